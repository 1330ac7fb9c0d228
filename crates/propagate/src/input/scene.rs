//! A scene: a body, its state, and the requested accuracy. `solve` turns it into a motion.

use std::borrow::Cow;

use andoyer_double::DoubleDouble;
use nalgebra::UnitQuaternion;

use super::body::Body;
use super::options::{Averaging, Level, MAX_ORDER, Method};
use super::state::State;
use super::torque::Torque;
use crate::error::Error;
use crate::numerics::scaling::exponent;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;

/// A body, its state at an epoch, and the options of the solution.
///
/// ```
/// use andoyer_propagate::{Body, Scene, State};
/// let body = Body::new([1.0, 1.5, 2.0])?;
/// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?;
/// let motion = Scene::new(body, state).tolerance(1e-12).solve()?;
/// let sample = motion.at(100.0)?;
/// assert!((sample.attitude.norm() - 1.0).abs() < 1e-15);
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    body: Body,
    state: State,
    /// What the angular velocity about the principal axes of a tensor loses by rounding.
    rate_lows: [f64; 3],
    tolerance: f64,
    method: Method,
    order: Option<usize>,
    disturbing: Vec<DisturbingBody>,
    torques: Vec<Torque>,
    averaging: Averaging,
    level: Level,
    span: Option<(f64, f64)>,
    name: Option<String>,
    source: Option<String>,
}

impl Scene {
    /// A scene with a tolerance of 1e-12 rad. The plan chooses all other options.
    pub fn new(body: Body, state: State) -> Self {
        Self {
            body,
            state,
            rate_lows: [0.0; 3],
            tolerance: 1e-12,
            method: Method::Auto,
            order: None,
            disturbing: Vec::new(),
            torques: Vec::new(),
            averaging: Averaging::Auto,
            level: Level::default(),
            span: None,
            name: None,
            source: None,
        }
    }

    /// Sets the largest attitude error over the span \[rad\]. A value below the limit of double precision requests the best accuracy available.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Sets the method. The default is [`Method::Auto`].
    #[must_use]
    pub fn method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// Fixes the order of the series, including its secular part (theory §7), or that of the normal form of a libration, from 2 to 16. The default is the order that the tolerance needs.
    #[must_use]
    pub fn order(mut self, order: usize) -> Self {
        self.order = Some(order);
        self
    }

    /// Sets the first and the last time at which the tolerance must hold. The default is any time within 1e9 rotations.
    #[must_use]
    pub fn span(mut self, start: f64, stop: f64) -> Self {
        self.span = Some((start, stop));
        self
    }

    /// Sets a name. The name is only printed.
    #[must_use]
    pub fn name(mut self, name: &str) -> Self {
        self.name = Some(name.to_owned());
        self
    }

    /// Sets the source of the figures. The source is only written to files.
    #[must_use]
    pub fn source(mut self, source: &str) -> Self {
        self.source = Some(source.to_owned());
        self
    }
}

/// Gravity gradients and other torques. They are absent without the feature `torques`.
#[cfg(feature = "torques")]
impl Scene {
    /// Sets the orbit of a body whose gravity gradient acts. The default is no such body.
    #[must_use]
    pub fn orbit(self, orbit: Orbit) -> Self {
        self.disturbing([orbit])
    }

    /// Sets the bodies whose gravity gradients act, in place of those that the scene had. A scene with a table of positions is integrated.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Method, Orbit, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.01, 1.0])?;
    /// let bodies = [Orbit::new(2e-3, 0.1)?, Orbit::new(5e-3, 0.0)?.mass_fraction(0.01)?];
    /// let scene = Scene::new(Body::new([1.0, 1.02, 1.05])?, state).disturbing(bodies).span(0.0, 2000.0);
    /// let [averaged, integrated] = [1e-5, 1e-12].map(|tolerance| scene.clone().tolerance(tolerance).solve());
    /// assert_eq!((averaged?.plan().method(), integrated?.plan().method()), (Method::Closed, Method::Integrated));
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    #[must_use]
    pub fn disturbing(mut self, bodies: impl IntoIterator<Item = impl Into<DisturbingBody>>) -> Self {
        self.disturbing = bodies.into_iter().map(Into::into).collect();
        self
    }

