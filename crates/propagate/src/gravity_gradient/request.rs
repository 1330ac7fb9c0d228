//! The options of a scene that concern the motion under a torque.

use crate::input::options::{Averaging, Level};
use crate::input::orbit::Orbit;

/// The requested options of the perturbed motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request<'a> {
    /// Of each disturbing body; at least one.
    pub(crate) orbits: &'a [Orbit],
    pub(crate) averaging: Averaging,
    pub(crate) level: Level,
    pub(crate) tolerance: f64,
    pub(crate) epoch: f64,
    /// Longest times before and after the epoch, in the user's unit.
    pub(crate) sides: [f64; 2],
    /// Whether the scene has a span.
    pub(crate) spanned: bool,
}

impl Request<'_> {
    /// Longest time from the epoch, in the user's unit.
    pub(crate) fn duration(&self) -> f64 {
        let [before, after] = self.sides;
        before.max(after)
    }

    /// Whether there is one body, on an orbit that does not precess.
    pub(crate) fn is_fixed(&self) -> bool {
        matches!(self.orbits, [orbit] if orbit.is_fixed())
    }

    /// Whether the mean M and L at the epoch are those of all terms.
    pub(crate) fn is_refined(&self) -> bool {
        self.is_fixed() && matches!(self.level, Level::Auto | Level::Full | Level::SecondOrder)
    }
}
