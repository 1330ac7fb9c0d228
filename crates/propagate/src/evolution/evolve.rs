//! `Scene::evolve`: the averaged motion over a span.

use std::sync::atomic::{AtomicBool, AtomicU32};

use nalgebra::Vector3;

use super::averaged_scene::{AveragedScene, Evolved};
use super::path::{AveragedPath, EvolutionEnd, Node, Scaled, UNREAD, Watch};
use super::polhode_means::ModeFamily;
use super::resonances::{PassedResonance, passed};
use super::short_period::ShortPeriod;
use super::weakness::EndReason;
use super::window::second_order;
use crate::error::Error;
use crate::input::options::Averaging;
use crate::input::scene::Scene;
use crate::integration::rates::of_interpolation;
use crate::simd::halt::GOING;

/// The averaged motion of a scene over a span. It has no attitude and no phases: after times of 1/ε rotations they are unknown.
#[derive(Clone, Debug)]
pub struct Evolution {
    /// As it was given.
    scene: Scene,
    problem: AveragedScene,
    span: [f64; 2],
    tolerance: f64,
    /// To the start of the span, and to its end.
    paths: [AveragedPath; 2],
    /// The ends of members with other phases.
    members: Vec<EvolutionEnd>,
}

impl Evolution {
    /// The averaged state at times within the span, up to the end of the evolution.
    ///
    /// # Errors
    /// - [`Error::Time`] for a time outside.
    pub fn at(&self, times: &[f64]) -> Result<Vec<Evolved>, Error> {
        let unit = self.problem.momentum.norm();
        let mut scaled = Scaled::new(&self.problem.equations, unit);
        let epoch = self.problem.equations.epoch;
        let [first, last] = self.paths.each_ref().map(|path| path.end.time);
        let one = |(index, &time): (usize, &f64)| {
            if !(first <= time && time <= last) {
                let bound = if time < epoch { epoch - first } else { last - epoch };
                let reason = ", within the evolution";
                return Err(Error::Time { index, value: time, epoch, span: Some([first, last]), bound, reason });
            }
            let [x, y, z, excess] = self.paths[usize::from(time >= epoch)].state(&mut scaled, time)?;
            Ok(self.problem.evolved(time, &(Vector3::new(x, y, z) * unit), excess))
        };
        times.iter().enumerate().map(one).collect()
    }

    /// What the averages leave out at times: root mean square over the phases of the short-period parts of the angular momentum, over its size, and of ξ.
    ///
    /// # Errors
    /// As [`Evolution::at`].
    pub fn band(&self, times: &[f64]) -> Result<Vec<[f64; 2]>, Error> {
        let one = |state: &Evolved| {
            let momentum = Vector3::from(state.momentum);
            let short = ShortPeriod::new(&self.problem.equations, state.time, (&momentum, state.excess))?;
            let [turn, excess] = short.band();
            Ok([turn / momentum.norm(), excess])
        };
        self.at(times)?.iter().map(one).collect()
    }

    /// How much earlier or later the end may be \[time\]. With two or more members that end for the same reason: the standard deviation of their ends. Otherwise, at the separatrix: the
    /// short-period part of ξ over the mean rate of ξ. `None` for other ends.
    ///
    /// # Errors
    /// As [`Evolution::at`].
    pub fn spread(&self) -> Result<Option<f64>, Error> {
        let EvolutionEnd { reason, time } = self.end();
        let same = self.members.iter().filter(|end| end.reason == reason && reason != EndReason::Span);
        let times: Vec<f64> = same.map(|end| end.time).collect();
        if times.len() > 1 {
            let mean = times.iter().sum::<f64>() / times.len() as f64;
            let squares = times.iter().map(|time| (time - mean).powi(2)).sum::<f64>();
            return Ok(Some((squares / (times.len() - 1) as f64).sqrt()));
        }
        if reason != EndReason::Separatrix {
            return Ok(None);
        }
        let epoch = self.problem.equations.epoch;
        let before = time - 1e-3 * (time - epoch);
        let change = self.at(&[time])?[0].excess - self.at(&[before])?[0].excess;
        let [_, band] = self.band(&[before])?[0];
        Ok((change != 0.0).then(|| (band * (time - before) / change).abs()))
    }

