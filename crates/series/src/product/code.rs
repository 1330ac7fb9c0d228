//! Codes of monomials. A code is one machine word, and the code of a product of two monomials is the sum of their codes.
//!
//! code = (degree) · G − Σ eₛ uₛ over all slots s except the last one, which the degree determines. The unit uₛ is the product of the radices of the slots
//! after s (Kronecker's substitution), and G is the product of all radices. The radix of a slot exceeds every exponent that the result can have there, so each
//! code belongs to one monomial. If the degree is the total degree, the order of the codes is the canonical order of the monomials. With a truncation the
//! degree is the one that the truncation bounds, so the dropped terms are those with the largest codes.

use crate::monomial::shift;
use crate::monomial::{Monomial, SLOTS};
use crate::polynomial::Truncation;
use std::fmt::Debug;

/// A code: `i64` if the codes of the result fit, otherwise `i128`, which always fits (7 · 15 bits of exponents, 18 bits of degree).
pub(super) trait Key: Copy + Ord + Debug + Send + Sync {
    /// A value below every code, which marks a free slot of a table.
    const NONE: Self;
    /// Largest number of bits of the magnitude of a sum of two codes.
    const BITS: u32;

    fn narrowed(code: i128) -> Self;
    /// The packed exponents of the code.
    fn decoded(self, layout: &Layout) -> u128;
    fn widened(self) -> i128;
    fn plus(self, other: Self) -> Self;
    /// self − base ≥ 0, or the largest `usize` if the difference does not fit.
    fn offset(self, base: Self) -> usize;
    /// A hash of 64 bits with well mixed upper bits. It uses all bits of the code except the last four.
    fn hash(self) -> u64;
    /// The lowest `count` bits.
    fn low_bits(self, count: u32) -> usize;
}

/// 2⁶⁴ divided by the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

impl Key for i64 {
    const NONE: Self = i64::MIN;
    const BITS: u32 = 61;

    #[inline]
    fn narrowed(code: i128) -> Self {
        code as i64
    }

    #[inline]
    fn decoded(self, layout: &Layout) -> u128 {
        layout.decode_word(self)
    }

    #[inline]
    fn widened(self) -> i128 {
        self.into()
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline]
    fn offset(self, base: Self) -> usize {
        (self - base) as usize
    }

    #[inline]
    fn hash(self) -> u64 {
        ((self >> 4) as u64).wrapping_mul(GOLDEN)
    }

    #[inline(always)]
    fn low_bits(self, count: u32) -> usize {
        self as usize & ((1 << count) - 1)
    }
}

impl Key for i128 {
    const NONE: Self = i128::MIN;
    const BITS: u32 = 125;

    fn narrowed(code: i128) -> Self {
        code
    }

    fn decoded(self, layout: &Layout) -> u128 {
        layout.decode_words(self)
    }

    fn widened(self) -> i128 {
        self
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline]
    fn offset(self, base: Self) -> usize {
        usize::try_from(self - base).unwrap_or(usize::MAX)
    }

    #[inline]
    fn hash(self) -> u64 {
        ((self >> 4) as u64 ^ ((self >> 64) as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f)).wrapping_mul(GOLDEN)
    }

    #[inline]
    fn low_bits(self, count: u32) -> usize {
        self as usize & ((1 << count) - 1)
    }
}

/// The coding of the monomials of one sum of products.
#[derive(Debug)]
pub(super) struct Layout {
    fields: Vec<Field>,
    /// How often each slot counts in the degree: once, unless a truncation says otherwise.
    counts: [i128; SLOTS],
    /// The slot that the degree determines.
    determined: Option<usize>,
    /// G, and its binary logarithm if all radices are powers of two.
    grade: i128,
    grade_bits: Option<u32>,
    /// Whether the codes follow the canonical order.
    pub(super) canonical: bool,
}

#[derive(Debug)]
struct Field {
    slot: usize,
    /// uₛ, and its binary logarithm if it is a power of two.
    unit: i128,
    bits: u32,
    /// How often the slot counts in the degree.
    count: u64,
}

