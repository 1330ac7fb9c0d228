//! The time-dependent quantities of the derivatives: attitude, rates, and δg and g·δθ for each parameter (theory §12).
//!
//! Attitude, rates and a few numbers are computed with a time in each lane, δg and g·δθ with a parameter in each lane. All quantities are in units of M = 1 and
//! of the scaled time.

use crate::numerics::phase::Phase;
use crate::simd::circles::{Circle, Evaluate, Instants};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::{Lanes, WIDEST};
use crate::torque_free::separatrix::Passage;
use crate::torque_free::steady::Steady;
use crate::torque_free::wobble::WobbleEvaluator;

use super::constants::{CHANGES, ParameterConstants, Setting};
use super::derivatives::PARAMETERS;
use super::integral::Integral;
use super::steady::{Growth, Varied};

/// Numbers of one time from which the changes of g are computed, at most.
pub(super) const NUMBERS: usize = 8;

/// Lane i of a row holds column i + 1.
pub(super) const COLUMNS: usize = PARAMETERS - 1;
/// The first of them, of the initial attitude, do not change the polhode: their constants are 0.
pub(super) const UNCHANGING: usize = COLUMNS - CHANGES;

/// Attitude, rates, and the numbers from which the derivatives of g are computed, with a time in each lane.
pub(super) struct PartialsPlace<S: InstructionSet> {
    pub(super) attitude: [Lanes<S>; 4],
    pub(super) rates: [Lanes<S>; 3],
    pub(super) numbers: [Lanes<S>; NUMBERS],
}

/// A type of motion: gives attitude, rates and their derivatives from the time since the epoch.
pub(super) trait PartialsSource {
    /// The constants or vectors of the parameters, one parameter in each lane.
    type Columns<S: InstructionSet>: Copy;
    /// Whether several times are computed at once.
    const VECTORS: bool = true;

    fn place<S: InstructionSet>(&self, simd: S, setting: &Setting, elapsed: (Lanes<S>, Lanes<S>)) -> PartialsPlace<S>;

    /// The constants from the column `first` on.
    fn columns<S: InstructionSet>(&self, simd: S, first: usize) -> Self::Columns<S>;

    /// δg and g·δθ for a unit of each parameter, from g and the numbers of the time.
    fn change<S: InstructionSet>(
        columns: &Self::Columns<S>,
        direction: [Lanes<S>; 3],
        numbers: [Lanes<S>; NUMBERS],
    ) -> ([Lanes<S>; 3], Lanes<S>);
}

/// Times whose matrices are computed at once.
pub(super) const fn at_once<S: InstructionSet>() -> usize {
    if Lanes::<S>::WIDTH > COLUMNS { 2 } else { 1 }
}

/// A constant of each column, one a lane. With two times at once both strands have the same numbers.
#[derive(Clone, Copy)]
pub(super) struct Constant<S: InstructionSet>(Lanes<S>);

impl<S: InstructionSet> Constant<S> {
    /// A number of each parameter, from the column `first` on.
    #[inline(always)]
    pub(super) fn new(simd: S, first: usize, value: impl Fn(usize) -> f64) -> Self {
        let mut lanes = [0.0; WIDEST];
        for (lane, place) in lanes.iter_mut().enumerate() {
            if let Some(parameter) = ((first + lane) % COLUMNS).checked_sub(UNCHANGING) {
                *place = value(parameter);
            }
        }
        Self(Lanes::load(simd, &lanes))
    }

    /// The numbers. Equal strands are loaded once.
    #[inline(always)]
    pub(super) fn lanes(self) -> Lanes<S> {
        if at_once::<S>() == 2 { self.0.alike() } else { self.0 }
    }
}

/// Times whose sines and cosines of ℓ′ and y′/2 are already computed.
#[derive(Clone, Copy)]
struct Ready<S: InstructionSet> {
    elapsed: (Lanes<S>, Lanes<S>),
    circles: [Circle<S>; 2],
}

impl<S: InstructionSet> Instants<S> for Ready<S> {
    #[inline(always)]
    fn elapsed(self) -> (Lanes<S>, Lanes<S>) {
        self.elapsed
    }

    #[inline(always)]
    fn circle(self, number: usize, _: &Phase) -> Circle<S> {
        self.circles[number]
    }
}

/// The amplitudes of a wobble and of a passage.
#[derive(Clone, Debug)]
pub(super) struct Amplitudes {
    constants: [ParameterConstants; CHANGES],
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
        constants: [ParameterConstants; CHANGES],
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

