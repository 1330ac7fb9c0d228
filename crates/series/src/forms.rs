//! Binary forms in (w̄, w) over floating-point numbers, and the normal form at a given β in O(N²) brackets.
//!
//! A form of degree d is Σ c_j w^j w̄^(d−j). Every part of one order of the rigid-body problem is such a form (theory §1, §4). The bracket is that of the exact
//! algebra, `[f; s] = ∂f/∂w̄ ∂s/∂w − ∂f/∂w ∂s/∂w̄`. For two forms it takes one product for each pair of coefficients.
//!
//! Deprit's triangle writes the generator in the old variables. This module writes it in the new variables. The transformed function then obeys dF/dε = [F; T]
//! with F and T at the same point, so that order n costs n brackets instead of n²/2. For one degree of freedom with the reversal w ↔ w̄ both methods give the
//! same transformation, because it is odd in ℓ and has no secular part.
//!
//! The sums lose little accuracy. A coefficient of order n, times the n-th power of the radius of convergence κσ_sep, is within 5e-17 of the exact one to order
//! 16 for β from 0 to 15/16 (tests/tests/numeric.rs). The triangle in `f64` subtracts large numbers instead.

use crate::coefficient::Coefficient;
use andoyer_double::DoubleDouble;
use std::ops::{Add, Div, Mul, Sub};

/// A real floating-point number that a form can have as coefficient: `f64` or [`DoubleDouble`].
pub trait Real:
    Coefficient + Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// `count` as a number; it must be below 2^53.
    #[must_use]
    fn small(count: usize) -> Self;

    /// The nearest double.
    fn to_f64(self) -> f64;

    /// The product with a whole number below 2^53.
    #[must_use]
    fn weighted(self, weight: f64) -> Self;
}

impl Real for f64 {
    fn small(count: usize) -> Self {
        count as f64
    }

    fn to_f64(self) -> f64 {
        self
    }

    #[inline]
    fn weighted(self, weight: f64) -> Self {
        self * weight
    }
}

impl Real for DoubleDouble {
    fn small(count: usize) -> Self {
        (count as f64).into()
    }

    fn to_f64(self) -> f64 {
        DoubleDouble::to_f64(self)
    }

    #[inline]
    fn weighted(self, weight: f64) -> Self {
        self.times_double(weight)
    }
}

/// A form Σ c_j w^j w̄^(d−j) of degree d in the complex variables of theory §1.
#[derive(Clone, Debug, PartialEq)]
pub struct Form<C = f64> {
    coefficients: Vec<C>,
}

impl<C: Real> Form<C> {
    /// The form with these coefficients: `coefficients[j]` belongs to w^j w̄^(d−j), and d = length − 1.
    pub(crate) fn new(coefficients: Vec<C>) -> Self {
        Self { coefficients }
    }

    /// The zero form of degree `degree`.
    fn zero(degree: usize) -> Self {
        Self { coefficients: vec![C::zero(); degree + 1] }
    }

    /// The degree d in (w̄, w).
    pub fn degree(&self) -> usize {
        self.coefficients.len().saturating_sub(1)
    }

    /// The coefficients: index j holds that of w^j w̄^(d−j).
    pub fn coefficients(&self) -> &[C] {
        &self.coefficients
    }

    /// Adds `[f; s]`, whose degree must be that of `self`.
    ///
    /// The weight of w^j w̄^k · w^p w̄^q is k p − j q = d_f p − d_s j. It is 0 if the product lacks w or w̄.
    fn add_bracket(&mut self, f: &Self, s: &Self) {
        let (f_degree, s_degree) = (f.degree() as f64, s.degree() as f64);
        let last = self.coefficients.len();
        for (j, &c) in f.coefficients.iter().enumerate() {
            if c.is_zero() {
                continue;
            }
            let fall = s_degree * j as f64;
            let first = usize::from(j == 0); // the product at index j + p − 1 needs j + p ≥ 1
            let start = j + first - 1;
            if start >= last {
                continue;
            }
            let targets = self.coefficients[start..].iter_mut();
            for ((target, &d), p) in targets.zip(&s.coefficients[first..]).zip(first..) {
                *target += &(c * d).weighted(f_degree * p as f64 - fall);
            }
        }
    }

    fn add_scaled(&mut self, factor: C, other: &Self) {
        for (target, &c) in self.coefficients.iter_mut().zip(&other.coefficients) {
            *target += &(factor * c);
        }
    }

    fn scale(&mut self, factor: C) {
        for c in &mut self.coefficients {
            *c *= &factor;
        }
    }
}

