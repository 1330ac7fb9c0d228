//! A scene from the periods of a tumbler (theory §7), as light curves and radar observations give them.
//!
//! In each mode P_ψ/P_φ is a function of sin²J alone. It grows from its value on the axis to infinity on the separatrix, so bisection in ln(sin²J/cos²J) finds
//! its root. The magnitude of the angular momentum then follows from either period. Frequencies come from the quadrature in double-double.
//!
//! The components of a state have rounding errors of 1e-16. With f = (cos²J₁ − cos²J₀)/sin²J₁, for J₀ at ℓ = 0 and J₁ at ℓ = π/2, these change cos²J₀, on which
//! the periods depend, by up to 2e-16 (cos J₁ + √f √(cos²J₁ − cos²J₀)). Motions are refused if this is more than 2e-6 of cos²J₀, because a state in doubles
//! does not hold their periods to 1e-5.

use std::f64::consts::TAU;

use andoyer_double::DoubleDouble;
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::scene_about_principal_axes;
use crate::error::Error;
use crate::input::body::Body;
use crate::input::options::Convention;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::torque_free::frequencies::Secular;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::Polhode;

/// Interval of ln(sin²J/cos²J) at ℓ = 0 in which roots are searched: from J = 1e-17 rad to cos²J = 1e-290.
const RANGE: [f64; 2] = [-78.0, 667.0];
/// Largest relative change of cos²J at ℓ = 0, over that of a component of the state, for which the state holds the periods to 1e-5.
const LARGEST_GAIN: f64 = 1e10;
/// A quarter turn in single precision, which exceeds it by 4e-8 rad: a pole that is given in single precision is a pole.
const HIGHEST_LATITUDE: f64 = std::f32::consts::FRAC_PI_2 as f64;
/// A ratio this near to that on the axis counts as equal to it.
const RATIO_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Every mode with its two different conventions; the extremal axis is the axis of the mode.
const FAMILIES: [(Mode, Convention); 4] = [
    (Mode::ShortAxis, Convention::ExtremalAxis),
    (Mode::ShortAxis, Convention::LongAxis),
    (Mode::LongAxis, Convention::ExtremalAxis),
    (Mode::LongAxis, Convention::ShortAxis),
];

/// The periods of a tumbler, as published.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObservedPeriods {
    /// P_φ, the period of the precession of an axis about the angular momentum [unit of time].
    pub precession: f64,
    /// P_ψ, the period of the rotation about this axis or of its oscillation [unit of time].
    pub rotation: f64,
    /// [`Mode::ShortAxis`] or [`Mode::LongAxis`].
    pub mode: Mode,
    /// The axis that the periods describe.
    pub convention: Convention,
    /// Direction of the angular momentum in inertial components; its length is arbitrary.
    pub momentum_direction: Vector3<f64>,
    /// Elapsed fractions of P_ψ and P_φ at the epoch \[turns\]. At \[0, 0\] the axis around which the angular momentum circles is nearest to the angular
    /// momentum, and is tilted towards z × momentum (towards x if the momentum is along z).
    pub phases: [f64; 2],
    /// 1 if the angular momentum circles the positive axis of the mode, −1 if it circles the negative one. `None` means 1, or with an attitude the nearer one.
    /// The two motions differ by half a turn of the body about its intermediate axis.
    pub sense: Option<f64>,
    /// An attitude, body to inertial, near which the state is. The state is the nearest one to it of all with these periods and this momentum direction;
    /// phases must be 0 then.
    pub attitude: Option<UnitQuaternion<f64>>,
    /// Time of the state.
    pub epoch: f64,
}

impl ObservedPeriods {
    /// Periods of the short-axis mode in the extremal-axis convention, with the angular momentum along z, and with phases and epoch 0.
    pub fn new(precession: f64, rotation: f64) -> Self {
        Self {
            precession,
            rotation,
            mode: Mode::ShortAxis,
            convention: Convention::default(),
            momentum_direction: Vector3::z(),
            phases: [0.0; 2],
            sense: None,
            attitude: None,
            epoch: 0.0,
        }
    }

    /// Sets the direction of the angular momentum by longitude and latitude \[rad\].
    ///
    /// # Errors
    /// - [`Error::Latitude`] for a latitude beyond ±π/2, such as −85, which is probably in degrees.
    ///
    /// ```
    /// use andoyer_propagate::periods::ObservedPeriods;
    /// assert!(ObservedPeriods::new(27.38, 263.0).towards(4.8, -1.48).is_ok());
    /// assert!(ObservedPeriods::new(27.38, 263.0).towards(275.0, -85.0).is_err());
    /// ```
    pub fn towards(self, longitude: f64, latitude: f64) -> Result<Self, Error> {
        if latitude.abs() > HIGHEST_LATITUDE {
            return Err(Error::Latitude { value: [longitude, latitude] });
        }
        let (sine, cosine) = latitude.sin_cos();
        let direction = Vector3::new(cosine * longitude.cos(), cosine * longitude.sin(), sine);
        Ok(Self { momentum_direction: direction, ..self })
    }

