//! The modes about a periodic motion.

use num_complex::Complex;

use super::row::Periodic;
use crate::birkhoff::matrix::Matrix;

/// A kind of mode about the periodic motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exponent {
    /// ω: a centre turns by ω per unit of time.
    Centre(f64),
    /// λ > 0: a saddle grows by e^{λt}.
    Saddle(f64),
}

impl Exponent {
    /// The eigenvalues of u and of U.
    pub(super) fn eigenvalues(self) -> [Complex<f64>; 2] {
        match self {
            Self::Centre(omega) => [Complex::new(0.0, -omega), Complex::new(0.0, omega)],
            Self::Saddle(lambda) => [lambda.into(), (-lambda).into()],
        }
    }

    /// ω, or iλ for a saddle.
    #[must_use]
    pub fn frequency(self) -> Complex<f64> {
        match self {
            Self::Centre(omega) => omega.into(),
            Self::Saddle(lambda) => Complex::new(0.0, lambda),
        }
    }
}

/// A frame: P and the exponents.
pub(super) type Frame = (Matrix<Periodic>, Vec<Exponent>);
