//! Several motions at once, one in each lane: each has its own body, ellipse, time and step.
//!
//! The torque is the gravity gradient of one body on an ellipse that does not precess. The series of a step are in [`super::lane_series`].

use std::ops::Range;

use nalgebra::{Quaternion, UnitQuaternion};
use pulp::bytemuck;

use super::conic::Conic;
use super::integrator::{Precision, sum};
use super::series::{RECIPROCALS, ROWS, Row};
use super::step_errors::{ROUNDING, StepSizes};
use crate::orbit::kepler::eccentric_anomaly;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::WIDEST;

/// The most lanes of a vector.
pub(super) const MOST: usize = WIDEST / 2;
/// One number for each lane.
pub(super) type PerLane = [f64; MOST];

/// Numbers for each lane.
pub(super) type LaneVectors<S, const N: usize> = [<S as pulp::Simd>::f64s; N];

/// A motion that enters a lane.
#[derive(Clone, Copy)]
pub(super) struct LaneStart<'a> {
    pub(super) conic: &'a Conic,
    /// The axes of its orbit.
    pub(super) axes: UnitQuaternion<f64>,
    /// Attitude relative to the axes of its orbit, and rates.
    pub(super) attitude: Row,
    pub(super) rates: Row,
    /// (I3 − I2)/I1 and so on.
    pub(super) factors: Row,
    /// Factor of the torque, next to 1.
    pub(super) strength: f64,
    /// Errors of rates are relative to this rate at least.
    pub(super) scale: f64,
}

/// What a lane has beside its numbers.
#[derive(Clone, Copy)]
pub(super) struct LanePlace<'a> {
    pub(super) conic: &'a Conic,
    /// From the epoch, in double-double.
    pub(super) time: (f64, f64),
    scale: f64,
    /// The eccentric anomaly at the start of the step.
    pub(super) anomaly: f64,
    /// The radius of convergence of its torque.
    pub(super) radius: f64,
}

/// The motions in the lanes of a vector, and their series.
pub(super) struct LaneMotions<'a, S: InstructionSet> {
    _aligned: [S::Register; 0],
    /// x, y, z, w of the quaternion, and ω1, ω2, ω3.
    pub(super) motion: [LaneVectors<S, 7>; ROWS],
    /// The first and the second row of the matrix: R11, R21, R12, R22, R13, R23.
    pub(super) matrix: [LaneVectors<S, 6>; ROWS],
    /// r̃.
    pub(super) path: [LaneVectors<S, 2>; ROWS],
    /// s.
    pub(super) direction: [LaneVectors<S, 3>; ROWS],
    /// x, sin E, k x of order k; E′, and the factor with the power of the distance.
    pub(super) ellipse: [LaneVectors<S, 5>; ROWS],
    pub(super) gyration: LaneVectors<S, 3>,
    /// What the state lacks by rounding.
    rest: LaneVectors<S, 7>,
    pub(super) factors: LaneVectors<S, 3>,
    pub(super) strength: S::f64s,
    /// The axes of the orbits as quaternions.
    axes: LaneVectors<S, 4>,
    pub(super) places: [Option<LanePlace<'a>>; MOST],
    pub(super) simd: S,
}

/// The numbers of a vector.
#[inline(always)]
fn lanes<S: InstructionSet>(vector: &S::f64s) -> &[f64] {
    bytemuck::cast_slice(std::slice::from_ref(vector))
}

#[inline(always)]
fn lanes_mut<S: InstructionSet>(vector: &mut S::f64s) -> &mut [f64] {
    bytemuck::cast_slice_mut(std::slice::from_mut(vector))
}

#[inline(always)]
fn loaded<S: InstructionSet>(simd: S, values: &PerLane) -> S::f64s {
    simd.partial_load_f64s(&values[..S::F64_LANES])
}

