//! Rotation of a free rigid body from perturbation series: a plan built once for a trajectory, attitude and rates at any epoch.
//!
//! A [`Scene`] (a [`Body`], its [`State`], a tolerance) is solved into a [`Motion`], which is immutable and shared between threads.
//! Units: none is built in; time, moments and angular velocity in any consistent set, angles in radians. An attitude is the rotation of body
//! components into inertial ones. The theory is M. Lara, "Short-axis-mode rotation in complex variables" (2017).
//!
#![doc = include_str!("../doc/formulas.html")]

// The layers, each of which imports only those above it: tests/layers.py holds them to it. Empty lines keep rustfmt from sorting them.
pub mod error;

mod numerics;

mod simd;

mod input;

mod torque_free;

mod gravity_gradient;

mod motion;

mod solve;

mod partials;

mod motion_code;

mod observed;

mod scene_file;

mod outcome;

mod ensemble;

pub use ensemble::{Ensemble, MAX_THREADS, OnError, Run};
pub use error::Error;
pub use input::body::Body;
pub use input::options::{Averaging, Convention, Level, MAX_ORDER, Method};
pub use input::orbit::Orbit;
pub use input::scene::Scene;
pub use input::state::State;
pub use motion::batch::Batch;
pub use motion::plan::Plan;
pub use motion::solved::{Frequencies, Motion, Periods, Sample};
pub use motion_code::{CodeLanguage, MotionCode};
pub use observed::periods::ObservedPeriods;
pub use outcome::Outcome;
pub use partials::{Derivatives, PARAMETERS, Partials};
pub use torque_free::mode::Mode;
pub use torque_free::series::tables::SeriesTables;

/// The types of attitudes and vectors.
pub use nalgebra;
