//! The full equations of a rigid body under a gravity gradient, integrated: Gauss's collocation of order 16, fixed step, compensated sums.
//!
//! Attitude and Euler's equations with the torques 3 n² (a/r)³ r̂ × I r̂ times the mass fraction, each disturbing body on Kepler's orbit. It shares no formula
//! with the averaged theory. Steps of at most 1 rad of the fastest rate: the method leaves 1e-23 h^17 of a step, so that rounding is all that is left.
//! Coefficients in plain doubles would make the energy drift by 1e-16 a step, and the phase by that times the square of their number: they carry a second
//! double.

use andoyer_double::DoubleDouble;
use andoyer_propagate::Orbit;
use andoyer_propagate::nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};

const STAGES: usize = 8;
const UNKNOWNS: usize = 7;
/// Radians of the fastest rate in a step.
const STEP: f64 = 1.0;

type Vector = [f64; UNKNOWNS];

/// A body and the orbit that disturbs it; `None` for free rotation.
#[derive(Clone, Copy, Debug)]
pub struct Problem {
    /// Moments about body axes 1, 2, 3.
    pub moments: [f64; 3],
    /// The orbit.
    pub orbit: Option<Orbit>,
}

/// Nodes and the integrals of their Lagrange polynomials.
struct Tableau {
    nodes: [f64; STAGES],
    inner: [[DoubleDouble; STAGES]; STAGES],
    weights: [DoubleDouble; STAGES],
}

impl Problem {
    /// Attitude [x, y, z, w] and rates at times that go one way from the epoch, from the state there.
    pub fn integrate(
        &self,
        epoch: f64,
        attitude: [f64; 4],
        rates: [f64; 3],
        times: &[f64],
    ) -> Vec<([f64; 4], [f64; 3])> {
        self.integrate_under(self.orbit.as_slice(), epoch, (attitude, rates), times)
    }

    /// The same under the bodies of these orbits, which may precess, in place of the problem's.
    pub fn integrate_under(
        &self,
        orbits: &[Orbit],
        epoch: f64,
        (attitude, rates): ([f64; 4], [f64; 3]),
        times: &[f64],
    ) -> Vec<([f64; 4], [f64; 3])> {
        let tableau = Tableau::gauss();
        let fastest = rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        let [x, y, z, w] = attitude;
        let [a, b, c] = rates;
        let mut state = [x, y, z, w, a, b, c];
        let (mut lost, mut now) = ([0.0; UNKNOWNS], epoch);
        let mut states = Vec::with_capacity(times.len());
        for &time in times {
            let steps = ((time - now).abs() * fastest / STEP).ceil().max(1.0);
            let step = (time - now) / steps;
            for k in 0..steps as usize {
                self.advance((&tableau, orbits), (now + k as f64 * step, step), &mut state, &mut lost);
            }
            now = time;
            let norm = state[..4].iter().map(|c| c * c).sum::<f64>().sqrt();
            states.push((std::array::from_fn(|i| state[i] / norm), std::array::from_fn(|i| state[4 + i])));
        }
        states
    }

    fn advance(
        &self,
        (tableau, orbits): (&Tableau, &[Orbit]),
        (start, step): (f64, f64),
        state: &mut Vector,
        lost: &mut Vector,
    ) {
        let places = tableau
            .nodes
            .map(|node| orbits.iter().map(|orbit| disturber(orbit, start + node * step)).collect::<Vec<_>>());
        let mut slopes = places.each_ref().map(|places| self.slope(state, places));
        let mut last = f64::INFINITY;
        loop {
            let mut change = 0.0_f64;
            for i in 0..STAGES {
                let stage =
                    std::array::from_fn(|c| state[c] + (step * weighted(&tableau.inner[i], &slopes, c) - lost[c]));
                let slope = self.slope(&stage, &places[i]);
                change = (0..UNKNOWNS).fold(change, |most, c| most.max((slope[c] - slopes[i][c]).abs()));
                slopes[i] = slope;
            }
            // Until rounding alone is left: a part of the last change would be a drift.
            if change >= last || change.is_nan() {
                break;
            }
            last = change;
        }
        for c in 0..UNKNOWNS {
            let increment = step * weighted(&tableau.weights, &slopes, c) - lost[c];
            let sum = state[c] + increment;
            lost[c] = (sum - state[c]) - increment;
            state[c] = sum;
        }
    }

    fn slope(&self, state: &Vector, places: &[(f64, Vector3<f64>)]) -> Vector {
        let [x, y, z, w, rates @ ..] = *state;
        let rates = Vector3::from(rates);
        let attitude = Quaternion::new(w, x, y, z);
        let moments = Vector3::from(self.moments);
        let mut torque = moments.component_mul(&rates).cross(&rates);
        for (strength, direction) in places {
            let direction = UnitQuaternion::new_normalize(attitude).inverse() * direction;
            torque += direction.cross(&moments.component_mul(&direction)) * *strength;
        }
        let turning = attitude * Quaternion::from_parts(0.0, rates * 0.5);
        let acceleration = torque.component_div(&moments);
        [turning.i, turning.j, turning.k, turning.w, acceleration.x, acceleration.y, acceleration.z]
    }
}

