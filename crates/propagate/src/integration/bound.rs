//! The error bound of an integration, from the separation of displaced states.
//!
//! The state at the epoch is displaced in four directions by the size of all errors of the steps together: the root of the sum of squares of the rounding
//! errors, plus the sum of the truncation errors. Every step adds a displacement of the size of its own errors, because a later displacement may grow more. The
//! constants of the equations (the ratios of the moments and the strength of each torque) are displaced by their rounding errors, which are the same in every
//! step. The displaced states separate from the motion as errors do; the bound is a safety factor times their largest distance so far. This covers phases,
//! whose errors grow linearly with time, resonances, and chaotic motion, where errors grow exponentially. The factor is 2 for linear growth. For faster growth
//! it rises to 4, because the displacement may lie across the direction that grows. Of 4,050 random scenes the smallest ratio of bound and error is 4.1 above the floor
//! (`benches/rivals/integration.py --scenes 150 --seed 5`, `--seed 15`, and `--seed 6 --tolerance 1e-6`); of twenty librations over 1,000 orbits, whose errors are
//! those of rounding alone, it is 2.9 at tolerances of 1e-8 and 1e-16, against heyoka in 80-bit reals.
//!
//! First the displacements are enlarged to about 1e-3 rad at the end, and the distance is scaled back. It is then the largest distance between two of the four
//! states, which share the truncation errors of their steps: low orders are enough. At each comparison their mean is moved to the motion. Where they go far away,
//! they are brought nearer to each other, in the same direction, and the scale changes, as for Lyapunov exponents. The four are integrated
//! at once, in lanes. If an enlarged displacement grows beyond 0.1 rad, the displacements themselves are integrated, with shorter steps, and compared with the motion.
//!
//! The interpolation error of tables is measured with two more integrations, by the neighbouring polynomials ([`ReinterpolatedSteps`]).

use std::f64::consts::PI;
use std::slice::Chunks;
use std::sync::atomic::AtomicBool;

use super::expansion::{Equations, Start, Workspace};
use super::integrator::{Precision, Runner, Step, next_end};
use super::series::{Row, norm};
use super::step_errors::PATTERNS;
use crate::error::Error;
use crate::simd::halt::going;
use crate::simd::instruction_set::{InstructionSet, Task};

/// Least and largest safety factor: the bound is the largest distance of the displaced states times a number in this interval.
pub(super) const SAFETY: [f64; 2] = [2.0, 4.0];
/// The most times at which the motion and the displaced states are compared.
const COMPARISONS: usize = 256;
/// The fewest steps of the motion between two comparisons.
const BETWEEN: usize = 3;
/// Relative rounding error of the integrals of the free motion, computed from rounded rates.
const DRIFT: f64 = 1e-15;
/// Length of the steps of the displaced state, relative to those of the motion.
const SHORTER: f64 = 0.9;
/// Length of the steps of an enlarged displacement, relative to those of the motion. With 1.15 an integration takes 2 to 27 % more time, and has the
/// same bounds to a quarter.
const LONGER: f64 = 1.5;
/// A distance from which on the error bound is half a turn \[rad\].
const LOST: f64 = 0.5;
/// Rounding errors of the evaluation \[rad\].
pub(super) const FLOOR: f64 = 1e-14;
/// Relative rounding errors of the state.
pub(super) const INPUT: f64 = 1.2e-16;
/// Relative rounding errors of the ratios of the moments and of each torque, the same in every step.
const CONSTANTS: [f64; 2] = [2.4e-16, 4.8e-16];

/// Displacements of the rates, with the sign of each. Where nearby states separate in a plane of two axes, beside the middle axis, one direction in it does
/// not grow. In no plane do all four displacements lie near one line. With the first two alone the distance of one scene in some hundred was too small by a
/// factor of ten, because the displacements of the steps happened to cancel the growing part of both.
const WEIGHTS: [Row; PATTERNS] =
    [[0.8, 1.0, 0.9, 0.0], [1.0, -0.4, 0.2, 0.0], [-0.3, 0.9, -1.0, 0.0], [0.5, 0.3, -0.8, 0.0]];
