//! A coefficient that is a periodic function of driven phases: a constant, or its values at the times of a [`Grid`](super::grid::Grid).
//!
//! Sums and products act value by value, so polynomials with such coefficients use the products and brackets of every other coefficient. A sum of products of one
//! bracket is one fused loop without temporary values. Rows of different grids must not be mixed.

use std::ops::{Add, AddAssign, Mul, MulAssign, Neg, SubAssign};
use std::sync::Arc;

use num_complex::Complex;
use num_traits::{One, Zero};

use super::raw::{AddProduct, AddScaled, RawPeriodic};
use crate::coefficient::Coefficient;

/// A periodic function.
#[derive(Clone, Debug)]
pub enum Periodic {
    /// A constant.
    Constant(Complex<f64>),
    /// The real parts at all times of a grid, then the imaginary parts.
    Row(Arc<[f64]>),
}

use Periodic::{Constant, Row};

impl Periodic {
    /// A real constant.
    #[must_use]
    pub fn real(value: f64) -> Self {
        Constant(value.into())
    }

    /// The function with these values at the times of a grid.
    #[must_use]
    pub fn of(values: &[Complex<f64>]) -> Self {
        Row(values.iter().map(|c| c.re).chain(values.iter().map(|c| c.im)).collect())
    }

    /// The value at the time number `index` of the grid.
    #[must_use]
    pub fn at(&self, index: usize) -> Complex<f64> {
        match self {
            Constant(c) => *c,
            Row(row) => Complex::new(row[index], row[row.len() / 2 + index]),
        }
    }

    /// The mean over the phases.
    #[must_use]
    pub fn mean(&self) -> Complex<f64> {
        match self {
            Constant(c) => *c,
            Row(row) => {
                let (re, im) = row.split_at(row.len() / 2);
                Complex::new(re.iter().sum(), im.iter().sum()) / re.len() as f64
            }
        }
    }

    /// The largest modulus; infinite if a value is not finite.
    #[must_use]
    pub fn size(&self) -> f64 {
        let square = match self {
            Constant(c) => c.norm_sqr(),
            Row(row) => {
                let (re, im) = row.split_at(row.len() / 2);
                let squares = re.iter().zip(im).map(|(x, y)| x * x + y * y);
                squares.fold(0.0, |most, next| if next <= most { most } else { next })
            }
        };
        if square.is_finite() { square.sqrt() } else { f64::INFINITY }
    }

    /// Σ weight · value, real weights of the times.
    #[must_use]
    pub fn weighted(&self, weights: &[f64]) -> Complex<f64> {
        match self {
            Constant(c) => *c,
            Row(row) => {
                let (re, im) = row.split_at(row.len() / 2);
                Complex::new(dot(re, weights), dot(im, weights))
            }
        }
    }

    /// Σ factor · function.
    pub(crate) fn combined(terms: &[(Complex<f64>, &Self)]) -> Self {
        let mut sum = RawPeriodic::default();
        for (factor, function) in terms {
            Self::raw_add_product(&mut sum, &function.raw(), &RawPeriodic::Constant(*factor), 1);
        }
        Self::lower(sum, &(), &())
    }

    /// `function` of the value at each time.
    #[must_use]
    pub fn each(&self, function: impl Fn(Complex<f64>) -> Complex<f64>) -> Self {
        match self {
            Constant(c) => Constant(function(*c)),
            Row(row) => Self::of(&(0..row.len() / 2).map(|index| function(self.at(index))).collect::<Vec<_>>()),
        }
    }

    /// A constant where all values are equal.
    #[must_use]
    pub fn simplified(self) -> Self {
        match &self {
            Row(row) if (1..row.len() / 2).all(|index| self.at(index) == self.at(0)) => Constant(self.at(0)),
            _ => self,
        }
    }

    /// The function without its imaginary part.
    #[must_use]
    pub fn real_part(&self) -> Self {
        match self {
            Constant(c) => Self::real(c.re),
            Row(_) => self.each(|c| c.re.into()),
        }
    }

    /// The bytes that the values take.
    pub(crate) fn memory(&self) -> usize {
        size_of::<Self>() + if let Row(row) = self { size_of_val(&row[..]) } else { 0 }
    }

    fn raw(&self) -> RawPeriodic {
        match self {
            Constant(c) => RawPeriodic::Constant(*c),
            Row(row) => RawPeriodic::Factor(Arc::clone(row)),
        }
    }
}

/// The product of two matrices; each entry is one fused sum.
pub(crate) fn product(a: &[Vec<Periodic>], b: &[Vec<Periodic>]) -> Vec<Vec<Periodic>> {
    let raw = |matrix: &[Vec<Periodic>]| -> Vec<Vec<RawPeriodic>> {
        matrix.iter().map(|row| row.iter().map(Periodic::raw).collect()).collect()
    };
    let (a, b) = (raw(a), raw(b));
    let entry = |row: &Vec<RawPeriodic>, column: usize| {
        let mut sum = RawPeriodic::default();
        for (x, y) in row.iter().zip(&b) {
            Periodic::raw_add_product(&mut sum, x, &y[column], 1);
        }
        Periodic::lower(sum, &(), &())
    };
    a.iter().map(|row| (0..b.first().map_or(0, Vec::len)).map(|column| entry(row, column)).collect()).collect()
}

