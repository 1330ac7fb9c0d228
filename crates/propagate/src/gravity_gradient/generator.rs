//! The generating function W of the gravity gradient and its derivatives at one place of the orbit, arranged for fast evaluation.
//!
//! With ε = 1/Ω, the sum for G is Σ (iε)^j d^j/dt^j g, up to the factor −iε. The time derivatives of (a/r)³, (a/r)³ cos 2f and (a/r)³ sin 2f are Fourier
//! polynomials in f that all terms share. After contraction with r̂r̂ for one m, each term needs only real multiples of them, since T33, i t1 e^(−iy′) and t2
//! e^(−2iy′) have real coefficients (time reversal). |p| = √σ is a constant of the mean motion and is included in the coefficients. The derivatives with
//! respect to p and p̄ are stored as ∂/∂p e^(iℓ′) and ∂/∂p̄ e^(−iℓ′), which are regular at p = 0.

use nalgebra::Vector3;

use super::inertia::HIGHEST;
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::kepler::Place;
use crate::simd::lanes::Lanes;

/// Number of functions in G: g and its time derivatives.
pub(crate) const ORDERS: usize = 7;
/// Highest multiple of f in the last derivative.
pub(crate) const WIDTH: usize = 5 + 2 * (ORDERS - 1);

/// Number of sums over the terms: W, M ∂W/∂M, ∂W/∂p and ∂W/∂p̄.
const SUMS: usize = 4;

/// All terms of one |h|: the factors of cos hℓ′ and of i sin hℓ′, by j and sum.
#[derive(Clone, Debug)]
pub(crate) struct Harmonic {
    pub(crate) degree: usize,
    pub(crate) factors: Vec<[[f64; 2]; SUMS]>,
}

impl Harmonic {
    /// Adds a term e^(ihℓ′) with these factors of the sums.
    pub(crate) fn add(&mut self, negative: bool, factors: &[[f64; SUMS]]) {
        if self.factors.len() < factors.len() {
            self.factors.resize(factors.len(), [[0.0; 2]; SUMS]);
        }
        let sign = if negative { -1.0 } else { 1.0 };
        for (slots, factors) in self.factors.iter_mut().zip(factors) {
            for ([even, odd], factor) in slots.iter_mut().zip(factors) {
                *even += factor;
                *odd += sign * factor;
            }
        }
    }
}

/// The terms by m, the Fourier polynomials, and the plane of the orbit.
#[derive(Clone, Debug)]
pub(crate) struct Generator {
    pub(crate) harmonics: [Vec<Harmonic>; 3],
    pub(crate) orbital: Orbital,
    /// Unit vectors to the pericentre and perpendicular to it, in inertial components.
    pub(crate) axes: [Vector3<f64>; 2],
    /// 3n²/2 times the disturbing mass fraction.
    pub(crate) strength: f64,
    pub(crate) root: f64,
    pub(crate) momentum: f64,
}

/// The mean motion at some times: cosine and sine of ℓ′ and of y′, and the invariable frame.
#[derive(Clone, Copy)]
pub(crate) struct MeanLanes<S: InstructionSet> {
    pub(crate) turn: ComplexLanes<S>,
    pub(crate) spin: ComplexLanes<S>,
    pub(crate) frame: QuaternionLanes<S>,
}

/// First-order changes of the mean motion. For p it is the change times e^(−iℓ′); `rotation` is about axes 1 and 2 of the frame.
#[derive(Clone, Copy)]
pub(crate) struct Correction<S: InstructionSet> {
    pub(crate) p: ComplexLanes<S>,
    pub(crate) longitude: Lanes<S>,
    pub(crate) momentum: Lanes<S>,
    pub(crate) rotation: [Lanes<S>; 2],
}

/// Time derivatives of (a/r)³ times 1, cos 2f and sin 2f; the indices are the order j and the function. Even derivatives of the first two and odd derivatives
/// of the third are series in cos kf. The others are series in sin kf.
#[derive(Clone, Debug, Default)]
pub(crate) struct Orbital {
    series: Vec<[Fourier; 3]>,
    /// The derivative after the last.
    next: Vec<[Fourier; 3]>,
    /// Highest k.
    highest: usize,
    /// Largest sum of the coefficients' magnitudes, by j; there is one entry more than there are derivatives.
    pub(crate) norms: Vec<f64>,
}

