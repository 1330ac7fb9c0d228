//! The series of a disturbing body about a time: r̃ = √(3μ) ρ^(−5/2) r, whose products with itself are the torque.
//!
//! On an orbit, with E′ = n/ρ and ρ = 1 − e cos E, r is (cos E − e, √(1−e²) sin E) in units of a, turned by the argument of the pericentre, the inclination and
//! the node; a secular rate multiplies by the series of a rotation. μ is the attraction G m/a³. On a hyperbola H′ = n/ρ, ρ = e cosh H − 1 and r is
//! (e − cosh H, √(e²−1) sinh H) in units of |a|.

use std::f64::consts::PI;
use std::sync::Arc;

use super::interpolation::Table;
use super::series::{ROWS, Row, Scalars, Series, ZERO, add_scaled};
use crate::numerics::phase::Phase;
use crate::numerics::scaling::scaled;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;
use crate::orbit::hyperbola::hyperbolic_anomaly;
use crate::orbit::kepler::eccentric_anomaly;
use crate::orbit::position::singularity;
use crate::orbit::table::TabulatedOrbit;
use crate::simd::instruction_set::InstructionSet;
use crate::torque::strength;

/// The power of the distance in the series of the gravity gradient.
const GRAVITY: f64 = -2.5;

/// A disturbing body with its times and rates in the unit of the integration.
#[derive(Clone, Debug)]
pub(super) enum Disturber {
    Conic(Box<Conic>),
    Tabulated(Box<Table>),
}

/// A body on an ellipse or a hyperbola.
#[derive(Clone, Debug)]
pub(super) struct Conic {
    mean_anomaly: Phase,
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
    /// The series is `strength` times this power of the distance times the position: √(3μ) and −5/2 for the gravity gradient.
    strength: f64,
    power: f64,
    /// Exponent of the unit of time.
    exponent: i32,
}

impl Disturber {
    /// From the epoch of the scene and the exponent of the unit of rates.
    pub(super) fn new(body: &DisturbingBody, epoch: f64, exponent: i32) -> Self {
        match body {
            DisturbingBody::Orbit(orbit) => {
                let strength = scaled((2.0 * strength(orbit.strength())).sqrt(), -exponent);
                Self::of_orbit(orbit, (epoch, exponent), (strength, GRAVITY))
            }
            DisturbingBody::Tabulated(table) => {
                let length = Table::length(table);
                let strength = scaled((3.0 * table.gm() / length).sqrt() / length, -exponent);
                Self::of_table(table, (epoch, exponent), (strength, GRAVITY))
            }
        }
    }

    /// A body on an orbit whose series is a factor times a power of the distance in semi-major axes times the position.
    pub(super) fn of_orbit(orbit: &Orbit, (epoch, exponent): (f64, i32), factor: (f64, f64)) -> Self {
        Self::Conic(Box::new(Conic::new(orbit, (epoch, exponent), factor)))
    }

    /// A body with a table whose series is a factor times a power of the distance times the position, both in units of [`Table::length`].
    pub(super) fn of_table(table: &Arc<TabulatedOrbit>, (epoch, exponent): (f64, i32), factor: (f64, f64)) -> Self {
        Self::Tabulated(Box::new(Table::new(table, (epoch, exponent), factor)))
    }

    /// The series of the factor and the power of the distance alone.
    pub(super) fn factor<S: InstructionSet>(
        &self,
        simd: S,
        (time, backward): ((f64, f64), bool),
        order: usize,
    ) -> Scalars {
        match self {
            Self::Conic(orbit) => orbit.factor(simd, time, order),
            Self::Tabulated(table) => table.expanded((time, backward), order).1,
        }
    }

    /// The first `order` coefficients about a time after the epoch, from which a step goes on or backwards. Returns the radius of convergence in units of time.
    #[inline(always)]
    pub(super) fn series<S: InstructionSet>(
        &self,
        simd: S,
        (time, backward): ((f64, f64), bool),
        order: usize,
        out: &mut Series,
    ) -> f64 {
        match self {
            Self::Conic(orbit) => orbit.series(simd, time, order, out),
            Self::Tabulated(table) => table.series((time, backward), order, out),
        }
    }

