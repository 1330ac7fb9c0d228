//! Normal forms about a resonance, kept for the next scene of the same body and orbit, and what they cost.
//!
//! The cost of a form is known before it is made: products of two terms, at each time of the grid of the driven phases. Two polynomials in six variables whose degrees together are
//! N + 2 at most have C(N + 14, 12) of them, and the products of a form of order N take as long as some such multiplications.

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use andoyer_series::birkhoff::Mode;
use andoyer_series::periodic::{DrivenForm, DrivenHamiltonian, DrivenOptions, Grid, Periodic};
use andoyer_series::{Error, Polynomial};

use super::shape::{LockedShape, PlaneMotion};
use crate::numerics::kept::KeptForms;

/// Divisors below this part of the largest frequency end a normal form: the estimate refuses larger ones that are too small.
const SMALLEST_DIVISOR: f64 = 1e-9;
/// Most harmonics of a phase.
const HARMONICS: usize = 252;
/// The last harmonics of the periodic motion and of its frame are at most this fraction of the tolerance, and not below the second number, which rounding reaches.
const TAIL: [f64; 2] = [1e-4, 1e-13];

/// The most products of terms in all forms of a solution that no order asks for: one core takes 1.7 s for them.
pub(super) const MOST_PRODUCTS: f64 = 6e7;
/// The cost of a step towards the periodic motion, in products at a time of the grid.
const PRODUCTS_OF_A_STEP: f64 = 6e3;
/// A product of terms costs as much as so many more times of the grid.
const TERM: usize = 16;

/// The number of products of terms in a form of an order on a grid of so many times.
pub(super) fn products(shape: &LockedShape, order: usize, times: usize) -> f64 {
    let all = (1..=12).fold(1.0, |product, k| product * (order as f64 + 2.0 + f64::from(k)) / f64::from(k));
    // In the plane of the orbit H is even in the four variables of the pole: each factor has half of the terms.
    let part = if shape.is_tilted() { 1.0 } else { 0.25 };
    all * part * (times + TERM) as f64
}

/// The equations of a shape, which are refused after some steps towards the periodic motion.
struct Limited<'a> {
    shape: &'a LockedShape,
    /// The times of all grids of the steps so far, and the most of them.
    times: AtomicUsize,
    most: usize,
}

impl DrivenHamiltonian for Limited<'_> {
    fn pairs(&self) -> usize {
        self.shape.pairs()
    }

    fn expanded(
        &self,
        grid: &Grid,
        variables: &[Polynomial<Periodic>],
        degree: u32,
    ) -> Result<Polynomial<Periodic>, Error> {
        let times = grid.times() + self.times.fetch_add(grid.times(), Ordering::Relaxed);
        if times > self.most {
            return Err(Error::GridTooLarge { times, bound: self.most });
        }
        self.shape.expanded(grid, variables, degree)
    }
}

/// The periodic motion of a shape: its normal form of order 0. `limited`: without more than [`MOST_PRODUCTS`].
///
/// # Errors
/// Those of [`form`]; [`Error::GridTooLarge`] for a motion that takes more products.
pub(super) fn periodic(
    shape: &LockedShape,
    tolerance: f64,
    limited: bool,
    stop: &AtomicBool,
) -> Result<Arc<DrivenForm>, Error> {
    let most = if limited { (MOST_PRODUCTS / PRODUCTS_OF_A_STEP) as usize } else { usize::MAX };
    let system = Limited { shape, times: AtomicUsize::new(0), most };
    form((shape, &system, limited), 0, tolerance, None, stop)
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
    form((shape, shape, false), order, tolerance, Some(known), stop)
}

/// The normal form of a shape for a tolerance \[rad\], kept for the next scene. `known` is one of another order for the same shape and tolerance: the periodic motion is the same.
///
/// # Errors
/// Those of [`DrivenForm::new`]; [`Error::Interrupted`] when the flag is set.
fn form(
    (shape, system, limited): (&LockedShape, &dyn DrivenHamiltonian, bool),
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
    // A motion that a limit refuses is refused although another scene, without the limit, has kept it.
    let numbers = [i64::from(shape.twice), order as i64, tail as i64, i64::from(limited)];
    key.extend(numbers.map(i64::cast_unsigned));
    let mut going = |_: usize, _: usize| match stop.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let options =
        DrivenOptions { order, tolerance: tail.exp2(), harmonics: HARMONICS, smallest_divisor: SMALLEST_DIVISOR };
    KeptForms::shared().of(key, || {
        let form = match known {
            Some(known) => known.to_order(system, order, &mut going)?,
            None => DrivenForm::new(system, &shape.rates(), options, &mut going)?,
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
