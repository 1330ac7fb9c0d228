//! The position of a disturbing body as a table of times and vectors.
//!
//! Between two times the position is the polynomial of degree seven through the eight nearest times. The error bound of a motion contains the interpolation
//! error, which is estimated with the polynomial of degree five.

use nalgebra::Vector3;

use crate::error::Error;

/// Number of times through whose positions a polynomial passes.
pub(crate) const NODES: usize = 8;

/// Positions of the disturbing body relative to the rotating body, in inertial components. Only the integrated method uses them.
///
/// ```
/// use andoyer_propagate::TabulatedOrbit;
/// let times: Vec<f64> = (0..100).map(|k| 0.1 * f64::from(k)).collect();
/// let positions: Vec<[f64; 3]> = times.iter().map(|time| [time.cos(), time.sin(), 0.0]).collect();
/// let orbit = TabulatedOrbit::new(times, positions, 1.0)?;
/// assert!((orbit.position(3.14)?[1] - 3.14_f64.sin()).abs() < 1e-10);
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TabulatedOrbit {
    times: Vec<f64>,
    positions: Vec<[f64; 3]>,
    gm: f64,
}

impl TabulatedOrbit {
    /// A table of increasing times with a position for each, and G × the mass of the disturbing body [length³/time²].
    ///
    /// # Errors
    /// - [`Error::Length`] for times and positions of different lengths.
    /// - [`Error::TooFew`] for fewer than eight times.
    /// - [`Error::Table`] for a time that is not after the one before it, a number that is not finite, or a position at the origin.
    /// - [`Error::Orbit`] for a gm of 0, −1 or NaN.
    pub fn new(times: Vec<f64>, positions: Vec<[f64; 3]>, gm: f64) -> Result<Self, Error> {
        if positions.len() != times.len() {
            return Err(Error::Length { argument: "positions", found: positions.len(), expected: times.len() });
        }
        let refused = |argument, index, value, bound| Err(Error::Table { argument, index, value, bound });
        if times.len() < NODES {
            return Err(Error::TooFew { argument: "times", found: times.len(), least: NODES });
        }
        for (index, &time) in times.iter().enumerate() {
            if !time.is_finite() {
                return refused("times", index, time, "finite");
            }
            if index > 0 && time <= times[index - 1] {
                return refused("times", index, time, "greater than the one before it");
            }
        }
        for (index, position) in positions.iter().enumerate() {
            if let Some(&value) = position.iter().find(|value| !value.is_finite()) {
                return refused("positions", index, value, "finite");
            }
            if Vector3::from(*position).norm() == 0.0 {
                return refused("positions", index, 0.0, "away from the origin");
            }
        }
        if !(gm > 0.0 && gm.is_finite()) {
            return Err(Error::Orbit { argument: "gm", value: gm, bound: "positive and finite" });
        }
        Ok(Self { times, positions, gm })
    }

    /// The times.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The positions, one for each time.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// G × the mass of the disturbing body.
    pub fn gm(&self) -> f64 {
        self.gm
    }

    /// The position at a time within the table, in inertial components.
    ///
    /// # Errors
    /// - [`Error::Table`] for a time that is outside the table or NaN.
    pub fn position(&self, time: f64) -> Result<[f64; 3], Error> {
        let (first, last) = self.ends();
        if !(first <= time && time <= last) {
            return Err(Error::Table { argument: "time", index: 0, value: time, bound: "within the table" });
        }
        let start = self.first_node(self.interval(time), NODES);
        let nodes: [f64; NODES] = std::array::from_fn(|i| self.times[start + i] - time);
        let mut table: [[f64; 3]; NODES] = std::array::from_fn(|i| self.positions[start + i]);
        // Neville's scheme, evaluated at 0.
        for level in 1..NODES {
            for i in 0..NODES - level {
                let (left, right) = (nodes[i], nodes[i + level]);
                let next = table[i + 1];
                for (value, next) in table[i].iter_mut().zip(next) {
                    *value = (right * *value - left * next) / (right - left);
                }
            }
        }
        Ok(table[0])
    }

    /// The first and the last time of the table.
    pub(crate) fn ends(&self) -> (f64, f64) {
        (self.times[0], self.times[self.times.len() - 1])
    }

    /// The index of the time at which the interval of a time begins.
    pub(crate) fn interval(&self, time: f64) -> usize {
        self.times.partition_point(|knot| *knot <= time).clamp(1, self.times.len() - 1) - 1
    }

    /// The index of the first of `count` times around an interval.
    pub(crate) fn first_node(&self, interval: usize, count: usize) -> usize {
        (interval + 1).saturating_sub(count / 2).min(self.times.len() - count)
    }
}
