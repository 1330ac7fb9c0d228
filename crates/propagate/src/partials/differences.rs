//! Derivatives of an averaged motion far from its epoch, from differences of solved motions.
//!
//! They are central differences of fourth order. A step turns the body by [`STEP`] at the most distant time, or is a part
//! [`LARGEST`] of its parameter if that is less. The truncation error is STEP⁴/30 of the largest
//! derivative, 3e-10. The rounding error of a solution, 1e-13, divided by the step is as large; for an element of the orbit it is larger by one over the effect of the
//! torque. Derivatives of the mean motion alone would lack those of the short-period corrections, which have the size of the torque. One call solves four motions for
//! each column, for any number of times.

use std::sync::atomic::AtomicBool;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use crate::error::Error;
use crate::input::options::{Averaging, Method};
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::integration::columns::{ForcedColumn, PartialsRows};
use crate::motion::solved::Motion;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;

/// Angle by which a step turns the body or its orbit at the most distant time \[rad\].
const STEP: f64 = 1e-2;
/// Largest step relative to the angular velocity, the moment, the mean motion or the attraction, and largest step of the eccentricity.
const LARGEST: f64 = 1e-3;
/// Tolerance of the solved motions, so that dropped terms are negligible relative to a step \[rad\].
const TOLERANCE: f64 = 1e-13;
/// Positions and weights of the differences: [8 f(h) − 8 f(−h) − f(2h) + f(−2h)]/12h.
const STENCIL: [(f64, f64); 4] = [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)];

/// Writes the derivatives at times that are valid for the motion, in the axes of its scene.
pub(super) fn fill(
    (motion, averaging): (&Motion, Averaging),
    columns: &[ForcedColumn],
    times: &[f64],
    outputs: PartialsRows<'_>,
    stop: &AtomicBool,
) -> Result<(), Error> {
    let scene = motion.scene.clone().tolerance(TOLERANCE.min(motion.scene.asked_tolerance()));
    let scene = scene.method(Method::Closed).averaging(averaging);
    let mut samples = Samples::new(times.len(), stop);
    samples.evaluate(&scene, times)?;
    let origins = samples.attitudes.clone();
    let [attitudes, rates] = outputs;
    attitudes.fill(0.0);
    rates.fill(0.0);
    for (column, parameter) in columns.iter().enumerate() {
        let step = step(&scene, parameter, times);
        for (place, weight) in STENCIL {
            samples.evaluate(&changed(&scene, parameter, place * step), times)?;
            let factor = weight / (12.0 * step);
            for (index, origin) in origins.iter().enumerate() {
                let turned = rotation_vector(*origin, samples.attitudes[index]);
                for row in 0..3 {
                    let entry = (3 * index + row) * columns.len() + column;
                    attitudes[entry] += factor * turned[row];
                    rates[entry] += factor * samples.rates[index][row];
                }
            }
        }
    }
    Ok(())
}

/// Attitudes and rates of one motion after the other.
struct Samples<'a> {
    attitudes: Vec<[f64; 4]>,
    rates: Vec<[f64; 3]>,
    stop: &'a AtomicBool,
}

impl<'a> Samples<'a> {
    fn new(times: usize, stop: &'a AtomicBool) -> Self {
        Self { attitudes: vec![[0.0; 4]; times], rates: vec![[0.0; 3]; times], stop }
    }

    fn evaluate(&mut self, scene: &Scene, times: &[f64]) -> Result<(), Error> {
        let motion = scene.solve_until(self.stop)?;
        motion.batch().until(self.stop).samples_into(times, &mut self.attitudes, &mut self.rates)
    }
}

/// The step of a parameter.
fn step(scene: &Scene, parameter: &ForcedColumn, times: &[f64]) -> f64 {
    let State { epoch, angular_velocity, .. } = *scene.state();
    let farthest = times.iter().fold(0.0_f64, |most, time| most.max((time - epoch).abs()));
    let rate = angular_velocity.norm();
    let part = |rate: f64| LARGEST.min(STEP / (rate * farthest));
    let orbit = |body: usize| match &scene.asked_disturbing()[body] {
        DisturbingBody::Orbit(orbit) => Some(orbit),
        DisturbingBody::Tabulated(_) => None,
    };
    match parameter {
        ForcedColumn::Attitude(_) => STEP,
        ForcedColumn::AngularVelocity(_) => part(rate) * rate,
        ForcedColumn::Inertia(change) => {
            let moments = scene.body().moments();
            let relative = Matrix3::from_fn(|i, j| change[(i, j)].abs() / (moments[i] * moments[j]).sqrt());
            part(rate) / relative.max()
        }
        ForcedColumn::Element(body, element) => orbit(*body).map_or(STEP, |orbit| {
            let (motion, e) = (orbit.mean_motion(), orbit.eccentricity());
            match element {
                0 => part(motion) * motion,
                1 => LARGEST * (1.0 - e),
                2 => STEP / motion,
                _ => STEP,
            }
        }),
        ForcedColumn::Attraction(body) => orbit(*body).map_or(STEP, |orbit| LARGEST * orbit.strength()),
        // A motion under such a torque is integrated.
        ForcedColumn::Torque(_) => STEP,
    }
}

/// The scene with one parameter changed.
fn changed(scene: &Scene, parameter: &ForcedColumn, step: f64) -> Scene {
    let (mut state, mut change) = (*scene.state(), Matrix3::zeros());
    match parameter {
        ForcedColumn::Attitude(axis) => state.attitude *= UnitQuaternion::from_scaled_axis(axis * step),
        ForcedColumn::AngularVelocity(direction) => state.angular_velocity += direction * step,
        ForcedColumn::Inertia(direction) => change = direction * step,
        ForcedColumn::Element(body, element) => {
            return with_orbit(scene, *body, |orbit| orbit.displaced(*element, step));
        }
        ForcedColumn::Torque(_) => {}
        ForcedColumn::Attraction(body) => {
            return with_orbit(scene, *body, |orbit| orbit.attracting(orbit.strength() + step));
        }
    }
    let elements = [change.m11, change.m22, change.m33, change.m12, change.m13, change.m23];
    scene.starting_from(scene.body().displaced(elements), state)
}

/// The scene with another orbit of one of its bodies.
fn with_orbit(scene: &Scene, body: usize, change: impl Fn(&Orbit) -> Orbit) -> Scene {
    let mut bodies = scene.asked_disturbing().to_vec();
    if let DisturbingBody::Orbit(orbit) = &mut bodies[body] {
        *orbit = change(orbit);
    }
    scene.clone().disturbing(bodies)
}

/// The rotation vector from one attitude to a nearby one, in body components.
fn rotation_vector(start: [f64; 4], end: [f64; 4]) -> Vector3<f64> {
    let [start, end] = [start, end].map(|attitude| UnitQuaternion::new_unchecked(attitude.into()));
    (start.inverse() * end).scaled_axis()
}
