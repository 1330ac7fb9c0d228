//! The changes of M and L = Mσ of second order, as one sum over pairs of terms.
//!
//! With D = Σ D_a e^(iaθ), a = (h, m), θ = (ℓ′, y′), dW/dt = D − ⟨D⟩ and the bracket \[ , \] of two amplitudes (theory §9),
//!
//! ```text
//! δ₂M = Re Σ_ab e^(i(a+b)θ) {−(i/2) m_a [W_a, W_b] − i (m_a + m_b) χ_ab}
//! χ_ab = S_ab/(iΩ_ab) − Ṡ_ab/(iΩ_ab)²,   S_ab = ½ [D_a, W_b]
//! ```
//!
//! and the same with h for m gives δ₂L. ⟨D⟩ is one more a, with S_ab = [⟨D⟩, W_b] and without the first part. Quotients of a power of √σ and √σ are
//! formed before σ is: the sum is regular at σ = 0.

use num_complex::Complex;

use super::modes::{Mode, SMALLEST_ROOT};
use crate::gravity_gradient::corrections::Mean;
use crate::gravity_gradient::generator::ORDERS;
use crate::gravity_gradient::inertia::Inertia;

type C64 = Complex<f64>;

/// A symmetric tensor: components 11, 22, 33, 12, 13, 23.
pub(super) type Tensor = [f64; 6];
/// The contraction of a tensor for one m, and its derivatives when the frame turns about its axes 1 and 2.
type Contraction = [C64; 3];

/// The state at which the sum is taken.
pub(super) struct Stand<'a> {
    pub(super) inertia: &'a Inertia,
    pub(super) mean: &'a Mean,
    /// q = 3φn²/2.
    pub(super) strength: f64,
    /// (a/r)³ r̂r̂ in the frame and its time derivatives.
    pub(super) tensors: &'a [Tensor; ORDERS],
    /// Largest sizes of the time derivatives, as many and one more.
    pub(super) norms: &'a [f64],
    /// Frequency below which pairs are left out: the fastest of the orbit's times [`SMALLEST_RATIO`](crate::gravity_gradient::candidate::SMALLEST_RATIO).
    pub(super) slowest: f64,
    /// Mean motion of the disturbing body.
    pub(super) mean_motion: f64,
    /// Longest time from the epoch.
    pub(super) duration: f64,
    /// Largest (a/r)³ within the span, over that at the epoch.
    pub(super) closest: f64,
    /// Second time derivative of (a/r)³ r̂r̂ at the epoch, over it.
    pub(super) bend: f64,
    /// Sum of the moments of inertia.
    pub(super) trace: f64,
}

/// Safety factor of slow pairs. S is taken at the epoch, and elsewhere on the orbit the directions to the disturbing body may make it larger.
const SOURCE_MARGIN: f64 = 3.0;
/// What χ lacks of a pair is at most this many times its first term.
const MOST_LEFT: f64 = 1.5;
/// Pairs whose sizes, over the largest, have a smaller product are left out.
const SMALLEST_PRODUCT: f64 = 1e-6;

/// δ₂M and δ₂L.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Actions {
    pub(super) momentum: f64,
    pub(super) action: f64,
    /// What the sum leaves of them: pairs that are too slow, the rest of the two terms in d/dt, and pairs that are left out for their size.
    pub(super) left: [f64; 2],
    /// The largest changes by one pair over the product of its relative sizes.
    largest: [f64; 2],
}

/// A contraction and its derivative with respect to Ω.
#[derive(Clone, Copy, Default)]
struct Part {
    value: Contraction,
    slope: C64,
}

/// One term, or ⟨D⟩.
#[derive(Clone, Copy)]
struct Row {
    harmonic: f64,
    multiple: f64,
    /// Relative size.
    size: f64,
    /// Ω and its derivatives with respect to σ and M.
    frequency: [f64; 3],
    /// q e^(i(hℓ′+my′)), and −i for m = 1.
    weight: C64,
    /// F = σ^(|h|/2) f, √σ dF/dσ, and h F/√σ.
    amplitude: [f64; 3],
    /// Of D, and of dD/dt.
    torque: [Part; 2],
    /// Of W, and of dW/dt.
    generator: [Part; 2],
}