    /// Why and when it ends: towards the end of the span, or towards its start if that is where it stops.
    pub fn end(&self) -> EvolutionEnd {
        end_of(self.paths.each_ref().map(|path| path.end))
    }

    /// The ends of members with the same momentum and energy at the epoch and evenly spread phases: their averages differ by what the averages leave out.
    pub fn members(&self) -> &[EvolutionEnd] {
        &self.members
    }

    /// What is known of its error. It integrates the full equations over thirty rotations at the epoch and near each end.
    ///
    /// # Errors
    /// Those of [`Scene::solve`] for these rotations.
    pub fn plan(&self) -> Result<EvolutionPlan, Error> {
        let second_order = self.second_order()?;
        let epoch = self.problem.equations.epoch;
        let mut resonances = Vec::new();
        let mut error_bound = 0.0_f64;
        for path in &self.paths {
            let passed = passed(&self.problem, path, self.tolerance)?;
            let jumps: f64 = passed.iter().map(|one| one.jump).sum();
            let length = second_order[0] * (path.end.time - epoch).abs() + self.truncated(path);
            error_bound = error_bound.max(length + jumps);
            resonances.extend(passed);
        }
        Ok(EvolutionPlan { error_bound, truncation: self.truncation(), second_order, resonances })
    }

    /// The part of the error that needs no integration, as [`EvolutionPlan::large_error`]: what the polynomials of shapes leave out, times the change of the angular momentum.
    pub fn large_error(&self) -> Option<String> {
        let largest = self.paths.iter().map(|path| self.truncated(path)).fold(0.0, f64::max);
        large(largest, self.truncation())
    }

    /// What the polynomials of shapes leave out, relative to the torque.
    fn truncation(&self) -> f64 {
        let truncations = self.scene.asked_torques().iter().map(|torque| torque.truncation());
        truncations.map(|part| part * part).sum::<f64>().sqrt()
    }

    /// The truncation times the length of a path of the angular momentum, over its size at the epoch.
    fn truncated(&self, path: &AveragedPath) -> f64 {
        let change = |pair: &[Node]| {
            let [one, other] = [pair[0].state, pair[1].state].map(|[x, y, z, _]| Vector3::new(x, y, z));
            (other - one).norm()
        };
        self.truncation() * path.nodes.windows(2).map(change).sum::<f64>()
    }

    /// The larger rates of second order of windows at the epoch and near both ends of the paths.
    fn second_order(&self) -> Result<[f64; 2], Error> {
        let mut most = second_order(&self.problem)?;
        let epoch = self.problem.equations.epoch;
        for path in &self.paths {
            let time = epoch + NEAR_END * (path.end.time - epoch);
            if time == epoch {
                continue;
            }
            let state = self.at(&[time])?[0];
            let there = self.problem.near(time, &Vector3::from(state.momentum), state.excess);
            // Next to an end the window may be refused: the other one stays.
            if let Ok(found) = there.and_then(|there| second_order(&there)) {
                most = [0, 1].map(|part| most[part].max(found[part]));
            }
        }
        Ok(most)
    }

    /// The first and the last time of the span that it reaches.
    pub fn reached(&self) -> [f64; 2] {
        let [first, last] = self.paths.each_ref().map(|path| path.end.time);
        self.span.map(|time| time.clamp(first, last))
    }

