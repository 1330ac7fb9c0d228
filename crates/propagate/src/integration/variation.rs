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
//! Other torques add their derivatives to A and B. All columns share A and B, and eight of them are lanes of one sum of products.

use std::sync::atomic::AtomicBool;

use andoyer_double::two_sum;
use nalgebra::{Matrix3, Vector3};
use pulp::Arch;

use super::disturber::Disturber;
use super::expansion::{Equations, Workspace};
use super::integrated::Problem;
use super::integrator::{AT_ONCE, MOST_STEPS, Precision, Runner, affordable, next_end};
use super::series::{ROWS, Row, Series, StateLanes, ZERO, add_product, add_scaled};
use super::torques::Torques;
use crate::error::Error;
use crate::input::scene::Scene;
use crate::numerics::scaling::scaled;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::simd::halt::going;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch_few};

/// Relative truncation error of a step, below rounding: order 21.
const ERROR: f64 = 1e-17;
/// Columns of a block.
const LANES: usize = 8;

type ColumnLanes = StateLanes<LANES>;
/// A vector for each column of a block.
type Vectors = [ColumnLanes; 3];

/// A parameter, in the axes of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ForcedColumn {
    /// A rotation of the initial attitude about this axis.
    Attitude(Vector3<f64>),
    /// A change of the initial angular velocity along this vector.
    AngularVelocity(Vector3<f64>),
    /// A change of the inertia tensor.
    Inertia(Matrix3<f64>),
    /// The element of the orbit of a disturbing body, in the order of the orbit's arguments.
    Element(usize, usize),
    /// The attraction of a disturbing body.
    Attraction(usize),
}

/// The derivatives of attitude and rates, (n, 3, columns) each.
pub(crate) type PartialsRows<'a> = [&'a mut [f64]; 2];

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
        dispatch_few(Arch::new(), variation)?;
    }
    Ok(())
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
            let whole = runner.expand(simd, (equations, precision), &mut workspace);
            linear.set(simd, equations, &workspace, order);
            let mut length = whole;
            for block in &mut blocks {
                block.set_forces(simd, (equations, &workspace, &linear), (start, backward), order);
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

/// The series of the matrices A and B, of ω, and of the products of s and ω.
struct Linear {
    rates: [[f64; 3]; ROWS],
    by_angle: [[[f64; 3]; 3]; ROWS],
    by_rate: [[[f64; 3]; 3]; ROWS],
    /// (s2 s2, s3 s3, s1 s1) and (s2 s3, s3 s1, s1 s2) of each body.
    squares: Vec<[Series; 2]>,
    /// Σ s sᵀ − ω ωᵀ.
    products: [Matrix3<f64>; ROWS],
}

impl Linear {
    fn new(bodies: usize) -> Self {
        Self {
            rates: [[0.0; 3]; ROWS],
            by_angle: [[[0.0; 3]; 3]; ROWS],
            by_rate: [[[0.0; 3]; 3]; ROWS],
            squares: vec![[ZERO; 2]; bodies],
            products: [Matrix3::zeros(); ROWS],
        }
    }

    #[inline(always)]
    fn set<S: InstructionSet>(&mut self, simd: S, equations: &Equations<4>, workspace: &Workspace<4>, order: usize) {
        let f = equations.factors;
        for k in 0..order {
            let [mut squares, mut mixed] = [[0.0; 4]; 2];
            for (body, kept) in self.squares.iter_mut().enumerate() {
                let sums = squared(simd, |j| *workspace.direction(body, j), k);
                (kept[0][k], kept[1][k]) = (sums[0], sums[1]);
                for lane in 0..3 {
                    squares[lane] += sums[0][lane];
                    mixed[lane] += sums[1][lane];
                }
            }
            let [p22, p33, p11, _] = squares;
            let [p23, p31, p12, _] = mixed;
            let [x, y, z, _] = workspace.rates[k];
            self.rates[k] = [x, y, z];
            self.by_angle[k] = [
                [f[0] * (p33 - p22), f[0] * p12, -f[0] * p31],
                [-f[1] * p12, f[1] * (p11 - p33), f[1] * p23],
                [f[2] * p31, -f[2] * p23, f[2] * (p22 - p11)],
            ];
            self.by_rate[k] = [[0.0, -f[0] * z, -f[0] * y], [-f[1] * z, 0.0, -f[1] * x], [-f[2] * y, -f[2] * x, 0.0]];
            let rate = |j: usize| {
                let [x, y, z, _] = workspace.rates[j];
                [[y, z, x, 0.0], [z, x, y, 0.0]]
            };
            let [turned, gyration] = squared(simd, rate, k);
            let [d22, d33, d11] = [0, 1, 2].map(|lane| squares[lane] - turned[lane]);
            let [d23, d31, d12] = [0, 1, 2].map(|lane| mixed[lane] - gyration[lane]);
            self.products[k] = Matrix3::new(d11, d12, d31, d12, d22, d23, d31, d23, d33);
        }
        if let Some(torques) = &equations.torques {
            let [by_angle, by_rate] = torques.derivatives(order, workspace.polynomials());
            for (k, (angle, rate)) in by_angle.iter().zip(&by_rate).enumerate() {
                for row in 0..3 {
                    for column in 0..3 {
                        self.by_angle[k][row][column] += angle[(row, column)];
                        self.by_rate[k][row][column] += rate[(row, column)];
                    }
                }
            }
        }
    }
}

/// Coefficient k of the products of a vector's components, from (v2, v3, v1) and (v3, v1, v2): squares of the first, and their products.
#[inline(always)]
fn squared<S: InstructionSet>(simd: S, vector: impl Fn(usize) -> [Row; 2], k: usize) -> [Row; 2] {
    let mut sums = [[0.0; 4]; 2];
    for j in 0..=k {
        let ([one, _], [same, other]) = (vector(j), vector(k - j));
        add_product(simd, &mut sums[0], &one, &same);
        add_product(simd, &mut sums[1], &one, &other);
    }
    sums
}

/// Eight columns.
struct ColumnBlock<'a> {
    columns: &'a [ForcedColumn],
    scene: &'a Scene,
    exponent: i32,
    angle: [Vectors; ROWS],
    rate: [Vectors; ROWS],
    force: [Vectors; ROWS],
}

