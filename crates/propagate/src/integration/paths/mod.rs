//! The series of where a body is, on a conic or by a table, of a dipole's field, and of a law of the distance, about a time.

mod conic;
mod field;
pub(super) mod interpolation;
pub(super) mod law_series;
pub(super) mod path_series;
