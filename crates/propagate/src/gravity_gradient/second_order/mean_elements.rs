//! The mean σ and M of second order at the epoch, equation (4) of docs/theory-second-order.md, and the averaged Hamiltonian there.

use super::k2::Hamiltonian;
use super::k2_remainder::SteadyRates;
use super::pair_harmonics::{OrbitHarmonics, SplitTerm};
use super::pair_terms::{PairTerm, SecondOrderState};
use super::pairs::{Actions, second_actions};
use crate::error::Error;
use crate::gravity_gradient::constants::CUTOFF;
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::first_order::corrections::Corrections;
use crate::gravity_gradient::first_order::fourier::ExactTerm;
use crate::gravity_gradient::first_order::mean_motion::MeanMotion;
use crate::gravity_gradient::first_order::mean_variables::{Mean, PeriodicChange};
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::terms::term::{Term, fast_terms, slow_limit, slow_terms};
use crate::input::options::Level;
use crate::numerics::C64;
use crate::orbit::position::Position;
use crate::torque_free::polhode::Polhode;

/// A mean state at the epoch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EpochMean {
    pub(crate) mean: Mean,
    /// The change of M that leads to the state.
    pub(crate) momentum: f64,
    /// Estimated errors of the mean M and L, divided by M.
    pub(crate) left: [f64; 2],
}

/// The mean M and L from all terms, in first and in second order, with the other quantities of second order.
pub(crate) struct SecondOrderData {
    both: [EpochMean; 2],
    /// The constant rates by the part of ⟨K2⟩ that the closed form omits.
    steady: SteadyRates,
}

impl SecondOrderData {
    /// From the mean motion of first order, the state, and the position of the disturbing body at the epoch.
    pub(crate) fn new(
        first: &MeanMotion,
        state: &Mean,
        start: &Position<pulp::Scalar>,
        disturbance: &Disturbance<'_>,
    ) -> Self {
        let MeanMotion { mean, change, inertia, corrections } = first;
        let exact = &corrections[0].generator.exact[..];
        let slow_limit = slow_limit(disturbance);
        let at_epoch = SecondOrderState::new(inertia, mean, &start.place, disturbance);
        let harmonics = OrbitHarmonics::new(mean, &start.place, disturbance);
        let mut terms = fast_terms(inertia, CUTOFF * CUTOFF, slow_limit);
        if harmonics.is_some() {
            terms.extend(slow_terms(inertia, slow_limit));
        }
        let first = first_actions(&at_epoch, &terms, harmonics.as_ref().map(|harmonics| (harmonics, exact)));
        let steady =
            SteadyRates::new(inertia, mean, disturbance, (exact, &fast_terms(inertia, CUTOFF.sqrt(), slow_limit)));
        let terms = fast_terms(inertia, CUTOFF, slow_limit);
        let exact = harmonics.as_ref().map(|harmonics| split(&at_epoch, exact, harmonics)).unwrap_or_default();
        let average = harmonics.map(|harmonics| harmonics.average(&PairTerm::average(&at_epoch))).unwrap_or_default();
        let second = second_actions(&at_epoch, &terms, &exact, &average);
        let turn = if mean.p == C64::default() { C64::new(1.0, 0.0) } else { mean.p / mean.p.norm() };
        let at = |sigma: f64, momentum: f64| Mean { p: turn * sigma.max(0.0).sqrt(), momentum, ..*mean };
        // The corrections drop terms and truncate sums. `lacking` is M of all terms less M of the corrections.
        let used = mean.momentum * 2.0 * (mean.p.conj() * change.p).re + inertia.sigma * change.momentum;
        let (lacking, lacking_action) = (first.momentum - change.momentum, first.action - used);
        let by_sigma = (lacking_action - inertia.sigma * lacking) / mean.momentum;
        let lower = EpochMean {
            mean: at(mean.p.norm_sqr() - by_sigma, mean.momentum - lacking),
            momentum: first.momentum,
            left: [0, 1].map(|i| (first.left[i] + second.swung[i]) / mean.momentum),
        };
        let by_momentum = first.momentum + second.momentum;
        let momentum = state.momentum - by_momentum;
        let higher = EpochMean {
            mean: at((state.momentum * state.p.norm_sqr() - first.action - second.action) / momentum, momentum),
            momentum: by_momentum,
            left: [0, 1].map(|i| (first.left[i] + second.left[i] + second.swung[i]) / momentum),
        };
        Self { both: [lower, higher], steady }
    }

    /// The mean motion with the mean M and L of a level, and their estimated errors over M.
    pub(crate) fn motion(
        &self,
        polhode: &Polhode,
        first: &MeanMotion,
        disturbance: &Disturbance<'_>,
        level: Level,
    ) -> Result<(MeanMotion, SteadyRates, [f64; 2]), Error> {
        let EpochMean { mean, momentum, left } = self.both[usize::from(level == Level::SecondOrder)];
        let inertia = first.inertia.moved(polhode, mean.p.norm_sqr(), mean.momentum);
        let corrections = vec![Corrections::new(&inertia, disturbance)?];
        let change = PeriodicChange { momentum, ..first.change };
        Ok((MeanMotion { mean, change, inertia, corrections }, self.steady, left))
    }
}

/// ⟨D⟩ + K2 at a mean motion.
pub(crate) fn hamiltonian(inertia: &Inertia, disturbance: &Disturbance<'_>, steady: SteadyRates) -> Hamiltonian {
    let terms = fast_terms(inertia, CUTOFF, slow_limit(disturbance));
    Hamiltonian { steady, ..Hamiltonian::new(inertia, &terms, disturbance.strength()) }
}

/// The terms with exact divisors, split into harmonics.
fn split(at_epoch: &SecondOrderState<'_>, exact: &[ExactTerm], harmonics: &OrbitHarmonics) -> Vec<SplitTerm> {
    let inertia = at_epoch.inertia;
    let split = |exact: &ExactTerm| {
        let (harmonic, multiple) = exact.numbers;
        let term = Term::new(inertia, harmonic, multiple);
        let strength = term.strength(inertia.root()) * inertia.momentum;
        harmonics.split((PairTerm::of(at_epoch, &term), strength), &exact.divisors)
    };
    exact.iter().map(split).collect()
}

/// δM and δL of first order, and their truncation errors by the sums over time derivatives.
fn first_actions(
    at_epoch: &SecondOrderState<'_>,
    terms: &[Term],
    harmonics: Option<(&OrbitHarmonics, &[ExactTerm])>,
) -> Actions {
    let mut actions = Actions::default();
    for term in terms {
        let row = PairTerm::of(at_epoch, term);
        let (value, rest) = match harmonics {
            Some((harmonics, exact)) => {
                let exact = exact.iter().find(|other| other.numbers == (term.harmonic, term.multiple));
                (harmonics.solution(row.frequency[0], term.multiple, exact), 0.0)
            }
            None => row.solution(at_epoch, term.multiple),
        };
        // A term and its conjugate: δM is m times 2 Re(−iW), and δL is h times.
        let amplitude = 2.0 * row.weight * row.amplitude[0];
        let turned = (amplitude * value * -C64::i()).re;
        actions.momentum += row.multiple * turned;
        actions.action += row.harmonic * turned;
        let rest = amplitude.norm() * rest;
        actions.left = [actions.left[0] + row.multiple * rest, actions.left[1] + row.harmonic.abs() * rest];
    }
    actions
}
