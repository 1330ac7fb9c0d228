//! A scene from Andoyer variables (theory §1): the inverse of [`crate::Motion::andoyer`].

use nalgebra::{UnitQuaternion, Vector3};

use super::scene_about_principal_axes;
use andoyer_series::error::Short;

use crate::error::Error;
use crate::input::body::Body;
use crate::input::scene::Scene;
use crate::input::torque::{Torque, rotors};
use crate::torque_free::polhode::Frame;

/// Largest relative excess of |Λ| and |N| over M, which allows for rounding.
const SLACK: f64 = 8.0 * f64::EPSILON;

impl Scene {
    /// Creates the scene whose Andoyer variables at the epoch are (λ, μ, ν, Λ, M, N): angles \[rad\], momenta in units of moment × rate.
    ///
    /// R = Rz(λ) Rx(I) Rz(μ) Rx(J) Rz(ν), cos I = Λ/M, cos J = N/M, about the principal axes in the order of [`crate::Motion::andoyer`]. If J is small, M − N
    /// determines it only to 1e-8.
    ///
    /// # Errors
    /// - [`Error::Andoyer`] for a variable that is not finite, for M ≤ 0, and for |Λ| or |N| above M.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Scene, State};
    /// let body = Body::new([1.0, 1.5, 2.0])?;
    /// let motion = Scene::from_andoyer(body, [0.1, 0.2, 0.3, 0.5, 1.0, 0.9], 0.0)?.solve()?;
    /// let found = motion.andoyer(0.0)?;
    /// assert!(found.iter().zip([0.1, 0.2, 0.3, 0.5, 1.0, 0.9]).all(|(found, given)| (found - given).abs() < 4e-15));
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn from_andoyer(body: Body, variables: [f64; 6], epoch: f64) -> Result<Self, Error> {
        Self::of_andoyer(body, variables, epoch, &[])
    }

    /// The scene of [`Scene::from_andoyer`] with torques. The variables include the angular momentum of rotors, as those of [`Motion::andoyer`](crate::Motion::andoyer) do.
    ///
    /// # Errors
    /// As [`Scene::from_andoyer`].
    #[cfg(feature = "torques")]
    pub fn from_andoyer_with(body: Body, variables: [f64; 6], epoch: f64, torques: Vec<Torque>) -> Result<Self, Error> {
        Self::of_andoyer(body, variables, epoch, &torques).map(|scene| scene.torques(torques))
    }

    fn of_andoyer(body: Body, variables: [f64; 6], epoch: f64, torques: &[Torque]) -> Result<Self, Error> {
        let refused =
            |index: usize, bound: &str| Error::Andoyer { index, value: variables[index], bound: bound.to_owned() };
        if let Some(index) = variables.iter().position(|value| !value.is_finite()) {
            return Err(refused(index, "finite"));
        }
        if !epoch.is_finite() {
            return Err(Error::Epoch { value: epoch });
        }
        let [node, angle, spin, vertical, momentum, axial] = variables;
        if momentum <= 0.0 {
            return Err(refused(4, "positive, since a body at rest has no such variables"));
        }
        for (index, part) in [(3, vertical), (5, axial)] {
            if part.abs() > momentum * (1.0 + SLACK) {
                return Err(refused(index, &format!("at most M = {} in magnitude", Short(momentum))));
            }
        }
        // Sine and cosine of an inclination, and the rotation by it, from M and one of its components.
        let inclined = |part: f64| {
            let cosine = part / momentum;
            let sine = ((momentum - part) / momentum * ((momentum + part) / momentum)).max(0.0).sqrt();
            (sine, cosine, UnitQuaternion::from_axis_angle(&Vector3::x_axis(), sine.atan2(cosine)))
        };
        let about = |angle: f64| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
        let (_, _, inclination) = inclined(vertical);
        let (sine, cosine, tilt) = inclined(axial);
        let moments = body.moments();
        let frame = Frame::new(body.precise_moments(), [0.0; 3], false);
        let attitude = about(node) * inclination * about(angle) * tilt * about(spin) * frame.quaternion;
        let direction = frame.user([sine * spin.sin(), sine * spin.cos(), cosine]);
        let turn = body.turn().unwrap_or_else(UnitQuaternion::identity);
        let rotors = turn.inverse() * rotors(torques);
        let rates = Vector3::from_fn(|axis, _| (momentum * direction[axis] - rotors[axis]) / moments[axis]);
        Ok(scene_about_principal_axes(body, epoch, attitude, rates))
    }
}
