//! How each term of the generating function is corrected: by a sum over time derivatives, with exact divisors, or not at all.

use std::f64::consts::TAU;

use super::aspect::Aspect;
use super::candidate::{Candidate, SMALLEST_RATIO};
use super::divisors::Divisors;
use super::generator::returns;
use super::orbit_series::{FEWEST_ORBITS, OrbitSeries};
use super::resonance::{Commensurability, Nearest};

/// Largest change of the attitude by a harmonic near resonance, and by a slow term, that is corrected \[rad\].
const LARGEST: f64 = 0.01;

/// The same for the change of y′ through the slope of Ω, in which the correction is linear.
const LARGEST_TURN: f64 = 0.2;
/// The safety factor of what the correction of a harmonic near resonance leaves.
const MARGIN: f64 = 2.0;

/// The same for what the average torque does to it.
const SHIFT_MARGIN: f64 = 1.5;

/// What is of third order in the charge of a harmonic near resonance, over the charge and the sum of all terms.
const GROWING: f64 = 10.0;
/// The safety factor of pairs with the h and m of a slow term.
const PAIRS_MARGIN: f64 = 3.0;

/// What decides it.
pub(super) struct Selection<'a> {
    pub(super) commensurability: Commensurability<'a>,
    /// Largest sizes of the time derivatives within the span.
    pub(super) sizes: Vec<f64>,
    /// Largest number of derivatives.
    pub(super) most: usize,
    /// Smaller changes of the attitude are not looked at \[rad\].
    pub(super) nothing: f64,
    /// What the sum of a term may leave at one time, where exact divisors can replace it \[rad\].
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
    /// By a sum with so many derivatives, which leaves so much.
    Sum(usize, f64),
    /// With exact divisors.
    Exact(Exact),
}

/// A term with exact divisors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exact {
    /// The harmonic of the orbit that is left out, because the term is too near to a resonance with it.
    pub(super) left_out: Option<i32>,
    /// Largest change of the attitude by the term \[rad\].
    pub(super) size: f64,
    /// What the harmonic nearest to resonance does to the attitude over the span, corrected or not \[rad\].
    pub(super) effect: f64,
    /// The size of a slow term and of pairs of fast terms with its h and m together \[rad\]; 0 for fast terms.
    pub(super) slow: f64,
}

