//! Steps in one direction from the epoch, kept with the state at the start of each.
//!
//! Sums over steps are compensated (Kahan), so that their rounding errors are those of the increments.

use std::sync::atomic::AtomicBool;

use andoyer_double::two_sum;

use super::expansion::{Equations, Start, Workspace};
use super::growth::StepGrowth;
use super::series::{Coefficients, MAX, Row, StateLanes, four, largest, norm};
use super::step_errors::{PATTERNS, ROUNDING, RandomSigns, StepErrors, StepSizes, moved};
use crate::error::Error;
use crate::simd::halt::going;
use crate::simd::instruction_set::{InstructionSet, Task};

/// The most steps that are kept in one direction: 600 MB.
pub(crate) const MOST_STEPS: usize = 1 << 23;
/// Steps between two checks of the stop flag. They take less than a millisecond.
pub(super) const AT_ONCE: usize = 64;
/// An integration is refused if its number of steps, extrapolated from the steps so far, exceeds the largest one by this factor. After `TYPICAL` steps the factor
/// is 1.
const HOPELESS: f64 = 4.0;
const TYPICAL: usize = MOST_STEPS / 64;
/// A body that needs more steps for the rest of the span at its present rotation has been spun up.
const MOST_BY_ROTATION: f64 = HOPELESS * MOST_STEPS as f64;
/// No step is longer than this rotation \[rad\]: at tolerances up to 1 rad the mean over 400 motions was 2.4 at most.
const LONGEST_STEP: f64 = 4.0;
/// Steps during which a body must rotate too fast for the rest of the span before it is refused: within a passage of a pericentre it may do so for some hundreds.
const SUSTAINED: usize = 1 << 14;
/// A step is at most this part of the radius of convergence of each torque. Far from a pericentre the torque is below the rounding errors of the coefficients of
/// the motion: steps by these alone would pass over the pericentre.
const NEAREST: f64 = 0.5;

/// The start of a step: 72 bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// Time from the epoch, in double-double.
    pub(super) time: (f64, f64),
    pub(super) attitude: Row,
    pub(super) rates: [f64; 3],
}

impl Step {
    pub(super) fn start(&self, backward: bool) -> Start<4> {
        let [first, second, third] = self.rates;
        Start { time: self.time, backward, attitude: self.attitude, rates: [first, second, third, 0.0] }
    }
}

/// The most rows of coefficients that are kept in one direction: 59 MB. Longer integrations keep no row, and a step is expanded again when a time falls into
/// it.
const MOST_COEFFICIENTS: usize = 1 << 20;

/// The steps in one direction.
#[derive(Clone, Debug, Default)]
pub(super) struct Side {
    pub(super) steps: Vec<Step>,
    /// order + 1 for each step, or none.
    pub(super) coefficients: Vec<Coefficients>,
}

impl Side {
    /// Keeps the starts of the steps alone. They are copied first: where they grew beside the coefficients they would leave holes in the memory of many motions.
    pub(super) fn compact(&mut self) {
        self.steps = self.steps.clone();
        self.coefficients = Vec::new();
    }

    /// Whether it lacks coefficients of an order that an integration keeps.
    pub(super) fn is_compact(&self, order: usize) -> bool {
        let rows = (self.steps.len() - 1) * (order + 1);
        self.coefficients.is_empty() && rows > 0 && rows <= MOST_COEFFICIENTS
    }

    /// Without the steps after a time from the epoch, with the coefficients of an order.
    pub(super) fn end_at(&mut self, time: f64, order: usize) {
        let steps = self.steps.partition_point(|step| step.time.0.abs() <= time.abs()).max(1);
        self.steps.truncate(steps);
        self.coefficients.truncate((steps - 1) * (order + 1));
    }
}

/// The order and the lengths of steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Precision {
    pub(super) order: usize,
    /// Logarithm of the length of a step relative to the radius of convergence.
    shrinkage: f64,
}

impl Precision {
    /// For a relative error of a step (Jorba and Zou, eq. 3-7).
    pub(super) fn of(error: f64) -> Self {
        let order = (-0.5 * error.ln()).ceil() + 1.0;
        Self::of_order((order as usize).clamp(4, MAX))
    }

    fn of_order(order: usize) -> Self {
        Self { order, shrinkage: -2.0 - 0.7 / (order - 1) as f64 }
    }

