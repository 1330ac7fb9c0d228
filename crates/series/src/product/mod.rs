//! Sums of products and of brackets. All multiplication of polynomials takes place here.
//!
//! All left factors are lifted to one scale, and all right factors to another. Every product then has the same denominator, and a whole sum (such as the inner
//! sum of Deprit's triangle) costs at most one gcd for each resulting term. If a bound computed in advance shows that the sums fit, exact factors are 64-bit
//! integers with 128-bit sums; otherwise they are big integers. Products are added in canonical order of the factor with fewer terms, then of the other factor.
//! A floating-point sum therefore has the same bits in every run and with any number of threads.

mod arithmetic;
mod code;
mod engine;
mod operands;
mod pause;
mod piece;
mod rule;
mod store;

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::monomial::{MAX_EXPONENT, SLOTS};
use crate::polynomial::{Polynomial, Truncation};
use crate::terms::Terms;
use crate::words::{FactorList, Factors, Numerators, Words};
use arithmetic::{Arithmetic, GaussianIntegers, Integers, Lifted};
use code::{Key, Layout};
use engine::{CELLS_PER_PRODUCT, Part, Sum};
use operands::Sides;
pub(crate) use pause::Pause;
use piece::Piece;
pub(crate) use rule::Rule;
use rule::{Product, Weight};

/// The factors of both sides, polynomial by polynomial.
type OperandFactors<A> = (Vec<Vec<<A as Arithmetic>::Factor>>, Vec<Vec<<A as Arithmetic>::Factor>>);

/// Sums below this bound fit in 128 bits.
const LARGEST_SUM: f64 = (1_u128 << 126) as f64;

/// A weighted sum of products of left polynomials with right polynomials.
pub(crate) struct Accumulator<'a, C> {
    left: Vec<&'a Polynomial<C>>,
    right: Vec<&'a Polynomial<C>>,
    products: Vec<Product>,
    truncation: Option<&'a Truncation>,
}

impl<'a, C: Coefficient> Accumulator<'a, C> {
    /// A sum with these factors, which are then named by their positions.
    pub(crate) fn new(left: &[&'a Polynomial<C>], right: &[&'a Polynomial<C>]) -> Self {
        Accumulator { left: left.to_vec(), right: right.to_vec(), products: Vec::new(), truncation: None }
    }

    /// The same sum without the terms that `truncation` drops.
    pub(crate) fn within(mut self, truncation: Option<&'a Truncation>) -> Self {
        self.truncation = truncation;
        self
    }

    /// Adds `weight` · left · right.
    pub(crate) fn add_product(&mut self, (left, right): (usize, usize), weight: i64) {
        self.products.push(Product { left, right, weight: Weight::Constant(weight) });
    }

    /// Adds, for each pair of terms and each rule, their product with the weight `rule.weigh(left, right)`.
    pub(crate) fn add_bracket(&mut self, (left, right): (usize, usize), rules: &[Rule]) {
        self.products.extend(rules.iter().map(|&rule| Product { left, right, weight: Weight::Rule(rule) }));
    }

    /// Computes the sum. An exponent that overflows is an error, even in a product that is dropped.
    pub(crate) fn finish(mut self, pause: &mut Pause<'_>) -> Result<Polynomial<C>, Error> {
        self.products.retain(|product| !self.left[product.left].is_zero() && !self.right[product.right].is_zero());
        if self.products.is_empty() {
            return Ok(Polynomial::zero());
        }
        let bounds = self.exponent_bounds()?;
        match self.in_words() {
            Some(words) => self.sum_of_words(&words, &bounds, pause),
            None => self.sum_of_lifted(&bounds, pause),
        }
    }

    /// The largest exponents of the result.
    fn exponent_bounds(&self) -> Result<[u32; SLOTS], Error> {
        let most = |p: &&Polynomial<C>| largest(p.terms.monomials());
        let (left, right): (Vec<_>, Vec<_>) =
            (self.left.iter().map(most).collect(), self.right.iter().map(most).collect());
        let mut bounds = [0; SLOTS];
        for product in &self.products {
            let raised = match product.weight {
                Weight::Constant(_) => [0; SLOTS],
                Weight::Rule(rule) => Monomial::from_key(rule.raised).exponents(),
            };
            let mut reached = [0; SLOTS];
            for slot in 0..SLOTS {
                reached[slot] = left[product.left][slot] + right[product.right][slot] + raised[slot];
            }
            if reached.iter().any(|&exponent| exponent > MAX_EXPONENT) {
                self.check_exponents(product)?;
            }
            for (bound, reached) in bounds.iter_mut().zip(reached) {
                *bound = reached.min(MAX_EXPONENT).max(*bound);
            }
        }
        Ok(bounds)
    }

