//! Rotation of a rigid body, free or under the gravity gradient of other bodies: closed form, perturbation series, averaged theory or numerical integration,
//! each with an error bound.
//!
//! A [`Scene`] (a [`Body`], its [`State`], a tolerance) is solved into a [`Motion`], which is immutable and shared between threads.
//! Units: none is built in; time, moments and angular velocity in any consistent set, angles in radians. An attitude is the rotation of body
//! components into inertial ones. The theory is M. Lara, "Short-axis-mode rotation in complex variables" (2017).
//!
//! The features are on by default. `torques` has motions under a torque: the averaged theory, integration, libration, and [`Motion::verify`]; without it a free
//! motion is built alone, and a scene takes no orbit and no torque. `rayon` computes on several threads, `serde` has scenes, plans and what they consist of for
//! serde, `code` writes a motion as source text, `scene-files` has scenes as TOML texts, `spice` kernels.
#![doc = include_str!("../doc/formulas.html")]
// What only motions under a torque, files and source texts use is dead without them.
#![cfg_attr(not(all(feature = "torques", feature = "serde", feature = "code")), allow(dead_code))]
#![cfg_attr(docsrs, feature(doc_cfg))]

// The layers, each of which imports only those above it: tests/layers.py holds them to it. Empty lines keep rustfmt from sorting them.
pub mod error;

mod numerics;

mod simd;

mod orbit;

mod torque;

mod input;

mod torque_free;

mod motion;

pub mod dissipation;

#[cfg(feature = "torques")]
mod gravity_gradient;

#[cfg(feature = "torques")]
mod cassini;

#[cfg(feature = "torques")]
mod integration;

#[cfg(feature = "torques")]
mod libration;

mod solve;

#[cfg(feature = "torques")]
pub mod verification;

#[cfg(feature = "torques")]
mod evolution;

pub mod partials;

#[cfg(feature = "code")]
pub mod motion_code;

#[cfg(feature = "spice")]
pub mod spice;

pub mod orbital;

mod observed;

#[cfg(feature = "torques")]
mod crossing;

#[cfg(feature = "serde")]
mod scene_file;

mod outcome;

pub mod ensemble;

pub use ensemble::Ensemble;
pub use error::Error;
pub use input::body::Body;
pub use input::options::Method;
pub use input::scene::Scene;
pub use input::state::State;
pub use motion::plan::Plan;
pub use motion::solved::{Motion, Sample};
pub use orbit::elements::Orbit;
pub use orbit::table::TabulatedOrbit;
pub use torque_free::mode::Mode;

pub mod options {
    //! How a scene is solved, and what its periods belong to.
    pub use crate::input::options::{Averaging, Convention, Level, MAX_ORDER, Method};
}

pub mod periods {
    //! Mean frequencies and periods of a motion, and periods as observers publish them.
    pub use crate::input::options::Convention;
    pub use crate::motion::solved::{Frequencies, Periods};
    pub use crate::observed::periods::ObservedPeriods;
}

pub mod disturbers {
    //! Bodies whose gravity gradient acts: by elements of an orbit or by a table of positions; Cassini states.
    #[cfg(feature = "torques")]
    pub use crate::cassini::{CassiniState, cassini_states};
    pub use crate::orbit::disturbing_body::DisturbingBody;
    pub use crate::orbit::elements::Orbit;
    pub use crate::orbit::oblate::Oblateness;
    pub use crate::orbit::table::TabulatedOrbit;
}

#[cfg(feature = "torques")]
pub mod libration_terms {
    //! A body locked to an orbit: the state that is asked for, and what is read of its motion.
    pub use crate::libration::solution::Libration;
    pub use crate::libration::terms::{LibrationAngle, LibrationTerm};
    pub use crate::observed::locked::LockedState;
}

pub mod torques {
    //! Torques beside the gravity gradient, under which scenes are integrated.
    #[cfg(feature = "torques")]
    pub use crate::evolution::distance_rule::DistanceRule;
    #[cfg(feature = "torques")]
    pub use crate::evolution::facets::{Facet, Finish, Light};
    #[cfg(feature = "torques")]
    pub use crate::evolution::obj::Mesh;
    #[cfg(feature = "torques")]
    pub use crate::evolution::sphere::SphereRule;
    pub use crate::input::distance_law::DistanceLaw;
    pub use crate::input::energy_loss::{EnergyLoss, LossState};
    pub use crate::input::gravity::Gravity;
    pub use crate::input::torque::{PolynomialTorque, Torque};
    pub use crate::input::torque_source::{SourcePath, TorqueSource};
    pub use crate::orbit::field::DipoleField;
}

#[cfg(feature = "torques")]
pub mod evolutions {
    //! Weak torques averaged over the rotation: mean rates, and the motion over years to millions of years.
    pub use crate::evolution::averaged_scene::Evolved;
    pub use crate::evolution::drift::Drift;
    pub use crate::evolution::evolve::{Evolution, EvolutionPlan, EvolveOptions};
    pub use crate::evolution::path::EvolutionEnd;
    pub use crate::evolution::resonances::PassedResonance;
    pub use crate::evolution::weakness::EndReason;
}

pub mod batch {
    //! A motion at many times at once.
    pub use crate::motion::batch::Batch;
}

/// The types of attitudes and vectors.
pub use nalgebra;
