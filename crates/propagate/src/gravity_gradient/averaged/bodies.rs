//! The averaged motion under several disturbing bodies, on orbits whose nodes and pericentres may precess.
//!
//! The equations ([`OnArc`]) are solved on arcs of time, by polynomials as on the quarters of one orbit. The length of an arc follows from the singularities of the orbits
//! in the complex plane of time, which are near the pericentre of an eccentric orbit. Arcs are solved when a time first needs them, and are kept.

use std::f64::consts::{PI, TAU};

use pulp::Arch;

use super::arcs::{Averaged, SolvedArc};
use super::equations::OnArc;
use super::polynomial::{AtPoints, Column, NODES, POINTS, PiecePolynomial};
use crate::gravity_gradient::constants::{ARC_SHARE, LONGEST_ARC, SHORTEST_ARC};
use crate::orbit::position::{Path, singularity};
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::Lanes;

/// The averaged equations; times are those from the epoch in the user's unit.
#[derive(Clone, Debug)]
pub(crate) struct Bodies {
    /// The path of each body, and its ⅔Γ in the units of the motion times the user's unit of time in these units.
    pub(crate) bodies: Vec<(Path, f64)>,
    /// Δ/M.
    pub(crate) delta: f64,
}

impl Averaged for Bodies {
    fn arc(&self, sign: f64, from: f64, start: &Column) -> SolvedArc {
        let longest = |(path, _): &(Path, f64)| longest_arc(path, path.mean_anomaly.angle((sign * from, 0.0)));
        let length = self.bodies.iter().map(longest).fold(f64::INFINITY, f64::min);
        // Next to the pericentre of a nearly parabolic orbit an arc may be shorter than the spacing of the times.
        let length = length.max(SHORTEST_ARC * from);
        let half = 0.5 * length;
        let times = NODES.map(|x| sign * (from + half * (1.0 + x)));
        let bodies = dispatch(Arch::new(), DirectionsAt { bodies: &self.bodies, times });
        let equations = OnArc { delta: self.delta, bodies };
        SolvedArc { from, length, solution: PiecePolynomial::solved(sign * half, (-1.0, start), &equations) }
    }
}

/// The directions and strengths of the bodies at the points of an arc, as [`OnArc`] needs them.
struct DirectionsAt<'a> {
    bodies: &'a [(Path, f64)],
    times: AtPoints,
}

impl Task for DirectionsAt<'_> {
    type Output = Vec<[AtPoints; 4]>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let none = Lanes::splat(simd, 0.0);
        let mut bodies = vec![[[0.0; POINTS]; 4]; self.bodies.len()];
        for ((path, strength), [x, y, z, attraction]) in self.bodies.iter().zip(&mut bodies) {
            let e = path.ellipse.eccentricity;
            for first in (0..POINTS).step_by(Lanes::<S>::WIDTH) {
                let position = path.at((Lanes::load(simd, &self.times[first..]), none));
                for (component, row) in position.direction().into_iter().zip([&mut *x, y, z]) {
                    component.store(&mut row[first..]);
                }
                let near =
                    position.place.cosine.mul_add(none.all(e), none.all(1.0)) * none.all(1.0 / ((1.0 - e) * (1.0 + e)));
                (near * near * near * none.all(*strength)).store(&mut attraction[first..]);
            }
        }
        bodies
    }
}

/// The longest time from a place on an orbit over which a polynomial represents the torque, in either direction.
fn longest_arc(path: &Path, mean_anomaly: f64) -> f64 {
    to_singularity(path, mean_anomaly).min(LONGEST_ARC / path.rate())
}

/// The longest time over which a polynomial represents the torque, without the precession of the orbit.
fn to_singularity(path: &Path, mean_anomaly: f64) -> f64 {
    let distance = mean_anomaly.hypot(singularity(path.ellipse.eccentricity));
    ARC_SHARE * distance / (TAU * path.mean_anomaly.frequency())
}

/// Number of arcs in a unit of time under one body, at most.
pub(crate) fn most_arcs(path: &Path) -> f64 {
    let rate = TAU * path.mean_anomaly.frequency();
    let (mut anomaly, mut count) = (-PI, 0.0);
    while anomaly < PI {
        anomaly += rate * to_singularity(path, anomaly);
        count += 1.0;
    }
    count * path.mean_anomaly.frequency() + path.rate() / LONGEST_ARC
}
