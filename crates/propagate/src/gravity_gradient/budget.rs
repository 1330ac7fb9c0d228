//! The parts of the error bound of a motion under a gravity gradient.
//!
//! The largest first-order change ε is sampled over ℓ′, y′, the position of the disturbing body within the span, and the precession. S is the sum of the sizes
//! of all terms that are not slow. With one fixed orbit, the levels "full" and "second-order" have these parts:
//!
//! 1. the short-period change of second order and its harmonics near resonance ([`super::second_order::short_period`]);
//! 2. the pairs of terms with a slow term;
//! 3. the drift of third order, from ε, S, the rates and the time ([`Response::growing`]);
//! 4. the errors of the mean M and L at the epoch;
//! 5. at "full" the distance from the averaged motion of second order ([`super::second_order::drift`]).
//!
//! At "paper" and "moving", for several bodies and for precessing orbits, the whole error of second order is estimated from ε, S, the rates and the time
//! ([`Response::second_order`]). Then follow the dropped and resonant terms, the truncation of the sums for G, the terms that the level omits, the average over
//! the orbit, and rounding.

use std::f64::consts::{PI, TAU};

use nalgebra::UnitQuaternion;

use super::averaged::{AveragedOrbit, MOST_QUARTERS};
use super::corrections::{Corrections, Mean};
use super::envelope::Reach;
use super::inertia::Inertia;
use super::request::Request;
use super::response::Response;
use super::second_order::short_period::Turns;
use crate::error::Error;
use crate::input::options::{Averaging, Level};

mod bodies;
mod largest;

use largest::Sample;

/// Number of samples of the first-order change.
const SAMPLES: usize = 48;
/// Safety factor of the second-order error. The largest change may exceed the largest sample, and enters squared; second order has a factor too. With this
/// margin the worst case found by hill climbing (docs/gravity-gradient.md) is below its bound.
const SECOND_ORDER_MARGIN: f64 = 2.0;
/// The safety factor of the short-period change of second order: the constants that make the motion start at the state may double it, and the distance from the
/// state grows by its own second order.
const SHORT_PERIOD_MARGIN: f64 = 2.65;
/// Fraction of the upper estimate of the drift of third order that enters the error.
const THIRD_SHARE: f64 = 0.85;
/// Safety factor of the part of the second-order drifts that K2 lacks.
const CUT_MARGIN: f64 = 1.45;
/// Safety factor of the errors of the mean M and L at the epoch.
const ACTIONS_MARGIN: f64 = 1.1;
/// Fraction of the dropped terms and truncations that enters the error: they do not all reach their largest sizes at one time.
const AT_ONCE_SHARE: f64 = 0.8;
/// Fraction of the upper estimate of the pairs of terms with a slow term that enters the error. Their drift is part of [`Corrections::resonant`].
const SLOW_SHARE: f64 = 0.5;
/// Safety factor of [`Turns::resonant`].
const RESONANT_PAIRS_MARGIN: f64 = 1.5;
/// [`Turns::resonant`] is multiplied by 1 plus this times S, for its third order.
const PAIRS_THIRD_ORDER: f64 = 50.0;
/// The growing drifts are multiplied by 1 plus this times S, for the next order.
const FURTHER: f64 = 85.0;
/// The safety factor of the distance between the motions of first and of second order.
const FIRST_MARGIN: f64 = 1.4;
/// Safety factor of the error of the average over the orbit in second order. In 1,200 comparisons the distance from the motion averaged over the rotation alone
/// was at most 0.75 of the estimate without this factor, in the median 0.07.
const ORBIT_MARGIN: f64 = 1.5;
/// The derivatives of the change, as a fraction of the sum of the largest sizes of all terms.
const SLOPE_SHARE: f64 = 0.25;
/// Number of orbits on each side of the epoch for which quarters are kept.
pub(super) const MOST_ORBITS: f64 = (MOST_QUARTERS / 4 - 2) as f64;

/// The parts of the attitude error \[rad\].
pub(super) struct Budget {
    /// Error from the average over the rotation.
    spin: f64,
    /// Error from the average over the orbit.
    orbit: f64,
    /// Error from dropped terms.
    dropped: f64,
    /// Error from the terms that the level omits.
    omitted: f64,
    /// Error from the rounding of σ to a double in the phases.
    rounding: f64,
    /// Number of orbits from the epoch to the end of the span.
    orbits: f64,
}

/// One mean motion, and the tables from which its error is estimated.
pub(super) struct Subject<'a> {
    pub(super) mean: &'a Mean,
    pub(super) inertia: &'a Inertia,
    pub(super) corrections: &'a Corrections,
    pub(super) response: &'a Response,
    pub(super) ellipse: &'a AveragedOrbit,
    /// The part of the orbit within the span.
    pub(super) reach: &'a Reach,
    /// `None` at the levels "paper" and "moving", for several bodies and for precessing orbits.
    pub(super) further: Option<SecondOrderErrors>,
    /// d⟨T33⟩/dσ times −3/4 of the mass fraction over M.
    pub(super) drift: f64,
}

/// Error estimates from the second order in the torque, for a motion whose mean M and L contain all terms.
#[derive(Clone, Copy, Debug)]
pub(super) struct SecondOrderErrors {
    /// The short-period change of second order.
    pub(super) short_period: Turns,
    /// Estimated errors of the mean M and L, divided by M.
    pub(super) left: [f64; 2],
    /// The part of the drifts of second order that K2 lacks over the span.
    pub(super) cut: f64,
    /// The mean over the span of the drift of third order, divided by its largest value.
    pub(super) acting: f64,
    /// The distance from the motion of second order over the span, 0 for that motion \[rad\].
    pub(super) apart: f64,
}

