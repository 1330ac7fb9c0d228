//! The elliptic point: its frequencies, and the complex variables in which its quadratic part is diagonal.
//!
//! A mode (a p² + b q²)/2 with ab > 0 has the frequency ω = ±√(ab), negative where a and b are, and r = √(a/b) = ω/b. With
//! q = √(2rI) sin φ and p = √(2I/r) cos φ it is ωI, and dφ/dt = ω. Complex variables, canonical:
//!
//! ```text
//! U = r p + i q = √(2rI) e^{iφ},   u = (q + i r p)/(2r) = i Ū/(2r),   {u; U} = 1,   uU = iI
//! q = r u − (i/2) U,               p = U/(2r) − i u
//! ```
//!
//! Those of theory §1 are √(2r) u and U/√(2r): the unequal scales keep square roots out, so that all is rational where ω is.

use super::PhaseSpace;
use crate::{Coefficient, Error, Monomial, Polynomial, RealField};

/// One mode of the quadratic part.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Mode<R> {
    /// ω.
    pub(crate) frequency: R,
    /// r = √(a/b).
    pub(crate) ratio: R,
}

/// Reads the modes of `hamiltonian` and refuses what is no elliptic point with a diagonal quadratic part.
pub(crate) fn modes<R: RealField>(hamiltonian: &Polynomial<R>, space: &PhaseSpace) -> Result<Vec<Mode<R>>, Error> {
    let phase = space.phase_slots();
    for (monomial, c) in hamiltonian.terms() {
        let shown = || (text(monomial, space), literal(c));
        let square = phase.iter().any(|&slot| monomial.exponent(slot) == 2) && monomial.total_degree() == 2;
        let unknown = (space.names().len()..crate::SLOTS).find(|&slot| monomial.exponent(slot) > 0);
        if let Some(slot) = unknown {
            return Err(Error::ValueMissing { slot, given: space.names().len() });
        }
        if !c.is_finite() {
            return Err(Error::NotFinite { what: "Hamiltonian", term: format!("{} {}", shown().1, shown().0) });
        }
        match monomial.degree_in(&phase) {
            1 => return Err(Error::LinearTerm { term: shown().0, coefficient: shown().1 }),
            2 if !square => return Err(Error::QuadraticNotDiagonal { term: shown().0, coefficient: shown().1 }),
            _ => {}
        }
    }
    (0..space.degrees_of_freedom()).map(|mode| self::mode(hamiltonian, space, mode)).collect()
}

fn mode<R: RealField>(hamiltonian: &Polynomial<R>, space: &PhaseSpace, mode: usize) -> Result<Mode<R>, Error> {
    let square = |slot| Ok::<_, Error>(hamiltonian.coefficient(&Monomial::ONE.with(slot, 2)?).cloned());
    let (half_b, half_a) = (square(2 * mode)?.unwrap_or_else(R::zero), square(2 * mode + 1)?.unwrap_or_else(R::zero));
    let name = |slot: usize| space.names()[slot].to_owned();
    let (coordinate, momentum) = (name(2 * mode), name(2 * mode + 1));
    if half_a.sign() * half_b.sign() != 1 {
        let (coordinate_square, momentum_square) = (literal(&half_b), literal(&half_a));
        return Err(Error::NotElliptic { coordinate, momentum, coordinate_square, momentum_square });
    }
    let (a, b) = (half_a.times(2), half_b.times(2));
    let Some(root) = a.geometric_mean(&b) else {
        let mut square = a;
        square *= &b;
        return Err(Error::FrequencyIrrational { coordinate, momentum, square: literal(&square) });
    };
    let frequency = root.times(a.sign().into());
    let ratio = frequency.divide(&b).ok_or(Error::DivisionByZero)?;
    if !frequency.is_finite() || !ratio.is_finite() || ratio.is_zero() {
        return Err(Error::NotFinite { what: "frequency", term: coordinate });
    }
    Ok(Mode { frequency, ratio })
}

/// A monomial in the user's names.
fn text(monomial: Monomial, space: &PhaseSpace) -> String {
    Polynomial::from_terms([(monomial, 1.0)]).display(&space.names()).to_string()
}

/// A coefficient with its sign.
fn literal<R: RealField>(c: &R) -> String {
    let (negative, magnitude) = c.literal();
    format!("{}{magnitude}", if negative { "-" } else { "" })
}

/// A real function in the complex variables.
pub(crate) fn to_complex<R: RealField>(f: &Polynomial<R>, modes: &[Mode<R>]) -> Result<Polynomial<R::Complex>, Error> {
    let half = R::ratio(1, 2).ok_or(Error::DivisionByZero)?;
    let pairs = modes.iter().enumerate().map(|(mode, Mode { ratio, .. })| {
        let inverse = half.divide(ratio).ok_or(Error::DivisionByZero)?;
        let q = [(ratio.clone(), R::zero()), (R::zero(), -half.clone())];
        let p = [(R::zero(), -R::one()), (inverse, R::zero())];
        Ok([linear::<R>(mode, q)?, linear::<R>(mode, p)?])
    });
    let images = pairs.collect::<Result<Vec<_>, Error>>()?;
    substitute(&f.map(|c| R::complex(c.clone(), R::zero())), &images)
}

/// A function in the complex variables that is real on real points, in the real ones.
pub(crate) fn to_real<R: RealField>(f: &Polynomial<R::Complex>, modes: &[Mode<R>]) -> Result<Polynomial<R>, Error> {
    let half = R::ratio(1, 2).ok_or(Error::DivisionByZero)?;
    let pairs = modes.iter().enumerate().map(|(mode, Mode { ratio, .. })| {
        let inverse = half.divide(ratio).ok_or(Error::DivisionByZero)?;
        let u = [(inverse, R::zero()), (R::zero(), half.clone())];
        let momentum = [(R::zero(), R::one()), (ratio.clone(), R::zero())];
        Ok([linear::<R>(mode, u)?, linear::<R>(mode, momentum)?])
    });
    let images = pairs.collect::<Result<Vec<_>, Error>>()?;
    Ok(substitute(f, &images)?.map(|c| R::parts(c).0))
}

/// c₀ · (first variable) + c₁ · (second variable) of a mode, the coefficients as (re, im).
fn linear<R: RealField>(mode: usize, coefficients: [(R, R); 2]) -> Result<Polynomial<R::Complex>, Error> {
    let terms = (2 * mode..).zip(coefficients);
    let terms = terms.map(|(slot, (re, im))| Ok((Monomial::ONE.with(slot, 1)?, R::complex(re, im))));
    Ok(Polynomial::from_terms(terms.collect::<Result<Vec<_>, Error>>()?))
}

fn substitute<C: Coefficient>(f: &Polynomial<C>, images: &[[Polynomial<C>; 2]]) -> Result<Polynomial<C>, Error> {
    let replacements: Vec<_> = images.iter().flatten().enumerate().collect();
    f.compose(&replacements, None)
}
