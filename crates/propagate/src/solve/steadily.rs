//! Motions without a wobble: rest, and rotation about an axis that keeps its place in the body (theory §5).
//!
//! A sphere, a principal axis, any axis across the equal ones of a round body: the attitude turns about the constant angular velocity at M over the moment about it.

use andoyer_double::DoubleDouble;
use nalgebra::Vector3;

use crate::input::options::Method;
use crate::input::scene::Scene;
use crate::motion::plan::Plan;
use crate::motion::solved::{Frequencies, Motion};
use crate::motion::trajectory::Course;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::{half, scaled, user_rate};
use crate::torque_free::error_budget::{ROUNDING, departure, phase_rounding};
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::{Polhode, SMALLEST_TILT};

/// The motion of a body at rest.
pub(crate) fn at_rest(scene: Scene) -> Motion {
    let half_angle = Phase::new(DoubleDouble::ZERO, 0.0);
    Motion {
        plan: steady_plan(&scene, Mode::AtRest, "the body is at rest"),
        course: Course::steady(scene.state(), Vector3::zeros(), half_angle),
        frequencies: Frequencies { anomaly: 0.0, longitude: 0.0 },
        given: None,
        precession: 0.0,
        angular_momentum: Vector3::zeros(),
        long_axis: false,
        scene,
    }
}

fn steady_plan(scene: &Scene, mode: Mode, reason: &str) -> Plan {
    Plan {
        mode,
        method: Method::Closed,
        order: 0,
        harmonics: 0,
        error_bound: ROUNDING,
        tolerance: scene.asked_tolerance(),
        spanned: scene.asked_span().is_some(),
        separatrix_ratio: 0.0,
        gradient: None,
        skipped: vec![format!("series: {reason}")],
    }
}

/// Rotation about an axis that keeps its place in the body.
pub(crate) fn steadily_rotating(scene: Scene, polhode: &Polhode, mode: Mode) -> Motion {
    let [_, g2, g3] = polhode.direction;
    let [_, second] = polhode.excesses;
    // With A = B every axis across axis 3 is a principal one, and M over their moment the rate; of three unequal moments only the middle one is across.
    let across = mode == Mode::PrincipalAxis && second != DoubleDouble::ZERO && g3.abs() < SMALLEST_TILT;
    let middle = across && polhode.difference != DoubleDouble::ZERO;
    let reason = match mode {
        Mode::Spherical => "every axis of a sphere is a principal axis",
        _ if middle => "the rotation is about the axis of middle inertia, its unstable equilibrium",
        _ if across => "A = B and the rotation is about one of their axes",
        _ if g2.abs() < SMALLEST_TILT && polhode.long_axis => "the rotation is about the axis of least inertia",
        _ if g2.abs() < SMALLEST_TILT => "the rotation is about the axis of greatest inertia (J = 0)",
        _ => "B = C and the rotation is about one of their axes",
    };
    let rate = if across { polhode.middle_rate() } else { polhode.mean_rate() };
    let (_, exponent) = polhode.scales;
    let axis = polhode.frame.user(polhode.direction);
    let anomaly = if across { DoubleDouble::ZERO } else { rate * polhode.gamma() };
    let mut plan = steady_plan(&scene, mode, reason);
    plan.error_bound += phase_rounding(&scene, rate, exponent);
    if across {
        plan.separatrix_ratio = 1.0;
    }
    if middle {
        plan.error_bound = (plan.error_bound + departure(&scene, polhode)).min(std::f64::consts::PI);
    }
    Motion {
        plan,
        course: Course::steady(scene.state(), Vector3::from(axis), half(user_rate(rate, exponent), 0.0)),
        frequencies: Frequencies {
            anomaly: scaled(anomaly.to_f64(), exponent),
            longitude: scaled(rate.to_f64(), exponent),
        },
        given: None,
        precession: scaled((rate + anomaly).to_f64(), exponent),
        angular_momentum: polhode.angular_momentum(scene.state().attitude),
        long_axis: polhode.long_axis,
        scene,
    }
}
