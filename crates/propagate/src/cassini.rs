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
/// - [`Error::Orbit`] for a node rate of 0, and for a hyperbola.
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

#[cfg(test)]
mod tests {
    use crate::cassini::{Body, CassiniState, Orbit, cassini_states};

    fn states(node_rate: f64, inclination: f64) -> usize {
        let orbit = Orbit::new(0.02, 0.0).and_then(|orbit| orbit.plane(inclination, 0.0, 0.0));
        let orbit = orbit.and_then(|orbit| orbit.secular_rates(node_rate, 0.0)).expect("an orbit");
        cassini_states(&Body::new([0.9, 0.9, 1.0]).expect("a body"), &orbit, 1.0).expect("states").len()
    }

    #[test]
    fn two_states_merge_at_the_critical_ratio_of_the_rates() {
        // α_p = (3/2) 0.02² 0.1 = 6e-5.
        for inclination in [0.01, 0.2, 0.7, 1.4_f64] {
            let (sine, cosine) = inclination.sin_cos();
            let critical = 6e-5 * (sine.powf(2.0 / 3.0) + cosine.powf(2.0 / 3.0)).powf(-1.5);
            assert_eq!(states(-critical * (1.0 - 1e-9), inclination), 4, "{inclination}");
            assert_eq!(states(-critical * (1.0 + 1e-9), inclination), 2, "{inclination}");
        }
    }

    /// The state whose pole is beyond inertial axis 3, seen from the normal: that of the Moon and of Mercury.
    fn state(moments: [f64; 3], orbit: &Orbit, spin_rate: f64) -> CassiniState {
        let states = cassini_states(&Body::new(moments).expect("a body"), orbit, spin_rate).expect("states");
        let near = |state: &&CassiniState| state.stable && state.obliquity.abs() < 0.5;
        states.iter().find(near).copied().expect("a stable state near the normal")
    }

    #[test]
    fn the_moon_is_inclined_to_the_ecliptic_as_observed() {
        // The equator of the Moon is inclined to the ecliptic by 1.54°. Input: the observed (C − A)/B, (B − A)/C, G m of the Earth, distance and months. Rates
        // in rad/day.
        let day = |period: f64| std::f64::consts::TAU / period;
        let (anomalistic, draconic, node) = (day(27.554_550), day(27.212_221), -day(6798.38));
        let attraction = 398_600.435 / 384_399.014_f64.powi(3) * 86_400.0 * 86_400.0;
        let inclination = 5.145_396_4_f64.to_radians();
        let orbit = Orbit::new(anomalistic, 0.0549)
            .and_then(|orbit| {
                orbit.plane(inclination, 0.0, 0.0)?.secular_rates(node, draconic - anomalistic)?.attraction(attraction)
            })
            .expect("the orbit of the Moon");
        let moon = state([0.999_369_23, 0.999_596_96, 1.0], &orbit, day(27.321_662));
        assert_eq!(moon.resonance, Some(1.0));
        let tilt = (moon.obliquity + inclination).to_degrees();
        assert!((tilt + 1.54).abs() <= 0.01, "{tilt}");
    }

    #[test]
    fn mercury_is_inclined_to_its_orbit_as_observed() {
        // Margot et al. 2012: C/M R² = 0.346 from the observed obliquity of 2.04 ± 0.08′. Gravity field: J₂ = 5.03e-5, C₂₂ = 0.81e-5; Laplace plane at 8.53°,
        // node in 325,513 years (Stark et al. 2015).
        let (polar, oblateness, triaxiality) = (0.346, 5.03e-5, 4.0 * 0.81e-5);
        let a = 1.0 - (oblateness + 0.5 * triaxiality) / polar;
        let motion = std::f64::consts::TAU / 87.969_349_6;
        let node = -std::f64::consts::TAU / (325_513.0 * 365.25);
        let orbit = Orbit::new(motion, 0.205_630)
            .and_then(|orbit| orbit.plane(8.53_f64.to_radians(), 0.0, 0.0)?.secular_rates(node, 0.0))
            .expect("the orbit of Mercury");
        let mercury = state([a, a + triaxiality / polar, 1.0], &orbit, 6.138_518_04_f64.to_radians());
        assert_eq!(mercury.resonance, Some(1.5));
        let obliquity = 60.0 * mercury.obliquity.to_degrees();
        assert!((obliquity - 2.04).abs() <= 0.02, "{obliquity}");
    }

    #[test]
    fn a_spin_outside_the_width_of_a_resonance_has_the_states_of_a_fast_body() {
        let orbit = Orbit::new(0.02, 0.0)
            .and_then(|orbit| orbit.plane(0.2, 0.0, 0.0)?.secular_rates(-1e-6, 0.0))
            .expect("an orbit");
        let width = 0.02 * (3.0 * 0.01_f64).sqrt();
        let resonance = |by: f64| state([0.98, 0.99, 1.0], &orbit, 0.02 - 1e-6 * 0.2_f64.cos() + by * width).resonance;
        assert_eq!([-1.001, -0.999, 0.0, 0.999, 1.001].map(resonance), [None, Some(1.0), Some(1.0), Some(1.0), None]);
        // On a circle no other multiple of half a rotation is a resonance.
        assert_eq!(state([0.98, 0.99, 1.0], &orbit, 0.03).resonance, None);
    }

    #[test]
    fn a_body_with_thousands_of_rotations_an_orbit_is_in_no_resonance() {
        // Quadratures with fewer points than twice the harmonic gave false coefficients, 1 for 2p = 10,306 on a circle.
        for eccentricity in [0.0, 0.2229, 0.5] {
            let orbit = Orbit::new(1e-4, eccentricity)
                .and_then(|orbit| orbit.plane(0.2, 0.0, 0.0)?.secular_rates(-1e-9, 0.0))
                .expect("an orbit");
            for double in (3000..11_000).step_by(7).chain([10_306]) {
                let spin_rate = 0.5e-4 * f64::from(double);
                let states = cassini_states(&Body::new([0.5, 0.8, 1.0]).expect("a body"), &orbit, spin_rate);
                assert_eq!(states.expect("states")[0].resonance, None, "{eccentricity} {double}");
            }
        }
    }
}
