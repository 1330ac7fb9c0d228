//! The refusal of a torque, or of a part of one.

use super::Error;

/// [`Error::Torque`] with its argument, the value as given and what it must be.
pub(crate) fn torque_refused(argument: &'static str, value: impl ToString, bound: &str) -> Error {
    Error::Torque { argument, value: value.to_string(), bound: bound.to_owned() }
}
