//! Andoyer variables of a motion (theory §1): λ, μ, ν and their momenta Λ, M, N.
//!
//! R = Rz(λ) Rx(I) Rz(μ) Rx(J) Rz(ν). Axis 3 is the user's axis of greatest inertia, axis 2 the axis of B, and axis 1 the axis of A, reversed if the user's
//! order A, B, C is left-handed. N < 0 is a body turned over; then μ − ν grows with the mean rate instead of μ + ν. The inclinations are arctangents of sine
//! and cosine, not arccosines. The angular momentum includes that of rotors. If a node is not defined, its angle is 0 by convention: λ = 0 at I = 0 or π, ν = 0 at J = 0 or π. μ then contains the sum.

use nalgebra::{UnitQuaternion, Vector3};

use super::batch::Batch;
use super::solved::{Motion, length};
use crate::error::Error;
use crate::input::torque::rotors;
use crate::torque_free::polhode::Frame;

/// Number of times that are evaluated together.
const AT_ONCE: usize = 64;

impl Motion {
    /// [λ, μ, ν, Λ, M, N] at a time: angles in (−π, π] \[rad\], momenta in units of moment × rate, with those of rotors. All are 0 for a body at rest without rotors.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 2.0])?;
    /// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).solve()?;
    /// // At I = J = 0 the angle of rotation is μ, and Λ = M = N = C ω.
    /// let [_, mu, _, _, momentum, _] = motion.andoyer(0.5)?;
    /// assert!((mu - 1.0).abs() < 1e-14 && (momentum - 4.0).abs() < 1e-14);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`Motion::at`].
    pub fn andoyer(&self, time: f64) -> Result<[f64; 6], Error> {
        let mut variables = [[0.0; 6]];
        self.andoyer_into(&[time], &mut variables)?;
        Ok(variables[0])
    }

    /// Writes [λ, μ, ν, Λ, M, N] at many times to `out`, without an allocation.
    ///
    /// # Errors
    /// The errors of [`Motion::attitudes_into`].
    pub fn andoyer_into(&self, times: &[f64], out: &mut [[f64; 6]]) -> Result<(), Error> {
        self.batch().andoyer_into(times, out)
    }

    fn andoyer_of(&self, attitude: [f64; 4], rates: [f64; 3], total: Vector3<f64>) -> [f64; 6] {
        // Squares are avoided, because they overflow long before the momentum does.
        let momentum = total.x.hypot(total.y).hypot(total.z);
        if momentum == 0.0 {
            return [0.0; 6];
        }
        let moments = self.scene.body().moments();
        // Axis 3 keeps its direction.
        let frame = Frame::new(self.scene.body().precise_moments(), [0.0; 3], false);
        let rotors = rotors(self.scene.asked_torques());
        let [g1, g2, g3] = frame.sorted(std::array::from_fn(|i| moments[i] * rates[i] + rotors[i]));
        let node = node_angle(total.x, -total.y);
        let spin = node_angle(g1, g2);
        let inclination = total.x.hypot(total.y).atan2(total.z);
        let tilt = g1.hypot(g2).atan2(g3);
        let z = Vector3::z_axis();
        let x = Vector3::x_axis();
        let about = UnitQuaternion::from_axis_angle;
        // Rz(μ) is R without the rotations before and after it.
        let left = (about(&z, node) * about(&x, inclination)).inverse();
        let right = (about(&x, tilt) * about(&z, spin)).inverse();
        let sorted = UnitQuaternion::new_unchecked(attitude.into()) * frame.quaternion.inverse();
        let middle = left * sorted * right;
        let angle = 2.0 * middle.k.atan2(middle.w);
        [node, wrapped(angle), spin, total.z, momentum, g3]
    }
}

impl Batch<'_> {
    /// Writes [λ, μ, ν, Λ, M, N] at `times` to `out`.
    ///
    /// # Errors
    /// The errors of [`Motion::attitudes_into`].
    pub fn andoyer_into(&self, times: &[f64], out: &mut [[f64; 6]]) -> Result<(), Error> {
        length("out", out.len(), times.len())?;
        let (mut attitudes, mut rates, mut momenta) = ([[0.0; 4]; AT_ONCE], [[0.0; 3]; AT_ONCE], [[0.0; 3]; AT_ONCE]);
        for ((index, part), out) in times.chunks(AT_ONCE).enumerate().zip(out.chunks_mut(AT_ONCE)) {
            let (attitudes, rates) = (&mut attitudes[..part.len()], &mut rates[..part.len()]);
            let momenta = &mut momenta[..part.len()];
            self.about_principal_axes(part, attitudes, rates).map_err(|error| error.later(index * AT_ONCE))?;
            self.angular_momenta_into(part, momenta).map_err(|error| error.later(index * AT_ONCE))?;
            for (((slot, attitude), rates), total) in out.iter_mut().zip(attitudes).zip(rates).zip(momenta) {
                *slot = self.motion().andoyer_of(*attitude, *rates, (*total).into());
            }
        }
        Ok(())
    }
}

/// The angle of (sine, cosine); 0 if both are 0, whatever their signs.
fn node_angle(sine: f64, cosine: f64) -> f64 {
    if sine == 0.0 && cosine == 0.0 { 0.0 } else { sine.atan2(cosine) }
}

/// An angle in (−2π, 2π], moved to (−π, π].
fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if angle > PI {
        angle - TAU
    } else if angle <= -PI {
        angle + TAU
    } else {
        angle
    }
}
