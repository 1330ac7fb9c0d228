//! The estimate of the attitude error over the span.
//!
//! Let ε be a quarter of the root of the sum of the squared sizes of all terms, about the largest first-order change \[rad\]. The error has three physical parts:
//!
//! 1. the periodic change of the next order, ε²;
//! 2. the drift of the next order: ε times the drift that a relative change ε of the mean variables makes, in second order ε² times it, and the drift by the
//!    errors of the mean M and L at the epoch;
//! 3. what is not corrected of terms in resonance ([`crate::gravity_gradient::terms::regime`]).
//!
//! Each part has one safety factor below. Dropped terms, truncated sums, terms that the level omits, the average over the orbit, and rounding follow.
//! `gradient safety` of the test crate measures the factors against integrations.

use std::f64::consts::TAU;

use crate::error::Error;
use crate::gravity_gradient::averaged::spin::MOST_QUARTERS;
use crate::gravity_gradient::averaged::torque::Averages;
use crate::gravity_gradient::body::inertia::Inertia;
use crate::gravity_gradient::first_order::corrections::Corrections;
use crate::gravity_gradient::first_order::mean_motion::CONVERGED;
use crate::gravity_gradient::orbit::elliptic_orbit::Demand;
use crate::gravity_gradient::request::Request;
use crate::gravity_gradient::terms::term::Sensitivity;
use crate::input::options::{Averaging, Level};

/// Safety factor of the periodic change of the next order.
const PERIODIC: f64 = 5.0;
/// Safety factor of the drift of the next order.
const DRIFT: f64 = 3.6;
/// Safety factor of the terms in resonance.
const RESONANT: f64 = 1.5;
/// Safety factor of the average over the orbit.
const ORBIT: f64 = 1.5;
/// Number of orbits on each side of the epoch for which quarters are kept.
pub(crate) const MOST_ORBITS: usize = MOST_QUARTERS / 4 - 2;

/// The parts of the attitude error \[rad\], with their safety factors.
pub(crate) struct Estimate {
    periodic: f64,
    drift: f64,
    resonant: f64,
    /// Terms and coefficients that are dropped, and truncated sums.
    dropped: f64,
    /// Terms that the level omits.
    omitted: f64,
    /// Rounding of σ to a double in the phases, and of the mean M and L.
    rounding: f64,
    /// The average over the orbit.
    orbit: f64,
    /// Number of orbits from the epoch to the end of the span.
    orbits: f64,
}

impl Estimate {
    /// For the torques of all bodies. `left` has the errors of the mean M and L at the epoch, over M, if these are known to the order of the level.
    pub(crate) fn new(
        inertia: &Inertia,
        corrections: &[Corrections],
        averages: &Averages,
        demands: &[Demand<'_>],
        (level, left): (Level, [f64; 2]),
    ) -> Self {
        let response = Sensitivity::new(inertia);
        let duration = demands[0].duration;
        let change = 0.25 * corrections.iter().map(|corrections| corrections.rms).sum::<f64>();
        let acting = |power: fn(&Demand<'_>) -> f64| demands.iter().map(power).fold(0.0, f64::max);
        let drift = response.drift(change) * change * duration;
        let drift = match level {
            Level::SecondOrder => drift * change * acting(|demand| demand.envelope.share.cube),
            _ => drift * acting(|demand| demand.envelope.share.square),
        };
        let sum = |part: fn(&Corrections) -> f64| corrections.iter().map(part).sum::<f64>();
        let omitted =
            corrections.iter().zip(demands).map(|(corrections, demand)| omitted(corrections, &response, demand));
        let [anomaly, longitude] = inertia.rate_slopes.map(f64::abs);
        let orbits = demands.iter().map(|demand| demand.mean_motion * duration / TAU).fold(0.0, f64::max);
        Self {
            periodic: PERIODIC * change * change,
            drift: DRIFT * (drift + response.of_actions(left, duration)),
            resonant: RESONANT * sum(|corrections| corrections.resonant),
            dropped: sum(|corrections| corrections.dropped),
            omitted: omitted.sum(),
            // The iteration to the mean M and L ends at its own threshold.
            rounding: 4.0 * f64::EPSILON * inertia.sigma * (anomaly + longitude) * duration
                + response.of_actions([CONVERGED; 2], duration),
            orbit: ORBIT * averages.over_orbit_error(&response, inertia, &demands[0], level),
            orbits,
        }
    }

    /// Whether the equations are averaged over the orbit as well.
    pub(crate) fn by_orbit(&self, request: &Request<'_>) -> Result<bool, Error> {
        if !request.is_fixed() {
            return match request.averaging {
                Averaging::Orbit => {
                    Err(Error::OneFixedOrbit { argument: "averaging", value: Averaging::Orbit.to_string() })
                }
                _ => Ok(false),
            };
        }
        let too_far = request.spanned && self.orbits > MOST_ORBITS as f64;
        match request.averaging {
            Averaging::Orbit => Ok(true),
            // Second order is for accuracy, which the average over the orbit takes from it.
            Averaging::Auto => Ok(too_far || request.level != Level::SecondOrder && self.orbit <= request.tolerance),
            Averaging::Spin if too_far => Err(Error::TooManyOrbits { orbits: self.orbits, bound: MOST_ORBITS as f64 }),
            Averaging::Spin => Ok(false),
        }
    }

    /// The sum of all parts \[rad\].
    pub(crate) fn error(&self, by_orbit: bool) -> f64 {
        let Self { periodic, drift, resonant, dropped, omitted, rounding, orbit, .. } = *self;
        periodic + drift + resonant + dropped + omitted + rounding + if by_orbit { orbit } else { 0.0 }
    }
}

/// The error by the terms that the level omits: short-period terms, and the tilt in the averages.
fn omitted(corrections: &Corrections, response: &Sensitivity, demand: &Demand<'_>) -> f64 {
    let [axial, slope] = corrections.axial_omitted;
    let e = demand.orbit.eccentricity();
    let scale = demand.mean_motion * ((1.0 - e) * (1.0 + e)).powf(-1.5);
    let rate = scale * (4.5 * axial + 2.0 * slope * (response.visible + response.sigma));
    corrections.omitted + rate * (1.0 + demand.mean_motion * demand.duration)
}
