//! Numbers without vectors: phases in double-double, scaling by powers of two, the theta quantities of a polhode.
//!
//! Imports the errors and nothing else of the crate.

pub(crate) mod phase;
pub(crate) mod scaling;
pub(crate) mod theta;
