//! The generating function W of the gravity gradient and its derivatives at one place of the orbit, laid out for speed.
//!
//! With ε = 1/Ω, the sum for G is Σ (iε)^j d^j/dt^j g, up to −iε: the time derivatives of (a/r)³, (a/r)³ cos 2f and (a/r)³ sin 2f are Fourier polynomials in f that all terms
//! share. Contracted with r̂r̂ for one m, each term takes real multiples of them, since T33, i t1 e^(−iy′) and t2 e^(−2iy′) have real coefficients (time reversal).
//! |p| = √σ is a constant of the mean motion and is part of the coefficients; derivatives by p and p̄ are kept as ∂/∂p e^(iℓ′) and ∂/∂p̄ e^(−iℓ′), which is regular at p = 0.

use nalgebra::{Rotation3, Vector3};
use num_complex::Complex;

use super::corrections::{Change, Mean};
use super::inertia::HIGHEST;
use crate::orbit::Place;

type C64 = Complex<f64>;

/// g and the time derivatives of it that G may have.
pub(crate) const ORDERS: usize = 7;
/// Highest multiple of f in the last of them.
pub(crate) const WIDTH: usize = 5 + 2 * (ORDERS - 1);

/// One (h, m).
#[derive(Clone, Debug)]
pub(crate) struct Term {
    pub(crate) harmonic: i32,
    /// (iε)^j, without i for odd j, and the same times j + 1, by j.
    pub(crate) weights: [[f64; 2]; ORDERS],
    /// How many of them are not nothing.
    pub(crate) orders: usize,
    /// ε f_h √σ^|h|, and the factors of H0 and H1 in ∂/∂p and in ∂/∂p̄: the latter of the two H1 are equal.
    pub(crate) value: f64,
    pub(crate) by_p: f64,
    pub(crate) by_p_bar: f64,
    pub(crate) by_frequency: f64,
}

/// Terms by m, the Fourier polynomials, and the plane of the orbit.
#[derive(Clone, Debug)]
pub(crate) struct Generator {
    pub(crate) terms: [Vec<Term>; 3],
    pub(crate) orbital: Orbital,
    /// To the pericentre and across it, inertial.
    pub(crate) axes: [Vector3<f64>; 2],
    /// 3n²/2 times the disturbing mass fraction.
    pub(crate) strength: f64,
    pub(crate) root: f64,
}

/// Time derivatives of (a/r)³ times 1, cos 2f, sin 2f: [j][g] with the coefficients of cos kf, for even j of 1 and cos 2f and odd j of sin 2f, or else of sin kf.
#[derive(Clone, Debug, Default)]
pub(crate) struct Orbital {
    pub(crate) series: Vec<[Vec<f64>; 3]>,
}

impl Orbital {
    /// As many derivatives as `orders` by a body of mean motion n; n η^(−3) w² d/df, w = 1 + e cos f.
    pub(crate) fn new(eccentricity: f64, mean_motion: f64, orders: usize) -> Self {
        let eta_square = 1.0 - eccentricity * eccentricity;
        let rate = mean_motion / (eta_square * eta_square.sqrt());
        let unit = |k: usize| -> Vec<f64> { (0..=WIDTH).map(|i| if i == k { 1.0 } else { 0.0 }).collect() };
        let mut current = [(unit(0), false), (unit(2), false), (unit(2), true)].map(|(series, odd)| {
            let cubed = (0..3).fold(series, |series, _| times_w(&series, eccentricity, odd));
            (cubed.iter().map(|c| c / eta_square.powi(3)).collect::<Vec<f64>>(), odd)
        });
        let mut series = Vec::new();
        for _ in 0..orders {
            series.push(current.each_ref().map(|(coefficients, _)| trimmed(coefficients)));
            current = current.map(|(coefficients, odd)| {
                let sign = if odd { rate } else { -rate };
                let slope: Vec<f64> = coefficients.iter().enumerate().map(|(k, c)| sign * k as f64 * c).collect();
                let weighted = (0..2).fold(slope, |series, _| times_w(&series, eccentricity, !odd));
                (weighted, !odd)
            });
        }
        Self { series }
    }
}

