//! From a scene to its motion: mode, method, secular part, series, initial phases (theory §5 to §8, §10).

use std::sync::atomic::AtomicBool;

use crate::error::{Error, Kind, TorqueMeasure};
use crate::gravity_gradient::body::osculating::{LARGEST_SEPARATRIX_RATIO, osculating};
use crate::gravity_gradient::level::chosen;
use crate::gravity_gradient::request::Request;
use crate::input::options::{Averaging, Level, Method};
use crate::input::orbit::Orbit;
use crate::input::scene::Scene;
use crate::motion::plan::Plan;
use crate::motion::solved::{Frequencies, Given, Motion};
use crate::motion::trajectory::Trajectory;
use crate::numerics::scaling::{exponent, half, scaled, user_rate};
use crate::simd::halt::GOING;
use crate::torque_free::error_budget::{DEFAULT_ROTATIONS, ROUNDING, phase_rounding, sides};
use crate::torque_free::frequencies::Secular;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::{Polhode, UserFrame};
use crate::torque_free::separatrix::Passage;
use crate::torque_free::series::solution::by_the_series;
use crate::torque_free::series::tables::SeriesTables;
use crate::torque_free::solution::{CayleyKlein, Solution, by_theta_functions, on_the_separatrix};
use crate::torque_free::steady::SteadyRotation;
use crate::torque_free::wobble::{Wobble, WobbleEvaluator};

mod choice;
mod several;

pub(crate) use several::several;

use choice::{beyond_theory, cheapest, in_ascii, integrated, is_sphere, may_be_integrated, without_span};

/// An error bound below this is not compared with the effect of the torque \[rad\].
const LEAST_CHECKED_BOUND: f64 = 1e-3;
/// Intervals of the span at whose ends the effect of the torque is sampled.
const EFFECT_SAMPLES: u32 = 16;

impl Scene {
    /// The motion: everything that does not depend on time is done here, once.
    ///
    /// # Errors
    /// - Those of [`Scene::validate`].
    /// - [`Error::Units`] where the angular momentum over- or underflows, or a rate that belongs to it does.
    /// - [`Error::NearSeparatrix`] where the series is asked for and the tolerance needs an order above [`MAX_ORDER`](crate::options::MAX_ORDER).
    /// - [`Error::Separatrix`] where the series is asked for on the separatrix itself.
    /// - [`Error::Resonance`], [`Error::TorqueTooStrong`], [`Error::Unaveraged`] for an orbit whose gravity gradient cannot be averaged, without a span or with
    ///   a method other than [`Method::Auto`] and [`Method::Integrated`].
    /// - [`Error::NoSpan`] where the motion is integrated and no span is given; [`Error::OnlyIntegrated`] for a table of positions with another method.
    /// - [`Error::TooManySteps`], [`Error::Unpredictable`] where the integration takes too many steps, or nothing is known at its end; [`Error::TableSpan`].
    pub fn solve(&self) -> Result<Motion, Error> {
        self.solve_with(&SeriesTables::default())
    }

    /// The same motion, to the same bits, with tables of the series that serve the scenes of the same body after it: a second solution by the series costs a
    /// fraction of the first.
    ///
    /// # Errors
    /// As [`Scene::solve`].
    ///
    /// ```
    /// use andoyer_propagate::{Body, Method, Scene, SeriesTables, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?;
    /// let scene = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).method(Method::Series);
    /// let tables = SeriesTables::default();
    /// for tolerance in [1e-12, 1e-6] {
    ///     assert!(scene.clone().tolerance(tolerance).solve_with(&tables)?.plan().error_bound() <= tolerance);
    /// }
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn solve_with(&self, tables: &SeriesTables) -> Result<Motion, Error> {
        self.solve_until(tables, &GOING)
    }

    /// As [`Scene::solve_with`], and ends early, with [`Error::Stopped`], once another thread has set the flag: an integration may take seconds. A flag that is
    /// set from the start ends an integration before its first step; a motion that needs none is returned.
    ///
    /// # Errors
    /// As [`Scene::solve`], and [`Error::Stopped`].
    pub fn solve_until(&self, tables: &SeriesTables, stop: &AtomicBool) -> Result<Motion, Error> {
        let scene = self.validated()?;
        let Some(turn) = scene.body().turn() else { return scene.solve_about_principal_axes(tables, stop) };
        let mut motion = scene.about_principal_axes(turn).solve_about_principal_axes(tables, stop)?;
        motion.given = Some(Box::new(Given { scene, turn }));
        Ok(motion)
    }

