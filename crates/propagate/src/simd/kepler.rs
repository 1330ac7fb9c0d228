//! Kepler's equation and the true anomaly, in lanes.
//!
//! Kepler's equation is solved with a fixed number of steps. Markley's starter (Celest. Mech. Dyn. Astron. 63 (1995) 101) is accurate to 1e-4. Where e is small
//! M + e sin M is enough, with a polynomial for the sine. Two steps of third order follow, with the residual (1−e)E + e(E − sin E) − M, which is computed
//! without cancellation.

use std::f64::consts::{PI, TAU};

use super::instruction_set::InstructionSet;
use super::lanes::Lanes;
use super::sincos::{sin_cos_of_turns, twice_arc};

/// Largest eccentricity for which M + e sin M starts the iteration.
const SMALL: f64 = 0.3;

/// The place of the disturbing body on its ellipse at some times.
#[derive(Clone, Copy)]
pub(crate) struct Place<S: InstructionSet> {
    /// The true anomaly, in [−π, π] \[rad\].
    pub(crate) angle: Lanes<S>,
    /// The true anomaly minus the mean anomaly, computed without that subtraction.
    pub(crate) centre: Lanes<S>,
    /// Sine and cosine of the true anomaly.
    pub(crate) sine: Lanes<S>,
    pub(crate) cosine: Lanes<S>,
}

impl<S: InstructionSet> Place<S> {
    /// From the mean anomaly in [−π, π], which may exceed this interval by a rounding error.
    #[inline(always)]
    pub(crate) fn of(mean_anomaly: Lanes<S>, eccentricity: f64) -> Self {
        let all = |value: f64| mean_anomaly.all(value);
        if eccentricity == 0.0 {
            let (sine, cosine) = sin_cos_of_turns(mean_anomaly * all(1.0 / TAU));
            return Self { angle: mean_anomaly, centre: all(0.0), sine, cosine };
        }
        let anomaly = eccentric_anomaly(mean_anomaly, eccentricity);
        let (sine, cosine) = sin_cos_of_turns(anomaly * all(0.5 / TAU));
        let (y, x) = (sine * all((1.0 + eccentricity).sqrt()), cosine * all((1.0 - eccentricity).sqrt()));
        let scale = y.mul_add(y, x * x).reciprocal();
        // tan (f − E)/2 = β sin E/(1 − β cos E), e = 2β/(1 + β²), and E − M = e sin E.
        let beta = eccentricity / (1.0 + ((1.0 - eccentricity) * (1.0 + eccentricity)).sqrt());
        let product = sine * cosine;
        let across = product * all(2.0 * beta);
        let along = (sine * sine).mul_add(all(2.0 * beta), all(1.0 - beta));
        let ahead = twice_arc(across, along);
        let centre = product.mul_add(all(2.0 * eccentricity), ahead);
        Self { angle: anomaly + ahead, centre, sine: (x * y) * (scale + scale), cosine: ((x - y) * (x + y)) * scale }
    }
}

/// E from Kepler's equation E − e sin E = M, for M in [−π, π] and 0 ≤ e < 1.
#[inline(always)]
pub(crate) fn eccentric_anomaly<S: InstructionSet>(m: Lanes<S>, e: f64) -> Lanes<S> {
    let all = |value: f64| m.all(value);
    let mut anomaly = if e <= SMALL { near_circle(m, e) } else { starter(m, e) };
    for _ in 0..2 {
        let (half_sine, half_cosine) = sin_cos_of_turns(anomaly * all(0.5 / TAU));
        let sine = (half_sine + half_sine) * half_cosine;
        let versed = (half_sine + half_sine) * half_sine;
        let slope = versed.mul_add(all(e), all(1.0 - e));
        let residual = anomaly.mul_add(all(1.0 - e), excess(anomaly, sine).mul_add(all(e), -m));
        // Third order (Halley), then fourth, from the second and third derivatives e sin E and e cos E.
        let (second, third) = (sine * all(0.5 * e), versed.negate_mul_add(all(e / 6.0), all(e / 6.0)));
        let newton = residual / slope;
        let halley = residual / newton.negate_mul_add(second, slope);
        anomaly = anomaly - residual / (halley * halley).mul_add(third, halley.negate_mul_add(second, slope));
    }
    anomaly
}

/// E − sin E without cancellation.
#[inline(always)]
fn excess<S: InstructionSet>(anomaly: Lanes<S>, sine: Lanes<S>) -> Lanes<S> {
    // x³/3! − x⁵/5! + …: the term x^21/21! is 2e-20 of the sum at x = 1.
    let square = anomaly * anomaly;
    let mut sum = anomaly.all(0.0);
    for k in (1..=9_i32).rev() {
        sum = (anomaly.all(1.0) - sum) * square * anomaly.all(1.0 / f64::from(2 * k * (2 * k + 1)));
    }
    anomaly.magnitude().up_to(1.0, anomaly * sum, anomaly - sine)
}

