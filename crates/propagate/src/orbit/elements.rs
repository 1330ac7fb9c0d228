//! The relative orbit of a disturbing body: a Keplerian ellipse or hyperbola in any plane, fixed or with secular rates of node and pericentre.
//!
//! The elements refer to the inertial frame of the scene. Node and argument of the pericentre are those at the time of pericentre. Kepler's equation is solved
//! in lanes ([`crate::orbit::kepler`]), that of a hyperbola one by one ([`crate::orbit::hyperbola`]).

use std::f64::consts::{PI, TAU};

use andoyer_double::DoubleDouble;
use nalgebra::{UnitQuaternion, Vector3};

use crate::error::Error;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::scaled;
use crate::orbit::conic::true_anomaly;
use crate::orbit::hyperbola::hyperbolic_anomaly;
use crate::orbit::kepler::Place;
use crate::simd::lanes::Lanes;

/// Largest mean anomaly from the pericentre \[rad\]. Beyond it a double has no phase.
pub(super) const MOST_TURNS: f64 = TAU * 1e15;

/// Largest semi-major axis. No position on its orbit overflows.
const LONGEST: f64 = 1e300;

pub(super) const POSITIVE: &str = "positive and finite";
/// The bound in words of what scales the torque of a body on an orbit.
const REPRESENTABLE: &str = "such that the attraction in units of the rotation rate, mean_motion^2 * mass_fraction unless given, and its quotient by mean_motion^2 are normal doubles";

/// Largest eccentricity. Powers of the distance do not overflow.
const MOST_ECCENTRIC: f64 = 1e50;
/// Its bound in words, and that of the mean elements of an ellipse.
const CONIC: &str = "0 or more, other than 1 and at most 1e50";

/// The bounds of mass_fraction and of attraction if both are given: the attraction of the disturbing body contains its share of the mass.
const NOT_BOTH: [&str; 2] =
    ["1 or absent if an attraction is given", "absent, or given with no mass_fraction other than 1"];

/// A Keplerian orbit of the disturbing body about the rotating one: an ellipse, or a hyperbola, under which scenes are integrated.
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
    node_rate: f64,
    pericentre_rate: f64,
    attraction: Option<f64>,
    semi_major_axis: Option<f64>,
}