/// A series in cos kf, or in sin kf, times 1 + e cos f.
fn times_w(series: &[f64], eccentricity: f64, odd: bool) -> Vec<f64> {
    let at = |k: usize| series.get(k).copied().unwrap_or_default();
    let half = 0.5 * eccentricity;
    let mut product: Vec<f64> = (0..series.len()).map(|k| at(k) + half * (at(k + 1) + at(k.wrapping_sub(1)))).collect();
    // cos(−f) = cos f, sin(−f) = −sin f, and the mean is counted once.
    match odd {
        true => product[0] = 0.0,
        false => product[1] += half * at(0),
    }
    product
}

/// Without the highest coefficients that are nothing beside the largest.
fn trimmed(series: &[f64]) -> Vec<f64> {
    let largest = series.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let kept = series.iter().rposition(|c| c.abs() > 1e-18 * largest).map_or(0, |last| last + 1);
    series[..kept].to_vec()
}

/// cos kf and sin kf.
struct Circle([[f64; 2]; WIDTH + 1]);

impl Circle {
    fn new(place: &Place, width: usize) -> Self {
        let mut circle = [[1.0, 0.0]; WIDTH + 1];
        for k in 1..width {
            let [cosine, sine] = circle[k - 1];
            circle[k] = [cosine * place.cosine - sine * place.sine, sine * place.cosine + cosine * place.sine];
        }
        Self(circle)
    }

    fn sum(&self, series: &[f64], part: usize) -> f64 {
        series.iter().zip(&self.0).map(|(c, turn)| c * turn[part]).sum()
    }
}

/// What r̂r̂ gives to a multiple of y′, r₃² − ⅓, r̄₊ r₃, r̄₊², and its derivatives when the frame turns about its axes 1 and 2; times i for odd j.
type Contracted = [[C64; 3]; ORDERS];

