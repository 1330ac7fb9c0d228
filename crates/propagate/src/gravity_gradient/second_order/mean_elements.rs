//! The mean σ and M of second order, and the averaged Hamiltonian there.

use super::CUTOFF;
use super::k2::Hamiltonian;
use super::k2_remainder::SteadyRates;
use super::pair_harmonics::OrbitHarmonics;
use super::pair_terms::{Stand, orders};
use super::pairs::{OrbitParts, second_actions};
use super::pairs_around::{Around, OrbitPoint};
use crate::error::Error;
use crate::gravity_gradient::body::contraction::{SymmetricTensor, contraction};
use crate::gravity_gradient::body::inertia::Inertia;
use crate::gravity_gradient::first_order::corrections::Corrections;
use crate::gravity_gradient::first_order::fourier::ExactTerm;
use crate::gravity_gradient::first_order::generator::{Generator, TorqueScale};
use crate::gravity_gradient::first_order::mean_motion::MeanMotion;
use crate::gravity_gradient::first_order::mean_variables::{Mean, PeriodicChange};
use crate::gravity_gradient::orbit::derivatives::ORDERS;
use crate::gravity_gradient::orbit::elliptic_motion::When;
use crate::gravity_gradient::orbit::elliptic_orbit::Demand;
use crate::gravity_gradient::terms::term::{Term, fast_terms, slow_terms, slowest};
use crate::input::options::Level;
use crate::numerics::C64;
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::kepler::Place;
use crate::simd::lanes::Lanes;
use crate::torque_free::polhode::Polhode;
use num_complex::Complex;
/// Terms smaller than this share of the largest are left out of the changes of first order.
const FIRST_ORDER_CUTOFF: f64 = 1e-13;

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
    /// From the mean motion of first order, and the position of the disturbing body at the epoch.
    pub(crate) fn new(first: &MeanMotion, state: &Mean, start: &When<pulp::Scalar>, demand: &Demand<'_>) -> Self {
        let exact = &first.corrections[0].generator.exact;
        let mean = (&first.mean, &first.change, &exact[..]);
        let (both, steady) = epoch_means(mean, state, &first.inertia, &start.place, demand);
        Self { both, steady }
    }

    /// The mean motion with the mean M and L of a level, and their estimated errors over M.
    pub(crate) fn motion(
        &self,
        polhode: &Polhode,
        first: &MeanMotion,
        demand: &Demand<'_>,
        level: Level,
    ) -> Result<(MeanMotion, SteadyRates, [f64; 2]), Error> {
        let EpochMean { mean, momentum, left } = self.both[usize::from(level == Level::SecondOrder)];
        let inertia = first.inertia.moved(polhode, mean.p.norm_sqr(), mean.momentum);
        let corrections = vec![Corrections::new(&inertia, demand)?];
        let change = PeriodicChange { momentum, ..first.change };
        Ok((MeanMotion { mean, change, inertia, corrections }, self.steady, left))
    }
}

/// ⟨D⟩ + K2 at a mean motion.
pub(crate) fn hamiltonian(inertia: &Inertia, demand: &Demand<'_>, steady: SteadyRates) -> Hamiltonian {
    let terms = fast_terms(inertia, CUTOFF, slowest(demand));
    Hamiltonian::new(inertia, &terms, demand.strength()).with_steady(steady)
}

