//! Driven phases: z = e^{iM} with Ṁ given, and no momentum.
//!
//! A term of order n is u^a U^b z^j with j of either sign. Exponents are unsigned, so the slot of z holds j + s n, with one `stride` s for a whole
//! Hamiltonian and |j| ≤ s n. Orders add in every bracket of Deprit's triangle, {f_n; T_m} is of order n + m, hence the exponents s n add as well, and products
//! need no change. In the extended phase space h₀ + Ṁ Λ, and no generator contains Λ. With ż = ρ z, the eigenvalue of S → {h₀ + Ṁ Λ; S} is Σ λᵢ (kᵢ − jᵢ) − ρ j.

use crate::coefficient::Coefficient;
use crate::error::Error;
use crate::homological::Homological;
use crate::monomial::Monomial;
use crate::monomial::check_slot;
use crate::polynomial::Polynomial;
use crate::triangle::{Normalization, Progress, Removal, normalize_by};

/// Driven phases: the slot of z = e^{iM} and ρ in ż = ρ z for each, and the stride s of their exponents.
#[derive(Debug, Clone, PartialEq)]
pub struct Driven<C> {
    phases: Vec<(usize, C)>,
    stride: u32,
}

impl<C: Coefficient> Driven<C> {
    /// The phases (slot of z, ρ). A term of order n may have |j| ≤ `stride` n.
    ///
    /// # Errors
    /// - slot 8: [`Error::SlotOutOfRange`]; one slot for two phases: [`Error::SlotRepeated`].
    pub fn new(phases: &[(usize, C)], stride: u32) -> Result<Self, Error> {
        for (index, &(slot, _)) in phases.iter().enumerate() {
            check_slot(slot)?;
            if phases[..index].iter().any(|&(other, _)| other == slot) {
                return Err(Error::SlotRepeated { slot });
            }
        }
        Ok(Driven { phases: phases.to_vec(), stride })
    }

    /// `monomial` times z^j, one j for each phase, as a term of order `order`.
    ///
    /// # Errors
    /// - |j| above `stride` · `order`, or an exponent above the largest: [`Error::ExponentOverflow`].
    pub fn raise(&self, monomial: Monomial, order: u32, j: &[i32]) -> Result<Monomial, Error> {
        self.phases.iter().zip(j).try_fold(monomial, |raised, (&(slot, _), &j)| {
            let zero = u64::from(self.stride) * u64::from(order);
            let exponent = u64::from(j.unsigned_abs());
            let overflow = Error::ExponentOverflow { slot, exponent, bound: zero.min(u32::MAX.into()) as u32 };
            let stored = (zero as i128) + i128::from(j);
            let stored = u32::try_from(stored).map_err(|_| overflow.clone())?;
            if exponent > zero { Err(overflow) } else { raised.with(slot, stored) }
        })
    }

    /// The exponents j of a term of order `order`.
    #[must_use]
    pub fn harmonics(&self, monomial: Monomial, order: usize) -> Vec<i64> {
        let zero = i64::from(self.stride) * order as i64;
        self.phases.iter().map(|&(slot, _)| i64::from(monomial.exponent(slot)) - zero).collect()
    }

    /// The eigenvalue Σ λᵢ (kᵢ − jᵢ) − ρ j of S → {h₀ + Ṁ Λ; S} for a term of order `order`.
    #[must_use]
    pub fn eigenvalue(&self, homological: &Homological<C>, monomial: Monomial, order: usize) -> C {
        let mut sum = homological.eigenvalue(monomial);
        for ((_, rate), j) in self.phases.iter().zip(self.harmonics(monomial, order)) {
            sum += &rate.times(-j);
        }
        sum
    }
}

