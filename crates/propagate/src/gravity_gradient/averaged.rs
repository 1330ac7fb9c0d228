//! The averaged motion of the angular momentum under the gravity gradient (theory §9). The invariable frame moves with the angular momentum and does not turn
//! about it.
//!
//! Let k be the unit angular momentum, Δ(σ) = (3 T33 − A − B − C)/2 averaged over ℓ′ and y′, and κ_o = 3φn Δ/(M η³), where φ is the mass fraction. Then
//!
//! ```text
//! dk/df = κ_o (1 + e cos f) (k·r̂) (r̂ × k)        dΨ/df = n η^(−3) (1 + e cos f) (1 − 3 (k·r̂)²)
//! ```
//!
//! where Ψ is the phase integral: to first order the torque adds s Ψ to ℓ′ and −σ s Ψ to y′, with s = −φ Δ′(σ)/(2M) ([`super::averages`]).
//!
//! `Slow::Spin` solves these equations on quarters or eighths of an orbit by Picard's iteration on Chebyshev points. In first order the right-hand side is a
//! trigonometric polynomial of f; what second order adds is not, but small: at e = 0.95 quarters and eighths agree to 7e-15 over 20 orbits. κ_o(1 + e) is at most
//! 0.3, so the iteration converges to rounding error. The result is a polynomial that can be evaluated at any time of the piece. A piece is solved when a time
//! first needs it, and is kept. `Slow::Orbit` is the orbit average: precession about the orbit's normal, steady in first order, with the periodic part in closed
//! form in f, without an expansion in e. `Slow::Bodies` has the sum over several disturbing bodies on orbits that may precess. It is averaged over the rotation
//! only, and solved on arcs of time.

use std::f64::consts::{PI, TAU};
use std::sync::{Arc, LazyLock};

use nalgebra::{Unit, UnitQuaternion, Vector3};

use super::corrections::Demand;
use super::course::{Elapsed, When};
use super::second_order::hamiltonian::{DisturberLanes, Hamiltonian, dot};
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

mod arcs;
mod bodies;
mod chain;
mod polynomial;
mod precession;
#[cfg(test)]
mod tests;

pub(crate) use bodies::{Bodies, Pull};
use chain::Chain;
use polynomial::{COLUMNS, Column, NODES, Polynomial, Row, Slopes};
pub(crate) use precession::Precession;

/// Number of pieces of an orbit, each with a polynomial of its own.
const FEWEST_PIECES: i64 = 4;
/// Largest precession of the angular momentum in one radian of the true anomaly for which an orbit has this number of pieces \[rad\]. The polynomials on quarters
/// then have an error of 1e-14 rad. If the precession is faster, an orbit has twice as many pieces.
const FASTEST_IN_QUARTERS: f64 = 0.02;
/// Number of quarters that are kept on each side of the epoch, 0.8 kB each; of eighths twice as many.
pub(crate) const MOST_QUARTERS: usize = 1 << 18;
const _: () = assert!(2 * MOST_QUARTERS < chain::MOST);

/// The orbit and the strength of its torque, in the units of the averaged motion.
#[derive(Clone, Debug)]
pub(crate) struct AveragedOrbit {
    pub(crate) eccentricity: f64,
    eta_cubed: f64,
    /// The mean over the mean anomaly of ½ cos 2f + ½ e cos f + ⅙ e cos 3f, with its sign changed.
    mean_of_sine: f64,
    /// n in the units of the motion.
    mean_motion: f64,
    /// G m/a³ over n².
    fraction: f64,
    axes: [Vector3<f64>; 3],
    /// κ_o.
    strength: f64,
    /// ⟨D⟩ + K2, if the averaged equations are those of second order.
    second: Option<Box<Hamiltonian>>,
}

/// The averaged motion.
#[derive(Clone, Debug)]
pub(crate) enum Slow {
    /// Averaged over the rotation only.
    Spin(Box<Spin>),
    /// Averaged over the rotation and the orbit.
    Orbit(Box<Precession>),
    /// Averaged over the rotation only, for several bodies or for orbits that precess.
    Bodies(Box<Bodies>),
}

impl Slow {
    /// The memory of what is solved so far, in bytes.
    pub(crate) fn memory(&self) -> usize {
        match self {
            Self::Spin(spin) => spin.kept.iter().map(Chain::memory).sum(),
            Self::Orbit(precession) => precession.memory(),
            Self::Bodies(bodies) => bodies.memory(),
        }
    }

