//! First order in the torque: the generating function W, the short-period corrections, and the mean motion from which they lead to a state.

pub(crate) mod corrections;
mod epoch_solution;
pub(crate) mod fourier;
pub(crate) mod generator;
pub(crate) mod mean_motion;
pub(crate) mod mean_variables;
pub(crate) mod sums;
