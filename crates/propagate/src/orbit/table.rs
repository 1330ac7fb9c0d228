//! The position of a disturbing body as a table of times and vectors.
//!
//! Between two times the position is a polynomial: of degree seven through the eight nearest positions, or, where the table has velocities, of degree eleven through the six nearest
//! positions and their velocities (Hermite), and through fewer rows in a segment that has no more. Two equal times of a table with velocities are the edge of two segments, and no polynomial passes it. The error bound of a motion contains the
//! interpolation error, which is estimated with the polynomials through rows that begin one earlier and one later. Where the eighth derivative is constant, they differ
//! from the polynomial by 2 to 2.7 times its error (with velocities by 1.0 times, in the mean over an interval), in the direction of the error. Where the polynomials do not converge,
//! because a pericentre lies between few times, all of them pass it far outside and agree on a torque that is too weak. A table is therefore
//! refused if the departure in the middle of an interval is a tenth of the distance.

use std::ops::Range;

use nalgebra::Vector3;

use super::elements::{POSITIVE, check};
use crate::error::Error;
use crate::numerics::scaling::scaled;

/// Positions through which a polynomial passes.
const POSITIONS: usize = 8;
/// Rows of positions and velocities through which a polynomial passes, where a segment has as many.
const ROWS: usize = 6;
/// The least number of rows of a segment.
const LEAST: usize = 2;
/// The intervals in which the units of a table are tried, at most.
const PROBES: usize = 15;
/// r² × acceleration over gm of units that do not fit, from a mass ratio of 0.3 to one of 100: the Moon's position from the Earth with the Moon's gm has 82.
const DOUBTFUL: [[f64; 2]; 2] = [[1e-12, 1e-7], [3e8, 1e11]];
/// Acceleration × step² over the distance of a path that is not straight.
const STRAIGHT: f64 = 1e-10;
/// The most coefficients of a polynomial.
pub(crate) const COEFFICIENTS: usize = 2 * ROWS;

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
    velocities: Option<Vec<[f64; 3]>>,
    /// The first row of each segment.
    segments: Vec<usize>,
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
        Self { times, positions, velocities: None, segments: vec![0], gm }.checked()
    }

    /// A table with a velocity for each time. A segment has at least two times, and six or more for polynomials of the full degree; at the edge of two segments its time stands twice, as at a change of the orbit.
    ///
    /// # Errors
    /// Those of [`TabulatedOrbit::new`], and
    /// - [`Error::Length`] for another number of velocities.
    /// - [`Error::TooFew`] for a segment of fewer than two times.
    pub fn with_velocities(
        times: Vec<f64>,
        positions: Vec<[f64; 3]>,
        velocities: Vec<[f64; 3]>,
        gm: f64,
    ) -> Result<Self, Error> {
        if velocities.len() != times.len() {
            return Err(Error::Length { argument: "velocities", found: velocities.len(), expected: times.len() });
        }
        let edges = (1..times.len()).filter(|&row| times[row] == times[row - 1]);
        let segments = std::iter::once(0).chain(edges).collect();
        Self { times, positions, velocities: Some(velocities), segments, gm }.checked()
    }

    fn checked(self) -> Result<Self, Error> {
        let Self { times, positions, velocities, segments, gm } = &self;
        if positions.len() != times.len() {
            return Err(Error::Length { argument: "positions", found: positions.len(), expected: times.len() });
        }
        let refused = |argument, index, value, bound| Err(Error::Table { argument, index, value, bound });
        for (index, &time) in times.iter().enumerate() {
            if !time.is_finite() {
                return refused("times", index, time, "finite");
            }
            let Some(before) = index.checked_sub(1).map(|before| times[before]) else { continue };
            match velocities {
                None if time <= before => return refused("times", index, time, "greater than the one before it"),
                Some(_) if time < before => {
                    return refused("times", index, time, "greater than the one before it, or equal to it");
                }
                _ => {}
            }
        }
        let ends = segments[1..].iter().copied().chain([times.len()]);
        let least = if velocities.is_some() { LEAST } else { POSITIONS };
        if let Some(found) = segments.iter().zip(ends).map(|(first, end)| end - first).find(|rows| *rows < least) {
            return Err(Error::TooFew { argument: "times", found, least });
        }
        for (argument, vectors) in [("positions", Some(positions)), ("velocities", velocities.as_ref())] {
            for (index, vector) in vectors.into_iter().flatten().enumerate() {
                if let Some(&value) = vector.iter().find(|value| !value.is_finite()) {
                    return refused(argument, index, value, "finite");
                }
            }
        }
        if let Some(index) = positions.iter().position(|position| *position == [0.0; 3]) {
            return refused("positions", index, 0.0, "away from the origin");
        }
        check("gm", *gm, *gm > 0.0 && gm.is_finite(), POSITIVE)?;
        Ok(self)
    }

    /// The times.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The positions, one for each time.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// The velocities, if the table has them, one for each time.
    pub fn velocities(&self) -> Option<&[[f64; 3]]> {
        self.velocities.as_deref()
    }

    /// G × the mass of the disturbing body.
    pub fn gm(&self) -> f64 {
        self.gm
    }

    /// A sentence if the lengths or times of the table seem to have other units than gm: r² × acceleration, which is gm (1 + m/M) for two bodies with masses M and m, is some 1e9 times gm
    /// or 1e-9 of it.
    ///
    /// ```
    /// use andoyer_propagate::TabulatedOrbit;
    /// let times: Vec<f64> = (0..100).map(|k| 100.0 * f64::from(k)).collect();
    /// let place = |time: &f64| [42_164.0 * (7.292e-5 * time).cos(), 42_164.0 * (7.292e-5 * time).sin(), 0.0];
    /// let kilometres: Vec<[f64; 3]> = times.iter().map(place).collect();
    /// assert!(TabulatedOrbit::new(times.clone(), kilometres.clone(), 3.986e5)?.doubtful_units().is_none());
    /// assert!(TabulatedOrbit::new(times, kilometres, 3.986e14)?.doubtful_units().is_some());
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn doubtful_units(&self) -> Option<String> {
        let middle = |row: usize| 0.5 * self.times[row] + 0.5 * self.times[row + 1];
        let last = self.times.len() - 1;
        let mut ratios: Vec<f64> = (0..last)
            .step_by(last.div_ceil(PROBES))
            .filter_map(|row| Some((row, self.motion(middle(row)).ok()?)))
            .filter_map(|(row, [position, _, acceleration])| {
                let (distance, pull) = (Vector3::from(position).norm(), Vector3::from(acceleration).norm());
                let step = self.times[row + 1] - self.times[row];
                // A straight path has the acceleration of its rounding errors.
                (step * pull * step > STRAIGHT * distance).then(|| distance * pull / self.gm * distance)
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        let ratio = ratios.get(ratios.len() / 2).copied()?;
        DOUBTFUL.iter().any(|[least, most]| (least..most).contains(&&ratio)).then(|| {
            format!(
                "r² × acceleration of the table is {ratio:.1e} times gm: do positions, times and gm have the same units? \
                 (kilometres beside metres make a factor of 1e9, days beside seconds one of 7.5e9)"
            )
        })
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
        Ok(self.taylor(&self.around(self.interval(time), None), time).map(|coefficients| coefficients[0]))
    }

    /// Position, velocity and acceleration at a time, of the polynomial.
    pub(crate) fn motion(&self, time: f64) -> Result<[[f64; 3]; 3], Error> {
        self.position(time)?;
        let coefficients = self.taylor(&self.around(self.interval(time), None), time);
        Ok([(0, 1.0), (1, 1.0), (2, 2.0)].map(|(order, factor)| coefficients.map(|of_axis| factor * of_axis[order])))
    }

    /// Taylor's coefficients about a time of the polynomial through rows.
    fn taylor(&self, rows: &Range<usize>, time: f64) -> [[f64; COEFFICIENTS]; 3] {
        taylor(
            rows,
            |row| self.times[row] - time,
            |row| self.positions[row],
            |row| Some(self.velocities.as_ref()?[row]),
        )
    }

    /// The rows of the polynomial of an interval, or of the neighbour that begins one row earlier or later. At an end of a segment both neighbours are the same. A segment with no row
    /// more than the polynomial has neighbours through one row less.
    pub(crate) fn around(&self, interval: usize, earlier: Option<bool>) -> Range<usize> {
        let segment = self.segments.partition_point(|first| *first <= interval);
        let first = self.segments[segment - 1];
        let end = self.segments.get(segment).copied().unwrap_or(self.times.len());
        let most = if self.velocities.is_some() { ROWS } else { POSITIONS };
        let rows = most.min(end - first);
        let own = (interval + 1).saturating_sub(rows / 2).max(first).min(end - rows);
        let Some(earlier) = earlier else { return own..own + rows };
        let count = rows.min(end - first - 1);
        let [before, after] = [own.saturating_sub(1).max(first), (own + 1).min(end - count)];
        let (asked, other) = if earlier { (before, after) } else { (after, before) };
        let start = if (asked, count) == (own, rows) { other } else { asked };
        start..start + count
    }

    /// The interval between two times in which a neighbouring polynomial departs most from its own, and that departure in the middle over the least distance of the
    /// path, taken as two chords.
    pub(crate) fn coarsest(&self, start: f64, stop: f64) -> (usize, f64) {
        let departure = |interval: usize| {
            let middle = 0.5 * self.times[interval] + 0.5 * self.times[interval + 1];
            // Squares of lengths are doubles in this unit.
            let unit = Vector3::from(self.positions[interval]).amax();
            let at = |earlier| {
                Vector3::from(self.taylor(&self.around(interval, earlier), middle).map(|axis| axis[0])) / unit
            };
            let own = at(None);
            let [one, other] = [true, false].map(|earlier| (at(Some(earlier)) - own).norm());
            let nearest = |end: usize| distance_of_chord(own, Vector3::from(self.positions[end]) / unit);
            one.max(other) / nearest(interval).min(nearest(interval + 1))
        };
        let last = self.times.partition_point(|knot| *knot < stop).clamp(1, self.times.len() - 1) - 1;
        let intervals = self.interval(start)..=last.max(self.interval(start));
        let intervals = intervals.filter(|&interval| self.times[interval] < self.times[interval + 1]);
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
}

/// Taylor's coefficients about the present of the polynomial through rows, by Newton's divided differences. A row is at a time from the present; one with a velocity counts twice.
pub(crate) fn taylor(
    rows: &Range<usize>,
    time: impl Fn(usize) -> f64,
    position: impl Fn(usize) -> [f64; 3],
    velocity: impl Fn(usize) -> Option<[f64; 3]>,
) -> [[f64; COEFFICIENTS]; 3] {
    let (mut at, mut values) = ([0.0; COEFFICIENTS], [[0.0; 3]; COEFFICIENTS]);
    let slopes = velocity(rows.start).is_some();
    let (each, nodes) = if slopes { (2, 2 * rows.len()) } else { (1, rows.len()) };
    for i in 0..nodes {
        (at[i], values[i]) = (time(rows.start + i / each), position(rows.start + i / each));
    }
    for level in 1..nodes {
        for i in (level..nodes).rev() {
            if level == 1
                && i % each == 1
                && let Some(slope) = velocity(rows.start + i / each)
            {
                values[i] = slope;
                continue;
            }
            let share = 1.0 / (at[i] - at[i - level]);
            let before = values[i - 1];
            for (value, before) in values[i].iter_mut().zip(before) {
                *value = (*value - before) * share;
            }
        }
    }
    std::array::from_fn(|axis| {
        let mut p = [0.0; COEFFICIENTS];
        for i in (0..nodes).rev() {
            // p ← p · (t − at) + value.
            for k in (1..nodes).rev() {
                p[k] = p[k - 1] - at[i] * p[k];
            }
            p[0] = values[i][axis] - at[i] * p[0];
        }
        p
    })
}

/// The least distance of a chord from the origin.
fn distance_of_chord(start: Vector3<f64>, stop: Vector3<f64>) -> f64 {
    let chord = stop - start;
    let part = (-start.dot(&chord) / chord.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (start + part * chord).norm()
}