impl<'a> ColumnBlock<'a> {
    fn new(columns: &'a [ForcedColumn], scene: &'a Scene, exponent: i32) -> Self {
        let nothing = [[[0.0; LANES]; 3]; ROWS];
        let mut block = Self { columns, scene, exponent, angle: nothing, rate: nothing, force: nothing };
        for (lane, column) in columns.iter().enumerate() {
            for axis in 0..3 {
                match column {
                    ForcedColumn::Attitude(turn) => block.angle[0][axis][lane] = turn[axis],
                    ForcedColumn::AngularVelocity(change) => {
                        block.rate[0][axis][lane] = scaled(change[axis], -exponent)
                    }
                    _ => {}
                }
            }
        }
        block
    }

    /// The series of the forces F about the start of a step.
    #[inline(always)]
    fn set_forces<S: InstructionSet>(
        &mut self,
        simd: S,
        (equations, workspace, linear): (&Equations<4>, &Workspace<4>, &Linear),
        time: ((f64, f64), bool),
        order: usize,
    ) {
        let inverse = Vector3::from(self.scene.body().moments()).map(f64::recip);
        let mut elements: Option<(usize, [Series; 6])> = None;
        for (lane, column) in self.columns.iter().enumerate() {
            match column {
                ForcedColumn::Attitude(_) | ForcedColumn::AngularVelocity(_) => {}
                ForcedColumn::Inertia(change) => {
                    for k in 0..order {
                        let [x, y, z, _] = workspace.rates[k + 1];
                        let faster = (k + 1) as f64 * (change * Vector3::new(x, y, z));
                        let moved = linear.products[k] * change;
                        for axis in 0..3 {
                            let (j, l) = ((axis + 1) % 3, (axis + 2) % 3);
                            self.force[k][axis][lane] = inverse[axis] * (moved[(j, l)] - moved[(l, j)] - faster[axis]);
                        }
                    }
                }
                ForcedColumn::Element(body, element) => {
                    let Disturber::Conic(conic) = &equations.bodies[*body] else { continue };
                    let series = match &elements {
                        Some((of, series)) if of == body => series,
                        _ => &elements.insert((*body, conic.by_elements(simd.four(), time.0, order))).1,
                    };
                    let unit = match element {
                        0 => -self.exponent,
                        2 => self.exponent,
                        _ => 0,
                    };
                    self.force_by_path(simd, (equations, workspace), (*body, lane, unit), &series[*element], order);
                }
                ForcedColumn::Attraction(body) => {
                    let DisturbingBody::Orbit(orbit) = &self.scene.asked_disturbing()[*body] else { continue };
                    for k in 0..order {
                        for axis in 0..3 {
                            let product = linear.squares[*body][1][k][axis];
                            self.force[k][axis][lane] = equations.factors[axis] * product / orbit.strength();
                        }
                    }
                }
            }
        }
    }

