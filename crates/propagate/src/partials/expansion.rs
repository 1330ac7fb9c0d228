//! Derivatives where the closed form cancels: next to a sphere, to the separatrix and to the middle axis, and for a tensor with nearly equal moments (theory §12).
//!
//! The equations of g, of δg and of ∫ g_i g_j dt have polynomial right sides, and their solutions have no small divisor. They are expanded in powers of time about
//! points of the polhode that are apart by a step. With x = 2K ℓ′/π as the time, the poles of g are at least K′ ≥ π/2 from the real axis, and a step of π/16 is
//! an eighth of this. The n-th term is then 8⁻ⁿ of the first.
//!
//! Near the middle axis, where an error would grow like e^x, each step ends on the invariants of the epoch: |g|² = 1, d1 g3² − d3 g1² = d1 Q1, and their
//! changes with the parameters.
//!
//! The expansion covers half a turn of ℓ′ on either side of the epoch. After half a turn, x = 2K, the polhode repeats: g(t + T; p) = S g(t; p), where S turns by π
//! about axis 3 and T is the time of half a turn. T and, with a product of inertia, S depend on the parameters p, hence
//!
//! ```text
//! δg(t + jT) = Sʲ (δg(t) − j δT ġ(t)) + (δS g(t) for odd j)
//! ```
//!
//! Half a turn has 16 steps or, next to the separatrix, some hundreds. A step takes longer than the derivatives at one time.

use std::f64::consts::PI;

use andoyer_double::{DoubleDouble, two_sum};
use nalgebra::{Quaternion, UnitQuaternion};

use super::derivatives::Derivatives;
use super::displacement::{DISPLACEMENTS, Displacement, ELEMENTS, Response, Writer, products};
use super::evaluate::Target;
use crate::error::Error;
use crate::motion::solved::Motion;
use crate::solve::untruncated;
use crate::torque_free::frequencies::Secular;
use crate::torque_free::polhode::Polhode;

/// Distance of the points of expansion.
const STEP: f64 = PI / 16.0;
/// Terms of an expansion: the first one that is missing is 8^−20 of the first, 1e-18.
const TERMS: usize = 20;
/// g2² above which a point is near the middle axis.
const NEAR_THE_MIDDLE: f64 = 0.5;

type Polynomial = [f64; TERMS];

/// Fills the derivatives of a wobble or a passage.
pub(super) fn fill<const N: usize>(
    motion: &Motion,
    polhode: &Polhode,
    target: Target<'_>,
    outputs: (&mut [Derivatives<N>], &mut [Derivatives<N>]),
) -> Result<(), Error> {
    let exact = untruncated(&motion.scene, polhode, motion.plan.mode())?;
    let (attitudes, _) = exact.samples_about_principal_axes(target.epoch, target.times)?;
    let displacements = &Displacement::all(polhode, target.setting);
    let writer = Writer { polhode, setting: target.setting, displacements };
    let mut expansion = Expansion::new(&writer, N - 3);
    for (index, time) in target.times.iter().enumerate() {
        let attitude = UnitQuaternion::new_unchecked(Quaternion::from(attitudes[index]));
        let carried = (attitude.inverse() * target.initial).to_rotation_matrix().into_inner();
        let elapsed = two_sum(*time, -target.epoch);
        let response = expansion.response(DoubleDouble { high: elapsed.0, low: elapsed.1 });
        writer.write(&carried, &response, &mut outputs.0[index], &mut outputs.1[index]);
    }
    Ok(())
}

/// g, δg of each displacement and ∫ g_i g_j dx in the order of [`ELEMENTS`].
#[derive(Clone, Copy)]
struct Point {
    direction: [f64; 3],
    changes: [[f64; 3]; DISPLACEMENTS],
    integrals: [f64; 6],
}

/// The expansion of a motion about several points.
struct Expansion<'a> {
    writer: &'a Writer<'a>,
    /// Number of displacements.
    count: usize,
    /// Change of x in a unit of scaled time.
    rate: f64,
    /// 2K, the change of x in half a turn of ℓ′.
    half_turn: f64,
    /// Half turns of ℓ′ in a unit of scaled time.
    turns: DoubleDouble,
    /// d over the rate of x.
    slopes: [f64; 3],
    invariants: DisplacedInvariants,
    /// After the epoch, and before it.
    sides: [ExpandedSide; 2],
}

