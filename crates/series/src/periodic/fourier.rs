//! The motion at fixed actions as a Fourier series in the proper angles and the driven phases.

use std::collections::BTreeMap;

use num_complex::Complex;
use num_traits::Zero;

use super::divisors::turns;
use super::exponent::Exponent;
use super::form::DrivenForm;
use super::row::{Periodic, product};
use crate::error::Error;
use crate::polynomial::Polynomial;

/// One harmonic of a motion: each variable is the sum of Re(amplitude · e^{i(k·φ + j·M)}).
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonic {
    /// The integers k of the proper angles, then those j of the driven phases. The first that is not 0 is positive.
    pub multiples: Vec<i64>,
    /// The amplitudes of q₁, p₁, q₂, p₂, …
    pub amplitudes: Vec<Complex<f64>>,
}

impl DrivenForm {
    /// The state as a Fourier series in the proper angles and the driven phases, at fixed actions of centres. Harmonics whose amplitudes are all at most `least` are left out.
    ///
    /// # Errors
    /// - the errors of [`frequencies`](Self::frequencies); a mode that is no centre: [`Error::CountMismatch`].
    pub fn fourier(&self, actions: &[f64], least: f64) -> Result<Vec<Harmonic>, Error> {
        self.frequencies(actions)?;
        self.centres()?;
        let (modes, grid, n) = (actions.len(), self.grid(), self.motion.origin.len());
        let mut sums: BTreeMap<Vec<i64>, Vec<Complex<f64>>> = BTreeMap::new();
        let mut join = |mut multiples: Vec<i64>, variable: usize, c: Complex<f64>| {
            let negative = multiples.iter().find(|&&k| k != 0).is_some_and(|&k| k < 0);
            if negative {
                multiples.iter_mut().for_each(|k| *k = -*k);
            }
            let sums = sums.entry(multiples).or_insert_with(|| vec![Complex::default(); n]);
            sums[variable] += if negative { c.conj() } else { c };
        };
        for (variable, x) in self.motion.origin.iter().enumerate() {
            for (at, c) in grid.harmonics(x).into_iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                join([vec![0; modes], grid.multiples(at)].concat(), variable, c);
            }
        }
        let mut rows: BTreeMap<Vec<i64>, Vec<(usize, Periodic)>> = BTreeMap::new();
        for (slot, image) in &self.images {
            for (k, row) in by_angles(image, actions) {
                rows.entry(k).or_default().push((*slot, row));
            }
        }
        for (k, rows) in rows {
            let column: Vec<Vec<Periodic>> = rows.iter().map(|(_, row)| vec![row.clone()]).collect();
            let used: Vec<Vec<Periodic>> = (self.motion.change.iter())
                .map(|row| rows.iter().map(|(slot, _)| row[*slot].clone()).collect())
                .collect();
            for (variable, sum) in product(&used, &column).into_iter().enumerate() {
                if 2.0 * sum[0].size() <= least / grid.times() as f64 {
                    continue;
                }
                for (at, c) in grid.harmonics(&sum[0]).into_iter().enumerate() {
                    join([k.clone(), grid.multiples(at)].concat(), variable, c * 2.0);
                }
            }
        }
        let counts = |amplitudes: &[Complex<f64>]| amplitudes.iter().any(|c| c.norm() > least);
        let kept = sums.into_iter().filter(|(_, amplitudes)| counts(amplitudes));
        Ok(kept.map(|(multiples, amplitudes)| Harmonic { multiples, amplitudes }).collect())
    }

    /// Refuses modes that are no centres.
    fn centres(&self) -> Result<(), Error> {
        let exponents = &self.motion.exponents;
        let found = exponents.iter().filter(|exponent| matches!(exponent, Exponent::Centre(_))).count();
        if found == exponents.len() {
            return Ok(());
        }
        Err(Error::CountMismatch { what: "centres", found, expected: exponents.len() })
    }
}

/// The image of U at fixed actions of centres: k, and the function before e^{ik·φ}.
fn by_angles(image: &Polynomial<Periodic>, actions: &[f64]) -> Vec<(Vec<i64>, Periodic)> {
    let sizes: Vec<f64> = actions.iter().map(|action| (2.0 * action).sqrt()).collect();
    let mut terms = Vec::new();
    for (monomial, c) in image.terms() {
        // u = (i/2) √(2I) e^{−iφ}, U = √(2I) e^{iφ}
        let mut factor = Complex::new(1.0, 0.0);
        for (mode, size) in sizes.iter().enumerate() {
            let [a, b] = [2 * mode, 2 * mode + 1].map(|slot| monomial.exponent(slot));
            factor *= Complex::new(0.0, 0.5).powu(a) * size.powi((a + b) as i32);
        }
        terms.push((turns(monomial, actions.len()), factor, c));
    }
    terms.sort_by(|a, b| a.0.cmp(&b.0));
    let mut sums: Vec<(Vec<i64>, Periodic)> = Vec::new();
    for group in terms.chunk_by(|a, b| a.0 == b.0) {
        let factors: Vec<_> = group.iter().map(|(_, factor, c)| (*factor, *c)).collect();
        sums.push((group[0].0.clone(), Periodic::combined(&factors)));
    }
    sums
}
