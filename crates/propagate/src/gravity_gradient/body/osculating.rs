//! The variables of the averaged theory at a given state.

use andoyer_double::DoubleDouble;

use crate::error::Error;
use crate::torque_free::closed_form::ClosedForm;
use crate::torque_free::frequencies::Secular;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::{Polhode, SMALLEST_TILT};

/// Largest σ/σ_sep for which the tables for the gravity gradient have enough harmonics.
pub(crate) const LARGEST_SEPARATRIX_RATIO: f64 = 0.9;

/// The variables of a state that can be averaged: σ/σ_sep, and σ, ℓ′, y′ − y.
pub(crate) fn osculating(polhode: &Polhode) -> Result<(f64, (f64, [f64; 2])), Error> {
    let mode = Mode::of(polhode);
    let [g1, g2, g3] = polhode.invariants.direction;
    let [_, second] = polhode.invariants.excesses;
    let principal = mode == Mode::PrincipalAxis && g3.abs() >= SMALLEST_TILT && g1.abs().max(g2.abs()) < SMALLEST_TILT;
    let unaveraged = |ratio: f64| Error::Unaveraged { mode: mode.to_string(), ratio, bound: LARGEST_SEPARATRIX_RATIO };
    if second == DoubleDouble::ZERO || mode == Mode::Separatrix || (mode == Mode::PrincipalAxis && !principal) {
        return Err(unaveraged(1.0));
    }
    if principal {
        return Ok((0.0, (0.0, [0.0; 2])));
    }
    let sigma = Secular::exact(polhode).kappa_sigma / polhode.invariants.kappa;
    let ratio = (sigma / polhode.separatrix_action()).min(1.0);
    if ratio > LARGEST_SEPARATRIX_RATIO {
        return Err(unaveraged(ratio));
    }
    let closed = ClosedForm::new(polhode, &polhode.invariants.theta);
    Ok((ratio, (sigma, [closed.anomaly, -2.0 * closed.series.pair(closed.anomaly)[0].arg()])))
}
