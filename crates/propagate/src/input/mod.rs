//! The user's input: body and catalogue, state, orbit, options, scene. All values are validated here.
//!
//! Imports errors, numerics and simd. (An orbit computes its true anomaly with simd.)

pub(crate) mod body;
mod catalogue;
pub(crate) mod disturbing_body;
pub(crate) mod options;
pub(crate) mod orbit;
mod orbit_state;
mod principal_axes;
pub(crate) mod scene;
pub(crate) mod state;
pub(crate) mod tabulated;
