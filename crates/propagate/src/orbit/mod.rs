//! The orbit of a disturbing body: its elements or a table of positions, its position at a time, and the series of its functions in the torque.
//!
//! - As the user states it: `elements.rs` (with `from_state.rs`), `table.rs`; `disturbing_body.rs` is one of the two.
//! - The position at a time: `position.rs`, by Kepler's equation in `kepler.rs` (lanes) or `hyperbola.rs`.
//! - (a/r)³ r̂r̂ as a function of time: its turns in `tensor.rs`, time derivatives in `derivatives.rs`, harmonics of the mean anomaly in `hansen.rs`, sizes within a span in `span.rs`.
//!
//! Imports errors, numerics and simd.

pub(crate) mod derivatives;
pub(crate) mod disturbing_body;
pub(crate) mod elements;
mod from_state;
pub(crate) mod hansen;
pub(crate) mod hyperbola;
pub(crate) mod kepler;
pub(crate) mod position;
pub(crate) mod span;
pub(crate) mod table;
pub(crate) mod tensor;
