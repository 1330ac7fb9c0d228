//! The changes of M and L = Mσ of second order, as one sum over pairs of terms.
//!
//! With D = Σ D_a e^(iaθ), a = (h, m), θ = (ℓ′, y′), dW/dt = D − ⟨D⟩ and the bracket \[ , \] of two amplitudes (theory §9),
//!
//! ```text
//! δ₂M = Re Σ_ab e^(i(a+b)θ) {−(i/2) m_a [W_a, W_b] − i (m_a + m_b) χ_ab}
//! χ_ab = S_ab/(iΩ_ab) − Ṡ_ab/(iΩ_ab)²,   S_ab = ½ [D_a, W_b]
//! ```
//!
//! and δ₂L has h in place of m. ⟨D⟩ is one more a, with S_ab = [⟨D⟩, W_b] and without the first part. Quotients of a power of √σ and √σ are
//! formed before σ is: the sum is regular at σ = 0.
//!
//! A harmonic of the orbit near resonance is a term of its own, of frequency Ω + jn and of constant amplitude; a pair of two such terms has the divisor of both
//! frequencies together. Pairs for which two terms of χ are not enough are summed around the orbit ([`crate::gravity_gradient::second_order::pairs_around`]).

use super::CUTOFF;
use super::pair_harmonics::{Near, Split, inverse, unreturned};
use super::pair_terms::{PairTerm, Stand};
use super::pairs_around;
use super::pairs_around::{Around, Total};
use crate::gravity_gradient::terms::term::Term;
use crate::numerics::C64;
/// δ₂M and δ₂L.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Actions {
    pub(crate) momentum: f64,
    pub(crate) action: f64,
    /// Their errors: of the sums around the orbit, and of the sums over time derivatives of the other pairs.
    pub(crate) left: [f64; 2],
}

/// The harmonics of the orbit in the sum.
#[derive(Default)]
pub(crate) struct OrbitParts<'a> {
    /// The terms whose divisors are exact.
    pub(crate) terms: Vec<(Term, Split)>,
    /// ⟨D⟩'s harmonics.
    pub(crate) average: Vec<Near>,
    /// The orbit, where its harmonics are known.
    pub(crate) around: Option<Around<'a>>,
}

/// δ₂M and δ₂L at a mean state of first order.
pub(crate) fn second_actions(stand: &Stand<'_>, terms: &[Term], exact: &OrbitParts<'_>) -> Actions {
    let is_exact = |term: &Term| exact.terms.iter().any(|(other, _)| term.is(other));
    let mut listed: Vec<Term> = terms.iter().filter(|term| !is_exact(term)).copied().collect();
    let mut half: Vec<PairTerm> = listed.iter().map(|term| PairTerm::new(stand, term)).collect();
    for (term, split) in &exact.terms {
        if stand.mean.momentum * term.frequency[0].abs() > stand.slowest {
            listed.push(*term);
            half.push(PairTerm::of(stand, term, split.rest));
        }
    }
    let single: Vec<PairTerm> = exact
        .terms
        .iter()
        .flat_map(|(term, split)| split.near.iter().map(|near| PairTerm::single(stand, term, near)))
        .collect();
    let largest_of = |rows: &[PairTerm]| rows.iter().fold(0.0_f64, |most, row| most.max(row.size));
    let largest = if half.is_empty() { largest_of(&single) } else { largest_of(&half) };
    half.extend(single.into_iter().filter(|row| row.size > CUTOFF * largest));
    half.iter_mut().for_each(|row| row.size /= largest);
    let rows: Vec<PairTerm> = half.iter().flat_map(|row| [*row, row.conjugate()]).collect();
    let average = PairTerm::average(stand);
    let averages: Vec<PairTerm> = exact.average.iter().map(|near| average.at(near)).collect();
    let (mut actions, mut together) = (Actions::default(), Vec::new());
    for b in &rows {
        // The other half of the sum is its conjugate.
        for a in half.iter().filter(|a| a.size * b.size >= CUTOFF) {
            actions.add(stand, (a, b), 2.0, &mut together);
        }
        if b.single {
            // The mean of ⟨D⟩ is in the divisors of harmonics near resonance.
            let others = averages.iter().filter(|average| !b.shifted || average.frequency[0] != 0.0);
            others.for_each(|average| actions.add(stand, (average, b), 1.0, &mut together));
        } else {
            actions.add(stand, (&average, b), 1.0, &mut together);
        }
    }
    if let Some(around) = &exact.around {
        let listed: Vec<_> = listed.into_iter().zip(half.iter().map(|row| row.size)).collect();
        together = actions.around(stand, &listed, together, (around, &exact.terms));
        together.iter().for_each(|all| actions.add_error(all.of_actions(all.at_resonance(stand, around))));
    }
    together.iter().for_each(|all| actions.add_error(all.sum_error(stand)));
    actions
}

