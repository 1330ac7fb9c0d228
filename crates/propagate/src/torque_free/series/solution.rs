//! The Cayley–Klein parameters of one motion, by the series (theory §7, §8).

use super::composition::{harmonics, oscillator_and_longitude};
use super::order::{Expanded, expanded, initial_anomaly};
use crate::error::Error;
use crate::input::scene::Scene;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::user_rate;
use crate::torque_free::closed_form::anomaly;
use crate::torque_free::error_budget::{drift, rounding};
use crate::torque_free::frequencies::Secular;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::Polhode;
use crate::torque_free::solution::{CayleyKlein, HARMONICS_SHARE, Solution, dropped_harmonics, round_body};

/// The solution by the series at the fixed order, or at the lowest order that the tolerance needs.
///
/// # Errors
/// - [`Error::NearSeparatrix`] if no order meets the tolerance.
pub(crate) fn by_the_series(
    scene: &Scene,
    polhode: &Polhode,
    exact: Secular,
    ratio: f64,
    mode: Mode,
) -> Result<Solution, Error> {
    let expanded = expanded(scene, polhode, &exact, ratio, mode)?;
    let Expanded { order, expansion, secular, ellipse, truncation } = expanded;
    let (series, dropped) = harmonics(&expansion, ellipse).truncated(HARMONICS_SHARE * scene.asked_tolerance());
    let theta = polhode.invariants.theta;
    // The truncated series of a fixed order has its own ℓ′, found by iteration. Near the separatrix this is ill-conditioned; the elliptic integral is not.
    let anomaly = match scene.asked_order() {
        Some(_) => initial_anomaly(&expansion, ellipse.oscillator(polhode.zeta())),
        None => anomaly(polhode, &theta),
    };
    let (_, longitude) = oscillator_and_longitude(&expansion, |h| (h as f64 * anomaly).sin_cos());
    let exponent = polhode.scales.1;
    let drift = drift(scene, &exact, &secular, exponent, theta.quarter);
    Ok(Solution {
        longitude: -longitude,
        order,
        harmonics: series.harmonics(),
        error_bound: truncation + dropped + drift + rounding(&series),
        skipped: if mode == Mode::Axisymmetric { round_body() } else { dropped_harmonics(&series, 4 * order + 3) },
        parameters: CayleyKlein::Fourier(Phase::new(user_rate(secular.anomaly_rate, exponent), anomaly), series),
        rates: secular,
    })
}