/// Displacements of the attitude of states that are compared with the motion: all have the same.
const TURN: [Row; PATTERNS] = [[0.7, -1.0, 0.8, 0.0]; PATTERNS];
/// Displacements of states that are compared with each other: the corners of a tetrahedron, in another order for the attitude. Their six differences have length 1, and
/// lie on four lines in the plane of each two axes.
const CORNERS: [Row; PATTERNS] =
    [[PART, PART, PART, 0.0], [PART, -PART, -PART, 0.0], [-PART, PART, -PART, 0.0], [-PART, -PART, PART, 0.0]];
const PART: f64 = 0.5 * std::f64::consts::FRAC_1_SQRT_2;
const TURNED_CORNERS: [Row; PATTERNS] = [CORNERS[1], CORNERS[2], CORNERS[3], CORNERS[0]];
/// Random displacements of a step by its rounding errors: over √2, because two states are compared, and over √LONGER, because each step is LONGER times as long.
const NOISE: f64 = 0.577_350_269_189_625_8;
/// Where the signs of the displacements of each step begin.
const SEED: u64 = 0x9e37_79b9_7f4a_7c15;
/// The lanes of the displaced states.
const LANES: usize = 4 * PATTERNS;

/// Distance at the end of linear growth, of an enlarged displacement \[rad\].
const ENLARGED: f64 = 1e-3;
/// An enlarged displacement larger than this does not grow linearly, and is not used \[rad\].
const UNSCALED: f64 = 0.1;
/// A displacement larger than `FAR` \[rad\] is multiplied by `SMALLER`.
const FAR: f64 = 0.01;
const SMALLER: f64 = 0.1;

/// The error bound at some times from the epoch, which does not decrease.
pub(super) type Profile = Vec<(f64, f64)>;

/// The steps of a motion in one direction, and the settings by which their error is measured.
#[derive(Clone, Copy)]
pub(super) struct MeasuredSteps<'a> {
    pub(super) equations: &'a Equations<4>,
    pub(super) precision: Precision,
    pub(super) steps: &'a [Step],
    /// Of attitude \[rad\] and rates.
    pub(super) errors: [f64; 2],
    /// The displacements of a step relative to its rounding errors.
    pub(super) noise: [f64; 2],
    pub(super) backward: bool,
    /// Whether the displacements are enlarged.
    pub(super) enlarged: bool,
    pub(super) stop: &'a AtomicBool,
}

impl MeasuredSteps<'_> {
    /// Of attitude \[rad\] and rates.
    fn displacement(&self) -> [f64; 2] {
        let [angle, rate] = self.errors;
        let [first, second, third] = self.steps[0].rates;
        [angle + INPUT, rate + INPUT * first.abs().max(second.abs()).max(third.abs())]
    }

    /// The error of the attitude by the norm of the quaternion and, without a torque, by the integrals of the free motion \[rad\].
    fn drift(&self, step: &Step) -> f64 {
        let by_norm = 2.0 * (norm(&step.attitude) - 1.0).abs();
        if !self.equations.is_free() {
            return by_norm;
        }
        // Rates that are wrong by a relative ε change the integrals by 2ε and the angle by ε times the phase.
        let first = &self.steps[0];
        let fastest = norm(&first.start(self.backward).rates);
        let drift = self.equations.drift(&first.rates, &step.rates) - DRIFT;
        by_norm.max(0.5 * drift * fastest * step.time.0.abs())
    }

    /// The size of the error after a time, if it grows linearly \[rad\].
    fn linear(&self, time: f64) -> f64 {
        let [angle, rate] = self.displacement();
        angle + rate * time.abs()
    }

    /// The displacements of the attitudes and of the rates and constants.
    fn patterns(&self) -> [&'static [Row; PATTERNS]; 2] {
        if self.enlarged { [&TURNED_CORNERS, &CORNERS] } else { [&TURN, &WEIGHTS] }
    }

    /// The displaced states at the epoch, their displacements enlarged.
    fn displaced(&self, scale: f64) -> Runner<LANES> {
        let first = self.steps[0].start(self.backward);
        let states = self.displaced_states(&first, scale);
        let lanes = |of: fn(&[Row; 2]) -> &Row| std::array::from_fn(|lane| of(&states[lane / 4])[lane % 4]);
        Runner::new(lanes(|[attitude, _]| attitude), lanes(|[_, rates]| rates), self.backward)
    }

    /// Attitude and rates of each displaced state at the epoch.
    fn displaced_states(&self, first: &Start<4>, scale: f64) -> [[Row; 2]; PATTERNS] {
        let [angle, rate] = self.displacement().map(|displacement| scale * displacement);
        let [turns, weights] = self.patterns();
        let [x, y, z, w] = first.attitude;
        std::array::from_fn(|state| {
            let turn = turns[state].map(|part| 0.5 * angle * part);
            let attitude = [
                x + w * turn[0] + y * turn[2] - z * turn[1],
                y + w * turn[1] + z * turn[0] - x * turn[2],
                z + w * turn[2] + x * turn[1] - y * turn[0],
                w - x * turn[0] - y * turn[1] - z * turn[2],
            ];
            let own = first.rates;
            let rates =
                std::array::from_fn(|lane| own[lane] + rate * weights[state][lane] * 1.0_f64.copysign(own[lane]));
            [attitude, rates]
        })
    }

    /// The distance of the displaced states \[rad\].
    fn distance(&self, attitudes: &[Row; PATTERNS], target: &Step) -> f64 {
        if !self.enlarged {
            return attitudes.iter().map(|displaced| angle(&target.attitude, displaced)).fold(0.0, worse);
        }
        let apart = |one: &Row, other: &Row| {
            2.0 * norm(&[0, 1, 2, 3].map(|lane| one[lane] - other[lane])) // a small angle
        };
        let pairs = (1..PATTERNS).flat_map(|i| (0..i).map(move |j| (i, j)));
        pairs.map(|(i, j)| apart(&attitudes[i], &attitudes[j])).fold(0.0, worse)
    }
}

