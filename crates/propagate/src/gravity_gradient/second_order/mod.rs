//! The gravity gradient to second order in the torque (theory §9): the averaged Hamiltonian K2 in closed form, and the mean σ and M at the epoch by a sum over
//! pairs of terms.
//!
//! Both parts are needed together: through the rates of ℓ′ and y′, an error of second order in the mean σ or M makes a drift as large as that by K2.
//! The short-period corrections are those of first order.

pub(crate) mod k2;
pub(crate) mod k2_orbit_mean;
pub(crate) mod k2_remainder;
mod k2_slow_pairs;
pub(crate) mod mean_elements;
mod pair_harmonics;
mod pair_terms;
mod pairs;
mod pairs_around;
#[cfg(test)]
mod tests;
