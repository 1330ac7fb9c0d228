//! The mean σ and M of second order, and the averaged Hamiltonian there.

use num_complex::Complex;

use super::hamiltonian::Hamiltonian;
use super::modes::modes;
use super::pairs::{Stand, Tensor, second_actions};
use crate::gravity_gradient::candidate::SMALLEST_RATIO;
use crate::gravity_gradient::corrections::{Change, Demand, Mean};
use crate::gravity_gradient::generator::{Generator, ORDERS, Orbital};
use crate::gravity_gradient::inertia::Inertia;
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::kepler::Place;
use crate::simd::lanes::Lanes;

/// Terms smaller than this share of the largest are left out of the sum over pairs.
const SMALLEST_PAIR: f64 = 1e-6;
/// Terms smaller than this share of the largest are left out of K2.
const SMALLEST_TERM: f64 = 1e-9;

/// The mean state of second order at the epoch.
pub(crate) struct Refined {
    pub(crate) mean: Mean,
    /// The change of M that leads to the state.
    pub(crate) momentum: f64,
    /// What is left of the mean M and L, over M.
    pub(crate) left: [f64; 2],
}

/// Twice the rate of the true anomaly at the pericentre, times the ratio below which sums over time derivatives do not converge.
pub(super) fn slowest(demand: &Demand<'_>) -> f64 {
    let eccentricity = demand.orbit.eccentricity();
    let eta_cubed = (1.0 - eccentricity * eccentricity).powf(1.5);
    SMALLEST_RATIO * 2.0 * demand.mean_motion * (1.0 + eccentricity).powi(2) / eta_cubed
}

fn strength(demand: &Demand<'_>) -> f64 {
    1.5 * demand.mean_motion * demand.mean_motion * demand.orbit.disturbing_fraction()
}

/// ⟨D⟩ + K2 at a mean motion.
pub(crate) fn hamiltonian(inertia: &Inertia, demand: &Demand<'_>, moments: [f64; 3]) -> Hamiltonian {
    Hamiltonian::new(inertia, &modes(inertia, SMALLEST_TERM, slowest(demand)), strength(demand), moments)
}

/// The mean state with |p| and M to second order: from the mean state of first order at the epoch, its change, and the sum of all terms \[rad\].
pub(crate) fn refined(
    (first, change, size): (&Mean, &Change, f64),
    state: &Mean,
    inertia: &Inertia,
    place: &Place<pulp::Scalar>,
    (demand, moments): (&Demand<'_>, [f64; 3]),
) -> Refined {
    let slowest = slowest(demand);
    let (tensors, norms) = tensors(first, place, demand);
    let stand = Stand {
        inertia,
        mean: first,
        strength: strength(demand),
        tensors: &tensors,
        norms: &norms,
        slowest,
        mean_motion: demand.mean_motion,
        duration: demand.duration,
        closest: closest(place, demand.orbit.eccentricity()),
        trace: moments.iter().sum(),
    };
    let actions = second_actions(&stand, &modes(inertia, SMALLEST_PAIR, slowest));
    let by_momentum = change.momentum + actions.momentum;
    let by_sigma = 2.0 * (first.p.conj() * change.p).re;
    let by_action = first.momentum * by_sigma + inertia.sigma * change.momentum + actions.action;
    let momentum = state.momentum - by_momentum;
    let sigma = ((state.momentum * state.p.norm_sqr() - by_action) / momentum).max(0.0);
    let turn = if first.p == Complex::default() { Complex::new(1.0, 0.0) } else { first.p / first.p.norm() };
    let pruned = actions.pruned * size * size;
    Refined {
        mean: Mean { p: turn * sigma.sqrt(), momentum, ..*first },
        momentum: by_momentum,
        left: actions.left.map(|left| left / momentum + pruned),
    }
}

/// (a/r)⁶ at the pericentre over that at a place.
fn closest(place: &Place<pulp::Scalar>, eccentricity: f64) -> f64 {
    ((1.0 + eccentricity) / (1.0 + eccentricity * place.cosine.values()[0])).powi(6)
}

/// (a/r)³ r̂r̂ in the frame of a mean state, its time derivatives, and their largest sizes.
pub(super) fn tensors(mean: &Mean, place: &Place<pulp::Scalar>, demand: &Demand<'_>) -> ([Tensor; ORDERS], Vec<f64>) {
    let [first, second, _] = demand.orbit.axes();
    let generator = Generator {
        harmonics: Default::default(),
        orbital: Orbital::new(demand.orbit.eccentricity(), demand.mean_motion),
        axes: [first, second],
        strength: 0.0,
        root: 0.0,
        momentum: mean.momentum,
    };
    let frame = QuaternionLanes::all(Lanes::splat(pulp::Scalar, 0.0), &mean.frame);
    let tensors = generator.tensors(frame, place).map(|tensor| tensor.map(|lanes| lanes.values()[0]));
    (tensors, generator.orbital.norms)
}
