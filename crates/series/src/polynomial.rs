//! Sparse polynomials in up to eight variables: constructors and parts.
//!
//! A polynomial is a set of distinct [`Monomial`]s with nonzero coefficients in canonical order. Iteration, printing and summation follow this order, so floats
//! have the same bits in every run. Products leave their terms sorted, and a term is found by binary search. If terms are added one by one out of order, a hash
//! index finds them, and iteration sorts them.

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::monomial::check_slot;
use crate::monomial::{Monomial, SLOTS};
use crate::terms::Terms;
use std::hash::{Hash, Hasher};

/// A polynomial with coefficients `C`.
///
/// ```
/// use andoyer_series::Polynomial;
/// use num_rational::BigRational;
/// let p = Polynomial::<BigRational>::parse("(x + y)^2 - 2*x*y", &["x", "y"])?;
/// assert_eq!(p.display(&["x", "y"]).to_string(), "x^2 + y^2");
/// # Ok::<(), andoyer_series::Error>(())
/// ```
#[derive(Clone)]
pub struct Polynomial<C> {
    pub(crate) terms: Terms<C>,
}

impl<C: Coefficient> Polynomial<C> {
    /// The polynomial 0.
    #[must_use]
    pub fn zero() -> Self {
        Polynomial { terms: Terms::default() }
    }

    /// The constant polynomial `value`.
    #[must_use]
    pub fn constant(value: C) -> Self {
        Self::from_terms([(Monomial::ONE, value)])
    }

    /// The variable in `slot`.
    ///
    /// # Errors
    /// - slot 8: [`Error::SlotOutOfRange`].
    pub fn variable(slot: usize) -> Result<Self, Error> {
        Ok(Self::from_terms([(Monomial::ONE.with(slot, 1)?, C::one())]))
    }

    /// The sum of the given terms. Coefficients of equal monomials are added in the given order.
    #[must_use]
    pub fn from_terms(terms: impl IntoIterator<Item = (Monomial, C)>) -> Self {
        Polynomial { terms: Terms::from_unordered(terms.into_iter().collect()) }
    }

    /// Adds one term to this polynomial.
    pub fn add_term(&mut self, monomial: Monomial, coefficient: &C) {
        self.terms.add(monomial, coefficient);
    }

    /// The terms in canonical order.
    pub fn terms(&self) -> impl ExactSizeIterator<Item = (Monomial, &C)> {
        self.sorted().into_iter()
    }

    pub(crate) fn sorted(&self) -> Vec<(Monomial, &C)> {
        let mut terms: Vec<_> = self.terms.iter().collect();
        if !self.terms.is_ordered() {
            terms.sort_by_cached_key(|(monomial, _)| monomial.rank());
        }
        terms
    }

    /// The coefficient of `monomial`, or `None` if it does not occur.
    #[must_use]
    pub fn coefficient(&self, monomial: &Monomial) -> Option<&C> {
        self.terms.position(*monomial).map(|at| &self.terms.values()[at])
    }

    /// Number of terms.
    #[must_use]
    pub fn len(&self) -> usize {
        self.terms.monomials().len()
    }

    /// Whether this is the polynomial 0, which has no terms. The same as [`is_zero`](Self::is_zero).
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.terms.monomials().is_empty()
    }

    /// Whether this is the polynomial 0.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.terms.monomials().is_empty()
    }

    /// The value of a constant polynomial (0 for the polynomial 0), or `None` if a variable occurs.
    #[must_use]
    pub fn as_constant(&self) -> Option<C> {
        match self.len() {
            0 => Some(C::zero()),
            1 => self.coefficient(&Monomial::ONE).cloned(),
            _ => None,
        }
    }

    /// The polynomial with `function` applied to every coefficient, for example to convert it to another type.
    #[must_use]
    pub fn map<D: Coefficient>(&self, mut function: impl FnMut(&C) -> D) -> Polynomial<D> {
        Polynomial::from_terms(self.terms().map(|(monomial, c)| (monomial, function(c))))
    }

    /// The terms for which `keep` returns true.
    #[must_use]
    pub fn filter(&self, mut keep: impl FnMut(Monomial, &C) -> bool) -> Self {
        Self::from_terms(self.terms().filter(|&(monomial, c)| keep(monomial, c)).map(|(m, c)| (m, c.clone())))
    }

    /// The terms that `truncation` keeps.
    #[must_use]
    pub fn truncate(&self, truncation: &Truncation) -> Self {
        self.filter(|monomial, _| truncation.keeps(monomial))
    }

    /// The terms of total degree `degree`.
    #[must_use]
    pub fn homogeneous_part(&self, degree: u32) -> Self {
        self.filter(|monomial, _| monomial.total_degree() == degree)
    }

    /// The terms of degree `degree` in the variable of `slot`.
    ///
    /// # Errors
    /// - slot 8: [`Error::SlotOutOfRange`].
    pub fn part(&self, slot: usize, degree: u32) -> Result<Self, Error> {
        check_slot(slot)?;
        Ok(self.filter(|monomial, _| monomial.exponent(slot) == degree))
    }

    /// Largest total degree of a term, or `None` for the polynomial 0.
    #[must_use]
    pub fn degree(&self) -> Option<u32> {
        self.terms.monomials().iter().map(|monomial| monomial.total_degree()).max()
    }
}

impl<C> Default for Polynomial<C> {
    fn default() -> Self {
        Polynomial { terms: Terms::default() }
    }
}

impl<C: Coefficient> PartialEq for Polynomial<C> {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.terms().eq(other.terms())
    }
}

impl<C: Coefficient + Eq> Eq for Polynomial<C> {}

impl<C: Coefficient + Hash> Hash for Polynomial<C> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let terms = self.sorted();
        state.write_usize(terms.len());
        terms.hash(state);
    }
}

/// A rule for the terms of a product to keep: those up to a total degree, or up to a degree in some of the variables.
///
/// ```
/// use andoyer_series::{Polynomial, Truncation};
/// let p = Polynomial::<f64>::parse("x^2*y + x*y^2", &["x", "y"])?;
/// assert_eq!(p.truncate(&Truncation::partial(&[0], 1)?).display(&["x", "y"]).to_string(), "x*y^2");
/// # Ok::<(), andoyer_series::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Truncation {
    slots: Vec<usize>,
    degree: u32,
}

impl Truncation {
    /// Keeps the terms of total degree `degree` or less.
    #[must_use]
    pub fn total(degree: u32) -> Self {
        Truncation { slots: (0..SLOTS).collect(), degree }
    }

    /// Keeps the terms whose degree in the variables of `slots` together is `degree` or less.
    ///
    /// # Errors
    /// - slot 8: [`Error::SlotOutOfRange`].
    pub fn partial(slots: &[usize], degree: u32) -> Result<Self, Error> {
        slots.iter().try_for_each(|&slot| check_slot(slot))?;
        Ok(Truncation { slots: slots.to_vec(), degree })
    }

    pub(crate) fn slots(&self) -> &[usize] {
        &self.slots
    }

    pub(crate) fn degree(&self) -> u32 {
        self.degree
    }

    /// Whether a monomial is kept.
    #[must_use]
    pub fn keeps(&self, monomial: Monomial) -> bool {
        monomial.degree_in(&self.slots) <= self.degree
    }
}
