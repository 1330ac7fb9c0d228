//! The average over the rotation and the orbit, to first order in κ.

use andoyer_double::DoubleDouble;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::AveragedOrbit;
use crate::numerics::phase::Phase;
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::kepler::Place;
use crate::simd::lanes::Lanes;

/// Steady precession with the periodic part of one orbit.
#[derive(Clone, Debug)]
pub(crate) struct Precession {
    ellipse: AveragedOrbit,
    /// The mean frame at the epoch.
    frame: UnitQuaternion<f64>,
    /// Half the angle about the orbit's normal. `half_back` is half the angle about the angular momentum that keeps the frame from turning about it.
    half: Phase,
    half_back: Phase,
    /// The orbit average of dJ/dt.
    secular: f64,
    /// J of the periodic part at the epoch.
    phase: f64,
}

impl Precession {
    /// The motion from the frame at one place of the orbit, where J is 0. `unit` is the user's unit of time in units of the motion.
    pub(crate) fn new(
        ellipse: AveragedOrbit,
        frame: UnitQuaternion<f64>,
        place: &Place<pulp::Scalar>,
        unit: f64,
    ) -> Self {
        let still = Phase::new(DoubleDouble::ZERO, 0.0);
        let mut precession = Self { ellipse, frame, half: still, half_back: still, secular: 0.0, phase: 0.0 };
        let one = Lanes::splat(pulp::Scalar, 1.0);
        // The mean axis to first order, then again with the periodic part evaluated at the mean axis.
        let mut phase = one;
        for _ in 0..3 {
            let (rotation, next) = precession.periodic(QuaternionLanes::all(one, &precession.frame), place);
            let [x, y, z] = rotation.map(|lanes| -0.5 * lanes.values()[0]);
            precession.frame = UnitQuaternion::new_normalize(Quaternion::new(1.0, x, y, z)) * frame;
            phase = next;
        }
        let axis = precession.frame * Vector3::z();
        let cosine = axis.dot(&precession.ellipse.axes[2]);
        // dλ/dt = −(3/2) n² Δ cos I/(M η³): κ is 3 n Δ/(M η³).
        let precessing = -0.5 * precession.ellipse.strength * cosine * precession.ellipse.mean_motion * unit;
        precession.half = Phase::new((0.5 * precessing).into(), 0.0);
        precession.half_back = Phase::new((-0.5 * cosine * precessing).into(), 0.0);
        precession.secular = precession.ellipse.secular(&axis) * unit;
        precession.phase = phase.values()[0];
        precession
    }

    #[inline(always)]
    pub(super) fn at<S: InstructionSet>(
        &self,
        place: &Place<S>,
        elapsed: (Lanes<S>, Lanes<S>),
    ) -> (QuaternionLanes<S>, Lanes<S>) {
        let turn = QuaternionLanes::about(&self.ellipse.axes[2], self.half.sin_cos(elapsed));
        let back = QuaternionLanes::about(&Vector3::z(), self.half_back.sin_cos(elapsed));
        let mean = turn * QuaternionLanes::all(elapsed.0, &self.frame) * back;
        let ([x, y, z], phase) = self.periodic(mean, place);
        let (half, one) = (x.all(0.5), x.all(1.0));
        let frame = QuaternionLanes([half * x, half * y, half * z, one]) * mean;
        (frame.normalized(), elapsed.0.mul_add(x.all(self.secular), phase - x.all(self.phase)))
    }

    /// The periodic part of one orbit: a rotation in inertial components, and J, by the integrals of theory §9.
    #[inline(always)]
    fn periodic<S: InstructionSet>(&self, frame: QuaternionLanes<S>, place: &Place<S>) -> ([Lanes<S>; 3], Lanes<S>) {
        let AveragedOrbit { eccentricity, eta_cubed, mean_motion, axes, strength, .. } = &self.ellipse;
        let Place { centre, sine, cosine, .. } = *place;
        let all = |value: f64| sine.all(value);
        let double = ComplexLanes { re: cosine, im: sine } * ComplexLanes { re: cosine, im: sine };
        let triple = double * ComplexLanes { re: cosine, im: sine };
        let (half, first, third) = (all(0.5), all(0.5 * eccentricity), all(eccentricity / 6.0));
        let constant = sine.mul_add(all(*eccentricity), centre);
        let by_cosine = triple.im.mul_add(third, sine.mul_add(first, half * double.im));
        let by_sine = -triple.re.mul_add(third, cosine.mul_add(first, half * double.re));
        // The tensor ½ [(PP + QQ) constant + (PP − QQ) by_cosine + (PQ + QP) by_sine] times the axis.
        let rows = frame.rows();
        let axis = [rows[0][2], rows[1][2], rows[2][2]];
        let along = |direction: &Vector3<f64>| {
            let part = axis[0].mul_add(all(direction.x), axis[1] * all(direction.y));
            axis[2].mul_add(all(direction.z), part)
        };
        let (p, q) = (along(&axes[0]), along(&axes[1]));
        let to_p = half * p.mul_add(constant + by_cosine, q * by_sine);
        let to_q = half * q.mul_add(constant - by_cosine, p * by_sine);
        let sum = p.mul_add(to_p, q * to_q);
        let scale = all(*strength);
        let mut turned = [sum; 3];
        for (c, component) in turned.iter_mut().enumerate() {
            let inside = to_p.mul_add(all(axes[0][c]), to_q * all(axes[1][c]));
            *component = scale * axis[c].negate_mul_add(sum, inside);
        }
        (turned, all(mean_motion / eta_cubed) * sum.negate_mul_add(all(3.0), constant))
    }
}
