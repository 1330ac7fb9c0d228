//! The clock of the C-kernels: a piecewise linear SCLK of type 1 with 131,072 ticks a second of TDB from J2000 on.
//!
//! A C-kernel has its times in ticks of a spacecraft clock, and ticks are not negative. Doubles are dense near tick 0 only, so a clock that simply starts before the first time of
//! interest would round all later times. Here the times before J2000 are on the ticks 0 to 4, and a tick is the longer, the earlier it is. From J2000 on the ticks have every digit of the
//! seconds, but for a last bit where the exponent changes. [`rounding`] bounds the rounding before J2000. All constants are whole numbers, which
//! every reader of text kernels reads exactly, and ratios of powers of two, so conversions round once. Strings of this clock (`scdecd`) are useful after J2000 only.

/// Ticks of a second of the clock.
pub const TICKS: f64 = 131_072.0;

/// Pieces of the clock: first tick, its time \[s of TDB past J2000\], seconds of TDB in a second of the clock. The first three have widths of 2^36, 2^30 and 2^20 s.
pub const PIECES: [(f64, f64, f64); 4] = [
    (0.0, FIRST, 9_007_199_254_740_992.0),
    (1.0, -1_074_790_400.0, 140_737_488_355_328.0),
    (2.0, -1_048_576.0, 68_719_476_736.0),
    (4.0, 0.0, 1.0),
];

/// The first time that the clock holds \[s of TDB past J2000\]: in the year −212.
pub const FIRST: f64 = -69_794_267_136.0;

/// The last time that the clock holds \[s of TDB past J2000\]: after 31,000 years.
pub const LAST: f64 = 1e12;

/// The piece that holds a time.
fn piece(time: f64) -> (f64, f64, f64) {
    PIECES.into_iter().rev().find(|piece| piece.1 <= time).unwrap_or(PIECES[0])
}

/// Ticks of the clock at a time \[s of TDB past J2000\], as CSPICE computes them.
///
/// ```
/// use andoyer_kernels::clock::ticks;
/// assert!(ticks(12.5) == 12.5 * 131_072.0 + 4.0 && ticks(-1.0) < ticks(-0.5) && ticks(-2e9) < ticks(-1e9));
/// ```
pub fn ticks(time: f64) -> f64 {
    let (tick, start, rate) = piece(time);
    tick + (time - start) * (TICKS / rate)
}

/// The time of a tick \[s of TDB past J2000\].
fn time(ticks: f64) -> f64 {
    let (tick, start, rate) = PIECES.into_iter().rev().find(|piece| piece.0 <= ticks).unwrap_or(PIECES[0]);
    start + (ticks - tick) * (rate / TICKS)
}

/// The nearest time that both a double and the clock hold exactly \[s of TDB past J2000\].
///
/// ```
/// use andoyer_kernels::clock::{held, rounding};
/// assert_eq!(held(8.2e8 + 0.1), 8.2e8 + 0.1);
/// assert!((held(-1e8 - 0.1) + 1e8 + 0.1).abs() <= rounding(-1e8) && rounding(-1e8) < 3e-7);
/// ```
pub fn held(at: f64) -> f64 {
    time(ticks(at))
}

/// The last time up to `at` and the first time from `at` on that the clock holds; both are `at` if it does.
///
/// ```
/// use andoyer_kernels::clock::around;
/// let [before, after] = around(-1e8 - 0.1);
/// assert!(before < -1e8 - 0.1 && -1e8 - 0.1 < after && after - before < 3e-7 && around(0.5) == [0.5, 0.5]);
/// ```
pub fn around(at: f64) -> [f64; 2] {
    let (ticks, near) = (ticks(at), held(at));
    [if near > at { time(ticks.next_down()) } else { near }, if near < at { time(ticks.next_up()) } else { near }]
}

/// Seconds of TDB in a tick at a time \[s of TDB past J2000\].
pub fn rate(time: f64) -> f64 {
    piece(time).2 / TICKS
}

/// Bound of the difference \[s\] between a time near `time`, SPICE's double of it, and the time of the tick that this becomes. It is smaller nearer to J2000.
pub fn rounding(time: f64) -> f64 {
    let (_, start, rate) = piece(time);
    let next = PIECES.iter().find(|piece| piece.1 > start);
    // Before J2000 the time since the start of the piece is rounded, and then the tick, which is below that of the next piece.
    let rounded = next.map_or(0.0, |next| (time - start) + 0.5 * next.0 * rate / TICKS);
    0.5 * f64::EPSILON * (time.abs() + rounded)
}
