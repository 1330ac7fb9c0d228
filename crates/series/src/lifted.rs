//! Sums of products and of brackets, accumulated unreduced.
//!
//! Left factors are lifted together to one scale and so are right factors; then every product of a left with a right
//! has the same denominator, and a whole sum (the inner sum of Deprit's triangle, for one) costs one gcd for each
//! resulting term. Terms are taken in canonical order, so a floating-point sum has the same bits in every run.

use crate::polynomial::Terms;
use crate::{Coefficient, Error, Monomial, Polynomial, Truncation};

/// Products from one call of `pause` to the next: some tens of milliseconds of large rationals.
const PRODUCTS_PER_PAUSE: usize = 1 << 14;

/// What a long sum calls now and then; an error ends it.
pub(crate) type Pause<'a> = dyn FnMut() -> Result<(), Error> + 'a;

type LiftedTerms<C> = Vec<(Monomial, <C as Coefficient>::Raw)>;

/// A weighted sum of products of some left polynomials with some right ones.
pub(crate) struct Accumulator<C: Coefficient> {
    left: Vec<LiftedTerms<C>>,
    right: Vec<LiftedTerms<C>>,
    scales: (C::Scale, C::Scale),
    sums: Terms<C::Raw>,
    /// Products since the last pause.
    products: usize,
}

fn lift_together<C: Coefficient>(polynomials: &[&Polynomial<C>]) -> (Vec<LiftedTerms<C>>, C::Scale) {
    let sorted: Vec<_> = polynomials.iter().map(|p| p.sorted()).collect();
    let values: Vec<&C> = sorted.iter().flatten().map(|&(_, c)| c).collect();
    let (raws, scale) = C::lift(&values);
    let mut raws = raws.into_iter();
    let attach = |terms: Vec<(Monomial, &C)>| terms.into_iter().map(|(m, _)| m).zip(raws.by_ref()).collect();
    (sorted.into_iter().map(attach).collect(), scale)
}

impl<C: Coefficient> Accumulator<C> {
    /// Lifts the factors; they are named by their position from here on.
    pub(crate) fn new(left: &[&Polynomial<C>], right: &[&Polynomial<C>]) -> Self {
        let ((left, first), (right, second)) = (lift_together(left), lift_together(right));
        Accumulator { left, right, scales: (first, second), sums: Terms::default(), products: 0 }
    }

    /// Adds `weight` · left · right, leaving out what `truncation` drops.
    pub(crate) fn add_product(
        &mut self,
        (left, right): (usize, usize),
        weight: i64,
        truncation: Option<&Truncation>,
    ) -> Result<(), Error> {
        for (m, a) in &self.left[left] {
            for (n, b) in &self.right[right] {
                let monomial = m.checked_mul(*n)?;
                if truncation.is_none_or(|truncation| truncation.keeps(monomial)) {
                    C::raw_accumulate(self.sums.entry(monomial).or_default(), &C::raw_product(a, b), weight);
                }
            }
        }
        Ok(())
    }

    /// Adds one term for each pair of terms and each of its weights: `weigh(left, right)` for every rule.
    pub(crate) fn add_bracket(
        &mut self,
        (left, right): (usize, usize),
        rules: &[Rule],
        pause: &mut Pause<'_>,
    ) -> Result<(), Error> {
        for (m, a) in &self.left[left] {
            self.products += self.right[right].len();
            if self.products >= PRODUCTS_PER_PAUSE {
                self.products = 0;
                pause()?;
            }
            for (n, b) in &self.right[right] {
                let mut product = None;
                for rule in rules {
                    let weight = rule.weigh(*m, *n);
                    if weight != 0 {
                        let monomial = m.bracket_mul(*n, rule.raised, rule.lowered)?;
                        let product = product.get_or_insert_with(|| C::raw_product(a, b));
                        C::raw_accumulate(self.sums.entry(monomial).or_default(), product, weight);
                    }
                }
            }
        }
        Ok(())
    }

    /// The sum, reduced.
    pub(crate) fn finish(self) -> Polynomial<C> {
        let (first, second) = &self.scales;
        let lowered = self.sums.into_iter().map(|(monomial, raw)| (monomial, C::lower(raw, first, second)));
        Polynomial { terms: lowered.filter(|(_, c)| !c.is_zero()).collect() }
    }
}

/// What one pair of variables makes of a pair of terms: an integer weight and a shift of the exponents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Rule {
    pub(crate) first: usize,
    pub(crate) second: usize,
    pub(crate) sign: i64,
    pub(crate) raised: u128,
    pub(crate) lowered: u128,
}

impl Rule {
    /// ± (j₁ k₂ − k₁ j₂), with j, k the exponents of the first and the second variable of the pair.
    fn weigh(&self, left: Monomial, right: Monomial) -> i64 {
        let exponent = |m: Monomial, slot| i64::from(m.exponent(slot));
        let (j1, k1) = (exponent(left, self.first), exponent(left, self.second));
        let (j2, k2) = (exponent(right, self.first), exponent(right, self.second));
        self.sign * (j1 * k2 - k1 * j2)
    }
}
