//! Verifies that a normal form from a file belongs to the Hamiltonian in the same file. The normal form is computed again, and every coefficient is compared.
//!
//! K and S alone cannot be verified: any K with only kept terms and any S without kept terms are the normal form of some Hamiltonian.

use super::quadratic::literal;
use super::{BirkhoffNormalForm, normalize_driven};
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;
use crate::triangle::Progress;

/// Largest error of a float, relative to the largest coefficient of its order. Another machine may round differently.
const FLOAT_TOLERANCE: f64 = 1e-8;

/// Compares a normal form with the computed one.
///
/// # Errors
/// - the first coefficient that differs: [`Error::CoefficientWrong`]; the errors of [`normalize_driven`].
pub(super) fn verified<R: RealField>(form: &BirkhoffNormalForm<R>, progress: &mut Progress<'_>) -> Result<(), Error> {
    let original = &form.hamiltonian + &form.offset;
    let driven = &form.phases.given;
    let computed = normalize_driven(&original, form.order(), &form.space, driven, &form.resonances, progress)?;
    for (row, (found, expected)) in form.linear_change().iter().zip(computed.linear_change()).enumerate() {
        let line = |row: &[R]| {
            Polynomial::from_terms(
                row.iter()
                    .enumerate()
                    .map(|(column, c)| {
                        (Monomial::new(&[column as u32]).unwrap_or(Monomial::ONE), R::complex(c.clone(), R::zero()))
                    })
                    .filter(|(_, c)| {
                        let (re, im) = R::parts(c);
                        re.sign() != 0 || im.sign() != 0
                    }),
            )
        };
        same::<R>("linear change", row, (&line(found), &line(expected)), 1)?;
    }
    let slots = form.space.names().len();
    let pairs = form.normalization.hamiltonian.iter().zip(&computed.normalization.hamiltonian);
    for (n, pair) in pairs.enumerate() {
        same::<R>("hamiltonian", n, pair, slots)?;
    }
    for m in 1..=form.order() {
        if let (Some(found), Some(expected)) =
            (form.transform().scaled_generator(m), computed.transform().scaled_generator(m))
        {
            same::<R>("generating function", m, (found, expected), slots)?;
        }
    }
    Ok(())
}

fn number<R: RealField>(c: &R) -> String {
    if R::EPSILON == 0.0 { literal(c) } else { format!("{:?}", c.to_float()) }
}

/// Refuses two polynomials that differ, and names the first coefficient that does.
pub(crate) fn same<R: RealField>(
    what: &'static str,
    order: usize,
    (found, expected): (&Polynomial<R::Complex>, &Polynomial<R::Complex>),
    slots: usize,
) -> Result<(), Error> {
    let modulus = |c: &R::Complex| {
        let (re, im) = R::parts(c);
        re.to_float().hypot(im.to_float())
    };
    let largest = expected.terms().map(|(_, c)| modulus(c)).fold(0.0, f64::max);
    let mut difference = found.clone();
    difference -= expected;
    let wrong = |(_, c): &(Monomial, &R::Complex)| R::EPSILON == 0.0 || modulus(c) > FLOAT_TOLERANCE * largest;
    let Some((monomial, _)) = difference.terms().find(wrong) else { return Ok(()) };
    let text = |f: &Polynomial<R::Complex>| {
        let (re, im) = f.coefficient(&monomial).map_or_else(|| (R::zero(), R::zero()), R::parts);
        if im.sign() == 0 { number(&re) } else { format!("{} + {} i", number(&re), number(&im)) }
    };
    let exponents = monomial.exponents()[..slots].to_vec();
    Err(Error::CoefficientWrong { what, order, exponents, found: text(found), expected: text(expected) })
}
