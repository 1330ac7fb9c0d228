//! Threads to work on.

use andoyer_series::threads::{alone, shared};
use rayon::ThreadPoolBuilder;

use crate::error::Error;

/// The largest number of threads that can be asked for.
pub const MAX_THREADS: usize = 1024;

/// Calls `work` with the number of threads that share it. If a number was asked for, it has as many threads of its own; one is the thread that calls.
/// Otherwise these are the threads of the process, at most `most` of them.
///
/// # Errors
/// - [`Error::Threads`] for a number that the system does not give.
pub(super) fn on_threads<R: Send>(
    asked: Option<usize>,
    most: usize,
    work: impl FnOnce(usize) -> R + Send,
) -> Result<R, Error> {
    match asked {
        None => Ok(shared(most, work)),
        Some(1) => Ok(alone(|| work(1))),
        Some(threads) => match ThreadPoolBuilder::new().num_threads(threads).build() {
            Ok(pool) => Ok(pool.install(|| work(threads))),
            Err(problem) => Err(Error::Threads { value: threads, problem: problem.to_string() }),
        },
    }
}
