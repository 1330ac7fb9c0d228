//! ⟨D⟩ + K2 in closed form, to first order in n/Ω, and its derivatives: equations (2) and (3) of docs/theory-second-order.md.
//!
//! With the strength Γ, the components k_r and k_N of k, and F_j for each term,
//!
//! ```text
//! Â_mj = Σ_h [(h − mσ) dF_j/dσ − m(j+1) F_j],   B̂_mj = Σ_h F_j
//! K2 = −(Γ²(a/r)⁶/M²) [P0 + P1 k_r² + P2 k_r⁴] − (Γ²(a/r)⁶ ḟ k_N/M³) [Q0 + Q1 k_r²]
//! ```
//!
//! with h > 0 for m = 0, where P and Q are sums of Â and B̂. Terms with j = 0 hold the disturbing body fixed. K2 contains neither ℓ′ nor y′, so the mean σ and M
//! are constant to second order.

use nalgebra::Vector3;

use super::k2_remainder::SteadyRates;
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::terms::term::Term;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// P0, P1, P2, Q0, Q1, times their factors before the geometry.
type K2Factors = [f64; 5];

/// ⟨D⟩ + K2 at one mean σ and M, as a function of the angular momentum's direction and of the disturbing body's place.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hamiltonian {
    /// ΓΔ of ⟨D⟩ = ΓΔ (a/r)³ (k_r² − ⅓), and its derivatives with respect to L and to M at fixed L.
    pub(crate) first: [f64; 3],
    /// The coefficients of K2, and their derivatives with respect to L and to M at fixed L.
    pub(crate) second: [K2Factors; 3],
    pub(crate) momentum: f64,
    /// The constant rates by the part of K2 that the closed form omits.
    pub(crate) steady: SteadyRates,
}

/// The disturbing body at several places of one orbit.
#[derive(Clone, Copy)]
pub(crate) struct DisturberLanes<S: InstructionSet> {
    pub(crate) direction: [Lanes<S>; 3],
    pub(crate) normal: Vector3<f64>,
    pub(crate) cube: Lanes<S>,
    pub(crate) rate: Lanes<S>,
}

/// The product of two vectors.
#[inline(always)]
pub(crate) fn dot<S: InstructionSet>(one: &[Lanes<S>; 3], other: &[Lanes<S>; 3]) -> Lanes<S> {
    one[0].mul_add(other[0], one[1].mul_add(other[1], one[2] * other[2]))
}

/// Vectors in all lanes.
#[inline(always)]
pub(crate) fn in_lanes<S: InstructionSet, const N: usize>(
    like: Lanes<S>,
    vectors: &[Vector3<f64>; N],
) -> [[Lanes<S>; 3]; N] {
    let mut lanes = [[like; 3]; N];
    for (components, vector) in lanes.iter_mut().zip(vectors) {
        *components = [like.all(vector.x), like.all(vector.y), like.all(vector.z)];
    }
    lanes
}

/// The component of a vector across a unit vector, times a factor.
#[inline(always)]
pub(crate) fn across<S: InstructionSet>(
    mut vector: [Lanes<S>; 3],
    axis: &[Lanes<S>; 3],
    factor: Lanes<S>,
) -> [Lanes<S>; 3] {
    let along = dot(axis, &vector);
    for (component, axis) in vector.iter_mut().zip(axis) {
        *component = axis.negate_mul_add(along, *component) * factor;
    }
    vector
}

impl Hamiltonian {
    /// ⟨D⟩ alone; `strength` is Γ.
    pub(crate) fn first(inertia: &Inertia, strength: f64) -> Self {
        let Inertia { sigma, momentum, .. } = *inertia;
        let [value, slope, _] = Term::average(inertia).map(|part| strength * part);
        let by_action = slope / momentum;
        let first = [value, by_action, -by_action * sigma];
        Self { first, momentum, ..Self::default() }
    }

    /// From the terms of the disturbing function.
    pub(crate) fn new(inertia: &Inertia, terms: &[Term], strength: f64) -> Self {
        let Inertia { sigma, momentum, .. } = *inertia;
        let sums = [0, 1].map(|order| K2Sums::new(terms, sigma, order));
        let mut second = [[0.0; 5]; 3];
        let [values, slopes] = [0, 1].map(|part| coefficients(&sums, part));
        for i in 0..5 {
            // The power of 1/M is j + 2.
            let power = if i < 3 { 2 } else { 3 };
            let scale = -strength * strength / momentum.powi(power);
            second[0][i] = scale * values[i];
            second[1][i] = scale * slopes[i] / momentum;
            second[2][i] = -scale * (f64::from(power) * values[i] + sigma * slopes[i]) / momentum;
        }
        Self { second, ..Self::first(inertia, strength) }
    }

