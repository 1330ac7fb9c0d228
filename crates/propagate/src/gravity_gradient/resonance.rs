//! Resonances, where averaging is not valid: terms e^(i(hℓ′+my′)) whose frequency Ω is near a multiple of the mean motion of the disturbing body (theory §9).
//!
//! A term with Ω below [`SMALLEST_RATIO`] times the largest rate of twice the true anomaly is not corrected. For larger Ω the sum for G contains the whole term
//! except the harmonics of the mean anomaly that are too high for its powers of d/dt. Their amplitude falls like e^(−|j|(arcosh 1/e − η)), as Hansen's
//! coefficients do. In both cases the attitude error is the rate of the term times the time during which it acts in one direction, which is the span or 2/|Ω −
//! jn|. In addition the phases drift, because the term changes σ and, for m ≠ 0, M. This is an upper estimate. If it is not larger than the second-order error,
//! it becomes part of the error bound; otherwise it is [`Error::Resonance`].

use std::f64::consts::PI;

use super::candidate::{Candidate, SMALLEST_RATIO};
use super::response::Response;
use crate::error::Error;

/// Harmonics of the orbit, from −3 to 3, with which the frequency of a slow term is compared.
const SLOW_HARMONICS: i32 = 3;
/// Largest error of the resonant terms over that of second order.
const MARGIN: f64 = 10.0;
/// Largest prefactor of Hansen's coefficients, apart from their exponential, over their value at the pericentre.
const PREFACTOR: f64 = 1.0;

/// The frequencies of a mean motion and of its orbit.
pub(super) struct Commensurability<'a> {
    pub(super) response: &'a Response,
    pub(super) mean_motion: f64,
    pub(super) eccentricity: f64,
    /// Largest change of the frequencies of the torque by the rates of node and pericentre.
    pub(super) turning: f64,
    /// Largest rate of twice the true anomaly.
    pub(super) fastest: f64,
    pub(super) duration: f64,
}

impl Commensurability<'_> {
    /// The attitude error of all terms together \[rad\].
    ///
    /// # Errors
    /// - [`Error::Resonance`] if the error exceeds `allowed` by more than a factor [`MARGIN`]. It names the largest term.
    pub(super) fn left(&self, terms: &[Candidate], allowed: f64) -> Result<f64, Error> {
        let effects = terms.iter().map(|term| (self.effect(term), term));
        let (mut sum, mut largest) = (0.0, None::<(f64, &Candidate)>);
        for (effect, term) in effects {
            sum += effect;
            // Of two terms with the same largest effect, the one nearer to the commensurability is named.
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

    /// The attitude error of a term over the span \[rad\], at most π.
    fn effect(&self, term: &Candidate) -> f64 {
        if term.frequency.abs() > SMALLEST_RATIO * self.fastest {
            let (amplitude, distance) = self.beyond_the_sum(term);
            self.turned(term, amplitude, distance)
        } else {
            self.turned(term, 1.0, self.slow_distance(term))
        }
    }

    /// The attitude error over the span if the term is not corrected at all \[rad\], at most π.
    pub(super) fn whole(&self, term: &Candidate) -> f64 {
        self.turned(term, 1.0, self.slow_distance(term))
    }

    /// The attitude error of a part of a term at its distance from a commensurability.
    fn turned(&self, term: &Candidate, amplitude: f64, distance: f64) -> f64 {
        let distance = (distance - self.turning).max(0.0);
        let time = if distance * self.duration > 2.0 { 2.0 / distance } else { self.duration };
        (amplitude * term.rate * time * self.response.growth(term.multiple, self.duration)).min(PI)
    }

    /// The distance of Ω from the nearest low multiple of the mean motion.
    fn slow_distance(&self, term: &Candidate) -> f64 {
        let multiples = -SLOW_HARMONICS..=SLOW_HARMONICS;
        multiples.map(|j| (term.frequency - f64::from(j) * self.mean_motion).abs()).fold(f64::INFINITY, f64::min)
    }

    /// The amplitude of the nearest harmonic that the sum for G does not contain, and the distance of Ω from it.
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
