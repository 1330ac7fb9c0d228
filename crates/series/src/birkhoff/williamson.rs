//! The symplectic diagonalization of one block of a quadratic part.
//!
//! Eigenvalues are those of J A in floats; over the rationals each must be one of the fractions near it, which elimination then proves. An eigenvalue
//! of multiplicity m has m null vectors of J A − λ, or a Jordan block, which is an error.
//! The vectors w = a + ib of iω are orthogonalized in the Hermitian form w̄ᵀ J w = 2i aᵀ J b, whose sign is the signature of the centre: it gives ω its sign.
//! Those of λ and −λ are paired. Among floats M is then made symplectic to rounding, M ← M (1 + ½ J E), E = Mᵀ J M − J, and the frequencies are read off
//! Mᵀ A M, where errors of the vectors enter squared.

use super::diagonal::Diagonal;
use super::matrix::{Matrix, dot, null_space, pairing, product, transposed, turned, turned_rows};
use super::mode::{Mode, modulus};
use crate::{Coefficient, Error, RealField};
use num_traits::{One, Zero};

/// Eigenvalues of this size count as zero, and eigenvalues as close as this to an axis lie on it: relative to the largest entry of A, the root of rounding,
/// by which a Jordan block splits.
const ROOT: f64 = 1e-7;
/// Eigenvalues as close as this are one of a higher multiplicity; where they are two, their vectors are told apart to 1e-5 and made symplectic afterwards.
const EQUAL: f64 = 1e-11;
/// What is left off the diagonal of Mᵀ A M by rounding.
const RESIDUAL: f64 = 1e-9;

/// An eigenvalue in the first quadrant, with its multiplicity and its null vectors.
struct Eigenspace<R: RealField> {
    re: R,
    im: R,
    vectors: Vec<Vec<R::Complex>>,
    /// Null vectors of −λ, of saddles and quartets.
    opposite: Vec<Vec<R::Complex>>,
}

/// What an error says about the block.
struct Names<'a> {
    names: &'a dyn Fn(usize) -> String,
    slots: usize,
}

impl Names<'_> {
    fn pairs(&self) -> String {
        let pair = |slot| format!("({}, {})", (self.names)(slot), (self.names)(slot + 1));
        (0..self.slots).step_by(2).map(pair).collect::<Vec<_>>().join(", ")
    }

    /// The largest components of a vector, relative to the largest of all.
    fn direction<R: RealField>(&self, vector: &[R::Complex]) -> String {
        let largest = vector.iter().map(modulus::<R>).fold(0.0, f64::max);
        let part = |(slot, value): (usize, &R::Complex)| {
            let share = modulus::<R>(value) / largest;
            (share > 1e-6).then(|| format!("{} {share:.3}", (self.names)(slot)))
        };
        vector.iter().enumerate().filter_map(part).collect::<Vec<_>>().join(", ")
    }
}

