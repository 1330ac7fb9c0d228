//! The derivatives of W at some times, as sums over the terms.

use super::deviator::{Contracted, Deviator, axial_contractions, contractions};
use super::sums::{SUMS, Sums};
use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// The parts of the derivatives of W that count, divided by twice the strength.
#[derive(Clone, Copy)]
pub(crate) struct Derivatives<S: InstructionSet> {
    /// The real part with respect to p̄ and to p together, and the imaginary part of their difference.
    pub(crate) by_p: [Lanes<S>; 2],
    pub(crate) by_longitude: Lanes<S>,
    pub(crate) by_momentum: Lanes<S>,
    /// About axes that are turned by y′.
    pub(crate) by_rotation: [Lanes<S>; 2],
}

impl<S: InstructionSet> Derivatives<S> {
    /// Adds the terms that have the derivative j.
    #[inline(always)]
    pub(crate) fn add_all(
        &mut self,
        [axial, first, second]: &[Sums; 3],
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
