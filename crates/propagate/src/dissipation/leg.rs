//! The time of one mode's part of a relaxation, as a function of y = ln(x/(1 − x)) (docs/relaxation.md, equation 17).
//!
//! |dt/dy| is analytic in |Im y| < π, falls as y e^(−y) towards the separatrix, and is constant to e^y at the other end. With two equal moments it falls as e^(−y/2), and with
//! a loss ∝ f^s as e^(−y(1 − s)/2): for s ≥ 1 the time from the separatrix is infinite. On panels it is a sum of Legendre
//! polynomials from Gauss's rule with 16 points, and its integral has the same coefficients. A panel is halved until its last two terms are negligible.

use std::f64::consts::PI;

use crate::error::Error;

/// Points of Gauss's rule.
const POINTS: usize = 16;
/// The y below which |dt/dy| is constant to rounding.
const BOTTOM: f64 = -40.0;
/// Length of a panel before it is halved.
const LONGEST: f64 = 4.0;
/// Relative size of the last terms of a panel that is not halved.
const RESOLVED: f64 = 1e-13;
/// Number of times that a panel is halved at most: a loss function with jumps is never resolved.
const HALVINGS: u32 = 5;

/// The nodes and weights of Gauss's rule on (−1, 1).
pub(super) fn gauss_rule() -> [(f64, f64); POINTS] {
    std::array::from_fn(|index| {
        let mut node = (PI * (index as f64 + 0.75) / (POINTS as f64 + 0.5)).cos();
        let mut slope = 1.0;
        // Newton's method from this start converges in five steps.
        for _ in 0..8 {
            let polynomials = legendre(node);
            let [before, last] = [polynomials[POINTS - 1], polynomials[POINTS]];
            slope = POINTS as f64 * (node * last - before) / (node * node - 1.0);
            node -= last / slope;
        }
        (node, 2.0 / ((1.0 - node * node) * slope * slope))
    })
}

/// P_0 … P_16.
fn legendre(z: f64) -> [f64; POINTS + 1] {
    let mut values = [1.0; POINTS + 1];
    values[1] = z;
    for k in 1..POINTS {
        let n = k as f64;
        // (k + 1) P_(k+1) = (2k + 1) z P_k − k P_(k−1)
        values[k + 1] = ((2.0 * n + 1.0) * z * values[k] - n * values[k - 1]) / (n + 1.0);
    }
    values
}

/// |dt/dy| from `top` down to `top − 2 half`, as Σ c_k P_k(z) with y = top − half (1 + z).
#[derive(Clone, Debug)]
struct Panel {
    top: f64,
    half: f64,
    coefficients: [f64; POINTS],
    /// The time from the separatrix to `top`.
    before: f64,
}

impl Panel {
    fn new(
        rule: &[(f64, f64)],
        top: f64,
        half: f64,
        slope: &impl Fn(f64) -> Result<f64, Error>,
    ) -> Result<Self, Error> {
        let mut coefficients = [0.0; POINTS];
        for &(z, weight) in rule {
            let value = slope(top - half * (1.0 + z))?;
            for (k, (coefficient, polynomial)) in coefficients.iter_mut().zip(legendre(z)).enumerate() {
                *coefficient += (k as f64 + 0.5) * weight * value * polynomial;
            }
        }
        Ok(Self { top, half, coefficients, before: 0.0 })
    }

    /// Whether the last terms are negligible beside |dt/dy| here, or beside `tail`, that of the exponential end.
    fn resolved(&self, tail: f64) -> bool {
        let [first, .., before, last] = self.coefficients;
        before.abs() + last.abs() <= RESOLVED * first.max(tail)
    }

    /// The time from `top`, and |dt/dy| there.
    fn elapsed(&self, z: f64) -> (f64, f64) {
        let values = legendre(z);
        // ∫ P_k = (P_(k+1) − P_(k−1))/(2k + 1)
        let (mut time, mut slope) = (self.coefficients[0] * (1.0 + z), self.coefficients[0]);
        for k in 1..POINTS {
            time += self.coefficients[k] * (values[k + 1] - values[k - 1]) / (2.0 * k as f64 + 1.0);
            slope += self.coefficients[k] * values[k];
        }
        (self.half * time, slope)
    }

    fn whole(&self) -> f64 {
        2.0 * self.half * self.coefficients[0]
    }

    /// The z at which this time has elapsed: Newton's method within an interval that bisection narrows.
    fn place(&self, time: f64) -> f64 {
        let (mut low, mut high) = (-1.0, 1.0);
        let mut z = 2.0 * time / self.whole() - 1.0;
        for _ in 0..60 {
            let (found, slope) = self.elapsed(z);
            if found < time {
                low = z
            } else {
                high = z
            }
            let next = z - (found - time) / (self.half * slope);
            let next = if low < next && next < high { next } else { 0.5 * (low + high) };
            let step = (next - z).abs();
            z = next;
            if step < 1e-15 {
                break;
            }
        }
        z
    }
}

/// The part of a relaxation in one mode, with times counted from the separatrix.
#[derive(Clone, Debug)]
pub(super) struct Leg {
    panels: Vec<Panel>,
    /// The time from the separatrix to y = −40, and |dt/dy| below.
    whole: f64,
    tail: f64,
    /// Whether the time from the separatrix is infinite: times are counted from the largest y.
    open: bool,
}

impl Leg {
    /// The times from y = `top` down, from |dt/dy|.
    pub(super) fn new(top: f64, is_open: bool, slope: &impl Fn(f64) -> Result<f64, Error>) -> Result<Self, Error> {
        let rule = gauss_rule();
        let count = ((top - BOTTOM) / LONGEST).ceil();
        let half = 0.5 * (top - BOTTOM) / count;
        let starts = (0..count as u32).rev().map(|k| (top - 2.0 * half * f64::from(k), half, 0));
        let mut open: Vec<(f64, f64, u32)> = starts.collect();
        let (mut panels, mut whole, tail) = (Vec::new(), 0.0, slope(BOTTOM)?);
        while let Some((top, half, halvings)) = open.pop() {
            let panel = Panel::new(&rule, top, half, slope)?;
            if panel.resolved(tail) || halvings == HALVINGS {
                let length = panel.whole();
                panels.push(Panel { before: whole, ..panel });
                whole += length;
            } else {
                open.push((top - half, 0.5 * half, halvings + 1));
                open.push((top, 0.5 * half, halvings + 1));
            }
        }
        Ok(Self { panels, whole, tail, open: is_open })
    }

    pub(super) fn is_open(&self) -> bool {
        self.open
    }

    /// The time from the separatrix to y, or back.
    pub(super) fn time(&self, y: f64) -> f64 {
        if y <= BOTTOM {
            return self.whole + (BOTTOM - y) * self.tail;
        }
        let after = self.panels.partition_point(|panel| panel.top >= y);
        let Some(panel) = after.checked_sub(1).map(|index| &self.panels[index]) else { return 0.0 };
        panel.before + panel.elapsed(((panel.top - y) / panel.half - 1.0).min(1.0)).0
    }

    /// The y at this time from the separatrix.
    pub(super) fn place(&self, time: f64) -> f64 {
        let after = self.panels.partition_point(|panel| panel.before <= time);
        match after.checked_sub(1).map(|index| &self.panels[index]) {
            Some(panel) if time < self.whole => panel.top - panel.half * (1.0 + panel.place(time - panel.before)),
            _ => BOTTOM - (time - self.whole) / self.tail,
        }
    }
}
