//! The changes of M and L = Mσ of second order, as one sum over pairs of terms: equation (4) of docs/theory-second-order.md.
//!
//! With D = Σ D_a e^(i(h_a ℓ′ + m_a y′)), dW/dt = D − ⟨D⟩ and the bracket \[ , \] of two amplitudes by equation (1),
//!
//! ```text
//! δ₂M = Re Σ_ab e^(i(h_a+h_b)ℓ′ + i(m_a+m_b)y′) {−(i/2) m_a [W_a, W_b] − i (m_a + m_b) χ_ab}
//! χ_ab = R_ab/(iΩ_ab) − Ṙ_ab/(iΩ_ab)²,   R_ab = ½ [D_a, W_b]
//! ```
//!
//! and δ₂L has h in place of m. ⟨D⟩ is one more a, with R_ab = [⟨D⟩, W_b] and without the first part. σ^(|h|/2)/√σ is
//! evaluated as σ^((|h|−1)/2), so the sum is regular at σ = 0.
//!
//! A harmonic of the orbit near resonance is a term of its own, of frequency Ω + jn and of constant amplitude; a pair of two such terms has the divisor of both
//! frequencies together. Pairs for which two terms of χ are not enough are summed around the orbit ([`crate::gravity_gradient::second_order::pairs_around`]).
//!
//! The corrections lack χ. Where Ω_ab is small beside n, it turns the phases by ∂Ω_ab/∂M χ/Ω_ab, as the changes of M and L by the pair would in the time 1/Ω_ab.

use std::collections::BTreeMap;

use super::pair_harmonics::{SplitTerm, inverse, unreturned};
use super::pair_terms::{PairTerm, SecondOrderState};
use super::pairs_around::{PairSum, by_harmonics};
use crate::gravity_gradient::constants::CUTOFF;
use crate::gravity_gradient::terms::term::Term;
use crate::numerics::C64;

/// Changes of M and L at the epoch.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Actions {
    pub(crate) momentum: f64,
    pub(crate) action: f64,
    /// Errors of both.
    pub(crate) left: [f64; 2],
    /// Parts of both by pairs next to resonance, times 1/(|Ω_ab| span): within the span they turn the phases as errors of M and L of this size do.
    pub(crate) swung: [f64; 2],
}

/// The sources of pairs of single harmonics, by h and m, where the harmonic of the orbit in the pair is the nearest to resonance; with the least |Ω_ab|.
type NearPairs = BTreeMap<[i32; 2], (C64, f64)>;

/// δ₂M and δ₂L at a mean state of first order, from the terms, those whose divisors are exact, and the harmonics of ⟨D⟩.
pub(crate) fn second_actions(
    state: &SecondOrderState<'_>,
    terms: &[Term],
    exact: &[SplitTerm],
    averages: &[PairTerm],
) -> Actions {
    let mut half: Vec<PairTerm> = terms.iter().map(|term| PairTerm::new(state, term)).collect();
    half.retain(|term| !exact.iter().any(|split| split.rest.is(term)));
    half.extend(exact.iter().map(|split| split.rest).filter(|rest| rest.frequency[0].abs() > state.slow_limit()));
    let listed = half.len();
    let single: Vec<PairTerm> = exact.iter().flat_map(|split| &split.near).copied().collect();
    let largest_of = |rows: &[PairTerm]| rows.iter().fold(0.0_f64, |most, row| most.max(row.size));
    let largest = if half.is_empty() { largest_of(&single) } else { largest_of(&half) };
    half.extend(single.into_iter().filter(|row| row.size > CUTOFF * largest));
    half.iter_mut().for_each(|row| row.size /= largest);
    let rows: Vec<PairTerm> = half.iter().flat_map(|row| [*row, row.conjugate()]).collect();
    let average = PairTerm::average(state);
    let (mut actions, mut together, mut near) = (Actions::default(), Vec::new(), NearPairs::new());
    for b in &rows {
        // The other half of the sum is its conjugate.
        for a in half.iter().filter(|a| a.size * b.size >= CUTOFF) {
            actions.add(state, (a, b), 2.0, (&mut together, &mut near));
        }
        if b.single {
            // The mean of ⟨D⟩ is in the divisors of harmonics near resonance.
            let others = averages.iter().filter(|average| !b.shifted || average.frequency[0] != 0.0);
            others.for_each(|average| actions.add(state, (average, b), 1.0, (&mut together, &mut near)));
        } else {
            actions.add(state, (&average, b), 1.0, (&mut together, &mut near));
        }
    }
    for ([h, m], (source, frequency)) in near {
        actions.swing([h, m].map(f64::from), (source.norm(), frequency), state.disturbance.duration);
    }
    let (served, others): (Vec<_>, Vec<_>) = together.into_iter().partition(|pairs| pairs.needs(state));
    for pairs in &others {
        let resonant = if state.disturbance.series.is_some() { pairs.at_resonance(state) } else { 0.0 };
        actions.change(pairs.numbers, pairs.by_sum(state), pairs.sum_error(state).hypot(resonant));
    }
    if !served.is_empty() {
        let mut errors = [0.0; 2];
        for (pairs, [part, left, nearest, distance]) in
            served.iter().zip(by_harmonics(state, &half[..listed], &served, exact))
        {
            let [h, m] = pairs.numbers.map(f64::abs);
            actions.change(pairs.numbers, part, 0.0);
            actions.swing(pairs.numbers, (nearest, distance), state.disturbance.duration);
            errors = [errors[0] + m * left, errors[1] + h * left];
        }
        actions.left = [0, 1].map(|i| actions.left[i].hypot(errors[i]));
    }
    actions
}