/// M + e sin M, to e²/2 + 0.02 e.
#[inline(always)]
fn near_circle<S: InstructionSet>(m: Lanes<S>, e: f64) -> Lanes<S> {
    let square = m * m;
    m * square.polynomial(&[0.987_86, -0.155_27, 0.005_643]).mul_add(m.all(e), m.all(1.0))
}

/// The starter: the root of the cubic that follows from Kepler's equation with a Padé approximation of the sine.
#[inline(always)]
fn starter<S: InstructionSet>(m: Lanes<S>, e: f64) -> Lanes<S> {
    let all = |value: f64| m.all(value);
    let scale = 1.6 * PI / (1.0 + e) / (PI * PI - 6.0);
    let alpha = (all(PI) - m.magnitude()).mul_add(all(scale), all(3.0 * PI * PI / (PI * PI - 6.0)));
    let d = alpha.mul_add(all(e), all(3.0 * (1.0 - e)));
    let (square, product) = (m * m, alpha * d);
    let q = product.mul_add(all(2.0 * (1.0 - e)), -square);
    let r = m * (product * all(3.0)).mul_add(d - all(1.0 - e), square);
    let radicand = (q * q).mul_add(q, r * r);
    let radicand = radicand.up_to(0.0, all(0.0), radicand);
    let root = (r.magnitude() + radicand.root()).each(f64::cbrt);
    let w = root * root;
    ((r + r) * w / q.mul_add(q, w * (w + q)) + m) / d
}

#[cfg(test)]
mod tests {
    use andoyer_double::DoubleDouble;

    use super::*;

    fn one(value: f64) -> Lanes<pulp::Scalar> {
        Lanes::splat(pulp::Scalar, value)
    }

    fn solved(m: f64, e: f64) -> f64 {
        eccentric_anomaly(one(m), e).values()[0]
    }

    #[test]
    fn the_eccentric_anomaly_solves_keplers_equation_to_the_last_bits_for_any_ellipse() {
        // M is computed from E in double-double, so the root is known. Rounding M changes E by half a unit of M over 1 − e cos E.
        for e in [0.0, 1e-9, 0.1, SMALL, 0.5, 0.9, 0.99, 0.999_999, 1.0 - 1e-12, 1.0 - f64::EPSILON] {
            for k in 0..=2000 {
                let anomaly =
                    if k % 2 == 0 { PI * f64::from(k) / 2000.0 } else { 10.0_f64.powf(-f64::from(k) / 100.0) };
                let exact = DoubleDouble::sum(1.0, -e) * anomaly.into() + DoubleDouble::from(e) * tail(anomaly);
                let m = exact.to_f64();
                let slope = (1.0 - e) + 2.0 * e * (0.5 * anomaly).sin().powi(2);
                let found = solved(m, e);
                let error = (found - anomaly).abs();
                let budget = 4.5e-16 * anomaly + 1.2e-16 * m / slope;
                assert!(error <= budget, "e = {e}, E = {anomaly}: off by {error:e} of {budget:e}");
                assert_eq!(solved(-m, e), -found);
            }
        }
    }

    /// E − sin E in double-double.
    fn tail(anomaly: f64) -> DoubleDouble {
        let x = DoubleDouble::from(anomaly);
        let square = x * x;
        let sum = (1..=30_i32)
            .rev()
            .fold(DoubleDouble::ZERO, |sum, k| (DoubleDouble::ONE - sum) * square.over(f64::from(2 * k * (2 * k + 1))));
        x * sum
    }

    #[test]
    fn true_anomaly_is_that_of_the_geometry() {
        for e in [0.0, 0.3, 0.97] {
            for k in -50..=50 {
                let mean = PI * f64::from(k) / 50.0;
                let place = Place::of(one(mean), e);
                let anomaly = solved(mean, e);
                let [sine, cosine, angle, centre] =
                    [place.sine, place.cosine, place.angle, place.centre].map(|l| l.values()[0]);
                let r = 1.0 - e * anomaly.cos();
                assert!((cosine - (anomaly.cos() - e) / r).abs() < 1e-14 / (1.0 - e));
                assert!((sine - (1.0 - e * e).sqrt() * anomaly.sin() / r).abs() < 1e-14 / (1.0 - e));
                assert!((angle.sin() - sine).abs() < 1e-15);
                assert!((centre - (angle - mean)).abs() < 1e-15);
            }
        }
    }
}
