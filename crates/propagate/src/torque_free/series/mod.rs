//! The perturbation series of the paper: tables of the normal form at a body's β, their Fourier coefficients for one motion, and the order that a tolerance
//! needs.

pub(crate) mod composition;
pub(crate) mod order;
pub(crate) mod solution;
pub(crate) mod tables;
