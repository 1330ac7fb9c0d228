//! The orbit of a disturbing body: its elements or a table of positions, its position at a time, and the functions of the orbit that the torque needs, as series.
//!
//! - As the user states it: `elements.rs` (with `from_state.rs` and `oblate.rs`), `table.rs`; `disturbing_body.rs` is an enum of the two.
//! - The position at a time: of an ellipse in lanes in `position.rs`, with Kepler's equation in `kepler.rs`; of any orbit at one time in `from_state.rs`, with
//!   `conic.rs` and `hyperbola.rs`; of a table in `table.rs`. The integration has series in time of its own (`integration/paths`).
//! - (a/r)³ r̂r̂ as a function of time: its turns in `tensor.rs`, time derivatives in `derivatives.rs`, harmonics of the mean anomaly in `hansen.rs`, sizes within a span in `span.rs`.

pub(crate) mod conic;
pub(crate) mod derivatives;
pub(crate) mod disturbing_body;
pub(crate) mod elements;
pub(crate) mod field;
mod from_state;
pub(crate) mod hansen;
pub(crate) mod hyperbola;
pub(crate) mod kepler;
pub(crate) mod oblate;
pub(crate) mod position;
pub(crate) mod span;
pub(crate) mod table;
pub(crate) mod tensor;
