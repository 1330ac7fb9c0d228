//! Scalar numerics: phases in double-double, scaling by powers of two, the theta quantities of a polhode.
//!
//! Imports errors only.

pub(crate) mod phase;
pub(crate) mod scaling;
pub(crate) mod theta;
