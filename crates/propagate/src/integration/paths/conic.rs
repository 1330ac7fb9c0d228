//! The series of a body on an ellipse or a hyperbola about a time, and their derivatives with respect to the elements.
//!
//! With E′ = n/ρ and ρ = 1 − e cos E, r is (cos E − e, √(1−e²) sin E) in units of a, turned by the argument of the pericentre, the inclination and the node; a
//! secular rate multiplies by the series of a rotation. μ is the attraction G m/a³. On a hyperbola H′ = n/ρ, ρ = e cosh H − 1 and r is
//! (e − cosh H, √(e²−1) sinh H) in units of |a|.

use std::f64::consts::PI;

use crate::integration::series::{GRAVITY, RECIPROCALS, ROWS, Row, Scalars, Series, ZERO, add_scaled, product};
use crate::numerics::phase::Phase;
use crate::numerics::scaling::scaled;
use crate::orbit::conic::ConicPoint;
use crate::orbit::elements::Orbit;
use crate::orbit::position::singularity;
use crate::simd::instruction_set::InstructionSet;

/// A body on an ellipse or a hyperbola.
#[derive(Clone, Debug)]
pub(crate) struct Conic {
    mean_anomaly: Phase,
    /// Time from the pericentre's passage to the epoch, in the unit of the integration.
    since_pericentre: f64,
    /// Whether the attraction is the mean motion's square times a given fraction.
    by_fraction: bool,
    /// The orbit and the epoch of a hyperbola, whose mean anomaly does not turn.
    hyperbola: Option<(Orbit, f64)>,
    node: Phase,
    argument: Phase,
    /// Sine and cosine of node and argument at the epoch.
    still: [(f64, f64); 2],
    /// Rates of node and argument in the unit of the integration.
    rates: [f64; 2],
    mean_motion: f64,
    eccentricity: f64,
    root: f64,
    /// The mean anomaly of the singularity above the pericentre, over the imaginary unit.
    singularity: f64,
    tilt: (f64, f64),
    /// The directions to the pericentre and a quarter turn further, inertial, at the epoch.
    axes: [Row; 2],
    /// The series is `strength` times this power of the distance times the position: √(3μ) and −5/2 for the gravity gradient.
    pub(crate) strength: f64,
    power: f64,
    /// Exponent of the unit of time.
    exponent: i32,
}

impl Conic {
    pub(crate) fn new(orbit: &Orbit, (epoch, exponent): (f64, i32), (strength, power): (f64, f64)) -> Self {
        let [node, argument] = orbit.node_and_argument(epoch);
        let [_, eccentricity, time_of_pericentre, ..] = orbit.elements();
        let root = ((1.0 - eccentricity) * (1.0 + eccentricity)).abs().sqrt();
        let still = [node, argument].map(|phase| phase.angle((0.0, 0.0)).sin_cos());
        let tilt = orbit.tilt();
        let axis = |row: Row| turned(tilted(turned(row, still[1]), tilt), still[0]);
        Self {
            mean_anomaly: orbit.mean_anomaly(epoch),
            since_pericentre: scaled(epoch - time_of_pericentre, exponent),
            by_fraction: orbit.asked_attraction().is_none(),
            hyperbola: orbit.is_hyperbola().then_some((*orbit, epoch)),
            still,
            node,
            argument,
            rates: orbit.rates().map(|rate| scaled(rate, -exponent)),
            mean_motion: scaled(orbit.mean_motion(), -exponent),
            eccentricity,
            root,
            singularity: singularity(eccentricity),
            tilt,
            axes: [axis([1.0, 0.0, 0.0, 0.0]), axis([0.0, 1.0, 0.0, 0.0])],
            strength,
            power,
            exponent,
        }
    }

    /// The mean anomaly a time after the epoch; that of an ellipse is in [−π, π].
    #[inline(always)]
    fn mean_at(&self, (high, low): (f64, f64)) -> f64 {
        self.mean((scaled(high, -self.exponent), scaled(low, -self.exponent))).1
    }

    #[inline(always)]
    pub(crate) fn series<S: InstructionSet>(
        &self,
        simd: S,
        (high, low): (f64, f64),
        order: usize,
        out: &mut Series,
    ) -> f64 {
        let elapsed = (scaled(high, -self.exponent), scaled(low, -self.exponent));
        let mean = self.mean(elapsed).1;
        if self.rates == [0.0; 2] {
            self.conic(simd, mean, (order, &self.axes), out);
        } else {
            let mut place = ZERO;
            self.conic(simd, mean, (order, &IN_PLANE), &mut place);
            self.turn(simd, &mut place, 1, (elapsed, order));
            let tilted = place.map(|row| tilted(row, self.tilt));
            *out = self.beside_node(simd, &tilted, (elapsed, order));
        }
        self.radius(mean)
    }

