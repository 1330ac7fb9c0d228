//! The range of a normal form: the sizes of its orders, and the best order at a given amplitude.
//!
//! The amplitude of a mode is a = √(2|I|). If all amplitudes are at most a, a term c Π u^j U^k of degree d is at most |c| Π |u|^j |U|^k, with |u| = a/(2√r) and
//! |U| = a √r for a centre, and |u| = |U| = a for a saddle or a quartet. The norm ‖T_m‖ of a generating function T_m = S_m/(m−1)! is the sum of these bounds at
//! a = 1. Its contribution to the transformation has the size ‖T_m‖ a^(m+1) (m+2).
//!
//! Such series behave like a^m/ρ_m^m with ρ_m = (‖T_{m−2}‖/‖T_m‖)^{1/2}. ρ_m falls with the order, so the series diverge. At a given amplitude the sizes first
//! fall and then rise, and the best order is where they are smallest. This is an estimate, not a bound. The formal integrals along an integrated orbit test it:
//! [`BirkhoffMap::actions`](crate::BirkhoffMap::actions).
//!
//! With driven phases |e^{ijM}| = 1, and T_m has parts of degree d ≤ m + 2. Their contributions are d ‖…‖ a^(d−1): orders are not powers of a, and there are no ρ_m.

use super::BirkhoffNormalForm;
use super::mode::{Mode, modulus};
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;

/// The sizes of the orders of a normal form.
#[derive(Debug, Clone, PartialEq)]
pub struct Domain {
    norms: Vec<f64>,
    /// With driven phases, the parts of each norm by degree in the variables; otherwise empty.
    by_degree: Vec<Vec<f64>>,
}

impl<R: RealField> BirkhoffNormalForm<R> {
    /// The sizes of the orders. `parameters` are numbers for the parameters, in the order of their names.
    ///
    /// ```
    /// use andoyer_series::{PhaseSpace, normalize};
    /// let space = PhaseSpace::new(&[("q", "p")])?;
    /// let form = normalize(&space.parse::<f64>("(p^2 + q^2)/2 - q^3/3")?, 12, &space)?;
    /// let domain = form.domain(&[])?;
    /// // Well inside the separatrix the highest order is best; beyond it (it passes through q = 1) a low order is best.
    /// assert_eq!((domain.best_order(0.05)?, domain.best_order(1.5)?), (12, 2));
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - one number for two parameters: [`Error::CountMismatch`]; a NaN: [`Error::NotFinite`].
    pub fn domain(&self, parameters: &[f64]) -> Result<Domain, Error> {
        super::map::check("parameters", parameters, self.space().parameters())?;
        let mut sizes: Vec<f64> = self.modes().iter().flat_map(size).collect();
        sizes.extend(parameters.iter().map(|value| value.abs()));
        let bound = |(monomial, c): (Monomial, &R::Complex)| {
            let powers = sizes.iter().enumerate().map(|(slot, size)| size.powi(monomial.exponent(slot) as i32));
            modulus::<R>(c) * powers.product::<f64>()
        };
        // `sum` of no terms is −0.
        let norm = |generator: &Polynomial<R::Complex>| generator.terms().map(bound).fold(0.0, |sum, size| sum + size);
        let generators = || (1..=self.order()).filter_map(|m| self.transform().scaled_generator(m));
        let pairs = self.space().phase_slots();
        let degrees = |generator: &Polynomial<R::Complex>| {
            let mut sums = vec![0.0; self.order() + 3];
            for (monomial, c) in generator.terms() {
                sums[monomial.degree_in(&pairs) as usize] += bound((monomial, c));
            }
            sums
        };
        let driven = !self.driven().is_empty();
        let by_degree = if driven { generators().map(degrees).collect() } else { Vec::new() };
        Ok(Domain { norms: generators().map(norm).collect(), by_degree })
    }
}

/// |u| and |U| at the amplitude 1.
pub(crate) fn size<R: RealField>(mode: &Mode<R>) -> [f64; 2] {
    match mode {
        Mode::Elliptic { ratio, .. } => [0.5 / ratio.to_float().sqrt(), ratio.to_float().sqrt()],
        _ => [1.0, 1.0],
    }
}

impl Domain {
    /// The sizes of orders that are powers of the amplitude.
    pub(crate) fn of_norms(norms: Vec<f64>) -> Self {
        Self { norms, by_degree: Vec::new() }
    }

    /// The norms ‖T_1‖, …, ‖T_N‖.
    #[must_use]
    pub fn norms(&self) -> &[f64] {
        &self.norms
    }

    /// ρ_m = (‖T_{m−2}‖/‖T_m‖)^{1/2} for m = 3, …, N: the amplitude at which order m is as large as order m − 2. It is infinite if T_m is 0. The list is empty for a
    /// form with driven phases, whose orders are not powers of the amplitude.
    #[must_use]
    pub fn radii(&self) -> Vec<f64> {
        if !self.by_degree.is_empty() {
            return Vec::new();
        }
        self.norms
            .windows(3)
            .map(|norms| if norms[2] > 0.0 { (norms[0] / norms[2]).sqrt() } else { f64::INFINITY })
            .collect()
    }

    /// The sizes (m + 2) ‖T_m‖ a^(m+1), m = 1, …, N, of the orders of the transformation if all amplitudes √(2|I|) are a. With driven phases, the sums of
    /// d ‖…‖ a^(d−1) over the parts of degree d.
    ///
    /// # Errors
    /// - −1, NaN, an infinity: [`Error::OutsideInterval`].
    pub fn sizes(&self, amplitude: f64) -> Result<Vec<f64>, Error> {
        if !(0.0..=f64::MAX).contains(&amplitude) {
            let (argument, value) = ("amplitude", amplitude);
            return Err(Error::OutsideInterval { argument, value, lower: 0.0, upper: f64::MAX });
        }
        if !self.by_degree.is_empty() {
            let size = |degrees: &Vec<f64>| {
                let part = |(d, norm): (i32, &f64)| f64::from(d) * norm * amplitude.powi((d - 1).max(0));
                (0..).zip(degrees).map(part).sum()
            };
            return Ok(self.by_degree.iter().map(size).collect());
        }
        let size = |(m, norm): (i32, &f64)| f64::from(m + 2) * norm * amplitude.powi(m + 1);
        Ok((1..).zip(&self.norms).map(size).collect())
    }

    /// The order with the smallest nonzero size. It is the highest order if all sizes are 0, and 0 for a normal form of order 0.
    ///
    /// # Errors
    /// - The errors of [`sizes`](Self::sizes).
    pub fn best_order(&self, amplitude: f64) -> Result<usize, Error> {
        let sizes = self.sizes(amplitude)?;
        let nonzero = sizes.iter().enumerate().filter(|(_, size)| **size > 0.0);
        // A size is 0 at amplitude 0, or if a symmetry removes the order.
        Ok(nonzero.min_by(|a, b| a.1.total_cmp(b.1)).map_or(self.norms.len(), |(at, _)| at + 1))
    }
}

/// A table of orders, norms and radii.
impl std::fmt::Display for Domain {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(formatter, "order        norm      radius")?;
        let radii = self.radii();
        for (at, norm) in self.norms.iter().enumerate() {
            write!(formatter, "{:>5} {norm:>11.3e}", at + 1)?;
            match at.checked_sub(2).and_then(|at| radii.get(at)) {
                Some(radius) if radius.is_finite() => writeln!(formatter, " {radius:>11.4}")?,
                _ => writeln!(formatter)?,
            }
        }
        Ok(())
    }
}
