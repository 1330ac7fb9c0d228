//! The relative orbit of a disturbing body: a Keplerian ellipse in any plane.
//!
//! The elements refer to the inertial frame of the scene. Kepler's equation is solved in lanes ([`crate::simd::kepler`]).

use std::f64::consts::{PI, TAU};

use andoyer_double::DoubleDouble;
use nalgebra::{UnitQuaternion, Vector3};

use crate::error::Error;
use crate::numerics::phase::Phase;
use crate::simd::kepler::Place;
use crate::simd::lanes::Lanes;

/// Largest mean anomaly from the pericentre \[rad\]. Beyond it a double has no phase.
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
    /// n²a³ is G times the sum of the two masses. The disturbing body has the whole mass unless [`Orbit::mass_fraction`] gives its share.
    ///
    /// # Errors
    /// - [`Error::Orbit`] for a mean motion of 0, −1 or NaN, and for an eccentricity of −0.1, 1 or NaN.
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

    /// Sets a time of pericentre passage [unit of time].
    ///
    /// # Errors
    /// - [`Error::Orbit`] for a time that is NaN or infinite.
    pub fn time_of_pericentre(self, time: f64) -> Result<Self, Error> {
        finite("time_of_pericentre", time)?;
        Ok(Self { time_of_pericentre: time, ..self })
    }

    /// Sets inclination, longitude of the node and argument of the pericentre \[rad\].
    ///
    /// # Errors
    /// - [`Error::Orbit`] for an angle that is NaN or infinite.
    pub fn plane(self, inclination: f64, node: f64, argument_of_pericentre: f64) -> Result<Self, Error> {
        finite("inclination", inclination)?;
        finite("node", node)?;
        finite("argument_of_pericentre", argument_of_pericentre)?;
        Ok(Self { inclination, node, argument_of_pericentre, ..self })
    }

    /// Sets the disturbing mass as a fraction of the sum of both masses: 1 for the Sun and an asteroid, 1/82.3 for the Moon and the Earth.
    ///
    /// # Errors
    /// - [`Error::Orbit`] for 0, −1, 1.1 or NaN.
    pub fn mass_fraction(self, fraction: f64) -> Result<Self, Error> {
        check("mass_fraction", fraction, fraction > 0.0 && fraction <= 1.0, "greater than 0 and at most 1")?;
        Ok(Self { mass_fraction: fraction, ..self })
    }

    /// The elements: mean motion n, eccentricity, time of pericentre, inclination, node, argument of pericentre, mass fraction.
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

    /// The angles of the elements that exceed a whole turn, with their names \[rad\]. They are accepted, but they are often degrees given by mistake.
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

    /// Unit vectors in inertial components: to the pericentre, perpendicular to it in the direction of motion, and along the orbital angular momentum.
    pub(crate) fn axes(&self) -> [Vector3<f64>; 3] {
        let about = UnitQuaternion::from_axis_angle;
        let turn = about(&Vector3::z_axis(), self.node)
            * about(&Vector3::x_axis(), self.inclination)
            * about(&Vector3::z_axis(), self.argument_of_pericentre);
        [turn * Vector3::x(), turn * Vector3::y(), turn * Vector3::z()]
    }

    /// The mean anomaly as a phase that starts at an epoch.
    pub(crate) fn mean_anomaly(&self, epoch: f64) -> Phase {
        let since = DoubleDouble::sum(epoch, -self.time_of_pericentre);
        let angle = since * DoubleDouble::from(self.mean_motion);
        let turns = angle / (DoubleDouble::PI * DoubleDouble::from(2.0));
        let rest = turns - DoubleDouble::from(turns.high.round());
        Phase::new(self.mean_motion.into(), TAU * rest.to_f64())
    }

    /// Checks that the mean anomaly can be computed at an epoch.
    pub(crate) fn within_reach(&self, epoch: f64) -> Result<(), Error> {
        let bounded = (epoch - self.time_of_pericentre).abs() * self.mean_motion <= MOST_TURNS;
        check("time_of_pericentre", self.time_of_pericentre, bounded, "within 1e15 periods of the epoch of the state")
    }

    /// The true anomaly at a time, in (−π, π] \[rad\].
    ///
    /// # Errors
    /// - [`Error::Orbit`] for a time that is NaN, infinite, or more than 1e15 periods from the time of pericentre.
    pub fn true_anomaly(&self, time: f64) -> Result<f64, Error> {
        let bounded = (time - self.time_of_pericentre).abs() * self.mean_motion <= MOST_TURNS;
        check("time", time, bounded, "finite and within 1e15 periods of the pericentre")?;
        let anomaly = self.mean_anomaly(self.time_of_pericentre).angle((time - self.time_of_pericentre, 0.0));
        // The angle of half a turn may have either sign.
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
