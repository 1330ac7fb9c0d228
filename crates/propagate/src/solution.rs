//! From a scene to its motion: mode, order, secular part, series, initial phases (theory §5 to §8).

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::error::Error;
use crate::fourier::{Ellipse, QuaternionSeries, oscillator_and_longitude};
use crate::motion::{Course, Frequencies, Motion, Wobble};
use crate::phase::Phase;
use crate::plan::{MAX_ORDER, Mode, Plan};
use crate::polhode::{Polhode, scaled};
use crate::scene::Scene;
use crate::secular::Secular;
use crate::series::{Expansion, Tables};
use andoyer_series::DoubleDouble;

/// What double precision leaves of an attitude: rounding of the frames, of two quaternion products, and, for eight harmonics each, of the sums \[rad\].
const ROUNDING: f64 = 2.5e-15;
/// Part of the tolerance that dropped harmonics may use.
const HARMONICS_SHARE: f64 = 0.125;
/// Part of the tolerance that truncation may use.
const TRUNCATION_SHARE: f64 = 0.75;
/// Truncation below this is lost in rounding \[rad\].
const SMALLEST_TOLERANCE: f64 = 1e-15;
/// Rotations over which the tolerance holds if no span is given.
const DEFAULT_ROTATIONS: f64 = 1e9;
/// Relative error of frequencies and phases in double-double: 2^−104, twenty operations deep.
const PHASE_ROUNDING: f64 = 1e-30;
/// sin J below which the wobble is nothing: its square has no normal double.
const SMALLEST_TILT: f64 = 1e-150;

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
        match mode(&polhode)? {
            mode @ (Mode::ShortAxis | Mode::Axisymmetric) => wobbling(scene, &polhode, mode),
            mode => Ok(steadily_rotating(scene, &polhode, mode)),
        }
    }
}

fn mode(polhode: &Polhode) -> Result<Mode, Error> {
    let [g1, g2, _] = polhode.direction;
    let [first, second] = polhode.excesses;
    if first == DoubleDouble::ZERO {
        return Ok(Mode::Spherical);
    }
    // With B = C every axis across axis 1 is one of greatest inertia.
    if g1.abs() < SMALLEST_TILT && (g2.abs() < SMALLEST_TILT || second == DoubleDouble::ZERO) {
        return Ok(Mode::PrincipalAxis);
    }
    if polhode.difference == DoubleDouble::ZERO {
        return Ok(Mode::Axisymmetric);
    }
    if second == DoubleDouble::ZERO {
        return Err(Error::LongAxisMode { energy_ratio: f64::INFINITY });
    }
    let nearest = polhode.cosine_squares()[0].high;
    if nearest < 0.0 {
        return Err(Error::LongAxisMode { energy_ratio: polhode.energy_ratio() });
    }
    if nearest < SMALLEST_TILT * SMALLEST_TILT {
        return Err(Error::Separatrix);
    }
    Ok(Mode::ShortAxis)
}

fn at_rest(scene: Scene) -> Motion {
    let half_angle = Phase::new(DoubleDouble::ZERO, 0.0);
    Motion {
        plan: steady_plan(&scene, Mode::AtRest, "the body is at rest"),
        course: Course::steady(scene.state(), Vector3::zeros(), half_angle),
        frequencies: Frequencies { anomaly: 0.0, longitude: 0.0 },
        angular_momentum: Vector3::zeros(),
        scene,
    }
}