    /// The force by a change of the direction to a body, from the series of the change of r̃.
    #[inline(always)]
    fn force_by_path<S: InstructionSet>(
        &mut self,
        simd: S,
        (equations, workspace): (&Equations<4>, &Workspace<4>),
        (body, lane, unit): (usize, usize, i32),
        change: &Series,
        order: usize,
    ) {
        let mut turned = [[[0.0; 4]; 2]; ROWS];
        for k in 0..order {
            let mut sums = [[0.0; 4]; 3];
            for j in 0..=k {
                let (matrix, change) = (workspace.matrix(j), &change[k - j]);
                for axis in 0..3 {
                    add_scaled(simd, &mut sums[axis], change[axis], &matrix[axis]);
                }
            }
            let [x, y, z] = [0, 1, 2].map(|at| sums[0][at] + sums[1][at] + sums[2][at]);
            turned[k] = [[y, z, x, 0.0], [z, x, y, 0.0]];
            let mut force = [0.0; 4];
            for (j, [first, second]) in turned[..=k].iter().enumerate() {
                let [one, other] = workspace.direction(body, k - j);
                add_product(simd, &mut force, first, other);
                add_product(simd, &mut force, second, one);
            }
            for (axis, (factor, force)) in equations.factors.iter().zip(force).enumerate().take(3) {
                self.force[k][axis][lane] = scaled(factor * force, unit);
            }
        }
    }

    /// Coefficients 1 to `order` of all columns.
    #[inline(always)]
    fn expand<S: InstructionSet>(&mut self, simd: S, linear: &Linear, order: usize) {
        for k in 0..order {
            let (mut turned, mut pushed) = (self.rate[k], self.force[k]);
            for j in 0..=k {
                let (angle, rate) = (&self.angle[k - j], &self.rate[k - j]);
                let [x, y, z] = linear.rates[j];
                add_scaled(simd, &mut turned[0], z, &angle[1]);
                add_scaled(simd, &mut turned[0], -y, &angle[2]);
                add_scaled(simd, &mut turned[1], x, &angle[2]);
                add_scaled(simd, &mut turned[1], -z, &angle[0]);
                add_scaled(simd, &mut turned[2], y, &angle[0]);
                add_scaled(simd, &mut turned[2], -x, &angle[1]);
                for (pushed, (by_angle, by_rate)) in
                    pushed.iter_mut().zip(linear.by_angle[j].iter().zip(&linear.by_rate[j]))
                {
                    for column in 0..3 {
                        add_scaled(simd, pushed, by_angle[column], &angle[column]);
                        add_scaled(simd, pushed, by_rate[column], &rate[column]);
                    }
                }
            }
            let share = 1.0 / (k + 1) as f64;
            for axis in 0..3 {
                self.angle[k + 1][axis] = turned[axis].map(|value| value * share);
                self.rate[k + 1][axis] = pushed[axis].map(|value| value * share);
            }
        }
    }

    /// The length, `whole` at most, at which the last terms of each column are a rounding error of the largest one: torques turn several times as fast as the attitude's
    /// quaternion, and where they are weak the motion's own series does not show it.
    #[inline(always)]
    fn longest(&self, whole: f64, order: usize) -> f64 {
        let mut most = 1.0_f64;
        for series in [&self.angle, &self.rate] {
            let (mut size, mut rest, mut power) = ([0.0; LANES], [0.0; LANES], 1.0);
            for (k, vectors) in series.iter().enumerate().take(order + 1) {
                for lane in 0..LANES {
                    let term = power * vectors[0][lane].abs().max(vectors[1][lane].abs()).max(vectors[2][lane].abs());
                    size[lane] = f64::max(size[lane], term);
                    if k + 1 >= order {
                        rest[lane] = f64::max(rest[lane], term);
                    }
                }
                power *= whole;
            }
            for lane in 0..LANES {
                if rest[lane] > ERROR * size[lane] {
                    most = most.min((ERROR * size[lane] / rest[lane]).powf(1.0 / (order - 1) as f64));
                }
            }
        }
        whole * most
    }

    /// Angles and rates a time after the start of the step.
    #[inline(always)]
    fn at(&self, length: f64, order: usize) -> [Vectors; 2] {
        let (mut angle, mut rate) = (self.angle[order], self.rate[order]);
        for k in (0..order).rev() {
            for axis in 0..3 {
                for lane in 0..LANES {
                    angle[axis][lane] = angle[axis][lane].mul_add(length, self.angle[k][axis][lane]);
                    rate[axis][lane] = rate[axis][lane].mul_add(length, self.rate[k][axis][lane]);
                }
            }
        }
        [angle, rate]
    }

    /// Goes to the end of a step.
    #[inline(always)]
    fn advance(&mut self, length: f64, order: usize) {
        [self.angle[0], self.rate[0]] = self.at(length, order);
    }

    /// Writes the derivatives of a time a length after the start of the step; `place`: the index of the time, the first column of the block, and the number of all columns.
    #[inline(always)]
    fn write(
        &self,
        length: f64,
        order: usize,
        (index, first, all): (usize, usize, usize),
        outputs: &mut PartialsRows<'_>,
    ) {
        let [angle, rate] = self.at(length, order);
        for axis in 0..3 {
            let row = (3 * index + axis) * all + first;
            for lane in 0..self.columns.len() {
                outputs[0][row + lane] = angle[axis][lane];
                outputs[1][row + lane] = scaled(rate[axis][lane], self.exponent);
            }
        }
    }
}
