//! The disturbing body's part of the torque as a Fourier series in its mean anomaly l, and the divisors that belong to it.
//!
//! With U = (a/r)³ r̂r̂ᵀ = Σ_j U_j e^(ijl), the solution of V̇ + iΩV = U is Σ_j U_j e^(ijl)/(i(Ω + jn)). The sums over time derivatives are its expansion in
//! jn/Ω: they have low harmonics to a few powers, and high ones not at all. Here nothing is expanded. A harmonic that does not return within the time T is no
//! part of the mean: with x = Ω + jn the divisor has the factor 1 − e^(−x²T²/4). The factor must reach 1 fast: with 1 − sin(xT)/(xT), which is that of the mean
//! over (−T, T), the error of the attitude was four times as large in scenes without a resonance, because the corrections take the regular harmonics as a
//! whole.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use num_complex::Complex;

use super::modes::slowest;
use super::pairs::{Tensor, contraction};
use crate::gravity_gradient::corrections::{Demand, Mean};
use crate::gravity_gradient::envelope::Reach;
use crate::simd::kepler::Place;

type C64 = Complex<f64>;

/// Logarithm of the largest harmonic over the first that is left out.
const RANGE: f64 = 28.0;
/// Most harmonics; more are needed from an eccentricity of 0.8 on.
const MOST: f64 = 320.0;

/// Least span in orbits.
const FEWEST_ORBITS: f64 = 1.5;
/// From this xT/2 on, 1 − e^(−x²T²/4) is 1.
const WHOLE: f64 = 6.1;
/// Harmonics with a larger divisor, over Ω, are in the sums over time derivatives: the corrections take them out at any time.
const NEAR: f64 = 0.5;

/// The series of one orbit at one place of the disturbing body.
pub(super) struct Harmonics {
    /// U_j e^(ijl) of (a/r)³ times 1, cos 2f and sin 2f, from −j to j.
    turned: Vec<[C64; 3]>,
    /// c_m for m = 0, 1, 2 of the tensors that belong to these functions.
    contracted: [[C64; 3]; 3],
    mean_motion: f64,
    /// T.
    duration: f64,
    /// Terms of a lower frequency have no sum over time derivatives.
    slowest: f64,
}

/// Number of harmonics on each side of 0: they fall like e^(−|j|(arcosh 1/e − η)), as Hansen's coefficients do.
fn count(eccentricity: f64) -> Option<usize> {
    if eccentricity == 0.0 {
        return Some(2);
    }
    let eta = ((1.0 - eccentricity) * (1.0 + eccentricity)).sqrt();
    let count = 6.0 + RANGE / ((1.0 / eccentricity).acosh() - eta);
    (count <= MOST).then_some(count as usize)
}

/// Whether the series is better than the sums: it is short enough, and the span has several orbits. Far from the pericentre the sums lack nothing until the
/// next passage, while the series takes the mean over all passages.
pub(crate) fn serves(reach: &Reach) -> bool {
    reach.orbital >= FEWEST_ORBITS * TAU && count(reach.eccentricity).is_some()
}

impl Harmonics {
    /// The series in the frame of a mean state; `None` where it is too long.
    pub(super) fn new(mean: &Mean, place: &Place<pulp::Scalar>, demand: &Demand<'_>) -> Option<Self> {
        let eccentricity = demand.orbit.eccentricity();
        let count = count(eccentricity)?;
        let coefficients = coefficients(eccentricity, count);
        let at = place.angle.values()[0] - place.centre.values()[0];
        let turned = (0..=2 * count).map(|i| {
            let j = i as f64 - count as f64;
            let [one, cosine, sine] = coefficients[i.abs_diff(count)];
            let turn = C64::from_polar(1.0, j * at);
            [turn * one, turn * cosine, turn * C64::new(0.0, -sine * j.signum())]
        });
        let [first, second, _] = demand.orbit.axes().map(|axis| mean.frame.inverse() * axis);
        let tensors = [
            [(first, first, 0.5), (second, second, 0.5)],
            [(first, first, 0.5), (second, second, -0.5)],
            [(first, second, 0.5), (second, first, 0.5)],
        ]
        .map(|[one, other]| -> Tensor { std::array::from_fn(|i| product(&one, i) + product(&other, i)) });
        Some(Self {
            turned: turned.collect(),
            contracted: [0, 1, 2].map(|m| tensors.map(|tensor| contraction(&tensor, m)[0])),
            mean_motion: demand.mean_motion,
            duration: demand.duration,
            slowest: slowest(demand),
        })
    }

