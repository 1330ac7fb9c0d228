//! The resonance of a scene, and its state in the frame that turns with the resonance.

use std::f64::consts::{FRAC_PI_2, PI};

use andoyer_double::DoubleDouble;
use andoyer_series::error::Short;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::shape::{LockedShape, PlaneMotion};
use crate::cassini::{CassiniState, cassini_states};
use crate::input::body::Body;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::motion::plan::in_words;
use crate::numerics::phase::Phase;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;
use crate::orbit::hansen::hansen;

/// Largest number of rotations in two orbits.
pub(crate) const MOST_IN_TWO: i32 = 8;

/// A Hansen coefficient X of the resonance below this holds no body: with ω_ψ² = 3 X (B − A)/C n² a libration takes 58,000 orbits or more.
const NO_TORQUE: f64 = 1e-10;

/// Largest angle of the body from the frame \[rad\], beyond which no series is tried; also the amplitude of a swing whose resonance is not the nearest one.
pub(super) const LARGEST_ANGLE: f64 = 0.6;

/// A scene in the frame of its resonance.
#[derive(Clone, Debug)]
pub(crate) struct Lock {
    pub(crate) shape: LockedShape,
    /// In the user's unit.
    pub(crate) mean_motion: f64,
    /// M and α at the epoch \[rad\], and as phases from there on.
    pub(crate) start: [f64; 2],
    pub(crate) phases: [Phase; 2],
    /// Half the angle r M + ψ₀ of the frame, or α if the orbit precesses.
    pub(crate) half_turn: Phase,
    /// From the frame at this angle 0 to inertial components, or to those that turn with the node.
    pub(crate) plane: UnitQuaternion<f64>,
    /// Half the longitude of the node, if the orbit precesses.
    pub(crate) half_node: Option<Phase>,
    /// From the sorted axes to the body's principal axes.
    pub(crate) body: UnitQuaternion<f64>,
    /// From the frame to inertial components at the epoch.
    pub(crate) turned: UnitQuaternion<f64>,
    /// ψ, p_ψ − C W₃, θ, p_θ, φ, p_φ at the epoch.
    pub(crate) state: [f64; 6],
    /// A bound of the angle by which the other bodies move the body \[rad\].
    pub(crate) others: f64,
}

impl Lock {
    /// The lock of a scene about principal axes, or the reason why it has none.
    pub(crate) fn new(scene: &Scene) -> Result<Self, String> {
        let (orbit, others) = strongest(scene.asked_disturbing())?;
        let (body, [a, b, c]) = axes_of(scene.body())?;
        let spin = spin(scene, orbit, body * Vector3::z());
        let nearest = (2.0 * spin).round() as i32;
        let orders = 1..=MOST_IN_TWO;
        let of = |twice: i32| Self::of_resonance(scene, (orbit, others), ([a, b, c], body), twice);
        let mut found = if orders.contains(&nearest) {
            of(nearest)
        } else {
            let (spin, most) = (Short::rounded(spin, 4), MOST_IN_TWO / 2);
            Err(format!("{spin} rotations an orbit are near no resonance from 1/2 to {most}"))
        };
        // In the middle of a swing a body can be nearer to the rate of the next resonance than to its own. |X| ≤ (1 − e)⁻³ bounds ω_ψ, and a pendulum swings no faster than ω_ψ.
        let kappa = orbit.disturbing_fraction();
        let fastest = 3.0 * kappa * (b - a) / (1.0 - orbit.eccentricity()).powi(3);
        for twice in [nearest.saturating_sub(1), nearest.saturating_add(1)] {
            if orders.contains(&twice)
                && (spin - f64::from(twice) / 2.0).powi(2) < fastest
                && let Ok(other) = of(twice)
                && other.amplitude_squared() < found.as_ref().map_or(LARGEST_ANGLE.powi(2), Self::amplitude_squared)
            {
                found = Ok(other);
            }
        }
        found
    }

    /// ψ² + (ψ̇/ω_ψ)², the square of the amplitude of a small libration in longitude \[rad²\].
    fn amplitude_squared(&self) -> f64 {
        let [longitude, rate, ..] = self.state;
        longitude.powi(2) + rate.powi(2) / self.shape.swing_rate_squared()
    }

