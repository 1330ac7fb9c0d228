//! Driven Hamiltonians: what a form needs of one, and one given as a polynomial with coefficients that are sampled or written as cosines and sines.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use num_complex::Complex;

use super::rows::grid::Grid;
use super::rows::row::Periodic;
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

    /// The work of H to degree 2 at one time of a grid, in multiplications of two floats. The search for a periodic motion counts with it. The default is that of some terms.
    fn work(&self) -> f64 {
        4000.0
    }

    /// The largest difference between a coefficient and its interpolation, at phases between the times of a grid, relative to this coefficient. A harmonic beyond the grid passes for
    /// a lower one at its times. The default is 0: no test, for coefficients with all harmonics up to the highest, as for an ellipse, whose last harmonics show the error.
    ///
    /// # Errors
    /// - Those of the coefficients; a coefficient that does not have the period 2π of a phase: [`Error::NotPeriodic`].
    fn between_times(&self, _grid: &Grid) -> Result<f64, Error> {
        Ok(0.0)
    }

    /// The harmonics of each phase that a first grid must hold; those that are not given are few.
    fn harmonics(&self) -> &[usize] {
        &[]
    }

    /// A state q₁, p₁, … near the periodic motion at the phase 0, where one is known: with one driven phase the search begins at its solution over a period.
    fn start(&self) -> Option<&[f64]> {
        None
    }
}

/// Phases at which coefficients are compared between the times of a grid.
const BETWEEN: u32 = 8;
/// The roots of these primes are the steps of the phases \[turns\]: no sum of them with integer weights is an integer.
const PRIMES: [f64; 8] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0];
/// A coefficient below this part of the largest one is rounding.
const ROUNDING: f64 = 1e-15;
/// The phase \[rad\] that is compared with itself after a turn, where no sine is 0, and the largest difference in units of the largest coefficient.
const CLOSED_AT: f64 = 1.0;
const CLOSED: f64 = 1e-9;

/// A polynomial Hamiltonian whose coefficients are functions of the driven phases.
#[derive(Clone)]
pub struct SampledHamiltonian<F> {
    pairs: usize,
    samples: F,
    harmonics: Vec<usize>,
    start: Option<Vec<f64>>,
}

impl<F> std::fmt::Debug for SampledHamiltonian<F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut fields = f.debug_struct("SampledHamiltonian");
        fields.field("pairs", &self.pairs).field("harmonics", &self.harmonics).field("start", &self.start);
        fields.finish_non_exhaustive()
    }
}

impl<F: Fn(&[f64]) -> Result<Vec<(Monomial, f64)>, Error> + Sync> SampledHamiltonian<F> {
    /// The Hamiltonian of `pairs` pairs whose terms at phases \[rad\] are `samples`.
    pub fn new(pairs: usize, samples: F) -> Self {
        Self { pairs, samples, harmonics: Vec::new(), start: None }
    }

    /// The Hamiltonian with the highest harmonic of each phase, where it is known.
    #[must_use]
    pub fn with_harmonics(self, harmonics: Vec<usize>) -> Self {
        Self { harmonics, ..self }
    }

    /// The Hamiltonian with a state near the periodic motion at the phase 0, where one is known.
    #[must_use]
    pub fn with_start(self, start: Option<Vec<f64>>) -> Self {
        Self { start, ..self }
    }

    /// Refuses a coefficient that does not have the period 2π of each phase.
    fn check_period(&self, phases: usize) -> Result<(), Error> {
        let at = |phases: &[f64]| Ok::<_, Error>(Polynomial::from_terms((self.samples)(phases)?));
        let start = at(&vec![CLOSED_AT; phases])?;
        for phase in 0..phases {
            let mut turned = vec![CLOSED_AT; phases];
            turned[phase] += TAU;
            let end = at(&turned)?;
            let largest = start.terms().chain(end.terms()).map(|(_, c)| c.abs()).fold(0.0, f64::max);
            let mut change = end;
            change -= &start;
            if let Some((_, c)) = change.terms().find(|(_, c)| c.abs() > CLOSED * largest) {
                return Err(Error::NotPeriodic { phase, change: c.abs(), largest });
            }
        }
        Ok(())
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

    fn harmonics(&self) -> &[usize] {
        &self.harmonics
    }

    fn start(&self) -> Option<&[f64]> {
        self.start.as_deref()
    }

    fn between_times(&self, grid: &Grid) -> Result<f64, Error> {
        self.check_period(grid.phases())?;
        let known = self.on(grid)?;
        let rounding = ROUNDING * known.terms().map(|(_, c)| c.size()).fold(0.0, f64::max);
        let mut most = 0.0_f64;
        for number in 1..=BETWEEN {
            let turns = PRIMES.iter().take(grid.phases()).map(|prime| prime.sqrt() * f64::from(number));
            let phases: Vec<f64> = turns.map(|turns| TAU * turns.fract()).collect();
            let weights = grid.weights(&phases);
            let seen = Polynomial::from_terms((self.samples)(&phases)?).map(|&c: &f64| Complex::from(c));
            let mut left = known.map(|c| c.weighted(&weights));
            left -= &seen;
            for (monomial, c) in left.terms() {
                if !c.is_finite() {
                    return Ok(f64::INFINITY);
                }
                let size = known.coefficient(&monomial).map_or(0.0, Periodic::size);
                let size = size.max(seen.coefficient(&monomial).map_or(0.0, |c| c.norm()));
                most = most.max(if size > rounding { c.norm() / size } else { 0.0 });
            }
        }
        Ok(most)
    }
}
