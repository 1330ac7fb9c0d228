//! Numerical integration of the full equations: Euler's, the quaternion's, and the torques of any number of bodies, by Taylor series of high order.
//!
//! A step expands the motion about its start ([`expansion`], [`products`]) and is as long as the last two coefficients allow (Jorba and Zou, Exp. Math. 14 (2005) 99, eqs.
//! 3-7 and 3-8). The steps are kept ([`integrator`]), and a time is evaluated by the series of the step that contains it ([`dense`]). Integrations from
//! displaced states measure the error ([`bound`]), also before the end, so that a motion of which nothing is known any more ends ([`judged`]). docs/speed.md has its time beside that of heyoka, which
//! has no bound (`make rivals-integration`).
//!
//! A member of an ensemble is integrated as its scene; an ensemble keeps only the start of each step.

mod bound;
pub(crate) mod columns;
pub(crate) mod dense;
mod expansion;
mod growth;
pub(crate) mod integrated;
pub(crate) mod integrator;
mod judged;
mod linear;
mod paths;
mod problem;
mod products;
pub(crate) mod prospect;
pub(crate) mod rates;
mod series;
mod step_errors;
mod torques;
pub(crate) mod variation;

#[cfg(test)]
mod tests;
