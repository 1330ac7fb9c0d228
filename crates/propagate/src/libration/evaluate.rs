//! Attitude and rates of a libration, at several times at once.
//!
//! ψ, θ, φ and their momenta are sums of harmonics of the proper angles, of M and of α ([`super::waves`]); the longitude and the pole have different ones. The frame turns
//! with (r M + ψ₀ + ψ)/2, as a phase in double-double, and with the node.

use std::any::Any;
use std::f64::consts::TAU;

use andoyer_double::DoubleDouble;
use pulp::Arch;

use super::course::MOST_POWERS;
use super::solution::Libration;
use super::waves::{PHASES, Waves, inner_phase, outer_phases};
use crate::motion::forced::Forced;
use crate::motion::solved::Motion;
use crate::motion::trajectory::Trajectory;
use crate::numerics::phase::Phase;
use crate::simd::circles::{Evaluate, Instants};
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::halt::Halt;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::simd::run::Run;
use crate::simd::sincos::sin_cos_of_turns;
use crate::simd::unit_powers::UnitPowers;

/// Multiples that take no loop.
const FEW: usize = 9;

/// The constants from which a libration is evaluated.
#[derive(Clone, Debug)]
pub(crate) struct LibrationEvaluator {
    pub(crate) libration: Libration,
    /// The three proper angles, M and α: the outer ones first, then the inner one.
    phases: [Phase; PHASES],
    /// Number of powers of each phase, 0 among them.
    powers: [usize; PHASES],
    /// ψ, p_ψ.
    longitude: Waves<2>,
    /// θ, φ, p_θ, p_φ.
    pole: Waves<4>,
    /// (r M + ψ₀)/2, or α/2 if the orbit precesses.
    half_turn: Phase,
    half_node: Option<Phase>,
    spin: f64,
    /// From the frame to inertial components, or to those that turn with the node, and from the body's axes to the sorted ones.
    plane: [f64; 4],
    sorting: [f64; 4],
    /// n/A, n/B, n/C with C = 1.
    rates: [f64; 3],
    /// Rows of the rotation from sorted to body components.
    body: [[f64; 3]; 3],
}

impl LibrationEvaluator {
    pub(crate) fn new(libration: Libration) -> Self {
        let Libration { lock, course, .. } = &libration;
        let n = DoubleDouble::from(lock.mean_motion);
        let proper = |mode: usize| Phase::new(n * course.frequencies[mode].into(), course.angles[mode]);
        let harmonics = &course.harmonics;
        let most = |phase: usize| harmonics.iter().map(|one| one.multiples[phase].unsigned_abs()).max().unwrap_or(0);
        let body = lock.body.to_rotation_matrix();
        let all = [proper(0), proper(1), proper(2), lock.phases[0], lock.phases[1]];
        let inner = inner_phase(harmonics);
        let [a, b, c, d] = outer_phases(inner);
        let order = [a, b, c, d, inner];
        Self {
            phases: order.map(|phase| all[phase]),
            powers: order.map(|phase| most(phase) as usize + 1),
            longitude: Waves::new(harmonics, [0, 1], inner),
            pole: Waves::new(harmonics, [2, 4, 3, 5], inner),
            half_turn: lock.half_turn,
            half_node: lock.half_node,
            spin: lock.shape.precession.spin,
            plane: lock.plane.coords.into(),
            sorting: lock.body.inverse().coords.into(),
            rates: lock.shape.moments.map(|moment| lock.mean_motion / moment),
            body: [0, 1, 2].map(|row| [0, 1, 2].map(|column| body[(row, column)])),
            libration,
        }
    }

    /// The attitude from sines and cosines of half the angles.
    #[inline(always)]
    fn attitude<S: InstructionSet>(
        &self,
        elapsed: (Lanes<S>, Lanes<S>),
        (sin_psi, cos_psi): (Lanes<S>, Lanes<S>),
        (sin_theta, cos_theta): (Lanes<S>, Lanes<S>),
        (sin_phi, cos_phi): (Lanes<S>, Lanes<S>),
    ) -> [Lanes<S>; 4] {
        // Rz(ψ) Ry(θ) Rx(φ)
        let seen = QuaternionLanes([
            cos_psi * cos_theta * sin_phi - sin_psi * sin_theta * cos_phi,
            cos_psi * sin_theta * cos_phi + sin_psi * cos_theta * sin_phi,
            sin_psi * cos_theta * cos_phi - cos_psi * sin_theta * sin_phi,
            cos_psi * cos_theta * cos_phi + sin_psi * sin_theta * sin_phi,
        ]);
        let plane = QuaternionLanes(Lanes::splats(elapsed.0.simd(), self.plane));
        let sorting = QuaternionLanes(Lanes::splats(elapsed.0.simd(), self.sorting));
        let attitude = plane * seen * sorting;
        match &self.half_node {
            None => attitude.0,
            Some(node) => {
                let (sine, cosine) = node.sin_cos(elapsed);
                let [x, y, z, w] = attitude.0;
                [
                    sine.negate_mul_add(y, cosine * x),
                    sine.mul_add(x, cosine * y),
                    sine.mul_add(w, cosine * z),
                    sine.negate_mul_add(z, cosine * w),
                ]
            }
        }
    }

