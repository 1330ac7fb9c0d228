//! Kepler's equation of a hyperbola, e sinh H − H = M.
//!
//! The residual e(sinh H − H) + (e − 1)H − M and the slope (e − 1) + 2e sinh²(H/2) are computed without cancellation, so that H keeps its relative accuracy for
//! e next to 1. The equation is convex for H > 0. The root of the cubic e H³/6 + (e − 1)H = M is above the solution, and so is arsinh((M + that root)/e), which
//! is nearer to it; four steps of third order (Halley) follow.

/// Below this |H| sinh H − H is summed as a series.
const SMALL: f64 = 1.0;
/// Steps from the start, which is within a quarter of H: each triples the number of right digits.
const STEPS: usize = 4;

/// The hyperbolic anomaly H with e sinh H − H = M, for e > 1 and any finite M.
pub(crate) fn hyperbolic_anomaly(m: f64, e: f64) -> f64 {
    let mean = m.abs();
    if mean == 0.0 {
        return m;
    }
    // H³ + 3p H = 2q.
    let (p, q) = (2.0 * (e - 1.0) / e, 3.0 * mean / e);
    let cubic = 2.0 * p.sqrt() * ((q / (p * p.sqrt())).asinh() / 3.0).sinh();
    let mut anomaly = if cubic < SMALL { cubic } else { ((mean + cubic) / e).asinh() };
    for _ in 0..STEPS {
        let (sine, half) = (anomaly.sinh(), (0.5 * anomaly).sinh());
        let slope = (e - 1.0) + 2.0 * e * half * half;
        let residual = e * excess(anomaly, sine) + ((e - 1.0) * anomaly - mean);
        let newton = residual / slope;
        anomaly -= residual / (slope - 0.5 * e * sine * newton);
    }
    anomaly.copysign(m)
}

/// e sinh H − H.
pub(crate) fn mean_anomaly(anomaly: f64, e: f64) -> f64 {
    e * excess(anomaly, anomaly.sinh()) + (e - 1.0) * anomaly
}

/// sinh H − H, where sinh H is `sine`.
fn excess(anomaly: f64, sine: f64) -> f64 {
    if anomaly.abs() >= SMALL {
        return sine - anomaly;
    }
    // x³/3! + x⁵/5! + …: the term x^19/19! is 5e-17 of the sum at x = 1.
    let square = anomaly * anomaly;
    let sum = (1..=9_i32).rev().fold(0.0, |sum, k| (1.0 + sum) * square / f64::from(2 * k * (2 * k + 1)));
    anomaly * sum
}

#[cfg(test)]
mod tests {
    use andoyer_double::DoubleDouble;

    use super::*;

    /// sinh H − H in double-double.
    fn exact_excess(anomaly: f64) -> DoubleDouble {
        let square = DoubleDouble::from(anomaly) * DoubleDouble::from(anomaly);
        let sum = (1..=90_i32)
            .rev()
            .fold(DoubleDouble::ZERO, |sum, k| (DoubleDouble::ONE + sum) * square.over(f64::from(2 * k * (2 * k + 1))));
        DoubleDouble::from(anomaly) * sum
    }

    #[test]
    fn the_anomaly_solves_keplers_equation_to_the_last_bits_for_any_hyperbola() {
        // M is computed from H in double-double, so the root is known. Rounding M changes H by half a unit of M over e cosh H − 1.
        for e in [1.0 + f64::EPSILON, 1.0 + 1e-12, 1.000_001, 1.0001, 1.01, 1.5, 4.25, 20.0, 1e3, 1e9] {
            for k in 0..=3000 {
                let anomaly = if k % 2 == 0 { 0.01 * f64::from(k) } else { 10.0_f64.powf(-f64::from(k) / 100.0) };
                let exact = DoubleDouble::sum(e, -1.0) * anomaly.into() + DoubleDouble::from(e) * exact_excess(anomaly);
                let m = exact.to_f64();
                let slope = (e - 1.0) + 2.0 * e * (0.5 * anomaly).sinh().powi(2);
                let found = hyperbolic_anomaly(m, e);
                let error = (found - anomaly).abs();
                let budget = 4.5e-16 * anomaly + 2.4e-16 * m / slope;
                assert!(error <= budget, "e = {e}, H = {anomaly}: off by {error:e} of {budget:e}");
                assert_eq!(hyperbolic_anomaly(-m, e), -found);
            }
        }
        assert_eq!(hyperbolic_anomaly(0.0, 1.5), 0.0);
    }

    #[test]
    fn extreme_mean_anomalies_have_an_anomaly() {
        for e in [1.0 + f64::EPSILON, 2.0, 1e50] {
            for m in [1e-200, 1e-9, 1e15, 1e100] {
                let anomaly = hyperbolic_anomaly(m, e);
                assert!(
                    anomaly.is_finite() && (mean_anomaly(anomaly, e) / m - 1.0).abs() < 1e-12,
                    "{m:e} {e:e}: {anomaly:e}"
                );
            }
        }
    }
}
