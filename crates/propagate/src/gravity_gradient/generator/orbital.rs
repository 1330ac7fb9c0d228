//! Time derivatives of the orbit's functions in the torque, as Fourier polynomials in the true anomaly.

use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::simd::unit_powers::UnitPowers;

/// Number of functions in G: g and its time derivatives.
pub(crate) const ORDERS: usize = 7;
/// Highest multiple of f in the last derivative.
pub(crate) const WIDTH: usize = 5 + 2 * (ORDERS - 1);

/// The powers of e^(if). Most scenes do with few.
pub(super) type Circle<S> = UnitPowers<S, 10, { WIDTH + 1 }>;

/// Time derivatives of (a/r)³ times 1, cos 2f and sin 2f. Even derivatives of the first two and odd derivatives of the third are series in cos kf. The others
/// are series in sin kf.
#[derive(Clone, Debug)]
pub(crate) struct Orbital {
    rows: Vec<Row>,
    /// Coefficients of the three functions, row after row.
    coefficients: Vec<[f64; 3]>,
    /// Number of multiples of f, from 0, in the derivatives.
    multiples: usize,
    /// Rate of the node about inertial axis 3.
    pub(super) node_rate: f64,
    /// Largest sum of the coefficients' magnitudes, by j.
    pub(crate) norms: Vec<f64>,
}

/// The first k of a derivative, and where its coefficients are.
#[derive(Clone, Copy, Debug)]
struct Row {
    first: usize,
    start: usize,
    end: usize,
}

impl Orbital {
    /// The derivatives that G needs, and one more, for a mean motion n: d/dt = n η^(−3) w² d/df with w = 1 + e cos f.
    pub(crate) fn new(eccentricity: f64, mean_motion: f64) -> Self {
        Self::precessing(eccentricity, mean_motion, [0.0; 2])
    }

    /// The same on an orbit whose node and pericentre precess with these rates. With the pericentre's rate ω̇, the derivatives of (a/r)³ e^(2i(f+ω)), times
    /// e^(−2iω), are those of (d/dt + 2iω̇)^j; the rate of the node enters at the evaluation.
    pub(crate) fn precessing(eccentricity: f64, mean_motion: f64, [node_rate, pericentre_rate]: [f64; 2]) -> Self {
        let fixed = derivatives(eccentricity, mean_motion);
        let turned: Vec<_> = (0..=ORDERS).map(|j| with_turning(&fixed, 2.0 * pericentre_rate, j)).collect();
        let sizes: Vec<f64> = turned
            .iter()
            .map(|functions| {
                let sums = functions.each_ref().map(|series| series.iter().map(|c| c.abs()).sum::<f64>());
                sums.into_iter().fold(0.0, f64::max)
            })
            .collect();
        // A rate of the axes turns a symmetric tensor of rank 2 at most twice as fast.
        let norms = (0..=ORDERS).map(|j| leibniz(j, 2.0 * node_rate.abs()).zip(&sizes[..=j]).map(|(c, s)| c * s).sum());
        let mut orbital =
            Self { rows: Vec::new(), coefficients: Vec::new(), multiples: 0, node_rate, norms: norms.collect() };
        for [one, cosine, sine] in &turned {
            let series = one.iter().zip(cosine).zip(sine).map(|((one, cosine), sine)| [*one, *cosine, *sine]);
            let largest = one.iter().chain(cosine).chain(sine).fold(0.0_f64, |most, c| most.max(c.abs()));
            orbital.push(0, series, 1e-18 * largest);
        }
        orbital
    }

    /// The first derivatives, as many as there are bounds, without the lowest and the highest coefficients that do not exceed the bound; and for each the sum
    /// of the coefficients that it lacks.
    pub(crate) fn cut(&self, bounds: &[f64]) -> (Self, Vec<f64>) {
        let mut orbital = Self { rows: Vec::new(), coefficients: Vec::new(), multiples: 0, norms: Vec::new(), ..*self };
        let cut = |(row, bound): (&Row, &f64)| {
            orbital.push(row.first, self.coefficients[row.start..row.end].iter().copied(), *bound)
        };
        let cut = self.rows.iter().zip(bounds).map(cut).collect();
        (orbital, cut)
    }

    /// Number of derivatives.
    pub(super) fn orders(&self) -> usize {
        self.rows.len()
    }

