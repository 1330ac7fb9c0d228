//! The state of a body at an epoch: attitude and angular velocity.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::error::Error;

/// Largest difference from 1 of the norm of an attitude quaternion.
const NORM_SLACK: f64 = 1e-6;
/// Largest difference from 1 of a norm that normalization leaves. Another normalization would change the last bits, so a state written to a file would not be
/// read back unchanged.
const ROUNDED_NORM: f64 = 2.0 * f64::EPSILON;

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
    /// A state from plain numbers. `attitude` is [x, y, z, w] with a norm within 1e-6 of 1; it is normalized unless its norm is 1 to rounding.
    ///
    /// ```
    /// let state = andoyer_propagate::State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?;
    /// assert_eq!(state.angular_velocity.z, 1.0);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Epoch`] for `f64::NAN`.
    /// - [`Error::Attitude`] for `[0.0; 4]`, `[f64::NAN, 0.0, 0.0, 1.0]`, `[0.0, 0.0, 0.0, 1.1]`.
    /// - [`Error::AngularVelocity`] for `[f64::NAN, 0.0, 1.0]`.
    pub fn new(epoch: f64, attitude: [f64; 4], angular_velocity: [f64; 3]) -> Result<Self, Error> {
        let [x, y, z, w] = attitude;
        let quaternion = Quaternion::new(w, x, y, z);
        let attitude = UnitQuaternion::new_unchecked(quaternion);
        let state = Self { epoch, attitude, angular_velocity: Vector3::from(angular_velocity) };
        state.validated()
    }

    /// The state with a unit quaternion, if all its numbers are finite and its quaternion has a norm near 1.
    pub(crate) fn validated(mut self) -> Result<Self, Error> {
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
        if !is_unit(norm) {
            return Err(Error::Attitude { value: coordinates.into(), norm });
        }
        if (norm - 1.0).abs() > ROUNDED_NORM {
            self.attitude = UnitQuaternion::new_normalize(self.attitude.into_inner());
        }
        Ok(self)
    }
}

/// Whether a norm is near enough to 1. False for NaN.
fn is_unit(norm: f64) -> bool {
    (norm - 1.0).abs() <= NORM_SLACK
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalized_attitude_is_kept_to_the_bit() {
        // One division by the norm leaves 1 ± a few ulp in one of forty of these quaternions. A second division would change them.
        for k in 1..2000 {
            let k = f64::from(k);
            let given = Quaternion::new(k.sin(), (2.0 * k).sin(), (3.0 * k).cos(), (5.0 * k).sin()).normalize();
            let given: [f64; 4] = (given * (1.0 + 1e-7)).coords.into();
            let once = State::new(0.0, given, [0.0; 3]).expect("a state").attitude;
            let twice = State::new(0.0, once.coords.into(), [0.0; 3]).expect("a state").attitude;
            assert_eq!(once.coords, twice.coords);
        }
    }
}
