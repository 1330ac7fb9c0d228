//! An orbit from a position and a velocity, and the positions on an orbit.
//!
//! Let h = r × v and p = h²/GM. The inclination and the node follow from h, and the argument of latitude u from r in the plane of the orbit. With 1/a = 2/r −
//! v²/GM, Kepler's equation has e cos E = 1 − r/a and e sin E = r·v/√(GM a), so e, E and M = E − e sin E follow without a division by e. The true anomaly f
//! comes from the same E and e, so that u = argument of the pericentre + f holds for a circle too, whose pericentre is arbitrary.
//! For a hyperbola e² − 1 = p/|a| and e sinh H = r·v/√(GM |a|).
//!
//! Vectors are scaled by their largest components, so no square overflows. Within 3.3 periods the error of a position is at most 1.4e-14 of a(1 + e) for e ≤ 0.95
//! (`crates/py/tests/test_orbit_state.py`). For e near 1 it grows by a/r, since 2/r and v²/GM cancel. A large time loses digits of the time of pericentre.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::elements::{MOST_TURNS, Orbit, check};
use crate::error::Error;
use crate::orbit::conic::{ConicPoint, true_anomaly};
use crate::orbit::hyperbola::mean_anomaly;

const CONIC: &str = "other than 1 for this position, velocity and gm: parabolas and straight falls have no orbit here";

impl Orbit {
    /// The Keplerian orbit through a position with a velocity, in inertial components, at a time: of the disturbing body relative to the rotating one, or of a
    /// satellite relative to its primary. `gm` is G × the sum of both masses [length³/time²]. The orbit has its semi-major axis, and the whole mass disturbs.
    ///
    /// Angles are in [0, 2π) and the time of pericentre is the one nearest to `time`. If the inclination is 0 or π, the node is on the inertial x axis. If the
    /// eccentricity is 0, the pericentre is the given position.
    ///
    /// ```
    /// use andoyer_propagate::Orbit;
    /// // A circle with the radius 2 in the x, z plane.
    /// let orbit = Orbit::from_state([2.0, 0.0, 0.0], [0.0, 0.0, 0.5], 0.5, 3.0)?;
    /// let [mean_motion, eccentricity, _, inclination, ..] = orbit.elements();
    /// assert!((mean_motion - 0.25).abs() < 1e-15 && eccentricity < 1e-15 && inclination == std::f64::consts::FRAC_PI_2);
    /// let quarter = orbit.position(3.0 + 0.5 * std::f64::consts::PI / 0.25)?;
    /// assert!(quarter[0].abs() < 1e-14 && (quarter[2] - 2.0).abs() < 1e-14);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Direction`] for a position of 0, and for a component that is not finite.
    /// - [`Error::Orbit`] for a gm of 0, −1 or NaN; for a time that is not finite; for an eccentricity of 1 to rounding; for a mean motion or a semi-major axis that
    ///   overflows or underflows.
    pub fn from_state(position: [f64; 3], velocity: [f64; 3], gm: f64, time: f64) -> Result<Self, Error> {
        for (argument, vector, zero) in [("position", position, false), ("velocity", velocity, true)] {
            if vector.iter().any(|x| !x.is_finite()) || (!zero && vector == [0.0; 3]) {
                return Err(Error::Direction { argument, value: vector.to_vec() });
            }
        }
        check("gm", gm, gm > 0.0 && gm.is_finite(), "positive and finite")?;
        check("time", time, time.is_finite(), "finite")?;
        let [position, velocity] = [position, velocity].map(Vector3::from);
        // In units in which the largest components of the position and of the velocity are 1.
        let (length, speed) = (position.amax(), velocity.amax());
        let (r, v) = (position / length, if speed > 0.0 { velocity / speed } else { velocity });
        let gm = gm / length / speed / speed;
        let Plane { inclination, node, latitude, momentum } = Plane::of(&r, &v);
        let (radius, radial) = (r.norm(), r.dot(&v));
        let inverse = 2.0 / radius - v.norm_squared() / gm;
        // e cos f and e sin f, for every conic.
        let (cosine, sine) = (momentum * momentum / gm / radius - 1.0, momentum * radial / radius / gm);
        let eccentricity = cosine.hypot(sine);
        let rate = |inverse: f64| (gm * inverse).sqrt() * inverse * (speed / length);
        let time_past = |mean_anomaly: f64, mean_motion: f64| time - mean_anomaly / mean_motion;
        // 2/r and v²/GM have rounding errors of this size. Within them an orbit is a parabola, not a hyperbola.
        if inverse < -4.0 * f64::EPSILON * 2.0 / radius && momentum > 0.0 {
            let inverse = -inverse;
            let square = momentum * momentum / gm * inverse;
            let eccentricity = 1.0 + square / (1.0 + (1.0 + square).sqrt());
            let orbit = Self::new(rate(inverse), eccentricity)?;
            let anomaly = (radial * (inverse / gm).sqrt() / eccentricity).asinh();
            let argument = latitude - true_anomaly(anomaly, eccentricity);
            return orbit
                .plane(inclination, node, argument.rem_euclid(TAU))?
                .time_of_pericentre(time_past(mean_anomaly(anomaly, eccentricity), orbit.mean_motion()))?
                .semi_major_axis(length / inverse);
        }
        // False for NaN, which comes from a velocity of 0.
        if !(eccentricity < 1.0 && inverse > 0.0) {
            return Err(Error::Orbit { argument: "eccentricity", value: 1.0, bound: CONIC });
        }
        let axis = 1.0 / inverse;
        let (along, across) = (1.0 - radius * inverse, radial * (inverse / gm).sqrt());
        let (eccentricity, anomaly) = (along.hypot(across), across.atan2(along));
        let mean_motion = rate(inverse);
        let orbit = Self::new(mean_motion, eccentricity)?;
        let argument = latitude - true_anomaly(anomaly, eccentricity);
        orbit
            .plane(inclination, node, argument.rem_euclid(TAU))?
            .time_of_pericentre(time_past(anomaly - across, mean_motion))?
            .semi_major_axis(axis * length)
    }

