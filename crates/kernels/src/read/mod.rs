//! Reader of ephemerides (SPK) and of orientations (binary PCK).
//!
//! A file is opened by its summaries alone. The words of a segment are read when a time needs them, some 4 kB at once, and the last ones are kept. The operations
//! have the order of CSPICE's, so that values agree to the last bits. Source: SPK, PCK and DAF Required Reading (toolkit N67).

mod chebyshev;
mod daf;
mod error;
mod files;
mod pck;
mod segment;
mod spk;
mod states;
mod words;

pub use daf::Source;
pub use error::{Gap, ReadError};
pub use pck::Orientations;
pub use segment::Segment;
pub use spk::Ephemeris;
