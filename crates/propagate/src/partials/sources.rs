//! The time-dependent quantities of the derivatives: attitude, rates, and δg and g·δθ for each parameter (theory §12).
//!
//! All quantities are in units of M = 1 and of the scaled time.

use crate::numerics::phase::Phase;
use crate::simd::circles::{Circle, Circles, Evaluate};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::torque_free::separatrix::Passage;
use crate::torque_free::steady::Steady;
use crate::torque_free::wobble::WobbleEvaluator;

use super::constants::{CHANGES, Constants, Setting};
use super::integral::Integral;
use super::steady::{Growth, Varied};

/// Attitude, rates, and the quantities from which the derivatives of g at some times are computed.
pub(super) struct Place<S: InstructionSet, T> {
    pub(super) attitude: [Lanes<S>; 4],
    pub(super) rates: [Lanes<S>; 3],
    pub(super) rest: T,
}

/// A type of motion: gives attitude, rates and their derivatives from the time since the epoch.
pub(super) trait Source {
    /// The quantities from which derivatives of g at some times are computed.
    type Rest<S: InstructionSet>: Copy;
    /// Whether several times are computed at once.
    const VECTORS: bool = true;

    fn place<S: InstructionSet>(
        &self,
        simd: S,
        setting: &Setting,
        elapsed: (Lanes<S>, Lanes<S>),
    ) -> Place<S, Self::Rest<S>>;

    /// δg and g·δθ for a unit of one parameter.
    fn change<S: InstructionSet>(&self, rest: &Self::Rest<S>, parameter: usize) -> ([Lanes<S>; 3], Lanes<S>);
}

/// Sines and cosines of ℓ′ and y′/2 that are already computed.
#[derive(Clone, Copy)]
struct Ready<S: InstructionSet>([Circle<S>; 2]);

impl<S: InstructionSet> Circles<S> for Ready<S> {
    #[inline(always)]
    fn anomaly(self) -> Circle<S> {
        self.0[0]
    }

    #[inline(always)]
    fn half_longitude(self) -> Circle<S> {
        self.0[1]
    }
}

#[inline(always)]
fn ready<S: InstructionSet>(phases: [&Phase; 2], elapsed: (Lanes<S>, Lanes<S>)) -> Ready<S> {
    Ready([phases[0].sin_cos(elapsed), phases[1].sin_cos(elapsed)])
}

/// g, ġ and the time-dependent amplitudes on a polhode.
#[derive(Clone, Copy)]
pub(super) struct Polhodic<S: InstructionSet> {
    direction: [Lanes<S>; 3],
    slope: [Lanes<S>; 3],
    /// The r_i of each of the user's axes.
    squares: [Lanes<S>; 3],
    /// The scaled time; `swing` is the periodic part of ∫w dt.
    time: Lanes<S>,
    swing: Lanes<S>,
}

/// The amplitudes of a wobble and of a passage.
#[derive(Clone, Debug)]
pub(super) struct Amplitudes {
    constants: [Constants; CHANGES],
    /// For r_1 and r_2: the user's axis, and 1/d_i, scaled.
    invariants: [(usize, f64); 2],
    /// The index i of the r_i of each of the user's axes.
    owners: [usize; 3],
    /// The periodic part of ∫w dt for each unit of Z/m.
    swing: f64,
    /// Z/m at the epoch.
    start: f64,
}

impl Amplitudes {
    /// The amplitudes; `anomaly_rate` is the rate of ℓ′, scaled, and `quarter` is K.
    pub(super) fn new(
        setting: &Setting,
        constants: [Constants; CHANGES],
        anomaly_rate: f64,
        quarter: f64,
        start: f64,
    ) -> Self {
        let Setting { direction: g, slopes: d, axes, .. } = setting;
        let swing = g[1] * g[1] / d[1] - g[0] * g[0] / d[0];
        let mut owners = [0; 3];
        for (axis, owner) in axes.iter().zip([1, 0, 0]) {
            owners[*axis] = owner;
        }
        Self {
            constants,
            invariants: [(axes[0], 1.0 / d[0]), (axes[1], 1.0 / d[1])],
            owners,
            swing: -0.25 * std::f64::consts::PI * swing / (quarter * anomaly_rate),
            start,
        }
    }

    #[inline(always)]
    fn polhodic<S: InstructionSet>(
        &self,
        setting: &Setting,
        rates: [Lanes<S>; 3],
        time: Lanes<S>,
        zeta: Lanes<S>,
    ) -> Polhodic<S> {
        let one = time.all(1.0);
        let nu = setting.user_rates;
        let direction =
            [rates[0] * one.all(1.0 / nu[0]), rates[1] * one.all(1.0 / nu[1]), rates[2] * one.all(1.0 / nu[2])];
        let [x, y, z] = direction;
        let [a, b, c] = setting.user_slopes;
        let slope = [y * z * one.all(a), z * x * one.all(b), x * y * one.all(c)];
        let [(first, a), (second, b)] = self.invariants;
        let square =
            [direction[first] * direction[first] * one.all(a), direction[second] * direction[second] * one.all(b)];
        let squares = [square[self.owners[0]], square[self.owners[1]], square[self.owners[2]]];
        let swing = (zeta - one.all(self.start)) * one.all(self.swing);
        Polhodic { direction, slope, squares, time: time * one.all(setting.unit), swing }
    }

