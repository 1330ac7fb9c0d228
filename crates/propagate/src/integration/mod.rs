//! Numerical integration of the full equations: Euler's, the quaternion's, and the torques of any number of bodies, by Taylor series of high order.
//!
//! A step expands the motion about its start ([`expansion`]) and is as long as the last two coefficients allow (Jorba and Zou, Exp. Math. 14 (2005) 99, eqs. 3-7 and 3-8). The steps are
//! kept ([`integrator`]), and a time is evaluated by the series of the step that contains it ([`dense`]). A second integration from a displaced state measures the error ([`bound`]).
//! Measured on one core of a Zen 5, per step with one body: 3.3 µs at order 16 and 4.9 at order 20; heyoka 7 takes 3.8 at order 15 and 7.1 to 7.8 at orders 19 and 20, with the same number
//! of steps, after a compilation of 0.5 s (`make rivals-integration`).
//!
//! Imports errors, numerics, simd and input.

mod bound;
pub(crate) mod dense;
mod disturber;
mod expansion;
pub(crate) mod integrated;
pub(crate) mod integrator;
mod interpolation;
mod series;

#[cfg(test)]
mod tests;
