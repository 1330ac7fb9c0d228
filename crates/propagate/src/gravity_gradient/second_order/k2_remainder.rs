//! The part of ⟨K2⟩ over the orbit that the closed form of K2 omits: the terms from (n/Ω)² on, and slow terms.
//!
//! With the harmonics c_mj e^(ijl) of the contractions, F = σ^(|h|/2) f and q = 3φn²/2, the average is
//!
//! ```text
//! ⟨K2⟩ = q² Σ_hmj [α_mj (((h − mσ)/M) ∂_σ + m ∂_M) + β_mj/M] F² G(Ω)
//! α_mj = −|c_mj|²,   β_mj = −2 Im (X₁c_mj X₂c̄_mj),   G = 1/(Ω + jn)
//! ```
//!
//! with h > 0 for m = 0, and X₁, X₂ the turns of the frame about its axes 1 and 2. K2 in closed form has 1/Ω − jn/Ω² for G, so that (jn)²/(Ω² (Ω + jn)) is
//! left. Its derivatives are taken at the epoch. As k precesses, the part of the turning about the normal of the orbit turns with it; the rest, of the order of
//! e², stays in space.

use nalgebra::{UnitQuaternion, Vector3};

use super::CUTOFF;
use crate::gravity_gradient::body::contraction::{Contraction, coefficients, contraction, factors, with_turns};
use crate::gravity_gradient::body::inertia::Inertia;
use crate::gravity_gradient::first_order::fourier::ExactTerm;
use crate::gravity_gradient::orbit::elliptic_orbit::Demand;
use crate::gravity_gradient::orbit::hansen::OrbitSeries;
use crate::gravity_gradient::terms::divisors::Divisors;
use crate::gravity_gradient::terms::term::{ROOT_FLOOR, Term};
#[cfg(test)]
use crate::gravity_gradient::terms::term::{fast_terms, slowest};

/// Largest squared sine of the inclination at which the turning is not split into parts.
const SPLIT_SQUARE: f64 = 1e-12;

/// Constant rates by K2.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SteadyRates {
    /// ∂K2/∂k, in inertial components.
    pub(crate) force: Vector3<f64>,
    /// What is added to dℓ′/dt and dy′/dt.
    pub(crate) phases: [f64; 2],
}

/// α and β of one m and j, and their derivatives by X₁ and X₂.
#[derive(Clone, Copy, Default)]
struct Geometry {
    values: [f64; 2],
    turned: [[f64; 2]; 2],
}

impl Geometry {
    /// From a contraction and those of the tensor turned about axes 1 and 2.
    fn new([whole, first, second]: &[Contraction; 3]) -> Self {
        let [c, x1, x2] = whole;
        let turned = [(x1, first), (x2, second)]
            .map(|(by, outer)| [-2.0 * (c.conj() * by).re, -2.0 * (outer[1] * x2.conj() + x1 * outer[2].conj()).im]);
        Self { values: [-c.norm_sqr(), -2.0 * (x1 * x2.conj()).im], turned }
    }
}

/// The functions of one term that its harmonics share.
struct Shape {
    /// h − mσ and m.
    numbers: [f64; 2],
    /// F² and its derivatives with respect to σ.
    square: [f64; 3],
    /// ν and its derivatives with respect to σ.
    frequency: [f64; 3],
    momentum: f64,
}

impl Shape {
    fn new(term: &Term, inertia: &Inertia) -> Self {
        let (h, m) = (f64::from(term.harmonic), f64::from(term.multiple));
        let Inertia { sigma, momentum, .. } = *inertia;
        Self { numbers: [h - m * sigma, m], square: term.square(sigma), frequency: term.frequency, momentum }
    }

    /// The factors of α and of β, and their derivatives with respect to σ and M, for G and its derivatives with respect to Ω.
    fn factors(&self, [g, g1, g2]: [f64; 3]) -> [[f64; 2]; 3] {
        let Self { numbers: [a, m], square: [s, s1, s2], frequency: [nu, nu1, nu2], momentum } = *self;
        let along = a * nu1 + m * nu;
        [
            [a / momentum * s1 * g + s * along * g1, s * g / momentum],
            [
                (a * s2 - m * s1) / momentum * g
                    + (2.0 * a * s1 * nu1 + m * s1 * nu + s * a * nu2) * g1
                    + s * along * momentum * nu1 * g2,
                s1 * g / momentum + s * g1 * nu1,
            ],
            [
                a / momentum * s1 * (g1 * nu - g / momentum) + s * along * nu * g2,
                s / momentum * (g1 * nu - g / momentum),
            ],
        ]
    }
}

