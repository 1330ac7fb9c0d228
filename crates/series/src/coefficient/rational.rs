//! Exact coefficients: rationals and Gaussian rationals, lifted to integers over the least common denominator.

use super::Coefficient;
use crate::words::{MachineWords, Numerators, Words};
use num_bigint::BigInt;
use num_complex::Complex;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// Least common multiple of the denominators. Most denominators divide the multiple found so far, and a remainder costs less than a gcd.
fn common_denominator<'a>(values: impl Iterator<Item = &'a BigRational>) -> BigInt {
    let mut common = BigInt::one();
    for value in values {
        if !(&common % value.denom()).is_zero() {
            common = common.lcm(value.denom());
        }
    }
    common
}

fn lifted(value: &BigRational, scale: &BigInt) -> BigInt {
    if value.is_zero() { BigInt::zero() } else { value.numer() * (scale / value.denom()) }
}

fn lowered(raw: BigInt, scale: BigInt) -> BigRational {
    if raw.is_zero() { BigRational::zero() } else { BigRational::new(raw, scale) }
}

/// Rationals as integers over their common denominator, or `None` if one of them does not fit in 128 bits.
fn words<'a>(values: impl Iterator<Item = &'a BigRational> + Clone) -> Option<(Vec<i128>, i128)> {
    let mut common = 1_i128;
    for value in values.clone() {
        let denominator = value.denom().to_i128()?;
        if common % denominator != 0 {
            common = common.checked_mul(denominator / common.gcd(&denominator))?;
        }
    }
    let numerators = values.map(|value| value.numer().to_i128()?.checked_mul(common / value.denom().to_i128()?));
    Some((numerators.collect::<Option<_>>()?, common))
}

/// The reduced fraction `numerator`/`denominator`.
fn fraction(numerator: i128, denominator: i128) -> BigRational {
    if denominator == 1 || numerator == 0 {
        return BigRational::from_integer(numerator.into());
    }
    let shared = numerator.gcd(&denominator);
    BigRational::new_raw((numerator / shared).into(), (denominator / shared).into())
}

impl Coefficient for BigRational {
    type Raw = BigInt;
    type Scale = BigInt;

    const MACHINE_WORDS: Option<MachineWords<Self>> = Some(MachineWords {
        lift: |values| {
            let (numerators, denominator) = words(values.iter())?;
            Some(Words { numerators: Numerators::Real(numerators), denominator })
        },
        lower: |words| match &words.numerators {
            Numerators::Real(values) => values.iter().map(|&re| fraction(re, words.denominator)).collect(),
            Numerators::Complex(values) => values.iter().map(|&[re, _]| fraction(re, words.denominator)).collect(),
        },
    });

    fn integer(value: i64) -> Self {
        BigRational::from_integer(value.into())
    }

    fn invert(&self) -> Option<Self> {
        (!self.is_zero()).then(|| self.recip())
    }

    fn literal(&self) -> (bool, String) {
        (self.is_negative(), self.abs().to_string())
    }

    fn lift(values: &[&Self]) -> (Vec<BigInt>, BigInt) {
        let scale = common_denominator(values.iter().copied());
        (values.iter().map(|value| lifted(value, &scale)).collect(), scale)
    }

    fn lower(raw: BigInt, first: &BigInt, second: &BigInt) -> Self {
        lowered(raw, first * second)
    }

    fn raw_product(first: &BigInt, second: &BigInt) -> BigInt {
        first * second
    }

    fn raw_accumulate(sum: &mut BigInt, product: &BigInt, weight: i64) {
        // Most sums are of plain products, and another multiplication would be another allocation.
        if weight == 1 {
            *sum += product;
        } else {
            *sum += product * weight;
        }
    }

    fn bits(&self) -> u64 {
        self.numer().bits() + self.denom().bits()
    }

    fn times(&self, factor: i64) -> Self {
        self * BigInt::from(factor)
    }
}

impl Coefficient for Complex<BigRational> {
    type Raw = Complex<BigInt>;
    type Scale = BigInt;

    const MACHINE_WORDS: Option<MachineWords<Self>> = Some(MachineWords {
        lift: |values| {
            let (parts, denominator) = words(values.iter().flat_map(|value| [&value.re, &value.im]))?;
            let numerators = parts.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
            Some(Words { numerators: Numerators::Complex(numerators), denominator })
        },
        lower: |words| {
            let complex =
                |[re, im]: [i128; 2]| Complex::new(fraction(re, words.denominator), fraction(im, words.denominator));
            match &words.numerators {
                Numerators::Real(values) => values.iter().map(|&re| complex([re, 0])).collect(),
                Numerators::Complex(values) => values.iter().map(|&pair| complex(pair)).collect(),
            }
        },
    });

    fn integer(value: i64) -> Self {
        Complex::new(BigRational::integer(value), BigRational::zero())
    }

    fn invert(&self) -> Option<Self> {
        let inverse = self.norm_sqr().invert()?;
        Some(self.conj().scale(inverse))
    }

    fn imaginary_unit() -> Option<Self> {
        Some(Complex::new(BigRational::zero(), BigRational::one()))
    }

    fn literal(&self) -> (bool, String) {
        complex_literal(self.re.literal(), self.im.literal(), self.re.is_zero(), self.im.is_zero())
    }

    fn lift(values: &[&Self]) -> (Vec<Complex<BigInt>>, BigInt) {
        let scale = common_denominator(values.iter().flat_map(|value| [&value.re, &value.im]));
        let raws = values.iter().map(|value| Complex::new(lifted(&value.re, &scale), lifted(&value.im, &scale)));
        (raws.collect(), scale)
    }

    fn lower(raw: Complex<BigInt>, first: &BigInt, second: &BigInt) -> Self {
        let scale = first * second;
        Complex::new(lowered(raw.re, scale.clone()), lowered(raw.im, scale))
    }

    fn raw_product(first: &Complex<BigInt>, second: &Complex<BigInt>) -> Complex<BigInt> {
        first * second
    }

    fn raw_accumulate(sum: &mut Complex<BigInt>, product: &Complex<BigInt>, weight: i64) {
        sum.re += &product.re * weight;
        sum.im += &product.im * weight;
    }

    fn bits(&self) -> u64 {
        self.re.bits() + self.im.bits()
    }

    fn times(&self, factor: i64) -> Self {
        Complex::new(self.re.times(factor), self.im.times(factor))
    }
}

/// The literal of a complex number from those of its parts, for example `3/4`, `3/4*i`, `i` or `(1/2 - 3/4*i)`.
pub(super) fn complex_literal(re: (bool, String), im: (bool, String), re_zero: bool, im_zero: bool) -> (bool, String) {
    let imaginary = if im.1 == "1" { "i".to_owned() } else { format!("{}*i", im.1) };
    match (re_zero, im_zero) {
        (_, true) => re,
        (true, false) => (im.0, imaginary),
        (false, false) => {
            let first = if re.0 { "-" } else { "" };
            let second = if im.0 { '-' } else { '+' };
            (false, format!("({first}{} {second} {imaginary})", re.1))
        }
    }
}
