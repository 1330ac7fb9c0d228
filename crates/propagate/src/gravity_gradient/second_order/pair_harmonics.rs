//! The disturbing body's part of the torque as a Fourier series in its mean anomaly l, and the divisors that belong to it: equation (5) of
//! docs/theory-second-order.md.
//!
//! With Θ = Σ_j Θ_j e^(ijl), the solution Ξ is Σ_j Θ_j e^(ijl)/(i(Ω + jn)). The sums over time derivatives are its expansion in
//! jn/Ω, so they contain low harmonics to a few powers of jn/Ω and no high ones. Here nothing is expanded. A harmonic that does not return within the span is
//! no part of the mean: the divisor has the factor 1 − e^(−Ω_j² span²/4). The factor must reach 1 fast: with 1 − sin(Ω_j span)/(Ω_j span), which is that of the mean
//! over the span on either side, the error of the attitude was four times as large in scenes without a resonance, because the corrections take the regular harmonics as a
//! whole.

use super::pair_terms::{ContractedPart, PairTerm};
use crate::gravity_gradient::constants::SUMMED_ABOVE;
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::first_order::fourier::ExactTerm;
use crate::gravity_gradient::first_order::mean_variables::Mean;
use crate::gravity_gradient::terms::divisors::Divisors;
use crate::gravity_gradient::terms::term::slow_limit;
use crate::numerics::C64;
use crate::orbit::kepler::Place;
use crate::orbit::tensor::products_at;
use crate::torque::{Contraction, contraction};

/// The factors of f in the functions of the series.
const TURNS: [i32; 3] = [0, 2, -2];
/// Highest |j| of the harmonics of ⟨D⟩ that are paired with single harmonics of terms. At e = 0.6 the next one is 1/400 of the mean of ⟨D⟩.
const MOST_OF_AVERAGE: usize = 24;

/// A term whose divisors are exact, in parts.
#[derive(Clone, Debug)]
pub(crate) struct SplitTerm {
    /// The harmonics of the orbit near resonance. Each is a term of its own.
    pub(crate) near: Vec<PairTerm>,
    /// The other harmonics together.
    pub(crate) rest: PairTerm,
}

/// The series of one orbit at one place of the disturbing body.
pub(crate) struct OrbitHarmonics {
    /// The part of Θ_j e^(ijl) by (a/r)³ times 1, e^(2if) and e^(−2if), from −j to j.
    waves: Vec<[C64; 3]>,
    /// The contractions for m = 0, 1, 2 of the tensors that belong to these functions.
    contracted: [[Contraction; 3]; 3],
    /// Largest size of (a/r)³ r̂r̂ on the orbit.
    largest: f64,
    mean_motion: f64,
    /// The span.
    duration: f64,
    /// Terms of a lower frequency have no sum over time derivatives.
    slow_limit: f64,
}

impl OrbitHarmonics {
    /// The series in the frame of a mean state, if the orbit has one.
    pub(crate) fn new(mean: &Mean, place: &Place<pulp::Scalar>, disturbance: &Disturbance<'_>) -> Option<Self> {
        let series = disturbance.series.as_ref()?;
        let count = series.coefficients.len() as i32 - 1;
        let at = place.angle.values()[0] - place.centre.values()[0];
        let waves = (-count..=count).map(|j| {
            let turn = C64::from_polar(1.0, f64::from(j) * at);
            let [one, cosine, sine] = series.at(j);
            let [even, odd] = [cosine, C64::i() * sine];
            [one, even + odd, even - odd].map(|coefficient| turn * coefficient)
        });
        let (tensors, _) = products_at(&mean.frame, disturbance.orbit.axes());
        Some(Self {
            waves: waves.collect(),
            contracted: [0, 1, 2].map(|m| {
                let [one, cosine, sine] = tensors.map(|tensor| contraction(&tensor, m));
                let half = |sign: f64| std::array::from_fn(|i| 0.5 * (cosine[i] - C64::new(0.0, sign) * sine[i]));
                [one, half(1.0), half(-1.0)]
            }),
            largest: disturbance.envelope.orbital.norms[0],
            mean_motion: disturbance.mean_motion,
            duration: disturbance.duration,
            slow_limit: slow_limit(disturbance),
        })
    }

