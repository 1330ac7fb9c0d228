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

#[cfg(test)]
mod tests {
    use super::*;

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
