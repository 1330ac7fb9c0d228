//! What becomes of an averaged motion at the separatrix: the full equations with many phases, and averages on the other side.
//!
//! The averages lose the phases, and the mode after the separatrix depends on them: it is known by probabilities. Members with evenly spread phases are integrated from some wobbles before
//! the separatrix until their energy is as far from it again.

use std::sync::atomic::AtomicBool;

use nalgebra::Vector3;

use crate::error::Error;
use crate::evolution::averaged_scene::{Evolved, family_of};
use crate::evolution::evolve::{Evolution, EvolveOptions};
use crate::evolution::polhode_means::ModeFamily;
use crate::evolution::weakness::EndReason;
use crate::input::options::{Convention, Method};
use crate::input::scene::Scene;
use crate::observed::periods::ObservedPeriods;

/// Members start at least so many wobbles before the separatrix, where 1 − ξ/ξ_sep is at least the second number.
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
            sense: Some(self.family().sign()),
            // Of a rotation about the axis the ratio is the lowest one, which rounding may miss.
            ..ObservedPeriods::new(periods.precession, periods.rotation.max(lowest * periods.precession))
        };
        let free = Scene::from_periods(self.scene().body().clone(), &observed)?;
        Ok(self.scene().with_state(*free.state()).without_span())
    }

    /// What becomes of it beyond the separatrix: for each mode and sense that members with evenly spread phases reach, the share of the members and the averaged motion of one of them up to the
    /// end of the span, the most frequent first. Their starts are spread over some wobbles, too. In the passage a torque across the angular momentum takes the power of internal friction. An evolution that ends otherwise is its own, with the share 1.
    ///
    /// # Errors
    /// - [`Error::Number`] for no members; those of [`Scene::solve`] and [`Scene::evolve`]; [`Error::NotAveraged`] if a member stays at the separatrix.
    pub fn through(&self, members: usize, seed: u64, stop: &AtomicBool) -> Result<Vec<(f64, Self)>, Error> {
        if members == 0 {
            return Err(Error::Number { argument: "members", index: None, value: 0.0, bound: "1 or more" });
        }
        let end = self.end();
        if end.reason != EndReason::Separatrix {
            return Ok(vec![(1.0, self.clone())]);
        }
        let (start, distance, wobble) = self.before(end.time)?;
        let origin = (seed as f64 * 0.618_033_988_749_894_9).fract();
        // The energy changes in steps of a wobble, so that starts at one time would not mix: they are spread over some wobbles.
        let earliest = start - (SPREAD * wobble).min((start - self.epoch()).abs()).copysign(end.time - start);
        let mut found: Vec<(ModeFamily, usize, Scene)> = Vec::new();
        for member in 0..members {
            let [first, second, third] = EVEN.map(|step| (origin + (member as f64 + 0.5) * step).fract());
            let from = start + third * (earliest - start);
            let scene = self.with_friction(&self.motion_at(from, [first, second])?)?;
            let (family, scene) = self.passed(scene, (end.time - from, distance, wobble), stop)?;
            match found.iter_mut().find(|one| one.0 == family) {
                Some(one) => one.1 += 1,
                None => found.push((family, 1, scene)),
            }
        }
        found.sort_by_key(|one| std::cmp::Reverse(one.1));
        let [first, last] = self.span();
        let evolved = |(_, count, scene): (ModeFamily, usize, Scene)| {
            let time = scene.state().epoch;
            let scene = self.scene().with_state(*scene.state());
            let span = if end.time < start { [first.min(time), time] } else { [time, last.max(time)] };
            let options = EvolveOptions::default().span(span[0], span[1]).average(self.average());
            let evolution = scene.evolve(options.tolerance(self.tolerance()).until(stop))?;
            Ok((count as f64 / members as f64, evolution))
        };
        found.into_iter().map(evolved).collect()
    }

    /// A time before the separatrix, 1 − ξ/ξ_sep there, and the period of the wobble.
    fn before(&self, end: f64) -> Result<(f64, f64, f64), Error> {
        let seen = |time: f64| {
            let state = self.at(&[time])?[0];
            Ok::<_, Error>((1.0 - state.excess / self.separatrix(), state.periods(Convention::ExtremalAxis).rotation))
        };
        // The period of the wobble changes slowly, with the logarithm of the distance.
        let (mut near, mut away) = (end, self.epoch());
        for _ in 0..60 {
            let middle = near + 0.5 * (away - near);
            let (distance, wobble) = seen(middle)?;
            if distance > LEAST && (end - middle).abs() > BEFORE * wobble { away = middle } else { near = middle }
        }
        let (distance, wobble) = seen(away)?;
        Ok((away, distance, wobble))
    }

    /// The scene of a member after it has passed the separatrix, by the full equations, and its mode and sense.
    fn passed(
        &self,
        mut scene: Scene,
        (whole, distance, wobble): (f64, f64, f64),
        stop: &AtomicBool,
    ) -> Result<(ModeFamily, Scene), Error> {
        let length = whole + wobble.copysign(whole);
        let (mut left, mut nearest) = (2.0 * length, 0.0);
        let tolerance = TOLERANCE.min(distance * 1e-2);
        for _ in 0..FURTHER {
            let epoch = scene.state().epoch;
            let until = epoch + left;
            let solved = scene.clone().method(Method::Integrated).tolerance(tolerance);
            let motion = solved.span(epoch.min(until), epoch.max(until)).solve_until(stop)?;
            scene = scene.with_state(*motion.scene_at(until)?.state());
            if let Some((family, part)) = family_of(&scene) {
                nearest = 1.0 - part;
                if nearest > AWAY * distance {
                    return Ok((family, scene));
                }
            }
            left = 0.5 * length;
        }
        let reason = "1 − ξ/ξ_sep of a member that stays at the separatrix: it";
        Err(Error::NotAveraged { reason, size: nearest, bound: AWAY * distance })
    }

    fn epoch(&self) -> f64 {
        self.scene().state().epoch
    }
}