    /// The invariable frame at times after the epoch, and two numbers: the phase integral Ψ twice, or in second order the drifts of ℓ′ and y′. `when` is the
    /// position of the first body.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(
        &self,
        when: &When<S>,
        elapsed: Elapsed<S>,
    ) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        match self {
            Self::Spin(spin) => spin.at(when),
            Self::Orbit(precession) => precession.at(&when.place, elapsed),
            Self::Bodies(bodies) => bodies.at(elapsed.0),
        }
    }
}

impl AveragedOrbit {
    /// The averaged orbit; `delta` is Δ/M.
    pub(crate) fn new(demand: &Demand<'_>, delta: f64) -> Self {
        let Demand { orbit, mean_motion, axes, .. } = *demand;
        let (eccentricity, fraction) = (orbit.eccentricity(), orbit.disturbing_fraction());
        let eta = (1.0 - eccentricity * eccentricity).sqrt();
        let eta_cubed = eta * eta * eta;
        // ⟨cos kf⟩ = (−β)^k (1 + kη).
        let beta = eccentricity / (1.0 + eta);
        let third = eccentricity / 6.0 * beta * (1.0 + 3.0 * eta);
        let mean_of_sine = 0.5 * eccentricity * eccentricity - beta * beta * (0.5 * (1.0 + 2.0 * eta) - third);
        let strength = 3.0 * mean_motion * (delta * fraction) / eta_cubed;
        Self { eccentricity, eta_cubed, mean_of_sine, mean_motion, fraction, axes, strength, second: None }
    }

    /// With the averaged equations of second order.
    pub(crate) fn with_second(self, hamiltonian: Hamiltonian) -> Self {
        Self { second: Some(Box::new(hamiltonian)), ..self }
    }

    /// κ_o.
    pub(crate) fn strength(&self) -> f64 {
        self.strength
    }

    /// Whether the averaged equations are those of second order.
    pub(crate) fn is_of_second_order(&self) -> bool {
        self.second.is_some()
    }

    /// G m/a³ over n².
    pub(crate) fn fraction(&self) -> f64 {
        self.fraction
    }

    /// G m/a³, in the units of the motion.
    pub(crate) fn attraction(&self) -> f64 {
        self.mean_motion * self.mean_motion * self.fraction
    }

    /// η³.
    pub(crate) fn eta_cubed(&self) -> f64 {
        self.eta_cubed
    }

    /// The orbit's normal.
    pub(crate) fn normal(&self) -> Unit<Vector3<f64>> {
        Unit::new_unchecked(self.axes[2])
    }

    /// dΨ/dt averaged over the orbit, for an angular momentum along an axis.
    pub(crate) fn secular(&self, axis: &Vector3<f64>) -> f64 {
        // 1 − (3/2) sin² I is computed without cancellation at I = 0.
        let sine_square = axis.cross(&self.axes[2]).norm_squared();
        self.mean_motion * self.mean_motion * (1.0 - 1.5 * sine_square) / self.eta_cubed
    }
}

/// The averaged equations at the points of a piece of the orbit, by true anomaly.
struct Piece<'a> {
    ellipse: &'a AveragedOrbit,
    sine: &'a Row,
    cosine: &'a Row,
}

/// The sines and the cosines of the true anomalies at the points, by piece, for [`FEWEST_PIECES`] and for twice as many.
static CIRCLES: LazyLock<[Vec<[Row; 2]>; 2]> = LazyLock::new(|| {
    [FEWEST_PIECES, 2 * FEWEST_PIECES].map(|count| {
        let half = PI / count as f64;
        let piece = |piece: i64| {
            let circles = NODES.map(|x| (half * ((2 * piece + 1) as f64 + x)).sin_cos());
            [circles.map(|(sine, _)| sine), circles.map(|(_, cosine)| cosine)]
        };
        (0..count).map(piece).collect()
    })
});

