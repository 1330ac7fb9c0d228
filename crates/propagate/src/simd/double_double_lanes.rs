//! Double-doubles in lanes: several at once, to the bits of [`DoubleDouble`].
//!
//! Sums and errors of products are exact, quotients and roots take the same steps as those of one double-double, and nothing is fused that is not fused there.
//! Reciprocals and sums of numbers of the same sign, which take fewer steps, are found in lanes only.

use std::ops::{Add, Div, Mul, Neg, Sub};

use andoyer_double::DoubleDouble;

use super::instruction_set::InstructionSet;
use super::lanes::Lanes;

/// A double-double in each lane.
#[derive(Clone, Copy)]
pub(crate) struct DoubleDoubleLanes<S: InstructionSet> {
    pub(crate) high: Lanes<S>,
    pub(crate) low: Lanes<S>,
}

impl<S: InstructionSet> DoubleDoubleLanes<S> {
    /// The same in all lanes.
    #[inline(always)]
    pub(crate) fn splat(simd: S, value: DoubleDouble) -> Self {
        Self { high: Lanes::splat(simd, value.high), low: Lanes::splat(simd, value.low) }
    }

    /// As many as there are lanes.
    #[inline(always)]
    pub(crate) fn load(simd: S, high: &[f64], low: &[f64]) -> Self {
        Self { high: Lanes::load(simd, high), low: Lanes::load(simd, low) }
    }

    /// What one lane holds.
    pub(crate) fn lane(&self, lane: usize) -> DoubleDouble {
        DoubleDouble { high: self.high.values()[lane], low: self.low.values()[lane] }
    }

    /// self/divisor for a divisor in doubles.
    #[inline(always)]
    pub(crate) fn over(self, divisor: Lanes<S>) -> Self {
        let first = self.high / divisor;
        let product = first * divisor;
        let error = first.product_error(divisor, product);
        renormalized(first, ((self.high - product) - error + self.low) / divisor)
    }

    /// self/divisor for a divisor whose low part is a correction of first order: it costs four operations more than [`Self::over`].
    #[inline(always)]
    pub(crate) fn over_pair(self, divisor: Self) -> Self {
        let by_high = self.over(divisor.high);
        renormalized(by_high.high, by_high.low - by_high.high * (divisor.low / divisor.high))
    }

    /// The nearest doubles.
    #[inline(always)]
    pub(crate) fn nearest(self) -> Lanes<S> {
        self.high + self.low
    }

    /// In each lane `near` if `place` is at most 0, otherwise `far`.
    #[inline(always)]
    pub(crate) fn up_to_zero(place: Lanes<S>, near: Self, far: Self) -> Self {
        Self { high: place.up_to(0.0, near.high, far.high), low: place.up_to(0.0, near.low, far.low) }
    }

    /// √self for self > 0.
    #[inline(always)]
    pub(crate) fn root(self) -> Self {
        let root = self.high.root();
        let square = root * root;
        let residual = ((self.high - square) - root.product_error(root, square)) + self.low;
        renormalized(root, residual / (root + root))
    }

    /// √self, and 0 for self ≤ 0.
    #[inline(always)]
    pub(crate) fn root_or_zero(self) -> Self {
        let root = self.root();
        let zero = self.high.all(0.0);
        Self { high: self.high.up_to(0.0, zero, root.high), low: self.high.up_to(0.0, zero, root.low) }
    }

    /// self·factor for a factor in doubles.
    #[inline(always)]
    pub(crate) fn times(self, factor: Lanes<S>) -> Self {
        let product = self.high * factor;
        renormalized(product, self.high.product_error(factor, product) + self.low * factor)
    }

    #[inline(always)]
    fn plus(self, high: Lanes<S>) -> Self {
        let (sum, error) = two_sum(self.high, high);
        let first = renormalized(sum, error + self.low);
        renormalized(first.high, first.low)
    }

    /// 1/self with an error of at most 6 u², by one Newton step from the reciprocal in doubles (Joldes, Muller, Popescu 2017, Algorithm 18). A quotient takes
    /// three times as many operations; it is exact where the result is a double.
    #[inline(always)]
    pub(crate) fn reciprocal(self) -> Self {
        let one = self.high.all(1.0);
        let first = self.high.reciprocal();
        let product = self.high * first;
        let error = self.high.product_error(first, product);
        let rest = renormalized((one - product) - error, -(self.low * first)).times(first);
        let (high, error) = two_sum(first, rest.high);
        renormalized(high, error + rest.low)
    }

    /// self + other for two numbers of the same sign. As nothing cancels, half of the operations suffice for the same bound, 3 u² (Joldes, Muller, Popescu
    /// 2017, Algorithm 5).
    #[inline(always)]
    pub(crate) fn plus_alike(self, other: Self) -> Self {
        let (high, error) = two_sum(self.high, other.high);
        renormalized(high, error + (self.low + other.low))
    }
}

