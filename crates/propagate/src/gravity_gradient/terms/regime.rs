//! How each term of the generating function is corrected, and the effect of what is not corrected.
//!
//! A term with |Ω| above [`SLOW_RATIO`] times the largest rate of twice the true anomaly is fast. Its sum over time derivatives contains all low harmonics of the
//! orbit. A term that is slower, or whose sum is not accurate enough, has exact divisors Ω + jn in the harmonics of the orbit, if the orbit has a series of
//! harmonics and the change is small. A harmonic next to resonance whose correction would be large is left out of it. A slow term without a series is not
//! corrected.
//!
//! A part that is not corrected turns the attitude by its rate times the time during which it acts in one sense, which is the span or 2/|Ω + jn|. It also
//! changes σ and M, so that the phases drift. [`Regimes::uncorrected`] is an upper estimate of both. A scene with a large one is [`Error::Resonance`].

use std::f64::consts::{PI, TAU};

use super::divisors::{AverageShift, Divisors, multiple_of, returns};
use super::term::{SLOW_RATIO, Sensitivity, SizedTerm, Term};
use crate::error::Error;
use crate::gravity_gradient::body::inertia::Inertia;
use crate::gravity_gradient::orbit::derivatives::ORDERS;
use crate::gravity_gradient::orbit::elliptic_orbit::Demand;
use crate::gravity_gradient::orbit::hansen::{OrbitSeries, at_most};
use crate::input::options::Level;

/// Harmonics of the orbit, from −3 to 3, with which the frequency of a slow term is compared.
const SLOW_HARMONICS: i32 = 3;
/// Largest change of the attitude by a slow term, and by a harmonic near resonance, that is corrected \[rad\].
const LARGEST_CORRECTED: f64 = 0.01;
/// Largest change of y′ by a harmonic near resonance, through the slope of Ω, that is corrected \[rad\]. The correction is linear in it.
const LARGEST_TURN: f64 = 0.2;
/// A scene is refused if one term turns the attitude by more than this without correction \[rad\].
const LARGEST_EFFECT: f64 = 0.03;
/// A scene is refused if the terms without correction turn the attitude by more than this multiple of the tolerance or of the error of second order.
const REFUSAL_FACTOR: f64 = 10.0;

/// How one term is corrected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Regime {
    /// By a sum over time derivatives.
    Fast {
        /// Number of time derivatives.
        orders: usize,
        /// Truncation error \[rad\].
        truncation: f64,
    },
    /// With exact divisors in the harmonics of the orbit.
    Exact {
        /// The harmonic j that is left out, because the term is in resonance with it.
        resonant: Option<i32>,
        /// Largest change of the attitude by all other harmonics \[rad\].
        size: f64,
    },
    /// Not at all: the term is too slow.
    Slow,
    /// Not at all: the term is negligible.
    Negligible,
}

/// The terms of one body at a level, before any is dropped.
pub(crate) struct Terms {
    pub(crate) all: Vec<SizedTerm>,
    /// Those that the level omits.
    pub(crate) omitted: Vec<SizedTerm>,
    pub(crate) response: Sensitivity,
    /// Largest change of the frequencies of the torque by the rates of node and pericentre.
    turning: f64,
    /// The largest rate of twice the true anomaly, at the pericentre, and of the axes.
    fastest: f64,
    /// Sum of the sizes of the terms that are not slow \[rad\].
    pub(crate) size: f64,
}

impl Terms {
    pub(crate) fn new(inertia: &Inertia, demand: &Demand<'_>) -> Self {
        let Demand { level, rates, envelope, .. } = *demand;
        let turning = 2.0 * (rates[0].abs() + rates[1].abs());
        let fastest = envelope.fastest + turning;
        let response = Sensitivity::new(inertia);
        let scale = 4.0 * demand.strength() * envelope.span[0] / inertia.momentum;
        let sized = |function: fn(Level, &Inertia, i32, i32) -> (f64, f64)| -> Vec<_> {
            let of_level = |term: Term| (term, function(level, inertia, term.multiple, term.harmonic));
            let terms = Term::all(inertia).map(of_level);
            terms.filter_map(|(term, f)| SizedTerm::new(term, f, inertia, (&response, scale))).collect()
        };
        let all = sized(Level::tensor);
        let omitted = if matches!(level, Level::Paper | Level::Moving) { sized(Level::omitted) } else { Vec::new() };
        let regular = |term: &&SizedTerm| term.frequency.abs() > SLOW_RATIO * fastest;
        let size = all.iter().filter(regular).map(SizedTerm::size).sum();
        Self { all, omitted, response, turning, fastest, size }
    }
}

