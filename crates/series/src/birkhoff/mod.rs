//! The Birkhoff normal form of any polynomial Hamiltonian about an equilibrium.
//!
//! H(q₁, p₁, …, qₙ, pₙ) = constant + H₂ + terms of higher degree, with {q; p} = 1. A linear symplectic change turns H₂ into a sum of modes: centres, saddles
//! and quartets (`quadratic`, `williamson`, `mode`). Terms are graded by degree, where parameters count with given degrees: the terms of degree 2 + n are of
//! order n. Deprit's triangle (theory §4), in the complex variables (u, U) of the modes, removes every term of degree 2 + N or less except those that
//! [`Resonances`] keeps. The result is the Gustavson form if there are resonances, and the reduction to the centre manifold if all terms of the centres are
//! kept. Generators have no kernel part, which makes the normal form unique. Driven phases (`phases`) are angles that move by themselves; a term with one counts one
//! order more.
//!
//! The computation is exact over the rationals if the eigenvalues are rational; otherwise it is in `f64`. The series diverge in general, so at fixed amplitude
//! there is a best order (`domain`). Cost: N³/6 brackets of growing polynomials. Sources: G. D. Birkhoff, *Dynamical Systems* (1927), ch. III; J. Williamson,
//! Amer. J. Math. 58 (1936) 141; F. G. Gustavson, Astron. J. 71 (1966) 670; A. Deprit, Celest. Mech. 1 (1969) 12; A. Jorba and J. Masdemont, Physica D 132
//! (1999) 189.

pub(crate) mod actions;
#[cfg(feature = "code")]
pub(crate) mod code;
pub(crate) mod diagonal;
pub(crate) mod domain;
mod exact_spectrum;
pub(crate) mod flow;
#[cfg(feature = "serde")]
pub(crate) mod json;
pub(crate) mod latex;
pub(crate) mod map;
pub(crate) mod matrix;
pub(crate) mod mode;
mod phase_space;
pub(crate) mod phases;
mod quadratic;
pub(crate) mod range;
pub(crate) mod resonances;
mod scaled;
pub(crate) mod schur;
mod series;
mod spectrum;
mod text;
mod transformation;
mod univariate;
pub(crate) mod variables;
#[cfg(feature = "serde")]
pub(crate) mod verify;
mod williamson;

pub use actions::{AnglePart, AngleTerms};
pub use domain::Domain;
pub use map::BirkhoffMap;
pub use mode::Mode;
pub use phase_space::PhaseSpace;
pub use resonances::Resonances;

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;
use crate::triangle::{LieTransform, Normalization, Progress, Removal, normalize_by, quiet};
use diagonal::Diagonal;
use mode::modulus;
use phases::{Phases, Prepared};
use resonances::{Spectrum, is_small};
use variables::{changed, to_complex, to_real};

/// The normal form of a Hamiltonian about an equilibrium, and the transformation to it.
#[derive(Debug, Clone, PartialEq)]
pub struct BirkhoffNormalForm<R: RealField> {
    space: PhaseSpace,
    diagonal: Diagonal<R>,
    resonances: Resonances,
    phases: Phases<R>,
    offset: Polynomial<R>,
    /// The normalized Hamiltonian, without the constant term and without the terms above its order.
    hamiltonian: Polynomial<R>,
    normalization: Normalization<R::Complex>,
}

