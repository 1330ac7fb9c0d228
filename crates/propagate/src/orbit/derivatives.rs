//! Time derivatives of the orbit's functions in the torque, as powers of 1 + e cos f times Fourier polynomials in the true anomaly f.
//!
//! With ϱ = 1 + e cos f, (a/r)³ = ϱ³/η⁶ and d/dt = n η^(−3) ϱ² d/df. So the derivative j of (a/r)³ times 1, cos 2f or sin 2f is ϱ^(3+j) times a polynomial of
//! degree 2 + j. Without the factor it would have the degree 5 + 2j, and near the apocentre of an elongated ellipse its terms would cancel. If
//! the pericentre precesses, only the factor ϱ³ is taken out.

use std::ops::Range;

use super::kepler::Place;
use super::position::eta;
use super::tensor::{Deviator, Products, deviator_of, turned};
use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::simd::unit_powers::UnitPowers;

/// Number of functions in G: g and its time derivatives.
pub(crate) const ORDERS: usize = 7;
/// Number of multiples of f, from 0, in the expanded derivatives. G uses `ORDERS` derivatives; one more gives the truncation error.
const EXPANDED: usize = 6 + 2 * ORDERS;
/// Multiples of f, from 0, in the polynomials without ϱ³ if the pericentre precesses. If it is fixed there are at most `ORDERS` + 3.
const MULTIPLES: usize = 3 + 2 * ORDERS;

/// The powers of e^(if). Orbits whose pericentre is fixed do with few.
pub(crate) type AnomalyPowers<S> = UnitPowers<S, { ORDERS + 3 }, MULTIPLES>;

/// Real coefficients of e^(ikf) for |k| < [`EXPANDED`], from the lowest k on.
type FourierSeries = [f64; 2 * EXPANDED - 1];

/// Time derivatives of (a/r)³ times 1, cos 2f and sin 2f, without powers of w. Even derivatives of the first two and odd derivatives of the third are series in
/// cos kf. The others are series in sin kf.
#[derive(Clone, Debug)]
pub(crate) struct Orbital {
    eccentricity: f64,
    /// Whether the power of ϱ is 3 + j for the derivative j, and not 3 for all.
    climbs: bool,
    /// The first k of each derivative, and where its coefficients are.
    rows: Vec<(usize, Range<usize>)>,
    /// Coefficients of the three functions, row after row.
    coefficients: Vec<[f64; 3]>,
    /// Number of multiples of f, from 0, in the derivatives.
    multiples: usize,
    /// Rate of the node about inertial axis 3.
    pub(crate) node_rate: f64,
    /// Largest sum of the magnitudes of the expanded derivatives' coefficients, by j.
    pub(crate) norms: Vec<f64>,
}

