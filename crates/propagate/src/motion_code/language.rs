//! The languages of the emitted code.

use std::str::FromStr;

use crate::error::Error;

/// A language that [`Motion::to_code`](crate::Motion::to_code) writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CodeLanguage {
    /// C99 with `math.h`; without allocation.
    C,
    /// Rust of `core` alone, without allocation.
    Rust,
    /// Python 3.9 or later with its module `math`.
    Python,
    /// JavaScript of 2015 or later, in a browser or in Node.
    JavaScript,
}

impl FromStr for CodeLanguage {
    type Err = Error;

    /// Reads "c", "rust", "python" or "javascript".
    fn from_str(name: &str) -> Result<Self, Error> {
        match name {
            "c" => Ok(Self::C),
            "rust" => Ok(Self::Rust),
            "python" => Ok(Self::Python),
            "javascript" => Ok(Self::JavaScript),
            _ => Err(Error::CodeLanguage { value: name.to_owned() }),
        }
    }
}
