//! The constants that make the motion pass exactly through the given state.
//!
//! First-order corrections lead from the mean variables to the state with an error of second order. Here the error at the epoch becomes a constant of the
//! motion, which is added to p (relative to its circle), to M, and to the frame from which the averaged motion starts. The mean σ and M, and with them all
//! rates, are those of the theory. The error is therefore 0 at the epoch, grows from there in both directions of time, and is continuous.

use nalgebra::{Matrix2, Quaternion, UnitQuaternion, Vector2, Vector3};
use num_complex::Complex;

use crate::gravity_gradient::averaged::averages::AveragedMotion;
use crate::gravity_gradient::disturbed::DisturbedMotion;
use crate::gravity_gradient::evaluate::Osculating;
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::lanes::Lanes;
use crate::torque_free::polhode::Polhode;

/// Largest number of steps to the constants. Each step reduces the error by the size of the torque, or by the step of the differences.
const MOST_STEPS: usize = 16;

impl DisturbedMotion {
    /// Finds the constants for which the motion has this attitude and the polhode's angular momentum at the epoch. `slow` solves the averaged motion from a
    /// frame.
    pub(crate) fn start_at(
        &mut self,
        polhode: &Polhode,
        attitude: UnitQuaternion<f64>,
        mut frame: UnitQuaternion<f64>,
        slow: impl Fn(UnitQuaternion<f64>) -> AveragedMotion,
    ) {
        let none = Lanes::splat(pulp::Scalar, 0.0);
        let momentum = polhode.invariants.momentum.to_f64();
        let direction = Vector3::from(polhode.invariants.direction);
        let scale = polhode.separatrix_action().sqrt();
        for _ in 0..MOST_STEPS {
            let state = self.state((none, none));
            let missing = self.missing(&state, &direction, f64::EPSILON.cbrt() * scale);
            let lacking = momentum - value(state.momentum);
            let turned = state.frame * self.relative(&state) * QuaternionLanes::all(none, &self.frame.quaternion);
            let [x, y, z, w] = turned.0.map(value);
            let back = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)).inverse();
            let rotation = attitude * back;
            self.circle += missing;
            self.momentum += lacking;
            frame = UnitQuaternion::new_normalize((rotation * frame).into_inner());
            self.slow = slow(frame);
            let moved = missing.norm() / scale + lacking.abs() / momentum + rotation.vector().norm();
            if moved <= f64::EPSILON {
                break;
            }
        }
    }

    /// The change of p e^(−iℓ′) that gives the angular momentum this direction in the body: one step of Newton's method.
    fn missing(&self, state: &Osculating<pulp::Scalar>, direction: &Vector3<f64>, step: f64) -> Complex<f64> {
        let none = Lanes::splat(pulp::Scalar, 0.0);
        let (sine, cosine) = self.anomaly.sin_cos((none, none));
        let turn = ComplexLanes { re: cosine, im: sine };
        let axis = |re: f64, im: f64| {
            let small = ComplexLanes { re: none.all(re), im: none.all(im) };
            let state = Osculating { p: state.p + turn * small, ..*state };
            Vector3::from(self.relative(&state).third_row().map(value))
        };
        let columns = [(step, 0.0), (0.0, step)].map(|(re, im)| (axis(re, im) - axis(-re, -im)) / (2.0 * step));
        let residual = direction - axis(0.0, 0.0);
        let [first, second] = columns;
        let normal = Matrix2::new(first.norm_squared(), first.dot(&second), first.dot(&second), second.norm_squared());
        let side = Vector2::new(first.dot(&residual), second.dot(&residual));
        let solution = normal.lu().solve(&side).unwrap_or_default();
        Complex::new(solution.x, solution.y)
    }
}

fn value(lanes: Lanes<pulp::Scalar>) -> f64 {
    lanes.values()[0]
}
