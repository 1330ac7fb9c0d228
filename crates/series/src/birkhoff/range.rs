//! The range of a truncated transformation: a point that it takes there and back must return to within 1 % of its distance.
//!
//! The series diverge, and beyond their range they give numbers of any size. Both classes of forms use this test: [`BirkhoffMap`](crate::BirkhoffMap), whose
//! second direction is the inverse series, and [`DrivenForm`](crate::periodic::DrivenForm), whose second direction is an iteration. The distance is the
//! largest variable: of the state or, if that is larger, of the forced motion (`BirkhoffMap`), or of the state measured from the periodic motion (`DrivenForm`).
//! The test sees whether a transformation returns, not whether it is right: a low order can return far from the equilibrium.

use num_complex::Complex;

use super::mode::Mode;
use crate::error::Error;

/// A point that returns farther off than this part of its distance is beyond the range of the series.
pub(crate) const LOST: f64 = 0.01;
/// Actions are refused if a point of their torus returns farther off than this part of its distance: the frequencies are derivatives of K alone, and keep digits
/// where single states have lost theirs.
pub(crate) const LOST_TORUS: f64 = 1.0;
/// The number of points of a torus that are tested, at equal steps of all angles.
const POINTS: u32 = 4;
/// Angle of the first mode at the first point \[rad\]; each mode has one radian more. No point has a variable that is 0.
const FIRST: f64 = 0.3;

/// Refuses a point at `distance` that returns to a place more than `part` of it away. A miss that is not a number is refused.
pub(crate) fn check_return(miss: f64, distance: f64, part: f64) -> Result<(), Error> {
    if miss <= part * distance {
        return Ok(());
    }
    Err(Error::BeyondSeries { miss: if miss.is_nan() { f64::INFINITY } else { miss }, distance })
}

/// The largest modulus of some numbers.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// The largest difference of two points, infinite where one is not a number.
pub(crate) fn apart(a: &[f64], b: &[f64]) -> f64 {
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, |most, d| if d.is_nan() { f64::INFINITY } else { most.max(d) })
}

/// Points of real normal variables with these actions, at several angles of the centres. Those of saddles and quartets are the nearest to the origin.
pub(crate) fn torus(modes: &[Mode<f64>], actions: &[f64]) -> Vec<Vec<f64>> {
    (0..POINTS)
        .map(|step| point(modes, actions, FIRST + f64::from(step) * std::f64::consts::TAU / f64::from(POINTS)))
        .collect()
}

fn point(modes: &[Mode<f64>], actions: &[f64], first: f64) -> Vec<f64> {
    let mut normal = vec![0.0; 2 * modes.len()];
    for (mode, kind) in modes.iter().enumerate() {
        let (q, p, action) = (2 * mode, 2 * mode + 1, actions[mode]);
        match kind {
            Mode::Elliptic { ratio, .. } => {
                let turned = (2.0 * action).sqrt() * Complex::cis(first + mode as f64);
                (normal[q], normal[p]) = (turned.im * ratio.sqrt(), turned.re / ratio.sqrt());
            }
            Mode::Hyperbolic { .. } => {
                let side = action.abs().sqrt();
                (normal[q], normal[p]) = (side.copysign(action), side);
            }
            // I₁ = q₁p₁ + q₂p₂ and I₂ = q₂p₁ − q₁p₂, here with p₂ = 0.
            Mode::Complex { frequency, partner, .. } if *frequency > 0.0 => {
                let other = actions[*partner];
                let side = action.hypot(other).sqrt();
                let unit = if side > 0.0 { side } else { 1.0 };
                (normal[q], normal[2 * partner], normal[p]) = (action / unit, other / unit, side);
            }
            Mode::Complex { .. } => {}
        }
    }
    normal
}
