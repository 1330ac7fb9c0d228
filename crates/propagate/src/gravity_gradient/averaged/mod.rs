//! The averaged motion of the angular momentum under the gravity gradient (theory §9). The invariable frame moves with the angular momentum and does not turn
//! about it.
//!
//! Let k be the unit angular momentum, Δ(σ) = (3 T33 − A − B − C)/2 averaged over ℓ′ and y′, and κ_o = 3φn Δ/(M η³), where φ is the mass fraction. Then
//!
//! ```text
//! dk/df = κ_o (1 + e cos f) (k·r̂) (r̂ × k)        dΨ/df = n η^(−3) (1 + e cos f) (1 − 3 (k·r̂)²)
//! ```
//!
//! where Ψ is the phase integral: to first order the torque adds −φ Δ′(σ) Ψ/(2M) to ℓ′ and σφ Δ′(σ) Ψ/(2M) to y′ ([`crate::gravity_gradient::averaged::averages`]).
//!
//! [`spin`] solves these equations on quarters or eighths of an orbit by Picard's iteration on Chebyshev points. In first order the right-hand side is a
//! trigonometric polynomial of f. The constant rates of second order, divided by ḟ, are not; at e = 0.95 solutions on quarters and on eighths differ by 7e-15 rad after
//! 20 orbits. κ_o(1 + e) is at most
//! 0.3, so the iteration converges to rounding error. The result is a polynomial that can be evaluated at any time of the piece. A piece is solved when a time
//! first needs it, and is kept. [`precession`] is the average over the true anomaly: precession about the orbit's normal, steady in first order, with the periodic
//! part, a trigonometric polynomial of f. [`bodies`] has the sum over several disturbing bodies on orbits that may precess. It is averaged over the rotation
//! only, and solved on arcs of time.

mod arcs;
pub(crate) mod averaged_orbit;
pub(crate) mod averages;
mod bodies;
mod polynomial;
mod precession;
pub(crate) mod spin;
#[cfg(test)]
mod tests;
