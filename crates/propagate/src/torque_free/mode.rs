//! The modes of free rotation (theory §5).

use std::str::FromStr;

use andoyer_double::DoubleDouble;

use super::error_budget::COSINE_ROUNDING;
use super::polhode::{Polhode, SMALLEST_TILT};
use crate::error::Error;
use crate::input::names::names;

/// The mode of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Mode {
    /// Triaxial body that rotates about its axis of greatest inertia with a wobble.
    ShortAxis,
    /// Triaxial body that rotates about its axis of least inertia with a wobble.
    LongAxis,
    /// Triaxial body on the separatrix between the two; it turns over once (theory §5).
    Separatrix,
    /// A = B or B = C: regular precession.
    Axisymmetric,
    /// A = B = C.
    Spherical,
    /// Rotation exactly about a principal axis.
    PrincipalAxis,
    /// Zero angular velocity.
    AtRest,
}

names!(
    Mode: ShortAxis = "short-axis", LongAxis = "long-axis", Separatrix = "separatrix", Axisymmetric = "axisymmetric",
    Spherical = "spherical", PrincipalAxis = "principal-axis", AtRest = "at-rest"
);

impl FromStr for Mode {
    type Err = Error;

    /// Reads "short-axis" or "long-axis", the two modes that have periods.
    fn from_str(text: &str) -> Result<Self, Error> {
        let with_periods = |mode: &Self| matches!(mode, Self::ShortAxis | Self::LongAxis);
        Self::of_name(text).filter(with_periods).ok_or_else(|| Error::ModeName { value: text.to_owned() })
    }
}

impl Mode {
    /// The mode of a rotating body.
    pub(crate) fn of(polhode: &Polhode) -> Self {
        let [g1, g2, g3] = polhode.invariants.direction.map(|g| g.abs() < SMALLEST_TILT);
        let [first, second] = polhode.invariants.excesses;
        if first == DoubleDouble::ZERO {
            return Self::Spherical;
        }
        // If B = C, every axis perpendicular to axis 1 has the greatest inertia. If A = B, every axis perpendicular to axis 3 has the least inertia. Rotation
        // exactly about the axis of B is steady too.
        if g1 && (g2 || g3 || second == DoubleDouble::ZERO) || g3 && polhode.invariants.difference == DoubleDouble::ZERO
        {
            return Self::PrincipalAxis;
        }
        if polhode.invariants.difference == DoubleDouble::ZERO {
            return Self::Axisymmetric;
        }
        let lost = polhode.invariants.cancellation * COSINE_ROUNDING;
        if lost >= 1.0 || lost.is_nan() {
            return Self::Separatrix;
        }
        if polhode.long_axis { Self::LongAxis } else { Self::ShortAxis }
    }
}
