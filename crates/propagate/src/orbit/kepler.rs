//! Kepler's equation and the true anomaly, in lanes.
//!
//! Kepler's equation is solved with a fixed number of steps. Where e is small, the start is Lagrange's series for E − M up to e⁶, accurate to 2e-4, and one
//! step that is of fourth order follows. Otherwise the start is Markley's (Celest. Mech. Dyn. Astron. 63 (1995) 101), accurate to 1e-4, and two steps follow,
//! with the residual (1−e)E + e(E − sin E) − M, which is computed without cancellation.

use std::f64::consts::{PI, TAU};

use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::simd::sincos::{sin_cos_of_turns, twice_arc, twice_short_arc};

/// Largest eccentricity for which Lagrange's series starts the iteration.
const SMALL: f64 = 0.3;
/// Largest eccentricity for which f − E is below π/4.
const SHORT: f64 = 0.66;

/// An ellipse, with what its eccentricity determines.
#[derive(Clone, Debug)]
pub(crate) struct Ellipse {
    pub(crate) eccentricity: f64,
    /// Square roots of 1 + e and of 1 − e.
    roots: [f64; 2],
    /// e = 2β/(1 + β²).
    beta: f64,
    /// (E − M)/sin M to e⁶, as a polynomial in cos M.
    series: [f64; 6],
}

impl Ellipse {
    pub(crate) fn new(eccentricity: f64) -> Self {
        let e = eccentricity;
        let roots = [(1.0 + e).sqrt(), (1.0 - e).sqrt()];
        let square = e * e;
        // e sin M + e²/2 sin 2M + e³/8 (3 sin 3M − sin M) + e⁴/6 (2 sin 4M − sin 2M) + e⁵/384 (125 sin 5M − 81 sin 3M + 2 sin M)
        // + e⁶/240 (81 sin 6M − 64 sin 4M + 5 sin 2M), with sin kM/sin M = U(cos M).
        let series = [
            e * (1.0 - square * (0.5 - square * 13.0 / 24.0)),
            square * (1.0 - square * (5.0 / 3.0 - square * 47.0 / 15.0)),
            e * square * (1.5 - square * 4.75),
            square * square * (8.0 / 3.0 - square * 194.0 / 15.0),
            e * square * square * 125.0 / 24.0,
            square * square * square * 10.8,
        ];
        Self { eccentricity, roots, beta: e / (1.0 + roots[0] * roots[1]), series }
    }

    /// E from Kepler's equation E − e sin E = M, for M in [−π, π] and 0 ≤ e < 1, with sine and cosine of E/2.
    #[inline(always)]
    fn anomaly<S: InstructionSet>(&self, m: Lanes<S>) -> (Lanes<S>, [Lanes<S>; 2]) {
        if self.eccentricity <= SMALL {
            return self.near_circle(m);
        }
        let anomaly = from_starter(m, self.eccentricity);
        let (sine, cosine) = sin_cos_of_turns(anomaly * m.all(0.5 / TAU));
        (anomaly, [sine, cosine])
    }

    #[inline(always)]
    fn near_circle<S: InstructionSet>(&self, m: Lanes<S>) -> (Lanes<S>, [Lanes<S>; 2]) {
        let all = |value: f64| m.all(value);
        let (sine, cosine) = sin_cos_of_turns(m * all(1.0 / TAU));
        let start = sine.mul_add(cosine.polynomial(&self.series), m);
        let (half_sine, half_cosine) = sin_cos_of_turns(start * all(0.5 / TAU));
        let sine = (half_sine + half_sine) * half_cosine;
        let versed = (half_sine + half_sine) * half_sine;
        let e = all(self.eccentricity);
        let inverse = versed.mul_add(e, all(1.0 - self.eccentricity)).reciprocal();
        // E − M is exact here.
        let newton = sine.negate_mul_add(e, start - m) * inverse;
        let curvature = all(0.5) * e * sine * inverse;
        let third = versed.negate_mul_add(e, e) * inverse * all(1.0 / 6.0);
        // f + f′ δ + f″/2 δ² + f‴/6 δ³ = 0.
        let cubic = (curvature + curvature).negate_mul_add(curvature, third);
        let change = newton * newton.mul_add(newton.mul_add(cubic, -curvature), all(-1.0));
        let half = all(0.5) * change;
        let square = half * half;
        let turned_sine = square.negate_mul_add(half * all(1.0 / 6.0), half);
        let turned_versed = square * square.negate_mul_add(all(1.0 / 24.0), all(0.5));
        let new_sine = half_sine + half_cosine.mul_add(turned_sine, -(half_sine * turned_versed));
        let new_cosine = half_cosine - half_sine.mul_add(turned_sine, half_cosine * turned_versed);
        (start + change, [new_sine, new_cosine])
    }