/// Normal form and generator of `w w̄ + Σ τ^n h_n`, with the generator in the new variables.
#[derive(Clone, Debug)]
pub(crate) struct FormNormalization<C> {
    /// k_n of K = Σ k_n τ^n (w w̄)^(n+1), n = 0 … order.
    kernel: Vec<C>,
    /// T_n, n = 1 … order, at index n − 1.
    generators: Vec<Form<C>>,
}

impl<C: Real> FormNormalization<C> {
    /// Normalizes `w w̄ + τ h` to `order`; `perturbation` is h, which must be of degree 4 and symmetric in w ↔ w̄.
    ///
    /// Let A = (w w̄)∘Φ and B = h∘Φ. Then A_n + B_{n−1} = K_n and n A_n = Σ [A_{n−1−m}; T_{m+1}], and the same recursion holds for B. The term with T_n is [w
    /// w̄; T_n] = (p − q) T_n for w^p w̄^q. This determines T_n outside the kernel.
    pub(crate) fn new(perturbation: &Form<C>, order: usize) -> Self {
        let action = Form::new(vec![C::zero(), C::one(), C::zero()]);
        let (mut kernel, mut generators) = (vec![C::one()], Vec::with_capacity(order));
        let (mut actions, mut energies) = (vec![action], vec![perturbation.clone()]);
        for n in 1..=order {
            let mut action_n = transported(&actions, &generators, n);
            let mut generator = Form::zero(2 * n + 2);
            let energy = &energies[n - 1];
            for p in 0..=2 * n + 2 {
                let total = action_n.coefficients[p] + energy.coefficients[p];
                if p == n + 1 {
                    kernel.push(total);
                } else {
                    action_n.coefficients[p] -= &total;
                    // The harmonic p − q = 2(p − n − 1).
                    let weighted = total * C::small(n);
                    let divisor = C::small(2 * p.abs_diff(n + 1));
                    generator.coefficients[p] = if p > n { -(weighted / divisor) } else { weighted / divisor };
                }
            }
            actions.push(action_n);
            generators.push(generator);
            if n < order {
                energies.push(transported(&energies, &generators, n));
            }
        }
        Self { kernel, generators }
    }

    /// k_0 … k_order.
    pub(crate) fn kernel(&self) -> &[C] {
        &self.kernel
    }

    /// The transformation of w, orders 0 … order: w = Σ τ^n W_n(w̄′, w′), where W_n has degree 2n + 1.
    pub(crate) fn direct(&self) -> Vec<Form<C>> {
        let mut parts = vec![Form::new(vec![C::zero(), C::one()])];
        for n in 1..=self.generators.len() {
            parts.push(transported(&parts, &self.generators, n));
        }
        parts
    }

    /// The transformation ŷ − ŷ′ of ŷ = y/i: order n = 1 … order, at index n − 1, is a form of degree 2n + 2 times τ^(n+1), in units of κ.
    ///
    /// Every order starts with [ŷ; T_n τ^n] = −n T_n τ^(n+1) (theory §6), which is a form. The brackets with the lower orders follow.
    pub(crate) fn direct_longitude(&self) -> Vec<Form<C>> {
        let mut parts: Vec<Form<C>> = Vec::with_capacity(self.generators.len());
        for n in 1..=self.generators.len() {
            let mut sum = Form::zero(2 * n + 2);
            sum.add_scaled(-C::small(n), &self.generators[n - 1]);
            for m in 1..n {
                sum.add_bracket(&parts[n - m - 1], &self.generators[m - 1]);
            }
            sum.scale(C::one() / C::small(n));
            parts.push(sum);
        }
        parts
    }
}

/// Order n of a transformed function from its lower orders: (1/n) Σ_{m=1…n} [F_{n−m}; T_m], over the T_m that exist.
fn transported<C: Real>(parts: &[Form<C>], generators: &[Form<C>], n: usize) -> Form<C> {
    let mut sum = Form::zero(parts[0].degree() + 2 * n);
    for m in 1..=n.min(generators.len()) {
        sum.add_bracket(&parts[n - m], &generators[m - 1]);
    }
    sum.scale(C::one() / C::small(n));
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bracket_of_the_action_turns_w() {
        let mut sum = Form::zero(1);
        sum.add_bracket(&Form::new(vec![0.0, 1.0, 0.0]), &Form::new(vec![0.0, 1.0]));
        assert_eq!(sum.coefficients(), &[0.0, 1.0]); // [w w̄; w] = w
    }
}
