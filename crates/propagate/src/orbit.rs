//! The relative orbit of a disturbing body: Kepler's, any ellipse, in any plane.
//!
//! Elements are those of the inertial frame of the scene. Kepler's equation is solved without a loop that could run out: Markley's starter (Celest. Mech. Dyn. Astron.
//! 63 (1995) 101), good to 1e-4, then two steps of third order with a residual that is formed without cancellation, (1−e)E + e(E − sin E) − M.

use std::f64::consts::{PI, TAU};

use andoyer_series::DoubleDouble;
use nalgebra::{UnitQuaternion, Vector3};

use crate::error::Error;
use crate::kernel::lanes::Lanes;
use crate::kernel::level::Level;
use crate::kernel::sincos::{sin_cos_of_turns, twice_arc};
use crate::phase::Phase;

/// Radians of the mean anomaly beyond which a double has no phase.
const MOST_TURNS: f64 = TAU * 1e15;

/// A Keplerian orbit of the disturbing body about the rotating one.
///
/// ```
/// use andoyer_propagate::Orbit;
/// let year = 2.0 * std::f64::consts::PI;
/// let orbit = Orbit::new(year, 0.0167)?.plane(0.409, 0.0, 1.8)?.mass_fraction(1.0)?;
/// assert!((orbit.true_anomaly(0.5)? - std::f64::consts::PI).abs() < 1e-15); // half a period from pericentre to apocentre
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    mean_motion: f64,
    eccentricity: f64,
    time_of_pericentre: f64,
    inclination: f64,
    node: f64,
    argument_of_pericentre: f64,
    mass_fraction: f64,
}

impl Orbit {
    /// An orbit from its mean motion n [rad per unit of time] and eccentricity e, in the inertial x, y plane, with its pericentre on the x axis at time 0.
    ///
    /// n²a³ is G times the sum of the two masses; the disturbing one is all of it until [`Orbit::mass_fraction`] says otherwise.
    ///
    /// # Errors
    /// - [`Error::Orbit`] for a mean motion of 0, −1, NaN, or an eccentricity of −0.1, 1, NaN.
    pub fn new(mean_motion: f64, eccentricity: f64) -> Result<Self, Error> {
        check("mean_motion", mean_motion, mean_motion > 0.0 && mean_motion.is_finite(), "positive and finite")?;
        check("eccentricity", eccentricity, (0.0..1.0).contains(&eccentricity), "0 or more and less than 1")?;
        Ok(Self {
            mean_motion,
            eccentricity,
            time_of_pericentre: 0.0,
            inclination: 0.0,
            node: 0.0,
            argument_of_pericentre: 0.0,
            mass_fraction: 1.0,
        })
    }

    /// A time of a passage of the pericentre.
    ///
    /// # Errors
    /// - [`Error::Orbit`] for NaN or infinite.
    pub fn time_of_pericentre(self, time: f64) -> Result<Self, Error> {
        finite("time_of_pericentre", time)?;
        Ok(Self { time_of_pericentre: time, ..self })
    }

    /// Inclination, longitude of the node and argument of the pericentre \[rad\].
    ///
    /// # Errors
    /// - [`Error::Orbit`] for NaN or infinite.
    pub fn plane(self, inclination: f64, node: f64, argument_of_pericentre: f64) -> Result<Self, Error> {
        finite("inclination", inclination)?;
        finite("node", node)?;
        finite("argument_of_pericentre", argument_of_pericentre)?;
        Ok(Self { inclination, node, argument_of_pericentre, ..self })
    }

    /// The disturbing mass over the sum of both: 1 for the Sun on an asteroid, 1/82.3 for the Moon on the Earth.
    ///
    /// # Errors
    /// - [`Error::Orbit`] for 0, −1, 1.1, NaN.
    pub fn mass_fraction(self, fraction: f64) -> Result<Self, Error> {
        check("mass_fraction", fraction, fraction > 0.0 && fraction <= 1.0, "greater than 0 and at most 1")?;
        Ok(Self { mass_fraction: fraction, ..self })
    }

