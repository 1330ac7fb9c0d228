//! A diagonalized quadratic part: its modes, and the linear symplectic change that gives them.

use super::matrix::Matrix;
use super::mode::Mode;

/// The modes, and the symplectic matrix M that gives the old variables from the new ones: z = M z′.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Diagonal<R> {
    pub(crate) modes: Vec<Mode<R>>,
    pub(crate) matrix: Matrix<R>,
}
