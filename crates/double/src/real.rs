//! The trait of the real numbers that this crate computes with.

use std::ops::{Add, Div, Mul, Sub};

use crate::double_double::DoubleDouble;

/// `f64` or [`DoubleDouble`]; no other type can implement it.
///
/// ```
/// use andoyer_double::{DoubleDouble, Real, carlson_rf};
/// fn lemniscate<R: Real>() -> f64 {
///     carlson_rf(R::from(0.0), R::from(1.0), R::from(2.0)).to_f64()
/// }
/// assert!((lemniscate::<f64>() - lemniscate::<DoubleDouble>()).abs() < 4e-16);
/// ```
pub trait Real:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + sealed::Sealed
{
    /// Relative difference of two numbers below which their arithmetic and geometric means agree to rounding error.
    const EQUAL_MEANS: f64;

    /// √self for self ≥ 0.
    #[must_use]
    fn sqrt(self) -> Self;

    /// self·factor.
    #[must_use]
    fn times_double(self, factor: f64) -> Self;

    /// self/divisor.
    #[must_use]
    fn over(self, divisor: f64) -> Self;

    /// The nearest double.
    fn to_f64(self) -> f64;
}

mod sealed {
    /// Prevents implementations of the trait outside this crate.
    pub trait Sealed {}

    impl Sealed for f64 {}
    impl Sealed for super::DoubleDouble {}
}

impl Real for f64 {
    const EQUAL_MEANS: f64 = 1e-8;

    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline]
    fn times_double(self, factor: f64) -> Self {
        self * factor
    }

    #[inline]
    fn over(self, divisor: f64) -> Self {
        self / divisor
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
}

impl Real for DoubleDouble {
    const EQUAL_MEANS: f64 = 1e-17;

    #[inline]
    fn sqrt(self) -> Self {
        DoubleDouble::sqrt(self)
    }

    #[inline]
    fn times_double(self, factor: f64) -> Self {
        DoubleDouble::times_double(self, factor)
    }

    #[inline]
    fn over(self, divisor: f64) -> Self {
        DoubleDouble::over(self, divisor)
    }

    #[inline]
    fn to_f64(self) -> f64 {
        DoubleDouble::to_f64(self)
    }
}