impl Slopes for Piece<'_> {
    #[inline(always)]
    fn at<S: InstructionSet>(&self, first: usize, frame: QuaternionLanes<S>) -> [Lanes<S>; COLUMNS] {
        let AveragedOrbit { eccentricity, eta_cubed, mean_motion, axes, strength, .. } = self.ellipse;
        let like = frame.0[0];
        let all = |value: f64| like.all(value);
        let (sine, cosine) = (like.like(&self.sine[first..]), like.like(&self.cosine[first..]));
        let mut direction = [like; 3];
        for (c, component) in direction.iter_mut().enumerate() {
            *component = cosine.mul_add(all(axes[0][c]), sine * all(axes[1][c]));
        }
        let weight = cosine.mul_add(all(*eccentricity), all(1.0));
        let rows = frame.rows();
        let axis = [rows[0][2], rows[1][2], rows[2][2]];
        let along = dot(&axis, &direction);
        let (turning, phases) = match &self.ellipse.second {
            Some(hamiltonian) => {
                let square = weight * weight;
                let disturber = DisturberLanes {
                    direction,
                    normal: axes[2],
                    cube: square * weight * all(1.0 / (eta_cubed * eta_cubed)),
                    rate: square * all(mean_motion / eta_cubed),
                };
                let (turning, phases) = hamiltonian.slopes_at(&axis, &disturber);
                let inverse = disturber.rate.reciprocal();
                let [x, y, z] = turning;
                ([x * inverse, y * inverse, z * inverse], [phases[0] * inverse, phases[1] * inverse])
            }
            None => {
                // k × dk turns k, without a component about k.
                let scale = weight * along * all(*strength);
                let mut turning = direction;
                for (component, axis) in turning.iter_mut().zip(axis) {
                    *component = axis.negate_mul_add(along, *component) * scale;
                }
                let phase = weight * all(mean_motion / eta_cubed) * (along * along).negate_mul_add(all(3.0), all(1.0));
                (turning, [phase, phase])
            }
        };
        let half = all(0.5);
        let [x, y, z] = turning;
        let [i, j, k, w] = (QuaternionLanes([x * half, y * half, z * half, like.all(0.0)]) * frame).0;
        [i, j, k, w, phases[0], phases[1]]
    }
}

/// The averaged motion, solved for each piece of the orbit: quarters, or eighths if the precession is fast.
#[derive(Clone, Debug)]
pub(crate) struct Spin {
    ellipse: AveragedOrbit,
    /// Number of pieces of an orbit.
    count: i64,
    /// The piece that contains the epoch, counted from the pericentre before the epoch.
    first: i64,
    epoch: Polynomial,
    /// The solved pieces after the epoch's piece, and before it.
    kept: Arc<[Chain<Polynomial>; 2]>,
}

impl Spin {
    /// From the frame at a place of the orbit, where Ψ and the drifts are 0.
    pub(crate) fn new(ellipse: AveragedOrbit, frame: UnitQuaternion<f64>, when: &When<pulp::Scalar>) -> Self {
        let fast = ellipse.strength.abs() * (1.0 + ellipse.eccentricity) > FASTEST_IN_QUARTERS;
        let count = if fast { 2 * FEWEST_PIECES } else { FEWEST_PIECES };
        let (number, inside) = piece(count, when);
        let (first, inside) = (number.values()[0] as i64, inside.values()[0]);
        let start: Column = [frame.i, frame.j, frame.k, frame.w, 0.0, 0.0];
        let epoch = in_piece(&ellipse, (count, first), inside, &start);
        Self { ellipse, count, first, epoch, kept: Arc::default() }
    }

    /// Times in the same piece are evaluated together.
    #[inline(always)]
    fn at<S: InstructionSet>(&self, when: &When<S>) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
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
    fn solved(&self, side: usize, index: usize) -> &Polynomial {
        let (step, end) = if side == 0 { (1, 1.0) } else { (-1, -1.0) };
        self.kept[side].get_or_compute(index, |index, last| {
            let start = last.unwrap_or(&self.epoch).at(end);
            let number = self.first + step * (index as i64 + 1);
            in_piece(&self.ellipse, (self.count, number), -end, &start)
        })
    }
}

/// The number of the piece of so many in an orbit, counted from the pericentre before the epoch, and the place in it from −1 to 1. At the end of a piece rounding
/// decides between it and the next one, and the place may exceed ±1 by rounding.
#[inline(always)]
fn piece<S: InstructionSet>(count: i64, when: &When<S>) -> (Lanes<S>, Lanes<S>) {
    let all = |value: f64| when.turns.all(value);
    let pieces = when.place.angle * all(count as f64 / TAU);
    let part = (pieces - all(0.5)).rounded();
    (when.turns.mul_add(all(count as f64), part), all(2.0).mul_add(pieces - part, all(-1.0)))
}

/// The solution in a piece that passes through `start` at a place of the piece.
fn in_piece(ellipse: &AveragedOrbit, (count, number): (i64, i64), place: f64, start: &Column) -> Polynomial {
    let circles = &CIRCLES[usize::from(count != FEWEST_PIECES)];
    let [sine, cosine] = &circles[number.rem_euclid(count) as usize]; // 0 ≤ number < count
    Polynomial::solved(PI / count as f64, (place, start), &Piece { ellipse, sine, cosine })
}
