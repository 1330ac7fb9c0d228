//! Attitudes and rates from the mean motion, at several times at once: phases, the averaged motion of the frame, corrections, and the harmonics of a and b
//! (theory §8).

use std::any::Any;
use std::f64::consts::TAU;

use pulp::{Arch, NullaryFnOnce};

use crate::gravity_gradient::disturbed::DisturbedMotion;
use crate::gravity_gradient::first_order::corrections::Corrections;
use crate::gravity_gradient::first_order::fourier::ExactTerm;
use crate::gravity_gradient::first_order::generator::{Correction, MeanLanes};
use crate::motion::forced::{End, Forced};
use crate::orbit::position::{Elapsed, Path};
use crate::simd::circles::{Evaluate, Instants};
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::halt::Halt;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::Lanes;
use crate::simd::phase::elapsed;
use crate::simd::run::Run;

/// Memory of the tables for one disturbing body, at most \[bytes\]: 18 to 50 kB.
const TABLES: usize = 1 << 16;

/// The reason why the times of a motion averaged over the spin are bounded.
const SOLVED: &str =
    ": averaging = spin solves the averaged equations no farther; averaging over the orbit reaches farther";

/// The reason why the times of a motion solved on arcs of time are bounded.
const SOLVED_ON_ARCS: &str = ": the averaged equations are solved no farther";

/// Osculating variables at some times: p, cosine and sine of y′/2, M, and the invariable frame, which is not normalized.
#[derive(Clone, Copy)]
pub(crate) struct Osculating<S: InstructionSet> {
    pub(crate) p: ComplexLanes<S>,
    pub(crate) half: ComplexLanes<S>,
    pub(crate) momentum: Lanes<S>,
    pub(crate) frame: QuaternionLanes<S>,
}

impl DisturbedMotion {
    /// The osculating variables at times after the epoch. The function is compiled separately, once for each instruction set.
    #[inline(always)]
    pub(crate) fn state<S: InstructionSet>(&self, elapsed: Elapsed<S>) -> Osculating<S> {
        elapsed.0.simd().vectorize(GradientAt { gradient: self, elapsed })
    }

    #[inline(always)]
    fn osculating<S: InstructionSet>(&self, elapsed: Elapsed<S>) -> Osculating<S> {
        let all = |value: f64| elapsed.0.all(value);
        let (path, corrections) = &self.bodies[0];
        let first = path.at(elapsed);
        let (frame, [by_anomaly, by_longitude]) = self.slow.at(&first, elapsed);
        let plane = |(im, re): (Lanes<S>, Lanes<S>)| ComplexLanes { re, im };
        let turn = plane(self.anomaly.sin_cos_beyond(elapsed, by_anomaly * all(self.drifts[0] / TAU)));
        let half = plane(self.half_longitude.sin_cos_beyond(elapsed, by_longitude * all(0.5 * self.drifts[1] / TAU)));
        let mean = MeanLanes { turn, spin: half * half, frame, elapsed: elapsed.0 };
        let mut change = corrections.generator.at(&mean, &first.place, &first.axes);
        for body in &self.bodies[1..] {
            change = change.plus(elapsed.0.simd().vectorize(OtherBody { body, mean: &mean, elapsed }));
        }
        let widened = elapsed.0.mul_add(all(self.widening), all(self.circle.re));
        let relative = ComplexLanes { re: change.p.re + widened, im: change.p.im + all(self.circle.im) };
        let [x, y] = change.rotation;
        let zero = all(0.0);
        Osculating {
            p: turn * relative,
            half: half * small_turn(all(0.5) * change.longitude),
            momentum: change.momentum + all(self.momentum),
            frame: frame * QuaternionLanes([all(0.5) * x, all(0.5) * y, zero, all(1.0)]),
        }
    }

    /// The quaternion of theory §8 for a state near the mean state, not normalized.
    #[inline(always)]
    pub(crate) fn relative<S: InstructionSet>(&self, state: &Osculating<S>) -> QuaternionLanes<S> {
        let Osculating { p, half, .. } = *state;
        let beyond = p.re.mul_add(p.re, p.im.mul_add(p.im, p.re.all(-self.inertia.sigma)));
        let square = p * p;
        let [[a, a_bar], [b, b_bar]] = [self.pair[0].at(square, beyond), self.pair[1].at(square, beyond)];
        let a = a.plus(a_bar, square.conjugate()) * half;
        let b = (b * p).plus(b_bar, p.conjugate()) * half;
        QuaternionLanes([b.re, b.im, a.im, a.re])
    }
}