/// The first k, and the coefficients from this k on.
#[derive(Clone, Debug)]
struct Fourier(usize, Vec<f64>);

impl Orbital {
    /// All derivatives for a mean motion n. d/dt = n η^(−3) w² d/df with w = 1 + e cos f.
    pub(crate) fn new(eccentricity: f64, mean_motion: f64) -> Self {
        let eta_square = 1.0 - eccentricity * eccentricity;
        let rate = mean_motion / (eta_square * eta_square.sqrt());
        let unit = |k: usize| -> Vec<f64> { (0..=WIDTH + 2).map(|i| if i == k { 1.0 } else { 0.0 }).collect() };
        let mut current = [(unit(0), false), (unit(2), false), (unit(2), true)].map(|(series, odd)| {
            let cubed = (0..3).fold(series, |series, _| times_w(&series, eccentricity, odd));
            (cubed.iter().map(|c| c / eta_square.powi(3)).collect::<Vec<f64>>(), odd)
        });
        let (mut series, mut norms, mut next) = (Vec::new(), Vec::new(), Vec::new());
        for j in 0..=ORDERS {
            let sums = current.each_ref().map(|(coefficients, _)| coefficients.iter().map(|c| c.abs()).sum::<f64>());
            norms.push(sums.into_iter().fold(0.0, f64::max));
            if j == ORDERS {
                next.push(current.each_ref().map(|(coefficients, _)| trimmed(coefficients)));
                break;
            }
            series.push(current.each_ref().map(|(coefficients, _)| trimmed(coefficients)));
            current = current.map(|(coefficients, odd)| {
                let sign = if odd { rate } else { -rate };
                let slope: Vec<f64> = coefficients.iter().enumerate().map(|(k, c)| sign * k as f64 * c).collect();
                let weighted = (0..2).fold(slope, |series, _| times_w(&series, eccentricity, !odd));
                (weighted, !odd)
            });
        }
        let mut orbital = Self { series, next, highest: 0, norms };
        orbital.keep(ORDERS);
        orbital
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
        let sum = |Fourier(first, rest): &Fourier, part: usize| -> f64 {
            circle[*first..].iter().zip(rest).map(|(turn, coefficient)| turn[part] * coefficient).sum()
        };
        for (j, (size, [one, cosine, sine])) in sizes.iter_mut().zip(self.series.iter().chain(&self.next)).enumerate() {
            let odd = j % 2;
            *size = sum(one, odd).abs().max(sum(cosine, odd).hypot(sum(sine, 1 - odd)));
        }
        sizes
    }

    /// Keeps the first `orders` derivatives.
    pub(crate) fn keep(&mut self, orders: usize) {
        self.series.truncate(orders);
        let ends = self.series.iter().flatten().map(|Fourier(first, rest)| first + rest.len());
        self.highest = ends.max().unwrap_or(1) - 1;
    }
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

/// Drops the lowest and the highest coefficients if they are negligible.
fn trimmed(series: &[f64]) -> Fourier {
    let largest = series.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let something = |c: &f64| c.abs() > 1e-18 * largest;
    let first = series.iter().position(something).unwrap_or(0);
    let last = series.iter().rposition(something).map_or(first, |last| last + 1);
    Fourier(first, series[first..last].to_vec())
}

/// The contraction of r̂r̂ for one multiple of y′ (r₃² − ⅓, r̄₊ r₃ or r̄₊²), and its derivatives when the frame turns about its axes 1 and 2. They are
/// multiplied by i for odd j.
type Contracted<S> = [ComplexLanes<S>; 3];

impl Generator {
    /// The changes from mean to osculating variables, for |p| = √σ.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(&self, mean: &MeanLanes<S>, place: &Place<S>) -> Correction<S> {
        let none = place.sine.all(0.0);
        let zero = ComplexLanes { re: none, im: none };
        let tensors = self.tensors(mean.frame, place);
        let highest = self.harmonics.iter().flatten().map(|harmonic| harmonic.degree).max().unwrap_or(0);
        let turns = circle(mean.turn, highest);
        let orders = self.orbital.series.len();
        let mut sums = Derivatives { by_p: [zero; 2], by_longitude: none, by_momentum: none, by_rotation: [none; 2] };
        let mut spin = ComplexLanes { re: none.all(1.0), im: none };
        for (multiple, harmonics) in self.harmonics.iter().enumerate() {
            if !harmonics.is_empty() {
                let mut totals = [zero; SUMS + 2];
                for (j, tensor) in tensors.iter().enumerate().take(orders) {
                    let factors = summed(harmonics, &turns, j, zero);
                    let contracted = contractions(tensor, multiple, j % 2 == 1);
                    for (total, factor) in totals.iter_mut().zip(factors) {
                        *total = total.plus(factor, contracted[0]);
                    }
                    totals[SUMS] = totals[SUMS].plus(factors[0], contracted[1]);
                    totals[SUMS + 1] = totals[SUMS + 1].plus(factors[0], contracted[2]);
                }
                sums.add(&totals, multiple, spin);
            }
            spin = spin * mean.spin;
        }
        self.change(&sums)
    }