/// The comparisons of the displaced states of a motion, one after another.
struct Comparisons<'a> {
    steps: MeasuredSteps<'a>,
    groups: Chunks<'a, Step>,
    group: &'a [Step],
    /// How many times the displacements are enlarged.
    scale: f64,
    bound: f64,
    profile: Profile,
    random: u64,
}

impl<'a> Comparisons<'a> {
    fn new(steps: MeasuredSteps<'a>) -> Self {
        let last = steps.steps[steps.steps.len() - 1].time.0;
        let scale = if steps.enlarged { ENLARGED / steps.linear(last) } else { 1.0 };
        let mut groups = steps.steps[1..].chunks(stride(steps.steps));
        let group = groups.next().unwrap_or_default();
        Self { steps, groups, group, scale, bound: 0.0, profile: Profile::new(), random: SEED }
    }

    /// The precision of the displaced states.
    fn precision(&self) -> Precision {
        self.steps.precision.shorter(if self.steps.enlarged { LONGER } else { SHORTER })
    }

    /// The step of the motion at the next comparison; none after the last.
    fn target(&self) -> Option<&'a Step> {
        self.group.last()
    }

    /// Displacements of the ratios of the moments and of each torque.
    fn constants(&self) -> [f64; 2] {
        CONSTANTS.map(|error| self.scale * error)
    }

    /// Displacements of a step relative to its rounding errors.
    fn noise(&self) -> [f64; 2] {
        self.steps.noise.map(|noise| noise * self.scale * if self.steps.enlarged { NOISE } else { 1.0 })
    }

    /// Whether the states have not been lost.
    fn holds(&self) -> bool {
        self.bound < PI
    }

    /// The displaced states are not finite.
    fn lose(&mut self) {
        self.bound = PI;
    }

    /// Compares the states at the target. Returns the factor by which their distances become smaller, or `None` if an enlarged displacement grew beyond
    /// [`UNSCALED`].
    fn compare(&mut self, attitudes: &[Row; PATTERNS]) -> Option<f64> {
        let Some(target) = self.target() else { return Some(1.0) };
        let Self { steps, scale, .. } = self;
        self.bound = self.group.iter().map(|step| steps.drift(step)).fold(self.bound, f64::max);
        let distance = steps.distance(attitudes, target);
        let grown = distance / *scale;
        let safety = (SAFETY[0] * grown / steps.linear(target.time.0)).clamp(SAFETY[0], SAFETY[1]);
        self.bound = if grown < LOST { self.bound.max(safety * grown + FLOOR) } else { PI };
        self.profile.push((target.time.0, self.bound.min(PI)));
        self.group = self.groups.next().unwrap_or_default();
        if steps.enlarged && (distance.is_nan() || distance >= UNSCALED) {
            return None;
        }
        let factor = if steps.enlarged && distance >= FAR { SMALLER } else { 1.0 };
        self.scale *= factor;
        Some(factor)
    }

    fn profile(self) -> Profile {
        self.profile
    }
}

