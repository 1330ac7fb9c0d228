//! The averaged equations: the derivatives of the invariable frame, and of the phase integral Ψ (first order) or the drifts of ℓ′ and y′ (second order): for one body
//! on a fixed orbit, for several bodies, and averaged over the orbit.
//!
//! With the unit angular momentum k, κ_o = 3φn Δ/(M η³) and the true anomaly f of one orbit, or with time t and a sum over bodies,
//!
//! ```text
//! dk/df = κ_o (1 + e cos f) (k·r̂) (r̂ × k)        dΨ/df = (⅔Γ/(n η³)) (1 + e cos f) (1 − 3 (k·r̂)²)
//! dk/dt = Σ 2Γ (Δ/M) (a/r)³ (k·r̂) (r̂ × k)        dΨ/dt = Σ ⅔Γ (a/r)³ (1 − 3 (k·r̂)²)
//! ```
//!
//! To first order the torque adds −Δ′(σ) Ψ/(2M) to ℓ′ and σΔ′(σ) Ψ/(2M) to y′ with the phase integral Ψ. In second order the derivatives are those of ⟨D⟩ + K2 ([`Hamiltonian`], [`OverOrbit`]), and the two numbers are the drifts of ℓ′ and y′.

use nalgebra::Vector3;

use super::polynomial::{AtPoints, AveragedEquations, COLUMNS};
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::second_order::k2::{DisturberLanes, Hamiltonian, across, dot};
use crate::gravity_gradient::second_order::k2_orbit_mean::OverOrbit;
use crate::orbit::position::eta;
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// The unit angular momentum of a frame: its axis 3.
#[inline(always)]
pub(crate) fn pole<S: InstructionSet>(frame: QuaternionLanes<S>) -> [Lanes<S>; 3] {
    let rows = frame.rows();
    [rows[0][2], rows[1][2], rows[2][2]]
}

/// The derivatives of a column, from the angular velocity of the frame in inertial components and the derivatives of the two numbers.
#[inline(always)]
pub(crate) fn column_slopes<S: InstructionSet>(
    frame: QuaternionLanes<S>,
    [x, y, z]: [Lanes<S>; 3],
    [anomaly, longitude]: [Lanes<S>; 2],
) -> [Lanes<S>; COLUMNS] {
    let half = x.all(0.5);
    let [i, j, k, w] = (QuaternionLanes([x * half, y * half, z * half, x.all(0.0)]) * frame).0;
    [i, j, k, w, anomaly, longitude]
}

/// The averaged torque of one body on a fixed orbit, in the units of the averaged motion.
#[derive(Clone, Debug)]
pub(crate) struct AveragedTorque {
    pub(crate) eccentricity: f64,
    pub(crate) eta_cubed: f64,
    /// n in the units of the motion.
    pub(crate) mean_motion: f64,
    pub(crate) axes: [Vector3<f64>; 3],
    /// ⅔Γ/(n η³): dΨ/df at e = 0 for r̂ ⊥ k.
    pub(crate) phase: f64,
    /// κ_o, the precession of the angular momentum while f advances by 1 rad on a circle \[rad\].
    pub(crate) precession: f64,
    /// ⟨D⟩ + K2, if the averaged equations are those of second order.
    pub(crate) second: Option<Box<Hamiltonian>>,
}

impl AveragedTorque {
    /// The averaged torque of a body; `delta` is Δ/M. `second` is ⟨D⟩ + K2, or `None` for equations of first order.
    pub(crate) fn new(body: &Disturbance<'_>, delta: f64, second: Option<Hamiltonian>) -> Self {
        let (eccentricity, mean_motion) = (body.orbit.eccentricity(), body.mean_motion);
        let eta_cubed = eta(eccentricity).powi(3);
        let phase = body.strength() / 1.5 / (mean_motion * eta_cubed);
        let precession = 3.0 * delta * phase;
        let (axes, second) = (body.path.axes, second.map(Box::new));
        Self { eccentricity, eta_cubed, mean_motion, axes, phase, precession, second }
    }