impl Selection<'_> {
    /// How a term is corrected. Exact divisors are for terms that are too slow for a sum, those of which no sum is accurate enough, and those of which the
    /// harmonics of the orbit that no sum contains have an effect.
    pub(super) fn choice(&self, term: &Candidate) -> Choice {
        let slow = self.commensurability.is_slow(term);
        if let Some((series, aspect)) = &self.series {
            let nearest = self.commensurability.nearest(term, series, aspect);
            let closest = nearest.distance.max(1.0 / self.commensurability.duration);
            let visible = term.size_at(closest) > self.nothing;
            let needs = || slow || self.sum(term).1 > self.enough || self.commensurability.effect(term) > self.nothing;
            if visible && (slow || term.size() > self.nothing) && needs() {
                let exact = self.exact(term, &nearest, series);
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

    /// What the harmonics of the orbit that a term lacks do to the attitude over the span \[rad\].
    pub(super) fn effect(&self, term: &Candidate, choice: &Choice) -> f64 {
        match choice {
            Choice::Exact(exact) => exact.effect,
            _ => self.commensurability.effect(term),
        }
    }

    /// What a sum with so many derivatives leaves of a term: the next derivative, and those after it if they fall like a geometric series, at most as much again.
    fn rest(&self, term: &Candidate, orders: usize) -> f64 {
        let [last, next] = [orders - 1, orders].map(|orders| self.next(term, orders));
        next / (1.0 - (next / last).min(0.5))
    }

    /// The part of a term by one derivative.
    fn next(&self, term: &Candidate, orders: usize) -> f64 {
        term.size() * self.sizes[orders] / self.sizes[0] / term.frequency.abs().powi(orders as i32)
    }

    /// The number of derivatives in the sum of a term, and what it leaves. The sum is asymptotic: it ends when it is accurate enough, or where it leaves least.
    fn sum(&self, term: &Candidate) -> (usize, f64) {
        let least = || (1..=self.most).min_by(|&a, &b| self.next(term, a).total_cmp(&self.next(term, b)));
        let accurate = (1..self.most).find(|&orders| self.rest(term, orders) <= self.nothing);
        let orders = accurate.or_else(least).unwrap_or(self.most);
        (orders, self.rest(term, orders))
    }

    /// A term with exact divisors. The harmonic nearest to resonance is left out if what its correction leaves would be more than its first order.
    fn exact(&self, term: &Candidate, nearest: &Nearest, series: &OrbitSeries) -> Exact {
        let Commensurability { duration, response, .. } = self.commensurability;
        let Nearest { amplitude, distance, acting, .. } = *nearest;
        let size = amplitude * term.size_at(distance);
        let [swing, turn] = term.swing_at(distance).map(|part| amplitude * part);
        let lasting = response.by_momentum * duration;
        // Of its square: the averaged Hamiltonian of second order, and the slope of a power of p, which is larger than the change near J = 0.
        let degree = f64::from((term.harmonic.abs() - 1).max(0));
        let slope = turn + size * degree / (response.gain * response.sigma.sqrt()).max(size).max(f64::MIN_POSITIVE);
        let square = size * (size + slope) + 0.5 * turn * turn;
        // Of pairs with the other terms, and with the other harmonics of the same one, which act while the body passes the pericentre.
        let passing = 2.0 * (term.frequency / self.commensurability.fastest).abs();
        let bounded = (size + turn) * (self.whole + passing * term.size());
        let Commensurability { mean_motion, eccentricity, secular, .. } = &self.commensurability;
        let divisors = self.commensurability.divisors(term);
        let (steady, swinging) = (divisors.steady_shift, divisors.swinging_shift);
        // K2 has the mean drift by the square, at the direction of the angular momentum at the epoch.
        let moved = (steady / distance + eccentricity * secular.precessed(duration)).min(1.0);
        let second = square * (1.0 + moved * acting * duration) + MARGIN * bounded;
        // The divisors have the mean shift of Ω by the average torque, but not its dependence on σ and k, the part that swings with the orbit, and its second order.
        let swinging = (steady * (3.0 * eccentricity + steady / distance) + 0.25 * swinging) / mean_motion;
        let shift = (swinging + self.whole * self.whole * term.frequency.abs() / distance).min(1.0);
        let angles = turn + amplitude * term.shift / (distance * distance);
        let shifted = shift * (angles + shift * swing * lasting);
        let left = second + SHIFT_MARGIN * shifted + swing * (steady / distance).min(1.0);
        let first = self.commensurability.turned(term, amplitude, distance);
        let small = size <= LARGEST && turn <= LARGEST_TURN;
        let corrected = returns(distance, duration) || small && left < MARGIN * first;
        let third = GROWING * self.whole * left;
        let (left_out, effect) = if corrected { (None, left + third) } else { (Some(nearest.harmonic), first) };
        let [size, square] = self.harmonics(term, &divisors.without(left_out), series);
        let (drift, slow) = match self.commensurability.is_slow(term) {
            true => (moved * square * duration, size * self.with_pairs(acting)),
            false => (0.0, 0.0),
        };
        Exact { left_out, size, effect: effect + drift, slow }
    }

    /// The factor by which pairs of fast terms with the h and m of a slow term enlarge what is bounded of it: they have its divisor, and second order lacks them.
    /// Over several orbits the drifts that are charged are larger than this.
    fn with_pairs(&self, acting: f64) -> f64 {
        let Commensurability { duration, mean_motion, fastest, .. } = self.commensurability;
        if mean_motion * duration >= FEWEST_ORBITS[0] * TAU {
            return 1.0;
        }
        PAIRS_MARGIN * (SMALLEST_RATIO * fastest / acting.max(1.0 / duration)).max(1.0)
    }

    /// Sums over the harmonics of the orbit in a term with exact divisors: of the changes of the attitude \[rad\], and of their squares times the divisors.
    fn harmonics(&self, term: &Candidate, divisors: &Divisors, series: &OrbitSeries) -> [f64; 2] {
        let count = series.coefficients.len() as i32;
        let mut sums = [0.0; 2];
        for j in (1 - count..count).filter(|j| divisors.left_out != Some(*j)) {
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
