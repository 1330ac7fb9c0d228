//! What a polynomial's coefficients must be able to do.
//!
//! The ring operations are the standard operators and `num_traits::{Zero, One}`; this trait adds integers, the inverse,
//! a literal for printing, and *long sums of products*. A reduced rational pays one gcd for each operation (6.6 µs for
//! a multiply-add); in a product of polynomials, or a bracket, thousands of pairs of terms fall on one resulting term.
//! So both factors are lifted to [`Raw`] values over one common denominator ([`Scale`]), the pairs are summed there
//! without a gcd, and each resulting term is lowered once. Types without denominators lift and lower as they are
//! (floats here; a prime field or a double-double alike).
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

    /// How values turn into machine words, for the exact types of this crate.
    #[doc(hidden)]
    const MACHINE_WORDS: Option<MachineWords<Self>> = None;

    /// The element `value` · 1.
    fn integer(value: i64) -> Self;

    /// The multiplicative inverse, or `None` where there is none.
    fn invert(&self) -> Option<Self>;

    /// The square root of −1 that is written `i`, where the type has one.
    #[must_use]
    fn imaginary_unit() -> Option<Self> {
        None
    }

    /// Sign and magnitude for printing; the magnitude is a factor of the grammar of
    /// [`Polynomial::parse`](crate::Polynomial::parse).
    fn literal(&self) -> (bool, String);

    /// Lifts values to one common denominator.
    fn lift(values: &[&Self]) -> (Vec<Self::Raw>, Self::Scale);

    /// The reduced value of a sum of products, the scales being those of the first and of the second factors.
    fn lower(raw: Self::Raw, first: &Self::Scale, second: &Self::Scale) -> Self;

    /// The product of two lifted values.
    fn raw_product(first: &Self::Raw, second: &Self::Raw) -> Self::Raw;

    /// Adds `weight` · `product` to `sum`.
    fn raw_accumulate(sum: &mut Self::Raw, product: &Self::Raw, weight: i64);

    /// Approximate size in bits, for estimates of cost.
    fn bits(&self) -> u64 {
        64
    }

    /// Whether this is a number: false for an infinity or a NaN.
    fn is_finite(&self) -> bool {
        true
    }

    /// `numerator`/`denominator`, or `None` where the denominator has no inverse.
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

    /// `self` / `divisor`, or `None` where the divisor has no inverse.
    #[must_use]
    fn divide(&self, divisor: &Self) -> Option<Self> {
        let mut quotient = divisor.invert()?;
        quotient *= self;
        Some(quotient)
    }

    /// `self` / `divisor`, or `None` where the divisor has no inverse.
    #[must_use]
    fn over(&self, divisor: i64) -> Option<Self> {
        self.divide(&Self::integer(divisor))
    }
}