/// δ₂M and δ₂L at a mean state of first order.
pub(super) fn second_actions(stand: &Stand<'_>, modes: &[Mode]) -> Actions {
    let mut half: Vec<Row> = modes.iter().map(|mode| Row::new(stand, mode)).collect();
    let largest = half.iter().fold(0.0_f64, |most, row| most.max(row.size));
    half.iter_mut().for_each(|row| row.size /= largest);
    let rows: Vec<Row> = half.iter().flat_map(|row| [*row, row.conjugate()]).collect();
    let average = Row::average(stand);
    let (mut actions, mut pruned) = (Actions::default(), 0.0);
    for b in &rows {
        // The other half of the sum is its conjugate.
        for a in &half {
            let product = a.size * b.size;
            if product < SMALLEST_PRODUCT {
                pruned += product;
            } else {
                actions.add(stand, a, b, 2.0, true);
            }
        }
        actions.add(stand, &average, b, 1.0, false);
    }
    // A pair that is left out changes M and L by no more than its product times what the pairs of the sum do.
    actions.left = [0, 1].map(|i| actions.left[i] + pruned * actions.largest[i]);
    actions
}

/// ½ ⟨{D̃, W}⟩ from the pairs whose phases cancel, with as many time derivatives as the sums have.
#[cfg(test)]
pub(super) fn averaged(stand: &Stand<'_>, modes: &[Mode]) -> f64 {
    let rows = modes.iter().map(|mode| Row::new(stand, mode));
    rows.map(|a| stand.bracket(&a, &a.torque[0], &a.conjugate(), &a.conjugate().generator[0]).re).sum()
}

impl Actions {
    fn add(&mut self, stand: &Stand<'_>, a: &Row, b: &Row, factor: f64, generating: bool) {
        let i = C64::i();
        let (torque, wave) = (&a.torque, &b.generator);
        let (h, m) = (a.harmonic + b.harmonic, a.multiple + b.multiple);
        let both =
            if generating { stand.bracket(a, &a.generator[0], b, &wave[0]) * (-0.5 * i) } else { C64::default() };
        let mut chi = C64::default();
        let omega = a.frequency[0] + b.frequency[0];
        if (h, m) != (0.0, 0.0) {
            let source = stand.bracket(a, &torque[0], b, &wave[0]);
            let change = stand.bracket(a, &torque[1], b, &wave[0]) + stand.bracket(a, &torque[0], b, &wave[1]);
            // S may be near 0 at the epoch, but not with its time derivative.
            let swing = if stand.bend > 0.0 { change.norm() / (2.0 * stand.bend.sqrt()) } else { 0.0 };
            let left = 0.5 * factor * source.norm().hypot(swing) * stand.left(omega);
            self.left = [self.left[0] + left * m.abs(), self.left[1] + left * h.abs()];
            if omega.abs() <= stand.slowest {
                return self.sum(factor, both, chi, (a, b, [h, m]));
            }
            let inverse = (i * omega).inv();
            chi = (source - change * inverse) * inverse * 0.5 * -i;
        }
        self.sum(factor, both, chi, (a, b, [h, m]));
    }

    fn sum(&mut self, factor: f64, both: C64, chi: C64, (a, b, [h, m]): (&Row, &Row, [f64; 2])) {
        let parts = [both * a.multiple + chi * m, both * a.harmonic + chi * h].map(|part| factor * part);
        self.momentum += parts[0].re;
        self.action += parts[1].re;
        if a.multiple != 0.0 || a.harmonic != 0.0 {
            self.largest = [0, 1].map(|i| self.largest[i].max(parts[i].norm() / (a.size * b.size)));
        }
    }
}