    /// Adds a row from the coefficients from k = `first` on, without the lowest and the highest that do not exceed `bound`. Returns the sum of these.
    fn push(&mut self, first: usize, series: impl Iterator<Item = [f64; 3]>, bound: f64) -> f64 {
        let start = self.coefficients.len();
        let (mut skipped, mut end) = (first, start);
        // The sum of those that are dropped, and of those that are if no larger one follows.
        let (mut dropped, mut pending) = (0.0, 0.0);
        for functions in series {
            let largest = functions.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
            if largest > bound {
                self.coefficients.push(functions);
                (end, pending) = (self.coefficients.len(), 0.0);
            } else if self.coefficients.len() > start {
                self.coefficients.push(functions);
                pending += largest;
            } else {
                skipped += 1;
                dropped += largest;
            }
        }
        self.coefficients.truncate(end);
        let row = Row { first: if end > start { skipped } else { 0 }, start, end };
        self.multiples = self.multiples.max(row.first + row.end - row.start);
        self.rows.push(row);
        dropped + pending
    }

    /// Sizes of all derivatives at a true anomaly: of (a/r)³, or of (a/r)³ e^(2if) if that is larger.
    pub(crate) fn sizes_at(&self, anomaly: f64) -> [f64; ORDERS + 1] {
        let mut sizes = [0.0; ORDERS + 1];
        let (sine, cosine) = anomaly.sin_cos();
        let mut circle = [[1.0, 0.0]; WIDTH + 3];
        for k in 1..circle.len() {
            let [x, y] = circle[k - 1];
            circle[k] = [x * cosine - y * sine, x * sine + y * cosine];
        }
        for (j, (size, row)) in sizes.iter_mut().zip(&self.rows).enumerate() {
            let mut sums = [0.0; 3];
            let odd = j % 2;
            for (turn, [one, cosine, sine]) in circle[row.first..].iter().zip(&self.coefficients[row.start..row.end]) {
                sums[0] += turn[odd] * one;
                sums[1] += turn[odd] * cosine;
                sums[2] += turn[1 - odd] * sine;
            }
            *size = (sums[0] * sums[0]).max(sums[1] * sums[1] + sums[2] * sums[2]).sqrt();
        }
        sizes
    }
}

/// The time derivatives of (a/r)³, (a/r)³ cos 2f and (a/r)³ sin 2f on a fixed ellipse, as coefficients of Fourier series.
fn derivatives(eccentricity: f64, mean_motion: f64) -> Vec<[Vec<f64>; 3]> {
    let eta_square = 1.0 - eccentricity * eccentricity;
    let rate = mean_motion / (eta_square * eta_square.sqrt());
    let unit = |k: usize| -> Vec<f64> { (0..=WIDTH + 2).map(|i| if i == k { 1.0 } else { 0.0 }).collect() };
    let mut current = [(unit(0), false), (unit(2), false), (unit(2), true)].map(|(series, odd)| {
        let cubed = (0..3).fold(series, |series, _| times_w(&series, eccentricity, odd));
        (cubed.iter().map(|c| c / eta_square.powi(3)).collect::<Vec<f64>>(), odd)
    });
    let mut all = Vec::with_capacity(ORDERS + 1);
    for _ in 0..=ORDERS {
        all.push(current.each_ref().map(|(coefficients, _)| coefficients.clone()));
        current = current.map(|(coefficients, odd)| {
            let sign = if odd { rate } else { -rate };
            let slope: Vec<f64> = coefficients.iter().enumerate().map(|(k, c)| sign * k as f64 * c).collect();
            let squared = (0..2).fold(slope, |series, _| times_w(&series, eccentricity, !odd));
            (squared, !odd)
        });
    }
    all
}

/// The j-th derivatives of the three functions, where e^(2if) also turns with `rate`.
fn with_turning(fixed: &[[Vec<f64>; 3]], rate: f64, j: usize) -> [Vec<f64>; 3] {
    let [one, cosine, sine] = &fixed[j];
    let (mut real, mut imaginary) = (cosine.clone(), sine.clone());
    if rate != 0.0 {
        for (k, weight) in leibniz(j, rate).enumerate().take(j) {
            let turns = j - k;
            let [_, cosine, sine] = &fixed[k];
            let sign = |quarter: usize| if (quarter / 2).is_multiple_of(2) { weight } else { -weight };
            // i^m (A + iB), of which an odd m exchanges the two functions.
            let (to_real, to_imaginary, signs) = if turns.is_multiple_of(2) {
                (cosine, sine, [sign(turns), sign(turns)])
            } else {
                (sine, cosine, [sign(turns + 1), sign(turns - 1)])
            };
            for (sum, c) in real.iter_mut().zip(to_real) {
                *sum += signs[0] * c;
            }
            for (sum, c) in imaginary.iter_mut().zip(to_imaginary) {
                *sum += signs[1] * c;
            }
        }
    }
    [one.clone(), real, imaginary]
}

