//! The orbit of a disturbing body: its place at a time, the part within the span, time derivatives and Hansen coefficients.

pub(crate) mod derivatives;
pub(crate) mod elliptic_motion;
pub(crate) mod elliptic_orbit;
pub(crate) mod hansen;
pub(crate) mod span;
