//! The resonances of a normal form: the terms that it keeps, and the smallest divisor that may remove a term.
//!
//! A monomial of the complex variables depends on the angles as e^{i k·φ}, with k_i = exponent of U_i − exponent of u_i. Its removal divides by k·ω. With driven
//! phases M it depends on them as e^{i(k·φ + j·M)}; the integers j follow those of k, and the frequencies of the phases those of the modes. It is kept
//! if k = 0, or if k is an integer combination of the given resonance vectors. Any other term with |k·ω| < `smallest divisor` · max |ω| is an error that names
//! the term.
//!
//! The default of the smallest divisor is 1e-6. A divisor δ multiplies a term, and its rounding error, by max|ω|/δ. At 1e-6 a term loses six of its sixteen
//! digits, and exact resonances of rounded frequencies, about 1e-15, are still recognized. In floats, terms that cancel may leave a rounding error, which
//! counts as a term. Euclid's algorithm on an echelon basis decides exactly whether k is a combination of the vectors.

use super::mode::{Mode, modulus};
use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::monomial::MAX_EXPONENT;
use crate::real_field::RealField;
use num_traits::Zero;

/// The default of the smallest divisor, relative to the largest frequency.
const SMALLEST_DIVISOR: f64 = 1e-6;

/// The resonances to keep, and the smallest divisor allowed.
///
/// ```
/// use andoyer_series::birkhoff::Resonances;
/// let one_to_one = Resonances::new(&[&[1, -1]])?;
/// assert!(one_to_one.keeps(&[2, -2]) && !one_to_one.keeps(&[2, -1]));
/// # Ok::<(), andoyer_series::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Resonances {
    vectors: Vec<Vec<i64>>,
    /// The vectors in echelon form: each row starts with at least one zero more than the row before.
    basis: Vec<Vec<i128>>,
    smallest_divisor: f64,
    centre: bool,
}

impl Default for Resonances {
    /// No resonance, and a smallest divisor of 1e-6.
    fn default() -> Self {
        Resonances { vectors: Vec::new(), basis: Vec::new(), smallest_divisor: SMALLEST_DIVISOR, centre: false }
    }
}

impl Resonances {
    /// The integer combinations of `vectors`, each with one entry for each degree of freedom, then one for each driven phase.
    ///
    /// # Errors
    /// - (0, 0), (1, −1) together with (1, −1, 0), (40000, 1): [`Error::ResonanceMalformed`].
    pub fn new(vectors: &[&[i64]]) -> Result<Self, Error> {
        let mut resonances = Self::default();
        for &vector in vectors {
            let malformed = || Error::ResonanceMalformed { vector: vector.to_vec(), bound: MAX_EXPONENT };
            let length = resonances.vectors.first().map_or(vector.len(), Vec::len);
            let fits = vector.iter().all(|entry| entry.unsigned_abs() <= MAX_EXPONENT.into());
            if vector.len() != length || !fits || vector.iter().all(|&entry| entry == 0) {
                return Err(malformed());
            }
            let row = vector.iter().map(|&entry| entry.into()).collect();
            insert(&mut resonances.basis, row).ok_or_else(malformed)?;
            resonances.vectors.push(vector.to_vec());
        }
        Ok(resonances)
    }

    /// These resonances with another smallest divisor, relative to the largest frequency. A larger value also admits resonances that are not exact.
    ///
    /// # Errors
    /// - −1, 1.1, NaN: [`Error::OutsideInterval`].
    pub fn with_smallest_divisor(mut self, smallest_divisor: f64) -> Result<Self, Error> {
        check_smallest_divisor(smallest_divisor)?;
        self.smallest_divisor = smallest_divisor;
        Ok(self)
    }

    /// These resonances, and in addition all terms of the centres. Only the terms that couple saddles and quartets to the centres are removed (Jorba and
    /// Masdemont, Physica D 132 (1999) 189). Divisors are then never smaller than the rate of a saddle.
    ///
    /// ```
    /// use andoyer_series::{PhaseSpace, normalize_with};
    /// use andoyer_series::birkhoff::Resonances;
    /// use andoyer_series::progress::quiet;
    /// let space = PhaseSpace::new(&[("x", "X"), ("y", "Y")])?;
    /// let h = space.parse::<f64>("x*X + (y^2 + Y^2)/2 + x*y^2 + X^2*y/2 + y^3")?;
    /// let reduced = normalize_with(&h, 1, &space, &Resonances::default().with_centre(), &mut quiet)?.centre_manifold()?;
    /// assert_eq!(reduced, space.parse("(y^2 + Y^2)/2 + y^3")?);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    #[must_use]
    pub fn with_centre(mut self) -> Self {
        self.centre = true;
        self
    }

    /// Whether all terms of the centres are kept.
    #[must_use]
    pub fn keeps_centre(&self) -> bool {
        self.centre
    }

    /// The smallest divisor, relative to the largest frequency.
    #[must_use]
    pub fn smallest_divisor(&self) -> f64 {
        self.smallest_divisor
    }

