//! The options of a solution: method, averaging, level of the gravity-gradient theory, largest order.

use std::fmt;
use std::str::FromStr;

use crate::error::Error;

/// The highest order of the series. It reaches σ/σ_sep = 0.66 for a tolerance of 1e-12.
pub const MAX_ORDER: usize = 60;

/// The formulas that evaluate a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Method {
    /// The cheapest method that meets the tolerance.
    #[default]
    Auto,
    /// The perturbation series.
    Series,
    /// The closed form with theta functions.
    Closed,
    /// Numerical integration of the full equations over the span.
    Integrated,
    /// The normal form about a spin–orbit resonance.
    Libration,
}

impl FromStr for Method {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "auto" => Ok(Self::Auto),
            "series" => Ok(Self::Series),
            "closed" => Ok(Self::Closed),
            "integrated" => Ok(Self::Integrated),
            "libration" => Ok(Self::Libration),
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
            Self::Integrated => "integrated",
            Self::Libration => "libration",
        })
    }
}

/// The axis whose precession and rotation a pair of periods describes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Convention {
    /// The axis around which the angular momentum circles: the short axis in the short-axis mode, the long axis in the long-axis mode. Light-curve papers use
    /// it.
    #[default]
    ExtremalAxis,
    /// The long axis. Radar papers use it.
    LongAxis,
    /// The short axis.
    ShortAxis,
}

impl Convention {
    /// The three conventions, in the order of the periods of an ensemble.
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

/// How much of the theory of the gravity gradient is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Level {
    /// [`Level::Full`] where it meets the tolerance, else [`Level::SecondOrder`] where its error bound is smaller.
    #[default]
    Auto,
    /// The terms of Lara (2017): the potential at J = 0, and a disturbing body that is fixed in the divisors.
    Paper,
    /// The potential at J = 0, and a disturbing body that moves along its orbit.
    Moving,
    /// First order in the torque, the potential to all orders in J, and a disturbing body that moves along its orbit.
    Full,
    /// To all orders in J, and the averaged motion to second order in the torque.
    SecondOrder,
}

impl FromStr for Level {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "auto" => Ok(Self::Auto),
            "paper" => Ok(Self::Paper),
            "moving" => Ok(Self::Moving),
            "full" => Ok(Self::Full),
            "second-order" => Ok(Self::SecondOrder),
            _ => Err(Error::Level { value: text.to_owned() }),
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Paper => "paper",
            Self::Moving => "moving",
            Self::Full => "full",
            Self::SecondOrder => "second-order",
        })
    }
}

/// The averaging of the equations of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Averaging {
    /// The cheapest averaging that meets the tolerance.
    #[default]
    Auto,
    /// Over the rotation and the orbit: the solution is a formula, in second order on an eccentric orbit a polynomial for each arc of the precession.
    Orbit,
    /// Over the rotation only: the averaged equations are solved for each quarter of the orbit.
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
