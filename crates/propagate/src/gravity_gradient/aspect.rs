//! How strongly a harmonic of the orbit acts on the terms of each m. This depends on the direction of the angular momentum relative to the orbit.

use nalgebra::{Unit, UnitQuaternion, Vector3};
use num_complex::Complex;

use super::contraction::{Tensor, coefficients, contraction, factors};
use super::orbit_series::OrbitSeries;

/// Angles about the normal of the orbit by which the angular momentum may precess \[rad\].
const PRECESSIONS: [f64; 3] = [-0.3, 0.0, 0.3];
/// Safety factor for precession.
const PRECESSION_MARGIN: f64 = 1.5;
/// The strength is at least this share of what it is at most for any direction.
const LEAST_SHARE: f64 = 0.2;

/// The tensors of 1, cos 2f and sin 2f for some directions of the angular momentum, in frames with axis 3 along it.
#[derive(Clone, Debug)]
pub(crate) struct Aspect([[Tensor; 3]; PRECESSIONS.len()]);

impl Aspect {
    /// From the axes of the orbit and the direction of the angular momentum.
    pub(crate) fn new([first, second, normal]: [Vector3<f64>; 3], pole: &Vector3<f64>) -> Self {
        let at = |angle: f64| {
            let turned = UnitQuaternion::from_axis_angle(&Unit::new_normalize(normal), angle) * pole;
            // There is no such rotation for a half turn.
            let to_frame = UnitQuaternion::rotation_between(&turned, &Vector3::z())
                .unwrap_or_else(|| UnitQuaternion::new(Vector3::x() * std::f64::consts::PI));
            factors([to_frame * first, to_frame * second])
        };
        Self(PRECESSIONS.map(at))
    }

    /// Upper estimate of the largest component of the contraction of (a/r)³ r̂r̂ and of its derivatives in e^(ijl), for m.
    pub(super) fn strength(&self, series: &OrbitSeries, harmonic: i32, multiple: i32) -> f64 {
        let Some(of_functions) = series.coefficients.get(harmonic.unsigned_abs() as usize) else {
            return 0.0;
        };
        let coefficients = coefficients(of_functions, f64::from(harmonic));
        let size = |tensors: &[Tensor; 3]| {
            let mut sums = [Complex::default(); 3];
            for (tensor, coefficient) in tensors.iter().zip(coefficients) {
                for (sum, part) in sums.iter_mut().zip(contraction(tensor, multiple)) {
                    *sum += coefficient * part;
                }
            }
            sums.iter().map(|sum: &Complex<f64>| sum.norm_sqr()).fold(0.0, f64::max).sqrt()
        };
        let largest = of_functions.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
        (PRECESSION_MARGIN * self.0.iter().map(size).fold(0.0, f64::max)).max(LEAST_SHARE * largest)
    }
}