    /// The next time after (or before) a time at which the series ends.
    pub(super) fn next_knot(&self, time: f64, forward: bool) -> Option<(f64, f64)> {
        match self {
            Self::Conic(_) => None,
            Self::Tabulated(table) => table.next_knot(time, forward),
        }
    }

    /// A measure of the steps from the epoch to a time: the integral of dt/R, where R is the radius of convergence, or the number of intervals of a table. The
    /// number of steps is proportional to it.
    pub(super) fn passed(&self, time: (f64, f64)) -> f64 {
        match self {
            Self::Conic(orbit) => orbit.passed(time),
            Self::Tabulated(table) => table.passed(time),
        }
    }

    /// With the earlier or the later of the neighbouring polynomials, where it has a table.
    pub(super) fn neighbouring(&self, earlier: bool) -> Self {
        match self {
            Self::Conic(orbit) => Self::Conic(orbit.clone()),
            Self::Tabulated(table) => Self::Tabulated(Box::new(table.neighbouring(earlier))),
        }
    }
}

impl Conic {
    fn new(orbit: &Orbit, (epoch, exponent): (f64, i32), (strength, power): (f64, f64)) -> Self {
        let [node, argument] = orbit.node_and_argument(epoch);
        let eccentricity = orbit.eccentricity();
        let root = ((1.0 - eccentricity) * (1.0 + eccentricity)).abs().sqrt();
        Self {
            mean_anomaly: orbit.mean_anomaly(epoch),
            hyperbola: orbit.is_hyperbola().then_some((*orbit, epoch)),
            still: [node, argument].map(|phase| phase.angle((0.0, 0.0)).sin_cos()),
            node,
            argument,
            rates: orbit.rates().map(|rate| scaled(rate, -exponent)),
            mean_motion: scaled(orbit.mean_motion(), -exponent),
            eccentricity,
            root,
            singularity: singularity(eccentricity),
            tilt: orbit.tilt(),
            strength,
            power,
            exponent,
        }
    }

    #[inline(always)]
    fn series<S: InstructionSet>(&self, simd: S, (high, low): (f64, f64), order: usize, out: &mut Series) -> f64 {
        let elapsed = (scaled(high, -self.exponent), scaled(low, -self.exponent));
        let mean = self.mean(elapsed).1;
        let (ellipse, factor) = self.conic(simd, mean, order);
        let mut place = ZERO;
        for k in 0..order {
            for j in 0..=k {
                add_scaled(simd, &mut place[k], factor[k - j], &ellipse[j]);
            }
        }
        self.turn(simd, &mut place, 1, (elapsed, order));
        let (sine, cosine) = self.tilt;
        let mut heights = [0.0; ROWS];
        for k in 0..order {
            let [x, y, ..] = place[k];
            (place[k], heights[k]) = ([x, y * cosine, 0.0, 0.0], y * sine);
        }
        self.turn(simd, &mut place, 0, (elapsed, order));
        for k in 0..order {
            let [x, y, ..] = place[k];
            out[k] = [x, y, heights[k], 0.0];
        }
        (mean * mean + self.singularity * self.singularity).sqrt() / self.mean_motion
    }