    /// c_m of V for a frequency Ω.
    pub(super) fn solution(&self, omega: f64, multiple: i32) -> C64 {
        let count = (self.turned.len() / 2) as f64;
        let mut sums = [C64::default(); 3];
        for (i, harmonic) in self.turned.iter().enumerate() {
            let divisor = omega + (i as f64 - count) * self.mean_motion;
            let inverse = self.inverse(divisor, omega);
            for (sum, part) in sums.iter_mut().zip(harmonic) {
                *sum += part * inverse;
            }
        }
        let contracted = &self.contracted[multiple as usize]; // 0 ≤ m ≤ 2
        sums.iter().zip(contracted).map(|(sum, part)| sum * part).sum::<C64>() * -C64::i()
    }

    /// The reciprocal of a divisor, with its factor where the sums over time derivatives lack the harmonic.
    fn inverse(&self, divisor: f64, omega: f64) -> f64 {
        let turn = 0.5 * divisor * self.duration;
        let summed = omega.abs() > self.slowest && divisor.abs() > NEAR * omega.abs();
        if turn.abs() > WHOLE || summed {
            1.0 / divisor
        } else if turn == 0.0 {
            0.0
        } else {
            -(-turn * turn).exp_m1() / divisor
        }
    }
}

/// A component of a product of two vectors: 11, 22, 33, 12, 13, 23.
fn product((a, b, factor): &(Vector3<f64>, Vector3<f64>, f64), component: usize) -> f64 {
    const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    let (i, k) = PAIRS[component];
    factor * a[i] * b[k]
}

