//! The torque of the gravity gradient and its disturbing function (theory §9).
//!
//! A body in the direction r̂ at the distance r exerts on a body with the inertia tensor T, with the attraction φn² = G m/a³,
//!
//! ```text
//! torque = 2Γ (a/r)³ r̂ × T r̂,   D = Γ (a/r)³ (r̂·T r̂ − tr T/3),   Γ = 3φn²/2
//! ⟨D⟩ = ΓΔ (a/r)³ (k_r² − ⅓)     averaged over ℓ′ and y′
//! ```
//!
//! In the frame of the angular momentum, D is Γ times the real part of a sum of T_m c_m for m = 0, 1, 2, with the components T_m of the inertia tensor and the
//! contractions c_m of the tensor Θ = (a/r)³ r̂r̂: c₀ = Θ33 − tr Θ/3, c₁ = Θ13 − iΘ23 and
//! c₂ = Θ11 − Θ22 − 2iΘ12. These are here; Θ is in `orbit/tensor.rs`, the factors T_m of the body in `gravity_gradient/inertia.rs`. The integration multiplies
//! series in time of √(2Γ) (a/r)^(3/2) r̂ (`integration/expansion.rs`).

use crate::numerics::C64;
use crate::orbit::elements::Orbit;
use crate::orbit::tensor::{Deviator, about_first, about_second};
use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// Γ of an attraction G m/a³.
pub(crate) fn strength(attraction: f64) -> f64 {
    1.5 * attraction
}

/// Γ of an orbit in the unit of time in which its mean motion is `mean_motion`: in the user's unit the square of the mean motion may under- or overflow.
pub(crate) fn strength_for(orbit: &Orbit, mean_motion: f64) -> f64 {
    strength(mean_motion * mean_motion * orbit.disturbing_fraction())
}

/// The contraction of Θ for m = 1, −c₁, or m = 2, −i c₂, and its derivatives. With these factors the sums of terms have real coefficients. The derivatives are those when the frame turns about its axes 1 and 2.
pub(crate) type Contracted<S> = [ComplexLanes<S>; 3];

/// The contractions for m = 1 or 2.
#[inline(always)]
pub(crate) fn contractions<S: InstructionSet>(tensor: &Deviator<S>, multiple: usize) -> Contracted<S> {
    [of(tensor, multiple), of(&about_first(tensor), multiple), of(&about_second(tensor), multiple)]
}

#[inline(always)]
fn of<S: InstructionSet>(&[_, across, xy, xz, yz]: &Deviator<S>, multiple: usize) -> ComplexLanes<S> {
    if multiple == 1 { ComplexLanes { re: -xz, im: yz } } else { ComplexLanes { re: -(xy + xy), im: across } }
}

/// (3/2) c₀ and its derivatives when the frame turns about its axes 1 and 2. All are real.
#[inline(always)]
pub(crate) fn axial_contractions<S: InstructionSet>(tensor: &Deviator<S>) -> [Lanes<S>; 3] {
    [tensor[0], about_first(tensor)[0], about_second(tensor)[0]]
}

/// c_m and its derivatives when the frame turns about its axes 1 and 2, at one time.
pub(crate) type Contraction = [C64; 3];

/// c_m, X₁c_m and X₂c_m of a tensor.
pub(crate) fn contraction(tensor: &Deviator<pulp::Scalar>, multiple: i32) -> Contraction {
    if multiple == 0 {
        return axial_contractions(tensor).map(|part| C64::from(part.values()[0] / 1.5));
    }
    let factor = if multiple == 1 { C64::from(-1.0) } else { C64::i() };
    contractions(tensor, multiple as usize).map(|part| factor * C64::new(part.re.values()[0], part.im.values()[0])) // m is 1 or 2
}
