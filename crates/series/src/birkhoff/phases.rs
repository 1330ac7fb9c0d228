//! The driven phases of a normal form: their frequencies, the exponents that the triangle stores, and the forced motion of first order.
//!
//! A driven phase M = M₀ + n t has no momentum. In the extended phase space H₂ becomes H₂ + nΛ and no generator contains Λ, so a term with e^{i(k·φ + jM)} has the
//! divisor k·ω + j n. The weight of a term is its degree, plus 1 if j ≠ 0; its order is the weight minus 2.
//!
//! Terms of order 0 with j ≠ 0 are linear in the variables: a force. Their motion is that of a driven oscillator, u = Σ c_j z^j with c_j = b_j/(i (j n + ω)) for b_j U
//! z^j in H, and U = Σ d_j z^j with d_j = −a_j/(i (j n − ω)) for a_j u z^j, z = e^{iM}. The variables are measured from it: u → u + Σ c_j z^j is inserted
//! exactly into all other terms. It lowers the degree and adds a factor z^j, so the order of a term is that before the shift, and is no longer given by its
//! monomial. Linear terms of higher order remain, which the triangle removes. Terms without variables do not change the motion, and are dropped.

use super::mode::{modulus, substitute};
use super::phase_space::PhaseSpace;
use super::resonances::{Spectrum, is_small};
use crate::coefficient::Coefficient;
use crate::driven::Driven;
use crate::error::Error;
use crate::harmonics;
use crate::monomial::{MAX_EXPONENT, Monomial};
use crate::polynomial::Polynomial;
use crate::real_field::RealField;

/// The driven phases, and the parts of the Hamiltonian as the triangle takes them.
pub(super) type Prepared<R> = (Phases<R>, Vec<Polynomial<<R as RealField>::Complex>>);

/// The driven phases of a normal form.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Phases<R: RealField> {
    /// The frequency n and the phase M₀ at time 0 of each.
    pub(super) given: Vec<(R, f64)>,
    /// The exponents inside the triangle.
    driven: Driven<R::Complex>,
    stride: u32,
    /// The forced motion of u₁, U₁, …; empty without a force.
    pub(super) shift: Vec<Polynomial<R::Complex>>,
}

impl<R: RealField> Phases<R> {
    /// The phases for a Hamiltonian in complex variables, and its parts as the triangle takes them: measured from the forced motion, without the part of order 0.
    pub(super) fn of(
        given: &[(R, f64)],
        space: &PhaseSpace,
        spectrum: &Spectrum<'_, R>,
        mut parts: Vec<Polynomial<R::Complex>>,
    ) -> Result<Prepared<R>, Error> {
        let mut phases = Phases { given: given.to_vec(), driven: Driven::new(&[], 1)?, stride: 1, shift: Vec::new() };
        if given.is_empty() {
            return Ok((phases, parts));
        }
        let force = std::mem::take(&mut parts[0]);
        phases.shift = forced(&force, space, spectrum)?;
        let pairs = space.phase_slots();
        for (order, part) in (0_u32..).zip(&mut parts) {
            *part = phases.shifted(part, space, 1)?.filter(|monomial, _| monomial.degree_in(&pairs) > 0);
            let largest = largest(part, space).into_iter().max().unwrap_or(0);
            phases.stride = phases.stride.max((largest as u32).div_ceil(order.max(1)));
        }
        fits(phases.stride, parts.len() - 1, space)?;
        let rates = space.driven_slots().zip(given).map(|(slot, (n, _))| (slot, R::complex(R::zero(), n.clone())));
        phases.driven = Driven::new(&rates.collect::<Vec<_>>(), phases.stride)?;
        let lifted = (0..).zip(&parts).map(|(order, part)| phases.lifted(part, space, order));
        let parts = lifted.collect::<Result<_, Error>>()?;
        Ok((phases, parts))
    }

    /// A polynomial with the exponents of a part of `order` of the triangle.
    pub(super) fn lifted(
        &self,
        polynomial: &Polynomial<R::Complex>,
        space: &PhaseSpace,
        order: u32,
    ) -> Result<Polynomial<R::Complex>, Error> {
        if self.given.is_empty() {
            return Ok(polynomial.clone());
        }
        let term = |(monomial, c): (Monomial, &R::Complex)| {
            let j: Vec<i32> = space.harmonics(monomial).into_iter().map(|j| j as i32).collect();
            Ok((self.driven.raise(monomial.without(space.driven_slots()), order, &j)?, c.clone()))
        };
        Ok(Polynomial::from_terms(polynomial.terms().map(term).collect::<Result<Vec<_>, Error>>()?))
    }

