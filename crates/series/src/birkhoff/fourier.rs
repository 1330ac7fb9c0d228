//! The motion at fixed actions as a Fourier series.
//!
//! At the action I and the angle φ of a centre U = √(2rI) e^{iφ} and u = i √(I/(2r)) e^{−iφ}, so a term of the direct transformation is a number times
//! e^{i(k·φ + j·M)}. Terms with equal k and j are added once for a motion; a sample then costs one product for each harmonic.

use super::BirkhoffMap;
use super::flow::actions;
use super::map::check;
use super::matrix::dot;
use super::mode::Mode;
use crate::error::Error;
use crate::harmonics;
use crate::monomial::{Monomial, SLOTS};
use num_complex::Complex;
use std::collections::BTreeMap;

/// One harmonic of a motion: each variable is the sum of Re(amplitude · e^{i(k·φ + j·M)}).
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonic {
    /// The integers k of the proper angles, then those j of the driven phases. The first that is not 0 is positive.
    pub multiples: Vec<i64>,
    /// The amplitudes of q₁, p₁, q₂, p₂, …
    pub amplitudes: Vec<Complex<f64>>,
}

impl BirkhoffMap {
    /// The state as a Fourier series in the proper angles φ and the driven phases M, at fixed actions. All modes must be centres; φ grows with
    /// [`frequencies`](Self::frequencies), and [`angles`](Self::angles) has its value.
    ///
    /// ```
    /// use andoyer_series::{BirkhoffMap, PhaseSpace, normalize};
    /// let space = PhaseSpace::new(&[("q", "p")])?;
    /// let pendulum = space.parse::<f64>("p^2/2 + q^2/2 - q^4/24")?;
    /// let map = BirkhoffMap::new(&normalize(&pendulum, 2, &space)?, &[])?;
    /// // The third harmonic of a pendulum with the amplitude a is a³/192 sin 3φ, and a² = 2 I.
    /// let third = map.fourier(&[0.005])?.into_iter().find(|harmonic| harmonic.multiples == [3]);
    /// assert!(third.is_some_and(|third| (third.amplitudes[0].norm() - 0.1_f64.powi(3) / 192.0).abs() < 1e-18));
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    ///
    /// # Errors
    /// - the errors of [`frequencies`](Self::frequencies); a mode that is no centre: [`Error::CountMismatch`].
    pub fn fourier(&self, actions: &[f64]) -> Result<Vec<Harmonic>, Error> {
        self.frequencies(actions)?;
        let ratios = self.ratios()?;
        let mut normal: BTreeMap<Vec<i64>, Vec<Complex<f64>>> = BTreeMap::new();
        for (mode, ratio) in ratios.iter().enumerate() {
            for (multiples, c) in self.image_at(mode, &ratios, actions) {
                // q = Im U = Re(−i U) and p = Re U/r.
                let parts = [Complex::new(c.im, -c.re), c / ratio];
                let sign = multiples.iter().find(|&&k| k != 0).map_or(1, |k| k.signum());
                let multiples = multiples[..ratios.len() + self.driven_phases()].iter().map(|k| i64::from(sign * k));
                let sums =
                    normal.entry(multiples.collect()).or_insert_with(|| vec![Complex::default(); 2 * ratios.len()]);
                for (sum, part) in sums[2 * mode..].iter_mut().zip(parts) {
                    *sum += if sign < 0 { part.conj() } else { part };
                }
            }
        }
        let old = |normal: &[Complex<f64>]| {
            let (re, im): (Vec<f64>, Vec<f64>) = normal.iter().map(|c| (c.re, c.im)).unzip();
            self.linear_change().iter().map(|row| Complex::new(dot(row, &re), dot(row, &im))).collect()
        };
        Ok(normal.into_iter().map(|(multiples, c)| Harmonic { multiples, amplitudes: old(&c) }).collect())
    }

    /// The actions of normal coordinates.
    ///
    /// # Errors
    /// - another number of coordinates: [`Error::CountMismatch`].
    pub fn actions_of(&self, normal: &[f64]) -> Result<Vec<f64>, Error> {
        check("normal", normal, 2 * self.modes().len())?;
        Ok(actions(self.modes(), normal))
    }

    /// The proper angles φ of normal coordinates, all of whose modes are centres: U = √(2rI) e^{iφ} = r p + i q.
    ///
    /// # Errors
    /// - another number of coordinates, or a mode that is no centre: [`Error::CountMismatch`].
    pub fn angles(&self, normal: &[f64]) -> Result<Vec<f64>, Error> {
        let ratios = self.ratios()?;
        check("normal", normal, 2 * ratios.len())?;
        Ok(normal.chunks(2).zip(&ratios).map(|(pair, ratio)| pair[0].atan2(ratio * pair[1])).collect())
    }

    /// The ratios r of the modes.
    fn ratios(&self) -> Result<Vec<f64>, Error> {
        let ratio = |mode: &Mode<f64>| if let Mode::Elliptic { ratio, .. } = mode { Some(*ratio) } else { None };
        let ratios: Vec<f64> = self.modes().iter().filter_map(ratio).collect();
        match ratios.len() {
            found if found == self.modes().len() => Ok(ratios),
            found => Err(Error::CountMismatch { what: "centres", found, expected: self.modes().len() }),
        }
    }

    /// The image of U of a mode at fixed actions: k and j, and the number before e^{i(k·φ + j·M)}; equal ones are added in the order of the terms.
    fn image_at(&self, mode: usize, ratios: &[f64], actions: &[f64]) -> Vec<([i32; SLOTS], Complex<f64>)> {
        let (terms, driven) = self.direct_terms(mode);
        // The powers of u = i Ū/(2r) and of U of each mode, as far as they occur, without e^{ikφ}.
        let powers: Vec<[Vec<Complex<f64>>; 2]> = ratios
            .iter()
            .zip(actions)
            .enumerate()
            .map(|(pair, (ratio, action))| {
                let size = (2.0 * ratio * action).sqrt();
                [Complex::new(0.0, 0.5 * size / ratio), size.into()].map(|value: Complex<f64>| {
                    let most = terms.iter().map(|(monomial, _)| monomial.degree_in(&[2 * pair, 2 * pair + 1]));
                    (0..=most.max().unwrap_or(0) as i32).map(|k| value.powi(k)).collect()
                })
            })
            .collect();
        let image = |&(monomial, c): &(Monomial, Complex<f64>)| {
            let (mut multiples, mut product) = ([0; SLOTS], c);
            for (pair, [u, conjugate]) in powers.iter().enumerate() {
                let [a, b] = [monomial.exponent(2 * pair), monomial.exponent(2 * pair + 1)];
                product *= u[a as usize] * conjugate[b as usize];
                multiples[pair] = b as i32 - a as i32;
            }
            for (j, slot) in multiples[ratios.len()..][..self.driven_phases()].iter_mut().zip(driven..) {
                *j = harmonics::signed(monomial.exponent(slot)) as i32;
            }
            (multiples, product)
        };
        let mut images: Vec<_> = terms.iter().map(image).collect();
        images.sort_by_key(|(multiples, _)| *multiples);
        images.dedup_by(|(next, c), (multiples, sum)| {
            let same = next == multiples;
            *sum += if same { *c } else { Complex::default() };
            same
        });
        images
    }
}
