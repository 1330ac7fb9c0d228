//! Integrations of several motions at once, in lanes.
//!
//! A motion enters a lane when another has left it, so that no lane is idle before the last ones. Each lane has steps of its own. Displaced states of a motion have four
//! lanes and the same steps. What the lanes do not serve is integrated alone: tables, hyperbolas, orbits that precess, several bodies or none, other torques, more than 2^15 steps, and all motions
//! on a machine without fused multiply-add.

use std::sync::atomic::AtomicBool;

use andoyer_series::threads::map;
use pulp::Arch;

use super::bound::{MeasuredSteps, Profile};
use super::integrated::{Integrated, MeasuredMotion, Problem};
use super::lane_tasks::{
    LaneProblem, MeasuredInLanes, MeasuredSide, MeasuredSides, SidesInLanes, StepsInLanes, lane_precision,
};
use crate::error::Error;
use crate::input::options::Served;
use crate::input::scene::Scene;
use crate::simd::instruction_set::dispatch;

/// The motions of scenes about principal axes over their spans, each as [`Integrated::new`] has it but for rounding and the lengths of steps. A motion does not depend on the
/// others. A scene comes with the reason why it is integrated.
pub(crate) fn several(scenes: &[(&Scene, &str)], served: Served, stop: &AtomicBool) -> Vec<Result<Integrated, Error>> {
    let problems: Vec<_> = scenes.iter().map(|(scene, reason)| Problem::new(scene, reason)).collect();
    let in_lanes: Vec<_> = problems.iter().map(|problem| problem.as_ref().ok().and_then(LaneProblem::new)).collect();
    let first = measured(&in_lanes, stop);
    // Those that miss the tolerance, with shorter steps.
    let finer = in_lanes.iter().zip(&first).map(|(lane, first)| {
        let (lane, Ok(first)) = (lane.as_ref()?, first.as_ref()?) else { return None };
        lane.problem.second_error(first).map(|error| LaneProblem { precision: lane_precision(error), ..*lane })
    });
    let second = measured(&finer.collect::<Vec<_>>(), stop);
    let finished = |(index, (first, second)): (usize, (Found, Found))| {
        let (scene, reason) = scenes[index];
        let (Ok(problem), Some(first)) = (&problems[index], first) else {
            return Integrated::served(scene, reason, served, stop);
        };
        let better = |first: MeasuredMotion| match second {
            Some(second) => Ok(first.or_better(second?)),
            None => problem.repeated(first, stop),
        };
        Integrated::of(problem, scene, Result::and_then(first, better), (served, stop))
    };
    map(first.into_iter().zip(second).enumerate().collect(), finished)
}

/// A motion, if the lanes serve it.
type Found = Option<Result<MeasuredMotion, Error>>;

/// The motions that the lanes serve, with their error bounds.
fn measured(served: &[Option<LaneProblem<'_>>], stop: &AtomicBool) -> Vec<Found> {
    let mut found = in_lanes(&served.iter().flatten().copied().collect::<Vec<_>>(), stop).into_iter();
    let found = served.iter().map(|served| served.and_then(|served| Some((served, found.next()??))));
    map(found.collect(), |found: Option<(LaneProblem<'_>, MeasuredSides)>| {
        found.map(|(served, sides)| served.measured(sides, stop))
    })
}

/// Indices of items that have the same order: these fill lanes together, so that no item depends on the others.
fn by_order<T>(items: &[T], order: impl Fn(&T) -> usize) -> Vec<Vec<usize>> {
    let mut all: Vec<usize> = (0..items.len()).collect();
    all.sort_by_key(|index| order(&items[*index]));
    all.chunk_by(|one, other| order(&items[*one]) == order(&items[*other])).map(<[usize]>::to_vec).collect()
}

/// The motions with their error bounds, `None` for one that is integrated alone.
fn in_lanes(problems: &[LaneProblem<'_>], stop: &AtomicBool) -> Vec<Option<MeasuredSides>> {
    let mut kept: SidesInLanes = problems.iter().map(|_| [None, None]).collect();
    for members in by_order(problems, |served| served.precision.order) {
        let problems: Vec<_> = members.iter().map(|member| problems[*member]).collect();
        let found = dispatch(Arch::new(), StepsInLanes { problems: &problems, stop });
        members.into_iter().zip(found).for_each(|(member, sides)| kept[member] = sides);
    }
    let kept: Vec<_> = kept.into_iter().map(|[before, after]| Some([before?, after?])).collect();
    let mut profiles: Vec<[Option<Profile>; 2]> = kept.iter().map(|_| [None, None]).collect();
    let (mut enlarged, mut exact) = (Vec::new(), Vec::new());
    for (member, (served, sides)) in problems.iter().zip(&kept).enumerate() {
        for (side, (kept, errors)) in sides.iter().flatten().enumerate() {
            let steps = served.problem.enlarged(&kept.steps, errors, side == 0, stop);
            let steps = MeasuredSteps { precision: steps.precision.of_even_order(), ..steps };
            let task = MeasuredSide { member, side, served: *served, steps };
            if kept.steps.len() <= 1 {
                profiles[member][side] = Some(Profile::new());
            } else if steps.precision.order < served.precision.order {
                enlarged.push(task);
            } else {
                exact.push(task.exact());
            }
        }
    }
    // Where enlarged displacements grow too far, those of the size of the errors count.
    exact.extend(profiles_in_lanes(&enlarged, &mut profiles, stop).into_iter().map(MeasuredSide::exact));
    profiles_in_lanes(&exact, &mut profiles, stop);
    kept.into_iter().zip(profiles).map(|(sides, profiles)| Some((sides?, profiles))).collect()
}

/// Fills in the profiles of error bounds. Returns the sides that have none.
fn profiles_in_lanes<'a>(
    all: &[MeasuredSide<'a>],
    profiles: &mut [[Option<Profile>; 2]],
    stop: &AtomicBool,
) -> Vec<MeasuredSide<'a>> {
    for group in by_order(all, |side| side.steps.precision.order) {
        let sides: Vec<_> = group.iter().map(|index| all[*index]).collect();
        for (side, profile) in sides.iter().zip(dispatch(Arch::new(), MeasuredInLanes { sides: &sides, stop })) {
            profiles[side.member][side.side] = profile;
        }
    }
    all.iter().filter(|side| profiles[side.member][side.side].is_none()).copied().collect()
}
