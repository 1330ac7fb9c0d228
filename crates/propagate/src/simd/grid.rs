//! Uniform times: sines and cosines by one product with a table instead of two phases and two polynomials.
//!
//! With times t_b + jh in a block of 64, e^(iφ(t_b + jh)) = e^(iφ(t_b)) e^(i2πf·jh): the second factor is the same for all blocks. The first is computed for
//! each block, so that no error accumulates. Times are seldom uniform to the last bit (`linspace` and `arange` round each), so the product is corrected by 1 +
//! i2πfδ for the deviation δ = t − t_b − jh. A block is evaluated by the table if δ is exact (the block is short beside t_b, by Sterbenz' lemma, or t_b = 0)
//! and if 2πf|δ| ≤ 2e-8: the neglected square is then 2e-16 rad. Rounding adds 5e-16 rad to the error of the direct path in [`super::run`], which evaluates all
//! other blocks.

use pulp::Arch;

use super::circles::{Circle, Instants};
use super::instruction_set::{self, InstructionSet, Task};
use super::lanes::Lanes;
use super::phase::elapsed;
use crate::numerics::phase::Phase;

/// Times in a block. 32 and 128 take the same time within 2 %.
pub(super) const BLOCK: usize = 64;
/// Times in a group: the first factors of its blocks are computed together.
pub(crate) const GROUP: usize = 16 * BLOCK;
/// With fewer times a table costs more than it saves.
const FEWEST: usize = 8 * BLOCK;
/// Largest 2πf|δ| \[rad\]; its square is neglected.
const LARGEST_DEVIATION: f64 = 2e-8;

/// Sine and cosine of the two phases.
type Seed = [[f64; 2]; 2];

/// The table of a step.
#[derive(Debug)]
pub(crate) struct Grid {
    step: f64,
    /// j·step.
    offsets: [f64; BLOCK],
    /// Largest |δ|.
    tolerance: f64,
    phases: [Phase; 2],
    /// 2πf of the two phases [rad per unit of time].
    rates: [f64; 2],
    /// Sines and cosines of the two phases after the offsets.
    table: [[[f64; BLOCK]; 2]; 2],
}

impl Grid {
    /// The grid of these times, or `None` if they are too few or do not seem uniform.
    pub(crate) fn new(arch: Arch, phases: [&Phase; 2], times: &[f64]) -> Option<Self> {
        let (&[first, ..], &[.., last]) = (times, times) else { return None };
        if times.len() < FEWEST {
            return None;
        }
        let step = (last - first) / (times.len() - 1) as f64;
        let rates = phases.map(|phase| std::f64::consts::TAU * phase.frequency());
        let fastest = rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        let mut grid = Self {
            step,
            offsets: std::array::from_fn(|j| j as f64 * step),
            tolerance: LARGEST_DEVIATION / fastest,
            phases: phases.map(|phase| *phase),
            rates,
            table: [[[0.0; BLOCK]; 2]; 2],
        };
        // Only one block in the middle is tested. A wrong guess costs time, not accuracy.
        let middle = times.len() / 2 / BLOCK * BLOCK;
        if !(step.is_finite() && grid.holds(pulp::Scalar, &times[middle..middle + BLOCK])) {
            return None;
        }
        grid.table =
            instruction_set::dispatch(arch, Fill { phases: phases.map(Phase::unstarted), offsets: &grid.offsets });
        Some(grid)
    }

    /// Whether a block of times is complete and uniform.
    #[inline(always)]
    pub(super) fn holds<S: InstructionSet>(&self, simd: S, times: &[f64]) -> bool {
        let base = times[0];
        let exact = base == 0.0 || base.abs() >= 2.0 * BLOCK as f64 * self.step.abs();
        if times.len() < BLOCK || !exact {
            return false;
        }
        let first = Lanes::splat(simd, base);
        let mut most = Lanes::splat(simd, 0.0);
        for place in (0..BLOCK).step_by(Lanes::<S>::WIDTH) {
            let offset = Lanes::load(simd, &self.offsets[place..]);
            most = most.largest((Lanes::load(simd, &times[place..]) - first) - offset);
        }
        most.values().iter().all(|deviation| *deviation <= self.tolerance)
    }

