//! The gravity gradient to second order in the torque (theory §9): the averaged Hamiltonian K2 in closed form, and the mean σ and M at the epoch by a sum over
//! pairs of terms.
//!
//! Both parts are needed together: the rates of ℓ′ and y′ turn an error of second order in the mean σ or M into a drift of the size of K2's.
//! Short-period corrections stay those of first order. The bounded change of second order that is left is computed for the error bound alone
//! ([`short_period`]).

use super::corrections::Demand;
use super::inertia::Inertia;

mod actions;
mod around;
pub(super) mod drift;
pub(super) mod epoch;
pub(crate) mod hamiltonian;
pub(super) mod harmonics;
mod jet;
mod modes;
pub(crate) mod orbit_periodic;
pub(crate) mod over_orbit;
mod pairs;
mod rows;
pub(super) mod short_period;
pub(super) mod steady;
#[cfg(test)]
mod tests;
mod totals;

/// Terms smaller than this share of the largest have no weight in [`cut`].
const WEIGHT_CUTOFF: f64 = 1e-6;

/// The part of the drifts of second order that K2 to first order in n/Ω lacks: (fastest/Ω)², each term by its weight in K2.
pub(super) fn cut(inertia: &Inertia, demand: &Demand<'_>) -> f64 {
    let slowest = modes::slowest(demand);
    let fastest = demand.envelope.fastest;
    let root = inertia.sigma.sqrt().max(modes::ROOT_FLOOR);
    let (mut sum, mut whole) = (0.0, f64::MIN_POSITIVE);
    for mode in modes::modes(inertia, WEIGHT_CUTOFF, slowest) {
        let omega = mode.frequency[0].abs() * inertia.momentum;
        let weight = mode.size(root).powi(2) * omega;
        sum += weight * (fastest / omega).powi(2);
        whole += weight;
    }
    sum / whole
}
