//! The Hamiltonian of theory-locked (2) as a polynomial in ψ, p_ψ, θ, p_θ, φ, p_φ about an origin, with the phases of the orbit.

use andoyer_series::num_complex::Complex;
use andoyer_series::{Error, Monomial, PhaseSpace, Polynomial, Truncation};
use nalgebra::{Matrix6, Vector6};

use super::shape::LockedShape;

/// Most harmonics of the orbit.
const MOST_HARMONICS: i32 = 60;
/// Steps of Newton's iteration to the equilibrium, and the last one's size.
const STEPS: usize = 40;
const REACHED: f64 = 1e-15;

/// The space of the six variables and the phases.
pub(super) fn space(shape: &LockedShape) -> Result<PhaseSpace, Error> {
    let space = PhaseSpace::new(&[("psi", "p_psi"), ("theta", "p_theta"), ("phi", "p_phi")])?;
    match shape.driven([0.0; 2]).0.len() {
        0 => Ok(space),
        1 => space.with_driven(&["M"]),
        _ => space.with_driven(&["M", "alpha"]),
    }
}

type Real = Polynomial<f64>;
type RealPair = [Real; 2];

/// Polynomials truncated at a degree.
struct Algebra {
    degree: u32,
    truncation: Truncation,
}

impl Algebra {
    fn times(&self, a: &Real, b: &Real) -> Result<Real, Error> {
        a.multiply_truncated(b, &self.truncation)
    }

    /// The product of two complex numbers.
    fn turned(&self, a: &RealPair, b: &RealPair) -> Result<RealPair, Error> {
        Ok([
            &self.times(&a[0], &b[0])? - &self.times(&a[1], &b[1])?,
            &self.times(&a[0], &b[1])? + &self.times(&a[1], &b[0])?,
        ])
    }

    /// Cosine and sine of an angle plus the variable of a slot.
    fn circle(&self, angle: f64, slot: usize) -> Result<RealPair, Error> {
        let mut functions = [Real::zero(), Real::zero()];
        let (mut power, mut factor) = (Real::constant(1.0), 1.0);
        for k in 0..=self.degree {
            let sign = if k % 4 < 2 { 1.0 } else { -1.0 };
            functions[usize::from(k % 2 == 1)] += &power.scale(&(sign * factor));
            power = self.times(&power, &Real::variable(slot)?)?;
            factor /= f64::from(k + 1);
        }
        let (sine, cosine) = angle.sin_cos();
        self.turned(&[Real::constant(cosine), Real::constant(sine)], &functions)
    }

    /// 1/f of a polynomial with a constant other than 0.
    fn inverse(&self, f: &Real) -> Result<Real, Error> {
        let constant = f.terms().find(|(monomial, _)| *monomial == Monomial::ONE).map_or(1.0, |(_, c)| *c);
        let rest = &Real::constant(1.0) - &f.scale(&(1.0 / constant));
        let (mut sum, mut power) = (Real::zero(), Real::constant(1.0));
        for _ in 0..=self.degree {
            sum += &power;
            power = self.times(&power, &rest)?;
        }
        Ok(sum.scale(&(1.0 / constant)))
    }
}

/// A Hamiltonian while terms are added.
struct Sum<'a, K: Fn(f64, u32) -> bool> {
    shape: &'a LockedShape,
    space: PhaseSpace,
    weight: u32,
    keeps: K,
    terms: Real,
}

impl<K: Fn(f64, u32) -> bool> Sum<'_, K> {
    /// Adds Re c (x + iy) e^{i(jM + kα)} without those terms with a phase that `keeps` leaves out; returns whether a term was added.
    fn add(&mut self, [x, y]: &RealPair, c: Complex<f64>, j: i32, k: i32) -> Result<bool, Error> {
        if c.norm() == 0.0 {
            return Ok(false);
        }
        let (multiples, angle) = self.shape.wave(j.into(), k.into());
        let mut waves = vec![(Vec::new(), c * Complex::cis(angle))];
        for multiple in multiples {
            // e^{imM} = cos |m|M + i sgn m sin |m|M
            let (size, sign) = (multiple.abs(), multiple.signum() as f64);
            let parts = [(size, Complex::new(1.0, 0.0)), (-size, Complex::new(0.0, sign))];
            let parts = &parts[..1 + usize::from(size > 0)];
            let longer = |(known, c): &(Vec<i64>, Complex<f64>), (next, factor): &(i64, Complex<f64>)| {
                ([known.as_slice(), &[*next]].concat(), c * factor)
            };
            waves = waves.iter().flat_map(|wave| parts.iter().map(move |part| longer(wave, part))).collect();
        }
        let mut added = false;
        for (harmonics, c) in waves {
            added |= self.insert(&(&x.scale(&c.re) - &y.scale(&c.im)), &harmonics)?;
        }
        Ok(added)
    }

    fn insert(&mut self, part: &Real, harmonics: &[i64]) -> Result<bool, Error> {
        let (driven, mut added) = (harmonics.iter().any(|&j| j != 0), false);
        for (monomial, c) in part.terms() {
            let exponents: Vec<u32> = (0..6).map(|slot| monomial.exponent(slot)).collect();
            let degree: u32 = exponents.iter().sum();
            let fits = (1..=self.weight).contains(&degree) && degree + u32::from(driven) <= self.weight;
            if fits && *c != 0.0 && (!driven || (self.keeps)(*c, degree)) {
                self.terms.add_term(self.space.monomial(&exponents, harmonics)?, c);
                added = true;
            }
        }
        Ok(added)
    }
}

