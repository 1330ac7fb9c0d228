//! Derivatives of the motion with respect to its parameters, by variational equations in the series of the steps (theory §12).
//!
//! A change of a parameter turns the body by a rotation vector δθ about its axes, R → R exp(\[δθ\]×), and changes its rates by δω. With the directions s of
//! [`super::expansion`], P = Σ s sᵀ, and a change δI of the inertia tensor,
//!
//! ```text
//! δθ′ = δω − ω × δθ,   δω′ = A δθ + B δω + F
//! A: f1 δP23 = f1 [θ1 (P33 − P22) + θ2 P12 − θ3 P13], and in turn
//! B: −f1 (ω3 δω2 + ω2 δω3), and in turn
//! F = I⁻¹ [−δI ω′ − ω × δI ω + Σ s × δI s]   for the tensor
//! F1 = f1 Σ (δs2 s3 + s2 δs3), and in turn   for the orbit, with δs = Rᵀ δr̃
//! ```
//!
//! Other torques add their derivatives to A and B. All columns share A and B ([`super::linear`]), and eight of them are lanes of one sum of products ([`super::columns`]).

use std::sync::atomic::AtomicBool;

use andoyer_double::two_sum;
use pulp::Arch;

use super::columns::{ColumnBlock, ERROR, ForcedColumn, LANES, PartialsRows};
use super::expansion::{Equations, Workspace};
use super::integrator::{AT_ONCE, MOST_STEPS, Precision, Runner, affordable, next_end};
use super::linear::Linear;
use super::paths::path_series::PathSeries;
use super::problem::Problem;
use super::torques::Torques;
use crate::error::Error;
use crate::input::scene::Scene;
use crate::numerics::scaling::scaled;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::simd::halt::going;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};

/// About how many steps the motion of a scene takes over its span; infinite if it cannot be integrated.
pub(crate) fn steps(scene: &Scene) -> f64 {
    Problem::new(scene, "").map_or(f64::INFINITY, |problem| problem.most_steps())
}

/// Writes the derivatives at times within the span of a scene, in the scene's axes.
///
/// # Errors
/// Those of an integration over the span, but for its error bound.
pub(crate) fn fill(
    scene: &Scene,
    columns: &[ForcedColumn],
    times: &[f64],
    mut outputs: PartialsRows<'_>,
    stop: &AtomicBool,
) -> Result<(), Error> {
    let mut problem = Problem::new(scene, "")?;
    let exponent = problem.exponent;
    problem.equations.torques = Torques::new(scene, exponent, true).map(std::sync::Arc::new);
    for column in columns {
        attraction_held(&problem.equations, scene, column)?;
    }
    let epoch = scene.state().epoch;
    let since = |(index, time): (usize, &f64)| {
        let (high, low) = two_sum(*time, -epoch);
        (index, (scaled(high, exponent), scaled(low, exponent)))
    };
    let mut times: Vec<_> = times.iter().enumerate().map(since).collect();
    times.sort_by(|(_, one), (_, other)| one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1)));
    let (before, after) = times.split_at(times.partition_point(|(_, time)| *time < (0.0, 0.0)));
    let before: Vec<_> = before.iter().rev().copied().collect();
    for (backward, times) in [(true, &before[..]), (false, after)] {
        let variation = Variation {
            equations: &problem.equations,
            scene,
            exponent,
            columns,
            runner: Runner::new(problem.attitude, problem.rates, backward),
            backward,
            times,
            outputs: outputs.each_mut().map(|output| &mut **output),
            stop,
        };
        dispatch(Arch::new(), variation)?;
    }
    Ok(())
}

/// Whether doubles hold a torque in the unit of the integration, if it is to be divided by its attraction.
fn attraction_held(equations: &Equations<4>, scene: &Scene, column: &ForcedColumn) -> Result<(), Error> {
    let ForcedColumn::Attraction(body) = *column else { return Ok(()) };
    let (PathSeries::Conic(conic), DisturbingBody::Orbit(orbit)) =
        (&equations.bodies[body], &scene.asked_disturbing()[body])
    else {
        return Ok(());
    };
    if (conic.strength * conic.strength).is_normal() {
        return Ok(());
    }
    let bound = "at least 1e-307 of the square of the fastest rate, for derivatives with respect to it";
    Err(Error::Orbit { argument: "attraction", value: orbit.strength(), bound })
}

/// The derivatives at times in one direction from the epoch, the nearest first.
struct Variation<'a> {
    equations: &'a Equations<4>,
    scene: &'a Scene,
    exponent: i32,
    columns: &'a [ForcedColumn],
    runner: Runner<4>,
    backward: bool,
    times: &'a [(usize, (f64, f64))],
    outputs: PartialsRows<'a>,
    stop: &'a AtomicBool,
}

impl Task for Variation<'_> {
    type Output = Result<(), Error>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let Self { equations, scene, exponent, columns, mut runner, backward, times, mut outputs, stop } = self;
        let Some((_, target)) = times.last() else { return Ok(()) };
        let precision = Precision::of(ERROR);
        let order = precision.order;
        let mut workspace = Workspace::new(equations);
        let mut linear = Linear::new(equations.bodies.len());
        let mut blocks: Vec<_> =
            columns.chunks(LANES).map(|columns| ColumnBlock::new(columns, scene, exponent)).collect();
        let (mut start, mut next, mut steps) = (runner.time, 0, 0);
        loop {
            while let Some((index, time)) = times.get(next).filter(|(_, time)| reached(*time, runner.time, backward)) {
                let length = (time.0 - start.0) + (time.1 - start.1);
                for (block, first) in blocks.iter().zip((0..).step_by(LANES)) {
                    block.write(length, order, (*index, first, columns.len()), &mut outputs);
                }
                next += 1;
            }
            if next == times.len() {
                return Ok(());
            }
            if steps % AT_ONCE == 0 {
                going(stop).map_err(|_| Error::Stopped)?;
                affordable(equations, steps, runner.time, *target)?;
            }
            steps += 1;
            if steps > 1 {
                let length = (runner.time.0 - start.0) + (runner.time.1 - start.1);
                blocks.iter_mut().for_each(|block| block.advance(length, order));
            }
            start = runner.time;
            let whole = runner.expand(simd.four(), (equations, precision), &mut workspace);
            linear.set(simd.four(), equations, &workspace, order);
            let mut length = whole;
            for block in &mut blocks {
                block.set_forces(simd.four(), (equations, &workspace, &linear), (start, backward), order);
                block.set_torques(simd.four(), &workspace, (start, backward), order);
                block.expand(simd, &linear, order);
                length = length.min(block.longest(whole, order));
            }
            let end = next_end(equations, start.0, *target, backward);
            if !runner.go(length, order, end, (equations, &workspace)) {
                return Err(Error::TooManySteps { steps: f64::INFINITY, bound: MOST_STEPS, reason: String::new() });
            }
        }
    }
}

/// Whether a time is not beyond another one, in the direction of the integration.
fn reached(time: (f64, f64), end: (f64, f64), backward: bool) -> bool {
    if backward { time >= end } else { time <= end }
}
