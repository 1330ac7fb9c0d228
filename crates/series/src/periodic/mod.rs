//! Normal forms of Hamiltonians with driven phases, about their periodic motion.
//!
//! `row` is a coefficient that is a periodic function, held at the times of a `grid`. `motion` finds the periodic motion, `frame` Floquet's frame about it, from a `start` by the
//! matrix of `monodromy`, with the frequencies of a `branch`; `work` is counted.
//! `search` begins at the equilibrium, at an `orbit` from a known state or at a neighbouring rate. `form` expands the Hamiltonian there and normalizes it with the `divisors`; `images` are the old variables in the new ones. `state` transforms states,
//! `fourier` gives the motion at fixed actions, `transport` expresses functions. `named` has the names of variables and phases, and text, `json` has JSON, `code` the source text.
//! `hamiltonian` has what a form needs of a Hamiltonian, [`DrivenHamiltonian`], and one that is a polynomial.

mod branch;
#[cfg(feature = "code")]
mod code;
mod divisors;
mod form;
mod fourier;
mod frame;
mod grid;
mod hamiltonian;
mod images;
#[cfg(feature = "serde")]
mod json;
mod monodromy;
mod motion;
mod named;
mod orbit;
mod raw;
mod row;
mod search;
mod start;
mod state;
mod transport;
mod work;

pub use divisors::Divisor;
pub use form::DrivenForm;
pub use fourier::Harmonic;
pub use grid::Grid;
pub use hamiltonian::{DrivenHamiltonian, SampledHamiltonian, terms_at};
pub use motion::{Begin, PeriodicMotion};
pub use named::{DrivenNormalForm, MAX_DRIVEN_ORDER};
pub use raw::RawPeriodic;
pub use row::Periodic;
pub use search::DrivenOptions;
pub use state::FormAtPhases;
pub use work::{Going, MOST_WORK};
