//! Several doubles at a time, with the arithmetic that the kernels are written in.

use std::ops::{Add, Mul, Sub};

use pulp::bytemuck;

use super::level::Level;

/// A vector of doubles. With a fused multiply-add `mul_add` rounds once, without one twice; everything else has the same bits everywhere.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<S: Level> {
    simd: S,
    values: S::f64s,
}

impl<S: Level> Add for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(self.simd.add_f64s(self.values, other.values))
    }
}

impl<S: Level> Sub for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(self.simd.sub_f64s(self.values, other.values))
    }
}

impl<S: Level> Mul for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(self.simd.mul_f64s(self.values, other.values))
    }
}

impl<S: Level> Lanes<S> {
    /// How many doubles.
    pub(crate) const WIDTH: usize = S::F64_LANES;

    #[inline(always)]
    fn with(self, values: S::f64s) -> Self {
        Self { values, ..self }
    }

    /// `value` in each lane.
    #[inline(always)]
    pub(crate) fn splat(simd: S, value: f64) -> Self {
        Self { simd, values: simd.splat_f64s(value) }
    }

    /// Each value in all lanes of a vector of its own.
    #[inline(always)]
    pub(crate) fn splats<const N: usize>(simd: S, values: [f64; N]) -> [Self; N] {
        let mut vectors = [Self::splat(simd, 0.0); N];
        for (vector, value) in vectors.iter_mut().zip(values) {
            *vector = Self::splat(simd, value);
        }
        vectors
    }

    /// As many values as there are lanes; zeros for those that lack.
    #[inline(always)]
    pub(crate) fn load(simd: S, values: &[f64]) -> Self {
        match S::as_simd_f64s(values).0 {
            [first, ..] => Self { simd, values: *first },
            [] => Self { simd, values: simd.partial_load_f64s(values) },
        }
    }

    /// `value` in each lane of another vector.
    #[inline(always)]
    pub(crate) fn all(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    /// As many values as there are lanes, from a slice that has them.
    #[inline(always)]
    pub(crate) fn like(self, values: &[f64]) -> Self {
        Self::load(self.simd, values)
    }

    /// The larger of self and |other|, in each lane; NaN stays if it comes last.
    #[inline(always)]
    pub(crate) fn largest(self, other: Self) -> Self {
        let magnitude = self.simd.abs_f64s(other.values);
        let smaller = self.simd.less_than_or_equal_f64s(magnitude, self.values);
        self.with(self.simd.select_f64s(smaller, self.values, magnitude))
    }

    /// The values in memory.
    #[inline(always)]
    pub(crate) fn values(&self) -> &[f64] {
        bytemuck::cast_slice(std::slice::from_ref(&self.values))
    }

    /// self·factor + term.
    #[inline(always)]
    pub(crate) fn mul_add(self, factor: Self, term: Self) -> Self {
        self.with(self.simd.mul_add_e_f64s(self.values, factor.values, term.values))
    }

    /// term − self·factor.
    #[inline(always)]
    pub(crate) fn negate_mul_add(self, factor: Self, term: Self) -> Self {
        self.with(self.simd.negate_mul_add_e_f64s(self.values, factor.values, term.values))
    }

    /// 1/self.
    #[inline(always)]
    pub(crate) fn reciprocal(self) -> Self {
        self.with(self.simd.div_f64s(self.simd.splat_f64s(1.0), self.values))
    }

    /// √self.
    #[inline(always)]
    pub(crate) fn root(self) -> Self {
        self.with(self.simd.sqrt_f64s(self.values))
    }

    /// self·other − product, exactly, where `product` is self·other rounded.
    #[inline(always)]
    pub(crate) fn product_error(self, other: Self, product: Self) -> Self {
        if S::FUSED {
            return self.with(self.simd.mul_add_f64s(self.values, other.values, self.simd.neg_f64s(product.values)));
        }
        // Veltkamp's splitting and Dekker's product.
        let ((a, a_low), (b, b_low)) = (self.halves(), other.halves());
        (((a * b - product) + a * b_low) + a_low * b) + a_low * b_low
    }

    /// Two parts of 26 bits whose products are exact.
    #[inline(always)]
    fn halves(self) -> (Self, Self) {
        let scaled = self * self.all(134_217_729.0);
        let high = scaled - (scaled - self);
        (high, self - high)
    }

    /// (self, cosine) of an angle turned on by as many quarter turns as the lowest bits of `quarters` say.
    #[inline(always)]
    pub(crate) fn turned(self, cosine: Self, quarters: Self) -> (Self, Self) {
        let quarters = self.simd.transmute_u64s_f64s(quarters.values);
        let (sine, cosine) = self.simd.turned(self.values, cosine.values, quarters);
        (self.with(sine), self.with(cosine))
    }

    /// Columns to rows of four, of which there are as many as lanes.
    #[inline(always)]
    pub(crate) fn store_fours(columns: [Self; 4], rows: &mut [[f64; 4]]) {
        let vectors =
            columns[0].simd.fours([columns[0].values, columns[1].values, columns[2].values, columns[3].values]);
        S::as_mut_simd_f64s(rows.as_flattened_mut()).0.copy_from_slice(&vectors);
    }

    /// Columns to rows of three, of which there are as many as lanes.
    #[inline(always)]
    pub(crate) fn store_threes(columns: [Self; 3], rows: &mut [[f64; 3]]) {
        let vectors = columns[0].simd.threes([columns[0].values, columns[1].values, columns[2].values]);
        S::as_mut_simd_f64s(rows.as_flattened_mut()).0.copy_from_slice(&vectors);
    }
}