/// The mean motion and one orbit, from which the regime of each term follows.
pub(crate) struct Regimes<'a> {
    demand: &'a Demand<'a>,
    terms: &'a Terms,
    /// The shift of the frequencies by the average torque.
    secular: AverageShift,
    /// Largest sizes of the time derivatives of the orbit's functions within the span.
    sizes: &'a [f64],
    /// Largest number of time derivatives in a sum.
    most: usize,
    /// Terms and truncation errors that change the attitude by less are neglected \[rad\].
    pub(crate) nothing: f64,
    /// Truncation error of a sum above which exact divisors replace it \[rad\].
    enough: f64,
    /// Sum of the sizes of the terms of all bodies that are not slow \[rad\].
    whole: f64,
}

impl<'a> Regimes<'a> {
    /// For the terms of one body. The sizes of the terms of all bodies that are not slow sum to `whole`.
    pub(crate) fn new(terms: &'a Terms, inertia: &Inertia, demand: &'a Demand<'a>, whole: f64) -> Self {
        let Demand { orbit, level, ledger, envelope, .. } = *demand;
        let eccentricity = orbit.eccentricity();
        let secular = AverageShift::new(inertia, demand.strength(), eccentricity, [&demand.axes[2], &demand.pole]);
        let sizes = if demand.rates == [0.0; 2] { &envelope.span[..] } else { &envelope.orbital.norms };
        let most = if level == Level::Paper { 1 } else { ORDERS };
        let mut regimes = Self { demand, terms, secular, sizes, most, nothing: 0.0, enough: 0.0, whole };
        regimes.nothing = (ledger.dropped / regimes.growth_of(1)).max(ledger.of_second_order * whole * whole);
        regimes.enough = regimes.nothing.max(ledger.truncated);
        regimes
    }

    /// The factor by which the effect of a dropped term grows over the span. The tilt of the angular momentum by it changes the precession, for m = 0 too.
    pub(crate) fn growth(&self, term: &SizedTerm) -> f64 {
        self.growth_of(if self.demand.ledger.refined { 1 } else { term.term.multiple })
    }

    /// That factor for terms of this m. Refined M and L contain all terms but are evaluated at a state found without the dropped ones, so that the effect of a
    /// dropped term grows in second order only.
    pub(crate) fn growth_of(&self, multiple: i32) -> f64 {
        let further = if self.demand.ledger.refined { self.whole } else { 1.0 };
        1.0 + further * (self.terms.response.growth(multiple, self.demand.duration) - 1.0)
    }

    /// The regime of a term.
    pub(crate) fn of(&self, term: &SizedTerm) -> Regime {
        let slow = self.is_slow(term);
        if let Some(series) = self.demand.series {
            let [_, amplitude, distance] = self.nearest(term, series);
            let visible = term.size_at(distance.max(1.0 / self.demand.duration)) > self.nothing;
            let needs =
                || slow || self.sum(term).1 > self.enough || self.turned(term, amplitude, distance) > self.nothing;
            if visible && (slow || term.size() > self.nothing) && needs() {
                let exact = self.exact(term, series);
                match exact {
                    Regime::Exact { size, .. } if slow && (size <= self.nothing || size > LARGEST_CORRECTED) => {}
                    _ => return exact,
                }
            }
        }
        if slow {
            return Regime::Slow;
        }
        if term.size() <= self.nothing {
            return Regime::Negligible;
        }
        let (orders, truncation) = self.sum(term);
        Regime::Fast { orders, truncation }
    }

    /// The largest turn of the attitude within the span by what is not corrected of a term, at most π \[rad\].
    pub(crate) fn uncorrected(&self, term: &SizedTerm, regime: &Regime) -> f64 {
        match (regime, self.demand.series) {
            (Regime::Exact { resonant, .. }, Some(series)) => {
                let [_, amplitude, distance] = self.nearest(term, series);
                match resonant {
                    Some(_) => self.turned(term, amplitude, distance),
                    None => self.corrected(term, amplitude, distance),
                }
            }
            (Regime::Slow, _) => self.whole(term),
            _ => {
                let [amplitude, distance] = self.beyond_the_sum(term);
                self.turned(term, amplitude, distance)
            }
        }
    }

