//! The clock of the C-kernels: a piecewise linear SCLK of type 1 whose ticks are seconds of TDB past J2000.
//!
//! A C-kernel has its times in ticks of a spacecraft clock, and ticks are not negative. Doubles are dense near tick 0 only. A clock that starts before the first time of interest
//! would therefore round all later times. This clock starts at −7e10 s, and the pieces before J2000 take the ticks below 2^−100: there a tick is 2^120 s or more. From J2000 on
//! a tick is the second itself without any rounding, and before J2000 the rounding is at most that of [`rounding`]. CSPICE evaluates the pieces as they stand here.
//! Strings of this clock (`scdecd`) are useful after J2000 only.

/// Pieces of the clock: first tick, its time [s of TDB past J2000], seconds a tick. The widths 2^36, 2^30 and 2^20 s and the rates are powers of two, so the
/// pieces meet without a rounding.
pub const PIECES: [(f64, f64, f64); 4] = [
    (0.0, FIRST, power(336)),
    (power(-300), -(power(20) + power(30)), power(230)),
    (power(-200), -power(20), power(120)),
    (power(-100), 0.0, 1.0),
];

/// The first time that the clock holds [s of TDB past J2000]: in the year −214.
pub const FIRST: f64 = -(power(20) + power(30) + power(36));

/// The last time that the clock holds [s of TDB past J2000]: after 31,000 years.
pub const LAST: f64 = 1e12;

const fn power(exponent: i64) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// The piece that holds a time.
fn piece(time: f64) -> (f64, f64, f64) {
    PIECES.into_iter().rev().find(|piece| piece.1 <= time).unwrap_or(PIECES[0])
}

/// The nearest time that both a double and the clock hold exactly [s of TDB past J2000]; from J2000 on the time itself.
///
/// ```
/// use andoyer_kernels::clock::{held, rounding};
/// assert_eq!(held(8.2e8 + 0.1), 8.2e8 + 0.1);
/// assert!((held(-1e8 - 0.1) + 1e8 + 0.1).abs() <= rounding(-1e8) && rounding(-1e8) < 1e-7);
/// ```
pub fn held(time: f64) -> f64 {
    let (_, start, _) = piece(time);
    start + (time - start)
}

/// Ticks of the clock at a time [s of TDB past J2000].
///
/// ```
/// use andoyer_kernels::clock::ticks;
/// assert!(ticks(12.5) == 12.5 && ticks(-1.0) < ticks(-0.5) && ticks(-2e9) < ticks(-1e9));
/// ```
pub fn ticks(time: f64) -> f64 {
    let (tick, start, rate) = piece(time);
    tick + (time - start) / rate
}

/// Seconds a tick at a time [s of TDB past J2000].
pub fn rate(time: f64) -> f64 {
    piece(time).2
}

/// Bound of the difference \[s\] between a time near `time`, SPICE's double of it, and the time of the tick that this becomes. It is smaller nearer to J2000.
pub fn rounding(time: f64) -> f64 {
    let (_, start, _) = piece(time);
    let next = PIECES.iter().map(|piece| piece.1).find(|&next| next > start).unwrap_or(start);
    0.5 * f64::EPSILON * (time.abs() + (next - start))
}