    /// The first factors of the blocks in a group.
    #[inline(always)]
    pub(super) fn seeds<S: InstructionSet>(&self, simd: S, times: &[f64], epoch: f64) -> [Seed; GROUP / BLOCK] {
        let mut bases = [0.0; GROUP / BLOCK];
        for (base, block) in bases.iter_mut().zip(times.chunks(BLOCK)) {
            *base = block[0];
        }
        let mut seeds = [[[0.0; 2]; 2]; GROUP / BLOCK];
        for place in (0..bases.len()).step_by(Lanes::<S>::WIDTH) {
            let elapsed = elapsed(Lanes::load(simd, &bases[place..]), Lanes::splat(simd, epoch));
            for (index, phase) in self.phases.iter().enumerate() {
                let (sine, cosine) = phase.sin_cos(elapsed);
                for (lane, (sine, cosine)) in sine.values().iter().zip(cosine.values()).enumerate() {
                    seeds[place + lane][index] = [*sine, *cosine];
                }
            }
        }
        seeds
    }

    /// The factors of a block that [`Grid::holds`] accepts.
    #[inline(always)]
    pub(super) fn tabled<S: InstructionSet>(&self, simd: S, base: f64, seed: &Seed) -> Tabled<'_, S> {
        Tabled {
            grid: self,
            base: Lanes::splat(simd, base),
            seeds: [Lanes::splats(simd, seed[0]), Lanes::splats(simd, seed[1])],
        }
    }
}

/// Fills a table.
struct Fill<'a> {
    phases: [Phase; 2],
    offsets: &'a [f64; BLOCK],
}

impl Task for Fill<'_> {
    type Output = [[[f64; BLOCK]; 2]; 2];

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let mut table = [[[0.0; BLOCK]; 2]; 2];
        for (circles, phase) in table.iter_mut().zip(self.phases) {
            let width = Lanes::<S>::WIDTH;
            for place in (0..BLOCK).step_by(width) {
                let offset = Lanes::load(simd, &self.offsets[place..]);
                let (sine, cosine) = phase.sin_cos((offset, Lanes::splat(simd, 0.0)));
                circles[0][place..place + width].copy_from_slice(sine.values());
                circles[1][place..place + width].copy_from_slice(cosine.values());
            }
        }
        table
    }
}

/// A block of a grid.
#[derive(Clone, Copy)]
pub(super) struct Tabled<'a, S: InstructionSet> {
    grid: &'a Grid,
    base: Lanes<S>,
    seeds: [[Lanes<S>; 2]; 2],
}

/// Some times of a block.
#[derive(Clone, Copy)]
pub(super) struct TabledCircles<'a, S: InstructionSet> {
    block: Tabled<'a, S>,
    place: usize,
    deviation: Lanes<S>,
    elapsed: (Lanes<S>, Lanes<S>),
}

impl<'a, S: InstructionSet> Tabled<'a, S> {
    #[inline(always)]
    pub(super) fn at(&self, place: usize, times: Lanes<S>, elapsed: (Lanes<S>, Lanes<S>)) -> TabledCircles<'a, S> {
        let offset = times.like(&self.grid.offsets[place..]);
        TabledCircles { block: *self, place, deviation: (times - self.base) - offset, elapsed }
    }
}

impl<S: InstructionSet> Instants<S> for TabledCircles<'_, S> {
    #[inline(always)]
    fn elapsed(self) -> (Lanes<S>, Lanes<S>) {
        self.elapsed
    }

    #[inline(always)]
    fn circle(self, number: usize, _: &Phase) -> Circle<S> {
        let [sines, cosines] = &self.block.grid.table[number];
        let (sine, cosine) = (self.deviation.like(&sines[self.place..]), self.deviation.like(&cosines[self.place..]));
        let [first_sine, first_cosine] = self.block.seeds[number];
        let turn = self.deviation * self.deviation.all(self.block.grid.rates[number]);
        let product_sine = first_sine.mul_add(cosine, first_cosine * sine);
        let product_cosine = first_sine.negate_mul_add(sine, first_cosine * cosine);
        (product_cosine.mul_add(turn, product_sine), product_sine.negate_mul_add(turn, product_cosine))
    }
}
