//! The ring operations of polynomials.
//!
//! Sums are operators: `&a + &b`, `&a - &b`, `-&a`, `+=`, `-=`. Products are methods, because a product can overflow an exponent, which is an error. A sum
//! costs O(n). A product costs one multiplication for each pair of terms and one reduction for each resulting term.

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::polynomial::{Polynomial, Truncation};
use crate::product::Accumulator;
use crate::terms::Terms;
use std::ops::{Add, AddAssign, Neg, Sub, SubAssign};

impl<C: Coefficient> AddAssign<&Polynomial<C>> for Polynomial<C> {
    fn add_assign(&mut self, other: &Polynomial<C>) {
        self.merge(other, |sum, c| *sum += c, C::clone);
    }
}

impl<C: Coefficient> SubAssign<&Polynomial<C>> for Polynomial<C> {
    fn sub_assign(&mut self, other: &Polynomial<C>) {
        self.merge(other, |sum, c| *sum -= c, |c| -c.clone());
    }
}

impl<C: Coefficient> Add for &Polynomial<C> {
    type Output = Polynomial<C>;

    fn add(self, other: Self) -> Polynomial<C> {
        let mut sum = self.clone();
        sum += other;
        sum
    }
}

impl<C: Coefficient> Sub for &Polynomial<C> {
    type Output = Polynomial<C>;

    fn sub(self, other: Self) -> Polynomial<C> {
        let mut difference = self.clone();
        difference -= other;
        difference
    }
}

impl<C: Coefficient> Neg for &Polynomial<C> {
    type Output = Polynomial<C>;

    fn neg(self) -> Polynomial<C> {
        self.each(|c| -c.clone())
    }
}

impl<C: Coefficient> Polynomial<C> {
    /// This polynomial times a number.
    #[must_use]
    pub fn scale(&self, factor: &C) -> Self {
        self.each(|c| {
            let mut product = c.clone();
            product *= factor;
            product
        })
    }

    /// This polynomial divided by an integer.
    ///
    /// # Errors
    /// - Divisor 0, or a multiple of the characteristic of a finite field: [`Error::DivisionByZero`].
    pub fn over(&self, divisor: i64) -> Result<Self, Error> {
        if divisor == 1 {
            return Ok(self.clone());
        }
        let inverse = C::integer(divisor).invert().ok_or(Error::DivisionByZero)?;
        Ok(self.scale(&inverse))
    }

    /// The product of two polynomials.
    ///
    /// ```
    /// use andoyer_series::Polynomial;
    /// let [sum, difference] = ["x + y", "x - y"].map(|text| Polynomial::<f64>::parse(text, &["x", "y"]));
    /// assert_eq!(sum?.multiply(&difference?)?.display(&["x", "y"]).to_string(), "x^2 - y^2");
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - x^20000 times x^20000: [`Error::ExponentOverflow`].
    pub fn multiply(&self, other: &Self) -> Result<Self, Error> {
        self.product(other, None)
    }

    /// The product without the terms that `truncation` drops.
    ///
    /// # Errors
    /// - x^20000 times x^20000, even if the term is dropped: [`Error::ExponentOverflow`].
    pub fn multiply_truncated(&self, other: &Self, truncation: &Truncation) -> Result<Self, Error> {
        self.product(other, Some(truncation))
    }

    pub(crate) fn product(&self, other: &Self, truncation: Option<&Truncation>) -> Result<Self, Error> {
        let mut sum = Accumulator::new(&[self], &[other]).within(truncation);
        sum.add_product((0, 0), 1);
        sum.finish(&mut || Ok(()))
    }

    /// This polynomial to the power `exponent`, by repeated squaring. The power 0 is 1, also of the polynomial 0.
    ///
    /// ```
    /// use andoyer_series::Polynomial;
    /// let parse = |text| Polynomial::<f64>::parse(text, &["x"]);
    /// assert_eq!(parse("1 + x")?.power(2)?, parse("1 + 2*x + x^2")?);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - x to the power 32768: [`Error::ExponentOverflow`].
    pub fn power(&self, exponent: u32) -> Result<Self, Error> {
        self.power_within(exponent, None)
    }

    pub(crate) fn power_within(&self, exponent: u32, truncation: Option<&Truncation>) -> Result<Self, Error> {
        let mut power = Self::constant(C::one());
        for bit in (0..u32::BITS - exponent.leading_zeros()).rev() {
            power = power.product(&power, truncation)?;
            if exponent >> bit & 1 == 1 {
                power = power.product(self, truncation)?;
            }
        }
        Ok(power)
    }

    /// The polynomial with `function` applied to every coefficient.
    fn each(&self, mut function: impl FnMut(&C) -> C) -> Self {
        Self::from_terms(self.terms().map(|(monomial, c)| (monomial, function(c))))
    }

    /// Merges the terms of `other` into these. `both` handles a monomial in both polynomials, `alone` a monomial that only `other` has.
    fn merge(&mut self, other: &Self, both: impl Fn(&mut C, &C), alone: impl Fn(&C) -> C) {
        if other.is_zero() {
            return;
        }
        self.terms.settle();
        let (monomials, values) = std::mem::take(&mut self.terms).into_values();
        let mut merged = (Vec::with_capacity(monomials.len() + other.len()), Vec::new());
        let mut push = |monomial, value: C| {
            if !value.is_zero() {
                merged.0.push(monomial);
                merged.1.push(value);
            }
        };
        let mut own = monomials.into_iter().zip(values).peekable();
        for (monomial, c) in other.terms() {
            while let Some((before, value)) = own.next_if(|&(held, _)| held < monomial) {
                push(before, value);
            }
            match own.next_if(|&(held, _)| held == monomial) {
                Some((_, mut value)) => {
                    both(&mut value, c);
                    push(monomial, value);
                }
                None => push(monomial, alone(c)),
            }
        }
        own.for_each(|(monomial, value)| push(monomial, value));
        self.terms = Terms::ordered(merged.0, merged.1);
    }
}
