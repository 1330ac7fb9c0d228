//! Scalar numerics: phases in double-double, scaling by powers of two, the theta quantities of a polhode; and the cache of results (`kept`).

pub(crate) mod kept;
pub(crate) mod phase;
pub(crate) mod scaling;
pub(crate) mod theta;

/// A complex number of doubles.
pub(crate) type C64 = num_complex::Complex<f64>;
