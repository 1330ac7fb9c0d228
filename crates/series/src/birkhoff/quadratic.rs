//! The quadratic part of a Hamiltonian, and the linear symplectic change of variables that diagonalizes it.
//!
//! H₂ = ½ zᵀ A z with z = (q₁, p₁, q₂, …) has the linear motion ż = J A z. If J A can be diagonalized and has no eigenvalue 0, there is a real symplectic M, Mᵀ
//! J M = J, such that z = M z′ turns H₂ into a sum of the modes of [`Mode`](super::mode): centres, saddles and quartets (Williamson).
//!
//! Pairs that no product couples are separate blocks. A pair that already is a centre (a p² + b q²)/2 does not change. In any other block the modes are
//! ordered: saddles by descending rate, then quartets, then centres by descending |ω|. They take the places of the pairs of the block. Before eigenvalues are
//! compared, A is scaled by powers of two, q → s q, p → p/s, so that units have no effect.

use super::PhaseSpace;
use super::diagonal::Diagonal;
use super::matrix::{Matrix, product, symplectic_inverse, transposed, unit};
use super::mode::Mode;
use super::williamson;
use crate::error::Error;
use crate::monomial::{Monomial, SLOTS};
use crate::polynomial::Polynomial;
use crate::real_field::RealField;

impl<R: RealField> Diagonal<R> {
    /// The modes of the quadratic part of `hamiltonian`, after a check of all terms.
    pub(crate) fn of(hamiltonian: &Polynomial<R>, space: &PhaseSpace) -> Result<Self, Error> {
        check(hamiltonian, space)?;
        let second = matrix(hamiltonian, space)?;
        let n = space.degrees_of_freedom();
        let mut modes = vec![None; n];
        let mut change = unit::<R>(2 * n);
        for pairs in blocks(&second) {
            let slots: Vec<usize> = pairs.iter().flat_map(|pair| [2 * pair, 2 * pair + 1]).collect();
            let block = slots.iter().map(|&i| slots.iter().map(|&j| second[i][j].clone()).collect()).collect();
            let names = |slot: usize| space.names()[slots[slot]].to_owned();
            if let Some(mode) = centre(&block, &names)? {
                modes[pairs[0]] = Some(mode);
                continue;
            }
            let explained = |error| explained(error, hamiltonian, space, &slots);
            let Diagonal { modes: found, matrix } = scaled(&block, &names).map_err(explained)?;
            for (mode, &pair) in found.into_iter().zip(&pairs) {
                modes[pair] = Some(match mode {
                    Mode::Complex { rate, frequency, partner } => {
                        Mode::Complex { rate, frequency, partner: pairs[partner] }
                    }
                    other => other,
                });
            }
            for (row, &i) in matrix.into_iter().zip(&slots) {
                for (entry, &j) in row.into_iter().zip(&slots) {
                    change[i][j] = entry;
                }
            }
        }
        Ok(Diagonal { modes: modes.into_iter().flatten().collect(), matrix: change })
    }

    /// The old variables as linear forms in the new ones, or `None` if they are equal.
    pub(crate) fn forms(&self) -> Result<Option<Vec<Polynomial<R>>>, Error> {
        forms(&self.matrix)
    }

    /// The new variables as linear forms in the old ones, or `None` if they are equal.
    pub(crate) fn inverse_forms(&self) -> Result<Option<Vec<Polynomial<R>>>, Error> {
        forms(&symplectic_inverse(&self.matrix))
    }
}

/// Replaces the error of a zero frequency if a term with a parameter in the block could make the frequency nonzero.
fn explained<R: RealField>(error: Error, hamiltonian: &Polynomial<R>, space: &PhaseSpace, slots: &[usize]) -> Error {
    let phase = space.phase_slots();
    let in_block = |m: Monomial| {
        m.degree_in(slots) == 2 && m.degree_in(&phase) == 2 && m.total_degree() > 2 && !space.is_driven(m)
    };
    match (error, hamiltonian.terms().find(|&(monomial, _)| in_block(monomial))) {
        (Error::ZeroFrequency { pairs, .. }, Some((monomial, c))) => {
            let term = space.text(&Polynomial::from_terms([(monomial, c.clone())]), &space.owned_names());
            Error::FrequencyParameter { pairs, term }
        }
        (error, _) => error,
    }
}

fn forms<R: RealField>(matrix: &Matrix<R>) -> Result<Option<Vec<Polynomial<R>>>, Error> {
    if *matrix == unit(matrix.len()) {
        return Ok(None);
    }
    let form = |row: &Vec<R>| {
        let terms = row.iter().enumerate().map(|(slot, c)| Ok((Monomial::ONE.with(slot, 1)?, c.clone())));
        Ok(Polynomial::from_terms(terms.collect::<Result<Vec<_>, Error>>()?))
    };
    matrix.iter().map(form).collect::<Result<Vec<_>, Error>>().map(Some)
}

/// Refuses a Hamiltonian whose quadratic part does not have numbers as coefficients: NaN, variables of another space, linear terms, parameters of degree 0.
fn check<R: RealField>(hamiltonian: &Polynomial<R>, space: &PhaseSpace) -> Result<(), Error> {
    for (monomial, c) in hamiltonian.terms() {
        let unknown = (space.driven_slots().end..SLOTS).find(|&slot| monomial.exponent(slot) > 0);
        if let Some(slot) = unknown {
            return Err(Error::ValueMissing { slot, given: space.driven_slots().end });
        }
        let term = || space.text(&Polynomial::from_terms([(monomial, 1.0)]), &space.owned_names());
        if !c.is_finite() {
            return Err(Error::NotFinite { what: "Hamiltonian", term: format!("{} {}", literal(c), term()) });
        }
        // A driven term belongs to order 1 at least, or is a force.
        if space.is_driven(monomial) {
            continue;
        }
        let (degree, phase) = (space.degree(monomial), monomial.degree_in(&space.phase_slots()));
        match (phase, degree) {
            (1, 1) => return Err(Error::LinearTerm { term: term(), coefficient: literal(c) }),
            (1, 2) => return Err(Error::ParameterDegree { term: term(), bound: 2 }),
            (2, 2) if monomial.total_degree() != 2 => return Err(Error::ParameterDegree { term: term(), bound: 1 }),
            _ => {}
        }
    }
    Ok(())
}

