//! Sine and cosine of an angle in turns.
//!
//! A multiple k/4 of a quarter turn is subtracted exactly. For |x| ≤ 1/8, sin 2πx = 2πx + x³ p(x²) and cos 2πx = 1 + x² q(x²), with p and q the minimax
//! polynomials of degree 5 and 6. They were found by Remez' exchange in 60 digits; the coefficients were rounded one after another, and the remaining ones were
//! fitted again each time. Truncation: 1.6e-18 and 3.5e-19. 2π is carried with its tail, so with a fused product the sine is rounded once. Largest error
//! 1.2e-16.

use super::instruction_set::InstructionSet;
use super::lanes::{INTEGERS, Lanes};

/// 2π as the sum of two doubles.
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

/// (sin, cos) of x turns, |x| ≤ 1/8, plus as many quarter turns as the lowest two bits of `quarters` say.
#[inline(always)]
pub(crate) fn sin_cos<S: InstructionSet>(x: Lanes<S>, quarters: Lanes<S>) -> (Lanes<S>, Lanes<S>) {
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

/// (sin, cos) of x turns.
#[inline(always)]
pub(crate) fn sin_cos_of_turns<S: InstructionSet>(x: Lanes<S>) -> (Lanes<S>, Lanes<S>) {
    let quarters = x.mul_add(x.all(4.0), x.all(INTEGERS));
    sin_cos((quarters - x.all(INTEGERS)).negate_mul_add(x.all(0.25), x), quarters)
}

/// (arctan x − x)/x³ as a polynomial in x² up to x = tan π/8: interpolated at Chebyshev's points in 50 digits, to 7e-18 of the arctangent.
const ARC: [f64; 11] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_955_2,
    -0.142_857_142_846_665_42,
    0.111_111_110_152_563_61,
    -0.090_909_045_781_239_03,
    0.076_921_831_908_260_87,
    -0.066_645_114_473_819_48,
    0.058_581_489_128_022_1,
    -0.050_854_497_379_402_6,
    0.039_231_658_295_587_19,
    -0.019_176_887_119_062_21,
];

/// Twice the arctangent of y/x, for x ≥ 0.
#[inline(always)]
pub(crate) fn twice_arc<S: InstructionSet>(y: Lanes<S>, x: Lanes<S>) -> Lanes<S> {
    // Halved twice: tan φ/2 = y/(x + |(x, y)|), and so on.
    let quarter = y / (x + x.mul_add(x, y * y).root());
    let one = x.all(1.0);
    let eighth = quarter / (one + quarter.mul_add(quarter, one).root());
    twice_short_arc(eighth) * x.all(4.0)
}

/// Twice the arctangent of a tangent, up to tan π/8.
#[inline(always)]
pub(crate) fn twice_short_arc<S: InstructionSet>(tangent: Lanes<S>) -> Lanes<S> {
    let square = tangent * tangent;
    let arc = (tangent * square).mul_add(square.polynomial(&ARC), tangent);
    arc + arc
}
