//! The normal form about a periodic motion, and its evaluation.
//!
//! H is expanded about x̄(M) in the variables u, U of Floquet's frame; a coefficient is a periodic function. The terms are graded by degree alone, and the brackets are
//! those of every coefficient: the expansion of H and the solution of the homological equation alone know the grid. A term h(M) u^a U^b with the harmonics h_j has
//!
//! ```text
//! S_j = h_j / (i ((b − a)·ω + j·n)),    kept: b = a and j = 0
//! ```
//!
//! The normal form K is a polynomial in the actions, and the direct transformation at fixed actions a Fourier series in the proper angles and the driven phases.

use std::ops::Add;
use std::sync::Arc;

use num_complex::Complex;

use super::divisors::{Divisor, divisors, removal};
use super::hamiltonian::DrivenHamiltonian;
use super::images::Images;
use super::motion::frame::fastest;
use super::motion::search::{DrivenOptions, settled};
use super::motion::solution::PeriodicMotion;
use super::motion::start::eigenvalues;
use super::rows::grid::Grid;
use super::rows::row::Periodic;
use crate::birkhoff::Mode;
use crate::birkhoff::domain::{Domain, size};
use crate::birkhoff::map::{check_actions, finite, needed};
use crate::birkhoff::matrix::symplectic_inverse;
use crate::birkhoff::range::torus;
use crate::bracket::Poisson;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::{Polynomial, Truncation};
use crate::triangle::{LieTransform, Progress, normalize_backwards};

/// The normal form of a driven Hamiltonian about its periodic motion.
#[derive(Clone, Debug)]
pub struct DrivenForm {
    options: DrivenOptions,
    /// That of the search for the periodic motion.
    work: f64,
    pub(super) motion: Arc<PeriodicMotion>,
    /// From the new variables to the old ones.
    pub(super) transform: LieTransform<Periodic>,
    /// K in u and U without the constant.
    hamiltonian: Polynomial<Complex<f64>>,
    /// ∂K/∂I of the modes, in the actions.
    pub(super) frequencies: Vec<Polynomial<f64>>,
    /// The old U of each mode, a function of the new variables; for saddles u as well.
    pub(super) images: Images,
}

impl DrivenForm {
    /// The normal form about the periodic motion that continues the equilibrium 0 of the Hamiltonian without its drive. `rates` are those of the phases
    /// [rad per unit of time]. The number of times of a phase grows until its last harmonics are below the tolerance.
    ///
    /// # Errors
    /// - no periodic motion: [`Error::NoPeriodicMotion`]; no frame: [`Error::MultiplierUnsupported`]; a divisor below the smallest: [`Error::SmallDivisor`];
    /// - more harmonics of a phase than [`DrivenOptions::harmonics`]: [`Error::GridTooFine`]; more than 20,000 times of several phases: [`Error::GridTooLarge`]; more work than [`DrivenOptions::work`]: [`Error::DrivenWorkTooLarge`];
    /// - a phase that is too slow beside the frequencies: [`Error::PhaseTooSlow`]; coefficients of another period: [`Error::NotPeriodic`]; a callback that returns `Break`: [`Error::Interrupted`].
    pub fn new(
        system: &dyn DrivenHamiltonian,
        rates: &[f64],
        options: DrivenOptions,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let (motion, work) = settled(system, rates, options, progress)?;
        Self::about(system, (Arc::new(motion), work), options, progress)
    }

    /// The normal form of another order about the same periodic motion of the same system.
    ///
    /// # Errors
    /// - a divisor below the smallest: [`Error::SmallDivisor`]; a callback that returns `Break`: [`Error::Interrupted`].
    pub fn to_order(
        &self,
        system: &dyn DrivenHamiltonian,
        order: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let known = (Arc::clone(&self.motion), self.work);
        Self::about(system, known, DrivenOptions { order, ..self.options }, progress)
    }

