//! Sums over the terms of one m, by time derivative, and what each term adds to them.

use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::terms::term::Term;
use crate::orbit::tensor::Deviator;
use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::torque::{Contracted, axial_contractions, contractions};

/// Number of sums over the terms: W, M ∂W/∂M, ∂W/∂p̄ + ∂W/∂p and ∂W/∂p̄ − ∂W/∂p.
pub(crate) const SUMS: usize = 4;

/// |h|, and the factors of cos hℓ′ and of i sin hℓ′ by sum, of all terms with this |h|.
type HarmonicFactors = (usize, [[f64; 2]; SUMS]);

/// The terms of one m, by time derivative.
#[derive(Clone, Debug, Default)]
pub(crate) struct TermSums {
    orders: Vec<Vec<HarmonicFactors>>,
}

impl TermSums {
    /// Adds a term with `orders` derivatives of g.
    pub(crate) fn add(&mut self, term: &Term, inertia: &Inertia, orders: usize) {
        let [still, moving] = term.factors(inertia);
        let harmonic = term.harmonic;
        let degree = harmonic.unsigned_abs() as usize;
        let sign = if harmonic < 0 { -1.0 } else { 1.0 };
        self.orders.resize_with(self.orders.len().max(orders), Vec::new);
        for (j, terms) in self.orders.iter_mut().enumerate().take(orders) {
            let place = terms.iter().position(|(other, _)| *other == degree).unwrap_or_else(|| {
                terms.push((degree, [[0.0; 2]; SUMS]));
                terms.len() - 1
            });
            // weight = (iε)^j, without the factor i for odd j; slope = (j + 1) · weight.
            let weight = if j / 2 % 2 == 0 { 1.0 } else { -1.0 } * term.frequency.powi(-(j as i32)); // j < ORDERS
            let slope = (j as f64 + 1.0) * weight;
            for (i, [even, odd]) in terms[place].1.iter_mut().enumerate() {
                let factor = still[i] * weight + moving[i] * slope;
                *even += factor;
                *odd += sign * factor;
            }
        }
    }

    /// The largest |h|.
    pub(crate) fn highest(&self) -> usize {
        self.orders.first().into_iter().flatten().map(|(degree, _)| *degree).max().unwrap_or(0)
    }

    /// The sums for the derivative j, from the powers of e^(iℓ′); none if there is no such term.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(&self, j: usize, turns: &[ComplexLanes<S>]) -> Option<[ComplexLanes<S>; SUMS]> {
        let terms = self.orders.get(j)?;
        let none = turns[0].im;
        let mut sums = [ComplexLanes { re: none, im: none }; SUMS];
        for (degree, factors) in terms {
            let turn = turns[*degree];
            for (sum, [even, odd]) in sums.iter_mut().zip(factors) {
                sum.re = turn.re.mul_add(none.all(*even), sum.re);
                sum.im = turn.im.mul_add(none.all(*odd), sum.im);
            }
        }
        Some(sums)
    }

    /// Sums for m = 0. The contraction is real; the factor −i of 1/(iΩ) makes a term imaginary for even j and real for odd j.
    #[inline(always)]
    pub(crate) fn axial<S: InstructionSet>(&self, j: usize, turns: &[ComplexLanes<S>]) -> Option<[Lanes<S>; SUMS]> {
        let terms = self.orders.get(j)?;
        let none = turns[0].im;
        let mut sums = [none; SUMS];
        let (main, other) = (1 - j % 2, j % 2);
        for (degree, factors) in terms {
            let turn = turns[*degree];
            let waves = if main == 0 { [turn.re, turn.im] } else { [turn.im, turn.re] };
            for s in 0..3 {
                sums[s] = waves[0].mul_add(none.all(factors[s][main]), sums[s]);
            }
            sums[3] = waves[1].mul_add(none.all(factors[3][other]), sums[3]);
        }
        if main == 1 {
            sums[3] = -sums[3];
        }
        Some(sums)
    }
}

