//! The magnetic field of a dipole at a body on an orbit.
//!
//! ```text
//! B = B_e (R/r)³ (3 (m̂·r̂) r̂ − m̂)
//! ```
//!
//! with the field B_e on the equator of the dipole at the distance R, the direction m̂ of its moment, and the position r. It is the same for r and −r.

use andoyer_double::DoubleDouble;
use nalgebra::Vector3;

use super::elements::Orbit;
use crate::error::{Error, torque_refused};
use crate::numerics::phase::Phase;

/// The field of a dipole in the centre of a planet, at a body on an orbit about it; its axis may turn with the planet about inertial axis 3.
///
/// ```
/// use andoyer_propagate::Orbit;
/// use andoyer_propagate::torques::DipoleField;
/// // Radius and semi-major axis in km, the field in tesla. The moment of the Earth points south.
/// let orbit = Orbit::new(1.1e-3, 0.0)?.semi_major_axis(6871.0)?;
/// let field = DipoleField::new(orbit, 6371.2, 2.98e-5)?.axis([0.0, 0.17, -0.98])?.rotating(7.292_115e-5)?;
/// let there = field.at(0.0, 0.0)?;
/// let size = there.iter().map(|part| part * part).sum::<f64>().sqrt();
/// assert!((2.3e-5..4.8e-5).contains(&size));
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DipoleField {
    orbit: Orbit,
    /// R in semi-major axes.
    ratio: f64,
    radius: f64,
    equatorial: f64,
    /// At time 0, as it was given.
    axis: [f64; 3],
    rotation_rate: f64,
}

impl DipoleField {
    /// The field `equatorial` at the distance `radius` on the equator of the dipole, whose moment is along inertial axis 3. With the elements of the body about the planet, or of the
    /// planet about the body.
    ///
    /// # Errors
    /// - [`Error::Torque`] for an orbit without a semi-major axis; a radius or a field that is not positive and finite, or too far from the orbit for doubles.
    pub fn new(orbit: Orbit, radius: f64, equatorial: f64) -> Result<Self, Error> {
        let positive = |argument, value: f64| match value > 0.0 && value.is_finite() {
            true => Ok(()),
            false => Err(torque_refused(argument, value, "positive and finite")),
        };
        positive("radius", radius)?;
        positive("equatorial", equatorial)?;
        let Some(size) = orbit.asked_semi_major_axis() else {
            let bound = "with semi_major_axis, in the unit of radius";
            return Err(torque_refused("orbit", "without semi_major_axis", bound));
        };
        let ratio = radius / size;
        let bound = "such that the field on the orbit is a normal double";
        if !(equatorial * ratio.powi(3)).is_normal() || !ratio.powi(3).is_normal() {
            return Err(torque_refused("radius", radius, bound));
        }
        Ok(Self { orbit, ratio, radius, equatorial, axis: [0.0, 0.0, 1.0], rotation_rate: 0.0 })
    }

    /// Sets the direction of the moment at time 0, inertial, of any length.
    ///
    /// # Errors
    /// - [`Error::Torque`] for a vector that is 0 or not finite.
    pub fn axis(self, axis: [f64; 3]) -> Result<Self, Error> {
        let vector = Vector3::from(axis);
        let largest = vector.amax();
        if !(vector.iter().all(|part| part.is_finite()) && largest > 0.0) {
            return Err(torque_refused("axis", format!("{axis:?}"), "a finite vector other than 0"));
        }
        Ok(Self { axis: axis.map(|part| part + 0.0), ..self })
    }

    /// Sets the rate at which the moment turns about inertial axis 3 [rad/time].
    ///
    /// # Errors
    /// - [`Error::Torque`] for a rate that is not finite.
    pub fn rotating(self, rate: f64) -> Result<Self, Error> {
        if rate.is_finite() {
            return Ok(Self { rotation_rate: rate + 0.0, ..self });
        }
        Err(torque_refused("rotation_rate", rate, "finite"))
    }

    /// The orbit.
    pub fn orbit(&self) -> &Orbit {
        &self.orbit
    }

    /// The distance R.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The field B_e on the equator at R.
    pub fn equatorial(&self) -> f64 {
        self.equatorial
    }

    /// The direction of the moment at time 0, as it was given.
    pub fn moment_axis(&self) -> [f64; 3] {
        self.axis
    }

    /// The unit vector of [`DipoleField::moment_axis`].
    pub(crate) fn unit_axis(&self) -> [f64; 3] {
        let vector = Vector3::from(self.axis);
        (vector / vector.amax()).normalize().into()
    }

    /// The rate of the moment about inertial axis 3.
    pub fn rotation_rate(&self) -> f64 {
        self.rotation_rate
    }

    /// The field at a time after an epoch, inertial, in the unit of the field.
    ///
    /// # Errors
    /// - [`Error::Orbit`] for a place on a hyperbola beyond the range of doubles.
    pub fn at(&self, epoch: f64, elapsed: f64) -> Result<[f64; 3], Error> {
        let place = self.orbit.relative_position(epoch, elapsed)?;
        let distance = place.amax() * (place / place.amax()).norm();
        Ok(self.of(&(place / distance), distance, self.phase(epoch).angle((elapsed, 0.0))).into())
    }

    /// The field in a direction at a distance in semi-major axes, with the moment turned by an angle.
    pub(crate) fn of(&self, r: &Vector3<f64>, distance: f64, turn: f64) -> Vector3<f64> {
        let [x, y, z] = self.unit_axis();
        let (sine, cosine) = turn.sin_cos();
        let m = Vector3::new(cosine * x - sine * y, sine * x + cosine * y, z);
        (r * (3.0 * m.dot(r)) - m) * self.strength(distance)
    }

    /// B_e (R/r)³ at a distance in semi-major axes.
    pub(crate) fn strength(&self, distance: f64) -> f64 {
        self.equatorial * (self.ratio / distance).powi(3)
    }

    /// The angle by which the moment has turned, from an epoch on.
    pub(crate) fn phase(&self, epoch: f64) -> Phase {
        let turn = DoubleDouble::PI * DoubleDouble::from(2.0);
        let angle = DoubleDouble::from(epoch) * DoubleDouble::from(self.rotation_rate);
        let turns = angle / turn;
        Phase::new(self.rotation_rate.into(), (turns - DoubleDouble::from(turns.high.round())) * turn)
    }
}