impl PartialEq for Periodic {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Constant(a), Constant(b)) => a == b,
            (Row(row), _) | (_, Row(row)) => (0..row.len() / 2).all(|index| self.at(index) == other.at(index)),
        }
    }
}

impl Zero for Periodic {
    fn zero() -> Self {
        Constant(Complex::zero())
    }

    fn is_zero(&self) -> bool {
        match self {
            Constant(c) => c.is_zero(),
            Row(row) => row.iter().all(|&value| value == 0.0),
        }
    }
}

impl One for Periodic {
    fn one() -> Self {
        Constant(Complex::one())
    }
}

/// Σ x y in four sums, of which none waits for another.
fn dot(first: &[f64], second: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (first, second) = (first.chunks_exact(4), second.chunks_exact(4));
    let rest: f64 = first.remainder().iter().zip(second.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in first.zip(second) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

impl Add for Periodic {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self += &other;
        self
    }
}

impl Mul for Periodic {
    type Output = Self;

    fn mul(mut self, other: Self) -> Self {
        self *= &other;
        self
    }
}

impl Neg for Periodic {
    type Output = Self;

    fn neg(self) -> Self {
        match self {
            Constant(c) => Constant(-c),
            Row(row) => Row(row.iter().map(|value| -value).collect()),
        }
    }
}

impl AddAssign<&Self> for Periodic {
    fn add_assign(&mut self, other: &Self) {
        *self = Self::combined(&[(Complex::one(), self), ((1.0).into(), other)]);
    }
}

impl SubAssign<&Self> for Periodic {
    fn sub_assign(&mut self, other: &Self) {
        *self = Self::combined(&[(Complex::one(), self), ((-1.0).into(), other)]);
    }
}

impl MulAssign<&Self> for Periodic {
    fn mul_assign(&mut self, other: &Self) {
        *self = Self::lower(Self::raw_product(&self.raw(), &other.raw()), &(), &());
    }
}

impl Coefficient for Periodic {
    type Raw = RawPeriodic;
    type Scale = ();

    fn integer(value: i64) -> Self {
        Self::real(value as f64)
    }

    /// The inverse value by value; `None` where one is 0.
    fn invert(&self) -> Option<Self> {
        match self {
            Constant(c) => c.invert().map(Constant),
            Row(row) => {
                let values: Option<Vec<_>> = (0..row.len() / 2).map(|index| self.at(index).invert()).collect();
                values.map(|values| Self::of(&values))
            }
        }
    }

    fn imaginary_unit() -> Option<Self> {
        Some(Constant(Complex::i()))
    }

    /// That of the mean.
    fn literal(&self) -> (bool, String) {
        self.mean().literal()
    }

    fn lift(values: &[&Self]) -> (Vec<RawPeriodic>, ()) {
        (values.iter().map(|value| value.raw()).collect(), ())
    }

    fn lower(raw: RawPeriodic, (): &(), (): &()) -> Self {
        match raw {
            RawPeriodic::Constant(c) => Constant(c),
            RawPeriodic::Factor(row) => Row(row),
            RawPeriodic::Sum(row) => Row(row.into()),
        }
    }

    fn raw_product(first: &RawPeriodic, second: &RawPeriodic) -> RawPeriodic {
        let mut product = RawPeriodic::default();
        Self::raw_add_product(&mut product, first, second, 1);
        product
    }

    fn raw_accumulate(sum: &mut RawPeriodic, product: &RawPeriodic, weight: i64) {
        Self::raw_add_product(sum, product, &RawPeriodic::Constant(Complex::one()), weight);
    }

    #[inline]
    fn raw_add_product(sum: &mut RawPeriodic, first: &RawPeriodic, second: &RawPeriodic, weight: i64) {
        let weight = weight as f64;
        match (first.row(), second.row()) {
            (Some(first), Some(second)) => {
                let sum = sum.opened(first.len());
                pulp::Arch::new().dispatch(AddProduct { sum, first, second, weight });
            }
            (Some(row), None) => {
                let (sum, factor) = (sum.opened(row.len()), second.constant() * weight);
                pulp::Arch::new().dispatch(AddScaled { sum, row, factor });
            }
            (None, Some(row)) => {
                let (sum, factor) = (sum.opened(row.len()), first.constant() * weight);
                pulp::Arch::new().dispatch(AddScaled { sum, row, factor });
            }
            (None, None) => {
                let product = first.constant() * second.constant() * weight;
                match sum {
                    RawPeriodic::Constant(c) => *c += product,
                    RawPeriodic::Factor(_) => {}
                    RawPeriodic::Sum(row) => {
                        let (re, im) = row.split_at_mut(row.len() / 2);
                        re.iter_mut().for_each(|value| *value += product.re);
                        im.iter_mut().for_each(|value| *value += product.im);
                    }
                }
            }
        }
    }

    fn is_finite(&self) -> bool {
        match self {
            Constant(c) => c.is_finite(),
            Row(row) => row.iter().all(|value| value.is_finite()),
        }
    }
}
