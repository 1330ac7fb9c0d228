//! Time derivatives of the orbit's functions in the torque, as powers of 1 + e cos f times Fourier polynomials in the true anomaly f.
//!
//! With w = 1 + e cos f, (a/r)³ = w³/η⁶ and d/dt = n η^(−3) w² d/df. So the derivative j of (a/r)³ times 1, cos 2f or sin 2f is w^(3+j) times a polynomial of
//! degree 2 + j. Without the factor it would have the degree 5 + 2j, and near the apocentre of an elongated ellipse its terms would cancel. If
//! the pericentre precesses, only the factor w³ is taken out.

use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::simd::unit_powers::UnitPowers;

/// Number of functions in G: g and its time derivatives.
pub(crate) const ORDERS: usize = 7;
/// Multiples of f, from 0, in the expanded derivatives; one derivative more than G has is known by its size.
const EXPANDED: usize = 6 + 2 * ORDERS;
/// Multiples of f, from 0, in the polynomials without w³ if the pericentre precesses. If it is fixed there are at most `ORDERS` + 3.
const MULTIPLES: usize = 3 + 2 * ORDERS;

/// The powers of e^(if). Orbits whose pericentre is fixed do with few.
pub(crate) type AnomalyPowers<S> = UnitPowers<S, { ORDERS + 3 }, MULTIPLES>;

/// Coefficients of a series in cos kf or in sin kf.
type FourierSeries = [f64; EXPANDED];

/// Time derivatives of (a/r)³ times 1, cos 2f and sin 2f, without powers of w. Even derivatives of the first two and odd derivatives of the third are series in
/// cos kf. The others are series in sin kf.
#[derive(Clone, Debug)]
pub(crate) struct Orbital {
    eccentricity: f64,
    /// Whether the power of w is 3 + j for the derivative j, and not 3 for all.
    climbs: bool,
    rows: Vec<DerivativeRow>,
    /// Coefficients of the three functions, row after row.
    coefficients: Vec<[f64; 3]>,
    /// Number of multiples of f, from 0, in the derivatives.
    multiples: usize,
    /// Rate of the node about inertial axis 3.
    pub(crate) node_rate: f64,
    /// Largest sum of the magnitudes of the expanded derivatives' coefficients, by j.
    pub(crate) norms: Vec<f64>,
}

/// The first k of a derivative, and where its coefficients are.
#[derive(Clone, Copy, Debug)]
struct DerivativeRow {
    first: usize,
    start: usize,
    end: usize,
}

impl Orbital {
    /// The derivatives that G needs, and one more, for a mean motion n.
    pub(crate) fn new(eccentricity: f64, mean_motion: f64) -> Self {
        Self::precessing(eccentricity, mean_motion, [0.0; 2])
    }

    /// The derivatives on an orbit whose node and pericentre precess with these rates. With the pericentre's rate ω̇, the derivatives of (a/r)³ e^(2i(f+ω)), times
    /// e^(−2iω), are those of (d/dt + 2iω̇)^j; the rate of the node enters at the evaluation.
    pub(crate) fn precessing(eccentricity: f64, mean_motion: f64, [node_rate, pericentre_rate]: [f64; 2]) -> Self {
        let climbs = pericentre_rate == 0.0;
        let mut series = derivatives(eccentricity, mean_motion);
        if !climbs {
            for (j, functions) in series.iter_mut().enumerate() {
                *functions = times_powers_of_w(functions, eccentricity, j, j);
            }
            series = std::array::from_fn(|j| with_turning(&series, 2.0 * pericentre_rate, j));
        }
        let power = |j: usize| if climbs { 3 + j } else { 3 };
        let sizes: [f64; ORDERS + 1] = std::array::from_fn(|j| {
            let expanded = times_powers_of_w(&series[j], eccentricity, j, power(j));
            expanded.iter().map(|series| series.iter().map(|c| c.abs()).sum()).fold(0.0, f64::max)
        });
        // A rate of the axes turns a symmetric tensor of rank 2 at most twice as fast.
        let norms = (0..=ORDERS).map(|j| leibniz(j, 2.0 * node_rate.abs()).zip(&sizes[..=j]).map(|(c, s)| c * s).sum());
        let norms = norms.collect();
        let mut orbital = Self { norms, ..Self::empty(eccentricity, climbs, node_rate) };
        for [one, cosine, sine] in &series {
            let largest = one.iter().chain(cosine).chain(sine).fold(0.0_f64, |most, c| most.max(c.abs()));
            let series = one.iter().zip(cosine).zip(sine).map(|((one, cosine), sine)| [*one, *cosine, *sine]);
            orbital.push(0, series, 1e-18 * largest);
        }
        orbital
    }

