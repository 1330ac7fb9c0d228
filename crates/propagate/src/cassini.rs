//! Cassini states: the axis of a body that keeps its place relative to a precessing orbit (Colombo 1966, Peale 1969). The equations are derived here from
//! theory §9.
//!
//! The body rotates about its axis of greatest inertia. Its pole k precesses about the normal n̂ of the orbit, and n̂ goes about inertial axis 3, ẑ, with the
//! rate Ω_n of the node at the inclination i. θ is the angle from n̂ to a pole in the plane of ẑ and n̂, counted away from ẑ.
//!
//! A body that rotates fast and out of resonance precesses with −α_p (k·n̂), where α_p = (3/2) (G m/a³) η^(−3) (C − (A+B)/2)/(C s) with the spin rate s (theory
//! §9). In the frame that turns with the node
//!
//! ```text
//! dk/dt = −α_p (k·n̂) n̂ × k − Ω_n ẑ × k,        h = −½ α_p cos²θ − Ω_n cos(i + θ),        dh/dθ = α_p cos θ sin θ + Ω_n sin(i + θ) = 0
//! ```
//!
//! There are four states if |Ω_n/α_p| is below (sin^(2/3) i + cos^(2/3) i)^(−3/2), else two. A state is stable where h has an extremum on the sphere.
//!
//! A body in a spin–orbit resonance makes p rotations an orbit relative to the pericentre, p = ½, 1, 1½, …, and its long axis points to the disturbing body at
//! the pericentre (or is across, where the coefficient G_p is negative). Of the potential (3/2) (G m/r³) (A x² + B y² + C z²), for the direction (x, y, z) of
//! the disturbing body about the axes of the body, the part with x² − y² then has a mean as well: −(3/2) (G m/a³) ½ (B − A) ((1 + cos θ)/2)² |G_p|, with
//! Hansen's coefficient G_p(e) = X_2p of (−3, 2), which is 1 − 5e²/2 + … for p = 1 and 7e/2 − … for p = 3/2. With γ_p = (3/2) (G m/a³) |G_p| (B − A)/(2 C s)
//!
//! ```text
//! h = −½ α_p cos²θ − ¼ γ_p (1 + cos θ)² − Ω_n cos(i + θ),        dh/dθ = α_p cos θ sin θ + ½ γ_p (1 + cos θ) sin θ + Ω_n sin(i + θ)
//! ```
//!
//! Here s is the rate of rotation relative to the node, p times the rate of the mean anomaly plus the rate of the pericentre. The terms of h with the argument
//! of the pericentre are left out; they average out as the pericentre goes around. For the circular orbit of the Moon this is the condition of Peale (1969).

use std::f64::consts::{PI, TAU};

use crate::error::Error;
use crate::input::body::Body;
use crate::orbit::elements::Orbit;
use crate::orbit::hansen::{LARGEST_NUMBER, hansen};
use crate::torque::strength;

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
    /// p, the rotations an orbit of a body in a spin–orbit resonance, or None out of resonance.
    pub resonance: Option<f64>,
}

/// The Cassini states of a body with a rate of rotation, in the order of their obliquities.
///
/// The orbit must have a rate of its node. The body rotates about its axis of greatest inertia, either much faster than its orbit or in a spin–orbit resonance:
/// with p rotations an orbit, where 2p is a whole number up to 4096. The body is taken to be in resonance if its spin rate differs from the resonant one by
/// less than the largest rate of a libration, √(3 (G m/a³) (B − A)/C |G_p|), at the obliquity 0. At the obliquity θ the resonance is narrower by (1 + cos θ)/2.
///
/// # Errors
/// - [`Error::Orbit`] for a node rate of 0, for a hyperbola, and for an attraction that is no normal double.
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
        return Err(Error::Orbit { argument: "node_rate", value: node_rate, bound: "other than 0" });
    }
    if orbit.is_hyperbola() {
        let bound = "less than 1: a hyperbola has no mean torque";
        return Err(Error::Orbit { argument: "eccentricity", value: orbit.eccentricity(), bound });
    }
    orbit.representable(0)?;
    let top = Top::new(body, orbit, spin_rate);
    let extremes = roots(&evenly(), |theta| top.curvatures(theta)[0]);
    let places = if extremes.is_empty() { evenly() } else { extremes };
    let mut states: Vec<CassiniState> =
        roots(&places, |theta| top.slope(theta)).into_iter().map(|theta| top.state(theta)).collect();
    states.sort_by(|one, other| one.obliquity.total_cmp(&other.obliquity));
    Ok(states)
}