/// Moments and products of inertia in S: J₁₁ + J₂₂, J₁₃ + i J₂₃ and J₁₁ − J₂₂ + 2i J₁₂.
struct InertiaProducts {
    still: RealPair,
    single: RealPair,
    double: RealPair,
}

impl InertiaProducts {
    /// `angles` are cosine and sine of ψ, θ, φ.
    fn new(algebra: &Algebra, moments: [f64; 3], [psi, theta, phi]: &[RealPair; 3]) -> Result<Self, Error> {
        let times = |a: &Real, b: &Real| algebra.times(a, b);
        let rows = [
            [theta[0].clone(), times(&theta[1], &phi[1])?, times(&theta[1], &phi[0])?],
            [Real::zero(), phi[0].clone(), -&phi[1]],
            [-&theta[1], times(&theta[0], &phi[1])?, times(&theta[0], &phi[0])?],
        ];
        let product = |i: usize, j: usize| -> Result<Real, Error> {
            let mut sum = Real::zero();
            for (column, moment) in moments.iter().enumerate() {
                sum += &times(&rows[i][column], &rows[j][column])?.scale(moment);
            }
            Ok(sum)
        };
        let (first, second) = (product(0, 0)?, product(1, 1)?);
        let doubled = algebra.turned(psi, psi)?;
        Ok(Self {
            still: [&first + &second, Real::zero()],
            single: algebra.turned(psi, &[product(0, 2)?, product(1, 2)?])?,
            double: algebra.turned(&doubled, &[&first - &second, product(0, 1)?.scale(&2.0)])?,
        })
    }

    /// The parts of ζ̄ᵀJζ and of ζᵀJζ (theory-locked (6)): the multiple of α, and the amplitude; without constants.
    fn waves(&self, obliquity: f64) -> [Vec<(i32, RealPair)>; 2] {
        let (p, q, s) = ((1.0 + obliquity.cos()) / 2.0, (1.0 - obliquity.cos()) / 2.0, obliquity.sin());
        let real = |pair: &RealPair, c: f64| [pair[0].scale(&c), pair[1].scale(&c)];
        let imaginary = |pair: &RealPair, c: f64| [pair[1].scale(&-c), pair[0].scale(&c)];
        let conjugate = |pair: &RealPair| [pair[0].clone(), -&pair[1]];
        let (still, single, double) = (&self.still, &self.single, &self.double);
        // s² = 4pq, and J₃₃ is a constant without `still`.
        let mut sides = [
            vec![
                (0, real(still, p * p + q * q - s * s)),
                (1, imaginary(single, 2.0 * s * (p - q))),
                (2, real(double, 2.0 * p * q)),
            ],
            vec![
                (0, real(&conjugate(double), p * p)),
                (1, imaginary(&conjugate(single), 2.0 * s * p)),
                (2, real(still, 6.0 * p * q)),
                (3, imaginary(single, 2.0 * s * q)),
                (4, real(double, q * q)),
            ],
        ];
        if obliquity == 0.0 {
            sides.iter_mut().for_each(|side| side.truncate(1));
        }
        sides
    }
}

