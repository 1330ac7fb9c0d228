//! Rotation under the gravity gradient of a body on an orbit (theory §9): torque, mean motion, averaged motion, short-period corrections, resonances, evaluation.
//!
//! Imports errors, numerics, simd, input and torque_free.

mod averaged;
mod candidate;
mod corrections;
pub(crate) mod disturbed;
mod evaluate;
mod generator;
mod inertia;
pub(crate) mod osculating;
mod powers;
mod resonance;
mod torque;
