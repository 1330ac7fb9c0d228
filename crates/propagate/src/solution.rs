//! From a scene to its motion: mode, method, secular part, series, initial phases (theory §5 to §8, §10).

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use andoyer_series::DoubleDouble;

use crate::bound::{COSINE_ROUNDING, ROUNDING, conditioning, drift, duration, phase_rounding, rounding};
use crate::closed::{ClosedForm, NEAREST_COMPLEMENT, anomaly};
use crate::elliptic::Theta;
use crate::error::Error;
use crate::fourier::{QuaternionSeries, oscillator_and_longitude};
use crate::gradient::{Averaging, Gradient, Level, Request};
use crate::motion::{Course, Frequencies, Motion, Place, Wobble};
use crate::orbit::Orbit;
use crate::order::{Expanded, expanded, first_order, initial_anomaly};
use crate::phase::Phase;
use crate::plan::{Mode, Plan};
use crate::polhode::{Polhode, SMALLEST_TILT, exponent, scaled};
use crate::scene::{Method, Scene};
use crate::secular::Secular;
use crate::separatrix::{Clock, Flip, Passage};
use crate::steady::{at_rest, steadily_rotating};

/// Part of the tolerance that dropped harmonics may use.
const HARMONICS_SHARE: f64 = 0.125;
/// σ/σ_sep up to which the tables for the gravity gradient have enough harmonics.
const LARGEST_RATIO: f64 = 0.9;
/// Error bound below which the corrections are not held against their own effect \[rad\].
const WORTH: f64 = 1e-3;
/// Intervals of a span at whose ends they are.
const EFFECT_SAMPLES: u32 = 16;

impl Motion {
    /// The motion of a valid scene.
    pub(crate) fn new(scene: Scene) -> Result<Self, Error> {
        let Some(polhode) = Polhode::new(scene.body(), scene.state()) else {
            return match scene.asked_orbit() {
                Some(_) => Err(Error::Unaveraged { mode: Mode::AtRest.to_string(), ratio: 0.0, bound: LARGEST_RATIO }),
                None => Ok(with_unused(at_rest(scene))),
            };
        };
        let momentum = polhode.user_momentum();
        if !momentum.is_normal() {
            let (moment, rate) = polhode.scales;
            return Err(Error::Units { quantity: "the angular momentum", exponent: moment + rate });
        }
        // No rate or frequency of the motion is more than twice M over the smallest moment.
        let smallest = polhode.moments.iter().copied().fold(f64::INFINITY, f64::min);
        let fastest = polhode.momentum.to_f64() / smallest;
        if !scaled(4.0 * fastest, polhode.scales.1).is_finite() {
            let exponent = exponent(fastest) + polhode.scales.1;
            return Err(Error::Units { quantity: "the rate that belongs to the smallest moment", exponent });
        }
        let mode = mode(&polhode);
        if let Some(&orbit) = scene.asked_orbit()
            && mode != Mode::Spherical
        {
            return disturbed(scene, &polhode, mode, &orbit);
        }
        let motion = match mode {
            mode @ (Mode::Spherical | Mode::PrincipalAxis) => steadily_rotating(scene, &polhode, mode),
            Mode::Separatrix => passing(scene, &polhode)?,
            mode => wobbling(scene, &polhode, mode)?,
        };
        Ok(with_unused(motion))
    }
}

fn mode(polhode: &Polhode) -> Mode {
    let [g1, g2, g3] = polhode.direction.map(|g| g.abs() < SMALLEST_TILT);
    let [first, second] = polhode.excesses;
    if first == DoubleDouble::ZERO {
        return Mode::Spherical;
    }
    // With B = C every axis across axis 1 is one of greatest inertia, with A = B every axis across axis 3 one of least; in the middle between A and C
    // rotation is steady too, as long as it is exact.
    if g1 && (g2 || g3 || second == DoubleDouble::ZERO) || g3 && polhode.difference == DoubleDouble::ZERO {
        return Mode::PrincipalAxis;
    }
    if polhode.difference == DoubleDouble::ZERO {
        return Mode::Axisymmetric;
    }
    let lost = polhode.cancellation() * COSINE_ROUNDING;
    if lost >= 1.0 || lost.is_nan() {
        return Mode::Separatrix;
    }
    if polhode.long_axis { Mode::LongAxis } else { Mode::ShortAxis }
}

