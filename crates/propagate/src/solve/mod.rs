//! From a scene to its motion: mode, method, secular part, series, initial phases (theory §5 to §8, §10).

mod steadily;

use andoyer_double::DoubleDouble;

use crate::error::Error;
use crate::gravity_gradient::disturbed::{Gradient, Request};
use crate::gravity_gradient::osculating::{LARGEST_SEPARATRIX_RATIO, osculating};
use crate::input::options::{Averaging, Level, Method};
use crate::input::orbit::Orbit;
use crate::input::scene::Scene;
use crate::motion::plan::Plan;
use crate::motion::solved::{Frequencies, Given, Motion};
use crate::motion::trajectory::Course;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::{exponent, half, scaled, user_rate};
use crate::numerics::theta::Theta;
use crate::torque_free::closed_form::{ClosedForm, NEAREST_COMPLEMENT, anomaly};
use crate::torque_free::error_budget::{
    COSINE_ROUNDING, ROUNDING, conditioning, drift, duration, phase_rounding, rounding,
};
use crate::torque_free::frequencies::Secular;
use crate::torque_free::harmonics::QuaternionSeries;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::{Place, Polhode};
use crate::torque_free::separatrix::{Clock, Flip, Passage};
use crate::torque_free::series::composition::{harmonics, oscillator_and_longitude};
use crate::torque_free::series::order::{Expanded, expanded, first_order, initial_anomaly};
use crate::torque_free::series::tables::SeriesTables;
use crate::torque_free::wobble::Wobble;
use steadily::{at_rest, steadily_rotating};

/// Part of the tolerance that dropped harmonics may use.
const HARMONICS_SHARE: f64 = 0.125;
impl Scene {
    /// The motion: everything that does not depend on time is done here, once.
    ///
    /// # Errors
    /// - Those of [`Scene::validate`].
    /// - [`Error::Units`] where the angular momentum over- or underflows, or a rate that belongs to it does.
    /// - [`Error::NearSeparatrix`] where the series is asked for and the tolerance needs an order above [`MAX_ORDER`](crate::MAX_ORDER).
    /// - [`Error::Separatrix`] where the series is asked for on the separatrix itself.
    /// - [`Error::Resonance`], [`Error::TorqueTooStrong`], [`Error::Unaveraged`] for an orbit whose gravity gradient cannot be averaged.
    pub fn solve(&self) -> Result<Motion, Error> {
        self.solve_with(&SeriesTables::default())
    }

    /// The same motion, to the same bits, with tables of the series that serve the scenes of the same body after it: a second solution by the series costs a fraction
    /// of the first.
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
        let scene = self.validated()?;
        let Some(turn) = scene.body().turn() else { return scene.solve_about_principal_axes(tables) };
        let mut motion = scene.about_principal_axes(turn).solve_about_principal_axes(tables)?;
        motion.given = Some(Box::new(Given { scene, turn }));
        Ok(motion)
    }

    fn solve_about_principal_axes(self, tables: &SeriesTables) -> Result<Motion, Error> {
        let scene = self;
        let Some(polhode) = Polhode::new(scene.body(), scene.state()) else {
            return match scene.asked_orbit() {
                Some(_) => Err(Error::Unaveraged {
                    mode: Mode::AtRest.to_string(),
                    ratio: 0.0,
                    bound: LARGEST_SEPARATRIX_RATIO,
                }),
                None => Ok(with_unused(at_rest(scene))),
            };
        };
        let momentum = polhode.user_momentum();
        if !momentum.is_normal() {
            let (moment, rate) = polhode.scales;
            return Err(Error::Units { quantity: "the angular momentum", exponent: moment + rate });
        }
        // No rate or frequency of the motion is more than twice M over the smallest moment.
        let smallest = polhode.moments.iter().copied().fold(f64::INFINITY, f64::min);
        let fastest = polhode.momentum.to_f64() / smallest;
        if !scaled(4.0 * fastest, polhode.scales.1).is_finite() {
            let exponent = exponent(fastest) + polhode.scales.1;
            return Err(Error::Units { quantity: "the rate that belongs to the smallest moment", exponent });
        }
        let mode = Mode::of(&polhode);
        if let Some(&orbit) = scene.asked_orbit()
            && mode != Mode::Spherical
        {
            return disturbed(scene, &polhode, mode, &orbit);
        }
        let motion = match mode {
            mode @ (Mode::Spherical | Mode::PrincipalAxis) => steadily_rotating(scene, &polhode, mode),
            Mode::Separatrix => passing(scene, &polhode)?,
            mode => wobbling((scene, tables), &polhode, mode)?,
        };
        Ok(with_unused(motion))
    }
}

