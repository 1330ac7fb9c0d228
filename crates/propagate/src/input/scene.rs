//! A scene: a body, its state and the accuracy asked for; `solve` turns it into a motion.

use nalgebra::UnitQuaternion;

use super::body::Body;
use super::disturbing_body::DisturbingBody;
use super::options::{Averaging, Level, MAX_ORDER, Method};
use super::orbit::Orbit;
use super::state::State;
use crate::error::Error;

/// A body, its state at an epoch, and what is asked of the solution.
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
    tolerance: f64,
    method: Method,
    order: Option<usize>,
    disturbing: Vec<DisturbingBody>,
    averaging: Averaging,
    level: Level,
    span: Option<(f64, f64)>,
    name: Option<String>,
    source: Option<String>,
}

impl Scene {
    /// A scene with a tolerance of 1e-12 rad and everything else left to the plan.
    pub fn new(body: Body, state: State) -> Self {
        Self {
            body,
            state,
            tolerance: 1e-12,
            method: Method::Auto,
            order: None,
            disturbing: Vec::new(),
            averaging: Averaging::Auto,
            level: Level::Full,
            span: None,
            name: None,
            source: None,
        }
    }

    /// The attitude error asked for over the span \[rad\]; less than double precision holds means the best there is.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// The method; [`Method::Auto`] if this is not called.
    #[must_use]
    pub fn method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// A fixed order of the series, of the secular part too (theory §7), instead of the one that the tolerance needs.
    #[must_use]
    pub fn order(mut self, order: usize) -> Self {
        self.order = Some(order);
        self
    }

    /// The orbit of a body whose gravity gradient acts; none if this is not called.
    #[must_use]
    pub fn orbit(self, orbit: Orbit) -> Self {
        self.disturbing([orbit])
    }

    /// The bodies whose gravity gradients act, instead of those that the scene had. Several of them, a table, and an orbit with secular rates are integrated.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Method, Orbit, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.01, 1.0])?;
    /// let bodies = [Orbit::new(2e-3, 0.1)?, Orbit::new(5e-3, 0.0)?.mass_fraction(0.01)?];
    /// let motion = Scene::new(Body::new([1.0, 1.02, 1.05])?, state).disturbing(bodies).span(0.0, 100.0).solve()?;
    /// assert_eq!(motion.plan().method(), Method::Integrated);
    /// assert!(motion.plan().error_bound() < 1e-12);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    #[must_use]
    pub fn disturbing(mut self, bodies: impl IntoIterator<Item = impl Into<DisturbingBody>>) -> Self {
        self.disturbing = bodies.into_iter().map(Into::into).collect();
        self
    }

    /// How far the equations of a scene with an orbit are averaged; [`Averaging::Auto`] if this is not called.
    #[must_use]
    pub fn averaging(mut self, averaging: Averaging) -> Self {
        self.averaging = averaging;
        self
    }

    /// Which terms the corrections of a scene with an orbit have; [`Level::Full`] if this is not called.
    #[must_use]
    pub fn level(mut self, level: Level) -> Self {
        self.level = level;
        self
    }

    /// The times over which the tolerance is asked for; any within 1e9 rotations if this is not called.
    #[must_use]
    pub fn span(mut self, start: f64, stop: f64) -> Self {
        self.span = Some((start, stop));
        self
    }

    /// A name, which is printed and nothing else.
    #[must_use]
    pub fn name(mut self, name: &str) -> Self {
        self.name = Some(name.to_owned());
        self
    }

    /// Where the figures come from, which is written and nothing else.
    #[must_use]
    pub fn source(mut self, source: &str) -> Self {
        self.source = Some(source.to_owned());
        self
    }

    /// The same scene about the principal axes of its body, to which `turn` leads from the user's.
    pub(crate) fn about_principal_axes(&self, turn: UnitQuaternion<f64>) -> Self {
        let State { epoch, attitude, angular_velocity } = self.state;
        let state = State { epoch, attitude: attitude * turn, angular_velocity: turn.inverse() * angular_velocity };
        self.starting_from(self.body.about_principal_axes(), state)
    }

    /// The same scene with another body and another state.
    pub(crate) fn starting_from(&self, body: Body, state: State) -> Self {
        Self { body, state, ..self.clone() }
    }

    /// The body.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The tolerance \[rad\].
    pub fn asked_tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The method.
    pub fn asked_method(&self) -> Method {
        self.method
    }

    /// The order, if one was fixed.
    pub fn asked_order(&self) -> Option<usize> {
        self.order
    }

    /// The orbit of the disturbing body, if there is one such body and it has an orbit.
    pub fn asked_orbit(&self) -> Option<&Orbit> {
        match &self.disturbing[..] {
            [DisturbingBody::Orbit(orbit)] => Some(orbit),
            _ => None,
        }
    }

    /// The bodies whose gravity gradients act.
    pub fn asked_disturbing(&self) -> &[DisturbingBody] {
        &self.disturbing
    }

    /// How far a scene with an orbit is averaged.
    pub fn asked_averaging(&self) -> Averaging {
        self.averaging
    }

    /// Which terms the corrections have.
    pub fn asked_level(&self) -> Level {
        self.level
    }

    /// The span, if one was given.
    pub fn asked_span(&self) -> Option<(f64, f64)> {
        self.span
    }

    /// The name, if it has one.
    pub fn asked_name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Where the figures come from, if it is said.
    pub fn asked_source(&self) -> Option<&str> {
        self.source.as_deref()
    }

    /// Whether every number of the scene is one that a motion can start from.
    ///
    /// # Errors
    /// - [`Error::Tolerance`] for 0, −1, NaN or infinite.
    /// - [`Error::Order`] for 61.
    /// - [`Error::Span`] for (1, 0), or not finite.
    /// - [`Error::Epoch`], [`Error::Attitude`], [`Error::AngularVelocity`] for a state with numbers that are no state.
    pub fn validate(&self) -> Result<(), Error> {
        self.validated().map(|_| ())
    }

    /// The scene with a unit quaternion, if it is one.
    pub(crate) fn validated(&self) -> Result<Self, Error> {
        let state = self.state.validated()?;
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
        Ok(Self { state, ..self.clone() })
    }
}
