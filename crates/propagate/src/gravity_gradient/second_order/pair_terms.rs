//! The terms of the sum over pairs at one state: their amplitudes, those of the generating function, and the bracket of two.

use super::pair_harmonics::{ContractedPart, Near, Parts};
use crate::gravity_gradient::body::contraction::{Contraction, SymmetricTensor, contraction};
use crate::gravity_gradient::body::inertia::Inertia;
use crate::gravity_gradient::first_order::mean_variables::Mean;
use crate::gravity_gradient::orbit::derivatives::ORDERS;
use crate::gravity_gradient::terms::term::{ROOT_FLOOR, Term};
use crate::numerics::C64;

/// Relative truncation error of the sum over time derivatives when a term is evaluated at the points around the orbit.
const SUM_ACCURACY: f64 = 1e-4;

/// The state at which the sum is taken.
pub(crate) struct Stand<'a> {
    pub(crate) inertia: &'a Inertia,
    pub(crate) mean: &'a Mean,
    /// q = 3φn²/2.
    pub(crate) strength: f64,
    /// The traceless part of (a/r)³ r̂r̂ in the frame, and its time derivatives.
    pub(crate) tensors: &'a [SymmetricTensor; ORDERS],
    /// Sizes of the time derivatives at the epoch, as many and one more.
    pub(crate) sizes: &'a [f64; ORDERS + 1],
    /// The largest on the orbit.
    pub(crate) norms: &'a [f64],
    /// Frequency below which pairs have no sum over time derivatives: the largest rate of twice the true anomaly times
    /// [`SLOW_RATIO`](crate::gravity_gradient::terms::term::SLOW_RATIO).
    pub(crate) slowest: f64,
    /// The harmonics of the orbit in S are multiples of this frequency.
    pub(crate) orbital_step: f64,
    /// Longest time from the epoch.
    pub(crate) duration: f64,
    /// Largest (a/r)³ within the span, over that at the epoch.
    pub(crate) closest: f64,
    /// Second time derivative of (a/r)³ r̂r̂ at the epoch, over it.
    pub(crate) bend: f64,
    /// Pairs with a smaller error of M and L, over M, are not summed around the orbit.
    pub(crate) enough: f64,
}

/// One term, or ⟨D⟩.
#[derive(Clone, Copy)]
pub(crate) struct PairTerm {
    pub(crate) harmonic: f64,
    pub(crate) multiple: f64,
    /// Relative size.
    pub(crate) size: f64,
    /// Ω and its derivatives with respect to σ and M.
    pub(crate) frequency: [f64; 3],
    /// q e^(i(hℓ′+my′)), and −i for m = 1.
    weight: C64,
    /// F = σ^(|h|/2) f, √σ dF/dσ, and h F/√σ.
    amplitude: [f64; 3],
    pub(crate) parts: Parts,
    /// Whether it is one harmonic of the orbit, which has no other time dependence than its frequency.
    pub(crate) single: bool,
    /// Whether its divisors have the shift by the average torque.
    pub(crate) shifted: bool,
}

impl Stand<'_> {
    /// [D_a, W_b].
    pub(crate) fn source(&self, a: &PairTerm, b: &PairTerm) -> C64 {
        self.bracket(a, &a.parts.torque[0], b, &b.parts.generator[0])
    }

    /// The bracket of a part of one term with a part of another, with the phases.
    pub(crate) fn bracket(&self, a: &PairTerm, a_part: &ContractedPart, b: &PairTerm, b_part: &ContractedPart) -> C64 {
        let (momentum, sigma) = (self.mean.momentum, self.inertia.sigma);
        let ([x, x1, x2], [z, z1, z2]) = (a_part.value, b_part.value);
        // The derivative (h − mσ)/M ∂/∂σ + m ∂/∂M, with the factor that b's or a's amplitude gives.
        let along = |row: &PairTerm, other: &PairTerm, value: C64, slope: C64| {
            let [whole, _, lowered] = row.amplitude;
            let [_, by_sigma, by_momentum] = other.frequency;
            let turned = (lowered - row.multiple * sigma.sqrt() * whole) * other.amplitude[1] / momentum;
            let shift = (row.harmonic - row.multiple * sigma) / momentum * by_sigma + row.multiple * by_momentum;
            value * turned + slope * (whole * other.amplitude[0] * shift)
        };
        let forth = x * along(a, b, z, b_part.slope);
        let back = z * along(b, a, x, a_part.slope);
        let turning = (x1 * z2 - x2 * z1) * (a.amplitude[0] * b.amplitude[0] / momentum);
        a.weight * b.weight * (C64::i() * (forth - back) + turning)
    }
}