impl Budget {
    pub(super) fn new(subject: &Subject<'_>, mean_motion: f64, duration: f64) -> Self {
        let Subject { inertia, corrections, response, ellipse, .. } = *subject;
        let orbital = mean_motion * duration;
        let [size, p] = subject.largest_change(orbital);
        // If the angular momentum is along the line to the disturbing body, or perpendicular to it, the change vanishes but its derivatives do not.
        let slope = size.max(SLOPE_SHARE * corrections.size);
        let [anomaly, longitude] = inertia.rate_slopes;
        let strength = ellipse.strength().abs();
        // The strength of the effect on the phases, as κ_o is that of the effect on the axis. Δ(σ) may be 0 where its slope is not.
        let by_phase = subject.phase() * mean_motion / ellipse.eta_cubed();
        let sizes = [size, slope];
        let square = strength * (strength + 6.0 * by_phase);
        let orbit = if ellipse.is_of_second_order() {
            ORBIT_MARGIN * square * (1.0 + strength * orbital)
        } else {
            square * (1.0 + orbital)
        };
        let (spin, dropped) = match subject.further {
            Some(SecondOrderErrors { short_period, left, cut, acting, apart }) => {
                let parts = [THIRD_SHARE * acting, CUT_MARGIN * cut];
                let growing = response.growing(sizes, p, duration, parts) * (1.0 + FURTHER * corrections.size);
                let left = ACTIONS_MARGIN * response.of_actions(left, duration);
                let slow = SLOW_SHARE * corrections.slow * (slope + corrections.slow)
                    + RESONANT_PAIRS_MARGIN * short_period.resonant * (1.0 + PAIRS_THIRD_ORDER * corrections.size);
                let bounded = SHORT_PERIOD_MARGIN * short_period.largest;
                let spin = bounded + growing + slow + left + FIRST_MARGIN * apart;
                (spin, AT_ONCE_SHARE * corrections.at_once + corrections.resonant)
            }
            None => {
                let second = response.second_order(sizes, p, duration);
                (SECOND_ORDER_MARGIN * second, corrections.dropped + 2.0 * corrections.rest)
            }
        };
        Self {
            spin,
            orbit,
            dropped,
            omitted: corrections.omitted + subject.omitted(mean_motion) * (1.0 + orbital),
            rounding: 4.0 * f64::EPSILON * inertia.sigma * (anomaly.abs() + longitude.abs()) * duration,
            orbits: orbital / TAU,
        }
    }

    /// Whether the equations are averaged over the orbit as well.
    pub(super) fn by_orbit(&self, request: &Request<'_>) -> Result<bool, Error> {
        let too_far = request.spanned && self.orbits > MOST_ORBITS;
        match request.averaging {
            Averaging::Orbit => Ok(true),
            // Second order is for accuracy, which the average over the orbit takes from it.
            Averaging::Auto => Ok(too_far || request.level != Level::SecondOrder && self.orbit <= request.tolerance),
            Averaging::Spin if too_far => Err(Error::TooManyOrbits { orbits: self.orbits, bound: MOST_ORBITS }),
            Averaging::Spin => Ok(false),
        }
    }

    pub(super) fn error(&self, by_orbit: bool) -> f64 {
        let averaged = self.spin + if by_orbit { self.orbit } else { 0.0 };
        averaged + self.dropped + self.omitted + self.rounding
    }
}

impl Subject<'_> {
    /// Turn of the attitude for a unit of the phase integral Ψ.
    fn phase(&self) -> f64 {
        self.drift.abs() * (self.response.visible + self.inertia.sigma)
    }

    /// The error of the averages in one radian of the orbit, if the level takes them at J = 0.
    fn omitted(&self, mean_motion: f64) -> f64 {
        let [axial, slope] = self.corrections.axial_omitted;
        let scale = mean_motion / self.ellipse.eta_cubed();
        let phase = slope * (self.response.visible + self.inertia.sigma);
        scale * (4.5 * axial + 2.0 * phase)
    }

    /// The largest first-order change of the attitude, and the largest change of p.
    fn largest_change(&self, orbital: f64) -> [f64; 2] {
        let precession = (0.5 * self.ellipse.strength().abs() * orbital).min(PI);
        let sample = |k: usize| {
            let [first, second, third, fourth] = kronecker(k);
            let turn = UnitQuaternion::from_axis_angle(&self.ellipse.normal(), precession * (2.0 * fourth - 1.0));
            Sample { angles: [first, second], orbital: self.place(k, third), turn }
        };
        self.largest_among(&(0..SAMPLES).map(sample).collect::<Vec<_>>())
    }

    /// A mean anomaly within the span. Of two samples, one is uniform in the mean anomaly and one in the true anomaly.
    fn place(&self, k: usize, part: f64) -> f64 {
        let uniform = self.reach.at(part);
        if k.is_multiple_of(2) {
            return uniform;
        }
        let e = self.ellipse.eccentricity;
        let (sine, cosine) = (PI * (part - 0.5)).sin_cos();
        let eccentric = 2.0 * ((1.0 - e).sqrt() * sine).atan2((1.0 + e).sqrt() * cosine);
        let anomaly = eccentric - e * eccentric.sin();
        if self.reach.contains(anomaly) { anomaly } else { uniform }
    }
}

/// A point of a sequence that fills the unit cube of four dimensions evenly: multiples of the powers of the root of x⁵ = x + 1.
fn kronecker(k: usize) -> [f64; 4] {
    const ROOT: f64 = 1.167_303_978_261_418_7;
    std::array::from_fn(|i| ((k as f64 + 0.5) / ROOT.powi(i as i32 + 1)).fract())
}
