//! Rotation under the gravity gradient of a body on a Keplerian orbit (theory §9).
//!
//! The mean motion is the free one at the mean σ and M, in an invariable frame that the averaged torque carries along ([`slow`]); short-period [`corrections`] of
//! first order lead from it to the motion. Each is regular at J = 0 and at any inclination. Validity: rotation much faster than the orbit, torque weak; a divisor that is too
//! small is [`Error::Resonance`]. What is left is of second order in the torque, and grows with time.

mod corrections;
mod generator;
mod inertia;
mod level;
mod slow;
#[cfg(test)]
mod tests;

pub use level::Level;

use std::f64::consts::TAU;
use std::fmt;
use std::str::FromStr;

use andoyer_series::DoubleDouble;
use nalgebra::{Quaternion, UnitQuaternion};
use num_complex::Complex;
use pulp::NullaryFnOnce;

use crate::error::Error;
use crate::kernel::lanes::Lanes;
use crate::kernel::level::{Level as Instructions, Task, dispatch};
use crate::kernel::plane::{Plane, Turns};
use crate::orbit::{Orbit, Place};
use crate::phase::{Phase, elapsed};
use crate::plan::GradientPlan;
use crate::polhode::{Frame, Polhode, scaled};
use corrections::{Change, Corrections, Demand, Mean, SHARE, second_order};
use inertia::{HIGHEST, Harmonics, Inertia};
use slow::{Ellipse, MOST_QUARTERS, Precession, Slow, Spin, When};

type C64 = Complex<f64>;

/// Changes of the mean variables below which they are converged.
const CONVERGED: f64 = 1e-15;
/// Steps to the mean variables.
const MOST_STEPS: usize = 12;
/// A harmonic of a or b below this turns nothing \[rad\].
const NEGLIGIBLE: f64 = 1e-18;
/// Torque over M²/C above which an expansion in it has no first order.
pub(crate) const STRONGEST: f64 = 0.02;

/// How far the equations are averaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Averaging {
    /// Whatever meets the tolerance at the lowest cost.
    #[default]
    Auto,
    /// Over rotation and orbit: formulas.
    Orbit,
    /// Over the rotation: the averaged equations are solved quarter by quarter of the orbit.
    Spin,
}

impl FromStr for Averaging {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "auto" => Ok(Self::Auto),
            "orbit" => Ok(Self::Orbit),
            "spin" => Ok(Self::Spin),
            _ => Err(Error::Averaging { value: text.to_owned() }),
        }
    }
}

impl fmt::Display for Averaging {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Orbit => "orbit",
            Self::Spin => "spin",
        })
    }
}

/// A motion under the gravity gradient.
#[derive(Clone, Debug)]
pub(crate) struct Gradient {
    inertia: Inertia,
    pair: [Powers; 2],
    corrections: Corrections,
    slow: Slow,
    anomaly: Phase,
    half_longitude: Phase,
    mean_anomaly: Phase,
    eccentricity: f64,
    root: f64,
    /// J times these is added to ℓ′ and y′.
    drifts: [f64; 2],
    frame: Frame,
    moments: [f64; 3],
    level: Level,
    /// Units of the motion: of rate and angular momentum over the user's.
    units: [f64; 2],
    pub(crate) error: f64,
}

/// Time since the epoch, with its rounding error.
type Elapsed<S> = (Lanes<S>, Lanes<S>);

/// Osculating variables at some times: p, the circle of y′/2, M, and the invariable frame, but for its norm.
#[derive(Clone, Copy)]
struct State<S: Instructions> {
    p: Plane<S>,
    half: Plane<S>,
    momentum: Lanes<S>,
    frame: Turns<S>,
}

/// What is asked of the perturbed motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request<'a> {
    pub(crate) orbit: &'a Orbit,
    pub(crate) averaging: Averaging,
    pub(crate) level: Level,
    pub(crate) tolerance: f64,
    pub(crate) epoch: f64,
    /// Longest time from the epoch, in the user's unit.
    pub(crate) duration: f64,
}

