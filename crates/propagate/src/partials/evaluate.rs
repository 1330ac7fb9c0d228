//! Derivatives at many times, several of them at once (theory §12).
//!
//! Conservation of the angular momentum, δL = R0 δG0, gives the derivatives of the attitude from those of g, except for the component along g, which grows with
//! twice the change of the energy:
//!
//! ```text
//! δθ = g × (RᵀR0 δg0 − δg) + g (g·δθ)
//! ```
//!
//! Attitude, rates and the numbers of theory §12 are computed with a time in each lane, the matrices ([`super::matrices`]) with a parameter in each lane. All
//! quantities are in units of M = 1 and of the scaled time.

use andoyer_series::threads::{map, shared};
use nalgebra::UnitQuaternion;
use pulp::Arch;

use crate::error::Error;
use crate::input::options::Method;
use crate::motion::solved::Motion;
use crate::motion::trajectory::Trajectory;
use crate::numerics::scaling::scaled;
use crate::simd::complex_quaternion::QuaternionLanes;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::{Lanes, WIDEST};
use crate::simd::phase::elapsed;
use crate::solve::untruncated;
use crate::torque_free::closed_form::ClosedForm;
use crate::torque_free::polhode::Polhode;

use super::constants::{ParameterConstants, Setting};
use super::derivatives::Derivatives;
use super::integral::Integral;
use super::matrices::{Block, Part};
use super::sources::{Amplitudes, PartialsSource, Passing, Wobbling};

/// Smallest number of samples for each thread. With fewer samples another thread costs more than it saves.
const SAMPLES_PER_THREAD: usize = 1024;

/// The times of the derivatives, and the state at the epoch.
#[derive(Clone, Copy)]
pub(super) struct Target<'a> {
    pub(super) times: &'a [f64],
    pub(super) epoch: f64,
    /// Attitude at the epoch.
    pub(super) initial: UnitQuaternion<f64>,
    pub(super) setting: &'a Setting,
}

impl Target<'_> {
    /// Fills the outputs with the best instruction set available, on as many threads as are faster. Parts begin where lanes begin, so that no bit depends on
    /// the number of threads.
    pub(super) fn fill<T: PartialsSource + Sync>(
        self,
        source: &T,
        attitudes: &mut [Derivatives],
        rates: &mut [Derivatives],
    ) {
        let length = self.times.len();
        shared(length / SAMPLES_PER_THREAD, |threads| {
            if threads == 1 {
                dispatch(Arch::new(), TargetRun { target: self, source, attitudes, rates });
                return;
            }
            let part = length.div_ceil(threads).next_multiple_of(WIDEST);
            let outputs = attitudes.chunks_mut(part).zip(rates.chunks_mut(part));
            map(self.times.chunks(part).zip(outputs).collect(), |(times, (attitudes, rates))| {
                let target = Target { times, ..self };
                dispatch(Arch::new(), TargetRun { target, source, attitudes, rates });
            });
        });
    }

    /// Derivatives on a polhode, with every harmonic of the closed form.
    pub(super) fn wobbling(
        self,
        motion: &Motion,
        polhode: &Polhode,
        outputs: (&mut [Derivatives], &mut [Derivatives]),
    ) -> Result<(), Error> {
        if motion.plan.method != Method::Closed {
            let exact = untruncated(&motion.scene, polhode, motion.plan.mode)?;
            return self.wobbling(&exact, polhode, outputs);
        }
        let (attitudes, rates) = outputs;
        let theta = polhode.invariants.theta;
        let integral = Integral::new(&theta);
        let constants = ParameterConstants::all(self.setting, &theta, &integral);
        let anomaly_rate = scaled(motion.frequencies.anomaly, -polhode.scales.1);
        let amplitudes = |start| Amplitudes::new(self.setting, constants, anomaly_rate, theta.quarter, start);
        match &motion.trajectory {
            Trajectory::Wobble(truncated) => {
                let closed = ClosedForm::new(polhode, &theta);
                let tables = &truncated.with_series(&closed.series, closed.anomaly);
                let (sine, cosine) = (2.0 * tables.phases()[0].angle((0.0, 0.0))).sin_cos();
                let amplitudes = &amplitudes(integral.zeta((sine, cosine)));
                self.fill(&Wobbling { tables, integral: &integral, amplitudes }, attitudes, rates);
            }
            Trajectory::Passage(passage) => {
                let start = integral.zeta_of_passages(passage.passage.angle((0.0, 0.0)));
                let amplitudes = &amplitudes(start);
                self.fill(&Passing { passage, integral: &integral, amplitudes }, attitudes, rates);
            }
            Trajectory::Steady(_) | Trajectory::Forced(_) => {}
        }
        Ok(())
    }
}

/// The loop over times, compiled for each instruction set.
struct TargetRun<'a, T> {
    target: Target<'a>,
    source: &'a T,
    attitudes: &'a mut [Derivatives],
    rates: &'a mut [Derivatives],
}

impl<T: PartialsSource> Task for TargetRun<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) {
        let Self { target: Target { times, epoch, initial, setting }, source, attitudes, rates } = self;
        let width = if T::VECTORS { Lanes::<S>::WIDTH } else { 1 };
        let origin = Lanes::splat(simd, epoch);
        let initial = QuaternionLanes::all(origin, &initial);
        let parts = Part::<S, T>::all(simd, source, setting);
        let mut block = Block::new();
        let mut start = 0;
        while start < times.len() {
            let stop = times.len().min(start + width);
            let mut now = [times[start]; WIDEST];
            now[..stop - start].copy_from_slice(&times[start..stop]);
            let elapsed = elapsed(Lanes::load(simd, &now), origin);
            block.gather(setting, initial, &source.place(simd, setting, elapsed));
            block.fill(simd, &parts, stop - start);
            block.copy_to(&mut attitudes[start..stop], &mut rates[start..stop]);
            start = stop;
        }
    }
}