    /// The turn that remains after the correction of the harmonic nearest to resonance. The relative error of the correction has four parts: the shift of Ω by
    /// the average torque and by second order, the correction itself, its turn of y′, and the part of the harmonic that does not return within the span.
    fn corrected(&self, term: &SizedTerm, amplitude: f64, distance: f64) -> f64 {
        if amplitude == 0.0 {
            return 0.0;
        }
        let distance = distance.max(1.0 / self.demand.duration);
        let size = amplitude * term.size_at(distance);
        let [_, turn] = term.swing_at(distance).map(|part| amplitude * part);
        let shift = self.divisors(term).steady_shift / self.demand.mean_motion;
        let further = self.whole * self.whole * term.frequency.abs() / distance;
        size * (shift + further + size + turn + self.unreturned(distance)).min(1.0)
    }

    /// The part of a harmonic that does not return within the span.
    fn unreturned(&self, distance: f64) -> f64 {
        (-0.25 * (distance * self.demand.duration).powi(2)).exp()
    }

    /// The turn by all terms together, from the turn by each: their phases are independent, so the squares add up.
    ///
    /// # Errors
    /// [`Error::Resonance`] if the turn is more than [`REFUSAL_FACTOR`] times `allowed`, or that of one term more than [`LARGEST_EFFECT`] although the orbit has
    /// a series. The error names the term with the largest turn.
    pub(crate) fn total<'t>(
        &self,
        effects: impl Iterator<Item = (&'t SizedTerm, f64)>,
        allowed: f64,
    ) -> Result<f64, Error> {
        let (mut sum, mut squares, mut largest) = (0.0, 0.0, None::<(&SizedTerm, f64)>);
        for (term, effect) in effects {
            sum += effect;
            squares += effect * effect;
            // Of two terms with the same effect, the one nearer to the commensurability is named.
            let nearer = |other: &SizedTerm| self.slow_distance(term) < self.slow_distance(other);
            if largest.is_none_or(|(other, most)| effect > most || (effect == most && nearer(other))) {
                largest = Some((term, effect));
            }
        }
        let Some((term, most)) = largest else { return Ok(0.0) };
        let refused = |effect: f64, limit: f64| Error::Resonance {
            harmonic: term.term.harmonic,
            multiple: term.term.multiple,
            divisor: 2.0 * term.frequency.abs() / self.terms.fastest,
            bound: 2.0 * SLOW_RATIO,
            effect,
            limit,
        };
        if self.demand.series.is_some() && most > LARGEST_EFFECT {
            return Err(refused(most, LARGEST_EFFECT));
        }
        if sum > REFUSAL_FACTOR * allowed { Err(refused(sum, REFUSAL_FACTOR * allowed)) } else { Ok(squares.sqrt()) }
    }

    /// The divisors of a term in the orbit's harmonics.
    pub(crate) fn divisors(&self, term: &SizedTerm) -> Divisors {
        let numbers = (term.term.harmonic, term.term.multiple);
        Divisors::new(numbers, [term.frequency, self.demand.mean_motion], self.is_slow(term), &self.secular)
    }

    /// Whether a term is too slow for a sum over time derivatives.
    pub(crate) fn is_slow(&self, term: &SizedTerm) -> bool {
        term.frequency.abs() <= SLOW_RATIO * self.terms.fastest
    }

    /// The turn of the attitude by a term that is not corrected at all: by the low harmonics of the orbit, and by the nearest one above them.
    pub(crate) fn whole(&self, term: &SizedTerm) -> f64 {
        let low = self.turned(term, 1.0, self.slow_distance(term));
        if (term.frequency / self.demand.mean_motion).abs() < f64::from(SLOW_HARMONICS) + 0.5 {
            return low;
        }
        let [amplitude, distance] = self.beyond_the_sum(term);
        low + self.turned(term, amplitude, distance)
    }

    /// A term with exact divisors. The harmonic nearest to resonance is left out if it does not return within the span and its correction is large.
    fn exact(&self, term: &SizedTerm, series: &OrbitSeries) -> Regime {
        let [number, amplitude, distance] = self.nearest(term, series);
        let [_, turn] = term.swing_at(distance).map(|part| amplitude * part);
        let small = amplitude * term.size_at(distance) <= LARGEST_CORRECTED && turn <= LARGEST_TURN;
        let corrected = small || amplitude == 0.0 || returns(distance, self.demand.duration);
        let resonant = (!corrected).then_some(number as i32);
        let divisors = self.divisors(term);
        let count = series.coefficients.len() as i32;
        let size = (1 - count..count)
            .filter(|j| resonant != Some(*j))
            .map(|j| self.amplitude(series, j) * term.size_at(divisors.smallest(j).abs()))
            .sum();
        Regime::Exact { resonant, size }
    }

