//! The way of a freely tumbling body to rotation about its axis of greatest inertia, at constant angular momentum.
//!
//! Time is counted from the passage of the separatrix, so that the long-axis mode has negative times and the short-axis mode positive ones. A body with A = B has
//! only the short-axis mode, and one with B = C only the long-axis mode, in which it ends: its axis 1 is then perpendicular to the angular momentum.

use std::f64::consts::FRAC_PI_2;

use super::body::Dissipation;
use super::harmonics::Swing;
use super::leg::Leg;
use super::material::refused;
use crate::error::Error;
use crate::torque_free::mode::Mode;

/// |dt/dy| falls by this factor, as e^(−40), before it is neglected.
const FALL: f64 = 40.0;
/// |dt/dy| next to the separatrix, relative to that of small angles, that is neglected.
const NEGLIGIBLE: f64 = 1e-14;
/// The largest y: 1 − x = e^(−y) and its square are normal doubles.
const FARTHEST: f64 = 320.0;

/// A relaxation, from [`Dissipation::relax`]. Its times are counted from the state of the scene; negative ones are in the past.
#[derive(Clone, Debug)]
pub struct Relaxation {
    dissipation: Dissipation,
    mean_rate: f64,
    long: Option<Leg>,
    short: Option<Leg>,
    /// The time of the state, from the passage of the separatrix.
    now: f64,
}

/// What is known of a relaxing body at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxedState {
    /// The time after the state of the scene.
    pub time: f64,
    /// [`Mode::ShortAxis`] or [`Mode::LongAxis`].
    pub mode: Mode,
    /// The largest angle between the angular momentum and the axis of the mode on the polhode \[rad\].
    pub angle: f64,
    /// E/E0, the rotational energy over that of rotation about the axis of greatest inertia with the same angular momentum.
    pub energy_ratio: f64,
    /// The loss of energy in the unit of time.
    pub power: f64,
}

impl Relaxation {
    pub(super) fn new(dissipation: Dissipation, mean_rate: f64, state: (bool, f64)) -> Result<Self, Error> {
        let leg = |long_axis: bool| -> Result<Option<Leg>, Error> {
            let axes = dissipation.axes(long_axis);
            if axes.range == 0.0 {
                return Ok(None);
            }
            let slope = |y: f64| dissipation.slope(&axes, Swing::new(long_axis, y), mean_rate);
            // The integrand falls as e^(−y/2) up to y = −ln d and as e^(−y) from there; slower if d = 0 and the loss falls with the frequency.
            let mut top = FALL + (-axes.spread.ln()).clamp(0.0, FALL);
            let negligible = NEGLIGIBLE * slope(-FALL)?;
            while top < FARTHEST && slope(top)? > negligible {
                top = (2.0 * top).min(FARTHEST);
            }
            Leg::new(top, slope(top)? > negligible, &slope).map(Some)
        };
        let (long, short) = (leg(true)?, leg(false)?);
        let mut relaxation = Self { dissipation, mean_rate, long, short, now: 0.0 };
        relaxation.now = relaxation.time_of(state.0, state.1)?;
        Ok(relaxation)
    }

    /// The time of a place from the separatrix.
    fn time_of(&self, long_axis: bool, y: f64) -> Result<f64, Error> {
        let (leg, mode, pair, sign) = if long_axis {
            (&self.long, Mode::LongAxis, "two smallest", -1.0)
        } else {
            (&self.short, Mode::ShortAxis, "two largest", 1.0)
        };
        let none = || Error::NoSuchMode { mode: mode.to_string(), moments: self.dissipation.moments(), pair };
        let leg = leg.as_ref().ok_or_else(none)?;
        if leg.is_open() && y > FARTHEST {
            let bound = "below π/2: the loss of the material falls with the frequency, and the way from the separatrix takes an infinite time";
            return Err(refused("angle", FRAC_PI_2, bound));
        }
        Ok(sign * leg.time(y))
    }

    /// The time after the state at which the largest angle between the angular momentum and the axis of a mode is `angle`; negative if it was before.
    ///
    /// An angle of π/2 is the separatrix. The time to an angle of 0 would be infinite: the last part is exponential. So is the time from the separatrix if two moments are equal
    /// and the loss of the material vanishes with the frequency, at least as fast: the frequency goes to 0 there.
    ///
    /// # Errors
    /// - [`Error::Dissipation`] for an angle that is not above 0 and at most π/2, and for π/2 where the time is infinite.
    /// - [`Error::ModeName`] for another mode than the long-axis and the short-axis mode, [`Error::NoSuchMode`] for one that the body does not have.
    pub fn time_to(&self, angle: f64, mode: Mode) -> Result<f64, Error> {
        Ok(self.time_of(long_axis(mode)?, logit("angle", angle)?)? - self.now)
    }

    /// The state at a time after that of the scene; negative times are in the past.
    ///
    /// # Errors
    /// [`Error::Dissipation`] for a time that is not finite, and for a time before the body was on its separatrix if A = B: there is no mode before it.
    pub fn at(&self, time: f64) -> Result<RelaxedState, Error> {
        if !time.is_finite() {
            return Err(refused("times", time, "finite"));
        }
        let passed = self.now + time;
        let (long_axis, y) = match (passed < 0.0, &self.long, &self.short) {
            (true, Some(leg), _) => (true, leg.place(-passed)),
            (false, _, Some(leg)) => (false, leg.place(passed)),
            (false, _, None) => (true, f64::INFINITY),
            (true, None, _) => {
                let then = if self.short.as_ref().is_some_and(Leg::is_open) { "next to" } else { "about" };
                let bound =
                    format!("at least {:.6e}, when the body rotated {then} an axis of least inertia", -self.now);
                return Err(refused("times", time, &bound));
            }
        };
        let swing = Swing::new(long_axis, y);
        Ok(RelaxedState {
            time,
            mode: if long_axis { Mode::LongAxis } else { Mode::ShortAxis },
            // tan² of the angle is x/(1 − x) = e^y
            angle: (0.5 * y).exp().atan(),
            energy_ratio: self.dissipation.axes(long_axis).energy_ratio(swing.x),
            power: self.dissipation.power_at(swing, self.mean_rate)?,
        })
    }
}

/// Whether a mode is the long-axis mode.
pub(super) fn long_axis(mode: Mode) -> Result<bool, Error> {
    match mode {
        Mode::LongAxis => Ok(true),
        Mode::ShortAxis => Ok(false),
        _ => Err(Error::ModeName { value: mode.to_string() }),
    }
}

/// y = ln(x/(1 − x)) = 2 ln tan θ of a largest angle θ.
fn logit(argument: &'static str, angle: f64) -> Result<f64, Error> {
    if angle == FRAC_PI_2 {
        return Ok(f64::INFINITY);
    }
    if angle > 0.0 && angle < FRAC_PI_2 {
        return Ok(2.0 * angle.tan().ln());
    }
    Err(refused(argument, angle, "above 0 and at most π/2"))
}
