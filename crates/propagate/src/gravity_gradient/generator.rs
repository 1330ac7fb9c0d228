//! The generating function W of the gravity gradient and its derivatives at one place of the orbit, arranged for fast evaluation.
//!
//! With ε = 1/Ω, the sum for G is Σ (iε)^j d^j/dt^j g, up to the factor −iε. The time derivatives of (a/r)³, (a/r)³ cos 2f and (a/r)³ sin 2f are Fourier
//! polynomials in f that all terms share. After contraction with r̂r̂ for one m, each term needs only real multiples of them, since T33, i t1 e^(−iy′) and t2
//! e^(−2iy′) have real coefficients (time reversal). |p| = √σ is a constant of the mean motion and is included in the coefficients. The derivatives with
//! respect to p and p̄ are stored as ∂/∂p e^(iℓ′) and ∂/∂p̄ e^(−iℓ′), which are regular at p = 0.

use std::f64::consts::TAU;

use nalgebra::Vector3;

mod exact;
mod orbital;

use pulp::NullaryFnOnce;

use exact::PARTS;
pub(crate) use exact::{ExactTerm, returns};
use orbital::sum;
pub(crate) use orbital::{ORDERS, Orbital};

use super::course::{Axes, fixed};
use super::inertia::HIGHEST;
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::kepler::Place;
use crate::simd::lanes::Lanes;
use crate::simd::sincos::sin_cos_of_turns;

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
    /// Terms that the sums over time derivatives do not serve.
    pub(crate) exact: Vec<ExactTerm>,
    pub(crate) orbital: Orbital,
    /// Unit vectors to the pericentre and perpendicular to it at the epoch, in inertial components.
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

impl<S: InstructionSet> Correction<S> {
    /// The sum of two changes.
    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            p: self.p + other.p,
            longitude: self.longitude + other.longitude,
            momentum: self.momentum + other.momentum,
            rotation: [self.rotation[0] + other.rotation[0], self.rotation[1] + other.rotation[1]],
        }
    }
}

/// The contraction of r̂r̂ for one multiple of y′ (r₃² − ⅓, r̄₊ r₃ or r̄₊²), and its derivatives when the frame turns about its axes 1 and 2. They are
/// multiplied by i for odd j.
type Contracted<S> = [ComplexLanes<S>; 3];

