//! Pairs of terms by the harmonics of the orbit, equation (7) of docs/theory-second-order.md: pairs that are too slow for the sums over time derivatives, and pairs with a harmonic near resonance.
//!
//! The source R of all pairs with one h and m depends on the place of the disturbing body. With R = Σ_j R_j e^(ijl), its integral is Σ_j R_j e^(ijl)/(i(Ω +
//! jn)). A harmonic with a small Ω_j has the factor 1 − e^(−Ω_j² span²/4) of [`crate::gravity_gradient::second_order::pair_harmonics`] there.

use std::f64::consts::{PI, TAU};

use super::pair_harmonics::{SplitTerm, inverse, unreturned};
use super::pair_terms::{PairTerm, SecondOrderState, tensors};
use crate::gravity_gradient::constants::{CUTOFF, MOST_POINTS, SOURCE_CHANGE, SOURCE_MARGIN};
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::terms::term::slow_limit;
use crate::numerics::C64;
use crate::orbit::hansen::at_most;
use crate::orbit::kepler::Place;
use crate::orbit::position::singularity;
use crate::simd::lanes::Lanes;
use crate::torque::contraction;

/// R of all pairs with the same h and m.
#[derive(Clone, Copy)]
pub(crate) struct PairSum {
    /// h and m.
    pub(crate) numbers: [f64; 2],
    /// Ω.
    pub(crate) frequency: f64,
    /// R and Ṙ.
    pub(crate) source: C64,
    pub(crate) change: C64,
}

impl PairSum {
    /// Adds this sum to the one in the list that has its h and m or the opposite ones.
    pub(crate) fn join(mut self, all: &mut Vec<Self>) {
        let [h, m] = self.numbers;
        if m < 0.0 || m == 0.0 && h < 0.0 {
            let Self { frequency, source, change, .. } = self;
            self = Self { numbers: [-h, -m], frequency: -frequency, source: source.conj(), change: change.conj() };
        }
        match all.iter_mut().find(|other| other.numbers == self.numbers) {
            Some(other) => {
                other.source += self.source;
                other.change += self.change;
            }
            None => all.push(self),
        }
    }

    /// Whether the harmonics of the orbit are needed, and are not too many. On a circle they are few, and better than the sum over time derivatives.
    pub(crate) fn needs(&self, state: &SecondOrderState<'_>) -> bool {
        let Disturbance { orbit, series, ledger, duration, .. } = state.disturbance;
        let slow = self.frequency.abs() <= state.slow_limit();
        let by_sum = if slow || orbit.eccentricity() == 0.0 { self.sum_error(state) } else { 0.0 };
        let [h, m] = self.numbers.map(f64::abs);
        let rates: f64 = state.inertia.rates.iter().map(|rate| rate.to_f64().abs()).sum();
        let enough = ledger.pairs * state.mean.momentum / (duration * rates);
        series.is_some()
            && h.max(m) * (self.at_resonance(state) + by_sum) > enough
            && highest(state, self.frequency).is_some()
    }

    /// An upper estimate of the part of χ by the harmonic of R nearest to resonance, which the sum over time derivatives does not contain; 0 for slow pairs,
    /// which have no such sum.
    pub(crate) fn at_resonance(&self, state: &SecondOrderState<'_>) -> f64 {
        if self.frequency.abs() <= state.slow_limit() {
            return 0.0;
        }
        let Disturbance { orbit, mean_motion, duration, .. } = state.disturbance;
        let number = (self.frequency / mean_motion).abs().round();
        let distance = (self.frequency.abs() - number * mean_motion).abs();
        let size = self.size(state) * state.closest().powi(2) * at_most(orbit.eccentricity(), number, 2);
        size * (1.0 / distance).min(*duration)
    }

    /// Size of R. R may vanish at the epoch, so its time derivative is included.
    fn size(&self, state: &SecondOrderState<'_>) -> f64 {
        let swing = if state.bend() > 0.0 { self.change.norm_sqr() / (4.0 * state.bend()) } else { 0.0 };
        (self.source.norm_sqr() + swing).sqrt()
    }