impl Orbital {
    /// The derivatives that G needs, and one more, for a mean motion n and for rates of node and pericentre. With the pericentre's rate ω̇, the derivatives of
    /// (a/r)³ e^(2i(f+ω)), times e^(−2iω), are those of (d/dt + 2iω̇)^j. The rate of the node enters at the evaluation.
    pub(crate) fn new(eccentricity: f64, mean_motion: f64, [node_rate, pericentre_rate]: [f64; 2]) -> Self {
        let climbs = pericentre_rate == 0.0;
        let mut orbital = Self {
            eccentricity,
            climbs,
            rows: Vec::new(),
            coefficients: Vec::new(),
            multiples: 1,
            node_rate,
            norms: Vec::new(),
        };
        let rate = mean_motion / eta(eccentricity).powi(3);
        // −i d/dt keeps the coefficients of (a/r)³ and (a/r)³ e^(2if) real.
        let mut series = [0, 2].map(|k| {
            let mut series = [0.0; 2 * EXPANDED - 1];
            series[EXPANDED - 1 + k] = eta(eccentricity).powi(-6);
            series
        });
        let mut expanded = series.map(|series| (0..3).fold(series, |series, _| times_w(&series, eccentricity)));
        let next = |series: &mut [FourierSeries; 2], power: usize, further: bool| {
            for (series, turning) in series.iter_mut().zip([0.0, 2.0 * pericentre_rate]) {
                let next = derivative(series, eccentricity, power as f64);
                let next = if further { times_w(&next, eccentricity) } else { next };
                *series = std::array::from_fn(|k| rate * next[k] + turning * series[k]);
            }
        };
        let mut sizes = Vec::new();
        for j in 0..=ORDERS {
            let row = functions(&series, j);
            let largest = row.as_flattened().iter().fold(0.0_f64, |most, c| most.max(c.abs()));
            orbital.push(0, &row, f64::EPSILON * largest);
            let row = functions(&expanded, j);
            let sums = [0, 1, 2].map(|f| row.iter().map(|functions| functions[f].abs()).sum());
            sizes.push(sums.into_iter().fold(0.0, f64::max));
            // A rate of the axes turns a symmetric tensor of rank 2 at most twice as fast.
            orbital.norms.push(leibniz(j, 2.0 * node_rate.abs()).zip(&sizes).map(|(c, s)| c * s).sum());
            next(&mut series, if climbs { 3 + j } else { 3 }, !climbs);
            next(&mut expanded, 0, true);
        }
        orbital
    }

