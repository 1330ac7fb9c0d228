//! Solutions of averaged equations on arcs of time, which are solved when a time first needs them, and are kept.

use super::polynomial::{COLUMNS, Column, PiecePolynomial};
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::{Lanes, WIDEST};
use nalgebra::UnitQuaternion;
use pulp::NullaryFnOnce;
use std::sync::{Arc, OnceLock};

/// Averaged equations that are solved arc by arc.
pub(crate) trait Averaged {
    /// The arc that begins with a column at a distance from the epoch, after it (`sign` 1) or before it (−1).
    fn arc(&self, sign: f64, from: f64, start: &Column) -> SolvedArc;
}

/// One arc: the distances of its ends from the epoch, and the solution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolvedArc {
    pub(crate) from: f64,
    pub(crate) length: f64,
    pub(crate) solution: PiecePolynomial,
}

impl SolvedArc {
    fn end(&self) -> f64 {
        self.from + self.length
    }
}

/// The arcs of one solution. Times are those from the epoch.
#[derive(Clone, Debug)]
pub(crate) struct Arcs<E> {
    pub(crate) equations: E,
    start: Column,
    /// The solved arcs after the epoch, and before it.
    kept: Arc<[Chain<SolvedArc>; 2]>,
}

impl<E: Averaged> Arcs<E> {
    /// From the frame at the epoch, where the two numbers are 0.
    pub(crate) fn new(equations: E, frame: &UnitQuaternion<f64>) -> Self {
        Self { equations, start: [frame.i, frame.j, frame.k, frame.w, 0.0, 0.0], kept: Arc::default() }
    }

    /// The memory of the solved arcs, in bytes.
    pub(crate) fn memory(&self) -> usize {
        self.kept.iter().map(Chain::memory).sum()
    }

    /// The frame and the other columns at times after the epoch. The function is compiled separately: one fixed orbit does without it.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(&self, times: Lanes<S>) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        times.simd().vectorize(ArcsAt { arcs: self, times })
    }

    /// The frame and the other columns. Consecutive times in the same arc are evaluated together.
    #[inline(always)]
    fn evaluated<S: InstructionSet>(&self, times: Lanes<S>) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        let all = times.values();
        let mut rows = [[0.0; WIDEST]; COLUMNS];
        let mut lane = 0;
        while lane < all.len() {
            let side = usize::from(all[lane] < 0.0);
            let arc = self.arc(side, all[lane].abs());
            let inside =
                |time: &f64| usize::from(*time < 0.0) == side && time.abs() >= arc.from && time.abs() <= arc.end();
            let next = lane + 1 + all[lane + 1..].iter().take_while(|time| inside(time)).count();
            let place = (times.magnitude() - times.all(arc.from)) * times.all(2.0 / arc.length) - times.all(1.0);
            let columns = arc.solution.sums(place);
            if next - lane == all.len() {
                let [x, y, z, w, anomaly, longitude] = columns;
                return (QuaternionLanes([x, y, z, w]), [anomaly, longitude]);
            }
            for (row, column) in rows.iter_mut().zip(&columns) {
                row[lane..next].copy_from_slice(&column.values()[lane..next]);
            }
            lane = next;
        }
        let mut columns = [times; COLUMNS];
        for (column, row) in columns.iter_mut().zip(&rows) {
            *column = times.like(row);
        }
        let [x, y, z, w, anomaly, longitude] = columns;
        (QuaternionLanes([x, y, z, w]), [anomaly, longitude])
    }

    /// The arc that contains a time at this distance from the epoch. If it is not known yet, it is solved together with all arcs between.
    fn arc(&self, side: usize, distance: f64) -> &SolvedArc {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let next = |_, last: Option<&SolvedArc>| {
            let (from, start) = last.map_or((0.0, self.start), |arc| (arc.end(), arc.solution.at(1.0)));
            self.equations.arc(sign, from, &start)
        };
        let found = || {
            let number = self.kept[side].partition_point(|arc| arc.end() < distance);
            self.kept[side].get(number).unwrap_or_else(|| self.kept[side].get_or_compute(number, next))
        };
        let mut arc = found();
        while arc.end() < distance {
            arc = found();
        }
        arc
    }
}

/// [`Arcs::evaluated`] as a task that is compiled separately.
struct ArcsAt<'a, S: InstructionSet, E> {
    arcs: &'a Arcs<E>,
    times: Lanes<S>,
}

impl<S: InstructionSet, E: Averaged> NullaryFnOnce for ArcsAt<'_, S, E> {
    type Output = (QuaternionLanes<S>, [Lanes<S>; 2]);

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.arcs.evaluated(self.times)
    }
}

/// Blocks of 1, 2, 4, … values.
const BLOCKS: usize = 20;
/// Number of values that a chain can hold.
pub(crate) const MOST: usize = (1 << BLOCKS) - 1;

/// A value that is computed once. The block holds a pointer to it, because many values of a block are never needed.
type Cell<T> = OnceLock<Box<T>>;

/// The values from the number 0 on.
#[derive(Debug)]
pub(crate) struct Chain<T> {
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
    pub(crate) fn get(&self, number: usize) -> Option<&T> {
        let (block, place) = position(number);
        Some(self.blocks.get(block)?.get()?.get(place)?.get()?)
    }

    /// The number of the first value that is unknown or for which `before` is false. `before` is true for all values up to some number.
    fn partition_point(&self, before: impl Fn(&T) -> bool) -> usize {
        let is_before = |number: usize| self.get(number).is_some_and(&before);
        // The block by its first value, then the place in it.
        let block = (0..BLOCKS).take_while(|block| is_before((1 << block) - 1)).count();
        let [mut low, mut high] = [block.saturating_sub(1), block].map(|block| (1_usize << block) - 1);
        while low < high {
            let middle = low.midpoint(high);
            (low, high) = if is_before(middle) { (middle + 1, high) } else { (low, middle) };
        }
        low
    }

    /// The value, computed by `next` together with all unknown ones before it. `next` has a number and the value before it, if there is one. The number is below
    /// [`MOST`].
    #[cold]
    pub(crate) fn get_or_compute(&self, number: usize, next: impl Fn(usize, Option<&T>) -> T) -> &T {
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
    pub(crate) fn memory(&self) -> usize {
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
