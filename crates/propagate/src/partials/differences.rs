//! Derivatives of a motion under a gravity gradient, or of an integrated motion, from differences of solved motions.
//!
//! They are central differences of fourth order. A step turns the body by [`STEP`] at the most distant time. The truncation error is STEP⁴/30 of the largest
//! derivative, 3e-10. The rounding error of a solution, 1e-13, divided by the step is as large. Derivatives of the mean motion alone would lack those of the
//! short-period corrections, which have the size of the torque. One call solves 37 motions for any number of times, 49 for the
//! parameters of a body with a tensor.

use nalgebra::{UnitQuaternion, Vector3};

use crate::error::Error;
use crate::input::options::Method;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::input::torque::rotors;
use crate::motion::solved::Motion;

use super::derivatives::Derivatives;

/// Angle by which a step turns the body at the most distant time \[rad\].
const STEP: f64 = 1e-2;
/// Largest step relative to the angular velocity or the moment.
const LARGEST: f64 = 1e-3;
/// Tolerance of the solved motions, so that dropped terms are negligible relative to a step \[rad\].
const TOLERANCE: f64 = 1e-13;
/// Positions and weights of the differences: [8 f(h) − 8 f(−h) − f(2h) + f(−2h)]/12h.
const STENCIL: [(f64, f64); 4] = [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)];

/// Computes derivatives at times that are valid for the motion.
pub(super) fn fill<const N: usize>(
    motion: &Motion,
    times: &[f64],
    attitudes: &mut [Derivatives<N>],
    rates: &mut [Derivatives<N>],
) -> Result<(), Error> {
    let scene = motion.scene.clone().tolerance(TOLERANCE.min(motion.scene.asked_tolerance()));
    let scene = match motion.plan.averaging() {
        Some(averaging) => scene.averaging(averaging).method(Method::Closed),
        None => scene.method(Method::Integrated),
    };
    let steps = steps::<N>(motion, times);
    let mut samples = Samples::new(times.len());
    samples.evaluate(&scene, times)?;
    let origins = samples.attitudes.clone();
    attitudes.fill([[0.0; N]; 3]);
    rates.fill([[0.0; N]; 3]);
    for (parameter, step) in steps.into_iter().enumerate() {
        for (place, weight) in STENCIL {
            samples.evaluate(&changed(&scene, parameter, place * step), times)?;
            let factor = weight / (12.0 * step);
            for (index, origin) in origins.iter().enumerate() {
                let turned = rotation_vector(*origin, samples.attitudes[index]);
                for row in 0..3 {
                    attitudes[index][row][parameter] += factor * turned[row];
                    rates[index][row][parameter] += factor * samples.rates[index][row];
                }
            }
        }
    }
    Ok(())
}

/// Attitudes and rates of one motion.
struct Samples {
    attitudes: Vec<[f64; 4]>,
    rates: Vec<[f64; 3]>,
}

impl Samples {
    fn new(times: usize) -> Self {
        Self { attitudes: vec![[0.0; 4]; times], rates: vec![[0.0; 3]; times] }
    }

    fn evaluate(&mut self, scene: &Scene, times: &[f64]) -> Result<(), Error> {
        scene.solve()?.samples_into(times, &mut self.attitudes, &mut self.rates)
    }
}

/// The step of each parameter.
fn steps<const N: usize>(motion: &Motion, times: &[f64]) -> [f64; N] {
    let scene = &motion.scene;
    let State { epoch, angular_velocity, .. } = *scene.state();
    let farthest = times.iter().fold(0.0_f64, |most, time| most.max((time - epoch).abs()));
    // The rates of a body at rest need a step that is not 0.
    let least = scene.body().moments().into_iter().fold(f64::INFINITY, f64::min);
    // Torques may spin the body up, and rotors may turn it faster than it rotates at the epoch.
    let spun = match scene.asked_torques() {
        [] => 0.0,
        torques => motion.plan.fastest + rotors(torques).norm() / least,
    };
    let rate = match angular_velocity.norm().max(spun) {
        0.0 => STEP / farthest.max(f64::MIN_POSITIVE),
        rate => rate,
    };
    let part = LARGEST.min(STEP / (rate * farthest));
    let moments = scene.body().moments();
    std::array::from_fn(|parameter| match parameter {
        0..3 => STEP,
        3..6 => part * rate,
        6..9 => part * moments[parameter - 6],
        _ => part * moments.into_iter().fold(0.0, f64::max),
    })
}

/// The scene with one parameter changed.
fn changed(scene: &Scene, parameter: usize, step: f64) -> Scene {
    let (mut state, mut tensor) = (*scene.state(), [0.0; 6]);
    match parameter {
        0..3 => {
            let mut axis = Vector3::zeros();
            axis[parameter] = step;
            state.attitude *= UnitQuaternion::from_scaled_axis(axis);
        }
        3..6 => state.angular_velocity[parameter - 3] += step,
        _ => tensor[parameter - 6] = step,
    }
    scene.starting_from(scene.body().displaced(tensor), state)
}

/// The rotation vector from one attitude to a nearby one, in body components.
fn rotation_vector(start: [f64; 4], end: [f64; 4]) -> Vector3<f64> {
    let [start, end] = [start, end].map(|attitude| UnitQuaternion::new_unchecked(attitude.into()));
    (start.inverse() * end).scaled_axis()
}