    /// The phases that exceed a whole turn, with their indices \[turns\]. They are accepted, but they are often degrees given by mistake.
    ///
    /// ```
    /// use andoyer_propagate::periods::ObservedPeriods;
    /// let periods = ObservedPeriods { phases: [14.0, 0.5], ..ObservedPeriods::new(27.38, 263.0) };
    /// assert_eq!(periods.beyond_a_turn().collect::<Vec<_>>(), [(0, 14.0)]);
    /// ```
    pub fn beyond_a_turn(&self) -> impl Iterator<Item = (usize, f64)> {
        self.phases.into_iter().enumerate().filter(|(_, phase)| phase.abs() > 1.0)
    }
}

impl Body {
    /// The smallest and the largest P_ψ/P_φ of a mode. The smallest is that of rotation about the axis. The ratio grows to infinity on the separatrix; the
    /// largest is that of the motion nearest to it whose periods a state in doubles holds to 1e-5. Every ratio between them belongs to one motion.
    ///
    /// # Errors
    /// - [`Error::ModeName`] for a mode other than the short-axis mode and the long-axis mode.
    /// - [`Error::NoSuchMode`] for the short-axis mode of a body with B = C, and for the long-axis mode of a body with A = B.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Mode};
    /// use andoyer_propagate::options::Convention;
    /// let body = Body::new([1.0, 1.5, 2.0])?;
    /// let [lower, _] = body.period_ratios(Mode::ShortAxis, Convention::ExtremalAxis)?;
    /// // 1 + 1/γ, γ² = (C/A − 1)(C/B − 1) = 1/3.
    /// assert!((lower - (1.0 + 3.0_f64.sqrt())).abs() < 1e-15);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn period_ratios(&self, mode: Mode, convention: Convention) -> Result<[f64; 2], Error> {
        let family = Family::new(self, mode, convention)?;
        Ok([family.lowest(), family.ratio(family.highest())])
    }
}

impl Scene {
    /// Creates the scene of a body that tumbles with these periods without torque. For each mode, sense and pair of phases there is exactly one.
    ///
    /// # Errors
    /// - [`Error::Sense`] for a sense other than 1 and −1; [`Error::PhasesAndAttitude`] for phases beside an attitude.
    /// - [`Error::Positive`] for a period that is zero, negative or not finite.
    /// - [`Error::PeriodRatio`] for periods that the body cannot have, with the interval of possible ratios; [`Error::ModeName`], [`Error::NoSuchMode`] as for
    ///   [`Body::period_ratios`].
    /// - [`Error::Direction`] for a direction of length 0, or for phases that are not finite; [`Error::Epoch`] for an epoch that is not finite.
    /// - [`Error::Units`] for periods whose angular momentum overflows or underflows.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Scene};
    /// use andoyer_propagate::periods::ObservedPeriods;
    /// // Apophis, in hours (Pravec et al. 2014): E/E0 = 1.024 ± 0.013.
    /// let motion = Scene::from_periods(Body::new([0.61, 0.965, 1.0])?, &ObservedPeriods::new(27.38, 263.0))?.solve()?;
    /// assert!((motion.energy_ratio() - 1.02364).abs() < 5e-6);
    /// assert!((motion.long_axis_periods().precession - 30.56).abs() < 0.005);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn from_periods(body: Body, periods: &ObservedPeriods) -> Result<Self, Error> {
        periods.validate()?;
        let family = Family::new(&body, periods.mode, periods.convention)?;
        family.admits(periods.rotation / periods.precession, &body)?;
        let principal = body.about_principal_axes();
        let (attitude, rates) = match periods.attitude {
            Some(attitude) => {
                let turn = body.turn().unwrap_or_else(UnitQuaternion::identity);
                family.nearest(periods, attitude * turn)
            }
            None => family.phased(periods, principal)?,
        };
        Ok(scene_about_principal_axes(body, periods.epoch, attitude, rates))
    }
}

