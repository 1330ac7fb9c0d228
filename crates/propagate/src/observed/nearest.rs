//! The state of a tumbler with given periods that is nearest to an attitude.
//!
//! The momentum has the direction n in inertial axes, and m on a polhode in the body. An attitude R takes m to n. The attitude A has n in the direction A⁻¹n of the body. Every
//! R is at least the angle between m and A⁻¹n away from A, and A times the shortest rotation from m to A⁻¹n is so far away. So the nearest attitude belongs to
//! the point of the polhode nearest to A⁻¹n, which may be on the polhode around the positive or the negative axis of the mode.

use std::f64::consts::TAU;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::periods::{Family, ObservedPeriods, bisected, unit};
use crate::torque_free::polhode::Polhode;

/// Points of the polhode that are compared before the best one is refined.
const POINTS: u32 = 720;
/// Two directions are opposite if 1 plus the product of their unit vectors is below this.
const OPPOSITE: f64 = 1e-6;

impl Family {
    /// Attitude and angular velocity, about principal axes, of the motion with these periods nearest to `attitude`.
    pub(super) fn nearest(
        &self,
        periods: &ObservedPeriods,
        attitude: UnitQuaternion<f64>,
    ) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let (polhode, momentum) = self.motion(periods);
        let wanted = attitude.inverse() * unit(periods.momentum_direction);
        let sorted = self.axial.frame.sorted(wanted.into());
        let sense = periods.sense.unwrap_or(1.0_f64.copysign(sorted[2]));
        let direction = nearest_point(&polhode, sorted, sense);
        let turn = shortest(Vector3::from(self.axial.frame.user(direction)), wanted);
        (attitude * turn, self.angular_velocity(&polhode, direction.map(|x| momentum * x)))
    }
}

/// The point of the polhode around axis 3 or its negative that is nearest to a unit vector, on sorted axes.
fn nearest_point(polhode: &Polhode, [x, y, z]: [f64; 3], sense: f64) -> [f64; 3] {
    let [across, along] = polhode.invariants.sine_squares.map(|square| square.to_f64().sqrt());
    let [least, most] = polhode.invariants.cosine_squares.map(|square| square.to_f64());
    // (s₁ cos u, s₀ sin u, ±√(c₁² cos²u + c₀² sin²u))
    let point = |u: f64| {
        let (sine, cosine) = u.sin_cos();
        [along * cosine, across * sine, sense * (most * cosine * cosine + least * sine * sine).sqrt()]
    };
    let product = |u: f64| point(u).iter().zip([x, y, z]).map(|(a, b)| a * b).sum::<f64>();
    let slope = |u: f64| {
        let (sine, cosine) = u.sin_cos();
        let [.., height] = point(u);
        across * cosine * y - along * sine * x + (least - most) * sine * cosine / height * z
    };
    let step = TAU / f64::from(POINTS);
    let angles = (0..POINTS).map(|k| f64::from(k) * step);
    let best = angles.max_by(|&a, &b| product(a).total_cmp(&product(b))).unwrap_or(0.0);
    point(bisected([best - step, best + step], |u| slope(u) > 0.0))
}

/// The shortest rotation that takes one unit vector to another.
fn shortest(from: Vector3<f64>, to: Vector3<f64>) -> UnitQuaternion<f64> {
    let scalar = 1.0 + from.dot(&to);
    if scalar > OPPOSITE {
        return UnitQuaternion::from_quaternion(Quaternion::from_parts(scalar, from.cross(&to)));
    }
    let aside = from.cross(&Vector3::ith(from.iamin(), 1.0)).normalize();
    shortest(-from, to) * UnitQuaternion::new_unchecked(Quaternion::from_parts(0.0, aside))
}