impl Task for MeasuredSteps<'_> {
    /// `None` if an enlarged displacement grows beyond [`UNSCALED`].
    type Output = Result<Option<Profile>, Error>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let Self { backward, enlarged, stop, .. } = self;
        let mut comparisons = Comparisons::new(self);
        let constants = |constants: [f64; 2]| self.equations.displaced(constants, self.patterns()[1]);
        let mut equations = constants(comparisons.constants());
        let mut runner = self.displaced(comparisons.scale);
        let precision = comparisons.precision();
        let mut workspace = Workspace::new(&equations);
        while let Some(target) = comparisons.target() {
            while comparisons.holds() && runner.time != target.time {
                going(stop).map_err(|_| Error::Stopped)?;
                let end = next_end(&equations, runner.time.0, target.time, backward);
                if runner.advance(simd, (&equations, precision), end, &mut workspace).is_nan() {
                    comparisons.lose();
                }
                runner.disturb(comparisons.noise(), &mut comparisons.random);
            }
            let Some(factor) = comparisons.compare(&runner.attitudes()) else { return Ok(None) };
            if enlarged && comparisons.holds() {
                if factor < 1.0 {
                    equations = constants(comparisons.constants());
                }
                runner.move_to(&target.start(backward), factor);
            }
        }
        Ok(Some(comparisons.profile()))
    }
}

/// The number of steps from one comparison to the next.
fn stride(steps: &[Step]) -> usize {
    steps.len().div_ceil(COMPARISONS).max(BETWEEN)
}

/// The steps of a motion in one direction, and equations with other interpolations of its tables.
#[derive(Clone, Copy)]
pub(super) struct ReinterpolatedSteps<'a> {
    pub(super) equations: &'a Equations<4>,
    pub(super) precision: Precision,
    pub(super) steps: &'a [Step],
    pub(super) backward: bool,
    pub(super) stop: &'a AtomicBool,
}

impl Task for ReinterpolatedSteps<'_> {
    /// The largest angle so far between the two motions, at the times of the error bound.
    type Output = Result<Profile, Error>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let Self { equations, precision, steps, backward, stop } = self;
        let first = steps[0].start(backward);
        let mut runner = Runner::new(first.attitude, first.rates, backward);
        let mut workspace = Workspace::new(equations);
        let (mut profile, mut largest) = (Profile::new(), 0.0_f64);
        for group in steps[1..].chunks(stride(steps)) {
            let Some(target) = group.last() else { continue };
            while largest < LOST && runner.time != target.time {
                going(stop).map_err(|_| Error::Stopped)?;
                let end = next_end(equations, runner.time.0, target.time, backward);
                if runner.advance(simd, (equations, precision), end, &mut workspace).is_nan() {
                    largest = PI;
                }
            }
            if largest < LOST {
                largest = worse(largest, angle(&target.attitude, &runner.step().attitude));
            }
            profile.push((target.time.0, largest));
        }
        Ok(profile)
    }
}

/// Adds a multiple of the largest departure of two other interpolations to an error bound. Beyond [`LOST`] the bound is half a turn.
pub(super) fn with_interpolation(bound: &mut Profile, departures: &[Profile; 2], of_interpolation: f64) {
    let [one, other] = departures;
    for ((entry, one), other) in bound.iter_mut().zip(one).zip(other) {
        let departure = of_interpolation * worse(one.1, other.1);
        entry.1 = if departure < LOST { (entry.1 + departure).min(PI) } else { PI };
    }
}

/// The larger of two distances; not a number where one is none.
fn worse(one: f64, other: f64) -> f64 {
    if one.is_nan() || one > other { one } else { other }
}

/// The angle between two attitudes.
fn angle(one: &Row, other: &Row) -> f64 {
    let [x, y, z, w] = *one;
    let [a, b, c, d] = *other;
    let vector = [w * a - d * x - (y * c - z * b), w * b - d * y - (z * a - x * c), w * c - d * z - (x * b - y * a)];
    let scalar = x * a + y * b + z * c + w * d;
    2.0 * norm(&[vector[0], vector[1], vector[2], 0.0]).atan2(scalar.abs())
}
