//! Driven Hamiltonians: what a form needs of one, and one given as a polynomial with coefficients that are sampled or written as cosines and sines.

use num_complex::Complex;

use super::grid::Grid;
use super::row::Periodic;
use crate::birkhoff::PhaseSpace;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::{Polynomial, Truncation};

/// A Hamiltonian whose coefficients are periodic functions of driven phases.
pub trait DrivenHamiltonian: Sync {
    /// Number of pairs (q, p).
    fn pairs(&self) -> usize;

    /// H as a polynomial in z, without terms of a degree above `degree`, at the variables q₁, p₁, q₂, … that are `variables`: periodic functions plus linear forms in z.
    ///
    /// # Errors
    /// - Of the algebra, and of a function that is not finite at these variables.
    fn expanded(
        &self,
        grid: &Grid,
        variables: &[Polynomial<Periodic>],
        degree: u32,
    ) -> Result<Polynomial<Periodic>, Error>;
}

/// A polynomial Hamiltonian whose coefficients are functions of the driven phases.
pub struct SampledHamiltonian<F> {
    pairs: usize,
    samples: F,
}

impl<F: Fn(&[f64]) -> Result<Vec<(Monomial, f64)>, Error> + Sync> SampledHamiltonian<F> {
    /// The Hamiltonian of `pairs` pairs whose terms at phases \[rad\] are `samples`.
    pub fn new(pairs: usize, samples: F) -> Self {
        Self { pairs, samples }
    }
}

/// The terms of a polynomial of `space`, with cosines and sines of the driven phases, at phases \[rad\].
///
/// # Errors
/// - None, if the polynomial belongs to the space.
pub fn terms_at(
    hamiltonian: &Polynomial<f64>,
    space: &PhaseSpace,
    phases: &[f64],
) -> Result<Vec<(Monomial, f64)>, Error> {
    let slots = space.driven_slots();
    let term = |(monomial, c): (Monomial, &f64)| {
        let wave = |(j, phase): (i64, &f64)| {
            let angle = j.abs() as f64 * phase;
            if j < 0 { angle.sin() } else { angle.cos() }
        };
        let waves: f64 = space.harmonics(monomial).into_iter().zip(phases).map(wave).product();
        (monomial.without(slots.clone()), c * waves)
    };
    let sum = Polynomial::from_terms(hamiltonian.terms().map(term));
    Ok(sum.terms().map(|(monomial, c)| (monomial, *c)).collect())
}

impl<F: Fn(&[f64]) -> Result<Vec<(Monomial, f64)>, Error> + Sync> DrivenHamiltonian for SampledHamiltonian<F> {
    fn pairs(&self) -> usize {
        self.pairs
    }

    fn expanded(
        &self,
        grid: &Grid,
        variables: &[Polynomial<Periodic>],
        degree: u32,
    ) -> Result<Polynomial<Periodic>, Error> {
        let mut rows: std::collections::BTreeMap<Monomial, Vec<Complex<f64>>> = std::collections::BTreeMap::new();
        for at in 0..grid.times() {
            for (monomial, c) in (self.samples)(&grid.angles(at))? {
                rows.entry(monomial).or_insert_with(|| vec![Complex::default(); grid.times()])[at] += c;
            }
        }
        let terms = rows.iter().map(|(&monomial, row)| (monomial, Periodic::of(row).simplified()));
        let replacements: Vec<_> = variables.iter().enumerate().collect();
        Polynomial::from_terms(terms).compose(&replacements, Some(&Truncation::total(degree)))
    }
}
