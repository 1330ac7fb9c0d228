//! How each term of the generating function is corrected, and the effect of what is not corrected.
//!
//! A term with |Ω| above [`SLOW_RATIO`] times the largest rate of twice the true anomaly is fast. Its sum over time derivatives contains all low harmonics of the
//! orbit. A term that is slower, or whose sum is not accurate enough, has exact divisors Ω + jn in the harmonics of the orbit, if the orbit has a series of
//! harmonics and the change is small. A slow term without a series is not corrected. The harmonic nearest to resonance has one of
//! two solutions, the one with the smaller error: the periodic one, which contains the divisor Ω_j squared, or the one that vanishes at the epoch, which grows with
//! the span instead (equation (9) of docs/theory-second-order.md).
//!
//! A part that is not corrected turns the attitude by its rate times the time during which it acts in one sense, which is the span or 2/|Ω + jn|. It also
//! changes σ and M, so that the phases drift. [`Regimes::uncorrected`] is an upper estimate of both. A scene with a large one is [`Error::Resonance`].

use std::f64::consts::{PI, TAU};

use super::divisors::{AverageShift, Divisors, multiple_of, unreturned};
use super::term::{Sensitivity, Term, slow_limit};
use crate::error::Error;
use crate::gravity_gradient::constants::{LARGEST_CORRECTED, LARGEST_EFFECT, REFUSAL_FACTOR, SLOW_RATIO};
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::inertia::Inertia;
use crate::input::options::Level;
use crate::orbit::derivatives::ORDERS;
use crate::orbit::hansen::at_most;

/// Harmonics of the orbit, from −3 to 3, with which the frequency of a slow term is compared.
const SLOW_HARMONICS: i32 = 3;

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
        /// The harmonic j whose solution vanishes at the epoch, because the term is next to resonance with it.
        resonant: Option<i32>,
        /// Largest change of the attitude by all other harmonics \[rad\].
        size: f64,
        /// Mean square of that change over an orbit, by Parseval's theorem, and as much at the epoch \[rad²\].
        square: f64,
    },
    /// Not at all: the term is too slow.
    Slow,
    /// Not at all: the term is negligible.
    Negligible,
}

/// The terms of one body at a level, before any is dropped.
pub(crate) struct Terms {
    pub(crate) all: Vec<Term>,
    /// Those that the level omits.
    pub(crate) omitted: Vec<Term>,
    pub(crate) response: Sensitivity,
    /// Sum of the sizes of the terms that are not slow \[rad\].
    pub(crate) size: f64,
}

impl Terms {
    pub(crate) fn new(inertia: &Inertia, orbit: &Disturbance<'_>) -> Self {
        let level = orbit.level;
        let response = Sensitivity::new(inertia);
        let scale = 4.0 * orbit.strength() * orbit.envelope.span[0] / inertia.momentum;
        let sized = |function: fn(Level, &Inertia, i32, i32) -> (f64, f64)| -> Vec<_> {
            let of_level = |term: Term| (term, function(level, inertia, term.multiple, term.harmonic));
            let terms = Term::all(inertia).map(of_level);
            terms.filter_map(|(term, f)| term.under(f, inertia, (&response, scale))).collect()
        };
        let all = sized(Level::tensor);
        let omitted = if matches!(level, Level::Paper | Level::Moving) { sized(Level::omitted) } else { Vec::new() };
        let slow_limit = slow_limit(orbit);
        let size = all.iter().filter(|term| term.frequency.abs() > slow_limit).map(Term::size).sum();
        Self { all, omitted, response, size }
    }
}

/// The harmonic of the orbit with which a term is nearest to resonance.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    /// j.
    number: i32,
    /// Size of the harmonic, divided by the size of the torque where the disturbing body is nearest within the span.
    amplitude: f64,
    /// Smallest divisor of the harmonic.
    distance: f64,
}

/// The mean motion and one orbit, from which the regime of each term follows.
pub(crate) struct Regimes<'a> {
    orbit: &'a Disturbance<'a>,
    response: &'a Sensitivity,
    /// The shift of the frequencies by the average torque.
    secular: AverageShift,
    /// Largest |Ω| of a slow term.
    slow_limit: f64,
    /// Largest sizes of the time derivatives of the orbit's functions within the span.
    sizes: &'a [f64],
    /// Terms and truncation errors that change the attitude by less are neglected \[rad\].
    pub(crate) nothing: f64,
    /// Sum of the sizes of the terms of all bodies that are not slow \[rad\].
    whole: f64,
}

