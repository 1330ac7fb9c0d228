//! The old variables of the modes in the new ones, term by term, grouped by the multiples of the proper angles.

use std::collections::BTreeMap;

use super::divisors::turns;
use super::rows::row::Periodic;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;

/// A term c(M) u^a U^b of an old variable.
#[derive(Clone, Debug)]
pub(super) struct ImageTerm {
    /// The variable.
    pub(super) slot: usize,
    pub(super) monomial: Monomial,
    pub(super) coefficient: Periodic,
    /// The largest modulus of the coefficient.
    pub(super) size: f64,
    /// Whether b − a is the opposite of the multiples of the group.
    pub(super) opposite: bool,
}

/// Terms with the same b − a up to its sign, the first multiple that is not 0 positive.
#[derive(Clone, Debug)]
pub(super) struct ImageGroup {
    pub(super) multiples: Vec<i64>,
    pub(super) terms: Vec<ImageTerm>,
}

/// All terms.
#[derive(Clone, Debug)]
pub(super) struct Images(pub(super) Vec<ImageGroup>);

impl Images {
    /// The terms of variables, given as polynomials. The group without multiples, to which the periodic motion belongs, is always there.
    pub(super) fn new(images: &[(usize, Polynomial<Periodic>)], modes: usize) -> Self {
        let mut groups = BTreeMap::from([(vec![0; modes], Vec::new())]);
        for (slot, image) in images {
            for (monomial, c) in image.terms() {
                let mut multiples = turns(monomial, modes);
                let opposite = multiples.iter().find(|&&k| k != 0).is_some_and(|&k| k < 0);
                if opposite {
                    multiples.iter_mut().for_each(|k| *k = -*k);
                }
                let term = ImageTerm { slot: *slot, monomial, coefficient: c.clone(), size: c.size(), opposite };
                groups.entry(multiples).or_default().push(term);
            }
        }
        Self(groups.into_iter().map(|(multiples, terms)| ImageGroup { multiples, terms }).collect())
    }

    pub(super) fn terms(&self) -> impl Iterator<Item = &ImageTerm> {
        self.0.iter().flat_map(|group| &group.terms)
    }

    pub(super) fn memory(&self) -> usize {
        self.terms().map(|term| size_of_val(term) + term.coefficient.memory()).sum()
    }
}

impl ImageTerm {
    /// The order of the form to which the term belongs.
    pub(super) fn order(&self) -> usize {
        (self.monomial.total_degree() as usize).saturating_sub(1)
    }

    /// The product of the powers of the term where the variables u₁, U₁, … have these moduli.
    pub(super) fn modulus(&self, moduli: &[f64]) -> f64 {
        let powers = moduli.iter().enumerate();
        powers.map(|(slot, modulus)| modulus.powi(self.monomial.exponent(slot) as i32)).product()
    }
}
