//! The normal form of the rigid body at a given β, in `f64` or in double-double. The propagation evaluates it.
//!
//! The Hamiltonian is that of the exact normal form, with a number for β. The module `forms` does the computation. Cost: about N⁴/2 multiply-adds; times by
//! order in `f64` and in [`DoubleDouble`](andoyer_double::DoubleDouble), with the transformation: docs/speed.md (`make bench`). Loss of accuracy against the
//! exact polynomials, for β from 1/16 to 1 − 2^−10 (tests/tests/numeric.rs):
//!
//! ```text
//! order n                                              10        20        40        60
//! P_n in f64, relative                                 2e-15     3e-15     1e-14     1e-14     (4e-16 n at most)
//! P_n in f64, over radius^(−n), as in a sum            2e-18     1e-18     6e-19     2e-19
//! transformation in f64, over radius^(−n)              < 5e-17 at every order
//! P_n in double-double, over radius^(−n)               < 5e-34 at every order
//! P_n by Deprit's triangle in f64, β = ½, relative     < 1e-16   3e-15     9e-12     4e-9      (S_60: 4e-8)
//! ```
//!
//! The error that this route in `f64` adds to a motion is below the rounding error, at every order. It is the recommended route, and the propagation crate uses
//! it. Double-double serves for checks, and for users who need the coefficients themselves to more than 13 digits.

use crate::error::Error;
use crate::forms::{Form, FormNormalization, Real};
use crate::rigid_body::{BETA, W, W_BAR, hamiltonian};

/// Largest order. It limits the coefficients, which are 3.2^N at most, and the time: about a second in `f64` and some seconds in double-double.
const MAXIMUM_NUMERIC_ORDER: usize = 200;

/// Normal form and direct transformation at one β, orders 0 to N (theory §4, §6).
#[derive(Clone, Debug)]
pub struct NumericNormalForm<C = f64> {
    normalization: FormNormalization<C>,
}

impl<C: Real> NumericNormalForm<C> {
    /// The normal form at β, 0 ≤ β ≤ 1, to `order` ≤ 200.
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

    /// The direct transformation of w, orders 0 to N: w = Σ τ^n W_n(w̄′, w′), where W_n is a form of degree 2n + 1 (theory §6; τ^n |w′|^2n = (κσ)^n).
    pub fn direct(&self) -> Vec<Form<C>> {
        self.normalization.direct()
    }

    /// The direct transformation of the angle: ŷ − ŷ′ = (y − y′)/i = (1/κ) Σ τ^(n+1) Y_n in units of κ. Order n = 1 … N is at index n − 1; Y_n is a form of
    /// degree 2n + 2 (theory §6).
    pub fn direct_longitude(&self) -> Vec<Form<C>> {
        self.normalization.direct_longitude()
    }
}
