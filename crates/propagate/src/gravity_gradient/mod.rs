//! Rotation under the gravity gradient of a body on an orbit (theory §9): torque, mean motion, averaged motion, short-period corrections, resonances,
//! evaluation.
//!
//! Imports errors, numerics, simd, input and torque_free.

mod averaged;
pub(crate) mod body;
pub(crate) mod disturbed;
mod draft;
mod estimate;
mod evaluate;
mod first_order;
mod initial_constants;
pub(crate) mod level;
pub(crate) mod orbit;
pub(crate) mod request;
mod second_order;
mod terms;
#[cfg(test)]
mod tests;
