//! Where no averaging holds: a term e^(i(hℓ′+my′)) whose frequency Ω is near a multiple of the mean motion that the disturbing body has (theory §9).
//!
//! Below [`SMALLEST_RATIO`] times the fastest angular rate of twice the true anomaly, a term is not corrected at all. Above it the sum for G takes all of it but the
//! harmonics of the mean anomaly that are too high for its powers of d/dt: their amplitude falls like e^(−|j|(arcosh 1/e − η)), as Hansen's coefficients do. Either leaves the attitude
//! its rate over the time that it acts in one sense, the span or 2/|Ω − jn|, and lets the phases drift by what it does to σ and, for m ≠ 0, to M. That is an
//! estimate from above; what is not larger than second order becomes part of the error, and the rest is [`Error::Resonance`].

use std::f64::consts::PI;

use super::candidate::{Candidate, SMALLEST_RATIO};
use super::response::Response;
use crate::error::Error;

/// Orbital harmonics that a slow term is held against, from −3 to 3.
const SLOW_HARMONICS: i32 = 3;
/// How much more than second order may be left.
const MARGIN: f64 = 10.0;
/// Largest prefactor of Hansen's coefficients beside their exponential, over their value at the pericentre.
const PREFACTOR: f64 = 1.0;

/// Frequencies of a mean motion against those of the orbit.
pub(super) struct Commensurability<'a> {
    pub(super) response: &'a Response,
    pub(super) mean_motion: f64,
    pub(super) eccentricity: f64,
    /// Of twice the true anomaly.
    pub(super) fastest: f64,
    pub(super) duration: f64,
}

impl Commensurability<'_> {
    /// What the terms together leave \[rad\].
    ///
    /// # Errors
    /// - [`Error::Resonance`] if that is more than some times what is `allowed`; it names the largest.
    pub(super) fn left(&self, terms: &[Candidate], allowed: f64) -> Result<f64, Error> {
        let effects = terms.iter().map(|term| (self.effect(term), term));
        let (mut sum, mut largest) = (0.0, None::<(f64, &Candidate)>);
        for (effect, term) in effects {
            sum += effect;
            // Of two that are as large as can be, the one nearer to the commensurability.
            let nearer = |other: &Candidate| self.slow_distance(term) < self.slow_distance(other);
            if largest.is_none_or(|(most, other)| effect > most || (effect == most && nearer(other))) {
                largest = Some((effect, term));
            }
        }
        match largest {
            Some((_, term)) if sum > MARGIN * allowed => Err(Error::Resonance {
                harmonic: term.harmonic,
                multiple: term.multiple,
                divisor: 2.0 * term.frequency.abs() / self.fastest,
                bound: 2.0 * SMALLEST_RATIO,
            }),
            _ => Ok(sum),
        }
    }

    /// What a term leaves over the span \[rad\], π at most.
    fn effect(&self, term: &Candidate) -> f64 {
        if term.frequency.abs() > SMALLEST_RATIO * self.fastest {
            let (amplitude, distance) = self.beyond_the_sum(term);
            self.turned(term, amplitude, distance)
        } else {
            self.turned(term, 1.0, self.slow_distance(term))
        }
    }

    /// What a term turns the attitude by over the span \[rad\] if it is not corrected at all, π at most.
    pub(super) fn whole(&self, term: &Candidate) -> f64 {
        self.turned(term, 1.0, self.slow_distance(term))
    }

    /// What a part of a term turns the attitude by, at its distance from a commensurability.
    fn turned(&self, term: &Candidate, amplitude: f64, distance: f64) -> f64 {
        let time = if distance * self.duration > 2.0 { 2.0 / distance } else { self.duration };
        (amplitude * term.rate * time * self.response.growth(term.multiple, self.duration)).min(PI)
    }

    /// How far Ω is from a low multiple of the mean motion.
    fn slow_distance(&self, term: &Candidate) -> f64 {
        let multiples = -SLOW_HARMONICS..=SLOW_HARMONICS;
        multiples.map(|j| (term.frequency - f64::from(j) * self.mean_motion).abs()).fold(f64::INFINITY, f64::min)
    }

    /// Amplitude of the nearest harmonic that the sum for G does not see, and the distance to it.
    fn beyond_the_sum(&self, term: &Candidate) -> (f64, f64) {
        if self.eccentricity == 0.0 {
            return (0.0, term.frequency.abs());
        }
        let multiple = (term.frequency / self.mean_motion).round();
        let eta = ((1.0 - self.eccentricity) * (1.0 + self.eccentricity)).sqrt();
        let decay = (1.0 / self.eccentricity).acosh() - eta;
        let amplitude = PREFACTOR * (-multiple.abs() * decay).exp();
        (amplitude, (term.frequency - multiple * self.mean_motion).abs())
    }
}
