//! Coefficients that are periodic functions: a `row` is held at the times of a `grid`, and `raw` has the sums of products of its values.

pub(crate) mod grid;
mod raw;
pub(crate) mod row;

pub use raw::RawPeriodic;