fn steady_plan(scene: &Scene, mode: Mode, reason: &str) -> Plan {
    let mut skipped = vec![format!("series: {reason}")];
    skipped.extend(unused_order(scene));
    Plan {
        mode,
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
    let [_, g2, _] = polhode.direction;
    let reason = match mode {
        Mode::Spherical => "every axis of a sphere is a principal axis",
        _ if g2.abs() < SMALLEST_TILT => "the rotation is about the axis of greatest inertia (J = 0)",
        _ => "B = C and the rotation is about one of their axes",
    };
    // |ω| = M/C: the moment about the axis that turns is the greatest.
    let rate = polhode.mean_rate();
    let (_, exponent) = polhode.scales;
    let axis = polhode.frame.user(polhode.direction);
    let anomaly = scaled((rate * polhode.gamma()).to_f64(), exponent);
    let mut plan = steady_plan(&scene, mode, reason);
    plan.error_bound += phase_rounding(&scene, rate, exponent);
    Motion {
        plan,
        course: Course::steady(scene.state(), Vector3::from(axis), half(user_rate(rate, exponent), 0.0)),
        frequencies: Frequencies { anomaly, longitude: scaled(rate.to_f64(), exponent) },
        angular_momentum: angular_momentum(&scene, polhode),
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

fn wobbling(scene: Scene, polhode: &Polhode, mode: Mode) -> Result<Motion, Error> {
    let exact = Secular::exact(polhode);
    let ratio = (exact.kappa_sigma / polhode.kappa() / scene.body().separatrix_action()).min(1.0);
    let (order, series_of_order) = expanded(&scene, polhode, &exact, ratio, mode)?;
    let Expanded { expansion, secular, ellipse, truncation } = series_of_order;
    let (series, dropped) =
        QuaternionSeries::new(&expansion, ellipse).truncated(HARMONICS_SHARE * scene.asked_tolerance());

    let zeta = polhode.zeta();
    let anomaly = initial_anomaly(&expansion, ellipse.oscillator(zeta));
    let (_, longitude) = oscillator_and_longitude(&expansion, |h| (h as f64 * anomaly).sin_cos());
    let exponent = polhode.scales.1;
    let anomaly_rate = user_rate(secular.anomaly_rate, exponent);
    let longitude_rate = user_rate(secular.longitude_rate, exponent);

    let phases = drift(&scene, &exact, &secular, exponent) + phase_rounding(&scene, exact.longitude_rate, exponent);
    let rounding = ROUNDING * (1.0 + series.harmonics() as f64 / 8.0);
    let error_bound = (truncation + dropped + phases + rounding).min(std::f64::consts::PI);
    let plan = Plan {
        mode,
        order,
        harmonics: series.harmonics(),
        error_bound,
        tolerance: scene.asked_tolerance(),
        separatrix_ratio: ratio,
        skipped: skipped(&scene, mode, order, &series),
    };
    Ok(Motion {
        plan,
        course: Course::polhode(&Wobble {
            anomaly: Phase::new(anomaly_rate, anomaly),
            half_longitude: half(longitude_rate, -longitude),
            series,
            inertial: invariable_frame(&scene, polhode, zeta),
            frame: polhode.frame.clone(),
            rates: polhode.user_rates(),
        }),
        frequencies: Frequencies { anomaly: anomaly_rate.to_f64(), longitude: longitude_rate.to_f64() },
        angular_momentum: angular_momentum(&scene, polhode),
        scene,
    })
}

/// The series of one order, and what it leaves out.
struct Expanded {
    expansion: Expansion,
    secular: Secular,
    ellipse: Ellipse,
    truncation: f64,
}

/// The series at the order asked for, or at the lowest whose truncation leaves the tolerance its share.
///
/// The first order tried is that at which (σ/σ_sep)^(N+1)/(N+1), theory §5 and a share that was measured, is below the tolerance.
fn expanded(
    scene: &Scene,
    polhode: &Polhode,
    exact: &Secular,
    ratio: f64,
    mode: Mode,
) -> Result<(usize, Expanded), Error> {
    let target = scene.asked_tolerance().max(SMALLEST_TOLERANCE);
    let first = match (mode, scene.asked_order()) {
        (Mode::Axisymmetric, _) => Some(0), // the series ends with the quadratic part
        (_, Some(order)) if ratio < 1.0 => Some(order),
        _ => (0..=MAX_ORDER).find(|&order| ratio.powi(order as i32 + 1) <= target * (order as f64 + 1.0)),
    };
    for order in first.unwrap_or(MAX_ORDER)..=MAX_ORDER {
        let tables = Tables::new(scene.body().beta(), order)?;
        let fixed = mode == Mode::ShortAxis && scene.asked_order().is_some();
        let secular = if fixed { Secular::truncated(polhode, tables.polynomials()) } else { *exact };
        let expansion = tables.expand(secular.kappa_sigma, polhode.kappa());
        let [first, second] = polhode.excesses;
        let ellipse = Ellipse::new((first / second).to_f64());
        let truncation = truncation(&expansion, ellipse, ratio, mode);
        if (fixed && ratio < 1.0) || truncation <= TRUNCATION_SHARE * target {
            return Ok((order, Expanded { expansion, secular, ellipse, truncation }));
        }
        if order == MAX_ORDER {
            let attainable = truncation / TRUNCATION_SHARE;
            return Err(Error::NearSeparatrix { ratio, tolerance: scene.asked_tolerance(), attainable });
        }
    }
    Err(Error::Order { value: scene.asked_order().unwrap_or(MAX_ORDER) })
}

/// What the orders left out turn the attitude by \[rad\]: a geometric tail of the last one kept, at the time asked for and in both initial phases.
///
/// Hence the factor 3; with 2 some errors at orders 1 and 2 pass the bound by up to a fifth.
fn truncation(expansion: &Expansion, ellipse: Ellipse, ratio: f64, mode: Mode) -> f64 {
    match mode {
        Mode::Axisymmetric => 0.0,
        _ => 3.0 * ellipse.long * expansion.last_order * ratio / (1.0 - ratio),
    }
}

/// How far a fixed order lets the phases drift over the span \[rad\].
fn drift(scene: &Scene, exact: &Secular, secular: &Secular, exponent: i32) -> f64 {
    let anomaly = (exact.anomaly_rate - secular.anomaly_rate).to_f64().abs();
    let longitude = (exact.longitude_rate - secular.longitude_rate).to_f64().abs();
    (anomaly + longitude) * duration(scene, exact.longitude_rate, exponent)
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

fn skipped(scene: &Scene, mode: Mode, order: usize, series: &QuaternionSeries) -> Vec<String> {
    if mode == Mode::Axisymmetric {
        let reason = "series: A = B, the wobble is a circle and the precession regular".to_owned();
        return std::iter::once(reason).chain(unused_order(scene)).collect();
    }
    let kept = series.harmonics();
    if kept == 4 * order + 3 {
        return Vec::new();
    }
    vec![format!("harmonics above {kept}: together below an eighth of the tolerance")]
}

/// The rotation that leads from the invariable plane, with a node at which y = 0 at the epoch, to the inertial frame.
fn invariable_frame(scene: &Scene, polhode: &Polhode, zeta: [f64; 2]) -> UnitQuaternion<f64> {
    let half_z = 0.25 * (zeta[0] * zeta[0] + zeta[1] * zeta[1]);
    let relative = Quaternion::new((1.0 - half_z).max(0.0).sqrt(), 0.5 * zeta[0], 0.5 * zeta[1], 0.0);
    let relative = UnitQuaternion::new_normalize(relative);
    scene.state().attitude * (relative * polhode.frame.quaternion).inverse()
}

/// ℓ′ whose transformed w has the direction of `target`.
///
/// ℓ = 0, π/2, … are fixed points by symmetry, so the root is in the quadrant of the target. Regula falsi on the cross product, which
/// stays within its bracket; the end that stays twice has its value halved (the Illinois rule), so that both ends move.
fn initial_anomaly(expansion: &Expansion, target: [f64; 2]) -> f64 {
    let folded = [target[0].abs(), target[1].abs()];
    let cross = |angle: f64| {
        let (w, _) = oscillator_and_longitude(expansion, |h| (h as f64 * angle).sin_cos());
        (w[1] * folded[0] - w[0] * folded[1]) / (w[0].hypot(w[1]) * folded[0].hypot(folded[1]))
    };
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    let (mut low_value, mut high_value) = (cross(low), cross(high));
    let mut angle = folded[1].atan2(folded[0]);
    let mut last = 0.0_f64;
    // Superlinear; 200 steps are past any convergence.
    for _ in 0..200 {
        let value = cross(angle);
        if value == 0.0 || high - low <= f64::EPSILON {
            break;
        }
        let again = value * last > 0.0;
        if value < 0.0 {
            (low, low_value) = (angle, value);
            high_value *= if again { 0.5 } else { 1.0 };
        } else {
            (high, high_value) = (angle, value);
            low_value *= if again { 0.5 } else { 1.0 };
        }
        last = value;
        let next = (low * high_value - high * low_value) / (high_value - low_value);
        // A bracket that has closed on an axis of symmetry gives 0/0, which moves nothing.
        let moves = (next - angle).abs() > 0.5 * f64::EPSILON;
        if !moves {
            break;
        }
        angle = next;
    }
    let upper = if target[0] < 0.0 { std::f64::consts::PI - angle } else { angle };
    if target[1] < 0.0 { -upper } else { upper }
}