impl<'a> Regimes<'a> {
    /// For the terms of one body. The sizes of the terms of all bodies that are not slow sum to `whole`.
    pub(crate) fn new(terms: &'a Terms, inertia: &Inertia, orbit: &'a Disturbance<'a>, whole: f64) -> Self {
        let Disturbance { ledger, envelope, .. } = orbit;
        let sizes = if orbit.rates == [0.0; 2] { &envelope.span[..] } else { &envelope.orbital.norms };
        let (secular, slow_limit) = (AverageShift::new(inertia, orbit), slow_limit(orbit));
        let regimes = Self { orbit, response: &terms.response, secular, slow_limit, sizes, nothing: 0.0, whole };
        let nothing = (ledger.dropped / regimes.growth(1)).max(ledger.of_second_order * whole * whole);
        Self { nothing, ..regimes }
    }

    /// The factor by which the attitude error of a dropped term of this m grows over the span. If the mean M and L are computed with all terms, the growth has the
    /// further factor `whole`, and that of m = 1 holds for every m, because the tilt of the angular momentum changes the precession.
    pub(crate) fn growth(&self, multiple: i32) -> f64 {
        let (multiple, further) = if self.orbit.ledger.refined { (1, self.whole) } else { (multiple, 1.0) };
        1.0 + further * (self.response.growth(multiple, self.orbit.duration) - 1.0)
    }

    /// The regime of a term.
    pub(crate) fn of(&self, term: &Term) -> Regime {
        let (slow, size) = (self.is_slow(term), term.size());
        let enough = self.nothing.max(self.orbit.ledger.truncated);
        if self.orbit.series.is_some() && (slow || size > self.nothing) {
            let nearest = self.nearest(term);
            let visible = term.size_at(nearest.distance.max(1.0 / self.orbit.duration)) > self.nothing;
            if visible && (slow || self.sum(term).1 > enough || self.turned(term, nearest) > self.nothing) {
                let (resonant, size, square) = self.exact(term, nearest);
                if !slow || (size > self.nothing && size <= LARGEST_CORRECTED) {
                    return Regime::Exact { resonant, size, square };
                }
            }
        }
        if slow {
            Regime::Slow
        } else if size <= self.nothing {
            Regime::Negligible
        } else {
            let (orders, truncation) = self.sum(term);
            Regime::Fast { orders, truncation }
        }
    }

    /// The largest turn of the attitude within the span by the part of a term that is not corrected \[rad\]: first the effect of what is left out, which may refuse the
    /// scene, then the error of the correction of the harmonic nearest to resonance. `moved` is [`Regimes::all_moved`].
    pub(crate) fn uncorrected(&self, term: &Term, regime: &Regime, moved: f64) -> [f64; 2] {
        let nearest = self.nearest(term);
        match regime {
            Regime::Exact { resonant: None, .. } => [0.0, self.corrected(term, nearest)],
            Regime::Exact { .. } if self.turned(term, nearest) <= LARGEST_EFFECT => {
                [0.0, self.epoch_solution_error(term, nearest, moved)]
            }
            Regime::Slow => [self.whole(term), 0.0],
            _ => [self.turned(term, nearest), 0.0],
        }
    }

    /// The turn that remains after the correction of the harmonic nearest to resonance. With the divisor Ω_j, which lacks the shift ξ, the phase of
    /// the correction is wrong by ξ min(span, 1/Ω_j), and the correction is linear in its own size, of which the part Ω_j span acts within the span.
    fn corrected(&self, term: &Term, Nearest { amplitude, distance, .. }: Nearest) -> f64 {
        if amplitude == 0.0 {
            return 0.0;
        }
        let (duration, distance) = (self.orbit.duration, distance.max(f64::MIN_POSITIVE));
        let size = amplitude * (term.size_at(distance) + term.turn_at(distance));
        size * (self.shift(term) * duration.min(1.0 / distance) + size * (distance * duration).min(1.0)).min(1.0)
    }

