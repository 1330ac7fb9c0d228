//! What the averages leave out in second order: their difference from an integration of the full equations over a short window (weak torques, section 6).
//!
//! The mean state of each sample is compared with the averaged motion over the rotation alone. The difference grows linearly with time; its slope times the span is the error.

use std::f64::consts::TAU;

use nalgebra::{UnitQuaternion, Vector3};

use super::averaged_scene::AveragedScene;
use super::equations::{AveragedTorques, sorted_axes};
use super::path::{AveragedPath, Node, Scaled, UNREAD, Watch};
use super::short_period::{ShortPeriod, sorted_attitude};
use crate::error::Error;
use crate::input::options::Method;
use crate::simd::halt::GOING;

/// Rotations of the window, and samples in it.
const ROTATIONS: f64 = 30.0;
const SAMPLES: usize = 24;
/// Tolerances of the integrations: far below the changes of second order of a torque of 1e-5 of M times the rate.
const TOLERANCE: f64 = 1e-11;

const UNWATCHED: Watch<'static> = Watch { stop: &GOING, done: &UNREAD, path: (0, 1) };

/// Rates at which averages and full equations separate: of the angular momentum over its size, and of ξ.
pub(super) fn second_order(averaged: &AveragedScene) -> Result<[f64; 2], Error> {
    let epoch = averaged.equations.epoch;
    let own = averaged.equations.moments[averaged.equations.family.axis()];
    let length = ROTATIONS * TAU * own / averaged.momentum.norm();
    let (mut equations, lossy) = averaged.equations.without_losses();
    let scene = averaged.scene.without_dissipation();
    if lossy && scene.asked_torques().is_empty() && scene.asked_disturbing().is_empty() {
        return Ok([0.0; 2]);
    }
    let scene = scene.method(Method::Integrated).span(epoch, epoch + length).tolerance(TOLERANCE);
    let motion = scene.solve()?;
    equations.sources.iter_mut().for_each(|source| source.over_orbit = false);
    let (moments, sort) = (Vector3::from(scene.body().moments()), sorted_axes(scene.body().moments()).1);
    let mut means = Vec::with_capacity(SAMPLES);
    for sample in 0..SAMPLES {
        let time = epoch + length * sample as f64 / SAMPLES as f64;
        let state = motion.at(time)?;
        let momentum = state.attitude * moments.component_mul(&state.angular_velocity);
        means.push((time - epoch, mean(&equations, time, &sorted_attitude(&state.attitude, &sort), &momentum)?));
    }
    let unit = averaged.momentum.norm();
    let start = means[0].1;
    let mut scaled = Scaled::new(&equations, unit);
    let node = Node { time: epoch, state: [start[0] / unit, start[1] / unit, start[2] / unit, start[3]] };
    let path = AveragedPath::run(&mut scaled, node, (epoch + length, length / 6.0), TOLERANCE, UNWATCHED)?;
    let mut differences = Vec::with_capacity(SAMPLES);
    for (since, mean) in &means {
        // An end within the window leaves the rest out.
        if epoch + since > path.end.time {
            break;
        }
        let state = path.state(&mut scaled, epoch + since)?;
        let [x, y, z] = [0, 1, 2].map(|axis| mean[axis] / unit - state[axis]);
        differences.push((*since, [x, y, z, mean[3] - state[3]]));
    }
    let slopes = [0, 1, 2, 3].map(|part| slope(&differences, part));
    Ok([Vector3::new(slopes[0], slopes[1], slopes[2]).norm(), slopes[3].abs()])
}

/// The mean state: momentum and ξ.
fn mean(
    equations: &AveragedTorques,
    time: f64,
    attitude: &UnitQuaternion<f64>,
    momentum: &Vector3<f64>,
) -> Result<[f64; 4], Error> {
    let g = attitude.inverse() * momentum.normalize();
    let excess = equations.family.alpha(&equations.moments).dot(&g.component_mul(&g));
    let (momentum, excess) = ShortPeriod::new(equations, time, (momentum, excess))?.mean(attitude, momentum);
    Ok([momentum.x, momentum.y, momentum.z, excess])
}

/// The slope of a line through differences at times, by least squares.
fn slope(differences: &[(f64, [f64; 4])], part: usize) -> f64 {
    let count = differences.len() as f64;
    let middle = differences.iter().map(|(time, _)| time).sum::<f64>() / count;
    let (mut above, mut below) = (0.0, 0.0);
    for (time, difference) in differences {
        above += (time - middle) * difference[part];
        below += (time - middle) * (time - middle);
    }
    if below > 0.0 { above / below } else { 0.0 }
}
