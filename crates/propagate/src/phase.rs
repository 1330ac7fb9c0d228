//! Phases that last: turns = frequency × time, in double-double, reduced before any sine (theory §10).
//!
//! In double precision alone n·t is wrong by 6e-7 rad after 1e9 rotations. Here frequency, time since the epoch and product carry
//! 32 digits, and a phase in turns is reduced by subtracting an integer.

use andoyer_series::{DoubleDouble, two_product, two_sum};

/// An angle that grows with time, in turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Phase {
    /// Turns per unit of time.
    frequency: DoubleDouble,
    /// Turns at the epoch.
    start: f64,
}

impl Phase {
    /// From a rate [rad per unit of time] and the angle at the epoch \[rad\].
    pub(crate) fn new(rate: DoubleDouble, start: f64) -> Self {
        let turn = DoubleDouble::PI * DoubleDouble::from(2.0);
        Self { frequency: rate / turn, start: start / std::f64::consts::TAU }
    }

    /// The angle, reduced to about half a turn either way \[rad\], a time `(high, low)` after the epoch.
    pub(crate) fn angle(&self, elapsed: (f64, f64)) -> f64 {
        let (turns, error) = two_product(self.frequency.high, elapsed.0);
        let low = error + (self.frequency.high * elapsed.1 + self.frequency.low * elapsed.0);
        let (fraction, rest) = two_sum(turns - turns.round(), self.start);
        let fraction = fraction - fraction.round();
        let turns = fraction + (rest + low);
        std::f64::consts::TAU * turns
    }
}

/// Time since the epoch, with its rounding error.
pub(crate) fn elapsed(time: f64, epoch: f64) -> (f64, f64) {
    two_sum(time, -epoch)
}