/// a e^(−iy′/2) and b e^(−iy′/2) of theory §8, up to their norm, as functions of time.
enum Pair {
    /// ℓ′ and the harmonics of it.
    Fourier(Phase, QuaternionSeries),
    /// Near the separatrix and on it.
    Passage(Passage),
}

/// The pair (a, b) as a function of time, and what the plan says of it.
struct Solved {
    pair: Pair,
    /// y′ at the epoch, where y is 0.
    longitude: f64,
    rates: Secular,
    plan: Plan,
}

fn wobbling((scene, tables): (Scene, &SeriesTables), polhode: &Polhode, mode: Mode) -> Result<Motion, Error> {
    let exact = Secular::exact(polhode);
    let ratio = (exact.kappa_sigma / polhode.kappa() / polhode.separatrix_action()).min(1.0);
    let by_series = match scene.asked_method() {
        Method::Series => true,
        Method::Closed => false,
        // A fixed order is one of the series.
        Method::Auto => scene.asked_order().is_some() && mode != Mode::Axisymmetric,
    };
    let plan = Plan {
        mode,
        method: if by_series { Method::Series } else { Method::Closed },
        order: 0,
        harmonics: 0,
        error_bound: 0.0,
        tolerance: scene.asked_tolerance(),
        spanned: scene.asked_span().is_some(),
        separatrix_ratio: ratio,
        gradient: None,
        skipped: Vec::new(),
    };
    let mut solved = if by_series {
        by_the_series((&scene, tables), polhode, exact, plan)?
    } else {
        by_theta_functions(&scene, polhode, exact, plan)
    };
    let phases = phase_rounding(&scene, exact.longitude_rate, polhode.scales.1);
    solved.plan.error_bound = (solved.plan.error_bound + phases).min(std::f64::consts::PI);
    Ok(assembled(scene, polhode, solved))
}

/// The motion of a wobbling body by the closed form, with every harmonic that rounding leaves: what derivatives are taken of.
pub(crate) fn untruncated(scene: &Scene, polhode: &Polhode, mode: Mode) -> Result<Motion, Error> {
    wobbling((scene.clone().method(Method::Closed).tolerance(0.0), &SeriesTables::default()), polhode, mode)
}

fn assembled(scene: Scene, polhode: &Polhode, solved: Solved) -> Motion {
    let exponent = polhode.scales.1;
    let longitude_rate = user_rate(solved.rates.longitude_rate, exponent);
    let [anomaly, precession] = [solved.rates.anomaly_rate, solved.rates.longitude_rate + solved.rates.anomaly_rate]
        .map(|rate| scaled(rate.to_f64(), exponent));
    let half_longitude = half(longitude_rate, solved.longitude);
    let place = Place {
        inertial: polhode.invariable_frame(scene.state().attitude),
        frame: polhode.frame.clone(),
        rates: polhode.user_rates(),
    };
    let course = match solved.pair {
        Pair::Fourier(anomaly, series) => Course::polhode(&Wobble { anomaly, series, half_longitude, place }),
        Pair::Passage(passage) => Course::Flip(Box::new(Flip { passage, half_longitude, place })),
    };
    Motion {
        plan: solved.plan,
        course,
        frequencies: Frequencies { anomaly, longitude: longitude_rate.to_f64() },
        given: None,
        precession,
        angular_momentum: polhode.angular_momentum(scene.state().attitude),
        long_axis: polhode.long_axis,
        scene,
    }
}