impl Evaluate for DisturbedMotion {
    const BY_CIRCLES: bool = false;

    #[inline(always)]
    fn evaluate<S: InstructionSet, const ATTITUDE: bool, const RATES: bool>(
        &self,
        _: S,
        at: impl Instants<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]) {
        let elapsed = at.elapsed();
        let state = self.state(elapsed);
        let relative = self.relative(&state);
        let zero = elapsed.0.all(0.0);
        let mut rates = [zero; 3];
        if RATES {
            let body = relative.third_row();
            for i in 0..3 {
                let factor = self.frame.signs[i] * self.units[0] / self.moments[i];
                rates[self.frame.axes[i]] = state.momentum * body[i] * zero.all(factor);
            }
        }
        let mut attitude = [zero; 4];
        if ATTITUDE {
            let turned = state.frame * relative * QuaternionLanes::all(zero, &self.frame.quaternion);
            attitude = turned.normalized().0;
        }
        (attitude, rates)
    }
}

impl Forced for DisturbedMotion {
    fn name(&self) -> &'static str {
        "a motion under a torque"
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn memory(&self) -> usize {
        let exact = self.bodies.iter().flat_map(|(_, corrections)| &corrections.generator.exact).map(ExactTerm::memory);
        TABLES * self.bodies.len() + exact.sum::<usize>() + self.slow.memory()
    }

    fn fill(&self, arch: Arch, run: Run<'_>) -> Result<(), Halt> {
        run.in_lanes(arch, self)
    }

    fn ends(&self, phases: End) -> [End; 2] {
        let solved = (self.bound(), if self.is_by_quarters() { SOLVED } else { SOLVED_ON_ARCS });
        [if solved.0 < phases.0 { solved } else { phases }; 2]
    }

    fn angular_momenta(&self, times: &[f64], epoch: f64, out: &mut [[f64; 3]]) -> bool {
        dispatch(Arch::new(), Momenta { gradient: self, times, epoch, out });
        true
    }
}

/// The corrections for one of further bodies, as a task that is compiled separately: the first body's are inlined.
struct OtherBody<'a, S: InstructionSet> {
    body: &'a (Path, Corrections),
    mean: &'a MeanLanes<S>,
    elapsed: Elapsed<S>,
}

impl<S: InstructionSet> NullaryFnOnce for OtherBody<'_, S> {
    type Output = Correction<S>;

    #[inline(always)]
    fn call(self) -> Correction<S> {
        let (path, corrections) = self.body;
        let position = path.at(self.elapsed);
        corrections.generator.at(self.mean, &position.place, &position.axes)
    }
}

/// [`DisturbedMotion::state`] as a task that is compiled separately.
struct GradientAt<'a, S: InstructionSet> {
    gradient: &'a DisturbedMotion,
    elapsed: Elapsed<S>,
}

impl<S: InstructionSet> NullaryFnOnce for GradientAt<'_, S> {
    type Output = Osculating<S>;

    #[inline(always)]
    fn call(self) -> Osculating<S> {
        self.gradient.osculating(self.elapsed)
    }
}

/// e^(ix) for |x| ≤ 0.05, to 2e-17.
#[inline(always)]
fn small_turn<S: InstructionSet>(x: Lanes<S>) -> ComplexLanes<S> {
    let square = x * x;
    let series = |coefficients: &[f64]| square.polynomial(coefficients);
    ComplexLanes {
        re: series(&[1.0, -1.0 / 2.0, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40320.0]),
        im: x * series(&[1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0]),
    }
}

/// Angular momenta at many times.
struct Momenta<'a> {
    gradient: &'a DisturbedMotion,
    times: &'a [f64],
    epoch: f64,
    out: &'a mut [[f64; 3]],
}

impl Task for Momenta<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) {
        let epoch = Lanes::splat(simd, self.epoch);
        let width = Lanes::<S>::WIDTH;
        for (times, rows) in self.times.chunks(width).zip(self.out.chunks_mut(width)) {
            let state = self.gradient.state(elapsed(Lanes::load(simd, times), epoch));
            let matrix = state.frame.normalized().rows();
            let size = state.momentum * epoch.all(self.gradient.units[1]);
            for c in 0..3 {
                for (row, value) in rows.iter_mut().zip((matrix[c][2] * size).values()) {
                    row[c] = *value;
                }
            }
        }
    }
}
