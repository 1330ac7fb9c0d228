//! The Euler–Poinsot problem, theory §1 to §8 and §10: polhode, mode, frequencies, harmonics, the closed form, the separatrix, steady rotation and the error
//! budget. [`series`] is the perturbation series of the paper.

pub(crate) mod closed_form;
mod columns;
pub(crate) mod error_budget;
pub(crate) mod frequencies;
pub(crate) mod harmonics;
pub(crate) mod invariants;
pub(crate) mod mode;
pub(crate) mod polhode;
pub(crate) mod quadrature;
pub(crate) mod separatrix;
pub(crate) mod series;
pub(crate) mod solution;
pub(crate) mod steady;
pub(crate) mod sums;
pub(crate) mod wobble;