impl Gradient {
    /// From a polhode, the attitude at the epoch and where the state is on the polhode (ℓ′ and y′ − y there).
    pub(crate) fn new(
        polhode: &Polhode,
        attitude: UnitQuaternion<f64>,
        osculating: (f64, [f64; 2]),
        request: &Request<'_>,
    ) -> Result<Self, Error> {
        let exponent = polhode.scales.1;
        let orbit = request.orbit;
        let mean_motion = scaled(orbit.mean_motion(), -exponent);
        let momentum = polhode.momentum.to_f64();
        let [_, _, third] = polhode.moments;
        let duration = scaled(request.duration, exponent);
        let demand =
            Demand { orbit, mean_motion, level: request.level, tolerance: request.tolerance, duration, share: SHARE };
        let size = 1.5 * (mean_motion / (momentum / third)).powi(2) * orbit.disturbing_fraction()
            / (1.0 - orbit.eccentricity()).powi(3);
        if size > STRONGEST {
            // A resonance is the better reason, if it is one.
            Corrections::new(&Inertia::new(polhode, osculating.0, momentum), &demand)?;
            return Err(Error::TorqueTooStrong { size, bound: STRONGEST });
        }
        let mean_anomaly = orbit.mean_anomaly(request.epoch);
        let none = Lanes::splat(pulp::Scalar, 0.0);
        let start = when(&mean_anomaly, (none, none), orbit.eccentricity());
        let (sigma, [anomaly, longitude]) = osculating;
        let state = Mean {
            p: C64::from_polar(sigma.sqrt(), anomaly),
            longitude,
            momentum,
            frame: invariable_frame(polhode, attitude),
        };
        let MeanMotion { mean, change, inertia, corrections } = mean_motion_of(polhode, &state, &start, &demand)?;
        let (axial, axial_slope) = request.level.axial(&inertia);
        let fraction = orbit.disturbing_fraction();
        let delta = (1.5 * axial - 0.5 * polhode.moments.iter().sum::<f64>()) * fraction;
        let ellipse = Ellipse::new(orbit, mean_motion, delta / mean.momentum);
        // Rates are proportional to M, which as a double would leave 1e-16 of the phases.
        let precise = (polhode.momentum - change.momentum.into()) / mean.momentum.into();
        let [anomaly_rate, longitude_rate] = inertia.rates.map(|rate| rate * precise);
        let budget = Budget {
            spin: second_order(corrections.size, &inertia, duration),
            strength: ellipse.strength(),
            orbital: mean_motion * duration,
        };
        let by_orbit = match request.averaging {
            Averaging::Orbit => true,
            Averaging::Spin => false,
            Averaging::Auto => budget.of_the_orbit() <= request.tolerance,
        };
        let error = budget.spin
            + if by_orbit { budget.of_the_orbit() } else { 0.0 }
            + corrections.dropped
            + 2.0 * corrections.rest;
        let slow = if by_orbit {
            Slow::Orbit(Precession::new(ellipse, mean.frame, &start.place, scaled(1.0, exponent)))
        } else {
            Slow::Spin(Box::new(Spin::new(ellipse, mean.frame, &start)))
        };
        // ⟨D⟩ = −½ (dJ/dt) Δ: its derivatives with respect to L and M at fixed L.
        let slope = -0.5 * 1.5 * axial_slope * fraction / mean.momentum;
        let user =
            |rate: DoubleDouble| DoubleDouble { high: scaled(rate.high, exponent), low: scaled(rate.low, exponent) };
        Ok(Self {
            anomaly: Phase::new(user(anomaly_rate), mean.p.arg()),
            half_longitude: Phase::new(user(longitude_rate) * 0.5.into(), 0.5 * mean.longitude),
            mean_anomaly,
            eccentricity: orbit.eccentricity(),
            root: mean.p.norm(),
            drifts: [slope, -slope * inertia.sigma],
            pair: inertia.pair.each_ref().map(|series| Powers::new(series, inertia.sigma.sqrt())),
            inertia,
            corrections,
            slow,
            frame: polhode.frame.clone(),
            moments: polhode.moments,
            level: request.level,
            units: [scaled(1.0, exponent), polhode.user_momentum() / momentum],
            error,
        })
    }

    /// Mean rates of ℓ′ and y′ in the user's unit.
    pub(crate) fn frequencies(&self) -> [f64; 2] {
        [self.anomaly.frequency() * TAU, 2.0 * self.half_longitude.frequency() * TAU]
    }

    /// The longest time from the epoch that quarters are kept for, in the user's unit.
    pub(crate) fn bound(&self) -> f64 {
        match self.slow {
            Slow::Spin(_) => (MOST_QUARTERS / 4 - 2) as f64 / self.mean_anomaly.frequency(),
            Slow::Orbit(_) => f64::INFINITY,
        }
    }

    /// What the plan says of it.
    pub(crate) fn plan(&self) -> GradientPlan {
        GradientPlan {
            averaging: match self.slow {
                Slow::Spin(_) => Averaging::Spin,
                Slow::Orbit(_) => Averaging::Orbit,
            },
            level: self.level,
            terms: self.corrections.count,
            size: self.corrections.size,
        }
    }

