//! Errors that steps leave, and states that are displaced by as much.

use super::series::{Row, norm};

/// Sum of the terms after the last one, relative to the last one: steps are e^−2 of the radius of convergence, so the sum is 0.16.
const OMITTED: f64 = 0.2;
/// Relative rounding errors of a torque and of ω × Iω.
pub(super) const ROUNDING: [f64; 2] = [4.0 * 1.2e-16, 2.0 * 1.2e-16];

/// How many displaced states there are.
pub(super) const PATTERNS: usize = 4;

/// Estimates of the errors that all steps leave together, of attitude \[rad\] and rates.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StepErrors {
    /// Sums of squares of the rounding errors, and sums of the errors that do not change their sign by chance.
    rounded: [f64; 2],
    systematic: [f64; 2],
    /// Rounding errors of the last step.
    pub(super) last: [f64; 2],
}

/// What the errors of a step depend on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StepSizes {
    /// The last coefficients of attitude and rates.
    pub(super) omitted: [f64; 2],
    /// Rounding errors in a unit of time.
    pub(super) rounding: [f64; 2],
    pub(super) radius: f64,
}

impl StepErrors {
    /// Adds the errors that a step may have made.
    #[inline(always)]
    pub(super) fn add(&mut self, length: f64, order: usize, StepSizes { omitted, rounding, radius }: StepSizes) {
        let last = OMITTED.max(length / (radius - length)) * length.powi(order as i32);
        self.systematic[0] += 2.0 * omitted[0] * last;
        self.systematic[1] += omitted[1] * last;
        self.last = rounding.map(|rate| rate * length);
        for (sum, error) in self.rounded.iter_mut().zip(self.last) {
            *sum += error * error;
        }
    }

    /// Estimates of the errors that all steps leave together.
    pub(super) fn all(&self) -> [f64; 2] {
        std::array::from_fn(|i| self.rounded[i].sqrt() + self.systematic[i])
    }

    /// Errors of attitude and rates by all steps relative to those by rounding alone, 1 or more.
    pub(super) fn systematic_share(&self) -> [f64; 2] {
        std::array::from_fn(|i| {
            let rounded = self.rounded[i].sqrt();
            if rounded > 0.0 { 1.0 + self.systematic[i] / rounded } else { 1.0 }
        })
    }
}

/// Signs that look like random ones, for four lanes of each of four states.
#[derive(Clone, Copy)]
pub(super) struct RandomSigns(u64);

impl RandomSigns {
    #[inline(always)]
    pub(super) fn next(random: &mut u64) -> Self {
        // Marsaglia's generator of 64 bits.
        *random ^= *random << 13;
        *random ^= *random >> 7;
        *random ^= *random << 17;
        Self(*random)
    }

    /// The changes of a lane of the attitude and of the rates, by noise of these sizes \[rad\] and rate.
    #[inline(always)]
    pub(super) fn times(self, [angle, rate]: [f64; 2], lane: usize) -> [f64; 2] {
        let sign = |bit: usize| if (self.0 >> bit) & 1 == 0 { 1.0 } else { -1.0 };
        // The fourth rate is 0.
        [0.5 * angle * sign(8 + lane), if lane % 4 < 3 { rate * sign(40 + lane) } else { 0.0 }]
    }
}

/// States with their mean at one state, and distances from the mean multiplied by a factor.
pub(super) fn moved<const N: usize>(states: &[[Row; 2]; N], to: [&Row; 2], factor: f64) -> [[Row; 2]; N] {
    let mean = |i: usize, part: usize| states.iter().map(|state| state[i][part]).sum::<f64>() / N as f64;
    let means: [Row; 2] = [0, 1].map(|i| [0, 1, 2, 3].map(|part| mean(i, part)));
    states.map(|state| {
        let [attitude, rates]: [Row; 2] =
            [0, 1].map(|i| [0, 1, 2, 3].map(|part| to[i][part] + factor * (state[i][part] - means[i][part])));
        let norm = norm(&attitude);
        [attitude.map(|part| part / norm), rates]
    })
}