    /// The lock to one resonance. `others` is the largest torque of the other bodies, as by [`strongest`]; `moments` are sorted, and `body` turns from their axes to the body's.
    fn of_resonance(
        scene: &Scene,
        (orbit, others): (&Orbit, f64),
        (moments, body): ([f64; 3], UnitQuaternion<f64>),
        twice: i32,
    ) -> Result<Self, String> {
        let mut shape = shape_of(orbit, moments, twice)?;
        let torque = shape.resonant.abs();
        let others = moved_by_others(scene, others / (orbit.strength() * torque), orbit.mean_motion())?;
        shape.precession = precession_of(scene, orbit, &shape, body)?;
        Ok(Self { others, ..Self::about(scene, orbit, shape, body)? })
    }

    /// The lock to a resonance at a time, of a body that stands still in its frame.
    pub(crate) fn at_rest(body: &Body, orbit: &Orbit, twice: i32, epoch: f64) -> Result<Self, String> {
        let (turn, moments) = axes_of(body)?;
        let mut shape = shape_of(orbit, moments, twice)?;
        let still = |shape: &LockedShape| {
            let attitude = FramePlace::new(orbit, epoch, shape).turned() * turn.inverse();
            let rates = attitude.inverse() * (orbit.mean_motion() * orbit.axes_at(epoch)[2]);
            Scene::new(body.clone(), State { epoch, attitude, angular_velocity: rates })
        };
        // The pole of the nearest stable Cassini state to the orbit's normal.
        shape.precession = precession_of(&still(&shape), orbit, &shape, turn)?;
        Self::about(&still(&shape), orbit, shape, turn)
    }

    /// The attitude, and the angular velocity about the body's axes, of ψ, p_ψ − C W₃, θ, p_θ, φ, p_φ at the epoch.
    pub(crate) fn attitude_and_rates(&self, variables: [f64; 6]) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let [psi, p_psi, theta, p_theta, phi, p_phi] = variables;
        let ((sin_theta, cos_theta), (sin_phi, cos_phi)) = (theta.sin_cos(), phi.sin_cos());
        let across = (p_psi + self.shape.precession.spin + sin_theta * p_phi) / cos_theta;
        let momentum = Vector3::new(p_phi, cos_phi * p_theta + sin_phi * across, cos_phi * across - sin_phi * p_theta);
        let rates = momentum.component_div(&Vector3::from(self.shape.moments)) * self.mean_motion;
        let seen = UnitQuaternion::from_euler_angles(phi, theta, psi);
        (self.turned * seen * self.body.inverse(), self.body * rates)
    }

    fn about(scene: &Scene, orbit: &Orbit, shape: LockedShape, body: UnitQuaternion<f64>) -> Result<Self, String> {
        let (resonance, n, epoch) = (f64::from(shape.twice) / 2.0, orbit.mean_motion(), scene.state().epoch);
        let anomaly = orbit.mean_anomaly(epoch);
        let [node, _] = orbit.node_and_argument(epoch);
        let place = FramePlace::new(orbit, epoch, &shape);
        let FramePlace { start, longitude, argument, turn, alpha, tilt } = place;
        let seen = place.turned().inverse() * scene.state().attitude;
        // A half turn about an axis of the body is another equilibrium: the nearest one counts.
        let near = |turn: &UnitQuaternion<f64>| (seen * turn).w.abs();
        let halves = [0, 1, 2].map(|axis| body * about(axis, PI));
        let body = halves.into_iter().fold(body, |best, next| if near(&next) > near(&best) { next } else { best });
        let state = variables(&shape, seen * body, body.inverse() * scene.state().angular_velocity / n);
        if let Some(angle) = [state[0], state[2], state[4]].into_iter().find(|angle| angle.abs() > LARGEST_ANGLE) {
            let degrees = angle.abs().to_degrees();
            return Err(format!("the body is {degrees:.0} degrees from the resonance {}", in_words(shape.twice)));
        }
        let [_, pericentre_rate] = orbit.rates();
        let rate = DoubleDouble::from(n) * resonance.into() + pericentre_rate.into();
        let half = DoubleDouble::from(0.5);
        let fixed = orbit.is_fixed();
        let (half_node, plane) = match fixed {
            true => (None, tilt * about(2, argument)),
            false => (
                Some(Phase { frequency: node.frequency * half, ..node }.starting_at(longitude / 2.0)),
                about(0, orbit.elements()[3] + shape.precession.obliquity),
            ),
        };
        Ok(Self {
            shape,
            mean_motion: n,
            start: [start, alpha],
            phases: [anomaly, Phase::new(rate, alpha)],
            half_turn: Phase::new(rate * half, if fixed { turn } else { alpha } / 2.0),
            plane,
            half_node,
            body,
            turned: place.turned(),
            state,
            others: 0.0,
        })
    }
}

