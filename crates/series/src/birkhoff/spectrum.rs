//! The eigenvalues of the linear motion J A and their null vectors.
//!
//! Floats have the eigenvalues of the real Schur form, rationals those of [`exact_spectrum`]. An eigenvalue of multiplicity m has m null
//! vectors of J A − λ. Otherwise it has a Jordan block, which is an error that names the eigenvalue.

use super::exact_spectrum::{self, Eigenvalue, Refusal};
use super::matrix::{Matrix, null_space};
use super::mode::modulus;
use super::schur::eigenvalues;
use crate::error::Error;
use crate::real_field::RealField;

/// Tolerance relative to the largest entry of A. Smaller eigenvalues count as 0, and eigenvalues nearer than this to an axis lie on the axis. It is about the
/// square root of the rounding error, by which a Jordan block splits.
pub(super) const ROOT: f64 = 1e-7;
/// Eigenvalues nearer than this count as one of higher multiplicity. If they are two, their vectors are separated to 1e-5 and made symplectic afterwards.
const EQUAL: f64 = 1e-11;
/// An eigenvalue in the first quadrant, with its multiplicity and its null vectors.
pub(super) struct Eigenspace<R: RealField> {
    pub(super) re: R,
    pub(super) im: R,
    pub(super) vectors: Vec<Vec<R::Complex>>,
    /// Null vectors of −λ, for saddles and quartets.
    pub(super) opposite: Vec<Vec<R::Complex>>,
}

/// The names of a block's variables, for error messages.
pub(super) struct Names<'a> {
    pub(super) names: &'a dyn Fn(usize) -> String,
    pub(super) slots: usize,
}

impl Names<'_> {
    pub(super) fn pairs(&self) -> String {
        let pair = |slot| format!("({}, {})", (self.names)(slot), (self.names)(slot + 1));
        (0..self.slots).step_by(2).map(pair).collect::<Vec<_>>().join(", ")
    }

    /// The largest components of a vector, relative to its largest component.
    pub(super) fn direction<R: RealField>(&self, vector: &[R::Complex]) -> String {
        let largest = vector.iter().map(modulus::<R>).fold(0.0, f64::max);
        let part = |(slot, value): (usize, &R::Complex)| {
            let share = modulus::<R>(value) / largest;
            (share > 1e-6).then(|| format!("{} {share:.3}", (self.names)(slot)))
        };
        vector.iter().enumerate().filter_map(part).collect::<Vec<_>>().join(", ")
    }
}

/// The eigenvalues of J A with Re ≥ 0, Im ≥ 0 and their multiplicities: real ones first, then complex ones, then imaginary ones, each by descending size.
pub(super) fn spectrum<R: RealField>(
    motion: &Matrix<R>,
    scale: f64,
    names: &Names,
) -> Result<Vec<Eigenvalue<R>>, Error> {
    let not_finite = || Error::NotFinite { what: "quadratic part", term: names.pairs() };
    let mut found = if R::EPSILON > 0.0 {
        let floats = floating::<R>(motion, scale, names)?.into_iter();
        let number = |(re, im, count)| Some((R::from_float(re)?, R::from_float(im)?, count));
        floats.map(number).collect::<Option<Vec<_>>>().ok_or_else(not_finite)?
    } else {
        let fraction = |entry: &R| entry.to_rational().ok_or_else(not_finite);
        let fractions =
            motion.iter().map(|row| row.iter().map(fraction).collect()).collect::<Result<Matrix<_>, _>>()?;
        let exact = exact_spectrum::eigenvalues(&fractions).map_err(|refusal| match refusal {
            Refusal::Zero => zero::<R>(motion, names),
            Refusal::Irrational(re, im) => {
                Error::SpectrumIrrational { pairs: names.pairs(), eigenvalue: shown(re, im) }
            }
        })?;
        exact.iter().map(|(re, im, count)| (R::from_rational(re), R::from_rational(im), *count)).collect()
    };
    let rank = |(re, im, _): &Eigenvalue<R>| match (im.is_zero(), re.is_zero()) {
        (true, _) => 0,
        (false, false) => 1,
        (false, true) => 2,
    };
    let size = |(re, im, _): &Eigenvalue<R>| re.to_float().hypot(im.to_float());
    found.sort_by(|a, b| rank(a).cmp(&rank(b)).then(size(b).total_cmp(&size(a))));
    Ok(found)
}

