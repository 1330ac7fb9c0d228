//! Taylor coefficients in rows of four lanes, and sums of products of them.

/// The highest order of a step.
pub(super) const MAX: usize = 24;
/// Rows of a series.
pub(super) const ROWS: usize = MAX + 1;

/// Four lanes: a quaternion, or a vector and 0.
pub(super) type Row = [f64; 4];
/// The coefficients of four functions.
pub(super) type Series = [Row; ROWS];
/// The coefficients of one function.
pub(super) type Scalars = [f64; ROWS];

/// Coefficients of attitude and rates of one order.
pub(super) type Coefficients = [f64; 7];

/// A series of zeros.
pub(super) const ZERO: Series = [[0.0; 4]; ROWS];

/// sum += factor · row.
#[inline(always)]
pub(super) fn add_scaled(sum: &mut Row, factor: f64, row: &Row) {
    for lane in 0..4 {
        sum[lane] = factor.mul_add(row[lane], sum[lane]);
    }
}

/// sum += one · other, lane by lane.
#[inline(always)]
pub(super) fn add_product(sum: &mut Row, one: &Row, other: &Row) {
    for lane in 0..4 {
        sum[lane] = one[lane].mul_add(other[lane], sum[lane]);
    }
}

/// The largest magnitude in a row.
#[inline(always)]
pub(super) fn largest(row: &Row) -> f64 {
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
