//! Attitude and rates against the orbital frame.
//!
//! The frame turns with the line between the rotating body and its primary or disturbing body. With the radial direction R̂ outward from the primary, the normal N̂ of the orbit's
//! plane and the transverse direction T̂ = N̂ × R̂ its axes are
//!
//! - "rtn": R̂, T̂, N̂;
//! - "lvlh": T̂, −N̂, −R̂: forward on a circle, against the normal, to the primary.
//!
//! An orbit of this crate is that of the disturbing body relative to the rotating one, or a satellite's own about its primary. The gravity gradient is the same for both, but R̂ is
//! opposite: [`ElementsOf`] says which it is.
//!
//! For elements, N̂ is the normal of their plane and the frame turns with (f′ + ω′) N̂ + Ω′ ẑ, f′ = n √|1 − e²| (a/r)². For a table, N̂ is along h = r × v and the frame turns with
//! (h/r²) N̂ + (r a·N̂/h) r̂, with the velocity and the acceleration of the table's polynomials. Euler angles: Bernardes and Viollet, PLoS ONE 17 (2022) e0276302.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::str::FromStr;

use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

use crate::error::Error;
use crate::input::body::Body;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::motion::batch::Batch;
use crate::motion::solved::Motion;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;

/// Whose orbit the elements or the table describe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementsOf {
    /// The rotating body about its primary: a satellite's own elements.
    Rotating,
    /// The disturbing body as seen from the rotating one: the Sun from an asteroid.
    Disturbing,
}

/// The axes of the orbital frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OrbitalAxes {
    /// Radial, transverse, normal.
    #[default]
    Rtn,
    /// Forward, against the normal, to the primary.
    Lvlh,
}

/// Which orbital frame: of which of the bodies, whose elements they are, the axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OrbitalFrame {
    /// Whose orbit it is.
    pub elements_of: ElementsOf,
    /// The axes.
    pub axes: OrbitalAxes,
    /// Index of the disturbing body.
    pub of: usize,
}

/// Attitude and angular velocity against the orbital frame at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitalSample {
    /// Rotation of body components into components of the orbital frame.
    pub attitude: UnitQuaternion<f64>,
    /// Angular velocity relative to the turning frame, in body components.
    pub angular_velocity: Vector3<f64>,
}

impl OrbitalSample {
    /// NaN, for a time at which there is no motion.
    pub const NAN: Self = Self {
        attitude: Unit::new_unchecked(Quaternion::new(f64::NAN, f64::NAN, f64::NAN, f64::NAN)),
        angular_velocity: Vector3::new(f64::NAN, f64::NAN, f64::NAN),
    };
}

/// A sequence of three rotations about body axes, each about the axes as turned by the rotations before (intrinsic): "ZYX" is yaw, pitch, roll.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EulerSequence([usize; 3]);

fn refused(argument: &'static str, value: impl ToString, bound: impl Into<String>) -> Error {
    Error::OrbitalFrame { argument, value: value.to_string(), bound: bound.into() }
}

impl FromStr for ElementsOf {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "rotating" => Ok(Self::Rotating),
            "disturbing" => Ok(Self::Disturbing),
            _ => Err(refused("elements_of", format!("{text:?}"), "\"rotating\" or \"disturbing\"")),
        }
    }
}

impl FromStr for OrbitalAxes {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        match text.to_ascii_lowercase().as_str() {
            "rtn" => Ok(Self::Rtn),
            "lvlh" => Ok(Self::Lvlh),
            _ => Err(refused("frame", format!("{text:?}"), "\"rtn\" or \"lvlh\"")),
        }
    }
}

impl FromStr for EulerSequence {
    type Err = Error;

    /// # Errors
    /// [`Error::OrbitalFrame`] for a text that is not three of X, Y, Z with neighbours that differ.
    fn from_str(text: &str) -> Result<Self, Error> {
        let axes: Option<Vec<usize>> = text.chars().map(|letter| "XYZ".find(letter)).collect();
        match axes.as_deref() {
            Some(&[first, second, third]) if first != second && second != third => Ok(Self([first, second, third])),
            _ => Err(refused(
                "sequence",
                format!("{text:?}"),
                "three of X, Y and Z, neighbours different, such as \"ZYX\"",
            )),
        }
    }
}

impl EulerSequence {
    /// The attitude with these angles \[rad\].
    ///
    /// ```
    /// use andoyer_propagate::orbital::EulerSequence;
    /// let sequence: EulerSequence = "ZYX".parse()?;
    /// let angles = sequence.angles(&sequence.attitude([0.1, -0.2, 0.3]));
    /// assert!(angles.iter().zip([0.1, -0.2, 0.3]).all(|(found, given)| (found - given).abs() < 1e-15));
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn attitude(&self, angles: [f64; 3]) -> UnitQuaternion<f64> {
        let axes = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
        let [one, two, three] =
            [0, 1, 2].map(|place| UnitQuaternion::from_axis_angle(&axes[self.0[place]], angles[place]));
        one * two * three
    }