    /// The real part of −iχ by the sum over time derivatives; 0 for slow pairs, which have no such sum.
    pub(crate) fn by_sum(&self, state: &SecondOrderState<'_>) -> f64 {
        if self.frequency.abs() <= state.slow_limit() {
            return 0.0;
        }
        let inverse = (C64::i() * self.frequency).inv();
        ((self.source - self.change * inverse) * inverse * -C64::i()).re
    }

    /// Error of [`PairSum::by_sum`]: the terms of the sum from the third on; for slow pairs all of χ.
    pub(crate) fn sum_error(&self, state: &SecondOrderState<'_>) -> f64 {
        let (omega, duration, step) = (self.frequency, state.disturbance.duration, state.disturbance.orbital_step());
        // A product of two has twice the orbit's rates.
        let fastest = 2.0 * state.bend().sqrt();
        let beyond = omega.abs() - fastest;
        let distance = if beyond > 0.0 { beyond } else { (omega - step * (omega / step).round()).abs() };
        let time = if distance * duration > 1.0 { 1.0 / distance } else { duration };
        let slow = omega.abs() <= state.slow_limit();
        let share = if slow { SOURCE_MARGIN * state.closest().powi(2) } else { (fastest / omega).powi(2).min(1.0) };
        self.size(state) * share * time
    }
}

impl SecondOrderState<'_> {
    /// Frequency at and below which pairs have no sum over time derivatives.
    pub(crate) fn slow_limit(&self) -> f64 {
        slow_limit(self.disturbance)
    }

    /// Largest (a/r)³ within the span, over that at the epoch.
    fn closest(&self) -> f64 {
        self.disturbance.envelope.span[0] / self.disturbance.envelope.epoch[0]
    }

    /// Second time derivative of (a/r)³ r̂r̂ at the epoch, over it.
    fn bend(&self) -> f64 {
        self.disturbance.envelope.epoch[2] / self.disturbance.envelope.epoch[0]
    }
}

/// The highest harmonic that a pair of frequency Ω needs, if they are not too many.
fn highest(state: &SecondOrderState<'_>, omega: f64) -> Option<f64> {
    let slow = 6.0 + 4.0 / singularity(state.disturbance.orbit.eccentricity());
    let highest = slow.max((omega / state.disturbance.mean_motion).abs() + 4.0).ceil();
    (points_for(highest) <= MOST_POINTS).then_some(highest)
}

/// Number of points for so many harmonics.
fn points_for(highest: f64) -> f64 {
    2.0 * highest + 4.0
}

/// Mean anomalies and weights of points around an ellipse, even in the eccentric anomaly.
fn even(eccentricity: f64, count: f64) -> Vec<(f64, f64)> {
    let point = |k: usize| {
        let anomaly = TAU * (k as f64 + 0.5) / count - PI;
        (anomaly - eccentricity * anomaly.sin(), (1.0 - eccentricity * anomaly.cos()) / count)
    };
    (0..count as usize).map(point).collect()
}

/// The real part of −iχ of the pairs of these terms with each of these totals, its error, and |R_j| and Ω + jn of the harmonic nearest to resonance.
pub(crate) fn by_harmonics(
    state: &SecondOrderState<'_>,
    listed: &[PairTerm],
    totals: &[PairSum],
    exact: &[SplitTerm],
) -> Vec<[f64; 4]> {
    let highest = totals.iter().filter_map(|total| highest(state, total.frequency)).fold(0.0, f64::max);
    let points = even(state.disturbance.orbit.eccentricity(), points_for(highest));
    let sources = sources(state, (listed, totals), exact, &points);
    let highest = highest as i32;
    let turn = |j: i32| points.iter().map(move |(l, _)| C64::from_polar(1.0, f64::from(j) * (l - state.anomaly)));
    let steps: Vec<C64> = turn(-1).collect();
    let sum = |(total, source): (&PairSum, &Vec<C64>)| {
        let (mut sum, mut left, mut nearest) = (0.0, 0.0, [0.0, f64::INFINITY]);
        let waves = turn(highest).zip(&points).zip(source).map(|((turn, (_, weight)), value)| value * turn * weight);
        let mut waves: Vec<C64> = waves.collect();
        for j in -highest..=highest {
            let harmonic: C64 = waves.iter().sum();
            let divisor = total.frequency + f64::from(j) * state.disturbance.mean_motion;
            let part = harmonic * inverse(divisor, state.disturbance.duration);
            sum -= part.re;
            if divisor.abs() <= 0.5 * state.disturbance.mean_motion {
                nearest = [harmonic.norm(), divisor];
            }
            left += SOURCE_CHANGE * part.norm() + harmonic.norm() * unreturned(divisor, state.disturbance.duration);
            waves.iter_mut().zip(&steps).for_each(|(wave, step)| *wave *= step);
        }
        [sum, left, nearest[0], nearest[1]]
    };
    totals.iter().zip(&sources).map(sum).collect()
}

