//! What becomes of an averaged motion at the separatrix: the full equations with many phases, and averages on the other side.
//!
//! The averages lose the phases, and the mode after the separatrix depends on them: it is known by probabilities. Members with evenly spread phases are integrated from some wobbles before
//! the separatrix until their energy is as far from it again.

use std::sync::atomic::AtomicBool;

use nalgebra::Vector3;

use crate::error::Error;
use crate::evolution::averaged_scene::Evolved;
use crate::evolution::evolve::{Evolution, EvolveOptions};
use crate::evolution::weakness::EndReason;
use crate::input::options::{Convention, Method};
use crate::input::scene::Scene;
use crate::motion::solved::Motion;
use crate::observed::periods::ObservedPeriods;
use crate::torque_free::mode::Mode;
use crate::torque_free::series::tables::SeriesTables;

/// Members start where the averages have so many changes of a wobble left to the separatrix, and at least this fraction of its excess.
const BEFORE: f64 = 20.0;
const LEAST: f64 = 1e-6;
/// A member that is nearer to the separatrix after its integration than this part of the distance at its start is integrated further, so many times at most.
const AWAY: f64 = 0.5;
const FURTHER: usize = 12;
/// The tolerance of the integrations \[rad\], or less where the distance needs it.
const TOLERANCE: f64 = 1e-6;
/// Wobbles over which the starts of the members are spread.
const SPREAD: f64 = 8.0;
/// Steps from the averaged state to one whose average it is.
const CORRECTIONS: usize = 3;
/// Three numbers whose multiples fill a cube evenly: powers of the root of x⁴ = x + 1.
const EVEN: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_970_1];

/// What becomes of some of the phases.
#[derive(Clone, Debug)]
pub struct Crossing {
    /// The share of the phases.
    pub probability: f64,
    /// The mode after the separatrix.
    pub mode: Mode,
    /// 1 if the positive axis of the mode is along the angular momentum, otherwise −1.
    pub sense: f64,
    /// The averaged motion of one of them, from after the separatrix.
    pub evolution: Evolution,
}

impl Evolution {
    /// A scene at a time with given phases \[turns\], as of [`ObservedPeriods::phases`], whose averaged motion this is: torques, orbits and options are those of the evolution's scene, without a
    /// span. What the averages leave out at these phases is added to their momentum and energy.
    ///
    /// # Errors
    /// - As [`Evolution::at`]; [`Error::PeriodRatio`] for a state so near the separatrix that a double does not hold it; [`Error::Direction`] for phases that are not finite.
    pub fn motion_at(&self, time: f64, phases: [f64; 2]) -> Result<Scene, Error> {
        let [mean] = self.at(&[time])?[..] else { unreachable!("one time") };
        let (momentum, excess) = (Vector3::from(mean.momentum), mean.excess);
        let (mut own, mut above) = (momentum, excess);
        let mut scene = self.scene_of(&mean, phases)?;
        for _ in 0..CORRECTIONS {
            // Beside the separatrix the corrections are larger than the distance from it: the averaged state stays.
            let Ok((found, its_excess)) = self.mean_of(&scene) else { break };
            (own, above) = (own + momentum - found, (above + excess - its_excess).max(0.0));
            match self.scene_of(&self.evolved(time, &own, above), phases) {
                Ok(next) => scene = next,
                Err(_) => break,
            }
        }
        Ok(scene)
    }

    fn scene_of(&self, state: &Evolved, phases: [f64; 2]) -> Result<Scene, Error> {
        let periods = state.periods(Convention::ExtremalAxis);
        let [lowest, _] = self.scene().body().period_ratios(state.mode, Convention::ExtremalAxis)?;
        let observed = ObservedPeriods {
            mode: state.mode,
            momentum_direction: state.direction().into(),
            phases,
            epoch: state.time,
            sense: Some(self.sense()),
            // Of a rotation about the axis the ratio is the lowest one, which rounding may miss.
            ..ObservedPeriods::new(periods.precession, periods.rotation.max(lowest * periods.precession))
        };
        let free = Scene::from_periods(self.scene().body().clone(), &observed)?;
        Ok(self.scene().with_state(*free.state()).without_span())
    }

    /// Whether the positive axis of the mode is along the angular momentum at the epoch: 1, otherwise −1.
    fn sense(&self) -> f64 {
        sense_of(self.scene())
    }

