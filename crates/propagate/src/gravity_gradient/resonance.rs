//! Resonances, where averaging is not valid: terms e^(i(hℓ′+my′)) whose frequency Ω is near a multiple of the mean motion of the disturbing body (theory §9).
//!
//! A term with |Ω| at most [`SLOW_RATIO`] times the largest rate of twice the true anomaly is slow. It is corrected with exact divisors if the orbit has a
//! series and the change is small, otherwise not at all ([`super::selection`]). For a faster term the sum for G contains the whole term except the harmonics of
//! the mean anomaly that are too high for its powers of d/dt. Their amplitude falls like e^(−|j|(arcosh 1/e − η)), as Hansen's coefficients do. A term with
//! exact divisors contains all harmonics, except the one nearest to resonance if that is not corrected.
//!
//! The attitude error of a term or harmonic that is not corrected is its rate times the time during which it acts in one direction, which is the span or
//! 2/|Ω − jn|. In addition the phases drift, because the term changes σ and, for m ≠ 0, M. This is an upper estimate. A part of it
//! ([`UNCORRECTED_SHARE`]) enters the error bound. It is [`Error::Resonance`] if the part by terms that are not corrected exceeds [`REFUSAL_FACTOR`] times
//! the larger of the tolerance and the second-order error, or if the orbit has a series and one term may leave more than [`LARGEST_EFFECT`].

use std::cell::OnceCell;
use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::aspect::Aspect;
use super::candidate::{Candidate, SLOW_RATIO};
use super::divisors::{Divisors, Secular, multiple_of};
use super::envelope::{Envelope, LARGEST_NUMBER, at_most, harmonic};
use super::orbit_series::OrbitSeries;
use super::response::Response;
use crate::error::Error;

/// Harmonics of the orbit, from −3 to 3, with which the frequency of a slow term is compared.
const SLOW_HARMONICS: i32 = 3;
/// A scene is refused if the error by terms that are not corrected exceeds this multiple of the larger of the tolerance and the second-order error.
const REFUSAL_FACTOR: f64 = 10.0;
/// If the orbit has a series, a scene is refused if the upper estimate of the attitude error by one term is larger \[rad\].
const LARGEST_EFFECT: f64 = 0.03;
/// Harmonics on each side of the nearest one that are looked at.
const NEIGHBOURS: i32 = 3;
/// A scene is not refused for an error by a corrected term of at most this \[rad\].
const SERVED: f64 = 1e-3;
/// The error of a term with no or incomplete correction enters the bound with this factor, unless it may be half a turn.
const UNCORRECTED_SHARE: f64 = 0.65;
/// If the upper estimate of the attitude error by a harmonic is at most this, its coefficient is not computed \[rad\].
const NEGLIGIBLE: f64 = 1e-14;

/// The frequencies of a mean motion and of its orbit.
pub(super) struct Commensurability<'a> {
    pub(super) response: &'a Response,
    pub(super) mean_motion: f64,
    pub(super) eccentricity: f64,
    /// Largest change of the frequencies of the torque by the rates of node and pericentre.
    pub(super) turning: f64,
    /// Largest rate of twice the true anomaly.
    pub(super) fastest: f64,
    pub(super) envelope: &'a Envelope,
    pub(super) duration: f64,
    /// The shift of the frequencies by the average torque.
    pub(super) secular: Secular,
    /// The axes of the orbit, and the direction of the angular momentum.
    pub(super) directions: (&'a [Vector3<f64>; 3], &'a Vector3<f64>),
    /// [`Secular::swings`], if a harmonic near resonance has needed them.
    pub(super) swings: OnceCell<[f64; 2]>,
    /// Whether the bound has the whole error of terms that are not corrected.
    pub(super) whole_effects: bool,
    /// The orbit's harmonics, if the mean M and L at the epoch have them with their divisors.
    pub(super) series: Option<&'a OrbitSeries>,
}