    /// c_m of Ξ for a frequency Ω; `term` is the correction with exact divisors, if there is one.
    pub(crate) fn solution(&self, omega: f64, multiple: i32, term: Option<&ExactTerm>) -> C64 {
        let count = (self.waves.len() / 2) as i32;
        let mut sums = [C64::default(); 3];
        for (i, harmonic) in self.waves.iter().enumerate() {
            let j = i as i32 - count;
            let unshifted = self.inverse(omega + f64::from(j) * self.mean_motion, omega);
            for ((sum, part), turns) in sums.iter_mut().zip(harmonic).zip(TURNS) {
                let inverse = match term {
                    Some(term) => term.divisors.reciprocal(j, turns),
                    _ => unshifted,
                };
                *sum += part * inverse;
            }
        }
        let contracted = &self.contracted[multiple as usize]; // 0 ≤ m ≤ 2
        sums.iter().zip(contracted).map(|(sum, part)| sum * part[0]).sum::<C64>() * -C64::i()
    }

    /// A term, split into the harmonics near resonance and the rest. It comes without amplitudes, and with the relative rate of change of the mean variables by it. A term
    /// without a sum over time derivatives has no rest.
    pub(crate) fn split(&self, (whole, strength): (PairTerm, f64), divisors: &Divisors) -> SplitTerm {
        let count = (self.waves.len() / 2) as i32;
        let multiple = whole.multiple as usize; // 0 ≤ m ≤ 2
        let [_, by_sigma, by_momentum] = whole.frequency;
        let mut split = SplitTerm { near: Vec::new(), rest: whole };
        for (i, harmonic) in self.waves.iter().enumerate() {
            let j = i as i32 - count;
            if divisors.resonant == Some(j) {
                continue;
            }
            let torque = self.contracted(harmonic, multiple);
            let unshifted = divisors.unshifted(j);
            if divisors.is_single(j) {
                let mut generator = ContractedPart::default();
                for (k, turns) in TURNS.into_iter().enumerate() {
                    let functions = &self.contracted[multiple][k];
                    generator.add(functions.map(|function| harmonic[k] * function), divisors.reciprocal(j, turns));
                }
                let (divisor, shifted) = (divisors.smallest(j), divisors.is_shifted(j));
                let share = torque.iter().map(|part| part.norm_sqr()).fold(0.0, f64::max).sqrt() / self.largest;
                split.near.push(PairTerm {
                    size: share * strength / divisor.abs(),
                    frequency: [divisor, by_sigma, by_momentum],
                    unshifted,
                    torque: [torque.into(), ContractedPart::default()],
                    generator: [generator, ContractedPart::default()],
                    single: true,
                    shifted,
                    ..whole
                });
            } else {
                split.rest.add(torque, f64::from(j) * self.mean_motion, 1.0 / unshifted);
            }
        }
        split
    }

    /// The lowest harmonics of ⟨D⟩.
    pub(crate) fn average(&self, average: &PairTerm) -> Vec<PairTerm> {
        let count = self.waves.len() / 2;
        let most = count.min(MOST_OF_AVERAGE);
        let harmonics = (count - most..=count + most).map(|i| {
            let frequency = [(i as f64 - count as f64) * self.mean_motion, 0.0, 0.0];
            let torque = [self.contracted(&self.waves[i], 0).into(), ContractedPart::default()];
            PairTerm { frequency, torque, single: true, ..*average }
        });
        harmonics.collect()
    }

    /// One harmonic's contraction.
    fn contracted(&self, harmonic: &[C64; 3], multiple: usize) -> Contraction {
        let functions = &self.contracted[multiple];
        std::array::from_fn(|i| harmonic.iter().zip(functions).map(|(part, function)| part * function[i]).sum())
    }

    /// The reciprocal of a divisor, with the factor 1 − e^(−Ω_j² span²/4) where the sums over time derivatives do not contain the harmonic.
    fn inverse(&self, divisor: f64, omega: f64) -> f64 {
        let summed = omega.abs() > self.slow_limit && divisor.abs() > SUMMED_ABOVE * omega.abs();
        if summed { 1.0 / divisor } else { inverse(divisor, self.duration) }
    }
}

/// The reciprocal of a divisor, with the factor 1 − e^(−Ω_j² span²/4).
pub(crate) fn inverse(divisor: f64, duration: f64) -> f64 {
    let turn = 0.5 * divisor * duration;
    if turn == 0.0 { 0.0 } else { -(-turn * turn).exp_m1() / divisor }
}