    /// The length of a step, from the sizes of the coefficients of the last two orders, relative to the first, and the radius of convergence of the torques.
    #[inline(always)]
    pub(super) fn length(self, sizes: [f64; 2], radius: f64) -> f64 {
        let [before, last] =
            [(sizes[0], self.order - 1), (sizes[1], self.order)].map(|(size, k)| -size.ln() / k as f64);
        (before.min(last) + self.shrinkage).exp().min(NEAREST * radius)
    }

    /// With steps of this length relative to those before.
    pub(super) fn shorter(self, factor: f64) -> Self {
        Self { shrinkage: self.shrinkage + factor.ln(), ..self }
    }
}

/// The state of an integration, W = 4, or several states with the same steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Runner<const W: usize> {
    pub(super) time: (f64, f64),
    backward: bool,
    attitude: StateLanes<W>,
    attitude_rest: StateLanes<W>,
    rates: StateLanes<W>,
    rates_rest: StateLanes<W>,
    pub(super) errors: StepErrors,
}

impl<const W: usize> Runner<W> {
    pub(super) fn new(attitude: StateLanes<W>, rates: StateLanes<W>, backward: bool) -> Self {
        let none = [0.0; W];
        Self {
            time: (0.0, 0.0),
            backward,
            attitude,
            attitude_rest: none,
            rates,
            rates_rest: none,
            errors: StepErrors::default(),
        }
    }

    /// The attitude of each state.
    pub(super) fn attitudes<const STATES: usize>(&self) -> [Row; STATES] {
        std::array::from_fn(|state| four(&self.attitude, 4 * state))
    }

    /// Makes one step, to the target at most. Returns the length that the step has without a target, or NaN if the state is not finite.
    #[inline(always)]
    pub(super) fn advance<S: InstructionSet>(
        &mut self,
        simd: S,
        (equations, precision): (&Equations<W>, Precision),
        target: (f64, f64),
        workspace: &mut Workspace<W>,
    ) -> f64 {
        let whole = self.expand(simd, (equations, precision), workspace);
        if self.go(whole, precision.order, target, (equations, workspace)) { whole } else { f64::NAN }
    }

    /// Expands the motion. Returns the length of the step without a target.
    #[inline(always)]
    pub(super) fn expand<S: InstructionSet>(
        &self,
        simd: S,
        (equations, precision): (&Equations<W>, Precision),
        workspace: &mut Workspace<W>,
    ) -> f64 {
        let order = precision.order;
        let start = Start { time: self.time, backward: self.backward, attitude: self.attitude, rates: self.rates };
        workspace.expand(simd, equations, &start, order);
        let scale = largest(&self.rates).max(equations.scale);
        let sizes =
            [order - 1, order].map(|k| (largest(&workspace.rates[k]) / scale).max(largest(&workspace.attitude[k])));
        precision.length(sizes, workspace.radius)
    }

    /// Goes on by a length, to the target at most. Returns whether the state is finite.
    #[inline(always)]
    pub(super) fn go(
        &mut self,
        whole: f64,
        order: usize,
        target: (f64, f64),
        (equations, workspace): (&Equations<W>, &Workspace<W>),
    ) -> bool {
        let (length, end) = to_target(self.time, target, whole);
        self.add(length, order, workspace);
        self.account(length.abs(), order, (equations, workspace));
        self.time = end.unwrap_or_else(|| sum(self.time, length));
        let state: f64 = self.attitude.iter().chain(&self.rates).sum();
        state.is_finite()
    }

    #[inline(always)]
    fn add(&mut self, length: f64, order: usize, workspace: &Workspace<W>) {
        let (mut attitude, mut rates) = (workspace.attitude[order], workspace.rates[order]);
        for k in (1..order).rev() {
            for lane in 0..W {
                attitude[lane] = attitude[lane].mul_add(length, workspace.attitude[k][lane]);
                rates[lane] = rates[lane].mul_add(length, workspace.rates[k][lane]);
            }
        }
        for lane in 0..W {
            compensated(&mut self.attitude[lane], &mut self.attitude_rest[lane], attitude[lane] * length);
            compensated(&mut self.rates[lane], &mut self.rates_rest[lane], rates[lane] * length);
        }
    }

    /// Adds the errors that the step may have made.
    #[inline(always)]
    fn account(&mut self, length: f64, order: usize, (equations, workspace): (&Equations<W>, &Workspace<W>)) {
        let sizes = workspace.sizes(length);
        // Each axis has its own factor: the product of the largest of both can be none of them.
        let parts = |lane: usize| ROUNDING[0] * sizes[lane].abs() + ROUNDING[1] * workspace.gyration[lane].abs();
        let by_rates = (0..W).fold(0.0, |most: f64, lane| most.max(equations.factors[lane].abs() * parts(lane)));
        let rate = by_rates + ROUNDING[0] * largest(&workspace.further);
        let sizes = StepSizes {
            omitted: [largest(&workspace.attitude[order]), largest(&workspace.rates[order])],
            rounding: [ROUNDING[1] * largest(&self.rates), rate],
            radius: workspace.radius,
        };
        self.errors.add(length, order, sizes);
    }

