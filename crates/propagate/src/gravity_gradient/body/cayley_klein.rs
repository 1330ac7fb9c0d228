//! The harmonics of a and b for a motion near the mean motion, as polynomials in p² and p̄².

use super::inertia::{HIGHEST, Harmonics};
use crate::gravity_gradient::constants::SMALLEST_HARMONIC;
use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// The harmonics of a or b that are not negligible, with their slopes, as polynomials in p² and p̄². The first list has h ≥ 0, the second h < 0.
#[derive(Clone, Debug)]
pub(crate) struct WobbleSeries([Vec<[f64; 2]>; 2]);

impl WobbleSeries {
    pub(crate) fn new(series: &Harmonics, root: f64) -> Self {
        let odd = series.at(0).0 == 0.0;
        let side = |first: usize, sign: i32| {
            let terms = (first..=HIGHEST).step_by(2).map(|h| (h as i32, <[f64; 2]>::from(series.at(sign * h as i32))));
            let mut terms: Vec<_> = terms.collect();
            while let Some((degree, [value, slope])) = terms.last()
                && root.powi(*degree) * (value.abs() + slope.abs() * root * root) < SMALLEST_HARMONIC
            {
                terms.pop();
            }
            terms.into_iter().map(|(_, pair)| pair).collect()
        };
        if odd { Self([side(1, 1), side(1, -1)]) } else { Self([side(0, 1), side(2, -1)]) }
    }

    /// The two sums, without the remaining factors p and p̄.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(&self, square: ComplexLanes<S>, beyond: Lanes<S>) -> [ComplexLanes<S>; 2] {
        let zero = beyond.all(0.0);
        let mut sums = [ComplexLanes { re: zero, im: zero }; 2];
        for ((sum, terms), by) in sums.iter_mut().zip(&self.0).zip([square, square.conjugate()]) {
            for [value, slope] in terms.iter().rev() {
                let factor = ComplexLanes { re: beyond.mul_add(zero.all(*slope), zero.all(*value)), im: zero };
                *sum = factor.plus(*sum, by);
            }
        }
        sums
    }
}
