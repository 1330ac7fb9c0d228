//! The Cayley–Klein parameters (a, b) of theory §8 as functions of time, by theta functions: far from the separatrix, near it, and on it.

use andoyer_double::DoubleDouble;

use super::closed_form::{ClosedForm, NEAREST_COMPLEMENT};
use super::error_budget::{COSINE_ROUNDING, ROUNDING, conditioning, duration, phase_rounding, rounding};
use super::frequencies::Secular;
use super::harmonics::CayleyKleinSeries;
use super::mode::Mode;
use super::polhode::Polhode;
use super::separatrix::{Clock, PassageTheta};
use super::series::order::first_order;
use crate::input::scene::Scene;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::user_rate;
use crate::numerics::theta::Theta;

/// Fraction of the tolerance that dropped harmonics may use.
pub(crate) const HARMONICS_SHARE: f64 = 0.125;

/// a e^(−iy′/2) and b e^(−iy′/2), up to a common factor.
pub(crate) enum CayleyKlein {
    /// The phase ℓ′ and the harmonics in ℓ′.
    Fourier(Phase, CayleyKleinSeries),
    /// A passage near the separatrix or on it.
    Passage(PassageTheta),
}

/// The parameters of one motion, and the entries of its plan.
pub(crate) struct Solution {
    pub(crate) parameters: CayleyKlein,
    /// y′ at the epoch, where y is 0 \[rad\].
    pub(crate) longitude: f64,
    pub(crate) rates: Secular,
    /// Order of the series; 0 for the closed form.
    pub(crate) order: usize,
    /// Highest multiple of ℓ′; 0 if there is no sum.
    pub(crate) harmonics: usize,
    /// Bound of the attitude error \[rad\].
    pub(crate) error_bound: f64,
    pub(crate) skipped: Vec<String>,
}

/// The solution by theta functions for any polhode that is not on the separatrix; `ratio` is σ/σ_sep. `remarks` is whether the plan is to say what was skipped.
pub(crate) fn by_theta_functions(
    (scene, remarks): (&Scene, bool),
    polhode: &Polhode,
    rates: Secular,
    ratio: f64,
    mode: Mode,
) -> Solution {
    let theta = polhode.invariants.theta;
    if theta.complement < NEAREST_COMPLEMENT {
        return beside_the_separatrix(scene, polhode, rates, &theta);
    }
    let closed = ClosedForm::new(polhode, &theta);
    let all = closed.series.harmonics();
    // The dropped harmonics are missing at the epoch and at the time of evaluation.
    let budget = 0.5 * HARMONICS_SHARE * scene.asked_tolerance() * closed.least_norm;
    let (series, dropped) = if budget == 0.0 { (closed.series, 0.0) } else { closed.series.truncated(budget) };
    let error_bound =
        (2.0 * dropped + rounding(&series)) / closed.least_norm.min(1.0) + conditioning(scene, polhode, &rates);
    let skipped = if !remarks {
        Vec::new()
    } else if mode == Mode::Axisymmetric {
        round_body()
    } else {
        let reason = match first_order(ratio, scene.asked_tolerance()) {
            Some(order) => with_number("series: it would need order ", order, " or more, and no fewer harmonics"),
            None => "series: too near the separatrix for its highest order".to_owned(),
        };
        std::iter::once(reason).chain(dropped_harmonics(&series, all)).collect()
    };
    let longitude = -2.0 * series.pair(closed.anomaly)[0].arg();
    let harmonics = series.harmonics();
    let anomaly = Phase::new(user_rate(rates.anomaly_rate, polhode.scales.1), closed.anomaly);
    let parameters = CayleyKlein::Fourier(anomaly, series);
    Solution { parameters, longitude, rates, order: 0, harmonics, error_bound, skipped }
}

fn beside_the_separatrix(scene: &Scene, polhode: &Polhode, rates: Secular, theta: &Theta) -> Solution {
    let (place, quarter, turned) = PassageTheta::place(polhode);
    let anomaly_rate = user_rate(rates.anomaly_rate, polhode.scales.1);
    let clock = Clock::repeating(anomaly_rate, place, quarter, theta.conjugate);
    Solution {
        error_bound: 2.0 * ROUNDING + conditioning(scene, polhode, &rates),
        ..passage(PassageTheta::new(theta, clock).turned(turned), rates, "series: too near the separatrix")
    }
}

/// The motion on the separatrix: one passage that begins and ends with rotation about the axis of middle inertia.
pub(crate) fn on_the_separatrix(scene: &Scene, polhode: &Polhode) -> Solution {
    let (place, _, turned) = PassageTheta::place(polhode);
    // K is infinite on the separatrix, even if rounding leaves Q1 different from 0.
    let theta = Theta { quarter: f64::INFINITY, ..polhode.invariants.theta };
    let [least, greatest] = polhode.invariants.cosine_squares;
    let rate = polhode.invariants.mean_rate * polhode.invariants.gamma * greatest.sqrt();
    let clock = Clock::Once(place.times_double(0.5), user_rate(rate.times_double(0.5), polhode.scales.1));
    let rates = Secular { kappa_sigma: 0.0, anomaly_rate: DoubleDouble::ZERO, longitude_rate: polhode.middle_rate() };
    // A distance from the separatrix below the resolution of double-double grows like e^u.
    let growth = (rate.to_f64().abs() * duration(scene, rates.longitude_rate, polhode.scales.1)).exp();
    let unseen = if least == DoubleDouble::ZERO { 0.0 } else { COSINE_ROUNDING * growth };
    Solution {
        error_bound: 4.0 * ROUNDING + phase_rounding(scene, rates.longitude_rate, polhode.scales.1) + unseen,
        ..passage(PassageTheta::new(&theta, clock).turned(turned), rates, "series: on the separatrix")
    }
}

fn passage(passage: PassageTheta, rates: Secular, reason: &str) -> Solution {
    Solution {
        longitude: -2.0 * passage.phase((0.0, 0.0)),
        parameters: CayleyKlein::Passage(passage),
        rates,
        order: 0,
        harmonics: 0,
        error_bound: 0.0,
        skipped: vec![reason.to_owned()],
    }
}

/// The reason why an axisymmetric body needs no series.
pub(crate) fn round_body() -> Vec<String> {
    vec!["series: two moments are equal, the wobble is a circle and the precession regular".to_owned()]
}

/// A remark on the harmonics that were dropped, if there are any.
pub(crate) fn dropped_harmonics(series: &CayleyKleinSeries, all: usize) -> Vec<String> {
    let kept = series.harmonics();
    let reason = || with_number("harmonics above ", kept, ": together below an eighth of the tolerance");
    (kept < all).then(reason).into_iter().collect()
}

/// A text with a number. Every solution has one or two, and `format!` would be 6 % of its instructions.
fn with_number(before: &str, number: usize, after: &str) -> String {
    let mut text = String::with_capacity(before.len() + after.len() + 4);
    text.push_str(before);
    let mut unit = 1;
    while number / unit >= 10 {
        unit *= 10;
    }
    while unit > 0 {
        text.push(char::from(b'0' + (number / unit % 10) as u8));
        unit /= 10;
    }
    text.push_str(after);
    text
}
