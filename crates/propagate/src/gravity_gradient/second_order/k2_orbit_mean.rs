//! ⟨D⟩ + K2 averaged over the orbit, and the generating function W₂ of its periodic part (theory (10) to (13)).
//!
//! Let k_P, k_Q, k_N be the components of k along the pericentre, across it and along the normal, ϰ = k_P − ik_Q, ρ = |ϰ|², and f the true anomaly. Then
//! k_r = Re ϰ e^(if), and each part of ⟨D⟩ + K2 is a function of f and of k:
//!
//! ```text
//! υ k_r² = ½ (ρ b₀ + Re ϰ² b₂)          υ k_r⁴ = ⅜ρ² b₀ + ½ρ Re ϰ² b₂ + ⅛ Re ϰ⁴ b₄          b_m = υ e^(imf)
//! ```
//!
//! where υ is (a/r)⁶ or (a/r)⁶ ḟ. The second order of ⟨D⟩ is (ΓΔ)²/(Mn) k_N (ρ A + Re ϰ² B). K̄ has the means of these functions over f in the time f/n, and W₂ has
//! their primitives. For e = 0 the means of b₂, b₄ and B are 0, and k precesses steadily about the normal. For e ≠ 0 it nods with twice the angle of the node.

use super::k2::{Hamiltonian, across, dot, in_lanes};
use super::k2_remainder::SteadyRates;
use crate::orbit::kepler::Place;
use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use nalgebra::Vector3;

/// The highest harmonic of f.
const HIGHEST: usize = 8;
/// Number of functions of f: b₀, b₂, b₄ for (a/r)⁶, b₀, b₂ for (a/r)⁶ ḟ, A and B.
const FUNCTIONS: usize = 7;
/// The factors of ⟨D⟩, of P0, P1, P2, of Q0, Q1 and of A and B, with the powers of η and n.
type RowFactors = [f64; 7];

/// A function of f: its mean, and the primitive of the rest, Σ_k (p_k sin kf − i q_k cos kf) with k from 1 on.
#[derive(Clone, Copy, Debug)]
struct AnomalySeries {
    mean: f64,
    primitive: [[f64; 2]; HIGHEST],
}

/// K̄ and W₂ at one mean σ and M, as functions of the angular momentum's direction.
#[derive(Clone, Debug)]
pub(crate) struct OverOrbit {
    /// For the values, and for the derivatives with respect to L and to M at fixed L.
    rows: [RowFactors; 3],
    functions: [AnomalySeries; FUNCTIONS],
    momentum: f64,
    mean_motion: f64,
    axes: [Vector3<f64>; 3],
    steady: SteadyRates,
}

impl OverOrbit {
    /// From ⟨D⟩ + K2, and the eccentricity, the mean motion and the axes of the orbit.
    pub(crate) fn new(hamiltonian: &Hamiltonian, eccentricity: f64, mean_motion: f64, axes: [Vector3<f64>; 3]) -> Self {
        let Hamiltonian { first, second, momentum, steady } = *hamiltonian;
        let cube = ((1.0 - eccentricity) * (1.0 + eccentricity)).powf(-1.5);
        let squares = hamiltonian.squares(mean_motion);
        let rows = std::array::from_fn(|row| {
            let [p0, p1, p2] = [0, 1, 2].map(|i| second[row][i] * cube.powi(3));
            let [q0, q1] = [3, 4].map(|i| second[row][i] * mean_motion * cube.powi(4));
            [first[row] * cube, p0, p1, p2, q0, q1, squares[row] * cube * cube]
        });
        let [still, moving] = [4, 6].map(|power| powers_of_distance(eccentricity, power));
        let [a, b] = of_square(eccentricity);
        let harmonics = [(&still, 0), (&still, 2), (&still, 4), (&moving, 0), (&moving, 2)];
        let [b0, b2, b4, d0, d2] = harmonics.map(|(power, m)| AnomalySeries::new(power, m));
        Self { rows, functions: [b0, b2, b4, d0, d2, a, b], momentum, mean_motion, axes, steady }
    }

