//! Two numbers that compare tumblers: the energy over its minimum, and the parameter of the elliptic functions.
//!
//! Let g be the direction of the angular momentum in the body, a = C/A − 1 and b = C/B − 1 (theory §5, §10). Then
//!
//! ```text
//! E/E0 = 1 + a g1² + b g2²,   E0 = M²/(2C)
//! k² = (a − b)(g1²/b + g2²/a) / (g3² + g2² (a − b)/a),   in the long-axis mode with the axes in the opposite order
//! ```
//!
//! The sums have positive terms, so no digits are lost near the axes. The numbers are those of the state at the epoch; a gravity gradient changes them with
//! time.

use super::solved::Motion;

impl Motion {
    /// E/E0: the rotational energy over that of rotation about the axis of greatest inertia with the same angular momentum. It is between 1 and C/A, C/B on the
    /// separatrix, and 1 for a body at rest.
    pub fn energy_ratio(&self) -> f64 {
        let (first, second) = self.scene.body().excesses();
        let [g1, g2, _] = self.direction();
        1.0 + first * g1 * g1 + second * g2 * g2
    }

    /// k², the parameter of the elliptic functions of the polhode (k is their modulus). It is 0 on a principal axis and for an axisymmetric body, and 1 on the
    /// separatrix.
    pub fn elliptic_parameter(&self) -> f64 {
        let [a, b, c] = self.scene.body().sorted();
        let [g1, g2, g3] = self.direction();
        if a == b || b == c {
            return 0.0;
        }
        let short = parameter([a, b, c], [g1, g2, g3]);
        if short <= 1.0 { short } else { parameter([c, b, a], [g3, g2, g1]).min(1.0) }
    }

    /// The direction of the angular momentum on the axes of A ≤ B ≤ C, without the signs of the axes; 0 at rest.
    fn direction(&self) -> [f64; 3] {
        let moments = self.scene.body().moments();
        let rates = self.scene.state().angular_velocity;
        let largest = rates.amax();
        let mut pairs: [(f64, f64); 3] = std::array::from_fn(|i| (moments[i], rates[i]));
        pairs.sort_by(|one, other| one.0.total_cmp(&other.0));
        if largest == 0.0 {
            return [0.0; 3];
        }
        let momentum = pairs.map(|(moment, rate)| moment / pairs[2].0 * (rate / largest));
        let norm = momentum.iter().map(|x| x * x).sum::<f64>().sqrt();
        momentum.map(|x| x / norm)
    }
}

/// 1 − Q1/Q2 of theory §5 for moments in either order. It exceeds 1 if the motion is in the other mode.
fn parameter([a, b, c]: [f64; 3], [g1, g2, g3]: [f64; 3]) -> f64 {
    let (first, second) = ((c - a) / a, (c - b) / b);
    let difference = (c / b) * ((b - a) / a);
    let swing = difference * (g1 * g1 / second + g2 * g2 / first);
    let greatest = g3 * g3 + g2 * g2 * difference / first;
    if swing == 0.0 { 0.0 } else { swing / greatest }
}
