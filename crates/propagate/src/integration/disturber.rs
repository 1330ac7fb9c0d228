//! The series of a disturbing body about a time: r̃ = √(3μ) ρ^(−5/2) r, whose products with itself are the torque.
//!
//! On an orbit, with E′ = n/ρ and ρ = 1 − e cos E, r is (cos E − e, √(1−e²) sin E) in units of a, turned by the argument of the pericentre, the inclination and the node; a secular rate
//! multiplies by the series of a rotation. μ is the attraction G m/a³.

use super::interpolation::Table;
use super::series::{ROWS, Row, Scalars, Series, power, product};
use crate::input::disturbing_body::DisturbingBody;
use crate::input::orbit::Orbit;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::scaled;
use crate::simd::kepler::eccentric_anomaly;
use crate::simd::lanes::Lanes;

/// A disturbing body with its times and rates in the unit of the integration.
#[derive(Clone, Debug)]
pub(super) enum Disturber {
    Orbiting(Box<Orbiting>),
    Tabulated(Box<Table>),
}

/// A body on an orbit.
#[derive(Clone, Debug)]
pub(super) struct Orbiting {
    mean_anomaly: Phase,
    node: Phase,
    argument: Phase,
    /// Of node and argument; in the unit of the integration, as the mean motion.
    rates: [f64; 2],
    mean_motion: f64,
    eccentricity: f64,
    root: f64,
    tilt: (f64, f64),
    /// √(3μ).
    strength: f64,
    /// Exponent of the unit of time.
    exponent: i32,
}

impl Disturber {
    /// From the epoch of the scene and the exponent of the unit of rates.
    pub(super) fn new(body: &DisturbingBody, epoch: f64, exponent: i32) -> Self {
        match body {
            DisturbingBody::Orbit(orbit) => Self::Orbiting(Box::new(Orbiting::new(orbit, epoch, exponent))),
            DisturbingBody::Tabulated(table) => Self::Tabulated(Box::new(Table::new(table, epoch, exponent))),
        }
    }

    /// The first `order` coefficients about a time after the epoch, from which a step goes on or backwards.
    #[inline(always)]
    pub(super) fn series(&self, (time, backward): ((f64, f64), bool), order: usize, out: &mut Series) {
        match self {
            Self::Orbiting(orbit) => orbit.series(time, order, out),
            Self::Tabulated(table) => table.series((time, backward), order, out),
        }
    }

    /// The next time after (or before) a time at which the series ends.
    pub(super) fn next_knot(&self, time: f64, forward: bool) -> Option<(f64, f64)> {
        match self {
            Self::Orbiting(_) => None,
            Self::Tabulated(table) => table.next_knot(time, forward),
        }
    }

    /// With √(3μ) multiplied by a factor.
    pub(super) fn strengthened(&self, factor: f64) -> Self {
        match self {
            Self::Orbiting(orbit) => {
                Self::Orbiting(Box::new(Orbiting { strength: orbit.strength * factor, ..**orbit }))
            }
            Self::Tabulated(table) => Self::Tabulated(Box::new(table.strengthened(factor))),
        }
    }

    /// With an interpolation of lower degree, where there is one.
    pub(super) fn coarser(&self) -> Self {
        match self {
            Self::Orbiting(orbit) => Self::Orbiting(orbit.clone()),
            Self::Tabulated(table) => Self::Tabulated(Box::new(table.coarser())),
        }
    }
}

impl Orbiting {
    fn new(orbit: &Orbit, epoch: f64, exponent: i32) -> Self {
        let [node, argument] = orbit.node_and_argument(epoch);
        let eccentricity = orbit.eccentricity();
        Self {
            mean_anomaly: orbit.mean_anomaly(epoch),
            node,
            argument,
            rates: orbit.rates().map(|rate| scaled(rate, -exponent)),
            mean_motion: scaled(orbit.mean_motion(), -exponent),
            eccentricity,
            root: ((1.0 - eccentricity) * (1.0 + eccentricity)).sqrt(),
            tilt: orbit.tilt(),
            strength: scaled((3.0 * orbit.strength()).sqrt(), -exponent),
            exponent,
        }
    }