    /// Mean motion n, eccentricity, time of pericentre, inclination, node, argument of pericentre, mass fraction.
    pub fn elements(&self) -> [f64; 7] {
        [
            self.mean_motion,
            self.eccentricity,
            self.time_of_pericentre,
            self.inclination,
            self.node,
            self.argument_of_pericentre,
            self.mass_fraction,
        ]
    }

    /// Angles of the elements beyond a whole turn, by name \[rad\]: they are taken as they are, but are often degrees given by mistake.
    ///
    /// ```
    /// let orbit = andoyer_propagate::Orbit::new(1e-3, 0.1)?.plane(23.4, 0.0, 6.0)?;
    /// assert_eq!(orbit.beyond_a_turn().collect::<Vec<_>>(), [("inclination", 23.4)]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn beyond_a_turn(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let names = ["inclination", "node", "argument_of_pericentre"];
        let angles = [self.inclination, self.node, self.argument_of_pericentre];
        names.into_iter().zip(angles).filter(|(_, angle)| angle.abs() > TAU)
    }

    pub(crate) fn eccentricity(&self) -> f64 {
        self.eccentricity
    }

    pub(crate) fn mean_motion(&self) -> f64 {
        self.mean_motion
    }

    pub(crate) fn disturbing_fraction(&self) -> f64 {
        self.mass_fraction
    }

    /// Unit vectors to the pericentre, across it in the direction of motion, and along the orbital angular momentum; inertial components.
    pub(crate) fn axes(&self) -> [Vector3<f64>; 3] {
        let about = UnitQuaternion::from_axis_angle;
        let turn = about(&Vector3::z_axis(), self.node)
            * about(&Vector3::x_axis(), self.inclination)
            * about(&Vector3::z_axis(), self.argument_of_pericentre);
        [turn * Vector3::x(), turn * Vector3::y(), turn * Vector3::z()]
    }

    /// The mean anomaly as a phase from an epoch on.
    pub(crate) fn mean_anomaly(&self, epoch: f64) -> Phase {
        let since = DoubleDouble::sum(epoch, -self.time_of_pericentre);
        let angle = since * DoubleDouble::from(self.mean_motion);
        let turns = angle / (DoubleDouble::PI * DoubleDouble::from(2.0));
        let rest = turns - DoubleDouble::from(turns.high.round());
        Phase::new(self.mean_motion.into(), TAU * rest.to_f64())
    }

    /// Whether there is a mean anomaly at an epoch.
    pub(crate) fn within_reach(&self, epoch: f64) -> Result<(), Error> {
        let bounded = (epoch - self.time_of_pericentre).abs() * self.mean_motion <= MOST_TURNS;
        check("time_of_pericentre", self.time_of_pericentre, bounded, "within 1e15 periods of the epoch of the state")
    }

    /// The true anomaly at a time, in (−π, π] \[rad\].
    ///
    /// # Errors
    /// - [`Error::Orbit`] for a time that is NaN, infinite, or more than 1e15 periods from the epoch of the elements.
    pub fn true_anomaly(&self, time: f64) -> Result<f64, Error> {
        let bounded = (time - self.time_of_pericentre).abs() * self.mean_motion <= MOST_TURNS;
        check("time", time, bounded, "finite and within 1e15 periods of the pericentre")?;
        let anomaly = self.mean_anomaly(self.time_of_pericentre).angle((time - self.time_of_pericentre, 0.0));
        // Half a turn may come out on either side.
        let anomaly = if anomaly == -PI { PI } else { anomaly };
        Ok(Place::of(Lanes::splat(pulp::Scalar, anomaly), self.eccentricity).angle.values()[0])
    }
}

fn check(argument: &'static str, value: f64, holds: bool, bound: &'static str) -> Result<(), Error> {
    if holds { Ok(()) } else { Err(Error::Orbit { argument, value, bound }) }
}

fn finite(argument: &'static str, value: f64) -> Result<(), Error> {
    check(argument, value, value.is_finite(), "finite")
}

