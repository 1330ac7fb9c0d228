//! The solution Ξ of dΞ/dt + iΩΞ = Θ that vanishes at the epoch, for one harmonic of the orbit next to resonance: equation (9) of docs/theory-second-order.md.
//!
//! For the part g_j e^(ijl) of Θ, with the divisor Ω_j and the time τ after the epoch,
//!
//! ```text
//! Ξ = g_j e^(ijl) (1 − e^(−iΩ_jτ))/(iΩ_j)        ∂Ξ/∂Ω = g_j e^(ijl) [τ e^(−iΩ_jτ)/Ω_j − (1 − e^(−iΩ_jτ))/(iΩ_j²)]
//! ```
//!
//! Neither has a pole at Ω_j = 0. The mean variables contain nothing of this harmonic. With δ = Ω_jτ/2, the sums E + iO = iΩ Ξ and
//! E₁ + iO₁ = −iΩ² ∂Ξ/∂Ω of `fourier.rs` are
//!
//! ```text
//! E + iO = Ωτ g_j i e^(i(jl−δ)) sin δ/δ        E₁ + iO₁ = (Ωτ)² g_j i e^(i(jl−δ)) [(sin δ/δ − cos δ)/(2δ) + i sin δ/(2δ)]
//! ```

use std::f64::consts::TAU;

use crate::gravity_gradient::constants::SERIES_BELOW;
use crate::gravity_gradient::terms::divisors::Divisors;
use crate::orbit::hansen::OrbitSeries;
use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::simd::sincos::sin_cos_of_turns;

/// E, O, E₁ and O₁.
pub(super) const PARTS: usize = 4;
/// sin δ/δ in powers of δ², to 5e-17 below [`SERIES_BELOW`].
const SINE: [f64; 7] =
    [1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0, -1.0 / 39_916_800.0, 1.0 / 6_227_020_800.0];
/// (sin δ/δ − cos δ)/(2δ²), to 1e-17.
const DIFFERENCE: [f64; 7] = [
    1.0 / 6.0,
    -1.0 / 60.0,
    1.0 / 1680.0,
    -1.0 / 90_720.0,
    1.0 / 7_983_360.0,
    -1.0 / 1_037_836_800.0,
    1.0 / 186_810_624_000.0,
];

/// The solution for one harmonic.
#[derive(Clone, Debug)]
pub(crate) struct EpochSolution {
    /// j.
    number: i32,
    /// Ω and half the divisor, in the user's unit.
    rates: [f64; 2],
    /// g_j for (a/r)³ times 1, cos 2f and sin 2f; the last one without its factor −i or i.
    coefficients: [f64; 3],
}

impl EpochSolution {
    /// The solution for a harmonic in the series. `unit` is the unit of rates in the user's.
    pub(crate) fn new(number: i32, series: &OrbitSeries, divisors: &Divisors, unit: f64) -> Self {
        let coefficients = series.coefficients.get(number.unsigned_abs() as usize).copied().unwrap_or_default();
        Self { number, rates: [divisors.frequency * unit, 0.5 * divisors.smallest(number) * unit], coefficients }
    }

