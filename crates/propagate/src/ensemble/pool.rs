//! Threads to work on.

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::Error;

/// The largest number of threads that can be asked for.
pub const MAX_THREADS: usize = 1024;

/// Rayon's threads, or those that were asked for.
pub(super) enum Pool {
    Global,
    Own(ThreadPool),
}

impl Pool {
    /// # Errors
    /// - [`Error::Threads`] for a number that the system does not give.
    pub(super) fn new(threads: Option<usize>) -> Result<Self, Error> {
        match threads {
            None => Ok(Self::Global),
            Some(threads) => {
                let pool = ThreadPoolBuilder::new().num_threads(threads).build();
                pool.map(Self::Own).map_err(|problem| Error::Threads { value: threads, problem: problem.to_string() })
            }
        }
    }

    pub(super) fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match self {
            Self::Global => work(),
            Self::Own(pool) => pool.install(work),
        }
    }
}