/// Normalizes H = Σ εⁿ `hamiltonian[n]`, in which the phases of `driven` occur, as [`deprit_triangle`](crate::lie::deprit_triangle) does without them.
///
/// A term is kept if its eigenvalue is exactly 0. [`Driven::raise`] gives the terms of `hamiltonian[n]`, of order n. Missing coefficients are 0.
///
/// # Errors
/// - `hamiltonian[0]` that is not the quadratic part of `homological`: [`Error::UnperturbedMismatch`];
/// - a callback that returns `Break`: [`Error::Interrupted`];
/// - exponents that outgrow the packed ones: [`Error::ExponentOverflow`].
pub fn driven_triangle<C: Coefficient>(
    hamiltonian: &[Polynomial<C>],
    homological: &Homological<C>,
    driven: &Driven<C>,
    poisson: &crate::bracket::Poisson,
    order: usize,
    progress: &mut Progress<'_>,
) -> Result<Normalization<C>, Error> {
    if hamiltonian.first() != Some(&homological.unperturbed()?) {
        return Err(Error::UnperturbedMismatch { terms: hamiltonian.first().map_or(0, Polynomial::len) });
    }
    let solve = |n, known: &Polynomial<C>| {
        let mut removal = Removal { image: Polynomial::zero(), solution: Polynomial::zero() };
        for (monomial, c) in known.terms() {
            let divisor = -driven.eigenvalue(homological, monomial, n);
            if divisor.is_zero() {
                continue;
            }
            let quotient = c.divide(&divisor).ok_or(Error::DivisionByZero)?;
            removal.image.add_term(monomial, c);
            removal.solution.add_term(monomial, &quotient);
        }
        Ok(removal)
    };
    normalize_by(hamiltonian, poisson, order, &solve, progress)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lie::Poisson;
    use crate::progress::quiet;
    use num_complex::Complex;

    /// Mathieu's equation x″ + (a − 2 q cos 2t) x = 0 with a = ω² in x = (u + i U)/√(2ω), z = e^{i t / `fraction`}: K.
    fn mathieu(omega: f64, q: f64, fraction: i32, order: usize) -> Result<Vec<Polynomial<Complex<f64>>>, Error> {
        let rate = Complex::new(0.0, 1.0 / f64::from(fraction));
        let driven = Driven::new(&[(2, rate)], 2 * fraction as u32)?;
        let homological = Homological::new(&[(0, 1, Complex::new(0.0, omega))])?;
        let mut forcing = Polynomial::zero();
        for j in [-2 * fraction, 2 * fraction] {
            for (exponents, c) in [([2, 0], (1.0, 0.0)), ([1, 1], (0.0, 2.0)), ([0, 2], (-1.0, 0.0))] {
                let monomial = driven.raise(Monomial::new(&exponents)?, 1, &[j])?;
                forcing.add_term(monomial, &(Complex::new(c.0, c.1) * (-q / (4.0 * omega))));
            }
        }
        let series = [homological.unperturbed()?, forcing];
        let poisson = Poisson::new(&[(0, 1)])?;
        Ok(driven_triangle(&series, &homological, &driven, &poisson, order, &mut quiet)?.hamiltonian)
    }

    /// The characteristic exponent ν: K = i ν u U.
    fn exponent(hamiltonian: &[Polynomial<Complex<f64>>]) -> f64 {
        hamiltonian.iter().flat_map(Polynomial::terms).map(|(_, c)| c.im).sum()
    }

    #[test]
    fn the_exponent_of_mathieu_is_that_of_dlmf_28_15_1() -> Result<(), Error> {
        for (omega, q) in [(0.3_f64, 0.01), (0.5, 0.01), (1.4, 0.01), (2.5, 0.02)] {
            let hamiltonian = mathieu(omega, q, 1, 6)?;
            let terms: Vec<_> = hamiltonian.iter().map(Polynomial::len).collect();
            assert_eq!(terms, [1, 0, 1, 0, 1, 0, 1], "{omega}");
            let n = exponent(&hamiltonian).powi(2);
            let a = n
                + q.powi(2) / (2.0 * (n - 1.0))
                + (5.0 * n + 7.0) * q.powi(4) / (32.0 * (n - 1.0).powi(3) * (n - 4.0))
                + (9.0 * n * n + 58.0 * n + 29.0) * q.powi(6) / (64.0 * (n - 1.0).powi(5) * (n - 4.0) * (n - 9.0));
            assert!((a - omega * omega).abs() < 2e-14, "{omega}: {a}");
        }
        Ok(())
    }

    #[test]
    fn a_half_phase_gives_the_same_exponent() -> Result<(), Error> {
        let (whole, half) = (exponent(&mathieu(0.3, 0.1, 1, 12)?), exponent(&mathieu(0.3, 0.1, 2, 12)?));
        assert!((whole - half).abs() < 1e-15, "{whole} {half}");
        Ok(())
    }

    #[test]
    fn the_orders_converge_to_the_root_of_hills_determinant() -> Result<(), Error> {
        // The root for a = 0.09, q = 0.1 of Hill's determinant with 29 rows, by mpmath with 20 digits.
        let error = |order| mathieu(0.3, 0.1, 1, order).map(|h| (exponent(&h) - 0.309_063_060_648_002_24).abs());
        let errors = [error(2)?, error(6)?, error(20)?];
        assert!(errors[0] > 1e-6 && errors[1] < errors[0] / 100.0 && errors[2] < 1e-13, "{errors:?}");
        Ok(())
    }

    #[test]
    fn a_resonance_of_the_phase_is_kept() -> Result<(), Error> {
        // a = 1: u² z⁻² and U² z² do not turn. K = −q/4 (u² z⁻² − U² z²), with the growth rate q/2.
        let hamiltonian = mathieu(1.0, 0.01, 1, 1)?;
        let driven = Driven::new(&[(2, Complex::new(0.0, 1.0))], 2)?;
        let kept: Vec<_> = hamiltonian[1]
            .terms()
            .map(|(monomial, c)| (monomial.exponent(0), monomial.exponent(1), driven.harmonics(monomial, 1)[0], *c))
            .collect();
        let c = Complex::new(0.0025, 0.0);
        assert_eq!(kept.len(), 2, "{kept:?}");
        assert!(kept.contains(&(2, 0, -2, -c)) && kept.contains(&(0, 2, 2, c)), "{kept:?}");
        Ok(())
    }

    #[test]
    fn harmonics_beyond_the_stride_are_refused() -> Result<(), Error> {
        let driven = Driven::new(&[(2, 1.0)], 2)?;
        assert_eq!(driven.harmonics(driven.raise(Monomial::ONE, 3, &[-6])?, 3), [-6]);
        for j in [3, -3, i32::MIN] {
            let refused = driven.raise(Monomial::ONE, 1, &[j]);
            assert!(matches!(refused, Err(Error::ExponentOverflow { slot: 2, bound: 2, .. })), "{refused:?}");
        }
        assert!(matches!(Driven::new(&[(8, 1.0)], 1), Err(Error::SlotOutOfRange { slot: 8, .. })));
        assert!(matches!(Driven::new(&[(2, 1.0), (2, 2.0)], 1), Err(Error::SlotRepeated { slot: 2 })));
        Ok(())
    }
}
