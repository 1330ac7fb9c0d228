//! What the user states: body and catalogue, state, orbit, options, scene. Everything is validated here.
//!
//! Imports errors, numerics and simd (an orbit gives its true anomaly).

pub(crate) mod body;
mod catalogue;
pub(crate) mod disturbing_body;
pub(crate) mod options;
pub(crate) mod orbit;
mod principal_axes;
pub(crate) mod scene;
pub(crate) mod state;
pub(crate) mod tabulated;
