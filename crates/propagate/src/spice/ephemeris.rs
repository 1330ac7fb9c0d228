//! Tables of orbits from SPICE's ephemerides (SPK).

use andoyer_kernels::{Ephemeris, ReadError, frames};
use thiserror::Error as Failure;

use crate::error::Error;
use crate::orbit::table::TabulatedOrbit;

/// The first table has so many intervals.
const FIRST: usize = 8;
/// Most intervals of a table.
const MOST: usize = 1 << 20;
/// Most intervals in which a table is compared with the ephemeris, evenly among all, and the places within them.
const COMPARED: usize = 4096;
const PLACES: [f64; 3] = [0.2, 0.5, 0.8];
/// Errors below this may be rounding.
const ROUNDING: f64 = 1e-13;
/// Between two rows the polynomials have the degree 11.
const ORDER: f64 = 12.0;

/// Which positions a table takes from an ephemeris.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitRequest {
    /// NAIF code of the disturbing body.
    pub target: i32,
    /// NAIF code of the rotating body.
    pub observer: i32,
    /// First and last time [s of TDB past J2000].
    pub span: [f64; 2],
    /// G × the mass of the disturbing body [km³/s²].
    pub gm: f64,
    /// Code of the inertial frame, 1 for J2000.
    pub frame: i32,
    /// Largest error of a position between two rows, over the distance.
    pub error: f64,
    /// The time [s of TDB past J2000] that is time 0 of the table.
    pub epoch: f64,
}

/// Why there is no table.
#[derive(Clone, Debug, Failure, PartialEq)]
#[non_exhaustive]
pub enum EphemerisError {
    /// The ephemeris has no positions.
    #[error("{0}")]
    Read(#[from] ReadError),
    /// The request or the table is not valid.
    #[error("{0}")]
    Table(#[from] Error),
    /// No table of a million rows has the error.
    #[error(
        "error = {error:e}: a table of {rows} rows from this ephemeris has {found:.1e}; ask for that, or for a shorter span"
    )]
    Coarse {
        /// The error that was asked for.
        error: f64,
        /// Rows of the last table.
        rows: usize,
        /// Its error.
        found: f64,
    },
}

impl TabulatedOrbit {
    /// The orbit of a body by rows with velocities from an ephemeris, in km and s, whose step is as long as the error allows.
    ///
    /// # Errors
    /// - [`EphemerisError::Read`] for a body or a time without data, and for files that are damaged.
    /// - [`EphemerisError::Table`] for a span that is empty, reversed or not finite, an error that is not positive, a body at the observer.
    /// - [`EphemerisError::Coarse`] for an error that a million rows do not reach.
    pub fn from_ephemeris(ephemeris: &Ephemeris, request: &OrbitRequest) -> Result<Self, EphemerisError> {
        let [start, stop] = request.span;
        if !(start.is_finite() && stop.is_finite() && start < stop) {
            return Err(Error::Span { start, stop }.into());
        }
        if !(request.error.is_finite() && request.error > 0.0) {
            return Err(Error::Positive { argument: "error", value: request.error }.into());
        }
        for body in [request.target, request.observer] {
            if !ephemeris.coverage(body).is_empty() {
                ephemeris.keep(body, (start, stop))?;
            }
        }
        let mut intervals = FIRST;
        let mut last = f64::INFINITY;
        loop {
            let table = request.table(ephemeris, intervals)?;
            let found = request.largest_error(ephemeris, &table)?;
            if found <= request.error {
                return Ok(table);
            }
            // At the rounding of positions more rows bring nothing.
            if intervals >= MOST || (found < ROUNDING && found > 0.5 * last) {
                return Err(EphemerisError::Coarse { error: request.error, rows: intervals + 1, found });
            }
            let growth = (found / request.error).powf(1.0 / ORDER).clamp(1.1, 2.0);
            last = found;
            intervals = ((intervals as f64 * growth).ceil() as usize).min(MOST);
        }
    }
}

impl OrbitRequest {
    fn table(&self, ephemeris: &Ephemeris, intervals: usize) -> Result<TabulatedOrbit, EphemerisError> {
        let [start, stop] = self.span;
        let step = (stop - start) / intervals as f64;
        let time = |row: usize| if row == intervals { stop } else { start + row as f64 * step };
        let (mut times, mut positions, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
        for row in 0..=intervals {
            let (position, velocity) = self.state(ephemeris, time(row))?;
            times.push(time(row) - self.epoch);
            positions.push(position);
            velocities.push(velocity);
        }
        Ok(TabulatedOrbit::with_velocities(times, positions, velocities, self.gm)?)
    }

    /// The largest error of a position between rows, over the distance.
    fn largest_error(&self, ephemeris: &Ephemeris, table: &TabulatedOrbit) -> Result<f64, EphemerisError> {
        let times = table.times();
        let intervals = times.len() - 1;
        let compared = intervals.min(COMPARED);
        let mut most = 0.0_f64;
        for index in 0..compared {
            let interval = index * intervals / compared;
            let (first, length) = (times[interval], times[interval + 1] - times[interval]);
            for place in PLACES {
                let time = first + place * length;
                let (exact, _) = self.state(ephemeris, time + self.epoch)?;
                let found = table.position(time)?;
                let size = |vector: [f64; 3]| vector[0].hypot(vector[1]).hypot(vector[2]);
                most = most.max(size([0, 1, 2].map(|axis| found[axis] - exact[axis])) / size(exact));
            }
        }
        Ok(most)
    }

    fn state(&self, ephemeris: &Ephemeris, et: f64) -> Result<([f64; 3], [f64; 3]), ReadError> {
        let (position, velocity) = ephemeris.state(self.target, self.observer, et)?;
        let matrix = frames::from_j2000(self.frame);
        let turned = |vector: [f64; 3]| matrix.map(|row| (0..3).map(|axis| row[axis] * vector[axis]).sum());
        Ok((turned(position), turned(velocity)))
    }
}