    /// What this scene did not need.
    pub(crate) fn skipped(&self) -> Vec<String> {
        let mut skipped = Vec::new();
        if self.corrections.dropped > 0.0 {
            skipped
                .push(format!("short-period terms: those dropped are {:.1e} rad together", self.corrections.dropped));
        }
        if self.eccentricity == 0.0 {
            skipped.push("Kepler's equation: the orbit is a circle".to_owned());
        }
        skipped
    }

    /// The motion at times after the epoch, in osculating variables: compiled by itself, once for each instruction set.
    #[inline(always)]
    fn state<S: Instructions>(&self, elapsed: Elapsed<S>) -> State<S> {
        elapsed.0.simd().vectorize(At { gradient: self, elapsed })
    }

    #[inline(always)]
    fn osculating<S: Instructions>(&self, elapsed: Elapsed<S>) -> State<S> {
        let all = |value: f64| elapsed.0.all(value);
        let when = when(&self.mean_anomaly, elapsed, self.eccentricity);
        let (frame, phase) = self.slow.at(&when, elapsed);
        let plane = |(im, re): (Lanes<S>, Lanes<S>)| Plane { re, im };
        let turn = plane(self.anomaly.sin_cos_beyond(elapsed, phase * all(self.drifts[0] / TAU)));
        let half = plane(self.half_longitude.sin_cos_beyond(elapsed, phase * all(0.5 * self.drifts[1] / TAU)));
        let change = self.corrections.generator.at(&generator::Mean { turn, spin: half * half, frame }, &when.place);
        let relative = Plane { re: change.p.re + all(self.root), im: change.p.im };
        let [x, y] = change.rotation;
        let zero = all(0.0);
        State {
            p: turn * relative,
            half: half * small_turn(all(0.5) * change.longitude),
            momentum: change.momentum + all(self.inertia.momentum),
            frame: frame * Turns([all(0.5) * x, all(0.5) * y, zero, all(1.0)]),
        }
    }

    /// Attitude and rates at times after the epoch, as far as they are asked for.
    #[inline(always)]
    pub(crate) fn evaluate<S: Instructions, const ATTITUDE: bool, const RATES: bool>(
        &self,
        elapsed: Elapsed<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]) {
        let state = self.state(elapsed);
        let relative = self.relative(&state);
        let zero = elapsed.0.all(0.0);
        let mut rates = [zero; 3];
        if RATES {
            let body = relative.rows()[2];
            for i in 0..3 {
                let factor = self.frame.signs[i] * self.units[0] / self.moments[i];
                rates[self.frame.axes[i]] = state.momentum * body[i] * zero.all(factor);
            }
        }
        let mut attitude = [zero; 4];
        if ATTITUDE {
            let turned = state.frame * relative * Turns::all(zero, &self.frame.quaternion);
            attitude = turned.normalized().0;
        }
        (attitude, rates)
    }

    /// The angular momenta, inertial components, at times from an epoch.
    pub(crate) fn angular_momenta(&self, times: &[f64], epoch: f64, out: &mut [[f64; 3]]) {
        dispatch(pulp::Arch::new(), Momenta { gradient: self, times, epoch, out });
    }

    /// The quaternion of theory §8 of a state near the mean one.
    #[inline(always)]
    fn relative<S: Instructions>(&self, state: &State<S>) -> Turns<S> {
        let State { p, half, .. } = *state;
        let beyond = p.re.mul_add(p.re, p.im.mul_add(p.im, p.re.all(-self.inertia.sigma)));
        let square = p * p;
        let [[a, a_bar], [b, b_bar]] = [self.pair[0].at(square, beyond), self.pair[1].at(square, beyond)];
        let a = a.plus(a_bar, square.conjugate()) * half;
        let b = (b * p).plus(b_bar, p.conjugate()) * half;
        Turns([b.re, b.im, a.im, a.re]).normalized()
    }
}

/// [`Gradient::state`] as a function of its own.
struct At<'a, S: Instructions> {
    gradient: &'a Gradient,
    elapsed: Elapsed<S>,
}

impl<S: Instructions> NullaryFnOnce for At<'_, S> {
    type Output = State<S>;

    #[inline(always)]
    fn call(self) -> State<S> {
        self.gradient.osculating(self.elapsed)
    }
}

/// e^(ix) for |x| ≤ 0.05, to 2e-17.
#[inline(always)]
fn small_turn<S: Instructions>(x: Lanes<S>) -> Plane<S> {
    let square = x * x;
    let series = |coefficients: &[f64]| square.polynomial(coefficients);
    Plane {
        re: series(&[1.0, -1.0 / 2.0, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40320.0]),
        im: x * series(&[1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0]),
    }
}

