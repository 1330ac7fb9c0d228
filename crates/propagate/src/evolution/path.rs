//! The averaged motion in one direction of time: steps with their states, and where and why it ends.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use nalgebra::Vector3;

use super::equations::{AveragedTorques, Scratch};
use super::extrapolation::{SlowState, step};
use super::weakness::{EndReason, Weakness};
use crate::error::Error;
use crate::simd::halt::going;

/// The most steps that are kept in one direction: 48 MB.
const MOST_STEPS: usize = 1 << 20;
/// The separatrix is reached at this fraction of its excess: the rates are continuous there, but not their derivatives.
const SEPARATRIX: f64 = 1.0 - 1e-6;
/// Rates are evaluated up to this fraction.
const NEAREST: f64 = 1.0 - 1e-12;
/// Errors of the excess are relative to it down to this fraction of that of the separatrix.
const LEAST_EXCESS: f64 = 1e-14;

/// The flag by which another thread stops an integration, and the share of the work that it reads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch<'a> {
    pub(super) stop: &'a AtomicBool,
    /// In thousandths.
    pub(super) done: &'a AtomicU32,
    /// The number of this path, and that of all.
    pub(super) path: (usize, usize),
}

impl Watch<'_> {
    /// # Errors
    /// - [`Error::Stopped`].
    fn at(&self, share: f64) -> Result<(), Error> {
        let (path, paths) = self.path;
        self.done.store((1000.0 * (path as f64 + share) / paths as f64) as u32, Ordering::Relaxed); // at most 1000
        going(self.stop).map_err(|_| Error::Stopped)
    }
}

/// A share that nobody reads.
pub(super) static UNREAD: AtomicU32 = AtomicU32::new(0);

/// Where an evolution ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvolutionEnd {
    /// Why.
    pub reason: EndReason,
    /// When.
    pub time: f64,
}

/// A state on the path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) time: f64,
    pub(super) state: SlowState,
}

/// The steps from the epoch in one direction.
#[derive(Clone, Debug)]
pub(super) struct AveragedPath {
    pub(super) nodes: Vec<Node>,
    pub(super) end: EvolutionEnd,
}

/// The equations in the units of a path.
pub(super) struct Scaled<'a> {
    pub(super) equations: &'a AveragedTorques,
    /// The size of the angular momentum at the epoch.
    pub(super) unit: f64,
    pub(super) scratch: Scratch,
}

impl<'a> Scaled<'a> {
    pub(super) fn new(equations: &'a AveragedTorques, unit: f64) -> Self {
        Self { equations, unit, scratch: Scratch::default() }
    }

    /// ξ of the separatrix.
    fn separatrix(&self) -> f64 {
        self.equations.family.alpha(&self.equations.moments).y
    }

    pub(super) fn slope(&mut self, time: f64, state: &SlowState) -> Result<SlowState, Error> {
        let [x, y, z, excess] = *state;
        let excess = excess.clamp(0.0, self.separatrix() * NEAREST);
        let momentum = Vector3::new(x, y, z) * self.unit;
        let rates = self.equations.rates(time, (&momentum, excess), &mut self.scratch)?;
        let momentum = rates.momentum / self.unit;
        Ok([momentum.x, momentum.y, momentum.z, rates.excess])
    }

    /// The state `h` after a node.
    pub(super) fn after(&mut self, node: &Node, h: f64) -> Result<SlowState, Error> {
        let slope = self.slope(node.time, &node.state)?;
        let stepped = step(&mut |t, y: &SlowState| self.slope(t, y), (node.time, h), (&node.state, &slope))?.0;
        Ok(within(stepped))
    }

    /// The event that has passed at a state.
    fn event(&mut self, time: f64, state: &SlowState) -> Result<Option<EndReason>, Error> {
        let separatrix = self.separatrix();
        if state[3] >= SEPARATRIX * separatrix {
            return Ok(Some(EndReason::Separatrix));
        }
        let size = Vector3::new(state[0], state[1], state[2]).norm() * self.unit;
        Ok(Weakness::of(self.equations, time, size, &mut self.scratch)?.end())
    }
}

