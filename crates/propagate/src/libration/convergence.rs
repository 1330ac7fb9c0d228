//! The estimate of the error from the terms of one normal form.
//!
//! The terms of a form to a lower order are the form of that order. Let d be the distance over the span of the motions by the terms to N and to N − 2, and d′ that of N − 2 and
//! N − 4. d is the error of the order N − 2, to the next order, and the error of the order N is about d · d/d′. The estimate is a factor times this, and rounding.
//!
//! A motion has the normal variables U = √(2I) e^{iφ} with the rates ω. Those of two orders differ by δU at the epoch and by δω in the rates, and the last terms of the
//! transformation have a size; in the angles, with the gains |∂x/∂U|,
//!
//! ```text
//! d = Σ gain (|δU| + |δω| span |U|) + Σ sizes of the terms between the orders
//! ```
//!
//! where the three angles count in the square, and so do terms with different multiples of the proper angles.

use andoyer_series::Error;
use andoyer_series::periodic::DrivenForm;

use super::lock::Lock;

/// The estimate over the error that three orders in geometric progression predict.
const SAFETY: f64 = 12.0;
/// The progression will miss a tolerance by which it would be so many times larger at the highest order: the ratio of two orders can become smaller.
const HOPELESS: f64 = 10.0;
/// Rounding of the coefficients and of the evaluation, relative to the angles.
const ROUNDING: f64 = 4e-15;
/// The relative rounding of the frequencies.
const FREQUENCIES: f64 = 1e-15;

/// How fast the motions of a state by the terms of a form come nearer to each other.
pub(super) struct Convergence {
    /// The normal variables of the state.
    pub(super) normal: Vec<f64>,
    /// d/d′, at most 1; 1 for an order without two below it.
    pub(super) ratio: f64,
    /// The estimate of the error over the span by the orders that are left out \[rad\].
    pub(super) truncation: f64,
    /// The rounding error over the span \[rad\].
    pub(super) rounding: f64,
}

/// The motion by the terms to one order.
struct TruncatedMotion {
    order: usize,
    /// p and q of U = p + iq, q first.
    normal: Vec<f64>,
    /// How far the image of the normal variables is from the state.
    missed: f64,
    rates: Vec<f64>,
}

impl Convergence {
    /// That of a lock over a time from the epoch, in units of 1/n.
    ///
    /// # Errors
    /// Those of the form: a state beyond the range of the series can overflow.
    pub(super) fn new(form: &DrivenForm, lock: &Lock, longest: f64) -> Result<Self, Error> {
        let motions = motions(form, lock)?;
        let in_angles = |variables: &Vec<f64>| variables.iter().step_by(2).map(|x| x * x).sum::<f64>().sqrt();
        let gains: Vec<f64> = form.gains()?.iter().map(in_angles).collect();
        let last = &motions[motions.len() - 1];
        let sizes: Vec<f64> = form.sizes(&form.actions_of(&last.normal))?.iter().map(in_angles).collect();
        let distances: Vec<f64> = motions
            .windows(2)
            .map(|pair| {
                let between = sizes[pair[0].order + 1..=pair[1].order].iter().sum::<f64>();
                between + pair[1].distance(&pair[0], &gains, longest)
            })
            .collect();
        let (distance, ratio) = match distances[..] {
            [] => (f64::INFINITY, 1.0),
            [only] => (only, 1.0),
            [.., before, last] => (last, (last / before).min(1.0)),
        };
        let amplitude = gains.iter().zip(moduli(&last.normal)).map(|(gain, modulus)| gain * modulus).sum::<f64>();
        let fastest = last.rates.iter().fold(1.0_f64, |most, rate| most.max(rate.abs()));
        let rounding = ROUNDING * (1.0 + amplitude) + FREQUENCIES * fastest * longest * amplitude;
        let truncation = SAFETY * (distance * ratio + last.missed);
        Ok(Self { ratio, truncation, rounding, normal: last.normal.clone() })
    }

    /// The estimate of the error over the span \[rad\].
    pub(super) fn error(&self) -> f64 {
        self.truncation + self.rounding
    }

    /// Whether no further order is better: where two orders are not nearer to each other than the two before, or where rounding is larger than what is left out.
    pub(super) fn is_over(&self) -> bool {
        self.ratio >= 1.0 || self.truncation < self.rounding
    }

    /// Whether so many further orders will not meet a tolerance, by the progression and by rounding.
    pub(super) fn will_miss(&self, orders: usize, tolerance: f64) -> bool {
        let left = self.truncation * self.ratio.powi((orders / 2) as i32);
        left > HOPELESS * tolerance || self.rounding > tolerance
    }
}

/// The motions by the terms to N − 4, N − 2 and N, as far as there are such orders.
fn motions(form: &DrivenForm, lock: &Lock) -> Result<Vec<TruncatedMotion>, Error> {
    let orders: Vec<usize> = [4, 2, 0].into_iter().filter_map(|below| form.order().checked_sub(below)).collect();
    let found = form.at(&lock.shape.driven(lock.start)).to_normal_by_orders(&lock.state, &orders)?;
    let motion = |(order, (normal, missed)): (usize, (Vec<f64>, f64))| {
        let rates = form.frequencies_of_order(order, &form.actions_of(&normal))?;
        Ok(TruncatedMotion { order, normal, missed, rates })
    };
    orders.into_iter().zip(found).map(motion).collect()
}

impl TruncatedMotion {
    /// How far the linear motions of two orders are apart over a time \[rad\].
    fn distance(&self, other: &Self, gains: &[f64], longest: f64) -> f64 {
        let difference: Vec<f64> = self.normal.iter().zip(&other.normal).map(|(a, b)| a - b).collect();
        let rates = self.rates.iter().zip(&other.rates).map(|(a, b)| (a - b).abs());
        let modes = moduli(&difference).zip(moduli(&self.normal)).zip(rates);
        modes.zip(gains).map(|(((moved, modulus), rate), gain)| gain * (moved + rate * longest * modulus)).sum()
    }
}

/// |U| of each mode.
fn moduli(normal: &[f64]) -> impl Iterator<Item = f64> {
    normal.chunks(2).map(|pair| pair[0].hypot(pair[1]))
}
