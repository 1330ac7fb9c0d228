//! Phases over long times: turns = frequency × time, in double-double, reduced before any sine is computed (theory §10).
//!
//! In double precision alone n·t is wrong by 6e-7 rad after 1e9 rotations. Here the frequency, the time since the epoch, their product and the phase at the
//! epoch have 32 digits. A phase in turns is reduced by subtracting integers and quarters, which is exact. The remaining rounding error is 1.4e-17 turns.

use super::instruction_set::InstructionSet;
use super::lanes::{INTEGERS, Lanes};
use super::sincos::sin_cos;
use crate::numerics::phase::Phase;

impl Phase {
    /// Whole turns since the epoch, and the angle beyond them, at most half a turn in either direction \[rad\].
    #[inline(always)]
    pub(crate) fn turns_and_angle<S: InstructionSet>(&self, elapsed: (Lanes<S>, Lanes<S>)) -> (Lanes<S>, Lanes<S>) {
        let (product, fraction, rest) = self.reduced(elapsed);
        let start = product.all(self.start.high);
        // Knuth's sum.
        let sum = fraction + start;
        let added = sum - fraction;
        let lost = (fraction - (sum - added)) + (start - added);
        let turns = sum.rounded();
        let beyond = (sum - turns) + (lost + rest);
        // The rest may move the angle past half a turn; the angle then belongs to the next turn.
        let over = beyond.rounded();
        (product.rounded() + (turns + over), (beyond - over) * product.all(std::f64::consts::TAU))
    }

    /// [`Phase::turns_and_angle`] for one time.
    pub(crate) fn turns_and_angle_at(&self, (high, low): (f64, f64)) -> (f64, f64) {
        let elapsed = (Lanes::splat(pulp::Scalar, high), Lanes::splat(pulp::Scalar, low));
        let (turns, angle) = self.turns_and_angle(elapsed);
        (turns.values()[0], angle.values()[0])
    }

    /// The angle beyond whole turns at one time \[rad\].
    pub(crate) fn angle(&self, elapsed: (f64, f64)) -> f64 {
        self.turns_and_angle_at(elapsed).1
    }

    /// (sin, cos) of the phase at the time `elapsed` = (high, low) after the epoch.
    #[inline(always)]
    pub(crate) fn sin_cos<S: InstructionSet>(&self, elapsed: (Lanes<S>, Lanes<S>)) -> (Lanes<S>, Lanes<S>) {
        let (_, fraction, rest) = self.reduced(elapsed);
        self.circle(fraction, rest)
    }

    /// (sin, cos) of the phase plus `turns`.
    #[inline(always)]
    pub(crate) fn sin_cos_beyond<S: InstructionSet>(
        &self,
        elapsed: (Lanes<S>, Lanes<S>),
        turns: Lanes<S>,
    ) -> (Lanes<S>, Lanes<S>) {
        let (_, fraction, rest) = self.reduced(elapsed);
        self.circle(fraction, rest + (turns - turns.rounded()))
    }

    /// Frequency × time rounded to an integer, the fraction beyond it, and the low part of the phase without the turns at the epoch.
    #[inline(always)]
    fn reduced<S: InstructionSet>(&self, elapsed: (Lanes<S>, Lanes<S>)) -> (Lanes<S>, Lanes<S>, Lanes<S>) {
        let (high, low) = (elapsed.0.all(self.frequency.high), elapsed.0.all(self.frequency.low));
        let product = high * elapsed.0;
        let error = high.product_error(elapsed.0, product);
        let rest = low.mul_add(elapsed.0, error + product.all(self.start.low));
        let rest = high.mul_add(elapsed.1, rest);
        (product, product - product.rounded(), rest)
    }

    #[inline(always)]
    fn circle<S: InstructionSet>(&self, fraction: Lanes<S>, rest: Lanes<S>) -> (Lanes<S>, Lanes<S>) {
        let (start, integers) = (fraction.all(self.start.high), fraction.all(INTEGERS));
        // Both start and k/4 are multiples of 2^−53, so their difference is exact. The sum is then below 1/8 of a turn and rounds there.
        let quarters = (start + (fraction + rest)).mul_add(fraction.all(4.0), integers);
        let x = ((quarters - integers).negate_mul_add(fraction.all(0.25), start) + fraction) + rest;
        sin_cos(x, quarters)
    }
}

/// Time since the epoch, with its rounding error.
#[inline(always)]
pub(crate) fn elapsed<S: InstructionSet>(time: Lanes<S>, epoch: Lanes<S>) -> (Lanes<S>, Lanes<S>) {
    // Knuth's sum of time and −epoch.
    let high = time - epoch;
    let virtual_epoch = time - high;
    (high, (time - (high + virtual_epoch)) + (virtual_epoch - epoch))
}
