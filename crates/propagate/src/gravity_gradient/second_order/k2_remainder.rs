//! The part of ⟨K2⟩ over the orbit that the closed form of K2 omits, the terms from (n/Ω)² on: equation (8) of docs/theory-second-order.md.
//!
//! With the harmonics c_mj e^(ijl) of the contractions, F and Γ, the average is
//!
//! ```text
//! ⟨K2⟩ = Γ² Σ_hmj [α_mj (((h − mσ)/M) ∂_σ + m ∂_M) + β_mj/M] F² G(Ω)
//! α_mj = −|c_mj|²,   β_mj = −2 Im (X₁c_mj X₂c̄_mj),   G = 1/(Ω + jn)
//! ```
//!
//! with h > 0 for m = 0, and X₁, X₂ the turns of the frame about its axes 1 and 2. The closed form of K2 has 1/Ω − jn/Ω² for G. This
//! file adds (jn)²/(Ω² (Ω + jn)) for terms with sums over time derivatives, and all of G for slow terms, and pairs of different terms ([`super::k2_slow_pairs`]). A harmonic whose solution vanishes at the epoch has no part in K2. The derivatives are taken at the epoch. The component of
//! ∂K2/∂k along the orbit's normal n̂ is kept along n̂; the other component, of the order of e², is constant in inertial axes.

use std::collections::BTreeMap;

use nalgebra::{UnitQuaternion, Vector3};

use super::k2_slow_pairs::{SlowAngle, reciprocal, slow_pairs};
use crate::gravity_gradient::constants::{CUTOFF, NEAREST_IN_K2};
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::first_order::fourier::ExactTerm;
use crate::gravity_gradient::first_order::mean_variables::Mean;
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::terms::divisors::Divisors;
use crate::gravity_gradient::terms::term::{Sensitivity, Term};
use crate::numerics::C64;
use crate::orbit::hansen::OrbitSeries;
use crate::orbit::tensor::{about_first, about_second, products_at};
use crate::torque::{Contraction, contraction};

/// Constant rates by K2.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SteadyRates {
    /// ∂K2/∂k, in inertial components.
    pub(crate) force: Vector3<f64>,
    /// What is added to dℓ′/dt and dy′/dt.
    pub(crate) phases: [f64; 2],
    /// dL/dt.
    pub(crate) action: f64,
    /// Error of the attitude over the span, because the rates are not constant \[rad\].
    pub(crate) unsteady: f64,
}

impl SteadyRates {
    /// The constant rates, from the slow terms among `exact` and the terms with sums over time derivatives.
    pub(crate) fn new(
        inertia: &Inertia,
        mean: &Mean,
        disturbance: &Disturbance<'_>,
        terms: (&[ExactTerm], &[Term]),
    ) -> Self {
        let rates = |series: &OrbitSeries| {
            Remainder::new(inertia, mean, (disturbance, series), terms).rates(
                inertia,
                &mean.frame,
                &disturbance.path.axes[2],
            )
        };
        disturbance.series.as_ref().map(rates).unwrap_or_default()
    }
}

/// The omitted part of ⟨K2⟩ and its derivatives with respect to σ and M, and by X₁ and X₂.
#[derive(Default)]
pub(crate) struct Remainder {
    pub(crate) value: f64,
    by_sigma: f64,
    by_momentum: f64,
    turned: [f64; 2],
    /// −∂K2/∂ℓ′.
    action: f64,
    /// As in [`SteadyRates`].
    unsteady: f64,
    /// Γ².
    scale: f64,
}

