//! The symplectic diagonalization of one block of a quadratic part.
//!
//! The vectors w = a + ib of an eigenvalue iω are orthogonalized in the Hermitian form w̄ᵀ J w = 2i aᵀ J b. The sign of this form is the signature of the
//! centre and determines the sign of ω. The vectors of λ and −λ are paired. For floats, M is then made symplectic to rounding error by M ← M (1 + ½ J E), E =
//! Mᵀ J M − J. The frequencies are read from Mᵀ A M, where the errors of the vectors enter squared.

use super::diagonal::Diagonal;
use super::matrix::{Matrix, dot, form_entry, pairing, product, transposed, turned, turned_rows};
use super::mode::{Mode, modulus};
use super::spectrum::{Eigenspace, Names, ROOT, eigenspace, shown, spectrum};
use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::real_field::RealField;
use num_traits::{One, Zero};

/// Largest rounding error of the entries of Mᵀ A M off its diagonal form, relative to A.
const RESIDUAL: f64 = 1e-9;

/// The modes of ½ zᵀ A z, and the matrix M.
pub(crate) fn diagonalized<R: RealField>(a: &Matrix<R>, names: &dyn Fn(usize) -> String) -> Result<Diagonal<R>, Error> {
    let names = Names { names, slots: a.len() };
    let scale = a.iter().flatten().map(|entry| entry.to_float().abs()).fold(0.0, f64::max);
    let motion = turned_rows(a);
    let mut spaces = Vec::new();
    for eigenvalue in spectrum(&motion, scale, &names)? {
        spaces.push(eigenspace(&motion, eigenvalue, scale, &names)?);
    }
    let mut columns = Vec::new();
    let mut modes = Vec::new();
    for space in &spaces {
        match (space.re.is_zero(), space.im.is_zero()) {
            (false, true) => saddles(space, &mut modes, &mut columns, &names)?,
            (false, false) => quartets(space, &mut modes, &mut columns, &names)?,
            _ => centres(space, &mut modes, &mut columns, &names)?,
        }
    }
    let matrix = symplectic(transposed(&columns));
    finished(a, modes, matrix, scale, &names)
}

fn parts<R: RealField>(vector: &[R::Complex]) -> (Vec<R>, Vec<R>) {
    vector.iter().map(R::parts).unzip()
}

fn scaled<C: Coefficient>(vector: &[C], factor: &C) -> Vec<C> {
    vector
        .iter()
        .map(|entry| {
            let mut product = entry.clone();
            product *= factor;
            product
        })
        .collect()
}

fn conjugate<R: RealField>(vector: &[R::Complex]) -> Vec<R::Complex> {
    vector
        .iter()
        .map(|value| {
            let (re, im) = R::parts(value);
            R::complex(re, -im)
        })
        .collect()
}

/// Subtracts factor · other from the vector.
fn less<C: Coefficient>(vector: &mut [C], other: &[C], factor: &C) {
    for (entry, other) in vector.iter_mut().zip(other) {
        let mut product = factor.clone();
        product *= other;
        *entry -= &product;
    }
}

/// The vector with its phase changed so that its largest coordinate q is real and positive (the first one of equal size).
fn phased<R: RealField>(vector: &[R::Complex]) -> Vec<R::Complex> {
    let size = |slot: usize| modulus::<R>(&vector[slot]);
    let slots = || (0..vector.len()).step_by(2);
    let largest = slots().map(size).fold(0.0, f64::max);
    let slot = slots().find(|&slot| size(slot) > 0.0 && size(slot) >= largest * (1.0 - 1e-6));
    let at = slot.unwrap_or_else(|| vector.iter().position(|value| !value.is_zero()).unwrap_or(0));
    let factor = conjugate::<R>(&vector[at..=at]);
    let mut turned = scaled(vector, &factor[0]);
    turned[at] = R::complex(R::parts(&turned[at]).0, R::zero());
    turned
}