impl Orbit {
    /// An orbit from its mean motion n [rad per unit of time] and eccentricity e, in the inertial x, y plane, with its pericentre on the x axis at time 0.
    ///
    /// n²|a|³ is G times the sum of the two masses, and the mean anomaly grows with n. An eccentricity above 1 is that of a hyperbola. The disturbing body has the whole mass unless [`Orbit::mass_fraction`] gives its share.
    ///
    /// # Errors
    /// - [`Error::Orbit`] for a mean motion of 0, −1 or NaN, and for an eccentricity of −0.1, 1, 1e51 or NaN.
    pub fn new(mean_motion: f64, eccentricity: f64) -> Result<Self, Error> {
        check("mean_motion", mean_motion, mean_motion > 0.0 && mean_motion.is_finite(), POSITIVE)?;
        let conic = (0.0..=MOST_ECCENTRIC).contains(&eccentricity) && eccentricity != 1.0;
        check("eccentricity", eccentricity, conic, CONIC)?;
        Ok(Self {
            mean_motion,
            eccentricity,
            time_of_pericentre: 0.0,
            inclination: 0.0,
            node: 0.0,
            argument_of_pericentre: 0.0,
            mass_fraction: 1.0,
            node_rate: 0.0,
            pericentre_rate: 0.0,
            attraction: None,
            semi_major_axis: None,
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
    /// - [`Error::Orbit`] for 0, −1, 1.1 or NaN, and for a fraction other than 1 beside an [`Orbit::attraction`].
    pub fn mass_fraction(self, fraction: f64) -> Result<Self, Error> {
        check("mass_fraction", fraction, fraction > 0.0 && fraction <= 1.0, "greater than 0 and at most 1")?;
        check("mass_fraction", fraction, fraction == 1.0 || self.attraction.is_none(), NOT_BOTH[0])?;
        Ok(Self { mass_fraction: fraction, ..self })
    }

    /// Sets the secular rates of the node, about inertial axis 3, and of the argument of the pericentre, about the normal of the orbit [rad per unit of time].
    /// Node and argument are then those at the time of pericentre, and the mean motion is the rate of the mean anomaly.
    ///
    /// # Errors
    /// - [`Error::Orbit`] for a rate that is NaN or infinite.
    pub fn secular_rates(self, node: f64, pericentre: f64) -> Result<Self, Error> {
        finite("node_rate", node)?;
        finite("pericentre_rate", pericentre)?;
        Ok(Self { node_rate: node, pericentre_rate: pericentre, ..self })
    }

    /// Sets the attraction G × disturbing mass / a³ [1/time²]. The default is mean_motion² × mass_fraction.
    ///
    /// ```
    /// use andoyer_propagate::Orbit;
    /// assert_eq!(Orbit::new(1e-3, 0.1)?.attraction(2e-6)?.strength(), 2e-6);
    /// assert!(Orbit::new(1e-3, 0.1)?.mass_fraction(0.5)?.attraction(2e-6).is_err());
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Orbit`] for 0, −1 or NaN, and beside an [`Orbit::mass_fraction`] other than 1.
    pub fn attraction(self, attraction: f64) -> Result<Self, Error> {
        check("attraction", attraction, attraction > 0.0 && attraction.is_finite(), POSITIVE)?;
        check("attraction", attraction, self.mass_fraction == 1.0, NOT_BOTH[1])?;
        Ok(Self { attraction: Some(attraction), ..self })
    }

    /// Sets the semi-major axis a \[length\], which [`Orbit::position`] needs. Torques of the gravity gradient do not depend on it.
    ///
    /// # Errors
    /// - [`Error::Orbit`] for 0, −1, NaN or 1e301.
    pub fn semi_major_axis(self, length: f64) -> Result<Self, Error> {
        check("semi_major_axis", length, length > 0.0 && length <= LONGEST, "positive and at most 1e300")?;
        Ok(Self { semi_major_axis: Some(length), ..self })
    }

    /// The orbit with a small change of an element, in the order of [`Orbit::elements`]. An eccentricity below 0 is that of the same ellipse from its apocentre.
    pub(crate) fn displaced(&self, element: usize, step: f64) -> Self {
        let mut orbit = *self;
        let elements: [&mut f64; 6] = [
            &mut orbit.mean_motion,
            &mut orbit.eccentricity,
            &mut orbit.time_of_pericentre,
            &mut orbit.inclination,
            &mut orbit.node,
            &mut orbit.argument_of_pericentre,
        ];
        if let Some(value) = elements.into_iter().nth(element) {
            *value += step;
        }
        if orbit.eccentricity < 0.0 {
            let half = PI / orbit.mean_motion;
            orbit.eccentricity = -orbit.eccentricity;
            orbit.time_of_pericentre -= half;
            orbit.node -= half * orbit.node_rate;
            orbit.argument_of_pericentre += PI - half * orbit.pericentre_rate;
        }
        orbit
    }

    /// The orbit of a body with another attraction.
    pub(crate) fn attracting(&self, attraction: f64) -> Self {
        Self { attraction: Some(attraction), mass_fraction: 1.0, ..*self }
    }

    /// The given semi-major axis \[length\], or `None`.
    pub fn asked_semi_major_axis(&self) -> Option<f64> {
        self.semi_major_axis
    }

    /// Sets node and argument of the pericentre at the time of pericentre, which replace those of [`Orbit::plane`] \[rad\].
    ///
    /// # Errors
    /// - [`Error::Orbit`] for an angle that is NaN or infinite.
    pub fn node_and_pericentre(self, node: f64, argument_of_pericentre: f64) -> Result<Self, Error> {
        self.plane(self.inclination, node, argument_of_pericentre)
    }

    /// Secular rates of the node and of the argument of the pericentre [rad per unit of time].
    pub fn rates(&self) -> [f64; 2] {
        [self.node_rate, self.pericentre_rate]
    }

    /// Whether node and pericentre are fixed.
    pub(crate) fn is_fixed(&self) -> bool {
        self.rates() == [0.0; 2]
    }

    /// The given attraction G × disturbing mass / a³ [1/time²], or `None`.
    pub fn asked_attraction(&self) -> Option<f64> {
        self.attraction
    }

    /// The attraction G × disturbing mass / a³ [1/time²]. The default is mean_motion² × mass_fraction.
    pub fn strength(&self) -> f64 {
        self.attraction.unwrap_or(self.mean_motion * self.mean_motion * self.mass_fraction)
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

    /// Whether the orbit is a hyperbola.
    pub(crate) fn is_hyperbola(&self) -> bool {
        self.eccentricity > 1.0
    }

    /// The attraction over n². It is the mass fraction unless an attraction is given.
    pub(crate) fn disturbing_fraction(&self) -> f64 {
        match self.attraction {
            Some(attraction) => attraction / self.mean_motion / self.mean_motion,
            None => self.mass_fraction,
        }
    }

    /// Unit vectors in inertial components: to the pericentre, perpendicular to it in the direction of motion, and along the orbital angular momentum.
    pub(crate) fn axes(&self) -> [Vector3<f64>; 3] {
        self.axes_of([self.node, self.argument_of_pericentre])
    }

    /// The unit vectors of [`axes`](Self::axes) at an epoch.
    pub(crate) fn axes_at(&self, epoch: f64) -> [Vector3<f64>; 3] {
        self.axes_after(epoch, 0.0)
    }

    /// The unit vectors of [`axes`](Self::axes) at the time `since` after an epoch.
    pub(crate) fn axes_after(&self, epoch: f64, since: f64) -> [Vector3<f64>; 3] {
        if self.is_fixed() {
            return self.axes();
        }
        self.axes_of(self.node_and_argument(epoch).map(|phase| phase.angle((since, 0.0))))
    }

    fn axes_of(&self, [node, argument]: [f64; 2]) -> [Vector3<f64>; 3] {
        let about = UnitQuaternion::from_axis_angle;
        let turn = about(&Vector3::z_axis(), node)
            * about(&Vector3::x_axis(), self.inclination)
            * about(&Vector3::z_axis(), argument);
        [turn * Vector3::x(), turn * Vector3::y(), turn * Vector3::z()]
    }

    /// The mean anomaly as a phase that starts at an epoch.
    pub(crate) fn mean_anomaly(&self, epoch: f64) -> Phase {
        self.angle(epoch, 0.0, self.mean_motion)
    }

    /// The mean anomaly of a hyperbola at a time after an epoch, which never turns \[rad\].
    pub(crate) fn hyperbolic_mean_anomaly(&self, epoch: f64, (high, low): (f64, f64)) -> f64 {
        let since = DoubleDouble::sum(epoch, -self.time_of_pericentre) + DoubleDouble::sum(high, low);
        (since * DoubleDouble::from(self.mean_motion)).to_f64()
    }

    /// The distance on a hyperbola at a time, over |a|.
    pub(crate) fn hyperbolic_distance(&self, time: f64) -> f64 {
        let anomaly = hyperbolic_anomaly(self.hyperbolic_mean_anomaly(time, (0.0, 0.0)), self.eccentricity);
        self.eccentricity * anomaly.cosh() - 1.0
    }

    /// The node and the argument of the pericentre as phases that start at an epoch.
    pub(crate) fn node_and_argument(&self, epoch: f64) -> [Phase; 2] {
        [
            self.angle(epoch, self.node, self.node_rate),
            self.angle(epoch, self.argument_of_pericentre, self.pericentre_rate),
        ]
    }

    /// Sine and cosine of the inclination.
    pub(crate) fn tilt(&self) -> (f64, f64) {
        self.inclination.sin_cos()
    }

    /// A phase that starts at an epoch, from an angle at the time of pericentre and its rate.
    fn angle(&self, epoch: f64, start: f64, rate: f64) -> Phase {
        let since = DoubleDouble::sum(epoch, -self.time_of_pericentre);
        let angle = since * DoubleDouble::from(rate) + DoubleDouble::from(start);
        let turn = DoubleDouble::PI * DoubleDouble::from(2.0);
        let turns = angle / turn;
        // In double-double: the passage of a pericentre may be shorter than the rounding error of a time in doubles.
        Phase::new(rate.into(), (turns - DoubleDouble::from(turns.high.round())) * turn)
    }

    /// The largest rate of an angle of the orbit [rad per unit of time].
    pub(crate) fn fastest(&self) -> f64 {
        self.mean_motion.max(self.node_rate.abs()).max(self.pericentre_rate.abs())
    }

    /// The attraction G m/a³ in a unit of time of 2^−exponent.
    pub(crate) fn strength_in(&self, exponent: i32) -> f64 {
        let rate = scaled(self.mean_motion, -exponent);
        let given = self.attraction.map(|attraction| scaled(scaled(attraction, -exponent), -exponent));
        given.unwrap_or(rate * rate * self.mass_fraction)
    }

    /// Checks that three times the attraction G m/a³ in a unit of time, and the attraction over n², are normal doubles: equations of motion have both.
    pub(crate) fn representable(&self, exponent: i32) -> Result<(), Error> {
        let strength = self.strength_in(exponent);
        let holds = [strength, 3.0 * strength, self.disturbing_fraction()].iter().all(|x| x.is_normal());
        let (argument, value) = match self.attraction {
            Some(attraction) => ("attraction", attraction),
            None if scaled(self.mean_motion, -exponent).powi(2).is_normal() => ("mass_fraction", self.mass_fraction),
            None => ("mean_motion", self.mean_motion),
        };
        check(argument, value, holds, REPRESENTABLE)
    }

    /// Checks that the mean anomaly can be computed at an epoch.
    pub(crate) fn within_reach(&self, epoch: f64) -> Result<(), Error> {
        let bounded = (epoch - self.time_of_pericentre).abs() * self.fastest() <= MOST_TURNS;
        check("time_of_pericentre", self.time_of_pericentre, bounded, "within 1e15 periods of the epoch of the state")
    }

    /// The true anomaly at a time, in (−π, π] \[rad\]; a hyperbola has those below arccos(−1/e).
    ///
    /// # Errors
    /// - [`Error::Orbit`] for a time that is NaN, infinite, or more than 1e15 periods from the time of pericentre.
    pub fn true_anomaly(&self, time: f64) -> Result<f64, Error> {
        let bounded = (time - self.time_of_pericentre).abs() * self.mean_motion <= MOST_TURNS;
        check("time", time, bounded, "finite and within 1e15 periods of the pericentre")?;
        if self.is_hyperbola() {
            let anomaly = hyperbolic_anomaly(self.hyperbolic_mean_anomaly(time, (0.0, 0.0)), self.eccentricity);
            return Ok(true_anomaly(anomaly, self.eccentricity));
        }
        let anomaly = self.mean_anomaly(self.time_of_pericentre).angle((time - self.time_of_pericentre, 0.0));
        // The angle of half a turn may have either sign.
        let anomaly = if anomaly == -PI { PI } else { anomaly };
        Ok(Place::of(Lanes::splat(pulp::Scalar, anomaly), self.eccentricity).angle.values()[0])
    }
}

pub(super) fn check(argument: &'static str, value: f64, holds: bool, bound: &'static str) -> Result<(), Error> {
    if holds { Ok(()) } else { Err(Error::Orbit { argument, value, bound }) }
}

pub(super) fn finite(argument: &'static str, value: f64) -> Result<(), Error> {
    check(argument, value, value.is_finite(), "finite")
}