impl ObservedPeriods {
    fn validate(&self) -> Result<(), Error> {
        for (argument, value) in [("precession", self.precession), ("rotation", self.rotation)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::Positive { argument, value });
            }
        }
        let direction = self.momentum_direction;
        if !(direction.iter().all(|x| x.is_finite()) && direction.amax() > 0.0) {
            return Err(Error::Direction { argument: "momentum_direction", value: direction.as_slice().to_vec() });
        }
        if self.phases.iter().any(|phase| !phase.is_finite()) {
            return Err(Error::Direction { argument: "phases", value: self.phases.to_vec() });
        }
        if let Some(value) = self.sense.filter(|sense| sense.abs() != 1.0) {
            return Err(Error::Sense { value });
        }
        if self.attitude.is_some() && self.phases != [0.0; 2] {
            return Err(Error::PhasesAndAttitude { value: self.phases });
        }
        if !self.epoch.is_finite() {
            return Err(Error::Epoch { value: self.epoch });
        }
        Ok(())
    }
}

/// The unit vector of a vector other than 0. The vector is scaled first, since squares of large components are infinite and of small ones 0.
pub(super) fn unit(vector: Vector3<f64>) -> Vector3<f64> {
    (vector / vector.amax()).normalize()
}

/// The end of the part of an interval in which a condition holds that holds at its start.
pub(super) fn bisected([mut low, mut high]: [f64; 2], holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return low;
        }
        if holds(middle) { low = middle } else { high = middle }
    }
}

/// The motions of a body in one mode, with M = 1 and scaled moments.
pub(super) struct Family {
    /// Rotation about the axis of the mode.
    pub(super) axial: Polhode,
    mode: Mode,
    convention: Convention,
    /// Whether the periods are those of the axis around which the angular momentum circles.
    own: bool,
}

impl Family {
    fn new(body: &Body, mode: Mode, convention: Convention) -> Result<Self, Error> {
        let (axis, pair) = match mode {
            Mode::ShortAxis => (2, "two largest"),
            Mode::LongAxis => (0, "two smallest"),
            _ => return Err(Error::ModeName { value: mode.to_string() }),
        };
        let moments = body.moments();
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
        let mut rates = Vector3::zeros();
        rates[order[axis]] = 1.0;
        let state = State { epoch: 0.0, attitude: UnitQuaternion::identity(), angular_velocity: rates };
        let none = || Error::NoSuchMode { mode: mode.to_string(), moments, pair };
        if moments[order[1]] == moments[order[axis]] {
            return Err(none());
        }
        let axial = Polhode::new(&body.about_principal_axes(), &state).ok_or_else(none)?;
        let own = match convention {
            Convention::ExtremalAxis => true,
            Convention::LongAxis => mode == Mode::LongAxis,
            Convention::ShortAxis => mode == Mode::ShortAxis,
        };
        Ok(Self { axial, mode, convention, own })
    }

    /// The polhode with M = 1 and this ln(sin²J/cos²J) at ℓ = 0.
    fn polhode(&self, logarithm: f64) -> Polhode {
        // The smaller of the two squares is computed directly, the larger as 1 minus it.
        let smaller = DoubleDouble::from(1.0 / (1.0 + logarithm.abs().exp()));
        let larger = DoubleDouble::ONE - smaller;
        let squares = if logarithm < 0.0 { [smaller, larger] } else { [larger, smaller] };
        self.axial.with_squares(squares, 1.0)
    }

    /// Rates of precession and rotation for M = 1.
    fn rates(&self, polhode: &Polhode) -> [DoubleDouble; 2] {
        let Secular { anomaly_rate, longitude_rate, .. } = Secular::exact(polhode);
        let precession = if self.own { longitude_rate + anomaly_rate } else { longitude_rate };
        [precession, if anomaly_rate.to_f64() < 0.0 { -anomaly_rate } else { anomaly_rate }]
    }

    fn ratio(&self, logarithm: f64) -> f64 {
        let [precession, rotation] = self.rates(&self.polhode(logarithm));
        (precession / rotation).to_f64()
    }

    /// The ratio on the axis, where dℓ′/dt = γ M/C and dy′/dt = M/C.
    fn lowest(&self) -> f64 {
        let gamma = self.axial.invariants.gamma;
        let own = if self.own { DoubleDouble::ONE + gamma } else { DoubleDouble::ONE };
        (own / gamma).to_f64().abs()
    }

    /// Whether the ratio is between the lowest and the highest, which are returned too.
    fn reaches(&self, ratio: f64) -> (bool, [f64; 2]) {
        let (lower, upper) = (self.lowest(), self.ratio(self.highest()));
        // This condition is false for NaN.
        (ratio >= lower * (1.0 - RATIO_ROUNDING) && ratio <= upper, [lower, upper])
    }

