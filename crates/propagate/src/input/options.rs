//! The options of a solution: method, averaging, level of the gravity-gradient theory, largest order.

use super::names::named;

named!(
    Method: Auto = "auto", Series = "series", Closed = "closed",
    #[cfg(feature = "torques")] Integrated = "integrated",
    #[cfg(feature = "torques")] Libration = "libration"
);
named!(Convention: ExtremalAxis = "extremal-axis", LongAxis = "long-axis", ShortAxis = "short-axis");
named!(Level: Auto = "auto", Paper = "paper", Moving = "moving", Full = "full", SecondOrder = "second-order");
named!(Averaging: Auto = "auto", Orbit = "orbit", Spin = "spin");

/// The highest order of the series. It reaches σ/σ_sep = 0.66 for a tolerance of 1e-12.
pub const MAX_ORDER: usize = 60;

/// The formulas that evaluate a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
    #[cfg(feature = "torques")]
    Integrated,
    /// The normal form about a spin–orbit resonance.
    #[cfg(feature = "torques")]
    Libration,
}

impl Method {
    #[cfg(feature = "torques")]
    const INTEGRATED: Option<Self> = Some(Self::Integrated);
    #[cfg(not(feature = "torques"))]
    const INTEGRATED: Option<Self> = None;

    /// Whether the motion is integrated.
    pub(crate) fn is_integrated(self) -> bool {
        Some(self) == Self::INTEGRATED
    }

    /// Whether it is a method of motions under torques.
    pub(crate) fn is_of_torques(self) -> bool {
        !matches!(self, Self::Auto | Self::Series | Self::Closed)
    }
}

/// The axis whose precession and rotation a pair of periods describes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
