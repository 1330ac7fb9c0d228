//! Terms whose divisors are exact in the orbit's harmonics: equation (9) of docs/theory-second-order.md.
//!
//! If the orbit is not much slower than a term, the sum over time derivatives for G ends before it is accurate. With g = Σ g_j e^(ijl) in the mean anomaly l,
//!
//! ```text
//! G = Σ_j g_j e^(ijl)/(i(Ω + jn)) = (E + iO)/(iΩ)          Ω² ∂G/∂Ω = −(E₁ + iO₁)/i
//! ```
//!
//! With r_± = 1/(Ω ± jn), the coefficients of E and E₁ are Ω(r₊ + r₋) and Ω²(r₊² + r₋²), and those of O and O₁ have differences instead of the sums. Near
//! resonance the average torque shifts the divisors ([`crate::gravity_gradient::terms::divisors`]). For an even g, E is a series in cos jl and O one in sin jl. So E
//! replaces the sum of the even time derivatives, and O that of the odd ones. The harmonic nearest to resonance may have the solution that vanishes at the epoch
//! instead ([`crate::gravity_gradient::terms::regime`]).

use std::f64::consts::TAU;

use pulp::NullaryFnOnce;

use super::epoch_solution::{EpochSolution, PARTS};
use super::sums::{GeneratorSlopes, SUMS};
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::terms::divisors::Divisors;
use crate::gravity_gradient::terms::term::Term;
use crate::orbit::hansen::OrbitSeries;
use crate::orbit::kepler::Place;
use crate::orbit::tensor::Products;
use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::simd::sincos::sin_cos_of_turns;
use crate::torque::{Contracted, axial_contractions, contractions};

/// One term.
#[derive(Clone, Debug)]
pub(crate) struct ExactTerm {
    /// h and m.
    pub(crate) numbers: (i32, i32),
    pub(crate) divisors: Divisors,
    /// The factors of G and of −Ω ∂G/∂Ω in W, M ∂W/∂M, ∂W/∂p̄ + ∂W/∂p and ∂W/∂p̄ − ∂W/∂p.
    factors: [[f64; SUMS]; 2],
    /// The coefficients of (a/r)³ times 1, cos 2f and sin 2f, by j, function and part.
    coefficients: Vec<[[f64; PARTS]; 3]>,
    /// The harmonic whose solution vanishes at the epoch.
    resonant: Option<EpochSolution>,
}

impl ExactTerm {
    /// Its memory, in bytes.
    pub(crate) fn memory(&self) -> usize {
        size_of::<Self>() + size_of_val(&self.coefficients[..])
    }

    /// A term with these divisors in the series. Coefficients whose part of the term is smaller than a tenth of `nothing` are dropped.
    /// `unit` is the unit of rates in the user's.
    pub(crate) fn new(
        term: &Term,
        inertia: &Inertia,
        (series, divisors): (&OrbitSeries, Divisors),
        (nothing, unit): (f64, f64),
    ) -> Self {
        let negligible = 0.1 * nothing / term.size();
        let mut coefficients: Vec<_> = (0..)
            .zip(&series.coefficients)
            .map(|(j, [one, cosine, sine])| {
                // For j = 0 both harmonics are one.
                let share = if j == 0 { 0.5 } else { 1.0 };
                // Coefficients of e^(ijl) and e^(−ijl) in the series of 1, cos 2f and sin 2f, without factors i.
                let at = |power: i32| {
                    let ratio =
                        |j: i32, turns: i32| share * (divisors.frequency * divisors.reciprocal(j, turns)).powi(power);
                    let [sum, difference] = [0.5 * (cosine + sine), 0.5 * (cosine - sine)];
                    let [after, before] = [
                        [sum * ratio(j, 2), difference * ratio(j, -2)],
                        [sum * ratio(-j, -2), difference * ratio(-j, 2)],
                    ];
                    [
                        [one * ratio(j, 0), one * ratio(-j, 0)],
                        [after[0] + after[1], before[0] + before[1]],
                        [after[0] - after[1], before[0] - before[1]],
                    ]
                };
                let (first, square) = (at(1), at(2));
                let parts = |f: usize| {
                    let ([after, before], [after_square, before_square]) = (first[f], square[f]);
                    let sign = if f < 2 { 1.0 } else { -1.0 };
                    [
                        after + before,
                        sign * (after - before),
                        after_square + before_square,
                        sign * (after_square - before_square),
                    ]
                };
                [parts(0), parts(1), parts(2)]
            })
            .collect();
        let something = |terms: &[[f64; PARTS]; 3]| terms.iter().flatten().any(|c| c.abs() > negligible);
        coefficients.truncate(coefficients.iter().rposition(something).map_or(0, |last| last + 1));
        let numbers = (term.harmonic, term.multiple);
        let resonant = divisors.resonant.map(|number| EpochSolution::new(number, series, &divisors, unit));
        Self { numbers, divisors, factors: term.factors(inertia), coefficients, resonant }
    }

