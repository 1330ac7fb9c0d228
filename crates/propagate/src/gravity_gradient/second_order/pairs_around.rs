//! Pairs of terms by the harmonics of the orbit: pairs that are too slow for the sums over time derivatives, and pairs with a harmonic near resonance.
//!
//! The source S of all pairs with one h and m depends on the place of the disturbing body. With S = Σ_j S_j e^(ijl), its integral is Σ_j S_j e^(ijl)/(i(Ω +
//! jn)). A harmonic with a small x = Ω + jn has the factor 1 − e^(−x²T²/4) of [`crate::gravity_gradient::second_order::pair_harmonics`] there.

use std::f64::consts::{PI, TAU};

use super::CUTOFF;
use super::pair_harmonics::{Near, Parts, Split, inverse, unreturned};
use super::pair_terms::{PairTerm, Stand};
use crate::gravity_gradient::body::contraction::{SymmetricTensor, contraction};
use crate::gravity_gradient::orbit::derivatives::ORDERS;
use crate::gravity_gradient::orbit::hansen::{at_most, decay};
use crate::gravity_gradient::terms::term::Term;
use crate::numerics::C64;

/// Most points around an orbit; more are needed from an eccentricity of 0.77 on, and for a harmonic above 60.
const MOST_POINTS: f64 = 128.0;

/// Relative error of a sum around the orbit: S changes within the span.
const SOURCE_CHANGE: f64 = 0.02;

/// The disturbing body at one place of its orbit.
pub(crate) struct OrbitPoint {
    /// l less l at the epoch.
    pub(crate) anomaly: f64,
    pub(crate) weight: f64,
    pub(crate) tensors: [SymmetricTensor; ORDERS],
}

/// The disturbing body at mean anomalies with weights.
pub(crate) type Points<'a> = dyn Fn(&[(f64, f64)]) -> Vec<OrbitPoint> + 'a;

/// An orbit, and the disturbing body on it.
#[derive(Clone, Copy)]
pub(crate) struct Around<'a> {
    pub(crate) eccentricity: f64,
    pub(crate) mean_motion: f64,
    pub(crate) points: &'a Points<'a>,
}

/// h and m of a pair together, and their frequency Ω.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Total {
    pub(crate) numbers: [f64; 2],
    pub(crate) frequency: f64,
}

impl Around<'_> {
    /// The highest harmonic that a pair needs, if they are not too many.
    pub(crate) fn highest(&self, total: &Total) -> Option<f64> {
        let slow = 6.0 + 4.0 / decay(self.eccentricity);
        let highest = slow.max((total.frequency / self.mean_motion).abs() + 4.0).ceil();
        (points_for(highest) <= MOST_POINTS).then_some(highest)
    }

    /// An upper estimate of the harmonic nearest to resonance in a product of so many factors (a/r)³, over the product at the pericentre, and its distance from
    /// resonance.
    pub(crate) fn nearest(&self, frequency: f64) -> [f64; 2] {
        let number = (frequency / self.mean_motion).abs().round();
        [at_most(self.eccentricity, number, 2), (frequency.abs() - number * self.mean_motion).abs()]
    }
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

/// A term of these pairs, around the orbit.
struct TermAround<'a> {
    row: PairTerm,
    /// m.
    multiple: usize,
    /// The number of derivatives in its sum.
    orders: usize,
    /// The harmonics of the orbit in it that are terms of their own.
    near: &'a [Near],
}

/// A pair of terms, by their places in the list; the first may be ⟨D⟩.
struct TermPair {
    /// Index of their total in `totals`.
    place: usize,
    terms: [Option<usize>; 2],
    /// Whether the second has the opposite h and m.
    conjugated: bool,
    /// Whether the sum of both has the opposite h and m of that total.
    opposite: bool,
}

