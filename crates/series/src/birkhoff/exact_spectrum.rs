//! The eigenvalues of a Hamiltonian matrix over the rationals, without floats.
//!
//! det(λ − J A) of the matrix with its denominators cleared (Faddeev and LeVerrier) is a monic polynomial in μ = λ² with integer coefficients. Its square-free
//! factors carry the multiplicities. A rational λ or iλ is an integer then, the parts of a λ = a + ib with rational parts are integers, and μ is a Gaussian
//! integer. A float has an eigenvalue of multiplicity m only to the m-th root of rounding, so that no fraction near it is the right one.

use super::matrix::Matrix;
use super::univariate::{Root, Univariate, roots};
use num_bigint::BigInt;
use num_complex::Complex;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, ToPrimitive, Zero};

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
    let squares: Vec<_> = characteristic(&integers).into_iter().step_by(2).map(BigRational::from_integer).collect();
    if squares[0].is_zero() {
        return Err(Refusal::Zero);
    }
    let mut found = Vec::new();
    for (part, multiplicity) in Univariate::new(squares).square_free() {
        let roots = lambdas(part).map_err(|square| {
            // λ² of the matrix itself, which is a float where its square is none.
            let unit = &denominator * &denominator;
            let [re, im] = [square.re, square.im].map(|part| (part / &unit).to_f64().unwrap_or(f64::MAX));
            let root = Complex::new(re, im).sqrt();
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

/// λ = a + ib in the first quadrant for each root λ² of a square-free factor, one of each conjugate pair; or an irrational λ².
fn lambdas(squares: Vec<BigInt>) -> Result<Vec<(BigInt, BigInt)>, Box<Complex<BigRational>>> {
    let lambda = |root: Root| {
        let square = match root {
            Root::Gaussian(square) => square,
            Root::Irrational(square) => return Err(Box::new(square)),
        };
        // (a + ib)² = x + iy: a² = (|μ| + x)/2, b² = (|μ| − x)/2.
        let irrational = || Box::new(Complex::new(square.re.clone().into(), square.im.clone().into()));
        let modulus = exact_root(&square.norm_sqr()).ok_or_else(irrational)?;
        let part = |twice: BigInt| {
            let (half, odd) = twice.div_rem(&2.into());
            exact_root(&half).filter(|_| odd.is_zero()).ok_or_else(irrational)
        };
        Ok((part(&modulus + &square.re)?, part(&modulus - &square.re)?))
    };
    roots(squares).into_iter().map(lambda).collect()
}

/// √n of a square n ≥ 0.
fn exact_root(n: &BigInt) -> Option<BigInt> {
    let root = n.sqrt();
    (&root * &root == *n).then_some(root)
}