/// Where the frame of a resonance is at a time.
#[derive(Clone, Copy)]
struct FramePlace {
    /// M, the longitude of the node and the argument of pericentre \[rad\].
    start: f64,
    longitude: f64,
    argument: f64,
    /// r M + ψ₀, and α with the argument.
    turn: f64,
    alpha: f64,
    /// To inertial components from those with axis 1 along the node and axis 3 along that of the frame.
    tilt: UnitQuaternion<f64>,
}

impl FramePlace {
    fn new(orbit: &Orbit, epoch: f64, shape: &LockedShape) -> Self {
        let [node, argument] = orbit.node_and_argument(epoch);
        let [start, longitude, argument] =
            [&orbit.mean_anomaly(epoch), &node, &argument].map(|phase| phase.angle((0.0, 0.0)));
        let across = if shape.is_across() { FRAC_PI_2 } else { 0.0 };
        let turn = f64::from(shape.twice) / 2.0 * start + across;
        let tilt = about(2, longitude) * about(0, orbit.elements()[3] + shape.precession.obliquity);
        Self { start, longitude, argument, turn, alpha: argument + turn, tilt }
    }

    /// From the frame to inertial components.
    fn turned(&self) -> UnitQuaternion<f64> {
        self.tilt * about(2, self.alpha)
    }
}

/// The rotation from the sorted axes of a body to its own, and the moments A, B, C in units of C.
fn axes_of(body: &Body) -> Result<(UnitQuaternion<f64>, [f64; 3]), String> {
    let (turn, [a, b, c]) = sorted(body.moments());
    if a == b {
        return Err("A = B: no torque turns the body about its orbit's normal".to_owned());
    }
    Ok((turn, [a / c, b / c, 1.0]))
}

/// The equations of a resonance on an orbit whose plane stands still.
fn shape_of(orbit: &Orbit, moments: [f64; 3], twice: i32) -> Result<LockedShape, String> {
    let precession = PlaneMotion { phase_rate: 0.0, spin: 0.0, sideways: 0.0, obliquity: 0.0, argument: None };
    let (eccentricity, attraction) = (orbit.eccentricity(), orbit.disturbing_fraction());
    if orbit.is_hyperbola() {
        return Err("a hyperbola has no period".to_owned());
    }
    let [_, resonant, _] = hansen(eccentricity, twice.unsigned_abs() as usize);
    if resonant.abs() < NO_TORQUE {
        return Err(format!("the resonance {} has no torque on this orbit", in_words(twice)));
    }
    Ok(LockedShape { moments, eccentricity, attraction, twice, resonant, precession })
}

/// Rotations an orbit about an axis of the body, in the frame that turns with the pericentre.
fn spin(scene: &Scene, orbit: &Orbit, axis: Vector3<f64>) -> f64 {
    let (state, n) = (scene.state(), orbit.mean_motion());
    let [node_rate, pericentre_rate] = orbit.rates();
    let normal = (state.attitude.inverse() * orbit.axes_at(state.epoch)[2]).dot(&state.angular_velocity);
    let spin = state.angular_velocity.dot(&axis).abs().copysign(normal);
    (spin - pericentre_rate - node_rate * orbit.elements()[3].cos()) / n
}

/// The orbit with the largest mean torque, and the largest attraction over the cube of the distance of the other bodies.
fn strongest(bodies: &[DisturbingBody]) -> Result<(&Orbit, f64), String> {
    let orbits: Result<Vec<&Orbit>, String> = bodies
        .iter()
        .map(|body| match body {
            DisturbingBody::Orbit(orbit) if orbit.is_hyperbola() => Err("a hyperbola has no period".to_owned()),
            DisturbingBody::Orbit(orbit) => Ok(orbit),
            _ => Err("a table of positions has no mean anomaly".to_owned()),
        })
        .collect();
    let orbits = orbits?;
    let distance = |orbit: &Orbit| (1.0 - orbit.eccentricity(), 1.0 + orbit.eccentricity());
    let mean = |orbit: &Orbit| orbit.strength() / (distance(orbit).0 * distance(orbit).1).powf(1.5);
    let largest = |orbit: &Orbit| orbit.strength() / distance(orbit).0.powi(3);
    let first = orbits.iter().copied().max_by(|a, b| mean(a).total_cmp(&mean(b)));
    let first = first.ok_or("there is no orbit")?;
    let others = orbits.iter().filter(|other| !std::ptr::eq(**other, first)).map(|other| largest(other));
    Ok((first, others.sum()))
}

