//! What is asked of all members of an ensemble, or of each.

use crate::input::options::{Level, Method};
use crate::input::torque::Torque;
use crate::orbit::disturbing_body::DisturbingBody;

/// The options of the members.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Options {
    /// None for 0, one for all, or one for each.
    pub(super) epochs: Vec<f64>,
    /// None, those of all, or those of each.
    pub(super) orbits: Vec<Vec<DisturbingBody>>,
    pub(super) torques: Vec<Torque>,
    pub(super) level: Level,
    pub(super) tolerance: f64,
    pub(super) method: Method,
    pub(super) span: Option<(f64, f64)>,
    pub(super) threads: Option<usize>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            epochs: Vec::new(),
            orbits: Vec::new(),
            torques: Vec::new(),
            level: Level::default(),
            tolerance: 1e-12,
            method: Method::Auto,
            span: None,
            threads: None,
        }
    }
}

impl Options {
    pub(super) fn epoch(&self, index: usize) -> f64 {
        of_member(&self.epochs, index).copied().unwrap_or(0.0)
    }

    pub(super) fn orbits(&self, index: usize) -> &[DisturbingBody] {
        of_member(&self.orbits, index).map_or(&[], Vec::as_slice)
    }
}

/// The value of a member, of none, one for all, or one for each.
fn of_member<T>(values: &[T], index: usize) -> Option<&T> {
    match values {
        [of_all] => Some(of_all),
        each => each.get(index),
    }
}

/// Values of members, kept once if all have the same, and not at all if that is the default: equal ensembles are equal.
pub(super) fn once<T: PartialEq>(mut values: Vec<T>, is_default: impl Fn(&T) -> bool) -> Vec<T> {
    if values.windows(2).all(|pair| pair[0] == pair[1]) {
        values.truncate(usize::from(values.first().is_some_and(|value| !is_default(value))));
    }
    values
}
