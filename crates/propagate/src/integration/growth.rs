//! The number of steps of a body that torques spin up, from the times at which the number has doubled.
//!
//! A doubling takes q times as long as the one before: q is 2 for a steady rotation, 2^(1/p) for a number of steps that grows as tᵖ, 1 for exponential growth, and below 1 for a rate
//! that becomes infinite in a finite time. With the last duration d, m more doublings take d (q + q² + … + qᵐ).

use crate::error::Error;

/// The number of steps at the first of the times.
const FIRST: usize = 1 << 14;
/// The last times of doublings that are kept.
const MARKS: usize = 4;
/// The first prediction must exceed the largest number of steps by this factor, the next ones by 1.
const HOPELESS: f64 = 4.0;

/// The last times at which the number of steps has doubled.
#[derive(Clone, Debug)]
pub(super) struct StepGrowth {
    /// Whether a torque can end the growth: then the rotation of the last doubling is taken to last, and not to grow.
    brakes: bool,
    /// The most steps.
    most: usize,
    /// Times from the epoch, in units of the integration.
    marks: Vec<f64>,
    next: usize,
}

impl StepGrowth {
    pub(super) fn new(brakes: bool, most: usize) -> Self {
        Self { brakes, most, marks: Vec::new(), next: FIRST }
    }

    /// Notes the time after a number of steps. `now` and `target` are times from the epoch.
    ///
    /// # Errors
    /// [`Error::TooManySteps`] if the growth so far leads to more than the most steps at the target.
    pub(super) fn check(&mut self, steps: usize, now: f64, target: f64) -> Result<(), Error> {
        if steps < self.next {
            return Ok(());
        }
        self.next *= 2;
        self.marks.push(now.abs());
        let Some(&[a, b, c, d]) = self.marks.last_chunk::<MARKS>() else { return Ok(()) };
        let doublings = self.doublings([b - a, c - b, d - c], target.abs() - d);
        let whole = steps as f64 * doublings.exp2();
        let factor = if self.marks.len() == MARKS { HOPELESS } else { 1.0 };
        if whole > factor * self.most as f64 {
            return Err(Error::TooManySteps { steps: whole, bound: self.most, reason: String::new() });
        }
        Ok(())
    }

    /// How often the number of steps doubles in the rest of the time, after the durations of three doublings; 0 for a body that becomes slower.
    fn doublings(&self, [first, second, third]: [f64; 3], rest: f64) -> f64 {
        // The slower of two growths.
        let ratio = (second / first).max(third / second);
        if ratio >= 2.0 {
            return 0.0;
        }
        if self.brakes {
            return (1.0 + 0.5 * rest / third).log2();
        }
        let (more, sum) = (ratio - 1.0, rest * (ratio - 1.0) / (third * ratio));
        match more {
            0.0 => rest / third,
            _ if sum <= -1.0 => f64::INFINITY,
            _ => sum.ln_1p() / more.ln_1p(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The doublings after 2^17 steps up to a time, for a number of steps that is 2^17 at the time 1.
    fn doublings(time: impl Fn(f64) -> f64, brakes: bool, target: f64) -> f64 {
        let [a, b, c, d] = [0.125, 0.25, 0.5, 1.0].map(time);
        StepGrowth::new(brakes, 1 << 23).doublings([b - a, c - b, d - c], target - d)
    }

    #[test]
    fn power_laws_and_exponential_growth_are_continued_exactly() {
        // N = t², eˣ with t − 1 = ln N, 1/(2 − t): times of the parts of N.
        let (exponential, pole) = (|n: f64| 10.0 + n.ln(), |n: f64| 2.0 - 1.0 / n);
        assert!((doublings(f64::sqrt, false, 16.0) - 8.0).abs() < 1e-12);
        assert!((doublings(exponential, false, 10.0 + 5.0 * 2.0_f64.ln()) - 5.0).abs() < 1e-9);
        assert!((doublings(pole, false, 1.75) - 2.0).abs() < 1e-12);
        assert_eq!(doublings(pole, false, 2.5), f64::INFINITY);
    }

    #[test]
    fn growth_that_can_end_is_not_continued_and_a_slower_body_has_none() {
        // The density at t = 1 is about that of the last doubling, 0.5/(1 − √0.5) = 1.707.
        assert!((doublings(f64::sqrt, true, 2.0) - (1.0 + 0.5 / (1.0 - 0.5_f64.sqrt())).log2()).abs() < 1e-12);
        assert_eq!(doublings(|n| n * n, false, 100.0), 0.0);
    }
}
