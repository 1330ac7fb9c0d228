//! Phases over long times: turns = frequency × time, in double-double (theory §10). [`crate::simd::phase`] evaluates them.

use andoyer_double::DoubleDouble;

/// 1/2π: a radian in turns, to 107 bits.
const RADIAN: DoubleDouble = DoubleDouble { high: 0.15915494309189535, low: -9.839338337591243e-18 };

/// An angle in turns that grows linearly with time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Phase {
    /// Turns per unit of time.
    pub(crate) frequency: DoubleDouble,
    /// Turns at the epoch. The high part is between ½ and 1½, a multiple of 2^−53; the low part is the remainder.
    pub(crate) start: DoubleDouble,
}

impl Phase {
    /// The phase with this rate [rad per unit of time] and this angle at the epoch \[rad\].
    pub(crate) fn new(rate: DoubleDouble, start: impl Into<DoubleDouble>) -> Self {
        Self { frequency: rate * RADIAN, start: DoubleDouble::ONE }.starting_at(start)
    }

    /// The same frequency with this angle at the epoch \[rad\].
    pub(crate) fn starting_at(&self, start: impl Into<DoubleDouble>) -> Self {
        let start = start.into() * RADIAN;
        let whole = 1.0 - start.high.round();
        Self { start: start + DoubleDouble::from(whole), ..*self }
    }

    /// The same frequency with a phase of 0 at the epoch.
    pub(crate) fn unstarted(&self) -> Self {
        Self { start: DoubleDouble::ONE, ..*self }
    }

    /// Turns per unit of time.
    pub(crate) fn frequency(&self) -> f64 {
        self.frequency.high
    }
}