    /// The error of the solution that vanishes at the epoch. Its phase lacks the shift ξ over the whole span, and it is linear in the turn that it makes. The second
    /// order of the changes π_a and π_b of p and k by two harmonics changes M by at most m π_a π_b and L by h π_a π_b; both grow like t². `moved` is the sum of all π.
    fn epoch_solution_error(&self, term: &Term, nearest: Nearest, moved: f64) -> f64 {
        let (turned, duration) = (self.turned(term, nearest), self.orbit.duration);
        let acting = self.acting(nearest).min(duration);
        let square = self.moved(term, nearest) * moved;
        let (h, m) = (f64::from(term.harmonic.abs()), f64::from(term.multiple));
        let drifting = self.response.of_actions([m * square, h * square], duration - acting / 1.5);
        turned * (self.shift(term) * duration + turned).min(1.0) + drifting
    }

    /// The largest change of p and k within the span by all harmonics whose solutions vanish at the epoch.
    pub(crate) fn all_moved(&self, chosen: &[(&Term, Regime)]) -> f64 {
        let resonant = chosen.iter().filter(|(_, regime)| matches!(regime, Regime::Exact { resonant: Some(_), .. }));
        resonant.map(|(term, _)| self.moved(term, self.nearest(term))).sum()
    }

    /// The largest change of p and k by a harmonic of a term.
    fn moved(&self, term: &Term, nearest: Nearest) -> f64 {
        nearest.amplitude * self.acting(nearest) * term.moving
    }

    /// The time during which a harmonic acts in one sense.
    fn acting(&self, Nearest { amplitude, distance, .. }: Nearest) -> f64 {
        let Disturbance { duration, mean_motion, .. } = *self.orbit;
        let distance = (distance - self.orbit.turning()).max(0.0);
        // A harmonic of the orbit acts at every passage of the pericentre.
        let span = duration + if amplitude < 1.0 { TAU / mean_motion } else { 0.0 };
        if distance * span > 2.0 { 2.0 / distance } else { span }
    }

    /// Upper estimate of the shift of a divisor: by the average torque over a part of the orbit, and of second order.
    fn shift(&self, term: &Term) -> f64 {
        self.divisors(term).steady_shift + self.whole * self.whole * term.frequency.abs()
    }

    /// The turn by all terms together, from the effect and the error of each, at most π: their phases are independent, so the squares add up.
    ///
    /// # Errors
    /// [`Error::Resonance`] if the turn is more than [`REFUSAL_FACTOR`] times `allowed`, or that of one term more than [`LARGEST_EFFECT`] although the orbit has
    /// a series. The error names the term with the largest turn.
    pub(crate) fn total<'t>(
        &self,
        effects: impl Iterator<Item = (&'t Term, [f64; 2])>,
        allowed: f64,
    ) -> Result<f64, Error> {
        let (mut sum, mut squares, mut largest) = (0.0, 0.0, None::<(&Term, f64)>);
        for (term, [effect, drift]) in effects {
            sum += effect.min(PI);
            squares += (effect + drift).min(PI).powi(2);
            largest = if largest.is_none_or(|(_, most)| effect > most) { Some((term, effect)) } else { largest };
        }
        let Some((term, most)) = largest else { return Ok(0.0) };
        let limit = REFUSAL_FACTOR * allowed;
        let (effect, limit) = match self.orbit.series {
            Some(_) if most > LARGEST_EFFECT => (most.min(PI), LARGEST_EFFECT),
            _ if sum > limit => (sum, limit),
            _ => return Ok(squares.sqrt()),
        };
        Err(Error::Resonance {
            harmonic: term.harmonic,
            multiple: term.multiple,
            divisor: 2.0 * SLOW_RATIO * term.frequency.abs() / self.slow_limit,
            bound: 2.0 * SLOW_RATIO,
            effect,
            limit,
        })
    }

    /// The divisors of a term in the orbit's harmonics.
    pub(crate) fn divisors(&self, term: &Term) -> Divisors {
        let numbers = (term.harmonic, term.multiple);
        Divisors::new(numbers, [term.frequency, self.orbit.mean_motion], self.is_slow(term), &self.secular)
    }

    /// Whether a term is too slow for a sum over time derivatives.
    fn is_slow(&self, term: &Term) -> bool {
        term.frequency.abs() <= self.slow_limit
    }

    /// The turn of the attitude by a term that is not corrected at all: by the low harmonics of the orbit, or by the nearest one if that is larger.
    pub(crate) fn whole(&self, term: &Term) -> f64 {
        let distance = |j: i32| (term.frequency - f64::from(j) * self.orbit.mean_motion).abs();
        let distance = (-SLOW_HARMONICS..=SLOW_HARMONICS).map(distance).fold(f64::INFINITY, f64::min);
        let low = Nearest { number: 0, amplitude: 1.0, distance };
        self.turned(term, low).max(self.turned(term, self.nearest(term)))
    }