/// A rate in the user's unit.
pub(crate) fn user_rate(rate: DoubleDouble, exponent: i32) -> DoubleDouble {
    DoubleDouble { high: scaled(rate.high, exponent), low: scaled(rate.low, exponent) }
}

/// The phase of half an angle, which a quaternion needs: whole turns of it leave the sign alone.
pub(crate) fn half(rate: DoubleDouble, start: f64) -> Phase {
    Phase::new(rate * DoubleDouble::from(0.5), 0.5 * start)
}

/// The angular momentum at the epoch, inertial components.
pub(crate) fn angular_momentum(scene: &Scene, polhode: &Polhode) -> Vector3<f64> {
    let direction = Vector3::from(polhode.frame.user(polhode.direction));
    scene.state().attitude * direction * polhode.user_momentum()
}

/// a e^(−iy′/2) and b e^(−iy′/2) of theory §8, up to their norm, as functions of time.
enum Pair {
    /// ℓ′ and the harmonics of it.
    Fourier(Phase, QuaternionSeries),
    /// Near the separatrix and on it.
    Passage(Passage),
}

/// The pair (a, b) as a function of time, and what the plan says of it.
struct Solved {
    pair: Pair,
    /// y′ at the epoch, where y is 0.
    longitude: f64,
    rates: Secular,
    plan: Plan,
}

fn wobbling(scene: Scene, polhode: &Polhode, mode: Mode) -> Result<Motion, Error> {
    let exact = Secular::exact(polhode);
    let ratio = (exact.kappa_sigma / polhode.kappa() / polhode.separatrix_action()).min(1.0);
    let by_series = match scene.asked_method() {
        Method::Series => true,
        Method::Closed => false,
        // A fixed order is one of the series.
        Method::Auto => scene.asked_order().is_some() && mode != Mode::Axisymmetric,
    };
    let plan = Plan {
        mode,
        method: if by_series { Method::Series } else { Method::Closed },
        order: 0,
        harmonics: 0,
        error_bound: 0.0,
        tolerance: scene.asked_tolerance(),
        spanned: scene.asked_span().is_some(),
        separatrix_ratio: ratio,
        gradient: None,
        skipped: Vec::new(),
    };
    let mut solved = if by_series {
        by_the_series(&scene, polhode, exact, plan)?
    } else {
        by_theta_functions(&scene, polhode, exact, plan)
    };
    let phases = phase_rounding(&scene, exact.longitude_rate, polhode.scales.1);
    solved.plan.error_bound = (solved.plan.error_bound + phases).min(std::f64::consts::PI);
    Ok(assembled(scene, polhode, solved))
}

fn assembled(scene: Scene, polhode: &Polhode, solved: Solved) -> Motion {
    let exponent = polhode.scales.1;
    let longitude_rate = user_rate(solved.rates.longitude_rate, exponent);
    let [anomaly, precession] = [solved.rates.anomaly_rate, solved.rates.longitude_rate + solved.rates.anomaly_rate]
        .map(|rate| scaled(rate.to_f64(), exponent));
    let half_longitude = half(longitude_rate, solved.longitude);
    let place = Place {
        inertial: invariable_frame(&scene, polhode, polhode.zeta()),
        frame: polhode.frame.clone(),
        rates: polhode.user_rates(),
    };
    let course = match solved.pair {
        Pair::Fourier(anomaly, series) => Course::polhode(&Wobble { anomaly, series, half_longitude, place }),
        Pair::Passage(passage) => Course::Flip(Box::new(Flip { passage, half_longitude, place })),
    };
    Motion {
        plan: solved.plan,
        course,
        frequencies: Frequencies { anomaly, longitude: longitude_rate.to_f64() },
        precession,
        angular_momentum: angular_momentum(&scene, polhode),
        long_axis: polhode.long_axis,
        scene,
    }
}