/// The coefficients of cos jl in (a/r)³ and (a/r)³ cos 2f and of sin jl in (a/r)³ sin 2f, halved but for j = 0.
fn coefficients(eccentricity: f64, count: usize) -> Vec<[f64; 3]> {
    // An even sum over more points than the integrand has harmonics in the eccentric anomaly is exact.
    let points = 32 + (1.25 * count as f64) as usize;
    let eta = ((1.0 - eccentricity) * (1.0 + eccentricity)).sqrt();
    let mut sums = vec![[0.0; 3]; count + 1];
    for k in 0..points {
        // Half the orbit: the other half is its mirror image.
        let anomaly = PI * (k as f64 + 0.5) / points as f64;
        let (sine, cosine) = anomaly.sin_cos();
        let distance = 1.0 - eccentricity * cosine;
        let (x, y) = ((cosine - eccentricity) / distance, eta * sine / distance);
        let weight = 1.0 / (distance * distance * points as f64);
        let [even, odd] = [weight * (x * x - y * y), weight * 2.0 * x * y];
        let turn = C64::from_polar(1.0, anomaly - eccentricity * sine);
        let mut wave = C64::new(1.0, 0.0);
        for sum in &mut sums {
            *sum = [sum[0] + weight * wave.re, sum[1] + even * wave.re, sum[2] + odd * wave.im];
            wave *= turn;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;
    use crate::gravity_gradient::envelope::whole;
    use crate::gravity_gradient::second_order::epoch::tensors;
    use crate::input::options::Level;
    use crate::input::orbit::Orbit;
    use crate::simd::lanes::Lanes;

    const MEAN_MOTION: f64 = 0.02;

    /// c_m of V for T, and by the quadrature ∫ e^(iΩs) U(s) ds over the period before, over 1 − e^(−iΩP).
    fn solutions(eccentricity: f64, omega: f64, multiple: i32, duration: f64) -> [C64; 2] {
        let orbit =
            Orbit::new(MEAN_MOTION, eccentricity).and_then(|orbit| orbit.plane(0.4, 1.0, 2.0)).expect("an orbit");
        let envelope = whole(eccentricity, MEAN_MOTION);
        let demand = Demand {
            orbit: &orbit,
            mean_motion: MEAN_MOTION,
            rates: [0.0; 2],
            axes: orbit.axes(),
            level: Level::Full,
            tolerance: 1e-30,
            duration,
            share: 0.0,
            exact: true,
            envelope: &envelope,
        };
        let frame = UnitQuaternion::from_euler_angles(0.3, -0.7, 1.1);
        let mean = Mean { p: C64::new(0.1, 0.0), longitude: 0.0, momentum: 1.0, frame };
        let place = |anomaly: f64| Place::of(Lanes::splat(pulp::Scalar, anomaly), eccentricity);
        let (points, start, period) = (4000, 0.8, TAU / MEAN_MOTION);
        let [first, second, _] = orbit.axes().map(|axis| frame.inverse() * axis);
        let sum: C64 = (0..points)
            .map(|k| {
                let back = k as f64 / points as f64;
                let wrapped = start - TAU * back;
                let place = place(wrapped - TAU * (wrapped / TAU).round());
                let (sine, cosine) = (place.sine.values()[0], place.cosine.values()[0]);
                let to_body = first * cosine + second * sine;
                let cube = ((1.0 + eccentricity * cosine) / (1.0 - eccentricity * eccentricity)).powi(3);
                let tensor: Tensor = std::array::from_fn(|i| product(&(to_body, to_body, cube), i));
                C64::from_polar(1.0, -omega * period * back) * contraction(&tensor, multiple)[0]
            })
            .sum();
        // The integrand jumps by 1 − e^(−iΩP) of its value at the end: the trapezoidal rule and its first correction.
        let now = tensors(&mean, &place(start), &demand);
        let value = |j: usize| contraction(&now.0[j], multiple)[0];
        let jump = 1.0 - C64::from_polar(1.0, -omega * period);
        let step = period / points as f64;
        let slope = C64::i() * omega * value(0) + value(1);
        let quadrature = (sum * step - value(0) * jump * (0.5 * step) - slope * jump * (step * step / 12.0)) / jump;
        let series = Harmonics::new(&mean, &place(start), &demand).expect("few harmonics");
        [series.solution(omega, multiple), quadrature]
    }

    #[test]
    fn the_series_solves_the_equation_of_the_generator_between_harmonics() {
        for (eccentricity, number) in [(0.0, 1.6), (0.1, 3.3), (0.6, 7.3), (0.6, -12.6), (0.75, 20.4)] {
            for multiple in 0..3 {
                let [series, quadrature] = solutions(eccentricity, number * MEAN_MOTION, multiple, 1e6);
                // Series left out at 1e-12, and (Ω step)⁴/720 of the quadrature.
                let gap = (series - quadrature).norm() / quadrature.norm();
                assert!(gap <= 1e-8, "{eccentricity} {number} {multiple}: {gap:e}");
            }
        }
    }

    #[test]
    fn a_harmonic_that_does_not_return_is_no_part_of_the_mean() {
        // Ω = −6.9999 n: the divisor of the seventh harmonic is 2e-6, which returns in 3e6 units of time.
        let at = |duration: f64| solutions(0.3, -6.9999 * MEAN_MOTION, 2, duration)[0].norm();
        let [short, long] = [at(1e3), at(1e8)];
        assert!(long >= 100.0 * short, "{short:e} {long:e}");
        // Those that the sums have are there in any time.
        assert!(at(1e-3) >= 0.1 * short, "{:e} {short:e}", at(1e-3));
    }

    #[test]
    fn orbits_with_too_many_harmonics_and_spans_of_one_orbit_are_left_to_the_sums() {
        let serves =
            |eccentricity: f64, orbits: f64| serves(&Reach { eccentricity, anomaly: 0.0, orbital: TAU * orbits });
        assert!(serves(0.0, 3.0) && serves(0.8, 3.0) && !serves(0.82, 3.0) && !serves(0.3, 1.4));
    }
}