/// The matrix A of the quadratic terms without parameters.
fn matrix<R: RealField>(hamiltonian: &Polynomial<R>, space: &PhaseSpace) -> Result<Matrix<R>, Error> {
    let n = 2 * space.degrees_of_freedom();
    let entry = |i: usize, j: usize| {
        let monomial = Monomial::ONE.with(i, 1)?;
        let monomial = monomial.with(j, monomial.exponent(j) + 1)?;
        let c = hamiltonian.coefficient(&monomial).cloned().unwrap_or_else(R::zero);
        Ok(if i == j { c.times(2) } else { c })
    };
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// The sets of pairs that A couples, in ascending order.
fn blocks<R: RealField>(second: &Matrix<R>) -> Vec<Vec<usize>> {
    let n = second.len() / 2;
    let coupled = |i: usize, j: usize| {
        [(0, 0), (0, 1), (1, 0), (1, 1)].iter().any(|(a, b)| !second[2 * i + a][2 * j + b].is_zero())
    };
    let mut label: Vec<usize> = (0..n).collect();
    for (i, j) in (0..n).flat_map(|i| (0..i).map(move |j| (i, j))) {
        if coupled(i, j) && label[i] != label[j] {
            let (keep, drop) = (label[i].min(label[j]), label[i].max(label[j]));
            label.iter_mut().filter(|label| **label == drop).for_each(|label| *label = keep);
        }
    }
    let block = |first: usize| (0..n).filter(|&pair| label[pair] == first).collect::<Vec<_>>();
    (0..n).map(block).filter(|block| !block.is_empty()).collect()
}

/// The mode of a block that already is one centre (a p² + b q²)/2.
fn centre<R: RealField>(block: &Matrix<R>, names: &dyn Fn(usize) -> String) -> Result<Option<Mode<R>>, Error> {
    if block.len() != 2 || !block[0][1].is_zero() || block[0][0].sign() * block[1][1].sign() != 1 {
        return Ok(None);
    }
    let (b, a) = (&block[0][0], &block[1][1]);
    let Some(root) = a.geometric_mean(b) else {
        let mut square = a.clone();
        square *= b;
        let (coordinate, momentum) = (names(0), names(1));
        return Err(Error::FrequencyIrrational { coordinate, momentum, square: literal(&square) });
    };
    let frequency = root.times(a.sign().into());
    let ratio = frequency.divide(b).ok_or(Error::DivisionByZero)?;
    if !frequency.is_finite() || !ratio.is_finite() || ratio.is_zero() {
        return Err(Error::NotFinite { what: "frequency", term: names(0) });
    }
    Ok(Some(Mode::Elliptic { frequency, ratio }))
}

/// The modes of a block after a change of units: z = D z′, D = diag(s₁, 1/s₁, s₂, …) of powers of two.
fn scaled<R: RealField>(block: &Matrix<R>, names: &dyn Fn(usize) -> String) -> Result<Diagonal<R>, Error> {
    let power = |exponent: i32| {
        let one = R::one();
        let times = |value: R, _| if exponent > 0 { Some(value.times(2)) } else { value.over(2) };
        (0..exponent.unsigned_abs()).try_fold(one, times).ok_or(Error::DivisionByZero)
    };
    let exponents = scales(block);
    let mut units = unit::<R>(block.len());
    for (pair, &exponent) in exponents.iter().enumerate() {
        units[2 * pair][2 * pair] = power(exponent)?;
        units[2 * pair + 1][2 * pair + 1] = power(-exponent)?;
    }
    let balanced = product(&product(&transposed(&units), block), &units);
    let Diagonal { modes, matrix } = williamson::diagonalized(&balanced, names)?;
    Ok(Diagonal { modes, matrix: product(&units, &matrix) })
}

/// The powers of two that make the rows of q and of p about equal in size.
fn scales<R: RealField>(block: &Matrix<R>) -> Vec<i32> {
    let mut exponents = vec![0; block.len() / 2];
    let size = |i: usize, j: usize, exponents: &[i32]| {
        let unit = |slot: usize| if slot.is_multiple_of(2) { exponents[slot / 2] } else { -exponents[slot / 2] };
        block[i][j].to_float().abs() * 2.0_f64.powi(unit(i) + unit(j))
    };
    for _ in 0..8 {
        for pair in 0..exponents.len() {
            let row = |slot: usize| {
                (0..block.len()).filter(|&j| j != (slot ^ 1)).map(|j| size(slot, j, &exponents)).sum::<f64>()
            };
            let (coordinate, momentum) = (row(2 * pair), row(2 * pair + 1));
            if coordinate > 0.0 && momentum > 0.0 && (momentum / coordinate).is_normal() {
                exponents[pair] += ((momentum / coordinate).log2() / 4.0).round() as i32;
            }
        }
    }
    exponents
}

/// A coefficient with its sign.
pub(crate) fn literal<R: RealField>(c: &R) -> String {
    let (negative, magnitude) = c.literal();
    format!("{}{magnitude}", if negative { "-" } else { "" })
}