impl SteadyRates {
    /// At a mean motion whose frame is known, from the terms whose divisors are exact and all terms with sums over time derivatives.
    pub(crate) fn new(
        inertia: &Inertia,
        frame: &UnitQuaternion<f64>,
        demand: &Demand<'_>,
        (exact, terms): (&[ExactTerm], &[Term]),
    ) -> Self {
        let rates = demand.series.map(|series| {
            let summed = summed(inertia, terms, exact);
            Rates::new(inertia, frame, (demand, series), (exact, &summed))
        });
        rates.map(|rates| rates.steady(frame, &demand.axes[2])).unwrap_or_default()
    }
}

/// The sums, in the frame.
struct Rates<'a> {
    inertia: &'a Inertia,
    /// q².
    scale: f64,
    #[cfg(test)]
    value: f64,
    /// Derivatives with respect to σ and M, and by X₁ and X₂.
    by_sigma: f64,
    by_momentum: f64,
    turned: [f64; 2],
}

impl<'a> Rates<'a> {
    fn new(
        inertia: &'a Inertia,
        frame: &UnitQuaternion<f64>,
        (demand, series): (&Demand<'_>, &OrbitSeries),
        (exact, summed): (&[ExactTerm], &[Term]),
    ) -> Self {
        let [first, second, _] = demand.orbit.axes().map(|axis| frame.inverse() * axis);
        let tensors = factors([first, second]).map(|tensor| with_turns(&tensor));
        let geometry = |multiple: i32, j: i32| {
            let coefficients = coefficients(&series.coefficients[j.unsigned_abs() as usize], f64::from(j));
            let parts: [Contraction; 3] = std::array::from_fn(|turn| {
                let parts = tensors.each_ref().map(|tensors| contraction(&tensors[turn], multiple));
                std::array::from_fn(|i| coefficients.iter().zip(&parts).map(|(c, part)| c * part[i]).sum())
            });
            Geometry::new(&parts)
        };
        let scale = demand.strength().powi(2);
        let mut rates = Self {
            inertia,
            scale,
            #[cfg(test)]
            value: 0.0,
            by_sigma: 0.0,
            by_momentum: 0.0,
            turned: [0.0; 2],
        };
        let (highest, last) = (highest(series), series.coefficients.len() as i32 - 1);
        for multiple in 0..=2 {
            let of_multiple = |numbers: (i32, i32)| numbers.1 == multiple;
            let exact: Vec<&ExactTerm> = exact.iter().filter(|term| of_multiple(term.numbers)).collect();
            let reach = if exact.is_empty() { highest } else { last };
            let table: Vec<(i32, Geometry)> = (-reach..=reach).map(|j| (j, geometry(multiple, j))).collect();
            for term in exact {
                let shape = Shape::new(&Term::new(inertia, term.numbers.0, multiple), inertia);
                for (j, geometry) in table.iter().filter(|(j, _)| term.divisors.excluded != Some(*j)) {
                    rates.add(&shape, geometry, of_divisors(&term.divisors, *j));
                }
            }
            for term in summed.iter().filter(|term| of_multiple((term.harmonic, term.multiple))) {
                let shape = Shape::new(term, inertia);
                let omega = inertia.momentum * term.frequency[0];
                for (j, geometry) in table.iter().filter(|(j, _)| *j != 0 && j.abs() <= highest) {
                    let step = f64::from(*j) * demand.mean_motion;
                    // A harmonic at resonance is so small that the term needs no exact divisors.
                    if (omega + step).abs() > 0.5 * demand.mean_motion {
                        rates.add(&shape, geometry, beyond(omega, step, omega + step));
                    }
                }
            }
        }
        rates
    }

    fn add(&mut self, shape: &Shape, geometry: &Geometry, of_frequency: [f64; 3]) {
        let product = |[a, b]: [f64; 2], [c, d]: [f64; 2]| self.scale * (a * c + b * d);
        let [value, by_sigma, by_momentum] = shape.factors(of_frequency);
        let [sigma, momentum] = [by_sigma, by_momentum].map(|part| product(geometry.values, part));
        let turned = geometry.turned.map(|turned| product(turned, value));
        #[cfg(test)]
        {
            self.value += product(geometry.values, value);
        }
        self.by_sigma += sigma;
        self.by_momentum += momentum;
        self.turned = [self.turned[0] + turned[0], self.turned[1] + turned[1]];
    }

    fn steady(&self, frame: &UnitQuaternion<f64>, normal: &Vector3<f64>) -> SteadyRates {
        let Inertia { sigma, momentum, .. } = *self.inertia;
        let by_action = self.by_sigma / momentum;
        let [first, second] = self.turned;
        let across = frame * Vector3::new(second, -first, 0.0);
        let pole = frame * Vector3::z();
        let inclined = pole.cross(normal).norm_squared();
        // ∂K2/∂k across k: the part along N − (k·N) k is that of ∂K2/∂k_N.
        let force = if inclined > SPLIT_SQUARE {
            let along = normal - pole * pole.dot(normal);
            let share = across.dot(normal) / inclined;
            across + (normal - along) * share
        } else {
            across
        };
        SteadyRates { force, phases: [by_action, self.by_momentum - sigma * by_action] }
    }
}

/// The last harmonic with a share of (jn)² |c_j|².
fn highest(series: &OrbitSeries) -> i32 {
    let sizes: Vec<f64> = (0..)
        .zip(&series.coefficients)
        .map(|(j, g)| f64::from(j) * g.iter().fold(0.0_f64, |most, g| most.max(g.abs())))
        .collect();
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    sizes.iter().rposition(|size| *size > CUTOFF.sqrt() * largest).unwrap_or(0) as i32
}

/// The terms with sums over time derivatives that count in the omitted part of K2.
fn summed(inertia: &Inertia, terms: &[Term], exact: &[ExactTerm]) -> Vec<Term> {
    let root = inertia.sigma.sqrt().max(ROOT_FLOOR);
    let weight = |term: &Term| term.size(root).powi(2) / term.frequency[0].abs();
    let least = CUTOFF * terms.iter().map(weight).sum::<f64>();
    let is_exact = |term: &Term| exact.iter().any(|other| other.numbers == (term.harmonic, term.multiple));
    terms.iter().filter(|term| weight(term) > least && !is_exact(term)).copied().collect()
}

/// G and its derivatives for a harmonic of a term whose divisors are exact.
fn of_divisors(divisors: &Divisors, j: i32) -> [f64; 3] {
    // One divisor for all parts of the harmonic. The error is part of that of the shift.
    let divisor = divisors.at(j, 2 * j.signum());
    if divisors.slow {
        let inverse = divisor.recip();
        [inverse, -inverse * inverse, 2.0 * inverse.powi(3)]
    } else {
        beyond(divisors.frequency, f64::from(j) * divisors.mean_motion, divisor)
    }
}

/// (jn)²/(Ω² (Ω + jn)) and its derivatives.
fn beyond(omega: f64, step: f64, divisor: f64) -> [f64; 3] {
    let value = (step / omega).powi(2) / divisor;
    let slope = -2.0 / omega - 1.0 / divisor;
    [value, value * slope, value * (slope * slope + 2.0 / (omega * omega) + 1.0 / (divisor * divisor))]
}

/// The part of K2 that the closed form omits, and its derivatives at a fixed σ or M and by turns of the frame, without terms whose divisors are exact.
#[cfg(test)]
pub(crate) fn lacking(
    inertia: &Inertia,
    frame: &UnitQuaternion<f64>,
    demand: &Demand<'_>,
    series: &OrbitSeries,
) -> (f64, SteadyRates) {
    let summed = summed(inertia, &fast_terms(inertia, 0.0, slowest(demand)), &[]);
    let rates = Rates::new(inertia, frame, (demand, series), (&[], &summed));
    (rates.value, rates.steady(frame, &demand.axes[2]))
}
