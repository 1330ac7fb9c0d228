//! The series of one motion: from β, an order and κσ to Fourier coefficients in ℓ′.
//!
//! With s = κσ (theory §6, §7), order n of w/√M is √σ s^n times a form of degree 2n + 1. Order n of y − y′ is s^(n+1)/κ times a form of degree 2n + 2. The
//! harmonics of a form are w^j w̄^k → e^(i(j−k)ℓ′). Sums run from the lowest order to the highest.
//!
//! An order is computed from lower orders only. Tables truncated to an order therefore have the same bits as tables computed to that order, and the tables of
//! one scene serve all later scenes of the body ([`reaching`]).

use std::sync::{Arc, LazyLock, OnceLock};

use andoyer_double::DoubleDouble;
use andoyer_series::NumericNormalForm;
use andoyer_series::forms::Form;

use crate::error::Error;
use crate::numerics::kept::{Goes, Keep, Kept};

/// The largest memory of the tables that a process keeps \[bytes\].
const MOST_MEMORY: usize = 64 << 20;
/// The longest tables of this process for each β, by its bits.
static TABLES: LazyLock<Kept<[u64; 2], Tables>> = LazyLock::new(|| Kept::new(MOST_MEMORY, Goes::Oldest));

/// The series of one body: forms and triaxiality polynomials at its β, orders 0 to N.
#[derive(Clone, Debug)]
pub(crate) struct Tables {
    /// β to 32 digits.
    beta: DoubleDouble,
    oscillator: Vec<Form>,
    longitude: Vec<Form>,
    /// The polynomials to 32 digits, computed only for a fixed order, because their frequencies are multiplied by the time.
    precise: OnceLock<Vec<DoubleDouble>>,
}

/// Fourier coefficients in ℓ′ for one motion.
#[derive(Clone, Debug)]
pub(crate) struct FourierExpansion {
    /// Coefficients of e^(ihℓ′) in w/√M, for h = −(2N+1), −(2N−1), … 2N+1.
    pub(crate) oscillator: Vec<f64>,
    /// Coefficients of sin 2kℓ′ in y − y′, for k = 1 … N, at index k − 1.
    pub(crate) longitude: Vec<f64>,
    /// Sum of the magnitudes of the terms of the highest order, for w/√M and y − y′ together.
    pub(crate) last_order: f64,
}

impl Tables {
    /// The tables of a body's β, 0 ≤ β ≤ 1, to `order`.
    pub(crate) fn new(beta: DoubleDouble, order: usize) -> Result<Self, Error> {
        let normal_form = NumericNormalForm::new(beta.to_f64().min(1.0), order)?;
        Ok(Self {
            beta,
            oscillator: normal_form.direct(),
            longitude: normal_form.direct_longitude(),
            precise: OnceLock::new(),
        })
    }

    /// The highest order of the tables.
    fn order(&self) -> usize {
        self.longitude.len()
    }

    /// P_0 … P_N at this β to 32 digits (theory §4), for N = `order`, which must not exceed the order of the tables.
    ///
    /// They are computed at the first call, which is most of the set-up of a new body (`set-up` in benches/README.md).
    pub(crate) fn polynomials(&self, order: usize) -> Result<&[DoubleDouble], Error> {
        let precise = match self.precise.get() {
            Some(precise) => precise,
            None => {
                let computed = NumericNormalForm::new(self.beta, self.order())?.triaxiality_polynomials();
                self.precise.get_or_init(|| computed)
            }
        };
        Ok(&precise[..=order])
    }

    /// The Fourier coefficients of orders 0 to `order` at s = κσ; `order` must not exceed the order of the tables.
    pub(crate) fn expand(&self, order: usize, kappa_sigma: f64, kappa: f64) -> FourierExpansion {
        let root = (kappa_sigma / kappa).sqrt();
        let mut oscillator = vec![0.0; 2 * order + 2];
        let mut longitude = vec![0.0; order];
        let mut last_order = 0.0;
        let mut power = root;
        for (n, form) in self.oscillator[..=order].iter().enumerate() {
            last_order = 0.0;
            for (j, &c) in form.coefficients().iter().enumerate() {
                oscillator[order - n + j] += c * power;
                last_order += (c * power).abs();
            }
            power *= kappa_sigma;
        }
        let mut power = kappa_sigma / kappa;
        for (index, form) in self.longitude[..order].iter().enumerate() {
            let n = index + 1;
            power *= kappa_sigma;
            // The forms are odd under w ↔ w̄: iŷ = Σ 2i·i c sin hℓ′ over the upper half, with h = 2(j − n − 1).
            for k in 1..=n {
                let c = -2.0 * form.coefficients()[n + 1 + k] * power;
                longitude[k - 1] += c;
                last_order += if n == order { c.abs() } else { 0.0 };
            }
        }
        FourierExpansion { oscillator, longitude, last_order }
    }
}

impl Keep for Tables {
    fn memory(&self) -> usize {
        let forms = self.oscillator.iter().chain(&self.longitude);
        let numbers: usize = forms.map(|form| form.coefficients().len()).sum();
        size_of::<Self>() + numbers * size_of::<f64>() + (self.order() + 1) * size_of::<DoubleDouble>()
    }
}

/// The tables of β to at least `order`. Each mode of a body has its own β. If another thread is computing them, this thread waits.
pub(crate) fn reaching(order: usize, beta: DoubleDouble) -> Result<Arc<Tables>, Error> {
    let key = [beta.high, beta.low].map(f64::to_bits);
    TABLES.of(key, |tables| tables.order() >= order, || Tables::new(beta, order))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_cut_off_have_the_bits_of_tables_that_end_there() {
        for beta in [0.0, 0.01, 0.5, 0.99] {
            let long = Tables::new(beta.into(), 40).expect("tables");
            for order in [0, 1, 2, 8, 20, 39] {
                let short = Tables::new(beta.into(), order).expect("tables");
                let [one, two] = [&short, &long].map(|tables| tables.polynomials(order).expect("a β"));
                assert_eq!(one, two, "β = {beta}, order {order}");
                assert_eq!(short.oscillator, long.oscillator[..=order], "β = {beta}, order {order}");
                assert_eq!(short.longitude, long.longitude[..order], "β = {beta}, order {order}");
            }
        }
    }

    #[test]
    fn tables_are_computed_once_for_a_body_and_again_only_for_a_higher_order() {
        let ask = |order| reaching(order, DoubleDouble::sum(0.5, 1e-20)).expect("tables");
        let first = ask(8);
        assert!([8, 5].iter().all(|&order| Arc::ptr_eq(&first, &ask(order))));
        let higher = ask(9);
        assert!(!Arc::ptr_eq(&first, &higher) && higher.order() >= 9);
        assert!(Arc::ptr_eq(&higher, &ask(8)));
    }

    #[test]
    fn each_beta_has_tables_of_its_own_to_its_last_digit() {
        let [short, long] = [0.25, 0.75].map(|beta| reaching(4, beta.into()).expect("tables"));
        let beside = reaching(4, DoubleDouble::sum(0.25, 1e-25)).expect("tables");
        assert_ne!(short.oscillator, long.oscillator);
        assert_ne!(short.polynomials(4).expect("a β"), beside.polynomials(4).expect("a β"));
    }
}
