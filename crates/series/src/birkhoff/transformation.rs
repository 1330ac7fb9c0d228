//! Functions of the old variables expressed in the new ones and the reverse, as polynomials.

use super::BirkhoffNormalForm;
use super::variables::{changed, to_complex, to_real};
use crate::error::Error;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;
use crate::triangle::{Progress, quiet};

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
        self.transported(&changed(f, old.as_deref())?, true, progress)
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
        let old = self.transported(f, false, progress)?;
        changed(&old, self.diagonal.inverse_forms()?.as_deref())
    }

    /// The sum of the series of the homogeneous parts of f. Each series is truncated at the degree to which all of them are known. With driven phases the old
    /// variables are measured from the forced motion.
    pub(super) fn transported(
        &self,
        f: &Polynomial<R>,
        direct: bool,
        progress: &mut Progress<'_>,
    ) -> Result<Polynomial<R>, Error> {
        let (space, phases) = (&self.space, &self.phases);
        let phase = space.phase_slots();
        let mut sum = f.filter(|monomial, _| monomial.degree_in(&phase) == 0);
        let f = f.filter(|monomial, _| monomial.degree_in(&phase) > 0);
        let degrees = || f.terms().map(|(monomial, _)| space.degree(monomial));
        let Some(lowest) = degrees().min() else { return Ok(sum) };
        // Degrees are below 8 · 2¹⁵, orders below 2¹⁵.
        let highest = lowest + self.order() as u32;
        for degree in lowest..=degrees().max().unwrap_or(lowest).min(highest) {
            let part = f.filter(|monomial, _| space.degree(monomial) == degree);
            let transform = self.transform().truncated((highest - degree) as usize);
            let mut part = to_complex(&part, self.modes(), space)?;
            if direct {
                part = phases.shifted(&part, space, 1)?;
            }
            let first = phases.order_of(&part, space, transform.order())?;
            let part = phases.lifted(&part, space, first)?;
            let terms =
                if direct { transform.direct_with(&part, progress) } else { transform.inverse_with(&part, progress) };
            let mut image = Polynomial::zero();
            for (order, term) in (first as usize..).zip(terms?) {
                image += &phases.lowered(&term, space, order);
            }
            if !direct {
                image = phases.shifted(&image, space, -1)?;
            }
            sum += &to_real(&image, self.modes(), space)?;
        }
        Ok(sum)
    }
}