    /// The radius of convergence at a mean anomaly.
    fn radius(&self, mean: f64) -> f64 {
        (mean * mean + self.singularity * self.singularity).sqrt() / self.mean_motion
    }

    /// Turns a series in axes along and beside the node, and along inertial axis 3, to inertial axes.
    #[inline(always)]
    fn beside_node<S: InstructionSet>(&self, simd: S, given: &Series, at: ((f64, f64), usize)) -> Series {
        let mut turned = given.map(|[x, y, ..]| [x, y, 0.0, 0.0]);
        self.turn(simd, &mut turned, 0, at);
        let mut out = ZERO;
        for k in 0..at.1 {
            let [x, y, ..] = turned[k];
            out[k] = [x, y, given[k][2], 0.0];
        }
        out
    }

    /// The derivatives of the series with respect to the six elements: mean motion, eccentricity, time of pericentre, inclination, node, argument of pericentre. What
    /// the orbit was given with is held: its attraction, or the mass fraction.
    ///
    /// The plane's angles turn r̃ about axis 3, about the node and about the normal. The derivative with respect to the mean anomaly is r̃′/n, the
    /// ellipse fixed. That with respect to e, the mean anomaly fixed, uses ∂E/∂e = sin E/ρ:
    ///
    /// ```text
    /// ∂x/∂e = −1 − sin²E/ρ,   ∂y/∂e = (−e sin E + η² cos E sin E/ρ)/η,   ∂ρ/∂e = −x/ρ
    /// ```
    ///
    /// with the opposite signs and η² = e² − 1 on a hyperbola.
    pub(crate) fn by_elements<S: InstructionSet>(&self, simd: S, (high, low): (f64, f64), order: usize) -> [Series; 6] {
        let elapsed = (scaled(high, -self.exponent), scaled(low, -self.exponent));
        let at = (elapsed, order);
        let mut place = ZERO;
        let conic = self.conic(simd, self.mean(elapsed).1, (order + 1, &IN_PLANE), &mut place);
        let mut by_anomaly = ZERO;
        for k in 0..order {
            by_anomaly[k] = place[k + 1].map(|value| value * (k + 1) as f64 / self.mean_motion);
        }
        let mut by_shape = self.by_eccentricity(&conic, order);
        for series in [&mut place, &mut by_anomaly, &mut by_shape] {
            self.turn(simd, series, 1, at);
        }
        let (sine, cosine) = self.tilt;
        let lifted = |series: &Series| self.beside_node(simd, &series.map(|row| tilted(row, self.tilt)), at);
        let position = lifted(&place);
        let (anomaly, eccentricity) = (lifted(&by_anomaly), lifted(&by_shape));
        let argument = lifted(&place.map(|[x, y, ..]| [-y, x, 0.0, 0.0]));
        let inclination = self.beside_node(simd, &place.map(|[_, y, ..]| [0.0, -y * sine, y * cosine, 0.0]), at);
        let node = position.map(|[x, y, ..]| [-y, x, 0.0, 0.0]);
        let (mut motion, mut passage) = (ZERO, ZERO);
        let since = self.since_pericentre + high + low;
        // The torque's strength is proportional to the root of the attraction.
        let by_strength = if self.by_fraction { 1.0 / self.mean_motion } else { 0.0 };
        for k in 0..order {
            for lane in 0..3 {
                let before = if k > 0 { anomaly[k - 1][lane] } else { 0.0 };
                motion[k][lane] = since.mul_add(anomaly[k][lane], before) + by_strength * position[k][lane];
                let turned = self.rates[0] * node[k][lane] + self.rates[1] * argument[k][lane];
                passage[k][lane] = -self.mean_motion * anomaly[k][lane] - turned;
            }
        }
        [motion, eccentricity, passage, inclination, node, argument]
    }

