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

use super::harmonics::{Near, Part, Parts, Split, inverse};
use super::modes::{Mode, SMALLEST_ROOT};
use super::slow_pairs::{self, Around, Total};
use crate::gravity_gradient::contraction::{Contraction, Tensor, contraction};
use crate::gravity_gradient::corrections::Mean;
use crate::gravity_gradient::generator::ORDERS;
use crate::gravity_gradient::inertia::Inertia;

type C64 = Complex<f64>;

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
    /// S has the harmonics of the orbit with multiples of this frequency.
    pub(super) orbital_step: f64,
    /// Longest time from the epoch.
    pub(super) duration: f64,
    /// Largest (a/r)³ within the span, over that at the epoch.
    pub(super) closest: f64,
    /// Second time derivative of (a/r)³ r̂r̂ at the epoch, over it.
    pub(super) bend: f64,
    /// Sum of the moments of inertia.
    pub(super) trace: f64,
    /// Smaller errors of M and L, over M, are not looked at.
    pub(super) enough: f64,
}

/// Safety factor of slow pairs. S is taken at the epoch, and elsewhere on the orbit the directions to the disturbing body may make it larger.
const SOURCE_MARGIN: f64 = 3.0;
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

/// The pairs with one h and m together.
#[derive(Clone, Copy)]
struct Together {
    numbers: [f64; 2],
    /// Ω.
    frequency: f64,
    /// S and Ṡ.
    source: C64,
    change: C64,
    /// Whether one of the pair is a single harmonic of the orbit.
    single: bool,
}

/// One term, or ⟨D⟩.
#[derive(Clone, Copy)]
pub(super) struct Row {
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
    parts: Parts,
    /// Whether it is one harmonic of the orbit, which has no other time dependence than its frequency.
    single: bool,
}

/// The terms whose divisors are exact, and ⟨D⟩'s harmonics.
#[derive(Default)]
pub(super) struct Exact<'a> {
    pub(super) terms: Vec<(Mode, Split)>,
    pub(super) average: Vec<Near>,
    pub(super) around: Option<Around<'a>>,
}

/// δ₂M and δ₂L at a mean state of first order.
pub(super) fn second_actions(stand: &Stand<'_>, modes: &[Mode], exact: &Exact<'_>) -> Actions {
    let is_exact = |mode: &Mode| exact.terms.iter().any(|(other, _)| mode.is(other));
    let mut listed: Vec<Mode> = modes.iter().filter(|mode| !is_exact(mode)).copied().collect();
    let mut half: Vec<Row> = listed.iter().map(|mode| Row::new(stand, mode)).collect();
    for (mode, split) in &exact.terms {
        if stand.mean.momentum * mode.frequency[0].abs() > stand.slowest {
            listed.push(*mode);
            half.push(Row::rest(stand, mode, split));
        }
    }
    let largest = half.iter().fold(0.0_f64, |most, row| most.max(row.size));
    let single =
        exact.terms.iter().flat_map(|(mode, split)| split.near.iter().map(|near| Row::single(stand, mode, near)));
    half.extend(single.filter(|row| row.size > SMALLEST_PRODUCT * largest));
    half.iter_mut().for_each(|row| row.size /= largest);
    let rows: Vec<Row> = half.iter().flat_map(|row| [*row, row.conjugate()]).collect();
    let average = Row::average(stand);
    let averages: Vec<Row> = exact.average.iter().map(|near| average.at(near)).collect();
    let (mut actions, mut pruned, mut together) = (Actions::default(), 0.0, Vec::new());
    for b in &rows {
        // The other half of the sum is its conjugate.
        for a in &half {
            let product = a.size * b.size;
            if product < SMALLEST_PRODUCT {
                pruned += product;
            } else {
                actions.add(stand, (a, b), 2.0, &mut together);
            }
        }
        if b.single {
            averages.iter().for_each(|average| actions.add(stand, (average, b), 1.0, &mut together));
        } else {
            actions.add(stand, (&average, b), 1.0, &mut together);
        }
    }
    if let Some(around) = &exact.around {
        let (served, others): (Vec<_>, Vec<_>) =
            together.into_iter().partition(|all| !all.single && all.needs(stand, around));
        for all in others.iter().filter(|all| !all.single && all.frequency.abs() > stand.slowest) {
            let left = all.at_resonance(stand, around);
            actions.left = [actions.left[0] + all.numbers[1] * left, actions.left[1] + all.numbers[0].abs() * left];
        }
        together = others;
        if !served.is_empty() {
            let listed: Vec<_> = listed.iter().zip(&half).map(|(mode, row)| (*mode, row.size)).collect();
            let totals: Vec<_> = served.iter().map(Together::total).collect();
            let [changes, left] = slow_pairs::actions(stand, &listed, &totals, around);
            let in_the_sum = served.iter().fold([0.0; 2], |sum, all| {
                let change = all.series(stand);
                [sum[0] + all.numbers[1] * change, sum[1] + all.numbers[0] * change]
            });
            actions.momentum += changes[0] - in_the_sum[0];
            actions.action += changes[1] - in_the_sum[1];
            actions.left = [0, 1].map(|i| actions.left[i] + left[i]);
        }
    }
    let left = stand.left(&together);
    actions.left = [0, 1].map(|i| actions.left[i] + left[i]);
    // A pair that is left out changes M and L by no more than its product times what the pairs of the sum do.
    actions.left = [0, 1].map(|i| actions.left[i] + pruned * actions.largest[i]);
    actions
}

