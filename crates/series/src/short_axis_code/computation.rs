//! The emitted computation: from σ, ℓ′ (and β) to ζ = (X + ix)/√M, y − y′ and the two frequencies (theory §6, §7, §8).
//!
//! Clenshaw's rule sums the Fourier series from the highest harmonic down, in e^(2iℓ′) scaled by ϱ, so no powers of s are computed. The factors cos ℓ′ of X,
//! sin ℓ′ of x and sin 2ℓ′ of y − y′ stand outside the sums, so the results keep their relative accuracy near their zeros:
//!
//! ```text
//! c_m = a_m + 2ϱ cos 2ℓ′ c_{m+1} − ϱ² c_{m+2}:   Σ a_m ϱ^m cos (2m+1)ℓ′ = cos ℓ′ (c_0 − ϱ c_1),   sin: sin ℓ′ (c_0 + ϱ c_1)
//! ```
//!
//! Here a_m = upper_m + ϱ lower_m for X and a_m = upper_m − ϱ lower_m for x. All terms of a rate have the same sign, except the first term of dℓ′/dt.

use super::coefficients::{Coefficients, Series};
use crate::emit::program::{Expression, Function, Program, call, name};
use andoyer_double::DoubleDouble;
use std::ops::{Add, Sub};

/// The names of the results, in order.
pub(super) const RESULTS: [&str; 5] =
    ["zeta_real", "zeta_imaginary", "longitude_shift", "anomaly_rate", "longitude_rate"];

/// The computation; `beta` is a number, or `None` if β is an argument of the emitted function.
pub(super) fn computation(coefficients: &Coefficients, beta: Option<f64>) -> Program {
    let mut program = Program::default();
    let radius = scales(&mut program, beta);
    trigonometry(&mut program, radius);
    oscillator(&mut program, coefficients, radius);
    longitude(&mut program, &coefficients.longitude);
    program.comment("frequencies");
    let anomaly_rate = rate(&mut program, &coefficients.anomaly_rate);
    program.assign("anomaly_rate", anomaly_rate);
    let longitude_rate = rate(&mut program, &coefficients.longitude_rate);
    program.assign("longitude_rate", name("sigma") * longitude_rate);
    program.comment("results");
    let several = coefficients.upper.len().max(coefficients.lower.len()) > 1;
    let bracket = |sum: &str, sign: fn(Expression, Expression) -> Expression| {
        let first = name(&format!("{sum}_0"));
        if several { sign(first, name(radius) * name(&format!("{sum}_1"))) } else { first }
    };
    program.assign("zeta_real", name("long_axis") * name("cosine") * bracket("real", Expression::sub));
    program.assign("zeta_imaginary", name("short_axis") * name("sine") * bracket("imaginary", Expression::add));
    let shift = name("sigma") * (name("double_sine") * name(radius) * name("shift_1"));
    program.assign("longitude_shift", if coefficients.longitude.is_empty() { 0.0.into() } else { shift });
    program.keep_what_gives(&RESULTS);
    program
}

/// Assigns s, ϱ and the axes √2ωσ, √2σ/ω of the ellipse of first order; returns the name of ϱ.
fn scales(program: &mut Program, beta: Option<f64>) -> &'static str {
    let root = |value| call(Function::SquareRoot, value);
    let Some(beta) = beta else {
        program.comment("kappa, kappa sigma, and the axes of the ellipse of first order");
        program.assign("beta_square", name("beta") * name("beta"));
        let complement = (Expression::from(1.0) - name("beta")) * (Expression::from(1.0) + name("beta"));
        program.assign("kappa", Expression::from(1.0) / root(complement));
        program.assign("omega", (Expression::from(1.0) + name("beta")) * name("kappa"));
        program.assign("s", name("kappa") * name("sigma"));
        program.assign("radius", name("beta") * name("s"));
        program.assign("long_axis", root(Expression::from(2.0) * name("omega") * name("sigma")));
        program.assign("short_axis", root(Expression::from(2.0) * name("sigma") / name("omega")));
        return "radius";
    };
    program.comment("kappa sigma, and the axes of the ellipse of first order");
    let one = DoubleDouble::ONE;
    let kappa = one / (one - DoubleDouble::product(beta, beta)).sqrt();
    let omega = (one + beta.into()) * kappa;
    let two = one + one;
    let [axis, other] = [two * omega, two / omega].map(|square| Expression::from(square.sqrt().to_f64()));
    let kappa = kappa.to_f64();
    program.assign("s", if kappa == 1.0 { name("sigma") } else { Expression::from(kappa) * name("sigma") });
    program.assign("root", root(name("sigma")));
    program.assign("long_axis", axis * name("root"));
    program.assign("short_axis", other * name("root"));
    "s"
}

