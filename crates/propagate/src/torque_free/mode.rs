//! The modes of free rotation (theory §5).

use std::fmt;
use std::str::FromStr;

use andoyer_double::DoubleDouble;

use super::error_budget::COSINE_ROUNDING;
use super::polhode::{Polhode, SMALLEST_TILT};
use crate::error::Error;

/// The kind of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub enum Mode {
    /// Triaxial body near rotation about its axis of greatest inertia.
    ShortAxis,
    /// Triaxial body about its axis of least inertia.
    LongAxis,
    /// Triaxial body between the two, turning over once (theory §5).
    Separatrix,
    /// A = B or B = C: regular precession.
    Axisymmetric,
    /// A = B = C.
    Spherical,
    /// Rotation about a principal axis itself.
    PrincipalAxis,
    /// Zero angular velocity.
    AtRest,
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ShortAxis => "short-axis",
            Self::LongAxis => "long-axis",
            Self::Separatrix => "separatrix",
            Self::Axisymmetric => "axisymmetric",
            Self::Spherical => "spherical",
            Self::PrincipalAxis => "principal-axis",
            Self::AtRest => "at-rest",
        })
    }
}

impl FromStr for Mode {
    type Err = Error;

    /// One of the two modes that have periods.
    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "short-axis" => Ok(Self::ShortAxis),
            "long-axis" => Ok(Self::LongAxis),
            _ => Err(Error::ModeName { value: text.to_owned() }),
        }
    }
}

impl Mode {
    /// The mode of a body that turns.
    pub(crate) fn of(polhode: &Polhode) -> Self {
        let [g1, g2, g3] = polhode.direction.map(|g| g.abs() < SMALLEST_TILT);
        let [first, second] = polhode.excesses;
        if first == DoubleDouble::ZERO {
            return Self::Spherical;
        }
        // With B = C every axis across axis 1 is one of greatest inertia, with A = B every axis across axis 3 one of least; in the middle between A and C
        // rotation is steady too, as long as it is exact.
        if g1 && (g2 || g3 || second == DoubleDouble::ZERO) || g3 && polhode.difference == DoubleDouble::ZERO {
            return Self::PrincipalAxis;
        }
        if polhode.difference == DoubleDouble::ZERO {
            return Self::Axisymmetric;
        }
        let lost = polhode.cancellation() * COSINE_ROUNDING;
        if lost >= 1.0 || lost.is_nan() {
            return Self::Separatrix;
        }
        if polhode.long_axis { Self::LongAxis } else { Self::ShortAxis }
    }
}
