//! Several doubles at a time, with the arithmetic of the kernels.
//!
//! A value consists of one or two vectors. A kernel is one long chain of dependent operations; two chains side by side use the time that each one waits (a
//! sixth of the time of a sample, with every instruction set). No closure and no `array::map` is used around
//! vectors: a function that is not inlined is compiled without the instructions of the set and is fifty times slower.

use std::ops::{Add, Div, Mul, Neg, Sub};

use pulp::bytemuck;

use super::instruction_set::InstructionSet;

/// Most vectors that any instruction set processes side by side.
const STRANDS: usize = 2;

/// Most lanes of any instruction set.
pub(crate) const WIDEST: usize = 8 * STRANDS;

/// 1.5·2^52. Adding and subtracting it rounds a smaller number to the nearest integer; after the addition the lowest bits are those of that integer.
pub(crate) const INTEGERS: f64 = 6_755_399_441_055_744.0;

/// The bits of a double without its sign. The functions of pulp for magnitude and sign are not always inlined.
const MAGNITUDE: f64 = f64::from_bits(!(1 << 63));

/// Vectors of doubles. A set with one strand leaves the second vector unused. `mul_add` rounds once if the instruction set has a fused multiply-add, otherwise
/// twice. All other operations give the same bits on every machine.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<S: InstructionSet> {
    simd: S,
    /// Gives the vectors in memory the alignment of a register. Without it loads from the stack cross cache lines, in most calls: derivatives took
    /// a seventh longer with AVX-512.
    _aligned: [S::Register; 0],
    strands: [S::f64s; STRANDS],
}

/// An operation on each strand.
macro_rules! strands {
    ($lanes:expr, $index:ident => $value:expr) => {{
        let mut lanes = $lanes;
        let mut $index = 0;
        while $index < S::STRANDS {
            lanes.strands[$index] = $value;
            $index += 1;
        }
        lanes
    }};
}

impl<S: InstructionSet> Add for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        strands!(self, i => self.simd.add_f64s(self.strands[i], other.strands[i]))
    }
}

impl<S: InstructionSet> Sub for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        strands!(self, i => self.simd.sub_f64s(self.strands[i], other.strands[i]))
    }
}

impl<S: InstructionSet> Mul for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        strands!(self, i => self.simd.mul_f64s(self.strands[i], other.strands[i]))
    }
}

impl<S: InstructionSet> Div for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        strands!(self, i => self.simd.div_f64s(self.strands[i], other.strands[i]))
    }
}

impl<S: InstructionSet> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        strands!(self, i => self.simd.xor_f64s(self.strands[i], self.simd.splat_f64s(-0.0)))
    }
}

impl<S: InstructionSet> Lanes<S> {
    /// Number of doubles.
    pub(crate) const WIDTH: usize = S::STRANDS * S::F64_LANES;

    /// `value` in each lane.
    #[inline(always)]
    pub(crate) fn splat(simd: S, value: f64) -> Self {
        Self { simd, _aligned: [], strands: [simd.splat_f64s(value); STRANDS] }
    }

    /// Each value in all lanes of one vector.
    #[inline(always)]
    pub(crate) fn splats<const N: usize>(simd: S, values: [f64; N]) -> [Self; N] {
        let mut all = [Self::splat(simd, 0.0); N];
        for (lanes, value) in all.iter_mut().zip(values) {
            *lanes = Self::splat(simd, value);
        }
        all
    }

    /// The values of a slice, one for each lane. Missing values are zero.
    #[inline(always)]
    pub(crate) fn load(simd: S, values: &[f64]) -> Self {
        let zeros = Self::splat(simd, 0.0);
        match S::as_simd_f64s(values).0 {
            [first, ..] if S::STRANDS == 1 => Self { strands: [*first; STRANDS], ..zeros },
            [first, second, ..] => Self { strands: [*first, *second], ..zeros },
            _ => {
                let middle = S::F64_LANES.min(values.len());
                let (first, second) = values.split_at(middle);
                Self { strands: [simd.partial_load_f64s(first), simd.partial_load_f64s(second)], ..zeros }
            }
        }
    }

