//! The error of a motion, measured: the full equations are integrated once more, and the attitudes are compared.
//!
//! The integration starts from what was given, a tensor and rates about the user's axes too. It is about the body axes (2, 3, 1): permuted axes give other steps and
//! other rounding, so that the check is independent of an integrated motion. Its own error bound comes from displaced states (docs/architecture.md, Integrated). The cost is that of
//! `Method::Integrated` over the same span.

use std::fmt;
use std::sync::atomic::AtomicBool;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::error::Error;
use crate::input::gravity::Gravity;
use crate::input::options::Method;
use crate::input::principal_axes::NEXT_AXES;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::motion::plan::{LONGEST_VERIFICATION, bound_in_words};
use crate::motion::solved::Motion;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::simd::halt::GOING;
use crate::torque_free::error_budget::DEFAULT_ROTATIONS;
use crate::torque_free::mode::Mode;

/// Default tolerance of the integration, relative to the error bound of a motion by theory.
const WELL_BELOW: f64 = 0.01;
/// Default tolerance relative to that of an integrated motion.
const FINER: f64 = 0.1;
/// The least and the largest number of times.
pub const SAMPLES: [usize; 2] = [2, 1_000_000];
/// Half of the default span of a body at rest, whose attitude is the same at any time \[unit of time\].
const AT_REST: f64 = 1.0;

/// The options of [`Motion::verify`].
#[derive(Clone, Copy, Debug)]
pub struct VerifyOptions<'a> {
    span: Option<(f64, f64)>,
    samples: usize,
    tolerance: Option<f64>,
    stop: &'a AtomicBool,
}

impl Default for VerifyOptions<'_> {
    fn default() -> Self {
        Self { span: None, samples: 64, tolerance: None, stop: &GOING }
    }
}

impl<'a> VerifyOptions<'a> {
    /// Sets the first and the last time. The default is the span of the scene; if it has none, the times for which the error bound holds.
    #[must_use]
    pub fn span(self, start: f64, stop: f64) -> Self {
        Self { span: Some((start, stop)), ..self }
    }

    /// Sets the number of times, from 2 to 1,000,000. The default is 64.
    #[must_use]
    pub fn samples(self, samples: usize) -> Self {
        Self { samples, ..self }
    }

    /// Sets the tolerance of the integration \[rad\]. The default is a hundredth of the plan's error bound, or a tenth of the tolerance of a motion that is
    /// integrated itself.
    #[must_use]
    pub fn tolerance(self, tolerance: f64) -> Self {
        Self { tolerance: Some(tolerance), ..self }
    }

    /// Ends the integration with [`Error::Stopped`] when another thread sets this flag.
    #[must_use]
    pub fn until(self, stop: &'a AtomicBool) -> Self {
        Self { stop, ..self }
    }
}

/// The difference between a motion and an integration of the full equations, from [`Motion::verify`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Verification {
    times: Vec<f64>,
    errors: Vec<f64>,
    integration_bound: f64,
    error_bound: f64,
}

impl Verification {
    /// The times at which the attitudes were compared.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The angle between the two attitudes at each time \[rad\].
    pub fn errors(&self) -> &[f64] {
        &self.errors
    }

    /// The largest of the errors \[rad\].
    pub fn error(&self) -> f64 {
        self.errors.iter().copied().fold(0.0, f64::max)
    }

    /// The error bound of the integration \[rad\].
    pub fn integration_bound(&self) -> f64 {
        self.integration_bound
    }

    /// The error bound of the motion's plan \[rad\].
    pub fn error_bound(&self) -> f64 {
        self.error_bound
    }

    /// Whether the error is within the plan's error bound, even if the integration is wrong by its own bound.
    pub fn holds(&self) -> bool {
        self.error() + self.integration_bound <= self.error_bound
    }

    /// Whether the error exceeds the plan's error bound, even if the integration is wrong by its own bound. If neither this nor [`Verification::holds`] is true,
    /// the integration is not accurate enough to decide.
    pub fn refuted(&self) -> bool {
        self.error() - self.integration_bound > self.error_bound
    }
}