    fn about(
        system: &dyn DrivenHamiltonian,
        (motion, work): (Arc<PeriodicMotion>, f64),
        options: DrivenOptions,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let pairs = system.pairs();
        let poisson = Poisson::new(&(0..pairs).map(|mode| (2 * mode, 2 * mode + 1)).collect::<Vec<_>>())?;
        let degree = options.order as u32 + 2;
        let expanded = system.expanded(&motion.grid, &motion.variables()?, degree)?;
        let mut series = vec![Polynomial::zero(); options.order + 1];
        for (mode, kind) in motion.modes.iter().enumerate() {
            let action = Monomial::ONE.with(2 * mode, 1)?.with(2 * mode + 1, 1)?;
            series[0].add_term(action, &Periodic::Constant(eigenvalues(kind)[0]));
        }
        for (monomial, c) in expanded.terms() {
            if let Some(order @ 1..) = (monomial.total_degree() as usize).checked_sub(2) {
                series[order].add_term(monomial, c);
            }
        }
        let bound = options.smallest_divisor * fastest(&motion.modes);
        let solve = |order: usize, known: &Polynomial<Periodic>| removal(&motion, bound, order, known);
        let normal = normalize_backwards(&series, &poisson, options.order, &solve, progress)?;
        let mut hamiltonian = Polynomial::zero();
        for part in &normal.hamiltonian {
            hamiltonian += &part.map(Periodic::mean);
        }
        let transform = normal.transform;
        let mut images = Vec::new();
        for slot in motion.modes.iter().enumerate().flat_map(|(mode, kind)| needed(mode, kind)) {
            let mut image = Polynomial::zero();
            for part in transform.inverse_with(&Polynomial::variable(slot)?, progress)? {
                image += &part;
            }
            images.push((slot, image));
        }
        let frequencies = frequencies(&hamiltonian, &motion.modes)?;
        Ok(Self { images: Images::new(&images, pairs), options, work, motion, transform, hamiltonian, frequencies })
    }

    /// The order.
    #[must_use]
    pub fn order(&self) -> usize {
        self.transform.order()
    }

    /// The work of the search for the periodic motion, in multiplications of two floats: the same for every order.
    #[must_use]
    pub fn work(&self) -> f64 {
        self.work
    }

