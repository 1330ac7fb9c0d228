//! Eight columns of the variational equations: the changes of attitude and rates with eight parameters, and the forces of these parameters (theory §12).

use nalgebra::{Matrix3, Vector3};

use super::expansion::{Equations, Workspace};
use super::linear::Linear;
use super::paths::path_series::PathSeries;
use super::series::{ROWS, Series, StateLanes, add_product, add_scaled};
use super::torques::{PolynomialSeries, Torques};
use crate::input::scene::Scene;
use crate::input::torque::Torque;
use crate::numerics::scaling::scaled;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::simd::instruction_set::InstructionSet;

/// Relative truncation error of a step, below rounding: order 21.
pub(super) const ERROR: f64 = 1e-17;
/// The derivatives of attitude and rates, (n, 3, columns) each.
pub(crate) type PartialsRows<'a> = [&'a mut [f64]; 2];
/// Columns of a block.
pub(super) const LANES: usize = 8;

type ColumnLanes = StateLanes<LANES>;
/// A vector for each column of a block.
type Vectors = [ColumnLanes; 3];

/// A parameter, in the axes of the scene.
#[derive(Clone, Debug, PartialEq)]
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
    /// The factor of a torque.
    Torque(Torque),
}

/// Eight columns.
pub(super) struct ColumnBlock<'a> {
    columns: &'a [ForcedColumn],
    scene: &'a Scene,
    exponent: i32,
    angle: [Vectors; ROWS],
    rate: [Vectors; ROWS],
    force: [Vectors; ROWS],
    /// The torques of columns, by lane, with room for their series.
    torques: Vec<(usize, Torques, Vec<PolynomialSeries>)>,
}

impl<'a> ColumnBlock<'a> {
    pub(super) fn new(columns: &'a [ForcedColumn], scene: &'a Scene, exponent: i32) -> Self {
        let nothing = [[[0.0; LANES]; 3]; ROWS];
        let mut block =
            Self { columns, scene, exponent, angle: nothing, rate: nothing, force: nothing, torques: Vec::new() };
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
            if let ForcedColumn::Torque(torque) = column {
                let found = Torques::of(std::slice::from_ref(torque), (scene, exponent), false);
                block.torques.extend(
                    found
                        .map(|torques| (lane, torques.room(1), torques))
                        .map(|(lane, room, torques)| (lane, torques, room)),
                );
            }
        }
        block
    }

    /// The series of the forces F about the start of a step.
    #[inline(always)]
    pub(super) fn set_forces<S: InstructionSet>(
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
                ForcedColumn::Attitude(_) | ForcedColumn::AngularVelocity(_) | ForcedColumn::Torque(_) => {}
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
                    let PathSeries::Conic(conic) = &equations.bodies[*body] else { continue };
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

    /// The forces of the factors of torques.
    #[inline(always)]
    pub(super) fn set_torques<S: InstructionSet>(
        &mut self,
        simd: S,
        workspace: &Workspace<4>,
        time: ((f64, f64), bool),
        order: usize,
    ) {
        for (lane, torques, series) in &mut self.torques {
            torques.begin(simd, time, order, series);
            let rate = |j: usize| {
                let [x, y, z, _] = workspace.rates[j];
                Vector3::new(x, y, z)
            };
            for k in 0..order {
                let found = torques.coefficient((k, 0), rate, |j| workspace.matrix(j), series);
                for axis in 0..3 {
                    self.force[k][axis][*lane] = found[axis];
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
            let mut sum = Vector3::zeros();
            for j in 0..=k {
                let [x, y, z, _] = change[k - j];
                sum += workspace.matrix(j).tr_mul(&Vector3::new(x, y, z));
            }
            let [x, y, z] = sum.into();
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
    pub(super) fn expand<S: InstructionSet>(&mut self, simd: S, linear: &Linear, order: usize) {
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

    /// The largest h ≤ `whole` such that the last two terms of every column are below `ERROR` of its largest. Torques turn several times as fast as the attitude's
    /// quaternion, and where they are weak the motion's own series does not show it.
    #[inline(always)]
    pub(super) fn longest(&self, whole: f64, order: usize) -> f64 {
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
    pub(super) fn advance(&mut self, length: f64, order: usize) {
        [self.angle[0], self.rate[0]] = self.at(length, order);
    }

    /// Writes the derivatives of a time a length after the start of the step; `place`: the index of the time, the first column of the block, and the number of all columns.
    #[inline(always)]
    pub(super) fn write(
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