    /// The harmonic of the orbit with which a term is nearest to resonance: its number, its size over that of the torque at the nearest place, and its smallest
    /// divisor.
    fn nearest(&self, term: &SizedTerm, series: &OrbitSeries) -> [f64; 3] {
        let divisors = self.divisors(term);
        let distance = |j: i32| divisors.smallest(j).abs();
        let about = -multiple_of(self.demand.mean_motion, term.frequency);
        // The shift by the average torque may make a neighbour the nearest.
        let number = [about, about - 1, about + 1].into_iter().min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        let number = number.unwrap_or(about);
        [f64::from(number), self.amplitude(series, number), distance(number)]
    }

    /// The size of a harmonic of the orbit over that of the torque at the nearest place.
    fn amplitude(&self, series: &OrbitSeries, number: i32) -> f64 {
        (series.largest(number.unsigned_abs() as usize).unwrap_or(0.0) / self.demand.envelope.span[0]).min(1.0)
    }

    /// The turn of the attitude by a part of a term at its distance from a commensurability: at once, and by the drift that the changes of M and L make.
    fn turned(&self, term: &SizedTerm, amplitude: f64, distance: f64) -> f64 {
        let distance = (distance - self.terms.turning).max(0.0);
        // A harmonic of the orbit acts at every passage of the pericentre.
        let passage = if amplitude < 1.0 { TAU / self.demand.mean_motion } else { 0.0 };
        let span = self.demand.duration + passage;
        let acting = if distance * span > 2.0 { 2.0 / distance } else { span };
        // The mean M and L at the epoch may be wrong by half their swing over the span. With exact divisors at the epoch a swing that returns within the span does
        // not make this error.
        let unreturned =
            if self.demand.series.is_some() { (-0.25 * (distance * self.demand.duration).powi(2)).exp() } else { 1.0 };
        let lasting = 0.5 * unreturned * self.demand.duration + acting;
        let (h, m) = (f64::from(term.term.harmonic.abs()), f64::from(term.term.multiple));
        let drifting = self.terms.response.of_actions([m * term.action, h * term.action], lasting);
        (amplitude * acting * (term.rate + drifting)).min(PI)
    }

    /// The distance of Ω from the nearest low multiple of the mean motion.
    fn slow_distance(&self, term: &SizedTerm) -> f64 {
        let multiples = -SLOW_HARMONICS..=SLOW_HARMONICS;
        multiples.map(|j| (term.frequency - f64::from(j) * self.demand.mean_motion).abs()).fold(f64::INFINITY, f64::min)
    }

    /// The amplitude of the nearest harmonic that the sum over time derivatives does not contain, and the distance of Ω from it.
    fn beyond_the_sum(&self, term: &SizedTerm) -> [f64; 2] {
        let e = self.demand.orbit.eccentricity();
        let number = (term.frequency / self.demand.mean_motion).abs();
        let distance = self.demand.mean_motion * (number - number.round()).abs();
        if e == 0.0 || !self.demand.envelope.passes {
            return [0.0, distance];
        }
        let known = self.demand.series.and_then(|series| series.largest(number as usize));
        let amplitude = known.map_or_else(|| at_most(e, number.floor(), 1), |size| size * (1.0 - e).powi(3));
        [amplitude, distance]
    }

    /// Truncation error of a sum with `orders` derivatives: the next derivative, and those after it as a geometric series, at most as much again.
    fn rest(&self, term: &SizedTerm, orders: usize) -> f64 {
        let [last, next] = [orders - 1, orders].map(|orders| self.next(term, orders));
        next / (1.0 - (next / last).min(0.5))
    }

    /// The part of a term by one derivative.
    fn next(&self, term: &SizedTerm, orders: usize) -> f64 {
        term.size() * self.sizes[orders] / self.sizes[0] / term.frequency.abs().powi(orders as i32)
    }

    /// The number of derivatives in the sum of a term, and its truncation error. The sum is asymptotic: it ends where it is accurate enough, or where the error
    /// is least.
    fn sum(&self, term: &SizedTerm) -> (usize, f64) {
        let least = || (1..=self.most).min_by(|&a, &b| self.next(term, a).total_cmp(&self.next(term, b)));
        let accurate = (1..self.most).find(|&orders| self.rest(term, orders) <= self.nothing);
        let orders = accurate.or_else(least).unwrap_or(self.most);
        (orders, self.rest(term, orders))
    }
}
