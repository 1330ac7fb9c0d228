//! How far a Fourier series is from a solution of the equations of motion.

use std::f64::consts::TAU;

use andoyer_series::num_complex::Complex;
use andoyer_series::periodic::{DrivenForm, Harmonic};

use super::course::FourierMotion;
use super::energy::{Drive, energy};
use super::lock::Lock;
use super::shape::LockedShape;

/// Orbits over the slowest period in which the series is inserted, and times in each.
const ORBITS: usize = 8;
const TIMES: usize = 8;
/// The step of a derivative by an imaginary number, which has no rounding error.
const STEP: f64 = 1e-100;
/// Largest sum of multiples of the proper angles whose divisors count.
const LOW: i64 = 2;
/// A harmonic moves a mode if its part in the mode is more than this fraction of its amplitudes. The rest is rounding.
const PART: f64 = 1e-9;
/// Turns by which two phases may differ and be one: rounding.
const SAME: f64 = 1e-9;
/// A smaller divisor than that of the terms that turn fast in a mode.
const FAST: f64 = 0.5;

/// The error of the angles over a time from the epoch by the residual of the equations of motion. In the frame that turns with a mode, the mean over an orbit is divided by the
/// smallest divisor of the mode, or taken over the whole time where that is less, and the rest is divided by the divisor of fast terms; of both the largest of some orbits counts.
pub(super) fn residual(form: &DrivenForm, lock: &Lock, course: &FourierMotion, longest: f64) -> f64 {
    let slowest = course.frequencies.iter().fold(1.0_f64, |least, rate| least.min(rate.abs()));
    let (mut slow, mut fast, mut seen) = ([0.0_f64; 3], [0.0_f64; 3], [[0.0_f64; 3]; 3]);
    // The frames at the times of an orbit.
    let mut frames: [Option<TimedFrame>; TIMES] = std::array::from_fn(|_| None);
    for orbit in 0..ORBITS {
        let start = TAU * (orbit as f64 / (slowest * ORBITS as f64)).round();
        let mut means = [Complex::default(); 3];
        let step = TAU / TIMES as f64;
        for (k, seen_at) in course.at_even_times(start, step, TIMES).iter().enumerate() {
            let elapsed = start + step * k as f64;
            let left = missing(lock, course, elapsed, seen_at);
            if left.iter().any(|x| !x.is_finite()) {
                return f64::INFINITY;
            }
            let phases = lock.shape.driven(course.orbit_phases(elapsed));
            let known = frames[k].take().filter(|known| known.is_at(&phases));
            let frame = known.unwrap_or_else(|| TimedFrame { matrices: form.frame(&phases), phases });
            let [change, inverse] = &frames[k].insert(frame).matrices;
            for (mode, mean) in means.iter_mut().enumerate() {
                let left: Complex<f64> = inverse[2 * mode + 1].iter().zip(left).map(|(a, b)| a * b).sum();
                fast[mode] = fast[mode].max(left.norm());
                *mean += left * Complex::cis(-course.frequencies[mode] * elapsed) / TIMES as f64;
                for (angle, seen) in seen.iter_mut().enumerate() {
                    // An angle is 2 Re(c U).
                    seen[mode] = seen[mode].max(2.0 * change[2 * angle][2 * mode + 1].norm());
                }
            }
        }
        slow.iter_mut().zip(means).for_each(|(most, mean)| *most = most.max(mean.norm()));
    }
    let [_, inverse] = form.frame(&lock.shape.driven(course.orbit_phases(0.0)));
    let growth = |mode: usize| longest.min(divisor(course, &inverse[2 * mode + 1], mode).recip());
    let error = |mode: usize| slow[mode] * growth(mode) + fast[mode] / FAST;
    seen.iter().map(|angle| (0..3).map(|mode| error(mode) * angle[mode]).sum::<f64>()).sum()
}

/// P and P⁻¹ at phases.
struct TimedFrame {
    phases: Vec<f64>,
    matrices: [Vec<Vec<Complex<f64>>>; 2],
}

impl TimedFrame {
    /// Whether other phases differ from these by whole turns, so that the frame is the same.
    fn is_at(&self, phases: &[f64]) -> bool {
        let mut turns = self.phases.iter().zip(phases).map(|(one, other)| (other - one) / TAU);
        turns.all(|turns| (turns - turns.round()).abs() < SAME)
    }
}

/// The smallest divisor of a mode: its frequency, or its difference from the rate of a harmonic that moves the mode and has low multiples.
fn divisor(course: &FourierMotion, mode_of: &[Complex<f64>], mode: usize) -> f64 {
    let own = course.frequencies[mode].abs();
    let size = |values: &[Complex<f64>]| values.iter().map(|c| c.norm()).sum::<f64>();
    let counts = |Harmonic { multiples, amplitudes }: &&Harmonic| {
        let moduli: Vec<i64> = multiples.iter().map(|k| k.abs()).collect();
        let is_own = moduli.iter().sum::<i64>() == 1 && moduli[mode] == 1;
        let part: Complex<f64> = mode_of.iter().zip(amplitudes).map(|(a, b)| a * b).sum();
        moduli[..3].iter().sum::<i64>() <= LOW && !is_own && part.norm() > PART * size(mode_of) * size(amplitudes)
    };
    let rates = course.harmonics.iter().filter(counts).map(|harmonic| course.rate(&harmonic.multiples));
    rates.map(|rate| (rate.abs() - own).abs()).fold(own, f64::min)
}

/// ẋ − {x; H} of the six variables, from x and ẋ.
fn missing(lock: &Lock, course: &FourierMotion, elapsed: f64, [state, rates]: &[[f64; 6]; 2]) -> [f64; 6] {
    let [anomaly, node] = course.orbit_phases(elapsed);
    let slopes = slopes(&lock.shape, state, anomaly, node);
    std::array::from_fn(
        |slot| if slot % 2 == 0 { rates[slot] - slopes[slot + 1] } else { rates[slot] + slopes[slot - 1] },
    )
}

/// The derivatives of H with respect to ψ, p_ψ, θ, p_θ, φ, p_φ.
fn slopes(shape: &LockedShape, state: &[f64; 6], anomaly: f64, node: f64) -> [f64; 6] {
    let drive = Drive::at(shape, [anomaly, node]);
    std::array::from_fn(|slot| {
        let mut at = state.map(|x| Complex::new(x, 0.0));
        at[slot].im = STEP;
        // Numbers have no error.
        energy(shape, &at, &drive).map_or(f64::NAN, |energy| energy.im / STEP)
    })
}