impl Remainder {
    pub(crate) fn new(
        inertia: &Inertia,
        mean: &Mean,
        (disturbance, series): (&Disturbance<'_>, &OrbitSeries),
        (exact, summed): (&[ExactTerm], &[Term]),
    ) -> Self {
        let divisors = |term: &Term| {
            let exact = exact.iter().find(|exact| exact.numbers == (term.harmonic, term.multiple));
            exact.map(|exact| &exact.divisors)
        };
        let slow = exact.iter().filter(|term| term.divisors.slow);
        let slow = slow.map(|term| (Term::new(inertia, term.numbers.0, term.numbers.1), Some(&term.divisors)));
        let terms: Vec<_> = slow.chain(summed.iter().map(|term| (*term, divisors(term)))).collect();
        let (tensors, _) = products_at(&mean.frame, disturbance.orbit.axes());
        let tensors = tensors.map(|tensor| [tensor, about_first(&tensor), about_second(&tensor)]);
        let of_harmonic = |multiple: i32, j: i32| {
            let coefficients = series.at(j);
            geometry(&std::array::from_fn(|turn| {
                let parts = tensors.each_ref().map(|tensors| contraction(&tensors[turn], multiple));
                std::array::from_fn(|i| coefficients.iter().zip(&parts).map(|(c, part)| c * part[i]).sum())
            }))
        };
        let (highest, scale) = (highest(series), disturbance.strength().powi(2));
        let empty = || Self { scale, ..Self::default() };
        let (mut sums, mut slow) = (empty(), BTreeMap::new());
        for multiple in 0..=2 {
            let harmonics: Vec<_> = (-highest..=highest).map(|j| (j, of_harmonic(multiple, j))).collect();
            for (term, divisors) in terms.iter().filter(|(term, _)| term.multiple == multiple) {
                for (j, [still, turned @ ..]) in &harmonics {
                    if let Some(of_frequency) = omitted(term, *divisors, (*j, disturbance.mean_motion)) {
                        sums.add((*still, *turned), shape(term, inertia, of_frequency));
                    }
                }
            }
            for pair in slow_pairs(&terms, multiple, inertia, disturbance.duration) {
                let part = slow.entry(pair.apart).or_insert_with(empty);
                for (j, [still, turned @ ..]) in &harmonics {
                    if let Some(shape) = pair.shape(inertia, (*j, disturbance.mean_motion)) {
                        part.add((*still, *turned), shape);
                    }
                }
            }
        }
        sums.add_slow(&slow, inertia, (mean.p.arg(), disturbance.duration));
        sums
    }

    /// Adds pairs of terms, by |h_a − h_b|, with the factors of their angles. `angle` is ℓ′ at the epoch.
    fn add_slow(&mut self, slow: &BTreeMap<i32, Self>, inertia: &Inertia, (angle, duration): (f64, f64)) {
        if slow.is_empty() {
            return;
        }
        let response = Sensitivity::new(inertia);
        for (&apart, part) in slow {
            let SlowAngle { factors: [factor, slope], unsteady } = SlowAngle::new(apart, angle, inertia, duration);
            self.value += factor * part.value;
            self.by_sigma += factor * part.by_sigma;
            self.by_momentum += factor * part.by_momentum;
            self.turned = [0, 1].map(|i| self.turned[i] + factor * part.turned[i]);
            self.action += slope * part.value;
            self.unsteady += unsteady * part.turn(apart, inertia, &response) * duration;
        }
    }

    /// Largest rate of the attitude by pairs of terms, before the factors of their angle: by the rates of ℓ′, y′, k and L \[rad per unit of time\].
    fn turn(&self, apart: i32, inertia: &Inertia, response: &Sensitivity) -> f64 {
        let by_action = self.by_sigma / inertia.momentum;
        let [first, second] = self.turned;
        response.visible * by_action.abs()
            + (self.by_momentum - inertia.sigma * by_action).abs()
            + first.hypot(second) / inertia.momentum
            + response.gain * f64::from(apart) * self.value.abs() / (2.0 * inertia.root() * inertia.momentum)
    }

    /// Adds a term's or a pair's factors of α and of β, with their derivatives with respect to σ and M, at one harmonic.
    fn add(&mut self, (still, turned): ([f64; 2], [[f64; 2]; 2]), [value, by_sigma, by_momentum]: [[f64; 2]; 3]) {
        let product = |[a, b]: [f64; 2], [c, d]: [f64; 2]| self.scale * (a * c + b * d);
        let (sigma, momentum) = (product(still, by_sigma), product(still, by_momentum));
        let [first, second] = turned.map(|turned| product(turned, value));
        self.value += product(still, value);
        self.by_sigma += sigma;
        self.by_momentum += momentum;
        self.turned = [self.turned[0] + first, self.turned[1] + second];
    }

    pub(crate) fn rates(&self, inertia: &Inertia, frame: &UnitQuaternion<f64>, normal: &Vector3<f64>) -> SteadyRates {
        let by_action = self.by_sigma / inertia.momentum;
        let [first, second] = self.turned;
        let across = frame * Vector3::new(second, -first, 0.0);
        let pole = frame * Vector3::z();
        let inclined = pole.cross(normal).norm_squared();
        // ∂K2/∂k across k: the part along n̂ − (k·n̂) k is that of ∂K2/∂k_N.
        let share = if inclined > f64::EPSILON { across.dot(normal) / inclined } else { 0.0 };
        let force = across + pole * (pole.dot(normal) * share);
        let phases = [by_action, self.by_momentum - inertia.sigma * by_action];
        SteadyRates { force, phases, action: self.action, unsteady: self.unsteady }
    }
}

/// α and β of one m and j, and their derivatives by X₁ and X₂, from a contraction and those of the tensor turned about axes 1 and 2.
fn geometry([whole, first, second]: &[Contraction; 3]) -> [[f64; 2]; 3] {
    let [c, x1, x2] = whole;
    let turned = |by: &C64, outer: &Contraction| {
        [-2.0 * (c.conj() * by).re, -2.0 * (outer[1] * x2.conj() + x1 * outer[2].conj()).im]
    };
    [[-c.norm_sqr(), -2.0 * (x1 * x2.conj()).im], turned(x1, first), turned(x2, second)]
}

/// The factors of α and of β for a term, and their derivatives with respect to σ and M, from G and its derivatives with respect to Ω.
fn shape(term: &Term, inertia: &Inertia, [g, g1, g2]: [f64; 3]) -> [[f64; 2]; 3] {
    let Inertia { sigma, momentum, .. } = *inertia;
    let m = f64::from(term.multiple);
    let a = f64::from(term.harmonic) - m * sigma;
    let ([s, s1, s2], [nu, nu1, nu2]) = (term.square(sigma), term.per_momentum);
    let along = a * nu1 + m * nu;
    [
        [a / momentum * s1 * g + s * along * g1, s * g / momentum],
        [
            (a * s2 - m * s1) / momentum * g
                + (2.0 * a * s1 * nu1 + m * s1 * nu + s * a * nu2) * g1
                + s * along * momentum * nu1 * g2,
            s1 * g / momentum + s * g1 * nu1,
        ],
        [a / momentum * s1 * (g1 * nu - g / momentum) + s * along * nu * g2, s / momentum * (g1 * nu - g / momentum)],
    ]
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

/// The part of G that the closed form of K2 omits for a term at one harmonic of the orbit, and its derivatives with respect to Ω; `None` where there is none.
fn omitted(term: &Term, divisors: Option<&Divisors>, (j, mean_motion): (i32, f64)) -> Option<[f64; 3]> {
    let (omega, step) = (term.frequency, f64::from(j) * mean_motion);
    match divisors {
        Some(divisors) if divisors.resonant == Some(j) && divisors.slow => None,
        Some(divisors) if divisors.resonant == Some(j) => Some(closed_form(omega, step).map(|part| -part)),
        // One divisor for all parts of the harmonic. The error is part of that of the shift.
        Some(divisors) if divisors.slow => Some(reciprocal(divisors.at(j, 2 * j.signum()))),
        Some(divisors) if j != 0 => Some(beyond(omega, step, divisors.at(j, 2 * j.signum()))),
        None if j != 0 && (omega + step).abs() > NEAREST_IN_K2 * mean_motion => Some(beyond(omega, step, omega + step)),
        _ => None,
    }
}

/// 1/Ω − jn/Ω² and its derivatives with respect to Ω, for a harmonic of frequency jn.
fn closed_form(omega: f64, step: f64) -> [f64; 3] {
    let [value, slope, curvature] = reciprocal(omega);
    let ratio = step / omega;
    [value * (1.0 - ratio), slope * (1.0 - 2.0 * ratio), curvature * (1.0 - 3.0 * ratio)]
}

/// (jn)²/(Ω² Ω_j) and its derivatives with respect to Ω, for a harmonic of frequency jn and its divisor Ω_j.
fn beyond(omega: f64, step: f64, divisor: f64) -> [f64; 3] {
    let value = (step / omega).powi(2) / divisor;
    let slope = -2.0 / omega - 1.0 / divisor;
    [value, value * slope, value * (slope * slope + 2.0 / (omega * omega) + 1.0 / (divisor * divisor))]
}
