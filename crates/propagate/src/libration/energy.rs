//! The Hamiltonian of theory-locked (2), (4) and (5), for numbers and for polynomials about a motion.

use std::f64::consts::{FRAC_PI_2, TAU};

use andoyer_series::num_complex::Complex;
use andoyer_series::periodic::{DrivenHamiltonian, Grid, Periodic};
use andoyer_series::{Coefficient, Error, Monomial, Polynomial, Truncation};

use super::shape::LockedShape;
use crate::orbit::kepler::Place;
use crate::simd::lanes::Lanes;
use crate::torque::strength;

/// The work of H to degree 2 at one time, in multiplications of two floats, as measured.
const WORK: f64 = 5e3;

/// What the Hamiltonian is computed with.
pub(super) trait Number: Clone {
    /// A constant of the same kind.
    fn constant(&self, value: f64) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn scaled(&self, factor: f64) -> Self;
    fn times(&self, other: &Self) -> Result<Self, Error>;
    fn inverse(&self) -> Result<Self, Error>;
    /// Sine and cosine.
    fn circle(&self) -> Result<[Self; 2], Error>;
}

impl Number for Complex<f64> {
    fn constant(&self, value: f64) -> Self {
        value.into()
    }

    fn plus(&self, other: &Self) -> Self {
        self + other
    }

    fn scaled(&self, factor: f64) -> Self {
        self * factor
    }

    fn times(&self, other: &Self) -> Result<Self, Error> {
        Ok(self * other)
    }

    fn inverse(&self) -> Result<Self, Error> {
        Ok(self.inv())
    }

    fn circle(&self) -> Result<[Self; 2], Error> {
        Ok([self.sin(), self.cos()])
    }
}

/// A polynomial without terms above a degree.
#[derive(Clone)]
struct Truncated {
    polynomial: Polynomial<Periodic>,
    degree: u32,
}

impl Truncated {
    fn with(&self, polynomial: Polynomial<Periodic>) -> Self {
        Self { polynomial, degree: self.degree }
    }

    fn constant_term(&self) -> Periodic {
        self.polynomial.coefficient(&Monomial::ONE).cloned().unwrap_or(Periodic::real(0.0))
    }

    /// Σ c_k x^k of the part x without the constant.
    fn series(&self, mut coefficient: impl FnMut(u32) -> f64) -> Result<Self, Error> {
        let rest = self.with(self.polynomial.filter(|monomial, _| monomial != Monomial::ONE));
        let mut power = self.with(Polynomial::constant(Periodic::real(1.0)));
        let mut sum = self.with(Polynomial::zero());
        for k in 0..=self.degree {
            let c = coefficient(k);
            if c != 0.0 {
                sum = sum.plus(&power.scaled(c));
            }
            power = power.times(&rest)?;
            if power.polynomial.is_zero() {
                break;
            }
        }
        Ok(sum)
    }
}

impl Number for Truncated {
    fn constant(&self, value: f64) -> Self {
        self.with(Polynomial::constant(Periodic::real(value)))
    }

    fn plus(&self, other: &Self) -> Self {
        self.with(&self.polynomial + &other.polynomial)
    }

    fn scaled(&self, factor: f64) -> Self {
        self.with(self.polynomial.scale(&Periodic::real(factor)))
    }

    fn times(&self, other: &Self) -> Result<Self, Error> {
        let truncation = Truncation::total(self.degree);
        Ok(self.with(self.polynomial.multiply_truncated(&other.polynomial, &truncation)?))
    }

    /// 1/(c + x) = c⁻¹ Σ (−x/c)^k
    fn inverse(&self) -> Result<Self, Error> {
        let inverse = self.constant_term().invert().ok_or(Error::DivisionByZero)?;
        let ratio = self.with(self.polynomial.scale(&inverse));
        let sum = ratio.series(|k| if k % 2 == 0 { 1.0 } else { -1.0 })?;
        Ok(self.with(sum.polynomial.scale(&inverse)))
    }

    fn circle(&self) -> Result<[Self; 2], Error> {
        let constant = self.constant_term();
        let of = |function: fn(Complex<f64>) -> Complex<f64>| self.with(Polynomial::constant(constant.each(function)));
        let [sine, cosine] = [of(Complex::sin), of(Complex::cos)];
        let mut factor = 1.0;
        let mut factors = Vec::new();
        for k in 0..=self.degree {
            factors.push(if k % 4 < 2 { factor } else { -factor });
            factor /= f64::from(k + 1);
        }
        let part = |odd: u32| self.series(|k| if k % 2 == odd { factors[k as usize] } else { 0.0 });
        let (even, odd) = (part(0)?, part(1)?);
        Ok([sine.times(&even)?.plus(&cosine.times(&odd)?), cosine.times(&even)?.plus(&sine.times(&odd)?.scaled(-1.0))])
    }
}

/// What the orbit does at a time: the direction of the disturbing body in S, the strength of the torque, and sine and cosine of α.
pub(super) struct Drive<N> {
    direction: [N; 3],
    strength: N,
    node: [N; 2],
}

