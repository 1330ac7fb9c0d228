//! A driven normal form with the names of its variables and phases: as polynomials in cosines and sines, as text and LaTeX.

use num_complex::Complex;

use super::form::DrivenForm;
use super::hamiltonian::{DrivenHamiltonian, SampledHamiltonian, terms_at};
use super::motion::search::DrivenOptions;
use super::motion::work::MOST_WORK;
use super::rows::row::Periodic;
use crate::birkhoff::actions::action_texts;
use crate::birkhoff::phases::cosines;
use crate::birkhoff::resonances::check_smallest_divisor;
use crate::birkhoff::variables::to_real;
use crate::birkhoff::{PhaseSpace, check_driven};
use crate::display::significant;
use crate::error::Error;
use crate::harmonics;
use crate::latex::Part;
use crate::monomial::MAX_EXPONENT;
use crate::polynomial::Polynomial;
use crate::triangle::{Progress, quiet};

/// The highest order.
pub const MAX_DRIVEN_ORDER: usize = 60;
/// The size of the last harmonics.
const TAIL: f64 = 1e-12;
/// Most harmonics of a phase: of one, and of several.
const HARMONICS: [usize; 2] = [1020, 252];
/// Harmonics below this part of the largest one of their coefficient are rounding errors.
const NEGLIGIBLE: f64 = 1e-14;

/// The normal form of a polynomial Hamiltonian about its periodic motion, with its names.
#[derive(Clone, Debug)]
pub struct DrivenNormalForm {
    pub(super) space: PhaseSpace,
    pub(super) hamiltonian: Polynomial<f64>,
    starts: Vec<f64>,
    pub(super) smallest_divisor: f64,
    /// The state near which the periodic motion was searched, at the phase 0.
    pub(super) start: Option<Vec<f64>>,
    form: DrivenForm,
}

/// Two forms are equal if they are of the same Hamiltonian and order.
impl PartialEq for DrivenNormalForm {
    fn eq(&self, other: &Self) -> bool {
        let key = |form: &Self| {
            (form.form.order(), form.starts.clone(), form.smallest_divisor, form.rates(), form.start.clone())
        };
        key(self) == key(other) && self.space == other.space && self.hamiltonian == other.hamiltonian
    }
}

impl DrivenNormalForm {
    /// The normal form of a Hamiltonian of `space`, whose driven phases have these rates \[rad per unit of time\] and values at time 0 \[rad\].
    ///
    /// ```
    /// use andoyer_series::PhaseSpace;
    /// use andoyer_series::periodic::DrivenNormalForm;
    /// use andoyer_series::progress::quiet;
    /// let space = PhaseSpace::new(&[("x", "p")])?.with_driven(&["M"])?;
    /// let duffing = space.parse::<f64>("(p^2 + x^2)/2 + x^4/4 - 3/10*x*cos(M)")?;
    /// let form = DrivenNormalForm::new(&duffing, 6, &space, &[(0.4, 0.0)], 1e-6, &mut quiet)?;
    /// assert!((form.form().periodic(&[0.0])[0] - 0.354788).abs() < 1e-6);
    /// assert_eq!(DrivenNormalForm::from_json(&form.to_json()?, &mut quiet)?, form);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - those of [`DrivenForm::new`]; a rate that is 0 or not finite: [`Error::DrivenUnsupported`], [`Error::NotFinite`]; order 61: [`Error::OrderTooLarge`];
    /// - a smallest divisor of −1 or NaN: [`Error::OutsideInterval`].
    pub fn new(
        hamiltonian: &Polynomial<f64>,
        order: usize,
        space: &PhaseSpace,
        phases: &[(f64, f64)],
        smallest_divisor: f64,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        Self::from_state((hamiltonian, space), order, phases, smallest_divisor, None, progress)
    }

    /// The normal form about the periodic motion near a state q₁, p₁, … at the phase 0, or without one as of [`new`](Self::new).
    ///
    /// # Errors
    /// - those of [`new`](Self::new); another number of variables, or several phases: [`Error::StartUnsupported`].
    pub fn from_state(
        (hamiltonian, space): (&Polynomial<f64>, &PhaseSpace),
        order: usize,
        phases: &[(f64, f64)],
        smallest_divisor: f64,
        start: Option<&[f64]>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let at = |phases: &[f64]| terms_at(hamiltonian, space, phases);
        let of = |phase: usize| {
            let multiples = hamiltonian.terms().map(|(monomial, _)| space.harmonics(monomial)[phase].unsigned_abs());
            multiples.max().unwrap_or(0) as usize
        };
        let system = SampledHamiltonian::new(space.degrees_of_freedom(), at)
            .with_harmonics((0..space.driven().len()).map(of).collect())
            .with_start(start.map(<[f64]>::to_vec));
        let form = Self::of(&system, order, space, phases, smallest_divisor, progress)?;
        Ok(Self { hamiltonian: hamiltonian.clone(), ..form })
    }