    /// The angular velocity from the momenta and from sines and cosines of half the angles.
    #[inline(always)]
    fn rates<S: InstructionSet>(
        &self,
        [p_psi, p_theta, p_phi]: [Lanes<S>; 3],
        (sin_theta, cos_theta): (Lanes<S>, Lanes<S>),
        (sin_phi, cos_phi): (Lanes<S>, Lanes<S>),
    ) -> [Lanes<S>; 3] {
        let one = p_psi.all(1.0);
        let [sin_theta, cos_theta, sin_phi, cos_phi] = [
            (sin_theta + sin_theta) * cos_theta,
            one - (sin_theta + sin_theta) * sin_theta,
            (sin_phi + sin_phi) * cos_phi,
            one - (sin_phi + sin_phi) * sin_phi,
        ];
        let along = p_phi.mul_add(sin_theta, p_psi + one.all(self.spin)) / cos_theta;
        let momenta =
            [p_phi, along.mul_add(sin_phi, p_theta * cos_phi), p_theta.negate_mul_add(sin_phi, along * cos_phi)];
        let mut sorted = momenta;
        for (rate, factor) in sorted.iter_mut().zip(self.rates) {
            *rate = *rate * one.all(factor);
        }
        let mut rates = momenta;
        for (rate, row) in rates.iter_mut().zip(self.body) {
            let [x, y, z] = Lanes::splats(one.simd(), row);
            *rate = z.mul_add(sorted[2], y.mul_add(sorted[1], x * sorted[0]));
        }
        rates
    }

    /// e^{iφ} of the phase of a place, or 1 where no harmonic has it.
    #[inline(always)]
    fn circle<S: InstructionSet>(&self, place: usize, elapsed: (Lanes<S>, Lanes<S>)) -> ComplexLanes<S> {
        if self.powers[place] == 1 {
            return ComplexLanes { re: elapsed.0.all(1.0), im: elapsed.0.all(0.0) };
        }
        let (sine, cosine) = self.phases[place].sin_cos(elapsed);
        ComplexLanes { re: cosine, im: sine }
    }

    /// ψ, p_ψ and θ, φ, p_θ, p_φ.
    #[inline(always)]
    fn variables<S: InstructionSet, const RATES: bool>(
        &self,
        elapsed: (Lanes<S>, Lanes<S>),
    ) -> ([Lanes<S>; 2], [Lanes<S>; 4]) {
        let zero = elapsed.0.all(0.0);
        let one = ComplexLanes { re: zero.all(1.0), im: zero };
        // Each by itself: an array of them would be copied.
        let mut first = UnitPowers::<S, FEW, MOST_POWERS>::new(one);
        let mut second = UnitPowers::<S, FEW, MOST_POWERS>::new(one);
        let mut third = UnitPowers::<S, FEW, MOST_POWERS>::new(one);
        let mut fourth = UnitPowers::<S, FEW, MOST_POWERS>::new(one);
        let mut fifth = UnitPowers::<S, FEW, MOST_POWERS>::new(one);
        let outer = [
            first.of(self.circle(0, elapsed), self.powers[0]),
            second.of(self.circle(1, elapsed), self.powers[1]),
            third.of(self.circle(2, elapsed), self.powers[2]),
            fourth.of(self.circle(3, elapsed), self.powers[3]),
        ];
        let inner = fifth.of(self.circle(4, elapsed), self.powers[4]);
        if RATES {
            return (self.longitude.sums::<S, 2>(outer, inner, zero), self.pole.sums::<S, 4>(outer, inner, zero));
        }
        let [psi] = self.longitude.sums::<S, 1>(outer, inner, zero);
        let [theta, phi] = self.pole.sums::<S, 2>(outer, inner, zero);
        ([psi, zero], [theta, phi, zero, zero])
    }
}

impl Evaluate for LibrationEvaluator {
    const BY_CIRCLES: bool = false;

    #[inline(always)]
    fn evaluate<S: InstructionSet, const ATTITUDE: bool, const RATES: bool>(
        &self,
        _: S,
        at: impl Instants<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]) {
        let elapsed = at.elapsed();
        let zero = elapsed.0.all(0.0);
        let ([psi, p_psi], [theta, phi, p_theta, p_phi]) = self.variables::<S, RATES>(elapsed);
        let half = zero.all(0.5 / TAU);
        let (theta, phi) = (sin_cos_of_turns(theta * half), sin_cos_of_turns(phi * half));
        let mut attitude = [zero; 4];
        if ATTITUDE {
            attitude = self.attitude(elapsed, self.half_turn.sin_cos_beyond(elapsed, psi * half), theta, phi);
        }
        let mut rates = [zero; 3];
        if RATES {
            rates = self.rates([p_psi, p_theta, p_phi], theta, phi);
        }
        (attitude, rates)
    }
}

impl Forced for LibrationEvaluator {
    fn name(&self) -> &'static str {
        "a libration"
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn memory(&self) -> usize {
        let harmonics = self.libration.harmonics() * self.libration.memory_of_a_harmonic();
        size_of::<Self>() + self.longitude.memory() + self.pole.memory() + harmonics
    }

    fn fill(&self, arch: Arch, run: Run<'_>) -> Result<(), Halt> {
        run.in_lanes(arch, self)
    }
}

impl Motion {
    /// The proper modes and the terms of a libration; `None` for other methods.
    pub fn libration(&self) -> Option<&Libration> {
        let Trajectory::Forced(motion) = &self.trajectory else { return None };
        motion.as_any().downcast_ref::<LibrationEvaluator>().map(|evaluator| &evaluator.libration)
    }
}