    /// The derivative of the series in the orbit's axes with respect to the eccentricity at fixed mean anomaly.
    fn by_eccentricity(&self, conic: &ConicSeries, order: usize) -> Series {
        let sign = if self.hyperbola.is_some() { -1.0 } else { 1.0 };
        let (e, root) = (self.eccentricity, self.root);
        let row = |lane: usize| -> Scalars { std::array::from_fn(|k| conic.rows[k][lane]) };
        let (x, sine) = (row(0), row(1));
        let mut cosine = x.map(|value| sign * value);
        cosine[0] += e;
        let inverse = conic.rate.map(|rate| rate / self.mean_motion);
        let times = |one: &Scalars, other: &Scalars| -> Scalars {
            std::array::from_fn(|k| if k < order { product(one, other, k) } else { 0.0 })
        };
        let share = times(&sine, &inverse);
        let (square, across) = (times(&sine, &share), times(&cosine, &share));
        // 5/2 x/ρ², from the power of the distance.
        let growth = times(&times(&x, &inverse), &inverse).map(|value| -self.power * value);
        let mut along = square.map(|value| -sign * value);
        along[0] -= sign;
        let beside: Scalars = std::array::from_fn(|k| sign * (root * across[k] - e * sine[k] / root));
        let ellipse = |lane: usize| -> Scalars { std::array::from_fn(|k| conic.ellipse[k][lane]) };
        let of = |change: Scalars, place: Scalars| {
            let grown = times(&growth, &place);
            times(&conic.factor, &std::array::from_fn(|k| sign.mul_add(grown[k], change[k])))
        };
        let (along, beside) = (of(along, ellipse(0)), of(beside, ellipse(1)));
        std::array::from_fn(|k| [along[k], beside[k], 0.0, 0.0])
    }

    /// The series of the factor and the power of the distance.
    pub(crate) fn factor<S: InstructionSet>(&self, simd: S, (high, low): (f64, f64), order: usize) -> Scalars {
        self.conic(simd, self.mean_at((high, low)), (order, &IN_PLANE), &mut ZERO.clone()).factor
    }

    /// Whole turns of the mean anomaly since the epoch, and the angle beyond them.
    #[inline(always)]
    fn mean(&self, elapsed: (f64, f64)) -> (f64, f64) {
        match &self.hyperbola {
            None => self.mean_anomaly.turns_and_angle_at(elapsed),
            Some((orbit, epoch)) => (0.0, orbit.hyperbolic_mean_anomaly(*epoch, elapsed)),
        }
    }

    /// The integral of dt/R from the epoch to a time; 0 for a circle, whose R is infinite.
    pub(crate) fn passed(&self, (high, low): (f64, f64)) -> f64 {
        let of = |elapsed: (f64, f64)| {
            let (turns, mean) = self.mean(elapsed);
            2.0 * turns * (PI / self.singularity).asinh() + (mean / self.singularity).asinh()
        };
        (of((scaled(high, -self.exponent), scaled(low, -self.exponent))) - of((0.0, 0.0))).abs()
    }

    /// The series from the mean anomaly. `place` becomes the position times the factor, in the axes in which the direction to the pericentre and that a quarter turn
    /// further are given.
    #[inline(always)]
    fn conic<S: InstructionSet>(
        &self,
        simd: S,
        mean: f64,
        (order, axes): (usize, &[Row; 2]),
        place: &mut Series,
    ) -> ConicSeries {
        let e = self.eccentricity;
        let ConicPoint { x, sine, cosine, radius, sign } = match self.hyperbola {
            None => ConicPoint::on_ellipse(mean, e),
            Some(_) => ConicPoint::on_hyperbola(mean, e),
        };
        let inverse = 1.0 / radius;
        let mut series = ConicSeries { ellipse: ZERO, factor: [0.0; ROWS], rate: [0.0; ROWS], rows: ZERO };
        let ConicSeries { ellipse, factor, rate, rows } = &mut series;
        rate[0] = self.mean_motion * inverse;
        factor[0] = if self.power == GRAVITY {
            self.strength * inverse * inverse / radius.sqrt()
        } else {
            self.strength * radius.powf(self.power)
        };
        let on_axes = |x: f64, y: f64| -> Row {
            let mut row = axes[1].map(|part| y * part);
            add_scaled(simd, &mut row, x, &axes[0]);
            row
        };
        rows[0] = [x, sine, radius, 0.0];
        ellipse[0] = on_axes(x, self.root * sine);
        for k in 0..order {
            let [by_rate, by_factor, mut found] = convolved(simd, [rate, factor], [rows, ellipse], k);
            if k > 0 {
                rate[k] = -by_rate[2] * inverse;
                let grown = -(self.power + 1.0) * RECIPROCALS[k];
                factor[k] = -inverse * grown.mul_add(by_factor[3], by_factor[2]);
            }
            add_scaled(simd, &mut found, factor[k], &ellipse[0]);
            place[k] = found;
            let share = RECIPROCALS[k + 1];
            // The cosine is x + e, and the hyperbolic one e − x.
            let next = -share * sine.mul_add(rate[k], by_rate[1]);
            let next_sine = share * cosine.mul_add(rate[k], sign * by_rate[0]);
            rows[k + 1] = [next, next_sine, -e * next, -e * next * (k + 1) as f64];
            ellipse[k + 1] = on_axes(next, self.root * next_sine);
        }
        series
    }

