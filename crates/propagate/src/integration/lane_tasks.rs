//! The steps of several motions in lanes, and their displaced states.

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use nalgebra::UnitQuaternion;

use super::bound::{Comparisons, MeasuredSteps, Profile};
use super::conic::Conic;
use super::integrated::{MeasuredMotion, Problem};
use super::integrator::{AT_ONCE, Precision, Side, Step, to_target};
use super::lanes::{LaneMotions, LaneSizes, LaneStart, MOST, within};
use super::path_series::PathSeries;
use super::series::{Row, norm};
use super::step_errors::{PATTERNS, RandomSigns, StepErrors, moved};
use crate::error::Error;
use crate::simd::halt::going;
use crate::simd::instruction_set::{InstructionSet, Task};

/// The most steps of a motion in a lane. Longer ones are integrated alone, where their number is predicted.
const MOST_STEPS_IN_LANES: usize = 1 << 15;
/// The most steps of a side for which there is room from the start: 6 MB.
const MOST_ROOM: f64 = 4096.0;

/// The precision of steps with this relative error. Orders are even, so that fewer differ.
pub(super) fn lane_precision(error: f64) -> Precision {
    Precision::of(error).of_even_order()
}

/// A motion that the lanes serve.
#[derive(Clone, Copy)]
pub(super) struct LaneProblem<'a> {
    pub(super) problem: &'a Problem,
    pub(super) conic: &'a Conic,
    pub(super) axes: UnitQuaternion<f64>,
    pub(super) precision: Precision,
}

/// The steps before and after the epoch with their errors, and the profiles of their error bounds where displaced states in lanes have measured them.
pub(super) type MeasuredSides = ([(Side, StepErrors); 2], [Option<Profile>; 2]);

impl<'a> LaneProblem<'a> {
    pub(super) fn new(problem: &'a Problem) -> Option<Self> {
        let ([PathSeries::Conic(conic)], None) = (&problem.equations.bodies[..], &problem.equations.torques) else {
            return None;
        };
        let axes = conic.fixed_axes()?;
        let precision = lane_precision(problem.first_error());
        (problem.most_steps() < MOST_STEPS_IN_LANES as f64).then_some(Self { problem, conic, axes, precision })
    }

    /// The motion by these steps. Error bounds that are missing are measured.
    pub(super) fn measured(
        &self,
        (sides, profiles): MeasuredSides,
        stop: &AtomicBool,
    ) -> Result<MeasuredMotion, Error> {
        let measured = |side: usize, profile: Option<Profile>| match profile {
            Some(profile) => Ok(profile),
            None => self.problem.measured(&sides[side].0.steps, (self.precision, &sides[side].1), side == 0, stop),
        };
        let [before, after] = profiles;
        let profiles = [measured(0, before)?, measured(1, after)?];
        self.problem.with_bounds((self.precision, self.precision.error()), sides, profiles, stop)
    }

    /// The motion from its epoch.
    fn start(&self) -> LaneStart<'a> {
        let Problem { equations, attitude, rates, .. } = self.problem;
        let attitude = within(&self.axes, *attitude);
        let length = norm(&attitude);
        LaneStart {
            conic: self.conic,
            axes: self.axes,
            attitude: attitude.map(|part| part / length),
            rates: *rates,
            factors: equations.factors,
            strength: 1.0,
            scale: equations.scale,
        }
    }
}

/// The displaced states of one side of a motion.
#[derive(Clone, Copy)]
pub(super) struct MeasuredSide<'a> {
    pub(super) member: usize,
    pub(super) side: usize,
    pub(super) served: LaneProblem<'a>,
    pub(super) steps: MeasuredSteps<'a>,
}

impl MeasuredSide<'_> {
    /// With displacements that are not enlarged.
    pub(super) fn exact(self) -> Self {
        Self { steps: MeasuredSteps { precision: self.served.precision, enlarged: false, ..self.steps }, ..self }
    }
}

