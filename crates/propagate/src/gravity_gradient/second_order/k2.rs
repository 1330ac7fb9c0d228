//! ⟨D⟩ + K2 in closed form, to first order in n/Ω, and its derivatives.
//!
//! With q = 3φn²/2, u = (a/r)³, s = k·r̂, c = k·N (N the normal of the orbit) and q_j = f² σ^|h| / ν^(j+1) for each term,
//!
//! ```text
//! Â_mj = Σ_h [(h − mσ) dq_j/dσ − m(j+1) q_j],   B̂_mj = Σ_h q_j
//! K2 = −(q²u²/M²) [P0 + P1 s² + P2 s⁴] − (q²u²ḟ c/M³) [Q0 + Q1 s²]
//! ```
//!
//! with h > 0 for m = 0, and P, Q sums of Â and B̂ (theory §9). Terms without j hold the disturbing body fixed. K2 has no ℓ′ and no y′: mean σ and M are
//! constant to second order.

use nalgebra::Vector3;

use super::k2_remainder::SteadyRates;
use crate::gravity_gradient::body::inertia::Inertia;
use crate::gravity_gradient::terms::term::Term;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// P0, P1, P2, Q0, Q1, times their factors before the geometry.
type K2Factors = [f64; 5];

/// ⟨D⟩ + K2 at one mean σ and M, as a function of the angular momentum's direction and of the disturbing body's place.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hamiltonian {
    /// C of ⟨D⟩ = C u (s² − ⅓), and its derivatives with respect to L and to M at fixed L.
    pub(crate) first: [f64; 3],
    /// The coefficients of K2, and their derivatives with respect to L and to M at fixed L.
    pub(crate) second: [K2Factors; 3],
    pub(crate) momentum: f64,
    /// The constant rates by the part of K2 that the closed form omits.
    pub(crate) steady: SteadyRates,
}

/// Where the disturbing body is, as the averaged equations see it.
#[cfg(test)]
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedBody {
    /// Unit vector to it.
    pub(crate) direction: Vector3<f64>,
    /// Normal of its orbit.
    pub(crate) normal: Vector3<f64>,
    /// (a/r)³.
    pub(crate) cube: f64,
    /// Rate of its true anomaly.
    pub(crate) rate: f64,
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

/// Time derivatives of the mean motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeanRates {
    /// Rotation of the invariable frame, across the angular momentum.
    pub(crate) turning: Vector3<f64>,
    /// What is added to dℓ′/dt and dy′/dt.
    pub(crate) phases: [f64; 2],
}

impl Hamiltonian {
    /// ⟨D⟩ alone; `strength` is q.
    pub(crate) fn first(inertia: &Inertia, strength: f64) -> Self {
        let Inertia { sigma, momentum, .. } = *inertia;
        let [value, slope] = inertia.average_torque().map(|part| strength * part);
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

    /// With the constant rates by the part of K2 that the closed form omits.
    pub(crate) fn with_steady(self, steady: SteadyRates) -> Self {
        Self { steady, ..self }
    }

    /// C²/Mn, and its derivatives with respect to L and to M at fixed L; `mean_motion` is n.
    pub(crate) fn squares(&self, mean_motion: f64) -> [f64; 3] {
        let [c, by_action, by_momentum] = self.first;
        let square = c / (self.momentum * mean_motion);
        [c * square, 2.0 * by_action * square, (2.0 * by_momentum - c / self.momentum) * square]
    }

    /// K2 without ⟨D⟩.
    #[cfg(test)]
    pub(crate) fn without_first(self) -> Self {
        Self { first: [0.0; 3], ..self }
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
        let mut level = [*cube; 3];
        for (component, normal) in level.iter_mut().zip(normal) {
            *component = all(*normal);
        }
        let (along, across) = (dot(axis, direction), dot(axis, &level));
        let square = along * along;
        let still = *cube * *cube;
        let moving = still * *rate;
        let mut phases = [*cube; 2];
        for ((phase, row), steady) in phases.iter_mut().zip([1, 2]).zip(self.steady.phases) {
            let [p0, p1, p2, q0, q1] = self.second[row];
            let of_still = square.mul_add(square.mul_add(all(p2), all(p1)), all(p0));
            let of_moving = across * square.mul_add(all(q1), all(q0));
            let first = *cube * all(self.first[row]) * (square - all(1.0 / 3.0));
            *phase = still.mul_add(of_still, moving.mul_add(of_moving, first)) + all(steady);
        }
        let [_, p1, p2, q0, q1] = self.second[0];
        let of_body = still.mul_add(square.mul_add(all(4.0 * p2), all(2.0 * p1)), *cube * all(2.0 * self.first[0]));
        let to_body = along * (moving * across).mul_add(all(2.0 * q1), of_body);
        let to_normal = moving * square.mul_add(all(q1), all(q0));
        let mut force = *direction;
        for ((component, normal), steady) in force.iter_mut().zip(level).zip(&self.steady.force) {
            *component = component.mul_add(to_body, normal.mul_add(to_normal, all(*steady)));
        }
        let beside = dot(axis, &force);
        let mut turning = force;
        for (component, axis) in turning.iter_mut().zip(axis) {
            *component = axis.negate_mul_add(beside, *component) * all(1.0 / self.momentum);
        }
        (turning, phases)
    }

    /// The derivatives of the mean variables for an angular momentum along a unit vector.
    #[cfg(test)]
    pub(crate) fn slopes(&self, axis: &Vector3<f64>, disturber: &PlacedBody) -> MeanRates {
        let one = |value: f64| Lanes::splat(pulp::Scalar, value);
        let vector = |vector: &Vector3<f64>| [one(vector.x), one(vector.y), one(vector.z)];
        let PlacedBody { direction, normal, cube, rate } = disturber;
        let disturber =
            DisturberLanes { direction: vector(direction), normal: *normal, cube: one(*cube), rate: one(*rate) };
        let (turning, phases) = self.slopes_at(&vector(axis), &disturber);
        MeanRates {
            turning: turning.map(|lanes| lanes.values()[0]).into(),
            phases: phases.map(|lanes| lanes.values()[0]),
        }
    }

    /// ⟨D⟩ and K2.
    #[cfg(test)]
    pub(crate) fn values(&self, axis: &Vector3<f64>, disturber: &PlacedBody) -> [f64; 2] {
        let square = axis.dot(&disturber.direction).powi(2);
        let [p0, p1, p2, q0, q1] = self.second[0];
        let moving = disturber.rate * axis.dot(&disturber.normal) * (q0 + q1 * square);
        let second = disturber.cube.powi(2) * (p0 + square * (p1 + square * p2) + moving);
        [self.first[0] * disturber.cube * (square - 1.0 / 3.0), second]
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
            let [value, slope, curvature] = product(term.square(sigma), power(term.frequency, -(order + 1)));
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