    /// The place at a mean anomaly in [−π, π], which may exceed this interval by a rounding error.
    #[inline(always)]
    pub(crate) fn place<S: InstructionSet>(&self, mean_anomaly: Lanes<S>) -> Place<S> {
        let all = |value: f64| mean_anomaly.all(value);
        let Self { eccentricity, roots, beta, .. } = *self;
        if eccentricity == 0.0 {
            let (sine, cosine) = sin_cos_of_turns(mean_anomaly * all(1.0 / TAU));
            return Place { angle: mean_anomaly, centre: all(0.0), sine, cosine };
        }
        let (anomaly, [sine, cosine]) = self.anomaly(mean_anomaly);
        let (y, x) = (sine * all(roots[0]), cosine * all(roots[1]));
        let scale = y.mul_add(y, x * x).reciprocal();
        // tan (f − E)/2 = β sin E/(1 − β cos E), and E − M = e sin E.
        let product = sine * cosine;
        let across = product * all(2.0 * beta);
        let along = (sine * sine).mul_add(all(2.0 * beta), all(1.0 - beta));
        let ahead = if eccentricity <= SHORT { twice_short_arc(across / along) } else { twice_arc(across, along) };
        let centre = product.mul_add(all(2.0 * eccentricity), ahead);
        Place { angle: anomaly + ahead, centre, sine: (x * y) * (scale + scale), cosine: ((x - y) * (x + y)) * scale }
    }
}

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
    /// e^(if) for the true anomaly f.
    #[inline(always)]
    pub(crate) fn turn(&self) -> ComplexLanes<S> {
        ComplexLanes { re: self.cosine, im: self.sine }
    }

    /// [`Ellipse::place`] for an ellipse with this eccentricity.
    pub(crate) fn of(mean_anomaly: Lanes<S>, eccentricity: f64) -> Self {
        Ellipse::new(eccentricity).place(mean_anomaly)
    }
}

/// E from Kepler's equation E − e sin E = M, for M in [−π, π] and 0 ≤ e < 1.
pub(crate) fn eccentric_anomaly(m: f64, e: f64) -> f64 {
    Ellipse::new(e).anomaly(Lanes::splat(pulp::Scalar, m)).0.values()[0]
}

/// E by Markley's starter and two steps.
#[inline(always)]
fn from_starter<S: InstructionSet>(m: Lanes<S>, e: f64) -> Lanes<S> {
    let shape = [m.all(e), m.all(1.0 - e)];
    corrected(corrected(starter(m, e), m, shape), m, shape)
}

/// An approximation to E after one step towards the root of Kepler's equation, from e and 1 − e.
#[inline(always)]
pub(crate) fn corrected<S: InstructionSet>(anomaly: Lanes<S>, m: Lanes<S>, [e, rest]: [Lanes<S>; 2]) -> Lanes<S> {
    let all = |value: f64| m.all(value);
    let (half_sine, half_cosine) = sin_cos_of_turns(anomaly * all(0.5 / TAU));
    let sine = (half_sine + half_sine) * half_cosine;
    let versed = (half_sine + half_sine) * half_sine;
    let slope = versed.mul_add(e, rest);
    let residual = anomaly.mul_add(rest, excess(anomaly, sine).mul_add(e, -m));
    // Third order (Halley), then fourth, from the second and third derivatives e sin E and e cos E.
    let (second, third) = (sine * (all(0.5) * e), versed.negate_mul_add(e * all(1.0 / 6.0), e * all(1.0 / 6.0)));
    let newton = residual / slope;
    let halley = residual / newton.negate_mul_add(second, slope);
    anomaly - residual / (halley * halley).mul_add(third, halley.negate_mul_add(second, slope))
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
        eccentric_anomaly(m, e)
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
        for e in [0.0, SMALL, SMALL + 1e-9, 0.5, SHORT, SHORT + 1e-9, 0.97] {
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