/// Steps of several motions before and after their epochs.
pub(super) struct StepsInLanes<'a> {
    /// With the same order.
    pub(super) problems: &'a [LaneProblem<'a>],
    pub(super) stop: &'a AtomicBool,
}

/// A side of a motion in a lane.
struct SideInLane {
    member: usize,
    side: usize,
    target: (f64, f64),
    kept: Side,
    errors: StepErrors,
}

/// The steps of each motion before and after its epoch, with their errors; `None` for a side that is not served.
pub(super) type SidesInLanes = Vec<[Option<(Side, StepErrors)>; 2]>;

impl<'a> StepsInLanes<'a> {
    /// The next side that has steps enters a lane. A side without steps is done.
    fn enter<S: InstructionSet>(
        &self,
        (motions, lane): (&mut LaneMotions<'a, S>, usize),
        queue: &mut impl Iterator<Item = (usize, usize)>,
        done: &mut SidesInLanes,
    ) -> Option<SideInLane> {
        for (member, side) in queue {
            let Problem { attitude, rates, ends, .. } = self.problems[member].problem;
            let [first, second, third, _] = *rates;
            let start = Step { time: (0.0, 0.0), attitude: *attitude, rates: [first, second, third] };
            let (target, errors) = (ends[side], StepErrors::turned());
            let room =
                if target == (0.0, 0.0) { 1.0 } else { self.problems[member].problem.most_steps().min(MOST_ROOM) };
            let mut kept = Side::with_room(room as usize, self.problems[member].precision.order);
            kept.steps.push(start);
            if target != (0.0, 0.0) {
                motions.enter(lane, &self.problems[member].start());
                return Some(SideInLane { member, side, target, kept, errors });
            }
            done[member][side] = Some((kept, errors));
        }
        None
    }
}

impl SideInLane {
    /// The length of a step, of which it adds the errors, and its end if that is the target.
    fn prepare(
        &mut self,
        now: (f64, f64),
        (sizes, lane): (&LaneSizes, usize),
        precision: Precision,
    ) -> (f64, Option<(f64, f64)>) {
        let mine = lane..lane + 1;
        let (length, end) = to_target(now, self.target, sizes.length(mine.clone(), precision));
        self.errors.add(length.abs(), precision.order, sizes.of_step(mine, length.abs()));
        (length, end)
    }

    /// Keeps the end of a step. Returns whether the motion may go on.
    fn keep(&mut self, time: (f64, f64), attitude: Row, [first, second, third, _]: Row) -> bool {
        self.kept.steps.push(Step { time, attitude, rates: [first, second, third] });
        let finite = (attitude.iter().sum::<f64>() + first + second + third).is_finite();
        finite && self.kept.steps.len() < MOST_STEPS_IN_LANES
    }
}

impl Task for StepsInLanes<'_> {
    type Output = SidesInLanes;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> SidesInLanes {
        let Self { problems, stop } = self;
        let mut done: SidesInLanes = problems.iter().map(|_| [None, None]).collect();
        let Some(LaneProblem { precision, .. }) = problems.first().copied().filter(|_| S::FUSED) else { return done };
        let order = precision.order;
        let mut queue = (0..problems.len()).flat_map(|member| [(member, 0), (member, 1)]);
        let mut motions = LaneMotions::new(simd);
        let mut inside: [Option<SideInLane>; MOST] = std::array::from_fn(|_| None);
        let mut count = 0_usize;
        loop {
            for (lane, slot) in inside.iter_mut().enumerate().take(S::F64_LANES) {
                if slot.is_none() {
                    *slot = self.enter((&mut motions, lane), &mut queue, &mut done);
                }
            }
            if inside.iter().all(Option::is_none) || count.is_multiple_of(AT_ONCE) && going(stop).is_err() {
                return done;
            }
            count += 1;
            motions.expand(order);
            let sizes = motions.sizes(order);
            let (mut lengths, mut ends) = ([0.0; MOST], [None; MOST]);
            for (lane, slot) in inside.iter_mut().enumerate() {
                if let Some(side) = slot {
                    (lengths[lane], ends[lane]) = side.prepare(motions.time(lane), (&sizes, lane), precision);
                }
            }
            motions.coefficients(order, |rows| {
                for (lane, slot) in inside.iter_mut().enumerate() {
                    if let Some(side) = slot {
                        side.kept.coefficients.push(rows.map(|row| row[lane]));
                    }
                }
            });
            motions.go(order, &lengths, &ends);
            for (lane, slot) in inside.iter_mut().enumerate() {
                let Some(side) = slot else { continue };
                let [attitude, rates] = motions.state(lane);
                let goes_on = side.keep(motions.time(lane), outside(&problems[side.member].axes, attitude), rates);
                if goes_on && ends[lane].is_none() {
                    continue;
                }
                if goes_on {
                    done[side.member][side.side] = Some((std::mem::take(&mut side.kept).fitted(), side.errors));
                }
                *slot = None;
            }
        }
    }
}