fn by_the_series(
    (scene, tables): (&Scene, &SeriesTables),
    polhode: &Polhode,
    exact: Secular,
    mut plan: Plan,
) -> Result<Solved, Error> {
    let expanded = expanded((scene, tables), polhode, &exact, plan.separatrix_ratio, plan.mode)?;
    let Expanded { order, expansion, secular, ellipse, truncation } = expanded;
    let (series, dropped) = harmonics(&expansion, ellipse).truncated(HARMONICS_SHARE * scene.asked_tolerance());
    let theta = polhode.theta();
    // The truncated series of a fixed order has its own ℓ′. Next to the separatrix that is ill-conditioned, and the elliptic integral is not.
    let anomaly = match scene.asked_order() {
        Some(_) => initial_anomaly(&expansion, ellipse.oscillator(polhode.zeta())),
        None => anomaly(polhode, &theta),
    };
    let (_, longitude) = oscillator_and_longitude(&expansion, |h| (h as f64 * anomaly).sin_cos());
    let exponent = polhode.scales.1;
    plan.order = order;
    plan.harmonics = series.harmonics();
    plan.error_bound =
        truncation + dropped + drift(scene, &exact, &secular, exponent, theta.quarter) + rounding(&series);
    plan.skipped =
        if plan.mode == Mode::Axisymmetric { round_body() } else { dropped_harmonics(&series, 4 * order + 3) };
    let anomaly = Phase::new(user_rate(secular.anomaly_rate, exponent), anomaly);
    Ok(Solved { pair: Pair::Fourier(anomaly, series), longitude: -longitude, rates: secular, plan })
}

fn by_theta_functions(scene: &Scene, polhode: &Polhode, rates: Secular, mut plan: Plan) -> Solved {
    let theta = polhode.theta();
    let exponent = polhode.scales.1;
    let anomaly_rate = user_rate(rates.anomaly_rate, exponent);
    let series_order = first_order(plan.separatrix_ratio, plan.tolerance);
    if theta.complement < NEAREST_COMPLEMENT {
        let (place, quarter, turned) = Passage::place(polhode);
        let clock = Clock::repeating(anomaly_rate, place, quarter, theta.conjugate);
        let passage = Passage::new(&theta, clock).turned(turned);
        plan.error_bound = 2.0 * ROUNDING + conditioning(scene, polhode, &rates);
        plan.skipped.push("series: too near the separatrix".to_owned());
        let longitude = -2.0 * passage.phase((0.0, 0.0));
        return Solved { pair: Pair::Passage(passage), longitude, rates, plan };
    }
    let closed = ClosedForm::new(polhode, &theta);
    let all = closed.series.harmonics();
    // What is dropped is missing at the epoch and at the time.
    let budget = 0.5 * HARMONICS_SHARE * plan.tolerance * closed.least_norm;
    let (series, dropped) = if budget == 0.0 { (closed.series, 0.0) } else { closed.series.truncated(budget) };
    plan.harmonics = series.harmonics();
    plan.error_bound =
        (2.0 * dropped + rounding(&series)) / closed.least_norm.min(1.0) + conditioning(scene, polhode, &rates);
    plan.skipped = if plan.mode == Mode::Axisymmetric {
        round_body()
    } else {
        let reason = match series_order {
            Some(order) => {
                format!("series: it would need order {order} or more, and no fewer harmonics")
            }
            None => "series: too near the separatrix for its highest order".to_owned(),
        };
        std::iter::once(reason).chain(dropped_harmonics(&series, all)).collect()
    };
    let longitude = -2.0 * series.pair(closed.anomaly)[0].arg();
    let pair = Pair::Fourier(Phase::new(anomaly_rate, closed.anomaly), series);
    Solved { pair, longitude, rates, plan }
}

/// The motion on the separatrix: one passage, from and to rotation about the axis of middle inertia.
fn passing(scene: Scene, polhode: &Polhode) -> Result<Motion, Error> {
    if scene.asked_method() == Method::Series {
        return Err(Error::Separatrix);
    }
    let theta = polhode.theta();
    let (place, _, turned) = Passage::place(polhode);
    // Without end, however far from 0 rounding has left Q1.
    let theta = Theta { quarter: f64::INFINITY, ..theta };
    let [_, greatest] = polhode.cosine_squares();
    let precise = polhode.mean_rate() * polhode.gamma() * greatest.sqrt();
    let clock = Clock::Once(place.times_double(0.5), user_rate(precise.times_double(0.5), polhode.scales.1));
    let rate = precise.to_f64();
    let passage = Passage::new(&theta, clock).turned(turned);
    let rates = Secular { kappa_sigma: 0.0, anomaly_rate: DoubleDouble::ZERO, longitude_rate: polhode.middle_rate() };
    // A distance from the separatrix that double-double does not see grows like e^u.
    let growth = (rate.abs() * duration(&scene, rates.longitude_rate, polhode.scales.1)).exp();
    let unseen = if polhode.cosine_squares()[0] == DoubleDouble::ZERO { 0.0 } else { COSINE_ROUNDING * growth };
    let phases = phase_rounding(&scene, rates.longitude_rate, polhode.scales.1);
    let plan = Plan {
        mode: Mode::Separatrix,
        method: Method::Closed,
        order: 0,
        harmonics: 0,
        error_bound: (4.0 * ROUNDING + phases + unseen).min(std::f64::consts::PI),
        tolerance: scene.asked_tolerance(),
        spanned: scene.asked_span().is_some(),
        separatrix_ratio: 1.0,
        gradient: None,
        skipped: vec!["series: on the separatrix".to_owned()],
    };
    let longitude = -2.0 * passage.phase((0.0, 0.0));
    Ok(assembled(scene, polhode, Solved { pair: Pair::Passage(passage), longitude, rates, plan }))
}

