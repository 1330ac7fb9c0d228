//! The rigid-body normal form at a given β, in `f64`: what a propagator evaluates.
//!
//! The Hamiltonian is that of the exact normal form with a number for β; the engine is that of the binary forms.
//! Cost about N⁴/2 multiply-adds at order N; accuracy: see the forms.

use crate::forms::{Form, FormNormalization};
use crate::{BETA, Error, W, W_BAR, hamiltonian};

/// Largest order: its coefficients, 3.2^N at most, and the work, some seconds, stay within reason.
const MAXIMUM_NUMERIC_ORDER: usize = 200;

/// Normal form and direct transformation at one β, orders 0 to N (theory §4, §6).
#[derive(Clone, Debug)]
pub struct NumericNormalForm {
    normalization: FormNormalization,
}

impl NumericNormalForm {
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
    pub fn new(beta: f64, order: usize) -> Result<Self, Error> {
        if !(0.0..=1.0).contains(&beta) {
            return Err(Error::OutsideInterval { argument: "beta", value: beta, lower: 0.0, upper: 1.0 });
        }
        if order > MAXIMUM_NUMERIC_ORDER {
            return Err(Error::OrderTooLarge { order, bound: MAXIMUM_NUMERIC_ORDER });
        }
        let [_, perturbation] = hamiltonian::<f64>()?;
        let at_beta = perturbation.evaluate_partial(BETA, &beta)?;
        let degree = at_beta.terms().map(|(m, _)| m.degree_in(&[W_BAR, W])).max().unwrap_or(0);
        let mut coefficients = vec![0.0; degree as usize + 1];
        for (monomial, &c) in at_beta.terms() {
            coefficients[monomial.exponent(W) as usize] += c;
        }
        Ok(Self { normalization: FormNormalization::new(&Form::new(coefficients), order) })
    }

    /// P_0 … P_N at this β (theory §4, real form).
    pub fn triaxiality_polynomials(&self) -> Vec<f64> {
        self.normalization.kernel().iter().map(|k| 2.0 * k).collect()
    }

    /// w = Σ τ^n W_n(w̄′, w′), orders 0 to N: W_n is a form of degree 2n + 1 (theory §6; τ^n |w′|^2n = (κσ)^n).
    pub fn direct(&self) -> Vec<Form> {
        self.normalization.direct()
    }

    /// ŷ − ŷ′ = (y − y′)/i = (1/κ) Σ τ^(n+1) Y_n in units of κ, orders 1 to N at n − 1: Y_n is a form of degree 2n + 2 (theory §6).
    pub fn direct_longitude(&self) -> Vec<Form> {
        self.normalization.direct_longitude()
    }
}
