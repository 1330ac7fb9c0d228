//! Functions of the old variables in the new ones and the reverse, and the motion of a state, at given phases.

use num_complex::Complex;

use super::form::DrivenForm;
use super::rows::row::Periodic;
use super::state::powers;
use crate::birkhoff::Mode;
use crate::birkhoff::map::check;
use crate::birkhoff::mode::{complex_in_real, real_in_complex};
use crate::error::Error;
use crate::polynomial::{Polynomial, Truncation};
use crate::triangle::{LieTransform, Progress};

type Complexes = Polynomial<Complex<f64>>;

/// Harmonics below this part of the largest normal variable are rounding.
const NEGLIGIBLE: f64 = 1e-18;

impl DrivenForm {
    /// A function f of the old variables q₁, p₁, … at phases \[rad\], in the real normal variables, to the degree of the order more than the lowest of f − f(x̄).
    ///
    /// # Errors
    /// - another number of phases: [`Error::CountMismatch`]; a callback that returns `Break`: [`Error::Interrupted`].
    pub fn direct(
        &self,
        f: &Polynomial<f64>,
        phases: &[f64],
        progress: &mut Progress<'_>,
    ) -> Result<Polynomial<f64>, Error> {
        check("phases", phases, self.grid().phases())?;
        let weights = self.grid().weights(phases);
        let sum = self.direct_rows(f, progress)?.map(|c| c.weighted(&weights));
        real(&sum, &complex_in_real(self.modes())?)
    }

    /// A function f of the old variables in u₁, U₁, … at all times of the grid.
    pub(super) fn direct_rows(
        &self,
        f: &Polynomial<f64>,
        progress: &mut Progress<'_>,
    ) -> Result<Polynomial<Periodic>, Error> {
        let variables = self.motion.variables()?;
        let replacements: Vec<_> = variables.iter().enumerate().collect();
        let highest = self.order() as u32 + 1;
        let f = f.map(|&c| Periodic::real(c)).compose(&replacements, Some(&Truncation::total(highest)))?;
        self.transported(&f, |transform, part| transform.inverse_with(part, progress))
    }

    /// A function f of the real normal variables at phases \[rad\], in the old variables q₁, p₁, …
    ///
    /// # Errors
    /// - The errors of [`direct`](Self::direct).
    pub fn inverse(
        &self,
        f: &Polynomial<f64>,
        phases: &[f64],
        progress: &mut Progress<'_>,
    ) -> Result<Polynomial<f64>, Error> {
        check("phases", phases, self.grid().phases())?;
        let weights = self.grid().weights(phases);
        let at = |f: &Polynomial<Periodic>| f.map(|c| c.weighted(&weights));
        let sum = at(&self.inverse_rows(f, progress)?);
        real(&sum, &self.motion.deviations()?.iter().map(at).collect::<Vec<_>>())
    }

    /// A function f of the real normal variables, in the complex variables w = P⁻¹ (x − x̄) of the old ones at all times of the grid.
    pub(super) fn inverse_rows(
        &self,
        f: &Polynomial<f64>,
        progress: &mut Progress<'_>,
    ) -> Result<Polynomial<Periodic>, Error> {
        let forms = real_in_complex(self.modes())?;
        let replacements: Vec<_> = forms.iter().enumerate().collect();
        let f = f.map(|&c| Complex::from(c)).compose(&replacements, None)?.map(|&c| Periodic::Constant(c));
        self.transported(&f, |transform, part| transform.direct_with(part, progress))
    }

    /// The sum of the series of the homogeneous parts of f, all to the degree of the order plus 1.
    fn transported(
        &self,
        f: &Polynomial<Periodic>,
        mut series: impl FnMut(&LieTransform<Periodic>, &Polynomial<Periodic>) -> Result<Vec<Polynomial<Periodic>>, Error>,
    ) -> Result<Polynomial<Periodic>, Error> {
        let highest = self.order() as u32 + 1;
        let mut sum = f.homogeneous_part(0);
        for degree in 1..=f.degree().unwrap_or(0).min(highest) {
            let transform = self.transform.truncated((highest - degree) as usize);
            for term in series(&transform, &f.homogeneous_part(degree))? {
                sum += &term;
            }
        }
        Ok(sum)
    }

    /// The states q₁, p₁, … at times after that of a state at phases \[rad\], by the motion of the normal form, in which the actions are constant.
    ///
    /// # Errors
    /// - a state of another length: [`Error::CountMismatch`]; a NaN: [`Error::NotFinite`].
    pub fn trajectory(&self, state: &[f64], phases: &[f64], times: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        check("phases", phases, self.grid().phases())?;
        check("times", times, times.len())?;
        let normal = self.at(phases).to_normal(state)?;
        let actions = self.actions_of(&normal);
        let (rates, driven) = (self.frequencies(&actions)?, self.grid().rates());
        let later = |time: f64| phases.iter().zip(&driven).map(|(phase, rate)| phase + rate * time).collect::<Vec<_>>();
        if !self.modes().iter().all(Mode::is_elliptic) {
            let at = |&time: &f64| self.at(&later(time)).from_normal(&self.advanced(&normal, &rates, time));
            return times.iter().map(at).collect();
        }
        let least = NEGLIGIBLE * actions.iter().fold(0.0_f64, |most, action| most.max((2.0 * action).sqrt()));
        let harmonics = self.fourier(&actions, least)?;
        let angles = self.angles_of(&normal);
        let most =
            |slot: usize| harmonics.iter().map(|one| one.multiples[slot].unsigned_abs()).max().unwrap_or(0) as usize;
        let highest: Vec<usize> = (0..angles.len() + phases.len()).map(most).collect();
        let at = |&time: &f64| {
            let mut sums = vec![0.0; state.len()];
            let moved: Vec<f64> = angles.iter().zip(&rates).map(|(angle, rate)| angle + rate * time).collect();
            let all = [moved, later(time)].concat();
            let powers: Vec<Vec<Complex<f64>>> =
                all.iter().zip(&highest).map(|(&angle, &most)| powers(Complex::cis(angle), most)).collect();
            for harmonic in &harmonics {
                let mut turn = Complex::new(1.0, 0.0);
                for (&k, powers) in harmonic.multiples.iter().zip(&powers).filter(|(k, _)| **k != 0) {
                    let power = powers[k.unsigned_abs() as usize];
                    turn *= if k < 0 { power.conj() } else { power };
                }
                sums.iter_mut().zip(&harmonic.amplitudes).for_each(|(sum, c)| *sum += (c * turn).re);
            }
            sums
        };
        Ok(times.iter().map(at).collect())
    }
}

/// The real part of a function after a linear change.
fn real(f: &Complexes, forms: &[Complexes]) -> Result<Polynomial<f64>, Error> {
    let replacements: Vec<_> = forms.iter().enumerate().collect();
    Ok(f.compose(&replacements, None)?.map(|c| c.re).filter(|_, c| *c != 0.0))
}
