//! Functions of the old variables expressed in the new ones and the reverse, as polynomials.

use super::BirkhoffNormalForm;
use super::mode::{Mode, complex_in_real, real_in_complex, substitute};
use crate::real_field::RealField;
use crate::triangle::{LieTransform, Progress, quiet};
use crate::{Error, Polynomial};

/// A real function, expressed in the complex variables.
pub(super) fn to_complex<R: RealField>(f: &Polynomial<R>, modes: &[Mode<R>]) -> Result<Polynomial<R::Complex>, Error> {
    substitute(&f.map(|c| R::complex(c.clone(), R::zero())), &real_in_complex(modes)?)
}

/// A function of the complex variables that is real on real points, expressed in the real variables.
pub(super) fn to_real<R: RealField>(f: &Polynomial<R::Complex>, modes: &[Mode<R>]) -> Result<Polynomial<R>, Error> {
    Ok(substitute(f, &complex_in_real(modes)?)?.map(|c| R::parts(c).0))
}

/// A function with linear forms substituted for its variables, if forms are given.
pub(super) fn changed<R: RealField>(
    f: &Polynomial<R>,
    forms: Option<&[Polynomial<R>]>,
) -> Result<Polynomial<R>, Error> {
    forms.map_or_else(|| Ok(f.clone()), |forms| substitute(f, forms))
}

impl<R: RealField> BirkhoffNormalForm<R> {
    /// Expresses a function f of the old variables in the new ones, complete to degree d + N, where d is the lowest positive degree of f.
    ///
    /// ```
    /// use andoyer_series::{PhaseSpace, normalize};
    /// use num_rational::BigRational;
    /// let space = PhaseSpace::new(&[("q", "p")])?;
    /// let hamiltonian = space.parse::<BigRational>("(p^2 + q^2)/2 + q^3")?;
    /// let normal_form = normalize(&hamiltonian, 1, &space)?;
    /// assert_eq!(normal_form.direct(&space.parse("q")?)?, space.parse("q - q^2 - 2*p^2")?);
    /// assert_eq!(normal_form.inverse(&space.parse("q")?)?, space.parse("q + q^2 + 2*p^2")?);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - degrees that outgrow the packed exponents: [`Error::ExponentOverflow`].
    pub fn direct(&self, f: &Polynomial<R>) -> Result<Polynomial<R>, Error> {
        self.direct_with(f, &mut quiet)
    }

    /// The same as [`direct`](Self::direct), with a callback as in [`normalize_with`](crate::normalize_with). Its counts start again for every homogeneous part
    /// of f.
    ///
    /// # Errors
    /// - The errors of [`direct`](Self::direct); a callback that returns `Break`: [`Error::Interrupted`].
    pub fn direct_with(&self, f: &Polynomial<R>, progress: &mut Progress<'_>) -> Result<Polynomial<R>, Error> {
        let old = self.diagonal.forms()?;
        self.transported(&changed(f, old.as_deref())?, |transform, part| transform.direct_with(part, progress))
    }

    /// Expresses a function f of the new variables in the old ones, complete to degree d + N, where d is the lowest positive degree of f.
    ///
    /// # Errors
    /// - The errors of [`direct`](Self::direct).
    pub fn inverse(&self, f: &Polynomial<R>) -> Result<Polynomial<R>, Error> {
        self.inverse_with(f, &mut quiet)
    }

    /// The same as [`inverse`](Self::inverse), with a callback as in [`normalize_with`](crate::normalize_with). Its counts start again for every homogeneous
    /// part of f.
    ///
    /// # Errors
    /// - The errors of [`direct_with`](Self::direct_with).
    pub fn inverse_with(&self, f: &Polynomial<R>, progress: &mut Progress<'_>) -> Result<Polynomial<R>, Error> {
        let old = self.transported(f, |transform, part| transform.inverse_with(part, progress))?;
        changed(&old, self.diagonal.inverse_forms()?.as_deref())
    }

    /// The sum of the series of the homogeneous parts of f. Each series is truncated at the degree to which all of them are known.
    pub(super) fn transported(
        &self,
        f: &Polynomial<R>,
        mut apply: impl FnMut(
            &LieTransform<R::Complex>,
            &Polynomial<R::Complex>,
        ) -> Result<Vec<Polynomial<R::Complex>>, Error>,
    ) -> Result<Polynomial<R>, Error> {
        let phase = self.space.phase_slots();
        let mut sum = f.filter(|monomial, _| monomial.degree_in(&phase) == 0);
        let f = f.filter(|monomial, _| monomial.degree_in(&phase) > 0);
        let degrees = || f.terms().map(|(monomial, _)| self.space.degree(monomial));
        let Some(lowest) = degrees().min() else { return Ok(sum) };
        // Degrees are below 8 · 2¹⁵, orders below 2¹⁵.
        let highest = lowest + self.order() as u32;
        for degree in lowest..=degrees().max().unwrap_or(lowest).min(highest) {
            let part = f.filter(|monomial, _| self.space.degree(monomial) == degree);
            let transform = self.transform().truncated((highest - degree) as usize);
            let mut image = Polynomial::zero();
            for term in apply(&transform, &to_complex(&part, self.modes())?)? {
                image += &term;
            }
            sum += &to_real(&image, self.modes())?;
        }
        Ok(sum)
    }
}