/// A spin–orbit resonance.
struct Resonance {
    /// p.
    rotations: f64,
    /// Rate of rotation relative to the node.
    rate: f64,
    /// |G_p|.
    coefficient: f64,
}

impl Resonance {
    /// The resonance in which a body with a spin rate librates, or None.
    fn around(orbit: &Orbit, spin_rate: f64, triaxiality: f64) -> Option<Self> {
        let [node_rate, pericentre_rate] = orbit.rates();
        let from_inertial = node_rate * orbit.elements()[3].cos();
        let half = 0.5 * orbit.mean_motion();
        let rotations = 0.5 * ((spin_rate - pericentre_rate - from_inertial) / half).round();
        // The width of a resonance with more rotations is far below the rounding error of the rates, but for e beyond 0.97.
        if rotations < 0.5 || 2.0 * rotations > LARGEST_NUMBER as f64 {
            return None;
        }
        let [_, coefficient, _] = hansen(orbit.eccentricity(), (2.0 * rotations) as usize).map(f64::abs);
        let rate = rotations * orbit.mean_motion() + pericentre_rate;
        let width = (2.0 * strength(orbit.strength()) * triaxiality * coefficient).sqrt();
        ((spin_rate - rate - from_inertial).abs() < width).then_some(Self { rotations, rate, coefficient })
    }
}

/// Colombo's top, with the mean of x² − y² in a resonance.
struct Top {
    alpha: f64,
    gamma: f64,
    resonance: Option<f64>,
    node_rate: f64,
    inclination: f64,
}

impl Top {
    fn new(body: &Body, orbit: &Orbit, spin_rate: f64) -> Self {
        let mut moments = body.moments();
        moments.sort_by(f64::total_cmp);
        let [a, b, c] = moments;
        let e = orbit.eccentricity();
        let eta = ((1.0 - e) * (1.0 + e)).sqrt();
        let triaxiality = (b - a) / c;
        let resonance = Resonance::around(orbit, spin_rate, triaxiality);
        let (rate, coefficient) = resonance.as_ref().map_or((spin_rate, 0.0), |at| (at.rate, at.coefficient));
        let torque = strength(orbit.strength()) / rate;
        Self {
            alpha: torque / (eta * eta * eta) * (0.5 * ((c - a) + (c - b)) / c),
            gamma: 0.5 * torque * coefficient * triaxiality,
            resonance: resonance.map(|at| at.rotations),
            node_rate: orbit.rates()[0],
            inclination: orbit.elements()[3],
        }
    }

    /// dh/dθ.
    fn slope(&self, theta: f64) -> f64 {
        let (sine, cosine) = theta.sin_cos();
        self.precession(cosine) * sine + self.node_rate * (self.inclination + theta).sin()
    }

    /// The rate of precession about the normal, for the cosine of the obliquity.
    fn precession(&self, cosine: f64) -> f64 {
        self.alpha * cosine + 0.5 * self.gamma * (1.0 + cosine)
    }

    /// Second derivatives of h along the plane of the state and across it.
    fn curvatures(&self, theta: f64) -> [f64; 2] {
        let turned = self.node_rate * (self.inclination + theta).cos();
        let (sine, cosine) = theta.sin_cos();
        let across = self.precession(cosine) * cosine;
        [across - (self.alpha + 0.5 * self.gamma) * sine * sine + turned, across + turned]
    }

    fn state(&self, theta: f64) -> CassiniState {
        let [along, across] = self.curvatures(theta);
        let product = along * across;
        let obliquity = if theta > PI { theta - TAU } else { theta };
        CassiniState { obliquity, stable: product > 0.0, rate: product.abs().sqrt(), resonance: self.resonance }
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