/// R of the pairs with each of these totals, at each point of the orbit.
fn sources(
    state: &SecondOrderState<'_>,
    (listed, totals): (&[PairTerm], &[PairSum]),
    exact: &[SplitTerm],
    points: &[(f64, f64)],
) -> Vec<Vec<C64>> {
    let pairs = pairs(listed, totals);
    let needed = |k: usize| pairs.iter().any(|(_, rows, _)| rows.iter().any(|row| row.div_ceil(2) == k + 1));
    let near = |term: &PairTerm| exact.iter().find(|split| split.rest.is(term)).map_or(&[][..], |split| &split.near);
    let around = |(k, term): (usize, &PairTerm)| needed(k).then(|| (term.orders_around(state), near(term)));
    // The number of derivatives of each term, and its harmonics that are terms of their own.
    let around: Vec<_> = listed.iter().enumerate().map(around).collect();
    let mut sources = vec![vec![C64::default(); points.len()]; totals.len()];
    let at_place = tensors(state.mean, state.disturbance);
    for (k, (anomaly, _)) in points.iter().enumerate() {
        let place = Place::of(Lanes::splat(pulp::Scalar, *anomaly), state.disturbance.orbit.eccentricity());
        let state = SecondOrderState { tensors: at_place(&place), ..*state };
        let elapsed = (anomaly - state.anomaly) / state.disturbance.mean_motion;
        let contracted = [0, 1, 2].map(|multiple| state.tensors.map(|tensor| contraction(&tensor, multiple)));
        let here = |(term, around): (&PairTerm, &Option<(usize, &[PairTerm])>)| {
            let contracted = &contracted[term.multiple as usize]; // 0 ≤ m ≤ 2
            let row = around.map_or(*term, |(orders, near)| term.elsewhere(&contracted[..orders], near, elapsed));
            [row, row.conjugate()]
        };
        let terms = listed.iter().zip(&around).flat_map(here);
        let rows: Vec<_> = std::iter::once(PairTerm::average(&state)).chain(terms).collect();
        for (place, pair, opposite) in &pairs {
            let [a, b] = pair.map(|row| &rows[row]);
            let source = state.bracket(a, &a.torque[0], b, &b.generator[0]);
            sources[*place][k] += if *opposite { source.conj() } else { source };
        }
    }
    sources
}

/// For each pair of terms with one of these totals or its negative: (index of the total, \[row a, row b\], whether the pair has the negative of the total). Row 0 is ⟨D⟩;
/// term k has row 2k + 1 and its conjugate row 2k + 2. Row a is ⟨D⟩ or a term.
fn pairs(listed: &[PairTerm], totals: &[PairSum]) -> Vec<(usize, [usize; 2], bool)> {
    let mut pairs = Vec::new();
    for (k, b) in listed.iter().enumerate() {
        for (row, sign) in [(2 * k + 1, 1.0), (2 * k + 2, -1.0)] {
            let mut add = |first: usize, harmonic: f64, multiple: f64| {
                let [h, m] = [harmonic + sign * b.harmonic, multiple + sign * b.multiple];
                let place = totals.iter().position(|total| total.numbers == [h, m] || total.numbers == [-h, -m]);
                pairs.extend(place.map(|place| (place, [first, row], totals[place].numbers != [h, m])));
            };
            for (i, a) in listed.iter().enumerate().filter(|(_, a)| a.size * b.size >= CUTOFF) {
                add(2 * i + 1, a.harmonic, a.multiple);
            }
            if sign == 1.0 {
                add(0, 0.0, 0.0);
            }
        }
    }
    pairs
}