    fn empty(eccentricity: f64, climbs: bool, node_rate: f64) -> Self {
        Self {
            eccentricity,
            climbs,
            rows: Vec::new(),
            coefficients: Vec::new(),
            multiples: 0,
            node_rate,
            norms: Vec::new(),
        }
    }

    /// The first derivatives, as many as there are bounds, without the lowest and the highest coefficients whose effect does not exceed the bound; and for each
    /// derivative the summed effect of its dropped coefficients.
    pub(crate) fn cut(&self, bounds: &[f64]) -> (Self, Vec<f64>) {
        let mut orbital = Self::empty(self.eccentricity, self.climbs, self.node_rate);
        let mut largest_power = (1.0 + self.eccentricity).powi(3);
        let cut = |(row, bound): (&DerivativeRow, &f64)| {
            let coefficients = self.coefficients[row.start..row.end].iter().copied();
            let lost = largest_power * orbital.push(row.first, coefficients, bound / largest_power);
            largest_power *= if self.climbs { 1.0 + self.eccentricity } else { 1.0 };
            lost
        };
        let losses = self.rows.iter().zip(bounds).map(cut).collect();
        (orbital, losses)
    }

    /// Number of derivatives.
    pub(crate) fn orders(&self) -> usize {
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
        let row = DerivativeRow { first: if end > start { skipped } else { 0 }, start, end };
        self.multiples = self.multiples.max(row.first + row.end - row.start);
        self.rows.push(row);
        dropped + pending
    }

    /// Sizes of all derivatives at a true anomaly: of (a/r)³, or of (a/r)³ e^(2if) if that is larger.
    pub(crate) fn sizes_at(&self, anomaly: f64) -> [f64; ORDERS + 1] {
        let mut sizes = [0.0; ORDERS + 1];
        let (sine, cosine) = anomaly.sin_cos();
        let mut circle = [[1.0, 0.0]; MULTIPLES];
        for k in 1..circle.len() {
            let [x, y] = circle[k - 1];
            circle[k] = [x * cosine - y * sine, x * sine + y * cosine];
        }
        let w = 1.0 + self.eccentricity * cosine;
        let mut power = w * w * w;
        for (j, (size, row)) in sizes.iter_mut().zip(&self.rows).enumerate() {
            let mut sums = [0.0; 3];
            let odd = j % 2;
            for (turn, [one, cosine, sine]) in circle[row.first..].iter().zip(&self.coefficients[row.start..row.end]) {
                sums[0] += turn[odd] * one;
                sums[1] += turn[odd] * cosine;
                sums[2] += turn[1 - odd] * sine;
            }
            *size = (sums[0] * sums[0]).max(sums[1] * sums[1] + sums[2] * sums[2]).sqrt() * power;
            power *= if self.climbs { w } else { 1.0 };
        }
        sizes
    }
}

/// The time derivatives of (a/r)³, (a/r)³ cos 2f and (a/r)³ sin 2f on a fixed ellipse, over w^(3+j): from P to n η^(−3) (w P′ + (3 + j) w′ P).
fn derivatives(eccentricity: f64, mean_motion: f64) -> [[FourierSeries; 3]; ORDERS + 1] {
    let eta_square = (1.0 - eccentricity) * (1.0 + eccentricity);
    let rate = mean_motion / (eta_square * eta_square.sqrt());
    let mut all = [[[0.0; EXPANDED]; 3]; ORDERS + 1];
    for (function, k) in all[0].iter_mut().zip([0, 2, 2]) {
        function[k] = 1.0 / eta_square.powi(3);
    }
    for j in 0..ORDERS {
        for (f, odd) in odd(j).into_iter().enumerate() {
            let (series, sign) = (all[j][f], if odd { rate } else { -rate });
            let slope: FourierSeries = std::array::from_fn(|k| sign * k as f64 * series[k]);
            let (slope, turned) = (times_w(&slope, eccentricity, !odd), times_sine(&series, odd));
            let factor = (3 + j) as f64 * eccentricity * rate;
            all[j + 1][f] = std::array::from_fn(|k| slope[k] - factor * turned[k]);
        }
    }
    all
}