    /// The angles of an attitude \[rad\]: the first and the third in (−π, π], the second in \[−π/2, π/2\], or in \[0, π\] if the first and the third axis are the same. Where only
    /// their sum or difference is determined, the third is 0.
    pub fn angles(&self, attitude: &UnitQuaternion<f64>) -> [f64; 3] {
        let [first, second, third] = self.0;
        let [i, j, k] = [third, second, if third == first { 3 - first - second } else { first }];
        let proper = third == first;
        let sign = if (i + 1) % 3 == j { 1.0 } else { -1.0 };
        let q = attitude.coords;
        let [a, b, c, d] = match proper {
            true => [q.w, q[i], q[j], q[k] * sign],
            false => [q.w - q[j], q[i] + q[k] * sign, q[j] + q.w, q[k] * sign - q[i]],
        };
        let (even, odd) = (a.hypot(b), c.hypot(d));
        let middle = 2.0 * odd.atan2(even);
        let (sum, difference) = (b.atan2(a), d.atan2(c));
        let tiny = 1e-15 * (even + odd);
        let [alpha, gamma] = match () {
            () if odd <= tiny => [2.0 * sum, 0.0],
            () if even <= tiny => [2.0 * difference, 0.0],
            () => [sum + difference, sum - difference],
        };
        let [alpha, middle] = if proper { [alpha, middle] } else { [sign * alpha, middle - FRAC_PI_2] };
        let wrapped = |angle: f64| {
            let angle = angle - TAU * (angle / TAU).round();
            if angle <= -PI { angle + TAU } else { angle }
        };
        [wrapped(alpha), middle, wrapped(gamma)]
    }
}

impl OrbitalFrame {
    /// The rotation of components of the frame into inertial ones, and the angular velocity of the frame in inertial components, at a time.
    ///
    /// # Errors
    /// - [`Error::OrbitalFrame`] for an index without a body.
    /// - [`Error::Orbit`] for a time that is NaN or more than 1e15 periods from the pericentre; [`Error::Table`] for one outside the table.
    pub fn at(&self, bodies: &[DisturbingBody], time: f64) -> Result<(UnitQuaternion<f64>, Vector3<f64>), Error> {
        self.after(bodies, time, 0.0)
    }

    /// Rotation and angular velocity of the frame at the time `since` after an epoch. The sum of the two would lose digits.
    fn after(
        &self,
        bodies: &[DisturbingBody],
        epoch: f64,
        since: f64,
    ) -> Result<(UnitQuaternion<f64>, Vector3<f64>), Error> {
        let body = bodies.get(self.of).ok_or_else(|| match bodies.len() {
            0 => refused("orbit", "none", "an orbit or a table of positions: without one there is no orbital frame"),
            count => refused("of", self.of, format!("the index of one of the {count} disturbing bodies, from 0")),
        })?;
        let [position, normal, rate] = match body {
            DisturbingBody::Orbit(orbit) => of_orbit(orbit, epoch, since)?,
            DisturbingBody::Tabulated(table) => {
                let [position, velocity, acceleration] = table.motion(epoch + since)?.map(Vector3::from);
                let momentum = position.cross(&velocity);
                let (size, normal) = (position.norm(), momentum.normalize());
                let turning = position * (acceleration.dot(&normal) / momentum.norm());
                [position, normal, normal * (momentum.norm() / (size * size)) + turning]
            }
        };
        let outward = position.normalize() * if self.elements_of == ElementsOf::Rotating { 1.0 } else { -1.0 };
        let forward = normal.cross(&outward);
        let columns = match self.axes {
            OrbitalAxes::Rtn => [outward, forward, normal],
            OrbitalAxes::Lvlh => [forward, -normal, -outward],
        };
        let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&columns));
        Ok((UnitQuaternion::from_rotation_matrix(&turn), rate))
    }
}

/// Position over |a|, normal of the plane, angular velocity of the frame, by elements.
fn of_orbit(orbit: &Orbit, epoch: f64, since: f64) -> Result<[Vector3<f64>; 3], Error> {
    let position = orbit.relative_position(epoch, since)?;
    let normal = orbit.axes_after(epoch, since)[2];
    let (e, [node_rate, pericentre_rate]) = (orbit.eccentricity(), orbit.rates());
    let turning = orbit.mean_motion() * ((1.0 - e) * (1.0 + e)).abs().sqrt() / position.norm_squared();
    Ok([position, normal, normal * (turning + pericentre_rate) + Vector3::z() * node_rate])
}