/// ½ ⟨{D̃, W}⟩ from the pairs whose phases cancel, with as many time derivatives as the sums have.
#[cfg(test)]
pub(crate) fn averaged(stand: &Stand<'_>, terms: &[Term]) -> f64 {
    let rows = terms.iter().map(|term| PairTerm::new(stand, term));
    rows.map(|a| stand.bracket(&a, &a.parts.torque[0], &a.conjugate(), &a.conjugate().parts.generator[0]).re).sum()
}

impl Actions {
    /// Adds a pair, `factor` times: a term with another, or ⟨D⟩ with one.
    fn add(&mut self, stand: &Stand<'_>, (a, b): (&PairTerm, &PairTerm), factor: f64, together: &mut Vec<PairSum>) {
        let i = C64::i();
        let (torque, wave) = (&a.parts.torque, &b.parts.generator);
        let (h, m) = (a.harmonic + b.harmonic, a.multiple + b.multiple);
        let both = stand.bracket(a, &a.parts.generator[0], b, &wave[0]) * (-0.5 * i);
        let omega = a.frequency[0] + b.frequency[0];
        let mut chi = C64::default();
        if (h, m) != (0.0, 0.0) {
            let source = stand.source(a, b);
            if a.single && b.single {
                chi = source * inverse(omega, stand.duration) * -0.5;
                let left = 0.5 * factor * source.norm() * unreturned(omega, stand.duration);
                self.add_error([left * m, left * h]);
            } else {
                let change = stand.bracket(a, &torque[1], b, &wave[0]) + stand.bracket(a, &torque[0], b, &wave[1]);
                let total = Total { numbers: [h, m], frequency: omega };
                // A pair with a single harmonic of the orbit in it has its own frequency, and is not joined.
                if !a.single && !b.single {
                    PairSum { total, source, change }.join(0.5 * factor, together);
                }
                if omega.abs() > stand.slowest {
                    let inverse = (i * omega).inv();
                    chi = (source - change * inverse) * inverse * 0.5 * -i;
                }
            }
        }
        self.momentum += factor * (both * a.multiple + chi * m).re;
        self.action += factor * (both * a.harmonic + chi * h).re;
    }

