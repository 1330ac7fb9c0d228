//! How far a Fourier series is from a solution of the equations of motion.

use std::f64::consts::TAU;

use andoyer_series::BirkhoffMap;
use andoyer_series::num_complex::Complex;

use super::course::FourierMotion;
use super::lock::Lock;
use super::shape::LockedShape;
use crate::orbit::kepler::Place;
use crate::simd::lanes::Lanes;
use crate::torque::strength;

/// Orbits over the slowest period in which the series is inserted, and times in each.
const ORBITS: usize = 16;
const TIMES: usize = 8;
/// The step of a derivative by an imaginary number, which has no rounding error.
const STEP: f64 = 1e-100;
/// Largest sum of multiples of the proper angles, and largest multiples of M and α, whose divisors count.
const LOW: i64 = 2;
const MOST: i32 = 8;
/// A smaller divisor than that of the terms that turn fast in a mode.
const FAST: f64 = 0.5;

/// The error of the angles by the residual of the equations of motion. In the frame that turns with a mode, the mean over an orbit is divided by the
/// smallest divisor of the mode, and the rest by that of fast terms; of both the largest of some orbits counts.
pub(super) fn residual(map: &BirkhoffMap, lock: &Lock, course: &FourierMotion) -> f64 {
    let slowest = course.frequencies.iter().fold(1.0_f64, |least, rate| least.min(rate.abs()));
    let [change, back] = map.linear_changes();
    let (mut slow, mut fast) = ([0.0_f64; 3], [0.0_f64; 3]);
    for orbit in 0..ORBITS {
        let start = TAU * (orbit as f64 / (slowest * ORBITS as f64)).round();
        let mut means = [Complex::default(); 3];
        for k in 0..TIMES {
            let elapsed = start + TAU * k as f64 / TIMES as f64;
            let left = missing(lock, course, elapsed);
            let row = |row: usize| back[row].iter().zip(left).map(|(a, b)| a * b).sum::<f64>();
            for (mode, mean) in means.iter_mut().enumerate() {
                let left = Complex::new(row(2 * mode + 1), row(2 * mode));
                fast[mode] = fast[mode].max(left.norm());
                *mean += left * Complex::cis(-course.frequencies[mode] * elapsed) / TIMES as f64;
            }
        }
        slow.iter_mut().zip(means).for_each(|(most, mean)| *most = most.max(mean.norm()));
    }
    let angle = |angle: usize| {
        let of = |mode: usize| {
            let error = slow[mode] / divisor(course, lock.shape.is_tilted(), mode) + fast[mode] / FAST;
            error * change[angle][2 * mode].hypot(change[angle][2 * mode + 1])
        };
        (0..3).map(of).sum::<f64>()
    };
    [0, 2, 4].map(angle).iter().sum()
}

/// The smallest divisor of a mode: its frequency, or its difference from low multiples of the others and from those of a precessing orbit.
fn divisor(course: &FourierMotion, tilted: bool, mode: usize) -> f64 {
    let own = course.frequencies[mode].abs();
    let low = |multiples: &[i64]| (1..=LOW).contains(&multiples[..3].iter().map(|k| k.abs()).sum::<i64>());
    let others = course.harmonics.iter().map(|harmonic| &harmonic.multiples);
    let others = others.filter(|multiples| low(multiples) && (0..3).any(|k| k != mode && multiples[k] != 0));
    let least = others.map(|multiples| (course.rate(multiples).abs() - own).abs()).fold(own, f64::min);
    let most = if tilted { MOST } else { 0 };
    let [anomaly, node] = course.rates_of_orbit();
    let forced = (-most..=most).flat_map(|j| (-most..=most).map(move |k| f64::from(j) * anomaly + f64::from(k) * node));
    forced.map(|rate| (rate.abs() - own).abs()).fold(least, f64::min)
}

/// ẋ − {x; H} of the six variables.
fn missing(lock: &Lock, course: &FourierMotion, elapsed: f64) -> [f64; 6] {
    let (state, rates) = course.with_rates(elapsed);
    let [anomaly, node] = course.orbit_phases(elapsed);
    let slopes = slopes(&lock.shape, &state, anomaly, node);
    std::array::from_fn(
        |slot| if slot % 2 == 0 { rates[slot] - slopes[slot + 1] } else { rates[slot] + slopes[slot - 1] },
    )
}

/// The derivatives of H with respect to ψ, p_ψ, θ, p_θ, φ, p_φ.
fn slopes(shape: &LockedShape, state: &[f64; 6], anomaly: f64, node: f64) -> [f64; 6] {
    let turned = anomaly - TAU * (anomaly / TAU).round();
    let place = Place::of(Lanes::splat(pulp::Scalar, turned), shape.eccentricity);
    let angle = place.angle.values()[0];
    let e = shape.eccentricity;
    let inverse = (1.0 + e * angle.cos()) / ((1.0 - e) * (1.0 + e));
    let across = if shape.is_across() { std::f64::consts::FRAC_PI_2 } else { 0.0 };
    // Rz(−α) Rx(−δ) Rz(α + v), v = f − r M − ψ₀
    let seen = node + angle - f64::from(shape.twice) / 2.0 * anomaly - across;
    let ((sine, cosine), (tilt, level)) = (seen.sin_cos(), shape.precession.obliquity.sin_cos());
    let (x, y, z) = (cosine, sine * level, -sine * tilt);
    let (sin_node, cos_node) = node.sin_cos();
    let direction = [cos_node * x + sin_node * y, cos_node * y - sin_node * x, z];
    let torque = strength(shape.attraction) * inverse.powi(3);
    std::array::from_fn(|slot| {
        let mut at = state.map(|x| Complex::new(x, 0.0));
        at[slot].im = STEP;
        energy(shape, &at, direction, torque, node).im / STEP
    })
}

/// H of theory-locked (2) and (5).
fn energy(shape: &LockedShape, state: &[Complex<f64>; 6], direction: [f64; 3], torque: f64, node: f64) -> Complex<f64> {
    let &[psi, p_psi, theta, p_theta, phi, p_phi] = state;
    let p_psi = p_psi + shape.precession.spin;
    let [(sin_psi, cos_psi), (sin_theta, cos_theta), (sin_phi, cos_phi)] =
        [psi, theta, phi].map(|angle| (angle.sin(), angle.cos()));
    let along = (p_psi + p_phi * sin_theta) / cos_theta;
    let momenta = [p_phi, p_theta * cos_phi + along * sin_phi, along * cos_phi - p_theta * sin_phi];
    // Rᵀ times the direction.
    let [x, y, z] = direction;
    let (first, second) = (cos_psi * x + sin_psi * y, cos_psi * y - sin_psi * x);
    let third = sin_theta * first + cos_theta * z;
    let axes =
        [cos_theta * first - sin_theta * z, cos_phi * second + sin_phi * third, cos_phi * third - sin_phi * second];
    let mut sum = -p_psi * shape.precession.spin;
    for ((momentum, axis), moment) in momenta.iter().zip(axes).zip(shape.moments) {
        sum += momentum * momentum * (0.5 / moment) + axis * axis * (torque * moment);
    }
    let across = p_phi * cos_theta + along * sin_theta;
    let (first, second) = (cos_psi * across - sin_psi * p_theta, sin_psi * across + cos_psi * p_theta);
    sum - (first * node.sin() + second * node.cos()) * shape.precession.sideways
}
