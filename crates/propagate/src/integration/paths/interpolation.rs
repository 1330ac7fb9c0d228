//! The series of a tabulated body: of the polynomial through the nearest rows.
//!
//! The polynomial belongs to an interval of the table, so a step ends at each of its times.

use std::sync::Arc;

use andoyer_double::two_sum;

use crate::integration::series::{GRAVITY, ROWS, Scalars, Series, power, product};
use crate::numerics::scaling::scaled;
use crate::orbit::table::{TabulatedOrbit, taylor};

/// A table in the unit of the integration.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    orbit: Arc<TabulatedOrbit>,
    /// Times from the epoch, in double-double.
    knots: Arc<Vec<(f64, f64)>>,
    /// A length by which positions are divided, and the unit of time, 2^−exponent.
    length: f64,
    exponent: i32,
    /// The series is `strength` times this power of the distance over `length` times the position over `length`: √(3 gm/length³) and −5/2 for the gravity
    /// gradient.
    strength: f64,
    power: f64,
    /// Whether a polynomial is the earlier or the later neighbour of the one of its interval.
    earlier: Option<bool>,
}

impl Table {
    /// The length by which positions are divided: the first distance.
    pub(crate) fn length(orbit: &TabulatedOrbit) -> f64 {
        let [x, y, z] = orbit.positions()[0];
        x.hypot(y).hypot(z)
    }

    pub(crate) fn new(
        orbit: &Arc<TabulatedOrbit>,
        (epoch, exponent): (f64, i32),
        (strength, power): (f64, f64),
    ) -> Self {
        let knots = orbit.times().iter().map(|time| {
            let (high, low) = two_sum(*time, -epoch);
            (scaled(high, exponent), scaled(low, exponent))
        });
        let (knots, length) = (Arc::new(knots.collect()), Self::length(orbit));
        Self { orbit: orbit.clone(), knots, length, exponent, strength, power, earlier: None }
    }

    pub(crate) fn neighbouring(&self, earlier: bool) -> Self {
        Self { earlier: Some(earlier), ..self.clone() }
    }

    /// The index of the interval that begins at a time or contains it.
    fn interval(&self, time: (f64, f64)) -> usize {
        let after = self.knots.partition_point(|knot| *knot <= time);
        after.clamp(1, self.knots.len() - 1) - 1
    }

    pub(crate) fn next_knot(&self, time: f64, forward: bool) -> Option<(f64, f64)> {
        if forward {
            self.knots.get(self.knots.partition_point(|knot| knot.0 <= time)).copied()
        } else {
            self.knots[..self.knots.partition_point(|knot| knot.0 < time)].last().copied()
        }
    }

    /// The number of intervals between the epoch and a time, that of the time included.
    pub(crate) fn passed(&self, time: (f64, f64)) -> f64 {
        self.interval(time).abs_diff(self.interval((0.0, 0.0))) as f64 + 1.0
    }

    /// Newton's divided differences, expanded about the time. Returns a radius of convergence: that of a straight path, and less of a bent one.
    pub(crate) fn series(&self, time: ((f64, f64), bool), order: usize, out: &mut Series) -> f64 {
        let (position, factor, nodes) = self.expanded(time, order);
        for (k, row) in out.iter_mut().enumerate().take(order) {
            let [x, y, z] = position.each_ref().map(|p| product(p, &factor, k));
            *row = [x, y, z, 0.0];
        }
        let size = |k: usize| position.iter().map(|p| p[k] * p[k]).sum::<f64>();
        let nearest = |k: usize| (size(0) / size(k)).powf(0.5 / k as f64);
        (1..nodes).map(nearest).fold(f64::INFINITY, f64::min)
    }

    /// The position, the factor with the power of the distance, and the number of times of the polynomial.
    pub(crate) fn expanded(
        &self,
        (time, backward): ((f64, f64), bool),
        order: usize,
    ) -> ([Scalars; 3], Scalars, usize) {
        let interval = self.interval(time);
        // A step backwards from a time of the table lies in the interval before it.
        let back = backward && self.knots[interval] == time;
        let interval = if back { self.knots.partition_point(|knot| *knot < time).saturating_sub(1) } else { interval };
        let rows = self.orbit.around(interval, self.earlier);
        let coefficients = taylor(
            &rows,
            |row| (self.knots[row].0 - time.0) + (self.knots[row].1 - time.1),
            |row| self.orbit.positions()[row].map(|value| value / self.length),
            |row| Some(self.orbit.velocities()?[row].map(|value| scaled(value, -self.exponent) / self.length)),
        );
        let mut position: [Scalars; 3] = [[0.0; ROWS]; 3];
        for (p, coefficients) in position.iter_mut().zip(&coefficients) {
            p[..coefficients.len()].copy_from_slice(coefficients);
        }
        let nodes = if self.orbit.velocities().is_some() { 2 * rows.len() } else { rows.len() };
        let (mut square, mut factor): (Scalars, Scalars) = ([0.0; ROWS], [0.0; ROWS]);
        for k in 0..order {
            square[k] = position.iter().map(|p| product(p, p, k)).sum();
            factor[k] = match k {
                0 if self.power == GRAVITY => self.strength / (square[0] * square[0].sqrt().sqrt()),
                0 => self.strength * square[0].powf(0.5 * self.power),
                _ => power(&square, &factor, 0.5 * self.power, k),
            };
        }
        (position, factor, nodes)
    }
}