/// Angular momenta at many times.
struct Momenta<'a> {
    gradient: &'a Gradient,
    times: &'a [f64],
    epoch: f64,
    out: &'a mut [[f64; 3]],
}

impl Task for Momenta<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Instructions>(self, simd: S) {
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

/// The harmonics of a or b that are not nothing, with their slopes, as polynomials in p² and p̄²: the first with h ≥ 0, the second with h < 0.
#[derive(Clone, Debug)]
struct Powers([Vec<[f64; 2]>; 2]);

impl Powers {
    fn new(series: &Harmonics, root: f64) -> Self {
        let odd = series.values[HIGHEST] == 0.0;
        let side = |first: usize, sign: i32| {
            let mut terms: Vec<(i32, [f64; 2])> = (first..=HIGHEST)
                .step_by(2)
                .map(|h| sign * h as i32)
                .map(|h| (h.abs(), <[f64; 2]>::from(series.at(h))))
                .collect();
            while let Some((degree, [value, slope])) = terms.last()
                && root.powi(*degree) * (value.abs() + slope.abs() * root * root) < NEGLIGIBLE
            {
                terms.pop();
            }
            terms.into_iter().map(|(_, pair)| pair).collect()
        };
        if odd { Self([side(1, 1), side(1, -1)]) } else { Self([side(0, 1), side(2, -1)]) }
    }

    /// Their sums, to be multiplied with what they lack of p and p̄.
    #[inline(always)]
    fn at<S: Instructions>(&self, square: Plane<S>, beyond: Lanes<S>) -> [Plane<S>; 2] {
        let zero = beyond.all(0.0);
        let mut sums = [Plane { re: zero, im: zero }; 2];
        for ((sum, terms), by) in sums.iter_mut().zip(&self.0).zip([square, square.conjugate()]) {
            for [value, slope] in terms.iter().rev() {
                let factor = Plane { re: beyond.mul_add(zero.all(*slope), zero.all(*value)), im: zero };
                *sum = factor.plus(*sum, by);
            }
        }
        sums
    }
}

/// Where the disturbing body is at times after the epoch.
#[inline(always)]
fn when<S: Instructions>(mean_anomaly: &Phase, elapsed: Elapsed<S>, eccentricity: f64) -> When<S> {
    let (turns, angle) = mean_anomaly.turns_and_angle(elapsed);
    When { turns, place: Place::of(angle, eccentricity) }
}

/// The frame of theory §8 at a state: axis 3 along the angular momentum, y = 0.
fn invariable_frame(polhode: &Polhode, attitude: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    let zeta = polhode.zeta();
    let half_z = 0.25 * (zeta[0] * zeta[0] + zeta[1] * zeta[1]);
    let relative = Quaternion::new((1.0 - half_z).max(0.0).sqrt(), 0.5 * zeta[0], 0.5 * zeta[1], 0.0);
    attitude * (UnitQuaternion::new_normalize(relative) * polhode.frame.quaternion).inverse()
}

/// A mean state, the change that leads from it to the state, and the tables of it.
struct MeanMotion {
    mean: Mean,
    change: Change,
    inertia: Inertia,
    corrections: Corrections,
}

/// The mean variables whose corrections lead to a state, by fixed-point iteration.
fn mean_motion_of(
    polhode: &Polhode,
    state: &Mean,
    start: &When<pulp::Scalar>,
    demand: &Demand<'_>,
) -> Result<MeanMotion, Error> {
    let (mut mean, mut change) = (*state, Change::default());
    let mut step = 0;
    // Each step gains the relative size of the corrections, which is below a fiftieth.
    loop {
        let inertia = Inertia::new(polhode, mean.p.norm_sqr(), mean.momentum);
        let corrections = Corrections::new(&inertia, demand)?;
        let next_change = corrections.at(&mean, &start.place);
        let next = state.changed(&next_change, -1.0);
        let moved = (next.p - mean.p).norm()
            + (next.longitude - mean.longitude).abs()
            + (next.momentum / mean.momentum - 1.0).abs()
            + next.frame.angle_to(&mean.frame);
        if moved <= CONVERGED || step == MOST_STEPS {
            return Ok(MeanMotion { mean, change, inertia, corrections });
        }
        (mean, change) = (next, next_change);
        step += 1;
    }
}

/// What second order leaves.
struct Budget {
    /// Of the average over the rotation.
    spin: f64,
    strength: f64,
    /// Radians of the orbit.
    orbital: f64,
}

impl Budget {
    /// Of the average over the orbit.
    fn of_the_orbit(&self) -> f64 {
        self.strength.powi(2) * (1.0 + self.orbital)
    }
}
