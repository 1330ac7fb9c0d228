//! A series with numbers: a polynomial in the complex variables and the harmonics of driven phases, evaluated from tables of powers.

use super::PhaseSpace;
use crate::error::Error;
use crate::monomial::{Monomial, SLOTS};
use crate::polynomial::Polynomial;
use num_complex::Complex;

/// A polynomial in the complex variables with numbers for the parameters. Its terms are in canonical order.
#[derive(Debug, Clone)]
pub(super) struct Series {
    pub(super) terms: Vec<(Monomial, Complex<f64>)>,
    /// The slots from this one on hold harmonics.
    pub(super) driven: usize,
}

impl Series {
    pub(super) fn new(
        polynomial: &Polynomial<Complex<f64>>,
        space: &PhaseSpace,
        parameters: &[f64],
    ) -> Result<Self, Error> {
        let mut polynomial = polynomial.clone();
        for (slot, &value) in (2 * space.degrees_of_freedom()..).zip(parameters) {
            polynomial = polynomial.evaluate_partial(slot, &Complex::new(value, 0.0))?;
        }
        let terms: Vec<_> = polynomial.terms().map(|(monomial, &c)| (monomial, c)).collect();
        match terms.iter().find(|(_, c)| !(c.re.is_finite() && c.im.is_finite())) {
            None => Ok(Series { terms, driven: space.driven_slots().start }),
            Some((monomial, c)) => {
                Err(Error::NotFinite { what: "transformation", term: format!("{c} at {:?}", space.turns(*monomial)) })
            }
        }
    }

    /// The terms without variables.
    pub(super) fn constant(&self, space: &PhaseSpace) -> Self {
        let pairs = space.phase_slots();
        let terms = self.terms.iter().filter(|(monomial, _)| monomial.degree_in(&pairs) == 0).copied().collect();
        Series { terms, driven: self.driven }
    }

    /// The value at a point. `powers` holds tables of powers with at least the powers 0 and 1; they grow as needed.
    pub(super) fn evaluate(&self, powers: &mut [Vec<Complex<f64>>]) -> Complex<f64> {
        let mut sum = Complex::default();
        for &(monomial, c) in &self.terms {
            let mut product = c;
            for (slot, table) in powers.iter_mut().enumerate().take(SLOTS) {
                let exponent = monomial.exponent(slot) as usize;
                if exponent == 0 {
                    continue;
                }
                while table.len() <= exponent {
                    let length = table.len();
                    let harmonic = slot >= self.driven;
                    let (last, factor) = if harmonic { (length - 2, 2 - length % 2) } else { (length - 1, 1) };
                    table.push(table[last] * table[factor]);
                }
                product *= table[exponent];
            }
            sum += product;
        }
        sum
    }
}
