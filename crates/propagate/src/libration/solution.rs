//! The order that a tolerance needs. The estimate of each order that is tried costs no Fourier series ([`Convergence`]); the series of the order that is taken is inserted into
//! the equations of motion.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use andoyer_series::Error as SeriesError;
use andoyer_series::periodic::DrivenForm;

use super::convergence::Convergence;
use super::course::FourierMotion;
use super::form::{self, MOST_PRODUCTS};
use super::lock::Lock;
use super::residual::residual;
use crate::error::Error;
use crate::motion::plan::{bound_in_words, in_words};

/// Orders without a phase of the orbit, with one and with two.
const HIGHEST: [usize; 3] = [16, 12, 6];
/// The first order that is tried.
const FIRST: usize = 4;
/// Orders that can be asked for.
const ORDERS: RangeInclusive<usize> = 2..=16;
/// An amplitude \[rad\] that is blamed before a divisor.
const LARGE: f64 = 0.35;
/// An amplitude \[rad\] that is never blamed.
const SMALL: f64 = 0.05;
/// A divisor below this part of the smallest frequency is a resonance.
const NEAR: f64 = 0.1;
/// Beyond this residual \[rad\] the series is no motion: a body that left the resonance had one of 1.3 and an error of 1.8, where the orders differed by 0.01.
const LARGEST_RESIDUAL: f64 = 0.03;
/// Fractions of the tolerance for dropped terms: of the Fourier series that is inserted into the equations of motion, and of that of the result.
const DROPPED: [f64; 2] = [1e-3, 0.1];
/// Harmonics below this fraction of the tolerance are never formed.
const NEGLIGIBLE: f64 = 1e-7;
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
    /// Why no higher order was tried, if its cost is the reason.
    pub(crate) left_out: Option<String>,
}

/// What a libration is to meet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    pub(crate) tolerance: f64,
    /// The times before and after the epoch, in units of 1/n.
    pub(crate) reach: [f64; 2],
    /// A fixed order, or that which the tolerance needs.
    pub(crate) order: Option<usize>,
    /// Whether a motion that misses the tolerance is of no use.
    pub(crate) strict: bool,
}

impl Wanted {
    /// The longest time from the epoch.
    fn longest(&self) -> f64 {
        self.reach.into_iter().fold(0.0_f64, |most, time| most.max(time.abs()))
    }
}

/// The motion of a lock: the lowest order whose estimate meets the tolerance, or the order with the least estimate, or that which was asked for; or why there is none.
///
/// # Errors
/// [`Error::Stopped`]; otherwise the reason in words.
pub(crate) fn solved(lock: Lock, wanted: &Wanted, stop: &AtomicBool) -> Result<Result<Libration, String>, Error> {
    match climb(&lock, wanted, stop) {
        Ok(found) => Ok(found),
        Err(SeriesError::Interrupted { .. }) => Err(Error::Stopped),
        Err(error) => Ok(Err(format!("about the resonance {}, {error}", in_words(lock.shape.twice)))),
    }
}

fn climb(lock: &Lock, wanted: &Wanted, stop: &AtomicBool) -> Result<Result<Libration, String>, SeriesError> {
    if let Some(order) = wanted.order.filter(|order| !ORDERS.contains(order)) {
        return Ok(Err(format!("its order is from {} to {}, not {order}", ORDERS.start(), ORDERS.end())));
    }
    let longest = wanted.longest();
    let motion =
        |form: &DrivenForm, normal: &[f64]| FourierMotion::new(form, lock, normal, NEGLIGIBLE * wanted.tolerance);
    let limited = wanted.order.is_none();
    let mut form = match form::periodic(&lock.shape, wanted.tolerance, limited, stop) {
        Err(SeriesError::GridTooLarge { times, bound }) if limited => return Ok(Err(of_steps(times, bound))),
        form => form?,
    };
    let linear = motion(&form, &form.at(&lock.shape.driven(lock.start)).to_normal(&lock.state)?)?;
    // A libration in longitude is below a quarter turn.
    if linear.angle() > FRAC_PI_2 {
        return Ok(Err(limit(lock, &linear, &linear)));
    }
    let highest = wanted.order.unwrap_or(HIGHEST[lock.shape.rates().len()]);
    let (mut best, mut residual): (Option<(Arc<DrivenForm>, Convergence)>, Option<f64>) = (None, None);
    let (mut made, mut left_out) = (0.0, None);
    for order in (wanted.order.unwrap_or(FIRST)..=highest).step_by(2) {
        made += form::products(&lock.shape, order, form.grid().times());
        if limited && made > MOST_PRODUCTS {
            left_out = Some(of_order(order, made, &form));
            break;
        }
        form = match form::to_order(&form, &lock.shape, order, wanted.tolerance, stop) {
            Err(error) if best.is_none() || matches!(error, SeriesError::Interrupted { .. }) => return Err(error),
            Err(_) => break,
            Ok(form) => form,
        };
        let convergence = match Convergence::new(&form, lock, longest) {
            Err(SeriesError::NotFinite { .. }) => break,
            convergence => convergence?,
        };
        let mut stays = false;
        if convergence.error() <= wanted.tolerance
            && let Some(libration) = libration(&form, &convergence, lock, wanted)?
        {
            if libration.error <= wanted.tolerance {
                return Ok(Ok(libration));
            }
            stays = residual.is_some_and(|before| libration.residual >= before);
            residual = Some(libration.residual);
        }
        let ends = stays
            || convergence.is_over()
            || (wanted.strict && convergence.will_miss(highest - order, wanted.tolerance));
        if best.as_ref().is_none_or(|(_, best)| convergence.error().total_cmp(&best.error()).is_lt()) {
            best = Some((Arc::clone(&form), convergence));
        }
        // A further order takes some seconds.
        if ends {
            break;
        }
    }
    let Some((form, convergence)) = best else {
        return Ok(Err(left_out.unwrap_or_else(|| limit(lock, &linear, &linear))));
    };
    let error = convergence.error() + residual.unwrap_or(0.0);
    if !(wanted.strict || error > PI)
        && let Some(libration) = libration(&form, &convergence, lock, wanted)?.filter(|found| found.error < PI)
    {
        return Ok(Ok(Libration { left_out, ..libration }));
    }
    let limit = match left_out {
        Some(cost) => cost,
        None => limit(lock, &linear, &motion(&form, &convergence.normal)?),
    };
    Ok(Err(if error < PI { format!("its error bound is {}; {limit}", bound_in_words(error)) } else { limit }))
}

