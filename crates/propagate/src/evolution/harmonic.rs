//! Harmonic polynomials of a direction u = (u₁, u₂, u₃): the parts of a polynomial, and sums of Legendre polynomials (weak torques (3), (9)).

use std::collections::BTreeMap;

use andoyer_series::{Monomial, Polynomial};
use nalgebra::Vector3;

use crate::error::Error;

/// A polynomial in the components of a direction.
pub(super) type Form = Polynomial<f64>;

/// u₁² + u₂² + u₃².
fn square() -> Result<Form, Error> {
    let terms = [[2, 0, 0], [0, 2, 0], [0, 0, 2]].map(|exponents: [u32; 3]| Monomial::new(&exponents));
    let terms = terms.into_iter().map(|monomial| monomial.map(|monomial| (monomial, 1.0)));
    Ok(Form::from_terms(terms.collect::<Result<Vec<_>, _>>()?))
}

fn laplacian(form: &Form) -> Result<Form, Error> {
    let mut sum = Form::zero();
    for axis in 0..3 {
        sum += &form.derivative(axis)?.derivative(axis)?;
    }
    Ok(sum)
}

/// n!! in floating point: 35!! exceeds 64 bits.
fn double_factorial(n: i32) -> f64 {
    (1..=n).rev().step_by(2).map(f64::from).product()
}

/// The harmonic parts of a polynomial on the sphere by their degrees (3).
pub(super) fn harmonic_parts(form: &Form) -> Result<BTreeMap<u32, Form>, Error> {
    let mut parts: BTreeMap<u32, Form> = BTreeMap::new();
    for n in 0..=form.degree().unwrap_or(0) {
        let mut laplacians = vec![form.homogeneous_part(n)];
        for k in 1..=n as usize / 2 {
            laplacians.push(laplacian(&laplacians[k - 1])?);
        }
        for j in 0..=n / 2 {
            let part = harmonic_part(&laplacians[j as usize..], (n as i32, j as i32))?;
            *parts.entry(n - 2 * j).or_insert_with(Form::zero) += &part;
        }
    }
    parts.retain(|_, part| !part.is_zero());
    Ok(parts)
}

/// h_m of a homogeneous polynomial of degree n, m = n − 2j, from its Laplacians of the orders j and above.
fn harmonic_part(laplacians: &[Form], (n, j): (i32, i32)) -> Result<Form, Error> {
    let m = n - 2 * j;
    // (2m+1)!! / ((2j)!! (2n−2j+1)!!)
    let whole = double_factorial(2 * m + 1) / (double_factorial(2 * j) * double_factorial(2 * n - 2 * j + 1));
    let (mut power, mut sum, square) = (Form::constant(1.0), Form::zero(), square()?);
    for (i, laplacian) in (0..=m / 2).zip(laplacians) {
        // (−1)^i (2m−2i−1)!! / ((2i)!! (2m−1)!!) |u|^2i Δ^(i+j) p
        let sign = if i % 2 == 0 { whole } else { -whole };
        let factor =
            sign * double_factorial(2 * m - 2 * i - 1) / (double_factorial(2 * i) * double_factorial(2 * m - 1));
        sum += &power.multiply(laplacian)?.scale(&factor);
        power = power.multiply(&square)?;
    }
    Ok(sum)
}

/// Σ w P_l(n·u) over unit vectors n with vectors of weights w, as three harmonic polynomials of degree l.
pub(super) fn zonal_sum(l: u32, terms: &[(Vector3<f64>, Vector3<f64>)]) -> Result<[Form; 3], Error> {
    let degree = l as usize;
    let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
    let mut forms = [Form::zero(), Form::zero(), Form::zero()];
    for i in 0..=degree {
        for j in 0..=degree - i {
            let exponents = [i, j, degree - i - j];
            let mut moment = Vector3::zeros();
            for (normal, weight) in terms {
                let powers = normal.zip_map(&Vector3::from(exponents), |x, power| x.powi(power as i32));
                moment += weight * powers.product();
            }
            // P_l(n·u) = (2l−1)!!/l! h_l[(n·u)^l], by the multinomial theorem
            let factor = double_factorial(2 * l as i32 - 1) / exponents.map(factorial).iter().product::<f64>();
            let monomial = Monomial::new(&exponents.map(|power| power as u32))?;
            (0..3).for_each(|axis| forms[axis].add_term(monomial, &(factor * moment[axis])));
        }
    }
    let harmonic = |axis: usize| Ok::<_, Error>(harmonic_parts(&forms[axis])?.remove(&l).unwrap_or_else(Form::zero));
    Ok([harmonic(0)?, harmonic(1)?, harmonic(2)?])
}

/// Coefficient of P_l in max(0, μ)^k (9).
pub(super) fn half_range(k: u32, l: u32) -> f64 {
    // ∫₀¹ μ^k P_l dμ = I_l, I_0 = 1/(k+1), I_1 = 1/(k+2), I_(l+2) = I_l (k−l)/(k+l+3)
    let start = 1.0 / f64::from(k + 1 + l % 2);
    let k = f64::from(k);
    let steps = (l % 2..l).step_by(2).map(f64::from);
    f64::from(2 * l + 1) / 2.0 * steps.fold(start, |integral, j| integral * (k - j) / (k + j + 3.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_harmonic_and_sum_to_the_polynomial_on_the_sphere() {
        let form = Form::parse("x^5*y^2*z - 2*x^4 + 3*y^3*z^3 + x*y - 0.5", &["x", "y", "z"]).expect("a polynomial");
        let parts = harmonic_parts(&form).expect("parts");
        let u = Vector3::new(0.3, -0.5, 0.7).normalize();
        let sum: f64 = parts.values().map(|part| part.evaluate(u.as_slice()).expect("a value")).sum();
        assert!((sum - form.evaluate(u.as_slice()).expect("a value")).abs() < 1e-14);
        for part in parts.values() {
            let rest = laplacian(part).expect("a polynomial");
            assert!(rest.terms().all(|(_, c)| c.abs() < 1e-13));
        }
    }

    #[test]
    fn zonal_sums_are_legendre_polynomials() {
        let n = Vector3::new(1.0, 2.0, -2.0) / 3.0;
        let u = Vector3::new(0.6, 0.0, 0.8);
        let [first, _, third] = zonal_sum(4, &[(n, Vector3::new(1.0, 0.0, -2.0))]).expect("a sum");
        let x = n.dot(&u);
        let legendre = (35.0 * x.powi(4) - 30.0 * x * x + 3.0) / 8.0;
        assert!((first.evaluate(u.as_slice()).expect("a value") - legendre).abs() < 1e-14);
        assert!((third.evaluate(u.as_slice()).expect("a value") + 2.0 * legendre).abs() < 1e-14);
    }

    #[test]
    fn half_range_series_converges_to_the_power() {
        for (k, expected) in [(1, 0.4), (2, 0.16)] {
            let mut legendre = [1.0, 0.4];
            let mut sum = half_range(k, 0) + half_range(k, 1) * 0.4;
            for l in 1..400_u32 {
                let n = f64::from(l);
                legendre = [legendre[1], ((2.0 * n + 1.0) * 0.4 * legendre[1] - n * legendre[0]) / (n + 1.0)];
                sum += half_range(k, l + 1) * legendre[1];
            }
            assert!((sum - expected).abs() < 1e-4, "{sum}");
        }
    }
}