/// The norm w̄ᵀ J w / (2i) = aᵀ J b of w = a + ib, and whether it is too small relative to |w|².
fn norm<R: RealField>(vector: &[R::Complex]) -> (R, bool) {
    let (a, b) = parts::<R>(vector);
    let (norm, size) = (pairing(&a, &b), vector.iter().map(|value| modulus::<R>(value).powi(2)).sum::<f64>());
    let small = norm.is_zero() || (R::EPSILON > 0.0 && norm.to_float().abs() < ROOT * size);
    (norm, small)
}

/// Adds one centre for each vector of iω: q along a, p along b/(aᵀJb). ω has the sign of aᵀJb.
fn centres<R: RealField>(
    space: &Eigenspace<R>,
    modes: &mut Vec<Mode<R>>,
    columns: &mut Matrix<R>,
    names: &Names,
) -> Result<(), Error> {
    let mut vectors = space.vectors.clone();
    let mut found = Vec::new();
    while !vectors.is_empty() {
        let vector = independent::<R>(&mut vectors).ok_or_else(|| Error::Defective {
            pairs: names.pairs(),
            eigenvalue: shown(0.0, space.im.to_float()),
            direction: space.vectors.first().map(|vector| names.direction::<R>(vector)).unwrap_or_default(),
        })?;
        let (norm_of, _) = norm::<R>(&vector);
        for other in &mut vectors {
            // w − v (v̄ᵀJw)/(v̄ᵀJv), v̄ᵀJv = 2i n.
            let share = pairing(&conjugate::<R>(&vector), other);
            let whole = R::complex(R::zero(), norm_of.times(2));
            less(other, &vector, &share.divide(&whole).ok_or(Error::DivisionByZero)?);
        }
        let vector = phased::<R>(&vector);
        let magnitude = |(n, _): (R, bool)| n.times(n.sign().into());
        let size = magnitude(norm::<R>(&vector));
        let root = size.geometric_mean(&R::one()).and_then(|root| root.invert());
        let vector = root.map_or_else(|| vector.clone(), |root| scaled(&vector, &R::complex(root, R::zero())));
        let (n, _) = norm::<R>(&vector);
        let (a, b) = parts::<R>(&vector);
        let ratio = if R::EPSILON > 0.0 {
            R::one()
        } else {
            magnitude((n.clone(), false)).invert().ok_or(Error::DivisionByZero)?
        };
        let mode = Mode::Elliptic { frequency: space.im.times(n.sign().into()), ratio };
        found.push((mode, a, scaled(&b, &n.invert().ok_or(Error::DivisionByZero)?), n.sign()));
    }
    found.sort_by_key(|&(.., sign)| -sign);
    for (mode, a, b, _) in found {
        modes.push(mode);
        columns.extend([a, b]);
    }
    Ok(())
}

/// Removes a vector of nonzero norm from `vectors`: the one of largest norm, or a sum of two.
fn independent<R: RealField>(vectors: &mut Vec<Vec<R::Complex>>) -> Option<Vec<R::Complex>> {
    let size = |vector: &[R::Complex]| {
        let length = vector.iter().map(|value| modulus::<R>(value).powi(2)).sum::<f64>();
        norm::<R>(vector).0.to_float().abs() / length
    };
    let at = (0..vectors.len()).max_by(|&i, &j| size(&vectors[i]).total_cmp(&size(&vectors[j])))?;
    if !norm::<R>(&vectors[at]).1 && (vectors.len() == 1 || size(&vectors[at]) > 1e-3) {
        return Some(vectors.swap_remove(at));
    }
    let imaginary = R::complex(R::zero(), R::one());
    let minus = [-R::Complex::one(), -imaginary];
    for (i, j) in (0..vectors.len()).flat_map(|i| (0..i).map(move |j| (i, j))) {
        for factor in &minus {
            let mut sum = vectors[i].clone();
            less(&mut sum, &vectors[j], factor);
            if !norm::<R>(&sum).1 {
                vectors.swap_remove(i);
                return Some(sum);
            }
        }
    }
    (!norm::<R>(&vectors[at]).1).then(|| vectors.swap_remove(at))
}

