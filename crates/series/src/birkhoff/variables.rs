//! Real and complex variables of the modes, and linear changes of them.

use super::mode::{Mode, complex_in_real, real_in_complex, substitute};
use super::phase_space::PhaseSpace;
use super::phases::{cosines, exponentials};
use crate::error::Error;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;

/// A real function, expressed in the complex variables and in exponentials of the driven phases.
pub(super) fn to_complex<R: RealField>(
    f: &Polynomial<R>,
    modes: &[Mode<R>],
    space: &PhaseSpace,
) -> Result<Polynomial<R::Complex>, Error> {
    let f = substitute(&f.map(|c| R::complex(c.clone(), R::zero())), &real_in_complex(modes)?)?;
    exponentials::<R>(f, space)
}

/// A function of the complex variables that is real on real points, expressed in the real variables and in cosines and sines of the driven phases.
pub(crate) fn to_real<R: RealField>(
    f: &Polynomial<R::Complex>,
    modes: &[Mode<R>],
    space: &PhaseSpace,
) -> Result<Polynomial<R>, Error> {
    let f = cosines::<R>(substitute(f, &complex_in_real(modes)?)?, space)?;
    Ok(f.map(|c| R::parts(c).0))
}

/// A function with linear forms substituted for its variables, if forms are given.
pub(super) fn changed<R: RealField>(
    f: &Polynomial<R>,
    forms: Option<&[Polynomial<R>]>,
) -> Result<Polynomial<R>, Error> {
    forms.map_or_else(|| Ok(f.clone()), |forms| substitute(f, forms))
}