    /// The series of the factor and the power of the distance.
    fn factor<S: InstructionSet>(&self, simd: S, (high, low): (f64, f64), order: usize) -> Scalars {
        let elapsed = (scaled(high, -self.exponent), scaled(low, -self.exponent));
        self.conic(simd, self.mean(elapsed).1, order).1
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
    fn passed(&self, (high, low): (f64, f64)) -> f64 {
        let of = |elapsed: (f64, f64)| {
            let (turns, mean) = self.mean(elapsed);
            2.0 * turns * (PI / self.singularity).asinh() + (mean / self.singularity).asinh()
        };
        (of((scaled(high, -self.exponent), scaled(low, -self.exponent))) - of((0.0, 0.0))).abs()
    }

    /// Position in the orbit's axes, and the factor with the power of the distance, from the mean anomaly.
    #[inline(always)]
    fn conic<S: InstructionSet>(&self, simd: S, mean: f64, order: usize) -> (Series, Scalars) {
        let e = self.eccentricity;
        let AtEpoch { x, sine, cosine, radius, sign } = match self.hyperbola {
            None => AtEpoch::on_ellipse(mean, e),
            Some(_) => AtEpoch::on_hyperbola(mean, e),
        };
        let inverse = 1.0 / radius;
        let (mut rate, mut factor): (Scalars, Scalars) = ([0.0; ROWS], [0.0; ROWS]);
        rate[0] = self.mean_motion * inverse;
        factor[0] = if self.power == GRAVITY {
            self.strength * inverse * inverse / radius.sqrt()
        } else {
            self.strength * radius.powf(self.power)
        };
        // x, sin E, ρ and k ρ of order k.
        let mut rows = ZERO;
        let mut ellipse = ZERO;
        rows[0] = [x, sine, radius, 0.0];
        ellipse[0] = [x, self.root * sine, 0.0, 0.0];
        for k in 0..order {
            let by_rate = convolved(simd, &rate, &rows, k);
            let by_factor = convolved(simd, &factor, &rows, k);
            if k > 0 {
                rate[k] = -by_rate[2] * inverse;
                factor[k] = -inverse * (-(self.power + 1.0) * by_factor[3] / k as f64 + by_factor[2]);
            }
            let share = 1.0 / (k + 1) as f64;
            // The cosine is x + e, and the hyperbolic one e − x.
            let next = -share * sine.mul_add(rate[k], by_rate[1]);
            let next_sine = share * cosine.mul_add(rate[k], sign * by_rate[0]);
            rows[k + 1] = [next, next_sine, -e * next, -e * next * (k + 1) as f64];
            ellipse[k + 1] = [next, self.root * next_sine, 0.0, 0.0];
        }
        (ellipse, factor)
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
            for row in place.iter_mut().take(order) {
                let [x, y, ..] = *row;
                *row = [cosine * x - sine * y, sine * x + cosine * y, 0.0, 0.0];
            }
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

/// The place on a conic at the start of a step.
struct AtEpoch {
    /// The position along the direction to the pericentre.
    x: f64,
    /// Of the eccentric anomaly; hyperbolic ones on a hyperbola.
    sine: f64,
    cosine: f64,
    radius: f64,
    /// −1 on a hyperbola.
    sign: f64,
}

impl AtEpoch {
    #[inline(always)]
    fn on_ellipse(mean: f64, e: f64) -> Self {
        let anomaly = if e == 0.0 { mean } else { eccentric_anomaly(mean, e) };
        let (half_sine, half_cosine) = (0.5 * anomaly).sin_cos();
        let versed = 2.0 * half_sine * half_sine;
        let sine = 2.0 * half_sine * half_cosine;
        Self { x: (1.0 - e) - versed, sine, cosine: 1.0 - versed, radius: (1.0 - e) + e * versed, sign: 1.0 }
    }

    fn on_hyperbola(mean: f64, e: f64) -> Self {
        let anomaly = hyperbolic_anomaly(mean, e);
        let half = (0.5 * anomaly).sinh();
        let versed = 2.0 * half * half;
        let radius = (e - 1.0) + e * versed;
        Self { x: (e - 1.0) - versed, sine: anomaly.sinh(), cosine: 1.0 + versed, radius, sign: -1.0 }
    }
}

/// Coefficient k of a product without the first coefficient of the rows: in two sums, which need not wait for each other.
#[inline(always)]
fn convolved<S: InstructionSet>(simd: S, scalars: &Scalars, rows: &Series, k: usize) -> Row {
    let (mut one, mut other) = ([0.0; 4], [0.0; 4]);
    let mut j = 1;
    while j < k {
        add_scaled(simd, &mut one, scalars[k - j], &rows[j]);
        add_scaled(simd, &mut other, scalars[k - j - 1], &rows[j + 1]);
        j += 2;
    }
    if j == k {
        add_scaled(simd, &mut one, scalars[0], &rows[j]);
    }
    for lane in 0..4 {
        one[lane] += other[lane];
    }
    one
}
