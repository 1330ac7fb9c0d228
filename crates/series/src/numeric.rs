//! The rigid-body normal form at a given β, in `f64` or in double-double: what a propagator evaluates.
//!
//! The Hamiltonian is that of the exact normal form with a number for β; the engine is that of the binary forms. Cost about N⁴/2 multiply-adds: in
//! `f64` 16 µs at order 12, 0.33 ms at 30, 4 ms at 60, transformation included; in [`DoubleDouble`](andoyer_double::DoubleDouble) 0.12, 2.6 and 34 ms. Loss of accuracy
//! against the exact polynomials, β from 1/16 to 1 − 2^−10 (tests/tests/numeric.rs):
//!
//! ```text
//! order n                                              10        20        40        60
//! P_n in f64, relative                                 2e-15     3e-15     1e-14     1e-14     (4e-16 n at most)
//! P_n in f64, over radius^(−n), what a sum feels       2e-18     1e-18     6e-19     2e-19
//! transformation in f64, over radius^(−n)              < 5e-17 at every order
//! P_n in double-double, over radius^(−n)               < 5e-34 at every order
//! P_n by Deprit's triangle in f64, β = ½, relative     < 1e-16   3e-15     9e-12     4e-9      (S_60: 4e-8)
//! ```
//!
//! So nothing that a motion feels is lost in `f64` by this route, at any order: it is the recommended one, and what the propagation crate uses. Double-double
//! is for checks, and for who wants the coefficients themselves to more than 13 digits.

use crate::Error;
use crate::forms::{Form, FormNormalization, Real};
use crate::rigid_body::{BETA, W, W_BAR, hamiltonian};

/// Largest order: its coefficients, 3.2^N at most, and the work, a second in `f64` and some seconds in double-double, stay within reason.
const MAXIMUM_NUMERIC_ORDER: usize = 200;

/// Normal form and direct transformation at one β, orders 0 to N (theory §4, §6).
#[derive(Clone, Debug)]
pub struct NumericNormalForm<C = f64> {
    normalization: FormNormalization<C>,
}

impl<C: Real> NumericNormalForm<C> {
    /// The normal form at β, 0 ≤ β ≤ 1, to `order`.
    ///
    /// # Errors
    /// - β = −0.1, 1.1 or NaN: [`Error::OutsideInterval`];
    /// - order 201: [`Error::OrderTooLarge`].
    ///
    /// ```
    /// use andoyer_series::NumericNormalForm;
    /// let normal_form = NumericNormalForm::new(0.5, 3)?;
    /// assert_eq!(normal_form.triaxiality_polynomials(), vec![2.0, -1.0, -0.125, -0.15625]);
    /// # Ok::<(), andoyer_series::Error>(())
    /// ```
    pub fn new(beta: C, order: usize) -> Result<Self, Error> {
        let nearest = beta.to_f64();
        if !(0.0..=1.0).contains(&nearest) {
            return Err(Error::OutsideInterval { argument: "beta", value: nearest, lower: 0.0, upper: 1.0 });
        }
        if order > MAXIMUM_NUMERIC_ORDER {
            return Err(Error::OrderTooLarge { order, bound: MAXIMUM_NUMERIC_ORDER });
        }
        let [_, perturbation] = hamiltonian::<C>()?;
        let at_beta = perturbation.evaluate_partial(BETA, &beta)?;
        let degree = at_beta.terms().map(|(m, _)| m.degree_in(&[W_BAR, W])).max().unwrap_or(0);
        let mut coefficients = vec![C::zero(); degree as usize + 1];
        for (monomial, c) in at_beta.terms() {
            coefficients[monomial.exponent(W) as usize] += c;
        }
        Ok(Self { normalization: FormNormalization::new(&Form::new(coefficients), order) })
    }

    /// P_0 … P_N at this β (theory §4, real form).
    pub fn triaxiality_polynomials(&self) -> Vec<C> {
        self.normalization.kernel().iter().map(|&k| k + k).collect()
    }

    /// w = Σ τ^n W_n(w̄′, w′), orders 0 to N: W_n is a form of degree 2n + 1 (theory §6; τ^n |w′|^2n = (κσ)^n).
    pub fn direct(&self) -> Vec<Form<C>> {
        self.normalization.direct()
    }

    /// ŷ − ŷ′ = (y − y′)/i = (1/κ) Σ τ^(n+1) Y_n in units of κ, orders 1 to N at n − 1: Y_n is a form of degree 2n + 2 (theory §6).
    pub fn direct_longitude(&self) -> Vec<Form<C>> {
        self.normalization.direct_longitude()
    }
}