/// The expansions on one side of the epoch.
struct ExpandedSide {
    sign: f64,
    steps: Vec<LocalExpansion>,
    /// The point at which the next step begins.
    next: Point,
    /// What half a turn changes, once a time needs it.
    half_turn: Option<HalfTurn>,
}

/// The changes in half a turn of ℓ′ on one side of the epoch.
#[derive(Clone, Copy)]
struct HalfTurn {
    integrals: [f64; 6],
    /// δT, with the sign of the side.
    delays: [f64; DISPLACEMENTS],
    /// The first two components of the rotation vector of axis 3.
    tilts: [[f64; 2]; DISPLACEMENTS],
}

/// The expansion about one point.
struct LocalExpansion {
    direction: [Polynomial; 3],
    changes: [[Polynomial; 3]; DISPLACEMENTS],
    integrals: [Polynomial; 6],
}

impl<'a> Expansion<'a> {
    fn new(writer: &'a Writer<'a>, count: usize) -> Self {
        let Writer { polhode, displacements, .. } = writer;
        let invariants = &polhode.invariants;
        let turns = Secular::exact(polhode).anomaly_rate / DoubleDouble::PI;
        let turns = if turns.high < 0.0 { -turns } else { turns };
        let half_turn = 2.0 * invariants.theta.quarter;
        let rate = half_turn * turns.to_f64();
        let slopes = writer.setting.slopes.map(|slope| slope / rate);
        let start = Point {
            direction: writer.setting.direction,
            changes: displacements.map(|displacement| displacement.step),
            integrals: [0.0; 6],
        };
        let sides = [1.0, -1.0].map(|sign| ExpandedSide { sign, steps: Vec::new(), next: start, half_turn: None });
        let invariants = DisplacedInvariants::new(writer, slopes, rate);
        Self { writer, count, rate, half_turn, turns, slopes, invariants, sides }
    }

    /// The point at x, which is at most half a turn away from the epoch.
    fn point(&mut self, x: f64) -> Point {
        let Self { writer, count, rate, slopes, invariants, sides, .. } = self;
        let side = &mut sides[usize::from(x < 0.0)];
        let index = (x.abs() / STEP) as usize;
        while side.steps.len() <= index {
            let step = LocalExpansion::new(&side.next, *slopes, *rate, &writer.displacements[..*count]);
            side.next = step.at(side.sign * STEP);
            invariants.restore(&mut side.next, &writer.displacements[..*count]);
            side.steps.push(step);
        }
        side.steps[index].at(side.sign * (x.abs() - index as f64 * STEP))
    }

    fn response(&mut self, elapsed: DoubleDouble) -> Response {
        let unit = self.writer.setting.unit;
        let turns = self.turns * elapsed.times_double(unit);
        let whole = turns.high.trunc();
        let time = elapsed.high * unit;
        let point = if whole == 0.0 {
            self.point(self.rate * time)
        } else {
            let rest = (turns - whole.into()).to_f64();
            let here = self.point(self.half_turn * rest.abs().copysign(whole));
            self.later(here, whole)
        };
        let displacements = self.writer.displacements;
        let along = displacements.map(|displacement| {
            displacement.energy(self.writer.setting) * time + displacement.half_form(&point.integrals) / self.rate
        });
        Response { direction: point.direction, changes: point.changes, along }
    }

    /// The point after a whole number of half turns.
    fn later(&mut self, here: Point, whole: f64) -> Point {
        let HalfTurn { integrals, delays, tilts } = self.half_turn(whole);
        let motion = velocity(self.slopes, here.direction);
        let odd = whole.abs() % 2.0 == 1.0;
        let sign = if odd { -1.0 } else { 1.0 };
        let mut point = here;
        for index in 0..self.count {
            let delay = whole.abs() * delays[index];
            let [a, b, c]: [f64; 3] = std::array::from_fn(|i| here.changes[index][i] - delay * motion[i]);
            let [p, q, r] = if odd { tilted(tilts[index], here.direction) } else { [0.0; 3] };
            point.changes[index] = [sign * a + p, sign * b + q, c + r];
        }
        point.direction = [sign * here.direction[0], sign * here.direction[1], here.direction[2]];
        for (index, (i, j)) in ELEMENTS.into_iter().enumerate() {
            // g1 g3 and g2 g3 change their sign after half a turn, the other products do not.
            point.integrals[index] = if i != 2 && j == 2 {
                (if odd { integrals[index] } else { 0.0 }) + sign * here.integrals[index]
            } else {
                whole.abs() * integrals[index] + here.integrals[index]
            };
        }
        point
    }

