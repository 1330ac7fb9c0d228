//! Driven Hamiltonians: what a form needs of one, and one given as a polynomial with coefficients that are sampled or written as cosines and sines.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

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

    /// The largest difference between a coefficient and its interpolation, at phases between the times of a grid, relative to the largest coefficient or to 1. A harmonic beyond
    /// the grid passes for a lower one at its times. The default is 0, for coefficients that have all harmonics up to their highest, as those of an ellipse: the last ones tell.
    ///
    /// # Errors
    /// - Those of the coefficients.
    fn between_times(&self, _grid: &Grid) -> Result<f64, Error> {
        Ok(0.0)
    }
}

/// Phases at which coefficients are compared between the times of a grid.
const BETWEEN: u32 = 8;
/// (√5 − 1)/2.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

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

    /// The Hamiltonian at the times of a grid.
    fn on(&self, grid: &Grid) -> Result<Polynomial<Periodic>, Error> {
        let mut rows: BTreeMap<Monomial, Vec<Complex<f64>>> = BTreeMap::new();
        for at in 0..grid.times() {
            for (monomial, c) in (self.samples)(&grid.angles(at))? {
                rows.entry(monomial).or_insert_with(|| vec![Complex::default(); grid.times()])[at] += c;
            }
        }
        Ok(Polynomial::from_terms(rows.iter().map(|(&monomial, row)| (monomial, Periodic::of(row).simplified()))))
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
        let replacements: Vec<_> = variables.iter().enumerate().collect();
        self.on(grid)?.compose(&replacements, Some(&Truncation::total(degree)))
    }

    fn between_times(&self, grid: &Grid) -> Result<f64, Error> {
        let known = self.on(grid)?;
        let largest = known.terms().map(|(_, c)| c.size()).fold(1.0, f64::max);
        let mut most = 0.0_f64;
        for number in 1..=BETWEEN {
            // Multiples of the golden ratio and of its powers are near no times of a grid.
            let turns = |phase: usize| GOLDEN.powi(phase as i32 + 1) * f64::from(number);
            let phases: Vec<f64> = (0..grid.phases()).map(|phase| TAU * turns(phase).fract()).collect();
            let weights = grid.weights(&phases);
            let mut left = known.map(|c| c.weighted(&weights));
            left -= &Polynomial::from_terms((self.samples)(&phases)?).map(|&c: &f64| Complex::from(c));
            for (_, c) in left.terms() {
                if !c.is_finite() {
                    return Ok(f64::INFINITY);
                }
                most = most.max(c.norm());
            }
        }
        Ok(most / largest)
    }
}