    /// The instruction set.
    #[inline(always)]
    pub(crate) fn simd(self) -> S {
        self.simd
    }

    /// `value` in each lane, for the instruction set of self.
    #[inline(always)]
    pub(crate) fn all(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    /// Loads a slice with one value for each lane.
    #[inline(always)]
    pub(crate) fn like(self, values: &[f64]) -> Self {
        Self::load(self.simd, values)
    }

    /// The larger of self and |other| in each lane. The result is NaN if `other` is NaN; a NaN in self is lost.
    #[inline(always)]
    pub(crate) fn largest(self, other: Self) -> Self {
        strands!(self, i => {
            let magnitude = self.simd.and_f64s(other.strands[i], self.simd.splat_f64s(MAGNITUDE));
            let smaller = self.simd.less_than_or_equal_f64s(magnitude, self.strands[i]);
            self.simd.select_f64s(smaller, self.strands[i], magnitude)
        })
    }

    /// The values as a slice.
    #[inline(always)]
    pub(crate) fn values(&self) -> &[f64] {
        bytemuck::cast_slice(&self.strands[..S::STRANDS])
    }

    /// self·factor + term.
    #[inline(always)]
    pub(crate) fn mul_add(self, factor: Self, term: Self) -> Self {
        strands!(self, i => self.simd.mul_add_e_f64s(self.strands[i], factor.strands[i], term.strands[i]))
    }

    /// term − self·factor.
    #[inline(always)]
    pub(crate) fn negate_mul_add(self, factor: Self, term: Self) -> Self {
        strands!(self, i => self.simd.negate_mul_add_e_f64s(self.strands[i], factor.strands[i], term.strands[i]))
    }

    /// |self|.
    #[inline(always)]
    pub(crate) fn magnitude(self) -> Self {
        strands!(self, i => self.simd.and_f64s(self.strands[i], self.simd.splat_f64s(MAGNITUDE)))
    }

    /// The nearest integer; |self| must be below 2^51.
    #[inline(always)]
    pub(crate) fn rounded(self) -> Self {
        let integers = self.all(INTEGERS);
        (self + integers) - integers
    }

    /// In each lane `near` if self is at most `bound`, otherwise `far`.
    #[inline(always)]
    pub(crate) fn up_to(self, bound: f64, near: Self, far: Self) -> Self {
        let bound = self.all(bound);
        strands!(self, i => {
            let within = self.simd.less_than_or_equal_f64s(self.strands[i], bound.strands[i]);
            self.simd.select_f64s(within, near.strands[i], far.strands[i])
        })
    }

    /// Whether a value is above 0; NaN is not.
    #[inline(always)]
    pub(crate) fn any_above_zero(self) -> bool {
        let zero = self.simd.splat_f64s(0.0);
        let mut found = false;
        let mut i = 0;
        while i < S::STRANDS {
            found |= self.simd.first_true_m64s(self.simd.less_than_f64s(zero, self.strands[i])) < S::F64_LANES;
            i += 1;
        }
        found
    }

    /// A scalar function of each value.
    #[inline(always)]
    pub(crate) fn each(self, function: impl Fn(f64) -> f64) -> Self {
        let mut lanes = self;
        for value in bytemuck::cast_slice_mut(&mut lanes.strands[..S::STRANDS]) {
            *value = function(*value);
        }
        lanes
    }

    /// The polynomial with these coefficients, evaluated at self.
    #[inline(always)]
    pub(crate) fn polynomial(self, coefficients: &[f64]) -> Self {
        let mut sum = self.all(0.0);
        for coefficient in coefficients.iter().rev() {
            sum = sum.mul_add(self, self.all(*coefficient));
        }
        sum
    }

    /// 1/self.
    #[inline(always)]
    pub(crate) fn reciprocal(self) -> Self {
        strands!(self, i => self.simd.div_f64s(self.simd.splat_f64s(1.0), self.strands[i]))
    }

    /// √self.
    #[inline(always)]
    pub(crate) fn root(self) -> Self {
        strands!(self, i => self.simd.sqrt_f64s(self.strands[i]))
    }

    /// self·other − product, exactly, where `product` is self·other rounded.
    #[inline(always)]
    pub(crate) fn product_error(self, other: Self, product: Self) -> Self {
        if S::FUSED {
            // A negated operand is part of the instruction.
            return self.mul_add(other, product * product.all(-1.0));
        }
        // Dekker's product.
        let ((a, a_low), (b, b_low)) = (self.halves(), other.halves());
        (((a * b - product) + a * b_low) + a_low * b) + a_low * b_low
    }

    /// The first 26 bits and the other 27 bits. Their products are exact except for the last bit of the smallest. The bits are cut off, because Veltkamp's
    /// factor would overflow.
    #[inline(always)]
    fn halves(self) -> (Self, Self) {
        let high = strands!(self, i => {
            let bits = self.simd.transmute_u64s_f64s(self.strands[i]);
            self.simd.transmute_f64s_u64s(self.simd.and_u64s(bits, self.simd.splat_u64s(!0x7ff_ffff)))
        });
        (high, self - high)
    }

    /// (self, cosine) of the angle plus as many quarter turns as the lowest two bits of `quarters` say.
    #[inline(always)]
    pub(crate) fn turned(self, cosine: Self, quarters: Self) -> (Self, Self) {
        let (mut sines, mut cosines) = (self, cosine);
        for i in 0..S::STRANDS {
            let quarters = self.simd.transmute_u64s_f64s(quarters.strands[i]);
            (sines.strands[i], cosines.strands[i]) = self.simd.turned(self.strands[i], cosine.strands[i], quarters);
        }
        (sines, cosines)
    }

    /// Four columns to rows, one row for each lane.
    #[inline(always)]
    pub(crate) fn store_fours([x, y, z, w]: [Self; 4], rows: &mut [[f64; 4]]) {
        for (i, rows) in rows.chunks_exact_mut(S::F64_LANES).enumerate().take(S::STRANDS) {
            let vectors = x.simd.fours([x.strands[i], y.strands[i], z.strands[i], w.strands[i]]);
            S::as_mut_simd_f64s(rows.as_flattened_mut()).0.copy_from_slice(&vectors);
        }
    }

    /// Writes the values, one for each lane.
    #[inline(always)]
    pub(crate) fn store(self, out: &mut [f64]) {
        let vectors = S::as_mut_simd_f64s(out).0;
        let mut i = 0;
        while i < S::STRANDS {
            vectors[i] = self.strands[i];
            i += 1;
        }
    }

    /// `first` in the lanes of one strand, `second` in those of the other.
    #[inline(always)]
    pub(crate) fn of_two(simd: S, first: f64, second: f64) -> Self {
        Self { simd, _aligned: [], strands: [simd.splat_f64s(first), simd.splat_f64s(second)] }
    }

    /// The same value, if both strands are known to be alike: the second one need not be loaded.
    #[inline(always)]
    pub(crate) fn alike(self) -> Self {
        Self { strands: [self.strands[0]; STRANDS], ..self }
    }

    /// The lanes of one strand, to as many places.
    #[inline(always)]
    pub(crate) fn store_strand(self, strand: usize, out: &mut [f64]) {
        S::as_mut_simd_f64s(out).0[0] = self.strands[strand];
    }

    /// Three columns to rows, one row for each lane.
    #[inline(always)]
    pub(crate) fn store_threes([x, y, z]: [Self; 3], rows: &mut [[f64; 3]]) {
        for (i, rows) in rows.chunks_exact_mut(S::F64_LANES).enumerate().take(S::STRANDS) {
            let vectors = x.simd.threes([x.strands[i], y.strands[i], z.strands[i]]);
            S::as_mut_simd_f64s(rows.as_flattened_mut()).0.copy_from_slice(&vectors);
        }
    }
}
