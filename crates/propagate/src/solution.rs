//! From a scene to its motion: mode, method, secular part, series, initial phases (theory §5 to §8, §10).

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use andoyer_series::{DoubleDouble, separatrix_action};

use crate::closed::{ClosedForm, NEAREST_COMPLEMENT, anomaly};
use crate::elliptic::Theta;
use crate::error::Error;
use crate::fourier::{QuaternionSeries, oscillator_and_longitude};
use crate::motion::{Course, Frequencies, Motion, Place, Wobble};
use crate::order::{Expanded, expanded, first_order, initial_anomaly};
use crate::phase::Phase;
use crate::plan::{Mode, Plan};
use crate::polhode::{Polhode, SMALLEST_TILT, scaled};
use crate::scene::{Method, Scene};
use crate::secular::Secular;
use crate::separatrix::{Clock, Flip, Passage};

/// What double precision leaves of an attitude: rounding of the frames, of two quaternion products, and, for eight harmonics each, of the sums \[rad\].
const ROUNDING: f64 = 3e-15;
/// Part of the tolerance that dropped harmonics may use.
const HARMONICS_SHARE: f64 = 0.125;
/// Rotations over which the tolerance holds if no span is given.
const DEFAULT_ROTATIONS: f64 = 1e9;
/// Relative error of frequencies and phases in double-double: 2^−104, twenty operations deep.
const PHASE_ROUNDING: f64 = 1e-30;
/// Relative error of the terms of Q1 in double-double, with inputs taken as exact.
const COSINE_ROUNDING: f64 = 1e-31;

impl Motion {
    /// The motion of a valid scene.
    pub(crate) fn new(scene: Scene) -> Result<Self, Error> {
        let Some(polhode) = Polhode::new(scene.body(), scene.state()) else {
            return Ok(at_rest(scene));
        };
        let momentum = polhode.user_momentum();
        if !momentum.is_normal() {
            let (moment, rate) = polhode.scales;
            return Err(Error::Units { exponent: moment + rate });
        }
        match mode(&polhode) {
            mode @ (Mode::Spherical | Mode::PrincipalAxis) => Ok(steadily_rotating(scene, &polhode, mode)),
            Mode::Separatrix => passing(scene, &polhode),
            mode => wobbling(scene, &polhode, mode),
        }
    }
}