fn by_the_series(scene: &Scene, polhode: &Polhode, exact: Secular, mut plan: Plan) -> Result<Solved, Error> {
    let expanded = expanded(scene, polhode, &exact, plan.separatrix_ratio, plan.mode)?;
    let Expanded { order, expansion, secular, ellipse, truncation } = expanded;
    let (series, dropped) =
        QuaternionSeries::new(&expansion, ellipse).truncated(HARMONICS_SHARE * scene.asked_tolerance());
    let theta = Theta::new(polhode);
    // The truncated series of a fixed order has its own ℓ′. Next to the separatrix that is ill-conditioned, and the elliptic integral is not.
    let anomaly = match scene.asked_order() {
        Some(_) => initial_anomaly(&expansion, ellipse.oscillator(polhode.zeta())),
        None => anomaly(polhode, &theta),
    };
    let (_, longitude) = oscillator_and_longitude(&expansion, |h| (h as f64 * anomaly).sin_cos());
    let exponent = polhode.scales.1;
    plan.order = order;
    plan.harmonics = series.harmonics();
    plan.error_bound =
        truncation + dropped + drift(scene, &exact, &secular, exponent, theta.quarter) + rounding(&series);
    plan.skipped =
        if plan.mode == Mode::Axisymmetric { round_body() } else { dropped_harmonics(&series, 4 * order + 3) };
    let anomaly = Phase::new(user_rate(secular.anomaly_rate, exponent), anomaly);
    Ok(Solved { pair: Pair::Fourier(anomaly, series), longitude: -longitude, rates: secular, plan })
}

fn by_theta_functions(scene: &Scene, polhode: &Polhode, rates: Secular, mut plan: Plan) -> Solved {
    let theta = Theta::new(polhode);
    let exponent = polhode.scales.1;
    let anomaly_rate = user_rate(rates.anomaly_rate, exponent);
    let series_order = first_order(plan.separatrix_ratio, plan.tolerance);
    if theta.complement < NEAREST_COMPLEMENT {
        let (place, quarter, turned) = Passage::place(polhode);
        let clock = Clock::repeating(anomaly_rate, place, quarter, theta.conjugate);
        let passage = Passage::new(&theta, clock).turned(turned);
        plan.error_bound = 2.0 * ROUNDING + conditioning(scene, polhode, &rates);
        plan.skipped.push("series: too near the separatrix".to_owned());
        let longitude = -2.0 * passage.phase((0.0, 0.0));
        return Solved { pair: Pair::Passage(passage), longitude, rates, plan };
    }
    let closed = ClosedForm::new(polhode, &theta);
    let all = closed.series.harmonics();
    // What is dropped is missing at the epoch and at the time.
    let (series, dropped) = closed.series.truncated(0.5 * HARMONICS_SHARE * plan.tolerance * closed.least_norm);
    plan.harmonics = series.harmonics();
    plan.error_bound =
        (2.0 * dropped + rounding(&series)) / closed.least_norm.min(1.0) + conditioning(scene, polhode, &rates);
    plan.skipped = if plan.mode == Mode::Axisymmetric {
        round_body()
    } else {
        let reason = match series_order {
            Some(order) => {
                format!("series: it would need order {order} or more, and no fewer harmonics")
            }
            None => "series: too near the separatrix for its highest order".to_owned(),
        };
        std::iter::once(reason).chain(dropped_harmonics(&series, all)).collect()
    };
    let longitude = -2.0 * series.pair(closed.anomaly)[0].arg();
    let pair = Pair::Fourier(Phase::new(anomaly_rate, closed.anomaly), series);
    Solved { pair, longitude, rates, plan }
}

