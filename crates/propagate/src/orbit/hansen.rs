//! The disturbing body's part of the torque as Fourier series in its mean anomaly l: (a/r)³ times 1, cos 2f and sin 2f (Hansen's coefficients).

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use super::position::{eta, singularity};
use crate::numerics::C64;

/// The coefficients of e^(ijl), from j = 0 on.
#[derive(Clone, Debug)]
pub(crate) struct OrbitSeries {
    /// Those of (a/r)³ and (a/r)³ cos 2f, which are even and real, and of (a/r)³ sin 2f times i.
    pub(crate) coefficients: Vec<[f64; 3]>,
}

impl OrbitSeries {
    /// The series of an orbit with so many harmonics on each side of 0.
    pub(crate) fn new(eccentricity: f64, count: usize) -> Self {
        Self { coefficients: coefficients(eccentricity, 0..=count, 0) }
    }

    /// The coefficients of e^(ijl) in (a/r)³ times 1, cos 2f and sin 2f.
    pub(crate) fn at(&self, j: i32) -> [C64; 3] {
        let [one, cosine, sine] = self.coefficients[j.unsigned_abs() as usize];
        [one.into(), cosine.into(), C64::new(0.0, -sine * f64::from(j.signum()))]
    }

    /// The largest size of a coefficient in (a/r)³ times 1, e^(2if) and e^(−2if), if the series has it.
    pub(crate) fn largest(&self, number: usize) -> Option<f64> {
        let [constant, even, odd] = self.coefficients.get(number)?;
        Some(constant.abs().max(even.abs() + odd.abs()))
    }
}

/// Largest number of a harmonic of the orbit whose coefficient is computed.
pub(crate) const LARGEST_NUMBER: usize = 4096;

/// Hansen's coefficients X_j of (−3, 0), (−3, 2) and (−3, −2): the Fourier coefficients of e^(ijl) in (a/r)³ times 1, e^(2if) and e^(−2if), for j up to
/// [`LARGEST_NUMBER`].
pub(crate) fn hansen(eccentricity: f64, number: usize) -> [f64; 3] {
    // Harmonics of (a/r)² in the eccentric anomaly fall like ((1 − η)/e)^k, about e^(−ηk).
    let more = (32.0 / eta(eccentricity)).min(1e6) as usize;
    let [constant, even, odd] = coefficients(eccentricity, number..=number, more)[0];
    [constant, even + odd, even - odd]
}

/// An upper estimate of the Fourier coefficient of e^(ijl) in a product of so many factors (a/r)³ e^(±2if) or (a/r)³, over its value at the pericentre.
pub(crate) fn at_most(eccentricity: f64, number: f64, factors: i32) -> f64 {
    // On a circle one factor has the harmonics 0 and ±2.
    let beyond = number.abs() - 2.0 * f64::from(factors);
    if beyond <= 0.0 {
        1.0
    } else if eccentricity == 0.0 {
        0.0
    } else {
        // At r = 0 one factor is like (l − l₀)^(−5/2), and two are like (l − l₀)^(−5).
        // The coefficients fall like e^(−|j| times the distance of the singularity).
        let fallen = singularity(eccentricity) * beyond;
        let growing = if factors == 1 {
            (1.0 + fallen).powf(1.5)
        } else {
            1.0 + fallen * (1.0 + fallen / 2.0 * (1.0 + fallen / 3.0 * (1.0 + fallen / 4.0)))
        };
        0.5 * ((-fallen).exp() * growing).min(1.0)
    }
}

