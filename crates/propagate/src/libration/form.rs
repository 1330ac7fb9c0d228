//! Normal forms about a resonance, kept for the next scene of the same body and orbit, and what they cost.
//!
//! The work of a form is known before it is made: that of the search for the periodic motion, and that of products of two terms, at each time of the grid of the driven phases. Two
//! polynomials in six variables whose degrees together are N + 2 at most have C(N + 14, 12) of them, and a form of order N takes as long as some such multiplications.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

use andoyer_series::Error;
use andoyer_series::birkhoff::Mode;
use andoyer_series::periodic::{DrivenForm, DrivenOptions};

use super::shape::{LockedShape, PlaneMotion};
use crate::numerics::kept::{Goes, Keep, Kept};

/// Divisors below this part of the largest frequency end a normal form: the estimate refuses larger ones that are too small.
const SMALLEST_DIVISOR: f64 = 1e-9;
/// Most harmonics of a phase.
const HARMONICS: usize = 252;
/// The last harmonics of the periodic motion and of its frame are at most this fraction of the tolerance, and not below the second number, which rounding reaches.
const TAIL: [f64; 2] = [1e-4, 1e-13];

/// The largest memory of the forms that a process keeps \[bytes\].
const MOST_MEMORY: usize = 256 << 20;
/// The forms of this process, by what they depend on, as bits.
static FORMS: LazyLock<Kept<Vec<u64>, DrivenForm>> = LazyLock::new(|| Kept::new(MOST_MEMORY, Goes::Oldest));

/// The work of a product of terms at a time of the grid, in multiplications of two floats.
const PRODUCT: f64 = 33.0;
/// A product of terms costs as much as so many more times of the grid.
const TERM: usize = 16;

/// The work of a form of an order on a grid of so many times, in multiplications of two floats, without that of the periodic motion.
pub(super) fn work(shape: &LockedShape, order: usize, times: usize) -> f64 {
    let all = (1..=12).fold(1.0, |product, k| product * (order as f64 + 2.0 + f64::from(k)) / f64::from(k));
    // In the plane of the orbit H is even in the four variables of the pole: each factor has half of the terms.
    let part = if shape.is_tilted() { 1.0 } else { 0.25 };
    PRODUCT * all * part * (times + TERM) as f64
}

/// The periodic motion of a shape: its normal form of order 0, which takes a work of `most` at most.
///
/// # Errors
/// Those of [`form`]; [`Error::DrivenWorkTooLarge`].
pub(super) fn periodic(
    shape: &LockedShape,
    tolerance: f64,
    most: f64,
    stop: &AtomicBool,
) -> Result<Arc<DrivenForm>, Error> {
    let form = form(shape, 0, (tolerance, most), None, stop)?;
    // A motion that the limit refuses is refused although another scene, without the limit, has kept it.
    if form.work() > most {
        return Err(Error::DrivenWorkTooLarge { times: form.grid().times(), work: most });
    }
    Ok(form)
}

/// The normal form of another order about the periodic motion of a form.
///
/// # Errors
/// Those of [`form`].
pub(super) fn to_order(
    known: &DrivenForm,
    shape: &LockedShape,
    order: usize,
    tolerance: f64,
    stop: &AtomicBool,
) -> Result<Arc<DrivenForm>, Error> {
    form(shape, order, (tolerance, f64::INFINITY), Some(known), stop)
}

/// The normal form of a shape for a tolerance \[rad\], with the most work of its search, kept for the next scene. `known` is one of another order for the same shape and tolerance: the periodic motion is the same.
///
/// # Errors
/// Those of [`DrivenForm::new`]; [`Error::Interrupted`] when the flag is set.
fn form(
    shape: &LockedShape,
    order: usize,
    (tolerance, most): (f64, f64),
    known: Option<&DrivenForm>,
    stop: &AtomicBool,
) -> Result<Arc<DrivenForm>, Error> {
    // A power of two, so that similar tolerances share a form.
    let tail = (TAIL[0] * tolerance).max(TAIL[1]).log2().floor();
    let [a, b, _] = shape.moments;
    let PlaneMotion { phase_rate, spin, sideways, obliquity, argument } = shape.precession;
    let numbers = [a, b, shape.eccentricity, shape.attraction, phase_rate, spin, sideways, obliquity];
    let mut key: Vec<u64> = numbers.map(f64::to_bits).into();
    // A number that no argument has.
    key.push(argument.unwrap_or(f64::NAN).to_bits());
    key.extend([i64::from(shape.twice), order as i64, tail as i64].map(i64::cast_unsigned));
    let mut going = |_: usize, _: usize| match stop.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let options = DrivenOptions {
        order,
        tolerance: tail.exp2(),
        harmonics: HARMONICS,
        smallest_divisor: SMALLEST_DIVISOR,
        work: most,
    };
    let make = || {
        let form = match known {
            Some(known) => known.to_order(shape, order, &mut going)?,
            None => DrivenForm::new(shape, &shape.rates(), options, &mut going)?,
        };
        if !form.modes().iter().any(|mode| matches!(mode, Mode::Hyperbolic { .. })) {
            return Ok(form);
        }
        let pair = |mode: &Mode<f64>| match mode {
            Mode::Hyperbolic { rate } => [[(rate * shape.period()).exp(), 0.0], [(-rate * shape.period()).exp(), 0.0]],
            Mode::Elliptic { frequency, .. } | Mode::Complex { frequency, .. } => {
                let (sine, cosine) = (frequency * shape.period()).sin_cos();
                [[cosine, sine], [cosine, -sine]]
            }
            _ => [[f64::NAN; 2]; 2],
        };
        let multipliers = form.modes().iter().flat_map(pair).collect();
        Err(Error::MultiplierUnsupported { multipliers, problem: "grow in each period: the motion is unstable" })
    };
    FORMS.of(key, |_| true, make)
}

impl Keep for DrivenForm {
    fn memory(&self) -> usize {
        Self::memory(self)
    }
}
