//! The averaged torques of a mean motion: the drifts of the phases, and the averaged motion that follows from them.

use super::arcs::Arcs;
use super::bodies::Bodies;
use super::equations::AveragedTorque;
use super::precession::Precession;
use super::spin::Spin;
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::first_order::mean_motion::MeanMotion;
use crate::gravity_gradient::first_order::mean_variables::Mean;
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::request::Request;
use crate::gravity_gradient::second_order::k2::in_lanes;
use crate::gravity_gradient::second_order::k2_remainder::SteadyRates;
use crate::gravity_gradient::second_order::mean_elements;
use crate::gravity_gradient::terms::term::Sensitivity;
use crate::input::options::Level;
use crate::orbit::position::{Elapsed, Position};
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::torque_free::polhode::Polhode;
use nalgebra::{UnitQuaternion, Vector3};

/// The averaged torques.
pub(crate) struct Averages {
    pub(crate) torques: Vec<AveragedTorque>,
    /// Δ over M.
    delta: f64,
    /// −½ (dΔ/dσ)/M. ⟨D⟩ = −½ (dΨ/dt) Δ with the phase integral Ψ, so the derivatives of ⟨D⟩ with respect to L, and to M at
    /// fixed L, are the product of this with dΨ/dt, and with −σ dΨ/dt.
    pub(crate) slope: f64,
}

impl Averages {
    pub(crate) fn new(
        polhode: &Polhode,
        (motion, steady): (&MeanMotion, SteadyRates),
        orbits: &[Disturbance<'_>],
        level: Level,
    ) -> Self {
        let MeanMotion { mean, inertia, .. } = motion;
        let (axial, axial_slope) = level.tensor(inertia, 0, 0);
        let delta = (1.5 * axial - 0.5 * polhode.moments.iter().sum::<f64>()) / mean.momentum;
        let torques = orbits.iter().map(|disturbance| {
            let second =
                (level == Level::SecondOrder).then(|| mean_elements::hamiltonian(inertia, disturbance, steady));
            AveragedTorque::new(disturbance, delta, second)
        });
        Self { torques: torques.collect(), delta, slope: -0.5 * 1.5 * axial_slope / mean.momentum }
    }

    /// The drifts of ℓ′ and y′ for a unit of Ψ.
    pub(crate) fn per_phase(&self, inertia: &Inertia) -> [f64; 2] {
        [self.slope, -inertia.sigma * self.slope]
    }

    /// The constant rates by the part of K2 that the closed form omits.
    pub(crate) fn steady(&self) -> SteadyRates {
        self.torques[0].second.as_ref().map(|hamiltonian| hamiltonian.steady).unwrap_or_default()
    }

    /// The rates of ℓ′ and y′ in the orbit average.
    pub(crate) fn secular(&self, inertia: &Inertia, mean: &Mean) -> [f64; 2] {
        let axis = mean.frame * Vector3::z();
        if let Some(average) = self.torques[0].over_orbit() {
            let [pole] = in_lanes(Lanes::splat(pulp::Scalar, 0.0), &[axis]);
            let (_, phases) = average.mean(&pole);
            return phases.map(|rate| rate.values()[0]);
        }
        let rate = self.torques.iter().map(|torque| torque.secular(&axis)).sum::<f64>();
        [self.slope * rate, -inertia.sigma * self.slope * rate]
    }

    /// The error by the average over the orbit \[rad\]: κ_o (κ_o + 6 θ)(1 + nT), with the precession κ_o and the drift θ of the phases in one radian of the orbit. In
    /// second order nT has one more factor κ_o.
    pub(crate) fn over_orbit_error(
        &self,
        response: &Sensitivity,
        inertia: &Inertia,
        disturbance: &Disturbance<'_>,
        level: Level,
    ) -> f64 {
        let torque = &self.torques[0];
        let precession = torque.precession.abs();
        let phase = self.slope.abs() * (response.visible + inertia.sigma) * torque.phase;
        let growing = if level == Level::SecondOrder { precession } else { 1.0 };
        precession * (precession + 6.0 * phase) * (1.0 + growing * disturbance.mean_motion * disturbance.duration)
    }

    /// The averaged motion from a frame at the epoch.
    pub(crate) fn slow(
        &self,
        frame: UnitQuaternion<f64>,
        (request, by_orbit): (&Request<'_>, bool),
        orbits: &[Disturbance<'_>],
        (unit, factors): (f64, [f64; 2]),
    ) -> AveragedMotion {
        let torque = &self.torques[0];
        match (request.is_fixed(), by_orbit) {
            (false, _) => {
                let bodies = orbits.iter().map(|body| (body.path.clone(), body.strength() / 1.5 * unit));
                let bodies = Bodies { bodies: bodies.collect(), delta: self.delta };
                AveragedMotion::Bodies(Box::new(Arcs::new(bodies, &frame)))
            }
            (true, true) => {
                let place = &orbits[0].start.place;
                AveragedMotion::Orbit(Box::new(Precession::new(torque.clone(), frame, place, (unit, factors))))
            }
            (true, false) => AveragedMotion::Spin(Box::new(Spin::new(torque.clone(), frame, &orbits[0].start))),
        }
    }
}

/// The averaged motion.
#[derive(Clone, Debug)]
pub(crate) enum AveragedMotion {
    /// Averaged over the rotation only.
    Spin(Box<Spin>),
    /// Averaged over the rotation and the orbit.
    Orbit(Box<Precession>),
    /// Averaged over the rotation only, for several bodies or for orbits that precess.
    Bodies(Box<Arcs<Bodies>>),
}

impl AveragedMotion {
    /// The memory of what is solved so far, in bytes.
    pub(crate) fn memory(&self) -> usize {
        match self {
            Self::Spin(spin) => spin.memory(),
            Self::Orbit(precession) => precession.memory(),
            Self::Bodies(bodies) => bodies.memory(),
        }
    }

    /// The invariable frame at times after the epoch, and two numbers: the phase integral Ψ twice, or in second order the drifts of ℓ′ and y′. `when` is the
    /// position of the first body.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(
        &self,
        when: &Position<S>,
        elapsed: Elapsed<S>,
    ) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        match self {
            Self::Spin(spin) => spin.at(when),
            Self::Orbit(precession) => precession.at(&when.place, elapsed),
            Self::Bodies(bodies) => bodies.at(elapsed.0),
        }
    }
}