impl Generator {
    /// The changes from mean to osculating variables, for |p| = √σ.
    pub(crate) fn at(&self, mean: &Mean, place: &Place) -> Change {
        let rotation: Rotation3<f64> = mean.frame.to_rotation_matrix();
        let [first, second] = self.axes.map(|axis| rotation.inverse_transform_vector(&axis));
        let orders = self.orbital.series.len();
        let width = self.orbital.series.iter().flatten().map(Vec::len).max().unwrap_or_default();
        let circle = Circle::new(place, width);
        let mut tensors = [[0.0; 6]; ORDERS];
        for (j, (tensor, [one, cosine, sine])) in tensors.iter_mut().zip(&self.orbital.series).enumerate() {
            let (even, odd) = (j % 2, 1 - j % 2);
            let (one, cosine, sine) =
                (circle.sum(one, even), circle.sum(cosine, even), circle.sum(sine, odd));
            // r̂r̂ = (PP + QQ)/2 + (PP − QQ)/2 cos 2f + (PQ + QP)/2 sin 2f.
            let (pp, qq, pq) = (0.5 * (one + cosine), 0.5 * (one - cosine), 0.5 * sine);
            for (slot, (a, b)) in tensor.iter_mut().zip([(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]) {
                *slot = pp * first[a] * first[b]
                    + qq * second[a] * second[b]
                    + pq * (first[a] * second[b] + first[b] * second[a]);
            }
        }
        let modulus = mean.p.norm();
        let turn = if modulus == 0.0 { C64::new(1.0, 0.0) } else { mean.p / modulus };
        let mut sums = Sums::default();
        for (multiple, terms) in self.terms.iter().enumerate() {
            if terms.is_empty() {
                continue;
            }
            let mut contracted = [[C64::default(); 3]; ORDERS];
            for (j, (slot, tensor)) in contracted.iter_mut().zip(&tensors).take(orders).enumerate() {
                *slot = contractions(tensor, multiple);
                if j % 2 == 1 {
                    *slot = slot.map(|c| C64::new(-c.im, c.re));
                }
            }
            sums.add(terms, multiple, &contracted, turn, mean.longitude);
        }
        sums.change(mean, turn, self.root, self.strength)
    }

    /// The number of terms.
    pub(crate) fn count(&self) -> usize {
        self.terms.iter().map(Vec::len).sum()
    }
}

fn contractions(tensor: &[f64; 6], multiple: usize) -> [C64; 3] {
    let c = C64::new;
    let [xx, yy, zz, xy, xz, yz] = *tensor;
    match multiple {
        0 => [c(zz - 0.5 * (xx + yy), 0.0), c(-3.0 * yz, 0.0), c(3.0 * xz, 0.0)],
        1 => [c(xz, -yz), c(-xy, yy - zz), c(xx - zz, -xy)],
        _ => [c(xx - yy, -2.0 * xy), c(-2.0 * yz, -2.0 * xz), c(-2.0 * xz, 2.0 * yz)],
    }
}

/// Derivatives of W over the strength.
#[derive(Default)]
struct Sums {
    by_p: C64,
    by_p_bar: C64,
    by_longitude: f64,
    by_momentum: f64,
    by_rotation: [f64; 2],
}

impl Sums {
    fn add(&mut self, terms: &[Term], multiple: usize, contracted: &Contracted, turn: C64, longitude: f64) {
        // −i of 1/(iΩ), and −i of t1: their coefficients are real without it.
        let phase = if multiple == 1 { C64::new(-2.0, 0.0) } else { C64::new(0.0, -2.0) };
        let spin = phase * C64::from_polar(1.0, multiple as f64 * longitude);
        let mut turns = [C64::new(1.0, 0.0); HIGHEST + 1];
        let widest = terms.iter().map(|term| term.harmonic.unsigned_abs()).max().unwrap_or_default();
        for h in 1..=widest as usize {
            turns[h] = turns[h - 1] * turn;
        }
        let mut by_longitude = 0.0;
        for term in terms {
            let power = turns[term.harmonic.unsigned_abs() as usize];
            let factor = spin * if term.harmonic < 0 { power.conj() } else { power };
            let mut series = [C64::default(); 4];
            for (weights, [whole, first, second]) in term.weights.iter().zip(contracted).take(term.orders) {
                series[0] += whole * weights[0];
                series[1] += whole * weights[1];
                series[2] += first * weights[0];
                series[3] += second * weights[0];
            }
            let [whole, slope, first, second] = series.map(|sum| sum * factor);
            by_longitude += term.value * whole.im;
            self.by_momentum -= term.value * slope.re;
            self.by_rotation[0] += term.value * first.re;
            self.by_rotation[1] += term.value * second.re;
            let common = slope * term.by_frequency;
            self.by_p += whole * term.by_p + common;
            self.by_p_bar += whole * term.by_p_bar + common;
        }
        self.by_longitude -= multiple as f64 * by_longitude;
    }

    fn change(&self, mean: &Mean, turn: C64, root: f64, strength: f64) -> Change {
        let momentum = -strength * self.by_longitude;
        // The real part of X counts: ∂/∂p̄ of it is (∂X/∂p̄ + conj ∂X/∂p)/2.
        let by_p_bar = (self.by_p_bar + self.by_p.conj()) * 0.5;
        let circling = 2.0 * root * by_p_bar.re;
        let [x, y] = self.by_rotation.map(|part| -strength * part / mean.momentum);
        Change {
            p: turn * (C64::i() * by_p_bar * (strength / mean.momentum)) - mean.p * (0.5 * momentum / mean.momentum),
            longitude: strength * (self.by_momentum - 0.5 * circling) / mean.momentum,
            momentum,
            // k × δ(Mk)/M turns k, and the frame with it.
            rotation: [-y, x],
        }
    }
}