    /// (ΓΔ)²/(Mn), and its derivatives with respect to L and to M at fixed L; `mean_motion` is n.
    pub(crate) fn squares(&self, mean_motion: f64) -> [f64; 3] {
        let [c, by_action, by_momentum] = self.first;
        let square = c / (self.momentum * mean_motion);
        [c * square, 2.0 * by_action * square, (2.0 * by_momentum - c / self.momentum) * square]
    }

    /// The derivatives of the mean variables for angular momenta along unit vectors: the rotation across them, and what is added to dℓ′/dt and dy′/dt.
    #[inline(always)]
    pub(crate) fn slopes_at<S: InstructionSet>(
        &self,
        axis: &[Lanes<S>; 3],
        disturber: &DisturberLanes<S>,
    ) -> ([Lanes<S>; 3], [Lanes<S>; 2]) {
        let DisturberLanes { direction, normal, cube, rate } = disturber;
        let all = |value: f64| cube.all(value);
        let [normal] = in_lanes(*cube, &[*normal]);
        let (along, to_normal) = (dot(axis, direction), dot(axis, &normal));
        let square = along * along;
        let still = *cube * *cube;
        let moving = still * *rate;
        let mut phases = [*cube; 2];
        for ((phase, row), steady) in phases.iter_mut().zip([1, 2]).zip(self.steady.phases) {
            let [p0, p1, p2, q0, q1] = self.second[row];
            let of_still = square.mul_add(square.mul_add(all(p2), all(p1)), all(p0));
            let of_moving = to_normal * square.mul_add(all(q1), all(q0));
            let first = *cube * all(self.first[row]) * (square - all(1.0 / 3.0));
            *phase = still.mul_add(of_still, moving.mul_add(of_moving, first)) + all(steady);
        }
        let [_, p1, p2, q0, q1] = self.second[0];
        let of_body = still.mul_add(square.mul_add(all(4.0 * p2), all(2.0 * p1)), *cube * all(2.0 * self.first[0]));
        let by_body = along * (moving * to_normal).mul_add(all(2.0 * q1), of_body);
        let by_normal = moving * square.mul_add(all(q1), all(q0));
        let mut force = *direction;
        for ((component, normal), steady) in force.iter_mut().zip(normal).zip(&self.steady.force) {
            *component = component.mul_add(by_body, normal.mul_add(by_normal, all(*steady)));
        }
        (across(force, axis, all(1.0 / self.momentum)), phases)
    }
}

/// Â_mj and B̂_mj of one j, by m, and their derivatives with respect to σ.
struct K2Sums {
    by_action: [[f64; 2]; 3],
    by_turn: [[f64; 2]; 3],
}

impl K2Sums {
    fn new(terms: &[Term], sigma: f64, order: i32) -> Self {
        let mut sums = Self { by_action: [[0.0; 2]; 3], by_turn: [[0.0; 2]; 3] };
        for term in terms {
            let (h, m) = (f64::from(term.harmonic), f64::from(term.multiple));
            let [value, slope, curvature] = product(term.square(sigma), power(term.per_momentum, -(order + 1)));
            let weight = m * f64::from(order + 1);
            let index = term.multiple as usize; // 0 ≤ m ≤ 2
            sums.by_action[index][0] += (h - m * sigma) * slope - weight * value;
            sums.by_action[index][1] += (h - m * sigma) * curvature - (m + weight) * slope;
            sums.by_turn[index][0] += value;
            sums.by_turn[index][1] += slope;
        }
        sums
    }
}

/// P0, P1, P2, Q0, Q1 (`part` 0) or their derivatives with respect to σ (1) from the sums for j = 0 and 1.
fn coefficients([still, moving]: &[K2Sums; 2], part: usize) -> K2Factors {
    let [a0, a1, a2] = still.by_action.map(|sum| sum[part]);
    let [_, b1, b2] = still.by_turn.map(|sum| sum[part]);
    let [_, c1, c2] = moving.by_action.map(|sum| sum[part]);
    let [d0, d1, d2] = moving.by_turn.map(|sum| sum[part]);
    [
        a0 / 9.0 + a2,
        -2.0 / 3.0 * a0 + a1 - 2.0 * b1 - 2.0 * a2 + 8.0 * b2,
        a0 + 4.0 * b1 - a1 + a2 - 8.0 * b2,
        2.0 * c2 - d1,
        c1 - 4.0 * d0 + 8.0 * d2 - 2.0 * c2 + d1,
    ]
}

/// A power of a function and its first two derivatives.
fn power([value, slope, curvature]: [f64; 3], exponent: i32) -> [f64; 3] {
    let e = f64::from(exponent);
    let lower = value.powi(exponent - 2);
    [
        lower * value * value,
        e * lower * value * slope,
        e * (e - 1.0) * lower * slope * slope + e * lower * value * curvature,
    ]
}

fn product(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2]]
}
