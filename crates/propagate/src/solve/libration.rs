//! The motion by the normal form about a spin–orbit resonance.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use andoyer_double::two_sum;
use nalgebra::{Quaternion, UnitQuaternion};

use super::free::{self, Preparation};
use crate::error::Error;
use crate::input::options::{Method, Served};
use crate::input::scene::Scene;
use crate::integration::dense::Cursor;
use crate::integration::integrated::Integrated;
use crate::integration::prospect::verification_cost;
use crate::libration::evaluate::LibrationEvaluator;
use crate::libration::lock::Lock;
use crate::libration::solution::{self, Wanted};
use crate::motion::plan::{Plan, bound_in_words, in_ascii};
use crate::motion::solved::Motion;
use crate::motion::trajectory::Trajectory;
use crate::torque_free::error_budget::DEFAULT_ROTATIONS;
use crate::torque_free::polhode::Polhode;

/// Orbits over which a motion is compared with an integration, at most the span. The first number is for motions on a fixed orbit that meet their tolerance. The second is for all
/// others: the slow phases of a precessing orbit take hundreds of orbits, and a series that misses its tolerance can lack the terms of a resonance, which its estimate does not see.
const CHECKED: [f64; 2] = [30.0, 1000.0];
/// Times at which they are compared.
const TIMES: usize = 64;
/// error bound = `SAFETY` · largest difference · (span / compared span).
const SAFETY: f64 = 2.0;
/// The least tolerance of this integration \[rad\].
const FINEST: f64 = 1e-12;

/// The libration of a scene about principal axes.
///
/// # Errors
/// [`Error::NoLibration`] with the reason, and [`Error::Stopped`].
pub(super) fn motion(scene: Scene, stop: &AtomicBool) -> Result<Motion, Error> {
    let lock = Lock::new(&scene).map_err(|reason| Error::NoLibration { reason })?;
    of_lock(scene, lock, stop)
}

/// The libration of a scene with its lock. Mode and frequencies are those of the free motion at the epoch.
fn of_lock(scene: Scene, lock: Lock, stop: &AtomicBool) -> Result<Motion, Error> {
    let no = |reason| Error::NoLibration { reason };
    let (n, epoch, precesses) = (lock.mean_motion, scene.state().epoch, lock.half_node.is_some());
    let far = DEFAULT_ROTATIONS * TAU;
    let reach = scene.asked_span().map_or([-far, far], |(start, stop)| [start, stop].map(|time| n * (time - epoch)));
    // Of "auto" the order is that of a series.
    let strict = scene.asked_method() != Method::Libration;
    let order = scene.asked_order().filter(|_| !strict);
    let wanted = Wanted { tolerance: scene.asked_tolerance(), reach, order, strict };
    let libration = solution::solved(lock, &wanted, stop)?.map_err(no)?;
    let unforced = Scene::new(scene.body().clone(), *scene.state());
    let polhode = Polhode::new(unforced.body(), unforced.state());
    let free = free::motion(unforced, polhode.as_ref(), Preparation::default())?;
    let mut plan = Plan::new(&scene, free.plan.mode, free.plan.separatrix_ratio, libration.error());
    plan.verification = verification_cost(&scene);
    plan.method = Method::Libration;
    plan.order = libration.order();
    plan.harmonics = libration.harmonics();
    plan.resonance = Some(libration.twice());
    plan.skipped.extend(libration.left_out.clone());
    let trajectory = Trajectory::Forced(Arc::new(LibrationEvaluator::new(libration)));
    let mut motion = Motion { scene, plan, trajectory, ..free };
    motion.plan.error_bound = checked(&motion, n, reach, precesses, stop)?;
    Ok(motion)
}

/// The error bound of a libration after a comparison with an integration from the epoch to the farther end of the span, or over as many orbits as are compared.
///
/// A bound that is refuted becomes what was seen, times [`SAFETY`] and the growth over the span. The same holds for a bound above the tolerance where the whole span was compared,
/// which lies on one side of the epoch, and the result is smaller. The integration's own bound is computed only in these cases. `before` and `after` are the ends of the span from
/// the epoch, in units of 1/n.
fn checked(
    motion: &Motion,
    mean_motion: f64,
    [before, after]: [f64; 2],
    precesses: bool,
    stop: &AtomicBool,
) -> Result<f64, Error> {
    let farthest = if -before > after { before } else { after };
    let (epoch, bound) = (motion.scene.state().epoch, motion.plan.error_bound);
    let misses = !motion.plan.meets_tolerance();
    let orbits = CHECKED[usize::from(precesses || misses)];
    let growth = (farthest.abs() / (orbits * TAU)).max(1.0);
    let time = farthest / growth / mean_motion;
    let tolerance = (bound.min(motion.scene.asked_tolerance()) / 10.0).max(FINEST);
    let compared = motion.scene.clone().span(epoch + time.min(0.0), epoch + time.max(0.0)).tolerance(tolerance);
    let elapsed: [f64; TIMES] = std::array::from_fn(|k| time * ((k + 1) as f64 / TIMES as f64));
    let mut attitudes = [[0.0; 4]; TIMES];
    motion.attitudes_into(&elapsed.map(|time| epoch + time), &mut attitudes)?;
    let departure = |integration: &Integrated| {
        let mut cursor = Cursor::new(integration);
        let apart = |(time, attitude): (&f64, &[f64; 4])| {
            let integrated = cursor.at(two_sum(epoch + time, -epoch)).0;
            rotation(*attitude).angle_to(&rotation(integrated))
        };
        elapsed.iter().zip(&attitudes).map(apart).fold(0.0, f64::max)
    };
    let is_measured = misses && growth == 1.0 && (before >= 0.0 || after <= 0.0);
    if !is_measured && departure(&Integrated::unmeasured(&compared, stop)?) <= bound {
        return Ok(bound);
    }
    let integration = Integrated::new(&compared, "", (Served::WholeSpan, stop))?;
    let seen = departure(&integration);
    let measured = (SAFETY * seen * growth + integration.error).min(PI);
    Ok(match seen - integration.error > bound {
        true => measured,
        false if is_measured => bound.min(measured),
        false => bound,
    })
}

fn rotation(attitude: [f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::from(attitude))
}

/// The libration of a scene if it meets the tolerance, or why not, where a body is near a resonance.
///
/// # Errors
/// [`Error::Stopped`].
pub(super) fn serving(scene: &Scene, stop: &AtomicBool) -> Result<Result<Motion, Option<String>>, Error> {
    let Ok(lock) = Lock::new(scene) else { return Ok(Err(None)) };
    let why = |motion: &Motion| {
        let bound = bound_in_words(motion.plan.error_bound);
        motion.libration().map(|libration| format!("its error bound is {bound}; {}", libration.limit()))
    };
    Ok(match of_lock(scene.clone(), lock, stop) {
        Err(Error::Stopped) => return Err(Error::Stopped),
        Err(Error::NoLibration { reason }) => Err(Some(reason)),
        Err(error) => Err(Some(in_ascii(&error.to_string()))),
        Ok(motion) if motion.plan.meets_tolerance() => Ok(motion),
        Ok(motion) => Err(why(&motion)),
    })
}
