//! The constants that make the motion pass through the given state.

use num_complex::Complex;

/// Constants of second order.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Offset {
    /// Added to p, times e^(−iℓ′).
    pub(super) p: Complex<f64>,
    /// Added to M.
    pub(super) momentum: f64,
}
