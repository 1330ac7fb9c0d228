//! Scaling of numbers by powers of two, and rates in the user's unit.

use andoyer_double::DoubleDouble;

use super::phase::Phase;

/// The binary exponent of a positive finite number, for a smaller number than the smallest normal one, the exponent of that one.
pub(crate) fn exponent(value: f64) -> i32 {
    // Eleven exponent bits: the shift leaves a value that fits.
    let biased = ((value.to_bits() >> 52) & 0x7ff) as i32;
    biased.max(1) - 1023
}

/// value·2^power, in two steps, so that neither factor overflows.
pub(crate) fn scaled(value: f64, power: i32) -> f64 {
    let half = power / 2;
    value * 2.0_f64.powi(half) * 2.0_f64.powi(power - half)
}

/// A rate in the user's unit.
pub(crate) fn user_rate(rate: DoubleDouble, exponent: i32) -> DoubleDouble {
    DoubleDouble { high: scaled(rate.high, exponent), low: scaled(rate.low, exponent) }
}

/// The phase of half an angle. A quaternion needs half angles: a whole turn of the half angle keeps its sign.
pub(crate) fn half(rate: DoubleDouble, start: f64) -> Phase {
    Phase::new(rate * DoubleDouble::from(0.5), 0.5 * start)
}
