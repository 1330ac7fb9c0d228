//! The factor of a torque as a function of the distance to its source: a Chebyshev series in x = r₀/r between the nearest and the farthest distance.

use crate::error::{Error, torque_refused};

/// Most coefficients of a law.
pub(crate) const MOST_COEFFICIENTS: usize = 128;
/// Part of the interval by which rounding may put x outside.
const ROUNDED: f64 = 1e-9;
/// What rounding errors leave unknown of a law, over its largest value.
const UNKNOWN: f64 = 1e-16;

/// A function of x = r₀/r, 1 at x = 1.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceLaw {
    coefficients: Vec<f64>,
    between: [f64; 2],
}

impl DistanceLaw {
    /// From the coefficients c_k of Σ c_k T_k(t), where t goes from −1 to 1 between these two values of x.
    ///
    /// # Errors
    /// - [`Error::Torque`] for no coefficient or more than 128, numbers that are not finite, a negative x, and values of x that do not grow.
    pub fn new(coefficients: Vec<f64>, between: [f64; 2]) -> Result<Self, Error> {
        if !(1..=MOST_COEFFICIENTS).contains(&coefficients.len()) {
            return Err(torque_refused("law", coefficients.len(), "from 1 to 128 coefficients"));
        }
        if let Some(number) = coefficients.iter().find(|number| !number.is_finite()) {
            return Err(torque_refused("law", number, "finite"));
        }
        let [farthest, nearest] = between;
        if !(farthest >= 0.0 && farthest < nearest && nearest.is_finite()) {
            return Err(torque_refused(
                "law",
                format!("{between:?}"),
                "two growing values of r0/r, the first at least 0",
            ));
        }
        Ok(Self { coefficients, between })
    }

    /// The coefficients of the series.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// r₀ over the farthest and over the nearest distance.
    pub fn between(&self) -> [f64; 2] {
        self.between
    }

    /// The two factors a and b of t = a x + b.
    pub(crate) fn argument(&self) -> [f64; 2] {
        let [farthest, nearest] = self.between;
        let width = nearest - farthest;
        [2.0 / width, -(nearest + farthest) / width]
    }

    /// Whether x is where the series holds.
    ///
    /// # Errors
    /// - [`Error::Torque`] outside.
    pub(crate) fn within(&self, x: f64) -> Result<(), Error> {
        let [farthest, nearest] = self.between;
        let margin = ROUNDED * (nearest - farthest);
        if (farthest - margin..=nearest + margin).contains(&x) {
            return Ok(());
        }
        let bound = format!("known at r0/r = {x:e}, which is outside {farthest:e} to {nearest:e}");
        Err(torque_refused("law", "a law of the distance", &bound))
    }

    /// The value at x, by Clenshaw's recurrence.
    pub(crate) fn value(&self, x: f64) -> f64 {
        let [a, b] = self.argument();
        let t = a.mul_add(x, b);
        let (mut before, mut last) = (0.0, 0.0);
        for coefficient in self.coefficients[1..].iter().rev() {
            // b_k = c_k + 2 t b_(k+1) − b_(k+2)
            (before, last) = ((2.0 * t).mul_add(before, coefficient - last), before);
        }
        t.mul_add(before, self.coefficients[0] - last)
    }

    /// The largest and the smallest value, at places as close as the series can change.
    pub(crate) fn extremes(&self) -> [f64; 2] {
        let [farthest, nearest] = self.between;
        let places = 4 * self.coefficients.len();
        let value = |k: usize| self.value((nearest - farthest).mul_add(k as f64 / places as f64, farthest)).abs();
        let (most, least) = (0..=places)
            .map(value)
            .fold((0.0_f64, f64::INFINITY), |(most, least), value| (most.max(value), least.min(value)));
        [most, least.max(UNKNOWN * most)]
    }
}
