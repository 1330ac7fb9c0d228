//! The position of a disturbing body as a function of time: the place on its ellipse, and the axes of an ellipse whose node and pericentre precess.
//!
//! The axes are unit vectors in inertial components: to the pericentre, perpendicular to it in the direction of motion, and along the orbital angular momentum.
//! With secular rates they are R_z(node) R_x(inclination) R_z(argument of the pericentre) with angles that grow linearly with time.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use crate::numerics::phase::Phase;
use crate::orbit::elements::Orbit;
use crate::orbit::kepler::{Ellipse, Place};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// η = √(1 − e²), without cancellation near e = 1.
pub(crate) fn eta(eccentricity: f64) -> f64 {
    ((1.0 - eccentricity) * (1.0 + eccentricity)).sqrt()
}

/// √|1 − e²| below which [`singularity`] is summed: the third term of its series is 1e-8 of it.
const SMALL_ROOT: f64 = 0.01;

/// Time since the epoch, with its rounding error.
pub(crate) type Elapsed<S> = (Lanes<S>, Lanes<S>);

/// Unit vectors to the pericentre and perpendicular to it, in inertial components.
pub(crate) type Axes<S> = [[Lanes<S>; 3]; 2];

/// The position of a body on its ellipse at some times: whole turns since the pericentre before the epoch, its place on the ellipse, and the ellipse's axes.
#[derive(Clone, Copy)]
pub(crate) struct Position<S: InstructionSet> {
    pub(crate) turns: Lanes<S>,
    pub(crate) place: Place<S>,
    pub(crate) axes: Axes<S>,
}

impl<S: InstructionSet> Position<S> {
    /// r̂, the direction to the body in inertial components.
    #[inline(always)]
    pub(crate) fn direction(&self) -> [Lanes<S>; 3] {
        let mut direction = self.axes[0];
        for (component, across) in direction.iter_mut().zip(self.axes[1]) {
            *component = component.mul_add(self.place.cosine, across * self.place.sine);
        }
        direction
    }
}

/// The motion of a body on its ellipse as a function of the time after an epoch, in the user's unit of time.
#[derive(Clone, Debug)]
pub(crate) struct Path {
    pub(crate) mean_anomaly: Phase,
    pub(crate) ellipse: Ellipse,
    /// At the epoch.
    pub(crate) axes: [Vector3<f64>; 3],
    turning: Option<TurningPlane>,
}

/// Node and argument of the pericentre as functions of the time after an epoch, and sine and cosine of the inclination.
#[derive(Clone, Debug)]
struct TurningPlane {
    node: Phase,
    argument: Phase,
    tilt: (f64, f64),
}

impl Path {
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
    pub(crate) fn at<S: InstructionSet>(&self, elapsed: Elapsed<S>) -> Position<S> {
        let (turns, angle) = self.mean_anomaly.turns_and_angle(elapsed);
        let axes = match &self.turning {
            Some(turning) => elapsed.0.simd().vectorize(AxesAt { turning, elapsed }),
            None => fixed(&self.axes, angle),
        };
        Position { turns, place: self.ellipse.place(angle), axes }
    }

    /// Radians per unit of time of mean anomaly, node and pericentre together.
    pub(crate) fn rate(&self) -> f64 {
        let turning = self.turning.as_ref();
        let slow = turning.map_or(0.0, |t| t.node.frequency().abs() + t.argument.frequency().abs());
        TAU * (self.mean_anomaly.frequency() + slow)
    }
}

/// The size of the imaginary mean anomaly at which the distance is 0, above the pericentre; infinite for a circle.
///
/// On an ellipse cos E = 1/e there: E = iy with tanh y = η, and M = i (y − η). On a hyperbola cosh H = 1/e: H = iy with tan y = √(e² − 1), and
/// M = i (√(e² − 1) − y).
pub(crate) fn singularity(eccentricity: f64) -> f64 {
    let root = ((1.0 - eccentricity) * (1.0 + eccentricity)).abs().sqrt();
    let square = if eccentricity > 1.0 { -root * root } else { root * root };
    match eccentricity {
        // Two terms of the series, where the difference cancels.
        _ if root < SMALL_ROOT => root * root * root * (1.0 / 3.0 + square / 5.0),
        e if e > 1.0 => root - root.atan(),
        _ => root.atanh() - root,
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
