//! The gravity gradient to second order in the torque (theory §9): the averaged Hamiltonian K2 in closed form, and the mean σ and M at the epoch by a sum over
//! pairs of terms.
//!
//! Both parts are needed together: the rates of ℓ′ and y′ turn an error of second order in the mean σ or M into a drift of the size of K2's.
//! Short-period corrections stay those of first order.

mod actions;
mod around;
pub(super) mod epoch;
pub(crate) mod hamiltonian;
pub(super) mod harmonics;
mod modes;
pub(crate) mod orbit_periodic;
pub(crate) mod over_orbit;
mod pairs;
mod rows;
pub(super) mod steady;
#[cfg(test)]
mod tests;
mod totals;