    /// The rates by K̄ for angular momenta along unit vectors: the rotation across them, and what is added to dℓ′/dt and dy′/dt.
    #[inline(always)]
    pub(crate) fn mean<S: InstructionSet>(&self, axis: &[Lanes<S>; 3]) -> ([Lanes<S>; 3], [Lanes<S>; 2]) {
        let none = axis[0].all(0.0);
        let mut functions = [ComplexLanes { re: none, im: none }; FUNCTIONS];
        for (lanes, function) in functions.iter_mut().zip(&self.functions) {
            lanes.re = none.all(function.mean);
        }
        self.slopes(axis, &functions, (none.all(1.0), none.all(1.0)))
    }

    /// The changes by W₂ for angular momenta along unit vectors: the rotation across them, and what is added to ℓ′ and y′.
    #[inline(always)]
    pub(crate) fn periodic<S: InstructionSet>(
        &self,
        axis: &[Lanes<S>; 3],
        place: &Place<S>,
    ) -> ([Lanes<S>; 3], [Lanes<S>; 2]) {
        let none = place.sine.all(0.0);
        let inverse = none.all(1.0 / self.mean_motion);
        let mut functions = [ComplexLanes { re: none, im: none }; FUNCTIONS];
        let (turn, mut power) = (place.turn(), place.turn());
        for k in 0..HIGHEST {
            let wave = ComplexLanes { re: power.re * inverse, im: power.im * inverse };
            for (sum, function) in functions.iter_mut().zip(&self.functions) {
                let [p, q] = function.primitive[k];
                sum.re = wave.im.mul_add(none.all(p), sum.re);
                sum.im = wave.re.negate_mul_add(none.all(q), sum.im);
            }
            power = power * turn;
        }
        // W₁ is not in W₂. The constant rates act in the time t − f/n.
        self.slopes(axis, &functions, (none, -(place.centre * inverse)))
    }

    /// The derivatives of K̄ or W₂ from the values of the functions. `first` is the factor of ⟨D⟩, 1 for K̄ and 0 for W₂; `time` multiplies the constant rates.
    #[inline(always)]
    fn slopes<S: InstructionSet>(
        &self,
        axis: &[Lanes<S>; 3],
        &[b0, b2, b4, d0, d2, a, b]: &[ComplexLanes<S>; FUNCTIONS],
        (first, time): (Lanes<S>, Lanes<S>),
    ) -> ([Lanes<S>; 3], [Lanes<S>; 2]) {
        let all = |value: f64| first.all(value);
        let axes = in_lanes(first, &self.axes);
        let [p, q, n] = [dot(axis, &axes[0]), dot(axis, &axes[1]), dot(axis, &axes[2])];
        let (z, conjugate, half) = (ComplexLanes { re: p, im: -q }, ComplexLanes { re: p, im: q }, all(0.5));
        let scaled = |c: ComplexLanes<S>, by: Lanes<S>| ComplexLanes { re: c.re * by, im: c.im * by };
        let rho = p.mul_add(p, q * q);
        // The gradient of Re ϰ²b in the plane is 2ϰb, the P-component its real part and the Q-component its imaginary part.
        let [zb2, zd2, zb] = [z * b2, z * d2, z * b];
        let zb4 = z * z * z * b4;
        let real = |c: ComplexLanes<S>| z.plus_re_of_product(c, all(0.0));
        let (by2, by4) = (real(zb2), real(zb4));
        let s0 = first * rho.mul_add(half, all(-1.0 / 3.0));
        let s2 = half * rho.mul_add(b0.re, by2);
        let s4 = (rho * half).mul_add((rho * all(0.75)).mul_add(b0.re, by2), by4 * all(0.125));
        let t2 = half * rho.mul_add(d0.re, real(zd2));
        let square = rho.mul_add(a.re, real(zb));
        let along =
            |[.., q0, q1, factor]: RowFactors| t2.mul_add(all(q1), d0.re.mul_add(all(q0), square * all(factor)));
        let mut phases = [time; 2];
        for ((phase, row), steady) in phases.iter_mut().zip(&self.rows[1..]).zip(self.steady.phases) {
            let [c, p0, p1, p2, ..] = *row;
            let even = s0.mul_add(all(c), b0.re.mul_add(all(p0), s2.mul_add(all(p1), s4 * all(p2))));
            *phase = time.mul_add(all(steady), n.mul_add(along(*row), even));
        }
        let [c, _, p1, p2, _, q1, factor] = self.rows[0];
        let slope4 = scaled(conjugate, (all(1.5) * rho).mul_add(b0.re, by2)) + scaled(zb2, rho) + scaled(zb4, half);
        let slope_t = scaled(conjugate, d0.re) + zd2;
        let slope_a = scaled(scaled(conjugate, a.re) + zb, all(2.0));
        let plane = scaled(conjugate, first.mul_add(all(c), b0.re * all(p1)))
            + scaled(zb2, all(p1))
            + scaled(slope4, all(p2))
            + scaled(scaled(slope_t, all(q1)) + scaled(slope_a, all(factor)), n);
        let normal = along(self.rows[0]);
        let mut force = *axis;
        for (c, component) in force.iter_mut().enumerate() {
            let constant = time * all(self.steady.force[c]);
            let inside = plane.re.mul_add(axes[0][c], plane.im.mul_add(axes[1][c], constant));
            *component = normal.mul_add(axes[2][c], inside);
        }
        (across(force, axis, all(1.0 / self.momentum)), phases)
    }

