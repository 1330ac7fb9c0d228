//! The averaged motion under several disturbing bodies, on orbits whose nodes and pericentres may precess.
//!
//! With the strengths Γ of the torques and time t
//!
//! ```text
//! dk/dt = Σ 2Γ (Δ/M) (a/r)³ (k·r̂) (r̂ × k)          dΨ/dt = Σ ⅔Γ (a/r)³ (1 − 3 (k·r̂)²)
//! ```
//!
//! The equations are solved on arcs of time, by polynomials as on the quarters of one orbit. The length of an arc follows from the singularities of the orbits
//! in the complex plane of time, which are near the pericentre of an eccentric orbit. Arcs are solved when a time first needs them, and are kept.

use pulp::Arch;

use super::arcs::{Averaged, SolvedArc};
use super::polynomial::{
    AtPoints, AveragedEquations, COLUMNS, Column, NODES, POINTS, PiecePolynomial, column_slopes, pole,
};
use crate::gravity_gradient::constants::SHORTEST_ARC;
use crate::gravity_gradient::orbit::elliptic_motion::Course;
use crate::gravity_gradient::second_order::k2::{across, dot};
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::Lanes;

/// A disturbing body: its course, and ⅔Γ in the units of the motion times the user's unit of time in these units.
#[derive(Clone, Debug)]
pub(crate) struct Pull {
    pub(crate) course: Course,
    pub(crate) attraction: f64,
}

/// The averaged equations; times are those from the epoch in the user's unit.
#[derive(Clone, Debug)]
pub(crate) struct Bodies {
    pub(crate) pulls: Vec<Pull>,
    /// Δ/M.
    pub(crate) delta: f64,
}

impl Averaged for Bodies {
    fn arc(&self, sign: f64, from: f64, start: &Column) -> SolvedArc {
        let longest = |pull: &Pull| pull.course.arc(pull.course.mean_anomaly.angle((sign * from, 0.0)));
        let length = self.pulls.iter().map(longest).fold(f64::INFINITY, f64::min);
        // Next to the pericentre of a nearly parabolic orbit an arc may be shorter than the spacing of the times.
        let length = length.max(SHORTEST_ARC * from);
        let half = 0.5 * length;
        let times = NODES.map(|x| sign * (from + half * (1.0 + x)));
        let bodies = dispatch(Arch::new(), PlacesAt { pulls: &self.pulls, times });
        let equations = OnArc { delta: self.delta, bodies };
        SolvedArc { from, length, solution: PiecePolynomial::solved(sign * half, (-1.0, start), &equations) }
    }
}

/// The averaged equations at the points of an arc: the components of the direction to each body, and its ⅔Γ (a/r)³.
struct OnArc {
    delta: f64,
    bodies: Vec<[AtPoints; 4]>,
}

impl AveragedEquations for OnArc {
    #[inline(always)]
    fn at<S: InstructionSet>(&self, first: usize, frame: QuaternionLanes<S>) -> [Lanes<S>; COLUMNS] {
        let axis = pole(frame);
        let all = |value: f64| axis[0].all(value);
        let (mut force, mut phase) = ([all(0.0); 3], all(0.0));
        for [x, y, z, attraction] in &self.bodies {
            let direction = [axis[0].like(&x[first..]), axis[0].like(&y[first..]), axis[0].like(&z[first..])];
            let attraction = axis[0].like(&attraction[first..]);
            let along = dot(&axis, &direction);
            let scale = attraction * along * all(3.0 * self.delta);
            for (sum, component) in force.iter_mut().zip(direction) {
                *sum = component.mul_add(scale, *sum);
            }
            phase = attraction.mul_add((along * along).negate_mul_add(all(3.0), all(1.0)), phase);
        }
        column_slopes(frame, across(force, &axis, all(1.0)), [phase; 2])
    }
}

/// The places of the bodies at the points of an arc, as [`OnArc`] needs them.
struct PlacesAt<'a> {
    pulls: &'a [Pull],
    times: AtPoints,
}

impl Task for PlacesAt<'_> {
    type Output = Vec<[AtPoints; 4]>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let none = Lanes::splat(simd, 0.0);
        let mut bodies = vec![[[0.0; POINTS]; 4]; self.pulls.len()];
        for (pull, [x, y, z, attraction]) in self.pulls.iter().zip(&mut bodies) {
            let e = pull.course.ellipse.eccentricity;
            for first in (0..POINTS).step_by(Lanes::<S>::WIDTH) {
                let when = pull.course.at((Lanes::load(simd, &self.times[first..]), none));
                let (sine, cosine) = (when.place.sine, when.place.cosine);
                for (c, row) in [&mut *x, y, z].into_iter().enumerate() {
                    when.axes[0][c].mul_add(cosine, when.axes[1][c] * sine).store(&mut row[first..]);
                }
                let near = cosine.mul_add(none.all(e), none.all(1.0)) * none.all(1.0 / ((1.0 - e) * (1.0 + e)));
                (near * near * near * none.all(pull.attraction)).store(&mut attraction[first..]);
            }
        }
        bodies
    }
}
