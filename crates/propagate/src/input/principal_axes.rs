//! Principal axes of an inertia tensor, as near as possible to the axes of the tensor.
//!
//! The method is Jacobi's: rotations in the planes of two axes, each by at most 45°, until the matrix is diagonal. Products of inertia below [`NEGLIGIBLE`] of
//! the largest moment count as 0. Moments that are equal to this accuracy therefore keep their axes, and a diagonal tensor has the unit matrix.

use nalgebra::Matrix3;

/// Products of inertia and differences of moments below this fraction of the largest moment count as 0.
pub(crate) const NEGLIGIBLE: f64 = 1e-12;
/// Largest number of sweeps. Convergence is quadratic, and five sweeps have always been enough.
const MOST_SWEEPS: usize = 12;

/// Principal moments, and the axes as columns of a proper rotation. The first axis is the one nearest to the given axis 1, and so on.
pub(crate) fn principal_axes(tensor: &Matrix3<f64>) -> ([f64; 3], Matrix3<f64>) {
    let largest = tensor.amax();
    let mut left = *tensor / largest;
    let mut axes = Matrix3::identity();
    for _ in 0..MOST_SWEEPS {
        let mut rest = 0.0_f64;
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            rest = rest.max(left[(i, j)].abs());
            let turn = rotation(&left, i, j);
            left = turn.transpose() * left * turn;
            axes *= turn;
        }
        if rest <= f64::EPSILON * NEGLIGIBLE {
            break;
        }
    }
    let axes = nearest_order(&axes);
    let moments = (axes.transpose() * tensor * axes).diagonal();
    (moments.into(), axes)
}

/// The rotation that removes one product of inertia. It is the identity if the product and the difference of the two moments are negligible.
fn rotation(tensor: &Matrix3<f64>, i: usize, j: usize) -> Matrix3<f64> {
    let (product, difference) = (tensor[(i, j)], tensor[(j, j)] - tensor[(i, i)]);
    let mut turn = Matrix3::identity();
    if product == 0.0 || product.abs().max(difference.abs()) <= NEGLIGIBLE {
        return turn;
    }
    let cotangent = difference / (2.0 * product);
    let tangent = cotangent.signum() / (cotangent.abs() + cotangent.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = tangent * cosine;
    (turn[(i, i)], turn[(j, j)]) = (cosine, cosine);
    (turn[(i, j)], turn[(j, i)]) = (sine, -sine);
    turn
}

/// The columns in the order and with the signs that bring them nearest to the unit matrix.
fn nearest_order(axes: &Matrix3<f64>) -> Matrix3<f64> {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let nearness = |order: &[usize; 3]| -> f64 { (0..3).map(|i| axes[(i, order[i])].abs()).sum() };
    let mut best = ORDERS[0];
    for order in ORDERS {
        if nearness(&order) > nearness(&best) {
            best = order;
        }
    }
    let mut sorted = Matrix3::from_fn(|row, column| axes[(row, best[column])]);
    for column in 0..3 {
        if sorted[(column, column)] < 0.0 {
            sorted.column_mut(column).neg_mut();
        }
    }
    if sorted.determinant() < 0.0 {
        // Reverse the column that is least aligned with its own axis.
        let along = |column: &usize| sorted[(*column, *column)];
        let least = (0..3).min_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or(0);
        sorted.column_mut(least).neg_mut();
    }
    sorted
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::*;

    fn turned(moments: [f64; 3], axis: [f64; 3]) -> (Matrix3<f64>, Matrix3<f64>) {
        let turn = Rotation3::from_scaled_axis(Vector3::from(axis)).into_inner();
        (turn * Matrix3::from_diagonal(&Vector3::from(moments)) * turn.transpose(), turn)
    }

    #[test]
    fn axes_and_moments_of_a_turned_body_are_found_to_rounding() {
        for moments in [[1.0, 1.5, 2.0], [2.0, 1.0, 1.5], [1.0, 1.0 + 1e-6, 1.5]] {
            for axis in [[0.1, -0.2, 0.3], [1e-9, 0.0, 0.0], [0.4, 0.4, 0.2]] {
                let (tensor, _) = turned(moments, axis);
                let (found, axes) = principal_axes(&tensor);
                let rebuilt = axes * Matrix3::from_diagonal(&Vector3::from(found)) * axes.transpose();
                assert!((rebuilt - tensor).amax() < 4e-15, "{moments:?} {axis:?}");
                assert!((axes.determinant() - 1.0).abs() < 1e-15 && (0..3).all(|i| axes[(i, i)] > 0.4));
            }
        }
    }

    #[test]
    fn equal_moments_keep_the_axes_as_given() {
        let (mut tensor, _) = turned([1.0, 1.0, 2.0], [0.0, 0.0, 0.7]);
        tensor[(0, 1)] += 3e-14;
        tensor[(1, 0)] += 3e-14;
        assert_eq!(principal_axes(&tensor).1, Matrix3::identity());
        let (tensor, _) = turned([2.0, 2.0, 2.0], [0.3, 0.2, 0.7]);
        assert_eq!(principal_axes(&tensor).1, Matrix3::identity());
    }
}
