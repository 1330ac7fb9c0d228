//! The arithmetic of a sum of products.
//!
//! There are three kinds: lifted values of any coefficient (floats, or big integers for rationals), integers of 64 bits that are summed in 128, and Gaussian
//! integers in the same way. The caller ensures that the sums of the last two kinds fit.

use crate::coefficient::Coefficient;

/// Factors, sums of their products, and the values of these sums.
pub(super) trait Arithmetic: Sync {
    type Factor: Sync;
    type Sum: Clone + Default + Send;
    type Value: Clone + Send + Sync;
    /// Whether an array of sums is cheap to fill and to scan.
    const LIGHT: bool;

    /// Adds `weight` · `first` · `second`.
    fn add(sum: &mut Self::Sum, first: &Self::Factor, second: &Self::Factor, weight: i64);

    /// The value 0.
    fn zero() -> Self::Value;

    /// The value of a sum, or `None` if it is zero.
    fn value(&self, sum: Self::Sum) -> Option<Self::Value>;
}

/// The lifted values of a coefficient. Each sum is lowered by itself.
pub(super) struct Lifted<'a, C: Coefficient> {
    pub(super) scales: (&'a C::Scale, &'a C::Scale),
}

impl<C: Coefficient> Arithmetic for Lifted<'_, C> {
    type Factor = C::Raw;
    type Sum = C::Raw;
    type Value = C;
    const LIGHT: bool = !std::mem::needs_drop::<C::Raw>() && size_of::<C::Raw>() <= 16;

    #[inline(always)]
    fn add(sum: &mut C::Raw, first: &C::Raw, second: &C::Raw, weight: i64) {
        C::raw_add_product(sum, first, second, weight);
    }

    fn zero() -> C {
        C::zero()
    }

    #[inline]
    fn value(&self, sum: C::Raw) -> Option<C> {
        let value = C::lower(sum, self.scales.0, self.scales.1);
        (!value.is_zero()).then_some(value)
    }
}

/// Integers of 64 bits with sums of 128 bits.
pub(super) struct Integers;

impl Arithmetic for Integers {
    type Factor = i64;
    type Sum = i128;
    type Value = i128;
    const LIGHT: bool = true;

    #[inline(always)]
    fn add(sum: &mut i128, first: &i64, second: &i64, weight: i64) {
        *sum += i128::from(*first) * i128::from(*second) * i128::from(weight);
    }

    fn zero() -> i128 {
        0
    }

    #[inline]
    fn value(&self, sum: i128) -> Option<i128> {
        (sum != 0).then_some(sum)
    }
}

/// Gaussian integers as (re, im).
pub(super) struct GaussianIntegers;

impl Arithmetic for GaussianIntegers {
    type Factor = [i64; 2];
    type Sum = [i128; 2];
    type Value = [i128; 2];
    const LIGHT: bool = true;

    #[inline(always)]
    fn add(sum: &mut [i128; 2], first: &[i64; 2], second: &[i64; 2], weight: i64) {
        let ([a, b], [c, d]) = (first.map(i128::from), second.map(i128::from));
        let weight = i128::from(weight);
        sum[0] += (a * c - b * d) * weight;
        sum[1] += (a * d + b * c) * weight;
    }

    fn zero() -> [i128; 2] {
        [0, 0]
    }

    #[inline]
    fn value(&self, sum: [i128; 2]) -> Option<[i128; 2]> {
        (sum != [0, 0]).then_some(sum)
    }
}
