//! ⟨D⟩ + K2 averaged over the orbit as well, in closed form.
//!
//! Let k_P, k_Q, k_N be the components of k along the pericentre, across it and along the normal, ρ = k_P² + k_Q², δ = k_P² − k_Q², and
//! ⟨D⟩ = C (a/r)³ ((k·r̂)² − ⅓). Then
//!
//! ```text
//! K̄ = C η^(−3) (½ρ − ⅓) + (C²/Mn) k_N (I_c ρ + I_1 δ) + ⟨K2⟩
//! I_c = −η^(−6) (¼ + e²/6)          I_1 = −¼ η^(−6) e²
//! ```
//!
//! The middle term is the effect of second order of the part of ⟨D⟩ that is periodic in the true anomaly f, whose mean over f is 0
//! ([`OrbitPeriodic`]). K̄ acts in the time f/n. ⟨K2⟩ has the means of (a/r)⁶ and (a/r)⁶ ḟ times powers of k·r̂. K̄ is a
//! polynomial in ρ, δ and k_N. For e = 0 it has no δ, and k precesses steadily about the normal. For e ≠ 0 it nods with twice the angle of the node.

use super::k2::{Hamiltonian, MeanRates, dot};
use super::k2_remainder::SteadyRates;
use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::kepler::Place;
use crate::simd::lanes::Lanes;
use nalgebra::Vector3;

/// Factors of 1, ρ, δ, ρ², ρδ, δ², k_N, k_N ρ, k_N δ.
type MeanFactors = [f64; 9];

/// K̄ at one mean σ and M, as a function of the angular momentum's direction.
#[derive(Clone, Debug)]
pub(crate) struct OrbitAverage {
    /// K̄, and its derivatives with respect to L and to M at fixed L.
    rows: [MeanFactors; 3],
    momentum: f64,
    axes: [Vector3<f64>; 3],
    steady: SteadyRates,
}

impl OrbitAverage {
    /// From ⟨D⟩ + K2, and the eccentricity, the mean motion and the axes of the orbit.
    pub(crate) fn new(hamiltonian: &Hamiltonian, eccentricity: f64, mean_motion: f64, axes: [Vector3<f64>; 3]) -> Self {
        let Hamiltonian { first, second, momentum, steady } = hamiltonian;
        let means = OrbitMeans::new(eccentricity, mean_motion);
        let squares = hamiltonian.squares(mean_motion);
        let rows = std::array::from_fn(|row| means.coefficients(first[row], squares[row], &second[row]));
        Self { rows, momentum: *momentum, axes, steady: *steady }
    }

    /// The derivatives of the mean variables for an angular momentum along a unit vector.
    pub(crate) fn slopes(&self, axis: &Vector3<f64>) -> MeanRates {
        let [p, q, n] = self.axes.map(|direction| axis.dot(&direction));
        let (rho, delta) = (p * p + q * q, p * p - q * q);
        let value = |[one, r, d, rr, rd, dd, z, zr, zd]: MeanFactors| {
            one + rho * (r + rr * rho + rd * delta) + delta * (d + dd * delta) + n * (z + zr * rho + zd * delta)
        };
        let [_, r, d, rr, rd, dd, z, zr, zd] = self.rows[0];
        let by_rho = r + 2.0 * rr * rho + rd * delta + n * zr;
        let by_delta = d + rd * rho + 2.0 * dd * delta + n * zd;
        let force = self.axes[0] * (2.0 * p * (by_rho + by_delta))
            + self.axes[1] * (2.0 * q * (by_rho - by_delta))
            + self.axes[2] * (z + zr * rho + zd * delta)
            + self.steady.force;
        MeanRates {
            turning: (force - axis * axis.dot(&force)) / self.momentum,
            phases: [0, 1].map(|i| value(self.rows[i + 1]) + self.steady.phases[i]),
        }
    }