    /// The vectors given.
    #[must_use]
    pub fn vectors(&self) -> &[Vec<i64>] {
        &self.vectors
    }

    /// Whether terms with e^{i k·φ} are kept: k is 0 or a combination of the vectors.
    #[must_use]
    pub fn keeps(&self, k: &[i64]) -> bool {
        let mut rest: Vec<i128> = k.iter().map(|&entry| entry.into()).collect();
        for row in &self.basis {
            let Some(pivot) = pivot(row).filter(|_| row.len() == rest.len()) else { return false };
            let quotient = rest[pivot] / row[pivot];
            // An overflow means that k is too large for the exponents of any monomial.
            let Some(reduced) = combine(&rest, row, quotient) else { return false };
            rest = reduced;
        }
        rest.iter().all(|&entry| entry == 0)
    }

    /// Whether terms with e^{i k·φ} are kept in a normal form with these modes.
    pub(crate) fn keeps_of<R: RealField>(&self, k: &[i64], modes: &[Mode<R>]) -> bool {
        let centre = || k.iter().zip(modes).all(|(&k, mode)| k == 0 || mode.is_elliptic());
        self.keeps(k) || (self.centre && centre())
    }

    /// Refuses vectors of the wrong length, and vectors that are not a resonance of these frequencies.
    pub(crate) fn check<R: RealField>(&self, spectrum: &Spectrum<'_, R>) -> Result<(), Error> {
        for vector in &self.vectors {
            if vector.len() != spectrum.modes.len() + spectrum.driven.len() {
                return Err(Error::ResonanceMalformed { vector: vector.clone(), bound: MAX_EXPONENT });
            }
            let (divisor, bound) = (spectrum.divisor(vector), spectrum.bound);
            if !is_small::<R>(&divisor, bound) {
                let (re, im) = R::parts(&divisor);
                let divisor = if im.is_zero() { re.to_float() } else { modulus::<R>(&divisor) };
                return Err(Error::NotResonant { vector: vector.clone(), divisor, bound });
            }
        }
        Ok(())
    }
}

/// The frequencies of the modes and of the driven phases, with their phases at time 0, and the bound on |k·ω|.
pub(crate) struct Spectrum<'a, R: RealField> {
    modes: &'a [Mode<R>],
    driven: &'a [(R, f64)],
    pub(crate) bound: f64,
}

impl<'a, R: RealField> Spectrum<'a, R> {
    pub(crate) fn new(modes: &'a [Mode<R>], driven: &'a [(R, f64)], smallest_divisor: f64) -> Self {
        let modes_only = modes.iter().map(|mode| modulus::<R>(&mode.frequency()));
        let all = modes_only.chain(driven.iter().map(|(frequency, _)| frequency.to_float().abs()));
        Spectrum { modes, driven, bound: smallest_divisor * all.fold(0.0, f64::max) }
    }

    /// k·ω, with the driven phases last.
    pub(crate) fn divisor(&self, k: &[i64]) -> R::Complex {
        let mut sum = R::Complex::zero();
        for (&k, mode) in k.iter().zip(self.modes) {
            sum += &mode.frequency().times(k);
        }
        for (&j, (frequency, _)) in k.iter().skip(self.modes.len()).zip(self.driven) {
            sum += &R::complex(frequency.times(j), R::zero());
        }
        sum
    }
}

/// Whether a divisor is 0 or below the bound.
pub(crate) fn is_small<R: RealField>(divisor: &R::Complex, bound: f64) -> bool {
    divisor.is_zero() || modulus::<R>(divisor) < bound
}

fn pivot(row: &[i128]) -> Option<usize> {
    row.iter().position(|&entry| entry != 0)
}

/// Refuses a smallest divisor outside 0 to 1.
pub(crate) fn check_smallest_divisor(value: f64) -> Result<(), Error> {
    if (0.0..=1.0).contains(&value) {
        return Ok(());
    }
    Err(Error::OutsideInterval { argument: "smallest_divisor", value, lower: 0.0, upper: 1.0 })
}

/// row − quotient · other, or `None` on overflow.
fn combine(row: &[i128], other: &[i128], quotient: i128) -> Option<Vec<i128>> {
    row.iter().zip(other).map(|(a, b)| a.checked_sub(b.checked_mul(quotient)?)).collect()
}

/// Adds a vector to an echelon basis by Euclid's algorithm on rows with the same pivot; `None` on overflow.
fn insert(basis: &mut Vec<Vec<i128>>, mut row: Vec<i128>) -> Option<()> {
    while let Some(column) = pivot(&row) {
        match basis.iter().position(|held| pivot(held).is_some_and(|other| other >= column)) {
            Some(at) if pivot(&basis[at]) == Some(column) => {
                let quotient = basis[at][column] / row[column];
                let rest = combine(&basis[at], &row, quotient)?;
                basis[at] = std::mem::replace(&mut row, rest);
            }
            Some(at) => {
                basis.insert(at, row);
                return Some(());
            }
            None => {
                basis.push(row);
                return Some(());
            }
        }
    }
    Some(())
}