/// Computes the normal form of `hamiltonian` to `order`, that is to degree `order` + 2, without resonances.
///
/// Terms of higher degree have no effect. [`PhaseSpace::with_parameters`] defines the degrees of parameters.
///
/// ```
/// use andoyer_series::{PhaseSpace, normalize};
/// use num_rational::BigRational;
/// let space = PhaseSpace::new(&[("q", "p")])?;
/// let pendulum = space.parse::<BigRational>("p^2/2 - 1 + q^2/2 - q^4/24 + q^6/720")?; // p²/2 − cos q
/// let normal_form = normalize(&pendulum, 4, &space)?;
/// assert_eq!(normal_form.in_actions()?.display(&["I"]).to_string(), "-1 + I - 1/16*I^2 - 1/256*I^3");
/// # Ok::<(), andoyer_series::Error>(())
/// ```
///
/// # Errors
/// - q + p²/2: [`Error::LinearTerm`]; p²/2: [`Error::ZeroFrequency`]; x X + y Y + x Y: [`Error::Defective`]; d q² + p² with d of degree 0:
///   [`Error::ParameterDegree`], otherwise [`Error::FrequencyParameter`];
/// - p²/2 + q² over the rationals: [`Error::FrequencyIrrational`], for coupled pairs [`Error::SpectrumIrrational`]; a NaN: [`Error::NotFinite`];
/// - two coupled modes with equal frequencies: [`Error::SmallDivisor`];
/// - order 171 in `f64`, 32764 over the rationals: [`Error::OrderTooLarge`];
/// - a variable that `space` does not have: [`Error::ValueMissing`].
pub fn normalize<R: RealField>(
    hamiltonian: &Polynomial<R>,
    order: usize,
    space: &PhaseSpace,
) -> Result<BirkhoffNormalForm<R>, Error> {
    normalize_with(hamiltonian, order, space, &Resonances::default(), &mut quiet)
}

/// Computes the normal form of `hamiltonian` to `order` and keeps the terms of `resonances`.
///
/// `progress` is called with (orders done, `order`) before every cell of the triangle and during long cells.
///
/// ```
/// use andoyer_series::{PhaseSpace, normalize_with};
/// use andoyer_series::birkhoff::Resonances;
/// use andoyer_series::progress::quiet;
/// use num_rational::BigRational;
/// let space = PhaseSpace::new(&[("x", "X"), ("y", "Y")])?;
/// let henon_heiles = space.parse::<BigRational>("(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y - y^3/3")?;
/// let one_to_one = Resonances::new(&[&[1, -1]])?;
/// let normal_form = normalize_with(&henon_heiles, 2, &space, &one_to_one, &mut quiet)?;
/// // With N = I_x + I_y and the angular momentum L: K = N − (5/12) N² + (7/12) L².
/// let n = "(x^2 + X^2 + y^2 + Y^2)/2";
/// assert_eq!(normal_form.in_real()?, space.parse(&format!("{n} - 5/12*({n})^2 + 7/12*(x*Y - y*X)^2"))?);
/// # Ok::<(), andoyer_series::Error>(())
/// ```
///
/// # Errors
/// - the errors of [`normalize`];
/// - resonances of another number of modes: [`Error::ResonanceMalformed`]; (1, −1) for frequencies 1 and 2: [`Error::NotResonant`];
/// - a callback that returns `Break`: [`Error::Interrupted`].
pub fn normalize_with<R: RealField>(
    hamiltonian: &Polynomial<R>,
    order: usize,
    space: &PhaseSpace,
    resonances: &Resonances,
    progress: &mut Progress<'_>,
) -> Result<BirkhoffNormalForm<R>, Error> {
    normalize_driven(hamiltonian, order, space, &[], resonances, progress)
}

