//! Functions of the old variables in the new ones and the reverse, and the motion of a state, at given phases.

use num_complex::Complex;
use num_traits::Zero;

use super::exponent::Exponent;
use super::form::DrivenForm;
use super::row::Periodic;
use crate::birkhoff::map::check;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::{Polynomial, Truncation};
use crate::triangle::Progress;

type Complexes = Polynomial<Complex<f64>>;

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
        let variables = self.motion.variables()?;
        let replacements: Vec<_> = variables.iter().enumerate().collect();
        let highest = self.order() as u32 + 1;
        let f = f.map(|&c| Periodic::real(c)).compose(&replacements, Some(&Truncation::total(highest)))?;
        let weights = self.grid().weights(phases);
        let mut sum = f.homogeneous_part(0).map(|c| c.weighted(&weights));
        for degree in 1..=highest {
            let part = f.homogeneous_part(degree);
            let transform = self.transform.truncated((highest - degree) as usize);
            for term in transform.direct_with(&part, progress)? {
                sum += &term.map(|c| c.weighted(&weights));
            }
        }
        let forms = self.complex_in_real()?;
        real(&sum, &forms)
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
        let forms = self.real_in_complex()?;
        let replacements: Vec<_> = forms.iter().enumerate().collect();
        let f = f.map(|&c| Complex::from(c)).compose(&replacements, None)?;
        let weights = self.grid().weights(phases);
        let highest = self.order() as u32 + 1;
        let mut sum = f.homogeneous_part(0);
        for degree in 1..=f.degree().unwrap_or(0).min(highest) {
            let part = f.homogeneous_part(degree).map(|&c| Periodic::Constant(c));
            let transform = self.transform.truncated((highest - degree) as usize);
            for term in transform.inverse_with(&part, progress)? {
                sum += &term.map(|c| c.weighted(&weights));
            }
        }
        // w = P⁻¹ (x − x̄)
        let [_, inverse] = self.frame(phases);
        let origin = self.periodic(phases);
        let mut forms = Vec::new();
        for row in &inverse {
            let shift: Complex<f64> = row.iter().zip(&origin).map(|(c, x)| c * x).sum();
            let mut form = Polynomial::constant(-shift);
            for (slot, c) in row.iter().enumerate() {
                form.add_term(Monomial::ONE.with(slot, 1)?, c);
            }
            forms.push(form);
        }
        real(&sum, &forms)
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
        if self.exponents().iter().any(|exponent| matches!(exponent, Exponent::Saddle(_))) {
            let at = |&time: &f64| self.at(&later(time)).from_normal(&self.advanced(&normal, &rates, time));
            return times.iter().map(at).collect();
        }
        let harmonics = self.fourier(&actions, 0.0)?;
        let angles = self.angles_of(&normal);
        let at = |&time: &f64| {
            let mut sums = vec![0.0; state.len()];
            let moved: Vec<f64> = angles.iter().zip(&rates).map(|(angle, rate)| angle + rate * time).collect();
            let all = [moved, later(time)].concat();
            for harmonic in &harmonics {
                let angle: f64 = harmonic.multiples.iter().zip(&all).map(|(&k, angle)| k as f64 * angle).sum();
                let turn = Complex::cis(angle);
                sums.iter_mut().zip(&harmonic.amplitudes).for_each(|(sum, c)| *sum += (c * turn).re);
            }
            sums
        };
        Ok(times.iter().map(at).collect())
    }

    /// u and U as linear forms in the real normal variables.
    fn complex_in_real(&self) -> Result<Vec<Complexes>, Error> {
        let (half, i) = (Complex::new(0.5, 0.0), Complex::i());
        self.forms(|kind| match kind {
            Exponent::Centre(_) => [[half, half * i], [i, Complex::new(1.0, 0.0)]],
            Exponent::Saddle(_) => {
                [[Complex::new(1.0, 0.0), Complex::zero()], [Complex::zero(), Complex::new(1.0, 0.0)]]
            }
        })
    }

    /// The real normal variables as linear forms in u and U.
    fn real_in_complex(&self) -> Result<Vec<Complexes>, Error> {
        let (one, half, i) = (Complex::new(1.0, 0.0), Complex::new(0.5, 0.0), Complex::i());
        self.forms(|kind| match kind {
            Exponent::Centre(_) => [[one, -half * i], [-i, half]],
            Exponent::Saddle(_) => [[one, Complex::zero()], [Complex::zero(), one]],
        })
    }

    fn forms(&self, rows: impl Fn(Exponent) -> [[Complex<f64>; 2]; 2]) -> Result<Vec<Complexes>, Error> {
        let mut forms = Vec::new();
        for (mode, &kind) in self.exponents().iter().enumerate() {
            for row in rows(kind) {
                let mut form = Polynomial::zero();
                for (side, c) in row.iter().enumerate() {
                    form.add_term(Monomial::ONE.with(2 * mode + side, 1)?, c);
                }
                forms.push(form);
            }
        }
        Ok(forms)
    }
}

/// The real part of a function after a linear change.
fn real(f: &Complexes, forms: &[Complexes]) -> Result<Polynomial<f64>, Error> {
    let replacements: Vec<_> = forms.iter().enumerate().collect();
    Ok(f.compose(&replacements, None)?.map(|c| c.re).filter(|_, c| *c != 0.0))
}
