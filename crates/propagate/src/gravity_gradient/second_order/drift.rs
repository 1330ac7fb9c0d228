//! How far the averaged motions of first and of second order in the torque are from each other over a span.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::hamiltonian::{Disturber, Hamiltonian};
use crate::gravity_gradient::corrections::Demand;
use crate::gravity_gradient::envelope::{Reach, on_ellipse};

/// Steps of the integral over an orbit, or over a span that is shorter, even in the true anomaly.
const STEPS: usize = 48;

/// A turn of the angular momentum in inertial components, and changes of ℓ′ and y′.
type Difference = [f64; 5];

/// The differences between the averaged motions of first and second order.
pub(crate) struct Drift<'a> {
    /// K2 alone.
    pub(crate) hamiltonian: &'a Hamiltonian,
    pub(crate) demand: &'a Demand<'a>,
    pub(crate) reach: &'a Reach,
    /// The direction of the angular momentum.
    pub(crate) axis: Vector3<f64>,
    /// Rates of ℓ′ and y′ at the mean M and σ of second order, less those of first order.
    pub(crate) rates: [f64; 2],
    /// Turn of the attitude for a unit change of ℓ′.
    pub(crate) visible: f64,
}

impl Drift<'_> {
    /// The largest difference of the attitude within the span \[rad\].
    pub(crate) fn largest(&self) -> f64 {
        let mean_motion = self.demand.mean_motion;
        let period = TAU / mean_motion;
        let mut largest = 0.0_f64;
        let [before, after] = self.reach.sides;
        for (sign, side) in [(1.0, after), (-1.0, before)] {
            if side == 0.0 {
                continue;
            }
            let duration = side / mean_motion;
            let orbit = self.orbit(sign, side);
            let (_, whole) = orbit[STEPS];
            for (time, part) in &orbit {
                // The difference is linear in the number of whole orbits: it is largest at the first or at the last.
                for turns in [0.0, ((duration - time) / period).floor().max(0.0)] {
                    let elapsed = sign * (turns * period + time);
                    let mut sum: Difference = std::array::from_fn(|i| part[i] + turns * whole[i]);
                    sum[3] += self.rates[0] * elapsed;
                    sum[4] += self.rates[1] * elapsed;
                    let [x, y, z, anomaly, longitude] = sum;
                    // The turns by ℓ′ and by y′ may be about the same axis.
                    let about = self.visible * anomaly.abs() + longitude.abs();
                    largest = largest.max((x * x + y * y + z * z + about * about).sqrt());
                }
            }
        }
        largest
    }

    /// Times from the epoch, and the change by K2 until then: over one orbit, or to the end of a shorter span.
    fn orbit(&self, sign: f64, side: f64) -> Vec<(f64, Difference)> {
        let anomaly = self.reach.anomaly;
        let start = self.reach.true_anomaly(anomaly);
        let end = if side < TAU {
            let end = self.reach.true_anomaly(anomaly + sign * side);
            if sign * (end - start) < 0.0 { end + sign * TAU } else { end }
        } else {
            start + sign * TAU
        };
        let step = (end - start).abs() / STEPS as f64;
        let (mut time, mut sum) = (0.0, [0.0; 5]);
        let mut steps = vec![(time, sum)];
        for k in 0..STEPS {
            let (slopes, rate) = self.slopes(start + sign * (k as f64 + 0.5) * step);
            time += step / rate;
            sum = std::array::from_fn(|i| sum[i] + sign * slopes[i] * step / rate);
            steps.push((time, sum));
        }
        steps
    }

    /// K2's time derivatives at a true anomaly, and the rate of the anomaly.
    fn slopes(&self, anomaly: f64) -> (Difference, f64) {
        let eccentricity = self.reach.eccentricity;
        let [first, second, normal] = self.demand.orbit.axes();
        let (sine, cosine) = anomaly.sin_cos();
        let [rate, cube] = on_ellipse(self.demand.mean_motion, eccentricity, anomaly);
        let disturber = Disturber { direction: first * cosine + second * sine, normal, cube, rate };
        let slopes = self.hamiltonian.slopes(&self.axis, &disturber);
        let [x, y, z] = slopes.turning.into();
        let [anomaly, longitude] = slopes.phases;
        ([x, y, z, anomaly, longitude], rate)
    }
}