    /// r̂r̂ (a/r)³ and its time derivatives in the frame, as components 11, 22, 33, 12, 13, 23.
    #[inline(always)]
    pub(crate) fn tensors<S: InstructionSet>(
        &self,
        frame: QuaternionLanes<S>,
        place: &Place<S>,
    ) -> [[Lanes<S>; 6]; ORDERS] {
        let none = place.sine.all(0.0);
        let rows = frame.rows();
        let mut axes = [[none; 3]; 2];
        for (components, axis) in axes.iter_mut().zip(&self.axes) {
            for (c, component) in components.iter_mut().enumerate() {
                let part = rows[0][c].mul_add(none.all(axis.x), rows[1][c] * none.all(axis.y));
                *component = rows[2][c].mul_add(none.all(axis.z), part);
            }
        }
        let [first, second] = axes;
        let mut products = [[none; 3]; 6];
        for (product, (a, b)) in products.iter_mut().zip(COMPONENTS) {
            *product = [first[a] * first[b], second[a] * second[b], first[a].mul_add(second[b], first[b] * second[a])];
        }
        let circle = self.orbital.circle(place);
        let half = none.all(0.5);
        let mut tensors = [[none; 6]; ORDERS];
        for (j, (tensor, [one, cosine, sine])) in tensors.iter_mut().zip(&self.orbital.series).enumerate() {
            let (even, odd) = (j % 2, 1 - j % 2);
            let (one, cosine, sine) = (sum(&circle, one, even), sum(&circle, cosine, even), sum(&circle, sine, odd));
            // r̂r̂ = (PP + QQ)/2 + (PP − QQ)/2 cos 2f + (PQ + QP)/2 sin 2f.
            let (pp, qq, pq) = (half * (one + cosine), half * (one - cosine), half * sine);
            for (slot, [first, second, mixed]) in tensor.iter_mut().zip(products) {
                *slot = pp.mul_add(first, qq.mul_add(second, pq * mixed));
            }
        }
        tensors
    }

    #[inline(always)]
    fn change<S: InstructionSet>(&self, sums: &Derivatives<S>) -> Correction<S> {
        let all = |value: f64| sums.by_longitude.all(value);
        let momentum = sums.by_longitude * all(-self.strength);
        // Only the real part of X counts. Its derivative ∂/∂p̄ is (∂X/∂p̄ + conj ∂X/∂p)/2.
        let by_p_bar = sums.by_p[1] + sums.by_p[0].conjugate();
        let relative = all(self.strength / self.momentum);
        let half = all(0.5) * relative;
        let real = momentum.negate_mul_add(all(0.5 * self.root / self.momentum), -(by_p_bar.im * half));
        let circling = by_p_bar.re.negate_mul_add(all(0.5 * self.root), sums.by_momentum);
        let [x, y] = sums.by_rotation;
        Correction {
            p: ComplexLanes { re: real, im: by_p_bar.re * half },
            longitude: relative * circling,
            momentum,
            // k × δ(Mk)/M turns k and the frame.
            rotation: [relative * y, -(relative * x)],
        }
    }
}

/// Pairs of axes of a symmetric tensor.
const COMPONENTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

impl Orbital {
    /// cos kf and sin kf for k = 0, 1, …
    #[inline(always)]
    fn circle<S: InstructionSet>(&self, place: &Place<S>) -> [[Lanes<S>; 2]; WIDTH + 1] {
        let mut circle = [[place.sine.all(1.0), place.sine.all(0.0)]; WIDTH + 1];
        let step = ComplexLanes { re: place.cosine, im: place.sine };
        let mut turn = step;
        for slot in circle.iter_mut().take(self.highest + 1).skip(1) {
            *slot = [turn.re, turn.im];
            turn = turn * step;
        }
        circle
    }
}