/// The mean states at the epoch with |p| and M from all terms of first order, and to second order, from the mean state of the corrections.
pub(crate) fn epoch_means(
    (mean, change, exact): (&Mean, &PeriodicChange, &[ExactTerm]),
    state: &Mean,
    inertia: &Inertia,
    place: &Place<pulp::Scalar>,
    demand: &Demand<'_>,
) -> ([EpochMean; 2], SteadyRates) {
    let slowest = slowest(demand);
    let (tensors, norms) = tensors(mean, place, demand);
    let stand = Stand {
        inertia,
        mean,
        strength: demand.strength(),
        tensors: &tensors,
        sizes: &demand.envelope.epoch,
        norms,
        slowest,
        orbital_step: demand.orbital_step(),
        duration: demand.duration,
        closest: demand.envelope.span[0] / demand.envelope.epoch[0],
        bend: demand.envelope.epoch[2] / demand.envelope.epoch[0],
        enough: demand.ledger.pairs
            / (demand.duration * inertia.rates.iter().map(|rate| rate.to_f64().abs()).sum::<f64>()),
    };
    let points = |places: &[(f64, f64)]| points(mean, place, demand, places);
    let harmonics = OrbitHarmonics::new(mean, place, demand);
    let mut terms = fast_terms(inertia, FIRST_ORDER_CUTOFF, slowest);
    if harmonics.is_some() {
        terms.extend(slow_terms(inertia, slowest));
    }
    let first = first_actions(&stand, &terms, harmonics.as_ref().map(|harmonics| (harmonics, exact)));
    let terms = fast_terms(inertia, CUTOFF, slowest);
    let steady = SteadyRates::new(inertia, &mean.frame, demand, (exact, &terms));
    let exact = harmonics.as_ref().map(|harmonics| split(inertia, exact, harmonics)).unwrap_or_default();
    let around = Around { eccentricity: demand.orbit.eccentricity(), mean_motion: demand.mean_motion, points: &points };
    let exact = OrbitParts { around: harmonics.is_some().then_some(around), ..exact };
    let second = second_actions(&stand, &terms, &exact);
    let turn = if mean.p == Complex::default() { Complex::new(1.0, 0.0) } else { mean.p / mean.p.norm() };
    let at = |sigma: f64, momentum: f64| Mean { p: turn * sigma.max(0.0).sqrt(), momentum, ..*mean };
    // The corrections drop terms and truncate sums. `lacking` is M of all terms less M of the corrections.
    let used = mean.momentum * 2.0 * (mean.p.conj() * change.p).re + inertia.sigma * change.momentum;
    let (lacking, lacking_action) = (first.momentum - change.momentum, first.action - used);
    let by_sigma = (lacking_action - inertia.sigma * lacking) / mean.momentum;
    let lower = EpochMean {
        mean: at(mean.p.norm_sqr() - by_sigma, mean.momentum - lacking),
        momentum: first.momentum,
        left: first.left.map(|left| left / mean.momentum),
    };
    let by_momentum = first.momentum + second.momentum;
    let momentum = state.momentum - by_momentum;
    let higher = EpochMean {
        mean: at((state.momentum * state.p.norm_sqr() - first.action - second.action) / momentum, momentum),
        momentum: by_momentum,
        left: [0, 1].map(|i| (first.left[i] + second.left[i]) / momentum),
    };
    ([lower, higher], steady)
}

/// The disturbing body at mean anomalies with weights.
pub(crate) fn points(
    mean: &Mean,
    place: &Place<pulp::Scalar>,
    demand: &Demand<'_>,
    places: &[(f64, f64)],
) -> Vec<OrbitPoint> {
    let eccentricity = demand.orbit.eccentricity();
    let epoch = place.angle.values()[0] - place.centre.values()[0];
    let generator = without_terms(mean, demand);
    let at = |&(anomaly, weight): &(f64, f64)| {
        let place = Place::of(Lanes::splat(pulp::Scalar, anomaly), eccentricity);
        OrbitPoint { anomaly: anomaly - epoch, weight, tensors: tensors_by(&generator, mean, &place) }
    };
    places.iter().map(at).collect()
}

/// The terms with exact divisors, split into harmonics.
fn split<'a>(inertia: &Inertia, exact: &[ExactTerm], harmonics: &OrbitHarmonics) -> OrbitParts<'a> {
    let split = |exact: &ExactTerm| {
        let (harmonic, multiple) = exact.numbers;
        (Term::new(inertia, harmonic, multiple), harmonics.split(multiple, &exact.divisors))
    };
    OrbitParts { terms: exact.iter().map(split).collect(), average: harmonics.average(), around: None }
}

