//! The constants that make the motion go through the state that is given.

use num_complex::Complex;

/// Constants of second order.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Offset {
    /// Of p, times e^(−iℓ′).
    pub(super) p: Complex<f64>,
    /// Of M.
    pub(super) momentum: f64,
}
