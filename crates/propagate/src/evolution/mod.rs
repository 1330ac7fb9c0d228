//! Weak torques on a body that rotates freely, averaged over its rotation: evolution over 10³ to 10⁹ rotations (docs/theory-averaged.md).
//!
//! [`facets`], [`sphere`] and [`obj`] make torques of shapes, [`rows`] and [`equations`] average torques over [`polhode_means`], [`drift`] and [`evolve`] are what users call.

pub(crate) mod averaged_scene;
pub(crate) mod distance_rule;
pub(crate) mod drift;
mod elliptic;
mod equations;
pub(crate) mod evolve;
mod extrapolation;
pub(crate) mod facets;
mod friction;
mod harmonic;
pub(crate) mod obj;
pub(crate) mod path;
pub(crate) mod polhode_means;
pub(crate) mod resonances;
mod rows;
mod short_period;
mod sources;
pub(crate) mod sphere;
mod torus;
pub(crate) mod weakness;
mod window;
