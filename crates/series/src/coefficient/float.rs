//! Floating-point coefficients. The lifted values are the values themselves.

use super::Coefficient;
use andoyer_double::DoubleDouble;
use num_complex::Complex;

impl Coefficient for f64 {
    type Raw = f64;
    type Scale = ();

    fn integer(value: i64) -> Self {
        value as f64
    }

    fn invert(&self) -> Option<Self> {
        (*self != 0.0).then(|| self.recip())
    }

    fn literal(&self) -> (bool, String) {
        (self.is_sign_negative(), self.abs().to_string())
    }

    fn lift(values: &[&Self]) -> (Vec<f64>, ()) {
        (values.iter().map(|&&value| value).collect(), ())
    }

    #[inline]
    fn lower(raw: f64, (): &(), (): &()) -> Self {
        raw
    }

    #[inline]
    fn raw_product(first: &f64, second: &f64) -> f64 {
        first * second
    }

    #[inline]
    fn raw_accumulate(sum: &mut f64, product: &f64, weight: i64) {
        *sum += product * weight as f64;
    }

    fn is_finite(&self) -> bool {
        f64::is_finite(*self)
    }

    fn divide(&self, divisor: &Self) -> Option<Self> {
        (*divisor != 0.0).then(|| self / divisor)
    }

    fn ratio(numerator: i64, denominator: i64) -> Option<Self> {
        (denominator != 0).then(|| numerator as f64 / denominator as f64)
    }
}

impl Coefficient for DoubleDouble {
    type Raw = DoubleDouble;
    type Scale = ();

    fn integer(value: i64) -> Self {
        // Two parts of 32 bits each, both exact, hold any integer up to 2^63.
        let high = (value >> 32) as f64 * 4_294_967_296.0;
        DoubleDouble::sum(high, (value & 0xffff_ffff) as f64)
    }

    fn invert(&self) -> Option<Self> {
        (self.high != 0.0).then(|| DoubleDouble::ONE / *self)
    }

    fn literal(&self) -> (bool, String) {
        (self.high.is_sign_negative(), self.high.abs().to_string())
    }

    fn lift(values: &[&Self]) -> (Vec<DoubleDouble>, ()) {
        (values.iter().map(|&&value| value).collect(), ())
    }

    #[inline]
    fn lower(raw: DoubleDouble, (): &(), (): &()) -> Self {
        raw
    }

    #[inline]
    fn raw_product(first: &DoubleDouble, second: &DoubleDouble) -> DoubleDouble {
        *first * *second
    }

    #[inline]
    fn raw_accumulate(sum: &mut DoubleDouble, product: &DoubleDouble, weight: i64) {
        *sum += &(*product * Self::integer(weight));
    }

    fn is_finite(&self) -> bool {
        self.high.is_finite()
    }
}

impl Coefficient for Complex<f64> {
    type Raw = Complex<f64>;
    type Scale = ();

    fn integer(value: i64) -> Self {
        Complex::new(value as f64, 0.0)
    }

    fn invert(&self) -> Option<Self> {
        quotient(Complex::new(1.0, 0.0), *self)
    }

    fn imaginary_unit() -> Option<Self> {
        Some(Complex::i())
    }

    fn literal(&self) -> (bool, String) {
        super::rational::complex_literal(self.re.literal(), self.im.literal(), self.re == 0.0, self.im == 0.0)
    }

    fn lift(values: &[&Self]) -> (Vec<Complex<f64>>, ()) {
        (values.iter().map(|&&value| value).collect(), ())
    }

    #[inline]
    fn lower(raw: Complex<f64>, (): &(), (): &()) -> Self {
        raw
    }

    #[inline]
    fn raw_product(first: &Complex<f64>, second: &Complex<f64>) -> Complex<f64> {
        first * second
    }

    #[inline]
    fn raw_accumulate(sum: &mut Complex<f64>, product: &Complex<f64>, weight: i64) {
        *sum += product * weight as f64;
    }

    fn is_finite(&self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }

    fn divide(&self, divisor: &Self) -> Option<Self> {
        quotient(*self, *divisor)
    }
}

/// Smith's division (`Complex::fdiv`, no overflow of the squared modulus), `None` for a zero divisor.
fn quotient(dividend: Complex<f64>, divisor: Complex<f64>) -> Option<Complex<f64>> {
    (divisor.re != 0.0 || divisor.im != 0.0).then(|| dividend.fdiv(divisor))
}