    /// |h|.
    pub(crate) fn degree(&self) -> usize {
        self.numbers.0.unsigned_abs() as usize
    }

    /// m.
    fn multiple(&self) -> usize {
        self.numbers.1 as usize // 0 ≤ m ≤ 2
    }

    /// The parts of the three functions at a mean anomaly, which is given by its cosine and sine, and at times after the epoch.
    #[inline(always)]
    fn parts<S: InstructionSet>(&self, (anomaly, elapsed): (ComplexLanes<S>, Lanes<S>)) -> [[Lanes<S>; 3]; PARTS] {
        let none = anomaly.re.all(0.0);
        let mut parts = [[none; 3]; PARTS];
        let mut turn = ComplexLanes { re: none.all(1.0), im: none };
        for functions in &self.coefficients {
            for (function, coefficients) in functions.iter().enumerate() {
                for (part, coefficient) in coefficients.iter().enumerate() {
                    let wave = if (part % 2 == 0) == (function < 2) { turn.re } else { turn.im };
                    parts[part][function] = wave.mul_add(none.all(*coefficient), parts[part][function]);
                }
            }
            turn = turn * anomaly;
        }
        if let Some(resonant) = &self.resonant {
            resonant.add(&mut parts, anomaly, elapsed);
        }
        parts
    }

    /// e^(ihℓ′), from the powers of e^(iℓ′).
    #[inline(always)]
    fn turn<S: InstructionSet>(&self, turns: &[ComplexLanes<S>]) -> ComplexLanes<S> {
        let turn = turns[self.degree()];
        if self.numbers.0 < 0 { turn.conjugate() } else { turn }
    }

    /// Adds this term to the sums for m = 1 or 2. `functions` holds the contractions of the factors of 1, cos 2f and sin 2f in r̂r̂.
    #[inline(always)]
    fn add<S: InstructionSet>(
        &self,
        sums: &mut GeneratorSlopes<S>,
        functions: &[Contracted<S>; 3],
        turns: &[ComplexLanes<S>],
        when: (ComplexLanes<S>, Lanes<S>),
    ) {
        let parts = self.parts(when);
        let turn = self.turn(turns);
        let none = turn.re.all(0.0);
        let mut value = ComplexLanes { re: none, im: none };
        let (mut slope, mut rotation) = (none, [none; 2]);
        for (f, [function, first, second]) in functions.iter().enumerate() {
            let wave = turn * ComplexLanes { re: parts[0][f], im: parts[1][f] };
            let moving = turn * ComplexLanes { re: parts[2][f], im: parts[3][f] };
            value = value.plus(wave, *function);
            slope = moving.plus_re_of_product(*function, slope);
            for (part, by) in rotation.iter_mut().zip([first, second]) {
                *part = wave.plus_re_of_product(*by, *part);
            }
        }
        self.add_parts(sums, value, slope, rotation);
    }