    /// Turns the first two lanes by the node, 0, or the argument of the pericentre, 1, which may grow with time.
    #[inline(always)]
    fn turn<S: InstructionSet>(
        &self,
        simd: S,
        place: &mut Series,
        angle: usize,
        (elapsed, order): ((f64, f64), usize),
    ) {
        let rate = self.rates[angle];
        let across = |[x, y, ..]: Row| [-y, x, 0.0, 0.0];
        if rate == 0.0 {
            let (sine, cosine) = self.still[angle];
            place[..order].iter_mut().for_each(|row| *row = turned(*row, (sine, cosine)));
            return;
        }
        let phase = if angle == 0 { &self.node } else { &self.argument };
        let (mut sine, mut cosine) = phase.angle(elapsed).sin_cos();
        let given = *place;
        let crossed = given.map(across);
        *place = ZERO;
        for j in 0..order {
            for k in j..order {
                add_scaled(simd, &mut place[k], cosine, &given[k - j]);
                add_scaled(simd, &mut place[k], sine, &crossed[k - j]);
            }
            let share = rate / (j + 1) as f64;
            (cosine, sine) = (-share * sine, share * cosine);
        }
    }
}

/// The axes of the orbit's plane.
const IN_PLANE: [Row; 2] = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]];

/// The series of a conic.
struct ConicSeries {
    /// The position in semi-major axes.
    ellipse: Series,
    /// The factor with the power of the distance.
    factor: Scalars,
    /// E′ = n/ρ.
    rate: Scalars,
    /// x, sin E, ρ, and k ρ of order k.
    rows: Series,
}

/// A vector turned about axis 3.
#[inline(always)]
fn turned([x, y, z, _]: Row, (sine, cosine): (f64, f64)) -> Row {
    [cosine * x - sine * y, sine * x + cosine * y, z, 0.0]
}

/// A vector in the orbit's plane, in axes along and beside the node and along inertial axis 3.
#[inline(always)]
fn tilted([x, y, ..]: Row, (sine, cosine): (f64, f64)) -> Row {
    [x, y * cosine, y * sine, 0.0]
}

/// Coefficient k of E′ times the rows, of the factor times the rows, and of the factor times the position, each without the first coefficient of the second
/// series: in two sums, which need not wait for each other.
#[inline(always)]
fn convolved<S: InstructionSet>(
    simd: S,
    [rate, factor]: [&Scalars; 2],
    [rows, ellipse]: [&Series; 2],
    k: usize,
) -> [Row; 3] {
    let (mut odd, mut even) = ([[0.0; 4]; 3], [[0.0; 4]; 3]);
    let mut j = 1;
    while j < k {
        add_convolved(simd, &mut odd, ([rate, factor], k - j), [&rows[j], &ellipse[j]]);
        add_convolved(simd, &mut even, ([rate, factor], k - j - 1), [&rows[j + 1], &ellipse[j + 1]]);
        j += 2;
    }
    if j == k {
        add_convolved(simd, &mut odd, ([rate, factor], 0), [&rows[k], &ellipse[k]]);
    }
    std::array::from_fn(|row| std::array::from_fn(|lane| odd[row][lane] + even[row][lane]))
}

/// Adds the products with one coefficient of each series. A function, because compilers do not always inline closures.
#[inline(always)]
fn add_convolved<S: InstructionSet>(
    simd: S,
    sums: &mut [Row; 3],
    ([rate, factor], at): ([&Scalars; 2], usize),
    [row, place]: [&Row; 2],
) {
    add_scaled(simd, &mut sums[0], rate[at], row);
    add_scaled(simd, &mut sums[1], factor[at], row);
    add_scaled(simd, &mut sums[2], factor[at], place);
}