impl<'a, S: InstructionSet> LaneMotions<'a, S> {
    pub(super) fn new(simd: S) -> Box<Self> {
        let zero = simd.splat_f64s(0.0);
        Box::new(Self {
            _aligned: [],
            motion: [[zero; 7]; ROWS],
            matrix: [[zero; 6]; ROWS],
            path: [[zero; 2]; ROWS],
            direction: [[zero; 3]; ROWS],
            ellipse: [[zero; 5]; ROWS],
            gyration: [zero; 3],
            rest: [zero; 7],
            factors: [zero; 3],
            strength: zero,
            axes: [zero; 4],
            places: [None; MOST],
            simd,
        })
    }

    /// Gives a lane to another motion, at its epoch.
    pub(super) fn enter(&mut self, lane: usize, start: &LaneStart<'a>) {
        let LaneStart { conic, axes, scale, strength, .. } = *start;
        let place = LanePlace { conic, time: (0.0, 0.0), scale, anomaly: 0.0, radius: f64::INFINITY };
        self.places[lane] =
            Some(LanePlace { anomaly: eccentric_anomaly(conic.mean_at(place.time), conic.eccentricity), ..place });
        for (vector, value) in self.axes.iter_mut().zip(axes.coords.iter()) {
            lanes_mut::<S>(vector)[lane] = *value;
        }
        self.set_constants(lane, &start.factors, strength);
        self.restart(lane, [&start.attitude, &start.rates]);
    }

    /// Changes the factors of Euler's equations and that of the torque in a lane.
    pub(super) fn set_constants(&mut self, lane: usize, factors: &Row, strength: f64) {
        for (vector, value) in self.factors.iter_mut().zip(factors) {
            lanes_mut::<S>(vector)[lane] = *value;
        }
        lanes_mut::<S>(&mut self.strength)[lane] = strength;
    }

    /// Moves the state in a lane.
    pub(super) fn restart(&mut self, lane: usize, [attitude, rates]: [&Row; 2]) {
        for (vector, value) in self.motion[0].iter_mut().zip(attitude.iter().chain(rates)) {
            lanes_mut::<S>(vector)[lane] = *value;
        }
        for rest in &mut self.rest {
            lanes_mut::<S>(rest)[lane] = 0.0;
        }
    }

    pub(super) fn time(&self, lane: usize) -> (f64, f64) {
        self.places[lane].map_or((0.0, 0.0), |place| place.time)
    }

    /// Attitude relative to the axes of the orbit, and rates, of the state in a lane.
    pub(super) fn state(&self, lane: usize) -> [Row; 2] {
        let [x, y, z, w, p, q, r] = self.motion[0].each_ref().map(|vector| lanes::<S>(vector)[lane]);
        [[x, y, z, w], [p, q, r, 0.0]]
    }

    /// What the lengths of the steps and their errors depend on.
    #[inline(always)]
    pub(super) fn sizes(&self, order: usize) -> LaneSizes {
        let simd = self.simd;
        let [before, last, first] = [&self.motion[order - 1], &self.motion[order], &self.motion[0]];
        let (mut scale, mut radius) = ([1.0; MOST], [f64::INFINITY; MOST]);
        for ((scale, radius), place) in scale.iter_mut().zip(&mut radius).zip(&self.places) {
            if let Some(place) = place {
                (*scale, *radius) = (place.scale, place.radius);
            }
        }
        let fastest = largest(simd, &first[4..]);
        let scale = larger(simd, loaded(simd, &scale), fastest);
        let omitted = [largest(simd, &last[..4]), largest(simd, &last[4..])];
        let before = [largest(simd, &before[..4]), largest(simd, &before[4..])];
        let size = [before, omitted].map(|[attitude, rates]| larger(simd, attitude, simd.div_f64s(rates, scale)));
        // Each axis has its own factor.
        let by_axes =
            |sizes: [S::f64s; 3]| largest(simd, &[0, 1, 2].map(|axis| simd.mul_f64s(sizes[axis], self.factors[axis])));
        let distance = norm(simd, &self.path[0]);
        let least = larger(simd, distance, simd.splat_f64s(f64::MIN_POSITIVE));
        let turning = simd.add_f64s(norm(simd, &first[4..]), simd.div_f64s(norm(simd, &self.path[1]), least));
        let [one, two, three] = [0, 1, 2].map(|axis| largest(simd, &self.direction[0][axis..=axis]));
        let across = by_axes([simd.add_f64s(two, three), simd.add_f64s(three, one), simd.add_f64s(one, two)]);
        let twice = simd.mul_f64s(simd.splat_f64s(2.0 * ROUNDING[0]), distance);
        let by_torque = simd.mul_f64s(twice, across);
        let by_gyration = simd.mul_f64s(simd.splat_f64s(ROUNDING[1]), by_axes(self.gyration));
        LaneSizes {
            sizes: size.map(|size| stored::<S>(size)),
            omitted: omitted.map(|omitted| stored::<S>(omitted)),
            fastest: stored::<S>(fastest),
            turning: stored::<S>(turning),
            by_torque: stored::<S>(by_torque),
            by_gyration: stored::<S>(by_gyration),
            radius,
        }
    }

