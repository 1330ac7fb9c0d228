//! The terms of a polynomial in memory.
//!
//! The packed monomials and the coefficients are two arrays. Products, sums and constructors leave them in canonical order. If terms are added one by one out
//! of order, a hash index is built to find them. Exact coefficients of a product stay [`Words`] until they are read.

use crate::coefficient::Coefficient;
use crate::monomial::Monomial;
use crate::words::Words;
use rustc_hash::FxBuildHasher;
use std::collections::HashMap;
use std::sync::OnceLock;

/// Distinct monomials with nonzero coefficients.
#[derive(Clone)]
pub(crate) struct Terms<C> {
    monomials: Vec<Monomial>,
    /// The coefficients, converted from `words` at the first read.
    values: OnceLock<Vec<C>>,
    words: Option<Words>,
    /// Positions of all terms. The index exists only if the terms are out of order.
    index: Option<HashMap<Monomial, usize, FxBuildHasher>>,
}

impl<C> Default for Terms<C> {
    fn default() -> Self {
        Terms { monomials: Vec::new(), values: OnceLock::from(Vec::new()), words: None, index: None }
    }
}

impl<C> Terms<C> {
    /// The monomials, in the order of the values.
    pub(crate) fn monomials(&self) -> &[Monomial] {
        &self.monomials
    }

    /// Whether the terms are in canonical order.
    pub(crate) fn is_ordered(&self) -> bool {
        self.index.is_none()
    }
}

impl<C: Coefficient> Terms<C> {
    /// Terms in canonical order; no coefficient is 0.
    pub(crate) fn ordered(monomials: Vec<Monomial>, values: Vec<C>) -> Self {
        debug_assert!(
            monomials.is_sorted() && monomials.len() == values.len(),
            "terms in canonical order, one value for each monomial"
        );
        Terms { monomials, values: OnceLock::from(values), words: None, index: None }
    }

    /// The same as [`ordered`](Self::ordered), with the coefficients in machine words.
    pub(crate) fn ordered_words(monomials: Vec<Monomial>, words: Words) -> Self {
        debug_assert!(
            monomials.is_sorted() && monomials.len() == words.numerators.len(),
            "terms in canonical order, one value for each monomial"
        );
        Terms { monomials, values: OnceLock::new(), words: Some(words), index: None }
    }

    /// The sum of the given terms in any order. Coefficients of equal monomials are added in the given order.
    pub(crate) fn from_unordered(mut terms: Vec<(Monomial, C)>) -> Self {
        if !terms.is_sorted_by(|(m, _), (n, _)| m < n) {
            terms.sort_by_cached_key(|(monomial, _)| monomial.rank());
        }
        let (mut monomials, mut values) = (Vec::with_capacity(terms.len()), Vec::<C>::with_capacity(terms.len()));
        for (monomial, value) in terms {
            match values.last_mut() {
                Some(held) if monomials.last() == Some(&monomial) => *held += &value,
                _ => {
                    if values.last().is_some_and(C::is_zero) {
                        monomials.pop();
                        values.pop();
                    }
                    monomials.push(monomial);
                    values.push(value);
                }
            }
        }
        if values.last().is_some_and(C::is_zero) {
            monomials.pop();
            values.pop();
        }
        Self::ordered(monomials, values)
    }

    /// The coefficients, in the order of the monomials.
    pub(crate) fn values(&self) -> &[C] {
        self.values.get_or_init(|| match (&self.words, C::MACHINE_WORDS) {
            (Some(words), Some(face)) => (face.lower)(words),
            _ => Vec::new(), // Terms without words have their values from the start.
        })
    }

    /// The coefficients in machine words, or `None` if they do not fit.
    pub(crate) fn words(&self) -> Option<std::borrow::Cow<'_, Words>> {
        match &self.words {
            Some(words) => Some(std::borrow::Cow::Borrowed(words)),
            None => (C::MACHINE_WORDS?.lift)(self.values()).map(std::borrow::Cow::Owned),
        }
    }

    /// The terms in the order of the arrays.
    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = (Monomial, &C)> {
        self.monomials.iter().copied().zip(self.values())
    }

    pub(crate) fn into_values(self) -> (Vec<Monomial>, Vec<C>) {
        self.values();
        (self.monomials, self.values.into_inner().unwrap_or_default())
    }

    /// The position of a monomial in the arrays.
    pub(crate) fn position(&self, monomial: Monomial) -> Option<usize> {
        match &self.index {
            Some(index) => index.get(&monomial).copied(),
            None => {
                let rank = monomial.rank();
                self.monomials.binary_search_by_key(&rank, |held| held.rank()).ok()
            }
        }
    }

    /// Adds one term.
    pub(crate) fn add(&mut self, monomial: Monomial, coefficient: &C) {
        if coefficient.is_zero() {
            return;
        }
        self.values();
        self.words = None;
        let last = self.monomials.last().copied();
        if self.index.is_none() && last.is_none_or(|last| last < monomial) {
            self.push(monomial, coefficient.clone());
        } else if let Some(at) = self.position(monomial) {
            let Some(values) = self.values.get_mut() else { return };
            values[at] += coefficient;
            if values[at].is_zero() {
                self.remove(at);
            }
        } else {
            let monomials = &self.monomials;
            let index = self.index.get_or_insert_with(|| monomials.iter().copied().zip(0..).collect());
            index.insert(monomial, monomials.len());
            self.push(monomial, coefficient.clone());
        }
    }

    fn push(&mut self, monomial: Monomial, value: C) {
        self.monomials.push(monomial);
        if let Some(values) = self.values.get_mut() {
            values.push(value);
        }
    }

    fn remove(&mut self, at: usize) {
        let Some(values) = self.values.get_mut() else { return };
        match &mut self.index {
            None => {
                self.monomials.remove(at);
                values.remove(at);
            }
            Some(index) => {
                index.remove(&self.monomials.swap_remove(at));
                values.swap_remove(at);
                if let Some(&moved) = self.monomials.get(at) {
                    index.insert(moved, at);
                }
            }
        }
    }

    /// Brings the terms into canonical order.
    pub(crate) fn settle(&mut self) {
        if !self.is_ordered() {
            let (monomials, values) = std::mem::take(self).into_values();
            *self = Self::from_unordered(monomials.into_iter().zip(values).collect());
        }
    }
}
