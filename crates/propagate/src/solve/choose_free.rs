//! The only method of a build without torques: the free motion.

use std::sync::atomic::AtomicBool;

use super::free::{self, Preparation};
use crate::error::Error;
use crate::input::options::{Method, Served};
use crate::input::scene::Scene;
use crate::motion::solved::Motion;
use crate::torque_free::polhode::Polhode;

impl Scene {
    /// Whether the scene is integrated without an attempt by theory: never, without the feature `torques`.
    #[must_use]
    pub fn needs_integration(&self) -> bool {
        false
    }

    /// Whether the scene needs a short integration: never, without the feature `torques`.
    #[must_use]
    pub fn is_brief(&self) -> bool {
        false
    }
}

/// The motion of a scene about principal axes.
///
/// # Errors
/// [`Error::NotBuilt`] for a scene with a torque or with a method that is not built, and those of the free motion.
pub(super) fn motion(scene: Scene, _: &AtomicBool) -> Result<Motion, Error> {
    let method = scene.asked_method();
    if matches!(method, Method::Integrated | Method::Libration) {
        return Err(Error::NotBuilt { argument: "method", value: method.to_string() });
    }
    let bodies = scene.asked_disturbing().len();
    if bodies > 0 && !scene.body().is_sphere() {
        return Err(Error::NotBuilt { argument: "orbit", value: format!("{bodies} disturbing") });
    }
    if let Some(torque) = scene.asked_torques().first() {
        return Err(Error::NotBuilt { argument: "torques", value: torque.kind().to_owned() });
    }
    let polhode = Polhode::of(&scene);
    free::motion(scene, polhode.as_ref(), Preparation::default())
}

/// The motions of several scenes about principal axes.
pub(super) fn motions(scenes: Vec<Result<Scene, Error>>, _: Served, stop: &AtomicBool) -> Vec<Result<Motion, Error>> {
    scenes.into_iter().map(|scene| scene.and_then(|scene| motion(scene, stop))).collect()
}
