//! The place of an error: the member of an ensemble, or the index in an array of which a part was computed.

use super::Error;

impl Error {
    /// The error of one member of an ensemble.
    #[must_use]
    pub fn of_member(index: usize, problem: Self) -> Self {
        Self::Member { index, others: 0, problem: Box::new(problem) }
    }

    /// The same error for times that begin at the index `start` of an array.
    #[must_use]
    pub fn later(self, start: usize) -> Self {
        match self {
            Self::Time { index, value, epoch, span, bound, reason } => {
                Self::Time { index: start + index, value, epoch, span, bound, reason }
            }
            other => other,
        }
    }
}
