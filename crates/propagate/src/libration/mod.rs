//! Rotation locked to an orbit: the normal form about a spin–orbit resonance (docs/theory-locked.md).
//!
//! `shape` has the equations, `lock` finds the resonance of a scene and its variables, `energy` is the Hamiltonian, `form` normalizes it about the periodic motion, `convergence`
//! estimates the error of an order, `course` makes the Fourier series of one motion, `residual` inserts it into the equations of motion, `solution` climbs the orders until the estimate meets the tolerance, `relaxed` finds the state of given librations, `evaluate` evaluates with `waves`, `terms` is what a user reads.

mod convergence;
mod course;
mod energy;
pub(crate) mod evaluate;
mod form;
pub(crate) mod lock;
pub(crate) mod relaxed;
mod residual;
mod shape;
pub(crate) mod solution;
pub(crate) mod terms;
mod waves;
