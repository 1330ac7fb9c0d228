//! The one file that knows the series crate: from β, an order and κσ to Fourier coefficients in ℓ′.
//!
//! With s = κσ (theory §6, §7) order n of w/√M is √σ s^n times a form of degree 2n + 1, and order n of y − y′ is s^(n+1)/κ times one of
//! degree 2n + 2. A form becomes harmonics by w^j w̄^k → e^(i(j−k)ℓ′). Sums run from the lowest order to the highest.

use andoyer_series::{Form, NumericNormalForm};

use crate::error::Error;

/// The series of one body: forms and triaxiality polynomials at its β, orders 0 to N.
#[derive(Clone, Debug)]
pub(crate) struct Tables {
    polynomials: Vec<f64>,
    oscillator: Vec<Form>,
    longitude: Vec<Form>,
}

/// Fourier coefficients in ℓ′ for one motion.
#[derive(Clone, Debug)]
pub(crate) struct Expansion {
    /// Coefficient of e^(ihℓ′) of w/√M, h = −(2N+1), −(2N−1), … 2N+1.
    pub(crate) oscillator: Vec<f64>,
    /// Coefficient of sin 2kℓ′ of y − y′, k = 1 … N, at k − 1.
    pub(crate) longitude: Vec<f64>,
    /// Sum of the magnitudes that the highest order added, w/√M and y − y′ together.
    pub(crate) last_order: f64,
}

impl Tables {
    /// The tables of a body's β, 0 ≤ β ≤ 1, to `order`.
    pub(crate) fn new(beta: f64, order: usize) -> Result<Self, Error> {
        let normal_form = NumericNormalForm::new(beta, order)?;
        Ok(Self {
            polynomials: normal_form.triaxiality_polynomials(),
            oscillator: normal_form.direct(),
            longitude: normal_form.direct_longitude(),
        })
    }

    /// P_0 … P_N at this β (theory §4).
    pub(crate) fn polynomials(&self) -> &[f64] {
        &self.polynomials
    }

    /// The Fourier coefficients at s = κσ.
    pub(crate) fn expand(&self, kappa_sigma: f64, kappa: f64) -> Expansion {
        let order = self.longitude.len();
        let root = (kappa_sigma / kappa).sqrt();
        let mut oscillator = vec![0.0; 2 * order + 2];
        let mut longitude = vec![0.0; order];
        let mut last_order = 0.0;
        let mut power = root;
        for (n, form) in self.oscillator.iter().enumerate() {
            last_order = 0.0;
            for (j, &c) in form.coefficients().iter().enumerate() {
                oscillator[order - n + j] += c * power;
                last_order += (c * power).abs();
            }
            power *= kappa_sigma;
        }
        let mut power = kappa_sigma / kappa;
        for (index, form) in self.longitude.iter().enumerate() {
            let n = index + 1;
            power *= kappa_sigma;
            // The forms are odd in w ↔ w̄: iŷ = Σ 2i·i c sin hℓ′ over the upper half, h = 2(j − n − 1).
            for k in 1..=n {
                let c = -2.0 * form.coefficients()[n + 1 + k] * power;
                longitude[k - 1] += c;
                last_order += if n == order { c.abs() } else { 0.0 };
            }
        }
        Expansion { oscillator, longitude, last_order }
    }
}
