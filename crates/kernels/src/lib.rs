//! Writer and reader of SPICE kernels without CSPICE.
//!
//! - [`Daf`] writes the binary files: C-kernels (CK) with segments of type 2 or 3, planetary constants kernels (PCK) with segments of type 2.
//! - [`Kernel`] has the codes and names of a frame, checked against the names and codes that SPICE keeps for itself, and writes the text kernel.
//! - [`clock`] is the clock of all C-kernels of this crate. It is the same for every frame and interval, so kernels do not disturb each other.
//! - [`Ephemeris`] reads positions and velocities from SPK files (types 2, 3, 9, 13), [`Orientations`] reads attitudes from binary PCK files (type 2).
//! - [`whole`] gives a file its name when it is complete.
//!
//! Not supported: other types of segments, reading of C-kernels, writing of big-endian files.
//! Source: NAIF's required readings for DAF, CK, PCK, SPK, SCLK, Frames (toolkit N67).

#![warn(missing_docs)]

pub mod clock;
mod daf;
mod file;
pub mod frames;
mod kernel;
mod read;
mod segments;

pub use daf::Daf;
pub use file::whole;
pub use kernel::{Kernel, Refused};
pub use read::{Ephemeris, Gap, Orientations, ReadError, Segment, Source};
pub use segments::Head;