    /// Attitude, rates, and ġ, the r_i of each of the user's axes, the scaled time and the periodic part of ∫w dt.
    #[inline(always)]
    fn place<S: InstructionSet>(
        &self,
        setting: &Setting,
        (attitude, rates): ([Lanes<S>; 4], [Lanes<S>; 3]),
        time: Lanes<S>,
        zeta: Lanes<S>,
    ) -> PartialsPlace<S> {
        let one = time.all(1.0);
        let direction = direction(setting, rates);
        let [x, y, z] = direction;
        let [a, b, c] = setting.user_slopes;
        let [(first, p), (second, q)] = self.invariants;
        let square =
            [direction[first] * direction[first] * one.all(p), direction[second] * direction[second] * one.all(q)];
        let [u, v, w] = self.owners;
        let swing = (zeta - one.all(self.start)) * one.all(self.swing);
        let numbers = [
            y * z * one.all(a),
            z * x * one.all(b),
            x * y * one.all(c),
            square[u],
            square[v],
            square[w],
            time * one.all(setting.unit),
            swing,
        ];
        PartialsPlace { attitude, rates, numbers }
    }

    #[inline(always)]
    fn columns<S: InstructionSet>(&self, simd: S, first: usize) -> Amplitude<S> {
        let all = &self.constants;
        Amplitude {
            growth: [
                Constant::new(simd, first, |parameter| all[parameter].growth[0]),
                Constant::new(simd, first, |parameter| all[parameter].growth[1]),
                Constant::new(simd, first, |parameter| all[parameter].growth[2]),
            ],
            half_beta: Constant::new(simd, first, |parameter| all[parameter].half_beta),
            delay: Constant::new(simd, first, |parameter| all[parameter].delay),
            drift: Constant::new(simd, first, |parameter| all[parameter].drift),
            turn: Constant::new(simd, first, |parameter| all[parameter].turn),
            swing: Constant::new(simd, first, |parameter| all[parameter].swing),
        }
    }
}

/// g from the rates.
#[inline(always)]
pub(super) fn direction<S: InstructionSet>(setting: &Setting, [p, q, r]: [Lanes<S>; 3]) -> [Lanes<S>; 3] {
    let nu = setting.user_rates;
    [p * p.all(1.0 / nu[0]), q * q.all(1.0 / nu[1]), r * r.all(1.0 / nu[2])]
}

/// The constants of theory §12 with a parameter in each lane.
#[derive(Clone, Copy)]
pub(super) struct Amplitude<S: InstructionSet> {
    growth: [Constant<S>; 3],
    half_beta: Constant<S>,
    delay: Constant<S>,
    drift: Constant<S>,
    turn: Constant<S>,
    swing: Constant<S>,
}

impl<S: InstructionSet> Amplitude<S> {
    #[inline(always)]
    fn change(&self, direction: [Lanes<S>; 3], numbers: [Lanes<S>; NUMBERS]) -> ([Lanes<S>; 3], Lanes<S>) {
        let [half, delay, drift] = [self.half_beta.lanes(), self.delay.lanes(), self.drift.lanes()];
        let (growth, turn, work) = (self.growth, self.turn.lanes(), self.swing.lanes());
        let [a, b, c, u, v, w, time, swing] = numbers;
        let (slope, squares) = ([a, b, c], [u, v, w]);
        let delay = time.mul_add(drift, (half + half).negate_mul_add(swing, delay));
        let mut change = direction;
        for i in 0..3 {
            let amplitude = half.mul_add(squares[i], growth[i].lanes());
            change[i] = amplitude.mul_add(direction[i], delay * slope[i]);
        }
        (change, time.mul_add(turn, swing * work))
    }
}

/// A wobble, from its Fourier series.
pub(super) struct Wobbling<'a> {
    pub(super) tables: &'a WobbleEvaluator,
    pub(super) integral: &'a Integral,
    pub(super) amplitudes: &'a Amplitudes,
}

impl PartialsSource for Wobbling<'_> {
    type Columns<S: InstructionSet> = Amplitude<S>;

    #[inline(always)]
    fn place<S: InstructionSet>(&self, simd: S, setting: &Setting, elapsed: (Lanes<S>, Lanes<S>)) -> PartialsPlace<S> {
        let circles = self.tables.phases().map(|phase| phase.sin_cos(elapsed));
        let sample = self.tables.evaluate::<S, true, true>(simd, Ready { elapsed, circles });
        let (sine, cosine) = circles[0];
        let one = sine.all(1.0);
        let twice = sine + sine;
        let (sine, cosine) = (twice * cosine, twice.negate_mul_add(sine, one));
        let (mut numerator, mut denominator, mut c, mut s) = (one.all(0.0), one, cosine, sine);
        for [odd, even] in &self.integral.terms {
            numerator = s.mul_add(one.all(*odd), numerator);
            denominator = c.mul_add(one.all(*even), denominator);
            (c, s) = (s.negate_mul_add(sine, c * cosine), s.mul_add(cosine, c * sine));
        }
        self.amplitudes.place(setting, sample, elapsed.0, numerator / denominator)
    }

    #[inline(always)]
    fn columns<S: InstructionSet>(&self, simd: S, first: usize) -> Amplitude<S> {
        self.amplitudes.columns(simd, first)
    }

    #[inline(always)]
    fn change<S: InstructionSet>(
        columns: &Amplitude<S>,
        direction: [Lanes<S>; 3],
        numbers: [Lanes<S>; NUMBERS],
    ) -> ([Lanes<S>; 3], Lanes<S>) {
        columns.change(direction, numbers)
    }
}

