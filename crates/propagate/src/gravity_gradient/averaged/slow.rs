//! The averaged motion, by one of three averages.

use super::bodies::Bodies;
use super::precession::Precession;
use super::spin::Spin;
use crate::gravity_gradient::orbit::elliptic_motion::{Elapsed, When};
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// The averaged motion.
#[derive(Clone, Debug)]
pub(crate) enum Slow {
    /// Averaged over the rotation only.
    Spin(Box<Spin>),
    /// Averaged over the rotation and the orbit.
    Orbit(Box<Precession>),
    /// Averaged over the rotation only, for several bodies or for orbits that precess.
    Bodies(Box<Bodies>),
}

impl Slow {
    /// The invariable frame at times after the epoch, and two numbers: the phase integral Ψ twice, or in second order the drifts of ℓ′ and y′. `when` is the
    /// position of the first body.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(
        &self,
        when: &When<S>,
        elapsed: Elapsed<S>,
    ) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        match self {
            Self::Spin(spin) => spin.at(when),
            Self::Orbit(precession) => precession.at(&when.place, elapsed),
            Self::Bodies(bodies) => bodies.at(elapsed.0),
        }
    }
}
