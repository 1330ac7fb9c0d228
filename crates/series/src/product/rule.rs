//! The weight of a product in a sum.

use crate::monomial::Monomial;

/// One product of the sum: the positions of its factors, and its weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Product {
    pub(super) left: usize,
    pub(super) right: usize,
    pub(super) weight: Weight,
}

/// The weight of a product.
#[derive(Debug, Clone, Copy)]
pub(super) enum Weight {
    Constant(i64),
    Rule(Rule),
}

/// The effect of one pair of variables on a pair of terms in a bracket: an integer weight and a shift of the exponents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Rule {
    pub(crate) first: usize,
    pub(crate) second: usize,
    pub(crate) sign: i64,
    pub(crate) raised: u128,
    pub(crate) lowered: u128,
}

impl Rule {
    /// The weight ± (j₁ k₂ − k₁ j₂), where j, k are the exponents of the first and the second variable of the pair.
    pub(super) fn weigh(&self, left: Monomial, right: Monomial) -> i64 {
        let exponent = |m: Monomial, slot| i64::from(m.exponent(slot));
        let (j1, k1) = (exponent(left, self.first), exponent(left, self.second));
        let (j2, k2) = (exponent(right, self.first), exponent(right, self.second));
        self.sign * (j1 * k2 - k1 * j2)
    }
}
