//! Motions without a torque: at rest, about an axis fixed in the body, wobbling, and on the separatrix (theory §5 to §8).

use crate::error::Error;
#[cfg(test)]
use crate::input::body::Body;
use crate::input::options::{Averaging, Level, Method};
use crate::input::scene::Scene;
#[cfg(test)]
use crate::input::state::State;
use crate::motion::plan::Plan;
use crate::motion::solved::{Frequencies, Motion};
use crate::motion::trajectory::Trajectory;
use crate::numerics::scaling::{exponent, half, scaled, user_rate};
use crate::torque_free::error_budget::phase_rounding;
use crate::torque_free::frequencies::Secular;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::{Polhode, UserFrame};
use crate::torque_free::separatrix::Passage;
use crate::torque_free::series::solution::by_the_series;
use crate::torque_free::solution::{CayleyKlein, Solution, by_theta_functions, on_the_separatrix};
use crate::torque_free::steady::SteadyRotation;
use crate::torque_free::wobble::{Wobble, WobbleEvaluator};

/// Frequencies that are known before a scene is solved, and whether its plan has remarks.
#[derive(Clone, Copy)]
pub(crate) struct Preparation {
    /// The frequencies, if they are computed already.
    pub(crate) secular: Option<Secular>,
    /// Whether the plan says what was skipped.
    pub(crate) remarks: bool,
}

/// The motion on a polhode of a scene whose bodies exert no torque; `None` for a body at rest.
///
/// # Errors
/// [`Error::Units`], and those of the series.
pub(crate) fn motion(scene: Scene, polhode: Option<&Polhode>, preparation: Preparation) -> Result<Motion, Error> {
    let Some(polhode) = polhode else {
        let mut motion = at_rest(scene);
        remark_unused(&mut motion);
        return Ok(motion);
    };
    representable(polhode)?;
    let mode = Mode::of(polhode);
    let mut solved = match mode {
        Mode::Spherical | Mode::PrincipalAxis => Ok(steadily_rotating(scene, polhode, mode)),
        _ => wobbling(scene, preparation, polhode, mode),
    };
    // The motion is not moved: it has some hundreds of bytes.
    if let Ok(motion) = &mut solved {
        remark_unused(motion);
    }
    solved
}

impl Default for Preparation {
    /// Nothing is known, and the plan has remarks.
    fn default() -> Self {
        Self { secular: None, remarks: true }
    }
}

/// Whether the angular momentum and every rate of a motion are normal doubles in the user's units.
pub(crate) fn representable(polhode: &Polhode) -> Result<(), Error> {
    let (moment, rate) = polhode.scales;
    if !polhode.user_momentum().is_normal() {
        return Err(Error::Units { quantity: "the angular momentum", exponent: moment + rate });
    }
    // No rate or frequency of the motion is more than twice M over the smallest moment.
    let smallest = polhode.moments.iter().copied().fold(f64::INFINITY, f64::min);
    let fastest = polhode.invariants.momentum.to_f64() / smallest;
    if !scaled(4.0 * fastest, rate).is_finite() {
        let exponent = exponent(fastest) + rate;
        return Err(Error::Units { quantity: "the rate that belongs to the smallest moment", exponent });
    }
    Ok(())
}

/// The motion of a body at rest.
fn at_rest(scene: Scene) -> Motion {
    let rotation = SteadyRotation::none();
    let mut plan = Plan::new(&scene, Mode::AtRest, rotation.separatrix_ratio, rotation.error_bound);
    plan.skipped.push(format!("series: {}", rotation.reason));
    Motion {
        plan,
        trajectory: Trajectory::Steady(Box::new(rotation.evaluator(scene.state(), 0))),
        frequencies: Frequencies { anomaly: 0.0, longitude: 0.0 },
        given: None,
        precession: 0.0,
        angular_momentum: [0.0; 3].into(),
        long_axis: false,
        scene,
    }
}

/// The motion about an axis that keeps its place in the body.
fn steadily_rotating(scene: Scene, polhode: &Polhode, mode: Mode) -> Motion {
    let rotation = SteadyRotation::new(&scene, polhode, mode);
    let mut plan = Plan::new(&scene, mode, rotation.separatrix_ratio, rotation.error_bound);
    plan.skipped.push(format!("series: {}", rotation.reason));
    let (_, exponent) = polhode.scales;
    let SteadyRotation { rate, anomaly_rate, .. } = rotation;
    let [anomaly, longitude, precession] =
        [anomaly_rate, rate, rate + anomaly_rate].map(|rate| scaled(rate.to_f64(), exponent));
    Motion {
        plan,
        trajectory: Trajectory::Steady(Box::new(rotation.evaluator(scene.state(), exponent))),
        frequencies: Frequencies { anomaly, longitude },
        given: None,
        precession,
        angular_momentum: polhode.angular_momentum(scene.state().attitude),
        long_axis: polhode.long_axis,
        scene,
    }
}