    #[inline(always)]
    fn series(&self, (high, low): (f64, f64), order: usize, out: &mut Series) {
        let elapsed = (scaled(high, -self.exponent), scaled(low, -self.exponent));
        let mean = self.mean_anomaly.angle(elapsed);
        let e = self.eccentricity;
        let anomaly = if e == 0.0 { mean } else { eccentric_anomaly(Lanes::splat(pulp::Scalar, mean), e).values()[0] };
        let mut sine = [0.0; ROWS + 1];
        let mut x = [0.0; ROWS + 1];
        let (mut rate, mut radius, mut factor): (Scalars, Scalars, Scalars) = ([0.0; ROWS], [0.0; ROWS], [0.0; ROWS]);
        let (half_sine, half_cosine) = (0.5 * anomaly).sin_cos();
        let versed = 2.0 * half_sine * half_sine;
        let cosine = 1.0 - versed;
        sine[0] = 2.0 * half_sine * half_cosine;
        x[0] = (1.0 - e) - versed;
        radius[0] = (1.0 - e) + e * versed;
        rate[0] = self.mean_motion / radius[0];
        factor[0] = self.strength / (radius[0] * radius[0] * radius[0].sqrt());
        let inverse = 1.0 / radius[0];
        for k in 0..order {
            if k > 0 {
                let mut sum = 0.0_f64;
                for j in 1..=k {
                    sum = radius[j].mul_add(rate[k - j], sum);
                }
                rate[k] = -sum * inverse;
                factor[k] = power(&radius, &factor, -2.5, k);
            }
            if k + 1 < order {
                // The cosine is x + e.
                let (mut of_sine, mut of_cosine) = (0.0_f64, cosine * rate[k]);
                for j in 0..=k {
                    of_sine = sine[j].mul_add(rate[k - j], of_sine);
                }
                for j in 1..=k {
                    of_cosine = x[j].mul_add(rate[k - j], of_cosine);
                }
                let share = 1.0 / (k + 1) as f64;
                x[k + 1] = -of_sine * share;
                sine[k + 1] = of_cosine * share;
                radius[k + 1] = -e * x[k + 1];
            }
        }
        let (mut along, mut across): (Scalars, Scalars) = ([0.0; ROWS], [0.0; ROWS]);
        for k in 0..order {
            let (mut a, mut b) = (0.0_f64, 0.0_f64);
            for j in 0..=k {
                a = x[j].mul_add(factor[k - j], a);
                b = sine[j].mul_add(factor[k - j], b);
            }
            (along[k], across[k]) = (a, self.root * b);
        }
        self.turned(elapsed, order, (along, across), out);
    }

    /// From the orbit's axes to the inertial ones.
    #[inline(always)]
    fn turned(&self, elapsed: (f64, f64), order: usize, (along, across): (Scalars, Scalars), out: &mut Series) {
        let (x, y) = rotated((along, across), self.argument.angle(elapsed), self.rates[1], order);
        let (sine, cosine) = self.tilt;
        let level: Scalars = std::array::from_fn(|k| y[k] * cosine);
        let (first, second) = rotated((x, level), self.node.angle(elapsed), self.rates[0], order);
        for k in 0..order {
            let row: Row = [first[k], second[k], y[k] * sine, 0.0];
            out[k] = row;
        }
    }
}

/// Two components turned by an angle that grows with a rate.
#[inline(always)]
fn rotated((x, y): (Scalars, Scalars), angle: f64, rate: f64, order: usize) -> (Scalars, Scalars) {
    let (sine, cosine) = angle.sin_cos();
    let (mut first, mut second): (Scalars, Scalars) = ([0.0; ROWS], [0.0; ROWS]);
    if rate == 0.0 {
        for k in 0..order {
            first[k] = cosine * x[k] - sine * y[k];
            second[k] = sine * x[k] + cosine * y[k];
        }
        return (first, second);
    }
    let (mut c, mut s): (Scalars, Scalars) = ([0.0; ROWS], [0.0; ROWS]);
    (c[0], s[0]) = (cosine, sine);
    for k in 1..order {
        let share = rate / k as f64;
        (c[k], s[k]) = (-share * s[k - 1], share * c[k - 1]);
    }
    for k in 0..order {
        first[k] = product(&c, &x, k) - product(&s, &y, k);
        second[k] = product(&s, &x, k) + product(&c, &y, k);
    }
    (first, second)
}
