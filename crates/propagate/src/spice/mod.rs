//! Motions and samples as SPICE kernels: C-kernels, binary PCK; tables of orbits from ephemerides.
//!
//! The files are written by `andoyer_kernels`, without CSPICE and without any global state. The error that a kernel states is that of SPICE's interpolation plus that of the
//! times: a double past J2000 has a rounding error of 6e-8 s in 2026, and the attitude turns meanwhile.

mod ck;
mod ephemeris;
mod nodes;
mod options;
mod pck;
mod samples;

pub use andoyer_kernels::{Ephemeris, Kernel, Orientations, ReadError, Refused, frames};
pub use ephemeris::{EphemerisError, OrbitRequest};
pub use options::{KernelOptions, Progress, Ticks, WriteError, Written};
pub use samples::{AttitudeTable, write_samples};