    /// For a term with exact divisors, the harmonic whose solution vanishes at the epoch, and the size and the square of [`Regime::Exact`].
    fn exact(&self, term: &Term, nearest: Nearest) -> (Option<i32>, f64, f64) {
        let at_epoch = self.epoch_solution_error(term, nearest, self.moved(term, nearest));
        let resonant = (self.corrected(term, nearest) > at_epoch).then_some(nearest.number);
        let divisors = self.divisors(term);
        let count = self.orbit.series.as_ref().map_or(0, |series| series.coefficients.len() as i32);
        let others = (1 - count..count).filter(|j| resonant != Some(*j));
        let sizes = others.map(|j| self.amplitude(j) * term.size_at(divisors.smallest(j).abs()));
        let [size, squares] = sizes.fold([0.0; 2], |[sum, squares], size| [sum + size, squares + size * size]);
        (resonant, size, (2.0 * squares).min(size * size))
    }

    fn nearest(&self, term: &Term) -> Nearest {
        let divisors = self.divisors(term);
        let distance = |j: i32| divisors.smallest(j).abs();
        let about = -multiple_of(self.orbit.mean_motion, term.frequency);
        // The shift by the average torque may make a neighbour the nearest.
        let number = [about - 1, about + 1].into_iter().find(|j| distance(*j) < distance(about));
        let number = number.unwrap_or(about);
        Nearest { number, amplitude: self.amplitude(number), distance: distance(number) }
    }

    /// The size of a harmonic of the orbit over that of the torque at the nearest place. Without a series it is an upper estimate for a span with the
    /// pericentre, and 0 for any other.
    fn amplitude(&self, number: i32) -> f64 {
        let Disturbance { orbit, series, envelope, .. } = self.orbit;
        match series {
            Some(series) => (series.largest(number.unsigned_abs() as usize).unwrap_or(0.0) / envelope.span[0]).min(1.0),
            None if envelope.passes => at_most(orbit.eccentricity(), f64::from(number), 1),
            None => 0.0,
        }
    }

    /// The turn of the attitude by a harmonic of a term: at once, and by the drift that the changes of M and L make.
    fn turned(&self, term: &Term, nearest: Nearest) -> f64 {
        let (duration, acting) = (self.orbit.duration, self.acting(nearest));
        let distance = (nearest.distance - self.orbit.turning()).max(0.0);
        // The mean M and L at the epoch may be wrong by half their swing over the span. With exact divisors at the epoch a swing that returns within the span does
        // not make this error.
        let unreturned = if self.orbit.series.is_some() { unreturned(distance, duration) } else { 1.0 };
        let lasting = 0.5 * unreturned * duration + acting;
        let (h, m) = (f64::from(term.harmonic.abs()), f64::from(term.multiple));
        let drifting = self.response.of_actions([m * term.action, h * term.action], lasting);
        nearest.amplitude * acting * (term.rate + drifting)
    }

    /// Truncation error of a sum with `orders` derivatives: the next derivative, and those after it as a geometric series, at most as much again.
    fn rest(&self, term: &Term, orders: usize) -> f64 {
        let [last, next] = [orders - 1, orders].map(|orders| self.next(term, orders));
        next / (1.0 - (next / last).min(0.5))
    }

    /// The part of a term by one derivative.
    fn next(&self, term: &Term, orders: usize) -> f64 {
        term.size() * self.sizes[orders] / self.sizes[0] / term.frequency.abs().powi(orders as i32)
    }

    /// The number of derivatives in the sum of a term, and its truncation error. The sum is asymptotic: it ends where it is accurate enough, or where the error
    /// is least.
    fn sum(&self, term: &Term) -> (usize, f64) {
        let most = if self.orbit.level == Level::Paper { 1 } else { ORDERS };
        let least = || (1..=most).min_by(|&a, &b| self.next(term, a).total_cmp(&self.next(term, b)));
        let accurate = (1..most).find(|&orders| self.rest(term, orders) <= self.nothing);
        let orders = accurate.or_else(least).unwrap_or(most);
        (orders, self.rest(term, orders))
    }
}
