//! Scenes from published quantities: a pair of periods, Andoyer variables, a spin–orbit resonance.

mod andoyer;
#[cfg(feature = "torques")]
pub(crate) mod locked;
mod nearest;
pub(crate) mod periods;

use nalgebra::{UnitQuaternion, Vector3};

use crate::input::body::Body;
use crate::input::scene::Scene;
use crate::input::state::State;

/// The scene of a state that is given about the principal axes of the body.
fn scene_about_principal_axes(
    body: Body,
    epoch: f64,
    attitude: UnitQuaternion<f64>,
    angular_velocity: Vector3<f64>,
) -> Scene {
    let turn = body.turn().unwrap_or_else(UnitQuaternion::identity);
    let state = State { epoch, attitude: attitude * turn.inverse(), angular_velocity: turn * angular_velocity };
    Scene::new(body, state)
}