/// Computes the normal form of a Hamiltonian with driven phases; otherwise the same as [`normalize_with`].
///
/// `driven` has the frequency n and the phase M₀ at time 0 of each phase M = M₀ + n t of [`PhaseSpace::with_driven`], in the order of their names. A term with
/// e^{i(k·φ + j·M)} is removed by dividing by k·ω + j·n. `resonances` have the integers j after those of k. The order of a term is its degree minus 2, plus 1 if it
/// contains a phase. Terms of order 0 are linear forces: the variables are measured from their forced motion. Terms without variables do not change the
/// motion: those with a phase, and those that arise, are dropped.
///
/// ```
/// use andoyer_series::{PhaseSpace, normalize_driven};
/// use andoyer_series::birkhoff::Resonances;
/// use andoyer_series::progress::quiet;
/// use num_rational::BigRational;
/// // Mathieu's equation x″ + (4/9 − 2 q cos 2t) x = 0: the characteristic exponent is 2/3 + 27/40 q² + …
/// let space = PhaseSpace::new(&[("x", "p")])?.with_parameters(&["q"])?.with_driven(&["M"])?;
/// let h = space.parse::<BigRational>("(p^2 + 4/9*x^2)/2 - q*x^2*cos(2*M)")?;
/// let one = (BigRational::from_integer(1.into()), 0.0);
/// let form = normalize_driven(&h, 2, &space, &[one], &Resonances::default(), &mut quiet)?;
/// assert_eq!(form.to_string(), "2/3*I_x + 27/40*I_x*q^2");
/// # Ok::<(), andoyer_series::Error>(())
/// ```
///
/// # Errors
/// - the errors of [`normalize_with`]; another number of frequencies than of phases: [`Error::CountMismatch`];
/// - a NaN: [`Error::NotFinite`]; a frequency 0: [`Error::DrivenUnsupported`];
/// - a force with the frequency of a mode: [`Error::ResonantForce`]; exponents 2 |j| above 32767/N: [`Error::ExponentOverflow`].
pub fn normalize_driven<R: RealField>(
    hamiltonian: &Polynomial<R>,
    order: usize,
    space: &PhaseSpace,
    driven: &[(R, f64)],
    resonances: &Resonances,
    progress: &mut Progress<'_>,
) -> Result<BirkhoffNormalForm<R>, Error> {
    if order > R::MAX_ORDER {
        return Err(Error::OrderTooLarge { order, bound: R::MAX_ORDER });
    }
    let space = space.settled(hamiltonian);
    check_driven(driven, &space)?;
    let diagonal = Diagonal::of(hamiltonian, &space)?;
    let spectrum = Spectrum::new(&diagonal.modes, driven, resonances.smallest_divisor());
    resonances.check(&spectrum)?;
    let (phases, series) = prepared(hamiltonian, order, &space, &diagonal, &spectrum, driven)?;
    let removal = |n, known: &Polynomial<_>| {
        remove(n, known, &spectrum, |k| resonances.keeps_of(k, &diagonal.modes), &phases, &space)
    };
    let normalization = normalize_by(&series, &space.poisson()?, order, &removal, progress)?;
    let offset = hamiltonian.filter(|m, _| m.degree_in(&space.phase_slots()) == 0 && !space.is_driven(m));
    let within = |monomial: Monomial| {
        monomial.degree_in(&space.phase_slots()) > 0 && space.weight(monomial) as usize <= order + 2
    };
    let hamiltonian = hamiltonian.filter(|monomial, _| within(monomial));
    let resonances = resonances.clone();
    let normal_form = BirkhoffNormalForm { space, diagonal, resonances, phases, offset, hamiltonian, normalization };
    normal_form.check_finite()?;
    Ok(normal_form)
}

/// Refuses frequencies that do not belong to the phases of `space`.
pub(crate) fn check_driven<R: RealField>(driven: &[(R, f64)], space: &PhaseSpace) -> Result<(), Error> {
    let names = space.driven();
    if driven.len() != names.len() {
        return Err(Error::CountMismatch { what: "driven", found: driven.len(), expected: names.len() });
    }
    for ((frequency, phase), name) in driven.iter().zip(names) {
        if !frequency.is_finite() || !phase.is_finite() {
            return Err(Error::NotFinite {
                what: "driven",
                term: format!("{name}: {:?}, {phase:?}", frequency.to_float()),
            });
        }
        if frequency.is_zero() {
            return Err(Error::DrivenUnsupported { problem: "needs frequencies other than 0" });
        }
    }
    Ok(())
}

