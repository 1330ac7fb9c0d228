//! The motion at fixed actions as a Fourier series in the proper angles and the driven phases.

use num_complex::Complex;
use num_traits::Zero;

use super::form::DrivenForm;
use super::images::{ImageGroup, ImageTerm};
use super::rows::row::{Periodic, product};
use crate::birkhoff::map::check;
use crate::error::Error;

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
        let moduli = moduli(actions);
        let largest = 2.0 * self.motion.change.iter().flatten().map(Periodic::size).fold(0.0, f64::max);
        // All terms that are left out add at most `least`.
        let negligible = least / (largest * self.images.terms().count() as f64);
        let mut harmonics = Vec::new();
        for group in &self.images.0 {
            let (mut sum, mut kept) = (0.0, Vec::new());
            for term in &group.terms {
                let modulus = term.modulus(&moduli);
                let bound = term.size * modulus;
                sum += bound;
                if bound > negligible {
                    kept.push((modulus, term));
                }
            }
            let still = group.multiples.iter().all(|&k| k == 0);
            if still || sum * largest > least {
                let mut functions = self.functions(&kept);
                if still {
                    functions.iter_mut().zip(&self.motion.origin).for_each(|(function, x)| *function += x);
                }
                self.add_harmonics(group, &functions, least, &mut harmonics);
            }
        }
        Ok(harmonics)
    }

    /// The functions before e^{ik·φ} of the variables, of terms with the moduli of their powers. The part with −k is Re(f e^{−ik·φ}) = Re(f̄ e^{ik·φ}).
    fn functions(&self, terms: &[(f64, &ImageTerm)]) -> Vec<Periodic> {
        let variables = self.motion.origin.len();
        let mut functions = vec![Periodic::zero(); variables];
        for opposite in [false, true] {
            let mut by_slot: Vec<Vec<(Complex<f64>, &Periodic)>> = vec![Vec::new(); variables];
            for (modulus, term) in terms.iter().filter(|(_, term)| term.opposite == opposite) {
                let turns: u32 = (0..variables).step_by(2).map(|slot| term.monomial.exponent(slot)).sum();
                by_slot[term.slot].push((2.0 * modulus * Complex::i().powu(turns), &term.coefficient));
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

    /// The largest moduli that a U of modulus 1 has in q₁, p₁, …: a row for each mode, which is a centre.
    ///
    /// # Errors
    /// - a mode that is no centre: [`Error::CountMismatch`].
    pub fn gains(&self) -> Result<Vec<Vec<f64>>, Error> {
        self.centres()?;
        // A variable is the real part of 2 P U.
        let gain = |mode: usize| self.motion.change.iter().map(|row| 2.0 * row[2 * mode + 1].size()).collect();
        Ok((0..self.motion.modes.len()).map(gain).collect())
    }

    /// The size of what the terms of each order add to q₁, p₁, … at fixed actions: a row for each order. The moduli of terms with equal multiples of the proper angles are
    /// added, and the size is the root of the sum of the squares of these sums.
    ///
    /// # Errors
    /// - another number of actions, or a mode that is no centre: [`Error::CountMismatch`].
    pub fn sizes(&self, actions: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        check("actions", actions, self.motion.modes.len())?;
        let (moduli, gains) = (moduli(actions), self.gains()?);
        let modes = moduli.len() / 2;
        let mut squares = vec![vec![0.0; modes]; self.order() + 1];
        for group in &self.images.0 {
            let mut sums = vec![vec![[0.0; 2]; modes]; self.order() + 1];
            for term in &group.terms {
                sums[term.order()][term.slot / 2][usize::from(term.opposite)] += term.size * term.modulus(&moduli);
            }
            for (square, sum) in squares.iter_mut().flatten().zip(sums.iter().flatten()) {
                *square += sum[0] * sum[0] + sum[1] * sum[1];
            }
        }
        let of = |squares: &[f64], variable: usize| {
            let terms = squares.iter().zip(&gains).map(|(square, gain)| square * gain[variable] * gain[variable]);
            terms.sum::<f64>().sqrt()
        };
        Ok(squares.iter().map(|squares| (0..moduli.len()).map(|variable| of(squares, variable)).collect()).collect())
    }

    /// Refuses modes that are no centres.
    fn centres(&self) -> Result<(), Error> {
        let (found, expected) =
            (self.motion.modes.iter().filter(|mode| mode.is_elliptic()).count(), self.motion.modes.len());
        if found == expected { Ok(()) } else { Err(Error::CountMismatch { what: "centres", found, expected }) }
    }
}

/// The moduli of u = (i/2) √(2I) e^{−iφ} and U = √(2I) e^{iφ} of each mode.
fn moduli(actions: &[f64]) -> Vec<f64> {
    actions.iter().map(|action| (2.0 * action).sqrt()).flat_map(|size| [size / 2.0, size]).collect()
}