    /// An upper bound of the rate at which the angular momentum turns.
    pub(crate) fn fastest(&self) -> f64 {
        let [_, r, d, rr, rd, dd, z, zr, zd] = self.rows[0].map(f64::abs);
        (2.0 * (r + d) + 4.0 * (rr + rd + dd) + z + 3.0 * (zr + zd) + self.steady.force.norm()) / self.momentum
    }
}

/// The means over one orbit.
struct OrbitMeans {
    /// ⟨(a/r)³⟩.
    cube: f64,
    /// I_c and I_1.
    square: [f64; 2],
    /// ⟨(a/r)⁶⟩ times c0, c2, c4: the even cosines of the true anomaly.
    still: [f64; 3],
    /// ⟨(a/r)⁶ ḟ⟩ times d0 and d2.
    moving: [f64; 2],
}

impl OrbitMeans {
    fn new(e: f64, mean_motion: f64) -> Self {
        let square = e * e;
        let eta = ((1.0 - e) * (1.0 + e)).sqrt();
        let cube = eta.powi(-3);
        let [still, moving] = [cube.powi(3), mean_motion * cube.powi(4)];
        Self {
            cube,
            square: [-cube * cube * (0.25 + square / 6.0), -0.25 * cube * cube * square],
            still: [
                still * (1.0 + square * (3.0 + 0.375 * square)),
                still * square * (1.5 + 0.25 * square),
                still * square * square / 16.0,
            ],
            moving: [
                moving * (1.0 + square * (7.5 + square * (5.625 + 0.3125 * square))),
                moving * square * (3.75 + square * (3.75 + 0.234_375 * square)),
            ],
        }
    }

    /// One row of K̄, from the factors of ⟨D⟩, of C²/Mn and of K2.
    fn coefficients(&self, first: f64, square: f64, second: &[f64; 5]) -> MeanFactors {
        let [p0, p1, p2, q0, q1] = *second;
        let [c0, c2, c4] = self.still;
        let [d0, d2] = self.moving;
        [
            p0 * c0 - first * self.cube / 3.0,
            0.5 * (p1 * c0 + first * self.cube),
            0.5 * p1 * c2,
            p2 * (0.375 * c0 - 0.125 * c4),
            0.5 * p2 * c2,
            0.25 * p2 * c4,
            q0 * d0,
            square * self.square[0] + 0.5 * q1 * d0,
            square * self.square[1] + 0.5 * q1 * d2,
        ]
    }
}

/// The highest harmonic of f.
const HIGHEST: usize = 8;
/// Number of series.
const SERIES: usize = 7;

/// The factors of a real or complex series Σ_k (p_k sin kf − i q_k cos kf), k from 1 on.
type SineSeries = [[f64; 2]; HIGHEST];

/// The factors of S0, S2, S4, of T0, T2, and of A.
#[derive(Clone, Copy, Debug)]
struct PoleFactors {
    still: [f64; 3],
    moving: [f64; 2],
    square: f64,
}

/// W₂ at one mean σ and M.
#[derive(Clone, Debug)]
pub(crate) struct OrbitPeriodic {
    /// Of W₂, and of its derivatives with respect to L and to M at fixed L.
    rows: [PoleFactors; 3],
    series: [SineSeries; SERIES],
    momentum: f64,
    mean_motion: f64,
    axes: [Vector3<f64>; 3],
    steady: SteadyRates,
}