impl PairTerm {
    /// A term by the sums over time derivatives.
    pub(crate) fn new(stand: &Stand<'_>, term: &Term) -> Self {
        let contracted = stand.tensors.map(|tensor| contraction(&tensor, term.multiple));
        let omega = stand.mean.momentum * term.frequency[0];
        let parts = Parts {
            torque: [0, 1].map(|j| ContractedPart { value: contracted[j], slope: C64::default() }),
            generator: generating(&contracted, omega, stand.sizes),
        };
        Self::of(stand, term, parts)
    }

    /// The number of derivatives for a sum around the orbit.
    pub(crate) fn orders_around(&self, stand: &Stand<'_>) -> usize {
        orders(self.frequency[0], stand.norms, SUM_ACCURACY)
    }

    /// D and W of the term with the disturbing body at another place, from the contractions of the tensor and its derivatives there. The harmonics `near` are
    /// terms of their own and are subtracted; `elapsed` is the time from the place of their amplitudes. dD/dt and dW/dt are not computed.
    pub(crate) fn elsewhere(&self, contracted: &[Contraction], near: &[Near], elapsed: f64) -> Self {
        let omega = self.frequency[0];
        let inverse = (C64::i() * omega).inv();
        let mut turns: Vec<C64> =
            near.iter().map(|harmonic| C64::from_polar(1.0, (harmonic.frequency - omega) * elapsed)).collect();
        let (mut torque, mut generator) = (ContractedPart::default(), ContractedPart::default());
        let mut factor = inverse;
        for (j, &values) in contracted.iter().enumerate() {
            let mut values = values;
            for (harmonic, turn) in near.iter().zip(&mut turns) {
                for (value, part) in values.iter_mut().zip(harmonic.torque) {
                    *value -= part * *turn;
                }
                *turn *= C64::new(0.0, harmonic.frequency - omega);
            }
            if j == 0 {
                torque.value = values;
            }
            for (sum, value) in generator.value.iter_mut().zip(values) {
                *sum += factor * value;
            }
            generator.slope += factor * inverse * -C64::i() * (j as f64 + 1.0) * values[0];
            factor *= -inverse;
        }
        let parts =
            Parts { torque: [torque, ContractedPart::default()], generator: [generator, ContractedPart::default()] };
        Self { parts, ..*self }
    }

    /// One harmonic of the orbit in a term.
    pub(crate) fn single(stand: &Stand<'_>, term: &Term, near: &Near) -> Self {
        let row = Self::of(stand, term, near.parts());
        let share = near.torque.iter().map(|part| part.norm_sqr()).fold(0.0, f64::max).sqrt() / stand.norms[0];
        let root = stand.inertia.sigma.sqrt().max(ROOT_FLOOR);
        let size = share * term.strength(root) * stand.mean.momentum / near.divisor.abs();
        let [_, by_sigma, by_momentum] = row.frequency;
        Self { size, frequency: [near.divisor, by_sigma, by_momentum], single: true, shifted: near.shifted, ..row }
    }

    /// A term with these amplitudes of D and W.
    pub(crate) fn of(stand: &Stand<'_>, term: &Term, parts: Parts) -> Self {
        let (h, m) = (f64::from(term.harmonic), f64::from(term.multiple));
        let Stand { mean, strength, .. } = stand;
        let [nu, slope, _] = term.frequency;
        let angle = if mean.p == C64::default() { 0.0 } else { mean.p.arg() };
        let phase = C64::from_polar(*strength, h * angle + m * mean.longitude);
        Self {
            harmonic: h,
            multiple: m,
            size: term.size(stand.inertia.sigma.sqrt().max(ROOT_FLOOR)),
            frequency: [mean.momentum * nu, mean.momentum * slope, nu],
            weight: if term.multiple == 1 { phase * -C64::i() } else { phase },
            amplitude: amplitude(term.harmonic, term.weighted(), stand.inertia.sigma),
            parts,
            single: false,
            shifted: false,
        }
    }

