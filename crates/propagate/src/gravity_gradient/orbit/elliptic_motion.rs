//! The motion of a disturbing body along its orbit: the place on the ellipse, and the axes of an ellipse whose node and pericentre precess.
//!
//! The axes are unit vectors in inertial components: to the pericentre, perpendicular to it in the direction of motion, and along the orbital angular momentum.
//! With secular rates they are R_z(node) R_x(inclination) R_z(argument of the pericentre) with angles that grow linearly with time.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use crate::gravity_gradient::constants::{ARC_SHARE, LONGEST_ARC};
use crate::input::orbit::Orbit;
use crate::numerics::phase::Phase;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::kepler::{Ellipse, Place};
use crate::simd::lanes::Lanes;

/// η = √(1 − e²), without cancellation near e = 1.
pub(crate) fn eta(eccentricity: f64) -> f64 {
    ((1.0 - eccentricity) * (1.0 + eccentricity)).sqrt()
}

/// Time since the epoch, with its rounding error.
pub(crate) type Elapsed<S> = (Lanes<S>, Lanes<S>);

/// Unit vectors to the pericentre and perpendicular to it, in inertial components.
pub(crate) type Axes<S> = [[Lanes<S>; 3]; 2];

/// The position of the disturbing body at some times: whole turns since the pericentre before the epoch, its place on the ellipse, and the ellipse's axes.
#[derive(Clone, Copy)]
pub(crate) struct When<S: InstructionSet> {
    pub(crate) turns: Lanes<S>,
    pub(crate) place: Place<S>,
    pub(crate) axes: Axes<S>,
}

/// The motion of one disturbing body after the epoch of the scene; times in the user's unit.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    pub(crate) mean_anomaly: Phase,
    pub(crate) ellipse: Ellipse,
    /// At the epoch.
    pub(crate) axes: [Vector3<f64>; 3],
    turning: Option<TurningPlane>,
}

/// Node, argument of the pericentre, and sine and cosine of the inclination.
#[derive(Clone, Debug)]
struct TurningPlane {
    node: Phase,
    argument: Phase,
    tilt: (f64, f64),
}

impl Course {
    pub(crate) fn new(orbit: &Orbit, epoch: f64) -> Self {
        let turning = (!orbit.is_fixed()).then(|| {
            let [node, argument] = orbit.node_and_argument(epoch);
            TurningPlane { node, argument, tilt: orbit.tilt() }
        });
        Self {
            mean_anomaly: orbit.mean_anomaly(epoch),
            ellipse: Ellipse::new(orbit.eccentricity()),
            axes: orbit.axes_at(epoch),
            turning,
        }
    }

    /// The position at times after the epoch.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(&self, elapsed: Elapsed<S>) -> When<S> {
        let (turns, angle) = self.mean_anomaly.turns_and_angle(elapsed);
        let axes = match &self.turning {
            Some(turning) => elapsed.0.simd().vectorize(AxesAt { turning, elapsed }),
            None => fixed(&self.axes, angle),
        };
        When { turns, place: self.ellipse.place(angle), axes }
    }

    /// Radians per unit of time of mean anomaly, node and pericentre together.
    fn rate(&self) -> f64 {
        let turning = self.turning.as_ref();
        let slow = turning.map_or(0.0, |t| t.node.frequency().abs() + t.argument.frequency().abs());
        TAU * (self.mean_anomaly.frequency() + slow)
    }

    /// The longest time from a place on the orbit over which a polynomial represents the torque, in either direction.
    ///
    /// The torque is singular at the mean anomalies ±i (artanh η − η), where the distance is 0.
    pub(crate) fn arc(&self, mean_anomaly: f64) -> f64 {
        self.to_singularity(mean_anomaly).min(LONGEST_ARC / self.rate())
    }

    /// The longest time over which a polynomial represents the torque, without the precession of the orbit.
    fn to_singularity(&self, mean_anomaly: f64) -> f64 {
        let eta = eta(self.ellipse.eccentricity);
        // Two terms of the series, where the difference cancels. For a circle the singularity is infinitely far.
        let singular = if eta < 0.01 { eta.powi(3) * (1.0 / 3.0 + eta * eta / 5.0) } else { eta.atanh() - eta };
        ARC_SHARE * mean_anomaly.hypot(singular) / (TAU * self.mean_anomaly.frequency())
    }

    /// Number of arcs in a unit of time, at most.
    pub(crate) fn arcs(&self) -> f64 {
        let rate = TAU * self.mean_anomaly.frequency();
        let (mut anomaly, mut count) = (-PI, 0.0);
        while anomaly < PI {
            anomaly += rate * self.to_singularity(anomaly);
            count += 1.0;
        }
        count * self.mean_anomaly.frequency() + self.rate() / LONGEST_ARC
    }
}

/// [`TurningPlane::axes`] as a task that is compiled separately: a fixed orbit does without it.
struct AxesAt<'a, S: InstructionSet> {
    turning: &'a TurningPlane,
    elapsed: Elapsed<S>,
}

impl<S: InstructionSet> NullaryFnOnce for AxesAt<'_, S> {
    type Output = Axes<S>;

    #[inline(always)]
    fn call(self) -> Axes<S> {
        self.turning.axes(self.elapsed)
    }
}

impl TurningPlane {
    #[inline(always)]
    fn axes<S: InstructionSet>(&self, elapsed: Elapsed<S>) -> Axes<S> {
        let (node_sine, node_cosine) = self.node.sin_cos(elapsed);
        let (sine, cosine) = self.argument.sin_cos(elapsed);
        let (tilt_sine, tilt_cosine) = (sine.all(self.tilt.0), sine.all(self.tilt.1));
        let axis = |along: Lanes<S>, across: Lanes<S>| {
            let level = across * tilt_cosine;
            [
                node_cosine.mul_add(along, -(node_sine * level)),
                node_sine.mul_add(along, node_cosine * level),
                across * tilt_sine,
            ]
        };
        [axis(cosine, sine), axis(-sine, cosine)]
    }
}

/// Axes that are fixed in space, as a function of time.
#[inline(always)]
pub(crate) fn fixed<S: InstructionSet>(axes: &[Vector3<f64>], like: Lanes<S>) -> Axes<S> {
    // Not `map`, which is not inlined into code for an instruction set.
    let (first, second) = (&axes[0], &axes[1]);
    [
        [like.all(first.x), like.all(first.y), like.all(first.z)],
        [like.all(second.x), like.all(second.y), like.all(second.z)],
    ]
}