/// An attitude relative to the axes of an orbit in inertial axes.
fn outside(axes: &UnitQuaternion<f64>, attitude: Row) -> Row {
    within(&axes.inverse(), attitude)
}

/// Displaced states of several motions, of each in four lanes.
pub(super) struct MeasuredInLanes<'a> {
    /// With the same order.
    pub(super) sides: &'a [MeasuredSide<'a>],
    pub(super) stop: &'a AtomicBool,
}

/// The displaced states of a motion in its lanes.
struct StatesInLanes<'a> {
    index: usize,
    comparisons: Comparisons<'a>,
    errors: StepErrors,
}

impl<'a> MeasuredInLanes<'a> {
    /// The factors of each displaced state, and those of its torque.
    fn constants(&self, index: usize, comparisons: &Comparisons<'_>) -> [(Row, f64); PATTERNS] {
        let MeasuredSide { served, steps, .. } = &self.sides[index];
        let displaced =
            served.problem.equations.displaced::<{ 4 * PATTERNS }>(comparisons.constants(), steps.patterns()[1]);
        std::array::from_fn(|state| {
            (std::array::from_fn(|axis| displaced.factors[4 * state + axis]), displaced.strengths[0][4 * state])
        })
    }

    /// The displaced states of a motion enter the lanes from `first` on.
    fn enter<S: InstructionSet>(
        &self,
        motions: &mut LaneMotions<'a, S>,
        first: usize,
        index: usize,
    ) -> StatesInLanes<'a> {
        let MeasuredSide { served, steps, .. } = &self.sides[index];
        let comparisons = Comparisons::new(*steps);
        let start = steps.steps[0].start(steps.backward);
        let states = steps.displaced_states(&start, comparisons.scale);
        let constants = self.constants(index, &comparisons);
        for (state, ([attitude, rates], (factors, strength))) in states.into_iter().zip(constants).enumerate() {
            let attitude = within(&served.axes, attitude);
            motions.enter(first + state, &LaneStart { attitude, rates, factors, strength, ..served.start() });
        }
        StatesInLanes { index, comparisons, errors: StepErrors::default() }
    }

    /// Compares the states with their motion. Returns whether they go on, or `None` if the motion is measured alone.
    fn compare<S: InstructionSet>(
        &self,
        motions: &mut LaneMotions<'a, S>,
        first: usize,
        states: &mut StatesInLanes<'a>,
    ) -> Option<bool> {
        let MeasuredSide { served, steps, .. } = &self.sides[states.index];
        let all: [[Row; 2]; PATTERNS] = std::array::from_fn(|state| motions.state(first + state));
        let target = states.comparisons.target()?;
        let outward = |[attitude, _]: [Row; 2]| outside(&served.axes, attitude);
        let factor = states.comparisons.compare(&all.map(outward))?;
        if !steps.enlarged {
            return Some(states.comparisons.holds() && states.comparisons.target().is_some());
        }
        let to = target.start(steps.backward);
        let moved = moved(&all, [&within(&served.axes, to.attitude), &to.rates], factor);
        for (state, [attitude, rates]) in moved.iter().enumerate() {
            motions.restart(first + state, [attitude, rates]);
        }
        if factor < 1.0 {
            for (state, (factors, strength)) in self.constants(states.index, &states.comparisons).iter().enumerate() {
                motions.set_constants(first + state, factors, *strength);
            }
        }
        Some(states.comparisons.holds() && states.comparisons.target().is_some())
    }
}

