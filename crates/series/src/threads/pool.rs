//! The pools of rayon, one for each process.

use std::sync::OnceLock;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// A process in which large work was shared. A forked process has the entries of its ancestors before its own.
struct Process {
    number: u32,
    /// None for rayon's global pool.
    pool: Option<ThreadPool>,
    forked: OnceLock<Box<Process>>,
}

static FIRST: OnceLock<Box<Process>> = OnceLock::new();

pub(super) fn shared<R: Send>(most: usize, work: impl FnOnce(usize) -> R + Send) -> R {
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

pub(super) fn map<T: Send, R: Send>(items: Vec<T>, function: impl Fn(T) -> R + Send + Sync) -> Vec<R> {
    items.into_par_iter().with_max_len(1).map(function).collect()
}

pub(super) fn sort<T: Ord + Send>(items: &mut [T]) {
    items.par_sort_unstable();
}

/// Calls both, each by a thread of its own if one is free.
pub fn join<A: Send, B: Send>(one: impl FnOnce() -> A + Send, other: impl FnOnce() -> B + Send) -> (A, B) {
    rayon::join(one, other)
}

/// Calls `work` on a pool of its own with so many threads, which ends after it.
///
/// # Errors
/// - What the system says where it does not give the threads.
#[cfg_attr(docsrs, doc(cfg(feature = "rayon")))]
pub fn on_own<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> Result<R, String> {
    match ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => Ok(pool.install(work)),
        Err(problem) => Err(problem.to_string()),
    }
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