/// Knuth's sum and its error.
#[inline(always)]
fn two_sum<S: InstructionSet>(a: Lanes<S>, b: Lanes<S>) -> (Lanes<S>, Lanes<S>) {
    let sum = a + b;
    let added = sum - a;
    (sum, (a - (sum - added)) + (b - added))
}

#[inline(always)]
fn renormalized<S: InstructionSet>(high: Lanes<S>, low: Lanes<S>) -> DoubleDoubleLanes<S> {
    let sum = high + low;
    DoubleDoubleLanes { high: sum, low: low - (sum - high) }
}

impl<S: InstructionSet> Add for DoubleDoubleLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (high, error) = two_sum(self.high, other.high);
        let (low, low_error) = two_sum(self.low, other.low);
        let sum = renormalized(high, error + low);
        renormalized(sum.high, sum.low + low_error)
    }
}

impl<S: InstructionSet> Sub for DoubleDoubleLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<S: InstructionSet> Mul for DoubleDoubleLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let product = self.high * other.high;
        let error = self.high.product_error(other.high, product);
        renormalized(product, error + (self.high * other.low + self.low * other.high))
    }
}

impl<S: InstructionSet> Div for DoubleDoubleLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let reciprocal = other.high.reciprocal();
        let first = self.high * reciprocal;
        let rest = self - other.times(first);
        let second = rest.high * reciprocal;
        let rest = rest - other.times(second);
        renormalized(first, second).plus(rest.high * reciprocal)
    }
}

impl<S: InstructionSet> Neg for DoubleDoubleLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

#[cfg(test)]
mod tests {
    use pulp::Arch;

    use super::*;
    use crate::simd::instruction_set::{Task, dispatch, dispatch_one};
    use crate::simd::lanes::WIDEST;

    /// Sum, difference, product, quotient, root and quotient by a double in lanes; reciprocal, and sum of numbers of the same sign.
    struct Operations {
        numbers: [[DoubleDouble; WIDEST]; 2],
    }

    impl Task for Operations {
        type Output = Vec<([DoubleDouble; 6], [DoubleDouble; 2])>;

        #[inline(always)]
        fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
            let width = Lanes::<S>::WIDTH;
            let load = |numbers: &[DoubleDouble]| {
                let [high, low] =
                    [numbers.iter().map(|x| x.high).collect::<Vec<_>>(), numbers.iter().map(|x| x.low).collect()];
                DoubleDoubleLanes::load(simd, &high, &low)
            };
            let mut found = Vec::new();
            for start in (0..WIDEST).step_by(width) {
                let [a, b] = [0, 1].map(|which| load(&self.numbers[which][start..start + width]));
                let results = [a + b, a - b, a * b, a / b, a.root(), a.over(b.high)];
                let others = [b.reciprocal(), a.plus_alike(b)];
                let each = |lane: usize| (results.map(|one| one.lane(lane)), others.map(|one| one.lane(lane)));
                found.extend((0..width).map(each));
            }
            found
        }
    }

    /// Two numbers between 1e-6 and 1 for each lane, with both parts at work.
    fn numbers(seed: &mut u64) -> [[DoubleDouble; WIDEST]; 2] {
        let mut next = || {
            *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (*seed >> 11) as f64 / (1_u64 << 53) as f64 + 1e-3
        };
        let mut number = || DoubleDouble::from(next()) * DoubleDouble::sum(next(), 1e-17 * next());
        [0, 1].map(|_| std::array::from_fn(|_| number()))
    }

    #[test]
    fn lanes_have_the_bits_of_one_double_double() {
        let mut seed = 1;
        // Without a fused multiply-add the last bit of an error may differ.
        for _ in 0..200 {
            let numbers = numbers(&mut seed);
            let expected: Vec<_> = std::iter::zip(numbers[0], numbers[1])
                .map(|(a, b)| [a + b, a - b, a * b, a / b, a.sqrt(), a.over(b.high)])
                .collect();
            for found in
                [dispatch(Arch::new(), Operations { numbers }), dispatch_one(Arch::new(), Operations { numbers })]
            {
                assert!(found.iter().map(|(bits, _)| bits).eq(&expected));
            }
        }
    }

    #[test]
    fn reciprocals_and_sums_of_the_same_sign_hold_thirty_one_digits() {
        // 6 u² and 3 u² are 7.4e-32 and 3.7e-32; the references have 10 u² and 3 u² themselves.
        let mut seed = 2;
        for _ in 0..200 {
            let numbers = numbers(&mut seed);
            let found = dispatch(Arch::new(), Operations { numbers });
            for ((a, b), (_, [reciprocal, sum])) in std::iter::zip(numbers[0], numbers[1]).zip(found) {
                let exact = [DoubleDouble::ONE / b, a + b];
                assert!(((reciprocal - exact[0]) / exact[0]).to_f64().abs() <= 2e-31, "{b:?}");
                assert!(((sum - exact[1]) / exact[1]).to_f64().abs() <= 8e-32, "{a:?} {b:?}");
            }
        }
    }
}