    /// One harmonic of ⟨D⟩.
    pub(crate) fn at(&self, near: &Near) -> Self {
        let torque = [ContractedPart { value: near.torque, slope: C64::default() }, ContractedPart::default()];
        let frequency = [near.frequency, 0.0, 0.0];
        Self { frequency, parts: Parts { torque, ..Parts::default() }, single: true, ..*self }
    }

    /// 2⟨D⟩. The source of a pair with ⟨D⟩ is [⟨D⟩, W_b], without the factor ½ of S_ab = ½ [D_a, W_b].
    pub(crate) fn average(stand: &Stand<'_>) -> Self {
        let function = Term::average(stand.inertia);
        let part = |tensor: &SymmetricTensor| ContractedPart { value: contraction(tensor, 0), slope: C64::default() };
        Self {
            harmonic: 0.0,
            multiple: 0.0,
            size: 1.0,
            frequency: [0.0; 3],
            weight: (2.0 * stand.strength).into(),
            amplitude: amplitude(0, function, stand.inertia.sigma),
            parts: Parts {
                torque: [part(&stand.tensors[0]), part(&stand.tensors[1])],
                generator: [ContractedPart::default(); 2],
            },
            single: false,
            shifted: false,
        }
    }

    pub(crate) fn conjugate(&self) -> Self {
        let conjugated = |part: &ContractedPart, sign: f64| ContractedPart {
            value: part.value.map(|c| c.conj()),
            slope: part.slope.conj() * sign,
        };
        let [whole, slope, lowered] = self.amplitude;
        Self {
            harmonic: -self.harmonic,
            multiple: -self.multiple,
            size: self.size,
            frequency: self.frequency.map(|part| -part),
            weight: self.weight.conj(),
            amplitude: [whole, slope, -lowered],
            parts: Parts {
                torque: self.parts.torque.each_ref().map(|part| conjugated(part, 1.0)),
                // Ω has the other sign.
                generator: self.parts.generator.each_ref().map(|part| conjugated(part, -1.0)),
            },
            single: self.single,
            shifted: self.shifted,
        }
    }
}

/// F = σ^(|h|/2) f, √σ dF/dσ and h F/√σ, regular at σ = 0.
fn amplitude(harmonic: i32, [value, slope, _]: [f64; 3], sigma: f64) -> [f64; 3] {
    let root = sigma.sqrt();
    let degree = harmonic.abs();
    let lowered = if degree == 0 { 0.0 } else { root.powi(degree - 1) * value };
    let whole = root.powi(degree) * value;
    [whole, root.powi(degree + 1) * slope + 0.5 * f64::from(degree) * lowered, f64::from(harmonic) * lowered]
}

/// V and dV/dt with V̇ + iΩV = U, from the contractions of U and its time derivatives: sums that end where what they leave is least.
fn generating(contracted: &[Contraction; ORDERS], omega: f64, sizes: &[f64]) -> [ContractedPart; 2] {
    let orders = orders(omega, sizes, 0.0);
    let inverse = (C64::i() * omega).inv();
    let mut parts = [ContractedPart::default(); 2];
    // (−1)^j/(iΩ)^(j+1).
    let mut factor = inverse;
    for (j, values) in contracted.iter().enumerate().take(orders) {
        let slope = factor * inverse * -C64::i() * (j as f64 + 1.0);
        for (sum, value) in parts[0].value.iter_mut().zip(values) {
            *sum += factor * value;
        }
        parts[0].slope += slope * values[0];
        if let Some(next) = contracted.get(j + 1) {
            for (sum, value) in parts[1].value.iter_mut().zip(next) {
                *sum += factor * value;
            }
            parts[1].slope += slope * next[0];
        }
        factor *= -inverse;
    }
    parts
}

/// The number of derivatives with which a sum leaves this share of its first term, or with which it leaves least, from the sizes of the derivatives.
pub(crate) fn orders(omega: f64, sizes: &[f64], enough: f64) -> usize {
    let left = |orders: usize| sizes[orders] / omega.abs().powi(orders as i32);
    let best = (1..=ORDERS).min_by(|&a, &b| left(a).total_cmp(&left(b))).unwrap_or(1);
    (1..best).find(|&orders| left(orders) <= enough * sizes[0]).unwrap_or(best)
}
