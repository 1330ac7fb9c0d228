//! A search for scenes under a gravity gradient whose error is large beside its bound: hill climbing from random scenes of several families.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use andoyer_propagate::nalgebra::UnitQuaternion;
use andoyer_propagate::options::{Averaging, Level};

use crate::disturbed::{Disturbed, Measured};

/// Uniform numbers in [0, 1) from a linear congruential generator (Knuth's multiplier): the same on every machine.
#[derive(Clone, Debug)]
pub struct Uniform(pub u64);

impl Uniform {
    /// The next one.
    pub fn draw(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The next one of another interval.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.draw()
    }
}

/// Coordinates of a scene in its family.
const COORDINATES: usize = 11;
/// A point of the unit cube: a scene of a family.
type Point = [f64; COORDINATES];

/// How a scene is solved; the family of levels has its own level.
pub type Theory = (Averaging, Level);

/// A kind of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Any body, J up to a right angle.
    Generic,
    /// C − B from 1e-6 to 0.1 of C.
    NearlyProlate,
    /// B − A small beside C − A, J from 45° to 60°, where ⟨D⟩ may vanish.
    NearlyOblate,
    /// A short span at the pericentre, e up to 0.95.
    Pericentre,
    /// A span of less than an orbit that begins after the pericentre, e from 0.5 to 0.95.
    AfterPericentre,
    /// Moments that differ by 1e-3 to 0.1, a fast orbit, and in half of the scenes a circle.
    NearlySphere,
    /// A circle on which pairs of terms with h = 2, m = 0 are near resonance with 4n.
    Circle,
    /// Any body, by a level of the paper's.
    Levels,
}

/// All families.
pub const FAMILIES: [Family; 8] = [
    Family::Generic,
    Family::NearlyProlate,
    Family::NearlyOblate,
    Family::Pericentre,
    Family::AfterPericentre,
    Family::NearlySphere,
    Family::Circle,
    Family::Levels,
];

