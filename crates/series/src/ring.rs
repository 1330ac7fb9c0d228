//! The ring operations.
//!
//! `&a + &b`, `&a - &b`, `-&a` and `+=`, `-=` as operators; products are methods, since a product may overflow an
//! exponent and that is an error. Sums cost O(n), products one multiplication for each pair of terms and one reduction
//! for each resulting term.

use crate::lifted::Accumulator;
use crate::{Coefficient, Error, Polynomial, Truncation};
use std::ops::{Add, AddAssign, Neg, Sub, SubAssign};

impl<C: Coefficient> AddAssign<&Polynomial<C>> for Polynomial<C> {
    fn add_assign(&mut self, other: &Polynomial<C>) {
        for (&monomial, c) in &other.terms {
            self.add_term(monomial, c);
        }
    }
}

impl<C: Coefficient> SubAssign<&Polynomial<C>> for Polynomial<C> {
    fn sub_assign(&mut self, other: &Polynomial<C>) {
        for (&monomial, c) in &other.terms {
            self.add_term(monomial, &-c.clone());
        }
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
        Polynomial { terms: self.terms.iter().map(|(&monomial, c)| (monomial, -c.clone())).collect() }
    }
}

impl<C: Coefficient> Polynomial<C> {
    /// This polynomial times a number.
    #[must_use]
    pub fn scale(&self, factor: &C) -> Self {
        let scaled = self.terms.iter().map(|(&monomial, c)| {
            let mut product = c.clone();
            product *= factor;
            (monomial, product)
        });
        Polynomial { terms: scaled.filter(|(_, c)| !c.is_zero()).collect() }
    }

    /// This polynomial divided by an integer.
    ///
    /// # Errors
    /// - divisor 0, or a multiple of the characteristic of a finite field: [`Error::DivisionByZero`].
    pub fn over(&self, divisor: i64) -> Result<Self, Error> {
        if divisor == 1 {
            return Ok(self.clone());
        }
        let inverse = C::integer(divisor).invert().ok_or(Error::DivisionByZero)?;
        Ok(self.scale(&inverse))
    }

    /// The product.
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
    /// - x^20000 times x^20000, kept or not: [`Error::ExponentOverflow`].
    pub fn multiply_truncated(&self, other: &Self, truncation: &Truncation) -> Result<Self, Error> {
        self.product(other, Some(truncation))
    }

    pub(crate) fn product(&self, other: &Self, truncation: Option<&Truncation>) -> Result<Self, Error> {
        let mut sum = Accumulator::new(&[self], &[other]);
        sum.add_product((0, 0), 1, truncation)?;
        Ok(sum.finish())
    }

    /// This polynomial to a power, by repeated squaring; the power 0 is 1, of the polynomial 0 as well.
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
}
