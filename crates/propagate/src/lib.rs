//! Rotation of a free rigid body from perturbation series: a plan built once for a trajectory, attitude and rates at any epoch.
//!
//! A [`Scene`] (a [`Body`], its [`State`], a tolerance) is solved into a [`Motion`], which is immutable and shared between threads.
//! Units: none is built in; time, moments and angular velocity in any consistent set, angles in radians. An attitude is the rotation of body
//! components into inertial ones. The theory is M. Lara, "Short-axis-mode rotation in complex variables" (2017).
//!
#![doc = include_str!("../doc/formulas.html")]

mod andoyer;
mod batch;
mod body;
mod bound;
mod catalogue;
mod closed;
mod elliptic;
mod energy;
mod ensemble;
mod error;
mod fourier;
mod gradient;
mod kernel;
mod motion;
mod orbit;
mod order;
mod partials;
mod phase;
mod plan;
mod polhode;
mod scene;
mod scene_file;
mod secular;
mod separatrix;
mod series;
mod solution;
mod state;
mod steady;

pub use batch::Batch;
pub use body::Body;
pub use ensemble::{Ensemble, MAX_THREADS};
pub use error::Error;
pub use gradient::{Averaging, Level};
pub use motion::{Frequencies, Motion, Periods, Sample};
pub use orbit::Orbit;
pub use partials::{Derivatives, PARAMETERS, Partials};
pub use plan::{MAX_ORDER, Mode, Plan};
pub use scene::{Method, Scene};
pub use state::State;

/// The types of attitudes and vectors.
pub use nalgebra;
