//! The average over the rotation alone, under one body on a fixed orbit: solved on quarters or eighths of the orbit.

use std::f64::consts::{PI, TAU};
use std::sync::{Arc, LazyLock};

use nalgebra::UnitQuaternion;

use super::arcs::{Chain, MOST};
use super::equations::{AveragedTorque, OnPiece};
use super::polynomial::{AtPoints, COLUMNS, Column, NODES, PiecePolynomial};
use crate::gravity_gradient::constants::FASTEST_IN_QUARTERS;
use crate::orbit::position::Position;
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// Number of pieces of an orbit, each with a polynomial of its own.
const FEWEST_PIECES: i64 = 4;
/// Number of quarters that are kept on each side of the epoch, 0.8 kB each; of eighths twice as many.
pub(crate) const MOST_QUARTERS: usize = 1 << 18;
const _: () = assert!(2 * MOST_QUARTERS < MOST);

/// The sines and the cosines of the true anomalies at the points, by piece, for [`FEWEST_PIECES`] and for twice as many.
static CIRCLES: LazyLock<[Vec<[AtPoints; 2]>; 2]> = LazyLock::new(|| {
    [FEWEST_PIECES, 2 * FEWEST_PIECES].map(|count| {
        let half = PI / count as f64;
        let piece = |piece: i64| {
            let circles = NODES.map(|x| (half * ((2 * piece + 1) as f64 + x)).sin_cos());
            [circles.map(|(sine, _)| sine), circles.map(|(_, cosine)| cosine)]
        };
        (0..count).map(piece).collect()
    })
});

/// The averaged motion, solved for each piece of the orbit: quarters, or eighths if the precession is fast.
#[derive(Clone, Debug)]
pub(crate) struct Spin {
    torque: AveragedTorque,
    /// Number of pieces of an orbit.
    count: i64,
    /// The piece that contains the epoch, counted from the pericentre before the epoch.
    first: i64,
    epoch: PiecePolynomial,
    /// The solved pieces after the epoch's piece, and before it.
    kept: Arc<[Chain<PiecePolynomial>; 2]>,
}

impl Spin {
    /// From the frame at a place of the orbit, where Ψ and the drifts are 0.
    pub(crate) fn new(torque: AveragedTorque, frame: UnitQuaternion<f64>, when: &Position<pulp::Scalar>) -> Self {
        let fast = torque.precession.abs() * (1.0 + torque.eccentricity) > FASTEST_IN_QUARTERS;
        let count = if fast { 2 * FEWEST_PIECES } else { FEWEST_PIECES };
        let (number, inside) = piece(count, when);
        let (first, inside) = (number.values()[0] as i64, inside.values()[0]);
        let start: Column = [frame.i, frame.j, frame.k, frame.w, 0.0, 0.0];
        let epoch = in_piece(&torque, (count, first), inside, &start);
        Self { torque, count, first, epoch, kept: Arc::default() }
    }

    /// The memory of the pieces that are solved, in bytes.
    pub(crate) fn memory(&self) -> usize {
        self.kept.iter().map(Chain::memory).sum()
    }

    /// Times in the same piece are evaluated together.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(&self, when: &Position<S>) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        let (number, inside) = piece(self.count, when);
        let pieces = number.values();
        // The bound of the motion keeps the numbers within 2 MOST_QUARTERS.
        let mut columns = self.sums(pieces[0] as i64 - self.first, inside);
        for (lane, piece) in pieces.iter().enumerate().skip(1) {
            if pieces[..lane].contains(piece) {
                continue;
            }
            let distance = (number - inside.all(*piece)).magnitude();
            let others = self.sums(*piece as i64 - self.first, inside);
            for (column, other) in columns.iter_mut().zip(others) {
                *column = distance.up_to(0.5, other, *column);
            }
        }
        let [x, y, z, w, anomaly, longitude] = columns;
        (QuaternionLanes([x, y, z, w]), [anomaly, longitude])
    }

    /// The sums of the piece at a distance from the epoch's piece. If it is not known yet, it is solved together with all pieces between.
    #[inline(always)]
    fn sums<S: InstructionSet>(&self, distance: i64, inside: Lanes<S>) -> [Lanes<S>; COLUMNS] {
        let (side, index) = match distance {
            0 => return self.epoch.sums(inside),
            later if later > 0 => (0, later as usize - 1),
            earlier => (1, earlier.unsigned_abs() as usize - 1),
        };
        self.kept[side].get(index).unwrap_or_else(|| self.solved(side, index)).sums(inside)
    }

    #[cold]
    fn solved(&self, side: usize, index: usize) -> &PiecePolynomial {
        let (step, end) = if side == 0 { (1, 1.0) } else { (-1, -1.0) };
        self.kept[side].get_or_compute(index, |index, last| {
            let start = last.unwrap_or(&self.epoch).at(end);
            let number = self.first + step * (index as i64 + 1);
            in_piece(&self.torque, (self.count, number), -end, &start)
        })
    }
}

/// The number of the piece of so many in an orbit, counted from the pericentre before the epoch, and the place in it from −1 to 1. At the end of a piece rounding
/// decides between it and the next one, and the place may exceed ±1 by rounding.
#[inline(always)]
fn piece<S: InstructionSet>(count: i64, when: &Position<S>) -> (Lanes<S>, Lanes<S>) {
    let all = |value: f64| when.turns.all(value);
    let pieces = when.place.angle * all(count as f64 / TAU);
    let part = (pieces - all(0.5)).rounded();
    (when.turns.mul_add(all(count as f64), part), all(2.0).mul_add(pieces - part, all(-1.0)))
}

/// The solution in a piece that passes through `start` at a place of the piece.
fn in_piece(torque: &AveragedTorque, (count, number): (i64, i64), place: f64, start: &Column) -> PiecePolynomial {
    let circles = &CIRCLES[usize::from(count != FEWEST_PIECES)];
    let [sine, cosine] = &circles[number.rem_euclid(count) as usize]; // 0 ≤ number < count
    PiecePolynomial::solved(PI / count as f64, (place, start), &OnPiece { torque, sine, cosine })
}
