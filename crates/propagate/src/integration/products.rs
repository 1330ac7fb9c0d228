//! The products of the series of attitude and rates (the sums of [`super::expansion`]), and the factors in which a coefficient enters them.

use nalgebra::Matrix3;

use super::series::{StateLanes, add_product, added, subtracted, tiled};
use crate::simd::instruction_set::InstructionSet;

/// One coefficient of each series that is multiplied, in the lanes of the products. A product of two series is the sum of the first factors of one coefficient
/// times the second factors of another.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Factors<const W: usize> {
    /// (x, y, z, w), (y, z, x, w) and w.
    pub(super) attitude: StateLanes<W>,
    pub(super) cyclic: StateLanes<W>,
    pub(super) scalar: StateLanes<W>,
    /// ω1, ω2 and ω3.
    pub(super) rates: [StateLanes<W>; 3],
    /// The next and the next but one of ω1, ω2, ω3.
    pub(super) neighbours: [StateLanes<W>; 2],
    /// (R11, R22, R33), (R21, R32, R13) and (R31, R12, R23).
    pub(super) diagonals: [StateLanes<W>; 3],
}

/// Sums of products of factors.
pub(super) struct ProductSums<const W: usize> {
    /// q ω1, q ω2 and q ω3.
    pub(super) turning: [StateLanes<W>; 3],
    pub(super) gyration: StateLanes<W>,
    /// xx, yy, zz, ww; xy, yz, zx; xw, yw, zw.
    pub(super) squares: StateLanes<W>,
    pub(super) mixed: StateLanes<W>,
    pub(super) axial: StateLanes<W>,
}

impl<const W: usize> ProductSums<W> {
    pub(super) const ZERO: Self =
        Self { turning: [[0.0; W]; 3], gyration: [0.0; W], squares: [0.0; W], mixed: [0.0; W], axial: [0.0; W] };

    #[inline(always)]
    pub(super) fn add<S: InstructionSet>(&mut self, simd: S, one: &Factors<W>, other: &Factors<W>) {
        for axis in 0..3 {
            add_product(simd, &mut self.turning[axis], &one.attitude, &other.rates[axis]);
        }
        add_product(simd, &mut self.gyration, &one.neighbours[0], &other.neighbours[1]);
        add_product(simd, &mut self.squares, &one.attitude, &other.attitude);
        add_product(simd, &mut self.mixed, &one.attitude, &other.cyclic);
        add_product(simd, &mut self.axial, &one.attitude, &other.scalar);
    }

    /// The cyclic diagonals of the matrix.
    #[inline(always)]
    pub(super) fn diagonals<S: InstructionSet>(&self, simd: S) -> [StateLanes<W>; 3] {
        // Twice the products off the diagonal: zw, xw, yw.
        let axial = simd.in_order::<LAST, W>(&self.axial);
        let (mixed, axial) = (added(simd, &self.mixed, &self.mixed), added(simd, &axial, &axial));
        let above = subtracted(simd, &mixed, &axial);
        let others = added(simd, &simd.in_order::<NEXT, W>(&self.squares), &simd.in_order::<LAST, W>(&self.squares));
        let own = added(simd, &simd.in_order::<FOURTH, W>(&self.squares), &self.squares);
        [subtracted(simd, &own, &others), added(simd, &mixed, &axial), simd.in_order::<LAST, W>(&above)]
    }

    const SIGNS: [StateLanes<W>; 3] =
        [tiled(&[1.0, 1.0, -1.0, -1.0]), tiled(&[-1.0, 1.0, 1.0, -1.0]), tiled(&[1.0, -1.0, 1.0, -1.0])];

    /// q ω, from q ω1, q ω2 and q ω3: the lanes of each in another order, with signs.
    #[inline(always)]
    pub(super) fn turned<S: InstructionSet>(&self, simd: S) -> StateLanes<W> {
        let mut sum = [0.0; W];
        add_product(simd, &mut sum, &Self::SIGNS[0], &simd.in_order::<0b00_01_10_11, W>(&self.turning[0]));
        add_product(simd, &mut sum, &Self::SIGNS[1], &simd.in_order::<0b01_00_11_10, W>(&self.turning[1]));
        add_product(simd, &mut sum, &Self::SIGNS[2], &simd.in_order::<0b10_11_00_01, W>(&self.turning[2]));
        sum
    }
}

/// The next and the last of three lanes in turn, and the fourth: two bits a lane.
pub(super) const NEXT: i32 = 0b11_00_10_01;
pub(super) const LAST: i32 = 0b11_01_00_10;
const FOURTH: i32 = 0b11_11_11_11;

impl<const W: usize> Factors<W> {
    pub(super) const ZERO: Self = Self {
        attitude: [0.0; W],
        cyclic: [0.0; W],
        scalar: [0.0; W],
        rates: [[0.0; W]; 3],
        neighbours: [[0.0; W]; 2],
        diagonals: [[0.0; W]; 3],
    };

    /// The products that depend on one coefficient of attitude and rates.
    #[inline(always)]
    pub(super) fn set<S: InstructionSet>(&mut self, simd: S, attitude: &StateLanes<W>, rates: &StateLanes<W>) {
        self.attitude = *attitude;
        self.cyclic = simd.in_order::<NEXT, W>(attitude);
        self.scalar = simd.in_order::<FOURTH, W>(attitude);
        self.rates[0] = simd.in_order::<0b00_00_00_00, W>(rates);
        self.rates[1] = simd.in_order::<0b01_01_01_01, W>(rates);
        self.rates[2] = simd.in_order::<0b10_10_10_10, W>(rates);
        self.neighbours = [simd.in_order::<NEXT, W>(rates), simd.in_order::<LAST, W>(rates)];
    }

    /// The matrix of one state.
    #[inline(always)]
    pub(super) fn matrix(&self, state: usize) -> Matrix3<f64> {
        Matrix3::from_fn(|row, column| self.diagonals[(row + 3 - column) % 3][4 * state + column])
    }
}