impl Layout {
    /// The layout for exponents up to `bounds`. Radices that are powers of two decode faster; other radices leave fewer codes unused.
    pub(super) fn new(bounds: &[u32; SLOTS], truncation: Option<&Truncation>, powers_of_two: bool) -> Self {
        let mut counts = [1; SLOTS];
        if let Some(truncation) = truncation {
            counts = std::array::from_fn(|slot| truncation.slots().iter().filter(|&&s| s == slot).count() as i128);
        }
        let used: Vec<usize> = (0..SLOTS).filter(|&slot| bounds[slot] > 0).collect();
        let canonical = used.iter().all(|&slot| counts[slot] == 1);
        let determined = used.iter().copied().rfind(|&slot| counts[slot] > 0);
        let mut fields = Vec::with_capacity(SLOTS);
        let mut grade = 1_i128;
        for &slot in used.iter().rev().filter(|&&slot| Some(slot) != determined) {
            let radix = if powers_of_two { (bounds[slot] + 1).next_power_of_two() } else { bounds[slot] + 1 };
            fields.push(Field { slot, unit: grade, bits: grade.trailing_zeros(), count: counts[slot] as u64 });
            grade *= i128::from(radix);
        }
        fields.reverse();
        let grade_bits = powers_of_two.then(|| grade.trailing_zeros());
        Layout { fields, counts, determined, grade, grade_bits, canonical }
    }

    /// The change of a code when the exponent of each slot grows by one.
    fn weights(&self) -> [i128; SLOTS] {
        let mut weights = self.counts.map(|count| count * self.grade);
        for field in &self.fields {
            weights[field.slot] -= field.unit;
        }
        weights
    }

    /// A function that gives the codes of monomials, or of differences of monomials.
    pub(super) fn encoder(&self) -> impl Fn(Monomial) -> i128 + use<> {
        let weights = self.weights();
        move |monomial| (0..SLOTS).map(|slot| i128::from(monomial.exponent(slot)) * weights[slot]).sum()
    }

    /// The largest code of a monomial with this degree of the truncation.
    pub(super) fn last_of_degree(&self, degree: u32) -> i128 {
        i128::from(degree) * self.grade
    }

    /// Number of codes from degree `low` to degree `high`.
    pub(super) fn codes(&self, low: u32, high: u32) -> i128 {
        i128::from(high - low + 1).saturating_mul(self.grade)
    }

    /// Bits of the magnitude of the codes of results up to this total degree.
    pub(super) fn bits(&self, degree: u32) -> u32 {
        let most = self.counts.iter().max().copied().unwrap_or(1).max(1);
        let largest = (i128::from(degree) * most + 1).saturating_mul(self.grade);
        i128::BITS - largest.leading_zeros()
    }

    /// The exponents of a code in one word; the units and G fit in a word as well.
    #[inline]
    fn decode_word(&self, code: i64) -> u128 {
        let grade = self.grade as i64;
        let mut degree = match self.grade_bits {
            Some(bits) => (code + grade - 1) >> bits,
            None => (code + grade - 1).div_euclid(grade),
        };
        let mut rest = (degree * grade - code) as u64;
        let mut key = 0;
        for field in &self.fields {
            let exponent = if self.grade_bits.is_some() { rest >> field.bits } else { rest / field.unit as u64 };
            rest -= exponent * field.unit as u64;
            degree -= (exponent * field.count) as i64;
            key |= u128::from(exponent) << shift(field.slot);
        }
        key | self.last(degree.into())
    }

    fn decode_words(&self, code: i128) -> u128 {
        let mut degree = (code + self.grade - 1).div_euclid(self.grade);
        let mut rest = (degree * self.grade - code) as u128;
        let mut key = 0;
        for field in &self.fields {
            let exponent = rest / field.unit as u128;
            rest %= field.unit as u128;
            degree -= exponent as i128 * i128::from(field.count);
            key |= exponent << shift(field.slot);
        }
        key | self.last(degree)
    }

    /// The field of the slot that the degree determines. `degree` is the remaining degree after the other slots.
    #[inline]
    fn last(&self, degree: i128) -> u128 {
        match self.determined {
            Some(slot) if self.counts[slot] == 1 => (degree as u128) << shift(slot),
            Some(slot) => ((degree / self.counts[slot]) as u128) << shift(slot),
            None => 0,
        }
    }
}