impl StatesInLanes<'_> {
    /// The length of a step in some lanes, of which it adds the errors, and its end if that is the target.
    fn prepare(
        &mut self,
        now: (f64, f64),
        (sizes, mine): (&LaneSizes, Range<usize>),
        precision: Precision,
    ) -> (f64, Option<(f64, f64)>) {
        let Some(target) = self.comparisons.target() else { return (0.0, None) };
        let (length, end) = to_target(now, target.time, sizes.length(mine.clone(), precision));
        self.errors.add(length.abs(), precision.order, sizes.of_step(mine, length.abs()));
        (length, end)
    }

    /// Displaces the states by the rounding errors of the last step. Returns whether they are finite.
    fn disturb<S: InstructionSet>(&mut self, motions: &mut LaneMotions<'_, S>, first: usize) -> bool {
        let (noise, last) = (self.comparisons.noise(), self.errors.last);
        let noise = [noise[0] * last[0], noise[1] * last[1]];
        let signs = RandomSigns::next(&mut self.comparisons.random);
        for state in 0..PATTERNS {
            let changes: [[f64; 2]; 4] = std::array::from_fn(|part| signs.times(noise, 4 * state + part));
            motions.disturb(first + state, [0, 1].map(|i| changes.map(|change| change[i])));
        }
        let finite = (first..first + PATTERNS).all(|lane| motions.state(lane)[0].iter().sum::<f64>().is_finite());
        if !finite {
            self.comparisons.lose();
        }
        finite
    }
}

impl<'a> Task for MeasuredInLanes<'a> {
    /// `None` for a motion that is measured alone.
    type Output = Vec<Option<Profile>>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let mut done: Self::Output = self.sides.iter().map(|_| None).collect();
        let Some(first) = self.sides.first() else { return done };
        let precision = Comparisons::new(first.steps).precision();
        let (mut queue, mut count) = (0..self.sides.len(), 0_usize);
        let mut motions = LaneMotions::new(simd);
        let mut inside: [Option<StatesInLanes<'a>>; MOST / PATTERNS] = std::array::from_fn(|_| None);
        loop {
            for (slot, place) in inside.iter_mut().enumerate().take(S::F64_LANES / PATTERNS) {
                if place.is_none() {
                    *place = queue.next().map(|index| self.enter(&mut motions, PATTERNS * slot, index));
                }
            }
            if inside.iter().all(Option::is_none) || count.is_multiple_of(AT_ONCE) && going(self.stop).is_err() {
                return done;
            }
            count += 1;
            motions.expand(precision.order);
            let sizes = motions.sizes(precision.order);
            let (mut lengths, mut ends) = ([0.0; MOST], [None; MOST]);
            for (slot, place) in inside.iter_mut().enumerate() {
                let Some(states) = place else { continue };
                let mine = PATTERNS * slot..PATTERNS * (slot + 1);
                let (length, end) = states.prepare(motions.time(mine.start), (&sizes, mine.clone()), precision);
                lengths[mine.clone()].fill(length);
                ends[mine].fill(end);
            }
            motions.go(precision.order, &lengths, &ends);
            for (slot, place) in inside.iter_mut().enumerate() {
                let (first, Some(states)) = (PATTERNS * slot, &mut *place) else { continue };
                if states.disturb(&mut motions, first) && ends[first].is_none() {
                    continue;
                }
                let next = self.compare(&mut motions, first, states);
                if next == Some(true) {
                    continue;
                }
                let index = states.index;
                done[index] = place.take().filter(|_| next.is_some()).map(|states| states.comparisons.profile());
            }
        }
    }
}
