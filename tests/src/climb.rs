//! A search for scenes under a gravity gradient whose error is large beside its bound: hill climbing from random scenes of several families.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use andoyer_propagate::nalgebra::UnitQuaternion;
use andoyer_propagate::options::{Averaging, Level};

use crate::disturbed::{Disturbed, Measured};
use crate::tuned::{nearly_without_wobble, next_to_a_sphere, next_to_resonance};

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

/// Coordinates of a scene in one of [`FAMILIES`].
const COORDINATES: usize = 11;
/// Coordinates of a second or of a third disturbing body.
const OF_A_BODY: usize = 7;
/// Coordinates of a scene in one of [`FURTHER_FAMILIES`].
const MOST_COORDINATES: usize = COORDINATES + 2 * OF_A_BODY;
/// A point of the unit cube: a scene of a family.
type Point = [f64; MOST_COORDINATES];

/// How a scene is solved; the family of levels has its own level.
pub type Theory = (Averaging, Level);

/// First order by either averaging, and second order.
pub const THEORIES: [Theory; 3] =
    [(Averaging::Spin, Level::Full), (Averaging::Orbit, Level::Full), (Averaging::Spin, Level::SecondOrder)];

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
    /// B − A small beside C − A, and a span that lies before the epoch and apart from it.
    BeforeTheEpoch,
    /// Moments near 0.977, 0.978 and 1, n/spin near 0.09.
    FastOrbit,
    /// Two disturbing bodies.
    TwoBodies,
    /// Three disturbing bodies.
    ThreeBodies,
    /// One disturbing body whose node and pericentre precess.
    Precessing,
    /// J from 0 to 0.01, and B − A small beside C − A.
    SteadyOblate,
    /// B − A or C − B from 1e-8 to 1e-3, any J.
    NearlyAxisymmetric,
    /// J = 0 and a tolerance from 1e-6 to 1e-2, for which terms are dropped.
    LooseTolerance,
    /// A part of one orbit, averaged over the orbit in second order.
    WithinAnOrbit,
    /// A harmonic j of the orbit and a term for which |Ω + jn| times the span is 1e-4 to 2.
    NearResonance,
    /// Moments that differ by 1e-7 to 1e-3 under a strong attraction, in half of the scenes on a circle.
    NextToSphere,
    /// A mean wobble of 1e-9 to 1e-3, or of 0: on circles, on ellipses, and in first order on orbits that precess, under two bodies, and by the paper's levels.
    MeanWobbleZero,
}

/// Families in which the bound holds.
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

