//! The only method of a build without torques: the free motion.

use std::sync::atomic::AtomicBool;

use super::free::{self, Preparation};
use crate::error::Error;
use crate::input::options::Served;
use crate::input::scene::Scene;
use crate::motion::solved::Motion;
use crate::torque_free::polhode::Polhode;

/// The motion of a scene about principal axes.
///
/// # Errors
/// Those of the free motion.
pub(super) fn motion(scene: Scene, _: (Served, &AtomicBool)) -> Result<Motion, Error> {
    let polhode = Polhode::of(&scene);
    free::motion(scene, polhode.as_ref(), Preparation::default())
}
