//! The order that a tolerance needs, and the estimate of the error.
//!
//! Let d be the largest distance of the motions of the orders N and N − 2 at times over the span, and d′ that of the orders N − 2 and N − 4. d is the error of the
//! order N − 2, to the next order; the error of the order N is about d · d/d′. The estimate is a factor times this, and what was dropped, and rounding.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use andoyer_series::Error as SeriesError;
use andoyer_series::periodic::DrivenForm;

use super::course::FourierMotion;
use super::form::form;
use super::lock::Lock;
use super::residual::residual;
use crate::error::Error;
use crate::motion::plan::in_words;

/// Orders without a phase of the orbit, with one and with two.
const HIGHEST: [usize; 3] = [16, 12, 6];
/// Orders that can be asked for.
const ORDERS: RangeInclusive<usize> = 2..=16;
/// An amplitude \[rad\] that is blamed before a divisor.
const LARGE: f64 = 0.35;
/// A divisor below this part of the smallest frequency is a resonance.
const NEAR: f64 = 0.1;
/// The estimate over the error that three orders in geometric progression predict.
const SAFETY: f64 = 12.0;
/// Beyond this residual \[rad\] the series is no motion: a body that left the resonance had one of 1.3 and an error of 1.8, where the orders differed by 0.01.
const LARGEST_RESIDUAL: f64 = 0.03;
/// Times over the span at which motions are compared.
const TIMES: usize = 24;
/// Rounding of the coefficients and of the evaluation, relative to the angles.
const ROUNDING: f64 = 4e-15;
/// The relative rounding of the frequencies.
const FREQUENCIES: f64 = 1e-15;
/// Fractions of the tolerance for dropped terms: of the Fourier series of each order, and of that of the result.
const DROPPED: [f64; 2] = [1e-3, 0.1];
/// Harmonics below this fraction of the tolerance are never formed.
const NEGLIGIBLE: f64 = 1e-7;
/// No further order is tried after one with so many harmonics: it would take some seconds.
const MOST_HARMONICS: usize = 6000;
/// The libration of a body locked to an orbit: its proper modes and its terms, in the frame that turns with the resonance.
#[derive(Clone, Debug)]
pub struct Libration {
    pub(super) lock: Lock,
    pub(super) course: FourierMotion,
    pub(super) order: usize,
    /// The estimate of the error of the attitude over the span \[rad\].
    pub(super) error: f64,
    /// What the series leaves in the equations of motion, as an angle \[rad\].
    pub(super) residual: f64,
}

/// One order: its normal form, its motion, and the distance from that two orders below.
struct Rung {
    form: Arc<DrivenForm>,
    /// Without harmonics that count for nothing.
    course: FourierMotion,
    /// The sum of those, and the number of all.
    dropped: f64,
    harmonics: usize,
    order: usize,
    distance: f64,
}

/// What a libration is to meet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    pub(crate) tolerance: f64,
    /// The times before and after the epoch, in units of 1/n.
    pub(crate) reach: [f64; 2],
    /// A fixed order, or that which the tolerance needs.
    pub(crate) order: Option<usize>,
}