/// The motion on the separatrix: one passage, from and to rotation about the axis of middle inertia.
fn passing(scene: Scene, polhode: &Polhode) -> Result<Motion, Error> {
    if scene.asked_method() == Method::Series {
        return Err(Error::Separatrix);
    }
    let theta = Theta::new(polhode);
    let (place, _, turned) = Passage::place(polhode);
    // Without end, however far from 0 rounding has left Q1.
    let theta = Theta { quarter: f64::INFINITY, ..theta };
    let [_, greatest] = polhode.cosine_squares();
    let precise = polhode.mean_rate() * polhode.gamma() * greatest.sqrt();
    let clock = Clock::Once(place.times_double(0.5), user_rate(precise.times_double(0.5), polhode.scales.1));
    let rate = precise.to_f64();
    let passage = Passage::new(&theta, clock).turned(turned);
    let rates = Secular { kappa_sigma: 0.0, anomaly_rate: DoubleDouble::ZERO, longitude_rate: polhode.middle_rate() };
    // A distance from the separatrix that double-double does not see grows like e^u.
    let growth = (rate.abs() * duration(&scene, rates.longitude_rate, polhode.scales.1)).exp();
    let unseen = if polhode.cosine_squares()[0] == DoubleDouble::ZERO { 0.0 } else { COSINE_ROUNDING * growth };
    let phases = phase_rounding(&scene, rates.longitude_rate, polhode.scales.1);
    let plan = Plan {
        mode: Mode::Separatrix,
        method: Method::Closed,
        order: 0,
        harmonics: 0,
        error_bound: (4.0 * ROUNDING + phases + unseen).min(std::f64::consts::PI),
        tolerance: scene.asked_tolerance(),
        spanned: scene.asked_span().is_some(),
        separatrix_ratio: 1.0,
        gradient: None,
        skipped: vec!["series: on the separatrix".to_owned()],
    };
    let longitude = -2.0 * passage.phase((0.0, 0.0));
    Ok(assembled(scene, polhode, Solved { pair: Pair::Passage(passage), longitude, rates, plan }))
}

/// Where a state that can be averaged is: σ/σ_sep, and σ, ℓ′, y′ − y.
pub(crate) fn osculating(polhode: &Polhode) -> Result<(f64, (f64, [f64; 2])), Error> {
    let mode = mode(polhode);
    let [g1, g2, g3] = polhode.direction;
    let [_, second] = polhode.excesses;
    let principal = mode == Mode::PrincipalAxis && g3.abs() >= SMALLEST_TILT && g1.abs().max(g2.abs()) < SMALLEST_TILT;
    let unaveraged = |ratio: f64| Error::Unaveraged { mode: mode.to_string(), ratio, bound: LARGEST_RATIO };
    if second == DoubleDouble::ZERO || mode == Mode::Separatrix || (mode == Mode::PrincipalAxis && !principal) {
        return Err(unaveraged(1.0));
    }
    if principal {
        return Ok((0.0, (0.0, [0.0; 2])));
    }
    let sigma = Secular::exact(polhode).kappa_sigma / polhode.kappa();
    let ratio = (sigma / polhode.separatrix_action()).min(1.0);
    if ratio > LARGEST_RATIO {
        return Err(unaveraged(ratio));
    }
    let closed = ClosedForm::new(polhode, &Theta::new(polhode));
    Ok((ratio, (sigma, [closed.anomaly, -2.0 * closed.series.pair(closed.anomaly)[0].arg()])))
}

