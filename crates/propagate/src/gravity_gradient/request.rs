//! The options of a scene that concern the motion under a torque.

use crate::input::options::{Averaging, Level};
use crate::input::orbit::Orbit;

/// The requested options of the perturbed motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request<'a> {
    pub(crate) orbit: &'a Orbit,
    pub(crate) averaging: Averaging,
    pub(crate) level: Level,
    pub(crate) tolerance: f64,
    pub(crate) epoch: f64,
    /// Longest time from the epoch, in the user's unit.
    pub(crate) duration: f64,
    /// Whether the scene has a span.
    pub(crate) spanned: bool,
}
