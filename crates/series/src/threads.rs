//! The threads that share large work: rayon's, and in a forked process its own. Without the feature `rayon` there is one thread, and no work is shared.
//!
//! The child of a `fork` has the memory of its parent, but of the threads only the one that forked. Work for the pool of the parent would wait there for ever.
//! Each pool is therefore kept with the number of the process that started it. The first process that computes uses rayon's global pool. A process that was
//! forked from it starts a pool of its own when it first needs one, and keeps it. Work that is called by a thread of a pool stays in that pool.

#[cfg_attr(not(feature = "rayon"), path = "threads/one.rs")]
#[cfg_attr(feature = "rayon", path = "threads/pool.rs")]
mod pool;

use std::cell::Cell;

pub use pool::join;
#[cfg(feature = "rayon")]
pub use pool::on_own;

thread_local! {
    /// Whether the work of this thread is not shared.
    static ALONE: Cell<bool> = const { Cell::new(false) };
}

/// Calls `work` with the number of threads that may share it: at most `most`, and at most those of the pool. Where it is more than one, [`join`] in `work` uses
/// the pool. Where it is one, `work` must not call it.
///
/// ```
/// use andoyer_series::threads::{alone, shared};
/// assert_eq!(shared(1, |threads| threads), 1);
/// assert_eq!(alone(|| shared(8, |threads| threads)), 1);
/// ```
pub fn shared<R: Send>(most: usize, work: impl FnOnce(usize) -> R + Send) -> R {
    if most <= 1 || ALONE.get() { work(1) } else { pool::shared(most, work) }
}

/// Maps the items, each by one thread, in their order.
///
/// ```
/// use andoyer_series::threads::map;
/// assert_eq!(map(vec![1, 2, 3], |n| n * n), [1, 4, 9]);
/// ```
pub fn map<T: Send, R: Send>(items: Vec<T>, function: impl Fn(T) -> R + Send + Sync) -> Vec<R> {
    shared(items.len(), |threads| match threads {
        1 => items.into_iter().map(function).collect(),
        _ => pool::map(items, function),
    })
}

/// Sorts the items. Equal ones may change places.
pub fn sort<T: Ord + Send>(items: &mut [T]) {
    shared(items.len(), |threads| if threads > 1 { pool::sort(items) } else { items.sort_unstable() });
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

    #[cfg(feature = "rayon")]
    #[test]
    fn work_in_a_pool_stays_in_it() {
        let threads = || shared(8, |threads| (threads, rayon::current_num_threads()));
        assert_eq!(on_own(3, threads), Ok((3, 3)));
    }

    #[test]
    fn mapped_items_keep_their_order() {
        assert!(map((0..1000).collect(), |n| 3 * n).into_iter().eq((0..1000).map(|n| 3 * n)));
        let mut items: Vec<_> = (0..1000).rev().collect();
        sort(&mut items);
        assert!(items.into_iter().eq(0..1000));
    }
}