/// ½ ⟨{D̃, W}⟩ from the pairs whose phases cancel, with as many time derivatives as the sums have.
#[cfg(test)]
pub(super) fn averaged(stand: &Stand<'_>, modes: &[Mode]) -> f64 {
    let rows = modes.iter().map(|mode| Row::new(stand, mode));
    rows.map(|a| stand.bracket(&a, &a.parts.torque[0], &a.conjugate(), &a.conjugate().parts.generator[0]).re).sum()
}

impl Actions {
    /// Adds a pair, `factor` times: a term with another, or ⟨D⟩ with one.
    fn add(&mut self, stand: &Stand<'_>, (a, b): (&Row, &Row), factor: f64, together: &mut Vec<Together>) {
        let i = C64::i();
        let (torque, wave) = (&a.parts.torque, &b.parts.generator);
        let (h, m) = (a.harmonic + b.harmonic, a.multiple + b.multiple);
        let both = stand.bracket(a, &a.parts.generator[0], b, &wave[0]) * (-0.5 * i);
        let mut chi = C64::default();
        let omega = a.frequency[0] + b.frequency[0];
        if (h, m) != (0.0, 0.0) {
            let source = stand.source(a, b);
            if a.single && b.single {
                chi = source * inverse(omega, stand.duration) * -0.5;
                let turn = 0.5 * omega * stand.duration;
                let left = 0.5 * factor * source.norm() * stand.duration * (-turn * turn).exp();
                self.left = [self.left[0] + left * m.abs(), self.left[1] + left * h.abs()];
                self.sum(factor, both, chi, (a, b, [h, m]));
                return;
            }
            let change = stand.bracket(a, &torque[1], b, &wave[0]) + stand.bracket(a, &torque[0], b, &wave[1]);
            Together { numbers: [h, m], frequency: omega, source, change, single: a.single || b.single }.join(
                0.5 * factor,
                stand.orbital_step,
                together,
            );
            if omega.abs() > stand.slowest {
                let inverse = (i * omega).inv();
                chi = (source - change * inverse) * inverse * 0.5 * -i;
            }
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

impl Together {
    /// Adds this, `factor` times, to that with the same h and m, or the opposite ones.
    fn join(self, factor: f64, step: f64, all: &mut Vec<Self>) {
        let [h, m] = self.numbers;
        let conjugated = m < 0.0 || m == 0.0 && h < 0.0;
        let [source, change] =
            [self.source, self.change].map(|part| if conjugated { part.conj() } else { part } * factor);
        let numbers = if conjugated { [-h, -m] } else { [h, m] };
        let frequency = if conjugated { -self.frequency } else { self.frequency };
        let same = |other: &&mut Self| {
            (other.numbers, other.single) == (numbers, self.single) && (other.frequency - frequency).abs() < 0.1 * step
        };
        match all.iter_mut().find(same) {
            Some(other) => {
                other.source += source;
                other.change += change;
            }
            None => all.push(Self { numbers, frequency, source, change, ..self }),
        }
    }
}

impl Together {
    fn total(&self) -> Total {
        Total { numbers: self.numbers, frequency: self.frequency }
    }

    /// Whether the harmonics of the orbit are needed.
    fn needs(&self, stand: &Stand<'_>, around: &Around<'_>) -> bool {
        let [h, m] = self.numbers;
        let enough = stand.enough * stand.mean.momentum / h.abs().max(m);
        let size = if self.frequency.abs() <= stand.slowest {
            self.size(stand) * stand.left_over(self.frequency)
        } else {
            self.at_resonance(stand, around)
        };
        size > enough && around.highest(&self.total()).is_some()
    }

    /// What the harmonic of S that is nearest to resonance does.
    fn at_resonance(&self, stand: &Stand<'_>, around: &Around<'_>) -> f64 {
        let [size, distance] = around.nearest(self.frequency);
        self.size(stand) * stand.closest.powi(2) * size * (1.0 / distance).min(stand.duration)
    }

    /// S, which may be near 0 at the epoch, but not with its time derivative.
    fn size(&self, stand: &Stand<'_>) -> f64 {
        let swing = if stand.bend > 0.0 { self.change.norm() / (2.0 * stand.bend.sqrt()) } else { 0.0 };
        self.source.norm().hypot(swing)
    }

    /// The change by the sum over time derivatives, which slow pairs do not have.
    fn series(&self, stand: &Stand<'_>) -> f64 {
        if self.frequency.abs() <= stand.slowest {
            return 0.0;
        }
        let inverse = (C64::i() * self.frequency).inv();
        ((self.source - self.change * inverse) * inverse * -C64::i()).re
    }
}

impl Stand<'_> {
    /// What the sum lacks of δ₂M and δ₂L.
    fn left(&self, all: &[Together]) -> [f64; 2] {
        all.iter().fold([0.0; 2], |[momentum, action], together| {
            let [h, m] = together.numbers;
            let left = together.size(self) * self.left_over(together.frequency);
            [momentum + left * m.abs(), action + left * h.abs()]
        })
    }

    /// What χ lacks of pairs of frequency Ω, over S: the terms of its sum from the third on, or all of it if the pairs are too slow.
    fn left_over(&self, omega: f64) -> f64 {
        // A product of two has twice the orbit's rates.
        let fastest = 2.0 * self.bend.sqrt();
        let beyond = omega.abs() - fastest;
        let nearest = self.orbital_step * (omega / self.orbital_step).round();
        let distance = if beyond > 0.0 { beyond } else { (omega - nearest).abs() };
        let time = if distance * self.duration > 1.0 { 1.0 / distance } else { self.duration };
        if omega.abs() > self.slowest {
            return (fastest / omega).powi(2).min(1.0) * time;
        }
        SOURCE_MARGIN * self.closest * self.closest * time
    }

    /// [D_a, W_b].
    pub(super) fn source(&self, a: &Row, b: &Row) -> C64 {
        self.bracket(a, &a.parts.torque[0], b, &b.parts.generator[0])
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
    pub(super) fn new(stand: &Stand<'_>, mode: &Mode) -> Self {
        let contracted = stand.tensors.map(|tensor| contraction(&tensor, mode.multiple));
        let omega = stand.mean.momentum * mode.frequency[0];
        let parts = Parts {
            torque: [0, 1].map(|j| Part { value: contracted[j], slope: C64::default() }),
            generator: generating(&contracted, omega, stand.norms),
        };
        Self::of(stand, mode, parts)
    }

    /// A term with exact divisors, without its harmonics near resonance.
    fn rest(stand: &Stand<'_>, mode: &Mode, split: &Split) -> Self {
        Self::of(stand, mode, split.rest)
    }

    /// One harmonic of the orbit in a term.
    fn single(stand: &Stand<'_>, mode: &Mode, near: &Near) -> Self {
        let row = Self::of(stand, mode, near.parts());
        let share = near.torque.iter().map(|part| part.norm()).fold(0.0, f64::max) / stand.norms[0];
        let size = row.size * share * (row.frequency[0] / near.frequency).abs();
        let [_, by_sigma, by_momentum] = row.frequency;
        Self { size, frequency: [near.frequency, by_sigma, by_momentum], single: true, ..row }
    }

    fn of(stand: &Stand<'_>, mode: &Mode, parts: Parts) -> Self {
        let (h, m) = (f64::from(mode.harmonic), f64::from(mode.multiple));
        let Stand { mean, strength, .. } = stand;
        let [nu, slope, _] = mode.frequency;
        let angle = if mean.p == C64::default() { 0.0 } else { mean.p.arg() };
        let phase = C64::from_polar(*strength, h * angle + m * mean.longitude);
        Self {
            harmonic: h,
            multiple: m,
            size: mode.size(stand.inertia.sigma.sqrt().max(SMALLEST_ROOT)),
            frequency: [mean.momentum * nu, mean.momentum * slope, nu],
            weight: if mode.multiple == 1 { phase * -C64::i() } else { phase },
            amplitude: amplitude(mode.harmonic, mode.function, stand.inertia.sigma),
            parts,
            single: false,
        }
    }

    /// One harmonic of ⟨D⟩.
    fn at(&self, near: &Near) -> Self {
        let torque = [Part { value: near.torque, slope: C64::default() }, Part::default()];
        let frequency = [near.frequency, 0.0, 0.0];
        Self { frequency, parts: Parts { torque, ..Parts::default() }, single: true, ..*self }
    }

    /// ⟨D⟩, twice: it is no part of D̃, and S has not the half of it.
    pub(super) fn average(stand: &Stand<'_>) -> Self {
        let function = Mode::average(stand.inertia, stand.trace).function;
        let part = |tensor: &Tensor| Part { value: contraction(tensor, 0), slope: C64::default() };
        Self {
            harmonic: 0.0,
            multiple: 0.0,
            size: 1.0,
            frequency: [0.0; 3],
            weight: (2.0 * stand.strength).into(),
            amplitude: amplitude(0, function, stand.inertia.sigma),
            parts: Parts {
                torque: [part(&stand.tensors[0]), part(&stand.tensors[1])],
                generator: [Part::default(); 2],
            },
            single: false,
        }
    }

    pub(super) fn conjugate(&self) -> Self {
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
            parts: Parts {
                torque: self.parts.torque.each_ref().map(|part| conjugated(part, 1.0)),
                // Ω has the other sign.
                generator: self.parts.generator.each_ref().map(|part| conjugated(part, -1.0)),
            },
            single: self.single,
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