/// 3 G m/r³ of the disturbing body, and r̂.
fn disturber(orbit: &Orbit, time: f64) -> (f64, Vector3<f64>) {
    let [n, e, pericentre, inclination, node, argument, _] = orbit.elements();
    let [node_rate, pericentre_rate] = orbit.rates();
    let (node, argument) = (node + node_rate * (time - pericentre), argument + pericentre_rate * (time - pericentre));
    let mean = (n * (time - pericentre)).rem_euclid(std::f64::consts::TAU);
    // Newton's method from π converges for every mean anomaly in a turn.
    let mut anomaly = std::f64::consts::PI;
    for _ in 0..40 {
        let step = (anomaly - e * anomaly.sin() - mean) / (1.0 - e * anomaly.cos());
        anomaly -= step;
        if step.abs() <= 1e-15 {
            break;
        }
    }
    let radius = 1.0 - e * anomaly.cos();
    let place = Vector3::new(anomaly.cos() - e, (1.0 - e * e).sqrt() * anomaly.sin(), 0.0) / radius;
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), node)
        * Rotation3::from_axis_angle(&Vector3::x_axis(), inclination)
        * Rotation3::from_axis_angle(&Vector3::z_axis(), argument);
    (3.0 * orbit.strength() / radius.powi(3), turn * place)
}

/// A component of a weighted sum of slopes.
fn weighted(weights: &[DoubleDouble; STAGES], slopes: &[Vector; STAGES], component: usize) -> f64 {
    let sum = |part: fn(&DoubleDouble) -> f64| -> f64 {
        weights.iter().zip(slopes).map(|(weight, slope)| part(weight) * slope[component]).sum()
    };
    sum(|weight| weight.high) + sum(|weight| weight.low)
}

impl Tableau {
    /// Gauss's, on [0, 1]: roots of the Legendre polynomial by Newton's method, integrals by the same quadrature.
    fn gauss() -> Self {
        let number = |x: f64| DoubleDouble::from(x);
        let (mut nodes, mut weights) = ([DoubleDouble::ZERO; STAGES], [DoubleDouble::ZERO; STAGES]);
        for i in 0..STAGES {
            let mut x = number(-(std::f64::consts::PI * (i as f64 + 0.75) / (STAGES as f64 + 0.5)).cos());
            let mut slope = DoubleDouble::ZERO;
            for _ in 0..20 {
                let (value, derivative) = legendre(x);
                slope = derivative;
                x = x - value / derivative;
            }
            nodes[i] = (DoubleDouble::ONE + x) * number(0.5);
            weights[i] = DoubleDouble::ONE / ((DoubleDouble::ONE - x * x) * slope * slope);
        }
        let lagrange = |j: usize, at: DoubleDouble| {
            let others = (0..STAGES).filter(|&k| k != j);
            others.fold(DoubleDouble::ONE, |product, k| product * ((at - nodes[k]) / (nodes[j] - nodes[k])))
        };
        // A polynomial of degree 7 over [0, c]: the rule is exact for it.
        let integral = |j: usize, to: DoubleDouble| {
            (0..STAGES).fold(DoubleDouble::ZERO, |sum, k| sum + to * weights[k] * lagrange(j, to * nodes[k]))
        };
        let inner = std::array::from_fn(|i| std::array::from_fn(|j| integral(j, nodes[i])));
        Self { nodes: nodes.map(|node| node.to_f64()), inner, weights }
    }
}

/// The Legendre polynomial of as many roots as there are stages, and its derivative.
fn legendre(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let number = |x: usize| DoubleDouble::from(x as f64);
    let (mut lower, mut value) = (DoubleDouble::ONE, x);
    for n in 2..=STAGES {
        (lower, value) = (value, (number(2 * n - 1) * x * value - number(n - 1) * lower) / number(n));
    }
    (value, number(STAGES) * (lower - x * value) / (DoubleDouble::ONE - x * x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_phase_of_a_free_motion_is_that_of_the_closed_form_after_a_hundred_thousand_rotations() {
        use andoyer_propagate::{Body, Scene, State};
        let (moments, rates) = ([0.5, 0.8, 1.0], [0.3, 0.1, 1.0]);
        let times: Vec<f64> = (1..=6).map(|k| 1e5 * f64::from(k)).collect();
        let states = Problem { moments, orbit: None }.integrate(0.0, [0.0, 0.0, 0.0, 1.0], rates, &times);
        let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], rates).expect("a state");
        let motion = Scene::new(Body::new(moments).expect("a body"), state).solve().expect("free");
        for (&time, &(attitude, _)) in times.iter().zip(&states) {
            let exact = motion.at(time).expect("finite").attitude.coords.into();
            let error = crate::attitude_error(attitude, exact);
            assert!(error <= 1e-8, "{error:e}");
        }
    }

    #[test]
    fn the_rule_is_exact_to_degree_fifteen_and_the_free_motion_keeps_energy_and_momentum() {
        let tableau = Tableau::gauss();
        for degree in 0..=15 {
            let sum: f64 = (0..STAGES).map(|i| tableau.weights[i].to_f64() * tableau.nodes[i].powi(degree)).sum();
            assert!((sum * f64::from(degree + 1) - 1.0).abs() < 1e-14, "{degree}: {sum}");
        }
        let problem = Problem { moments: [1.0, 1.5, 2.0], orbit: None };
        let states = problem.integrate(0.0, [0.0, 0.0, 0.0, 1.0], [0.3, 0.2, 1.0], &[100.0, 1000.0]);
        let energy = |w: [f64; 3]| w[0] * w[0] + 1.5 * w[1] * w[1] + 2.0 * w[2] * w[2];
        assert!((energy(states[1].1) / energy([0.3, 0.2, 1.0]) - 1.0).abs() < 1e-14);
        let momentum = |(q, w): ([f64; 4], [f64; 3])| {
            UnitQuaternion::new_normalize(Quaternion::from(q)) * Vector3::new(w[0], 1.5 * w[1], 2.0 * w[2])
        };
        assert!((momentum(states[1]) - Vector3::new(0.3, 0.3, 2.0)).norm() < 1e-13);
    }
}