/// Combines the vectors of −λ so that vᵢᵀ J wⱼ = δᵢⱼ with the vectors of λ.
fn paired<R: RealField>(space: &Eigenspace<R>, names: &Names) -> Result<Vec<[Vec<R::Complex>; 2]>, Error> {
    let (mut left, mut right) = (space.vectors.clone(), space.opposite.clone());
    let mut pairs = Vec::new();
    let length = |vector: &[R::Complex]| vector.iter().map(|value| modulus::<R>(value).powi(2)).sum::<f64>().sqrt();
    while !left.is_empty() {
        let size =
            |i: usize, j: usize| modulus::<R>(&pairing(&left[i], &right[j])) / (length(&left[i]) * length(&right[j]));
        let all = (0..left.len()).flat_map(|i| (0..right.len()).map(move |j| (i, j)));
        let best = all.max_by(|a, b| size(a.0, a.1).total_cmp(&size(b.0, b.1)));
        let (i, j) = best.filter(|&(i, j)| size(i, j) > R::EPSILON.sqrt()).ok_or_else(|| Error::Defective {
            pairs: names.pairs(),
            eigenvalue: shown(space.re.to_float(), space.im.to_float()),
            direction: names.direction::<R>(&left[0]),
        })?;
        let (v, w) = (phased::<R>(&left.swap_remove(i)), right.swap_remove(j));
        let w = scaled(&w, &pairing(&v, &w).invert().ok_or(Error::DivisionByZero)?);
        for other in &mut left {
            let share = pairing(other, &w);
            less(other, &v, &share);
        }
        for other in &mut right {
            let share = pairing(&v, other);
            less(other, &w, &share);
        }
        pairs.push(balanced::<R>(v, w)?);
    }
    Ok(pairs)
}

/// For floats, scales v and w to the same length.
fn balanced<R: RealField>(v: Vec<R::Complex>, w: Vec<R::Complex>) -> Result<[Vec<R::Complex>; 2], Error> {
    if R::EPSILON == 0.0 {
        return Ok([v, w]);
    }
    let length = |vector: &[R::Complex]| vector.iter().map(|value| modulus::<R>(value).powi(2)).sum::<f64>();
    let factor = (length(&w) / length(&v)).powf(0.25);
    let [up, down] = [factor, factor.recip()].map(|factor| R::from_float(factor));
    let (up, down) = (up.ok_or(Error::DivisionByZero)?, down.ok_or(Error::DivisionByZero)?);
    Ok([scaled(&v, &R::complex(up, R::zero())), scaled(&w, &R::complex(down, R::zero()))])
}

fn saddles<R: RealField>(
    space: &Eigenspace<R>,
    modes: &mut Vec<Mode<R>>,
    columns: &mut Matrix<R>,
    names: &Names,
) -> Result<(), Error> {
    for [v, w] in paired(space, names)? {
        columns.push(parts::<R>(&v).0);
        columns.push(parts::<R>(&w).0);
        modes.push(Mode::Hyperbolic { rate: space.re.clone() });
    }
    Ok(())
}

/// Adds the modes of quartets: z = v u + w U + conjugates with u = (q − iQ)/2, U = p + iP.
fn quartets<R: RealField>(
    space: &Eigenspace<R>,
    modes: &mut Vec<Mode<R>>,
    columns: &mut Matrix<R>,
    names: &Names,
) -> Result<(), Error> {
    for [v, w] in paired(space, names)? {
        let ((real, imaginary), (real_w, imaginary_w)) = (parts::<R>(&v), parts::<R>(&w));
        let two = R::integer(2);
        columns.extend([real, scaled(&real_w, &two), imaginary, scaled(&imaginary_w, &-two)]);
        let (rate, frequency, first) = (space.re.clone(), space.im.clone(), modes.len());
        modes.push(Mode::Complex { rate: rate.clone(), frequency: frequency.clone(), partner: first + 1 });
        modes.push(Mode::Complex { rate, frequency: -frequency, partner: first });
    }
    Ok(())
}