    /// The first derivatives, as many as there are bounds, without the lowest and the highest coefficients whose effect does not exceed the bound; and for each
    /// derivative the summed effect of its dropped coefficients.
    pub(crate) fn cut(&self, bounds: &[f64]) -> (Self, Vec<f64>) {
        let mut orbital = Self { rows: Vec::new(), coefficients: Vec::new(), multiples: 1, norms: Vec::new(), ..*self };
        let mut largest_power = (1.0 + self.eccentricity).powi(3);
        let cut = |((first, places), bound): (&(usize, Range<usize>), &f64)| {
            let lost = largest_power * orbital.push(*first, &self.coefficients[places.clone()], bound / largest_power);
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
    fn push(&mut self, first: usize, series: &[[f64; 3]], bound: f64) -> f64 {
        let size = |functions: &[f64; 3]| functions.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        let end = series.iter().rposition(|c| size(c) > bound).map_or(0, |last| last + 1);
        let skipped = series[..end].iter().position(|c| size(c) > bound).unwrap_or(0);
        let start = self.coefficients.len();
        self.coefficients.extend(&series[skipped..end]);
        let first = if end > 0 { first + skipped } else { 0 };
        self.multiples = self.multiples.max(first + end - skipped);
        self.rows.push((first, start..self.coefficients.len()));
        series[..skipped].iter().chain(&series[end..]).map(size).sum()
    }

    /// Sizes of all derivatives at a true anomaly: of (a/r)³, or of (a/r)³ e^(2if) if that is larger.
    pub(crate) fn sizes_at(&self, anomaly: f64) -> [f64; ORDERS + 1] {
        let [sine, cosine] = <[f64; 2]>::from(anomaly.sin_cos()).map(|value| Lanes::splat(pulp::Scalar, value));
        let turn = ComplexLanes { re: cosine, im: sine };
        let mut room = AnomalyPowers::new(turn);
        let circle = room.of(turn, self.multiples());
        let [mut power, growth] = self.powers(cosine);
        std::array::from_fn(|j| {
            let [one, cosine, sine] = self.derivative(j, circle, power).map(|lanes| lanes.values()[0]);
            power = power * growth;
            (one * one).max(cosine * cosine + sine * sine).sqrt()
        })
    }
}

/// The coefficients of cos kf or sin kf, k = 0, 1, …, in the derivatives j of the three functions. The arguments are the series of (−i d/dt)^j of (a/r)³ and of
/// (a/r)³ e^(2if).
fn functions([one, turned]: &[FourierSeries; 2], j: usize) -> [[f64; 3]; EXPANDED] {
    let middle = EXPANDED - 1;
    std::array::from_fn(|k| {
        let sum =
            |series: &FourierSeries| if k == 0 { series[middle] } else { series[middle + k] + series[middle - k] };
        let difference = |series: &FourierSeries| series[middle + k] - series[middle - k];
        match j % 4 {
            0 => [sum(one), sum(turned), difference(turned)],
            1 => [-difference(one), -difference(turned), sum(turned)],
            2 => [-sum(one), -sum(turned), -difference(turned)],
            _ => [difference(one), difference(turned), -sum(turned)],
        }
    })
}

/// The series −i (w P′ + c w′ P) from the series P, with c = `power`.
fn derivative(series: &FourierSeries, eccentricity: f64, power: f64) -> FourierSeries {
    let at = |k: usize| series.get(k).copied().unwrap_or_default();
    let slope: FourierSeries = std::array::from_fn(|k| (k as f64 - (EXPANDED - 1) as f64) * series[k]);
    let slope = times_w(&slope, eccentricity);
    let half = 0.5 * power * eccentricity;
    std::array::from_fn(|k| slope[k] + half * (at(k.wrapping_sub(1)) - at(k + 1)))
}

/// A series times 1 + e cos f.
fn times_w(series: &FourierSeries, eccentricity: f64) -> FourierSeries {
    let at = |k: usize| series.get(k).copied().unwrap_or_default();
    std::array::from_fn(|k| at(k) + 0.5 * eccentricity * (at(k + 1) + at(k.wrapping_sub(1))))
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

impl Orbital {
    /// ϱ³, and the factor by which the power of ϱ grows from one derivative to the next.
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
        let (first, places) = &self.rows[j];
        let none = circle[0].im;
        let mut sums = [none; 3];
        for (turn, [one, cosine, sine]) in circle[*first..].iter().zip(&self.coefficients[places.clone()]) {
            let (even, odd) = if ODD { (turn.im, turn.re) } else { (turn.re, turn.im) };
            sums[0] = even.mul_add(none.all(*one), sums[0]);
            sums[1] = even.mul_add(none.all(*cosine), sums[1]);
            sums[2] = odd.mul_add(none.all(*sine), sums[2]);
        }
        sums
    }

    /// The traceless part of (a/r)³ r̂r̂ and its time derivatives, from the products of the orbit's axes and inertial axis 3 in the frame.
    #[inline(always)]
    pub(crate) fn tensors<S: InstructionSet>(
        &self,
        products: &Products<S>,
        [x, y, z]: [Lanes<S>; 3],
        place: &Place<S>,
    ) -> [Deviator<S>; ORDERS] {
        let none = x.all(0.0);
        let mut room = AnomalyPowers::new(place.turn());
        let circle = room.of(place.turn(), self.multiples());
        let mut tensors = [[none; 5]; ORDERS];
        let orders = self.orders().min(ORDERS);
        let [mut power, growth] = self.powers(place.cosine);
        for (j, tensor) in tensors.iter_mut().enumerate().take(orders) {
            *tensor = deviator_of(self.derivative(j, circle, power), products);
            power = power * growth;
        }
        if self.node_rate != 0.0 {
            let rate = x.all(self.node_rate);
            turned(&mut tensors, orders, [x * rate, y * rate, z * rate]);
        }
        tensors
    }

    /// The number of multiples of f, from 0, in the derivatives.
    pub(crate) fn multiples(&self) -> usize {
        self.multiples
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::kepler::{Place, eccentric_anomaly};

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
            let orbital = Orbital::new(e, motion, [0.0, rate]);
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
            cut_of(&Orbital::new(0.3, 1e-2, [0.0, rate]));
        }
    }

    fn cut_of(orbital: &Orbital) {
        let bounds: [f64; ORDERS] = std::array::from_fn(|j| 0.02 * orbital.norms[j]);
        let (cut, lost) = orbital.cut(&bounds);
        let row = |orbital: &Orbital, j: usize| orbital.rows[j].1.len();
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
}