    /// Adds errors of so many times the size of the rounding errors of the last step, with signs that look like random ones.
    #[inline(always)]
    pub(super) fn disturb(&mut self, noise: [f64; 2], random: &mut u64) {
        let noise = [noise[0] * self.errors.last[0], noise[1] * self.errors.last[1]];
        let signs = RandomSigns::next(random);
        for lane in 0..W {
            let [angle, rate] = signs.times(noise, lane);
            self.attitude[lane] += angle;
            self.rates[lane] += rate;
        }
    }
}

impl Runner<{ 4 * PATTERNS }> {
    /// Moves the mean of the states to one state, and multiplies their distances from the mean by a factor.
    pub(super) fn move_to(&mut self, to: &Start<4>, factor: f64) {
        let states: [[Row; 2]; PATTERNS] =
            std::array::from_fn(|state| [four(&self.attitude, 4 * state), four(&self.rates, 4 * state)]);
        for (state, [attitude, rates]) in moved(&states, [&to.attitude, &to.rates], factor).iter().enumerate() {
            self.attitude[4 * state..4 * state + 4].copy_from_slice(attitude);
            self.rates[4 * state..4 * state + 4].copy_from_slice(rates);
        }
    }
}

impl Runner<4> {
    pub(super) fn step(&self) -> Step {
        let [first, second, third, _] = self.rates;
        Step { time: self.time, attitude: self.attitude, rates: [first, second, third] }
    }
}

/// The length of a step that goes to a target at most, and its end if that is the target.
#[inline(always)]
fn to_target(now: (f64, f64), target: (f64, f64), whole: f64) -> (f64, Option<(f64, f64)>) {
    let left = (target.0 - now.0) + (target.1 - now.1);
    if whole >= left.abs() { (left, Some(target)) } else { (whole.copysign(left), None) }
}

/// A time in double-double plus a length.
#[inline(always)]
fn sum((high, low): (f64, f64), length: f64) -> (f64, f64) {
    let (sum, rest) = two_sum(high, length);
    two_sum(sum, rest + low)
}

#[inline(always)]
fn compensated(value: &mut f64, rest: &mut f64, change: f64) {
    let change = change + *rest;
    let sum = *value + change;
    *rest = change - (sum - *value);
    *value = sum;
}

/// An integration as far as it has gone, with every step.
pub(super) struct StepsSoFar {
    pub(super) runner: Runner<4>,
    /// The start of each step.
    steps: Vec<Step>,
    coefficients: Vec<Coefficients>,
    /// Whether there are coefficients of every step.
    kept: bool,
    fast: Option<(f64, usize)>,
    growth: Option<StepGrowth>,
}

impl StepsSoFar {
    pub(super) fn new(runner: Runner<4>, equations: &Equations<4>) -> Self {
        let growth = equations.torques.as_ref().map(|torques| StepGrowth::new(torques.brakes, MOST_STEPS));
        Self { runner, steps: Vec::new(), coefficients: Vec::new(), kept: true, fast: None, growth }
    }

    /// The number of steps of the whole integration, from below.
    pub(super) fn expected(&self, equations: &Equations<4>, target: (f64, f64)) -> f64 {
        let steps = self.steps.len();
        extrapolated(equations, steps, self.runner.time, target).max(steps as f64 + by_rotation(&self.runner, target))
    }

    /// Whether the body rotates too fast for the rest of the span: it is refused if that lasts.
    pub(super) fn is_spun_up(&self, target: (f64, f64)) -> bool {
        by_rotation(&self.runner, target) > MOST_BY_ROTATION
    }

    /// What a function reads of the steps so far, with the state after the last one.
    pub(super) fn with_last<T>(&mut self, read: impl FnOnce(&[Step]) -> T) -> T {
        self.steps.push(self.runner.step());
        let found = read(&self.steps);
        self.steps.pop();
        found
    }

    /// The steps, and the errors that they leave.
    pub(super) fn ended(mut self) -> (Side, StepErrors) {
        self.steps.push(self.runner.step());
        (Side { steps: self.steps, coefficients: self.coefficients }, self.runner.errors)
    }
}

