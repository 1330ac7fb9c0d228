//! Pairs of terms that are slower than the sums over time derivatives allow, by the harmonics of the orbit.
//!
//! The source S of all pairs with one h and m is a function of the disturbing body's place. With S = Σ_j S_j e^(ijl), what it does is Σ_j S_j e^(ijl)/(i(Ω + jn)).
//! A harmonic that does not return within the span has a part of it only (`harmonics`).

use std::f64::consts::{PI, TAU};

use num_complex::Complex;

use super::harmonics::inverse;
use super::modes::Mode;
use super::pairs::{Row, Stand};
use crate::gravity_gradient::contraction::Tensor;
use crate::gravity_gradient::generator::ORDERS;

type C64 = Complex<f64>;

/// Most points around an orbit; more are needed from an eccentricity of 0.74 on.
const MOST_POINTS: f64 = 128.0;
/// What the points leave of a sum, over it.
const LEFT: f64 = 0.05;
/// Pairs whose sizes, over the largest, have a smaller product are left out.
const SMALLEST_PRODUCT: f64 = 1e-6;

/// The disturbing body at one point of its orbit.
pub(super) struct Point {
    /// l less l at the epoch.
    pub(super) anomaly: f64,
    pub(super) weight: f64,
    pub(super) tensors: [Tensor; ORDERS],
}

/// Mean anomalies and weights of points around an ellipse, even in the eccentric anomaly, if there are not too many.
pub(super) fn points(eccentricity: f64) -> Option<impl Iterator<Item = (f64, f64)>> {
    let count = 2.0 * highest(eccentricity)? + 8.0;
    let point = move |k: usize| {
        let anomaly = TAU * (k as f64 + 0.5) / count - PI;
        (anomaly - eccentricity * anomaly.sin(), (1.0 - eccentricity * anomaly.cos()) / count)
    };
    (count <= MOST_POINTS).then(|| (0..count as usize).map(point))
}

/// The highest harmonic.
fn highest(eccentricity: f64) -> Option<f64> {
    if eccentricity == 0.0 {
        return Some(4.0);
    }
    let eta = ((1.0 - eccentricity) * (1.0 + eccentricity)).sqrt();
    Some((8.0 + 6.0 / ((1.0 / eccentricity).acosh() - eta)).ceil())
}

/// A pair of terms, by their places in the list.
struct Pair {
    /// Which h and m they have together.
    place: usize,
    terms: [usize; 2],
    /// Whether the second has the opposite h and m.
    conjugated: bool,
    /// Whether both together have the opposite ones.
    opposite: bool,
}

/// The changes of M and L by the pairs of these terms with each h and m together, and what is left of them.
pub(super) fn actions(
    stand: &Stand<'_>,
    modes: &[(Mode, f64)],
    numbers: &[([f64; 2], f64)],
    (points, eccentricity, mean_motion): (&[Point], f64, f64),
) -> [[f64; 2]; 2] {
    let pairs = pairs(modes, numbers);
    let mut sources = vec![vec![C64::default(); points.len()]; numbers.len()];
    for (k, point) in points.iter().enumerate() {
        let stand = Stand { tensors: &point.tensors, ..*stand };
        let mut rows: Vec<Option<[Row; 2]>> = vec![None; modes.len()];
        for pair in &pairs {
            let [a, b] = pair.terms.map(|place| {
                *rows[place].get_or_insert_with(|| {
                    let row = Row::new(&stand, &modes[place].0);
                    [row, row.conjugate()]
                })
            });
            let source = stand.source(&a[0], &b[usize::from(pair.conjugated)]);
            sources[pair.place][k] += if pair.opposite { source.conj() } else { source };
        }
    }
    let highest = highest(eccentricity).unwrap_or(0.0) as i32;
    let mut actions = [[0.0; 2]; 2];
    for ((numbers, frequency), source) in numbers.iter().zip(&sources) {
        let [h, m] = *numbers;
        let (mut sum, mut size, mut still) = (C64::default(), 0.0, 0.0);
        for j in -highest..=highest {
            let turned = points
                .iter()
                .zip(source)
                .map(|(point, value)| value * C64::from_polar(point.weight, -f64::from(j) * point.anomaly));
            let harmonic: C64 = turned.sum();
            let divisor = frequency + f64::from(j) * mean_motion;
            let part = harmonic * inverse(divisor, stand.duration);
            let turn = 0.5 * divisor * stand.duration;
            sum += part;
            size += part.norm();
            still += harmonic.norm() * stand.duration * (-turn * turn).exp();
        }
        // −i/2 times m or h times S/(iΩ), twice its real part.
        let left = LEFT * size + still;
        for (i, number) in [m, h].into_iter().enumerate() {
            actions[0][i] -= number * sum.re;
            actions[1][i] += number.abs() * left;
        }
    }
    actions
}

/// The pairs of these terms that have one of these h and m together.
fn pairs(modes: &[(Mode, f64)], numbers: &[([f64; 2], f64)]) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for (i, (a, size)) in modes.iter().enumerate() {
        for (k, (b, other)) in modes.iter().enumerate() {
            for conjugated in [false, true] {
                let sign = if conjugated { -1 } else { 1 };
                let [h, m] = [a.harmonic + sign * b.harmonic, a.multiple + sign * b.multiple].map(f64::from);
                let place = numbers.iter().position(|(both, _)| *both == [h, m] || *both == [-h, -m]);
                if let Some(place) = place.filter(|_| size * other >= SMALLEST_PRODUCT) {
                    let opposite = numbers[place].0 != [h, m];
                    pairs.push(Pair { place, terms: [i, k], conjugated, opposite });
                }
            }
        }
    }
    pairs
}
