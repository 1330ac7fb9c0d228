//! The threads that share large work: rayon's, and in a forked process its own.
//!
//! The child of a `fork` has the memory of its parent, but of the threads only the one that forked. Work for the pool of the parent would wait there for ever.
//! Each pool is therefore kept with the number of the process that started it. The first process that computes uses rayon's global pool. A process that was
//! forked from it starts a pool of its own when it first needs one, and keeps it. Work that is called by a thread of a pool stays in that pool.

use std::cell::Cell;
use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// A process in which large work was shared. A forked process has the entries of its ancestors before its own.
struct Process {
    number: u32,
    /// None for rayon's global pool.
    pool: Option<ThreadPool>,
    forked: OnceLock<Box<Process>>,
}

static FIRST: OnceLock<Box<Process>> = OnceLock::new();

thread_local! {
    /// Whether the work of this thread is not shared.
    static ALONE: Cell<bool> = const { Cell::new(false) };
}

/// Calls `work` with the number of threads that may share it: at most `most`, and at most those of the pool. Where it is more than one, the operations of
/// rayon in `work` use the pool. Where it is one, `work` must not use them.
///
/// ```
/// use andoyer_series::threads::{alone, shared};
/// assert_eq!(shared(1, |threads| threads), 1);
/// assert_eq!(alone(|| shared(8, |threads| threads)), 1);
/// ```
pub fn shared<R: Send>(most: usize, work: impl FnOnce(usize) -> R + Send) -> R {
    if most <= 1 || ALONE.get() {
        return work(1);
    }
    let here = || most.min(rayon::current_num_threads());
    if rayon::current_thread_index().is_some() {
        return work(here());
    }
    match process().map(|process| &process.pool) {
        Some(None) => work(here()),
        Some(Some(pool)) if pool.current_num_threads() > 1 => pool.install(|| work(here())),
        _ => work(1),
    }
}

/// Calls `work` with this thread only: no work in it is shared, and no pool is started.
pub fn alone<R>(work: impl FnOnce() -> R) -> R {
    struct Before(bool);
    impl Drop for Before {
        fn drop(&mut self) {
            ALONE.set(self.0);
        }
    }
    let _before = Before(ALONE.replace(true));
    work()
}

/// The entry of this process; None if the system gives it no threads for a pool.
fn process() -> Option<&'static Process> {
    // Only Unix forks, and other systems may have no numbers.
    let number = if cfg!(unix) { std::process::id() } else { 0 };
    let (mut place, mut is_forked) = (&FIRST, false);
    loop {
        match place.get() {
            Some(known) if known.number == number => return Some(known),
            Some(ancestor) => (place, is_forked) = (&ancestor.forked, true),
            None => {
                let pool = if is_forked { Some(ThreadPoolBuilder::new().build().ok()?) } else { None };
                // If another thread was faster, its entry is found in the next turn, and this pool ends.
                let _ = place.set(Box::new(Process { number, pool, forked: OnceLock::new() }));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_is_alone_stays_so_and_the_thread_is_free_after_it() {
        let threads = || shared(2, |threads| threads);
        let before = threads();
        assert_eq!(alone(|| (threads(), alone(threads), threads())), (1, 1, 1));
        let panicked = std::panic::catch_unwind(|| alone(|| panic!("in the work")));
        assert!(panicked.is_err() && threads() == before);
    }

    #[test]
    fn work_in_a_pool_stays_in_it() {
        let pool = ThreadPoolBuilder::new().num_threads(3).build().expect("threads");
        assert_eq!(pool.install(|| shared(8, |threads| (threads, rayon::current_num_threads()))), (3, 3));
    }
}
