//! Rotation under the gravity gradient of bodies on orbits: docs/theory.md §9, and docs/theory-second-order.md with numbered equations.
//!
//! There is no torque in the time domain here. The disturbing function D ([`crate::torque`]) is a sum of terms e^(i(hℓ′ + my′)) times a function of the orbit: its
//! mean over ℓ′ and y′ moves the angular momentum, and the generating function W of the rest gives short-period corrections.
//!
//! - One term: `terms/term.rs`; its factors that belong to the body: `inertia.rs`; to the orbit: [`crate::orbit`], with the contractions in [`crate::torque`].
//! - The averaged equations: `averaged/equations.rs`; they are solved in `averaged/spin.rs` for one fixed orbit, `averaged/bodies.rs` for several,
//!   `averaged/precession.rs` averaged over the orbit. ℓ′ and y′ are in `evaluate.rs`.
//! - The corrections: `first_order/generator.rs` with sums over time derivatives, `first_order/fourier.rs` with exact divisors; `terms/regime.rs` chooses.
//! - Second order: `second_order/k2.rs` for the averaged Hamiltonian, `second_order/pairs.rs` for the mean variables at the epoch.
//! - A request becomes a motion in this order: `request`, `draft` (mean motion and averages), `estimate`, `disturbed` (the level, and the motion), `initial_constants`, `evaluate`.
//!
//! The degree is 2 everywhere: m = 0, 1, 2 with h + m even, three functions 1, cos 2f, sin 2f of the orbit, and (a/r)³. A further term of this form is added in
//! `Term::all`. A third degree would need other contractions, other powers of a/r and a body without planes of symmetry, whose coefficients are not real.
//!
//! Tuned floats stand in `constants.rs` under their kind, with the command that measures it; tuned whole numbers stand in the file that uses them.

mod averaged;
pub(crate) mod constants;
mod disturbance;
pub(crate) mod disturbed;
mod draft;
mod estimate;
mod evaluate;
mod first_order;
mod inertia;
mod initial_constants;
pub(crate) mod request;
mod second_order;
mod terms;
#[cfg(test)]
mod tests;
