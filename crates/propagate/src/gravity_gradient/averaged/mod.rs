//! The averaged motion of the angular momentum under the gravity gradient (theory §9). The invariable frame moves with the angular momentum and does not turn
//! about it.
//!
//! [`equations`] has the equations; their constants are in [`averages`], with Δ(σ) = (3 T33 − A − B − C)/2 averaged over ℓ′ and y′.
//!
//! [`spin`] solves the equations of one fixed orbit on quarters or eighths of an orbit by Picard's iteration on Chebyshev points. In first order the right-hand side is a
//! trigonometric polynomial of f. The constant rates of second order, divided by ḟ, are not; at e = 0.95 solutions on quarters and on eighths differ by 7e-15 rad after
//! 20 orbits. κ_o(1 + e) is at most
//! 0.3, so the iteration converges to rounding error. The result is a polynomial that can be evaluated at any time of the piece. A piece is solved when a time
//! first needs it, and is kept. [`precession`] is the average over the true anomaly: precession about the orbit's normal, steady in first order, with the periodic
//! part, a trigonometric polynomial of f. [`bodies`] has the sum over several disturbing bodies on orbits that may precess. It is averaged over the rotation
//! only, and solved on arcs of time.

mod arcs;
pub(crate) mod averages;
pub(crate) mod bodies;
pub(crate) mod equations;
mod polynomial;
mod precession;
pub(crate) mod spin;