/// A passage near the separatrix, evaluated for one time after another.
pub(super) struct Passing<'a> {
    pub(super) passage: &'a Passage,
    pub(super) integral: &'a Integral,
    pub(super) amplitudes: &'a Amplitudes,
}

impl PartialsSource for Passing<'_> {
    const VECTORS: bool = false;
    type Columns<S: InstructionSet> = Amplitude<S>;

    #[inline(always)]
    fn place<S: InstructionSet>(&self, simd: S, setting: &Setting, elapsed: (Lanes<S>, Lanes<S>)) -> PartialsPlace<S> {
        let now = (elapsed.0.values()[0], elapsed.1.values()[0]);
        let (attitude, rates) = self.passage.evaluate(now);
        let zeta = self.integral.zeta_of_passages(self.passage.passage.angle(now));
        let sample = (Lanes::splats(simd, attitude), Lanes::splats(simd, rates));
        self.amplitudes.place(setting, sample, elapsed.0, Lanes::splat(simd, zeta))
    }

    #[inline(always)]
    fn columns<S: InstructionSet>(&self, simd: S, first: usize) -> Amplitude<S> {
        self.amplitudes.columns(simd, first)
    }

    #[inline(always)]
    fn change<S: InstructionSet>(
        columns: &Amplitude<S>,
        direction: [Lanes<S>; 3],
        numbers: [Lanes<S>; NUMBERS],
    ) -> ([Lanes<S>; 3], Lanes<S>) {
        columns.change(direction, numbers)
    }
}

/// A steady rotation.
pub(super) struct Steadily<'a> {
    pub(super) steady: &'a Steady,
    pub(super) varied: &'a Varied,
}

/// The vectors of a steady rotation with a parameter in each lane.
#[derive(Clone, Copy)]
pub(super) struct VectorLanes<S: InstructionSet> {
    /// Factors of 1, S, C and t in δg.
    change: [[Constant<S>; 3]; 4],
    turn: Constant<S>,
}

impl PartialsSource for Steadily<'_> {
    type Columns<S: InstructionSet> = VectorLanes<S>;

    /// The numbers are S, C and the time, scaled.
    #[inline(always)]
    fn place<S: InstructionSet>(&self, simd: S, setting: &Setting, elapsed: (Lanes<S>, Lanes<S>)) -> PartialsPlace<S> {
        let (attitude, rates) = self.steady.evaluate::<S, true, true>(simd, elapsed);
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
        let zero = time.all(0.0);
        PartialsPlace { attitude, rates, numbers: [first, second, time, zero, zero, zero, zero, zero] }
    }

    #[inline(always)]
    fn columns<S: InstructionSet>(&self, simd: S, first: usize) -> VectorLanes<S> {
        let all = &self.varied.vectors;
        let mut change = [[Constant::new(simd, first, |_| 0.0); 3]; 4];
        for (factor, vector) in change.iter_mut().enumerate() {
            for (axis, lanes) in vector.iter_mut().enumerate() {
                *lanes = Constant::new(simd, first, |parameter| all[parameter].change[factor][axis]);
            }
        }
        VectorLanes { change, turn: Constant::new(simd, first, |parameter| all[parameter].turn) }
    }

    #[inline(always)]
    fn change<S: InstructionSet>(
        columns: &VectorLanes<S>,
        _direction: [Lanes<S>; 3],
        [first, second, time, ..]: [Lanes<S>; NUMBERS],
    ) -> ([Lanes<S>; 3], Lanes<S>) {
        let [start, once, twice, pushed] = columns.change;
        let mut change = [time; 3];
        for i in 0..3 {
            let linear = time.mul_add(pushed[i].lanes(), start[i].lanes());
            change[i] = second.mul_add(twice[i].lanes(), first.mul_add(once[i].lanes(), linear));
        }
        (change, time * columns.turn.lanes())
    }
}