/// The motion of a wobbling body, or of one on the separatrix.
fn wobbling(scene: Scene, preparation: Preparation, polhode: &Polhode, mode: Mode) -> Result<Motion, Error> {
    let Preparation { secular, remarks } = preparation;
    if mode == Mode::Separatrix {
        return match scene.asked_method() {
            Method::Series => Err(Error::Separatrix),
            _ => {
                let solution = on_the_separatrix(&scene, polhode);
                let plan = Plan::new(&scene, mode, 1.0, solution.error_bound);
                Ok(assembled(scene, polhode, plan, solution))
            }
        };
    }
    let exact = secular.unwrap_or_else(|| Secular::exact(polhode));
    let ratio = (exact.kappa_sigma / polhode.invariants.kappa / polhode.separatrix_action()).min(1.0);
    let by_series = match scene.asked_method() {
        Method::Series => true,
        // A fixed order is one of the series.
        Method::Auto => scene.asked_order().is_some() && mode != Mode::Axisymmetric,
        _ => false,
    };
    let solution = if by_series {
        by_the_series(&scene, polhode, exact, ratio, mode)?
    } else {
        by_theta_functions((&scene, remarks), polhode, exact, ratio, mode)
    };
    let phases = phase_rounding(&scene, exact.longitude_rate, polhode.scales.1);
    let mut plan = Plan::new(&scene, mode, ratio, solution.error_bound + phases);
    plan.method = if by_series { Method::Series } else { Method::Closed };
    plan.expanded = polhode.has_small_divisor(scene.body().has_tensor());
    Ok(assembled(scene, polhode, plan, solution))
}

/// The motion of a wobbling body by the closed form, with every harmonic above rounding. Derivatives are those of this motion.
pub(crate) fn untruncated(scene: &Scene, polhode: &Polhode, mode: Mode) -> Result<Motion, Error> {
    let preparation = Preparation { secular: None, remarks: false };
    wobbling(scene.clone().method(Method::Closed).tolerance(0.0), preparation, polhode, mode)
}

fn assembled(scene: Scene, polhode: &Polhode, mut plan: Plan, solution: Solution) -> Motion {
    let Solution { parameters, longitude, rates, order, harmonics, skipped, .. } = solution;
    (plan.order, plan.harmonics, plan.skipped) = (order, harmonics, skipped);
    let exponent = polhode.scales.1;
    let longitude_rate = user_rate(rates.longitude_rate, exponent);
    let [anomaly, precession] =
        [rates.anomaly_rate, rates.longitude_rate + rates.anomaly_rate].map(|rate| scaled(rate.to_f64(), exponent));
    let half_longitude = half(longitude_rate, longitude);
    let place = UserFrame {
        inertial: polhode.invariable_frame(scene.state().attitude),
        frame: polhode.frame.clone(),
        rates: polhode.user_rates(),
    };
    let trajectory = match parameters {
        CayleyKlein::Fourier(anomaly, series) => {
            let wobble = Wobble { anomaly, series, half_longitude, place };
            Trajectory::Wobble(Box::new(WobbleEvaluator::new(&wobble)))
        }
        CayleyKlein::Passage(passage) => Trajectory::Passage(Box::new(Passage { passage, half_longitude, place })),
    };
    Motion {
        plan,
        trajectory,
        frequencies: Frequencies { anomaly, longitude: longitude_rate.to_f64() },
        given: None,
        precession,
        angular_momentum: polhode.angular_momentum(scene.state().attitude),
        long_axis: polhode.long_axis,
        scene,
    }
}

/// Adds to the plan's list of skipped parts the options of the scene that the motion did not need.
fn remark_unused(motion: &mut Motion) {
    let Motion { scene, plan, .. } = motion;
    plan.skipped.extend(match (plan.method, plan.mode) {
        (Method::Series, Mode::ShortAxis | Mode::LongAxis) => None,
        (_, Mode::ShortAxis | Mode::LongAxis) => {
            scene.asked_order().map(|order| format!("order {order}, which was asked for: the closed form has none"))
        }
        _ => unused_order(scene),
    });
    if !scene.asked_disturbing().is_empty() {
        plan.skipped.push("gravity gradient: it exerts no torque on a sphere".to_owned());
        return;
    }
    let (averaging, level) = (scene.asked_averaging(), scene.asked_level());
    if averaging != Averaging::default() {
        plan.skipped.push(format!("averaging {averaging}, which was asked for: there is no orbit"));
    }
    if level != Level::default() {
        plan.skipped.push(format!("level {level}, which was asked for: there is no orbit"));
    }
}

/// The plan's remark about a requested order if the motion has no series.
pub(crate) fn unused_order(scene: &Scene) -> Option<String> {
    scene.asked_order().map(|order| format!("order {order}, which was asked for: this motion has no series"))
}

/// A free motion of the unit tests. The choice among all methods would compile them all for the tests.
#[cfg(test)]
pub(crate) fn solved(moments: [f64; 3], state: State) -> Motion {
    let scene = Scene::new(Body::new(moments).expect("a body"), state);
    let polhode = Polhode::new(scene.body(), scene.state());
    motion(scene, polhode.as_ref(), Preparation::default()).expect("a motion")
}
