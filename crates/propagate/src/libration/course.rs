//! The motion of one state by a normal form: proper actions and angles, and a Fourier series.

use std::cmp::Reverse;

use andoyer_series::Error;
use andoyer_series::periodic::{DrivenForm, Harmonic};
use num_complex::Complex;

use super::lock::Lock;

/// Most powers of a phase, 0 among them.
pub(crate) const MOST_POWERS: usize = 33;

/// A motion as a Fourier series in three proper angles, the mean anomaly M and the angle α.
#[derive(Clone, Debug)]
pub(crate) struct FourierMotion {
    /// Rates of the proper angles, in units of n.
    pub(crate) frequencies: [f64; 3],
    /// The proper angles at the epoch.
    pub(crate) angles: [f64; 3],
    /// M and α at the epoch, and their rates.
    start: [f64; 2],
    rates: [f64; 2],
    /// Of ψ, p_ψ − C W₃, θ, p_θ, φ, p_φ; the multiples are those of the proper angles, of M and of α.
    pub(crate) harmonics: Vec<Harmonic>,
}

impl FourierMotion {
    /// The motion of the normal variables of a lock at the epoch. Harmonics whose amplitudes are all at most `least` are left out.
    ///
    /// # Errors
    /// Those of the form: a state beyond the range of the series can overflow.
    pub(crate) fn new(form: &DrivenForm, lock: &Lock, normal: &[f64], least: f64) -> Result<Self, Error> {
        let actions = form.actions_of(normal);
        let three = |values: &[f64]| [values[0], values[1], values[2]];
        Ok(Self {
            frequencies: three(&form.frequencies(&actions)?),
            angles: three(&form.angles_of(normal)),
            start: lock.start,
            rates: [1.0, lock.shape.precession.phase_rate],
            harmonics: harmonics(form.fourier(&actions, least)?, lock),
        })
    }

    /// Leaves out the smallest harmonics, which together are at most `least`, and those with too high multiples; returns the sum of all.
    pub(crate) fn drop_below(&mut self, least: f64) -> f64 {
        let size = |harmonic: &Harmonic| harmonic.amplitudes.iter().map(|c| c.norm_sqr().sqrt()).sum::<f64>();
        // The bits of positive numbers are in the order of the numbers.
        self.harmonics.sort_by_cached_key(|harmonic| Reverse(size(harmonic).to_bits()));
        let mut dropped = 0.0;
        while let Some(last) = self.harmonics.last().map(size).filter(|last| dropped + last <= least) {
            dropped += last;
            self.harmonics.pop();
        }
        let fits = |all: &[i64]| all.iter().all(|k| k.unsigned_abs() < MOST_POWERS as u64);
        let (kept, beyond) =
            std::mem::take(&mut self.harmonics).into_iter().partition(|harmonic: &Harmonic| fits(&harmonic.multiples));
        self.harmonics = kept;
        dropped += beyond.iter().map(size).sum::<f64>();
        self.harmonics.sort_by(|a, b| a.multiples.cmp(&b.multiples));
        dropped
    }

    /// The largest sum of amplitudes of an angle \[rad\].
    pub(crate) fn angle(&self) -> f64 {
        let of = |angle: usize| self.harmonics.iter().map(|harmonic| harmonic.amplitudes[angle].norm()).sum::<f64>();
        [0, 2, 4].map(of).into_iter().fold(0.0, f64::max)
    }

    /// The multiples with the smallest rate, in units of n, of those with at most four proper frequencies, which are those of `linear`: a proper frequency itself does not count.
    pub(crate) fn smallest_divisor(&self, linear: &Self) -> (Vec<i64>, f64) {
        let proper = |all: &[i64]| all[..3].iter().map(|k| k.abs()).sum::<i64>();
        let low = self.harmonics.iter().map(|harmonic| &harmonic.multiples);
        let low = low.filter(|all| (1..=4).contains(&proper(all)) && (proper(all) > 1 || all[3..] != [0, 0]));
        let rates = low.map(|all| (all.clone(), linear.rate(all).abs()));
        rates.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((Vec::new(), f64::INFINITY))
    }

    /// The rate of a harmonic, in units of n.
    pub(crate) fn rate(&self, multiples: &[i64]) -> f64 {
        let rates = self.frequencies.iter().chain(&self.rates);
        multiples.iter().zip(rates).map(|(&k, rate)| k as f64 * rate).sum()
    }

    /// The phase of a harmonic a time after the epoch, in units of 1/n.
    pub(crate) fn phase(&self, multiples: &[i64], elapsed: f64) -> f64 {
        let starts = self.angles.iter().chain(&self.start);
        let start: f64 = multiples.iter().zip(starts).map(|(&k, angle)| k as f64 * angle).sum();
        start + self.rate(multiples) * elapsed
    }

    /// M and α a time after the epoch, in units of 1/n.
    pub(crate) fn orbit_phases(&self, elapsed: f64) -> [f64; 2] {
        [0, 1].map(|phase| self.start[phase] + self.rates[phase] * elapsed)
    }

    /// The variables and their rates at even times after the epoch, in units of 1/n.
    pub(crate) fn at_even_times(&self, start: f64, step: f64, count: usize) -> Vec<[[f64; 6]; 2]> {
        let mut sums = vec![[[0.0; 6]; 2]; count];
        for Harmonic { multiples, amplitudes } in &self.harmonics {
            let rate = self.rate(multiples);
            let (mut turn, further) = (Complex::cis(self.phase(multiples, start)), Complex::cis(rate * step));
            for [values, rates] in &mut sums {
                for ((value, slope), amplitude) in values.iter_mut().zip(rates).zip(amplitudes) {
                    let term = amplitude * turn;
                    *value += term.re;
                    *slope -= term.im * rate;
                }
                turn *= further;
            }
        }
        sums
    }
}

/// Harmonics with the multiples of M and α.
fn harmonics(mut harmonics: Vec<Harmonic>, lock: &Lock) -> Vec<Harmonic> {
    for harmonic in &mut harmonics {
        let (phases, angle) = lock.shape.multiples(&harmonic.multiples[3..]);
        harmonic.multiples.truncate(3);
        harmonic.multiples.extend(phases);
        harmonic.amplitudes.iter_mut().for_each(|amplitude| *amplitude *= Complex::cis(-angle));
    }
    harmonics
}