    /// Adds E, O, E₁ and O₁ of the three functions at a mean anomaly, which is given by its cosine and sine, and a time after the epoch.
    #[inline(always)]
    pub(super) fn add<S: InstructionSet>(
        &self,
        parts: &mut [[Lanes<S>; 3]; PARTS],
        anomaly: ComplexLanes<S>,
        elapsed: Lanes<S>,
    ) {
        let all = |value: f64| elapsed.all(value);
        let [omega, half] = self.rates;
        let delta = elapsed * all(half);
        let (sine, cosine) = sin_cos_of_turns(delta * all(1.0 / TAU));
        let square = delta * delta;
        let divisor = delta.magnitude().up_to(SERIES_BELOW, all(1.0), delta);
        let quotient = delta.magnitude().up_to(SERIES_BELOW, square.polynomial(&SINE), sine / divisor);
        let far = (quotient - cosine) / (divisor + divisor);
        let difference = delta.magnitude().up_to(SERIES_BELOW, delta * square.polynomial(&DIFFERENCE), far);
        let mut wave = ComplexLanes { re: all(1.0), im: all(0.0) };
        for _ in 0..self.number.unsigned_abs() {
            wave = wave * anomaly;
        }
        let wave = if self.number < 0 { wave.conjugate() } else { wave };
        // i e^(i(jl−δ)) Ωτ.
        let phase = elapsed * all(omega);
        let turned = wave * ComplexLanes { re: sine * phase, im: cosine * phase };
        let value = ComplexLanes { re: turned.re * quotient, im: turned.im * quotient };
        let slope = turned * ComplexLanes { re: difference * phase, im: all(0.5) * quotient * phase };
        let [one, even, odd] = self.coefficients;
        // (a/r)³ sin 2f has the factor −i for j > 0, and i for j < 0.
        let odd = if self.number < 0 { -odd } else { odd };
        for (function, factor) in [one, even].into_iter().enumerate() {
            for (part, wave) in [value.re, value.im, slope.re, slope.im].into_iter().enumerate() {
                parts[part][function] = wave.mul_add(all(factor), parts[part][function]); // function < 2
            }
        }
        for (part, wave) in [value.im, -value.re, slope.im, -slope.re].into_iter().enumerate() {
            parts[part][2] = wave.mul_add(all(odd), parts[part][2]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::C64;

    /// E + iO and E₁ + iO₁ of the three functions.
    fn sums(solution: &EpochSolution, anomaly: f64, elapsed: f64) -> [[C64; 3]; 2] {
        let one = |value: f64| Lanes::splat(pulp::Scalar, value);
        let mut parts = [[one(0.0); 3]; PARTS];
        solution.add(&mut parts, ComplexLanes { re: one(anomaly.cos()), im: one(anomaly.sin()) }, one(elapsed));
        let value = |part: usize, f: usize| parts[part][f].values()[0];
        [0, 2].map(|part| std::array::from_fn(|f| C64::new(value(part, f), value(part + 1, f))))
    }

    #[test]
    fn the_solution_vanishes_at_the_epoch_and_obeys_the_equation_of_the_generator() {
        // dΞ/dt + iΩΞ = Θ, and its derivative with respect to Ω: the time derivatives by differences of fourth order.
        for (number, divisor) in [(-7, 1e-3), (3, -0.4), (0, 0.0), (-21, 1e-9), (5, 2.5)] {
            let (omega, coefficients) = (1.3, [0.7, -0.4, if number == 0 { 0.0 } else { 0.2 }]);
            let solution = EpochSolution { number, rates: [omega, 0.5 * divisor], coefficients };
            let rate = divisor - omega; // of jl
            let start = 0.3;
            let at = |time: f64| {
                let anomaly = if number == 0 { start } else { start + rate * time / f64::from(number) };
                (anomaly, sums(&solution, anomaly, time))
            };
            assert_eq!(at(0.0).1, [[C64::default(); 3]; 2], "at the epoch");
            for time in [1e-3, 0.4, 2.0, 30.0] {
                let step = 1e-3;
                let [far, near, next, last] = [-2.0, -1.0, 1.0, 2.0].map(|k| at(time + k * step).1);
                let (anomaly, [value, slope]) = at(time);
                // A harmonic with j = 0 has no frequency of its own: then Ω is the divisor.
                let own = if number == 0 { divisor } else { omega };
                for f in 0..3 {
                    let derivative = |part: usize| {
                        (far[part][f] - last[part][f] + (next[part][f] - near[part][f]) * 8.0) / (12.0 * step)
                    };
                    let sign = f64::from(number.signum());
                    let factor = if f == 2 { C64::new(0.0, -sign) } else { 1.0.into() };
                    let torque = C64::from_polar(coefficients[f], f64::from(number) * anomaly) * factor;
                    // Ξ = (E + iO)/(iΩ) and ∂Ξ/∂Ω = −(E₁ + iO₁)/(iΩ²).
                    let wave = C64::new(0.0, -1.0 / omega);
                    let left = (derivative(0) + C64::i() * own * value[f]) * wave - torque;
                    assert!(left.norm() <= 1e-9 * (1.0 + time), "{number} {divisor:e} {time} {f}: {left}");
                    let by_omega = C64::new(0.0, 1.0 / (omega * omega));
                    let left = (derivative(1) + C64::i() * own * slope[f]) * by_omega + C64::i() * value[f] * wave;
                    assert!(left.norm() <= 1e-9 * (1.0 + time * time), "{number} {divisor:e} {time} {f}: {left}");
                }
            }
        }
    }

    #[test]
    fn quotients_by_a_small_phase_are_continuous() {
        let solution = EpochSolution { number: 1, rates: [1.0, 1.0], coefficients: [1.0, 0.0, 0.0] };
        let [below, above] = [-1.0, 1.0].map(|sign| sums(&solution, 0.2, SERIES_BELOW + sign * 1e-12));
        for (below, above) in below.iter().flatten().zip(above.iter().flatten()) {
            assert!((below - above).norm() <= 1e-11, "{below} {above}");
        }
    }
}