    /// Refuses a ratio that the body cannot have in this mode and convention, and names those in which it can.
    fn admits(&self, ratio: f64, body: &Body) -> Result<(), Error> {
        let (reached, [lower, upper]) = self.reaches(ratio);
        if reached {
            return Ok(());
        }
        let fitting = |ratio: f64| {
            let fits = |&(mode, convention): &(Mode, Convention)| {
                Family::new(body, mode, convention).is_ok_and(|family| family.reaches(ratio).0)
            };
            FAMILIES
                .into_iter()
                .filter(fits)
                .map(|(mode, convention)| [mode.to_string(), convention.to_string()])
                .collect::<Vec<_>>()
        };
        let possible = fitting(ratio);
        let swapped = if possible.is_empty() { fitting(1.0 / ratio) } else { Vec::new() };
        let (mode, convention) = (self.mode.to_string(), self.convention.to_string());
        Err(Error::PeriodRatio { ratio, mode, convention, lower, upper, possible, swapped })
    }

    /// The polhode with M = 1 and this ratio of periods.
    fn with_ratio(&self, ratio: f64) -> Polhode {
        if ratio <= self.lowest() * (1.0 + RATIO_ROUNDING) {
            return self.axial.with_squares([DoubleDouble::ZERO, DoubleDouble::ONE], 1.0);
        }
        self.polhode(bisected([RANGE[0], self.highest()], |logarithm| self.ratio(logarithm) < ratio))
    }

    /// The largest ln(sin²J/cos²J) at ℓ = 0 for which the state holds the periods.
    fn highest(&self) -> f64 {
        let holds = |logarithm: f64| {
            let invariants = self.polhode(logarithm).invariants;
            let [least, most] = invariants.cosine_squares.map(|square| square.to_f64());
            let sine = invariants.sine_squares[1].to_f64().sqrt();
            most.sqrt() + (most - least) / sine <= LARGEST_GAIN * least
        };
        if holds(RANGE[1]) { RANGE[1] } else { bisected(RANGE, holds) }
    }

    /// Attitude and angular velocity, about principal axes, at the phases and in the sense of the periods.
    fn phased(&self, periods: &ObservedPeriods, body: Body) -> Result<(UnitQuaternion<f64>, Vector3<f64>), Error> {
        let part = periods.phases[0].rem_euclid(1.0);
        let passed = Scene::new(body, self.state(periods)).solve()?.at(part * periods.rotation)?;
        // The precession during the phase along the polhode is subtracted.
        let turns = periods.phases[1] - part * periods.rotation / periods.precession;
        let axis = nalgebra::Unit::new_unchecked(unit(periods.momentum_direction));
        let turned = UnitQuaternion::from_axis_angle(&axis, TAU * (turns - turns.round()));
        let (attitude, rates) = (turned * passed.attitude, passed.angular_velocity);
        if periods.sense != Some(-1.0) {
            return Ok((attitude, rates));
        }
        // Half a turn of the body about its intermediate axis, which reverses the other two.
        let middle = self.axial.frame.axes[1];
        let half = UnitQuaternion::new_unchecked(Quaternion::from_parts(0.0, Vector3::ith(middle, 1.0)));
        let reversed = Vector3::from_fn(|axis, _| if axis == middle { rates[axis] } else { -rates[axis] });
        Ok((attitude * half, reversed))
    }

    /// The polhode with M = 1 of these periods, and the angular momentum in the scaled units.
    pub(super) fn motion(&self, periods: &ObservedPeriods) -> (Polhode, f64) {
        let polhode = self.with_ratio(periods.rotation / periods.precession);
        let [precession, _] = self.rates(&polhode);
        let momentum = TAU / (precession.to_f64() * periods.precession);
        (polhode, momentum)
    }

    /// The angular velocity of an angular momentum on sorted axes.
    pub(super) fn angular_velocity(&self, polhode: &Polhode, momentum: [f64; 3]) -> Vector3<f64> {
        self.axial.frame.user(std::array::from_fn(|i| momentum[i] / polhode.moments[i])).into()
    }

    /// The state at time 0 with phases 0: ℓ = π/2, where cos J has its maximum.
    fn state(&self, periods: &ObservedPeriods) -> State {
        let (polhode, momentum) = self.motion(periods);
        let [_, sine] = polhode.invariants.sine_squares.map(|square| square.to_f64().sqrt());
        let [_, cosine] = polhode.invariants.cosine_squares.map(|square| square.to_f64().sqrt());
        let direction = [-sine, 0.0, cosine];
        let angular_velocity = self.angular_velocity(&polhode, direction.map(|x| momentum * x));
        let pole = unit(periods.momentum_direction);
        let node = Vector3::z().cross(&pole);
        let node = if node.amax() == 0.0 { Vector3::x() } else { unit(node) };
        let columns = [pole * -sine + node * cosine, pole.cross(&node), pole * cosine + node * sine];
        let sorted = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&columns));
        let attitude = UnitQuaternion::from_rotation_matrix(&sorted) * self.axial.frame.quaternion;
        State { epoch: 0.0, attitude, angular_velocity }
    }
}