/// The numbers of a [`Drive`] at a mean anomaly M and an angle α.
fn drive(shape: &LockedShape, [anomaly, node]: [f64; 2]) -> [f64; 6] {
    let turned = anomaly - TAU * (anomaly / TAU).round();
    let place = Place::of(Lanes::splat(pulp::Scalar, turned), shape.eccentricity);
    let angle = place.angle.values()[0];
    let e = shape.eccentricity;
    let inverse = (1.0 + e * angle.cos()) / ((1.0 - e) * (1.0 + e));
    let across = if shape.is_across() { FRAC_PI_2 } else { 0.0 };
    // Rz(−α) Rx(−δ) Rz(α + v), v = f − r M − ψ₀
    let seen = node + angle - f64::from(shape.twice) / 2.0 * anomaly - across;
    let ((sine, cosine), (tilt, level)) = (seen.sin_cos(), shape.precession.obliquity.sin_cos());
    let (x, y, z) = (cosine, sine * level, -sine * tilt);
    let (sin_node, cos_node) = node.sin_cos();
    let [first, second] = [cos_node * x + sin_node * y, cos_node * y - sin_node * x];
    [first, second, z, strength(shape.attraction) * inverse.powi(3), sin_node, cos_node]
}

impl Drive<Complex<f64>> {
    /// The drive at a mean anomaly M and an angle α.
    pub(super) fn at(shape: &LockedShape, phases: [f64; 2]) -> Self {
        let [x, y, z, strength, sine, cosine] = drive(shape, phases).map(Complex::from);
        Self { direction: [x, y, z], strength, node: [sine, cosine] }
    }
}

/// Sines, cosines and momenta of a state.
struct Angles<N> {
    psi: [N; 2],
    theta: [N; 2],
    phi: [N; 2],
    secant: N,
    tangent: N,
    /// p_ψ, p_θ, p_φ.
    momenta: [N; 3],
}

/// H in units of C n², of ψ, p_ψ − C W₃, θ, p_θ, φ, p_φ.
pub(super) fn energy<N: Number>(shape: &LockedShape, state: &[N; 6], drive: &Drive<N>) -> Result<N, Error> {
    let [psi, p_psi, theta, p_theta, phi, p_phi] = state;
    let theta = theta.circle()?;
    let secant = theta[1].inverse()?;
    let angles = Angles {
        psi: psi.circle()?,
        phi: phi.circle()?,
        tangent: theta[0].times(&secant)?,
        theta,
        secant,
        momenta: [p_psi.plus(&p_psi.constant(shape.precession.spin)), p_theta.clone(), p_phi.clone()],
    };
    let sum = kinetic(shape, &angles)?.plus(&potential(shape, &angles, drive)?);
    if shape.precession.sideways == 0.0 { Ok(sum) } else { Ok(sum.plus(&sideways(shape, &angles, drive)?)) }
}

/// ½ Σ G²/I − W₃ p_ψ. Q = p_ψ sec θ + p_φ tan θ stays apart as a function of ψ, p_ψ and one of θ, φ: few products have all variables.
fn kinetic<N: Number>(shape: &LockedShape, angles: &Angles<N>) -> Result<N, Error> {
    let ([a, b, c], [p_psi, p_theta, p_phi]) = (shape.moments, &angles.momenta);
    let [sine, cosine] = &angles.phi;
    // sin²/B + cos²/C, cos²/B + sin²/C, (1/B − 1/C) sin cos, by the difference of the moments, which would else be lost to rounding.
    let difference = (c - b) / (b * c);
    let square = sine.times(sine)?.scaled(difference);
    let gamma = square.plus(&sine.constant(1.0 / c));
    let alpha = square.scaled(-1.0).plus(&sine.constant(1.0 / b));
    let beta = sine.times(cosine)?.scaled(difference);
    let slope = p_phi.times(&angles.tangent)?;
    let inner = p_phi
        .times(p_phi)?
        .scaled(0.5 / a)
        .plus(&alpha.times(&p_theta.times(p_theta)?)?.scaled(0.5))
        .plus(&beta.times(&p_theta.times(&slope)?)?)
        .plus(&gamma.times(&slope.times(&slope)?)?.scaled(0.5));
    let linear = angles.secant.times(&beta.times(p_theta)?.plus(&gamma.times(&slope)?))?;
    let quadratic = angles.secant.times(&angles.secant)?.times(&gamma)?.scaled(0.5);
    Ok(inner
        .plus(&p_psi.times(&linear)?)
        .plus(&p_psi.times(p_psi)?.times(&quadratic)?)
        .plus(&p_psi.scaled(-shape.precession.spin)))
}

