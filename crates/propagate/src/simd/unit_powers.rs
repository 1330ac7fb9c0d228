//! Powers of complex numbers of size 1.

use super::complex_quaternion::ComplexLanes;
use super::instruction_set::InstructionSet;

/// Memory for at most `MOST` powers of a complex number, from the power 0 on. Where `FEW` of them suffice, just these are computed: their number is known to the
/// compiler, and the longest chain of products has four (up to 17 powers).
pub(crate) struct UnitPowers<S: InstructionSet, const FEW: usize, const MOST: usize> {
    few: [ComplexLanes<S>; FEW],
    many: Option<[ComplexLanes<S>; MOST]>,
}

impl<S: InstructionSet, const FEW: usize, const MOST: usize> UnitPowers<S, FEW, MOST> {
    /// Without powers; `like` has the instruction set.
    #[inline(always)]
    pub(crate) fn new(like: ComplexLanes<S>) -> Self {
        const { assert!(2 <= FEW && FEW <= MOST) };
        Self { few: [one(like); FEW], many: None }
    }

    /// The powers 0, 1, … of a number, as many as `count`, which is 1 to `MOST`.
    #[inline(always)]
    pub(crate) fn of(&mut self, number: ComplexLanes<S>, count: usize) -> &[ComplexLanes<S>] {
        if count <= FEW {
            self.few[1] = number;
            for k in 2..FEW {
                self.few[k] = self.few[k / 2] * self.few[k - k / 2];
            }
            return &self.few[..count];
        }
        let powers = self.many.insert([one(number); MOST]);
        let mut last = one(number);
        for power in powers.iter_mut().take(count).skip(1) {
            last = last * number;
            *power = last;
        }
        &powers[..count]
    }
}

#[inline(always)]
fn one<S: InstructionSet>(like: ComplexLanes<S>) -> ComplexLanes<S> {
    ComplexLanes { re: like.re.all(1.0), im: like.re.all(0.0) }
}