    /// Goes on by a length in each lane. `ends` are the targets that are reached.
    #[inline(always)]
    pub(super) fn go(&mut self, order: usize, lengths: &PerLane, ends: &[Option<(f64, f64)>; MOST]) {
        let simd = self.simd;
        let length = loaded(simd, lengths);
        let (mut motion, mut turned) = (self.motion[order], self.ellipse[order - 1][3]);
        for row in self.motion[1..order].iter().rev() {
            for (part, coefficient) in motion.iter_mut().zip(row) {
                *part = plus(simd, *part, length, *coefficient);
            }
        }
        for ((value, rest), part) in self.motion[0].iter_mut().zip(&mut self.rest).zip(motion) {
            compensated(simd, value, rest, simd.mul_f64s(part, length));
        }
        // E is the integral of E′.
        turned = simd.mul_f64s(turned, simd.splat_f64s(RECIPROCALS[order]));
        for k in (0..order - 1).rev() {
            let share = simd.mul_f64s(self.ellipse[k][3], simd.splat_f64s(RECIPROCALS[k + 1]));
            turned = plus(simd, turned, length, share);
        }
        turned = simd.mul_f64s(turned, length);
        for (lane, place) in self.places.iter_mut().enumerate().take(S::F64_LANES) {
            let Some(place) = place else { continue };
            place.time = ends[lane].unwrap_or_else(|| sum(place.time, lengths[lane]));
            place.anomaly += lanes::<S>(&turned)[lane];
        }
    }

    /// Adds to the state in a lane.
    pub(super) fn disturb(&mut self, lane: usize, [attitude, rates]: [Row; 2]) {
        for (vector, value) in self.motion[0].iter_mut().zip(attitude.into_iter().chain(rates)) {
            lanes_mut::<S>(vector)[lane] += value;
        }
    }

    /// The coefficients of the inertial attitude and of the rates in all lanes, one after another.
    #[inline(always)]
    pub(super) fn coefficients(&self, order: usize, mut each: impl FnMut([&[f64]; 7])) {
        let simd = self.simd;
        let [a, b, c, d] = self.axes;
        for k in 0..=order {
            let [x, y, z, w, p, q, r] = self.motion[k];
            let x_of = plus(simd, b, z, plus(simd, a, w, simd.mul_f64s(d, x)));
            let y_of = plus(simd, c, x, plus(simd, b, w, simd.mul_f64s(d, y)));
            let z_of = plus(simd, a, y, plus(simd, c, w, simd.mul_f64s(d, z)));
            let inertial = [
                minus(simd, c, y, x_of),
                minus(simd, a, z, y_of),
                minus(simd, b, x, z_of),
                minus(simd, c, z, minus(simd, b, y, minus(simd, a, x, simd.mul_f64s(d, w)))),
            ];
            let [x, y, z, w] = inertial.each_ref().map(lanes::<S>);
            let [p, q, r] = [&p, &q, &r].map(lanes::<S>);
            each([x, y, z, w, p, q, r]);
        }
    }
}

/// What the lengths of the steps and their errors depend on, in each lane.
pub(super) struct LaneSizes {
    /// Of the coefficients of the last two orders, relative to the first.
    sizes: [PerLane; 2],
    /// The last coefficients of attitude and rates.
    omitted: [PerLane; 2],
    /// The largest rate.
    fastest: PerLane,
    /// Rates at which matrix and direction turn.
    turning: PerLane,
    /// Rounding errors of the angular acceleration by the torque, without the growth of its series, and by ω × Iω.
    by_torque: PerLane,
    by_gyration: PerLane,
    radius: PerLane,
}