fn mode(polhode: &Polhode) -> Mode {
    let [g1, g2, g3] = polhode.direction.map(|g| g.abs() < SMALLEST_TILT);
    let [first, second] = polhode.excesses;
    if first == DoubleDouble::ZERO {
        return Mode::Spherical;
    }
    // With B = C every axis across axis 1 is one of greatest inertia; in the middle between A and C rotation is steady too, as long as it is exact.
    if g1 && (g2 || g3 || second == DoubleDouble::ZERO) {
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

fn at_rest(scene: Scene) -> Motion {
    let half_angle = Phase::new(DoubleDouble::ZERO, 0.0);
    Motion {
        plan: steady_plan(&scene, Mode::AtRest, "the body is at rest"),
        course: Course::steady(scene.state(), Vector3::zeros(), half_angle),
        frequencies: Frequencies { anomaly: 0.0, longitude: 0.0 },
        angular_momentum: Vector3::zeros(),
        long_axis: false,
        scene,
    }
}

fn steady_plan(scene: &Scene, mode: Mode, reason: &str) -> Plan {
    let mut skipped = vec![format!("series: {reason}")];
    skipped.extend(unused_order(scene));
    Plan {
        mode,
        method: Method::Closed,
        order: 0,
        harmonics: 0,
        error_bound: ROUNDING,
        tolerance: scene.asked_tolerance(),
        separatrix_ratio: 0.0,
        skipped,
    }
}

fn unused_order(scene: &Scene) -> Option<String> {
    scene.asked_order().map(|order| format!("order {order}, which was asked for: this motion has no series"))
}

fn steadily_rotating(scene: Scene, polhode: &Polhode, mode: Mode) -> Motion {
    let [_, g2, g3] = polhode.direction;
    let [_, second] = polhode.excesses;
    let middle = mode == Mode::PrincipalAxis && second != DoubleDouble::ZERO && g3.abs() < SMALLEST_TILT;
    let reason = match mode {
        Mode::Spherical => "every axis of a sphere is a principal axis",
        _ if middle => "the rotation is about the axis of middle inertia, its unstable equilibrium",
        _ if g2.abs() < SMALLEST_TILT && polhode.long_axis => "the rotation is about the axis of least inertia",
        _ if g2.abs() < SMALLEST_TILT => "the rotation is about the axis of greatest inertia (J = 0)",
        _ => "B = C and the rotation is about one of their axes",
    };
    let rate = if middle { polhode.middle_rate() } else { polhode.mean_rate() };
    let (_, exponent) = polhode.scales;
    let axis = polhode.frame.user(polhode.direction);
    let anomaly = if middle { 0.0 } else { scaled((rate * polhode.gamma()).to_f64(), exponent) };
    let mut plan = steady_plan(&scene, mode, reason);
    plan.error_bound += phase_rounding(&scene, rate, exponent);
    if middle {
        plan.separatrix_ratio = 1.0;
    }
    Motion {
        plan,
        course: Course::steady(scene.state(), Vector3::from(axis), half(user_rate(rate, exponent), 0.0)),
        frequencies: Frequencies { anomaly, longitude: scaled(rate.to_f64(), exponent) },
        angular_momentum: angular_momentum(&scene, polhode),
        long_axis: polhode.long_axis,
        scene,
    }
}

fn user_rate(rate: DoubleDouble, exponent: i32) -> DoubleDouble {
    DoubleDouble { high: scaled(rate.high, exponent), low: scaled(rate.low, exponent) }
}

/// The phase of half an angle, which a quaternion needs: whole turns of it leave the sign alone.
fn half(rate: DoubleDouble, start: f64) -> Phase {
    Phase::new(rate * DoubleDouble::from(0.5), 0.5 * start)
}

fn angular_momentum(scene: &Scene, polhode: &Polhode) -> Vector3<f64> {
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
    let ratio = (exact.kappa_sigma / polhode.kappa() / separatrix_action(polhode.beta())?).min(1.0);
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
        separatrix_ratio: ratio,
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
    let anomaly = scaled(solved.rates.anomaly_rate.to_f64(), exponent);
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
        if plan.mode == Mode::Axisymmetric { round_body(scene) } else { dropped_harmonics(&series, 4 * order + 3) };
    let anomaly = Phase::new(user_rate(secular.anomaly_rate, exponent), anomaly);
    Ok(Solved { pair: Pair::Fourier(anomaly, series), longitude: -longitude, rates: secular, plan })
}

fn by_theta_functions(scene: &Scene, polhode: &Polhode, rates: Secular, mut plan: Plan) -> Solved {
    let theta = Theta::new(polhode);
    let exponent = polhode.scales.1;
    let anomaly_rate = user_rate(rates.anomaly_rate, exponent);
    let series_order = first_order(plan.separatrix_ratio, plan.tolerance);
    if theta.complement < NEAREST_COMPLEMENT {
        let (place, turned) = Passage::place(polhode, &theta);
        let start = std::f64::consts::FRAC_PI_2 * place / theta.quarter;
        let start = if turned { start - std::f64::consts::PI } else { start };
        let scale = 0.5 * theta.quarter / theta.conjugate;
        let passage = Passage::new(&theta, Clock::Repeating(Phase::new(anomaly_rate, start), scale));
        plan.error_bound = 2.0 * ROUNDING + f64::EPSILON * theta.quarter + conditioning(scene, polhode, &rates);
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
        round_body(scene)
    } else {
        let reason = match series_order {
            Some(order) => {
                format!("series: for this tolerance it has order {order}, and no fewer harmonics than the closed form")
            }
            None => "series: too near the separatrix for its highest order".to_owned(),
        };
        std::iter::once(reason).chain(dropped_harmonics(&series, all)).collect()
    };
    let longitude = -2.0 * series.argument(closed.anomaly);
    let pair = Pair::Fourier(Phase::new(anomaly_rate, closed.anomaly), series);
    Solved { pair, longitude, rates, plan }
}

/// The motion on the separatrix: one passage, from and to rotation about the axis of middle inertia.
fn passing(scene: Scene, polhode: &Polhode) -> Result<Motion, Error> {
    if scene.asked_method() == Method::Series {
        return Err(Error::Separatrix);
    }
    let theta = Theta::new(polhode);
    let (place, turned) = Passage::place(polhode, &theta);
    let rate = (polhode.mean_rate() * polhode.gamma()).to_f64() * theta.cosines[1];
    let clock = Clock::Once(0.5 * place, 0.5 * scaled(rate, polhode.scales.1));
    let passage = Passage::new(&theta, clock).turned(turned);
    let rates = Secular { kappa_sigma: 0.0, anomaly_rate: DoubleDouble::ZERO, longitude_rate: polhode.middle_rate() };
    // A distance from the separatrix that double-double does not see grows like e^u.
    let growth = (rate.abs() * duration(&scene, rates.longitude_rate, polhode.scales.1)).exp();
    let unseen = if polhode.cosine_squares()[0] == DoubleDouble::ZERO { 0.0 } else { COSINE_ROUNDING * growth };
    let phases = phase_rounding(&scene, rates.longitude_rate, polhode.scales.1);
    let mut skipped = vec!["series: on the separatrix".to_owned()];
    skipped.extend(unused_order(&scene));
    let plan = Plan {
        mode: Mode::Separatrix,
        method: Method::Closed,
        order: 0,
        harmonics: 0,
        error_bound: (4.0 * ROUNDING + phases + unseen).min(std::f64::consts::PI),
        tolerance: scene.asked_tolerance(),
        separatrix_ratio: 1.0,
        skipped,
    };
    let longitude = -2.0 * passage.phase((0.0, 0.0));
    Ok(assembled(scene, polhode, Solved { pair: Pair::Passage(passage), longitude, rates, plan }))
}

fn rounding(series: &QuaternionSeries) -> f64 {
    ROUNDING * (1.0 + series.harmonics() as f64 / 8.0)
}

/// What the error of Q1, with inputs taken as exact, makes of the phase over the span \[rad\]: K goes with −½ ln Q1, so that each half turn of ℓ′ is late by half the
/// relative error of Q1, in u.
fn conditioning(scene: &Scene, polhode: &Polhode, rates: &Secular) -> f64 {
    let half_turns =
        (rates.anomaly_rate / rates.longitude_rate).to_f64().abs() * rotations(scene, rates, polhode) * 2.0;
    COSINE_ROUNDING * polhode.cancellation() * half_turns
}

fn rotations(scene: &Scene, rates: &Secular, polhode: &Polhode) -> f64 {
    duration(scene, rates.longitude_rate, polhode.scales.1) * rates.longitude_rate.to_f64() / std::f64::consts::TAU
}

/// How far a fixed order lets the phases drift over the span \[rad\].
fn drift(scene: &Scene, exact: &Secular, secular: &Secular, exponent: i32, quarter: f64) -> f64 {
    let anomaly = (exact.anomaly_rate - secular.anomaly_rate).to_f64().abs();
    let longitude = (exact.longitude_rate - secular.longitude_rate).to_f64().abs();
    // Where it is fastest the polhode turns 2K/π times as fast as ℓ′.
    (std::f64::consts::FRAC_2_PI * quarter * anomaly + longitude) * duration(scene, exact.longitude_rate, exponent)
}

/// What rounding of frequencies and phases adds over the span \[rad\].
fn phase_rounding(scene: &Scene, rate: DoubleDouble, exponent: i32) -> f64 {
    PHASE_ROUNDING * rate.to_f64() * duration(scene, rate, exponent)
}

/// The longest time from the epoch that the tolerance is asked for, in the scaled unit.
fn duration(scene: &Scene, rate: DoubleDouble, exponent: i32) -> f64 {
    let epoch = scene.state().epoch;
    match scene.asked_span() {
        Some((start, stop)) => scaled((start - epoch).abs().max((stop - epoch).abs()), exponent),
        None => DEFAULT_ROTATIONS * std::f64::consts::TAU / rate.to_f64(),
    }
}

fn round_body(scene: &Scene) -> Vec<String> {
    let reason = "series: two moments are equal, the wobble is a circle and the precession regular".to_owned();
    std::iter::once(reason).chain(unused_order(scene)).collect()
}

fn dropped_harmonics(series: &QuaternionSeries, all: usize) -> Vec<String> {
    let kept = series.harmonics();
    let reason = (kept < all).then(|| format!("harmonics above {kept}: together below an eighth of the tolerance"));
    reason.into_iter().collect()
}

/// The rotation that leads from the invariable plane, with a node at which y = 0 at the epoch, to the inertial frame.
fn invariable_frame(scene: &Scene, polhode: &Polhode, zeta: [f64; 2]) -> UnitQuaternion<f64> {
    let half_z = 0.25 * (zeta[0] * zeta[0] + zeta[1] * zeta[1]);
    let relative = Quaternion::new((1.0 - half_z).max(0.0).sqrt(), 0.5 * zeta[0], 0.5 * zeta[1], 0.0);
    let relative = UnitQuaternion::new_normalize(relative);
    scene.state().attitude * (relative * polhode.frame.quaternion).inverse()
}
