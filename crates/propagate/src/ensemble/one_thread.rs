//! The thread to work on in a build without rayon: the one that calls.

use super::members::Ensemble;
use crate::error::Error;

impl Ensemble {
    pub(super) fn validate_threads(&self) -> Result<(), Error> {
        Ok(())
    }

    pub(super) fn on_threads<R>(&self, work: impl FnOnce() -> R) -> Result<R, Error> {
        Ok(work())
    }
}