impl fmt::Display for Verification {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, .., last] = &self.times[..] else { return Ok(()) };
        let verdict = match (self.holds(), self.refuted()) {
            (true, _) => "holds",
            (_, true) => "is exceeded",
            _ => "is neither confirmed nor refuted, because the integration is not accurate enough",
        };
        write!(
            f,
            "the largest error at {} times from {first} to {last} is {:.1e} rad, by an integration with an error bound of {}; the error bound of the plan, {}, {verdict}",
            self.times.len(),
            self.error(),
            bound_in_words(self.integration_bound),
            bound_in_words(self.error_bound),
        )
    }
}

impl Motion {
    /// Integrates the full equations from the state at the epoch, and compares the attitudes at equal steps of time from the first to the last time of the span.
    ///
    /// ```
    /// use andoyer_propagate::verification::VerifyOptions;
    /// use andoyer_propagate::{Body, Orbit, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.2, 0.3, 1.1])?;
    /// let scene = Scene::new(Body::new([0.5, 0.75, 1.0])?, state).orbit(Orbit::new(2e-3, 0.2)?).tolerance(1e-8);
    /// let motion = scene.span(0.0, 1e3).solve()?;
    /// let verification = motion.verify(VerifyOptions::default())?;
    /// assert!(verification.holds() && verification.error() < motion.plan().error_bound());
    /// let part = motion.verify(VerifyOptions::default().span(0.0, 100.0).samples(5))?;
    /// assert_eq!(part.times(), [0.0, 25.0, 50.0, 75.0, 100.0]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Samples`] for 1 or 1,000,001 samples, [`Error::Tolerance`] for 0, −1, NaN or an infinity, [`Error::Span`] for (1, 0) or times that are not finite.
    /// - [`Error::VerifiedSpan`] for a span that is not within the one for which the error bound holds.
    /// - [`Error::LongVerification`] without a span where the integration would take more than a minute.
    /// - [`Error::TooManySteps`], [`Error::Unpredictable`] as for [`Scene::solve`] with [`Method::Integrated`]; [`Error::Stopped`].
    pub fn verify(&self, options: VerifyOptions<'_>) -> Result<Verification, Error> {
        let VerifyOptions { samples, stop, .. } = options;
        let [least, most] = SAMPLES;
        if samples < least || samples > most {
            return Err(Error::Samples { value: samples, least, most });
        }
        let span = self.verified_span(options.span)?;
        let reference = self.independent(span, options.tolerance)?.solve_until(stop)?;
        let last = samples - 1;
        let time = |k: usize| if k == last { span.1 } else { span.0 + (span.1 - span.0) * (k as f64 / last as f64) };
        let times: Vec<f64> = (0..samples).map(time).collect();
        self.compared(&reference, times, stop)
    }

    /// The angles between this motion and one about the body axes (2, 3, 1).
    fn compared(&self, reference: &Self, times: Vec<f64>, stop: &AtomicBool) -> Result<Verification, Error> {
        let samples = times.len();
        let [own, other] = [self, reference].map(|motion| {
            let (mut attitudes, mut rates) = (vec![[0.0; 4]; samples], vec![[0.0; 3]; samples]);
            motion.batch().until(stop).samples_into(&times, &mut attitudes, &mut rates).map(|()| attitudes)
        });
        let attitude = |components: &[f64; 4]| UnitQuaternion::new_unchecked((*components).into());
        let error = |(own, other): (&[f64; 4], &[f64; 4])| (attitude(own) * next_axes()).angle_to(&attitude(other));
        let errors = own?.iter().zip(&other?).map(error).collect();
        let (integration_bound, error_bound) = (reference.plan().error_bound(), self.plan.error_bound());
        Ok(Verification { times, errors, integration_bound, error_bound })
    }

    /// The scene about the body axes (2, 3, 1), to be integrated.
    fn independent(&self, (start, stop): (f64, f64), tolerance: Option<f64>) -> Result<Scene, Error> {
        let given = self.scene();
        let State { epoch, attitude, angular_velocity: rates } = *given.state();
        let state = State {
            epoch,
            attitude: attitude * next_axes(),
            angular_velocity: Vector3::new(rates.y, rates.z, rates.x),
        };
        let torques: Vec<_> = given.asked_torques().iter().map(|torque| torque.turned(&NEXT_AXES)).collect();
        let mut scene = given.starting_from(given.body().about_next_axes()?, state).torques(torques);
        if given.body().is_sphere() && !given.body().gravity().is_some_and(Gravity::acts) {
            // No body exerts a torque on a homogeneous sphere, and a table need not reach over the span.
            scene = scene.disturbing(Vec::<DisturbingBody>::new());
        }
        let default = match self.plan.method() {
            Method::Integrated => FINER * self.plan.tolerance(),
            _ => WELL_BELOW * self.plan.error_bound(),
        };
        let tolerance = tolerance.unwrap_or(default.max(f64::MIN_POSITIVE));
        Ok(scene.method(Method::Integrated).span(start, stop).tolerance(tolerance))
    }

