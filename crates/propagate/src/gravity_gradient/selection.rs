//! How each term of the generating function is corrected: by a sum over time derivatives, with exact divisors, or not at all.

use std::f64::consts::TAU;

use super::aspect::Aspect;
use super::candidate::Candidate;
use super::divisors::Divisors;
use super::generator::returns;
use super::orbit_series::{FEWEST_ORBITS, OrbitSeries};
use super::resonance::{Commensurability, NearHarmonic};

/// Largest change of the attitude by a harmonic near resonance, and by a slow term, that is corrected \[rad\].
const LARGEST: f64 = 0.01;

/// The same for the change of y′ through the slope of Ω, in which the correction is linear.
const LARGEST_TURN: f64 = 0.2;
/// A harmonic that does not return within the span is corrected only if the largest error of its correction is below this multiple of its effect without
/// correction.
const CORRECTION_LIMIT: f64 = 2.0;
/// Safety factor of the upper estimate of the error by pairs of the harmonic with other terms and harmonics.
const PAIR_MARGIN: f64 = 0.7;
/// Fraction of the upper estimate of the error by the square of a harmonic that enters the error.
const SQUARE_SHARE: f64 = 0.5;

/// Safety factor of the error by the parts of the shift of Ω that the divisor lacks.
const SHIFT_MARGIN: f64 = 1.35;
/// Fraction of the changes of the angles by a harmonic that follows the swing of its phase.
const SWINGING_ANGLES: f64 = 0.16;
/// Fraction of the upper estimate of the second-order shift of Ω that enters the error.
const SECOND_SHIFT: f64 = 0.16;
/// Fraction of the swing of the phase that enters the error of a span with few orbits.
const SHORT_SPAN_SWING: f64 = 0.2;
/// Fraction of the upper estimates of the drifts by the squares of a harmonic and of its shift that enters the error.
const SQUARE_DRIFT: f64 = 0.25;

/// The error of a harmonic near resonance is multiplied by 1 plus this times the sum of the sizes of all terms, for its third order.
const HARMONIC_THIRD_ORDER: f64 = 10.0;

/// The data from which a [`Choice`] is made.
pub(super) struct Selection<'a> {
    pub(super) commensurability: Commensurability<'a>,
    /// Largest sizes of the time derivatives within the span.
    pub(super) sizes: Vec<f64>,
    /// Largest number of derivatives.
    pub(super) most: usize,
    /// Terms and truncation errors that change the attitude by less are neglected \[rad\].
    pub(super) nothing: f64,
    /// Truncation error of a sum above which exact divisors replace it, if the orbit has a series \[rad\].
    pub(super) enough: f64,
    /// Sum of the sizes of all terms that are not slow \[rad\].
    pub(super) whole: f64,
    /// The orbit's harmonics, where divisors may be exact in them.
    pub(super) series: Option<(&'a OrbitSeries, Aspect)>,
}

/// How one term is corrected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Choice {
    /// Not at all.
    Dropped,
    /// By a sum: its number of derivatives, and its truncation error \[rad\].
    Sum(usize, f64),
    /// With exact divisors.
    Exact(Exact),
}

/// A term with exact divisors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exact {
    /// The harmonic of the orbit that is left out, because the term is too near to a resonance with it.
    pub(super) excluded: Option<i32>,
    /// Largest change of the attitude by the term \[rad\].
    pub(super) size: f64,
    /// Attitude error over the span by the harmonics near resonance, corrected or not \[rad\].
    pub(super) effect: f64,
    /// Upper estimate of this error \[rad\].
    pub(super) at_most: f64,
}

