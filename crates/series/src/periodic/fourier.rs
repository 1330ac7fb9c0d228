//! The motion at fixed actions as a Fourier series in the proper angles and the driven phases.

use std::collections::BTreeMap;

use num_complex::Complex;
use num_traits::Zero;

use super::divisors::turns;
use super::form::DrivenForm;
use super::grid::Grid;
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

/// Harmonics by the multiples k of the proper angles, the first that is not 0 positive: those of each variable, in the order of the grid.
struct Sums<'a> {
    grid: &'a Grid,
    variables: usize,
    by_angle: BTreeMap<Vec<i64>, Vec<Complex<f64>>>,
}

impl Sums<'_> {
    /// Adds Re(factor · f(M) e^{ik·φ}) to a variable.
    fn add(&mut self, k: &[i64], variable: usize, function: &Periodic, factor: f64) {
        let negative = k.iter().find(|&&k| k != 0).is_some_and(|&k| k < 0);
        let key = if negative { k.iter().map(|k| -k).collect() } else { k.to_vec() };
        let (grid, times) = (self.grid, self.grid.times());
        let all = self.by_angle.entry(key).or_insert_with(|| vec![Complex::zero(); self.variables * times]);
        let own = &mut all[variable * times..][..times];
        for (at, c) in grid.harmonics(function).into_iter().enumerate() {
            match negative {
                true => own[grid.opposite(at)] += c.conj() * factor,
                false => own[at] += c * factor,
            }
        }
    }

    /// The harmonics of which an amplitude is above `least`.
    fn harmonics(self, least: f64) -> Vec<Harmonic> {
        let (grid, times) = (self.grid, self.grid.times());
        let multiples: Vec<Vec<i64>> = (0..times).map(|at| grid.multiples(at)).collect();
        let negative = |at: usize| multiples[at].iter().find(|&&j| j != 0).is_some_and(|&j| j < 0);
        let mut kept = Vec::new();
        for (k, all) in self.by_angle {
            let still = k.iter().all(|&k| k == 0);
            for at in (0..times).filter(|&at| !still || !negative(at)) {
                // Without a proper angle j and −j are one harmonic.
                let other = |own: &[Complex<f64>]| {
                    if still && at != 0 { own[grid.opposite(at)].conj() } else { Complex::zero() }
                };
                let amplitudes: Vec<_> = all.chunks(times).map(|own| own[at] + other(own)).collect();
                if amplitudes.iter().any(|c| c.norm() > least) {
                    kept.push(Harmonic { multiples: [&k[..], &multiples[at]].concat(), amplitudes });
                }
            }
        }
        kept
    }
}

impl DrivenForm {
    /// The state as a Fourier series in the proper angles and the driven phases, at fixed actions of centres. Harmonics whose amplitudes are all at most `least` are left out.
    ///
    /// # Errors
    /// - the errors of [`frequencies`](Self::frequencies); a mode that is no centre: [`Error::CountMismatch`].
    pub fn fourier(&self, actions: &[f64], least: f64) -> Result<Vec<Harmonic>, Error> {
        self.frequencies(actions)?;
        self.centres()?;
        let mut sums = Sums { grid: self.grid(), variables: self.motion.origin.len(), by_angle: BTreeMap::new() };
        for (variable, x) in self.motion.origin.iter().enumerate() {
            sums.add(&vec![0; actions.len()], variable, x, 1.0);
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
                if 2.0 * sum[0].size() > least / self.grid().times() as f64 {
                    sums.add(&k, variable, &sum[0], 2.0);
                }
            }
        }
        Ok(sums.harmonics(least))
    }

    /// Refuses modes that are no centres.
    fn centres(&self) -> Result<(), Error> {
        let (found, expected) =
            (self.motion.modes.iter().filter(|mode| mode.is_elliptic()).count(), self.motion.modes.len());
        if found == expected { Ok(()) } else { Err(Error::CountMismatch { what: "centres", found, expected }) }
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