    /// The span that was asked for.
    pub fn span(&self) -> [f64; 2] {
        self.span
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The averaged state of a scene of the same body and torques at its epoch.
    pub(crate) fn mean_of(&self, scene: &Scene) -> Result<(Vector3<f64>, f64), Error> {
        AveragedScene::new(scene, self.average())?.mean()
    }

    /// A scene of the same body and torques, with a torque of a rigid body for internal friction.
    pub(crate) fn with_friction(&self, scene: &Scene) -> Result<Scene, Error> {
        AveragedScene::new(scene, self.average())?.with_friction(scene)
    }

    /// What follows from an angular momentum and an excess of energy at a time.
    pub(crate) fn evolved(&self, time: f64, momentum: &Vector3<f64>, excess: f64) -> Evolved {
        self.problem.evolved(time, momentum, excess)
    }

    /// The largest relative error of a step of the integration.
    pub(crate) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The mode, and the sense of the angular momentum along its axis.
    pub(crate) fn family(&self) -> ModeFamily {
        self.problem.equations.family
    }

    /// ξ of the separatrix.
    pub(crate) fn separatrix(&self) -> f64 {
        self.family().alpha(&self.problem.equations.moments).y
    }

    /// Whether torques are averaged over orbits, too.
    pub fn average(&self) -> Averaging {
        let over = self.problem.equations.sources.iter().any(|source| source.over_orbit);
        if over { Averaging::Orbit } else { Averaging::Spin }
    }
}

/// The place of the second window, of the way to the end.
const NEAR_END: f64 = 0.9;

/// The end of two ways: towards the end of the span, or towards its start if that is where it stops.
fn end_of([backward, forward]: [EvolutionEnd; 2]) -> EvolutionEnd {
    if forward.reason == EndReason::Span && backward.reason != EndReason::Span { backward } else { forward }
}

/// What is known of the error of an evolution.
#[derive(Clone, Debug, PartialEq)]
pub struct EvolutionPlan {
    /// Estimated error of the angular momentum at the farther end, over its size at the epoch: the rate of second order times the time, the truncation times the change, and the jumps of the
    /// resonances that are passed.
    pub error_bound: f64,
    /// What the polynomials of shapes leave out, relative to the torque.
    pub truncation: f64,
    /// Rates at which averages and full equations separate [1/time], the largest that is measured: of the angular momentum over its size, and of ξ.
    pub second_order: [f64; 2],
    /// The resonances between rotation and wobble that are passed.
    pub resonances: Vec<PassedResonance>,
}

impl EvolutionPlan {
    /// A sentence if the error bound is above a tenth of the angular momentum, otherwise `None`.
    pub fn large_error(&self) -> Option<String> {
        large(self.error_bound, self.truncation)
    }
}

/// An error of the angular momentum over its size from which an evolution says so: the ratio at which averages end.
const LARGE: f64 = 0.1;

/// The sentence for an error above [`LARGE`].
fn large(error: f64, truncation: f64) -> Option<String> {
    let part = if truncation > 0.0 {
        format!("; the polynomials of its shapes leave out {truncation:.1e} of the torque")
    } else {
        String::new()
    };
    let said = || {
        format!("the error of the angular momentum may reach {error:.1e} of its size at the epoch, above {LARGE}{part}")
    };
    (error.is_nan() || error > LARGE).then(said)
}

/// Options of an evolution.
#[derive(Clone, Copy, Debug)]
pub struct EvolveOptions<'a> {
    span: Option<(f64, f64)>,
    average: Averaging,
    tolerance: f64,
    members: usize,
    stop: &'a AtomicBool,
    done: &'a AtomicU32,
}

/// Most members of an evolution.
const MOST_MEMBERS: usize = 10_000;

impl Default for EvolveOptions<'_> {
    /// The span of the scene, the averaging that serves, a tolerance of 1e-6.
    fn default() -> Self {
        Self { span: None, average: Averaging::Auto, tolerance: 1e-6, members: 0, stop: &GOING, done: &UNREAD }
    }
}

impl<'a> EvolveOptions<'a> {
    /// Sets the first and the last time.
    #[must_use]
    pub fn span(self, start: f64, stop: f64) -> Self {
        Self { span: Some((start, stop)), ..self }
    }

    /// Sets the averaging.
    #[must_use]
    pub fn average(self, average: Averaging) -> Self {
        Self { average, ..self }
    }

    /// Sets the largest relative error of a step of the integration.
    #[must_use]
    pub fn tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Also follows members with other phases at the epoch, for [`Evolution::members`] and [`Evolution::spread`].
    #[must_use]
    pub fn members(self, members: usize) -> Self {
        Self { members, ..self }
    }

