//! The state of a body at an epoch: attitude and angular velocity.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::error::Error;

/// How far from 1 the norm of an attitude quaternion may be.
const NORM_SLACK: f64 = 1e-6;

/// Attitude and angular velocity at an epoch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Time of the state [any unit].
    pub epoch: f64,
    /// Rotation of body components into inertial ones.
    pub attitude: UnitQuaternion<f64>,
    /// Angular velocity, body components [rad per unit of time].
    pub angular_velocity: Vector3<f64>,
}

impl State {
    /// A state from plain numbers: `attitude` as [x, y, z, w] with a norm within 1e-6 of 1, normalized here.
    ///
    /// # Errors
    /// - [`Error::Epoch`]: `f64::NAN`.
    /// - [`Error::Attitude`]: `[0.0; 4]`, `[f64::NAN, 0.0, 0.0, 1.0]`, `[0.0, 0.0, 0.0, 1.1]`.
    /// - [`Error::AngularVelocity`]: `[f64::NAN, 0.0, 1.0]`.
    pub fn new(epoch: f64, attitude: [f64; 4], angular_velocity: [f64; 3]) -> Result<Self, Error> {
        let [x, y, z, w] = attitude;
        let quaternion = Quaternion::new(w, x, y, z);
        let norm = quaternion.norm();
        // Written so that NaN fails it.
        if !((norm - 1.0).abs() <= NORM_SLACK) {
            return Err(Error::Attitude { value: attitude, norm });
        }
        let state = Self {
            epoch,
            attitude: UnitQuaternion::new_normalize(quaternion),
            angular_velocity: Vector3::from(angular_velocity),
        };
        state.validated()
    }

    /// The state itself, if every number in it is finite and its quaternion is one.
    pub(crate) fn validated(self) -> Result<Self, Error> {
        if !self.epoch.is_finite() {
            return Err(Error::Epoch { value: self.epoch });
        }
        for (axis, &value) in self.angular_velocity.iter().enumerate() {
            if !value.is_finite() {
                return Err(Error::AngularVelocity { axis, value });
            }
        }
        let coordinates = self.attitude.coords;
        let norm = coordinates.norm();
        if !((norm - 1.0).abs() <= NORM_SLACK) {
            return Err(Error::Attitude { value: coordinates.into(), norm });
        }
        Ok(self)
    }
}
