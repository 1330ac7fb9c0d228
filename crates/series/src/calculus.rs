//! Derivative, substitution and evaluation.
//!
//! The powers of a replacement are computed once and shared by all terms. Sums run in canonical order.

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::monomial::check_slot;
use crate::monomial::{Monomial, SLOTS};
use crate::polynomial::{Polynomial, Truncation};
use std::collections::BTreeMap;

impl<C: Coefficient> Polynomial<C> {
    /// The partial derivative with respect to the variable of `slot`.
    ///
    /// ```
    /// use andoyer_series::Polynomial;
    /// let parse = |text| Polynomial::<f64>::parse(text, &["x", "y"]);
    /// assert_eq!(parse("x^3*y")?.derivative(0)?, parse("3*x^2*y")?);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - slot 8: [`Error::SlotOutOfRange`].
    pub fn derivative(&self, slot: usize) -> Result<Self, Error> {
        check_slot(slot)?;
        let terms = self.terms().filter_map(|(monomial, c)| {
            let exponent = monomial.exponent(slot);
            let lowered = monomial.with(slot, exponent.checked_sub(1)?);
            Some(lowered.map(|lowered| (lowered, c.times(exponent.into()))))
        });
        Ok(Self::from_terms(terms.collect::<Result<Vec<_>, _>>()?))
    }

    /// This polynomial with `replacement` substituted for the variable of `slot`.
    ///
    /// # Errors
    /// - slot 8: [`Error::SlotOutOfRange`];
    /// - x^200 substituted for x in x^200: [`Error::ExponentOverflow`].
    pub fn substitute(&self, slot: usize, replacement: &Self) -> Result<Self, Error> {
        self.compose(&[(slot, replacement)], None)
    }

    /// This polynomial with all replacements substituted at once. Terms that `truncation` drops are not computed.
    ///
    /// ```
    /// use andoyer_series::Polynomial;
    /// let parse = |text| Polynomial::<f64>::parse(text, &["x", "y"]);
    /// let swapped = parse("x - 2*y")?.compose(&[(0, &parse("y")?), (1, &parse("x")?)], None)?;
    /// assert_eq!(swapped, parse("y - 2*x")?);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - slot 8: [`Error::SlotOutOfRange`]; one slot twice: [`Error::SlotRepeated`];
    /// - x^200 substituted for x in x^200: [`Error::ExponentOverflow`].
    pub fn compose(&self, replacements: &[(usize, &Self)], truncation: Option<&Truncation>) -> Result<Self, Error> {
        let mut slots = Vec::new();
        for &(slot, _) in replacements {
            check_slot(slot)?;
            if slots.contains(&slot) {
                return Err(Error::SlotRepeated { slot });
            }
            slots.push(slot);
        }
        // Terms with equal exponents of the replaced variables share one product of powers.
        let mut groups = BTreeMap::<Vec<u32>, Self>::new();
        for (monomial, c) in self.terms() {
            let exponents = slots.iter().map(|&slot| monomial.exponent(slot)).collect();
            groups.entry(exponents).or_default().add_term(monomial.without(slots.iter().copied()), c);
        }
        let mut powers: Vec<_> = replacements.iter().map(|&(_, base)| Powers::new(base, truncation)).collect();
        let mut sum = Self::zero();
        for (exponents, rest) in groups {
            let mut product = rest;
            for (powers, exponent) in powers.iter_mut().zip(exponents) {
                product = product.product(powers.get(exponent)?, truncation)?;
            }
            sum += &product;
        }
        Ok(match truncation {
            Some(truncation) => sum.truncate(truncation),
            None => sum,
        })
    }

    /// The value at a point: `values[slot]` is the value of the variable in `slot`.
    ///
    /// ```
    /// use andoyer_series::Polynomial;
    /// let p = Polynomial::<f64>::parse("x^2*y + 3", &["x", "y"])?;
    /// assert_eq!(p.evaluate(&[2.0, 5.0])?, 23.0);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - x*y with one value only: [`Error::ValueMissing`].
    pub fn evaluate(&self, values: &[C]) -> Result<C, Error> {
        let mut tables: Vec<Vec<C>> = values.iter().map(|_| vec![C::one()]).collect();
        let mut sum = C::zero();
        for (monomial, c) in self.terms() {
            let mut product = c.clone();
            for slot in (0..SLOTS).filter(|&slot| monomial.exponent(slot) > 0) {
                let exponent = monomial.exponent(slot) as usize;
                let missing = Error::ValueMissing { slot, given: values.len() };
                let (Some(table), Some(value)) = (tables.get_mut(slot), values.get(slot)) else { return Err(missing) };
                while table.len() <= exponent {
                    let mut next = table[table.len() - 1].clone();
                    next *= value;
                    table.push(next);
                }
                product *= &table[exponent];
            }
            sum += &product;
        }
        Ok(sum)
    }

    /// This polynomial with a number substituted for the variable of `slot`.
    ///
    /// # Errors
    /// - slot 8: [`Error::SlotOutOfRange`].
    pub fn evaluate_partial(&self, slot: usize, value: &C) -> Result<Self, Error> {
        check_slot(slot)?;
        let mut table = vec![C::one()];
        let mut sum = Self::zero();
        for (monomial, c) in self.terms() {
            let exponent = monomial.exponent(slot) as usize;
            while table.len() <= exponent {
                let mut next = table[table.len() - 1].clone();
                next *= value;
                table.push(next);
            }
            let mut product = c.clone();
            product *= &table[exponent];
            sum.add_term(monomial.without([slot]), &product);
        }
        Ok(sum)
    }

    /// This polynomial with the variables of two slots exchanged.
    ///
    /// # Errors
    /// - slot 8: [`Error::SlotOutOfRange`].
    pub fn exchange(&self, first: usize, second: usize) -> Result<Self, Error> {
        check_slot(first)?;
        check_slot(second)?;
        let exchanged = self.terms().map(|(monomial, c)| {
            let (j, k) = (monomial.exponent(first), monomial.exponent(second));
            Ok((monomial.with(first, k)?.with(second, j)?, c.clone()))
        });
        Ok(Self::from_terms(exchanged.collect::<Result<Vec<(Monomial, C)>, Error>>()?))
    }
}

/// The powers of a polynomial, computed on demand.
struct Powers<'a, C> {
    base: &'a Polynomial<C>,
    truncation: Option<&'a Truncation>,
    known: BTreeMap<u32, Polynomial<C>>,
}

impl<'a, C: Coefficient> Powers<'a, C> {
    fn new(base: &'a Polynomial<C>, truncation: Option<&'a Truncation>) -> Self {
        let known = BTreeMap::from([(0, Polynomial::constant(C::one()))]);
        Powers { base, truncation, known }
    }

    /// The power `exponent`, computed from the largest known power below it. For the first variable the exponents come in ascending order.
    fn get(&mut self, exponent: u32) -> Result<&Polynomial<C>, Error> {
        if !self.known.contains_key(&exponent) {
            let (start, mut power) = match self.known.range(..exponent).next_back() {
                Some((&start, power)) => (start, power.clone()),
                None => (0, Polynomial::constant(C::one())),
            };
            let gap = self.base.power_within(exponent - start, self.truncation)?;
            power = power.product(&gap, self.truncation)?;
            self.known.insert(exponent, power);
        }
        Ok(&self.known[&exponent])
    }
}