/// The motion of a lock: the lowest order whose estimate meets the tolerance, or the order with the least estimate, or that which was asked for; or why there is none.
///
/// # Errors
/// [`Error::Stopped`]; otherwise the reason in words.
pub(crate) fn solved(lock: Lock, wanted: &Wanted, stop: &AtomicBool) -> Result<Result<Libration, String>, Error> {
    if let Some(order) = wanted.order.filter(|order| !ORDERS.contains(order)) {
        return Ok(Err(format!("its order is from {} to {}, not {order}", ORDERS.start(), ORDERS.end())));
    }
    let highest = wanted.order.unwrap_or(HIGHEST[lock.shape.rates().len()]);
    let (mut rungs, mut best): (Vec<Rung>, Option<Libration>) = (Vec::new(), None);
    for order in (highest % 2..=highest).step_by(2) {
        let known = rungs.last().map(|rung| &*rung.form);
        let made = form(&lock.shape, order, wanted.tolerance, known, stop)
            .and_then(|form| Ok((FourierMotion::new(&form, &lock, NEGLIGIBLE * wanted.tolerance)?, form)));
        let (mut course, form) = match made {
            Err(SeriesError::Interrupted { .. }) => return Err(Error::Stopped),
            Err(error)
                if (rungs.len() < 3 || wanted.order.is_some()) && !matches!(error, SeriesError::NotFinite { .. }) =>
            {
                return Ok(Err(error.to_string()));
            }
            Err(_) => break,
            Ok(made) => made,
        };
        // A libration in longitude is below a quarter turn.
        if rungs.is_empty() && course.angle() > FRAC_PI_2 {
            return Ok(Err(limit(&lock, &course, &course)));
        }
        let harmonics = course.harmonics.len();
        // What is dropped counts in the residual over the smallest divisor.
        let slowest = course.frequencies.iter().fold(1.0_f64, |least, rate| least.min(rate.abs()));
        let dropped = course.drop_below(DROPPED[0] * wanted.tolerance * slowest);
        let distance = rungs.last().map_or(f64::INFINITY, |last| distance(&course, &last.course, wanted.reach));
        rungs.push(Rung { form, course, dropped, harmonics, order, distance });
        let many = rungs.last().is_some_and(|last| last.harmonics > MOST_HARMONICS);
        if wanted.order.map_or(rungs.len() < 3, |asked| order < asked) {
            continue;
        }
        let next = candidate(&rungs, &lock, wanted);
        // Where two orders are not nearer to each other than the two before, a further one takes some seconds and is no better.
        let diverges = next.is_none() && matches!(&rungs[..], [.., last, next] if next.distance >= last.distance);
        let error = best.as_ref().map_or(f64::INFINITY, |best| best.error);
        best = next.filter(|next| next.error < error).or(best);
        if many || diverges || best.as_ref().is_some_and(|best| best.error <= wanted.tolerance) {
            break;
        }
    }
    let why = || match &rungs[..] {
        [first, .., last] => limit(&lock, &first.course, &last.course),
        _ => "no order converges".to_owned(),
    };
    Ok(best.filter(|best| best.error < PI).ok_or_else(why))
}

/// The libration by the last order; none without an estimate.
fn candidate(rungs: &[Rung], lock: &Lock, wanted: &Wanted) -> Option<Libration> {
    let (estimate, last) = (estimate(rungs, wanted.reach)?, rungs.last()?);
    let residual = residual(&last.form, lock, &last.course);
    if residual > LARGEST_RESIDUAL {
        return None;
    }
    let mut course = last.course.clone();
    let dropped = last.dropped + course.drop_below(DROPPED[1] * wanted.tolerance);
    let error = estimate.max(residual) + dropped + lock.others;
    Some(Libration { lock: lock.clone(), course, order: last.order, error, residual })
}

/// Why a series is not near the motion: the smallest divisor among low multiples, or the amplitude. `linear` is the motion of order 0.
pub(super) fn limit(lock: &Lock, linear: &FourierMotion, course: &FourierMotion) -> String {
    let slowest = linear.frequencies.iter().fold(1.0_f64, |least, rate| least.min(rate.abs()));
    let (multiples, divisor) = course.smallest_divisor(linear);
    if divisor < NEAR * slowest && linear.angle() < LARGE {
        return format!(
            "the multiples {multiples:?} of the proper frequencies and of the orbit's have the small divisor {divisor:.1e} n"
        );
    }
    let (degrees, resonance) = (linear.angle().to_degrees(), in_words(lock.shape.twice));
    format!("an amplitude of {degrees:.0} degrees is beyond the range of the series about the resonance {resonance}")
}

/// The largest distance of two motions over a span.
fn distance(one: &FourierMotion, two: &FourierMotion, [before, after]: [f64; 2]) -> f64 {
    let time = |k: usize| before + (after - before) * (k as f64 / TIMES as f64);
    (0..=TIMES).map(|k| one.distance(two, time(k))).fold(0.0, f64::max)
}

/// The estimate of the error of the last of two orders or more. The first order has no distance from one below.
fn estimate(rungs: &[Rung], [before, after]: [f64; 2]) -> Option<f64> {
    let [.., second, last] = rungs else { return None };
    let ratio = if second.distance.is_finite() { (last.distance / second.distance).min(1.0) } else { 1.0 };
    let longest = before.abs().max(after.abs());
    let amplitude = last.course.amplitude();
    let fastest = last.course.frequencies.iter().fold(1.0_f64, |most, rate| most.max(rate.abs()));
    let rounding = ROUNDING * (1.0 + amplitude) + FREQUENCIES * fastest * longest * amplitude;
    Some(SAFETY * (last.distance * ratio + last.course.missed) + rounding)
}