/// Why an order is not tried: the products of all orders up to it.
fn of_order(order: usize, products: f64, form: &DrivenForm) -> String {
    let times = form.grid().times();
    let what =
        format!("orders to {order} take about {products:.1e} products of terms ({times} times of the orbit's phases)");
    costly(&what, MOST_PRODUCTS, order)
}

/// Why no periodic motion is found: the cost of its steps.
fn of_steps(times: usize, bound: usize) -> String {
    let what = format!("the periodic motion takes steps at {times} times of the orbit's phases");
    costly(&what, bound as f64, FIRST)
}

/// A cost with the largest one that needs no order, and what to do.
fn costly(what: &str, bound: f64, order: usize) -> String {
    format!(
        "{what}, and at most {bound:.0e} are made unless order={order} asks for them; methods \"auto\" and \"integrated\" integrate over a span"
    )
}

/// The libration by a form; none where its series is no motion.
fn libration(
    form: &DrivenForm,
    convergence: &Convergence,
    lock: &Lock,
    wanted: &Wanted,
) -> Result<Option<Libration>, SeriesError> {
    let mut course = FourierMotion::new(form, lock, &convergence.normal, NEGLIGIBLE * wanted.tolerance)?;
    // What is dropped counts in the residual over the smallest divisor.
    let slowest = course.frequencies.iter().fold(1.0_f64, |least, rate| least.min(rate.abs()));
    let dropped = course.drop_below(DROPPED[0] * wanted.tolerance * slowest);
    let residual = residual(form, lock, &course, wanted.longest());
    if residual > LARGEST_RESIDUAL {
        return Ok(None);
    }
    let dropped = dropped + course.drop_below(DROPPED[1] * wanted.tolerance);
    let error = convergence.error() + residual + dropped + lock.others;
    Ok(Some(Libration { lock: lock.clone(), course, order: form.order(), error, residual, left_out: None }))
}

/// Why a series is not near the motion: the smallest divisor among low multiples, or the amplitude, or the span. `linear` is the motion of order 0.
pub(super) fn limit(lock: &Lock, linear: &FourierMotion, course: &FourierMotion) -> String {
    let slowest = linear.frequencies.iter().fold(1.0_f64, |least, rate| least.min(rate.abs()));
    let (multiples, divisor) = course.smallest_divisor(linear);
    if linear.angle() < SMALL && divisor >= NEAR * slowest {
        return "its series is not accurate enough over the span".to_owned();
    }
    if divisor < NEAR * slowest && linear.angle() < LARGE {
        return format!(
            "the multiples {multiples:?} of the proper frequencies and of the orbit's have the small divisor {divisor:.1e} n"
        );
    }
    // A linear motion with a large angle is none of the body.
    let amplitude = match linear.angle() {
        angle if angle > PI => "above half a turn".to_owned(),
        angle => format!("of {:.0} degrees", angle.to_degrees()),
    };
    let resonance = in_words(lock.shape.twice);
    format!("an amplitude {amplitude} is beyond the range of the series about the resonance {resonance}")
}
