//! The options of a solution: method, averaging, level of the gravity-gradient theory, largest order.

use serde::{Deserialize, Serialize};

use crate::error::Error;

/// Reads and writes the names that serde gives the variants. The error of another name has the name of the type.
macro_rules! named {
    ($($type:ident),+) => {$(
        impl std::str::FromStr for $type {
            type Err = Error;

            fn from_str(text: &str) -> Result<Self, Error> {
                let name = serde::de::value::StrDeserializer::<serde::de::value::Error>::new(text);
                serde::Deserialize::deserialize(name).map_err(|_| Error::$type { value: text.to_owned() })
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                serde::Serialize::serialize(self, f)
            }
        }
    )+};
}

pub(crate) use named;

named!(Method, Convention, Level, Averaging);

/// The highest order of the series. It reaches σ/σ_sep = 0.66 for a tolerance of 1e-12.
pub const MAX_ORDER: usize = 60;

/// The formulas that evaluate a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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

/// The axis whose precession and rotation a pair of periods describes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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

/// How much of the theory of the gravity gradient is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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

/// The averaging of the equations of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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

/// The part of the span that a motion is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Served {
    /// All of it, or an error.
    WholeSpan,
    /// As much of it as has an error bound below half a turn.
    WhileKnown,
}
