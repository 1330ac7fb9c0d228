//! The kernel in Rust, compiled as it is emitted, and its largest difference from the library.

use super::constants::Constants;
use crate::error::Error;
use crate::motion::solved::Motion;

/// Times at which both are compared.
pub(super) const TIMES: u32 = 4096;
/// Rotations on either side of the epoch over which they lie if the scene has no span.
const ROTATIONS: f64 = 1e9;
/// 1/φ: its multiples fill the interval evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Largest differences are doubled, since there are times between, and the square roots of the languages may differ in the last bit.
const MARGIN: f64 = 2.0;
const LAST_BIT: f64 = 1e-15;

/// Bounds of the differences, and the interval in which they were measured.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) interval: [f64; 2],
    /// \[rad\]
    pub(super) attitude: f64,
    /// Of the angular velocity, over its length.
    pub(super) rates: f64,
}

impl Measured {
    pub(super) fn new(motion: &Motion, constants: &Constants) -> Result<Self, Error> {
        let interval = interval(motion, constants);
        let [start, stop] = interval;
        let times: Vec<f64> = (0..TIMES)
            .map(|k| match k {
                0 => start,
                1 => stop,
                _ => start + (stop - start) * (f64::from(k) * GOLDEN).fract(),
            })
            .collect();
        let (mut attitudes, mut rates) = (vec![[0.0; 4]; times.len()], vec![[0.0; 3]; times.len()]);
        motion.samples_into(&times, &mut attitudes, &mut rates)?;
        let (mut attitude_error, mut rate_error) = (0.0_f64, 0.0_f64);
        for ((time, attitude), rates) in times.iter().zip(&attitudes).zip(&rates) {
            let evaluate = if constants.powers { by_powers::at } else { by_harmonics::at };
            let Some((found, found_rates)) = evaluate(constants, *time) else { continue };
            attitude_error = attitude_error.max(2.0 * distance(attitude, &found));
            let length = rates.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
            if length > 0.0 {
                rate_error = rate_error.max(distance(&rates.map(|r| r / length), &found_rates.map(|r| r / length)));
            }
        }
        Ok(Self { interval, attitude: MARGIN * attitude_error + LAST_BIT, rates: MARGIN * rate_error + LAST_BIT })
    }
}

/// The span of the scene, or 1e9 rotations on either side of the epoch.
fn interval(motion: &Motion, constants: &Constants) -> [f64; 2] {
    if let Some((start, stop)) = motion.scene.asked_span() {
        return [start, stop]
            .map(|time| time.clamp(constants.epoch - constants.bound, constants.epoch + constants.bound));
    }
    let rate = motion.frequencies.longitude.abs();
    let far = if rate > 0.0 { (ROTATIONS * std::f64::consts::TAU / rate).min(constants.bound) } else { 1.0 };
    [constants.epoch - far, constants.epoch + far]
}

fn distance<const N: usize>(one: &[f64; N], other: &[f64; N]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The kernel with one of the two sums.
macro_rules! compiled {
    ($name:ident, $sums:literal) => {
#[allow(clippy::all, clippy::pedantic)] // as it is emitted
        #[rustfmt::skip]
        mod $name {
            include!("kernel/kernel.rs");
            include!($sums);

            /// Attitude and rates by these constants.
            pub(super) fn at(constants: &crate::motion_code::constants::Constants, time: f64) -> Option<([f64; 4], [f64; 3])> {
                let motion = Motion {
                    epoch: constants.epoch,
                    bound: constants.bound,
                    anomaly: constants.anomaly,
                    half_longitude: constants.half_longitude,
                    terms: &constants.terms,
                    attitude: constants.attitude,
                    rates: constants.rates,
                };
                evaluate(&motion, time)
            }
        }
    };
}
compiled!(by_powers, "kernel/powers.rs");
compiled!(by_harmonics, "kernel/harmonics.rs");