/// The motion under a gravity gradient.
fn disturbed(scene: Scene, polhode: &Polhode, mode: Mode, orbit: &Orbit) -> Result<Motion, Error> {
    let (ratio, osculating) = osculating(polhode)?;
    let exponent = polhode.scales.1;
    let rotation = polhode.mean_rate();
    let request = Request {
        orbit,
        averaging: scene.asked_averaging(),
        level: scene.asked_level(),
        tolerance: scene.asked_tolerance(),
        epoch: scene.state().epoch,
        duration: scaled(duration(&scene, rotation, exponent), -exponent),
        spanned: scene.asked_span().is_some(),
    };
    let gradient = Gradient::new(polhode, scene.state().attitude, osculating, &request)?;
    let [anomaly, longitude] = gradient.frequencies();
    let mut skipped: Vec<String> = unused_order(&scene).into_iter().collect();
    if scene.asked_method() == Method::Series {
        skipped.push("series: a scene with an orbit is solved about the closed form".to_owned());
    }
    skipped.extend(gradient.skipped());
    let plan = Plan {
        mode,
        method: Method::Closed,
        order: 0,
        harmonics: 0,
        error_bound: (gradient.error + 4.0 * ROUNDING).min(std::f64::consts::PI),
        tolerance: scene.asked_tolerance(),
        spanned: scene.asked_span().is_some(),
        separatrix_ratio: ratio,
        gradient: Some(gradient.plan()),
        skipped,
    };
    Ok(Motion {
        plan,
        frequencies: Frequencies { anomaly, longitude },
        given: None,
        precession: longitude + anomaly,
        angular_momentum: polhode.angular_momentum(scene.state().attitude),
        long_axis: polhode.long_axis,
        course: Course::Gradient(Box::new(gradient)),
        scene,
    })
}

fn round_body() -> Vec<String> {
    vec!["series: two moments are equal, the wobble is a circle and the precession regular".to_owned()]
}

fn dropped_harmonics(series: &QuaternionSeries, all: usize) -> Vec<String> {
    let kept = series.harmonics();
    let reason = (kept < all).then(|| format!("harmonics above {kept}: together below an eighth of the tolerance"));
    reason.into_iter().collect()
}

/// The motion with what its scene asked for and did not need among what was skipped.
fn with_unused(mut motion: Motion) -> Motion {
    let scene = &motion.scene;
    let mut unused: Vec<String> = match (motion.plan.method, motion.plan.mode) {
        (Method::Series, Mode::ShortAxis | Mode::LongAxis) => None,
        (_, Mode::ShortAxis | Mode::LongAxis) => {
            scene.asked_order().map(|order| format!("order {order}, which was asked for: the closed form has none"))
        }
        _ => unused_order(scene),
    }
    .into_iter()
    .collect();
    if scene.asked_orbit().is_some() {
        unused.push("gravity gradient: it exerts no torque on a sphere".to_owned());
    } else {
        let (averaging, level) = (scene.asked_averaging(), scene.asked_level());
        if averaging != Averaging::default() {
            unused.push(format!("averaging {averaging}, which was asked for: there is no orbit"));
        }
        if level != Level::default() {
            unused.push(format!("level {level}, which was asked for: there is no orbit"));
        }
    }
    motion.plan.skipped.extend(unused);
    motion
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
