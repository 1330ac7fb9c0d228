//! The order that a tolerance needs. The estimate of each order that is tried costs no Fourier series ([`Convergence`]); the series of the order that is taken is inserted into
//! the equations of motion.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use andoyer_series::Error as SeriesError;
use andoyer_series::error::Short;
use andoyer_series::periodic::{DrivenForm, MOST_WORK};

use super::convergence::Convergence;
use super::course::FourierMotion;
use super::form;
use super::lock::Lock;
use super::residual::residual;
use crate::error::Error;
use crate::motion::plan::{bound_in_words, in_words};

/// Orders without a phase of the orbit, with one and with two.
pub(super) const HIGHEST: [usize; 3] = [16, 12, 6];
/// The first order that is tried.
pub(super) const FIRST: usize = 4;
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
/// A multiplier of a stable motion exceeds 1 by less.
const STABLE: f64 = 1e-6;
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

    /// The most work of the periodic motion and all forms, in multiplications of two floats. An order that somebody asks for has no limit.
    fn most_work(&self) -> f64 {
        if self.order.is_some() { f64::INFINITY } else { MOST_WORK }
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
        Err(error) => Ok(Err(refusal(&lock, &error))),
    }
}

/// Why a resonance has no form. Multipliers off the unit circle are said in words: those of the longitude come first, unless the plane of the orbit moves and couples it to the pole.
pub(super) fn refusal(lock: &Lock, error: &SeriesError) -> String {
    let about = in_words(lock.shape.twice);
    let largest = |of: &[[f64; 2]]| of.iter().map(|[re, im]| re.hypot(*im)).fold(1.0, f64::max);
    let stable = |of: &[[f64; 2]]| largest(of) < 1.0 + STABLE;
    let multipliers = match error {
        SeriesError::MultiplierUnsupported { multipliers, .. } if multipliers.len() == 6 && !stable(multipliers) => {
            multipliers
        }
        _ => return format!("about the resonance {about}, {error}"),
    };
    let how = match (lock.shape.is_tilted(), stable(&multipliers[..2]), stable(&multipliers[2..])) {
        (true, ..) => "unstable",
        (false, true, _) => "stable in the orbit's plane, unstable out of it",
        (false, _, true) => "unstable in the orbit's plane, stable out of it",
        _ => "unstable in the orbit's plane and out of it",
    };
    let time = lock.shape.period() / largest(multipliers).ln();
    let (orbits, time) = (Short::rounded(time / TAU, 3), Short::rounded(time / lock.mean_motion, 3));
    format!(
        "the resonance {about} is {how}: a small angle grows by a factor e in {time} units of time ({orbits} orbits)"
    )
}

fn climb(lock: &Lock, wanted: &Wanted, stop: &AtomicBool) -> Result<Result<Libration, String>, SeriesError> {
    if let Some(order) = wanted.order.filter(|order| !ORDERS.contains(order)) {
        return Ok(Err(format!("its order is from {} to {}, not {order}", ORDERS.start(), ORDERS.end())));
    }
    let form = match form::periodic(&lock.shape, wanted.tolerance, wanted.most_work(), stop) {
        Err(SeriesError::DrivenWorkTooLarge { times, .. }) => return Ok(Err(of_periodic_motion(times))),
        form => form?,
    };
    let mut climb = Climb { lock, wanted, best: None, residual: None, left_out: None };
    let linear = climb.motion(&form, &form.at(&lock.shape.driven(lock.start)).to_normal(&lock.state)?)?;
    // A libration in longitude is below a quarter turn.
    if linear.angle() > FRAC_PI_2 {
        return Ok(Err(limit(lock, &linear, &linear)));
    }
    match climb.lowest(form, stop)? {
        Some(libration) => Ok(Ok(libration)),
        None => climb.best(&linear),
    }
}

/// The orders of a lock, tried one after another.
struct Climb<'a> {
    lock: &'a Lock,
    wanted: &'a Wanted,
    /// The form with the least estimate.
    best: Option<(Arc<DrivenForm>, Convergence)>,
    /// The residual of the last series that was inserted into the equations of motion.
    residual: Option<f64>,
    /// Why no higher order is tried, if its cost is the reason.
    left_out: Option<String>,
}

