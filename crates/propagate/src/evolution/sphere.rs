//! Torques that are functions of the direction to a source: their projection on harmonics by quadrature on the sphere, and their values.
//!
//! A rule with n + 1 Gauss–Legendre nodes in z and 2n + 2 longitudes integrates harmonics up to the degree 2n + 1 exactly.

use std::f64::consts::{PI, SQRT_2, TAU};

use nalgebra::Vector3;

use super::harmonic::{Form, zonal_sum};
use crate::error::{Error, torque_refused};
use crate::input::torque::{MOST_DEGREE, PolynomialTorque, Torque};
use crate::input::torque_source::TorqueSource;

/// A torque that is known on the sphere is sampled up to this degree beyond that of its polynomials: for light on facets it keeps the aliasing below the truncation.
const BEYOND: u32 = 16;

/// Unit vectors with weights whose sum is 1, exact for harmonics up to twice the degree.
#[derive(Clone, Debug)]
pub struct SphereRule {
    points: Vec<(Vector3<f64>, f64)>,
    degree: u32,
}

impl SphereRule {
    /// The rule at whose points a torque must be known for polynomials of this degree.
    ///
    /// # Errors
    /// - [`Error::Torque`] for a degree of 0 or above 8.
    pub fn of_degree(degree: u32) -> Result<Self, Error> {
        check_degree(degree)?;
        let n = degree + BEYOND;
        let nodes = gauss_legendre(n as usize + 1);
        let longitudes = 2 * n + 2;
        let point = |(z, weight): (f64, f64)| {
            (0..longitudes).map(move |j| {
                let (sine, cosine) = (TAU * (f64::from(j) + 0.5) / f64::from(longitudes)).sin_cos();
                let across = (1.0 - z * z).sqrt();
                (Vector3::new(across * cosine, across * sine, z), 0.5 * weight / f64::from(longitudes))
            })
        };
        Ok(Self { points: nodes.into_iter().flat_map(point).collect(), degree })
    }

    /// The unit vectors.
    pub fn directions(&self) -> Vec<[f64; 3]> {
        self.points.iter().map(|(point, _)| (*point).into()).collect()
    }

    /// The torque with these values at the directions, as polynomials in the direction to a source.
    ///
    /// # Errors
    /// - [`Error::Length`] for another number of values; [`Error::Torque`] for a value that is not finite, and as [`Torque::polynomial`].
    pub fn torque(&self, values: &[[f64; 3]], source: TorqueSource) -> Result<Torque, Error> {
        if values.len() != self.points.len() {
            return Err(Error::Length { argument: "table", found: values.len(), expected: self.points.len() });
        }
        if let Some(value) = values.iter().flatten().find(|value| !value.is_finite()) {
            return Err(torque_refused("table", value, "finite at every direction"));
        }
        let mut forms = [Form::zero(), Form::zero(), Form::zero()];
        for l in 0..=self.degree {
            // H_l(u) = (2l+1) Σ w T(s) P_l(s·u)
            let weighted = self.points.iter().zip(values);
            let terms: Vec<_> = weighted
                .map(|((point, weight), value)| (*point, Vector3::from(*value) * (weight * f64::from(2 * l + 1))))
                .collect();
            let harmonic = zonal_sum(l, &terms)?;
            forms.iter_mut().zip(&harmonic).for_each(|(form, part)| *form += part);
        }
        let size = values.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
        self.truncated(&forms, (values, size), source)
    }

    /// Values at the directions of three sums of orthonormal real harmonics: index l² + l + m, √2 cos mφ for m > 0, √2 sin |m|φ for m < 0, without (−1)^m.
    ///
    /// # Errors
    /// - [`Error::Torque`] for a number of coefficients that is no square, or with a degree that the rule does not resolve.
    pub fn of_harmonics(&self, coefficients: &[Vec<f64>; 3]) -> Result<Vec<[f64; 3]>, Error> {
        let (count, most) = (coefficients[0].len(), (self.degree + BEYOND) as usize);
        let highest = count.isqrt().saturating_sub(1);
        let uneven = coefficients.iter().any(|row| row.len() != count);
        if uneven || (highest + 1) * (highest + 1) != count || highest > most {
            return Err(torque_refused("table", count, &format!("(d + 1)² coefficients, d at most {most}")));
        }
        let value = |(point, _): &(Vector3<f64>, f64)| {
            let harmonics = real_harmonics(point, highest);
            coefficients.each_ref().map(|row| row.iter().zip(&harmonics).map(|(c, y)| c * y).sum::<f64>())
        };
        Ok(self.points.iter().map(value).collect())
    }

