//! The order of the series: the lowest one whose truncation error meets its share of the tolerance. A first estimate needs no expansion (theory §5).

use super::composition::{WobbleEllipse, oscillator_and_longitude};
use super::tables::{FourierExpansion, reaching};
use crate::error::Error;
use crate::input::options::MAX_ORDER;
use crate::input::scene::Scene;
use crate::torque_free::frequencies::Secular;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::Polhode;

/// Fraction of the tolerance that truncation may use.
const TRUNCATION_SHARE: f64 = 0.75;
/// Truncation errors below this are smaller than rounding errors \[rad\].
const SMALLEST_TOLERANCE: f64 = 1e-15;

/// The first order to try: the lowest N with (σ/σ_sep)^(N+1)/(N+1) below the tolerance. The power is from theory §5, the factor 1/(N+1) was measured.
pub(crate) fn first_order(ratio: f64, tolerance: f64) -> Option<usize> {
    let mut power = 1.0;
    (0..=MAX_ORDER).find(|&order| {
        power *= ratio;
        power <= tolerance.max(SMALLEST_TOLERANCE) * (order as f64 + 1.0)
    })
}

/// The series of one order, with its truncation error.
pub(crate) struct Expanded {
    pub(crate) order: usize,
    pub(crate) expansion: FourierExpansion,
    pub(crate) secular: Secular,
    pub(crate) ellipse: WobbleEllipse,
    /// Truncation error \[rad\].
    pub(crate) truncation: f64,
}

/// The series at the fixed order, or at the lowest order whose truncation error meets its share of the tolerance.
///
/// # Errors
/// - [`Error::NearSeparatrix`] if no order meets it.
pub(crate) fn expanded(
    scene: &Scene,
    polhode: &Polhode,
    exact: &Secular,
    ratio: f64,
    mode: Mode,
) -> Result<Expanded, Error> {
    let target = scene.asked_tolerance().max(SMALLEST_TOLERANCE);
    let first = match (mode, scene.asked_order()) {
        (Mode::Axisymmetric, _) => Some(0), // the series ends with the quadratic part
        (_, Some(order)) if ratio < 1.0 => Some(order),
        _ => first_order(ratio, target),
    };
    for order in first.unwrap_or(MAX_ORDER)..=MAX_ORDER {
        let tables = reaching(order, polhode.precise_beta())?;
        let fixed = mode != Mode::Axisymmetric && scene.asked_order().is_some();
        let secular = if fixed { Secular::truncated(polhode, tables.polynomials(order)?) } else { *exact };
        let expansion = tables.expand(order, secular.kappa_sigma, polhode.invariants.kappa);
        let [first, second] = polhode.invariants.excesses;
        let ellipse = WobbleEllipse::new((first / second).to_f64());
        let truncation = truncation(&expansion, ellipse, ratio, mode);
        if (fixed && ratio < 1.0) || truncation <= TRUNCATION_SHARE * target {
            return Ok(Expanded { order, expansion, secular, ellipse, truncation });
        }
        if order == MAX_ORDER {
            let attainable = truncation / TRUNCATION_SHARE;
            return Err(Error::NearSeparatrix {
                ratio,
                tolerance: scene.asked_tolerance(),
                attainable,
                highest: MAX_ORDER,
            });
        }
    }
    Err(Error::Order { value: scene.asked_order().unwrap_or(MAX_ORDER), bound: MAX_ORDER })
}

/// The turn of the attitude by the omitted orders \[rad\]. It is estimated as a geometric tail of the last order kept, at the time of evaluation and in both
/// initial phases.
///
/// Hence the factor 4 (with 2, some errors at orders 1 and 2 exceed the bound by up to a fifth). Terms grow at most linearly before they fall, like those of S
/// for β → 0: Σ_{n>N} n rⁿ = N rᴺ [r/(1−r) + r/(N(1−r)²)].
fn truncation(expansion: &FourierExpansion, ellipse: WobbleEllipse, ratio: f64, mode: Mode) -> f64 {
    match mode {
        Mode::Axisymmetric => 0.0,
        _ => {
            let order = expansion.longitude.len().max(1) as f64;
            let rest = 1.0 - ratio;
            4.0 * ellipse.long * expansion.last_order * ratio / rest * (1.0 + 1.0 / (order * rest))
        }
    }
}

/// The ℓ′ whose transformed w has the direction of `target`.
///
/// ℓ = 0, π/2, … are fixed points by symmetry, so the root is in the quadrant of the target. Regula falsi finds a root of the cross product and stays within
/// its bracket. If one end stays twice, its value is halved (the Illinois rule), so that both ends move.
pub(crate) fn initial_anomaly(expansion: &FourierExpansion, target: [f64; 2]) -> f64 {
    let folded = [target[0].abs(), target[1].abs()];
    let cross = |angle: f64| {
        let (w, _) = oscillator_and_longitude(expansion, |h| (h as f64 * angle).sin_cos());
        (w[1] * folded[0] - w[0] * folded[1]) / (w[0].hypot(w[1]) * folded[0].hypot(folded[1]))
    };
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    let (mut low_value, mut high_value) = (cross(low), cross(high));
    let mut angle = folded[1].atan2(folded[0]);
    let mut last = 0.0_f64;
    // Convergence is superlinear; 200 steps are always enough.
    for _ in 0..200 {
        let value = cross(angle);
        if value == 0.0 || high - low <= f64::EPSILON {
            break;
        }
        let again = value * last > 0.0;
        if value < 0.0 {
            (low, low_value) = (angle, value);
            high_value *= if again { 0.5 } else { 1.0 };
        } else {
            (high, high_value) = (angle, value);
            low_value *= if again { 0.5 } else { 1.0 };
        }
        last = value;
        let next = (low * high_value - high * low_value) / (high_value - low_value);
        // A bracket that has closed on an axis of symmetry gives 0/0; the angle then stays as it is.
        let moves = (next - angle).abs() > 0.5 * f64::EPSILON;
        if !moves {
            break;
        }
        angle = next;
    }
    let upper = if target[0] < 0.0 { std::f64::consts::PI - angle } else { angle };
    if target[1] < 0.0 { -upper } else { upper }
}

#[cfg(test)]
mod tests {
    use super::first_order;

    #[test]
    fn the_first_order_to_try_is_the_lowest_whose_power_over_its_number_is_below_the_tolerance() {
        // ½⁴/4 = 0.015625, and ½³/3 is above all three tolerances.
        assert_eq!([0.0156, 0.01563, 0.04].map(|tolerance| first_order(0.5, tolerance)), [Some(4), Some(3), Some(3)]);
        assert_eq!(first_order(1.0, 1e-9), None);
    }
}