/// A harmonic e^(ijl) of the orbit in a term.
pub(super) struct NearHarmonic {
    /// j.
    pub(super) harmonic: i32,
    /// Its size over that of the torque at the pericentre.
    pub(super) amplitude: f64,
    /// Its smallest divisor.
    pub(super) distance: f64,
}

impl Commensurability<'_> {
    /// The attitude error of all terms together \[rad\]. `effects` holds the error by each term, its upper estimate, and whether the term is corrected with all
    /// its harmonics.
    ///
    /// # Errors
    /// - [`Error::Resonance`] if the errors by terms that are not corrected, and errors by corrected terms above [`SERVED`], sum to more than
    ///   [`REFUSAL_FACTOR`] times `allowed`, or if the orbit has a series and the upper estimate of one term exceeds [`LARGEST_EFFECT`]. It names the term with
    ///   the largest upper estimate.
    pub(super) fn total_error<'a>(
        &self,
        effects: impl Iterator<Item = ([f64; 2], bool, &'a Candidate)>,
        allowed: f64,
    ) -> Result<f64, Error> {
        let (mut sum, mut uncorrected, mut largest) = (0.0, 0.0, None::<(f64, &Candidate)>);
        for ([effect, at_most], corrected, term) in effects {
            sum += if corrected || self.whole_effects || effect >= PI { effect } else { UNCORRECTED_SHARE * effect };
            uncorrected += if corrected && effect <= SERVED { 0.0 } else { effect };
            // Of two terms with the same largest effect, the one nearer to the commensurability is named.
            let nearer = |other: &Candidate| self.slow_distance(term) < self.slow_distance(other);
            if largest.is_none_or(|(most, other)| at_most > most || (at_most == most && nearer(other))) {
                largest = Some((at_most, term));
            }
        }
        match largest {
            Some((most, term)) if self.series.is_some() && most > LARGEST_EFFECT => {
                Err(self.resonance(term, most, LARGEST_EFFECT))
            }
            Some((_, term)) if uncorrected > REFUSAL_FACTOR * allowed => {
                Err(self.resonance(term, uncorrected, REFUSAL_FACTOR * allowed))
            }
            _ => Ok(sum),
        }
    }

    fn resonance(&self, term: &Candidate, effect: f64, limit: f64) -> Error {
        Error::Resonance {
            harmonic: term.harmonic,
            multiple: term.multiple,
            divisor: 2.0 * term.frequency.abs() / self.fastest,
            bound: 2.0 * SLOW_RATIO,
            effect,
            limit,
        }
    }

    /// The attitude error of a term that a sum corrects, or none, over the span \[rad\], at most π.
    pub(super) fn effect(&self, term: &Candidate) -> f64 {
        if self.is_slow(term) {
            return self.whole(term);
        }
        let (amplitude, distance) = self.beyond_the_sum(term);
        self.turned(term, amplitude, distance)
    }

    /// The harmonic of the orbit with which a term is nearest to resonance, and those beside it that are near it too, or in a slow term all beside it.
    pub(super) fn near(
        &self,
        term: &Candidate,
        series: &OrbitSeries,
        aspect: &Aspect,
    ) -> (NearHarmonic, Vec<NearHarmonic>) {
        let divisors = self.divisors(term);
        let distance = |j: i32| divisors.smallest(j).abs();
        let about = -multiple_of(self.mean_motion, term.frequency);
        // The shift may make a neighbour the nearest.
        let number = [about, about - 1, about + 1].into_iter().min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        let number = number.unwrap_or(about);
        let harmonic = |j: i32| {
            let amplitude = (aspect.strength(series, j, term.multiple) / self.envelope.span[0]).min(1.0);
            NearHarmonic { harmonic: j, amplitude, distance: distance(j) }
        };
        let beside = (number - NEIGHBOURS..=number + NEIGHBOURS).filter(|j| *j != number);
        let beside = beside.map(harmonic).filter(|near| divisors.slow || near.distance < self.mean_motion);
        (harmonic(number), beside.collect())
    }

    /// The divisors of a term in the orbit's harmonics.
    pub(super) fn divisors(&self, term: &Candidate) -> Divisors {
        let numbers = (term.harmonic, term.multiple);
        Divisors::new(numbers, [term.frequency, self.mean_motion], self.is_slow(term), &self.secular)
    }

    /// Upper estimate of the swing, within an orbit, of a term's phase and factors by the average torque \[rad\].
    pub(super) fn swing(&self, term: &Candidate) -> f64 {
        let elements = [self.eccentricity, self.mean_motion];
        let swings = self.swings.get_or_init(|| self.secular.swings(elements, self.directions));
        self.secular.swing((term.harmonic, term.multiple), *swings)
    }

    /// Whether a term is too slow for a sum over time derivatives.
    pub(super) fn is_slow(&self, term: &Candidate) -> bool {
        term.frequency.abs() <= SLOW_RATIO * self.fastest
    }

    /// The attitude error over the span if the term is not corrected at all \[rad\]: by the low harmonics of the orbit, and by the nearest one above them.
    pub(super) fn whole(&self, term: &Candidate) -> f64 {
        let low = self.turned(term, 1.0, self.slow_distance(term));
        if (term.frequency / self.mean_motion).abs() < f64::from(SLOW_HARMONICS) + 0.5 {
            return low;
        }
        let (amplitude, distance) = self.beyond_the_sum(term);
        low + self.turned(term, amplitude, distance)
    }

    /// The attitude error of a part of a term at its distance from a commensurability: at once, and by the drift that the changes of M and L make.
    pub(super) fn turned(&self, term: &Candidate, amplitude: f64, distance: f64) -> f64 {
        let distance = (distance - self.turning).max(0.0);
        let time = self.acting(amplitude, distance);
        let (h, m) = (f64::from(term.harmonic.abs()), f64::from(term.multiple));
        // The mean M and L at the epoch may be wrong by half their swing, for the whole duration. The swing itself adds half the acting time.
        // With exact divisors at the epoch a swing that returns within the span does not make this error. The other harmonics of the term add the rest of the
        // acting time.
        let lasting = if self.series.is_some() {
            0.5 * ((-0.25 * (distance * self.duration).powi(2)).exp() * self.duration) + time
        } else {
            0.5 * (self.duration + time)
        };
        let drifting = self.response.of_actions([m * term.action, h * term.action], lasting);
        (amplitude * time * (term.rate + drifting)).min(PI)
    }

    /// The time over which a term acts in one sense.
    fn acting(&self, amplitude: f64, distance: f64) -> f64 {
        // A harmonic of the orbit acts at every passage of the pericentre.
        let passage = if amplitude < 1.0 { TAU / self.mean_motion } else { 0.0 };
        let span = self.duration + passage;
        if distance * span > 2.0 { 2.0 / distance } else { span }
    }

    /// The distance of Ω from the nearest low multiple of the mean motion.
    fn slow_distance(&self, term: &Candidate) -> f64 {
        let multiples = -SLOW_HARMONICS..=SLOW_HARMONICS;
        multiples.map(|j| (term.frequency - f64::from(j) * self.mean_motion).abs()).fold(f64::INFINITY, f64::min)
    }

    /// The amplitude of the nearest harmonic that the sum for G does not contain, and the distance of Ω from it.
    fn beyond_the_sum(&self, term: &Candidate) -> (f64, f64) {
        let e = self.eccentricity;
        let number = (term.frequency / self.mean_motion).abs();
        let distance = self.mean_motion * (number - number.round()).abs();
        if e == 0.0 || !self.envelope.passes {
            return (0.0, distance);
        }
        let upper = at_most(e, number.floor(), 1);
        if self.turned(term, upper, distance) <= NEGLIGIBLE {
            return (upper, distance);
        }
        let number = number.floor().min(LARGEST_NUMBER);
        let known = self.series.and_then(|series| series.largest(number as usize));
        (known.unwrap_or_else(|| harmonic(e, number)) * (1.0 - e).powi(3), distance)
    }
}