impl Actions {
    /// Adds a pair, `factor` times: a term with another, or ⟨D⟩ with one. χ of terms that are not single harmonics is left to `together`.
    fn add(
        &mut self,
        state: &SecondOrderState<'_>,
        (a, b): (&PairTerm, &PairTerm),
        factor: f64,
        (together, near): (&mut Vec<PairSum>, &mut NearPairs),
    ) {
        let (torque, wave) = (&a.torque, &b.generator);
        let both = 0.5 * factor * state.bracket(a, &a.generator[0], b, &wave[0]).im;
        self.momentum += a.multiple * both;
        self.action += a.harmonic * both;
        let numbers = [a.harmonic + b.harmonic, a.multiple + b.multiple];
        if numbers == [0.0; 2] {
            return;
        }
        let (factor, frequency) = (0.5 * factor, a.frequency[0] + b.frequency[0]);
        let source = state.bracket(a, &torque[0], b, &wave[0]) * factor;
        if a.single && b.single {
            let duration = state.disturbance.duration;
            let left = source.norm() * unreturned(frequency, duration);
            if frequency.abs() <= 0.5 * state.disturbance.mean_motion {
                let [h, m] = numbers.map(|number| number as i32); // sums of two h and of two m
                let opposite = m < 0 || m == 0 && h < 0;
                let key = if opposite { [-h, -m] } else { [h, m] };
                let (sum, least) = near.entry(key).or_insert((C64::default(), f64::INFINITY));
                *sum += if opposite { source.conj() } else { source };
                *least = least.min(frequency.abs());
            }
            return self.change(numbers, -source.re * inverse(frequency, duration), left);
        }
        let change = (state.bracket(a, &torque[1], b, &wave[0]) + state.bracket(a, &torque[0], b, &wave[1])) * factor;
        let pair = PairSum { numbers, frequency, source, change };
        // A pair with a single harmonic of the orbit in it has its own frequency, and is not joined.
        if a.single || b.single {
            self.change(numbers, pair.by_sum(state), 0.0);
        } else {
            pair.join(together);
        }
    }

    /// Adds the swing of M and L by all pairs of one h and m, from the size of their source and their frequency.
    fn swing(&mut self, [h, m]: [f64; 2], (source, frequency): (f64, f64), duration: f64) {
        let distance = frequency.abs().max(f64::MIN_POSITIVE);
        let swung = source * inverse(distance, duration) * (1.0 / (distance * duration)).min(1.0);
        self.swung = [self.swung[0] + m.abs() * swung, self.swung[1] + h.abs() * swung];
    }

    /// Adds h and m times a part to the changes of L and M, and times its error to their errors. The phases of the pairs are independent: the squares of the
    /// errors add up.
    fn change(&mut self, [h, m]: [f64; 2], part: f64, left: f64) {
        self.momentum += m * part;
        self.action += h * part;
        self.left = [self.left[0].hypot(m * left), self.left[1].hypot(h * left)];
    }
}