/// Makes M symplectic to rounding error.
fn symplectic<R: RealField>(mut matrix: Matrix<R>) -> Matrix<R> {
    let Some(half) = R::ratio(1, 2).filter(|_| R::EPSILON > 0.0) else { return matrix };
    for _ in 0..3 {
        let columns = transposed(&matrix);
        let forms: Matrix<R> = columns.iter().map(|column| turned(column)).collect();
        let error = |i: usize, j: usize| {
            let mut error = dot(&columns[i], &forms[j]);
            error -= &R::integer(form_entry(i, j));
            error *= &half;
            error
        };
        let errors: Matrix<R> = (0..columns.len()).map(|i| (0..columns.len()).map(|j| error(i, j)).collect()).collect();
        let correction = product(&matrix, &turned_rows(&errors));
        for (row, by) in matrix.iter_mut().zip(&correction) {
            row.iter_mut().zip(by).for_each(|(entry, by)| *entry += by);
        }
    }
    matrix
}

/// Reads the frequencies from Mᵀ A M, which must have the diagonal form.
fn finished<R: RealField>(
    a: &Matrix<R>,
    mut modes: Vec<Mode<R>>,
    matrix: Matrix<R>,
    scale: f64,
    names: &Names,
) -> Result<Diagonal<R>, Error> {
    if R::EPSILON == 0.0 {
        return Ok(Diagonal { modes, matrix });
    }
    let mut rest = product(&transposed(&matrix), &product(a, &matrix));
    let read: Vec<(R, R)> = (0..modes.len()).map(|mode| read(&modes, mode, &rest)).collect::<Result<_, _>>()?;
    for (mode, (kind, (first, second))) in modes.iter_mut().zip(read).enumerate() {
        let (q, p) = (2 * mode, 2 * mode + 1);
        let entries = match kind {
            Mode::Elliptic { frequency, .. } => {
                *frequency = first.clone();
                vec![(q, q, first.clone()), (p, p, first)]
            }
            Mode::Hyperbolic { rate } => {
                *rate = first.clone();
                vec![(q, p, first.clone()), (p, q, first)]
            }
            Mode::Complex { rate, frequency, partner } => {
                (*rate, *frequency) = (first.clone(), second.clone());
                let other = 2 * *partner + 1;
                vec![(q, p, first.clone()), (p, q, first), (q, other, -second.clone()), (other, q, -second)]
            }
        };
        for (i, j, value) in entries {
            rest[i][j] -= &value;
        }
    }
    let left = rest.iter().flatten().map(|entry| entry.to_float().abs()).fold(0.0, f64::max);
    if left > RESIDUAL * scale || !left.is_finite() {
        let eigenvalue = modes.first().map(|mode| R::parts(&mode.frequency()));
        let eigenvalue = eigenvalue.map(|(re, im)| shown(im.to_float().abs(), re.to_float().abs()));
        let direction = String::new();
        return Err(Error::Defective { pairs: names.pairs(), eigenvalue: eigenvalue.unwrap_or_default(), direction });
    }
    Ok(Diagonal { modes, matrix })
}

/// The numbers of a mode in Mᵀ A M.
fn read<R: RealField>(modes: &[Mode<R>], mode: usize, rest: &Matrix<R>) -> Result<(R, R), Error> {
    let half = R::ratio(1, 2).ok_or(Error::DivisionByZero)?;
    let mean = |x: &R, y: &R| {
        let mut sum = x.clone();
        sum += y;
        sum *= &half;
        sum
    };
    let (q, p) = (2 * mode, 2 * mode + 1);
    Ok(match &modes[mode] {
        Mode::Elliptic { .. } => (mean(&rest[q][q], &rest[p][p]), R::zero()),
        Mode::Hyperbolic { .. } => (rest[q][p].clone(), R::zero()),
        Mode::Complex { partner, .. } => {
            let (other, other_p) = (2 * partner, 2 * partner + 1);
            (mean(&rest[q][p], &rest[other][other_p]), mean(&-rest[q][other_p].clone(), &rest[other][p]))
        }
    })
}
