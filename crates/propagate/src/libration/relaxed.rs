//! The state of a locked body: relaxed, on the periodic motion of its resonance, or with free librations of given amplitudes and phases.
//!
//! The periodic motion is the origin of the normal form. Free librations are normal variables U = √(2I) e^{iφ} whose actions and angles are changed until the terms of the three proper
//! modes are those that were asked for, by forms of rising order until two of them give the same state.

use std::sync::atomic::AtomicBool;

use andoyer_series::Error as SeriesError;
use andoyer_series::error::Short;
use andoyer_series::periodic::{DrivenForm, MOST_WORK};

use super::course::FourierMotion;
use super::form;
use super::lock::{LARGEST_ANGLE, Lock};
use super::solution::{FIRST, HIGHEST, Libration, refusal};
use crate::error::Error;
use crate::motion::plan::in_words;

/// The tolerance of the normal form \[rad\].
const TOLERANCE: f64 = 1e-12;
/// Of the amplitudes the part with which the steps to them begin.
const SMALL: f64 = 1e-6;
/// Most steps to the amplitudes.
const STEPS: usize = 30;
/// Two orders whose states differ by the first part of the largest amplitude give it; by more than the second, they are no series.
const SAME: [f64; 2] = [1e-10, 1e-2];

/// ψ, p_ψ − C W₃, θ, p_θ, φ, p_φ of the libration whose proper modes have these amplitudes and phases \[rad\] at the time of the lock, or why there is none.
///
/// # Errors
/// [`Error::Stopped`].
pub(crate) fn state(
    lock: &Lock,
    amplitudes: [f64; 3],
    phases: [f64; 3],
    stop: &AtomicBool,
) -> Result<Result<[f64; 6], String>, Error> {
    match of_forms(lock, amplitudes, phases, stop) {
        Ok(Some(variables)) => Ok(Ok(variables)),
        Ok(None) => {
            let [longitude, first, second] = amplitudes.map(|amplitude| Short::rounded(amplitude.to_degrees(), 2));
            let what = format!("amplitudes of {longitude}, {first} and {second} degrees");
            Ok(Err(format!(
                "{what} are beyond the range of the series about the resonance {}",
                in_words(lock.shape.twice)
            )))
        }
        Err(SeriesError::Interrupted { .. }) => Err(Error::Stopped),
        Err(error) => Ok(Err(refusal(lock, &error))),
    }
}

fn of_forms(
    lock: &Lock,
    amplitudes: [f64; 3],
    phases: [f64; 3],
    stop: &AtomicBool,
) -> Result<Option<[f64; 6]>, SeriesError> {
    let mut form = form::periodic(&lock.shape, TOLERANCE, MOST_WORK, stop)?;
    if amplitudes == [0.0; 3] {
        let state = form.at(&lock.shape.driven(lock.start)).from_normal(&[0.0; 6])?;
        return Ok(Some(std::array::from_fn(|slot| state[slot])));
    }
    let largest = amplitudes.into_iter().fold(0.0, f64::max);
    if largest > LARGEST_ANGLE {
        return Ok(None);
    }
    let (mut known, mut apart, mut work): (Option<[f64; 6]>, f64, f64) = (None, f64::INFINITY, 0.0);
    for order in (FIRST..=HIGHEST[lock.shape.rates().len()]).step_by(2) {
        work += form::work(&lock.shape, order, form.grid().times());
        if work > MOST_WORK {
            break;
        }
        form = form::to_order(&form, &lock.shape, order, TOLERANCE, stop)?;
        let Some(course) = course_of(&form, lock, amplitudes, phases)? else { continue };
        let [next, _] = course.at_even_times(0.0, 0.0, 1)[0];
        if let Some(before) = known.replace(next) {
            let further = before.iter().zip(next).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
            let diverges = further > apart;
            apart = further;
            if diverges || apart < SAME[0] * largest {
                break;
            }
        }
    }
    Ok(known.filter(|_| apart < SAME[1] * largest))
}

/// The series whose proper modes have these amplitudes and phases; none if the steps do not end.
fn course_of(
    form: &DrivenForm,
    lock: &Lock,
    amplitudes: [f64; 3],
    phases: [f64; 3],
) -> Result<Option<FourierMotion>, SeriesError> {
    // Small ones first: where the series is linear, they have the scale.
    let (mut sizes, mut angles) = (amplitudes.map(|amplitude| SMALL * amplitude), phases);
    for _ in 0..STEPS {
        let normal: Vec<f64> =
            sizes.iter().zip(angles).flat_map(|(r, angle)| [r * angle.sin(), r * angle.cos()]).collect();
        let course = match FourierMotion::new(form, lock, &normal, 0.0) {
            Err(SeriesError::NotFinite { .. }) => return Ok(None),
            course => course?,
        };
        let found = Libration::of(lock, course, form.order());
        let (seen, at) = (found.amplitudes(), found.phases());
        let mut worst = 0.0_f64;
        for mode in (0..3).filter(|&mode| amplitudes[mode] > 0.0) {
            // Where the mode has no term at all the series is none.
            if !(seen[mode] > 0.0 && seen[mode].is_finite()) {
                return Ok(None);
            }
            let (ratio, turn) = (amplitudes[mode] / seen[mode], phases[mode] - at[mode]);
            sizes[mode] *= ratio;
            angles[mode] += turn;
            worst = worst.max((ratio - 1.0).abs()).max(1.0 - turn.cos());
        }
        if worst < 1e-12 {
            return Ok(Some(found.course));
        }
    }
    Ok(None)
}