/// Binomial coefficients of (x + rate)^j, for x^0, x^1, … x^j.
fn leibniz(j: usize, rate: f64) -> impl Iterator<Item = f64> {
    let mut binomial = 1.0;
    (0..=j).map(move |k| {
        let weight = binomial * rate.powi((j - k) as i32); // j ≤ ORDERS
        binomial *= (j - k) as f64 / (k + 1) as f64;
        weight
    })
}

/// A series in cos kf, or in sin kf if `odd`, times 1 + e cos f.
fn times_w(series: &[f64], eccentricity: f64, odd: bool) -> Vec<f64> {
    let at = |k: usize| series.get(k).copied().unwrap_or_default();
    let half = 0.5 * eccentricity;
    let mut product: Vec<f64> = (0..series.len()).map(|k| at(k) + half * (at(k + 1) + at(k.wrapping_sub(1)))).collect();
    // cos(−f) = cos f and sin(−f) = −sin f; the mean has only one coefficient.
    match odd {
        true => product[0] = 0.0,
        false => product[1] += half * at(0),
    }
    product
}

impl Orbital {
    /// The derivative j of the three functions, from e^(ikf) for k = 0, 1, …
    #[inline(always)]
    pub(super) fn derivative<S: InstructionSet>(&self, j: usize, circle: &[ComplexLanes<S>]) -> [Lanes<S>; 3] {
        if j.is_multiple_of(2) { self.series::<S, false>(j, circle) } else { self.series::<S, true>(j, circle) }
    }

    #[inline(always)]
    fn series<S: InstructionSet, const ODD: bool>(&self, j: usize, circle: &[ComplexLanes<S>]) -> [Lanes<S>; 3] {
        let row = &self.rows[j];
        let none = circle[0].im;
        let mut sums = [none; 3];
        for (turn, [one, cosine, sine]) in circle[row.first..].iter().zip(&self.coefficients[row.start..row.end]) {
            let (even, odd) = if ODD { (turn.im, turn.re) } else { (turn.re, turn.im) };
            sums[0] = even.mul_add(none.all(*one), sums[0]);
            sums[1] = even.mul_add(none.all(*cosine), sums[1]);
            sums[2] = odd.mul_add(none.all(*sine), sums[2]);
        }
        sums
    }

    /// The number of multiples of f, from 0, in the derivatives that are evaluated. One derivative more is known only by its size.
    pub(super) fn multiples(&self) -> usize {
        self.multiples.clamp(1, WIDTH + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::kepler::Place;

    #[test]
    fn a_cut_derivative_lacks_no_more_than_it_says() {
        let orbital = Orbital::new(0.3, 1e-2);
        let bounds: [f64; ORDERS] = std::array::from_fn(|j| 0.05 * 1e-2_f64.powi(j as i32));
        let (cut, lost) = orbital.cut(&bounds);
        let row = |orbital: &Orbital, j: usize| orbital.rows[j].end - orbital.rows[j].start;
        assert!((0..ORDERS).all(|j| row(&cut, j) <= row(&orbital, j)) && row(&cut, 0) < row(&orbital, 0));
        for k in 0..=24 {
            let place = Place::of(Lanes::splat(pulp::Scalar, 0.25 * f64::from(k) - 3.0), 0.3);
            let mut room = Circle::new(place.turn());
            let circle = room.of(place.turn(), WIDTH + 1);
            for (j, lost) in lost.iter().enumerate() {
                let [whole, cut] = [&orbital, &cut].map(|orbital| orbital.derivative(j, circle));
                for (whole, cut) in whole.iter().zip(cut) {
                    let gap = (whole.values()[0] - cut.values()[0]).abs();
                    assert!(gap <= lost * (1.0 + 1e-12) + 1e-14 * orbital.norms[j], "{j}: {gap:e} of {lost:e}");
                }
            }
        }
        let (nothing, lost) = orbital.cut(&[f64::INFINITY; 2]);
        assert!(nothing.orders() == 2 && nothing.coefficients.is_empty() && lost.iter().all(|lost| *lost > 0.0));
    }
}