/// An integration to a time that keeps every step.
pub(super) struct KeptSteps<'a> {
    pub(super) equations: &'a Equations<4>,
    pub(super) precision: Precision,
    pub(super) progress: StepsSoFar,
    pub(super) target: (f64, f64),
    /// It pauses where it has so many steps.
    pub(super) pause: usize,
    pub(super) stop: &'a AtomicBool,
}

impl Task for KeptSteps<'_> {
    type Output = Result<StepsSoFar, Error>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let Self { equations, precision, progress, target, pause, stop } = self;
        let StepsSoFar { mut runner, mut steps, mut coefficients, mut kept, mut fast, mut growth } = progress;
        let mut workspace = Workspace::new(equations);
        while runner.time != target && steps.len() < pause {
            if steps.len() % AT_ONCE == 0 {
                going(stop).map_err(|_| Error::Stopped)?;
                affordable(equations, steps.len(), runner.time, target)?;
                fast = spun_up(&runner, target, (fast, steps.len()))?;
                if let Some(growth) = &mut growth {
                    growth.check(steps.len(), runner.time.0, target.0)?;
                }
            }
            let end = next_end(equations, runner.time.0, target, runner.backward);
            steps.push(runner.step());
            let length = runner.advance(simd, (equations, precision), end, &mut workspace);
            // A table whose polynomial meets the origin leaves no number.
            if length.is_nan() {
                return Err(Error::TooManySteps { steps: f64::INFINITY, bound: MOST_STEPS, reason: String::new() });
            }
            kept &= coefficients.len() + precision.order < MOST_COEFFICIENTS;
            if kept {
                coefficients.extend(workspace.coefficients(precision.order));
            } else {
                coefficients = Vec::new();
            }
        }
        Ok(StepsSoFar { runner, steps, coefficients, kept, fast, growth })
    }
}

/// The end of the next step at most: the target, or the nearest time at which the series of a body ends.
pub(super) fn next_end<const W: usize>(
    equations: &Equations<W>,
    time: f64,
    target: (f64, f64),
    backward: bool,
) -> (f64, f64) {
    let knots = equations.paths().filter_map(|body| body.next_knot(time, !backward));
    let nearest = knots.min_by(|one, other| one.0.abs().total_cmp(&other.0.abs()));
    nearest.filter(|knot| knot.0.abs() < target.0.abs()).unwrap_or(target)
}

/// The number of steps of a whole integration. Some of the steps are due to the rotation, and others to the passage of each body. The number of
/// each kind grows at least by the least of the factors by which they grow.
fn extrapolated(equations: &Equations<4>, steps: usize, now: (f64, f64), target: (f64, f64)) -> f64 {
    // A circle has 0/0 here, which is no minimum.
    let growth = equations.paths().map(|body| body.passed(target) / body.passed(now));
    steps as f64 * growth.fold(target.0 / now.0, f64::min)
}

/// Refuses an integration whose extrapolated number of steps exceeds [`MOST_STEPS`].
pub(super) fn affordable(
    equations: &Equations<4>,
    steps: usize,
    now: (f64, f64),
    target: (f64, f64),
) -> Result<(), Error> {
    let whole = extrapolated(equations, steps, now, target);
    let bound = MOST_STEPS as f64 * if steps < TYPICAL { HOPELESS } else { 1.0 };
    if steps > 0 && whole > bound || steps >= MOST_STEPS {
        return Err(Error::TooManySteps { steps: whole, bound: MOST_STEPS, reason: String::new() });
    }
    Ok(())
}

/// The steps to a target that the present rotation needs at least.
fn by_rotation(runner: &Runner<4>, target: (f64, f64)) -> f64 {
    (target.0 - runner.time.0).abs() * norm(&runner.rates) / LONGEST_STEP
}

/// Refuses an integration where a passage has left the body with a rotation that needs too many steps for the rest of the span. `since` is the time from which on it has been so, with the
/// number of steps then.
fn spun_up(
    runner: &Runner<4>,
    target: (f64, f64),
    (since, steps): (Option<(f64, usize)>, usize),
) -> Result<Option<(f64, usize)>, Error> {
    let needed = by_rotation(runner, target);
    if needed <= MOST_BY_ROTATION {
        return Ok(None);
    }
    let (time, first) = since.unwrap_or((runner.time.0, steps));
    if steps - first >= SUSTAINED {
        return Err(Error::SpunUp { time, rate: norm(&runner.rates), steps: needed, bound: MOST_STEPS });
    }
    Ok(Some((time, first)))
}