/// Whether the derivatives j of the three functions are series in sin kf.
fn odd(j: usize) -> [bool; 3] {
    let odd = !j.is_multiple_of(2);
    [odd, odd, !odd]
}

/// The derivatives j times a power of w.
fn times_powers_of_w(functions: &[FourierSeries; 3], eccentricity: f64, j: usize, power: usize) -> [FourierSeries; 3] {
    let odd = odd(j);
    std::array::from_fn(|f| (0..power).fold(functions[f], |series, _| times_w(&series, eccentricity, odd[f])))
}

/// The j-th derivatives of the three functions, where e^(2if) also turns with `rate`.
fn with_turning(fixed: &[[FourierSeries; 3]], rate: f64, j: usize) -> [FourierSeries; 3] {
    let [one, cosine, sine] = &fixed[j];
    let (mut real, mut imaginary) = (*cosine, *sine);
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
    [*one, real, imaginary]
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
fn times_w(series: &FourierSeries, eccentricity: f64, odd: bool) -> FourierSeries {
    let at = |k: usize| series.get(k).copied().unwrap_or_default();
    let half = 0.5 * eccentricity;
    let mut product: FourierSeries = std::array::from_fn(|k| at(k) + half * (at(k + 1) + at(k.wrapping_sub(1))));
    // cos(−f) = cos f and sin(−f) = −sin f; the mean has only one coefficient.
    match odd {
        true => product[0] = 0.0,
        false => product[1] += half * at(0),
    }
    product
}

/// A series in cos kf, or in sin kf if `odd`, times sin f.
fn times_sine(series: &FourierSeries, odd: bool) -> FourierSeries {
    let at = |k: usize| series.get(k).copied().unwrap_or_default();
    let sign = if odd { 0.5 } else { -0.5 };
    let mut product: FourierSeries = std::array::from_fn(|k| sign * (at(k + 1) - at(k.wrapping_sub(1))));
    match odd {
        true => product[0] = 0.5 * at(1),
        false => (product[0], product[1]) = (0.0, at(0) - 0.5 * at(2)),
    }
    product
}

impl Orbital {
    /// w³, and the factor by which the power of w grows from one derivative to the next.
    #[inline(always)]
    pub(crate) fn powers<S: InstructionSet>(&self, cosine: Lanes<S>) -> [Lanes<S>; 2] {
        let w = cosine.mul_add(cosine.all(self.eccentricity), cosine.all(1.0));
        [w * w * w, if self.climbs { w } else { w.all(1.0) }]
    }

    /// The derivative j of the three functions, from e^(ikf) for k = 0, 1, … and the power of w.
    #[inline(always)]
    pub(crate) fn derivative<S: InstructionSet>(
        &self,
        j: usize,
        circle: &[ComplexLanes<S>],
        power: Lanes<S>,
    ) -> [Lanes<S>; 3] {
        let [one, cosine, sine] =
            if j.is_multiple_of(2) { self.series::<S, false>(j, circle) } else { self.series::<S, true>(j, circle) };
        [one * power, cosine * power, sine * power]
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

    /// The number of multiples of f, from 0, in the derivatives.
    pub(crate) fn multiples(&self) -> usize {
        self.multiples.max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::kepler::{Place, eccentric_anomaly};

    /// The derivatives j at a mean anomaly.
    fn at(orbital: &Orbital, mean_anomaly: f64, j: usize) -> [f64; 3] {
        let place = Place::of(Lanes::splat(pulp::Scalar, mean_anomaly), orbital.eccentricity);
        let mut room = AnomalyPowers::new(place.turn());
        let circle = room.of(place.turn(), orbital.multiples());
        let [mut power, growth] = orbital.powers(place.cosine);
        for _ in 0..j {
            power = power * growth;
        }
        orbital.derivative(j, circle, power).map(|lanes| lanes.values()[0])
    }

    #[test]
    fn each_derivative_is_that_of_the_one_before() {
        let (motion, step) = (1e-2, 1e-3);
        for (e, rate) in [(0.0, 0.0), (0.3, 0.0), (0.8, 0.0), (0.3, 2e-3), (0.8, -1e-3)] {
            let orbital = Orbital::precessing(e, motion, [0.0, rate]);
            for anomaly in [-2.9, -1.0, 0.1, 0.7, 2.0] {
                let distance = 1.0 - e * eccentric_anomaly(anomaly, e).cos();
                assert!((at(&orbital, anomaly, 0)[0] * distance.powi(3) - 1.0).abs() < 1e-13);
                for j in 0..ORDERS {
                    let point = |k: f64| at(&orbital, anomaly + k * step, j);
                    let [far, near, after, beyond] = [-2.0, -1.0, 1.0, 2.0].map(point);
                    let mut slope: [f64; 3] = std::array::from_fn(|f| {
                        (8.0 * (after[f] - near[f]) - (beyond[f] - far[f])) / (12.0 * step) * motion
                    });
                    // (d/dt + 2i rate) of the second and third function.
                    let here = at(&orbital, anomaly, j);
                    slope[1] -= 2.0 * rate * here[2];
                    slope[2] += 2.0 * rate * here[1];
                    for (found, slope) in at(&orbital, anomaly, j + 1).iter().zip(slope) {
                        let scale = orbital.norms[j + 1];
                        assert!((found - slope).abs() <= 1e-7 * scale, "{e} {rate} {anomaly} {j}: {found:e} {slope:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_cut_derivative_lacks_no_more_than_it_says() {
        for rate in [0.0, 1e-3] {
            cut_of(&Orbital::precessing(0.3, 1e-2, [0.0, rate]));
        }
    }

    fn cut_of(orbital: &Orbital) {
        let bounds: [f64; ORDERS] = std::array::from_fn(|j| 0.02 * orbital.norms[j]);
        let (cut, lost) = orbital.cut(&bounds);
        let row = |orbital: &Orbital, j: usize| orbital.rows[j].end - orbital.rows[j].start;
        assert!(
            (0..ORDERS).all(|j| row(&cut, j) <= row(orbital, j)) && row(&cut, ORDERS - 1) < row(orbital, ORDERS - 1)
        );
        for k in 0..=24 {
            for (j, lost) in lost.iter().enumerate() {
                let [whole, cut] = [orbital, &cut].map(|orbital| at(orbital, 0.25 * f64::from(k) - 3.0, j));
                for (whole, cut) in whole.iter().zip(cut) {
                    let gap = (whole - cut).abs();
                    assert!(gap <= lost * (1.0 + 1e-12) + 1e-14 * orbital.norms[j], "{j}: {gap:e} of {lost:e}");
                }
            }
        }
        let (nothing, lost) = orbital.cut(&[f64::INFINITY; 2]);
        assert!(nothing.orders() == 2 && nothing.coefficients.is_empty() && lost.iter().all(|lost| *lost > 0.0));
    }

    #[test]
    fn sizes_are_those_of_the_derivatives() {
        for (e, rate) in [(0.0, 0.0), (0.9, 0.0), (0.9, 1e-3)] {
            let orbital = Orbital::precessing(e, 1e-2, [0.0, rate]);
            for anomaly in [-3.1, -0.2, 1.3] {
                let place = Place::of(Lanes::splat(pulp::Scalar, anomaly), e);
                let sizes = orbital.sizes_at(place.angle.values()[0]);
                for (j, found) in sizes.iter().enumerate().take(ORDERS) {
                    let [one, cosine, sine] = at(&orbital, anomaly, j);
                    let size = one.abs().max(cosine.hypot(sine));
                    assert!(
                        (found - size).abs() <= 1e-9 * size + 1e-15 * orbital.norms[j],
                        "{e} {rate} {anomaly} {j}: {found} {size}"
                    );
                }
            }
        }
    }
}