impl LaneSizes {
    /// The length without a target of a step that these lanes have in common.
    pub(super) fn length(&self, lanes: Range<usize>, precision: Precision) -> f64 {
        let sizes = self.sizes.each_ref().map(|sizes| worst(sizes, &lanes));
        let radius = self.radius[lanes].iter().fold(f64::INFINITY, |least, radius| least.min(*radius));
        precision.length(sizes, radius)
    }

    /// What the errors of a step of this length depend on: as [`super::integrator::Runner`] has it.
    pub(super) fn of_step(&self, lanes: Range<usize>, length: f64) -> StepSizes {
        let turned = length * worst(&self.turning, &lanes);
        let growth = if turned > 0.0 { turned.exp_m1() / turned } else { 1.0 };
        let by_torque = growth * worst(&self.by_torque, &lanes);
        StepSizes {
            omitted: self.omitted.each_ref().map(|omitted| worst(omitted, &lanes)),
            rounding: [ROUNDING[1] * worst(&self.fastest, &lanes), by_torque + worst(&self.by_gyration, &lanes)],
            radius: self.radius[lanes].iter().fold(f64::INFINITY, |least, radius| least.min(*radius)),
        }
    }
}

/// The largest value in some lanes.
fn worst(values: &PerLane, lanes: &Range<usize>) -> f64 {
    values[lanes.clone()].iter().fold(0.0, |most, value| if *value <= most { most } else { *value })
}

#[inline(always)]
fn stored<S: InstructionSet>(vector: S::f64s) -> PerLane {
    let mut values = [0.0; MOST];
    values[..S::F64_LANES].copy_from_slice(lanes::<S>(&vector));
    values
}

/// The larger in each lane; not a number where `other` is none.
#[inline(always)]
fn larger<S: InstructionSet>(simd: S, one: S::f64s, other: S::f64s) -> S::f64s {
    simd.select_f64s(simd.less_than_or_equal_f64s(other, one), one, other)
}

/// The largest magnitude in each lane.
#[inline(always)]
fn largest<S: InstructionSet>(simd: S, vectors: &[S::f64s]) -> S::f64s {
    let (mut most, sign) = (simd.splat_f64s(0.0), simd.splat_f64s(f64::from_bits(!(1 << 63))));
    for vector in vectors {
        most = larger(simd, most, simd.and_f64s(*vector, sign));
    }
    most
}

/// The root of the sum of squares in each lane.
#[inline(always)]
fn norm<S: InstructionSet>(simd: S, vectors: &[S::f64s]) -> S::f64s {
    let mut sum = simd.splat_f64s(0.0);
    for vector in vectors {
        sum = plus(simd, *vector, *vector, sum);
    }
    simd.sqrt_f64s(sum)
}

/// An inertial attitude relative to the axes of an orbit.
pub(super) fn within(axes: &UnitQuaternion<f64>, [x, y, z, w]: Row) -> Row {
    (axes.quaternion().conjugate() * Quaternion::new(w, x, y, z)).coords.into()
}

#[inline(always)]
fn compensated<S: InstructionSet>(simd: S, value: &mut S::f64s, rest: &mut S::f64s, change: S::f64s) {
    let change = simd.add_f64s(change, *rest);
    let sum = simd.add_f64s(*value, change);
    *rest = simd.sub_f64s(change, simd.sub_f64s(sum, *value));
    *value = sum;
}

/// sum + a b.
#[inline(always)]
pub(super) fn plus<S: InstructionSet>(simd: S, a: S::f64s, b: S::f64s, sum: S::f64s) -> S::f64s {
    simd.mul_add_e_f64s(a, b, sum)
}

/// sum − a b.
#[inline(always)]
pub(super) fn minus<S: InstructionSet>(simd: S, a: S::f64s, b: S::f64s, sum: S::f64s) -> S::f64s {
    simd.negate_mul_add_e_f64s(a, b, sum)
}
