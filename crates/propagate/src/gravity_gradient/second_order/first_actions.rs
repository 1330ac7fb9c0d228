//! The changes of M and L = Mσ of first order at the epoch, from all terms.
//!
//! The corrections of a motion drop small terms and end their sums early. The resulting error of the mean M and L makes the phases drift. Here nothing is
//! dropped.

use num_complex::Complex;

use super::pair_harmonics::Harmonics;
use super::pair_terms::{Stand, orders};
use crate::gravity_gradient::body::contraction::contraction;
use crate::gravity_gradient::first_order::fourier::ExactTerm;
use crate::gravity_gradient::terms::modes::Mode;

type C64 = Complex<f64>;

/// δM and δL of first order.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FirstActions {
    pub(crate) momentum: f64,
    pub(crate) action: f64,
    /// Truncation errors of both by the sums over time derivatives.
    pub(crate) left: [f64; 2],
}

pub(crate) fn first_actions(
    stand: &Stand<'_>,
    modes: &[Mode],
    harmonics: Option<(&Harmonics, &[ExactTerm])>,
) -> FirstActions {
    let mut actions = FirstActions::default();
    let angle = if stand.mean.p == C64::default() { 0.0 } else { stand.mean.p.arg() };
    let root = stand.inertia.sigma.sqrt();
    for mode in modes {
        let (h, m) = (f64::from(mode.harmonic), f64::from(mode.multiple));
        let omega = stand.mean.momentum * mode.frequency[0];
        let amplitude = 2.0 * stand.strength * mode.function[0] * root.powi(mode.harmonic.abs());
        let (sum, rest) = match harmonics {
            Some((harmonics, exact)) => {
                let term = exact.iter().find(|term| term.numbers == (mode.harmonic, mode.multiple));
                (harmonics.solution(omega, mode.multiple, term), 0.0)
            }
            None => solution_by_sums(stand, omega, mode.multiple),
        };
        let phase = C64::from_polar(amplitude, h * angle + m * stand.mean.longitude);
        let phase = if mode.multiple == 1 { phase * -C64::i() } else { phase };
        // δM is m times the real part of −i W, and δL is h times.
        let turned = (phase * sum * -C64::i()).re;
        actions.momentum += m * turned;
        actions.action += h * turned;
        let rest = amplitude.abs() * rest;
        actions.left = [actions.left[0] + m * rest, actions.left[1] + h.abs() * rest];
    }
    actions
}

/// c_m of V by the sum over time derivatives, and the size of the first term that the sum lacks.
fn solution_by_sums(stand: &Stand<'_>, omega: f64, multiple: i32) -> (C64, f64) {
    let orders = orders(omega, stand.sizes, 0.0);
    let mut factor = (C64::i() * omega).inv();
    let inverse = factor;
    let mut sum = C64::default();
    for tensor in stand.tensors.iter().take(orders) {
        sum += factor * contraction(tensor, multiple)[0];
        factor *= -inverse;
    }
    (sum, stand.sizes[orders] / omega.abs().powi(orders as i32 + 1))
}
