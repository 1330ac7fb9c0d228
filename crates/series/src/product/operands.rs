//! The factors of a sum of products, with codes in ascending order.

use super::code::{Key, Layout};
use super::engine::{Operand, Part, Weights};
use super::rule::{Product, Weight};
use crate::coefficient::Coefficient;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;

/// One factor: its operand, and its monomials in the same order.
struct Factor<K, F> {
    operand: Operand<K, F>,
    monomials: Vec<Monomial>,
}

/// All left and all right factors.
pub(super) struct Sides<K, F> {
    left: Vec<Factor<K, F>>,
    right: Vec<Factor<K, F>>,
}

impl<K: Key, F: Clone> Sides<K, F> {
    pub(super) fn new<C: Coefficient>(
        (left, right): (&[&Polynomial<C>], &[&Polynomial<C>]),
        factors: (Vec<Vec<F>>, Vec<Vec<F>>),
        layout: &Layout,
    ) -> Self {
        let encode = layout.encoder();
        let side = |polynomials: &[&Polynomial<C>], factors: Vec<Vec<F>>| {
            let coded = polynomials.iter().zip(factors).map(|(p, factors)| {
                let monomials = p.terms.monomials();
                let codes: Vec<K> = monomials.iter().map(|&monomial| K::narrowed(encode(monomial))).collect();
                factor(codes, monomials, factors)
            });
            coded.collect()
        };
        Sides { left: side(left, factors.0), right: side(right, factors.1) }
    }

    /// The input of the engine for one product. The factor with fewer terms is the outer one.
    pub(super) fn part<'a>(&'a self, product: &Product, layout: &Layout) -> Part<'a, K, F> {
        let (left, right) = (&self.left[product.left], &self.right[product.right]);
        let turned = left.monomials.len() > right.monomials.len();
        let (outer, inner) = if turned { (right, left) } else { (left, right) };
        let (shift, weights) = match product.weight {
            Weight::Constant(weight) => (0, Weights::Constant(weight)),
            Weight::Rule(rule) => {
                let encode = layout.encoder();
                let shift = encode(Monomial::from_key(rule.raised)) - encode(Monomial::from_key(rule.lowered));
                let sign = if turned { -rule.sign } else { rule.sign };
                let exponents = |factor: &Factor<K, F>, sign: i64| {
                    let pair = |m: &Monomial| [m.exponent(rule.first), m.exponent(rule.second)];
                    factor.monomials.iter().map(|m| pair(m).map(|exponent| sign * i64::from(exponent))).collect()
                };
                (shift, Weights::Bracket { outer: exponents(outer, sign), inner: exponents(inner, 1) })
            }
        };
        Part { outer: &outer.operand, inner: &inner.operand, shift: K::narrowed(shift), weights }
    }
}

/// Sorts a factor by code; most factors are already sorted.
fn factor<K: Key, F: Clone>(codes: Vec<K>, monomials: &[Monomial], factors: Vec<F>) -> Factor<K, F> {
    if codes.is_sorted() {
        return Factor { operand: Operand { codes, factors }, monomials: monomials.to_vec() };
    }
    let mut order: Vec<usize> = (0..codes.len()).collect();
    order.sort_unstable_by_key(|&at| codes[at]);
    Factor {
        operand: Operand {
            codes: order.iter().map(|&at| codes[at]).collect(),
            factors: order.iter().map(|&at| factors[at].clone()).collect(),
        },
        monomials: order.iter().map(|&at| monomials[at]).collect(),
    }
}