    /// Sets the torques beside the gravity gradient, in place of those that the scene had. A scene with any of them is integrated.
    #[must_use]
    pub fn torques(mut self, torques: impl IntoIterator<Item = Torque>) -> Self {
        self.torques = torques.into_iter().collect();
        self
    }

    /// Sets the averaging of a scene with an orbit. The default is [`Averaging::Auto`].
    #[must_use]
    pub fn averaging(mut self, averaging: Averaging) -> Self {
        self.averaging = averaging;
        self
    }

    /// Sets how much of the theory a scene with an orbit uses. The default is [`Level::Auto`].
    #[must_use]
    pub fn level(mut self, level: Level) -> Self {
        self.level = level;
        self
    }
}

impl Scene {
    /// The same scene about the principal axes of its body. `turn` is the rotation from components about principal axes to the user's.
    pub(crate) fn about_principal_axes(&self, turn: UnitQuaternion<f64>) -> Self {
        let State { epoch, attitude, angular_velocity } = self.state;
        let rates = self.body.along_principal_axes(angular_velocity);
        let angular_velocity = rates.map(|rate| rate.high).into();
        let state = State { epoch, attitude: attitude * turn, angular_velocity };
        let torques = self.torques.iter().map(|torque| torque.turned(&self.body.precise_axes())).collect();
        Self {
            torques,
            rate_lows: rates.map(|rate| rate.low),
            ..self.starting_from(self.body.about_principal_axes(), state)
        }
    }

    /// The same scene with another state. The span stays.
    #[must_use]
    pub fn with_state(&self, state: State) -> Self {
        Self { state, rate_lows: [0.0; 3], ..self.clone() }
    }

    /// The same scene without the terms of internal friction, which no integration has.
    pub(crate) fn without_dissipation(&self) -> Self {
        let mut scene = self.clone();
        scene.torques.retain(|torque| !matches!(torque, Torque::Dissipation(_)));
        scene
    }

    /// The same scene without a span.
    pub(crate) fn without_span(self) -> Self {
        Self { span: None, ..self }
    }

    /// The same scene with another body and another state.
    pub(crate) fn starting_from(&self, body: Body, state: State) -> Self {
        Self { body, state, rate_lows: [0.0; 3], ..self.clone() }
    }

    /// The body.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The angular velocity at the epoch in double-double: that about the principal axes of a tensor is not rounded.
    pub(crate) fn precise_rates(&self) -> [DoubleDouble; 3] {
        std::array::from_fn(|axis| DoubleDouble { high: self.state.angular_velocity[axis], low: self.rate_lows[axis] })
    }

    /// The state at the epoch.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The requested tolerance \[rad\].
    pub fn asked_tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The requested method.
    pub fn asked_method(&self) -> Method {
        self.method
    }

    /// The fixed order, or `None`.
    pub fn asked_order(&self) -> Option<usize> {
        self.order
    }

    /// The orbit of the disturbing body, or `None` if there is not exactly one body or it has no orbit.
    pub fn asked_orbit(&self) -> Option<&Orbit> {
        match &self.disturbing[..] {
            [DisturbingBody::Orbit(orbit)] => Some(orbit),
            _ => None,
        }
    }

    /// The orbits of the disturbing bodies, or `None` if there is no body or if one has a table.
    pub(crate) fn asked_orbits(&self) -> Option<Vec<Orbit>> {
        let orbit = |body: &DisturbingBody| match body {
            DisturbingBody::Orbit(orbit) => Some(*orbit),
            DisturbingBody::Tabulated(_) => None,
        };
        let orbits: Option<Vec<_>> = self.disturbing.iter().map(orbit).collect();
        orbits.filter(|orbits| !orbits.is_empty())
    }

