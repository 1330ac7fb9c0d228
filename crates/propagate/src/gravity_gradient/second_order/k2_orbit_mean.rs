//! ⟨D⟩ + K2 averaged over the orbit as well, in closed form.
//!
//! Let k_P, k_Q, k_N be the components of k along the pericentre, across it and along the normal, ρ = k_P² + k_Q², δ = k_P² − k_Q², and
//! ⟨D⟩ = C (a/r)³ ((k·r̂)² − ⅓). Then
//!
//! ```text
//! K̄ = C η^(−3) (½ρ − ⅓) + (C²/Mn) k_N (I_c ρ + I_1 δ) + ⟨K2⟩
//! I_c = −η^(−6) (¼ + e²/6)          I_1 = −¼ η^(−6) e²
//! ```
//!
//! The middle term is the effect of second order of the part of ⟨D⟩ that is periodic in the true anomaly f, whose mean over f is 0
//! ([`crate::gravity_gradient::second_order::k2_orbit_periodic`]). K̄ acts in the time f/n. ⟨K2⟩ has the means of (a/r)⁶ and (a/r)⁶ ḟ times powers of k·r̂. K̄ is a
//! polynomial in ρ, δ and k_N. For e = 0 it has no δ, and k precesses steadily about the normal. For e ≠ 0 it nods with twice the angle of the node.

use nalgebra::Vector3;

use super::k2::{Hamiltonian, Slopes};
use super::k2_remainder::Steady;

/// Factors of 1, ρ, δ, ρ², ρδ, δ², k_N, k_N ρ, k_N δ.
type Coefficients = [f64; 9];

/// K̄ at one mean σ and M, as a function of the angular momentum's direction.
#[derive(Clone, Debug)]
pub(crate) struct OrbitAverage {
    /// K̄, and its derivatives with respect to L and to M at fixed L.
    rows: [Coefficients; 3],
    momentum: f64,
    axes: [Vector3<f64>; 3],
    steady: Steady,
}

impl OrbitAverage {
    /// From ⟨D⟩ + K2, and the eccentricity, the mean motion and the axes of the orbit.
    pub(crate) fn new(hamiltonian: &Hamiltonian, eccentricity: f64, mean_motion: f64, axes: [Vector3<f64>; 3]) -> Self {
        let Hamiltonian { first, second, momentum, steady } = hamiltonian;
        let means = Means::new(eccentricity, mean_motion);
        let squares = hamiltonian.squares(mean_motion);
        let rows = std::array::from_fn(|row| means.coefficients(first[row], squares[row], &second[row]));
        Self { rows, momentum: *momentum, axes, steady: *steady }
    }

    /// The derivatives of the mean variables for an angular momentum along a unit vector.
    pub(crate) fn slopes(&self, axis: &Vector3<f64>) -> Slopes {
        let [p, q, n] = self.axes.map(|direction| axis.dot(&direction));
        let (rho, delta) = (p * p + q * q, p * p - q * q);
        let value = |[one, r, d, rr, rd, dd, z, zr, zd]: Coefficients| {
            one + rho * (r + rr * rho + rd * delta) + delta * (d + dd * delta) + n * (z + zr * rho + zd * delta)
        };
        let [_, r, d, rr, rd, dd, z, zr, zd] = self.rows[0];
        let by_rho = r + 2.0 * rr * rho + rd * delta + n * zr;
        let by_delta = d + rd * rho + 2.0 * dd * delta + n * zd;
        let force = self.axes[0] * (2.0 * p * (by_rho + by_delta))
            + self.axes[1] * (2.0 * q * (by_rho - by_delta))
            + self.axes[2] * (z + zr * rho + zd * delta)
            + self.steady.force;
        Slopes {
            turning: (force - axis * axis.dot(&force)) / self.momentum,
            phases: [0, 1].map(|i| value(self.rows[i + 1]) + self.steady.phases[i]),
        }
    }

    /// An upper bound of the rate at which the angular momentum turns.
    pub(crate) fn fastest(&self) -> f64 {
        let [_, r, d, rr, rd, dd, z, zr, zd] = self.rows[0].map(f64::abs);
        (2.0 * (r + d) + 4.0 * (rr + rd + dd) + z + 3.0 * (zr + zd) + self.steady.force.norm()) / self.momentum
    }
}

/// The means over one orbit.
struct Means {
    /// ⟨(a/r)³⟩.
    cube: f64,
    /// I_c and I_1.
    square: [f64; 2],
    /// ⟨(a/r)⁶⟩ times c0, c2, c4: the even cosines of the true anomaly.
    still: [f64; 3],
    /// ⟨(a/r)⁶ ḟ⟩ likewise.
    moving: [f64; 2],
}

impl Means {
    fn new(e: f64, mean_motion: f64) -> Self {
        let square = e * e;
        let eta = ((1.0 - e) * (1.0 + e)).sqrt();
        let cube = eta.powi(-3);
        let [still, moving] = [cube.powi(3), mean_motion * cube.powi(4)];
        Self {
            cube,
            square: [-cube * cube * (0.25 + square / 6.0), -0.25 * cube * cube * square],
            still: [
                still * (1.0 + square * (3.0 + 0.375 * square)),
                still * square * (1.5 + 0.25 * square),
                still * square * square / 16.0,
            ],
            moving: [
                moving * (1.0 + square * (7.5 + square * (5.625 + 0.3125 * square))),
                moving * square * (3.75 + square * (3.75 + 0.234_375 * square)),
            ],
        }
    }

    /// One row of K̄, from the factors of ⟨D⟩, of C²/Mn and of K2.
    fn coefficients(&self, first: f64, square: f64, second: &[f64; 5]) -> Coefficients {
        let [p0, p1, p2, q0, q1] = *second;
        let [c0, c2, c4] = self.still;
        let [d0, d2] = self.moving;
        [
            p0 * c0 - first * self.cube / 3.0,
            0.5 * (p1 * c0 + first * self.cube),
            0.5 * p1 * c2,
            p2 * (0.375 * c0 - 0.125 * c4),
            0.5 * p2 * c2,
            0.25 * p2 * c4,
            q0 * d0,
            square * self.square[0] + 0.5 * q1 * d0,
            square * self.square[1] + 0.5 * q1 * d2,
        ]
    }
}