/// The parts of the derivatives of W that count, divided by twice the strength.
#[derive(Clone, Copy)]
pub(crate) struct GeneratorSlopes<S: InstructionSet> {
    /// The real part with respect to p̄ and to p together, and the imaginary part of their difference.
    pub(crate) by_p: [Lanes<S>; 2],
    pub(crate) by_longitude: Lanes<S>,
    pub(crate) by_momentum: Lanes<S>,
    /// About axes that are turned by y′.
    pub(crate) by_rotation: [Lanes<S>; 2],
}

impl<S: InstructionSet> GeneratorSlopes<S> {
    /// Adds the terms that have the derivative j.
    #[inline(always)]
    pub(crate) fn add_all(
        &mut self,
        [axial, first, second]: &[TermSums; 3],
        turns: &[ComplexLanes<S>],
        j: usize,
        tensor: &Deviator<S>,
    ) {
        if let Some(sums) = axial.axial(j, turns) {
            self.add_axial(sums, tensor);
        }
        if let Some(sums) = first.at(j, turns) {
            self.add(sums, j, contractions(tensor, 1), 1.0);
        }
        if let Some(sums) = second.at(j, turns) {
            self.add(sums, j, contractions(tensor, 2), 2.0);
        }
    }

    /// Adds the terms with m = 0.
    #[inline(always)]
    pub(crate) fn add_axial(&mut self, [whole, slope, sum, difference]: [Lanes<S>; SUMS], tensor: &Deviator<S>) {
        let [value, first, second] = axial_contractions(tensor);
        self.by_momentum = slope.mul_add(value, self.by_momentum);
        self.by_p[0] = sum.mul_add(value, self.by_p[0]);
        self.by_p[1] = difference.mul_add(value, self.by_p[1]);
        self.by_rotation[0] = whole.mul_add(first, self.by_rotation[0]);
        self.by_rotation[1] = whole.mul_add(second, self.by_rotation[1]);
    }

    /// Adds the terms of another m.
    #[inline(always)]
    pub(crate) fn add(
        &mut self,
        [whole, slope, sum, difference]: [ComplexLanes<S>; SUMS],
        j: usize,
        mut contracted: Contracted<S>,
        multiple: f64,
    ) {
        if j % 2 == 1 {
            for function in &mut contracted {
                *function = function.quarter_turned();
            }
        }
        let [value, first, second] = contracted;
        let multiple = self.by_momentum.all(multiple);
        self.by_longitude = multiple.mul_add(whole.im_of_product(value), self.by_longitude);
        self.by_momentum = slope.plus_re_of_product(value, self.by_momentum);
        self.by_p[0] = sum.plus_re_of_product(value, self.by_p[0]);
        self.by_p[1] = self.by_p[1] + difference.im_of_product(value);
        self.by_rotation[0] = whole.plus_re_of_product(first, self.by_rotation[0]);
        self.by_rotation[1] = whole.plus_re_of_product(second, self.by_rotation[1]);
    }
}

impl Term {
    /// The factors of G and of −Ω ∂G/∂Ω in W, M ∂W/∂M, ∂W/∂p̄ + ∂W/∂p and ∂W/∂p̄ − ∂W/∂p.
    pub(crate) fn factors(&self, inertia: &Inertia) -> [[f64; 4]; 2] {
        let Self { harmonic, function: [value, slope, _], frequency, per_momentum: [_, by_sigma, _], .. } = *self;
        let by_sigma = inertia.momentum * by_sigma;
        let (root, degree) = (inertia.sigma.sqrt(), harmonic.abs());
        let inverse = 1.0 / frequency;
        let falling = if degree == 0 { 0.0 } else { f64::from(degree) * root.powi(degree - 1) * value };
        let further = root.powi(degree + 1);
        let [by_p, by_p_bar] = if harmonic > 0 { [falling, 0.0] } else { [0.0, falling] };
        let [sum, difference] = [by_p_bar + by_p, by_p_bar - by_p];
        let by_frequency = -inverse * inverse * further * value * by_sigma;
        let whole = inverse * root.powi(degree) * value;
        let sum = inverse * (sum + 2.0 * further * slope);
        [[whole, 0.0, sum, inverse * difference], [0.0, whole, 2.0 * by_frequency, 0.0]]
    }
}
