//! Double-double arithmetic: an unevaluated sum of two doubles, about 32 digits.
//!
//! Sums and products are error-free (Dekker 1971; Knuth, TAOCP 2, §4.2.2; products by fused multiply-add). The documentation of the crate lists the error bound
//! of each operation. Values must be finite. No operation checks for overflow.

use num_traits::{One, Zero};
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// The unevaluated sum `high + low`, |low| ≤ ulp(high)/2.
///
/// ```
/// use andoyer_double::DoubleDouble;
/// let third = DoubleDouble::ONE / DoubleDouble::from(3.0);
/// assert!((third * DoubleDouble::from(3.0) - DoubleDouble::ONE).to_f64().abs() < 1e-31);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    /// The nearest double.
    pub high: f64,
    /// The remainder: the value minus the nearest double.
    pub low: f64,
}

/// a + b and its rounding error, for any a and b.
///
/// ```
/// assert_eq!(andoyer_double::two_sum(1.0, 1e-20), (1.0, 1e-20));
/// ```
#[must_use]
#[inline]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_virtual = sum - a;
    (sum, (a - (sum - b_virtual)) + (b - b_virtual))
}

/// a·b and its rounding error.
///
/// ```
/// let near_one = 1.0 + f64::EPSILON;
/// let exact = (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON);
/// assert_eq!(andoyer_double::two_product(near_one, near_one), exact);
/// ```
#[must_use]
#[inline]
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

impl DoubleDouble {
    /// 0.
    pub const ZERO: Self = Self { high: 0.0, low: 0.0 };
    /// 1.
    pub const ONE: Self = Self { high: 1.0, low: 0.0 };
    /// π to 107 bits.
    pub const PI: Self = Self { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };

    /// a + b without a rounding error.
    #[must_use]
    #[inline]
    pub fn sum(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, b);
        Self { high, low }
    }

    /// a·b without a rounding error.
    #[must_use]
    #[inline]
    pub fn product(a: f64, b: f64) -> Self {
        let (high, low) = two_product(a, b);
        Self { high, low }
    }

    #[inline]
    fn renormalized(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self { high: sum, low: low - (sum - high) }
    }

    /// √self for self ≥ 0, and 0 for self < 0. The method is one Newton step from the root in `f64`.
    #[must_use]
    #[inline]
    pub fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::ZERO;
        }
        let root = self.high.sqrt();
        let (square, error) = two_product(root, root);
        // The residual of the high part is a double.
        let residual = ((self.high - square) - error) + self.low;
        Self::renormalized(root, residual / (root + root))
    }

    /// self/divisor for a divisor in `f64`. It costs a third of a quotient of two double-doubles.
    #[must_use]
    #[inline]
    pub fn over(self, divisor: f64) -> Self {
        let first = self.high / divisor;
        let (product, error) = two_product(first, divisor);
        Self::renormalized(first, ((self.high - product) - error + self.low) / divisor)
    }

    /// self·factor for a factor in `f64`. It costs half of a product of two double-doubles.
    #[must_use]
    #[inline]
    pub fn times_double(self, factor: f64) -> Self {
        let (high, error) = two_product(self.high, factor);
        Self::renormalized(high, error + self.low * factor)
    }

    /// (sin, cos) by their Taylor series, for |self| ≤ π/4.
    #[must_use]
    pub fn sin_cos(self) -> (Self, Self) {
        let square = self * self;
        let (mut sine, mut cosine) = (Self::ZERO, Self::ZERO);
        for k in (1..=14_i32).rev() {
            let k = f64::from(k);
            sine = -(square * (Self::ONE + sine)).over(2.0 * k * (2.0 * k + 1.0));
            cosine = -(square * (Self::ONE + cosine)).over(2.0 * k * (2.0 * k - 1.0));
        }
        (self * (Self::ONE + sine), Self::ONE + cosine)
    }

    /// The nearest double.
    #[must_use]
    #[inline]
    pub fn to_f64(self) -> f64 {
        self.high + self.low
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let (high, error) = two_sum(self.high, other.high);
        let (low, low_error) = two_sum(self.low, other.low);
        let sum = Self::renormalized(high, error + low);
        Self::renormalized(sum.high, sum.low + low_error)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let (high, error) = two_product(self.high, other.high);
        Self::renormalized(high, error + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        // The three digits of the long division are products with one reciprocal: each corrects the rounding of the one before.
        let reciprocal = 1.0 / other.high;
        let first = self.high * reciprocal;
        let rest = self - other * Self::from(first);
        let second = rest.high * reciprocal;
        let rest = rest - other * Self::from(second);
        Self::renormalized(first, second) + Self::from(rest.high * reciprocal)
    }
}

impl Zero for DoubleDouble {
    fn zero() -> Self {
        Self::ZERO
    }
    fn is_zero(&self) -> bool {
        self.high == 0.0
    }
}

impl One for DoubleDouble {
    fn one() -> Self {
        Self::ONE
    }
}

impl<'a> AddAssign<&'a Self> for DoubleDouble {
    fn add_assign(&mut self, other: &'a Self) {
        *self = *self + *other;
    }
}

impl<'a> SubAssign<&'a Self> for DoubleDouble {
    fn sub_assign(&mut self, other: &'a Self) {
        *self = *self - *other;
    }
}

impl<'a> MulAssign<&'a Self> for DoubleDouble {
    fn mul_assign(&mut self, other: &'a Self) {
        *self = *self * *other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mean::arithmetic_geometric_mean;

    fn close(a: DoubleDouble, b: DoubleDouble) -> bool {
        (a - b).to_f64().abs() <= 1e-30 * b.high.abs()
    }

    #[test]
    fn quotient_and_root_undo_product_and_square_to_thirty_digits() {
        let a = DoubleDouble::from(1.0) / DoubleDouble::from(3.0);
        let b = DoubleDouble::PI;
        assert!(close(a * b / b, a));
        assert!(
            close(a.times_double(3.0), DoubleDouble::ONE) && close(b.times_double(0.7), b * DoubleDouble::from(0.7))
        );
        assert!(close((b * b).sqrt(), b));
        assert!(close((a + b) - b, a) || ((a + b) - b - a).to_f64().abs() < 1e-30);
    }

    #[test]
    fn sine_and_cosine_of_a_twelfth_turn_hold_thirty_digits() {
        let (sine, cosine) = (DoubleDouble::PI / DoubleDouble::from(6.0)).sin_cos();
        assert!(close(sine, DoubleDouble::from(0.5)));
        assert!(close(cosine * cosine, DoubleDouble::from(0.75)));
    }

    #[test]
    fn mean_of_one_and_root_two_is_that_of_gauss() {
        // Gauss's constant: 1/agm(1, √2) = 0.834626841674073186281429732799…
        let mean = arithmetic_geometric_mean(DoubleDouble::from(2.0).sqrt(), DoubleDouble::ONE);
        let gauss = DoubleDouble::sum(0.834_626_841_674_073_2, -8.073_402_861_600_294e-18);
        assert!((DoubleDouble::ONE / mean - gauss).to_f64().abs() < 2e-30, "{:?}", DoubleDouble::ONE / mean - gauss);
    }
}