/// Where on its ellipse the disturbing body is, at some times.
#[derive(Clone, Copy)]
pub(crate) struct Place<S: Level> {
    /// The true anomaly, in [−π, π] \[rad\].
    pub(crate) angle: Lanes<S>,
    /// The true anomaly less the mean one, by no difference of them.
    pub(crate) centre: Lanes<S>,
    /// Sine and cosine of the true anomaly.
    pub(crate) sine: Lanes<S>,
    pub(crate) cosine: Lanes<S>,
}

impl<S: Level> Place<S> {
    /// From the mean anomaly, in [−π, π] or a rounding beyond.
    #[inline(always)]
    pub(crate) fn of(mean_anomaly: Lanes<S>, eccentricity: f64) -> Self {
        let all = |value: f64| mean_anomaly.all(value);
        if eccentricity == 0.0 {
            let (sine, cosine) = sin_cos_of_turns(mean_anomaly * all(1.0 / TAU));
            return Self { angle: mean_anomaly, centre: all(0.0), sine, cosine };
        }
        let anomaly = eccentric_anomaly(mean_anomaly, eccentricity);
        let (sine, cosine) = sin_cos_of_turns(anomaly * all(0.5 / TAU));
        let (y, x) = (sine * all((1.0 + eccentricity).sqrt()), cosine * all((1.0 - eccentricity).sqrt()));
        let scale = y.mul_add(y, x * x).reciprocal();
        // tan (f − E)/2 = β sin E/(1 − β cos E), e = 2β/(1 + β²), and E − M = e sin E.
        let beta = eccentricity / (1.0 + ((1.0 - eccentricity) * (1.0 + eccentricity)).sqrt());
        let product = sine * cosine;
        let across = product * all(2.0 * beta);
        let along = (sine * sine).mul_add(all(2.0 * beta), all(1.0 - beta));
        let ahead = twice_arc(across, along);
        let centre = product.mul_add(all(2.0 * eccentricity), ahead);
        Self { angle: anomaly + ahead, centre, sine: (x * y) * (scale + scale), cosine: ((x - y) * (x + y)) * scale }
    }
}

/// E from Kepler's equation E − e sin E = M, for M in [−π, π] and 0 ≤ e < 1.
#[inline(always)]
pub(crate) fn eccentric_anomaly<S: Level>(m: Lanes<S>, e: f64) -> Lanes<S> {
    let all = |value: f64| m.all(value);
    let mut anomaly = starter(m, e);
    for _ in 0..2 {
        let (half_sine, half_cosine) = sin_cos_of_turns(anomaly * all(0.5 / TAU));
        let sine = (half_sine + half_sine) * half_cosine;
        let versed = (half_sine + half_sine) * half_sine;
        let slope = versed.mul_add(all(e), all(1.0 - e));
        let residual = anomaly.mul_add(all(1.0 - e), excess(anomaly, sine).mul_add(all(e), -m));
        // Third order (Halley), then fourth, from the second and third derivatives e sin E and e cos E.
        let (second, third) = (sine * all(0.5 * e), versed.negate_mul_add(all(e / 6.0), all(e / 6.0)));
        let newton = residual / slope;
        let halley = residual / newton.negate_mul_add(second, slope);
        anomaly = anomaly - residual / (halley * halley).mul_add(third, halley.negate_mul_add(second, slope));
    }
    anomaly
}

/// E − sin E without cancellation.
#[inline(always)]
fn excess<S: Level>(anomaly: Lanes<S>, sine: Lanes<S>) -> Lanes<S> {
    // x³/3! − x⁵/5! + …: the term x^21/21! is 2e-20 of the sum at x = 1.
    let square = anomaly * anomaly;
    let mut sum = anomaly.all(0.0);
    for k in (1..=9_i32).rev() {
        sum = (anomaly.all(1.0) - sum) * square * anomaly.all(1.0 / f64::from(2 * k * (2 * k + 1)));
    }
    anomaly.magnitude().up_to(1.0, anomaly * sum, anomaly - sine)
}