impl Generator {
    /// The changes from mean to osculating variables, for |p| = √σ and an ellipse with these axes.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(&self, mean: &MeanLanes<S>, place: &Place<S>, axes: &Axes<S>) -> Correction<S> {
        let none = place.sine.all(0.0);
        let zero = ComplexLanes { re: none, im: none };
        let products = products(mean.frame, axes);
        let tensors = self.tensors_of(mean.frame, &products, place);
        let exact = self.exact.iter().flat_map(|term| &term.harmonic);
        let highest = self.harmonics.iter().flatten().chain(exact).map(|harmonic| harmonic.degree).max().unwrap_or(0);
        let turns = circle(mean.turn, highest);
        let orders = self.orbital.series.len();
        let mut sums = Derivatives { by_p: [zero; 2], by_longitude: none, by_momentum: none, by_rotation: [none; 2] };
        let mut spin = ComplexLanes { re: none.all(1.0), im: none };
        for (multiple, harmonics) in self.harmonics.iter().enumerate() {
            if !harmonics.is_empty() {
                let mut totals = [zero; SUMS + 2];
                for (j, tensor) in tensors.iter().enumerate().take(orders) {
                    add(&mut totals, harmonics, &turns, (j, tensor, multiple));
                }
                sums.add(&totals, multiple, spin);
            }
            spin = spin * mean.spin;
        }
        if !self.exact.is_empty() {
            let with = Exact { generator: self, turns: &turns, products: &products, spin: mean.spin, place, sums };
            sums = none.simd().vectorize(with);
        }
        self.change(&sums)
    }

    /// r̂r̂ (a/r)³ and its time derivatives in the frame at the epoch's axes, as components 11, 22, 33, 12, 13, 23.
    #[inline(always)]
    pub(crate) fn tensors<S: InstructionSet>(
        &self,
        frame: QuaternionLanes<S>,
        place: &Place<S>,
    ) -> [[Lanes<S>; 6]; ORDERS] {
        self.tensors_of(frame, &products(frame, &fixed(&self.axes, place.sine)), place)
    }

    #[inline(always)]
    fn tensors_of<S: InstructionSet>(
        &self,
        frame: QuaternionLanes<S>,
        products: &Products<S>,
        place: &Place<S>,
    ) -> [[Lanes<S>; 6]; ORDERS] {
        let none = place.sine.all(0.0);
        let circle = self.orbital.circle(place);
        let mut tensors = [[none; 6]; ORDERS];
        for (j, (tensor, [one, cosine, sine])) in tensors.iter_mut().zip(&self.orbital.series).enumerate() {
            let (even, odd) = (j % 2, 1 - j % 2);
            let (one, cosine, sine) = (sum(&circle, one, even), sum(&circle, cosine, even), sum(&circle, sine, odd));
            *tensor = tensor_of([one, cosine, sine], products);
        }
        if self.orbital.node_rate != 0.0 {
            let ([x, y, z], rate) = (frame.rows()[2], none.all(self.orbital.node_rate));
            turned(&mut tensors, self.orbital.series.len(), [x * rate, y * rate, z * rate]);
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

/// Time derivatives of a tensor from those relative to axes that turn with an angular velocity, which is constant relative to them. The lists hold the orders
/// from 0.
#[inline(always)]
fn turned<S: InstructionSet>(tensors: &mut [[Lanes<S>; 6]; ORDERS], orders: usize, [a, b, c]: [Lanes<S>; 3]) {
    for first in 1..orders {
        // Each pass replaces the derivative j by (d/dt + ω×) of the derivative j − 1 of the pass before, beginning with the highest.
        for j in (first..orders).rev() {
            let [xx, yy, zz, xy, xz, yz] = tensors[j - 1];
            let two = a.all(2.0);
            let change = [
                two * b.mul_add(xz, -(c * xy)),
                two * c.mul_add(xy, -(a * yz)),
                two * a.mul_add(yz, -(b * xz)),
                c.mul_add(xx - yy, b.mul_add(yz, -(a * xz))),
                b.mul_add(zz - xx, a.mul_add(xy, -(c * yz))),
                a.mul_add(yy - zz, c.mul_add(xz, -(b * xy))),
            ];
            for (component, more) in tensors[j].iter_mut().zip(change) {
                *component = *component + more;
            }
        }
    }
}

/// The products PP, QQ and PQ + QP of the axes of the orbit in the frame, by component.
type Products<S> = [[Lanes<S>; 3]; 6];

#[inline(always)]
fn products<S: InstructionSet>(frame: QuaternionLanes<S>, inertial: &Axes<S>) -> Products<S> {
    let rows = frame.rows();
    let none = rows[0][0].all(0.0);
    let mut axes = [[none; 3]; 2];
    for (components, [x, y, z]) in axes.iter_mut().zip(inertial) {
        for (c, component) in components.iter_mut().enumerate() {
            let part = rows[0][c].mul_add(*x, rows[1][c] * *y);
            *component = rows[2][c].mul_add(*z, part);
        }
    }
    let [first, second] = axes;
    let mut products = [[none; 3]; 6];
    for (product, (a, b)) in products.iter_mut().zip(COMPONENTS) {
        *product = [first[a] * first[b], second[a] * second[b], first[a].mul_add(second[b], first[b] * second[a])];
    }
    products
}

/// r̂r̂ = (PP + QQ)/2 + (PP − QQ)/2 cos 2f + (PQ + QP)/2 sin 2f, from the factors of the three functions.
#[inline(always)]
fn tensor_of<S: InstructionSet>([one, cosine, sine]: [Lanes<S>; 3], products: &Products<S>) -> [Lanes<S>; 6] {
    let half = one.all(0.5);
    let (pp, qq, pq) = (half * (one + cosine), half * (one - cosine), half * sine);
    let mut tensor = [half; 6];
    for (slot, [first, second, mixed]) in tensor.iter_mut().zip(products) {
        *slot = pp.mul_add(*first, qq.mul_add(*second, pq * *mixed));
    }
    tensor
}

/// Adds the terms of one m with one of the tensors. Those with an odd j are multiplied by i.
#[inline(always)]
fn add<S: InstructionSet>(
    totals: &mut [ComplexLanes<S>; SUMS + 2],
    harmonics: &[Harmonic],
    turns: &[ComplexLanes<S>; HIGHEST + 1],
    (j, tensor, multiple): (usize, &[Lanes<S>; 6], usize),
) {
    let none = tensor[0].all(0.0);
    let factors = summed(harmonics, turns, j, ComplexLanes { re: none, im: none });
    let contracted = contractions(tensor, multiple, j % 2 == 1);
    for (total, factor) in totals.iter_mut().zip(factors) {
        *total = total.plus(factor, contracted[0]);
    }
    totals[SUMS] = totals[SUMS].plus(factors[0], contracted[1]);
    totals[SUMS + 1] = totals[SUMS + 1].plus(factors[0], contracted[2]);
}

/// The sums with the exact terms added, as a task that is compiled separately: most scenes do without it.
struct Exact<'a, S: InstructionSet> {
    generator: &'a Generator,
    turns: &'a [ComplexLanes<S>; HIGHEST + 1],
    products: &'a Products<S>,
    spin: ComplexLanes<S>,
    place: &'a Place<S>,
    sums: Derivatives<S>,
}

impl<S: InstructionSet> NullaryFnOnce for Exact<'_, S> {
    type Output = Derivatives<S>;

    #[inline(always)]
    fn call(self) -> Derivatives<S> {
        let Self { generator, turns, products, spin, place, mut sums } = self;
        let none = place.sine.all(0.0);
        let zero = ComplexLanes { re: none, im: none };
        let (sine, cosine) = sin_cos_of_turns((place.angle - place.centre) * none.all(1.0 / TAU));
        let one = ComplexLanes { re: none.all(1.0), im: none };
        let spins = [one, spin, spin * spin];
        for term in &generator.exact {
            let mut totals = [zero; SUMS + 2];
            let multiple = term.numbers.1 as usize; // 0 ≤ m ≤ 2
            let parts = term.parts(ComplexLanes { re: cosine, im: sine });
            for (j, functions) in parts.iter().enumerate().take(PARTS) {
                let tensor = tensor_of(*functions, products);
                add(&mut totals, &term.harmonic, turns, (j, &tensor, multiple));
            }
            sums.add(&totals, multiple, spins[multiple]);
        }
        sums
    }
}

/// Pairs of axes of a symmetric tensor.
const COMPONENTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

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
#[derive(Clone, Copy)]
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
