//! Sine and cosine of an angle in turns.
//!
//! A quarter turn k/4 is taken off, exactly, and on |x| ≤ 1/8 stand sin 2πx = 2πx + x³ p(x²) and cos 2πx = 1 + x² q(x²), with p and q the
//! minimax polynomials of degree 5 and 6, found by Remez' exchange in 60 digits with the coefficients rounded one by one, each time fitting the rest
//! anew: truncation 1.6e-18 and 3.5e-19. 2π is carried with its tail, so with a fused product the sine is rounded once. Largest error 1.2e-16.

use super::lanes::Lanes;
use super::level::Level;

/// 2π and what its double leaves of it.
const TURN: [f64; 2] = [std::f64::consts::TAU, 2.449_293_598_294_706_4e-16];
const SINE: [f64; 6] = [
    -41.3417022403996,
    81.60524927591186,
    -76.70585969420165,
    42.05868379747909,
    -15.093736267536418,
    3.7794529249619515,
];
const COSINE: [f64; 7] = [
    -19.739208802178716,
    64.93939402266658,
    -85.45681720592083,
    60.244641210418315,
    -26.42623923109041,
    7.902528501565459,
    -1.6862683429441374,
];

/// 1.5·2^52: added to a smaller number and taken off again, it leaves the nearest integer; added, its lowest bits are that integer's.
pub(crate) const INTEGERS: f64 = 6_755_399_441_055_744.0;

/// (sin, cos) of x turns, |x| ≤ 1/8, and of as many quarters of a turn as the lowest bits of `quarters` say.
#[inline(always)]
pub(crate) fn sin_cos<S: Level>(x: Lanes<S>, quarters: Lanes<S>) -> (Lanes<S>, Lanes<S>) {
    let square = x * x;
    let mut sine = x.all(SINE[5]);
    for k in (0..5).rev() {
        sine = sine.mul_add(square, x.all(SINE[k]));
    }
    let sine = x.mul_add(x.all(TURN[0]), x * sine.mul_add(square, x.all(TURN[1])));
    let mut cosine = x.all(COSINE[6]);
    for k in (0..6).rev() {
        cosine = cosine.mul_add(square, x.all(COSINE[k]));
    }
    sine.turned(cosine.mul_add(square, x.all(1.0)), quarters)
}