/// A bound of the angle by which the other bodies move the body over the span: their torque over that of the lock, which also changes frequencies.
fn moved_by_others(scene: &Scene, ratio: f64, n: f64) -> Result<f64, String> {
    let epoch = scene.state().epoch;
    let longest =
        scene.asked_span().map_or(f64::INFINITY, |(start, stop)| (start - epoch).abs().max((stop - epoch).abs()));
    let moved = if ratio == 0.0 { 0.0 } else { ratio * (1.0 + n * longest) };
    if moved > scene.asked_tolerance() / 2.0 {
        let bodies = scene.asked_disturbing().len();
        let span = if longest.is_finite() { "" } else { ", and there is no span" };
        return Err(format!(
            "{bodies} bodies act: the torque of the others is up to {ratio:.1e} of that of the lock{span}"
        ));
    }
    Ok(moved)
}

/// ψ, p_ψ − C W₃, θ, p_θ, φ, p_φ from the attitude in S and the angular velocity about the sorted axes.
fn variables(shape: &LockedShape, seen: UnitQuaternion<f64>, rates: Vector3<f64>) -> [f64; 6] {
    let (phi, theta, psi) = seen.euler_angles();
    let momentum = Vector3::from(shape.moments).component_mul(&rates);
    let ((sin_theta, cos_theta), (sin_phi, cos_phi)) = (theta.sin_cos(), phi.sin_cos());
    let across_phi = sin_phi * momentum.y + cos_phi * momentum.z;
    let p_psi = cos_theta * across_phi - sin_theta * momentum.x - shape.precession.spin;
    [psi, p_psi, theta, cos_phi * momentum.y - sin_phi * momentum.z, phi, momentum.x]
}

/// What node and pericentre add to the equations: axis 3 of S is that of the nearest stable Cassini state, or the normal of an orbit whose node stands still.
fn precession_of(
    scene: &Scene,
    orbit: &Orbit,
    shape: &LockedShape,
    body: UnitQuaternion<f64>,
) -> Result<PlaneMotion, String> {
    let (n, resonance, inclination) = (orbit.mean_motion(), f64::from(shape.twice) / 2.0, orbit.elements()[3]);
    let [node_rate, pericentre_rate] = orbit.rates();
    let phase_rate = resonance + pericentre_rate / n;
    let fast = n * phase_rate + node_rate * inclination.cos();
    let [node, argument] = orbit.node_and_argument(scene.state().epoch).map(|phase| phase.angle((0.0, 0.0)));
    // Towards the angular velocity: retrograde states are other ones.
    let axis = body * Vector3::z();
    let pole =
        about(2, node).inverse() * scene.state().attitude * axis * scene.state().angular_velocity.dot(&axis).signum();
    let near = |state: &CassiniState| (about(0, inclination + state.obliquity) * Vector3::z()).dot(&pole);
    let states = if inclination.sin() == 0.0 || node_rate == 0.0 {
        Vec::new()
    } else {
        cassini_states(scene.body(), orbit, fast).map_err(|error| format!("it has no Cassini state: {error}"))?
    };
    let states = states.into_iter().filter(|state| state.stable);
    let obliquity = states.max_by(|a, b| near(a).total_cmp(&near(b))).map_or(0.0, |state| state.obliquity);
    let (sine, cosine) =
        if inclination.sin() == 0.0 { (0.0, inclination.cos()) } else { (inclination + obliquity).sin_cos() };
    let across = if shape.is_across() { FRAC_PI_2 } else { 0.0 };
    Ok(PlaneMotion {
        phase_rate,
        spin: phase_rate + node_rate / n * cosine,
        sideways: node_rate / n * sine,
        obliquity,
        argument: (node_rate != 0.0 && pericentre_rate == 0.0).then_some(argument + across),
    })
}

/// The rotation by an angle about an axis.
fn about(axis: usize, angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&[Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()][axis], angle)
}

/// The rotation from the axes of sorted moments to the body's, and the sorted moments.
fn sorted(moments: [f64; 3]) -> (UnitQuaternion<f64>, [f64; 3]) {
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
    let mut matrix = Matrix3::zeros();
    for (column, &row) in order.iter().enumerate() {
        matrix[(row, column)] = 1.0;
    }
    if matrix.determinant() < 0.0 {
        matrix.set_column(2, &-matrix.column(2));
    }
    (UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix)), order.map(|axis| moments[axis]))
}
