//! Threads to work on.

use andoyer_series::threads::{alone, on_own};

use super::members::Ensemble;
use crate::error::Error;

/// The largest number of threads that can be asked for.
#[cfg_attr(docsrs, doc(cfg(feature = "rayon")))]
pub const MAX_THREADS: usize = 1024;

impl Ensemble {
    /// The number of threads, instead of one for each core.
    #[cfg_attr(docsrs, doc(cfg(feature = "rayon")))]
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.options.threads = Some(threads);
        self
    }

    pub(super) fn validate_threads(&self) -> Result<(), Error> {
        match self.options.threads {
            None | Some(1..=MAX_THREADS) => Ok(()),
            Some(value) => Err(Error::Threads { value, problem: format!("it must be from 1 to {MAX_THREADS}") }),
        }
    }

    /// Calls `work` on as many threads of its own as were asked for, or on those of the process.
    ///
    /// # Errors
    /// - [`Error::Threads`] for a number that the system does not give.
    pub(super) fn on_threads<R: Send>(&self, work: impl FnOnce() -> R + Send) -> Result<R, Error> {
        self.validate_threads()?;
        match self.options.threads {
            None => Ok(work()),
            Some(1) => Ok(alone(work)),
            Some(value) => on_own(value, work).map_err(|problem| Error::Threads { value, problem }),
        }
    }
}
