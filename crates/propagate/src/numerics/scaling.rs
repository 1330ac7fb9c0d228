//! Scaling of numbers by powers of two, and rates in the user's unit.

use andoyer_double::DoubleDouble;

use super::phase::Phase;

/// The binary exponent of a positive finite number. For a subnormal number it is the exponent of the smallest normal number.
pub(crate) fn exponent(value: f64) -> i32 {
    // The shift leaves eleven exponent bits, which fit.
    let biased = ((value.to_bits() >> 52) & 0x7ff) as i32;
    biased.max(1) - 1023
}

/// value·2^power. Two factors are used so that neither overflows.
pub(crate) fn scaled(value: f64, power: i32) -> f64 {
    let [one, other] = factors(power);
    value * one * other
}

fn factors(power: i32) -> [f64; 2] {
    let half = power / 2;
    [half, power - half].map(power_of_two)
}

/// 2^power, from its bits: infinite above the largest double, and 0 below the smallest. A function call, even for powers that never occur, would be made for
/// each number.
fn power_of_two(power: i32) -> f64 {
    match power {
        -1022..=1023 => f64::from_bits(((power + 1023) as u64) << 52),
        -1074..=-1023 => f64::from_bits(1 << (power + 1074)),
        1024.. => f64::INFINITY,
        _ => 0.0,
    }
}

/// value·2^power of a double-double.
pub(crate) fn scaled_pair(value: DoubleDouble, power: i32) -> DoubleDouble {
    let [one, other] = factors(power);
    DoubleDouble { high: value.high * one * other, low: value.low * one * other }
}

/// A rate in the user's unit.
pub(crate) fn user_rate(rate: DoubleDouble, exponent: i32) -> DoubleDouble {
    scaled_pair(rate, exponent)
}

/// The phase of half an angle. A quaternion needs half angles, and a whole turn of the half angle leaves it unchanged.
pub(crate) fn half(rate: DoubleDouble, start: f64) -> Phase {
    Phase::new(rate * DoubleDouble::from(0.5), 0.5 * start)
}