impl Family {
    /// Its name in a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Generic => "generic",
            Self::NearlyProlate => "nearly prolate",
            Self::NearlyOblate => "nearly oblate",
            Self::Pericentre => "pericentre",
            Self::AfterPericentre => "after the pericentre",
            Self::NearlySphere => "nearly a sphere",
            Self::Circle => "circle",
            Self::Levels => "levels",
        }
    }

    /// A random scene.
    pub fn random(self, long_axis: bool, theory: Theory, random: &mut Uniform) -> Disturbed {
        self.scene(&std::array::from_fn(|_| random.draw()), long_axis, theory)
    }

    /// The scene at a point, in the short-axis mode or the long-axis one.
    fn scene(self, point: &Point, long_axis: bool, (averaging, level): Theory) -> Disturbed {
        let [shape, ratio, tilt, azimuth, inclination, motion, eccentricity, anomaly, argument, node, span] = *point;
        let mix = |low: f64, high: f64, part: f64| low + (high - low) * part;
        let power = |low: f64, high: f64, part: f64| 10.0_f64.powf(mix(low, high, part));
        let moments = match self {
            Self::NearlyProlate => {
                let second = 1.0 - power(-6.0, -1.0, ratio);
                [mix(1.0 - second, 0.5, shape).max(0.01), second, 1.0]
            }
            Self::NearlyOblate => {
                let first = mix(0.5, 0.99, shape);
                [first, first + (1.0 - first) * power(-6.0, -0.7, ratio), 1.0]
            }
            Self::NearlySphere => {
                let first = 1.0 - power(-3.0, -1.0, shape);
                [first, mix(first, 1.0, mix(0.02, 0.98, ratio)), 1.0]
            }
            _ => {
                let first = mix(0.05, 0.98, shape);
                [first, mix(first.max(1.0 - first), 0.999, ratio), 1.0]
            }
        };
        let tilt = match self {
            Self::NearlyOblate => mix(0.25 * PI, PI / 3.0, tilt),
            Self::Circle => 0.5 * tilt,
            _ => FRAC_PI_2 * tilt * tilt,
        };
        let (sine, cosine) = tilt.sin_cos();
        let (across, along) = (TAU * azimuth).sin_cos();
        let direction =
            if long_axis { [cosine, sine * along, sine * across] } else { [sine * across, sine * along, cosine] };
        let eccentricity = match self {
            Self::Pericentre => mix(0.3, 0.95, eccentricity),
            Self::AfterPericentre => mix(0.5, 0.95, eccentricity),
            Self::NearlySphere => 0.6 * (2.0 * eccentricity - 1.0).max(0.0),
            Self::Circle => 0.0,
            _ => 0.6 * eccentricity,
        };
        let squeezed = (1.0 - eccentricity).powf(1.5) / (1.0 + eccentricity).sqrt();
        let rates: [f64; 3] = std::array::from_fn(|i| direction[i] / moments[i]);
        let fastest = rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        let (mean_motion, span) = match self {
            Self::Pericentre => (squeezed * power(-3.0, -0.7, motion), power(-0.5, 2.0, span)),
            Self::AfterPericentre => {
                let mean_motion = power(-3.3, -2.3, motion);
                (mean_motion, mix(0.05, 0.95, span) * (TAU - mix(0.05, PI, anomaly)) / mean_motion)
            }
            Self::NearlySphere => (power(-2.0, -0.8, motion), power(1.3, 3.0, span)),
            Self::Circle => {
                // ℓ′ at J = 0.
                let [first, second, _] = moments;
                let rate = ((1.0 - first) * (1.0 - second) / (first * second)).sqrt();
                (0.5 * rate * (1.0 + mix(-0.2, 0.2, motion)), power(1.3, 3.0, span))
            }
            _ => (power(-4.0, -1.5, motion), power(1.3, 3.0, span)),
        };
        // Spans are in radians of the fastest rate, which the integration's time is proportional to, but that of part of an orbit.
        let span = if self == Self::AfterPericentre { span } else { span / fastest };
        let mean = match self {
            // Within a radian of true anomaly from the pericentre.
            Self::Pericentre => squeezed * (2.0 * anomaly - 1.0),
            Self::AfterPericentre => mix(0.05, PI, anomaly),
            _ => TAU * anomaly,
        };
        let attitude = UnitQuaternion::from_euler_angles(TAU * node, PI * inclination, 1.0);
        let scene = Disturbed::new(
            moments,
            attitude.coords.into(),
            rates,
            [mean_motion, eccentricity, -mean / mean_motion, 0.0, 0.0, TAU * argument],
            span,
        );
        let level = match self {
            Self::Levels if long_axis => Level::Paper,
            Self::Levels => Level::Moving,
            _ => level,
        };
        Disturbed { averaging, level, ..scene }
    }
}

/// The worst scene of a climb.
#[derive(Clone, Copy, Debug)]
pub struct Summit {
    /// The scene.
    pub scene: Disturbed,
    /// Its error and bound.
    pub measured: Measured,
    /// Scenes that were solved on the way.
    pub solved: usize,
}

impl Summit {
    /// Error over bound.
    pub fn ratio(&self) -> f64 {
        self.measured.ratio()
    }
}

/// Climbs from one random scene of a family; `None` where no scene was served.
pub fn climb(family: Family, long_axis: bool, theory: Theory, steps: usize, random: &mut Uniform) -> Option<Summit> {
    let mut best: Option<(Point, Summit)> = None;
    let mut solved = 0;
    for _ in 0..steps {
        let point: Point = match &best {
            None => std::array::from_fn(|_| random.draw()),
            Some((point, _)) => {
                // Steps of all sizes, of some of the coordinates.
                let size = 0.5 * 10.0_f64.powf(-3.0 * random.draw());
                point.map(|coordinate| {
                    let moved = random.draw() < 0.4;
                    let change = size * (random.draw() + random.draw() - 1.0);
                    if moved { reflected(coordinate + change) } else { coordinate }
                })
            }
        };
        let scene = family.scene(&point, long_axis, theory);
        // A scene that is refused is no step.
        let Ok(measured) = scene.measured() else { continue };
        solved += 1;
        let summit = Summit { scene, measured, solved };
        if best.as_ref().is_none_or(|(_, other)| summit.ratio() > other.ratio()) {
            best = Some((point, summit));
        }
    }
    best.map(|(_, summit)| Summit { solved, ..summit })
}

fn reflected(coordinate: f64) -> f64 {
    let coordinate = coordinate.abs();
    if coordinate > 1.0 { (2.0 - coordinate).clamp(0.0, 1.0) } else { coordinate }
}