    /// The first and the last time of a verification: those given, or all for which the error bound holds.
    fn verified_span(&self, span: Option<(f64, f64)>) -> Result<(f64, f64), Error> {
        let epoch = self.scene.state().epoch;
        let asked = self.plan.known().map(<(f64, f64)>::from).or(self.scene.asked_span());
        let [first, last] = match asked {
            Some((start, stop)) => [start.min(epoch), stop.max(epoch)],
            None => {
                let rotations = DEFAULT_ROTATIONS * std::f64::consts::TAU / self.frequencies.longitude;
                self.reach().map(|reach| epoch + reach.clamp(-rotations, rotations))
            }
        };
        if let Some((start, stop)) = span {
            if !(start.is_finite() && stop.is_finite() && start <= stop) {
                return Err(Error::Span { start, stop });
            }
            if start < first || stop > last {
                return Err(Error::VerifiedSpan { start, stop, first, last });
            }
            return Ok((start, stop));
        }
        let cost = self.plan.verification_cost();
        if cost.seconds() > LONGEST_VERIFICATION {
            let (seconds, steps, over) = (cost.seconds(), cost.steps, self.plan.over().to_string());
            return Err(Error::LongVerification { seconds, steps, bound: LONGEST_VERIFICATION, over });
        }
        Ok(match asked {
            Some(span) => span,
            None if self.plan.mode() == Mode::AtRest => (epoch - AT_REST, epoch + AT_REST),
            None => (first, last),
        })
    }
}

/// The rotation from components about the axes (2, 3, 1) to components about (1, 2, 3): a third of a turn about the diagonal.
fn next_axes() -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::new(0.5, 0.5, 0.5, 0.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOMENTS: [f64; 3] = [0.5, 0.75, 1.0];

    fn free(rates: [f64; 3]) -> Motion {
        crate::solve::solved(MOMENTS, State::new(0.0, [0.0, 0.0, 0.0, 1.0], rates).expect("a state"))
    }

    /// The verification of a motion by one with other rates, about the axes of verifications.
    fn verified(motion: &Motion, rates: [f64; 3]) -> Verification {
        let scene = free(rates).independent((0.0, 300.0), None).expect("a scene");
        let reference = crate::solve::solved(scene.body().moments(), *scene.state());
        motion.compared(&reference, vec![0.0, 150.0, 300.0], &GOING).expect("a verification")
    }

    #[test]
    fn motion_that_is_another_is_refuted() {
        let motion = free([0.2, 0.3, 1.1]);
        assert!(!verified(&motion, [0.2, 0.3, 1.1]).refuted());
        let other = verified(&motion, [0.2, 0.3, 1.1 + 1e-8]);
        assert!(other.refuted() && !other.holds() && other.error() > 1e-6, "{other}");
        assert!(other.to_string().ends_with("rad, is exceeded"), "{other}");
    }

    #[test]
    fn bound_that_is_smaller_than_the_error_is_refuted_and_a_larger_one_holds() {
        let verification = |error_bound: f64, integration_bound: f64| Verification {
            times: vec![0.0, 1.0],
            errors: vec![0.0, 1e-6],
            integration_bound,
            error_bound,
        };
        for (bound, holds) in [(0.5e-6, false), (2e-6, true)] {
            let found = verification(bound, 1e-8);
            assert_eq!((found.holds(), found.refuted()), (holds, !holds), "{found}");
        }
        // An integration that is not accurate enough decides nothing.
        let coarse = verification(1e-6, 0.01);
        assert!(!coarse.holds() && !coarse.refuted(), "{coarse}");
        let said = coarse.to_string();
        assert!(
            said.ends_with("is neither confirmed nor refuted, because the integration is not accurate enough"),
            "{said}"
        );
    }
}