    /// Takes the pairs that need it by the harmonics of the orbit instead, and returns the others.
    fn around(
        &mut self,
        stand: &Stand<'_>,
        listed: &[(Term, f64)],
        together: Vec<PairSum>,
        (around, exact): (&Around<'_>, &[(Term, Split)]),
    ) -> Vec<PairSum> {
        let (served, others): (Vec<_>, Vec<_>) = together.into_iter().partition(|all| all.needs(stand, around));
        if !served.is_empty() {
            let totals: Vec<_> = served.iter().map(|all| all.total).collect();
            let [changes, left] = pairs_around::actions(stand, listed, &totals, (around, exact));
            self.add_error(left);
            let by_sums = served.iter().map(|all| all.of_actions(all.by_sum(stand)));
            let [momentum, action] = by_sums.fold(changes, |sum, part| [sum[0] - part[0], sum[1] - part[1]]);
            self.momentum += momentum;
            self.action += action;
        }
        others
    }

    /// Adds to the errors. The phases of the pairs are independent: the squares add up.
    fn add_error(&mut self, left: [f64; 2]) {
        self.left = [0, 1].map(|i| self.left[i].hypot(left[i]));
    }
}

/// Safety factor of slow pairs. S is taken at the epoch, and elsewhere on the orbit the directions to the disturbing body may make it larger.
const SOURCE_MARGIN: f64 = 3.0;

/// All pairs with one total.
#[derive(Clone, Copy)]
pub(crate) struct PairSum {
    pub(crate) total: Total,
    /// S and Ṡ.
    pub(crate) source: C64,
    pub(crate) change: C64,
}

impl PairSum {
    /// Adds this sum, `factor` times, to the sum in the list that has its total or the opposite one.
    pub(crate) fn join(self, factor: f64, all: &mut Vec<Self>) {
        let Total { numbers: [h, m], frequency } = self.total;
        let opposite = m < 0.0 || m == 0.0 && h < 0.0;
        let sign = if opposite { -1.0 } else { 1.0 };
        let total = Total { numbers: [sign * h, sign * m], frequency: sign * frequency };
        let [source, change] =
            [self.source, self.change].map(|part| if opposite { part.conj() } else { part } * factor);
        let same = all.iter_mut().find(|other| other.total.numbers == total.numbers);
        match same {
            Some(other) => {
                other.source += source;
                other.change += change;
            }
            None => all.push(Self { total, source, change }),
        }
    }

    /// `part` times m and times h: the parts of M and of L.
    pub(crate) fn of_actions(&self, part: f64) -> [f64; 2] {
        let [h, m] = self.total.numbers;
        [m * part, h * part]
    }

    /// Errors of the changes of M and L by the sum over time derivatives.
    pub(crate) fn sum_error(&self, stand: &Stand<'_>) -> [f64; 2] {
        self.of_actions(self.size(stand) * stand.relative_sum_error(self.total.frequency)).map(f64::abs)
    }

    /// Whether the harmonics of the orbit are needed, and are not too many. On a circle they are few, and better than the sum over time derivatives.
    pub(crate) fn needs(&self, stand: &Stand<'_>, around: &Around<'_>) -> bool {
        let resonant = self.of_actions(self.at_resonance(stand, around)).map(f64::abs);
        let by_sum =
            if self.is_slow(stand) || around.eccentricity == 0.0 { self.sum_error(stand) } else { Default::default() };
        let enough = stand.enough * stand.mean.momentum;
        let left = [0, 1].map(|i| resonant[i] + by_sum[i]);
        left.iter().any(|left| *left > enough) && around.highest(&self.total).is_some()
    }

    /// Whether there is no sum over time derivatives.
    fn is_slow(&self, stand: &Stand<'_>) -> bool {
        self.total.frequency.abs() <= stand.slowest
    }

    /// The change by the harmonic of S nearest to resonance, which the sum over time derivatives does not contain; 0 for slow pairs, which have no such sum.
    pub(crate) fn at_resonance(&self, stand: &Stand<'_>, around: &Around<'_>) -> f64 {
        if self.is_slow(stand) {
            return 0.0;
        }
        let [size, distance] = around.nearest(self.total.frequency);
        self.size(stand) * stand.closest * stand.closest * size * (1.0 / distance).min(stand.duration)
    }

    /// Size of S. S may vanish at the epoch, so its time derivative is included.
    fn size(&self, stand: &Stand<'_>) -> f64 {
        let swing = if stand.bend > 0.0 { self.change.norm_sqr() / (4.0 * stand.bend) } else { 0.0 };
        (self.source.norm_sqr() + swing).sqrt()
    }

    /// The real part of S/Ω by the sum over time derivatives.
    pub(crate) fn by_sum(&self, stand: &Stand<'_>) -> f64 {
        if self.is_slow(stand) {
            return 0.0;
        }
        let inverse = (C64::i() * self.total.frequency).inv();
        ((self.source - self.change * inverse) * inverse * -C64::i()).re
    }
}

impl Stand<'_> {
    /// Error of χ for pairs of frequency Ω, divided by S: the terms of its sum from the third on; for slow pairs all of χ.
    fn relative_sum_error(&self, omega: f64) -> f64 {
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
}