impl Selection<'_> {
    /// How a term is corrected. Exact divisors are used for terms that are too slow for a sum, terms whose sum is not accurate enough, and terms with a visible
    /// effect of the harmonics of the orbit that no sum contains.
    pub(super) fn choice(&self, term: &Candidate) -> Choice {
        let slow = self.commensurability.is_slow(term);
        if let Some((series, aspect)) = &self.series {
            let near = self.commensurability.near(term, series, aspect);
            let closest = near.0.distance.max(1.0 / self.commensurability.duration);
            let visible = term.size_at(closest) > self.nothing;
            let needs = || slow || self.sum(term).1 > self.enough || self.commensurability.effect(term) > self.nothing;
            if visible && (slow || term.size() > self.nothing) && needs() {
                let exact = self.exact(term, &near, series);
                if !slow || exact.size > self.nothing && exact.size <= LARGEST {
                    return Choice::Exact(exact);
                }
            }
        }
        if slow || term.size() <= self.nothing {
            return Choice::Dropped;
        }
        let (orders, left) = self.sum(term);
        Choice::Sum(orders, left)
    }

    /// Attitude error over the span by the harmonics of the orbit that the correction of a term lacks or leaves, and its upper estimate \[rad\].
    pub(super) fn effect(&self, term: &Candidate, choice: &Choice) -> [f64; 2] {
        match choice {
            Choice::Exact(exact) => [exact.effect, exact.at_most],
            _ => [self.commensurability.effect(term); 2],
        }
    }

    /// Truncation error of a sum with `orders` derivatives: the next derivative, and those after it as a geometric series, at most as much again.
    fn rest(&self, term: &Candidate, orders: usize) -> f64 {
        let [last, next] = [orders - 1, orders].map(|orders| self.next(term, orders));
        next / (1.0 - (next / last).min(0.5))
    }

    /// The part of a term by one derivative.
    fn next(&self, term: &Candidate, orders: usize) -> f64 {
        term.size() * self.sizes[orders] / self.sizes[0] / term.frequency.abs().powi(orders as i32)
    }

    /// The number of derivatives in the sum of a term, and its truncation error. The sum is asymptotic: it ends where it is accurate enough, or where the error
    /// is least.
    fn sum(&self, term: &Candidate) -> (usize, f64) {
        let least = || (1..=self.most).min_by(|&a, &b| self.next(term, a).total_cmp(&self.next(term, b)));
        let accurate = (1..self.most).find(|&orders| self.rest(term, orders) <= self.nothing);
        let orders = accurate.or_else(least).unwrap_or(self.most);
        (orders, self.rest(term, orders))
    }

    /// A term with exact divisors. The harmonic nearest to resonance is left out if its correction may leave more than [`CORRECTION_LIMIT`] times its effect.
    fn exact(
        &self,
        term: &Candidate,
        (nearest, beside): &(NearHarmonic, Vec<NearHarmonic>),
        series: &OrbitSeries,
    ) -> Exact {
        let Commensurability { duration, .. } = self.commensurability;
        let divisors = self.commensurability.divisors(term);
        let [left, at_most] = self.correction_error(term, nearest, &divisors);
        let first = self.commensurability.turned(term, nearest.amplitude, nearest.distance);
        let [_, turn] = term.swing_at(nearest.distance).map(|part| nearest.amplitude * part);
        let small = nearest.amplitude * term.size_at(nearest.distance) <= LARGEST && turn <= LARGEST_TURN;
        let nothing = nearest.amplitude == 0.0;
        let corrected = nothing || returns(nearest.distance, duration) || small && at_most < CORRECTION_LIMIT * first;
        let (excluded, both) = if corrected { (None, [left, at_most]) } else { (Some(nearest.harmonic), [first; 2]) };
        let beside = beside.iter().map(|near| self.correction_error(term, near, &divisors));
        let [effect, at_most] = beside.fold(both, |sum, part| [sum[0] + part[0], sum[1] + part[1]]);
        let [size, square] = self.harmonics(term, &divisors.without(excluded), series);
        let slow = self.commensurability.is_slow(term);
        let drift = if slow { self.moved(&divisors, nearest.distance) * square * duration } else { 0.0 };
        Exact { excluded, size, effect: effect + drift, at_most: at_most + drift }
    }

    /// Attitude error over the span by the correction of a harmonic near resonance, and its upper estimate \[rad\].
    fn correction_error(&self, term: &Candidate, near: &NearHarmonic, divisors: &Divisors) -> [f64; 2] {
        let Commensurability { duration, response, mean_motion, fastest, .. } = self.commensurability;
        let NearHarmonic { amplitude, distance, .. } = *near;
        if amplitude == 0.0 {
            return [0.0; 2];
        }
        let size = amplitude * term.size_at(distance);
        let [of_momentum, turn] = term.swing_at(distance).map(|part| amplitude * part);
        let lasting = response.by_momentum * duration;
        // By the square of the harmonic: the averaged Hamiltonian of second order, and the slope of a power of p, which is larger than the change near J = 0.
        let degree = f64::from((term.harmonic.abs() - 1).max(0));
        let slope = turn + size * degree / (response.gain * response.sigma.sqrt()).max(size).max(f64::MIN_POSITIVE);
        let square = size * (size + slope) + 0.5 * turn * turn;
        // By pairs with the other terms, and with the other harmonics of the same term, which act while the disturbing body passes the pericentre.
        let passing = 2.0 * (term.frequency / fastest).abs();
        let bounded = (size + turn) * (self.whole + passing * term.size());
        let drift = SQUARE_DRIFT * self.moved(divisors, distance) * distance * duration;
        let (square, pairs) = (square * (1.0 + drift), PAIR_MARGIN * bounded);
        // The divisors contain the mean shift of Ω by the average torque. They lack its dependence on σ and k, the part that swings with the orbit, and its
        // second order.
        let (steady, angles) = (divisors.steady_shift, turn + amplitude * term.shift / (distance * distance));
        let further =
            steady * steady / (mean_motion * distance) + self.whole * self.whole * term.frequency.abs() / distance;
        let swing = self.commensurability.swing(term);
        let shift = (swing + further).min(1.0);
        let direct = amplitude * term.rate / distance;
        // The harmonic's phase has the swing in the correction and not in the motion, where it makes sidebands with divisors of about n, if the span has at
        // least `FEWEST_ORBITS[0]` orbits.
        let shifted = if mean_motion * duration >= FEWEST_ORBITS[0] * TAU {
            swing * (direct + SWINGING_ANGLES * angles) + SECOND_SHIFT * further * angles
        } else {
            (SHORT_SPAN_SWING * swing + further).min(1.0) * (direct + angles)
        };
        let of_mean = of_momentum * ((steady / distance).min(1.0) + SQUARE_DRIFT * shift * shift * lasting);
        let left = SQUARE_SHARE * square + pairs + SHIFT_MARGIN * shifted.min(direct + angles) + of_mean;
        let at_most = square + pairs + SHIFT_MARGIN * shift * (angles + shift * of_momentum * lasting);
        let third = 1.0 + HARMONIC_THIRD_ORDER * self.whole;
        [third * left, third * at_most.max(left)]
    }

    /// The share of the drift by the square of a harmonic that K2 lacks. K2 contains the mean drift for the direction of the angular momentum at the epoch.
    fn moved(&self, divisors: &Divisors, distance: f64) -> f64 {
        let Commensurability { duration, eccentricity, secular, .. } = &self.commensurability;
        (divisors.steady_shift / distance + eccentricity * secular.precessed(*duration)).min(1.0)
    }

    /// Sums over the harmonics of the orbit in a term with exact divisors: of the changes of the attitude \[rad\], and of their squares times the divisors.
    fn harmonics(&self, term: &Candidate, divisors: &Divisors, series: &OrbitSeries) -> [f64; 2] {
        let count = series.coefficients.len() as i32;
        let mut sums = [0.0; 2];
        for j in (1 - count..count).filter(|j| divisors.excluded != Some(*j)) {
            let functions = &series.coefficients[j.unsigned_abs() as usize];
            let largest = functions.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
            let divisor = divisors.smallest(j).abs();
            // The rate of a term is that where the disturbing body is nearest, and the coefficients add up there.
            let size = largest * term.size_at(divisor) / self.sizes[0];
            sums = [sums[0] + size, sums[1] + size * size * divisor];
        }
        sums
    }
}
