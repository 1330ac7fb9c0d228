//! The coefficients of an emitted function: power series in s = κσ, one for each harmonic of ℓ′ (theory §6, §7).
//!
//! Let ϱ = s if β is a number, and ϱ = βs if β is an argument, because the harmonic h of w e^(−iℓ′) has the factor β^(|h|/2). Then
//!
//! ```text
//! w/√M = √σ Σ_m ϱ^m [ upper_m(s) e^(i(2m+1)ℓ′) + ϱ lower_m(s) e^(−i(2m+1)ℓ′) ]      y − y′ = σ Σ_k ϱ^k longitude_k(s) sin 2kℓ′
//! ```
//!
//! At a given β the coefficients come from [`NumericNormalForm`] in double-double, otherwise from the exact polynomials in β². Each number is rounded once.

use crate::error::Error;
use crate::normal_form::NormalForm;
use crate::numeric::NumericNormalForm;
use crate::rigid_body::{Variable, turned_complex as turned};
use andoyer_double::DoubleDouble;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};

/// A power series in s, lowest power first. Each coefficient is a polynomial in β², lowest power first, or one number.
pub(super) type Series = Vec<Vec<f64>>;

/// All the series of a function.
#[derive(Clone, Debug)]
pub(super) struct Coefficients {
    /// The series of e^(i(2m+1)ℓ′) at index m.
    pub(super) upper: Vec<Series>,
    /// The series of e^(−i(2m+1)ℓ′) at index m.
    pub(super) lower: Vec<Series>,
    /// The series of sin 2kℓ′ at index k − 1.
    pub(super) longitude: Vec<Series>,
    /// ½ (n+1) P_n: dℓ′/dt in units of Mγ/C.
    pub(super) anomaly_rate: Series,
    /// ½ (1−n) P_n: ((C/M) dy′/dt − 1)/(γσ).
    pub(super) longitude_rate: Series,
}

impl Coefficients {
    /// The coefficients at one β, 0 ≤ β < 1.
    pub(super) fn at(beta: f64, order: usize) -> Result<Self, Error> {
        let normal_form = NumericNormalForm::<DoubleDouble>::new(beta.into(), order)?;
        let mut result = Self::empty(order);
        for (n, form) in normal_form.direct().iter().enumerate() {
            for (j, &c) in form.coefficients().iter().enumerate().filter(|(_, c)| **c != DoubleDouble::ZERO) {
                if let Some(target) = result.oscillator(n, 2 * j as i64 - (2 * n as i64 + 1)) {
                    *target = vec![c.to_f64()];
                }
            }
        }
        for (n, form) in (1..).zip(normal_form.direct_longitude()) {
            for k in 1..=n {
                result.longitude[k - 1][n - k] = vec![-2.0 * form.coefficients()[n + 1 + k].to_f64()];
            }
        }
        let polynomials = normal_form.triaxiality_polynomials();
        let weighted = |weight: fn(f64) -> f64| {
            let weighted = |(n, &p)| (DoubleDouble::from(0.5 * weight(n as f64)) * p).to_f64();
            polynomials.iter().enumerate().map(|term| vec![weighted(term)]).collect()
        };
        result.anomaly_rate = weighted(|n| n + 1.0);
        result.longitude_rate = weighted(|n| 1.0 - n);
        Ok(result.trimmed())
    }

    /// The coefficients for any β, as polynomials in β². Each harmonic has the powers of β that theory §2 gives. [`NormalForm::from_json`] checks this for a
    /// normal form from a file.
    pub(super) fn symbolic(normal_form: &NormalForm) -> Result<Self, Error> {
        let order = normal_form.order();
        let mut result = Self::empty(order);
        result.upper[0][0] = vec![1.0];
        for n in 1..=order {
            for ((j, k, l), c) in normal_form.direct(Variable::Momentum, n)? {
                let harmonic = i64::from(k) - i64::from(j);
                if let Some(target) = result.oscillator(n, harmonic) {
                    put(target, (l - harmonic.abs_diff(1) as u32 / 2) / 2, &turned(&c, j as usize).re)?;
                }
            }
            for ((j, k, l), c) in normal_form.direct(Variable::Angle, n)?.into_iter().filter(|((j, k, _), _)| k > j) {
                let half = (k - j) / 2;
                let target = &mut result.longitude[half as usize - 1][n - half as usize];
                put(target, (l - half) / 2, &(turned(&c, j as usize).im * BigRational::from_integer((-2).into())))?;
            }
        }
        for n in 0..=order {
            let (mut anomaly, mut longitude) = (Vec::new(), Vec::new());
            let half = |weight: BigInt| BigRational::new(weight, 2.into());
            for (&power, c) in normal_form.triaxiality_polynomial(n)? {
                put(&mut anomaly, power / 2, &(c * half(BigInt::from(n) + 1)))?;
                put(&mut longitude, power / 2, &(c * half(1 - BigInt::from(n))))?;
            }
            result.anomaly_rate.push(anomaly);
            result.longitude_rate.push(longitude);
        }
        Ok(result.trimmed())
    }

    fn empty(order: usize) -> Self {
        Self {
            upper: (0..=order).map(|m| vec![Vec::new(); order - m + 1]).collect(),
            lower: (0..=order).map(|m| vec![Vec::new(); order - m]).collect(),
            longitude: (1..=order).map(|k| vec![Vec::new(); order - k + 1]).collect(),
            anomaly_rate: Vec::new(),
            longitude_rate: Vec::new(),
        }
    }

    /// The coefficient of order n of the odd harmonic h of w, or `None` outside 1 − 2n ≤ h ≤ 1 + 2n.
    fn oscillator(&mut self, n: usize, harmonic: i64) -> Option<&mut Vec<f64>> {
        let m = harmonic.unsigned_abs() as usize / 2;
        if harmonic > 0 {
            self.upper.get_mut(m)?.get_mut(n.checked_sub(m)?)
        } else {
            self.lower.get_mut(m)?.get_mut(n.checked_sub(m + 1)?)
        }
    }

    /// Removes the zeros at the ends of the series, and the last harmonics if their series are empty.
    fn trimmed(mut self) -> Self {
        for list in [&mut self.upper, &mut self.lower, &mut self.longitude] {
            list.iter_mut().for_each(trim);
            while list.last().is_some_and(Vec::is_empty) {
                list.pop();
            }
        }
        trim(&mut self.anomaly_rate);
        trim(&mut self.longitude_rate);
        self
    }
}

fn trim(series: &mut Series) {
    while series.last().is_some_and(|coefficient| coefficient.iter().all(|&c| c == 0.0)) {
        series.pop();
    }
}

/// Rounds `value` and stores it at `index`.
fn put(target: &mut Vec<f64>, index: u32, value: &BigRational) -> Result<(), Error> {
    let index = index as usize;
    if value.is_zero() {
        return Ok(());
    }
    if target.len() <= index {
        target.resize(index + 1, 0.0);
    }
    target[index] = value.to_f64().ok_or(Error::DivisionByZero)?; // `None` only for 0/0
    Ok(())
}