/// The motion under a gravity gradient.
fn disturbed(scene: Scene, polhode: &Polhode, mode: Mode, orbit: &Orbit) -> Result<Motion, Error> {
    let (ratio, osculating) = osculating(polhode)?;
    let exponent = polhode.scales.1;
    let rotation = polhode.mean_rate();
    let request = Request {
        orbit,
        averaging: scene.asked_averaging(),
        level: scene.asked_level(),
        tolerance: scene.asked_tolerance(),
        epoch: scene.state().epoch,
        duration: scaled(duration(&scene, rotation, exponent), -exponent),
        spanned: scene.asked_span().is_some(),
    };
    let gradient = Gradient::new(polhode, scene.state().attitude, osculating, &request)?;
    let [anomaly, longitude] = gradient.frequencies();
    let mut skipped: Vec<String> = unused_order(&scene).into_iter().collect();
    if scene.asked_method() == Method::Series {
        skipped.push("series: a scene with an orbit is solved about the closed form".to_owned());
    }
    skipped.extend(gradient.skipped());
    let plan = Plan {
        mode,
        method: Method::Closed,
        order: 0,
        harmonics: 0,
        error_bound: (gradient.error + 4.0 * ROUNDING).min(std::f64::consts::PI),
        tolerance: scene.asked_tolerance(),
        spanned: scene.asked_span().is_some(),
        separatrix_ratio: ratio,
        gradient: Some(gradient.plan()),
        skipped,
    };
    let error = gradient.error;
    let motion = Motion {
        plan,
        frequencies: Frequencies { anomaly, longitude },
        precession: longitude + anomaly,
        angular_momentum: angular_momentum(&scene, polhode),
        long_axis: polhode.long_axis,
        course: Course::Gradient(Box::new(gradient)),
        scene,
    };
    let orbits = request.duration * orbit.mean_motion() / std::f64::consts::TAU;
    if request.level == Level::Full && orbits < 1.0 && error > WORTH.max(request.tolerance) {
        let effect = effect(&motion)?;
        if error > effect {
            return Err(Error::TorqueTooStrong { size: error, bound: effect });
        }
    }
    Ok(motion)
}

/// Largest turn between a motion under a torque and the free one over the span.
fn effect(motion: &Motion) -> Result<f64, Error> {
    let scene = &motion.scene;
    let (start, stop) = scene.asked_span().unwrap_or((scene.state().epoch, scene.state().epoch));
    let free = Motion::new(Scene::new(scene.body().clone(), *scene.state()).span(start, stop))?;
    (0..=EFFECT_SAMPLES).try_fold(0.0_f64, |largest, k| {
        let time = start + (stop - start) * f64::from(k) / f64::from(EFFECT_SAMPLES);
        Ok(largest.max(free.at(time)?.attitude.angle_to(&motion.at(time)?.attitude)))
    })
}

fn round_body() -> Vec<String> {
    vec!["series: two moments are equal, the wobble is a circle and the precession regular".to_owned()]
}

fn dropped_harmonics(series: &QuaternionSeries, all: usize) -> Vec<String> {
    let kept = series.harmonics();
    let reason = (kept < all).then(|| format!("harmonics above {kept}: together below an eighth of the tolerance"));
    reason.into_iter().collect()
}

/// The motion with what its scene asked for and did not need among what was skipped.
fn with_unused(mut motion: Motion) -> Motion {
    let scene = &motion.scene;
    let mut unused: Vec<String> = match (motion.plan.method, motion.plan.mode) {
        (Method::Series, Mode::ShortAxis | Mode::LongAxis) => None,
        (_, Mode::ShortAxis | Mode::LongAxis) => {
            scene.asked_order().map(|order| format!("order {order}, which was asked for: the closed form has none"))
        }
        _ => unused_order(scene),
    }
    .into_iter()
    .collect();
    if scene.asked_orbit().is_some() {
        unused.push("gravity gradient: it exerts no torque on a sphere".to_owned());
    } else {
        let (averaging, level) = (scene.asked_averaging(), scene.asked_level());
        if averaging != Averaging::default() {
            unused.push(format!("averaging {averaging}, which was asked for: there is no orbit"));
        }
        if level != Level::default() {
            unused.push(format!("level {level}, which was asked for: there is no orbit"));
        }
    }
    motion.plan.skipped.extend(unused);
    motion
}

fn unused_order(scene: &Scene) -> Option<String> {
    scene.asked_order().map(|order| format!("order {order}, which was asked for: this motion has no series"))
}

/// The rotation that leads from the invariable plane, with a node at which y = 0 at the epoch, to the inertial frame.
fn invariable_frame(scene: &Scene, polhode: &Polhode, zeta: [f64; 2]) -> UnitQuaternion<f64> {
    let half_z = 0.25 * (zeta[0] * zeta[0] + zeta[1] * zeta[1]);
    let relative = Quaternion::new((1.0 - half_z).max(0.0).sqrt(), 0.5 * zeta[0], 0.5 * zeta[1], 0.0);
    let relative = UnitQuaternion::new_normalize(relative);
    scene.state().attitude * (relative * polhode.frame.quaternion).inverse()
}
