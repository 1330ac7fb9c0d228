//! Inner dissipation of a freely tumbling body: a homogeneous, slightly inelastic ellipsoid loses energy at constant angular momentum and ends in rotation about
//! its axis of greatest inertia (docs/relaxation.md).
//!
//! The loss is averaged over the polhode. Valid for small deformations (ϱω²R²/S ≪ 1), frequencies far below those of elastic waves, and no torque that changes the
//! angular momentum. Gravity of the body at rest loads no harmonic; that of its deformation is neglected.

mod age;
mod body;
mod elastic;
mod harmonics;
mod leg;
mod material;
mod relaxation;
mod size;

pub use body::{Dissipation, LoadHarmonic};
pub use material::{Loss, LossFunction, Material};
pub use relaxation::{Relaxation, RelaxedState};
pub use size::Size;
