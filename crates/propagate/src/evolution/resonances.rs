//! Resonances between the rotation about the angular momentum and the motion along the polhode that an averaged motion passes (weak torques (13)).
//!
//! Ω = h dℓ′/dt + m dy′/dt is M times a function of ξ. Where it is 0, the term (h, m) of the torque acts for a time of 1/√ε rotations: a jump of the order √ε that depends on lost phases.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::averaged_scene::AveragedScene;
use super::equations::AveragedTorques;
use super::path::{AveragedPath, Node, Scaled};
use super::polhode_means::ExcessPolhode;
use super::torus::{ALONG, TorusTerms};
use crate::error::Error;
use crate::orbit::elements::Orbit;

/// Places on an orbit over which the torque is averaged, where the largest term counts.
const PLACES: usize = 8;
/// A resonance that is passed more often has the jump of the largest of so many passages.
const PASSAGES: usize = 8;
/// Bisections of a step: its time is known to 1e-9 of it.
const BISECTIONS: usize = 30;

/// A resonance that an evolution passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassedResonance {
    /// h, the multiple of the rate along the polhode.
    pub wobble: i32,
    /// m, the multiple of the rate about the angular momentum.
    pub turn: i32,
    /// When.
    pub time: f64,
    /// The largest change of the angular momentum by the passage, over its size.
    pub jump: f64,
    /// The largest change of ξ.
    pub excess_jump: f64,
    /// 2|F|/|⟨ξ̇⟩|, with the term F of ξ̇. From 1 on the motion may be captured.
    pub ratio: f64,
}

impl PassedResonance {
    /// Whether the motion may stay in resonance from there on: it is one of several then.
    pub fn may_capture(&self) -> bool {
        self.ratio >= 1.0
    }
}

/// The resonances with |m| at most one above the degree of the torque on a path, whose jumps of M or of ξ/ξ_sep are above a bound or that may capture, by time.
///
/// # Errors
/// As [`MovingSource::views`](super::sources::MovingSource::views).
pub(super) fn passed(problem: &AveragedScene, path: &AveragedPath, least: f64) -> Result<Vec<PassedResonance>, Error> {
    let equations = &problem.equations;
    let mut scaled = Scaled::new(equations, problem.momentum.norm());
    let most = equations.highest_degree() as i32 + 1;
    let separatrix = equations.family.alpha(&equations.moments).y;
    let mut found: Vec<PassedResonance> = Vec::new();
    let quotients: Vec<f64> = path.nodes.iter().map(|node| quotient(equations, node.state[3])).collect();
    for (pair, ends) in path.nodes.windows(2).zip(quotients.windows(2)) {
        for m in 1..=most {
            let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])].map(|quotient| f64::from(m) * quotient);
            let first = low.ceil() as i32;
            let last = (high.floor() as i32).min(ALONG as i32 / 2 - 1);
            for h in first..=last {
                let own = |one: &&PassedResonance| (one.wobble, one.turn) == (-h, m);
                let before = found.iter().filter(own).count();
                let node = crossing(&mut scaled, pair, f64::from(h) / f64::from(m))?;
                let one = if before < PASSAGES {
                    Some(passage(problem, &mut scaled, node, [-h, m])?)
                } else {
                    let largest = found.iter().filter(own).max_by(|one, other| one.jump.total_cmp(&other.jump));
                    largest.map(|largest| PassedResonance { time: node.time, ..*largest })
                };
                let counts = |one: &PassedResonance| {
                    one.may_capture() || one.jump >= least || one.excess_jump >= least * separatrix
                };
                found.extend(one.filter(counts));
            }
        }
    }
    found.sort_by(|one, other| one.time.total_cmp(&other.time));
    Ok(found)
}

/// dy′/dℓ′ at an excess.
fn quotient(equations: &AveragedTorques, excess: f64) -> f64 {
    let polhode = ExcessPolhode::new(&equations.moments, equations.family, excess);
    polhode.mean_turn_rate() / polhode.wobble_rate()
}

/// The state within a step where dy′/dℓ′ has a value.
fn crossing(scaled: &mut Scaled<'_>, pair: &[Node], value: f64) -> Result<Node, Error> {
    let above = quotient(scaled.equations, pair[0].state[3]) > value;
    let (mut before, mut after) = (0.0, pair[1].time - pair[0].time);
    let mut state = pair[0].state;
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (before + after);
        let found = scaled.after(&pair[0], middle)?;
        if (quotient(scaled.equations, found[3]) > value) == above {
            (before, state) = (middle, found);
        } else {
            after = middle;
        }
    }
    Ok(Node { time: pair[0].time + before, state })
}

/// The passage of (h, m) at a state (13).
fn passage(
    problem: &AveragedScene,
    scaled: &mut Scaled<'_>,
    Node { time, state }: Node,
    [h, m]: [i32; 2],
) -> Result<PassedResonance, Error> {
    let equations = &problem.equations;
    let [x, y, z, excess] = state;
    let momentum = Vector3::new(x, y, z) * scaled.unit;
    let size = momentum.norm();
    let (_, slopes) = ExcessPolhode::new(&equations.moments, equations.family, excess).rates_and_slopes(size);
    let slope = f64::from(h) * slopes[0] + f64::from(m) * slopes[1];
    let mean = scaled.slope(time, &state)?[3].abs();
    let averaged = equations.sources.iter().filter(|source| source.over_orbit).filter_map(|source| source.ellipse());
    let fastest = averaged.map(Orbit::mean_motion).fold(0.0, f64::max);
    let places = if fastest > 0.0 { PLACES } else { 1 };
    let mut term = [0.0_f64; 2];
    for place in 0..places {
        let after = if fastest > 0.0 { TAU / fastest * place as f64 / places as f64 } else { 0.0 };
        let [radial, x, z, excess_rate] = TorusTerms::new(equations, time + after, (&momentum, excess))?.of([h, m]);
        let torque = [radial, x, z].iter().map(|part| part.norm_sqr()).sum::<f64>().sqrt();
        let sizes = [torque, excess_rate.norm()];
        term = [0, 1].map(|k| term[k].max(sizes[k]));
    }
    let ratio = 2.0 * term[1] / mean;
    // The slowest passage has the rate (1 − ratio) ⟨ξ̇⟩.
    let slowest = if ratio < 1.0 { 1.0 - ratio } else { 1.0 };
    let lasting = 2.0 * (TAU / (mean * slope.abs() * slowest)).sqrt();
    Ok(PassedResonance {
        wobble: h,
        turn: m,
        time,
        jump: lasting * term[0] / size,
        excess_jump: lasting * term[1],
        ratio,
    })
}
