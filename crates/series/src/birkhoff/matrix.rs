//! Small matrices over a field, and the symplectic form in the order q₁, p₁, q₂, p₂, …

use super::mode::modulus;
use crate::coefficient::Coefficient;
use crate::real_field::RealField;
use num_traits::{One, Zero};

pub(crate) type Matrix<C> = Vec<Vec<C>>;

/// The unit matrix.
pub(crate) fn unit<C: Coefficient>(n: usize) -> Matrix<C> {
    (0..n).map(|i| (0..n).map(|j| if i == j { C::one() } else { C::zero() }).collect()).collect()
}

/// Σ aᵢ bᵢ.
pub(crate) fn dot<'a, C: Coefficient + 'a>(
    a: impl IntoIterator<Item = &'a C>,
    b: impl IntoIterator<Item = &'a C>,
) -> C {
    let mut sum = C::zero();
    for (a, b) in a.into_iter().zip(b) {
        let mut product = a.clone();
        product *= b;
        sum += &product;
    }
    sum
}

pub(crate) fn transposed<C: Clone>(matrix: &Matrix<C>) -> Matrix<C> {
    (0..matrix.first().map_or(0, Vec::len)).map(|j| matrix.iter().map(|row| row[j].clone()).collect()).collect()
}

pub(crate) fn product<C: Coefficient>(a: &Matrix<C>, b: &Matrix<C>) -> Matrix<C> {
    let columns = transposed(b);
    a.iter().map(|row| columns.iter().map(|column| dot(row, column)).collect()).collect()
}

/// J z: (p₁, −q₁, p₂, −q₂, …), so that ż = J ∇H.
pub(crate) fn turned<C: Coefficient>(z: &[C]) -> Vec<C> {
    z.chunks(2).flat_map(|pair| [pair[1].clone(), -pair[0].clone()]).collect()
}

/// xᵀ J y = Σ x_q y_p − x_p y_q.
pub(crate) fn pairing<C: Coefficient>(x: &[C], y: &[C]) -> C {
    dot(x, &turned(y))
}

/// An entry of J.
pub(crate) fn form_entry(i: usize, j: usize) -> i64 {
    let above = |i: usize, j: usize| i64::from(i.is_multiple_of(2) && j == i + 1);
    above(i, j) - above(j, i)
}

/// J M, where J acts on pairs of rows.
pub(crate) fn turned_rows<C: Coefficient>(matrix: &Matrix<C>) -> Matrix<C> {
    transposed(&transposed(matrix).iter().map(|column| turned(column)).collect())
}

/// The inverse −J Mᵀ J of a symplectic matrix.
pub(crate) fn symplectic_inverse<C: Coefficient>(matrix: &Matrix<C>) -> Matrix<C> {
    turned_rows(&transposed(&turned_rows(matrix))) // J (J M)ᵀ = J Mᵀ Jᵀ
}

/// The null vectors of a square matrix, from elimination with complete pivoting; `None` if there are fewer or more than `dimension` of them.
///
/// For floats the last `dimension` pivots count as zero if they are at most `smallest`.
pub(crate) fn null_space<R: RealField>(
    mut matrix: Matrix<R::Complex>,
    dimension: usize,
    smallest: f64,
) -> Option<Vec<Vec<R::Complex>>> {
    let n = matrix.len();
    let mut order: Vec<usize> = (0..n).collect();
    let size = |value: &R::Complex| if value.is_zero() { -1.0 } else { modulus::<R>(value).min(f64::MAX) };
    for step in 0..=n - dimension {
        let (mut largest, mut at) = (-1.0, (step, step));
        for (i, j) in (step..n).flat_map(|i| (step..n).map(move |j| (i, j))) {
            if size(&matrix[i][j]) > largest {
                (largest, at) = (size(&matrix[i][j]), (i, j));
            }
        }
        if step == n - dimension {
            let singular = if R::EPSILON > 0.0 { largest <= smallest } else { largest < 0.0 };
            return singular.then(|| back_substituted::<R>(&matrix, &order, dimension)).flatten();
        }
        if largest < 0.0 {
            return None;
        }
        matrix.swap(step, at.0);
        matrix.iter_mut().for_each(|row| row.swap(step, at.1));
        order.swap(step, at.1);
        let pivot = matrix[step].clone();
        for row in matrix.iter_mut().skip(step + 1) {
            let factor = row[step].divide(&pivot[step])?;
            for (entry, above) in row.iter_mut().zip(&pivot).skip(step) {
                let mut product = factor.clone();
                product *= above;
                *entry -= &product;
            }
        }
    }
    None
}

fn back_substituted<R: RealField>(
    matrix: &Matrix<R::Complex>,
    order: &[usize],
    dimension: usize,
) -> Option<Vec<Vec<R::Complex>>> {
    let n = matrix.len();
    let vector = |free: usize| {
        let mut solution = vec![R::Complex::zero(); n];
        solution[free] = R::Complex::one();
        for i in (0..n - dimension).rev() {
            let known = dot(&matrix[i][i + 1..], &solution[i + 1..]);
            solution[i] = -known.divide(&matrix[i][i])?;
        }
        let mut vector = vec![R::Complex::zero(); n];
        for (&at, value) in order.iter().zip(solution) {
            vector[at] = value;
        }
        Some(vector)
    };
    (n - dimension..n).map(vector).collect()
}