    fn solve_about_principal_axes(self, tables: &SeriesTables, stop: &AtomicBool) -> Result<Motion, Error> {
        match (self.asked_method(), beyond_theory(&self)) {
            (Method::Integrated, _) => integrated(self, tables, String::new(), stop),
            (Method::Auto, Some(reason)) => integrated(self, tables, format!("theory: {reason}"), stop),
            (method, Some(reason)) => Err(Error::OnlyIntegrated { method: method.to_string(), reason }),
            (_, None) if may_be_integrated(&self) => cheapest(self, tables, stop),
            (_, None) => {
                let bodies = without_span(&self);
                self.solve_by_theory(tables).map_err(|error| match bodies {
                    Some(bodies) if error.kind() == Kind::Theory => {
                        Error::NoSpan { reason: format!("theory for {bodies}: {}", in_ascii(&error.to_string())) }
                    }
                    _ => error,
                })
            }
        }
    }

    fn solve_by_theory(self, tables: &SeriesTables) -> Result<Motion, Error> {
        let polhode = Polhode::new(self.body(), self.state());
        self.solve_on(polhode.as_ref(), Preparation { tables, secular: None, remarks: true })
    }

    /// The motion on a polhode; `None` for a body at rest.
    fn solve_on(self, polhode: Option<&Polhode>, preparation: Preparation<'_>) -> Result<Motion, Error> {
        let scene = self;
        let Some(polhode) = polhode else {
            return match scene.asked_orbits() {
                Some(_) if !is_sphere(&scene) => Err(Error::Unaveraged {
                    mode: Mode::AtRest.to_string(),
                    ratio: 0.0,
                    bound: LARGEST_SEPARATRIX_RATIO,
                }),
                _ => {
                    let mut motion = at_rest(scene);
                    remark_unused(&mut motion);
                    Ok(motion)
                }
            };
        };
        representable(polhode)?;
        let mode = Mode::of(polhode);
        if mode != Mode::Spherical
            && let Some(orbits) = scene.asked_orbits()
        {
            return disturbed(scene, polhode, mode, &orbits);
        }
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
}

/// What is ready before a scene is solved, and what its plan is to say.
#[derive(Clone, Copy)]
struct Preparation<'a> {
    tables: &'a SeriesTables,
    /// The frequencies, if they are computed already.
    secular: Option<Secular>,
    /// Whether the plan says what was skipped.
    remarks: bool,
}

/// Whether the angular momentum and every rate of a motion are normal doubles in the user's units.
fn representable(polhode: &Polhode) -> Result<(), Error> {
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
fn wobbling(scene: Scene, preparation: Preparation<'_>, polhode: &Polhode, mode: Mode) -> Result<Motion, Error> {
    let Preparation { tables, secular, remarks } = preparation;
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
        Method::Closed | Method::Integrated => false,
        // A fixed order is one of the series.
        Method::Auto => scene.asked_order().is_some() && mode != Mode::Axisymmetric,
    };
    let solution = if by_series {
        by_the_series((&scene, tables), polhode, exact, ratio, mode)?
    } else {
        by_theta_functions((&scene, remarks), polhode, exact, ratio, mode)
    };
    let phases = phase_rounding(&scene, exact.longitude_rate, polhode.scales.1);
    let mut plan = Plan::new(&scene, mode, ratio, solution.error_bound + phases);
    plan.method = if by_series { Method::Series } else { Method::Closed };
    plan.expanded = polhode.has_small_divisor(scene.body().has_tensor());
    Ok(assembled(scene, polhode, plan, solution))
}