    /// The changes in half a turn on one side, from S (δg(0) ∓ δT ġ(0)) + δS g(0) at its end.
    fn half_turn(&mut self, whole: f64) -> HalfTurn {
        let side = usize::from(whole < 0.0);
        if let Some(found) = self.sides[side].half_turn {
            return found;
        }
        let end = self.point(self.half_turn.copysign(whole));
        let start = self.writer.setting.direction;
        let from = velocity(self.slopes, start);
        let square: f64 = from.iter().map(|component| component * component).sum();
        let tilts = self.writer.displacements.map(|displacement| tilt(&displacement, self.slopes, self.rate));
        let delays = std::array::from_fn(|index| {
            let ([a, b, c], [p, q, r]) = (end.changes[index], tilted(tilts[index], start));
            let (step, back) = (self.writer.displacements[index].step, [p - a, q - b, c - r]);
            (0..3).map(|i| (step[i] - back[i]) * from[i]).sum::<f64>() / square
        });
        let found = HalfTurn { integrals: end.integrals, delays, tilts };
        self.sides[side].half_turn = Some(found);
        found
    }
}

/// ġ.
fn velocity(slopes: [f64; 3], g: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| slopes[i] * g[(i + 1) % 3] * g[(i + 2) % 3])
}

/// The rotation vector of axis 3 for a displacement, without its third component: δν = \[ψ\]× ν − ν \[ψ\]×.
fn tilt(displacement: &Displacement, slopes: [f64; 3], rate: f64) -> [f64; 2] {
    [(1, 0), (0, 1)].map(|(moved, axis)| -displacement.rates[moved][2] / (slopes[axis] * rate))
}

/// δS g for the rotation vector of axis 3.
fn tilted([p, q]: [f64; 2], g: [f64; 3]) -> [f64; 3] {
    [2.0 * q * g[2], -2.0 * p * g[2], 2.0 * (q * g[0] - p * g[1])]
}

impl LocalExpansion {
    /// The expansion about a point.
    fn new(point: &Point, slopes: [f64; 3], rate: f64, displacements: &[Displacement]) -> Self {
        let direction = direction(point.direction, slopes);
        let products = ELEMENTS.map(|(i, j)| product(&direction[i], &direction[j]));
        let mut step = Self {
            direction,
            changes: [[[0.0; TERMS]; 3]; DISPLACEMENTS],
            integrals: std::array::from_fn(|index| integral(point.integrals[index], &products[index])),
        };
        for (index, displacement) in displacements.iter().enumerate() {
            let force = force(displacement, &products, rate);
            step.changes[index] = change(point.changes[index], slopes, &direction, &force);
        }
        step
    }

    fn at(&self, x: f64) -> Point {
        let sum = |terms: &Polynomial| terms.iter().rev().fold(0.0_f64, |sum, term| sum.mul_add(x, *term));
        Point {
            direction: [0, 1, 2].map(|i| sum(&self.direction[i])),
            changes: std::array::from_fn(|index| [0, 1, 2].map(|i| sum(&self.changes[index][i]))),
            integrals: std::array::from_fn(|index| sum(&self.integrals[index])),
        }
    }
}

/// The invariants of a motion and of its displacements.
struct DisplacedInvariants {
    /// d1 and d3 over the rate of x.
    slopes: [f64; 2],
    rate: f64,
    /// d1 g3² − d3 g1² over the rate of x.
    energy: f64,
    /// Half of its change, with the change of d, and g·δg.
    changes: [[f64; 2]; DISPLACEMENTS],
}

impl DisplacedInvariants {
    fn new(writer: &Writer<'_>, [first, _, third]: [f64; 3], rate: f64) -> Self {
        let g = writer.setting.direction;
        let energy = first * writer.polhode.invariants.cosine_squares[0].to_f64();
        let mut invariants = Self { slopes: [first, third], rate, energy, changes: [[0.0; 2]; DISPLACEMENTS] };
        invariants.changes = writer.displacements.map(|displacement| {
            let along = (0..3).map(|i| g[i] * displacement.step[i]).sum();
            [invariants.change(&displacement, g, displacement.step), along]
        });
        invariants
    }