#[cfg(feature = "torques")]
impl Scene {
    /// The scene of a state against the orbital frame: `attitude` rotates body components into components of the frame; the angular velocity is in body components, relative to the
    /// turning frame if `relative`, otherwise inertial. The bodies disturb.
    ///
    /// ```
    /// use andoyer_propagate::orbital::{OrbitalAxes, ElementsOf, OrbitalFrame};
    /// use andoyer_propagate::nalgebra::{UnitQuaternion, Vector3};
    /// use andoyer_propagate::{Body, Orbit, Scene};
    /// // A satellite that rests in its orbital frame: the largest moment about the normal, the smallest to the primary.
    /// let (body, orbit) = (Body::new([1.5, 2.0, 1.0])?, Orbit::new(1e-3, 0.0)?);
    /// let frame = OrbitalFrame { elements_of: ElementsOf::Rotating, axes: OrbitalAxes::Lvlh, of: 0 };
    /// let scene = Scene::from_orbital(body, [orbit], &frame, UnitQuaternion::identity(), Vector3::zeros(), true, 0.0)?;
    /// assert!((scene.state().angular_velocity - Vector3::new(0.0, -1e-3, 0.0)).norm() < 1e-18);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - Those of [`OrbitalFrame::at`]; [`Error::Epoch`] and [`Error::AngularVelocity`] for numbers that are not finite.
    pub fn from_orbital(
        body: Body,
        bodies: impl IntoIterator<Item = impl Into<DisturbingBody>>,
        frame: &OrbitalFrame,
        attitude: UnitQuaternion<f64>,
        angular_velocity: Vector3<f64>,
        relative: bool,
        epoch: f64,
    ) -> Result<Self, Error> {
        let bodies: Vec<DisturbingBody> = bodies.into_iter().map(Into::into).collect();
        let scene = Self::against(body, &bodies, frame, attitude, angular_velocity, relative, epoch)?;
        Ok(scene.disturbing(bodies))
    }
}

impl Scene {
    /// The scene of [`Scene::from_orbital`], on which no body acts yet.
    pub(crate) fn against(
        body: Body,
        bodies: &[DisturbingBody],
        frame: &OrbitalFrame,
        attitude: UnitQuaternion<f64>,
        angular_velocity: Vector3<f64>,
        relative: bool,
        epoch: f64,
    ) -> Result<Self, Error> {
        if !epoch.is_finite() {
            return Err(Error::Epoch { value: epoch });
        }
        if let Some(axis) = (0..3).find(|&axis| !angular_velocity[axis].is_finite()) {
            return Err(Error::AngularVelocity { axis, value: angular_velocity[axis] });
        }
        let (turn, rate) = frame.at(bodies, epoch)?;
        let attitude = turn * attitude;
        let angular_velocity = angular_velocity + if relative { attitude.inverse() * rate } else { Vector3::zeros() };
        Ok(Self::new(body, State { epoch, attitude, angular_velocity }))
    }
}

impl Motion {
    /// Attitudes and rates against the orbital frame.
    ///
    /// # Errors
    /// Those of [`Motion::at`] and of [`OrbitalFrame::at`].
    pub fn orbital(&self, times: &[f64], frame: &OrbitalFrame) -> Result<Vec<OrbitalSample>, Error> {
        self.batch().orbital(times, frame)
    }
}

impl Batch<'_> {
    /// Attitudes and rates against the orbital frame.
    ///
    /// # Errors
    /// Those of [`Motion::at`] and of [`OrbitalFrame::at`].
    pub fn orbital(&self, times: &[f64], frame: &OrbitalFrame) -> Result<Vec<OrbitalSample>, Error> {
        let scene = self.motion().scene();
        let (bodies, start) = (scene.asked_disturbing(), scene.state().epoch);
        // The frame must exist for no times too.
        frame.at(bodies, start)?;
        // Times count from the epoch of the scene, or from 0.
        let zero = start - self.epoch();
        let (mut attitudes, mut rates) = (vec![[0.0; 4]; times.len()], vec![[0.0; 3]; times.len()]);
        self.samples_into(times, &mut attitudes, &mut rates)?;
        let against = |((&time, attitude), rate): ((&f64, [f64; 4]), [f64; 3])| {
            let (turn, turning) = frame.after(bodies, zero, time)?;
            let attitude = UnitQuaternion::new_unchecked(attitude.into());
            let angular_velocity = Vector3::from(rate) - attitude.inverse() * turning;
            Ok(OrbitalSample { attitude: turn.inverse() * attitude, angular_velocity })
        };
        times.iter().zip(attitudes).zip(rates).map(against).collect()
    }
}
