//! Normal forms about a resonance, kept for the next scene of the same body and orbit.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use andoyer_series::birkhoff::Resonances;
use andoyer_series::{BirkhoffMap, Error, normalize_driven};

use super::hamiltonian::{equilibrium, hamiltonian, space, without_force};
use super::shape::{LockedShape, PlaneMotion};
use crate::numerics::kept::KeptForms;

/// Divisors below this times the largest frequency end a normal form: the estimate refuses larger ones that are too small.
const SMALLEST_DIVISOR: f64 = 1e-9;

/// What of a normal form depends on the motion: the order, and which terms with the mean anomaly are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Truncated {
    pub(crate) order: usize,
    /// The variables are at most 2^`size`.
    pub(crate) size: i32,
    /// A term is left out if it is at most 2^`least` times the variables.
    pub(crate) least: i32,
}

impl Truncated {
    /// Whether a term with the mean anomaly is kept: its coefficient and its degree.
    fn keeps(self, coefficient: f64, degree: u32) -> bool {
        let size = f64::from(self.size).exp2();
        coefficient.abs() * size.powi(degree as i32 - 1) > f64::from(self.least).exp2()
    }
}

/// The normal form of a shape, kept for the next scene.
///
/// # Errors
/// Those of [`normalize_driven`]; [`Error::Interrupted`] when the flag is set.
pub(super) fn form(shape: &LockedShape, truncated: Truncated, stop: &AtomicBool) -> Result<Arc<BirkhoffMap>, Error> {
    let [a, b, _] = shape.moments;
    let PlaneMotion { phase_rate, spin, sideways, obliquity, argument } = shape.precession;
    let numbers = [a, b, shape.eccentricity, shape.attraction, phase_rate, spin, sideways, obliquity];
    let mut key: Vec<u64> = numbers.map(f64::to_bits).into();
    // A number that no argument has.
    key.push(argument.unwrap_or(f64::NAN).to_bits());
    let Truncated { order, size, least } = truncated;
    key.extend([i64::from(shape.twice), order as i64, size.into(), least.into()].map(i64::cast_unsigned));
    KeptForms::shared().of(key, || normalized(shape, truncated, stop))
}

fn normalized(shape: &LockedShape, truncated: Truncated, stop: &AtomicBool) -> Result<BirkhoffMap, Error> {
    let origin = equilibrium(shape)?;
    let hamiltonian = hamiltonian(shape, &origin, truncated.order, |c, degree| truncated.keeps(c, degree))?;
    let driven: Vec<(f64, f64)> = shape.driven([0.0; 2]).0.into_iter().map(|rate| (rate, 0.0)).collect();
    let resonances = Resonances::default().with_smallest_divisor(SMALLEST_DIVISOR)?;
    let mut going = |_: usize, _: usize| match stop.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let hamiltonian = without_force(&hamiltonian);
    let form = normalize_driven(&hamiltonian, truncated.order, &space(shape)?, &driven, &resonances, &mut going)?;
    BirkhoffMap::direct_with_progress(&form, &[], &mut going)
}