    /// What becomes of it beyond the separatrix: for each mode and sense that members with evenly spread phases reach, its probability and the averaged motion of one of them up to the end of
    /// the span. Starts are spread over some wobbles, too. An evolution that ends otherwise is its own, with the probability 1.
    ///
    /// # Errors
    /// - Those of [`Scene::solve`] and [`Scene::evolve`]; [`Error::NotAveraged`] if a member stays at the separatrix.
    pub fn through(&self, members: usize, seed: u64, stop: &AtomicBool) -> Result<Vec<Crossing>, Error> {
        let end = self.end();
        if end.reason != EndReason::Separatrix || members == 0 {
            let (mode, sense) = (self.at(&[end.time])?[0].mode, self.sense());
            return Ok(vec![Crossing { probability: 1.0, mode, sense, evolution: self.clone() }]);
        }
        let (start, distance, wobble) = self.before(end.time)?;
        let origin = (seed as f64 * 0.618_033_988_749_894_9).fract();
        // The energy changes in steps of a wobble, so that starts at one time would not mix: they are spread over some wobbles.
        let epoch = self.scene().state().epoch;
        let earliest = start - (SPREAD * wobble).min((start - epoch).abs()).copysign(end.time - start);
        let mut found: Vec<(Mode, f64, usize, Scene)> = Vec::new();
        for member in 0..members {
            let [first, second, third] = EVEN.map(|step| (origin + (member as f64 + 0.5) * step).fract());
            let from = start + third * (earliest - start);
            let scene = self.motion_at(from, [first, second])?;
            let scene = self.passed(scene, (end.time - from, distance, wobble), stop)?;
            let (mode, sense) = (mode_of(&scene)?, sense_of(&scene));
            match found.iter_mut().find(|one| (one.0, one.1) == (mode, sense)) {
                Some(one) => one.2 += 1,
                None => found.push((mode, sense, 1, scene)),
            }
        }
        found.sort_by_key(|one| std::cmp::Reverse(one.2));
        let [first, last] = self.span();
        let evolved = |(mode, sense, count, scene): (Mode, f64, usize, Scene)| {
            let time = scene.state().epoch;
            let (first, last) = if end.time < start { (first, time) } else { (time, last.max(time)) };
            let options = EvolveOptions::default().span(first.min(last), last).average(self.average());
            let evolution = scene.evolve(options.tolerance(self.tolerance()).until(stop))?;
            Ok(Crossing { probability: count as f64 / members as f64, mode, sense, evolution })
        };
        found.into_iter().map(evolved).collect()
    }

    /// A time before the separatrix, how far from it the state is there (of 1 − ξ/ξ_sep), and the period of the wobble.
    fn before(&self, end: f64) -> Result<(f64, f64, f64), Error> {
        let epoch = self.scene().state().epoch;
        let far = |time: f64| Ok::<f64, Error>(1.0 - self.at(&[time])?[0].excess / self.separatrix());
        let (mut near, mut away) = (end, epoch);
        // The period of the wobble changes slowly, with the logarithm of the distance.
        for _ in 0..60 {
            let middle = near + 0.5 * (away - near);
            let distance = far(middle)?;
            let wobble = self.at(&[middle])?[0].periods(Convention::ExtremalAxis).rotation;
            let change = distance * wobble / (end - middle).abs().max(f64::MIN_POSITIVE);
            if distance > LEAST.max(BEFORE * change) { away = middle } else { near = middle }
        }
        let wobble = self.at(&[away])?[0].periods(Convention::ExtremalAxis).rotation;
        Ok((away, far(away)?, wobble))
    }

    /// The scene of a member after it has passed the separatrix, by the full equations.
    fn passed(
        &self,
        scene: Scene,
        (whole, distance, wobble): (f64, f64, f64),
        stop: &AtomicBool,
    ) -> Result<Scene, Error> {
        let length = whole + wobble.copysign(whole);
        let mut scene = scene;
        let mut left = 2.0 * length;
        let tolerance = TOLERANCE.min(distance * 1e-2);
        for _ in 0..FURTHER {
            let epoch = scene.state().epoch;
            let until = epoch + left;
            let solved = scene.clone().method(Method::Integrated).tolerance(tolerance);
            let motion: Motion =
                solved.span(epoch.min(until), epoch.max(until)).solve_until(&SeriesTables::default(), stop)?;
            scene = scene.with_state(*motion.scene_at(until)?.state());
            if from_separatrix(&scene) > AWAY * distance {
                return Ok(scene);
            }
            left = 0.5 * length;
        }
        let reason = "1 − ξ/ξ_sep of a member that stays at the separatrix: it";
        Err(Error::NotAveraged { reason, size: from_separatrix(&scene), bound: AWAY * distance })
    }
}

/// 2BE/M² − 1 of a scene over its largest value in the mode: the distance from the separatrix.
fn from_separatrix(scene: &Scene) -> f64 {
    let mut moments = scene.body().moments();
    let momentum = body_momentum(scene);
    let energy = momentum.iter().zip(moments).map(|(part, moment)| part * part / moment).sum::<f64>();
    moments.sort_by(f64::total_cmp);
    let [a, b, c] = moments;
    let departure = b * energy / momentum.norm_squared() - 1.0;
    (departure / if departure > 0.0 { b / a - 1.0 } else { b / c - 1.0 }).abs()
}

fn mode_of(scene: &Scene) -> Result<Mode, Error> {
    let mut moments = scene.body().moments();
    let momentum = body_momentum(scene);
    let energy = momentum.iter().zip(moments).map(|(part, moment)| part * part / moment).sum::<f64>();
    moments.sort_by(f64::total_cmp);
    Ok(if moments[1] * energy < momentum.norm_squared() { Mode::ShortAxis } else { Mode::LongAxis })
}

/// The sign of the angular momentum along the axis of the mode.
fn sense_of(scene: &Scene) -> f64 {
    let moments = scene.body().moments();
    let short = mode_of(scene) == Ok(Mode::ShortAxis);
    let order = |one: &usize, other: &usize| moments[*one].total_cmp(&moments[*other]);
    let axis = if short { (0..3).max_by(order) } else { (0..3).min_by(order) };
    if body_momentum(scene)[axis.unwrap_or(2)] < 0.0 { -1.0 } else { 1.0 }
}

/// The angular momentum about principal axes.
fn body_momentum(scene: &Scene) -> Vector3<f64> {
    let rates = scene.state().angular_velocity;
    let rates = scene.body().turn().map_or(rates, |turn| turn.inverse() * rates);
    Vector3::from(scene.body().moments()).component_mul(&rates)
}
