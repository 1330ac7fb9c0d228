//! Taylor coefficients in rows of lanes, four for each state, and sums of products of them.

use pulp::Simd;

/// The highest order of a step.
pub(super) const MAX: usize = 24;
/// Rows of a series.
pub(super) const ROWS: usize = MAX + 1;

/// Four lanes of each state: a quaternion, or a vector and 0. Several states go on with the same steps.
pub(super) type StateLanes<const W: usize> = [f64; W];
/// The lanes of one state.
pub(super) type Row = StateLanes<4>;
/// The coefficients of four functions.
pub(super) type Series = [Row; ROWS];
/// The coefficients of one function.
pub(super) type Scalars = [f64; ROWS];

/// Coefficients of attitude and rates of one order.
pub(super) type Coefficients = [f64; 7];

/// The power of the distance in the series of a body's gravity gradient.
pub(super) const GRAVITY: f64 = -2.5;

/// 1/k at the index k, and 0 at 0.
pub(super) const RECIPROCALS: [f64; ROWS + 1] = {
    let (mut reciprocals, mut k) = ([0.0; ROWS + 1], 1);
    while k <= ROWS {
        reciprocals[k] = 1.0 / k as f64;
        k += 1;
    }
    reciprocals
};

/// A series of zeros.
pub(super) const ZERO: Series = [[0.0; 4]; ROWS];

/// sum += factor · row.
#[inline(always)]
pub(super) fn add_scaled<S: Simd, const W: usize>(simd: S, sum: &mut StateLanes<W>, factor: f64, row: &StateLanes<W>) {
    let ((sums, _), (rows, _)) = (S::as_mut_simd_f64s(sum), S::as_simd_f64s(row));
    let factor = simd.splat_f64s(factor);
    // Loops over indices here and in the callers: compilers do not always inline iterators into functions as long as these.
    for i in 0..W / S::F64_LANES {
        sums[i] = simd.mul_add_f64s(factor, rows[i], sums[i]);
    }
}

/// sum += one · other, lane by lane. The rows are whole vectors: compilers would take them apart where their lanes are used apart later.
#[inline(always)]
pub(super) fn add_product<S: Simd, const W: usize>(
    simd: S,
    sum: &mut StateLanes<W>,
    one: &StateLanes<W>,
    other: &StateLanes<W>,
) {
    let ((sums, _), (ones, _), (others, _)) = (S::as_mut_simd_f64s(sum), S::as_simd_f64s(one), S::as_simd_f64s(other));
    for i in 0..W / S::F64_LANES {
        sums[i] = simd.mul_add_f64s(ones[i], others[i], sums[i]);
    }
}

/// one + other, lane by lane.
#[inline(always)]
pub(super) fn added<S: Simd, const W: usize>(simd: S, one: &StateLanes<W>, other: &StateLanes<W>) -> StateLanes<W> {
    let mut sum = *one;
    let ((sums, _), (others, _)) = (S::as_mut_simd_f64s(&mut sum), S::as_simd_f64s(other));
    for i in 0..W / S::F64_LANES {
        sums[i] = simd.add_f64s(sums[i], others[i]);
    }
    sum
}

/// one − other, lane by lane.
#[inline(always)]
pub(super) fn subtracted<S: Simd, const W: usize>(
    simd: S,
    one: &StateLanes<W>,
    other: &StateLanes<W>,
) -> StateLanes<W> {
    let mut sum = *one;
    let ((sums, _), (others, _)) = (S::as_mut_simd_f64s(&mut sum), S::as_simd_f64s(other));
    for i in 0..W / S::F64_LANES {
        sums[i] = simd.sub_f64s(sums[i], others[i]);
    }
    sum
}

/// Four lanes, repeated for each state.
pub(super) const fn tiled<const W: usize>(row: &Row) -> StateLanes<W> {
    let mut lanes = [0.0; W];
    let mut lane = 0;
    while lane < W {
        lanes[lane] = row[lane % 4];
        lane += 1;
    }
    lanes
}

/// The lanes of one state.
#[inline(always)]
pub(super) fn four<const W: usize>(row: &StateLanes<W>, at: usize) -> Row {
    [row[at], row[at + 1], row[at + 2], row[at + 3]]
}

/// The root of the sum of squares.
pub(super) fn norm(row: &[f64]) -> f64 {
    row.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// The largest magnitude in a row.
#[inline(always)]
pub(super) fn largest(row: &[f64]) -> f64 {
    row.iter().fold(0.0_f64, |most, value| most.max(value.abs()))
}

/// Coefficient k of a product.
#[inline(always)]
pub(super) fn product(one: &Scalars, other: &Scalars, k: usize) -> f64 {
    let mut sum = 0.0_f64;
    for j in 0..=k {
        sum = one[j].mul_add(other[k - j], sum);
    }
    sum
}

/// Coefficient k ≥ 1 of base^power, from those before it.
#[inline(always)]
pub(super) fn power(base: &Scalars, of: &Scalars, power: f64, k: usize) -> f64 {
    let mut sum = 0.0_f64;
    for j in 1..=k {
        let weight = (power + 1.0) * j as f64 - k as f64;
        sum = (weight * base[j]).mul_add(of[k - j], sum);
    }
    sum / (base[0] * k as f64)
}