    /// Adds this term to the sums for m = 0, where the contractions are real.
    #[inline(always)]
    fn add_axial<S: InstructionSet>(
        &self,
        sums: &mut GeneratorSlopes<S>,
        functions: &[[Lanes<S>; 3]; 3],
        turns: &[ComplexLanes<S>],
        when: (ComplexLanes<S>, Lanes<S>),
    ) {
        let parts = self.parts(when);
        let turn = self.turn(turns);
        let none = turn.re.all(0.0);
        let mut wave = [ComplexLanes { re: none, im: none }; 3];
        let mut moving = wave[0];
        for (f, function) in functions.iter().enumerate() {
            for (sum, by) in wave.iter_mut().zip(function) {
                sum.re = parts[0][f].mul_add(*by, sum.re);
                sum.im = parts[1][f].mul_add(*by, sum.im);
            }
            moving.re = parts[2][f].mul_add(function[0], moving.re);
            moving.im = parts[3][f].mul_add(function[0], moving.im);
        }
        // Times −i.
        let [value, first, second] = wave;
        let minus_re = turn.re.negate_mul_add(value.re, turn.im * value.im);
        let value = ComplexLanes { re: turn.im_of_product(value), im: minus_re };
        let rotation = [turn.im_of_product(first), turn.im_of_product(second)];
        self.add_parts(sums, value, turn.im_of_product(moving), rotation);
    }

    /// Adds this term to the derivatives of W. `value` is its part of W, `slope` the real part of −Ω ∂/∂Ω of it, and `rotation` has its derivatives when the
    /// frame turns about its axes 1 and 2, all without the factors.
    #[inline(always)]
    fn add_parts<S: InstructionSet>(
        &self,
        sums: &mut GeneratorSlopes<S>,
        value: ComplexLanes<S>,
        slope: Lanes<S>,
        rotation: [Lanes<S>; 2],
    ) {
        let [[whole, _, sum, difference], [_, _, sum_by_frequency, _]] = self.factors;
        let all = |factor: f64| slope.all(factor);
        sums.by_longitude = value.im.mul_add(all(whole * f64::from(self.numbers.1)), sums.by_longitude);
        sums.by_momentum = slope.mul_add(all(whole), sums.by_momentum);
        sums.by_p[0] = slope.mul_add(all(sum_by_frequency), value.re.mul_add(all(sum), sums.by_p[0]));
        sums.by_p[1] = value.im.mul_add(all(difference), sums.by_p[1]);
        for (total, part) in sums.by_rotation.iter_mut().zip(rotation) {
            *total = part.mul_add(all(whole), *total);
        }
    }
}

/// The sums with the exact terms added, as a task that is compiled separately: most scenes do without it.
pub(crate) struct ExactTerms<'a, S: InstructionSet> {
    pub(crate) terms: &'a [ExactTerm],
    pub(crate) turns: &'a [ComplexLanes<S>],
    pub(crate) products: &'a Products<S>,
    pub(crate) place: &'a Place<S>,
    /// Times after the epoch.
    pub(crate) elapsed: Lanes<S>,
    pub(crate) sums: GeneratorSlopes<S>,
}

impl<S: InstructionSet> NullaryFnOnce for ExactTerms<'_, S> {
    type Output = GeneratorSlopes<S>;

    #[inline(always)]
    fn call(self) -> GeneratorSlopes<S> {
        let Self { terms, turns, products, place, elapsed, mut sums } = self;
        let none = place.sine.all(0.0);
        let (sine, cosine) = sin_cos_of_turns((place.angle - place.centre) * none.all(1.0 / TAU));
        let when = (ComplexLanes { re: cosine, im: sine }, elapsed);
        // The lists are filled without `map`, which is not inlined into code for an instruction set.
        for multiple in 0..=2 {
            let mut terms = terms.iter().filter(|term| term.multiple() == multiple).peekable();
            if terms.peek().is_none() {
                continue;
            }
            if multiple == 0 {
                let mut functions = [[none; 3]; 3];
                for (function, product) in functions.iter_mut().zip(products) {
                    *function = axial_contractions(product);
                }
                for term in terms {
                    term.add_axial(&mut sums, &functions, turns, when);
                }
            } else {
                let zero = ComplexLanes { re: none, im: none };
                let mut functions = [[zero; 3]; 3];
                for (function, product) in functions.iter_mut().zip(products) {
                    *function = contractions(product, multiple);
                }
                for term in terms {
                    term.add(&mut sums, &functions, turns, when);
                }
            }
        }
        sums
    }
}