impl AveragedPath {
    /// From a node to a time, with a local error of each step relative to the state.
    ///
    /// # Errors
    /// - [`Error::TooManySteps`], [`Error::Stopped`], and as [`MovingSource::views`](super::sources::MovingSource::views).
    pub(super) fn run(
        scaled: &mut Scaled<'_>,
        start: Node,
        (stop, longest): (f64, f64),
        tolerance: f64,
        watch: Watch<'_>,
    ) -> Result<Self, Error> {
        // A step passes over no orbit that is not averaged.
        let least = (stop - start.time).abs() / longest;
        if least > MOST_STEPS as f64 {
            return Err(too_many(least));
        }
        let mut nodes = vec![start];
        let (sign, mut node) = (if stop < start.time { -1.0 } else { 1.0 }, start);
        let mut slope = scaled.slope(node.time, &node.state)?;
        let mut h = longest.min(first_step(&node.state, &slope));
        while node.time != stop {
            watch.at((node.time - start.time) / (stop - start.time))?;
            if nodes.len() > MOST_STEPS {
                return Err(too_many(f64::INFINITY));
            }
            let left = (stop - node.time).abs();
            // A last step shorter than the rounding of time would not end.
            let last = h >= left * (1.0 - 1e-9);
            let length = if last { left } else { h };
            let (state, error) = {
                let mut equations = |t: f64, y: &SlowState| scaled.slope(t, y);
                step(&mut equations, (node.time, sign * length), (&node.state, &slope))?
            };
            let error = relative(&state, &error, scaled.separatrix()) / tolerance;
            let factor = if error > 0.0 { (0.9 * error.powf(-1.0 / 7.0)).clamp(0.2, 4.0) } else { 4.0 };
            if error.is_nan() || error > 1.0 {
                h = length * factor.min(0.9);
                if node.time + sign * h == node.time || !h.is_finite() {
                    return Err(too_many(f64::INFINITY));
                }
                continue;
            }
            let next = Node { time: if last { stop } else { node.time + sign * length }, state: within(state) };
            if let Some(reason) = scaled.event(next.time, &next.state)? {
                let end = located(scaled, &node, next.time - node.time)?;
                nodes.push(end);
                return Ok(Self { nodes, end: EvolutionEnd { reason, time: end.time } });
            }
            nodes.push(next);
            node = next;
            slope = scaled.slope(node.time, &node.state)?;
            h = (length * factor).max(if last { h } else { 0.0 }).min(longest);
        }
        Ok(Self { nodes, end: EvolutionEnd { reason: EndReason::Span, time: stop } })
    }

    /// The state at a time between the epoch and the end.
    pub(super) fn state(&self, scaled: &mut Scaled<'_>, time: f64) -> Result<SlowState, Error> {
        let backward = self.end.time < self.nodes[0].time;
        let passed = |node: &Node| if backward { node.time >= time } else { node.time <= time };
        let node = self.nodes[self.nodes.partition_point(passed).max(1) - 1];
        if node.time == time { Ok(node.state) } else { scaled.after(&node, time - node.time) }
    }
}

fn too_many(steps: f64) -> Error {
    Error::TooManySteps { steps, bound: MOST_STEPS, reason: String::new() }
}

/// The last state before an event within a step, by bisection to 1e-12 of the step.
fn located(scaled: &mut Scaled<'_>, node: &Node, whole: f64) -> Result<Node, Error> {
    let (mut before, mut after) = (0.0, whole);
    for _ in 0..40 {
        let middle = 0.5 * (before + after);
        let state = scaled.after(node, middle)?;
        if scaled.event(node.time + middle, &state)?.is_some() { after = middle } else { before = middle }
    }
    let state = if before == 0.0 { node.state } else { scaled.after(node, before)? };
    Ok(Node { time: node.time + before, state })
}

/// ξ = 0 is invariant: a negative excess is an error of the step.
fn within([x, y, z, excess]: SlowState) -> SlowState {
    [x, y, z, excess.max(0.0)]
}

/// A hundredth of the time in which the state changes by itself.
fn first_step(state: &SlowState, slope: &SlowState) -> f64 {
    let [momentum, rate] = [state, slope].map(|v| Vector3::new(v[0], v[1], v[2]).norm());
    let fastest = (rate / momentum).max(if state[3] > 0.0 { (slope[3] / state[3]).abs() } else { 0.0 });
    if fastest > 0.0 { 0.01 / fastest } else { f64::INFINITY }
}

/// The error of a step relative to the state.
fn relative(state: &SlowState, error: &SlowState, separatrix: f64) -> f64 {
    let [momentum, part] = [state, error].map(|v| Vector3::new(v[0], v[1], v[2]).norm());
    (part / momentum).max(error[3].abs() / state[3].abs().max(LEAST_EXCESS * separatrix))
}