/// The eigenvalues of the real Schur form.
fn floating<R: RealField>(motion: &Matrix<R>, scale: f64, names: &Names) -> Result<Vec<Eigenvalue<f64>>, Error> {
    let n = motion.len();
    let floats = nalgebra::DMatrix::from_fn(n, n, |i, j| motion[i][j].to_float() / scale);
    let not_finite = || Error::NotFinite { what: "quadratic part", term: names.pairs() };
    if scale == 0.0 || floats.iter().any(|entry| !entry.is_finite()) {
        return if scale == 0.0 { Err(zero::<R>(motion, names)) } else { Err(not_finite()) };
    }
    let eigenvalues = eigenvalues(&floats).ok_or_else(not_finite)?;
    let mut found: Vec<Eigenvalue<f64>> = Vec::new();
    for value in &eigenvalues {
        if value.norm() < ROOT {
            return Err(zero::<R>(motion, names));
        }
        // Each eigenvalue represents ±λ, ±λ̄. If its distance from the axis is below `ROOT`, it is moved to the axis.
        let re = if value.re.abs() < ROOT { 0.0 } else { value.re.abs() };
        let im = if value.im.abs() < ROOT { 0.0 } else { value.im.abs() };
        let weight = if re > 0.0 && im > 0.0 { 1 } else { 2 };
        let known = found.iter_mut().find(|known| (known.0 - re).hypot(known.1 - im) < known_radius(value, re, im));
        match known {
            Some(known) => known.2 += weight,
            None => found.push((re, im, weight)),
        }
    }
    // Each count is four times the multiplicity: from ±λ, ±λ̄, or twice from ±λ.
    Ok(found.into_iter().map(|(re, im, count)| (re * scale, im * scale, count.div_ceil(4))).collect())
}

/// Largest distance of two computed values of one eigenvalue: `ROOT` if the value was moved to an axis, otherwise `EQUAL`.
fn known_radius(value: &nalgebra::Complex<f64>, re: f64, im: f64) -> f64 {
    let moved = (value.re.abs() - re).abs().max((value.im.abs() - im).abs());
    if moved > EQUAL { ROOT } else { EQUAL }
}

fn zero<R: RealField>(motion: &Matrix<R>, names: &Names) -> Error {
    let nulls =
        |dimension| null_space::<R>(complexified(motion, &R::complex(R::zero(), R::zero())), dimension, f64::INFINITY);
    let vectors = (1..=motion.len()).find_map(nulls).unwrap_or_default();
    let direction = vectors.first().map(|vector| names.direction::<R>(vector)).unwrap_or_default();
    Error::ZeroFrequency { pairs: names.pairs(), direction }
}

/// J A − λ.
fn complexified<R: RealField>(motion: &Matrix<R>, eigenvalue: &R::Complex) -> Matrix<R::Complex> {
    let complex = |i: usize, j: usize| {
        let mut entry = R::complex(motion[i][j].clone(), R::zero());
        if i == j {
            entry -= eigenvalue;
        }
        entry
    };
    (0..motion.len()).map(|i| (0..motion.len()).map(|j| complex(i, j)).collect()).collect()
}

/// The null vectors of λ and of −λ.
pub(super) fn eigenspace<R: RealField>(
    motion: &Matrix<R>,
    (re, im, multiplicity): Eigenvalue<R>,
    scale: f64,
    names: &Names,
) -> Result<Eigenspace<R>, Error> {
    let nulls = |re: &R, im: &R, dimension| {
        null_space::<R>(complexified(motion, &R::complex(re.clone(), im.clone())), dimension, ROOT * scale)
    };
    let defective = |vectors: Option<Vec<Vec<R::Complex>>>| Error::Defective {
        pairs: names.pairs(),
        eigenvalue: shown(re.to_float(), im.to_float()),
        direction: vectors.iter().flatten().next().map(|vector| names.direction::<R>(vector)).unwrap_or_default(),
    };
    let Some(vectors) = nulls(&re, &im, multiplicity) else {
        return Err(defective((1..multiplicity).rev().find_map(|fewer| nulls(&re, &im, fewer))));
    };
    let opposite = if re.is_zero() { Some(Vec::new()) } else { nulls(&-re.clone(), &-im.clone(), multiplicity) };
    let Some(opposite) = opposite else { return Err(defective(Some(vectors))) };
    Ok(Eigenspace { re, im, vectors, opposite })
}

/// Eigenvalues for a message, with ten digits.
pub(super) fn shown(re: f64, im: f64) -> String {
    let digits = |value: f64| if (1e-3..1e6).contains(&value) { format!("{value:.9}") } else { format!("{value:.9e}") };
    match (re > 0.0, im > 0.0) {
        (true, true) => format!("±{} ± {}i", digits(re), digits(im)),
        (true, false) => format!("±{}", digits(re)),
        _ => format!("±{}i", digits(im)),
    }
}
