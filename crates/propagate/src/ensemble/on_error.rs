//! What becomes of members that cannot be computed.

use std::fmt;
use std::str::FromStr;

use crate::error::Error;

/// What becomes of a member that is no body or no state, or has no motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum OnError {
    /// The first one is the error of all.
    #[default]
    Raise,
    /// Its rows are NaN, and the outcome has its error.
    Nan,
}

impl FromStr for OnError {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "raise" => Ok(Self::Raise),
            "nan" => Ok(Self::Nan),
            _ => Err(Error::OnError { value: text.to_owned() }),
        }
    }
}

impl fmt::Display for OnError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Raise => "raise",
            Self::Nan => "nan",
        })
    }
}