/// The coefficients of cos jl in (a/r)³ and (a/r)³ cos 2f and of sin jl in (a/r)³ sin 2f, halved but for j = 0.
fn coefficients(eccentricity: f64, numbers: RangeInclusive<usize>, more_points: usize) -> Vec<[f64; 3]> {
    // An even sum over more points than the integrand has harmonics in the eccentric anomaly is exact.
    let points = 32 + (1.25 * *numbers.end() as f64) as usize + more_points;
    let eta = eta(eccentricity);
    let (mut sums, mut largest) = (vec![[0.0; 3]; numbers.clone().count()], 0.0);
    for k in 0..points {
        // Half the orbit: the other half is its mirror image.
        let anomaly = PI * (k as f64 + 0.5) / points as f64;
        let (sine, cosine) = anomaly.sin_cos();
        let distance = 1.0 - eccentricity * cosine;
        let (x, y) = ((cosine - eccentricity) / distance, eta * sine / distance);
        let weight = 1.0 / (distance * distance * points as f64);
        let [even, odd] = [weight * (x * x - y * y), weight * 2.0 * x * y];
        let mean_anomaly = anomaly - eccentricity * sine;
        let turn = C64::from_polar(1.0, mean_anomaly);
        let mut wave = C64::from_polar(1.0, *numbers.start() as f64 * mean_anomaly);
        largest += weight;
        for sum in &mut sums {
            *sum = [sum[0] + weight * wave.re, sum[1] + even * wave.re, sum[2] + odd * wave.im];
            wave *= turn;
        }
    }
    // The power j of `turn` has j rounding errors. A smaller coefficient is rounding alone, which a small divisor would enlarge. None is larger than the mean of (a/r)³.
    for (j, sum) in numbers.zip(&mut sums) {
        let rounding = (4 + j) as f64 * f64::EPSILON * largest;
        sum.iter_mut().filter(|c| c.abs() < rounding).for_each(|c| *c = 0.0);
    }
    sums
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn largest(eccentricity: f64, number: usize) -> f64 {
        hansen(eccentricity, number).into_iter().fold(0.0, |most: f64, size| most.max(size.abs()))
    }

    #[test]
    fn coefficients_are_as_large_as_hansen_s() {
        for (eccentricity, count) in [(0.0, 2), (0.1, 20), (0.6, 100)] {
            let series = OrbitSeries::new(eccentricity, count);
            for number in 0..=count {
                let found = series.largest(number).expect("a harmonic of the series");
                let error = (found - largest(eccentricity, number)).abs();
                assert!(error <= 1e-13, "{eccentricity} {number}: {error:e}");
            }
            assert!(series.largest(count + 1).is_none());
        }
    }

    #[test]
    fn harmonics_are_hansen_s_coefficients() {
        // X_0 of (a/r)³ is η^(−3); at small e that of e^(2if) is 7e/2 for l and 1 for 2l.
        let e = 0.6_f64;
        assert!((largest(e, 0) - (1.0 - e * e).powf(-1.5)).abs() <= 1e-13);
        assert!((largest(1e-4, 2) - 1.0).abs() <= 1e-7);
        assert!((largest(1e-4, 3) - 3.5e-4).abs() <= 1e-10);
    }

    #[test]
    fn harmonics_of_a_very_eccentric_orbit_are_hansen_s_coefficients() {
        // X_0 of (−3, 2) is 0 for every e; X_1 is from a quadrature in 40 digits. A sum over 33 points gives −17.1 instead.
        let [_, mean, _] = hansen(0.99, 0);
        let [_, first, _] = hansen(0.99, 1);
        assert!(mean.abs() <= 1e-11 && (first + 0.496_058_029_176_203_1).abs() <= 1e-11, "{mean:e} {first}");
    }

    #[test]
    fn the_estimate_of_a_harmonic_is_not_below_it() {
        for eccentricity in [0.02_f64, 0.05, 0.1, 0.3, 0.6, 0.8, 0.9] {
            let eta = eta(eccentricity);
            for (factors, number) in (1..=2).flat_map(|factors| (1..40).map(move |number| (factors, number))) {
                // (a/r)³ e^(2if), or its square, by a sum that is even in the eccentric anomaly.
                let count = 4000;
                let sum: f64 = (0..count)
                    .map(|k| {
                        let (sine, cosine) = (TAU * (f64::from(k) + 0.5) / f64::from(count)).sin_cos();
                        let distance = 1.0 - eccentricity * cosine;
                        let f = (eta * sine).atan2(cosine - eccentricity);
                        let mean = sine.atan2(cosine) - eccentricity * sine;
                        let turn = f64::from(2 * factors) * f - f64::from(number) * mean;
                        ((1.0 - eccentricity) / distance).powi(3 * factors) * distance * turn.cos()
                    })
                    .sum::<f64>()
                    / f64::from(count);
                let estimate = at_most(eccentricity, f64::from(number), factors);
                assert!(sum.abs() <= estimate + 1e-14, "{eccentricity} {factors} {number}: {sum:e} {estimate:e}");
            }
        }
    }
}
