//! The average over the rotation and the true anomaly f of the orbit. The time of the averaged motion is f/n.
//!
//! To first order in κ_o the angular momentum precesses steadily about the orbit's normal. To second order it also nods if the orbit is eccentric (equations (10)
//! to (13) of docs/theory-second-order.md): the averaged equations are then solved on arcs of the precession. The periodic part has the
//! order of the averaged equations. In second order it is the flow of the Hamiltonian W₁ + W₂ over a unit of time, by one step of the midpoint rule.

use andoyer_double::DoubleDouble;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::arcs::{Arcs, Averaged, SolvedArc};
use super::equations::{AveragedTorque, pole};
use super::polynomial::{Column, PiecePolynomial};
use crate::gravity_gradient::constants::SLOWEST_PRECESSION;
use crate::gravity_gradient::second_order::k2_orbit_mean::OverOrbit;
use crate::numerics::phase::Phase;
use crate::orbit::kepler::Place;
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// Number of steps to the mean frame at the epoch. Each one multiplies its error by κ_o.
const EPOCH_STEPS: usize = 4;

/// Precession with the periodic part of one orbit.
#[derive(Clone, Debug)]
pub(crate) struct Precession {
    torque: AveragedTorque,
    /// Factors of the periodic part of Ψ: 1, or in second order the drifts of ℓ′ and y′ for a unit of Ψ.
    factors: [f64; 2],
    mean: MeanFrame,
    /// The periodic parts of Ψ twice, or of the drifts of ℓ′ and y′, at the epoch.
    phases: [f64; 2],
    /// f − l at the epoch, and 1/n.
    centre: f64,
    per_radian: f64,
}

/// A frame after a small rotation in inertial components.
#[inline(always)]
fn turned<S: InstructionSet>(frame: QuaternionLanes<S>, [x, y, z]: [Lanes<S>; 3]) -> QuaternionLanes<S> {
    let (half, one) = (x.all(0.5), x.all(1.0));
    (QuaternionLanes([half * x, half * y, half * z, one]) * frame).normalized()
}

/// The motion of the mean frame, with Ψ or the drifts of ℓ′ and y′.
#[derive(Clone, Debug)]
enum MeanFrame {
    /// Steady precession.
    Steady {
        /// The frame at the epoch.
        frame: UnitQuaternion<f64>,
        /// Half the angle about the orbit's normal. `half_back` is half the angle about the angular momentum that keeps the frame from turning about it.
        half: Phase,
        half_back: Phase,
        /// The orbit average of dΨ/dt.
        secular: f64,
    },
    /// The solution of the averaged equations of second order.
    Nodding(Box<Arcs<PrecessionEquations>>),
}

/// The averaged equations of second order.
#[derive(Clone, Debug)]
struct PrecessionEquations {
    average: OverOrbit,
    /// The user's unit of time in units of the motion.
    unit: f64,
    /// Length of an arc, in the user's unit.
    length: f64,
}

impl Averaged for PrecessionEquations {
    fn arc(&self, sign: f64, from: f64, start: &Column) -> SolvedArc {
        let half = sign * 0.5 * self.length * self.unit;
        SolvedArc { from, length: self.length, solution: PiecePolynomial::solved(half, (-1.0, start), &self.average) }
    }
}