/// The modes of ½ zᵀ A z and M.
pub(crate) fn diagonalized<R: RealField>(a: &Matrix<R>, names: &dyn Fn(usize) -> String) -> Result<Diagonal<R>, Error> {
    let names = Names { names, slots: a.len() };
    let scale = a.iter().flatten().map(|entry| entry.to_float().abs()).fold(0.0, f64::max);
    let motion = turned_rows(a);
    let mut spaces = Vec::new();
    for (re, im, multiplicity) in spectrum(&motion, scale, &names)? {
        spaces.push(eigenspace(&motion, (re, im), multiplicity, scale, &names)?);
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

/// The eigenvalues of J A with Re ≥ 0, Im ≥ 0 and their multiplicities: real ones first, then complex ones, then imaginary ones, by descending size.
fn spectrum<R: RealField>(motion: &Matrix<R>, scale: f64, names: &Names) -> Result<Vec<(f64, f64, usize)>, Error> {
    let n = motion.len();
    let floats = nalgebra::DMatrix::from_fn(n, n, |i, j| motion[i][j].to_float() / scale);
    let not_finite = || Error::NotFinite { what: "quadratic part", term: names.pairs() };
    if scale == 0.0 || floats.iter().any(|entry| !entry.is_finite()) {
        return if scale == 0.0 { Err(zero::<R>(motion, names)) } else { Err(not_finite()) };
    }
    let schur = nalgebra::linalg::Schur::try_new(floats, f64::EPSILON, 10_000).ok_or_else(not_finite)?;
    let mut found: Vec<(f64, f64, usize)> = Vec::new();
    for value in schur.complex_eigenvalues().iter() {
        if value.norm() < ROOT {
            return Err(zero::<R>(motion, names));
        }
        // Each eigenvalue stands for ±λ, ±λ̄: what lies off the axis by less than the root of rounding is on it.
        let re = if value.re.abs() < ROOT { 0.0 } else { value.re.abs() };
        let im = if value.im.abs() < ROOT { 0.0 } else { value.im.abs() };
        let weight = if re > 0.0 && im > 0.0 { 1 } else { 2 };
        let known = found.iter_mut().find(|known| (known.0 - re).hypot(known.1 - im) < known_radius(value, re, im));
        match known {
            Some(known) => known.2 += weight,
            None => found.push((re, im, weight)),
        }
    }
    let rank = |(re, im, _): &(f64, f64, usize)| {
        if *im == 0.0 {
            0
        } else if *re > 0.0 {
            1
        } else {
            2
        }
    };
    found.sort_by(|a, b| rank(a).cmp(&rank(b)).then((b.0.hypot(b.1)).total_cmp(&a.0.hypot(a.1))));
    // Counted four times: ±λ, ±λ̄, or two of them twice.
    Ok(found.into_iter().map(|(re, im, count)| (re * scale, im * scale, count.div_ceil(4))).collect())
}

/// How far apart two computed values of one eigenvalue can lie: by the root of rounding where they were off the axis, else by rounding.
fn known_radius(value: &nalgebra::Complex<f64>, re: f64, im: f64) -> f64 {
    let moved = (value.re.abs() - re).abs().max((value.im.abs() - im).abs());
    if moved > EQUAL { ROOT } else { EQUAL }
}

fn zero<R: RealField>(motion: &Matrix<R>, names: &Names) -> Error {
    let nulls =
        |dimension| null_space::<R>(complexified(motion, &R::complex(R::zero(), R::zero())), dimension, f64::INFINITY);
    let vectors = (1..=motion.len()).find_map(nulls).unwrap_or_default();
    let direction = vectors.first().map(|vector| names.direction::<R>(vector)).unwrap_or_default();
    Error::ZeroFrequency { pairs: names.pairs(), direction }
}

/// J A − λ.
fn complexified<R: RealField>(motion: &Matrix<R>, eigenvalue: &R::Complex) -> Matrix<R::Complex> {
    let complex = |i: usize, j: usize| {
        let mut entry = R::complex(motion[i][j].clone(), R::zero());
        if i == j {
            entry -= eigenvalue;
        }
        entry
    };
    (0..motion.len()).map(|i| (0..motion.len()).map(|j| complex(i, j)).collect()).collect()
}

/// The null vectors of λ and of −λ.
fn eigenspace<R: RealField>(
    motion: &Matrix<R>,
    (re, im): (f64, f64),
    multiplicity: usize,
    scale: f64,
    names: &Names,
) -> Result<Eigenspace<R>, Error> {
    let candidates = |value: f64| {
        let near = |candidate: &R| (candidate.to_float() - value).abs() < 1e-9 * scale;
        if value == 0.0 { vec![R::zero()] } else { R::candidates(value).into_iter().filter(near).collect() }
    };
    let defective = |vector: Option<&Vec<R::Complex>>| Error::Defective {
        pairs: names.pairs(),
        eigenvalue: shown(re, im),
        direction: vector.map(|vector| names.direction::<R>(vector)).unwrap_or_default(),
    };
    let nulls = |re: &R, im: &R, dimension| {
        null_space::<R>(complexified(motion, &R::complex(re.clone(), im.clone())), dimension, ROOT * scale)
    };
    for (a, b) in candidates(re).iter().flat_map(|a| candidates(im).into_iter().map(move |b| (a.clone(), b))) {
        if let Some(vectors) = nulls(&a, &b, multiplicity) {
            let opposite = if re == 0.0 { None } else { nulls(&-a.clone(), &-b.clone(), multiplicity) };
            if re > 0.0 && opposite.is_none() {
                return Err(defective(vectors.first()));
            }
            return Ok(Eigenspace { re: a, im: b, vectors, opposite: opposite.unwrap_or_default() });
        }
        // Fewer vectors than the multiplicity.
        for fewer in (1..multiplicity).rev() {
            if let Some(vectors) = nulls(&a, &b, fewer) {
                return Err(defective(vectors.first()));
            }
        }
    }
    if R::EPSILON > 0.0 {
        return Err(defective(None));
    }
    Err(Error::SpectrumIrrational { pairs: names.pairs(), eigenvalue: shown(re, im) })
}

fn shown(re: f64, im: f64) -> String {
    match (re > 0.0, im > 0.0) {
        (true, true) => format!("±{re:.9} ± {im:.9}i"),
        (true, false) => format!("±{re:.9}"),
        _ => format!("±{im:.9}i"),
    }
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

/// vector − factor · other.
fn less<C: Coefficient>(vector: &mut [C], other: &[C], factor: &C) {
    for (entry, other) in vector.iter_mut().zip(other) {
        let mut product = factor.clone();
        product *= other;
        *entry -= &product;
    }
}

/// The vector turned so that its largest coordinate q is real and positive (of equal ones the first).
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

/// The norm w̄ᵀ J w / (2i) = aᵀ J b of w = a + ib, and whether it is too small beside |w|².
fn norm<R: RealField>(vector: &[R::Complex]) -> (R, bool) {
    let (a, b) = parts::<R>(vector);
    let (norm, size) = (pairing(&a, &b), vector.iter().map(|value| modulus::<R>(value).powi(2)).sum::<f64>());
    let small = norm.is_zero() || (R::EPSILON > 0.0 && norm.to_float().abs() < ROOT * size);
    (norm, small)
}

/// One centre for each vector of iω: q along a, p along b/(aᵀJb), with the sign of aᵀJb for ω.
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

/// Takes a vector with a norm out of those that are left: the one of largest norm, or a sum of two.
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

/// The vectors of −λ combined so that vᵢᵀ J wⱼ = δᵢⱼ with those of λ.
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

/// Among floats v and w are given the same length.
fn balanced<R: RealField>(v: Vec<R::Complex>, w: Vec<R::Complex>) -> Result<[Vec<R::Complex>; 2], Error> {
    if R::EPSILON == 0.0 {
        return Ok([v, w]);
    }
    let length = |vector: &[R::Complex]| vector.iter().map(|value| modulus::<R>(value).powi(2)).sum::<f64>();
    let factor = (length(&w) / length(&v)).powf(0.25);
    let [up, down] = [factor, factor.recip()].map(|factor| R::candidates(factor).pop());
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

/// z = v u + w U + conjugates with u = (q − iQ)/2, U = p + iP.
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

/// M made symplectic to rounding.
fn symplectic<R: RealField>(mut matrix: Matrix<R>) -> Matrix<R> {
    let Some(half) = R::ratio(1, 2).filter(|_| R::EPSILON > 0.0) else { return matrix };
    for _ in 0..3 {
        let columns = transposed(&matrix);
        let forms: Matrix<R> = columns.iter().map(|column| turned(column)).collect();
        let error = |i: usize, j: usize| {
            let mut error = dot(&columns[i], &forms[j]);
            let expected = i64::from(i % 2 == 0 && j == i + 1) - i64::from(j % 2 == 0 && i == j + 1);
            error -= &R::integer(expected);
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

/// The modes with the frequencies of Mᵀ A M, which must be diagonal.
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
    let half = R::ratio(1, 2).ok_or(Error::DivisionByZero)?;
    let mut rest = product(&transposed(&matrix), &product(a, &matrix));
    let mean = |x: &R, y: &R| {
        let mut sum = x.clone();
        sum += y;
        sum *= &half;
        sum
    };
    let read: Vec<(R, R)> = modes
        .iter()
        .enumerate()
        .map(|(mode, kind)| {
            let (q, p) = (2 * mode, 2 * mode + 1);
            match kind {
                Mode::Elliptic { .. } => (mean(&rest[q][q], &rest[p][p]), R::zero()),
                Mode::Hyperbolic { .. } => (rest[q][p].clone(), R::zero()),
                Mode::Complex { partner, .. } => (
                    mean(&rest[q][p], &rest[2 * partner][2 * partner + 1]),
                    mean(&-rest[q][2 * partner + 1].clone(), &rest[2 * partner][p]),
                ),
            }
        })
        .collect();
    for (mode, (kind, (first, second))) in modes.iter_mut().zip(read).enumerate() {
        let (q, p) = (2 * mode, 2 * mode + 1);
        let mut clear = |i: usize, j: usize, value: &R| rest[i][j] -= value;
        match kind {
            Mode::Elliptic { frequency, .. } => {
                clear(q, q, &first);
                clear(p, p, &first);
                *frequency = first;
            }
            Mode::Hyperbolic { rate } => {
                clear(q, p, &first);
                clear(p, q, &first);
                *rate = first;
            }
            Mode::Complex { rate, frequency, partner } => {
                clear(q, p, &first);
                clear(p, q, &first);
                let other = 2 * *partner + 1;
                clear(q, other, &-second.clone());
                clear(other, q, &-second.clone());
                (*rate, *frequency) = (first, second);
            }
        }
    }
    let left = rest.iter().flatten().map(|entry| entry.to_float().abs()).fold(0.0, f64::max);
    if left > RESIDUAL * scale || !left.is_finite() {
        let eigenvalue = modes
            .first()
            .map(|mode| R::parts(&mode.frequency()))
            .map(|(re, im)| shown(im.to_float().abs(), re.to_float().abs()));
        return Err(Error::Defective {
            pairs: names.pairs(),
            eigenvalue: eigenvalue.unwrap_or_default(),
            direction: String::new(),
        });
    }
    Ok(Diagonal { modes, matrix })
}