    /// Writes the share of the work that is done, in thousandths.
    #[must_use]
    pub fn reporting(self, done: &'a AtomicU32) -> Self {
        Self { done, ..self }
    }

    /// Ends the integration with [`Error::Stopped`] once the flag is set.
    #[must_use]
    pub fn until(self, stop: &'a AtomicBool) -> Self {
        Self { stop, ..self }
    }
}

impl Scene {
    /// The motion averaged over the rotation: angular momentum and excess of energy over 10³ to 10⁹ rotations, without attitude and phases.
    ///
    /// ```
    /// use andoyer_propagate::evolutions::EvolveOptions;
    /// use andoyer_propagate::torques::Torque;
    /// use andoyer_propagate::{Body, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?;
    /// let damping = Torque::damping([[1e-9, 0.0, 0.0], [0.0, 1.5e-9, 0.0], [0.0, 0.0, 2e-9]])?; // κI: the momentum decays with κ
    /// let scene = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).torques([damping]);
    /// let evolution = scene.evolve(EvolveOptions::default().span(0.0, 1e9))?;
    /// let [start, end] = evolution.at(&[0.0, 1e9])?[..] else { unreachable!() };
    /// assert!((end.momentum[2] / start.momentum[2] - (-1.0_f64).exp()).abs() < 1e-6);
    /// assert!((end.excess / start.excess - 1.0).abs() < 1e-12);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - Those of [`Scene::validate`]; [`Error::NoSpan`]; [`Error::Span`] for (1, 0) and for times that are not finite; [`Error::Tolerance`].
    /// - [`Error::NotAveraged`] for a torque that is not weak against the rotation and the wobble, an orbit that is not slow, the separatrix, a sphere, a body at rest.
    /// - [`Error::Torque`] for rotors, and for a polynomial with the directions or distances of two sources in one term.
    /// - [`Error::Table`] also for a table whose rows leave the distance unknown, [`Error::TooManySteps`], [`Error::Stopped`].
    pub fn evolve(&self, options: EvolveOptions<'_>) -> Result<Evolution, Error> {
        let epoch = self.state().epoch;
        let Some((start, stop)) = options.span.or(self.asked_span()) else {
            return Err(Error::NoSpan { reason: String::new() });
        };
        if !(start.is_finite() && stop.is_finite() && start <= stop) {
            return Err(Error::Span { start, stop });
        }
        let tolerance = options.tolerance;
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(Error::Tolerance { value: tolerance });
        }
        if options.members > MOST_MEMBERS {
            let (value, bound) = (options.members as f64, "at most 10000");
            return Err(Error::Number { argument: "members", index: None, value, bound });
        }
        let problem = AveragedScene::new(self, options.average)?;
        of_interpolation(self, (start.min(epoch), stop.max(epoch)))?;
        let unit = problem.momentum.norm();
        let (momentum, excess) = problem.mean()?;
        let (equations, longest) = (&problem.equations, problem.longest_step());
        let mut scaled = Scaled::new(equations, unit);
        let number = 2 * (1 + options.members);
        let mut path = 0;
        let mut run = |(momentum, excess): (Vector3<f64>, f64), end: f64| {
            let k = momentum / unit;
            let node = Node { time: epoch, state: [k.x, k.y, k.z, excess] };
            let watch = Watch { stop: options.stop, done: options.done, path: (path, number) };
            path += 1;
            AveragedPath::run(&mut scaled, node, (end, longest), tolerance, watch)
        };
        // The way to a span beside the epoch belongs to it.
        let mut both = |state| Ok::<_, Error>([run(state, start.min(epoch))?, run(state, stop.max(epoch))?]);
        let paths = both((momentum, excess))?;
        let means = if options.members > 0 { problem.means_of_members(options.members)? } else { Vec::new() };
        let ends = means.into_iter().map(|state| Ok(end_of(both(state)?.map(|path| path.end))));
        let members = ends.collect::<Result<Vec<_>, Error>>()?;
        Ok(Evolution { scene: self.clone(), problem, span: [start, stop], tolerance, paths, members })
    }
}