    /// The torques of degree 3 and 4 by the body's gravity field.
    ///
    /// # Errors
    /// - [`Error::Torque`] for a gravity field and an orbit without a semi-major axis.
    fn gravity_torques(&self) -> Result<Vec<Torque>, Error> {
        let Some(gravity) = self.body.gravity().filter(|gravity| gravity.acts()) else { return Ok(Vec::new()) };
        let torques = self.disturbing.iter().map(|body| gravity.torques(body)).collect::<Result<Vec<_>, _>>()?;
        Ok(torques.into_iter().flatten().collect())
    }

    /// All torques beside the gravity gradient of a validated scene: those that were asked for, and those of its gravity field.
    pub(crate) fn acting_torques(&self) -> Cow<'_, [Torque]> {
        match self.gravity_torques() {
            Ok(own) if !own.is_empty() => Cow::Owned(self.torques.iter().cloned().chain(own).collect()),
            _ => Cow::Borrowed(&self.torques),
        }
    }

    /// The bodies whose gravity gradients act.
    pub fn asked_disturbing(&self) -> &[DisturbingBody] {
        &self.disturbing
    }

    /// The torques beside the gravity gradient.
    pub fn asked_torques(&self) -> &[Torque] {
        &self.torques
    }

    /// The requested averaging.
    pub fn asked_averaging(&self) -> Averaging {
        self.averaging
    }

    /// The requested level of the corrections.
    pub fn asked_level(&self) -> Level {
        self.level
    }

    /// The span, or `None`.
    pub fn asked_span(&self) -> Option<(f64, f64)> {
        self.span
    }

    /// The name, or `None`.
    pub fn asked_name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// The source of the figures, or `None`.
    pub fn asked_source(&self) -> Option<&str> {
        self.source.as_deref()
    }

    /// Checks that a motion can start from the numbers of the scene.
    ///
    /// # Errors
    /// - [`Error::Tolerance`] for 0, −1, NaN or an infinity.
    /// - [`Error::Order`] for 61.
    /// - [`Error::Span`] for (1, 0), or for times that are not finite.
    /// - [`Error::Torque`] for a torque that is not finite.
    /// - [`Error::Orbit`] for the orbit of a disturbing body whose attraction, or attraction over n², is no normal double: a mean motion of 1e-300.
    /// - [`Error::Epoch`], [`Error::Attitude`], [`Error::AngularVelocity`] for an invalid state: see [`State::new`].
    pub fn validate(&self) -> Result<(), Error> {
        self.validated().map(|_| ())
    }

    /// The validated scene, with the quaternion of its state normalized.
    pub(crate) fn validated(&self) -> Result<Self, Error> {
        self.clone().into_validated()
    }

    /// The same, without a copy.
    pub(crate) fn into_validated(mut self) -> Result<Self, Error> {
        self.state = self.state.validated()?;
        self.validate_options()?;
        Ok(self)
    }

    /// Whether tolerance, order, span, disturbing bodies and torques are valid.
    pub(crate) fn validate_options(&self) -> Result<(), Error> {
        if !(self.tolerance.is_finite() && self.tolerance > 0.0) {
            return Err(Error::Tolerance { value: self.tolerance });
        }
        if let Some(value) = self.order.filter(|&order| order > MAX_ORDER) {
            return Err(Error::Order { value, bound: MAX_ORDER });
        }
        if let Some((start, stop)) = self.span
            && !(start.is_finite() && stop.is_finite() && start <= stop)
        {
            return Err(Error::Span { start, stop });
        }
        let rate = self.state.angular_velocity.amax();
        // A body at rest has the unit of the user.
        let unit = if rate > 0.0 { exponent(rate) } else { 0 };
        self.disturbing.iter().try_for_each(|body| body.validate(unit))?;
        self.gravity_torques()?;
        self.torques.iter().try_for_each(Torque::validate)
    }
}
