//! What becomes of members that cannot be computed.

use crate::input::names::named;

/// What becomes of a member that is no body or no state, or has no motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum OnError {
    /// The first one is the error of all.
    #[default]
    Raise,
    /// Its rows are NaN, and the outcome has its error. If its motion does not serve some of the times, the rows of these alone are NaN.
    Nan,
}

named!(OnError: Raise = "raise", Nan = "nan");
