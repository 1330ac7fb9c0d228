//! Normal forms of Hamiltonians with driven phases, about their periodic motion.
//!
//! `rows` has coefficients that are periodic functions, and `motion` finds the periodic motion with Floquet's frame about it. `form` expands the Hamiltonian there and normalizes it with
//! the `divisors`; `images` are the old variables in the new ones. `state` transforms states, `fourier` gives the motion at fixed actions, `transport` expresses functions.
//! `named` has the names of variables and phases, and text, `json` has JSON, `code` the source text.
//! `hamiltonian` has what a form needs of a Hamiltonian, [`DrivenHamiltonian`], and one that is a polynomial.

#[cfg(feature = "code")]
mod code;
mod divisors;
mod form;
mod fourier;
mod hamiltonian;
mod images;
#[cfg(feature = "serde")]
mod json;
mod motion;
mod named;
mod rows;
mod state;
mod transport;

pub use divisors::Divisor;
pub use form::DrivenForm;
pub use fourier::Harmonic;
pub use hamiltonian::{DrivenHamiltonian, SampledHamiltonian, terms_at};
pub use motion::search::DrivenOptions;
pub use motion::solution::{Begin, PeriodicMotion};
pub use motion::work::{Going, MOST_WORK};
pub use named::{DrivenNormalForm, MAX_DRIVEN_ORDER};
pub use rows::RawPeriodic;
pub use rows::grid::Grid;
pub use rows::row::Periodic;
pub use state::FormAtPhases;