/// The motion of a wobbling body by the closed form, with every harmonic that rounding leaves: what derivatives are taken of.
pub(crate) fn untruncated(scene: &Scene, polhode: &Polhode, mode: Mode) -> Result<Motion, Error> {
    let preparation = Preparation { tables: &SeriesTables::default(), secular: None, remarks: false };
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

/// The motion under a gravity gradient.
fn disturbed(scene: Scene, polhode: &Polhode, mode: Mode, orbits: &[Orbit]) -> Result<Motion, Error> {
    let (ratio, osculating) = osculating(polhode)?;
    let exponent = polhode.scales.1;
    let rotation = polhode.invariants.mean_rate;
    let request = Request {
        orbits,
        averaging: scene.asked_averaging(),
        level: scene.asked_level(),
        tolerance: scene.asked_tolerance(),
        epoch: scene.state().epoch,
        sides: sides(&scene, rotation, exponent).map(|time| scaled(time, -exponent)),
        spanned: scene.asked_span().is_some(),
    };
    let (gradient, unused) = chosen(polhode, scene.state().attitude, osculating, &request)?;
    let [anomaly, longitude] = gradient.frequencies();
    let mut skipped: Vec<String> = unused_order(&scene).into_iter().collect();
    if scene.asked_method() == Method::Series {
        skipped.push("series: a scene with an orbit is solved about the closed form".to_owned());
    }
    skipped.extend(unused.as_deref().map(in_ascii));
    skipped.extend(gradient.skipped());
    let mut plan = Plan::new(&scene, mode, ratio, gradient.error + 4.0 * ROUNDING);
    (plan.gradient, plan.skipped) = (Some(gradient.plan()), skipped);
    let reach = gradient.bound() * longitude / std::f64::consts::TAU;
    plan.reach = Some(reach).filter(|reach| *reach < DEFAULT_ROTATIONS);
    let error = gradient.error;
    let motion = Motion {
        plan,
        frequencies: Frequencies { anomaly, longitude },
        given: None,
        precession: longitude + anomaly,
        angular_momentum: polhode.angular_momentum(scene.state().attitude),
        long_axis: polhode.long_axis,
        trajectory: Trajectory::Gradient(Box::new(gradient)),
        scene,
    };
    let fastest = orbits.iter().map(Orbit::mean_motion).fold(0.0, f64::max);
    let turns = request.duration() * fastest / std::f64::consts::TAU;
    if !matches!(request.level, Level::Paper | Level::Moving)
        && turns < 1.0
        && error > LEAST_CHECKED_BOUND.max(request.tolerance)
    {
        let effect = effect(&motion)?;
        if error > effect {
            return Err(Error::TorqueTooStrong { measure: TorqueMeasure::ErrorBound, size: error, bound: effect });
        }
    }
    Ok(motion)
}

/// Largest turn between a motion under a torque and the free one over the span.
fn effect(motion: &Motion) -> Result<f64, Error> {
    let scene = &motion.scene;
    let (start, stop) = scene.asked_span().unwrap_or((scene.state().epoch, scene.state().epoch));
    let free = Scene::new(scene.body().clone(), *scene.state()).span(start, stop).solve()?;
    (0..=EFFECT_SAMPLES).try_fold(0.0_f64, |largest, k| {
        let time = start + (stop - start) * f64::from(k) / f64::from(EFFECT_SAMPLES);
        Ok(largest.max(free.at(time)?.attitude.angle_to(&motion.at(time)?.attitude)))
    })
}

/// Adds what the scene of a motion asked for and did not need to what was skipped.
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

fn unused_order(scene: &Scene) -> Option<String> {
    scene.asked_order().map(|order| format!("order {order}, which was asked for: this motion has no series"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, State};

    fn rates_at(tables: &SeriesTables, order: usize, angular_velocity: [f64; 3]) -> [f64; 3] {
        let body = Body::new([0.5, 0.75, 1.0]).expect("a body");
        let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], angular_velocity).expect("a state");
        let motion = Scene::new(body, state).method(Method::Series).order(order).solve_with(tables).expect("a wobble");
        motion.at(123.4).expect("a finite time").angular_velocity.into()
    }

    #[test]
    fn what_was_solved_before_changes_no_bit() {
        let new = SeriesTables::default;
        for angular_velocity in [[0.2, 0.3, 0.9], [1.6, 0.35, 0.5]] {
            let expected = [2, 7, 20].map(|order| rates_at(&new(), order, angular_velocity));
            assert!(expected[0] != expected[1] && expected[1] != expected[2]);
            let seen = new();
            rates_at(&seen, 30, [0.2, 0.3, 0.9]);
            rates_at(&seen, 5, [1.6, 0.35, 0.5]);
            assert_eq!([2, 7, 20].map(|order| rates_at(&seen, order, angular_velocity)), expected);
        }
    }

    #[test]
    fn tables_and_bodies_go_to_other_threads() {
        fn shared<T: Send + Sync + std::panic::UnwindSafe + std::panic::RefUnwindSafe>() {}
        shared::<SeriesTables>();
        shared::<Body>();
    }
}
