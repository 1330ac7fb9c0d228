//! Normal forms of Hamiltonians with driven phases, about their periodic motion.
//!
//! `row` is a coefficient that is a periodic function, held at the times of a `grid`. `motion` finds the periodic motion and Floquet's frame about it, from the matrix of
//! `monodromy`; `form` expands the Hamiltonian there, normalizes it by Deprit's triangle, and evaluates the result; `transport` expresses functions. `polynomial` is a Hamiltonian that is a polynomial;
//! other functions implement [`DrivenHamiltonian`].

mod form;
mod grid;
mod monodromy;
mod motion;
mod polynomial;
mod row;
mod transport;

pub use form::{Divisor, DrivenForm, DrivenOptions, FormAtPhases, Harmonic};
pub use grid::Grid;
pub use motion::{DrivenHamiltonian, Exponent, PeriodicMotion};
pub use polynomial::{SampledHamiltonian, terms_at};
pub use row::{Periodic, RawPeriodic};

#[cfg(test)]
mod tests;
