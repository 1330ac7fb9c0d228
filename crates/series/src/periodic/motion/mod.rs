//! The periodic motion of a driven Hamiltonian, and Floquet's frame about it.
//!
//! `search` begins at the equilibrium, at an `orbit` from a known state or at a neighbouring rate, and `solution` finds the motion by Newton's steps. `frame` is Floquet's frame about it, from a
//! `start` by the matrix of `monodromy`, with the frequencies of a `branch`; `work` is counted.

mod branch;
pub(crate) mod frame;
mod monodromy;
mod orbit;
pub(crate) mod search;
pub(crate) mod solution;
pub(crate) mod start;
pub(crate) mod work;
