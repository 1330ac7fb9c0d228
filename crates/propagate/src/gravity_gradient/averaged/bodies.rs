//! The averaged motion under several disturbing bodies, on orbits whose nodes and pericentres may precess.
//!
//! With the attractions μ = G m/a³ of the bodies and time t
//!
//! ```text
//! dk/dt = Σ 3μ (Δ/M) (a/r)³ (k·r̂) (r̂ × k)          dΨ/dt = Σ μ (a/r)³ (1 − 3 (k·r̂)²)
//! ```
//!
//! The equations are solved on arcs of time, by polynomials as on the quarters of one orbit. The length of an arc follows from the singularities of the orbits
//! in the complex plane of time, which are near the pericentre of an eccentric orbit. Arcs are solved when a time first needs them, and are kept.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use pulp::Arch;

use super::arcs::{Arcs, Averaged, SolvedArc};
use super::polynomial::{Column, NODES, POINTS, PiecePolynomial, PointByPoint};
use crate::gravity_gradient::orbit::elliptic_motion::Course;
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::Lanes;

/// Shortest arc, over the time from the epoch.
const SHORTEST_ARC: f64 = 8.0 * f64::EPSILON;

/// A disturbing body: where it is, and μ in the units of the motion times the user's unit of time in these units.
#[derive(Clone, Debug)]
pub(crate) struct Pull {
    pub(crate) course: Course,
    pub(crate) attraction: f64,
}

/// The averaged motion; times are those from the epoch in the user's unit.
#[derive(Clone, Debug)]
pub(crate) struct Bodies {
    equations: BodiesEquations,
    arcs: Arcs,
}

/// The averaged equations.
#[derive(Clone, Debug)]
struct BodiesEquations {
    pulls: Vec<Pull>,
    /// Δ/M.
    delta: f64,
}

/// The direction of a body and μ (a/r)³.
type Torque = (Vector3<f64>, f64);

impl Bodies {
    /// From the frame at the epoch, where the phase integral Ψ is 0.
    pub(crate) fn new(pulls: Vec<Pull>, delta: f64, frame: UnitQuaternion<f64>) -> Self {
        let start = [frame.i, frame.j, frame.k, frame.w, 0.0, 0.0];
        Self { equations: BodiesEquations { pulls, delta }, arcs: Arcs::new(start) }
    }

    /// The memory of what is solved so far, in bytes.
    pub(crate) fn memory(&self) -> usize {
        self.arcs.memory()
    }

    /// The frame, and Ψ twice, at times after the epoch.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(&self, times: Lanes<S>) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        self.arcs.at(&self.equations, times)
    }
}

impl Averaged for BodiesEquations {
    fn arc(&self, sign: f64, from: f64, start: &Column) -> SolvedArc {
        let longest = |pull: &Pull| pull.course.arc(pull.course.mean_anomaly.angle((sign * from, 0.0)));
        let length = self.pulls.iter().map(longest).fold(f64::INFINITY, f64::min);
        // Next to the pericentre of a nearly parabolic orbit an arc may be shorter than the spacing of the times.
        let length = length.max(SHORTEST_ARC * from);
        let half = 0.5 * length;
        let times = NODES.map(|x| sign * (from + half * (1.0 + x)));
        let torques = dispatch(Arch::new(), Torques { pulls: &self.pulls, times });
        let slope = |i: usize, frame: &Quaternion<f64>| self.slope(torques.iter().map(|body| &body[i]), frame);
        SolvedArc { from, length, solution: PiecePolynomial::solved(sign * half, (-1.0, start), &PointByPoint(slope)) }
    }
}

impl BodiesEquations {
    /// The derivative of a column by time, from the directions of the bodies and μ(a/r)³.
    fn slope<'a>(&self, torques: impl Iterator<Item = &'a Torque>, frame: &Quaternion<f64>) -> Column {
        let axis = (frame * Quaternion::new(0.0, 0.0, 0.0, 1.0) * frame.conjugate()).imag();
        let (mut turning, mut phase) = (Vector3::zeros(), 0.0);
        for (direction, attraction) in torques {
            let along = axis.dot(direction);
            // k × dk turns k, without a component about k.
            turning += (direction - axis * along) * (3.0 * attraction * self.delta * along);
            phase += attraction * (1.0 - 3.0 * along * along);
        }
        let change = Quaternion::from_parts(0.0, turning * 0.5) * frame;
        [change.i, change.j, change.k, change.w, phase, phase]
    }
}

/// The directions of the bodies and μ (a/r)³ at the points of an arc, by body.
struct Torques<'a> {
    pulls: &'a [Pull],
    times: [f64; POINTS],
}

impl Task for Torques<'_> {
    type Output = Vec<[Torque; POINTS]>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let none = Lanes::splat(simd, 0.0);
        let mut all = vec![[(Vector3::zeros(), 0.0); POINTS]; self.pulls.len()];
        for (pull, torques) in self.pulls.iter().zip(&mut all) {
            let width = Lanes::<S>::WIDTH;
            for (times, torques) in self.times.chunks(width).zip(torques.chunks_mut(width)) {
                let when = pull.course.at((Lanes::load(simd, times), none));
                let e = pull.course.ellipse.eccentricity;
                for (lane, torque) in torques.iter_mut().enumerate() {
                    let [first, second] = when.axes.map(|axis| Vector3::from(axis.map(|lanes| lanes.values()[lane])));
                    let (sine, cosine) = (when.place.sine.values()[lane], when.place.cosine.values()[lane]);
                    let near = (1.0 + e * cosine) / ((1.0 - e) * (1.0 + e));
                    *torque = (first * cosine + second * sine, pull.attraction * near * near * near);
                }
            }
        }
        all
    }
}
