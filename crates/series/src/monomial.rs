//! Monomials in eight variables, with the exponents packed in one integer.
//!
//! The integer has eight fields of 16 bits; slot 0 is the most significant field. The top bit of each field is a guard bit, so exponents are at most 32767. A
//! product is one addition of integers, which never carries into the next field, and one test of the guard bits. Overflow of an exponent is an error.
//!
//! Canonical order: by ascending total degree, and within a degree lexicographic, with the larger exponent of the lower slot first (1, x, y, x², xy, y², …).
//! Iteration, summation and printing follow this order everywhere in the crate.

use crate::error::Error;
use std::cmp::Ordering;
use std::hash::{Hash, Hasher};

/// Number of variable slots in a monomial.
pub const SLOTS: usize = 8;
/// Largest exponent of a variable.
pub const MAX_EXPONENT: u32 = 0x7fff;

const FIELD: u32 = 16;
const MASK: u128 = 0xffff;
const GUARDS: u128 = 0x8000_8000_8000_8000_8000_8000_8000_8000;

/// A product of powers of up to eight variables.
///
/// ```
/// use andoyer_series::Monomial;
/// let xy2 = Monomial::new(&[1, 2])?;
/// let square = xy2.checked_mul(xy2)?;
/// assert_eq!((square.exponent(0), square.exponent(1), square.total_degree()), (2, 4, 6));
/// # Ok::<(), andoyer_series::Error>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Monomial(u128);

#[inline]
pub(crate) const fn shift(slot: usize) -> u32 {
    FIELD * (SLOTS - 1 - slot) as u32
}

impl Monomial {
    /// The monomial 1.
    pub const ONE: Monomial = Monomial(0);

    /// The monomial with the given exponents, slot 0 first. Missing slots have exponent 0.
    ///
    /// # Errors
    /// - `[0, 32768]`: [`Error::ExponentOverflow`];
    /// - nine exponents: [`Error::SlotOutOfRange`].
    pub fn new(exponents: &[u32]) -> Result<Self, Error> {
        exponents.iter().enumerate().try_fold(Self::ONE, |monomial, (slot, &e)| monomial.with(slot, e))
    }

    /// The monomial with exponents below 256, which always fit in the fields.
    ///
    /// ```
    /// use andoyer_series::Monomial;
    /// assert_eq!(Monomial::small([1, 2, 0, 0, 0, 0, 0, 0]), Monomial::new(&[1, 2])?);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    #[must_use]
    pub const fn small(exponents: [u8; SLOTS]) -> Self {
        let (mut key, mut slot) = (0, 0);
        while slot < SLOTS {
            key |= (exponents[slot] as u128) << shift(slot);
            slot += 1;
        }
        Monomial(key)
    }

    /// The exponent of the variable in `slot`; 0 if the slot does not exist.
    #[must_use]
    pub const fn exponent(self, slot: usize) -> u32 {
        if slot < SLOTS { ((self.0 >> shift(slot)) & MASK) as u32 } else { 0 }
    }

    /// All exponents, slot 0 first.
    #[must_use]
    pub fn exponents(self) -> [u32; SLOTS] {
        std::array::from_fn(|slot| self.exponent(slot))
    }

    /// This monomial with `exponent` as the exponent of `slot`.
    ///
    /// # Errors
    /// - exponent 32768: [`Error::ExponentOverflow`];
    /// - slot 8: [`Error::SlotOutOfRange`].
    pub fn with(self, slot: usize, exponent: u32) -> Result<Self, Error> {
        check_slot(slot)?;
        if exponent > MAX_EXPONENT {
            return Err(Error::ExponentOverflow { slot, exponent: exponent.into(), bound: MAX_EXPONENT });
        }
        let cleared = self.0 & !(MASK << shift(slot));
        Ok(Monomial(cleared | (u128::from(exponent) << shift(slot))))
    }

    /// This monomial without the variables of `slots`.
    #[must_use]
    pub(crate) fn without(self, slots: impl IntoIterator<Item = usize>) -> Self {
        let key = slots.into_iter().filter(|&slot| slot < SLOTS).fold(self.0, |key, slot| key & !(MASK << shift(slot)));
        Monomial(key)
    }

    /// Sum of the exponents.
    #[must_use]
    pub fn total_degree(self) -> u32 {
        (0..SLOTS).map(|slot| self.exponent(slot)).sum()
    }

    /// Sum of the exponents of the variables in `slots`.
    #[must_use]
    pub fn degree_in(self, slots: &[usize]) -> u32 {
        slots.iter().map(|&slot| self.exponent(slot)).sum()
    }

    /// The product of two monomials. It costs one addition and one test.
    ///
    /// # Errors
    /// - x^20000 times x^20000: [`Error::ExponentOverflow`].
    pub fn checked_mul(self, other: Self) -> Result<Self, Error> {
        Self::guarded(self.0 + other.0)
    }

    /// The product times `raised`, divided by `lowered` (both are keys from `unit`). It is the monomial that a bracket forms from a pair of terms.
    ///
    /// The caller ensures that the product contains `lowered`. The intermediate sums fit in 16 bits (2 * 32767 + 1).
    pub(crate) fn bracket_mul(self, other: Self, raised: u128, lowered: u128) -> Result<Self, Error> {
        Self::guarded(self.0 + other.0 + raised - lowered)
    }

    fn guarded(key: u128) -> Result<Self, Error> {
        if key & GUARDS == 0 { Ok(Monomial(key)) } else { Err(overflow(key)) }
    }

    /// The monomial with these packed exponents, in which no guard bit is set.
    pub(crate) const fn from_key(key: u128) -> Self {
        Monomial(key)
    }

    /// Sort key of the canonical order.
    pub(crate) fn rank(self) -> (u32, u128) {
        (self.total_degree(), !self.0)
    }
}

/// The packed key of the variable in `slot` to the first power.
pub(crate) const fn unit(slot: usize) -> u128 {
    1 << shift(slot)
}

/// Refuses a slot that does not exist.
pub(crate) fn check_slot(slot: usize) -> Result<(), Error> {
    if slot < SLOTS { Ok(()) } else { Err(Error::SlotOutOfRange { slot, count: SLOTS }) }
}

#[cold]
fn overflow(key: u128) -> Error {
    let raised = Monomial(key);
    let slot = (0..SLOTS).find(|&slot| raised.exponent(slot) > MAX_EXPONENT).unwrap_or(0);
    Error::ExponentOverflow { slot, exponent: raised.exponent(slot).into(), bound: MAX_EXPONENT }
}

impl PartialOrd for Monomial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Monomial {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rank().cmp(&other.rank())
    }
}

impl Hash for Monomial {
    /// Mixes the 128 bits so that every field reaches the low bits. The Fx hash alone does not carry the top field of a word into the bucket index of small
    /// tables, so all powers of one variable would collide.
    fn hash<H: Hasher>(&self, state: &mut H) {
        let (high, low) = ((self.0 >> 64) as u64, self.0 as u64);
        let mixed = high.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(low.wrapping_mul(0xc2b2_ae3d_27d4_eb4f));
        state.write_u64(mixed ^ (mixed >> 32));
    }
}

impl std::fmt::Debug for Monomial {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "Monomial({:?})", self.exponents())
    }
}
