//! The estimate of the attitude error over the span.
//!
//! Let ε be a quarter of the root of the sum of the squared sizes of all terms, about the largest first-order change \[rad\]. The error has three physical parts:
//!
//! 1. the periodic change of the next order, ε²;
//! 2. the drift of the next order: ε times the drift that a relative change ε of the mean variables makes, in second order ε² times it; and the drift by the
//!    errors of the mean M and L at the epoch;
//! 3. the effect of terms in resonance ([`crate::gravity_gradient::terms::regime`]).
//!
//! The first part and both drifts have one safety factor each, below; the third is an upper estimate. Dropped terms, truncated sums, terms that the level omits, the average over the orbit, and rounding follow.
//! `gradient safety` of the test crate measures the factors against integrations.

use std::f64::consts::TAU;

use crate::error::Error;
use crate::gravity_gradient::averaged::averages::Averages;
use crate::gravity_gradient::averaged::spin::MOST_QUARTERS;
use crate::gravity_gradient::constants::{CONVERGED, DRIFT, EPOCH, ORBIT, PERIODIC};
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::first_order::corrections::Corrections;
use crate::gravity_gradient::first_order::mean_motion::MeanMotion;
use crate::gravity_gradient::request::Request;
use crate::gravity_gradient::terms::term::Sensitivity;
use crate::input::options::{Averaging, Level};
use crate::orbit::position::eta;

/// Number of orbits on each side of the epoch for which quarters are kept.
pub(crate) const MOST_ORBITS: usize = MOST_QUARTERS / 4 - 2;

/// The error of the equations that are averaged over the rotation alone, and what the average over the orbit adds, with their safety factors \[rad\]. `left` has
/// the errors of the mean M and L at the epoch, over M, if these are known to the order of the level.
pub(crate) fn errors(
    MeanMotion { inertia, corrections, .. }: &MeanMotion,
    averages: &Averages,
    orbits: &[Disturbance<'_>],
    (level, left): (Level, [f64; 2]),
) -> [f64; 2] {
    let response = Sensitivity::new(inertia);
    let duration = orbits[0].duration;
    let sum = |part: fn(&Corrections) -> f64| corrections.iter().map(part).sum::<f64>();
    let largest = |part: fn(&Disturbance<'_>) -> f64| orbits.iter().map(part).fold(0.0, f64::max);
    let change = 0.25 * sum(|corrections| corrections.rms);
    let drift = response.drift(change) * change * duration;
    let drift = match level {
        Level::SecondOrder => drift * change * largest(|orbit| orbit.envelope.cube),
        _ => drift * corrections.iter().zip(orbits).map(|(terms, orbit)| share(terms, orbit)).fold(0.0, f64::max),
    };
    let omitted = corrections.iter().zip(orbits).map(|(corrections, orbit)| omitted(corrections, &response, orbit));
    // Rounding of σ to a double in the phases. The iteration to the mean M and L ends at its own threshold.
    let [anomaly, longitude] = inertia.rate_slopes.map(f64::abs);
    let rounding = 4.0 * f64::EPSILON * inertia.sigma * (anomaly + longitude) * duration
        + response.of_actions([CONVERGED; 2], duration);
    let spin = PERIODIC * change * change
        + DRIFT * drift
        + EPOCH * response.of_actions(left, duration)
        + sum(|corrections| corrections.resonant)
        + sum(|corrections| corrections.dropped)
        + averages.steady().unsteady
        + omitted.sum::<f64>()
        + rounding;
    [spin, ORBIT * averages.over_orbit_error(&response, inertia, &orbits[0], level)]
}

/// Whether the equations are averaged over the orbit as well. This average adds `error` \[rad\].
pub(crate) fn by_orbit(request: &Request<'_>, orbit: &Disturbance<'_>, error: f64) -> Result<bool, Error> {
    let fixed = request.is_fixed();
    let orbits = orbit.mean_motion * orbit.duration / TAU;
    let too_far = request.spanned && orbits > MOST_ORBITS as f64;
    match request.averaging {
        Averaging::Orbit if !fixed => {
            Err(Error::OneFixedOrbit { argument: "averaging", value: Averaging::Orbit.to_string() })
        }
        Averaging::Orbit => Ok(true),
        _ if !fixed => Ok(false),
        // Second order is chosen for accuracy, and the average over the orbit would lose it.
        Averaging::Auto => Ok(too_far || request.level != Level::SecondOrder && error <= request.tolerance),
        Averaging::Spin if too_far => Err(Error::TooManyOrbits { orbits, bound: MOST_ORBITS as f64 }),
        Averaging::Spin => Ok(false),
    }
}

/// The mean square of the changes by all terms over the span, over the square of their largest ones. The sums over time derivatives fall with (a/r)³; a slow term with exact
/// divisors has the same size around the whole orbit.
fn share(Corrections { exact: [largest, mean], .. }: &Corrections, orbit: &Disturbance<'_>) -> f64 {
    (1.0 - largest) * orbit.envelope.square + mean.max(largest * orbit.envelope.square)
}

/// The error by the terms that the level omits: short-period terms, and the tilt in the averages.
fn omitted(corrections: &Corrections, response: &Sensitivity, orbit: &Disturbance<'_>) -> f64 {
    let [axial, slope] = corrections.axial_omitted;
    let scale = orbit.mean_motion * eta(orbit.orbit.eccentricity()).powi(-3);
    let rate = scale * (4.5 * axial + 2.0 * slope * (response.visible + response.sigma));
    corrections.omitted + rate * (1.0 + orbit.mean_motion * orbit.duration)
}