    /// Searches all pairs of terms of a product for an exponent that overflows.
    fn check_exponents(&self, product: &Product) -> Result<(), Error> {
        for (m, _) in self.left[product.left].sorted() {
            for (n, _) in self.right[product.right].sorted() {
                match product.weight {
                    Weight::Constant(_) => drop(m.checked_mul(n)?),
                    Weight::Rule(rule) if rule.weigh(m, n) != 0 => drop(m.bracket_mul(n, rule.raised, rule.lowered)?),
                    Weight::Rule(_) => {}
                }
            }
        }
        Ok(())
    }

    /// Both sides in machine words, or `None` if the sums might not fit in 128 bits.
    fn in_words(&self) -> Option<[Factors; 2]> {
        C::MACHINE_WORDS?;
        let side = |polynomials: &[&Polynomial<C>]| {
            let words = polynomials.iter().map(|p| p.terms.words()).collect::<Option<Vec<_>>>()?;
            Factors::new(&words.iter().map(AsRef::as_ref).collect::<Vec<_>>())
        };
        let sides = [side(&self.left)?, side(&self.right)?];
        sides[0].denominator.checked_mul(sides[1].denominator)?;
        let norms = sides.each_ref().map(|side| side.lists.iter().map(FactorList::norms).collect::<Vec<_>>());
        let bound = |product: &Product| {
            let ([sum1, most1], [sum2, most2]) = (norms[0][product.left], norms[1][product.right]);
            let weight = match product.weight {
                Weight::Constant(weight) => weight.unsigned_abs() as f64,
                Weight::Rule(rule) => {
                    let most = |p: &Polynomial<C>, slot| f64::from(largest(p.terms.monomials())[slot]);
                    let (left, right) = (self.left[product.left], self.right[product.right]);
                    most(left, rule.first) * most(right, rule.second)
                        + most(left, rule.second) * most(right, rule.first)
                }
            };
            weight * (sum1 * most2).min(sum2 * most1)
        };
        (self.products.iter().map(bound).sum::<f64>() < LARGEST_SUM).then_some(sides)
    }

    fn sum_of_words(
        &self,
        [left, right]: &[Factors; 2],
        bounds: &[u32; SLOTS],
        pause: &mut Pause<'_>,
    ) -> Result<Polynomial<C>, Error> {
        let real = |factors: &Factors| -> Option<Vec<Vec<i64>>> {
            let list =
                |list: &FactorList| if let FactorList::Real(values) = list { Some(values.clone()) } else { None };
            factors.lists.iter().map(list).collect()
        };
        let complex = |factors: &Factors| -> Vec<Vec<[i64; 2]>> {
            let list = |list: &FactorList| match list {
                FactorList::Real(values) => values.iter().map(|&value| [value, 0]).collect(),
                FactorList::Complex(values) => values.clone(),
            };
            factors.lists.iter().map(list).collect()
        };
        let (monomials, numerators) = match (real(left), real(right)) {
            (Some(left), Some(right)) => {
                let (monomials, values) = self.sum(&Integers, (left, right), bounds, pause)?;
                (monomials, Numerators::Real(values))
            }
            _ => {
                let factors = (complex(left), complex(right));
                let (monomials, values) = self.sum(&GaussianIntegers, factors, bounds, pause)?;
                (monomials, Numerators::Complex(values))
            }
        };
        let words = Words { numerators, denominator: left.denominator * right.denominator };
        Ok(Polynomial { terms: Terms::ordered_words(monomials, words.reduced()) })
    }

