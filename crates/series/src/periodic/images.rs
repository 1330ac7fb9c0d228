//! The old variables of the modes in the new ones, term by term, grouped by the multiples of the proper angles.

use std::collections::BTreeMap;

use num_complex::Complex;

use super::divisors::turns;
use super::row::Periodic;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;

/// A term c(M) u^a U^b of an old variable.
#[derive(Clone, Debug)]
pub(super) struct ImageTerm {
    /// The variable.
    pub(super) slot: usize,
    pub(super) monomial: Monomial,
    pub(super) order: usize,
    pub(super) coefficient: Periodic,
    /// The largest modulus of the coefficient.
    size: f64,
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
    /// The terms of variables, given by the parts of the orders 0, 1, …
    pub(super) fn new(parts: Vec<(usize, Vec<Polynomial<Periodic>>)>, modes: usize) -> Self {
        let mut groups: BTreeMap<Vec<i64>, Vec<ImageTerm>> = BTreeMap::new();
        for (slot, parts) in parts {
            for (order, part) in parts.iter().enumerate() {
                for (monomial, c) in part.terms() {
                    let mut multiples = turns(monomial, modes);
                    let opposite = multiples.iter().find(|&&k| k != 0).is_some_and(|&k| k < 0);
                    if opposite {
                        multiples.iter_mut().for_each(|k| *k = -*k);
                    }
                    let term =
                        ImageTerm { slot, monomial, order, coefficient: c.clone(), size: c.size(), opposite };
                    groups.entry(multiples).or_default().push(term);
                }
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
    /// A bound of the term where the variables have these moduli.
    pub(super) fn bound(&self, moduli: &Powers<f64>) -> f64 {
        self.size * moduli.of(self.monomial)
    }
}

/// Powers of variables.
pub(super) struct Powers<T> {
    powers: Vec<Vec<T>>,
}

impl<T: Copy + std::ops::Mul<Output = T> + num_traits::One> Powers<T> {
    pub(super) fn new(values: &[T], highest: usize) -> Self {
        let of = |&value: &T| std::iter::successors(Some(T::one()), |&last| Some(last * value)).take(highest + 1).collect();
        Self { powers: values.iter().map(of).collect() }
    }

    pub(super) fn of(&self, monomial: Monomial) -> T {
        let powers = self.powers.iter().enumerate();
        powers.fold(T::one(), |product, (slot, powers)| product * powers[monomial.exponent(slot) as usize])
    }
}

/// u and U of centres with these actions and the proper angles 0.
pub(super) fn at_angles_0(actions: &[f64]) -> Vec<Complex<f64>> {
    let pair = |&action: &f64| {
        let size = (2.0 * action).sqrt();
        [Complex::new(0.0, size / 2.0), Complex::new(size, 0.0)]
    };
    actions.iter().flat_map(pair).collect()
}
