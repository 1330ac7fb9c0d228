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
pub(super) fn motion(scene: Scene, _: &AtomicBool) -> Result<Motion, Error> {
    let polhode = Polhode::of(&scene);
    free::motion(scene, polhode.as_ref(), Preparation::default())
}

/// The motions of several scenes about principal axes.
pub(super) fn motions(scenes: Vec<Result<Scene, Error>>, _: Served, stop: &AtomicBool) -> Vec<Result<Motion, Error>> {
    scenes.into_iter().map(|scene| scene.and_then(|scene| motion(scene, stop))).collect()
}
