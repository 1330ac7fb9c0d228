//! Principal axes of an inertia tensor, as near as possible to the axes of the tensor.
//!
//! The method is Jacobi's, in double-double: rotations in the planes of two axes, each by at most 45°, until the matrix is diagonal. The tensor is taken as exact.
//! Its least moment and the differences of its moments then keep the accuracy that the ratios in Euler's equations need: in doubles a needle of 1e5 : 1 would lose
//! five digits. A diagonal tensor has the unit matrix.

use andoyer_double::DoubleDouble;
use nalgebra::Matrix3;

use crate::numerics::scaling::{exponent, scaled_pair};

/// Products of inertia below this fraction of the largest element count as 0.
const NEGLIGIBLE: f64 = 1e-40;
/// Largest number of sweeps. Convergence is quadratic, and six sweeps have always been enough.
const MOST_SWEEPS: usize = 16;

/// A matrix of double-doubles by its rows.
pub(crate) type Square = [[DoubleDouble; 3]; 3];

/// Principal moments, and the axes as columns of a proper rotation. The first axis is the one nearest to the given axis 1, and so on.
pub(crate) fn principal_axes(tensor: &Square) -> ([DoubleDouble; 3], Square) {
    let largest = tensor.iter().flatten().fold(0.0_f64, |most, entry| most.max(entry.high.abs()));
    let unit = exponent(largest);
    let mut left = tensor.map(|row| row.map(|entry| scaled_pair(entry, -unit)));
    let mut axes = UNIT;
    for _ in 0..MOST_SWEEPS {
        let mut turned = false;
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            if let Some(turn) = rotation(&left, i, j) {
                turn_columns(&mut left, (i, j), turn);
                left = transposed(&left);
                turn_columns(&mut left, (i, j), turn);
                turn_columns(&mut axes, (i, j), turn);
                turned = true;
            }
        }
        if !turned {
            break;
        }
    }
    let order = nearest_order(&axes);
    let moments = order.map(|column| scaled_pair(left[column][column], unit));
    (moments, directed(&axes, order))
}

/// Cosine and sine of the rotation that removes one product of inertia, unless this is 0.
fn rotation(tensor: &Square, i: usize, j: usize) -> Option<[DoubleDouble; 2]> {
    let (product, difference) = (tensor[i][j], tensor[j][j] - tensor[i][i]);
    if product.high.abs() <= NEGLIGIBLE {
        return None;
    }
    let cotangent = difference / product.times_double(2.0);
    let size = if cotangent.high < 0.0 { -cotangent } else { cotangent };
    let root = (size * size + DoubleDouble::ONE).sqrt();
    let tangent = DoubleDouble::from(1.0_f64.copysign(cotangent.high)) / (size + root);
    let cosine = DoubleDouble::ONE / (tangent * tangent + DoubleDouble::ONE).sqrt();
    Some([cosine, tangent * cosine])
}

fn turn_columns(matrix: &mut Square, (i, j): (usize, usize), [cosine, sine]: [DoubleDouble; 2]) {
    for row in matrix {
        (row[i], row[j]) = (cosine * row[i] - sine * row[j], sine * row[i] + cosine * row[j]);
    }
}

/// The axes (2, 3, 1) as columns.
pub(crate) const NEXT_AXES: Square = [UNIT[2], UNIT[0], UNIT[1]];

pub(crate) fn transposed(matrix: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[j][i]))
}

/// The unit matrix.
pub(crate) const UNIT: Square = [
    [DoubleDouble::ONE, DoubleDouble::ZERO, DoubleDouble::ZERO],
    [DoubleDouble::ZERO, DoubleDouble::ONE, DoubleDouble::ZERO],
    [DoubleDouble::ZERO, DoubleDouble::ZERO, DoubleDouble::ONE],
];

/// A vector in components along the columns.
pub(crate) fn along(axes: &Square, vector: [f64; 3]) -> [DoubleDouble; 3] {
    std::array::from_fn(|column| {
        let term = |row: usize| axes[row][column].times_double(vector[row]);
        term(0) + term(1) + term(2)
    })
}

pub(crate) fn product(one: &Square, other: &Square) -> Square {
    let entry = |i: usize, j: usize| {
        let term = |k: usize| one[i][k] * other[k][j];
        term(0) + term(1) + term(2)
    };
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

/// The nearest doubles.
pub(crate) fn rounded(matrix: &Square) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| matrix[i][j].to_f64())
}

/// The order of the columns that brings them nearest to the unit matrix.
fn nearest_order(axes: &Square) -> [usize; 3] {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let nearness = |order: &[usize; 3]| -> f64 { (0..3).map(|i| axes[i][order[i]].high.abs()).sum() };
    let mut best = ORDERS[0];
    for order in ORDERS {
        if nearness(&order) > nearness(&best) {
            best = order;
        }
    }
    best
}

/// The columns in this order, with the signs that bring them nearest to the unit matrix.
fn directed(axes: &Square, order: [usize; 3]) -> Square {
    let mut sorted: Square = std::array::from_fn(|row| order.map(|column| axes[row][column]));
    let reverse = |sorted: &mut Square, column: usize| sorted.iter_mut().for_each(|row| row[column] = -row[column]);
    for column in 0..3 {
        if sorted[column][column].high < 0.0 {
            reverse(&mut sorted, column);
        }
    }
    if rounded(&sorted).determinant() < 0.0 {
        // Reverse the column that is least aligned with its own axis.
        let along = |column: &usize| sorted[*column][*column].high;
        let least = (0..3).min_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or(0);
        reverse(&mut sorted, least);
    }
    sorted
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::*;

    fn turned(moments: [f64; 3], axis: [f64; 3]) -> Matrix3<f64> {
        let turn = Rotation3::from_scaled_axis(Vector3::from(axis)).into_inner();
        turn * Matrix3::from_diagonal(&Vector3::from(moments)) * turn.transpose()
    }

    fn pairs(tensor: &Matrix3<f64>) -> Square {
        std::array::from_fn(|i| std::array::from_fn(|j| tensor[(i.min(j), i.max(j))].into()))
    }

    #[test]
    fn axes_and_moments_of_a_turned_body_rebuild_its_tensor_to_thirty_digits() {
        let moments = [[1.0, 1.5, 2.0], [2.0, 1.0, 1.5], [1.0, 1.0 + 1e-6, 1.5], [1.0, 1.0, 2.0], [1e-9, 1.0, 1.0]];
        for moments in moments {
            for axis in [[0.1, -0.2, 0.3], [1e-9, 0.0, 0.0], [0.4, 0.4, 0.2]] {
                let tensor = pairs(&turned(moments, axis));
                let (found, axes) = principal_axes(&tensor);
                for i in 0..3 {
                    for j in 0..3 {
                        let term = |k: usize| axes[i][k] * found[k] * axes[j][k];
                        let left = term(0) + term(1) + term(2) - tensor[i][j];
                        assert!(left.high.abs() < 1e-29, "{moments:?} {axis:?}: {left:?}");
                    }
                }
                assert!((rounded(&axes).determinant() - 1.0).abs() < 1e-15 && (0..3).all(|i| axes[i][i].high > 0.4));
            }
        }
    }

    #[test]
    fn a_diagonal_tensor_keeps_its_axes() {
        let tensor = pairs(&Matrix3::from_diagonal(&Vector3::new(2.0, 1.0, 1.0)));
        assert_eq!(rounded(&principal_axes(&tensor).1), Matrix3::identity());
    }
}
