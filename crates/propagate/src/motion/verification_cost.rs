//! What `Motion::verify` costs: the steps of its integration, counted without it, and the time that they take.

use std::f64::consts::TAU;

use crate::input::scene::Scene;

/// Time of one step and of its part of the error bound \[s\], and what each disturbing body adds: rough values from a busy machine, which no command measures yet.
/// `verify` is timed nowhere, so that a plan is the same on every machine.
const SECONDS: [f64; 2] = [4e-6, 3e-6];
/// Steps in one radian of the fastest rate, at most: as `integration::prospect` counts them.
const STEPS_A_RADIAN: f64 = 2.0;

/// The cost of a verification.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct VerificationCost {
    /// Steps before and after the epoch together, at most about.
    pub(crate) steps: f64,
    pub(crate) bodies: usize,
}

impl VerificationCost {
    /// Over the span of a scene without torques; `None` without a span.
    pub(crate) fn over_span(scene: &Scene) -> Option<Self> {
        let ((start, stop), epoch) = (scene.asked_span()?, scene.state().epoch);
        let radians = scene.state().angular_velocity.norm() * (stop.max(epoch) - start.min(epoch));
        Some(Self { steps: STEPS_A_RADIAN * radians, bodies: 0 })
    }

    /// Over a number of rotations before the epoch and as many after it.
    pub(crate) fn over_rotations(rotations: f64, bodies: usize) -> Self {
        Self { steps: 2.0 * STEPS_A_RADIAN * TAU * rotations, bodies }
    }

    pub(crate) fn seconds(self) -> f64 {
        let [own, of_body] = SECONDS;
        self.steps * (own + of_body * self.bodies as f64)
    }
}