    /// An upper bound of the rate at which the mean angular momentum turns.
    pub(crate) fn fastest(&self) -> f64 {
        let [c, _, p1, p2, q0, q1, factor] = self.rows[0].map(f64::abs);
        let [b0, b2, b4, d0, d2, a, b] = self.functions.map(|function| function.mean.abs());
        let still = c + p1 * (b0 + b2) + p2 * (1.5 * b0 + 2.0 * b2 + 0.5 * b4);
        let moving = q0 * d0 + 1.5 * q1 * (d0 + d2) + 3.0 * factor * (a + b);
        (still + moving + self.steady.force.norm()) / self.momentum
    }
}

impl AnomalySeries {
    /// A power of 1 + e cos f times e^(imf).
    fn new(power: &[f64; 2 * HIGHEST + 1], m: usize) -> Self {
        let of = |harmonic: usize| power.get(harmonic).copied().unwrap_or(0.0);
        let primitive = std::array::from_fn(|k| {
            // The factors of e^(i(k+1)f) and e^(−i(k+1)f).
            let (plus, minus) = (of((HIGHEST + k + 1).wrapping_sub(m)), of((HIGHEST - k - 1).wrapping_sub(m)));
            [plus + minus, plus - minus].map(|part| part / (k + 1) as f64)
        });
        Self { mean: of(HIGHEST - m), primitive }
    }
}

/// The Fourier coefficients of a power of 1 + e cos f, from the harmonic −8 to 8.
fn powers_of_distance(eccentricity: f64, power: usize) -> [f64; 2 * HIGHEST + 1] {
    let mut coefficients = [0.0; 2 * HIGHEST + 1];
    coefficients[HIGHEST] = 1.0;
    for _ in 0..power {
        let before = coefficients;
        let at = |i: usize| before.get(i).copied().unwrap_or(0.0);
        coefficients = std::array::from_fn(|i| before[i] + 0.5 * eccentricity * (at(i + 1) + at(i.wrapping_sub(1))));
    }
    coefficients
}

/// A and B, without the powers of η.
fn of_square(e: f64) -> [AnomalySeries; 2] {
    // ϱ e^(2if) = Σ c_k e^(ikf), ς₂ = −i Σ (c_k/k) e^(ikf), e sin f = −½ie (e^(if) − e^(−if)).
    let c = [0.0, 0.5 * e, 1.0, 0.5 * e];
    let [mut axial, mut double] = [AnomalySeries { mean: 0.0, primitive: [[0.0; 2]; HIGHEST] }; 2];
    // ½ [(ϱ + 1) ς₂ − ϱ e^(2if) e sin f] = −i Σ r_k e^(ikf).
    let mut r = [0.0; 5];
    for k in 1..=3 {
        let part = c[k] / k as f64;
        r[k] += part;
        r[k - 1] += 0.25 * e * (part + c[k]);
        r[k + 1] += 0.25 * e * (part - c[k]);
        for (j, other) in c.iter().enumerate().skip(1) {
            match k.abs_diff(j) {
                0 => axial.mean -= 0.5 * other * part,
                apart => axial.primitive[apart - 1][0] -= 0.5 * other * part / apart as f64,
            }
        }
    }
    double.mean = -r[0];
    for (k, r) in r.into_iter().enumerate().skip(1) {
        double.primitive[k - 1] = [-r / k as f64; 2];
    }
    [axial, double]
}
