//! What `Motion::verify` costs: the steps of its integration, counted without it, and the time that they take.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::input::scene::Scene;
use crate::integration::integrated::prospect;

/// Time of one step and of its part of the error bound \[s\], and what each disturbing body adds: rough values from a busy machine, which no command measures yet.
/// `verify` is timed nowhere, so that a plan is the same on every machine.
const SECONDS: [f64; 2] = [4e-6, 3e-6];
/// Steps in one radian of the fastest rate, at most: as `prospect` counts them.
const STEPS_A_RADIAN: f64 = 2.0;

/// The cost of a verification.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct VerificationCost {
    /// Steps before and after the epoch together, at most about.
    pub(crate) steps: f64,
    pub(crate) bodies: usize,
}

impl VerificationCost {
    /// Over the span of a scene; `None` without a span. No body exerts a torque on a `sphere`.
    pub(crate) fn over_span(scene: &Scene, sphere: bool) -> Option<Self> {
        let ((start, stop), epoch) = (scene.asked_span()?, scene.state().epoch);
        let sides = [(epoch - start).max(0.0), (stop - epoch).max(0.0)];
        let bodies = scene.asked_disturbing().len();
        if sphere || bodies == 0 {
            let radians = scene.state().angular_velocity.norm() * (sides[0] + sides[1]);
            return Some(Self { steps: STEPS_A_RADIAN * radians, bodies: 0 });
        }
        // `prospect` counts the steps on the longer side.
        let (_, steps) = prospect(scene)?;
        let longer = sides[0].max(sides[1]).max(f64::MIN_POSITIVE);
        Some(Self { steps: steps * (sides[0] + sides[1]) / longer, bodies })
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
