//! Phases over long times: turns = frequency × time, in double-double (theory §10). [`crate::simd::phase`] evaluates them.

use andoyer_double::DoubleDouble;

/// An angle that grows with time, in turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Phase {
    /// Turns per unit of time.
    pub(crate) frequency: DoubleDouble,
    /// Turns at the epoch: a part from ½ to 1½, which is a multiple of 2^−53, and the rest.
    pub(crate) start: DoubleDouble,
}

impl Phase {
    /// From a rate [rad per unit of time] and the angle at the epoch \[rad\].
    pub(crate) fn new(rate: DoubleDouble, start: impl Into<DoubleDouble>) -> Self {
        let turn = DoubleDouble::PI * DoubleDouble::from(2.0);
        let start = start.into() / turn;
        let whole = 1.0 - start.high.round();
        Self { frequency: rate / turn, start: start + DoubleDouble::from(whole) }
    }

    /// The phase that is 0 at its epoch.
    pub(crate) fn unstarted(&self) -> Self {
        Self { start: DoubleDouble::ONE, ..*self }
    }

    /// Turns per unit of time.
    pub(crate) fn frequency(&self) -> f64 {
        self.frequency.high
    }
}
