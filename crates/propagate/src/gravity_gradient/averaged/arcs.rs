//! Solutions of averaged equations on arcs of time, which are solved when a time first needs them, and are kept.

use std::sync::{Arc, RwLock};

use pulp::NullaryFnOnce;

use super::polynomial::{COLUMNS, Column, Polynomial};
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::{Lanes, WIDEST};

/// Averaged equations that are solved arc by arc.
pub(super) trait Averaged {
    /// The arc that begins with a column at a distance from the epoch, after it (`sign` 1) or before it (−1).
    fn arc(&self, sign: f64, from: f64, start: &Column) -> Stretch;
}

/// One arc: the distances of its ends from the epoch, and the solution.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub(super) from: f64,
    pub(super) length: f64,
    pub(super) solution: Polynomial,
}

impl Stretch {
    fn end(&self) -> f64 {
        self.from + self.length
    }
}

/// The arcs of one solution. Times are those from the epoch.
#[derive(Clone, Debug)]
pub(super) struct Arcs {
    start: Column,
    /// The solved arcs after the epoch, and before it.
    kept: Arc<[RwLock<Vec<Stretch>>; 2]>,
}

impl Arcs {
    pub(super) fn new(start: Column) -> Self {
        Self { start, kept: Arc::default() }
    }

    /// The memory of the solved arcs, in bytes.
    pub(super) fn memory(&self) -> usize {
        let side =
            |arcs: &RwLock<Vec<Stretch>>| arcs.read().unwrap_or_else(|poisoned| poisoned.into_inner()).capacity();
        self.kept.iter().map(side).sum::<usize>() * size_of::<Stretch>()
    }

    /// The frame and the other columns at times after the epoch. The function is compiled separately: one fixed orbit does without it.
    #[inline(always)]
    pub(super) fn at<S: InstructionSet>(
        &self,
        averaged: &impl Averaged,
        times: Lanes<S>,
    ) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        times.simd().vectorize(At { arcs: self, averaged, times })
    }

    /// Consecutive times in the same arc are evaluated together.
    #[inline(always)]
    fn evaluated<S: InstructionSet>(
        &self,
        averaged: &impl Averaged,
        times: Lanes<S>,
    ) -> (QuaternionLanes<S>, [Lanes<S>; 2]) {
        let all = times.values();
        let mut rows = [[0.0; WIDEST]; COLUMNS];
        let mut lane = 0;
        while lane < all.len() {
            let side = usize::from(all[lane] < 0.0);
            let stretch = self.stretch(averaged, side, all[lane].abs());
            let inside = |time: &f64| {
                usize::from(*time < 0.0) == side && time.abs() >= stretch.from && time.abs() <= stretch.end()
            };
            let next = lane + 1 + all[lane + 1..].iter().take_while(|time| inside(time)).count();
            let place =
                (times.magnitude() - times.all(stretch.from)) * times.all(2.0 / stretch.length) - times.all(1.0);
            let columns = stretch.solution.sums(place);
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
    fn stretch(&self, averaged: &impl Averaged, side: usize, distance: f64) -> Stretch {
        let found = |arcs: &[Stretch]| arcs.get(arcs.partition_point(|arc| arc.end() < distance)).copied();
        // If a thread panicked while it held the lock, the arcs are still complete.
        let known = found(&self.kept[side].read().unwrap_or_else(|poisoned| poisoned.into_inner()));
        if let Some(arc) = known {
            return arc;
        }
        let mut arcs = self.kept[side].write().unwrap_or_else(|poisoned| poisoned.into_inner());
        let sign = if side == 0 { 1.0 } else { -1.0 };
        loop {
            if let Some(arc) = found(&arcs) {
                return arc;
            }
            let (from, start) = arcs.last().map_or((0.0, self.start), |arc| (arc.end(), arc.solution.at(1.0)));
            arcs.push(averaged.arc(sign, from, &start));
        }
    }
}

/// [`Arcs::evaluated`] as a task that is compiled separately.
struct At<'a, S: InstructionSet, A> {
    arcs: &'a Arcs,
    averaged: &'a A,
    times: Lanes<S>,
}

impl<S: InstructionSet, A: Averaged> NullaryFnOnce for At<'_, S, A> {
    type Output = (QuaternionLanes<S>, [Lanes<S>; 2]);

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.arcs.evaluated(self.averaged, self.times)
    }
}
