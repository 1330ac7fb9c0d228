//! How much of the theory of the gravity gradient is used: the paper's, or more (theory §9).

use std::fmt;
use std::str::FromStr;

use super::inertia::Inertia;
use crate::error::Error;

/// Which terms the corrections by the gravity gradient have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Level {
    /// Those of Lara (2017): the potential at J = 0, the disturbing body held fixed in the divisors.
    Paper,
    /// The potential at J = 0, the disturbing body on its way.
    Moving,
    /// To all orders in J.
    #[default]
    Full,
}

impl Level {
    /// f_h of a multiple of y′ and its slope, as far as the level has it; of i t1 for the first multiple.
    pub(crate) fn tensor(self, inertia: &Inertia, multiple: i32, harmonic: i32) -> (f64, f64) {
        match self {
            Self::Full => inertia.tensor[multiple as usize].at(harmonic), // 0 ≤ m ≤ 2
            Self::Paper | Self::Moving if (multiple, harmonic) == (2, 0) => (inertia.untilted[1], 0.0),
            Self::Paper | Self::Moving => (0.0, 0.0),
        }
    }

    /// What the level leaves out of that.
    pub(crate) fn omitted(self, inertia: &Inertia, multiple: i32, harmonic: i32) -> (f64, f64) {
        let (value, slope) = Self::Full.tensor(inertia, multiple, harmonic);
        let (kept, kept_slope) = self.tensor(inertia, multiple, harmonic);
        (value - kept, slope - kept_slope)
    }

    /// T33 averaged over ℓ′ and its slope.
    pub(crate) fn axial(self, inertia: &Inertia) -> (f64, f64) {
        match self {
            Self::Full => inertia.mean_axial(),
            Self::Paper | Self::Moving => (inertia.untilted[0], 0.0),
        }
    }
}

impl FromStr for Level {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "paper" => Ok(Self::Paper),
            "moving" => Ok(Self::Moving),
            "full" => Ok(Self::Full),
            _ => Err(Error::Level { value: text.to_owned() }),
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Paper => "paper",
            Self::Moving => "moving",
            Self::Full => "full",
        })
    }
}