impl Precession {
    /// The motion from the frame at one place of the orbit, where Ψ and the drifts are 0. `unit` is the user's unit of time in units of the motion, and
    /// `factors` are the drifts of ℓ′ and y′ for a unit of Ψ.
    pub(crate) fn new(
        torque: AveragedTorque,
        frame: UnitQuaternion<f64>,
        place: &Place<pulp::Scalar>,
        (unit, factors): (f64, [f64; 2]),
    ) -> Self {
        let second = torque.over_orbit();
        let factors = if second.is_some() { factors } else { [1.0; 2] };
        let one = Lanes::splat(pulp::Scalar, 1.0);
        // The mean axis to first order, then again with the periodic part evaluated at the mean axis.
        let (mut start, mut phases) = (frame, [one; 2]);
        for _ in 0..EPOCH_STEPS {
            let (rotation, next) =
                torque.periodic((second.as_ref(), factors), QuaternionLanes::all(one, &start), place);
            let [x, y, z] = rotation.map(|lanes| 0.5 * lanes.values()[0]);
            start = UnitQuaternion::new_normalize(Quaternion::new(1.0, x, y, z)).inverse() * frame;
            phases = next;
        }
        let mean = match second {
            Some(second) => MeanFrame::nodding(second, &torque, start, unit),
            None => MeanFrame::steady(&torque, start, unit),
        };
        let (centre, per_radian) = (place.centre.values()[0], 1.0 / (torque.mean_motion * unit));
        Self { torque, factors, mean, phases: phases.map(|lanes| lanes.values()[0]), centre, per_radian }
    }

    /// The memory of what is solved so far, in bytes.
    pub(crate) fn memory(&self) -> usize {
        match &self.mean {
            MeanFrame::Steady { .. } => 0,
            MeanFrame::Nodding(arcs) => arcs.memory(),
        }
    }

    /// The frame, and Ψ twice or the drifts of ℓ′ and y′.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(
        &self,
        place: &Place<S>,
        elapsed: (Lanes<S>, Lanes<S>),
    ) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        let all = |value: f64| elapsed.0.all(value);
        let by_anomaly = (place.centre - all(self.centre)).mul_add(all(self.per_radian), elapsed.0);
        let (mean, mut drifts) = self.mean.at(&self.torque, (by_anomaly, elapsed.1));
        let second = match &self.mean {
            MeanFrame::Steady { .. } => None,
            MeanFrame::Nodding(arcs) => Some(&arcs.equations.average),
        };
        let (rotation, phases) = self.torque.periodic((second, self.factors), mean, place);
        for ((drift, phase), at_epoch) in drifts.iter_mut().zip(phases).zip(self.phases) {
            *drift = *drift + (phase - all(at_epoch));
        }
        (turned(mean, rotation), drifts)
    }

    /// The longest time from the epoch for which there are at most so many arcs, in the user's unit.
    pub(crate) fn bound(&self, most_arcs: usize) -> f64 {
        match &self.mean {
            MeanFrame::Steady { .. } => f64::INFINITY,
            MeanFrame::Nodding(arcs) => most_arcs as f64 * arcs.equations.length,
        }
    }
}

impl MeanFrame {
    fn steady(torque: &AveragedTorque, frame: UnitQuaternion<f64>, unit: f64) -> Self {
        let axis = frame * Vector3::z();
        let cosine = axis.dot(&torque.axes[2]);
        // dλ/dt = −Γ Δ cos I/(M η³) = −½ n κ_o cos I.
        let precessing = -0.5 * torque.precession * cosine * torque.mean_motion * unit;
        let [half, half_back] = [0.5, -0.5 * cosine].map(|part| Phase::new(DoubleDouble::from(part * precessing), 0.0));
        Self::Steady { frame, half, half_back, secular: torque.secular(&axis) * unit }
    }

    fn nodding(average: OverOrbit, torque: &AveragedTorque, frame: UnitQuaternion<f64>, unit: f64) -> Self {
        // The angular momentum turns by at most 1 rad in an arc.
        let length = 1.0 / (average.fastest().max(SLOWEST_PRECESSION * torque.mean_motion) * unit);
        Self::Nodding(Box::new(Arcs::new(PrecessionEquations { average, unit, length }, &frame)))
    }

