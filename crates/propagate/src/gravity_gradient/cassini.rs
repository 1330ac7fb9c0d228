//! Cassini states: the axis of a body that keeps its place relative to a precessing orbit (Colombo 1966). The equations are derived here from theory §9.
//!
//! The body rotates about its axis of greatest inertia, fast and out of resonance with its orbit. Its pole k precesses about the normal N of the orbit with −α (k·N), where
//! α = (3/2) (G m/a³) η^(−3) (C − (A+B)/2)/(C ω) (theory §9), and N goes about inertial axis 3, ẑ, with the rate g of the node at the inclination i. In the frame that turns with the node
//!
//! ```text
//! dk/dt = −α (k·N) N × k − g ẑ × k,        h = −½ α cos²θ − g cos(i + θ),        dh/dθ = α cos θ sin θ + g sin(i + θ) = 0
//! ```
//!
//! for a pole in the plane of ẑ and N at the angle θ from N, counted away from ẑ. There are four states if |g/α| is below (sin^(2/3) i + cos^(2/3) i)^(−3/2), else two. A state is stable where
//! h has an extremum on the sphere.

use std::f64::consts::{PI, TAU};

use crate::error::Error;
use crate::input::body::Body;
use crate::input::orbit::Orbit;

/// Intervals in which sign changes of the slope are searched.
const INTERVALS: usize = 720;
/// Halvings of an interval: beyond the digits of a double.
const HALVINGS: usize = 64;

/// A Cassini state.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CassiniState {
    /// θ, the angle from the normal of the orbit to the pole of the body \[rad\], in (−π, π]: positive away from inertial axis 3, in the plane of both.
    pub obliquity: f64,
    /// Whether nearby poles stay near.
    pub stable: bool,
    /// Frequency of small librations about a stable state, or the rate at which poles leave an unstable one [rad per unit of time].
    pub rate: f64,
}

/// The Cassini states of a body with a rate of rotation, in the order of their obliquities.
///
/// The orbit must have a rate of its node. The formula holds for a body that rotates about its axis of greatest inertia, much faster than its orbit and not in resonance with it.
///
/// # Errors
/// - [`Error::Orbit`] for a node rate of 0.
/// - [`Error::Positive`] for a spin rate of 0, −1, NaN or infinite.
///
/// ```
/// use andoyer_propagate::disturbers::cassini_states;
/// use andoyer_propagate::{Body, Orbit};
/// let orbit = Orbit::new(0.02, 0.0)?.plane(0.2, 0.0, 0.0)?.secular_rates(-1e-5, 0.0)?;
/// let states = cassini_states(&Body::new([0.9, 0.9, 1.0])?, &orbit, 1.0)?;
/// assert_eq!(states.iter().filter(|state| state.stable).count(), 3);
/// let theta = states[1].obliquity;
/// assert!((6e-5 * theta.cos() * theta.sin() - 1e-5 * (0.2 + theta).sin()).abs() < 1e-18);
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
pub fn cassini_states(body: &Body, orbit: &Orbit, spin_rate: f64) -> Result<Vec<CassiniState>, Error> {
    if !(spin_rate > 0.0 && spin_rate.is_finite()) {
        return Err(Error::Positive { argument: "spin_rate", value: spin_rate });
    }
    let [node_rate, _] = orbit.rates();
    if node_rate == 0.0 {
        return Err(Error::Orbit { argument: "node_rate", value: node_rate, bound: "not 0 for Cassini states" });
    }
    let top = Top { alpha: precession(body, orbit, spin_rate), node_rate, inclination: orbit.elements()[3] };
    let extremes = roots(&evenly(), |theta| top.curvatures(theta)[0]);
    let places = if extremes.is_empty() { evenly() } else { extremes };
    let mut states: Vec<CassiniState> =
        roots(&places, |theta| top.slope(theta)).into_iter().map(|theta| top.state(theta)).collect();
    states.sort_by(|one, other| one.obliquity.total_cmp(&other.obliquity));
    Ok(states)
}

/// α.
fn precession(body: &Body, orbit: &Orbit, spin_rate: f64) -> f64 {
    let mut moments = body.moments();
    moments.sort_by(f64::total_cmp);
    let [a, b, c] = moments;
    let e = orbit.eccentricity();
    let eta = ((1.0 - e) * (1.0 + e)).sqrt();
    1.5 * orbit.strength() / (eta * eta * eta) * (0.5 * ((c - a) + (c - b)) / c) / spin_rate
}

/// Colombo's top.
struct Top {
    alpha: f64,
    node_rate: f64,
    inclination: f64,
}

impl Top {
    /// dh/dθ.
    fn slope(&self, theta: f64) -> f64 {
        self.alpha * theta.cos() * theta.sin() + self.node_rate * (self.inclination + theta).sin()
    }

    /// Second derivatives of h along the plane of the state and across it.
    fn curvatures(&self, theta: f64) -> [f64; 2] {
        let turned = self.node_rate * (self.inclination + theta).cos();
        let (sine, cosine) = theta.sin_cos();
        [self.alpha * (cosine - sine) * (cosine + sine) + turned, self.alpha * cosine * cosine + turned]
    }

    fn state(&self, theta: f64) -> CassiniState {
        let [along, across] = self.curvatures(theta);
        let product = along * across;
        let obliquity = if theta > PI { theta - TAU } else { theta };
        CassiniState { obliquity, stable: product > 0.0, rate: product.abs().sqrt() }
    }
}

/// Angles around the circle, none of which is a likely root.
fn evenly() -> Vec<f64> {
    (0..INTERVALS).map(|k| -PI + TAU * (k as f64 + 0.4142) / INTERVALS as f64).collect()
}

/// The roots of a function between neighbouring places on the circle at which its signs differ.
fn roots(places: &[f64], function: impl Fn(f64) -> f64) -> Vec<f64> {
    let next = places.iter().skip(1).copied().chain(places.first().map(|first| first + TAU));
    let mut found = Vec::new();
    for (&start, stop) in places.iter().zip(next) {
        let sign = function(start) > 0.0;
        if sign == (function(stop) > 0.0) {
            continue;
        }
        let (mut low, mut high) = (start, stop);
        for _ in 0..HALVINGS {
            let middle = low + 0.5 * (high - low);
            if (function(middle) > 0.0) == sign { low = middle } else { high = middle }
        }
        found.push(low + 0.5 * (high - low));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{Body, Orbit, cassini_states};

    fn states(node_rate: f64, inclination: f64) -> usize {
        let orbit = Orbit::new(0.02, 0.0).and_then(|orbit| orbit.plane(inclination, 0.0, 0.0));
        let orbit = orbit.and_then(|orbit| orbit.secular_rates(node_rate, 0.0)).expect("an orbit");
        cassini_states(&Body::new([0.9, 0.9, 1.0]).expect("a body"), &orbit, 1.0).expect("states").len()
    }

    #[test]
    fn two_states_merge_at_the_critical_ratio_of_the_rates() {
        // α = (3/2) 0.02² 0.1 = 6e-5.
        for inclination in [0.01, 0.2, 0.7, 1.4_f64] {
            let (sine, cosine) = inclination.sin_cos();
            let critical = 6e-5 * (sine.powf(2.0 / 3.0) + cosine.powf(2.0 / 3.0)).powf(-1.5);
            assert_eq!(states(-critical * (1.0 - 1e-9), inclination), 4, "{inclination}");
            assert_eq!(states(-critical * (1.0 + 1e-9), inclination), 2, "{inclination}");
        }
    }
}