    /// The times of the driven phases.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.motion.grid
    }

    /// The modes, with Floquet's exponents as frequencies, on the branch of the rotation number, and the ratio 1.
    #[must_use]
    pub fn modes(&self) -> &[Mode<f64>] {
        &self.motion.modes
    }

    /// The smallest divisors of the generators, the smallest first.
    #[must_use]
    pub fn divisors(&self) -> Vec<Divisor> {
        divisors(&self.motion, &self.transform)
    }

    /// K in the complex variables u₁, U₁, …; for a centre u U = i I.
    #[must_use]
    pub fn in_complex(&self) -> &Polynomial<Complex<f64>> {
        &self.hamiltonian
    }

    /// K in the actions: I = (q² + p²)/2 of a centre and q p of a saddle.
    ///
    /// # Errors
    /// - None: K has no exponent beyond those of its terms.
    pub fn in_actions(&self) -> Result<Polynomial<f64>, Error> {
        in_actions(&self.hamiltonian, &self.motion.modes)
    }

    /// The sizes of the orders, whose terms count by their largest modulus.
    #[must_use]
    pub fn domain(&self) -> Domain {
        let sizes: Vec<f64> = self.modes().iter().flat_map(size).collect();
        let bound = |(monomial, c): (Monomial, &Periodic)| {
            let powers = sizes.iter().enumerate().map(|(slot, size)| size.powi(monomial.exponent(slot) as i32));
            c.size() * powers.product::<f64>()
        };
        let generators = (1..=self.order()).filter_map(|m| self.transform.scaled_generator(m));
        Domain::of_norms(generators.map(|generator| generator.terms().map(bound).fold(0.0, f64::add)).collect())
    }

    /// Its memory, in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        let of = |polynomial: &Polynomial<Periodic>| -> usize {
            polynomial.terms().map(|(_, c)| c.memory() + size_of::<Monomial>()).sum()
        };
        let generators = (1..=self.order()).filter_map(|m| self.transform.scaled_generator(m)).map(of).sum::<usize>();
        generators + self.images.memory()
    }

    /// Whether the periodic motion is opposite to the response to a weak drive, the first step of Newton's iteration from the equilibrium: it does not continue that response.
    #[must_use]
    pub fn is_opposite(&self) -> bool {
        self.motion.is_opposite
    }

    /// The periodic motion q₁, p₁, … at phases \[rad\].
    #[must_use]
    pub fn periodic(&self, phases: &[f64]) -> Vec<f64> {
        let weights = self.grid().weights(phases);
        self.motion.origin.iter().map(|x| x.weighted(&weights).re).collect()
    }

    /// Floquet's frame at phases \[rad\]: P with the rows q₁, p₁, … and the columns u₁, U₁, …, and P⁻¹.
    #[must_use]
    pub fn frame(&self, phases: &[f64]) -> [Vec<Vec<Complex<f64>>>; 2] {
        let weights = self.grid().weights(phases);
        let row = |row: &Vec<Periodic>| row.iter().map(|c| c.weighted(&weights)).collect();
        let change: Vec<Vec<Complex<f64>>> = self.motion.change.iter().map(row).collect();
        let inverse = symplectic_inverse(&change);
        [change, inverse]
    }

    /// The rates ∂K/∂I at actions whose states at phases \[rad\] are within the range of the series.
    ///
    /// # Errors
    /// - Those of [`frequencies`](Self::frequencies); states beyond the range: [`Error::BeyondSeries`].
    pub fn frequency_map(&self, actions: &[f64], phases: &[f64]) -> Result<Vec<f64>, Error> {
        let frequencies = self.frequencies(actions)?;
        let form = self.at(phases);
        torus(self.modes(), actions).iter().try_for_each(|normal| form.check_torus(normal))?;
        Ok(frequencies)
    }

    /// The rates ∂K/∂I at actions: frequencies of centres, growth rates of saddles. Their range is not tested.
    ///
    /// # Errors
    /// - another number of actions: [`Error::CountMismatch`]; −1 for a centre: [`Error::OutsideInterval`]; a result that is not finite: [`Error::NotFinite`].
    pub fn frequencies(&self, actions: &[f64]) -> Result<Vec<f64>, Error> {
        self.frequencies_of_order(self.order(), actions)
    }

    /// The rates by the terms to an order, which are those of the form of this order.
    ///
    /// # Errors
    /// - Those of [`frequencies`](Self::frequencies).
    pub fn frequencies_of_order(&self, order: usize, actions: &[f64]) -> Result<Vec<f64>, Error> {
        check_actions(self.modes(), actions)?;
        let truncation = Truncation::total((order / 2) as u32);
        let rates: Result<Vec<f64>, Error> =
            self.frequencies.iter().map(|frequency| frequency.truncate(&truncation).evaluate(actions)).collect();
        finite("frequencies", rates?)
    }
}

fn in_actions(hamiltonian: &Polynomial<Complex<f64>>, modes: &[Mode<f64>]) -> Result<Polynomial<f64>, Error> {
    let mut sum = Polynomial::zero();
    for (monomial, c) in hamiltonian.terms() {
        let mut target = Monomial::ONE;
        let mut factor = *c;
        for (mode, kind) in modes.iter().enumerate() {
            let power = monomial.exponent(2 * mode);
            target = target.with(mode, power)?;
            if kind.is_elliptic() {
                factor *= Complex::<f64>::i().powu(power);
            }
        }
        sum.add_term(target, &factor.re);
    }
    Ok(sum)
}

fn frequencies(hamiltonian: &Polynomial<Complex<f64>>, modes: &[Mode<f64>]) -> Result<Vec<Polynomial<f64>>, Error> {
    let actions = in_actions(hamiltonian, modes)?;
    (0..modes.len()).map(|mode| actions.derivative(mode)).collect()
}