    /// The normal form of a polynomial Hamiltonian that is known at the times of a grid. Its coefficients are kept as sums of cosines and sines.
    ///
    /// # Errors
    /// - those of [`new`](Self::new) and of the Hamiltonian.
    pub fn of(
        system: &dyn DrivenHamiltonian,
        order: usize,
        space: &PhaseSpace,
        phases: &[(f64, f64)],
        smallest_divisor: f64,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        if order > MAX_DRIVEN_ORDER {
            return Err(Error::OrderTooLarge { order, bound: MAX_DRIVEN_ORDER });
        }
        check_smallest_divisor(smallest_divisor)?;
        check_driven(phases, space)?;
        let (rates, starts): (Vec<f64>, Vec<f64>) = phases.iter().copied().unzip();
        let harmonics = HARMONICS[usize::from(rates.len() > 1)];
        let options = DrivenOptions { order, tolerance: TAIL, harmonics, smallest_divisor, work: MOST_WORK };
        let form = DrivenForm::new(system, &rates, options, progress)?;
        let variables: Vec<_> = (0..2 * system.pairs()).map(Polynomial::variable).collect::<Result<_, _>>()?;
        let rows = system.expanded(form.grid(), &variables, MAX_EXPONENT)?;
        let start = system.start().map(<[f64]>::to_vec);
        let hamiltonian = Polynomial::zero();
        let mut named = Self { space: space.clone(), hamiltonian, starts, smallest_divisor, start, form };
        named.hamiltonian = named.in_waves(&rows)?;
        Ok(named)
    }

    /// The form without names.
    #[must_use]
    pub fn form(&self) -> &DrivenForm {
        &self.form
    }

    /// The variables and the driven phases.
    #[must_use]
    pub fn space(&self) -> &PhaseSpace {
        &self.space
    }

    /// The rate of each driven phase and its value at time 0.
    #[must_use]
    pub fn driven(&self) -> Vec<(f64, f64)> {
        self.rates().into_iter().zip(self.starts.iter().copied()).collect()
    }

    fn rates(&self) -> Vec<f64> {
        self.form.grid().rates()
    }

    /// The driven phases at a time \[rad\].
    #[must_use]
    pub fn phases(&self, time: f64) -> Vec<f64> {
        self.driven().iter().map(|(rate, start)| start + rate * time).collect()
    }

    /// The old variable of a slot in the new ones, with cosines and sines of the phases.
    ///
    /// # Errors
    /// - exponents that outgrow a monomial: [`Error::ExponentOverflow`].
    pub fn direct_series(&self, slot: usize) -> Result<Polynomial<f64>, Error> {
        self.real_in_waves(&self.form.direct_rows(&Polynomial::variable(slot)?, &mut quiet)?)
    }

    /// The new variable of a slot in the old ones, with cosines and sines of the phases.
    ///
    /// # Errors
    /// - exponents that outgrow a monomial: [`Error::ExponentOverflow`].
    pub fn inverse_series(&self, slot: usize) -> Result<Polynomial<f64>, Error> {
        let rows = self.form.inverse_rows(&Polynomial::variable(slot)?, &mut quiet)?;
        let deviations = self.form.motion.deviations()?;
        self.in_waves(&rows.compose(&deviations.iter().enumerate().collect::<Vec<_>>(), None)?)
    }

    /// A function in u₁, U₁, … as one of the real variables of the modes.
    pub(super) fn real_in_waves(&self, rows: &Polynomial<Periodic>) -> Result<Polynomial<f64>, Error> {
        Ok(to_real(&self.exponentials(rows)?, self.form.modes(), &self.space)?.filter(|_, c| *c != 0.0))
    }

    /// A real function with coefficients in cosines and sines.
    pub(super) fn in_waves(&self, rows: &Polynomial<Periodic>) -> Result<Polynomial<f64>, Error> {
        let complex = cosines::<f64>(self.exponentials(rows)?, &self.space)?;
        Ok(complex.map(|c| c.re).filter(|_, c| *c != 0.0))
    }

    /// The coefficients as sums of e^{ijM}.
    fn exponentials(&self, rows: &Polynomial<Periodic>) -> Result<Polynomial<Complex<f64>>, Error> {
        let (grid, mut sum) = (self.form.grid(), Polynomial::zero());
        for (monomial, c) in rows.terms() {
            let all = grid.harmonics(c);
            let largest = all.iter().map(|c| c.norm()).fold(0.0, f64::max);
            for (index, c) in all.iter().enumerate().filter(|(_, c)| c.norm() > NEGLIGIBLE * largest) {
                let slots = self.space.driven_slots().zip(grid.multiples(index));
                let monomial = slots.into_iter().try_fold(monomial, |all, (slot, j)| harmonics::with(all, slot, j));
                sum.add_term(monomial?, c);
            }
        }
        Ok(sum)
    }

    /// A part as LaTeX, for a document with `\usepackage{amsmath}`, as of [`BirkhoffNormalForm`](crate::BirkhoffNormalForm::to_latex).
    ///
    /// # Errors
    /// - exponents that outgrow a monomial: [`Error::ExponentOverflow`].
    pub fn to_latex(&self, what: Part) -> Result<String, Error> {
        let generator = |m| self.real_in_waves(&self.form.transform.generator(m).unwrap_or_default());
        let image = |slot, direct| if direct { self.direct_series(slot) } else { self.inverse_series(slot) };
        crate::birkhoff::latex::part::<f64>(
            (what, &self.space, self.form.order()),
            || self.in_actions(),
            generator,
            image,
        )
    }

    /// K in the actions, and their names.
    fn in_actions(&self) -> Result<(Polynomial<Complex<f64>>, Vec<String>), Error> {
        let actions = self.form.in_actions()?.map(|&c| Complex::from(c));
        Ok((actions, action_texts(self.form.modes(), &self.space)))
    }
}

/// Prints K in the actions, as of a form without driven phases.
impl std::fmt::Display for DrivenNormalForm {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (actions, names) = self.in_actions().map_err(|_| std::fmt::Error)?;
        formatter.write_str(&self.space.text(&significant::<f64>(&actions, self.space.driven_slots()), &names))
    }
}
