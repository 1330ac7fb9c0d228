//! How a scene is to be solved: method, averaging, level of the gravity-gradient theory, largest order.

use std::fmt;
use std::str::FromStr;

use crate::error::Error;

/// The highest order of the series; it reaches σ/σ_sep = 0.66 for a tolerance of 1e-12.
pub const MAX_ORDER: usize = 60;

/// Which formulas evaluate a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub enum Method {
    /// Whatever meets the tolerance at the lowest cost.
    #[default]
    Auto,
    /// The perturbation series.
    Series,
    /// The closed form: theta functions.
    Closed,
}

impl FromStr for Method {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "auto" => Ok(Self::Auto),
            "series" => Ok(Self::Series),
            "closed" => Ok(Self::Closed),
            _ => Err(Error::Method { value: text.to_owned() }),
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Series => "series",
            Self::Closed => "closed",
        })
    }
}

/// Whose precession and rotation a pair of periods belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Convention {
    /// The axis that the angular momentum circles: the short axis in the short-axis mode, the long axis in the long-axis mode. Light-curve papers use it.
    #[default]
    ExtremalAxis,
    /// The long axis. Radar papers use it.
    LongAxis,
    /// The short axis.
    ShortAxis,
}

impl Convention {
    /// The three, in the order in which an ensemble gives its periods.
    pub const ALL: [Self; 3] = [Self::LongAxis, Self::ShortAxis, Self::ExtremalAxis];
}

impl FromStr for Convention {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "extremal-axis" => Ok(Self::ExtremalAxis),
            "long-axis" => Ok(Self::LongAxis),
            "short-axis" => Ok(Self::ShortAxis),
            _ => Err(Error::Convention { value: text.to_owned() }),
        }
    }
}

impl fmt::Display for Convention {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ExtremalAxis => "extremal-axis",
            Self::LongAxis => "long-axis",
            Self::ShortAxis => "short-axis",
        })
    }
}

/// Which terms the corrections by the gravity gradient have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
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

/// How far the equations are averaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub enum Averaging {
    /// Whatever meets the tolerance at the lowest cost.
    #[default]
    Auto,
    /// Over rotation and orbit: formulas.
    Orbit,
    /// Over the rotation: the averaged equations are solved quarter by quarter of the orbit.
    Spin,
}

impl FromStr for Averaging {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "auto" => Ok(Self::Auto),
            "orbit" => Ok(Self::Orbit),
            "spin" => Ok(Self::Spin),
            _ => Err(Error::Averaging { value: text.to_owned() }),
        }
    }
}

impl fmt::Display for Averaging {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Orbit => "orbit",
            Self::Spin => "spin",
        })
    }
}