impl OrbitPeriodic {
    /// From ⟨D⟩ + K2, and the eccentricity, the mean motion and the axes of the orbit.
    pub(crate) fn new(hamiltonian: &Hamiltonian, eccentricity: f64, mean_motion: f64, axes: [Vector3<f64>; 3]) -> Self {
        let Hamiltonian { second, momentum, steady, .. } = hamiltonian;
        let eta = ((1.0 - eccentricity) * (1.0 + eccentricity)).sqrt();
        let squares = hamiltonian.squares(mean_motion);
        let rows = std::array::from_fn(|row| {
            let [p0, p1, p2, q0, q1] = second[row];
            PoleFactors {
                still: [p0, p1, p2].map(|factor| factor / (mean_motion * eta.powi(9))),
                moving: [q0, q1].map(|factor| factor / eta.powi(12)),
                square: squares[row] / (mean_motion * eta.powi(6)),
            }
        });
        let [still, moving] = [4, 6].map(|power| DistancePowers::new(eccentricity, power));
        let [axial, double] = of_square(eccentricity);
        let series = [
            still.primitive(0),
            still.primitive(2),
            still.primitive(4),
            moving.primitive(0),
            moving.primitive(2),
            axial,
            double,
        ];
        Self { rows, series, momentum: *momentum, mean_motion, axes, steady: *steady }
    }

    /// The changes by W₂ for angular momenta along unit vectors: the rotation across them, and what is added to ℓ′ and y′.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(
        &self,
        axis: &[Lanes<S>; 3],
        place: &Place<S>,
    ) -> ([Lanes<S>; 3], [Lanes<S>; 2]) {
        let all = |value: f64| place.sine.all(value);
        let mut axes = [*axis; 3];
        for (lanes, direction) in axes.iter_mut().zip(&self.axes) {
            *lanes = [all(direction.x), all(direction.y), all(direction.z)];
        }
        let [p, q, n] = [dot(axis, &axes[0]), dot(axis, &axes[1]), dot(axis, &axes[2])];
        let [b0, b2, b4, d0, d2, axial, double] = self.sums(place);
        let (z, half) = (ComplexLanes { re: p, im: -q }, all(0.5));
        let conjugate = z.conjugate();
        let scaled = |c: ComplexLanes<S>, by: Lanes<S>| ComplexLanes { re: c.re * by, im: c.im * by };
        let rho = p.mul_add(p, q * q);
        // The gradient of Re z²B in the plane is 2zB, the P-component its real part and the Q-component its imaginary part.
        let [zb2, zd2, za] = [z * b2, z * d2, z * double];
        let zb4 = z * z * z * b4;
        let real = |c: ComplexLanes<S>| z.plus_re_of_product(c, all(0.0));
        let (by2, by4) = (real(zb2), real(zb4));
        let s2 = half * rho.mul_add(b0.re, by2);
        let s4 = (rho * half).mul_add((rho * all(0.75)).mul_add(b0.re, by2), by4 * all(0.125));
        let t2 = half * rho.mul_add(d0.re, real(zd2));
        let a = rho.mul_add(axial.re, real(za));
        let slope2 = scaled(conjugate, b0.re) + zb2;
        let slope4 = scaled(conjugate, (all(1.5) * rho).mul_add(b0.re, by2)) + scaled(zb2, rho) + scaled(zb4, half);
        let slope_t = scaled(conjugate, d0.re) + zd2;
        let slope_a = scaled(scaled(conjugate, axial.re) + za, all(2.0));

        let odd =
            |row: &PoleFactors| t2.mul_add(all(row.moving[1]), d0.re.mul_add(all(row.moving[0]), a * all(row.square)));
        // t − f/n, in which the constant rates act.
        let late = place.centre * all(-1.0 / self.mean_motion);
        let mut phases = [late; 2];
        for ((phase, row), steady) in phases.iter_mut().zip(&self.rows[1..]).zip(self.steady.phases) {
            let [p0, p1, p2] = row.still;
            let even = b0.re.mul_add(all(p0), s2.mul_add(all(p1), s4 * all(p2)));
            *phase = late.mul_add(all(steady), n.mul_add(odd(row), even));
        }
        let row = &self.rows[0];
        let plane = scaled(slope2, all(row.still[1]))
            + scaled(slope4, all(row.still[2]))
            + scaled(scaled(slope_t, all(row.moving[1])) + scaled(slope_a, all(row.square)), n);
        let along = odd(row);
        let mut force = *axis;
        for (c, component) in force.iter_mut().enumerate() {
            let constant = late * all(self.steady.force[c]);
            let inside = plane.re.mul_add(axes[0][c], plane.im.mul_add(axes[1][c], constant));
            *component = along.mul_add(axes[2][c], inside);
        }
        let beside = dot(axis, &force);
        let mut turning = force;
        for (component, axis) in turning.iter_mut().zip(axis) {
            *component = axis.negate_mul_add(beside, *component) * all(1.0 / self.momentum);
        }
        (turning, phases)
    }

    /// The series at places of the orbit.
    #[inline(always)]
    fn sums<S: InstructionSet>(&self, place: &Place<S>) -> [ComplexLanes<S>; SERIES] {
        let none = place.sine.all(0.0);
        let mut sums = [ComplexLanes { re: none, im: none }; SERIES];
        let (turn, mut power) = (place.turn(), place.turn());
        for k in 0..HIGHEST {
            for (sum, series) in sums.iter_mut().zip(&self.series) {
                let [p, q] = series[k];
                sum.re = power.im.mul_add(none.all(p), sum.re);
                sum.im = power.re.negate_mul_add(none.all(q), sum.im);
            }
            power = power * turn;
        }
        sums
    }
}

