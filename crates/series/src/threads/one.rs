//! One thread, in a build without rayon.

pub(super) fn shared<R>(_most: usize, work: impl FnOnce(usize) -> R) -> R {
    work(1)
}

pub(super) fn map<T, R>(items: Vec<T>, function: impl Fn(T) -> R) -> Vec<R> {
    items.into_iter().map(function).collect()
}

pub(super) fn sort<T: Ord>(items: &mut [T]) {
    items.sort_unstable();
}

/// Calls one after the other.
pub fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}
