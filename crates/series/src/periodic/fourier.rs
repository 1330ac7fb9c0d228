//! The motion at fixed actions as a Fourier series in the proper angles and the driven phases.

use num_complex::Complex;
use num_traits::Zero;

use super::form::DrivenForm;
use super::images::{ImageGroup, ImageTerm, Powers, at_angles_0};
use super::row::{Periodic, product};
use crate::error::Error;

/// One harmonic of a motion: each variable is the sum of Re(amplitude · e^{i(k·φ + j·M)}).
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonic {
    /// The integers k of the proper angles, then those j of the driven phases. The first that is not 0 is positive.
    pub multiples: Vec<i64>,
    /// The amplitudes of q₁, p₁, q₂, p₂, …
    pub amplitudes: Vec<Complex<f64>>,
}

/// A motion at fixed actions.
#[derive(Clone, Debug)]
pub struct FourierSeries {
    /// The harmonics.
    pub harmonics: Vec<Harmonic>,
    /// By order 0, 1, … of the form, a bound of what its terms add to q₁, p₁, q₂, p₂, …
    pub orders: Vec<Vec<f64>>,
}

impl DrivenForm {
    /// The state as a Fourier series in the proper angles and the driven phases, at fixed actions of centres. Harmonics whose amplitudes are all at most `least` are left out.
    ///
    /// # Errors
    /// - the errors of [`frequencies`](Self::frequencies); a mode that is no centre: [`Error::CountMismatch`].
    pub fn fourier(&self, actions: &[f64], least: f64) -> Result<FourierSeries, Error> {
        self.frequencies(actions)?;
        self.centres()?;
        let variables = self.motion.origin.len();
        let point = at_angles_0(actions);
        let moduli = Powers::new(&point.iter().map(|c| c.norm()).collect::<Vec<_>>(), self.order() + 1);
        let turned = Powers::new(&point, self.order() + 1);
        let seen: Vec<Vec<f64>> =
            (0..variables).map(|slot| self.motion.change.iter().map(|row| 2.0 * row[slot].size()).collect()).collect();
        let largest = seen.iter().flatten().copied().fold(0.0, f64::max);
        // All terms that are left out add less than `least`.
        let negligible = least / (largest * self.images.terms().count() as f64);
        let mut orders = vec![vec![0.0; variables]; self.order() + 1];
        let mut harmonics = Vec::new();
        let mut still = self.motion.origin.clone();
        for group in &self.images.0 {
            let (mut sum, mut kept) = (0.0, Vec::new());
            for term in &group.terms {
                let bound = term.bound(&moduli);
                sum += bound;
                orders[term.order].iter_mut().zip(&seen[term.slot]).for_each(|(all, seen)| *all += bound * seen);
                if bound > negligible {
                    kept.push((turned.of(term.monomial), term));
                }
            }
            let unturned = group.multiples.iter().all(|&k| k == 0);
            if unturned || sum * largest > least {
                let mut functions = self.functions(&kept);
                if unturned {
                    still.iter_mut().zip(&functions).for_each(|(still, function)| *still += function);
                    functions.clone_from(&still);
                }
                self.add_harmonics(group, &functions, least, &mut harmonics);
            }
        }
        Ok(FourierSeries { harmonics, orders })
    }

    /// The functions before e^{ik·φ} of the variables, of terms with their values at the angles 0. The part with −k is Re(f e^{−ik·φ}) = Re(f̄ e^{ik·φ}).
    fn functions(&self, terms: &[(Complex<f64>, &ImageTerm)]) -> Vec<Periodic> {
        let variables = self.motion.origin.len();
        let mut functions = vec![Periodic::zero(); variables];
        for opposite in [false, true] {
            let mut by_slot: Vec<Vec<(Complex<f64>, &Periodic)>> = vec![Vec::new(); variables];
            for (value, term) in terms.iter().filter(|(_, term)| term.opposite == opposite) {
                by_slot[term.slot].push((2.0 * value, &term.coefficient));
            }
            let used: Vec<usize> = (0..variables).filter(|&slot| !by_slot[slot].is_empty()).collect();
            if used.is_empty() {
                continue;
            }
            let column: Vec<_> = used.iter().map(|&slot| vec![Periodic::combined(&by_slot[slot])]).collect();
            let change: Vec<Vec<Periodic>> =
                self.motion.change.iter().map(|row| used.iter().map(|&slot| row[slot].clone()).collect()).collect();
            for (function, sum) in functions.iter_mut().zip(product(&change, &column)) {
                *function += &if opposite { sum[0].each(|c| c.conj()) } else { sum[0].clone() };
            }
        }
        functions
    }

    /// Appends the harmonics of which an amplitude is above `least`.
    fn add_harmonics(&self, group: &ImageGroup, functions: &[Periodic], least: f64, kept: &mut Vec<Harmonic>) {
        let grid = self.grid();
        let all: Vec<Vec<Complex<f64>>> = functions.iter().map(|function| grid.harmonics(function)).collect();
        let still = group.multiples.iter().all(|&k| k == 0);
        for at in 0..grid.times() {
            let opposite = if still { grid.opposite(at) } else { at };
            let amplitude = |own: &Vec<Complex<f64>>| match still && opposite != at {
                // Without a proper angle j and −j are one harmonic.
                true => own[at] + own[opposite].conj(),
                false => own[at],
            };
            if all.iter().all(|own| amplitude(own).norm_sqr() <= least * least) {
                continue;
            }
            let multiples = grid.multiples(at);
            if !still || multiples.iter().find(|&&j| j != 0).is_none_or(|&j| j > 0) {
                let multiples = [&group.multiples[..], &multiples].concat();
                kept.push(Harmonic { multiples, amplitudes: all.iter().map(amplitude).collect() });
            }
        }
    }

    /// Refuses modes that are no centres.
    fn centres(&self) -> Result<(), Error> {
        let (found, expected) =
            (self.motion.modes.iter().filter(|mode| mode.is_elliptic()).count(), self.motion.modes.len());
        if found == expected { Ok(()) } else { Err(Error::CountMismatch { what: "centres", found, expected }) }
    }
}