/// H about `origin` to `order`, in units of C n², with those terms of the phases whose coefficient and degree `keeps` accepts.
pub(super) fn hamiltonian(
    shape: &LockedShape,
    origin: &[f64; 6],
    order: usize,
    keeps: impl Fn(f64, u32) -> bool,
) -> Result<Real, Error> {
    let degree = order as u32 + 2;
    let algebra = Algebra { degree, truncation: Truncation::total(degree) };
    let [psi, theta, phi] = [0, 2, 4].map(|slot| algebra.circle(origin[slot], slot));
    let angles = [psi?, theta?, phi?];
    let (kinetic, across) = kinetic(&algebra, shape, origin, &angles)?;
    let inertia = InertiaProducts::new(&algebra, shape.moments, &angles)?;
    let mut sum = Sum { shape, space: space(shape)?, weight: degree, keeps, terms: Real::zero() };
    sum.insert(&kinetic, &vec![0; sum.space.driven().len()])?;
    sum.add(&across, Complex::new(0.0, shape.precession.sideways), 0, 1)?;
    let sides = inertia.waves(shape.precession.obliquity);
    let factor = 0.75 * shape.attraction;
    let side = if shape.is_across() { -factor } else { factor };
    for j in 0..=if shape.eccentricity == 0.0 { 0 } else { MOST_HARMONICS } {
        let mut added = false;
        for j in if j == 0 { vec![0] } else { vec![j, -j] } {
            let sizes = [factor * shape.hansen(j)[0], side * shape.hansen(j + shape.twice)[1]];
            for (waves, size) in sides.iter().zip(sizes) {
                for (k, part) in waves {
                    added |= sum.add(part, size.into(), j, *k)?;
                }
            }
        }
        if !added && j > shape.twice {
            break;
        }
    }
    Ok(sum.terms)
}

/// The degree of a term without phases, or `None`.
fn constant(monomial: Monomial) -> Option<u32> {
    (6..8).all(|slot| monomial.exponent(slot) == 0).then(|| (0..6).map(|slot| monomial.exponent(slot)).sum())
}

/// A Hamiltonian about an equilibrium without the constant force, which rounding leaves.
pub(super) fn without_force(hamiltonian: &Real) -> Real {
    hamiltonian.filter(|monomial, c| constant(monomial) != Some(1) && *c != 0.0)
}

/// The equilibrium of the constant part of the Hamiltonian, by Newton's iteration; it is 0 unless the phases are commensurate.
pub(super) fn equilibrium(shape: &LockedShape) -> Result<[f64; 6], Error> {
    let mut origin = [0.0; 6];
    for _ in 0..if shape.is_common() { STEPS } else { 0 } {
        let (mut force, mut matrix) = (Vector6::zeros(), Matrix6::zeros());
        for (monomial, &c) in hamiltonian(shape, &origin, 0, |_, _| false)?.terms() {
            let slots: Vec<usize> = (0..6).flat_map(|slot| vec![slot; monomial.exponent(slot) as usize]).collect();
            match slots[..] {
                [slot] => force[slot] += c,
                [i, j] => {
                    matrix[(i, j)] += c;
                    matrix[(j, i)] += c;
                }
                _ => {}
            }
        }
        let step = matrix.lu().solve(&force).unwrap_or_default();
        origin.iter_mut().zip(step.iter()).for_each(|(x, step)| *x -= step);
        if step.amax() <= REACHED {
            break;
        }
    }
    Ok(origin)
}

/// ½ Σ G²/I − W₃ p_ψ, and the part G₁ + i G₂ of the angular momentum in S. `origin` has p_ψ − C W₃.
fn kinetic(
    algebra: &Algebra,
    shape: &LockedShape,
    origin: &[f64; 6],
    [psi, theta, phi]: &[RealPair; 3],
) -> Result<(Real, RealPair), Error> {
    let spin = shape.precession.spin;
    let momentum = |slot: usize, add: f64| Ok(&Real::variable(slot)? + &Real::constant(origin[slot] + add));
    let (p_psi, p_theta, p_phi) = (momentum(1, spin)?, momentum(3, 0.0)?, momentum(5, 0.0)?);
    let along = &p_psi + &algebra.times(&p_phi, &theta[1])?;
    let along = algebra.times(&along, &algebra.inverse(&theta[0])?)?;
    let momenta = [
        p_phi.clone(),
        &algebra.times(&p_theta, &phi[0])? + &algebra.times(&along, &phi[1])?,
        &algebra.times(&along, &phi[0])? - &algebra.times(&p_theta, &phi[1])?,
    ];
    let mut sum = p_psi.scale(&-spin);
    for (momentum, moment) in momenta.iter().zip(shape.moments) {
        sum += &algebra.times(momentum, momentum)?.scale(&(0.5 / moment));
    }
    let across = &algebra.times(&p_phi, &theta[0])? + &algebra.times(&along, &theta[1])?;
    Ok((sum, algebra.turned(psi, &[across, p_theta])?))
}