    /// (ν1 − ν2) g1 δg1 + (ν3 − ν2) g3 δg3 + ½ g·δν g − ½ δν22, over the rate of x. Terms with g2² are absent: they would cancel next to the middle axis.
    fn change(&self, displacement: &Displacement, g: [f64; 3], change: [f64; 3]) -> f64 {
        let [first, third] = self.slopes;
        let middle = displacement.rates[1][1];
        let [p11, _, p33, p12, p13, p23] = products(g);
        let nu = &displacement.rates;
        let squares = 0.5 * ((nu[0][0] - middle) * p11 + (nu[2][2] - middle) * p33);
        let form = squares + nu[0][1] * p12 + nu[0][2] * p13 + nu[1][2] * p23;
        first * g[2] * change[2] - third * g[0] * change[0] + form / self.rate
    }

    /// Moves a point next to the middle axis onto the invariants. g1 and g3 change by equal and opposite factors, which changes d1 g3² − d3 g1² most.
    fn restore(&self, point: &mut Point, displacements: &[Displacement]) {
        let [x, y, z] = &mut point.direction;
        if *y * *y <= NEAR_THE_MIDDLE {
            return;
        }
        let [first, third] = self.slopes;
        let size = |x: f64, z: f64| first.abs() * z * z + third.abs() * x * x;
        let factor = 0.5 * (self.energy - (first * *z * *z - third * *x * *x)) / size(*x, *z);
        let factor = factor * first.signum();
        (*x, *z) = (*x - *x * factor, *z + *z * factor);
        *y = (1.0 - *x * *x - *z * *z).sqrt().copysign(*y);
        let g = point.direction;
        for (index, displacement) in displacements.iter().enumerate() {
            let [energy, along] = self.changes[index];
            let change = &mut point.changes[index];
            let factor = (energy - self.change(displacement, g, *change)) / size(g[0], g[2]) * first.signum();
            change[0] -= factor * g[0];
            change[2] += factor * g[2];
            change[1] = (along - g[0] * change[0] - g[2] * change[2]) / g[1];
        }
    }
}

/// g in powers of x, from dg1/dx = d1 g2 g3 and so on.
fn direction(start: [f64; 3], slopes: [f64; 3]) -> [Polynomial; 3] {
    let mut terms = [[0.0; TERMS]; 3];
    for (series, first) in terms.iter_mut().zip(start) {
        series[0] = first;
    }
    for n in 0..TERMS - 1 {
        for i in 0..3 {
            let (one, other) = ((i + 1) % 3, (i + 2) % 3);
            let sum: f64 = (0..=n).map(|k| terms[one][k] * terms[other][n - k]).sum();
            terms[i][n + 1] = slopes[i] * sum / (n + 1) as f64;
        }
    }
    terms
}

/// δg in powers of x, from dδg1/dx = d1 (δg2 g3 + g2 δg3) + f1 and so on.
fn change(start: [f64; 3], slopes: [f64; 3], g: &[Polynomial; 3], force: &[Polynomial; 3]) -> [Polynomial; 3] {
    let mut terms = [[0.0; TERMS]; 3];
    for (series, first) in terms.iter_mut().zip(start) {
        series[0] = first;
    }
    for n in 0..TERMS - 1 {
        for i in 0..3 {
            let (one, other) = ((i + 1) % 3, (i + 2) % 3);
            let sum: f64 = (0..=n).map(|k| terms[one][k] * g[other][n - k] + g[one][n - k] * terms[other][k]).sum();
            terms[i][n + 1] = (slopes[i] * sum + force[i][n]) / (n + 1) as f64;
        }
    }
    terms
}

/// g × δν g in powers of x, from the products of the components of g.
fn force(displacement: &Displacement, products: &[Polynomial; 6], rate: f64) -> [Polynomial; 3] {
    let nu = &displacement.rates;
    let at = |i: usize, j: usize| match (i.min(j), i.max(j)) {
        (0, 1) => &products[3],
        (0, 2) => &products[4],
        (1, 2) => &products[5],
        (i, _) => &products[i],
    };
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        std::array::from_fn(|n| {
            let beside = nu[i][k] * at(i, j)[n] - nu[i][j] * at(i, k)[n] + nu[j][k] * (at(j, j)[n] - at(k, k)[n]);
            (beside + (nu[k][k] - nu[j][j]) * at(j, k)[n]) / rate
        })
    })
}

fn product(one: &Polynomial, other: &Polynomial) -> Polynomial {
    std::array::from_fn(|n| (0..=n).map(|k| one[k] * other[n - k]).sum())
}

fn integral(start: f64, terms: &Polynomial) -> Polynomial {
    std::array::from_fn(|n| if n == 0 { start } else { terms[n - 1] / n as f64 })
}