/// The root of the cubic that a Padé approximation of the sine makes of Kepler's equation.
#[inline(always)]
fn starter<S: Level>(m: Lanes<S>, e: f64) -> Lanes<S> {
    let all = |value: f64| m.all(value);
    let scale = 1.6 * PI / (1.0 + e) / (PI * PI - 6.0);
    let alpha = (all(PI) - m.magnitude()).mul_add(all(scale), all(3.0 * PI * PI / (PI * PI - 6.0)));
    let d = alpha.mul_add(all(e), all(3.0 * (1.0 - e)));
    let (square, product) = (m * m, alpha * d);
    let q = product.mul_add(all(2.0 * (1.0 - e)), -square);
    let r = m * (product * all(3.0)).mul_add(d - all(1.0 - e), square);
    let radicand = (q * q).mul_add(q, r * r);
    let radicand = radicand.up_to(0.0, all(0.0), radicand);
    let root = (r.magnitude() + radicand.root()).each(f64::cbrt);
    let w = root * root;
    ((r + r) * w / q.mul_add(q, w * (w + q)) + m) / d
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(value: f64) -> Lanes<pulp::Scalar> {
        Lanes::splat(pulp::Scalar, value)
    }

    fn solved(m: f64, e: f64) -> f64 {
        eccentric_anomaly(one(m), e).values()[0]
    }

    #[test]
    fn the_eccentric_anomaly_solves_keplers_equation_to_the_last_bits_for_any_ellipse() {
        // M from E in double-double, so that the root is known; what M rounds to moves E by its half unit over 1 − e cos E.
        for e in [0.0, 1e-9, 0.1, 0.5, 0.9, 0.99, 0.999_999, 1.0 - 1e-12, 1.0 - f64::EPSILON] {
            for k in 0..=2000 {
                let anomaly =
                    if k % 2 == 0 { PI * f64::from(k) / 2000.0 } else { 10.0_f64.powf(-f64::from(k) / 100.0) };
                let exact = DoubleDouble::sum(1.0, -e) * anomaly.into() + DoubleDouble::from(e) * tail(anomaly);
                let m = exact.to_f64();
                let slope = (1.0 - e) + 2.0 * e * (0.5 * anomaly).sin().powi(2);
                let found = solved(m, e);
                let error = (found - anomaly).abs();
                let budget = 4.5e-16 * anomaly + 1.2e-16 * m / slope;
                assert!(error <= budget, "e = {e}, E = {anomaly}: off by {error:e} of {budget:e}");
                assert_eq!(solved(-m, e), -found);
            }
        }
    }

    /// E − sin E in double-double.
    fn tail(anomaly: f64) -> DoubleDouble {
        let x = DoubleDouble::from(anomaly);
        let square = x * x;
        let sum = (1..=30_i32)
            .rev()
            .fold(DoubleDouble::ZERO, |sum, k| (DoubleDouble::ONE - sum) * square.over(f64::from(2 * k * (2 * k + 1))));
        x * sum
    }

    #[test]
    fn true_anomaly_is_that_of_the_geometry() {
        for e in [0.0, 0.3, 0.97] {
            for k in -50..=50 {
                let mean = PI * f64::from(k) / 50.0;
                let place = Place::of(one(mean), e);
                let anomaly = solved(mean, e);
                let [sine, cosine, angle, centre] =
                    [place.sine, place.cosine, place.angle, place.centre].map(|l| l.values()[0]);
                let r = 1.0 - e * anomaly.cos();
                assert!((cosine - (anomaly.cos() - e) / r).abs() < 1e-14 / (1.0 - e));
                assert!((sine - (1.0 - e * e).sqrt() * anomaly.sin() / r).abs() < 1e-14 / (1.0 - e));
                assert!((angle.sin() - sine).abs() < 1e-15);
                assert!((centre - (angle - mean)).abs() < 1e-15);
            }
        }
    }
}
