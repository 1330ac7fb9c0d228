//! Refusals of values in the tables of a scene, with their keys.

use crate::error::{Error, Value as Fact};

/// A value that a scene cannot have, with its key.
pub(super) struct Refusal {
    pub(super) key: String,
    pub(super) problem: String,
    pub(super) value: Option<Fact>,
    pub(super) bound: Option<Fact>,
}

impl Refusal {
    /// A problem of the file itself. The value is that of the key.
    pub(super) fn new(key: &str, problem: &str, bound: &str) -> Self {
        Self { key: key.to_owned(), problem: problem.to_owned(), value: None, bound: Some(bound.into()) }
    }

    /// The same under a key of another table.
    pub(super) fn under(self, table: &str) -> Self {
        Self { key: format!("{table}.{}", self.key), ..self }
    }

    pub(super) fn missing(key: &str) -> Self {
        Self::new(key, "is missing, and a scene must have it", "present")
    }

    /// A value that a constructor refuses, under its key in the file.
    pub(super) fn of(error: &Error) -> Self {
        let key = match error {
            Error::Orbit { argument, .. }
            | Error::Table { argument, .. }
            | Error::Length { argument, .. }
            | Error::TooFew { argument, .. } => &format!("orbit.{argument}"),
            Error::OrbitalFrame { argument: "orbit", .. } => "orbit",
            Error::OrbitalFrame { argument, .. } => &format!("state.{argument}"),
            Error::Torque { .. } | Error::Series(_) => "torque",
            Error::Averaging { .. } => "averaging",
            Error::Level { .. } => "level",
            Error::Moment { .. } | Error::MomentsTriangle { .. } | Error::MomentsRatio { .. } => "body.moments",
            Error::InertiaSymmetry { .. } | Error::InertiaMoments { .. } => "body.inertia",
            Error::Positive { argument, .. } | Error::Direction { argument, .. } => &format!("periods.{argument}"),
            Error::PeriodRatio { .. } => "periods.rotation",
            Error::Latitude { .. } => "periods.momentum_direction",
            Error::ModeName { .. } | Error::NoSuchMode { .. } => "periods.mode",
            Error::UnknownBody { .. } => "body.named",
            Error::Attitude { .. } => "state.attitude",
            Error::AngularVelocity { .. } => "state.angular_velocity",
            Error::Epoch { .. } => "epoch",
            Error::Tolerance { .. } => "tolerance",
            Error::Span { .. } => "span",
            Error::Order { .. } => "order",
            _ => "scene",
        };
        Self { key: key.to_owned(), problem: error.to_string(), value: error.value(), bound: error.bound() }
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Self::of(&error)
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.key, self.problem)
    }
}
