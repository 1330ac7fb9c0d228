//! The largest first-order change of the attitude among samples, computed for several samples at once.

use nalgebra::UnitQuaternion;

use super::Subject;
use crate::gravity_gradient::corrections::Corrections;
use crate::gravity_gradient::course::fixed;
use crate::gravity_gradient::generator::MeanLanes;
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::kepler::Ellipse;
use crate::simd::lanes::{Lanes, WIDEST};
use crate::simd::sincos::sin_cos_of_turns;

/// A place of the mean motion and of the disturbing body.
pub(super) struct Sample {
    /// ℓ′ and y′ in turns.
    pub(super) angles: [f64; 2],
    /// Mean anomaly of the disturbing body.
    pub(super) orbital: f64,
    /// By which the mean frame is turned.
    pub(super) turn: UnitQuaternion<f64>,
}

impl Sample {
    /// As numbers: angles, mean anomaly, quaternion.
    fn numbers(&self) -> [f64; NUMBERS] {
        let [anomaly, longitude] = self.angles;
        let turn = &self.turn;
        [anomaly, longitude, self.orbital, turn.i, turn.j, turn.k, turn.w]
    }
}

/// Numbers of a sample.
const NUMBERS: usize = 7;

impl Subject<'_> {
    /// The largest first-order change of the attitude, and the largest change of p.
    pub(super) fn largest_among(&self, samples: &[Sample]) -> [f64; 2] {
        dispatch(
            pulp::Arch::new(),
            Largest { subject: self, ellipse: Ellipse::new(self.ellipse.eccentricity), samples },
        )
    }
}

struct Largest<'a> {
    subject: &'a Subject<'a>,
    ellipse: Ellipse,
    samples: &'a [Sample],
}

impl Task for Largest<'_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> [f64; 2] {
        let Self { subject, ellipse, samples } = self;
        let (none, width) = (Lanes::splat(simd, 0.0), Lanes::<S>::WIDTH);
        let mut largest = [none; 2];
        for block in samples.chunks(width) {
            // The last sample fills the lanes that are left.
            let mut columns = [[0.0; WIDEST]; NUMBERS];
            for lane in 0..width {
                let numbers = block[lane.min(block.len() - 1)].numbers();
                for n in 0..NUMBERS {
                    columns[n][lane] = numbers[n];
                }
            }
            let mut numbers = [none; NUMBERS];
            for n in 0..NUMBERS {
                numbers[n] = Lanes::load(simd, &columns[n]);
            }
            let sizes = sizes(subject, &ellipse, numbers);
            for i in 0..2 {
                largest[i] = largest[i].largest(sizes[i]);
            }
        }
        let of = |lanes: &Lanes<S>| lanes.values().iter().fold(0.0_f64, |most, &size| most.max(size));
        [of(&largest[0]), of(&largest[1])]
    }
}

/// The first-order change of the attitude, and the change of p.
#[inline(always)]
fn sizes<S: InstructionSet>(
    subject: &Subject<'_>,
    ellipse: &Ellipse,
    [anomaly, longitude, orbital, x, y, z, w]: [Lanes<S>; NUMBERS],
) -> [Lanes<S>; 2] {
    let Corrections { generator, .. } = subject.corrections;
    let (sine, cosine) = sin_cos_of_turns(anomaly);
    let turn = ComplexLanes { re: cosine, im: sine };
    let (sine, cosine) = sin_cos_of_turns(longitude);
    let spin = ComplexLanes { re: cosine, im: sine };
    let frame = QuaternionLanes([x, y, z, w]) * QuaternionLanes::all(x, &subject.mean.frame);
    let axes = fixed(&generator.axes, x);
    let change = generator.at(&MeanLanes { turn, spin, frame }, &ellipse.place(orbital), &axes);
    let p = change.p.re.mul_add(change.p.re, change.p.im * change.p.im).root();
    let [first, second] = change.rotation;
    let (of_p, momentum) = (p * p.all(subject.response.gain), change.momentum * p.all(1.0 / subject.mean.momentum));
    let mut sum = of_p * of_p;
    for part in [change.longitude, first, second, momentum] {
        sum = part.mul_add(part, sum);
    }
    [sum.root(), p]
}
