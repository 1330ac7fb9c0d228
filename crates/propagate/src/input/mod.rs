//! The user's input: body and catalogue, state, torques, options, scene. All values are validated here, those of an orbit in [`crate::orbit`].

pub(crate) mod body;
mod catalogue;
pub(crate) mod distance_law;
pub(crate) mod energy_loss;
mod field_torque;
pub(crate) mod gravity;
mod gravity_torque;
pub(crate) mod names;
pub(crate) mod options;
pub(crate) mod principal_axes;
pub(crate) mod scene;
pub(crate) mod state;
pub(crate) mod torque;
mod torque_parameters;
pub(crate) mod torque_source;
