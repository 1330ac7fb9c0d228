//! The eigenvalues of a Hamiltonian matrix over the rationals, without floats.
//!
//! det(λ − J A) of the matrix with its denominators cleared (Faddeev and LeVerrier) is a monic polynomial q in μ = λ² with integer coefficients. Its square-free
//! factors carry the multiplicities. A rational λ or iλ is an integer then, and the parts of a λ = a + ib with rational parts are integers. So μ is an integer,
//! found among the real roots, or μ = x + iy with integers x and y: 2x is an integer root of the polynomial of the sums of pairs of roots, and −y² is a common
//! root of the even and the odd part of q(x + ·). A float has an eigenvalue of multiplicity m only to the m-th root of rounding, so that no fraction near it is
//! the right one.

use super::matrix::Matrix;
use super::schur::eigenvalues as float_eigenvalues;
use super::univariate::{RealRoot, Univariate};
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// An eigenvalue a + ib in the first quadrant, a ≥ 0 and b ≥ 0, with its multiplicity.
pub(super) type Eigenvalue<R> = (R, R, usize);

/// Why a spectrum has no form over the rationals.
pub(super) enum Refusal {
    Zero,
    /// One of the irrational eigenvalues: real part, imaginary part.
    Irrational(f64, f64),
}

/// The eigenvalues of J A in the first quadrant.
pub(super) fn eigenvalues(motion: &Matrix<BigRational>) -> Result<Vec<Eigenvalue<BigRational>>, Refusal> {
    let denominator = motion.iter().flatten().fold(BigInt::one(), |lcm, entry| lcm.lcm(entry.denom()));
    let whole = |entry: &BigRational| entry.numer() * (&denominator / entry.denom());
    let integers = motion.iter().map(|row| row.iter().map(whole).collect()).collect();
    let squares = characteristic(&integers).into_iter().step_by(2).map(BigRational::from_integer).collect();
    let squares = Univariate::new(squares);
    if squares.coefficients()[0].is_zero() {
        return Err(Refusal::Zero);
    }
    let mut found = Vec::new();
    for (part, multiplicity) in squares.square_free() {
        let roots = roots(&part).map_err(|(re, im)| {
            let scale = denominator.to_f64().unwrap_or(f64::INFINITY);
            let root = nalgebra::Complex::new(re, im).sqrt() / scale;
            Refusal::Irrational(root.re.abs(), root.im.abs())
        })?;
        let fraction = |n| BigRational::new(n, denominator.clone());
        found.extend(roots.into_iter().map(|(a, b)| (fraction(a), fraction(b), multiplicity)));
    }
    Ok(found)
}

/// The coefficients of det(λ − M) by ascending powers.
fn characteristic(matrix: &Matrix<BigInt>) -> Vec<BigInt> {
    let n = matrix.len();
    let mut descending = vec![BigInt::one()];
    let mut adjugate: Matrix<BigInt> =
        (0..n).map(|i| (0..n).map(|j| BigInt::from(i32::from(i == j))).collect()).collect();
    for k in 1..=n {
        let entry = |i: usize, j: usize| (0..n).map(|l| &matrix[i][l] * &adjugate[l][j]).sum::<BigInt>();
        let mut product: Matrix<BigInt> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
        let c = -(0..n).map(|i| &product[i][i]).sum::<BigInt>() / BigInt::from(k);
        (0..n).for_each(|i| product[i][i] += &c);
        adjugate = product;
        descending.push(c);
    }
    descending.reverse();
    descending
}

/// λ = a + ib in the first quadrant for each root λ² of a square-free factor, one of each conjugate pair; or an irrational λ², as floats.
fn roots(squares: &Univariate) -> Result<Vec<(BigInt, BigInt)>, (f64, f64)> {
    let mut found = Vec::new();
    let mut rest = squares.clone();
    for root in squares.real_roots() {
        let square = match root {
            RealRoot::Integer(square) => square,
            RealRoot::Irrational(square) => return Err((square, 0.0)),
        };
        let size = exact_root(&square.abs()).ok_or_else(|| (float(&square), 0.0))?;
        rest = rest.quotient(&Univariate::factor(&square));
        found.push(if square.is_positive() { (size, BigInt::zero()) } else { (BigInt::zero(), size) });
    }
    for (x, y) in gaussian_pairs(&rest) {
        rest = rest.quotient(&Univariate::new(
            [&x * &x + &y * &y, -2 * &x, BigInt::one()].map(BigRational::from_integer).into(),
        ));
        // (a + ib)² = x + iy: a² = (|μ| + x)/2, b = y/(2a).
        let irrational = || (float(&x), float(&y));
        let modulus = exact_root(&(&x * &x + &y * &y)).ok_or_else(irrational)?;
        let [a, b] = [&modulus + &x, &modulus - &x].map(|twice| {
            let (half, odd) = twice.div_rem(&2.into());
            exact_root(&half).filter(|_| odd.is_zero())
        });
        found.push((a.ok_or_else(irrational)?, b.ok_or_else(irrational)?));
    }
    if rest.degree() > 0 { Err(complex_figure(&rest)) } else { Ok(found) }
}

/// The pairs of roots x ± iy, y > 0, with integers x and y, of a polynomial without real roots.
fn gaussian_pairs(squares: &Univariate) -> Vec<(BigInt, BigInt)> {
    if squares.degree() == 0 {
        return Vec::new();
    }
    let sums = squares.sums_of_pairs().square_free();
    let sums = sums.iter().flat_map(|(part, _)| part.real_roots());
    let halves = sums.filter_map(|sum| match sum {
        RealRoot::Integer(sum) => sum.is_even().then(|| sum / 2),
        RealRoot::Irrational(_) => None,
    });
    let pairs = halves.flat_map(|x| {
        let (even, odd) = squares.even_and_odd(&x);
        let roots = even.gcd(&odd).square_free().into_iter().flat_map(|(part, _)| part.real_roots());
        let height = |root| match root {
            RealRoot::Integer(square) if square.is_negative() => exact_root(&-square),
            _ => None,
        };
        roots.filter_map(height).map(|y| (x.clone(), y)).collect::<Vec<_>>()
    });
    pairs.collect()
}

/// √n of a square n ≥ 0.
fn exact_root(n: &BigInt) -> Option<BigInt> {
    let root = n.sqrt();
    (&root * &root == *n).then_some(root)
}

fn float(n: &BigInt) -> f64 {
    n.to_f64().unwrap_or(f64::INFINITY)
}

/// A complex root of a square-free polynomial in floats, from its companion matrix with x = s x′, s the size of the roots.
fn complex_figure(squares: &Univariate) -> (f64, f64) {
    let degree = squares.degree();
    let coefficients: Vec<f64> = squares.coefficients().iter().map(|c| c.to_f64().unwrap_or(f64::INFINITY)).collect();
    let size = (1..=degree).map(|k| coefficients[degree - k].abs().powf(1.0 / k as f64)).fold(0.0, f64::max);
    let companion = nalgebra::DMatrix::from_fn(degree, degree, |i, j| match j + 1 == degree {
        true => -coefficients[i] / size.powi((degree - i) as i32),
        false => f64::from(u8::from(i == j + 1)),
    });
    let roots = float_eigenvalues(&companion).unwrap_or_default();
    roots.first().map_or((f64::NAN, f64::NAN), |root| (root.re * size, root.im * size))
}
