//! The disturbing body's part of the torque as Fourier series in its mean anomaly l: (a/r)³ times 1, cos 2f and sin 2f.

use std::f64::consts::{PI, TAU};

use num_complex::Complex;

use super::envelope::{Reach, decay};

type C64 = Complex<f64>;

/// Harmonics below e^(−`LOG_CUTOFF`) of the largest are left out.
const LOG_CUTOFF: f64 = 28.0;
/// Most harmonics; more are needed from an eccentricity of 0.8 on.
const MOST_HARMONICS: f64 = 320.0;
/// Least length of the longer side of a span in orbits: without the pericentre, and with it or on a circle.
pub(super) const FEWEST_ORBITS: [f64; 2] = [1.5, 0.3];

/// The coefficients of e^(ijl), from j = 0 on.
#[derive(Clone, Debug)]
pub(crate) struct OrbitSeries {
    /// Those of (a/r)³ and (a/r)³ cos 2f, which are even and real, and of (a/r)³ sin 2f times i.
    pub(crate) coefficients: Vec<[f64; 3]>,
}

impl OrbitSeries {
    /// The series of an orbit, or `None` if it needs too many harmonics or the longer side of the span is shorter than [`FEWEST_ORBITS`]. Far from the
    /// pericentre the sums over time derivatives are better until the next passage, because the series takes the mean over all passages.
    pub(crate) fn new(reach: &Reach) -> Option<Self> {
        let count = count(reach.eccentricity)?;
        let fewest = FEWEST_ORBITS[usize::from(reach.eccentricity == 0.0 || reach.passes())];
        (reach.longest() >= fewest * TAU).then(|| Self { coefficients: coefficients(reach.eccentricity, count) })
    }

    /// The largest size of a coefficient in (a/r)³ times 1, e^(2if) and e^(−2if), as [`harmonic`](super::envelope::harmonic), if the series has it.
    pub(super) fn largest(&self, number: usize) -> Option<f64> {
        let [constant, even, odd] = self.coefficients.get(number)?;
        Some(constant.abs().max(even.abs() + odd.abs()))
    }
}

/// Number of harmonics on each side of 0: they fall like e^(−|j|(arcosh 1/e − η)), as Hansen's coefficients do.
fn count(eccentricity: f64) -> Option<usize> {
    if eccentricity == 0.0 {
        return Some(2);
    }
    let count = 6.0 + LOG_CUTOFF / decay(eccentricity);
    (count <= MOST_HARMONICS).then_some(count as usize)
}

/// The coefficients of cos jl in (a/r)³ and (a/r)³ cos 2f and of sin jl in (a/r)³ sin 2f, halved but for j = 0.
fn coefficients(eccentricity: f64, count: usize) -> Vec<[f64; 3]> {
    // An even sum over more points than the integrand has harmonics in the eccentric anomaly is exact.
    let points = 32 + (1.25 * count as f64) as usize;
    let eta = ((1.0 - eccentricity) * (1.0 + eccentricity)).sqrt();
    let mut sums = vec![[0.0; 3]; count + 1];
    for k in 0..points {
        // Half the orbit: the other half is its mirror image.
        let anomaly = PI * (k as f64 + 0.5) / points as f64;
        let (sine, cosine) = anomaly.sin_cos();
        let distance = 1.0 - eccentricity * cosine;
        let (x, y) = ((cosine - eccentricity) / distance, eta * sine / distance);
        let weight = 1.0 / (distance * distance * points as f64);
        let [even, odd] = [weight * (x * x - y * y), weight * 2.0 * x * y];
        let turn = C64::from_polar(1.0, anomaly - eccentricity * sine);
        let mut wave = C64::new(1.0, 0.0);
        for sum in &mut sums {
            *sum = [sum[0] + weight * wave.re, sum[1] + even * wave.re, sum[2] + odd * wave.im];
            wave *= turn;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gravity_gradient::envelope::harmonic;

    #[test]
    fn coefficients_are_as_large_as_hansen_s() {
        for eccentricity in [0.0, 0.1, 0.6] {
            let series =
                OrbitSeries::new(&Reach { eccentricity, anomaly: 0.0, sides: [TAU; 2] }).expect("few harmonics");
            let count = series.coefficients.len();
            for number in 0..count {
                let largest = series.largest(number).expect("a harmonic of the series");
                let error = (largest - harmonic(eccentricity, number as f64)).abs();
                assert!(error <= 1e-13, "{eccentricity} {number}: {error:e}");
            }
            assert!(series.largest(count).is_none());
        }
    }

    #[test]
    fn orbits_with_too_many_harmonics_and_spans_without_a_pericentre_are_left_to_the_sums() {
        let serves = |eccentricity: f64, anomaly: f64, orbits: f64| {
            OrbitSeries::new(&Reach { eccentricity, anomaly, sides: [TAU * orbits, 0.0] }).is_some()
        };
        assert!(serves(0.0, 1.0, 3.0) && serves(0.8, 1.0, 3.0) && !serves(0.82, 1.0, 3.0));
        assert!(serves(0.3, 1.0, 0.4) && !serves(0.3, PI, 0.4) && serves(0.0, PI, 0.4) && !serves(0.3, 1.0, 0.2));
    }
}
