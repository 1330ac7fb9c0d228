//! Real coefficients, and the complex coefficients over them.
//!
//! A Hamiltonian has real coefficients. Its normalization uses the complex numbers of the same kind: Gaussian rationals for rationals, `Complex<f64>` for
//! `f64`. In an exact field a square root is exact or does not exist.

use crate::coefficient::Coefficient;
use crate::monomial::MAX_EXPONENT;
use num_bigint::BigInt;
use num_complex::Complex;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};

/// A field of real numbers with its complex extension: `BigRational` (exact) or `f64`.
///
/// ```
/// use andoyer_series::Coefficient;
/// use andoyer_series::real_field::RealField;
/// use num_rational::BigRational;
/// let [two, eight] = [2, 8].map(BigRational::integer);
/// assert_eq!(two.geometric_mean(&eight), Some(BigRational::integer(4)));
/// assert_eq!(two.geometric_mean(&BigRational::integer(1)), None);
/// ```
pub trait RealField: Coefficient + Send + Sync {
    /// The complex numbers over this field.
    type Complex: Coefficient + Send + Sync;
    /// Largest order of a normal form in these numbers.
    const MAX_ORDER: usize;

    /// The complex number re + i im.
    fn complex(re: Self, im: Self) -> Self::Complex;

    /// Real and imaginary part.
    fn parts(value: &Self::Complex) -> (Self, Self);

    /// √(ab) ≥ 0, or `None` if it is not in the field.
    fn geometric_mean(&self, other: &Self) -> Option<Self>;

    /// The sign: −1, 0 or 1.
    fn sign(&self) -> i8;

    /// The nearest `f64`; infinite on overflow.
    fn to_float(&self) -> f64;

    /// Relative rounding error; 0 for exact numbers.
    const EPSILON: f64;

    /// The number as a fraction; `None` if it is not finite.
    fn to_rational(&self) -> Option<BigRational>;

    /// The number of this field that is nearest to a fraction.
    fn from_rational(value: &BigRational) -> Self;

    /// The number that equals a float; `None` if the float is not finite.
    fn from_float(value: f64) -> Option<Self> {
        BigRational::from_float(value).map(|value| Self::from_rational(&value))
    }
}

impl RealField for BigRational {
    type Complex = Complex<BigRational>;
    /// A product of two parts of orders a + b = N has degree N + 4 before a pair of variables is removed.
    const MAX_ORDER: usize = MAX_EXPONENT as usize - 4;

    fn complex(re: Self, im: Self) -> Self::Complex {
        Complex::new(re, im)
    }

    fn parts(value: &Self::Complex) -> (Self, Self) {
        (value.re.clone(), value.im.clone())
    }

    fn geometric_mean(&self, other: &Self) -> Option<Self> {
        let product = self * other;
        let root = |n: &BigInt| (!n.is_negative()).then(|| n.sqrt()).filter(|root| root * root == *n);
        Some(BigRational::new(root(product.numer())?, root(product.denom())?))
    }

    fn sign(&self) -> i8 {
        i8::from(self.is_positive()) - i8::from(self.is_negative())
    }

    fn to_float(&self) -> f64 {
        ToPrimitive::to_f64(self).unwrap_or(if self.is_negative() { f64::NEG_INFINITY } else { f64::INFINITY })
    }

    const EPSILON: f64 = 0.0;

    fn to_rational(&self) -> Option<BigRational> {
        Some(self.clone())
    }

    fn from_rational(value: &BigRational) -> Self {
        value.clone()
    }
}

impl RealField for f64 {
    type Complex = Complex<f64>;
    /// The cells of order N of the triangle contain the factor N!, and 171! overflows an `f64`.
    const MAX_ORDER: usize = 170;

    fn complex(re: Self, im: Self) -> Self::Complex {
        Complex::new(re, im)
    }

    fn parts(value: &Self::Complex) -> (Self, Self) {
        (value.re, value.im)
    }

    fn geometric_mean(&self, other: &Self) -> Option<Self> {
        let product = self * other;
        // The square root of the product is rounded once, and is exact for squares. The product of the square roots cannot overflow.
        let root = if product.is_normal() { product.sqrt() } else { self.abs().sqrt() * other.abs().sqrt() };
        (self.sign() * other.sign() >= 0).then_some(root)
    }

    fn sign(&self) -> i8 {
        i8::from(*self > 0.0) - i8::from(*self < 0.0)
    }

    fn to_float(&self) -> f64 {
        *self
    }

    const EPSILON: f64 = f64::EPSILON;

    fn to_rational(&self) -> Option<BigRational> {
        BigRational::from_float(*self)
    }

    fn from_rational(value: &BigRational) -> Self {
        value.to_float()
    }

    fn from_float(value: f64) -> Option<Self> {
        value.is_finite().then_some(value)
    }
}