    fn sum_of_lifted(&self, bounds: &[u32; SLOTS], pause: &mut Pause<'_>) -> Result<Polynomial<C>, Error> {
        let (left, first) = lift_together(&self.left);
        let (right, second) = lift_together(&self.right);
        let arithmetic = Lifted::<C> { scales: (&first, &second) };
        let (monomials, values) = self.sum(&arithmetic, (left, right), bounds, pause)?;
        Ok(Polynomial { terms: Terms::ordered(monomials, values) })
    }

    /// The terms of the sum in canonical order.
    fn sum<A: Arithmetic>(
        &self,
        arithmetic: &A,
        factors: OperandFactors<A>,
        bounds: &[u32; SLOTS],
        pause: &mut Pause<'_>,
    ) -> Result<(Vec<Monomial>, Vec<A::Value>), Error>
    where
        A::Factor: Clone,
    {
        let layout = self.layout(bounds, A::LIGHT);
        if layout.bits(bounds.iter().sum()) <= <i64 as Key>::BITS {
            self.sum_coded::<i64, A>(arithmetic, factors, &layout, pause)
        } else {
            self.sum_coded::<i128, A>(arithmetic, factors, &layout, pause)
        }
    }

    /// The layout of the codes. Radices are as small as possible if an array will hold the sums. Otherwise they are powers of two if their codes fit in a word.
    fn layout(&self, bounds: &[u32; SLOTS], light: bool) -> Layout {
        let layout = Layout::new(bounds, self.truncation, false);
        let pairs = |product: &Product| self.left[product.left].len() * self.right[product.right].len();
        let pairs: usize = self.products.iter().map(pairs).sum();
        let degree = |polynomials: &[&Polynomial<C>], least: bool| {
            let degrees = polynomials.iter().flat_map(|p| p.terms.monomials()).map(|m| m.total_degree());
            (if least { degrees.min() } else { degrees.max() }).unwrap_or(0)
        };
        let [low, high] = [true, false].map(|least| degree(&self.left, least) + degree(&self.right, least));
        if light && layout.codes(low, high) <= CELLS_PER_PRODUCT * pairs as i128 {
            return layout;
        }
        let wide = Layout::new(bounds, self.truncation, true);
        if wide.bits(bounds.iter().sum()) <= <i64 as Key>::BITS { wide } else { layout }
    }

    fn sum_coded<K: Key, A: Arithmetic>(
        &self,
        arithmetic: &A,
        factors: OperandFactors<A>,
        layout: &Layout,
        pause: &mut Pause<'_>,
    ) -> Result<(Vec<Monomial>, Vec<A::Value>), Error>
    where
        A::Factor: Clone,
    {
        let sides = Sides::<K, A::Factor>::new((&self.left, &self.right), factors, layout);
        let parts: Vec<Part<'_, K, A::Factor>> =
            self.products.iter().map(|product| sides.part(product, layout)).collect();
        let last_kept = self.truncation.map(|truncation| layout.last_of_degree(truncation.degree()));
        let terms = Sum { arithmetic, parts: &parts, layout, last_kept }.form(pause)?;
        Ok(in_order(terms, layout.canonical))
    }
}

/// The terms in canonical order.
fn in_order<V>(Piece { keys, values }: Piece<V>, ordered: bool) -> (Vec<Monomial>, Vec<V>) {
    // This conversion reuses the memory.
    let monomials: Vec<_> = keys.into_iter().map(Monomial::from_key).collect();
    if ordered {
        return (monomials, values);
    }
    let mut terms: Vec<_> = monomials.into_iter().zip(values).collect();
    terms.sort_by_cached_key(|(monomial, _)| monomial.rank());
    terms.into_iter().unzip()
}

/// The largest exponent in each slot.
fn largest(monomials: &[Monomial]) -> [u32; SLOTS] {
    let mut most = [0; SLOTS];
    for monomial in monomials {
        for (most, exponent) in most.iter_mut().zip(monomial.exponents()) {
            *most = exponent.max(*most);
        }
    }
    most
}

fn lift_together<C: Coefficient>(polynomials: &[&Polynomial<C>]) -> (Vec<Vec<C::Raw>>, C::Scale) {
    let values: Vec<&C> = polynomials.iter().flat_map(|p| p.terms.values()).collect();
    let (raws, scale) = C::lift(&values);
    let mut raws = raws.into_iter();
    (polynomials.iter().map(|p| raws.by_ref().take(p.len()).collect()).collect(), scale)
}
