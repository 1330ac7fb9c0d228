//! A sequence of values. Each is computed from the one before when it is first needed, and is kept. A known value is read without a lock.

use std::sync::OnceLock;

/// Blocks of 1, 2, 4, … values.
const BLOCKS: usize = 20;
/// Number of values that a chain can hold.
pub(super) const MOST: usize = (1 << BLOCKS) - 1;

/// A value that is computed once. A block has many that are never needed, so that the values are not in the block.
type Cell<T> = OnceLock<Box<T>>;

/// The values from the number 0 on.
#[derive(Debug)]
pub(super) struct Chain<T> {
    blocks: [OnceLock<Box<[Cell<T>]>>; BLOCKS],
}

impl<T> Default for Chain<T> {
    fn default() -> Self {
        Self { blocks: [const { OnceLock::new() }; BLOCKS] }
    }
}

/// The block of a number, and the place in it.
#[inline(always)]
fn position(number: usize) -> (usize, usize) {
    let block = (number + 1).ilog2();
    (block as usize, number + 1 - (1 << block))
}

impl<T> Chain<T> {
    /// The value, if it is known.
    #[inline(always)]
    pub(super) fn get(&self, number: usize) -> Option<&T> {
        let (block, place) = position(number);
        Some(self.blocks.get(block)?.get()?.get(place)?.get()?)
    }

    /// The value, computed by `next` together with all unknown ones before it. `next` has a number and the value before it, if there is one. The number is below
    /// [`MOST`].
    #[cold]
    pub(super) fn get_or_compute(&self, number: usize, next: impl Fn(usize, Option<&T>) -> T) -> &T {
        let known = (0..number).rev().find_map(|number| Some((number, self.get(number)?)));
        let (mut from, mut last) = known.map_or((0, None), |(known, value)| (known + 1, Some(value)));
        loop {
            let value: &T = self.cell(from).get_or_init(|| Box::new(next(from, last)));
            if from == number {
                return value;
            }
            (from, last) = (from + 1, Some(value));
        }
    }

    /// The memory of the values that are known, in bytes. Values are computed in order, so that a block is filled before the next is made.
    pub(super) fn memory(&self) -> usize {
        let made = self.blocks.iter().enumerate().filter(|(_, block)| block.get().is_some());
        made.map(|(block, _)| (size_of::<Cell<T>>() + size_of::<T>()) << block).sum()
    }

    fn cell(&self, number: usize) -> &Cell<T> {
        let (block, place) = position(number);
        &self.blocks[block].get_or_init(|| (0..1_usize << block).map(|_| OnceLock::new()).collect())[place]
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn each_value_is_computed_once_from_the_one_before() {
        let (chain, computed) = (Chain::default(), AtomicUsize::new(0));
        let next = |number: usize, last: Option<&usize>| {
            computed.fetch_add(1, Ordering::Relaxed);
            assert_eq!(last.copied(), number.checked_sub(1).map(|before| before * before));
            number * number
        };
        assert_eq!(chain.get(0), None);
        std::thread::scope(|scope| {
            for first in 0..4 {
                let (chain, next) = (&chain, &next);
                scope.spawn(move || {
                    for number in (first..1000).step_by(3).chain([999, 0]) {
                        assert_eq!(*chain.get_or_compute(number, next), number * number);
                    }
                });
            }
        });
        assert_eq!(computed.into_inner(), 1000);
        assert!((0..1000).all(|number| chain.get(number) == Some(&(number * number))));
        assert_eq!((chain.get(1000), chain.get(MOST - 1), chain.get(usize::MAX - 1)), (None, None, None));
    }

    #[test]
    fn a_panic_leaves_the_values_before_it() {
        let chain = Chain::default();
        let panicked = std::thread::scope(|scope| {
            let value =
                || *chain.get_or_compute(9, |number, _| if number < 5 { number } else { panic!("at {number}") });
            scope.spawn(value).join().is_err()
        });
        assert!(panicked && chain.get(4) == Some(&4) && chain.get(5).is_none());
        assert_eq!(
            chain.get_or_compute(9, |number, last| number + last.copied().unwrap_or_default()),
            &(4 + 5 + 6 + 7 + 8 + 9)
        );
    }
}