impl Stand<'_> {
    /// What χ lacks of a pair of frequency Ω, over S: the terms of its sum from the third on, or all of it if the pair is too slow.
    fn left(&self, omega: f64) -> f64 {
        if omega.abs() > self.slowest {
            // A product of two has twice the orbit's rates.
            let ratio = 2.0 * self.bend.sqrt() / omega.abs();
            let rest = if ratio < 1.0 { ratio * ratio / (1.0 - ratio) } else { MOST_LEFT };
            return rest.min(MOST_LEFT) / omega.abs();
        }
        let distance = (omega - self.mean_motion * (omega / self.mean_motion).round()).abs();
        let time = if distance * self.duration > 2.0 { 2.0 / distance } else { self.duration };
        SOURCE_MARGIN * self.closest * self.closest * time
    }

    /// The bracket of a part of one term with a part of another, with the phases.
    fn bracket(&self, a: &Row, a_part: &Part, b: &Row, b_part: &Part) -> C64 {
        let (momentum, sigma) = (self.mean.momentum, self.inertia.sigma);
        let ([x, x1, x2], [z, z1, z2]) = (a_part.value, b_part.value);
        // The derivative (h − mσ)/M ∂/∂σ + m ∂/∂M, with the factor that b's or a's amplitude gives.
        let along = |row: &Row, other: &Row, value: C64, slope: C64| {
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

impl Row {
    fn new(stand: &Stand<'_>, mode: &Mode) -> Self {
        let (h, m) = (f64::from(mode.harmonic), f64::from(mode.multiple));
        let Stand { mean, tensors, norms, strength, .. } = stand;
        let [nu, slope, _] = mode.frequency;
        let frequency = [mean.momentum * nu, mean.momentum * slope, nu];
        let angle = if mean.p == C64::default() { 0.0 } else { mean.p.arg() };
        let phase = C64::from_polar(*strength, h * angle + m * mean.longitude);
        let weight = if mode.multiple == 1 { phase * -C64::i() } else { phase };
        let contracted = tensors.map(|tensor| contraction(&tensor, mode.multiple));
        Self {
            harmonic: h,
            multiple: m,
            size: mode.size(stand.inertia.sigma.sqrt().max(SMALLEST_ROOT)),
            frequency,
            weight,
            amplitude: amplitude(mode.harmonic, mode.function, stand.inertia.sigma),
            torque: [0, 1].map(|j| Part { value: contracted[j], slope: C64::default() }),
            generator: generating(&contracted, frequency[0], norms),
        }
    }

    /// ⟨D⟩, twice: it is no part of D̃, and S has not the half of it.
    fn average(stand: &Stand<'_>) -> Self {
        let function = Mode::average(stand.inertia, stand.trace).function;
        let part = |tensor: &Tensor| Part { value: contraction(tensor, 0), slope: C64::default() };
        Self {
            harmonic: 0.0,
            multiple: 0.0,
            size: 1.0,
            frequency: [0.0; 3],
            weight: (2.0 * stand.strength).into(),
            amplitude: amplitude(0, function, stand.inertia.sigma),
            torque: [part(&stand.tensors[0]), part(&stand.tensors[1])],
            generator: [Part::default(); 2],
        }
    }

    fn conjugate(&self) -> Self {
        let conjugated =
            |part: &Part, sign: f64| Part { value: part.value.map(|c| c.conj()), slope: part.slope.conj() * sign };
        let [whole, slope, lowered] = self.amplitude;
        Self {
            harmonic: -self.harmonic,
            multiple: -self.multiple,
            size: self.size,
            frequency: self.frequency.map(|part| -part),
            weight: self.weight.conj(),
            amplitude: [whole, slope, -lowered],
            torque: self.torque.each_ref().map(|part| conjugated(part, 1.0)),
            // Ω has the other sign.
            generator: self.generator.each_ref().map(|part| conjugated(part, -1.0)),
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
fn generating(contracted: &[Contraction; ORDERS], omega: f64, norms: &[f64]) -> [Part; 2] {
    let left = |orders: usize| norms[orders] / omega.abs().powi(orders as i32);
    let orders = (1..=ORDERS).min_by(|&a, &b| left(a).total_cmp(&left(b))).unwrap_or(1);
    let inverse = (C64::i() * omega).inv();
    let mut parts = [Part::default(); 2];
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

/// c_m of a tensor and its derivatives by rotations about axes 1 and 2: U33 − tr U/3, U13 − iU23, U11 − U22 − 2iU12.
pub(super) fn contraction(&[xx, yy, zz, xy, xz, yz]: &Tensor, multiple: i32) -> Contraction {
    let c = C64::new;
    match multiple {
        0 => [c(zz - (xx + yy + zz) / 3.0, 0.0), c(-2.0 * yz, 0.0), c(2.0 * xz, 0.0)],
        1 => [c(xz, -yz), c(-xy, yy - zz), c(xx - zz, -xy)],
        _ => [c(xx - yy, -2.0 * xy), c(-2.0 * yz, -2.0 * xz), c(-2.0 * xz, 2.0 * yz)],
    }
}