impl Libration {
    /// The libration of a Fourier series, without an estimate of its error.
    pub(super) fn of(lock: &Lock, course: FourierMotion, order: usize) -> Self {
        Self { lock: lock.clone(), course, order, error: 0.0, residual: 0.0, left_out: None }
    }
}

impl Climb<'_> {
    /// The series of a state by a form.
    fn motion(&self, form: &DrivenForm, normal: &[f64]) -> Result<FourierMotion, SeriesError> {
        FourierMotion::new(form, self.lock, normal, NEGLIGIBLE * self.wanted.tolerance)
    }

    /// The motion of the lowest order that meets the tolerance, if one does. `form` is that of order 0.
    fn lowest(&mut self, mut form: Arc<DrivenForm>, stop: &AtomicBool) -> Result<Option<Libration>, SeriesError> {
        let Self { lock, wanted, .. } = *self;
        let highest = wanted.order.unwrap_or(HIGHEST[lock.shape.rates().len()]);
        let mut work = form.work();
        for order in (wanted.order.unwrap_or(FIRST)..=highest).step_by(2) {
            work += form::work(&lock.shape, order, form.grid().times());
            if work > wanted.most_work() {
                self.left_out = Some(of_order(order, work, &form));
                break;
            }
            form = match form::to_order(&form, &lock.shape, order, wanted.tolerance, stop) {
                Err(error) if self.best.is_none() || matches!(error, SeriesError::Interrupted { .. }) => {
                    return Err(error);
                }
                Err(_) => break,
                Ok(form) => form,
            };
            let convergence = match Convergence::new(&form, lock, wanted.longest()) {
                Err(SeriesError::NotFinite { .. }) => break,
                convergence => convergence?,
            };
            let mut stays = false;
            if convergence.error() <= wanted.tolerance
                && let Some(libration) = libration(&form, &convergence, lock, wanted)?
            {
                if libration.error <= wanted.tolerance {
                    return Ok(Some(libration));
                }
                stays = self.residual.is_some_and(|before| libration.residual >= before);
                self.residual = Some(libration.residual);
            }
            let misses = wanted.strict && convergence.will_miss(highest - order, wanted.tolerance);
            let ends = stays || convergence.is_over() || misses;
            if self.best.as_ref().is_none_or(|(_, best)| convergence.error().total_cmp(&best.error()).is_lt()) {
                self.best = Some((Arc::clone(&form), convergence));
            }
            if ends {
                break;
            }
        }
        Ok(None)
    }

    /// The motion of the order with the least estimate, or why there is none. `linear` is the motion of order 0.
    fn best(self, linear: &FourierMotion) -> Result<Result<Libration, String>, SeriesError> {
        let Self { lock, wanted, .. } = self;
        let Some((form, convergence)) = &self.best else {
            return Ok(Err(self.left_out.unwrap_or_else(|| limit(lock, linear, linear))));
        };
        let error = convergence.error() + self.residual.unwrap_or(0.0);
        if !(wanted.strict || error > PI)
            && let Some(libration) = libration(form, convergence, lock, wanted)?.filter(|found| found.error < PI)
        {
            return Ok(Ok(Libration { left_out: self.left_out, ..libration }));
        }
        let limit = match &self.left_out {
            Some(cost) => cost.clone(),
            None => limit(lock, linear, &self.motion(form, &convergence.normal)?),
        };
        Ok(Err(if error < PI { format!("its error bound is {}; {limit}", bound_in_words(error)) } else { limit }))
    }
}

/// Why an order is not tried: the work of the periodic motion and of all orders up to it.
fn of_order(order: usize, work: f64, form: &DrivenForm) -> String {
    let times = form.grid().times();
    let what = format!("orders to {order} take about {work:.1e} multiplications ({times} times of the orbit's phases)");
    costly(&what, order)
}

/// Why no periodic motion is found: the work of its search.
fn of_periodic_motion(times: usize) -> String {
    costly(&format!("the periodic motion takes more multiplications ({times} times of the orbit's phases)"), FIRST)
}

/// A cost with the largest one that needs no order, and what to do.
fn costly(what: &str, order: usize) -> String {
    format!(
        "{what}, and at most {MOST_WORK:.0e} are made unless order={order} asks for them; methods \"auto\" and \"integrated\" integrate over a span"
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
    Ok(Some(Libration { error, residual, ..Libration::of(lock, course, form.order()) }))
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