    /// A monomial of a part of `order` of the triangle with its harmonics, the inverse of [`lifted`](Self::lifted).
    pub(super) fn lowered_monomial(&self, monomial: Monomial, space: &PhaseSpace, order: usize) -> Monomial {
        if self.given.is_empty() {
            return monomial;
        }
        let slots = space.driven_slots().zip(self.driven.harmonics(monomial, order));
        // |j| ≤ s n ≤ `MAX_EXPONENT`/2, which `fits` has checked.
        slots.fold(monomial, |lowered, (slot, j)| harmonics::with(lowered, slot, j).unwrap_or(lowered))
    }

    /// A part of `order` of the triangle with its harmonics.
    pub(super) fn lowered<C: Coefficient>(
        &self,
        polynomial: &Polynomial<C>,
        space: &PhaseSpace,
        order: usize,
    ) -> Polynomial<C> {
        let term = |(monomial, c): (Monomial, &C)| (self.lowered_monomial(monomial, space, order), c.clone());
        if self.given.is_empty() { polynomial.clone() } else { Polynomial::from_terms(polynomial.terms().map(term)) }
    }

    /// The smallest order whose parts can have the harmonics of a polynomial, if the exponents of the next `orders` orders fit.
    pub(super) fn order_of(
        &self,
        polynomial: &Polynomial<R::Complex>,
        space: &PhaseSpace,
        orders: usize,
    ) -> Result<u32, Error> {
        let largest = largest(polynomial, space).into_iter().max().unwrap_or(0);
        let order = (largest as u32).div_ceil(self.stride);
        fits(self.stride, order as usize + orders, space)?;
        Ok(order)
    }

    /// `polynomial` at u + `sign` · shift.
    ///
    /// Harmonics become exponents j + B + b d for a term of degree d: each variable has the factor z^b, and each c_j the factor z^(b+j).
    pub(super) fn shifted(
        &self,
        polynomial: &Polynomial<R::Complex>,
        space: &PhaseSpace,
        sign: i64,
    ) -> Result<Polynomial<R::Complex>, Error> {
        if self.shift.iter().all(Polynomial::is_zero) {
            return Ok(polynomial.clone());
        }
        let pairs = space.phase_slots();
        let (base, mut own) = (largest(polynomial, space), vec![0; space.driven_slots().len()]);
        for shift in &self.shift {
            own.iter_mut().zip(largest(shift, space)).for_each(|(own, largest)| *own = largest.max(*own));
        }
        let forms = self.shift.iter().enumerate().map(|(slot, shift)| {
            let mut form = raised(&Polynomial::variable(slot)?, space, &own)?;
            form += &raised(shift, space, &own)?.map(|c| c.times(sign));
            Ok(form)
        });
        let forms = forms.collect::<Result<Vec<_>, Error>>()?;
        let mut sum = Polynomial::zero();
        for degree in 0..=polynomial.terms().map(|(monomial, _)| monomial.degree_in(&pairs)).max().unwrap_or(0) {
            let part = polynomial.filter(|monomial, _| monomial.degree_in(&pairs) == degree);
            let part = substitute(&raised(&part, space, &base)?, &forms)?;
            for (monomial, c) in part.terms() {
                let offsets = base.iter().zip(&own).map(|(base, own)| base + own * i64::from(degree));
                let lowered = space.driven_slots().zip(offsets).try_fold(monomial, |lowered, (slot, offset)| {
                    harmonics::with(lowered, slot, i64::from(monomial.exponent(slot)) - offset)
                })?;
                sum.add_term(lowered, c);
            }
        }
        Ok(sum)
    }
}

/// Refuses a stride s whose exponents 2 s n do not fit.
fn fits(stride: u32, order: usize, space: &PhaseSpace) -> Result<(), Error> {
    let exponent = 2 * u64::from(stride) * order as u64;
    if space.driven().is_empty() || exponent <= MAX_EXPONENT.into() {
        return Ok(());
    }
    Err(Error::ExponentOverflow { slot: space.driven_slots().start, exponent, bound: MAX_EXPONENT })
}