/// Assigns one sine and one cosine, sin 2ℓ′ and 2ϱ cos 2ℓ′ without cancellation, and ϱ².
fn trigonometry(program: &mut Program, radius: &str) {
    program.assign("sine", call(Function::Sine, name("anomaly")));
    program.assign("cosine", call(Function::Cosine, name("anomaly")));
    program.assign("double_sine", Expression::from(2.0) * name("sine") * name("cosine"));
    let double_cosine = (name("cosine") - name("sine")) * (name("cosine") + name("sine"));
    program.assign("turn", Expression::from(2.0) * name(radius) * double_cosine);
    program.assign("square", name(radius) * name(radius));
}

/// Assigns c_m of X and of x, from the highest harmonic down to the first.
fn oscillator(program: &mut Program, coefficients: &Coefficients, radius: &str) {
    let harmonics = coefficients.upper.len().max(coefficients.lower.len());
    let series = |list: &[Series], m: usize| list.get(m).cloned().unwrap_or_default();
    for m in (0..harmonics).rev() {
        program.comment(&format!("harmonic {} of X and x", 2 * m + 1));
        let upper = program.horner("upper", "s", "beta_square", &series(&coefficients.upper, m));
        let lower = program.horner("lower", "s", "beta_square", &series(&coefficients.lower, m));
        if lower {
            program.assign("lower", name(radius) * name("lower"));
        }
        for (sum, plus) in [("real", true), ("imaginary", false)] {
            let own = match (upper, lower) {
                (true, true) if plus => name("upper") + name("lower"),
                (true, true) => name("upper") - name("lower"),
                (true, false) => name("upper"),
                (false, true) if plus => name("lower"),
                (false, true) => Expression::from(0.0) - name("lower"),
                (false, false) => Expression::from(0.0),
            };
            clenshaw(program, sum, own, m, harmonics);
        }
    }
}

/// Assigns c_k of y − y′, from the highest harmonic down to k = 1.
fn longitude(program: &mut Program, list: &[Series]) {
    for (index, series) in list.iter().enumerate().rev() {
        let k = index + 1;
        program.comment(&format!("harmonic {} of y - y'", 2 * k));
        let own = if program.horner("own", "s", "beta_square", series) { name("own") } else { 0.0.into() };
        clenshaw(program, "shift", own, k, list.len() + 1);
    }
}

/// One step of Clenshaw's rule: `own` + 2ϱ cos 2ℓ′ c_{m+1} − ϱ² c_{m+2}. The c_m with m ≥ `end` are 0.
fn clenshaw(program: &mut Program, sum: &str, own: Expression, m: usize, end: usize) {
    let mut value = own;
    if m + 1 < end {
        value = value + name("turn") * name(&format!("{sum}_{}", m + 1));
    }
    if m + 2 < end {
        value = value - name("square") * name(&format!("{sum}_{}", m + 2));
    }
    program.assign(&format!("{sum}_{m}"), value);
}

/// The value of a power series in s.
fn rate(program: &mut Program, series: &Series) -> Expression {
    if program.horner("rate", "s", "beta_square", series) { name("rate") } else { 0.0.into() }
}
