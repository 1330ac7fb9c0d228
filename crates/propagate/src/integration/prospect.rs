//! What an integration will cost, and how accurate it will be, before it is made.

use super::bound::{FLOOR, INPUT, SAFETY};
use super::problem::Problem;
use super::step_errors::ROUNDING;
use crate::input::scene::Scene;
use crate::input::torque::Torque;
use crate::motion::verification_cost::VerificationCost;

/// Steps of a few milliseconds.
const BRIEF: f64 = 4e3;
/// Steps in a radian of the fastest rate, if passages of the pericentre have made the rotation four times as fast.
const SPUN_UP: f64 = 8.0;
/// Length of a step \[rad\], from below.
const STEP: f64 = 0.65;

/// A guess of the error bound, and about how many steps there will be: for the choice of a method.
///
/// The guess has the parts of the bound that a regular motion has without truncation errors: the rounded state at the epoch, and the rounding of ω × Iω in each
/// step. The errors of the rates add up by chance and turn the body ever after. For 30 scenes of which the theory holds the guess is
/// 0.5 of the bound in the median, and 0.3 to 0.9 of it in all.
pub(crate) fn prospect(scene: &Scene) -> Option<(f64, f64)> {
    let problem = Problem::new(scene, "").ok()?;
    let phase = problem.phase();
    let rates = INPUT + ROUNDING[1] * problem.gyration() * (STEP * phase).sqrt();
    Some((FLOOR + SAFETY[0] * rates * phase, problem.most_steps()))
}

/// Whether an integration takes some milliseconds at most, even if passages of the pericentre spin the body up.
pub(crate) fn is_brief(scene: &Scene) -> bool {
    // A constant torque may spin it up to any rate.
    scene.acting_torques().is_empty()
        && Problem::new(scene, "").is_ok_and(|problem| {
            let longest = problem.ends[0].0.abs().max(problem.ends[1].0.abs());
            problem.most_steps() + SPUN_UP * problem.fastest * longest < BRIEF
        })
}

/// The cost of a verification of a motion under torques over the span of its scene; `None` without a span.
pub(crate) fn verification_cost(scene: &Scene) -> Option<VerificationCost> {
    let polynomials = scene.acting_torques().iter().filter(|torque| matches!(torque, Torque::Polynomial(_))).count();
    let bodies = scene.asked_disturbing().len() + polynomials;
    if bodies == 0 && scene.acting_torques().is_empty() {
        return VerificationCost::over_span(scene);
    }
    let ((start, stop), epoch) = (scene.asked_span()?, scene.state().epoch);
    let sides = [(epoch - start).max(0.0), (stop - epoch).max(0.0)];
    // `prospect` counts the rotation on the longer side, and the passages on both.
    let (_, steps) = prospect(scene)?;
    let longer = sides[0].max(sides[1]).max(f64::MIN_POSITIVE);
    Some(VerificationCost { steps: steps * (sides[0] + sides[1]) / longer, bodies })
}