/// The time over which a harmonic acts without returning.
pub(crate) fn unreturned(divisor: f64, duration: f64) -> f64 {
    let turn = 0.5 * divisor * duration;
    duration * (-turn * turn).exp()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use nalgebra::{UnitQuaternion, Vector3};

    use super::*;
    use crate::gravity_gradient::disturbance::whole;
    use crate::gravity_gradient::second_order::pair_terms::tensors;
    use crate::gravity_gradient::terms::divisors::AverageShift;
    use crate::orbit::elements::Orbit;
    use crate::simd::lanes::Lanes;

    const MEAN_MOTION: f64 = 0.02;

    /// Calls `with` with a state and an orbit of many harmonics.
    fn on_orbit<R>(eccentricity: f64, duration: f64, with: impl FnOnce(&Mean, &Disturbance<'_>) -> R) -> R {
        let orbit =
            Orbit::new(MEAN_MOTION, eccentricity).and_then(|orbit| orbit.plane(0.4, 1.0, 2.0)).expect("an orbit");
        let frame = UnitQuaternion::from_euler_angles(0.3, -0.7, 1.1);
        let disturbance = Disturbance { duration, ..whole(&orbit, frame * Vector3::z()) };
        with(&Mean { p: C64::new(0.1, 0.0), longitude: 0.0, momentum: 1.0, frame }, &disturbance)
    }

    /// A term of this frequency, and the relative rate of change by it.
    fn term(omega: f64, multiple: i32) -> (PairTerm, f64) {
        (PairTerm { multiple: f64::from(multiple), frequency: [omega, 0.0, 0.0], ..PairTerm::default() }, 1.0)
    }

    /// c_m of Ξ for a span, and by the quadrature ∫ e^(iΩτ) Θ(τ) dτ over the period before, over 1 − e^(−iΩP).
    fn solutions(eccentricity: f64, omega: f64, multiple: i32, duration: f64) -> [C64; 2] {
        on_orbit(eccentricity, duration, |mean, disturbance| solutions_at(mean, disturbance, omega, multiple))
    }

    fn solutions_at(mean: &Mean, disturbance: &Disturbance<'_>, omega: f64, multiple: i32) -> [C64; 2] {
        let eccentricity = disturbance.orbit.eccentricity();
        let frame = mean.frame;
        let place = |anomaly: f64| Place::of(Lanes::splat(pulp::Scalar, anomaly), eccentricity);
        let (points, start, period) = (4000, 0.8, TAU / MEAN_MOTION);
        let [first, second, _] = disturbance.orbit.axes().map(|axis| frame.inverse() * axis);
        let sum: C64 = (0..points)
            .map(|k| {
                let back = k as f64 / points as f64;
                let wrapped = start - TAU * back;
                let place = place(wrapped - TAU * (wrapped / TAU).round());
                let (sine, cosine) = (place.sine.values()[0], place.cosine.values()[0]);
                let to_body = first * cosine + second * sine;
                let cube = ((1.0 + eccentricity * cosine) / (1.0 - eccentricity * eccentricity)).powi(3);
                let [x, y, z] = to_body.into();
                let tensor = [z * z - 0.5 * (x * x + y * y), y * y - x * x, x * y, x * z, y * z];
                let tensor = tensor.map(|part: f64| Lanes::splat(pulp::Scalar, cube * part));
                C64::from_polar(1.0, -omega * period * back) * contraction(&tensor, multiple)[0]
            })
            .sum();
        // The integrand jumps by 1 − e^(−iΩP) of its value at the end: the trapezoidal rule and its first correction.
        let now = tensors(mean, disturbance)(&place(start));
        let value = |j: usize| contraction(&now[j], multiple)[0];
        let jump = 1.0 - C64::from_polar(1.0, -omega * period);
        let step = period / points as f64;
        let slope = C64::i() * omega * value(0) + value(1);
        let quadrature = (sum * step - value(0) * jump * (0.5 * step) - slope * jump * (step * step / 12.0)) / jump;
        let series = OrbitHarmonics::new(mean, &place(start), disturbance).expect("few harmonics");
        [series.solution(omega, multiple, None), quadrature]
    }

    #[test]
    fn the_series_solves_the_equation_of_the_generator_between_harmonics() {
        for (eccentricity, number) in [(0.0, 1.6), (0.1, 3.3), (0.6, 7.3), (0.6, -12.6), (0.75, 20.4)] {
            for multiple in 0..3 {
                let [series, quadrature] = solutions(eccentricity, number * MEAN_MOTION, multiple, 1e6);
                // Series left out at 1e-12, and (Ω step)⁴/720 of the quadrature.
                let gap = (series - quadrature).norm() / quadrature.norm();
                assert!(gap <= 1e-8, "{eccentricity} {number} {multiple}: {gap:e}");
            }
        }
    }

    #[test]
    fn a_harmonic_that_does_not_return_is_no_part_of_the_mean() {
        // Ω = −6.9999 n: the divisor of the seventh harmonic is 2e-6, which returns in 3e6 units of time.
        let at = |duration: f64| solutions(0.3, -6.9999 * MEAN_MOTION, 2, duration)[0].norm();
        let [short, long] = [at(1e3), at(1e8)];
        assert!(long >= 100.0 * short, "{short:e} {long:e}");
        // Those that the sums have are there in any time.
        assert!(at(1e-3) >= 0.1 * short, "{:e} {short:e}", at(1e-3));
    }

    #[test]
    fn a_term_split_into_harmonics_is_the_term() {
        on_orbit(0.6, 1e6, |mean, disturbance| {
            let place = Place::of(Lanes::splat(pulp::Scalar, 0.8), 0.6);
            let tensors = tensors(mean, disturbance)(&place);
            let series = OrbitHarmonics::new(mean, &place, disturbance).expect("few harmonics");
            // The last is slow: all its harmonics are terms.
            for (number, multiple) in [(22.6, 0), (-31.4, 1), (1.3, 2)] {
                let omega = number * MEAN_MOTION;
                let divisors =
                    Divisors::new((1, multiple), [omega, MEAN_MOTION], multiple == 2, &AverageShift::default());
                let SplitTerm { near, rest } = series.split(term(omega, multiple), &divisors);
                assert!(if multiple == 2 { near.len() > 100 } else { near.len() == 5 }, "{}", near.len());
                let (mut torque, mut change, mut generator) =
                    (rest.torque[0].value, rest.torque[1].value[0], rest.generator[0].value[0]);
                for harmonic in &near {
                    let added = harmonic.torque[0].value;
                    torque = std::array::from_fn(|i| torque[i] + added[i]);
                    change += added[0] * C64::i() * (harmonic.unshifted - omega);
                    generator += harmonic.generator[0].value[0];
                }
                let expected = contraction(&tensors[0], multiple);
                let scale = expected.iter().map(|part| part.norm()).fold(0.0, f64::max);
                let off = torque.iter().zip(expected).map(|(one, other)| (one - other).norm()).fold(0.0, f64::max);
                assert!(off <= 1e-9 * scale, "{number} {off:e}");
                let by_time = contraction(&tensors[1], multiple)[0];
                assert!((change - by_time).norm() <= 1e-8 * by_time.norm(), "{number} {change} {by_time}");
                let whole = series.solution(omega, multiple, None);
                assert!((generator - whole).norm() <= 1e-9 * whole.norm(), "{number} {generator} {whole}");
            }
        });
    }

    #[test]
    fn the_slope_of_a_split_generator_is_its_derivative_with_respect_to_the_frequency() {
        on_orbit(0.6, 1e6, |mean, disturbance| {
            let place = Place::of(Lanes::splat(pulp::Scalar, 0.8), 0.6);
            let series = OrbitHarmonics::new(mean, &place, disturbance).expect("few harmonics");
            for (number, multiple) in [(22.6, 0), (-31.4, 1), (1.3, 2)] {
                let generator = |omega: f64| {
                    let divisors =
                        Divisors::new((1, multiple), [omega, MEAN_MOTION], multiple == 2, &AverageShift::default());
                    let SplitTerm { near, rest } = series.split(term(omega, multiple), &divisors);
                    near.iter()
                        .map(|harmonic| harmonic.generator[0])
                        .fold((rest.generator[0].value[0], rest.generator[0].slope), |(value, slope), part| {
                            (value + part.value[0], slope + part.slope)
                        })
                };
                let (omega, step) = (number * MEAN_MOTION, 1e-4 * MEAN_MOTION);
                let difference = (generator(omega + step).0 - generator(omega - step).0) / (2.0 * step);
                let (_, slope) = generator(omega);
                // The third derivative times step²/6 at a divisor of 0.3 n.
                assert!((slope - difference).norm() <= 1e-6 * slope.norm(), "{number} {slope} {difference}");
            }
        });
    }
}
