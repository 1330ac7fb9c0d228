//! The terms of `plan.error_bound` other than truncation (theory §10).
//!
//! Inputs are taken as exact. The rounding error of the attitude is a constant plus a part for each harmonic. Phases add the relative error of double-double
//! times the span. Near the separatrix the relative error of Q1, which is a difference, counts for each half turn of the polhode. Near the middle axis an error
//! below the resolution of double-double grows like e^(λt).

use std::f64::consts::{FRAC_2_PI, TAU};

use andoyer_double::DoubleDouble;

use super::frequencies::Secular;
use super::harmonics::CayleyKleinSeries;
use super::polhode::Polhode;
use crate::input::scene::Scene;
use crate::numerics::scaling::scaled;

/// Rounding error of an attitude \[rad\]: the frames, two quaternion products, and the sums of eight harmonics each.
pub(crate) const ROUNDING: f64 = 3e-15;
/// Rotations over which the tolerance holds if no span is given.
pub(crate) const DEFAULT_ROTATIONS: f64 = 1e9;
/// Relative error of frequencies and phases in double-double: 2^−104 after twenty operations.
const PHASE_ROUNDING: f64 = 1e-30;
/// Relative error of the terms of Q1 in double-double, with inputs taken as exact.
pub(crate) const COSINE_ROUNDING: f64 = 1e-31;

/// Rounding error of an attitude with these harmonics \[rad\].
pub(crate) fn rounding(series: &CayleyKleinSeries) -> f64 {
    ROUNDING * (1.0 + series.harmonics() as f64 / 8.0)
}

/// Phase error over the span from the rounding error of Q1 \[rad\], for exact inputs. K contains −½ ln Q1, so the argument u of each half turn of ℓ′ is late by
/// half the relative error of Q1.
pub(crate) fn conditioning(scene: &Scene, polhode: &Polhode, rates: &Secular) -> f64 {
    // For an axisymmetric body Q is constant, and Q1 is not computed as a difference.
    if polhode.invariants.difference == DoubleDouble::ZERO {
        return 0.0;
    }
    let half_turns =
        (rates.anomaly_rate.to_f64() / rates.longitude_rate.to_f64()).abs() * rotations(scene, rates, polhode) * 2.0;
    let tensor = if scene.body().has_tensor() { tensor_rounding(polhode) } else { 0.0 };
    COSINE_ROUNDING * (polhode.invariants.cancellation + tensor) * half_turns
}

/// Rounding error of Q1 by that of the principal moments and axes of a tensor, relative to Q1 and to [`COSINE_ROUNDING`]. Q1 is proportional to the difference of
/// A (C − B) (C ω3)² and C (B − A) (A ω1)². Moments have errors relative to the largest moment, and rates those relative to the largest rate.
fn tensor_rounding(polhode: &Polhode) -> f64 {
    let [a, b, c] = polhode.moments;
    let [_, second] = polhode.invariants.excesses;
    let [upper, lower] = [b * second.to_f64().abs(), a * b / c * polhode.invariants.difference.to_f64().abs()];
    let [x, y, z] = std::array::from_fn(|axis| polhode.invariants.direction[axis].abs() / polhode.moments[axis]);
    let (largest, fastest) = (a.max(c), x.max(y).max(z));
    // The parts of both terms, whose sum is the cancellation and whose difference is 1.
    let parts = [1.0, -1.0].map(|sign| 0.5 * (polhode.invariants.cancellation + sign));
    let errors = [
        largest / a + largest / upper + 2.0 * (largest / c + fastest / z),
        largest / c + largest / lower + 2.0 * (largest / a + fastest / x),
    ];
    let seen = parts.into_iter().zip(errors).filter(|(part, _)| *part > f64::EPSILON);
    seen.map(|(part, error)| part * error).sum()
}

fn rotations(scene: &Scene, rates: &Secular, polhode: &Polhode) -> f64 {
    duration(scene, rates.longitude_rate, polhode.scales.1) * rates.longitude_rate.to_f64() / TAU
}

/// Error at the end of the span if a rotation near the middle axis is treated as a rotation about that axis \[rad\]; 0 on the axis itself.
///
/// With λ = (M/C)√(b(a−b)) the linear motion of g3 is g3 cosh λt + g1 √((a−b)/b) sinh λt. The motion of g1 is the same with the inverse of the square root. The
/// attitude follows this motion.
pub(crate) fn departure(scene: &Scene, polhode: &Polhode) -> f64 {
    let rates = scene.state().angular_velocity;
    if rates.iter().filter(|rate| **rate != 0.0).count() == 1 {
        return 0.0;
    }
    let [_, second] = polhode.invariants.excesses;
    let rate = (polhode.invariants.mean_rate * (second * polhode.invariants.difference).sqrt()).to_f64();
    let stretch = (polhode.invariants.difference / second).to_f64().sqrt();
    let [g1, _, g3] = polhode.invariants.direction.map(f64::abs);
    // Scaling may underflow the smallest rates to 0.
    let tilt = (g1 * (1.0 + stretch) + g3 * (1.0 + 1.0 / stretch)).max(f64::MIN_POSITIVE);
    2.0 * (tilt.ln() + rate * duration(scene, polhode.middle_rate(), polhode.scales.1)).exp()
}

/// Phase error over the span from the frequencies of a fixed order \[rad\].
pub(crate) fn drift(scene: &Scene, exact: &Secular, secular: &Secular, exponent: i32, quarter: f64) -> f64 {
    let anomaly = (exact.anomaly_rate - secular.anomaly_rate).to_f64().abs();
    let longitude = (exact.longitude_rate - secular.longitude_rate).to_f64().abs();
    // The polhode angle changes at most 2K/π times as fast as ℓ′.
    (FRAC_2_PI * quarter * anomaly + longitude) * duration(scene, exact.longitude_rate, exponent)
}

/// Error over the span from the rounding of frequencies and phases \[rad\].
pub(crate) fn phase_rounding(scene: &Scene, rate: DoubleDouble, exponent: i32) -> f64 {
    PHASE_ROUNDING * rate.to_f64() * duration(scene, rate, exponent)
}

/// The longest time from the epoch at which the tolerance must hold, in the scaled unit.
pub(crate) fn duration(scene: &Scene, rate: DoubleDouble, exponent: i32) -> f64 {
    let [before, after] = sides(scene, rate, exponent);
    before.max(after)
}

/// The longest times before and after the epoch at which the tolerance must hold, in the scaled unit.
pub(crate) fn sides(scene: &Scene, rate: DoubleDouble, exponent: i32) -> [f64; 2] {
    let epoch = scene.state().epoch;
    match scene.asked_span() {
        Some((start, stop)) => [epoch - start, stop - epoch].map(|time| scaled(time.max(0.0), exponent)),
        None => [DEFAULT_ROTATIONS * TAU / rate.to_f64(); 2],
    }
}