    /// The position at a time, in inertial components and in the unit of the semi-major axis. With secular rates, node and pericentre are those of the time.
    ///
    /// It is the position that the elements describe: that of the disturbing body relative to the rotating one. The elements of a satellite about its primary, as of
    /// [`Orbit::around_oblate`], give the position of the satellite relative to the primary.
    ///
    /// ```
    /// use andoyer_propagate::{Error, Orbit};
    /// let orbit = Orbit::new(1.0, 0.5)?.semi_major_axis(2.0)?;
    /// assert_eq!(orbit.position(0.0)?, [1.0, 0.0, 0.0]); // at the pericentre
    /// assert!(matches!(Orbit::new(1.0, 0.5)?.position(0.0), Err(Error::NoSemiMajorAxis)));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::NoSemiMajorAxis`] if no semi-major axis was given.
    /// - [`Error::Orbit`] for a time that is NaN, infinite, or more than 1e15 periods from the time of pericentre.
    pub fn position(&self, time: f64) -> Result<[f64; 3], Error> {
        let axis = self.asked_semi_major_axis().ok_or(Error::NoSemiMajorAxis)?;
        Ok((self.relative_position(time, 0.0)? * axis).into())
    }

    /// The position at the time `since` after an epoch in units of |a|, which needs no semi-major axis.
    pub(crate) fn relative_position(&self, epoch: f64, since: f64) -> Result<Vector3<f64>, Error> {
        let time = epoch + since;
        let reached = (time - self.elements()[2]).abs() * self.fastest() <= MOST_TURNS;
        check("time", time, reached, "finite and within 1e15 periods of the pericentre")?;
        let e = self.eccentricity();
        let [to_pericentre, ahead, _] = self.axes_after(epoch, since);
        let point = if self.is_hyperbola() {
            ConicPoint::on_hyperbola(self.hyperbolic_mean_anomaly(epoch, (since, 0.0)), e)
        } else {
            ConicPoint::on_ellipse(self.mean_anomaly(epoch).angle((since, 0.0)), e)
        };
        Ok(to_pericentre * point.x + ahead * (((1.0 - e) * (1.0 + e)).abs().sqrt() * point.sine))
    }
}

/// The plane of an orbit and the place in it.
struct Plane {
    inclination: f64,
    node: f64,
    /// The angle from the node to the position.
    latitude: f64,
    /// |r × v|.
    momentum: f64,
}

impl Plane {
    fn of(r: &Vector3<f64>, v: &Vector3<f64>) -> Self {
        let normal = r.cross(v);
        let momentum = normal.norm();
        let across = normal.x.hypot(normal.y);
        // atan2(0, −0) is π.
        let node = if across > 0.0 { normal.x.atan2(-normal.y).rem_euclid(TAU) } else { 0.0 };
        let (sine, cosine) = node.sin_cos();
        let (tilt_sine, tilt_cosine) = (across / momentum, normal.z / momentum);
        let ahead = Vector3::new(-tilt_cosine * sine, tilt_cosine * cosine, tilt_sine);
        let latitude = r.dot(&ahead).atan2(r.x * cosine + r.y * sine);
        Self { inclination: across.atan2(normal.z), node, latitude, momentum }
    }
}