/// Families in most of which the error is known to exceed the bound, by 1.2 to 3.3 times.
pub const FURTHER_FAMILIES: [Family; 12] = [
    Family::BeforeTheEpoch,
    Family::FastOrbit,
    Family::TwoBodies,
    Family::ThreeBodies,
    Family::Precessing,
    Family::SteadyOblate,
    Family::NearlyAxisymmetric,
    Family::LooseTolerance,
    Family::WithinAnOrbit,
    Family::NearResonance,
    Family::MeanWobbleZero,
    Family::NextToSphere,
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
            Self::BeforeTheEpoch => "before the epoch",
            Self::FastOrbit => "fast orbit",
            Self::TwoBodies => "two bodies",
            Self::ThreeBodies => "three bodies",
            Self::Precessing => "precessing orbit",
            Self::SteadyOblate => "steady and nearly oblate",
            Self::NearlyAxisymmetric => "nearly axisymmetric",
            Self::LooseTolerance => "loose tolerance",
            Self::WithinAnOrbit => "within an orbit",
            Self::NearResonance => "near resonance",
            Self::MeanWobbleZero => "mean wobble zero",
            Self::NextToSphere => "next to a sphere",
        }
    }

    /// The theories by which a family is climbed.
    pub fn theories(self) -> &'static [Theory] {
        const BY_ORBIT: [Theory; 1] = [(Averaging::Orbit, Level::SecondOrder)];
        match self {
            // Several bodies and precessing orbits have no other; the family of levels has its own levels.
            Self::TwoBodies | Self::ThreeBodies | Self::Precessing => &THEORIES[..1],
            Self::Levels => &THEORIES[..2],
            Self::WithinAnOrbit => &BY_ORBIT,
            _ => &THEORIES,
        }
    }

    /// Number of coordinates of its scenes.
    fn coordinates(self) -> usize {
        if FAMILIES.contains(&self) { COORDINATES } else { MOST_COORDINATES }
    }

    /// A random scene.
    pub fn random(self, long_axis: bool, theory: Theory, random: &mut Uniform) -> Disturbed {
        self.scene(&self.random_point(random), long_axis, theory)
    }

    fn random_point(self, random: &mut Uniform) -> Point {
        let mut point = [0.5; MOST_COORDINATES];
        point[..self.coordinates()].fill_with(|| random.draw());
        point
    }

    /// The scene at a point, in the short-axis mode or the long-axis one.
    fn scene(self, point: &Point, long_axis: bool, (averaging, level): Theory) -> Disturbed {
        let [shape, ratio, tilt, azimuth, inclination, motion, eccentricity, anomaly, argument, node, span, extra @ ..] =
            *point;
        let moments = match self {
            Self::NearlyProlate => {
                let second = 1.0 - power(-6.0, -1.0, ratio);
                [mix(1.0 - second, 0.5, shape).max(0.01), second, 1.0]
            }
            Self::NearlyOblate | Self::BeforeTheEpoch | Self::SteadyOblate => {
                let first = mix(0.5, 0.99, shape);
                [first, first + (1.0 - first) * power(-6.0, -0.7, ratio), 1.0]
            }
            Self::NearlyAxisymmetric => {
                let (first, least) = (mix(0.5, 0.98, shape), power(-8.0, -3.0, ratio));
                [first, if extra[0] < 0.5 { first + least } else { 1.0 - least }, 1.0]
            }
            Self::FastOrbit => {
                let first = mix(0.965, 0.985, shape);
                [first, first + (1.0 - first) * mix(0.01, 0.2, ratio), 1.0]
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
            Self::SteadyOblate => 0.01 * (2.0 * tilt - 1.0).max(0.0).powi(3),
            Self::LooseTolerance | Self::MeanWobbleZero => 0.0,
            _ => FRAC_PI_2 * tilt * tilt,
        };
        let (sine, cosine) = tilt.sin_cos();
        let (across, along) = (TAU * azimuth).sin_cos();
        let direction =
            if long_axis { [cosine, sine * along, sine * across] } else { [sine * across, sine * along, cosine] };
        let eccentricity = match self {
            Self::Pericentre => mix(0.3, 0.95, eccentricity),
            Self::AfterPericentre => mix(0.5, 0.95, eccentricity),
            Self::WithinAnOrbit => 0.9 * eccentricity,
            Self::NearResonance => 0.75 * eccentricity,
            Self::NearlySphere | Self::FastOrbit => 0.6 * (2.0 * eccentricity - 1.0).max(0.0),
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
            Self::FastOrbit => (mix(0.07, 0.11, motion), power(1.3, 3.0, span)),
            Self::NearResonance => (power(-2.5, -0.9, motion), power(1.3, 3.0, span)),
            Self::WithinAnOrbit => {
                let mean_motion = power(-3.3, -1.5, motion);
                (mean_motion, mix(-1.0, 1.0, span) * TAU / mean_motion)
            }
            _ => (power(-4.0, -1.5, motion), power(1.3, 3.0, span)),
        };
        // Spans are in radians of the fastest rate, which the integration's time is proportional to, but those of part of an orbit.
        let in_radians = !matches!(self, Self::AfterPericentre | Self::WithinAnOrbit);
        let span = if in_radians { span / fastest } else { span };
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
        self.extended(Disturbed { averaging, level, ..scene }, &extra)
    }

    /// What the coordinates beyond the first add to a scene: the beginning of its span, precession of the orbit, further bodies, the tolerance.
    pub(crate) fn extended(self, scene: Disturbed, extra: &[f64]) -> Disturbed {
        let Disturbed { orbit: [n, ..], span, .. } = scene;
        let body = |part: &[f64]| {
            let mean_motion = n * power(-1.0, 0.3, part[0]);
            let pericentre = -TAU * part[2] / mean_motion;
            let elements = [mean_motion, 0.6 * part[1], pericentre, PI * part[3], TAU * part[4], TAU * part[5]];
            Some((elements, n * n * power(-1.5, 0.3, part[6])))
        };
        match self {
            Self::BeforeTheEpoch => Disturbed { from: -span * mix(0.0, 0.9, extra[0]), span: -span, ..scene },
            Self::TwoBodies => Disturbed { further: [body(extra), None], ..scene },
            Self::ThreeBodies => Disturbed { further: [body(extra), body(&extra[OF_A_BODY..])], ..scene },
            Self::Precessing => {
                let [_, e, pericentre, _, _, argument] = scene.orbit;
                let orbit = [n, e, pericentre, PI * extra[2], 0.0, argument];
                Disturbed { orbit, secular: [0, 1].map(|i| n * mix(-0.5, 0.5, extra[i])), ..scene }
            }
            Self::LooseTolerance => Disturbed { tolerance: power(-6.0, -2.0, extra[0]), ..scene },
            Self::NearResonance => next_to_resonance(scene, extra),
            Self::NextToSphere => next_to_a_sphere(scene, extra),
            Self::MeanWobbleZero => nearly_without_wobble(scene, extra),
            _ => scene,
        }
    }
}

fn mix(low: f64, high: f64, part: f64) -> f64 {
    low + (high - low) * part
}

pub(crate) fn power(low: f64, high: f64, part: f64) -> f64 {
    10.0_f64.powf(mix(low, high, part))
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
            None => family.random_point(random),
            Some((point, _)) => {
                // Steps of all sizes, of some of the coordinates.
                let size = 0.5 * 10.0_f64.powf(-3.0 * random.draw());
                let mut point = *point;
                for coordinate in &mut point[..family.coordinates()] {
                    let moved = random.draw() < 0.4;
                    let change = size * (random.draw() + random.draw() - 1.0);
                    *coordinate = if moved { reflected(*coordinate + change) } else { *coordinate };
                }
                point
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