/// The largest |j| of each phase in a polynomial.
fn largest<C: Coefficient>(polynomial: &Polynomial<C>, space: &PhaseSpace) -> Vec<i64> {
    let mut largest = vec![0; space.driven_slots().len()];
    for (monomial, _) in polynomial.terms() {
        largest.iter_mut().zip(space.harmonics(monomial)).for_each(|(largest, j)| *largest = j.abs().max(*largest));
    }
    largest
}

/// A polynomial with j + offset as the exponent of each phase.
fn raised<C: Coefficient>(
    polynomial: &Polynomial<C>,
    space: &PhaseSpace,
    offsets: &[i64],
) -> Result<Polynomial<C>, Error> {
    let term = |(monomial, c): (Monomial, &C)| {
        let slots = space.driven_slots().zip(space.harmonics(monomial)).zip(offsets);
        // The offset is the largest |j|.
        let raised =
            slots.into_iter().try_fold(monomial, |raised, ((slot, j), offset)| raised.with(slot, (j + offset) as u32));
        Ok((raised?, c.clone()))
    };
    Ok(Polynomial::from_terms(polynomial.terms().map(term).collect::<Result<Vec<_>, Error>>()?))
}

/// The forced motion of u₁, U₁, … under `force`, whose terms are linear.
fn forced<R: RealField>(
    force: &Polynomial<R::Complex>,
    space: &PhaseSpace,
    spectrum: &Spectrum<'_, R>,
) -> Result<Vec<Polynomial<R::Complex>>, Error> {
    let mut shift = vec![Polynomial::zero(); 2 * space.degrees_of_freedom()];
    for (monomial, c) in force.terms() {
        let divisor = spectrum.divisor(&space.turns(monomial));
        if is_small::<R>(&divisor, spectrum.bound) {
            let term = space.complex_text(&Polynomial::from_terms([(monomial, 1.0)]));
            return Err(Error::ResonantForce { term, divisor: modulus::<R>(&divisor), bound: spectrum.bound });
        }
        let (re, im) = R::parts(&divisor);
        let quotient = c.divide(&R::complex(-im, re)).ok_or(Error::DivisionByZero)?;
        // A linear term has one variable. The slot of its conjugate differs in the last bit.
        let slot = space.phase_slots().into_iter().find(|&slot| monomial.exponent(slot) > 0).unwrap_or(0);
        let quotient = if slot.is_multiple_of(2) { -quotient } else { quotient };
        shift[slot ^ 1].add_term(monomial.without([slot]), &quotient);
    }
    Ok(shift)
}

/// A polynomial in cosines and sines of the phases, in exponentials: cos jM = ½ z^j + ½ z^(−j), sin jM = (z^j − z^(−j))/(2i).
pub(super) fn exponentials<R: RealField>(
    polynomial: Polynomial<R::Complex>,
    space: &PhaseSpace,
) -> Result<Polynomial<R::Complex>, Error> {
    let half = R::ratio(1, 2).ok_or(Error::DivisionByZero)?;
    let real = R::complex(half.clone(), R::zero());
    let [up, down] = [-half.clone(), half].map(|im| R::complex(R::zero(), im));
    let images = |j: i64| match j {
        0 => vec![(0, R::Complex::integer(1))],
        1.. => vec![(j, real.clone()), (-j, real.clone())],
        ..0 => vec![(-j, up.clone()), (j, down.clone())],
    };
    replaced(polynomial, space, images)
}

/// A polynomial in exponentials of the phases, in cosines and sines: the inverse of [`exponentials`].
pub(crate) fn cosines<R: RealField>(
    polynomial: Polynomial<R::Complex>,
    space: &PhaseSpace,
) -> Result<Polynomial<R::Complex>, Error> {
    let images = |j: i64| match j {
        0 => vec![(0, R::Complex::integer(1))],
        _ => vec![(j.abs(), R::Complex::integer(1)), (-j.abs(), R::complex(R::zero(), R::integer(j.signum())))],
    };
    replaced(polynomial, space, images)
}

fn replaced<C: Coefficient>(
    mut polynomial: Polynomial<C>,
    space: &PhaseSpace,
    images: impl Fn(i64) -> Vec<(i64, C)>,
) -> Result<Polynomial<C>, Error> {
    for slot in space.driven_slots() {
        let mut sum = Polynomial::zero();
        for (monomial, c) in polynomial.terms() {
            for (j, factor) in images(harmonics::signed(monomial.exponent(slot))) {
                let mut product = c.clone();
                product *= &factor;
                sum.add_term(harmonics::with(monomial, slot, j)?, &product);
            }
        }
        polynomial = sum;
    }
    Ok(polynomial)
}
