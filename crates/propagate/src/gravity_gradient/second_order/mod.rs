//! The gravity gradient to second order in the torque (theory §9): the averaged Hamiltonian K2 in closed form, and the mean σ and M at the epoch by a sum over
//! pairs of terms.
//!
//! Both parts are needed together: the rates of ℓ′ and y′ turn an error of second order in the mean σ or M into a drift of the size of K2's.
//! Short-period corrections stay those of first order.

pub(crate) mod k2;
pub(crate) mod k2_orbit_mean;
pub(crate) mod k2_remainder;
pub(crate) mod mean_elements;
mod pair_harmonics;
mod pair_terms;
mod pairs;
mod pairs_around;
#[cfg(test)]
mod tests;

/// Terms, pairs and harmonics whose share of the largest, or of the sum, is smaller are left out of second order.
pub(crate) const CUTOFF: f64 = 1e-6;
