//! The sums of harmonics of one set of variables, at several times at once.
//!
//! With the inner phase M and the other phases x, harmonics k·x + jM and k·x − jM of equal k share e^{ik·x}: Re e^{ik·x} Σ_j (c₊ e^{ijM} + c₋ e^{−ijM}). The sum over j
//! takes four products for a variable and a pair of harmonics, and no product of two complex lanes: (c₊ + c₋) cos jM + i (c₊ − c₋) sin jM.

use std::collections::BTreeMap;

use andoyer_series::num_complex::Complex;
use andoyer_series::periodic::Harmonic;

use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// Three proper angles, M and α.
pub(super) const PHASES: usize = 5;
/// All of them but the inner one.
pub(super) const OUTER: usize = PHASES - 1;

/// The harmonics of N variables.
#[derive(Clone, Debug)]
pub(super) struct Waves<const N: usize> {
    groups: Vec<Group>,
    joined: Vec<JoinedHarmonics<N>>,
}

/// Harmonics with equal multiples of the outer phases.
#[derive(Clone, Debug)]
struct Group {
    multiples: [i32; OUTER],
    /// The end of its joined harmonics.
    end: usize,
}

/// Two harmonics: j, and c₊ + c₋ and i (c₊ − c₋) of each variable as real and imaginary parts.
#[derive(Clone, Debug)]
struct JoinedHarmonics<const N: usize> {
    power: usize,
    amplitudes: [[f64; 4]; N],
}

/// c₊ and c₋ of each variable.
type Sides<const N: usize> = [[Complex<f64>; 2]; N];

/// The phase with which the harmonics have the fewest groups.
pub(super) fn inner_phase(harmonics: &[Harmonic]) -> usize {
    let groups = |inner: &usize| {
        let mut all: Vec<[i64; OUTER]> =
            harmonics.iter().map(|harmonic| split(&harmonic.multiples, *inner).0).collect();
        all.sort_unstable();
        all.dedup();
        all.len()
    };
    (0..PHASES).min_by_key(groups).unwrap_or(0)
}

/// The multiples of the outer phases, the first that is not 0 positive, that of the inner one, and whether their signs were changed.
fn split(multiples: &[i64], inner: usize) -> ([i64; OUTER], i64, bool) {
    let others = outer_phases(inner).map(|phase| multiples[phase]);
    let negative = others.iter().chain([&multiples[inner]]).find(|&&k| k != 0).is_some_and(|&k| k < 0);
    let sign = if negative { -1 } else { 1 };
    (others.map(|k| sign * k), sign * multiples[inner], negative)
}

/// The phases other than the inner one.
pub(super) fn outer_phases(inner: usize) -> [usize; OUTER] {
    std::array::from_fn(|place| place + usize::from(place >= inner))
}

impl<const N: usize> Waves<N> {
    /// The waves of those variables, for an inner phase.
    pub(super) fn new(harmonics: &[Harmonic], variables: [usize; N], inner: usize) -> Self {
        let mut sorted: BTreeMap<[i64; OUTER], BTreeMap<usize, Sides<N>>> = BTreeMap::new();
        for harmonic in harmonics {
            let amplitudes = variables.map(|variable| harmonic.amplitudes[variable]);
            if amplitudes.iter().all(|c| c.norm() == 0.0) {
                continue;
            }
            let (outer, j, conjugate) = split(&harmonic.multiples, inner);
            let pairs = sorted.entry(outer).or_default();
            let pair = pairs.entry(j.unsigned_abs() as usize).or_insert([[Complex::default(); 2]; N]);
            for (sides, c) in pair.iter_mut().zip(amplitudes) {
                sides[usize::from(j < 0)] += if conjugate { c.conj() } else { c };
            }
        }
        let mut waves = Self { groups: Vec::with_capacity(sorted.len()), joined: Vec::new() };
        for (outer, pairs) in sorted {
            waves.joined.extend(pairs.into_iter().map(|(power, sides)| JoinedHarmonics::new(power, sides)));
            waves.groups.push(Group { multiples: outer.map(|k| k as i32), end: waves.joined.len() });
        }
        waves
    }

    /// Its memory on the heap, in bytes.
    pub(super) fn memory(&self) -> usize {
        self.groups.capacity() * size_of::<Group>() + self.joined.capacity() * size_of::<JoinedHarmonics<N>>()
    }

    /// The first M variables, from the powers of the outer phases and of the inner one.
    #[inline(always)]
    pub(super) fn sums<S: InstructionSet, const M: usize>(
        &self,
        outer: [&[ComplexLanes<S>]; OUTER],
        inner: &[ComplexLanes<S>],
        zero: Lanes<S>,
    ) -> [Lanes<S>; M] {
        let one = ComplexLanes { re: zero.all(1.0), im: zero };
        // Sums of products with real and with imaginary parts, each by itself: their chains of additions are half as long.
        let mut sums = [[zero; 2]; M];
        let (mut last, mut start) = ([0; OUTER], 0);
        // e^{ik·x} of the first phases: neighbours share them.
        let (mut two, mut three) = (one, one);
        for Group { multiples, end } in &self.groups {
            let [i, j, k, l] = *multiples;
            let [before_i, before_j, before_k, _] = last;
            if i != before_i || j != before_j {
                two = power(outer[0], i) * power(outer[1], j);
            }
            if i != before_i || j != before_j || k != before_k {
                three = if k == 0 { two } else { two * power(outer[2], k) };
            }
            last = *multiples;
            let turn = if l == 0 { three } else { three * power(outer[3], l) };
            let mut inside = [[zero; 4]; M];
            for joined in &self.joined[start..*end] {
                let ComplexLanes { re, im } = inner[joined.power];
                for (sums, &[a, b, c, d]) in inside.iter_mut().zip(&joined.amplitudes) {
                    sums[0] = re.mul_add(zero.all(a), sums[0]);
                    sums[1] = im.mul_add(zero.all(c), sums[1]);
                    sums[2] = re.mul_add(zero.all(b), sums[2]);
                    sums[3] = im.mul_add(zero.all(d), sums[3]);
                }
            }
            start = *end;
            for (sum, inside) in sums.iter_mut().zip(&inside) {
                sum[0] = turn.re.mul_add(inside[0] + inside[1], sum[0]);
                sum[1] = turn.im.mul_add(inside[2] + inside[3], sum[1]);
            }
        }
        let mut differences = [zero; M];
        for (difference, sum) in differences.iter_mut().zip(&sums) {
            *difference = sum[0] - sum[1];
        }
        differences
    }
}

impl<const N: usize> JoinedHarmonics<N> {
    fn new(power: usize, sides: Sides<N>) -> Self {
        let amplitudes = sides.map(|[ahead, behind]| {
            let (even, odd) = (ahead + behind, Complex::<f64>::i() * (ahead - behind));
            [even.re, even.im, odd.re, odd.im]
        });
        Self { power, amplitudes }
    }
}

/// A power of a number of size 1 with either sign.
#[inline(always)]
fn power<S: InstructionSet>(powers: &[ComplexLanes<S>], exponent: i32) -> ComplexLanes<S> {
    let power = powers[exponent.unsigned_abs() as usize];
    if exponent < 0 { power.conjugate() } else { power }
}