    #[inline(always)]
    fn change<S: InstructionSet>(&self, rest: &Polhodic<S>, parameter: usize) -> ([Lanes<S>; 3], Lanes<S>) {
        let Polhodic { direction, slope, squares, time, swing } = *rest;
        let Constants { growth, half_beta, delay, drift, turn, swing: work } = self.constants[parameter];
        let half = time.all(half_beta);
        let delay = time.mul_add(time.all(drift), (half + half).negate_mul_add(swing, time.all(delay)));
        let mut change = direction;
        for i in 0..3 {
            let amplitude = half.mul_add(squares[i], time.all(growth[i]));
            change[i] = amplitude.mul_add(direction[i], delay * slope[i]);
        }
        (change, time.mul_add(time.all(turn), swing * time.all(work)))
    }
}

/// A wobble, from its Fourier series.
pub(super) struct Wobbling<'a> {
    pub(super) tables: &'a WobbleEvaluator,
    pub(super) integral: &'a Integral,
    pub(super) amplitudes: &'a Amplitudes,
}

impl Source for Wobbling<'_> {
    type Rest<S: InstructionSet> = Polhodic<S>;

    #[inline(always)]
    fn place<S: InstructionSet>(
        &self,
        simd: S,
        setting: &Setting,
        elapsed: (Lanes<S>, Lanes<S>),
    ) -> Place<S, Polhodic<S>> {
        let circles = ready(self.tables.phases(), elapsed);
        let (attitude, rates) = self.tables.evaluate::<S, true, true>(simd, circles);
        let (sine, cosine) = circles.anomaly();
        let one = sine.all(1.0);
        let twice = sine + sine;
        let (sine, cosine) = (twice * cosine, twice.negate_mul_add(sine, one));
        let (mut numerator, mut denominator, mut c, mut s) = (one.all(0.0), one, cosine, sine);
        for [odd, even] in &self.integral.terms {
            numerator = s.mul_add(one.all(*odd), numerator);
            denominator = c.mul_add(one.all(*even), denominator);
            (c, s) = (s.negate_mul_add(sine, c * cosine), s.mul_add(cosine, c * sine));
        }
        let rest = self.amplitudes.polhodic(setting, rates, elapsed.0, numerator / denominator);
        Place { attitude, rates, rest }
    }

    #[inline(always)]
    fn change<S: InstructionSet>(&self, rest: &Polhodic<S>, parameter: usize) -> ([Lanes<S>; 3], Lanes<S>) {
        self.amplitudes.change(rest, parameter)
    }
}

/// A passage near the separatrix, evaluated for one time after another.
pub(super) struct Passing<'a> {
    pub(super) flip: &'a Passage,
    pub(super) integral: &'a Integral,
    pub(super) amplitudes: &'a Amplitudes,
}

impl Source for Passing<'_> {
    const VECTORS: bool = false;
    type Rest<S: InstructionSet> = Polhodic<S>;

    #[inline(always)]
    fn place<S: InstructionSet>(
        &self,
        simd: S,
        setting: &Setting,
        elapsed: (Lanes<S>, Lanes<S>),
    ) -> Place<S, Polhodic<S>> {
        let now = (elapsed.0.values()[0], elapsed.1.values()[0]);
        let (attitude, rates) = self.flip.evaluate(now);
        let zeta = self.integral.zeta_of_passages(self.flip.passage.angle(now));
        let rates = Lanes::splats(simd, rates);
        let rest = self.amplitudes.polhodic(setting, rates, elapsed.0, Lanes::splat(simd, zeta));
        Place { attitude: Lanes::splats(simd, attitude), rates, rest }
    }

    #[inline(always)]
    fn change<S: InstructionSet>(&self, rest: &Polhodic<S>, parameter: usize) -> ([Lanes<S>; 3], Lanes<S>) {
        self.amplitudes.change(rest, parameter)
    }
}

/// A steady rotation.
pub(super) struct Steadily<'a> {
    pub(super) course: &'a Steady,
    pub(super) varied: &'a Varied,
}

impl Source for Steadily<'_> {
    /// S, C and the time, scaled.
    type Rest<S: InstructionSet> = [Lanes<S>; 3];

    #[inline(always)]
    fn place<S: InstructionSet>(
        &self,
        simd: S,
        setting: &Setting,
        elapsed: (Lanes<S>, Lanes<S>),
    ) -> Place<S, [Lanes<S>; 3]> {
        let (attitude, rates) = self.course.evaluate::<S, true, true>(simd, ready(self.course.phases(), elapsed));
        let time = elapsed.0 * elapsed.0.all(setting.unit);
        let [first, second] = match &self.varied.growth {
            Growth::Oscillation(half, rate) => {
                let (sine, cosine) = half.sin_cos(elapsed);
                let twice = (sine + sine) * time.all(1.0 / rate);
                [twice * cosine, twice * sine * time.all(1.0 / rate)]
            }
            Growth::Exponential(rate) => {
                let half = time * time.all(0.5 * rate);
                let (sine, cosine) = (half.each(f64::sinh), half.each(f64::cosh));
                let twice = (sine + sine) * time.all(1.0 / rate);
                [twice * cosine, twice * sine * time.all(1.0 / rate)]
            }
            Growth::Polynomial => [time, time * time * time.all(0.5)],
        };
        Place { attitude, rates, rest: [first, second, time] }
    }

    #[inline(always)]
    fn change<S: InstructionSet>(&self, rest: &[Lanes<S>; 3], parameter: usize) -> ([Lanes<S>; 3], Lanes<S>) {
        let [first, second, time] = *rest;
        let vectors = &self.varied.vectors[parameter];
        let [start, once, twice, pushed] = vectors.change;
        let mut change = [time; 3];
        for i in 0..3 {
            let linear = time.mul_add(time.all(pushed[i]), time.all(start[i]));
            change[i] = second.mul_add(time.all(twice[i]), first.mul_add(time.all(once[i]), linear));
        }
        (change, time * time.all(vectors.turn))
    }
}