    #[inline(always)]
    fn at<S: InstructionSet>(
        &self,
        torque: &AveragedTorque,
        elapsed: (Lanes<S>, Lanes<S>),
    ) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        match self {
            Self::Steady { frame, half, half_back, secular } => {
                let turn = QuaternionLanes::about(&torque.axes[2], half.sin_cos(elapsed));
                let back = QuaternionLanes::about(&Vector3::z(), half_back.sin_cos(elapsed));
                let phase = elapsed.0 * elapsed.0.all(*secular);
                (turn * QuaternionLanes::all(elapsed.0, frame) * back, [phase; 2])
            }
            Self::Nodding(arcs) => arcs.at(elapsed.0),
        }
    }
}

impl AveragedTorque {
    /// ⟨D⟩ + K2 averaged over the orbit with its periodic part, if the averaged equations are those of second order.
    pub(crate) fn over_orbit(&self) -> Option<OverOrbit> {
        let hamiltonian = self.second.as_deref()?;
        Some(OverOrbit::new(hamiltonian, self.eccentricity, self.mean_motion, self.axes))
    }

    /// The periodic part of one orbit: a rotation of the mean frame in inertial components, and Ψ twice, or in second order the drifts of ℓ′ and y′.
    #[inline(always)]
    fn periodic<S: InstructionSet>(
        &self,
        (second, factors): (Option<&OverOrbit>, [f64; 2]),
        mean: QuaternionLanes<S>,
        place: &Place<S>,
    ) -> ([Lanes<S>; 3], [Lanes<S>; 2]) {
        let (mut rotation, mut phase) = self.first_order(mean, place);
        let all = |value: f64| phase.all(value);
        let (mut further, mut phases) = ([all(0.0); 3], [all(0.0); 2]);
        if let Some(second) = second {
            let half = turned(mean, rotation.map(|component| component * all(0.5)));
            (rotation, phase) = self.first_order(half, place);
            (further, phases) = second.periodic(&pole(half), place);
        }
        for (component, further) in rotation.iter_mut().zip(further) {
            *component = *component + further;
        }
        for (sum, factor) in phases.iter_mut().zip(factors) {
            *sum = phase.mul_add(phase.all(factor), *sum);
        }
        (rotation, phases)
    }

    /// The periodic part of one orbit by W₁: a rotation in inertial components, and Ψ (theory (13)).
    #[inline(always)]
    fn first_order<S: InstructionSet>(&self, frame: QuaternionLanes<S>, place: &Place<S>) -> ([Lanes<S>; 3], Lanes<S>) {
        let Self { eccentricity, axes, phase, precession, .. } = self;
        let Place { sine, cosine, .. } = *place;
        let all = |value: f64| sine.all(value);
        let double = ComplexLanes { re: cosine, im: sine } * ComplexLanes { re: cosine, im: sine };
        let triple = double * ComplexLanes { re: cosine, im: sine };
        let (half, first, third) = (all(0.5), all(0.5 * eccentricity), all(eccentricity / 6.0));
        let constant = sine * all(*eccentricity);
        let by_cosine = triple.im.mul_add(third, sine.mul_add(first, half * double.im));
        let by_sine = -triple.re.mul_add(third, cosine.mul_add(first, half * double.re));
        // The tensor ½ [(PP + QQ) constant + (PP − QQ) by_cosine + (PQ + QP) by_sine] times the axis.
        let axis = pole(frame);
        let along = |direction: &Vector3<f64>| {
            let part = axis[0].mul_add(all(direction.x), axis[1] * all(direction.y));
            axis[2].mul_add(all(direction.z), part)
        };
        let (p, q) = (along(&axes[0]), along(&axes[1]));
        let to_p = half * p.mul_add(constant + by_cosine, q * by_sine);
        let to_q = half * q.mul_add(constant - by_cosine, p * by_sine);
        let sum = p.mul_add(to_p, q * to_q);
        let scale = all(*precession);
        let mut turning = axis;
        for (c, component) in turning.iter_mut().enumerate() {
            let inside = to_p.mul_add(all(axes[0][c]), to_q * all(axes[1][c]));
            *component = scale * component.negate_mul_add(sum, inside);
        }
        (turning, all(*phase) * sum.negate_mul_add(all(3.0), constant))
    }
}
