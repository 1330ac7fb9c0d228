//! The orbit and the strength of its torque in the averaged motion.

use nalgebra::Vector3;

use crate::gravity_gradient::orbit::elliptic_orbit::EllipticOrbit;
use crate::gravity_gradient::second_order::k2::Hamiltonian;

/// The orbit and the strength of its torque, in the units of the averaged motion.
#[derive(Clone, Debug)]
pub(crate) struct AveragedOrbit {
    pub(crate) eccentricity: f64,
    pub(crate) eta_cubed: f64,
    /// n in the units of the motion.
    pub(crate) mean_motion: f64,
    /// G m/a³ over n².
    pub(crate) fraction: f64,
    pub(crate) axes: [Vector3<f64>; 3],
    /// κ_o.
    pub(crate) strength: f64,
    /// ⟨D⟩ + K2, if the averaged equations are those of second order.
    pub(crate) second: Option<Box<Hamiltonian>>,
}

impl AveragedOrbit {
    /// The averaged orbit; `delta` is Δ/M. With `second` the averaged equations are those of second order.
    pub(crate) fn new(elliptic: &EllipticOrbit<'_>, delta: f64, second: Option<Hamiltonian>) -> Self {
        let &EllipticOrbit { orbit, mean_motion, axes, .. } = elliptic;
        let (eccentricity, fraction) = (orbit.eccentricity(), orbit.disturbing_fraction());
        let eta = (1.0 - eccentricity * eccentricity).sqrt();
        let eta_cubed = eta * eta * eta;
        let strength = 3.0 * mean_motion * (delta * fraction) / eta_cubed;
        Self { eccentricity, eta_cubed, mean_motion, fraction, axes, strength, second: second.map(Box::new) }
    }

    /// dΨ/dt averaged over the orbit, for an angular momentum along an axis.
    pub(crate) fn secular(&self, axis: &Vector3<f64>) -> f64 {
        // 1 − (3/2) sin² I is computed without cancellation at I = 0.
        let sine_square = axis.cross(&self.axes[2]).norm_squared();
        self.mean_motion * self.mean_motion * (1.0 - 1.5 * sine_square) / self.eta_cubed
    }
}