/// The Fourier coefficients of (1 + e cos f)^power, by the number of the harmonic from −8 to 8.
struct DistancePowers([f64; 2 * HIGHEST + 1]);

impl DistancePowers {
    fn new(eccentricity: f64, power: usize) -> Self {
        let mut coefficients = [0.0; 2 * HIGHEST + 1];
        coefficients[HIGHEST] = 1.0;
        for _ in 0..power {
            let before = coefficients;
            let at = |i: usize| before.get(i).copied().unwrap_or(0.0);
            coefficients =
                std::array::from_fn(|i| before[i] + 0.5 * eccentricity * (at(i + 1) + at(i.wrapping_sub(1))));
        }
        Self(coefficients)
    }

    /// The primitive of the product with e^(imf), without its mean.
    fn primitive(&self, m: usize) -> SineSeries {
        let of = |harmonic: i32| {
            let index = harmonic - m as i32 + HIGHEST as i32;
            usize::try_from(index).ok().and_then(|index| self.0.get(index)).copied().unwrap_or(0.0)
        };
        std::array::from_fn(|k| {
            let harmonic = k as i32 + 1; // k < 8
            let (plus, minus, inverse) = (of(harmonic), of(-harmonic), 1.0 / f64::from(harmonic));
            [(plus + minus) * inverse, (plus - minus) * inverse]
        })
    }
}

/// The two series of A: the factor of ρ, and B with Re z²B.
fn of_square(e: f64) -> [SineSeries; 2] {
    // g e^(2if) = Σ c_k e^(ikf), b = −i Σ (c_k/k) e^(ikf), a = −½ie (e^(if) − e^(−if)).
    let c = [0.0, 0.5 * e, 1.0, 0.5 * e];
    let (mut axial, mut double) = ([[0.0; 2]; HIGHEST], [[0.0; 2]; HIGHEST]);
    // ½ [(g + 1) b − g e^(2if) a] = −i Σ r_k e^(ikf).
    let mut r = [0.0; 5];
    for k in 1..=3 {
        let part = c[k] / k as f64;
        r[k] += part;
        r[k - 1] += 0.25 * e * (part + c[k]);
        r[k + 1] += 0.25 * e * (part - c[k]);
        for j in (1..=3).filter(|j| *j != k) {
            let apart = k.abs_diff(j);
            axial[apart - 1][0] -= 0.5 * c[j] * part / apart as f64;
        }
    }
    for (k, r) in r.into_iter().enumerate().skip(1) {
        double[k - 1] = [-r / k as f64; 2];
    }
    [axial, double]
}