/// The driven phases, and the parts of order 0, 1, …, `order` in the complex variables. The part of order 0 is exactly −i Σ ω u U, without rounding.
fn prepared<R: RealField>(
    hamiltonian: &Polynomial<R>,
    order: usize,
    space: &PhaseSpace,
    diagonal: &Diagonal<R>,
    spectrum: &Spectrum<'_, R>,
    driven: &[(R, f64)],
) -> Result<Prepared<R>, Error> {
    let phase = space.phase_slots();
    let mut parts = vec![Polynomial::zero(); order + 1];
    for (monomial, c) in hamiltonian.terms().filter(|(monomial, _)| monomial.degree_in(&phase) > 0) {
        let known = |&n: &usize| n <= order && (n > 0 || space.is_driven(monomial));
        if let Some(n) = (space.weight(monomial) as usize).checked_sub(2).filter(known) {
            parts[n].add_term(monomial, c);
        }
    }
    let change = diagonal.forms()?;
    let mut series = Vec::new();
    for part in &parts {
        series.push(to_complex(&changed(part, change.as_deref())?, &diagonal.modes, space)?);
    }
    let (phases, mut series) = Phases::of(driven, space, spectrum, series)?;
    for (mode, kind) in diagonal.modes.iter().enumerate() {
        let action = Monomial::ONE.with(2 * mode, 1)?.with(2 * mode + 1, 1)?;
        let (re, im) = R::parts(&kind.frequency());
        series[0].add_term(action, &R::complex(im, -re));
    }
    Ok((phases, series))
}

/// The image part of `known`, and the S with {h₀; S} = −image. For a single term, {h₀; S} = −i (k·ω) S. With driven phases a term without
/// variables is dropped; it needs no S.
fn remove<R: RealField>(
    order: usize,
    known: &Polynomial<R::Complex>,
    spectrum: &Spectrum<'_, R>,
    keeps: impl Fn(&[i64]) -> bool,
    phases: &Phases<R>,
    space: &PhaseSpace,
) -> Result<Removal<R::Complex>, Error> {
    let (bound, pairs) = (spectrum.bound, space.phase_slots());
    let mut removal = Removal { image: Polynomial::zero(), solution: Polynomial::zero() };
    for (monomial, c) in known.terms() {
        if !phases.given.is_empty() && monomial.degree_in(&pairs) == 0 {
            removal.image.add_term(monomial, c);
            continue;
        }
        let lowered = phases.lowered_monomial(monomial, space, order);
        let k = space.turns(lowered);
        if keeps(&k) {
            continue;
        }
        let divisor = spectrum.divisor(&k);
        if is_small::<R>(&divisor, bound) {
            let term = space.complex_text(&Polynomial::from_terms([(lowered, 1.0)]));
            return Err(Error::SmallDivisor { order, term, k, divisor: modulus::<R>(&divisor), bound });
        }
        let (re, im) = R::parts(&divisor);
        let solution = c.divide(&R::complex(-im, re)).ok_or(Error::DivisionByZero)?;
        removal.image.add_term(monomial, c);
        removal.solution.add_term(monomial, &solution);
    }
    Ok(removal)
}

impl<R: RealField> BirkhoffNormalForm<R> {
    /// The order N: terms of degree N + 2 at most are normalized.
    #[must_use]
    pub fn order(&self) -> usize {
        self.normalization.transform.order()
    }

    /// The variables of the normal form.
    #[must_use]
    pub fn space(&self) -> &PhaseSpace {
        &self.space
    }

    /// The modes of the quadratic part.
    #[must_use]
    pub fn modes(&self) -> &[Mode<R>] {
        &self.diagonal.modes
    }

    /// The frequencies ωᵢ: real for centres (negative if the energy of the centre is negative), iλ for saddles, iσ ∓ ν for quartets.
    #[must_use]
    pub fn frequencies(&self) -> Vec<R::Complex> {
        self.modes().iter().map(Mode::frequency).collect()
    }

    /// The rows of the symplectic matrix M of the linear change z = M z′ that diagonalizes the quadratic part, with z = (q₁, p₁, q₂, …).
    #[must_use]
    pub fn linear_change(&self) -> &[Vec<R>] {
        &self.diagonal.matrix
    }

    /// The resonances that were kept.
    #[must_use]
    pub fn resonances(&self) -> &Resonances {
        &self.resonances
    }

