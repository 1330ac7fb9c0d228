//! The position of a disturbing body as a table of times and vectors.
//!
//! Between two times the position is the polynomial of degree seven through the eight nearest times. The error bound of a motion contains the interpolation
//! error, which is estimated with the polynomials through eight times that begin one earlier and one later. Where the eighth derivative is constant, they differ
//! from the polynomial by 2 to 2.7 times its error, in the direction of the error. Where the polynomials do not converge, because a pericentre lies between few
//! times, all of them pass it far outside and agree on a torque that is too weak. A table is therefore
//! refused if the departure in the middle of an interval is a tenth of the distance.

use nalgebra::Vector3;

use super::elements::{POSITIVE, check};
use crate::error::Error;
use crate::numerics::scaling::scaled;

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
        check("gm", gm, gm > 0.0 && gm.is_finite(), POSITIVE)?;
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
        Ok(self.through(self.first_node(self.interval(time), NODES), NODES, time))
    }

    /// Position, velocity and acceleration at a time: the derivatives of Neville's scheme.
    pub(crate) fn motion(&self, time: f64) -> Result<[[f64; 3]; 3], Error> {
        self.position(time)?;
        let start = self.first_node(self.interval(time), NODES);
        let mut table = [[[0.0; 3]; 3]; NODES];
        for (row, position) in table.iter_mut().zip(&self.positions[start..]) {
            row[0] = *position;
        }
        for level in 1..NODES {
            for i in 0..NODES - level {
                let (left, right) = (self.times[start + i] - time, self.times[start + i + level] - time);
                let (one, other) = (table[i], table[i + 1]);
                for axis in 0..3 {
                    let [p, v, a] = [0, 1, 2].map(|order| right * one[order][axis] - left * other[order][axis]);
                    let [slope, bend] = [0, 1].map(|order| other[order][axis] - one[order][axis]);
                    for (order, value) in [p, v + slope, a + 2.0 * bend].into_iter().enumerate() {
                        table[i][order][axis] = value / (right - left);
                    }
                }
            }
        }
        Ok(table[0])
    }

    /// The polynomial through `count` positions, at most eight, by Neville's scheme.
    fn through(&self, start: usize, count: usize, time: f64) -> [f64; 3] {
        let mut table = [[0.0; 3]; NODES];
        table[..count].copy_from_slice(&self.positions[start..start + count]);
        for level in 1..count {
            for i in 0..count - level {
                let (left, right) = (self.times[start + i] - time, self.times[start + i + level] - time);
                let next = table[i + 1];
                for (value, next) in table[i].iter_mut().zip(next) {
                    *value = (right * *value - left * next) / (right - left);
                }
            }
        }
        table[0]
    }

    /// A neighbour of the polynomial of an interval: the index of its first time, one earlier or later, and the number of its times. At an end of the table both
    /// neighbours are the same. A table of eight times has neighbours through seven.
    pub(crate) fn neighbour(&self, interval: usize, earlier: bool) -> (usize, usize) {
        let (own, count) = (self.first_node(interval, NODES), NODES.min(self.times.len() - 1));
        let [before, after] = [own.saturating_sub(1), (own + 1).min(self.times.len() - count)];
        let (asked, other) = if earlier { (before, after) } else { (after, before) };
        (if (asked, count) == (own, NODES) { other } else { asked }, count)
    }

    /// The interval between two times in which a neighbouring polynomial departs most from its own, and that departure in the middle over the least distance of the
    /// path, taken as two chords.
    pub(crate) fn coarsest(&self, start: f64, stop: f64) -> (usize, f64) {
        let departure = |interval: usize| {
            let middle = 0.5 * self.times[interval] + 0.5 * self.times[interval + 1];
            // Squares of lengths are doubles in this unit.
            let unit = Vector3::from(self.positions[interval]).amax();
            let at = |(start, count)| Vector3::from(self.through(start, count, middle)) / unit;
            let own = at((self.first_node(interval, NODES), NODES));
            let [one, other] = [true, false].map(|earlier| (at(self.neighbour(interval, earlier)) - own).norm());
            let nearest = |end: usize| distance_of_chord(own, Vector3::from(self.positions[end]) / unit);
            one.max(other) / nearest(interval).min(nearest(interval + 1))
        };
        let last = self.times.partition_point(|knot| *knot < stop).clamp(1, self.times.len() - 1) - 1;
        let intervals = self.interval(start)..=last.max(self.interval(start));
        let intervals = intervals.map(|interval| (interval, departure(interval)));
        intervals.max_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or((0, 0.0))
    }

    /// Checks that three times G m/r³ in a unit of time of 2^−exponent is a normal double at each position.
    pub(crate) fn representable(&self, exponent: i32) -> Result<(), Error> {
        let attraction = |[x, y, z]: &[f64; 3]| {
            let distance = x.hypot(*y).hypot(*z);
            let root = scaled((self.gm / distance).sqrt() / distance, -exponent);
            3.0 * (root * root)
        };
        let holds = self.positions.iter().all(|position| attraction(position).is_normal());
        check(
            "gm",
            self.gm,
            holds,
            "such that its quotient by the cube of each distance, in units of the rotation rate, is a normal double",
        )
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

/// The least distance of a chord from the origin.
fn distance_of_chord(start: Vector3<f64>, stop: Vector3<f64>) -> f64 {
    let chord = stop - start;
    let part = (-start.dot(&chord) / chord.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (start + part * chord).norm()
}
