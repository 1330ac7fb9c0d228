//! The averaged motion under several disturbing bodies, on orbits whose nodes and pericentres may precess.
//!
//! With the attractions μ = G m/a³ of the bodies and time t
//!
//! ```text
//! dk/dt = Σ 3μ (Δ/M) (a/r)³ (k·r̂) (r̂ × k)          dJ/dt = Σ μ (a/r)³ (1 − 3 (k·r̂)²)
//! ```
//!
//! The equations are solved on arcs of time, by polynomials as on the quarters of one orbit. The length of an arc follows from the singularities of the orbits
//! in the complex plane of time, which are near the pericentre of an eccentric orbit. Arcs are solved when a time first needs them, and are kept.

use std::sync::{Arc, RwLock};

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use pulp::{Arch, NullaryFnOnce};

use super::polynomial::{COLUMNS, Column, NODES, POINTS, Polynomial};
use crate::gravity_gradient::course::Course;
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::{Lanes, WIDEST};

/// A disturbing body: where it is, and μ in the units of the motion times the user's unit of time in these units.
#[derive(Clone, Debug)]
pub(crate) struct Pull {
    pub(crate) course: Course,
    pub(crate) attraction: f64,
}

/// The averaged motion; times are those from the epoch in the user's unit.
#[derive(Clone, Debug)]
pub(crate) struct Bodies {
    pulls: Vec<Pull>,
    /// Δ/M.
    delta: f64,
    start: Column,
    /// The solved arcs after the epoch, and before it.
    kept: Arc<[RwLock<Vec<Stretch>>; 2]>,
}

/// The direction of a body and μ (a/r)³.
type Torque = (Vector3<f64>, f64);

/// One arc: the distances of its ends from the epoch, and the solution.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    from: f64,
    length: f64,
    solution: Polynomial,
}

impl Stretch {
    fn end(&self) -> f64 {
        self.from + self.length
    }
}

impl Bodies {
    /// From the frame at the epoch, where J and the drifts are 0.
    pub(crate) fn new(pulls: Vec<Pull>, delta: f64, frame: UnitQuaternion<f64>) -> Self {
        Self { pulls, delta, start: [frame.i, frame.j, frame.k, frame.w, 0.0, 0.0], kept: Arc::default() }
    }

    /// The frame and J at times after the epoch. The function is compiled separately: one fixed orbit does without it.
    #[inline(always)]
    pub(super) fn at<S: InstructionSet>(&self, times: Lanes<S>) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        times.simd().vectorize(At { bodies: self, times })
    }

    /// Consecutive times in the same arc are evaluated together.
    #[inline(always)]
    fn evaluated<S: InstructionSet>(&self, times: Lanes<S>) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        let all = times.values();
        let mut rows = [[0.0; WIDEST]; COLUMNS];
        let mut lane = 0;
        while lane < all.len() {
            let side = usize::from(all[lane] < 0.0);
            let stretch = self.stretch(side, all[lane].abs());
            let inside = |time: &f64| {
                usize::from(*time < 0.0) == side && time.abs() >= stretch.from && time.abs() <= stretch.end()
            };
            let next = lane + 1 + all[lane + 1..].iter().take_while(|time| inside(time)).count();
            let place =
                (times.magnitude() - times.all(stretch.from)) * times.all(2.0 / stretch.length) - times.all(1.0);
            let columns = stretch.solution.sums(place);
            if next - lane == all.len() {
                let [x, y, z, w, anomaly, longitude] = columns;
                return (QuaternionLanes([x, y, z, w]), [anomaly, longitude]);
            }
            for (row, column) in rows.iter_mut().zip(&columns) {
                row[lane..next].copy_from_slice(&column.values()[lane..next]);
            }
            lane = next;
        }
        let [x, y, z, w, anomaly, longitude] = rows.map(|row| times.like(&row));
        (QuaternionLanes([x, y, z, w]), [anomaly, longitude])
    }

    /// The arc that contains a time at this distance from the epoch. If it is not known yet, it is solved together with all arcs between.
    fn stretch(&self, side: usize, distance: f64) -> Stretch {
        let found = |arcs: &[Stretch]| arcs.get(arcs.partition_point(|arc| arc.end() < distance)).copied();
        // If a thread panicked while it held the lock, the arcs are still complete.
        let known = found(&self.kept[side].read().unwrap_or_else(|poisoned| poisoned.into_inner()));
        if let Some(arc) = known {
            return arc;
        }
        let mut arcs = self.kept[side].write().unwrap_or_else(|poisoned| poisoned.into_inner());
        loop {
            if let Some(arc) = found(&arcs) {
                return arc;
            }
            let (from, start) = arcs.last().map_or((0.0, self.start), |arc| (arc.end(), arc.solution.at(1.0)));
            arcs.push(self.solved(side, from, &start));
        }
    }

    /// The arc that begins at a distance from the epoch.
    fn solved(&self, side: usize, from: f64, start: &Column) -> Stretch {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let longest = |pull: &Pull| pull.course.arc(pull.course.mean_anomaly.angle((sign * from, 0.0)));
        let length = self.pulls.iter().map(longest).fold(f64::INFINITY, f64::min);
        let half = 0.5 * length;
        let times = NODES.map(|x| sign * (from + half * (1.0 + x)));
        let torques = dispatch(Arch::new(), Torques { pulls: &self.pulls, times });
        let slope = |i: usize, frame: &Quaternion<f64>| self.slope(torques.iter().map(|body| &body[i]), frame);
        Stretch { from, length, solution: Polynomial::solved(sign * half, (-1.0, start), slope) }
    }

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

/// [`Bodies::evaluated`] as a task that is compiled separately.
struct At<'a, S: InstructionSet> {
    bodies: &'a Bodies,
    times: Lanes<S>,
}

impl<S: InstructionSet> NullaryFnOnce for At<'_, S> {
    type Output = (QuaternionLanes<S>, [Lanes<S>; 2]);

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.bodies.evaluated(self.times)
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
                let e = pull.course.eccentricity;
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
