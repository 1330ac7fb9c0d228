//! The trait of the coefficients of a polynomial.
//!
//! The ring operations are the standard operators and `num_traits::{Zero, One}`. This trait adds integers, the inverse, a literal for printing, and *long sums
//! of products*. A reduced rational needs one gcd for each operation, and in a product of polynomials or a bracket thousands of
//! pairs of terms contribute to one resulting term. Therefore both factors are lifted to [`Raw`] values over one common denominator ([`Scale`]). The pairs are
//! summed there without a gcd, and each resulting term is lowered once. Types without denominators, such as floats, a prime field or double-double, are their
//! own raw values.
//!
//! [`Raw`]: Coefficient::Raw
//! [`Scale`]: Coefficient::Scale

mod float;
mod rational;

use crate::words::MachineWords;
use num_traits::{One, Zero};
use std::fmt::Debug;
use std::ops::{AddAssign, MulAssign, Neg, SubAssign};

/// A field, or a ring whose [`invert`](Coefficient::invert) may fail.
///
/// ```
/// use andoyer_series::Coefficient;
/// use num_rational::BigRational;
/// let half = BigRational::ratio(1, 2).ok_or("no inverse")?;
/// assert_eq!(half.times(4), BigRational::integer(2));
/// # Ok::<(), &str>(())
/// ```
pub trait Coefficient:
    Clone
    + PartialEq
    + Debug
    + Send
    + Sync
    + Zero
    + One
    + Neg<Output = Self>
    + for<'a> AddAssign<&'a Self>
    + for<'a> SubAssign<&'a Self>
    + for<'a> MulAssign<&'a Self>
{
    /// An unreduced value over a common denominator; `default()` is zero.
    type Raw: Clone + Default + Send + Sync;
    /// The common denominator of a set of lifted values.
    type Scale: Send + Sync;

    /// The conversion to machine words and back, for the exact types of this crate.
    #[doc(hidden)]
    const MACHINE_WORDS: Option<MachineWords<Self>> = None;

    /// The integer `value` as a coefficient: `value` times 1.
    fn integer(value: i64) -> Self;

    /// The multiplicative inverse, or `None` if there is none.
    fn invert(&self) -> Option<Self>;

    /// The square root of −1 that is written `i`, or `None` if the type has none.
    #[must_use]
    fn imaginary_unit() -> Option<Self> {
        None
    }

    /// The sign (true for negative) and the magnitude for printing. The magnitude is a factor in the grammar of
    /// [`Polynomial::parse`](crate::Polynomial::parse).
    fn literal(&self) -> (bool, String);

    /// Lifts values to one common denominator.
    fn lift(values: &[&Self]) -> (Vec<Self::Raw>, Self::Scale);

    /// The reduced value of a sum of products. `first` and `second` are the scales of the first and of the second factors.
    fn lower(raw: Self::Raw, first: &Self::Scale, second: &Self::Scale) -> Self;

    /// The product of two lifted values.
    fn raw_product(first: &Self::Raw, second: &Self::Raw) -> Self::Raw;

    /// Adds `weight` · `product` to `sum`.
    fn raw_accumulate(sum: &mut Self::Raw, product: &Self::Raw, weight: i64);

    /// Adds `weight` · `first` · `second` to `sum`.
    #[inline(always)]
    fn raw_add_product(sum: &mut Self::Raw, first: &Self::Raw, second: &Self::Raw, weight: i64) {
        Self::raw_accumulate(sum, &Self::raw_product(first, second), weight);
    }

    /// Approximate size in bits, for estimates of cost.
    fn bits(&self) -> u64 {
        64
    }

    /// Whether the value is finite: false for an infinity or a NaN.
    fn is_finite(&self) -> bool {
        true
    }

    /// `numerator`/`denominator`, or `None` if the denominator has no inverse.
    #[must_use]
    fn ratio(numerator: i64, denominator: i64) -> Option<Self> {
        Self::integer(denominator).invert().map(|inverse| inverse.times(numerator))
    }

    /// `self` · `factor`.
    #[must_use]
    fn times(&self, factor: i64) -> Self {
        let mut product = Self::integer(factor);
        product *= self;
        product
    }

    /// `self` / `divisor`, or `None` if the divisor has no inverse.
    #[must_use]
    fn divide(&self, divisor: &Self) -> Option<Self> {
        let mut quotient = divisor.invert()?;
        quotient *= self;
        Some(quotient)
    }

    /// `self` / `divisor`, or `None` if the divisor has no inverse.
    #[must_use]
    fn over(&self, divisor: i64) -> Option<Self> {
        self.divide(&Self::integer(divisor))
    }
}
