//! The languages of the emitted code.

use crate::input::names::named;

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

named!(CodeLanguage: C = "c", Rust = "rust", Python = "python", JavaScript = "javascript");