    /// dΨ/dt averaged over the orbit, for an angular momentum along an axis.
    pub(crate) fn secular(&self, axis: &Vector3<f64>) -> f64 {
        // 1 − (3/2) sin² I is computed without cancellation at I = 0.
        let sine_square = axis.cross(&self.axes[2]).norm_squared();
        self.mean_motion * self.phase * (1.0 - 1.5 * sine_square)
    }
}

/// The averaged equations at the points of a piece of the orbit, by true anomaly.
pub(crate) struct OnPiece<'a> {
    pub(crate) torque: &'a AveragedTorque,
    pub(crate) sine: &'a AtPoints,
    pub(crate) cosine: &'a AtPoints,
}

impl AveragedEquations for OnPiece<'_> {
    #[inline(always)]
    fn at<S: InstructionSet>(&self, first: usize, frame: QuaternionLanes<S>) -> [Lanes<S>; COLUMNS] {
        let AveragedTorque { eccentricity, eta_cubed, mean_motion, axes, phase, precession, .. } = self.torque;
        let like = frame.0[0];
        let all = |value: f64| like.all(value);
        let (sine, cosine) = (like.like(&self.sine[first..]), like.like(&self.cosine[first..]));
        let mut direction = [like; 3];
        for (c, component) in direction.iter_mut().enumerate() {
            *component = cosine.mul_add(all(axes[0][c]), sine * all(axes[1][c]));
        }
        let weight = cosine.mul_add(all(*eccentricity), all(1.0));
        let axis = pole(frame);
        let along = dot(&axis, &direction);
        let (turning, phases) = match &self.torque.second {
            Some(hamiltonian) => {
                let square = weight * weight;
                let disturber = DisturberLanes {
                    direction,
                    normal: axes[2],
                    cube: square * weight * all(1.0 / (eta_cubed * eta_cubed)),
                    rate: square * all(mean_motion / eta_cubed),
                };
                let ([x, y, z], phases) = hamiltonian.slopes_at(&axis, &disturber);
                let inverse = disturber.rate.reciprocal();
                ([x * inverse, y * inverse, z * inverse], [phases[0] * inverse, phases[1] * inverse])
            }
            None => {
                let phase = weight * all(*phase) * (along * along).negate_mul_add(all(3.0), all(1.0));
                (across(direction, &axis, weight * along * all(*precession)), [phase, phase])
            }
        };
        column_slopes(frame, turning, phases)
    }
}

/// The averaged equations at the points of an arc: the components of the direction to each body, and its ⅔Γ (a/r)³.
pub(crate) struct OnArc {
    /// Δ/M.
    pub(crate) delta: f64,
    pub(crate) bodies: Vec<[AtPoints; 4]>,
}

impl AveragedEquations for OnArc {
    #[inline(always)]
    fn at<S: InstructionSet>(&self, first: usize, frame: QuaternionLanes<S>) -> [Lanes<S>; COLUMNS] {
        let axis = pole(frame);
        let all = |value: f64| axis[0].all(value);
        let (mut force, mut phase) = ([all(0.0); 3], all(0.0));
        for [x, y, z, attraction] in &self.bodies {
            let direction = [axis[0].like(&x[first..]), axis[0].like(&y[first..]), axis[0].like(&z[first..])];
            let attraction = axis[0].like(&attraction[first..]);
            let along = dot(&axis, &direction);
            let scale = attraction * along * all(3.0 * self.delta);
            for (sum, component) in force.iter_mut().zip(direction) {
                *sum = component.mul_add(scale, *sum);
            }
            phase = attraction.mul_add((along * along).negate_mul_add(all(3.0), all(1.0)), phase);
        }
        column_slopes(frame, across(force, &axis, all(1.0)), [phase; 2])
    }
}

impl AveragedEquations for OverOrbit {
    #[inline(always)]
    fn at<S: InstructionSet>(&self, _: usize, frame: QuaternionLanes<S>) -> [Lanes<S>; COLUMNS] {
        let (turning, phases) = self.mean(&pole(frame));
        column_slopes(frame, turning, phases)
    }
}