/// The sum of a series in cosines (part 0) or sines (part 1).
#[inline(always)]
fn sum<S: InstructionSet>(circle: &[[Lanes<S>; 2]], series: &Fourier, part: usize) -> Lanes<S> {
    let mut sum = circle[0][1];
    for (turn, coefficient) in circle[series.0..].iter().zip(&series.1) {
        sum = turn[part].mul_add(sum.all(*coefficient), sum);
    }
    sum
}

/// e^(ihℓ′) for h = 0, 1, …
#[inline(always)]
fn circle<S: InstructionSet>(turn: ComplexLanes<S>, highest: usize) -> [ComplexLanes<S>; HIGHEST + 1] {
    let mut turns = [ComplexLanes { re: turn.re.all(1.0), im: turn.re.all(0.0) }; HIGHEST + 1];
    for h in 1..=highest {
        turns[h] = turns[h - 1] * turn;
    }
    turns
}

/// The sums over the terms of one m, for one j.
#[inline(always)]
fn summed<S: InstructionSet>(
    harmonics: &[Harmonic],
    turns: &[ComplexLanes<S>; HIGHEST + 1],
    j: usize,
    zero: ComplexLanes<S>,
) -> [ComplexLanes<S>; SUMS] {
    let mut sums = [zero; SUMS];
    for harmonic in harmonics {
        let turn = turns[harmonic.degree];
        if let Some(factors) = harmonic.factors.get(j) {
            for (sum, [even, odd]) in sums.iter_mut().zip(factors) {
                sum.re = turn.re.mul_add(zero.re.all(*even), sum.re);
                sum.im = turn.im.mul_add(zero.re.all(*odd), sum.im);
            }
        }
    }
    sums
}

#[inline(always)]
fn contractions<S: InstructionSet>(tensor: &[Lanes<S>; 6], multiple: usize, odd: bool) -> Contracted<S> {
    let [xx, yy, zz, xy, xz, yz] = *tensor;
    let none = xx.all(0.0);
    let (three, two) = (xx.all(3.0), xx.all(2.0));
    let c = |re, im| ComplexLanes { re, im };
    let contracted = match multiple {
        0 => [c(zz - (xx + yy) * xx.all(0.5), none), c(-(three * yz), none), c(three * xz, none)],
        1 => [c(xz, -yz), c(-xy, yy - zz), c(xx - zz, -xy)],
        _ => [c(xx - yy, -(two * xy)), c(-(two * yz), -(two * xz)), c(-(two * xz), two * yz)],
    };
    if odd {
        [contracted[0].quarter_turned(), contracted[1].quarter_turned(), contracted[2].quarter_turned()]
    } else {
        contracted
    }
}

/// Derivatives of W divided by the strength.
struct Derivatives<S: InstructionSet> {
    /// With respect to p and p̄.
    by_p: [ComplexLanes<S>; 2],
    by_longitude: Lanes<S>,
    by_momentum: Lanes<S>,
    by_rotation: [Lanes<S>; 2],
}

impl<S: InstructionSet> Derivatives<S> {
    #[inline(always)]
    fn add(&mut self, totals: &[ComplexLanes<S>; SUMS + 2], multiple: usize, spin: ComplexLanes<S>) {
        // The factor −i is that of 1/(iΩ), and for m = 1 also that of t1. The coefficients are real without it.
        let factor = spin.re.all(-2.0);
        let phase = ComplexLanes { re: spin.re * factor, im: spin.im * factor };
        let phase = if multiple == 1 { phase } else { phase.quarter_turned() };
        let mut turned = *totals;
        for total in &mut turned {
            *total = *total * phase;
        }
        let [whole, slope, by_p, by_p_bar, first, second] = turned;
        self.by_longitude = whole.im.negate_mul_add(spin.re.all(multiple as f64), self.by_longitude);
        self.by_momentum = self.by_momentum - slope.re;
        self.by_rotation = [self.by_rotation[0] + first.re, self.by_rotation[1] + second.re];
        self.by_p = [self.by_p[0] + by_p, self.by_p[1] + by_p_bar];
    }
}
