//! Rotation under the gravity gradient of a body on an orbit (theory §9): torque, mean motion, averaged motion, short-period corrections, resonances,
//! evaluation.
//!
//! Imports errors, numerics, simd, input and torque_free.

mod averaged;
mod averages;
mod candidate;
pub(crate) mod cassini;
pub(crate) mod choice;
mod contraction;
mod corrections;
mod course;
pub(crate) mod disturbed;
mod divisors;
mod draft;
mod envelope;
mod epoch;
mod estimate;
mod evaluate;
mod generator;
mod inertia;
mod mean_motion;
mod offset;
mod orbit_series;
pub(crate) mod osculating;
mod paths;
mod powers;
pub(crate) mod request;
mod regime;
mod response;
mod second_order;
mod torque;