/// The traceless part of (a/r)³ r̂r̂ in the frame of a mean state, its time derivatives, and their largest sizes.
pub(crate) fn tensors<'a>(
    mean: &Mean,
    place: &Place<pulp::Scalar>,
    demand: &Demand<'a>,
) -> ([SymmetricTensor; ORDERS], &'a [f64]) {
    (tensors_by(&without_terms(mean, demand), mean, place), &demand.envelope.orbital.norms)
}

fn tensors_by(generator: &Generator, mean: &Mean, place: &Place<pulp::Scalar>) -> [SymmetricTensor; ORDERS] {
    let frame = QuaternionLanes::all(Lanes::splat(pulp::Scalar, 0.0), &mean.frame);
    generator.tensors(frame, place).map(|deviator| {
        let [axial, across, xy, xz, yz] = deviator.map(|lanes| lanes.values()[0]);
        let transverse = -axial / 3.0;
        [transverse - 0.5 * across, transverse + 0.5 * across, -2.0 * transverse, xy, xz, yz]
    })
}

/// The orbit's part of a generating function.
fn without_terms(mean: &Mean, demand: &Demand<'_>) -> Generator {
    let [first, second, _] = demand.orbit.axes();
    let factors = TorqueScale { strength: 0.0, root: 0.0, momentum: mean.momentum };
    Generator::new(&Default::default(), Vec::new(), (demand.envelope.orbital.clone(), [first, second]), factors)
}

/// δM and δL of first order.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FirstActions {
    pub(crate) momentum: f64,
    pub(crate) action: f64,
    /// Truncation errors of both by the sums over time derivatives.
    pub(crate) left: [f64; 2],
}

pub(crate) fn first_actions(
    stand: &Stand<'_>,
    terms: &[Term],
    harmonics: Option<(&OrbitHarmonics, &[ExactTerm])>,
) -> FirstActions {
    let mut actions = FirstActions::default();
    let angle = if stand.mean.p == C64::default() { 0.0 } else { stand.mean.p.arg() };
    let root = stand.inertia.sigma.sqrt();
    for term in terms {
        let (h, m) = (f64::from(term.harmonic), f64::from(term.multiple));
        let omega = stand.mean.momentum * term.frequency[0];
        let amplitude = 2.0 * stand.strength * term.weighted()[0] * root.powi(term.harmonic.abs());
        let (sum, rest) = match harmonics {
            Some((harmonics, exact)) => {
                let exact = exact.iter().find(|other| other.numbers == (term.harmonic, term.multiple));
                (harmonics.solution(omega, term.multiple, exact), 0.0)
            }
            None => solution_by_sums(stand, omega, term.multiple),
        };
        let phase = C64::from_polar(amplitude, h * angle + m * stand.mean.longitude);
        let phase = if term.multiple == 1 { phase * -C64::i() } else { phase };
        // δM is m times the real part of −i W, and δL is h times.
        let turned = (phase * sum * -C64::i()).re;
        actions.momentum += m * turned;
        actions.action += h * turned;
        let rest = amplitude.abs() * rest;
        actions.left = [actions.left[0] + m * rest, actions.left[1] + h.abs() * rest];
    }
    actions
}

/// c_m of V by the sum over time derivatives, and the size of the first term after the sum.
fn solution_by_sums(stand: &Stand<'_>, omega: f64, multiple: i32) -> (C64, f64) {
    let orders = orders(omega, stand.sizes, 0.0);
    let mut factor = (C64::i() * omega).inv();
    let inverse = factor;
    let mut sum = C64::default();
    for tensor in stand.tensors.iter().take(orders) {
        sum += factor * contraction(tensor, multiple)[0];
        factor *= -inverse;
    }
    (sum, stand.sizes[orders] / omega.abs().powi(orders as i32 + 1))
}