/// The changes of M and L by the pairs of these terms that have one of these totals, and their errors. A term comes with its relative size.
pub(crate) fn actions(
    stand: &Stand<'_>,
    listed: &[(Term, f64)],
    totals: &[Total],
    (around, exact): (&Around<'_>, &[(Term, Split)]),
) -> [[f64; 2]; 2] {
    let highest = totals.iter().filter_map(|total| around.highest(total)).fold(0.0, f64::max);
    let points = (around.points)(&even(around.eccentricity, points_for(highest)));
    let sources = sources(stand, (listed, totals), (around, exact), &points);
    let highest = highest as i32;
    let turn = |j: i32| points.iter().map(move |point| C64::from_polar(1.0, f64::from(j) * point.anomaly));
    let steps: Vec<C64> = turn(-1).collect();
    let mut actions = [[0.0; 2]; 2];
    for (Total { numbers: [h, m], frequency }, source) in totals.iter().zip(&sources) {
        let (mut sum, mut left) = (C64::default(), 0.0);
        let waves = turn(highest).zip(&points).zip(source).map(|((turn, point), value)| value * turn * point.weight);
        let mut waves: Vec<C64> = waves.collect();
        for j in -highest..=highest {
            let harmonic: C64 = waves.iter().sum();
            let divisor = frequency + f64::from(j) * around.mean_motion;
            let part = harmonic * inverse(divisor, stand.duration);
            sum += part;
            left += SOURCE_CHANGE * part.norm() + harmonic.norm() * unreturned(divisor, stand.duration);
            waves.iter_mut().zip(&steps).for_each(|(wave, step)| *wave *= step);
        }
        // With X = Σ_j S_j/(Ω + jn), M changes by −m Re X and L by −h Re X.
        for (i, number) in [*m, *h].into_iter().enumerate() {
            actions[0][i] -= number * sum.re;
            actions[1][i] += number.abs() * left;
        }
    }
    actions
}

/// S of the pairs with each of these totals, at each point of the orbit.
fn sources(
    stand: &Stand<'_>,
    (listed, totals): (&[(Term, f64)], &[Total]),
    (around, exact): (&Around<'_>, &[(Term, Split)]),
    points: &[OrbitPoint],
) -> Vec<Vec<C64>> {
    let pairs = pairs(listed, totals);
    let needed = |k: usize| pairs.iter().any(|pair| pair.terms.contains(&Some(k)));
    let near = |term: &Term| exact.iter().find(|(other, _)| term.is(other)).map_or(&[][..], |(_, split)| &split.near);
    let around_orbit = |term: &Term| {
        let row = PairTerm::of(stand, term, Parts::default());
        TermAround { row, multiple: term.multiple as usize, orders: row.orders_around(stand), near: near(term) } // 0 ≤ m ≤ 2
    };
    let terms: Vec<_> = listed.iter().enumerate().map(|(k, (term, _))| needed(k).then(|| around_orbit(term))).collect();
    let mut sources = vec![vec![C64::default(); points.len()]; totals.len()];
    for (k, point) in points.iter().enumerate() {
        let stand = Stand { tensors: &point.tensors, ..*stand };
        let elapsed = point.anomaly / around.mean_motion;
        let contracted = [0, 1, 2].map(|multiple| point.tensors.map(|tensor| contraction(&tensor, multiple)));
        let here = |TermAround { row, multiple, orders, near }: &TermAround<'_>| {
            row.elsewhere(&contracted[*multiple][..*orders], near, elapsed)
        };
        let rows: Vec<Option<[PairTerm; 2]>> =
            terms.iter().map(|term| term.as_ref().map(here).map(|row| [row, row.conjugate()])).collect();
        let average = [PairTerm::average(&stand); 2];
        let both = |place: Option<usize>| place.and_then(|place| rows[place].as_ref()).unwrap_or(&average);
        for pair in &pairs {
            let [[a, _], b] = pair.terms.map(both);
            let source = stand.source(a, &b[usize::from(pair.conjugated)]);
            sources[pair.place][k] += if pair.opposite { source.conj() } else { source };
        }
    }
    sources
}

/// The pairs of these terms that have one of these totals, or its opposite.
fn pairs(listed: &[(Term, f64)], totals: &[Total]) -> Vec<TermPair> {
    let mut pairs = Vec::new();
    for (i, (a, size)) in listed.iter().enumerate() {
        for (k, (b, other)) in listed.iter().enumerate() {
            for conjugated in [false, true] {
                let sign = if conjugated { -1 } else { 1 };
                let [h, m] = [a.harmonic + sign * b.harmonic, a.multiple + sign * b.multiple].map(f64::from);
                let place = totals.iter().position(|total| total.numbers == [h, m] || total.numbers == [-h, -m]);
                if let Some(place) = place.filter(|_| size * other >= CUTOFF) {
                    let opposite = totals[place].numbers != [h, m];
                    pairs.push(TermPair { place, terms: [Some(i), Some(k)], conjugated, opposite });
                }
            }
        }
    }
    for (k, (b, _)) in listed.iter().enumerate() {
        let numbers = [b.harmonic, b.multiple].map(f64::from);
        if let Some(place) = totals.iter().position(|total| total.numbers == numbers) {
            pairs.push(TermPair { place, terms: [None, Some(k)], conjugated: false, opposite: false });
        }
    }
    pairs
}
