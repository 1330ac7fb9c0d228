//! Normal forms about a resonance, kept for the next scene of the same body and orbit.

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use andoyer_series::Error;
use andoyer_series::birkhoff::Mode;
use andoyer_series::periodic::{DrivenForm, DrivenOptions};

use super::shape::{LockedShape, PlaneMotion};
use crate::numerics::kept::KeptForms;

/// Divisors below this part of the largest frequency end a normal form: the estimate refuses larger ones that are too small.
const SMALLEST_DIVISOR: f64 = 1e-9;
/// Most harmonics of a phase.
const HARMONICS: usize = 252;
/// The last harmonics of the periodic motion and of its frame are at most this fraction of the tolerance, and not below the second number, which rounding reaches.
const TAIL: [f64; 2] = [1e-4, 1e-13];

/// The normal form of a shape for a tolerance \[rad\], kept for the next scene. `known` is one of another order for the same shape and tolerance: the periodic motion is the same.
///
/// # Errors
/// Those of [`DrivenForm::new`]; [`Error::Interrupted`] when the flag is set.
pub(super) fn form(
    shape: &LockedShape,
    order: usize,
    tolerance: f64,
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
    let options =
        DrivenOptions { order, tolerance: tail.exp2(), harmonics: HARMONICS, smallest_divisor: SMALLEST_DIVISOR };
    KeptForms::shared().of(key, || {
        let form = match known {
            Some(known) => known.to_order(shape, order, &mut going)?,
            None => DrivenForm::new(shape, &shape.rates(), options, &mut going)?,
        };
        let growth = |mode: &Mode<f64>| match mode {
            Mode::Hyperbolic { rate } => Some([(TAU * rate.abs()).exp(), 0.0]),
            _ => None,
        };
        let multipliers: Vec<_> = form.modes().iter().filter_map(growth).collect();
        if multipliers.is_empty() {
            return Ok(form);
        }
        Err(Error::MultiplierUnsupported { multipliers, problem: "grow in each orbit: the motion is unstable" })
    })
}