    /// The torque of these polynomials, and what they leave out of the values at the directions. Coefficients below the rounding errors of `size` are dropped.
    pub(super) fn truncated(
        &self,
        forms: &[Form; 3],
        (values, size): (&[[f64; 3]], f64),
        source: TorqueSource,
    ) -> Result<Torque, Error> {
        let forms = forms.each_ref().map(|form| form.filter(|_, coefficient| coefficient.abs() > 1e-14 * size));
        let (mut left, mut whole) = (0.0, 0.0);
        for ((point, weight), value) in self.points.iter().zip(values) {
            let value = Vector3::from(*value);
            left += weight * (evaluated(&forms, point)? - value).norm_squared();
            whole += weight * value.norm_squared();
        }
        let torque = Torque::of_shape(&forms, source)?;
        torque.truncated(if whole.sqrt() > 1e-14 * size { (left / whole).sqrt() } else { 0.0 })
    }
}

impl PolynomialTorque {
    /// The torque for a direction to its source, of any length, at the reference distance.
    ///
    /// # Errors
    /// - [`Error::Torque`] for polynomials with rates, or with other than one source.
    /// - [`Error::Direction`] for a direction of 0, or that is not finite.
    pub fn value(&self, direction: [f64; 3]) -> Result<[f64; 3], Error> {
        let of_rates =
            self.terms().iter().flatten().any(|(_, exponents)| exponents.iter().rev().take(3).any(|e| *e > 0));
        if self.sources().len() != 1 || of_rates {
            return Err(torque_refused("value", self.sources().len(), "of polynomials in the direction to one source"));
        }
        let u = Vector3::from(direction);
        if !(u.amax() > 0.0 && u.amax().is_finite()) {
            return Err(Error::Direction { argument: "u", value: direction.to_vec() });
        }
        let u = self.turn() * (u / u.amax()).normalize();
        let component = |terms: &[(f64, Vec<u32>)]| -> f64 {
            let term = |(c, e): &(f64, Vec<u32>)| c * (0..3).map(|axis| u[axis].powi(e[axis] as i32)).product::<f64>();
            terms.iter().map(term).sum()
        };
        let [first, second, third] = self.terms();
        Ok((self.turn().transpose() * Vector3::new(component(first), component(second), component(third))).into())
    }
}

/// # Errors
/// - [`Error::Torque`] for 0 and above 8.
pub(super) fn check_degree(degree: u32) -> Result<(), Error> {
    if (1..=MOST_DEGREE).contains(&degree) { Ok(()) } else { Err(torque_refused("degree", degree, "from 1 to 8")) }
}

fn evaluated(forms: &[Form; 3], u: &Vector3<f64>) -> Result<Vector3<f64>, Error> {
    let [first, second, third] = forms.each_ref().map(|form| form.evaluate(u.as_slice()));
    Ok(Vector3::new(first?, second?, third?))
}

/// Orthonormal real harmonics of a unit vector up to a degree.
fn real_harmonics(u: &Vector3<f64>, highest: usize) -> Vec<f64> {
    let mut harmonics = vec![0.0; (highest + 1) * (highest + 1)];
    // ρ^m cos mφ and ρ^m sin mφ are those of (x + iy)^m; P_l^m/ρ^m is a polynomial in z.
    let (mut cosine, mut sine, mut norm) = (1.0, 0.0, (0.25 / PI).sqrt());
    for m in 0..=highest {
        let (mut before, mut here) = (0.0, norm);
        for l in m..=highest {
            let (n, k) = (l as f64, m as f64);
            if l > m {
                // P_l = √((4l²−1)/(l²−m²)) (z P_(l−1) − √(((l−1)²−m²)/(4(l−1)²−1)) P_(l−2))
                let one = n - 1.0;
                let last =
                    if l == m + 1 { 0.0 } else { ((one * one - k * k) / (4.0 * one * one - 1.0)).sqrt() * before };
                let next = ((4.0 * n * n - 1.0) / (n * n - k * k)).sqrt() * (u.z * here - last);
                (before, here) = (here, next);
            }
            let place = l * l + l;
            if m == 0 {
                harmonics[place] = here;
            } else {
                harmonics[place + m] = SQRT_2 * here * cosine;
                harmonics[place - m] = SQRT_2 * here * sine;
            }
        }
        (cosine, sine) = (cosine * u.x - sine * u.y, cosine * u.y + sine * u.x);
        norm *= ((2.0 * m as f64 + 3.0) / (2.0 * m as f64 + 2.0)).sqrt();
    }
    harmonics
}

/// Nodes and weights on (−1, 1), by Newton's method on P_n.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        // Quadratic convergence from an error of 1/n²: five steps reach 1e-16.
        for _ in 0..6 {
            let [mut before, mut value] = [1.0, x];
            for l in 1..n {
                let l = l as f64;
                [before, value] = [value, ((2.0 * l + 1.0) * x * value - l * before) / (l + 1.0)];
            }
            slope = n as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}
