//! What a scene asks of the motion under a torque: its options, the parts of its tolerance, and the averaged variables of its state.

use crate::error::Error;
use crate::gravity_gradient::constants::{DROPPED, DROPPED_OF_SECOND_ORDER, LARGEST_SEPARATRIX_RATIO, PAIRS};
use crate::input::options::{Averaging, Level};
use crate::orbit::elements::Orbit;
use crate::torque_free::closed_form::ClosedForm;
use crate::torque_free::frequencies::Secular;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::{Polhode, SMALLEST_TILT};
use andoyer_double::DoubleDouble;

/// The requested options of the perturbed motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request<'a> {
    /// Of each disturbing body; at least one.
    pub(crate) orbits: &'a [Orbit],
    pub(crate) averaging: Averaging,
    pub(crate) level: Level,
    pub(crate) tolerance: f64,
    pub(crate) epoch: f64,
    /// Longest times before and after the epoch, in the user's unit.
    pub(crate) sides: [f64; 2],
    /// Whether the scene has a span.
    pub(crate) spanned: bool,
}

impl Request<'_> {
    /// Longest time from the epoch, in the user's unit.
    pub(crate) fn duration(&self) -> f64 {
        let [before, after] = self.sides;
        before.max(after)
    }

    /// Whether there is one body, on an orbit that does not precess.
    pub(crate) fn is_fixed(&self) -> bool {
        matches!(self.orbits, [orbit] if orbit.is_fixed())
    }

    /// Whether the mean M and L at the epoch are those of all terms.
    pub(crate) fn is_refined(&self) -> bool {
        self.is_fixed() && matches!(self.level, Level::Auto | Level::Full | Level::SecondOrder)
    }
}

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

/// The parts of the tolerance \[rad\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ledger {
    pub(crate) dropped: f64,
    /// Truncation error of a sum over time derivatives. Above it exact divisors replace the sum.
    pub(crate) truncated: f64,
    pub(crate) pairs: f64,
    /// The whole tolerance. Resonances that turn the attitude by much more are refused.
    pub(crate) refused: f64,
    /// Terms below this share of the second-order change are dropped.
    pub(crate) of_second_order: f64,
    /// Whether the mean M and L at the epoch are those of all terms, so that the effect of dropped terms grows in second order only.
    pub(crate) refined: bool,
}

impl Ledger {
    /// The parts of a tolerance.
    pub(crate) fn new(tolerance: f64, refined: bool) -> Self {
        let case = usize::from(refined);
        let [dropped, truncated, pairs] = [DROPPED[case], DROPPED[0], PAIRS].map(|part| part * tolerance);
        let of_second_order = DROPPED_OF_SECOND_ORDER[case];
        Self { dropped, truncated, pairs, refused: tolerance, of_second_order, refined }
    }
}
