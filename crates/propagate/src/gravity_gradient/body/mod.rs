//! The body: its inertia tensor in the invariable frame as Fourier series, and the attitude by the Cayley–Klein parameters.

pub(crate) mod cayley_klein;
pub(crate) mod inertia;
