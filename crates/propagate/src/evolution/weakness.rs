//! Whether averages hold: torques weak against the rotation and the wobble, and orbits slow against both (weak torques §6).

use super::equations::{AveragedTorques, Scratch};
use crate::error::Error;

/// The largest ratio: at 0.1 first-order terms change the state by a tenth.
pub(super) const LIMIT: f64 = 0.1;
/// The largest ratio of the rate of a source's direction to the rates of the rotation: resonances with the orbit are not in the averages.
const SLOWEST: f64 = 0.25;

/// A wobble is slow by itself if the ratios differ by more than this factor, twice the ratio of the rates.
const SLOW_WOBBLE: f64 = 20.0;

/// Why an evolution ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EndReason {
    /// The end of the span.
    Span,
    /// The separatrix between the modes: the mode after it depends on lost phases.
    Separatrix,
    /// A rotation, or a wobble, that is no longer fast against the torque or the motion of a source.
    SlowRotation,
    /// A wobble that is no longer fast against the torque.
    NearSphere,
}

impl std::fmt::Display for EndReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Span => "span",
            Self::Separatrix => "separatrix",
            Self::SlowRotation => "slow rotation",
            Self::NearSphere => "near sphere",
        })
    }
}

/// Ratios that are small if averages hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weakness {
    /// Torque over M times the rate of the rotation.
    pub(super) rotation: f64,
    /// Twice the torque over M times the rate of a small wobble.
    pub(super) wobble: f64,
    /// Largest rate of a source's direction over the slower of the two rates.
    orbit: f64,
}

impl Weakness {
    pub(super) fn of(
        equations: &AveragedTorques,
        time: f64,
        momentum: f64,
        scratch: &mut Scratch,
    ) -> Result<Self, Error> {
        let (family, moments) = (equations.family, &equations.moments);
        let (alpha, own) = (family.alpha(moments), moments[family.axis()]);
        // Rates of steady rotation over M: 1/I_p and √(a b)/I_p.
        let [rotation, wobble] = [1.0, (alpha[family.across()] * alpha.y).sqrt()].map(|rate| rate / own);
        let strength = equations.strength(time, momentum, scratch)? / momentum / momentum;
        let fastest = equations.sources.iter().map(|source| source.fastest).fold(0.0, f64::max);
        Ok(Self {
            rotation: strength / rotation,
            wobble: if strength > 0.0 { 2.0 * strength / wobble } else { 0.0 },
            orbit: fastest / momentum / wobble.min(rotation),
        })
    }

    /// The reason for an end, if a ratio is too large.
    pub(super) fn end(self) -> Option<EndReason> {
        if self.rotation > LIMIT || self.orbit > SLOWEST {
            Some(EndReason::SlowRotation)
        } else if self.wobble > LIMIT {
            // A wobble as fast as the rotation is slow only if both are.
            Some(if self.wobble < SLOW_WOBBLE * self.rotation {
                EndReason::SlowRotation
            } else {
                EndReason::NearSphere
            })
        } else {
            None
        }
    }

    /// # Errors
    /// - [`Error::NotAveraged`] if a ratio is too large, or no number.
    pub(super) fn validate(self) -> Result<(), Error> {
        let checks = [
            ("the torque over momentum times the rate of the rotation", self.rotation, LIMIT),
            (
                "twice the torque over momentum times the rate of the wobble (the body is nearly a sphere, or nearly symmetric about the other axis)",
                self.wobble,
                LIMIT,
            ),
            (
                "the largest rate of the direction to a source over the slower rate of the rotation and the wobble",
                self.orbit,
                SLOWEST,
            ),
        ];
        match checks.into_iter().find(|(_, size, bound)| size.is_nan() || size > bound) {
            Some((reason, size, bound)) => Err(Error::NotAveraged { reason, size, bound }),
            None => Ok(()),
        }
    }
}