    /// The energy of the equilibrium: the constant term, which may contain parameters.
    #[must_use]
    pub fn offset(&self) -> &Polynomial<R> {
        &self.offset
    }

    /// The Hamiltonian that was normalized, to the degree of its order and without the constant term.
    #[must_use]
    pub fn hamiltonian(&self) -> &Polynomial<R> {
        &self.hamiltonian
    }

    /// The frequency n and the phase M₀ at time 0 of each driven phase.
    #[must_use]
    pub fn driven(&self) -> &[(R, f64)] {
        &self.phases.given
    }

    /// The transformation in the complex variables. Order n of its series is degree n + 2.
    ///
    /// With driven phases it is that of the variables measured from the forced motion, and its exponents of a phase are those of
    /// [`Driven`](crate::lie::Driven).
    #[must_use]
    pub fn transform(&self) -> &LieTransform<R::Complex> {
        &self.normalization.transform
    }

    /// The normal form in the complex variables (u₁, U₁, u₂, U₂, …), including the offset. A driven phase is e^{ijM}; see [`PhaseSpace::harmonics`].
    #[must_use]
    pub fn in_complex(&self) -> Polynomial<R::Complex> {
        let mut sum = self.offset.map(|c| R::complex(c.clone(), R::zero()));
        for (order, part) in self.normalization.hamiltonian.iter().enumerate() {
            if self.phases.given.is_empty() {
                sum += part;
            } else {
                sum += &self.phases.lowered(part, &self.space, order);
            }
        }
        sum
    }

    /// The normal form in the new real variables (q₁′, p₁′, q₂′, p₂′, …), including the offset.
    ///
    /// # Errors
    /// - None for an existing normal form: degrees do not change.
    pub fn in_real(&self) -> Result<Polynomial<R>, Error> {
        to_real(&self.in_complex(), self.modes(), &self.space)
    }

    /// The Hamiltonian on the centre manifold, in the new real variables of the centres. On this manifold the saddles and quartets have q = p = 0.
    ///
    /// [`BirkhoffMap::from_centre`] gives the states of its points.
    ///
    /// # Errors
    /// - None for an existing normal form.
    pub fn centre_manifold(&self) -> Result<Polynomial<R>, Error> {
        let outside: Vec<usize> = self.saddle_slots();
        let inside = self.in_complex().filter(|monomial, _| monomial.degree_in(&outside) == 0);
        to_real(&inside, self.modes(), &self.space)
    }

    /// The slots of saddles and quartets.
    fn saddle_slots(&self) -> Vec<usize> {
        let modes = self.modes().iter().enumerate().filter(|(_, mode)| !mode.is_elliptic());
        modes.flat_map(|(mode, _)| [2 * mode, 2 * mode + 1]).collect()
    }

    /// The generating function S_m in real variables. It has degree m + 2, or less with driven phases; orders are numbered 1 to N as in theory §4.
    ///
    /// # Errors
    /// - 0, N + 1: [`Error::OrderOutOfRange`].
    pub fn generator(&self, m: usize) -> Result<Polynomial<R>, Error> {
        let range =
            || Error::OrderOutOfRange { what: "generating function", order: m, minimum: 1, maximum: self.order() };
        let generator = self.phases.lowered(&self.transform().generator(m).ok_or_else(range)?, &self.space, m);
        to_real(&generator, self.modes(), &self.space)
    }

    /// Refuses floats that overflowed during the computation.
    fn check_finite(&self) -> Result<(), Error> {
        let generators = (1..=self.order()).filter_map(|m| self.transform().scaled_generator(m));
        for polynomial in self.normalization.hamiltonian.iter().chain(generators) {
            if let Some((monomial, c)) = polynomial.terms().find(|(_, c)| !c.is_finite()) {
                let monomial = monomial.without(self.space.driven_slots());
                let term = self.space.complex_text(&Polynomial::from_terms([(monomial, c.clone())]));
                return Err(Error::NotFinite { what: "normal form", term });
            }
        }
        Ok(())
    }
}
