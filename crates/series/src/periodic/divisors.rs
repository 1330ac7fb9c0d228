//! The homological equation of a driven Hamiltonian, and its divisors.
//!
//! A term h(M) u^a U^b with the harmonics h_j has S_j = h_j/(i (k·ω + j·n)), k = b − a; kept are the terms with k = 0 and j = 0.

use std::collections::BTreeMap;

use num_complex::Complex;
use num_traits::Zero;

use super::motion::frame::fastest;
use super::motion::solution::PeriodicMotion;
use super::rows::row::Periodic;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;
use crate::triangle::{LieTransform, Removal};

/// Harmonics below this part of the largest one of a generator have no divisor that counts.
const NEGLIGIBLE: f64 = 1e-10;
/// A harmonic below this part of the largest coefficient, or of the largest frequency, is rounding: where its divisor is small it is left out.
const ROUNDING: f64 = 1e-14;
/// Divisors that are kept for the user.
const DIVISORS: usize = 20;

/// A small divisor |k·ω + j·n| of a generator.
#[derive(Clone, Debug, PartialEq)]
pub struct Divisor {
    /// k, then j.
    pub multiples: Vec<i64>,
    /// k·ω + j·n [rad per unit of time].
    pub value: f64,
}

/// k = b − a of u^a U^b.
pub(super) fn turns(monomial: Monomial, modes: usize) -> Vec<i64> {
    (0..modes).map(|mode| i64::from(monomial.exponent(2 * mode + 1)) - i64::from(monomial.exponent(2 * mode))).collect()
}

/// The solution of the homological equation. For saddles the divisor is complex: k·ω with ω = iλ.
pub(super) fn removal(
    motion: &PeriodicMotion,
    bound: f64,
    order: usize,
    known: &Polynomial<Periodic>,
) -> Result<Removal<Periodic>, Error> {
    let (mut image, mut solution) = (Vec::new(), Vec::new());
    let grid = &motion.grid;
    let rounding = ROUNDING * known.terms().map(|(_, c)| c.size()).fold(fastest(&motion.modes), f64::max);
    for (monomial, c) in known.terms() {
        if monomial == Monomial::ONE {
            image.push((monomial, c.clone()));
            continue;
        }
        let k = turns(monomial, motion.modes.len());
        let own: Complex<f64> = k.iter().zip(&motion.modes).map(|(&k, one)| one.frequency() * k as f64).sum();
        let still = k.iter().all(|&k| k == 0);
        let mut harmonics = grid.harmonics(c);
        let removed = if still {
            let mean = std::mem::take(&mut harmonics[0]);
            let mut rest = c.clone();
            rest -= &Periodic::Constant(mean);
            rest
        } else {
            c.clone()
        };
        for (at, c) in harmonics.iter_mut().enumerate().filter(|(_, c)| !c.is_zero()) {
            let divisor = own + grid.rate(at);
            if divisor.norm() < bound && c.norm() <= rounding {
                *c = Complex::zero();
                continue;
            }
            if divisor.norm() < bound {
                let names: Vec<String> =
                    (1..=k.len()).flat_map(|mode| ["u", "U"].map(|name| format!("{name}{mode}"))).collect();
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                let term = Polynomial::<f64>::from_terms([(monomial, 1.0)]);
                return Err(Error::SmallDivisor {
                    order,
                    term: format!(
                        "{} with the multiples {:?} of the driven phases",
                        term.display(&names),
                        grid.multiples(at)
                    ),
                    k: first_positive([k, grid.multiples(at)].concat()),
                    divisor: divisor.norm(),
                    bound,
                });
            }
            *c /= Complex::<f64>::i() * divisor;
        }
        image.push((monomial, removed));
        solution.push((monomial, grid.function(&harmonics)));
    }
    Ok(Removal { image: Polynomial::from_terms(image), solution: Polynomial::from_terms(solution) })
}

/// Multiples with the sign that makes the first of them positive.
fn first_positive(mut multiples: Vec<i64>) -> Vec<i64> {
    if multiples.iter().find(|&&k| k != 0).is_some_and(|&k| k < 0) {
        multiples.iter_mut().for_each(|k| *k = -*k);
    }
    multiples
}

/// The smallest divisors of harmonics that count.
pub(super) fn divisors(motion: &PeriodicMotion, transform: &LieTransform<Periodic>) -> Vec<Divisor> {
    let mut found: BTreeMap<Vec<i64>, f64> = BTreeMap::new();
    for generator in (1..=transform.order()).filter_map(|m| transform.scaled_generator(m)) {
        let most = generator.terms().map(|(_, c)| c.size()).fold(0.0, f64::max);
        for (monomial, c) in generator.terms() {
            let k = turns(monomial, motion.modes.len());
            for (at, c) in motion.grid.harmonics(c).into_iter().enumerate() {
                if c.norm() <= NEGLIGIBLE * most {
                    continue;
                }
                let multiples = first_positive([k.clone(), motion.grid.multiples(at)].concat());
                let own: Complex<f64> =
                    multiples.iter().zip(&motion.modes).map(|(&k, one)| one.frequency() * k as f64).sum();
                let driven: f64 =
                    multiples[k.len()..].iter().zip(motion.grid.rates()).map(|(&j, rate)| j as f64 * rate).sum();
                let value = own + driven;
                found.insert(multiples, if value.im == 0.0 { value.re } else { value.norm() });
            }
        }
    }
    let mut all: Vec<_> = found.into_iter().map(|(multiples, value)| Divisor { multiples, value }).collect();
    all.sort_by(|a, b| a.value.abs().total_cmp(&b.value.abs()));
    all.truncate(DIVISORS);
    all
}