/// The torque's function: the direction turned back by ψ, and the inertia tensor turned by θ and φ. Without B times the unit tensor, which adds a function of time alone.
fn potential<N: Number>(shape: &LockedShape, angles: &Angles<N>, drive: &Drive<N>) -> Result<N, Error> {
    let [a, b, c] = shape.moments;
    let ([sin_psi, cos_psi], [sin_theta, cos_theta], [sin_phi, cos_phi]) = (&angles.psi, &angles.theta, &angles.phi);
    let [x, y, z] = &drive.direction;
    let turned = [
        cos_psi.times(x)?.plus(&sin_psi.times(y)?),
        cos_psi.times(y)?.plus(&sin_psi.times(x)?.scaled(-1.0)),
        z.clone(),
    ];
    let rows = [
        [cos_theta.clone(), sin_theta.times(sin_phi)?, sin_theta.times(cos_phi)?],
        [sin_phi.constant(0.0), cos_phi.clone(), sin_phi.scaled(-1.0)],
        [sin_theta.scaled(-1.0), cos_theta.times(sin_phi)?, cos_theta.times(cos_phi)?],
    ];
    let mut sum = sin_phi.constant(0.0);
    for (i, j) in [(0, 0), (1, 1), (0, 1), (2, 2), (0, 2), (1, 2)] {
        let mut tensor = sin_phi.constant(0.0);
        for (column, moment) in [(0, a - b), (2, c - b)] {
            tensor = tensor.plus(&rows[i][column].times(&rows[j][column])?.scaled(moment));
        }
        let twice = if i == j { 1.0 } else { 2.0 };
        let pair = turned[i].times(&turned[j])?.times(&drive.strength)?.scaled(twice);
        sum = sum.plus(&pair.times(&tensor)?);
    }
    Ok(sum)
}

/// −W (G₁ sin α + G₂ cos α) with G₁ + i G₂ = e^{iψ} (p_ψ tan θ + p_φ sec θ + i p_θ).
fn sideways<N: Number>(shape: &LockedShape, angles: &Angles<N>, drive: &Drive<N>) -> Result<N, Error> {
    let ([sin_psi, cos_psi], [sine, cosine], [p_psi, p_theta, p_phi]) = (&angles.psi, &drive.node, &angles.momenta);
    let turn = [
        sin_psi.times(cosine)?.plus(&cos_psi.times(sine)?),
        cos_psi.times(cosine)?.plus(&sin_psi.times(sine)?.scaled(-1.0)),
    ];
    let across = turn[0].times(p_psi)?.times(&angles.tangent)?.plus(&turn[0].times(&p_phi.times(&angles.secant)?)?);
    Ok(across.plus(&turn[1].times(p_theta)?).scaled(-shape.precession.sideways))
}

impl DrivenHamiltonian for LockedShape {
    fn pairs(&self) -> usize {
        3
    }

    fn work(&self) -> f64 {
        WORK
    }

    fn expanded(
        &self,
        grid: &Grid,
        variables: &[Polynomial<Periodic>],
        degree: u32,
    ) -> Result<Polynomial<Periodic>, Error> {
        let number = |polynomial| Truncated { polynomial, degree };
        let samples: Vec<[f64; 6]> =
            (0..grid.times()).map(|at| drive(self, self.anomaly_and_node(&grid.angles(at)))).collect();
        let constant = |place: usize| {
            let values: Vec<Complex<f64>> = samples.iter().map(|sample| sample[place].into()).collect();
            number(Polynomial::constant(Periodic::of(&values).simplified()))
        };
        let direction = [constant(0), constant(1), constant(2)];
        let drive = Drive { direction, strength: constant(3), node: [constant(4), constant(5)] };
        // H is sparse in the deviations from the periodic motion: a factor of a term depends on few of them, and the momenta have degree 2 at most. In the normal variables all
        // products would be dense, and take a hundred times as long at order 8.
        let mut state = Vec::new();
        for (slot, variable) in variables.iter().enumerate() {
            let origin = variable.filter(|monomial, _| monomial == Monomial::ONE);
            state.push(number(&origin + &Polynomial::variable(slot)?));
        }
        let forms: Vec<_> = variables.iter().map(|form| form.filter(|monomial, _| monomial != Monomial::ONE)).collect();
        let state: [Truncated; 6] = std::array::from_fn(|slot| state[slot].clone());
        at_forms(&energy(self, &state, &drive)?.polynomial, &forms)
    }
}

/// A polynomial in the first variables at linear forms, by Horner's rule in one variable after another.
fn at_forms(polynomial: &Polynomial<Periodic>, forms: &[Polynomial<Periodic>]) -> Result<Polynomial<Periodic>, Error> {
    let Some((form, before)) = forms.split_last() else { return Ok(polynomial.clone()) };
    let slot = before.len();
    let highest = polynomial.terms().map(|(monomial, _)| monomial.exponent(slot)).max().unwrap_or(0);
    let mut sum = Polynomial::zero();
    for power in (0..=highest).rev() {
        let mut coefficient = Polynomial::zero();
        for (monomial, c) in polynomial.terms().filter(|(monomial, _)| monomial.exponent(slot) == power) {
            coefficient.add_term(monomial.with(slot, 0)?, c);
        }
        sum = sum.multiply(form)?;
        sum += &at_forms(&coefficient, before)?;
    }
    Ok(sum)
}
