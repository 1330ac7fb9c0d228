//! Scenes under a gravity gradient, written as numbers, and the error of their solution beside its bound.
//!
//! The truth is [`Problem`], which integrates the full equations and shares no formula with the averaged theory.

use andoyer_propagate::options::{Averaging, Level};
use andoyer_propagate::{Body, Error, Method, Motion, Orbit, Scene, State};

use crate::attitude_error;
use crate::integration::Problem;

/// Times of a span at which an error is measured.
const SAMPLES: usize = 40;

/// What the integration loses over a span at least \[rad\].
const LEAST_LOSS: f64 = 1e-12;
/// Above this error/bound the error of the integration is measured too.
const SUSPICIOUS: f64 = 0.5;

/// A scene: a state at t = 0 and the span (`from`, `span`).
#[derive(Clone, Copy, Debug)]
pub struct Disturbed {
    /// Moments about body axes 1, 2, 3.
    pub moments: [f64; 3],
    /// [x, y, z, w].
    pub attitude: [f64; 4],
    /// Body components.
    pub rates: [f64; 3],
    /// Mean motion, eccentricity, time of the pericentre, inclination, node, argument of the pericentre.
    pub orbit: [f64; 6],
    /// Attraction of the disturbing body, GM/a³, over the square of the mean motion.
    pub attraction: f64,
    /// Rates of the node and of the argument of the pericentre.
    pub secular: [f64; 2],
    /// Further disturbing bodies: the same elements, and the attraction.
    pub further: [Option<([f64; 6], f64)>; 2],
    /// Beginning of the span, 0 if it is not apart from the state.
    pub from: f64,
    /// End of the span; negative for times before the state.
    pub span: f64,
    /// How far the equations are averaged.
    pub averaging: Averaging,
    /// Which terms the corrections have.
    pub level: Level,
    /// Tolerance of the scene \[rad\].
    pub tolerance: f64,
}

/// What the solution of a scene is worth.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    /// Largest attitude error over the span \[rad\].
    pub error: f64,
    /// What the plan says of it \[rad\].
    pub bound: f64,
    /// Largest error of the free motion, which is the effect of the torque \[rad\].
    pub effect: f64,
    /// What the integration loses of the free motion \[rad\]; 0 where the error is well within the bound, because it is not measured there.
    pub lost: f64,
}

impl Measured {
    /// Error over bound; what the integration loses over a span, 1e-12 and twice what it loses of the free motion, is no error.
    pub fn ratio(&self) -> f64 {
        (self.error - LEAST_LOSS - 2.0 * self.lost) / self.bound
    }
}

impl Disturbed {
    /// The full level, either averaging, tolerance 1e-8.
    pub fn new(moments: [f64; 3], attitude: [f64; 4], rates: [f64; 3], orbit: [f64; 6], span: f64) -> Self {
        let (averaging, level) = (Averaging::Auto, Level::Full);
        let (secular, further, from, tolerance) = ([0.0; 2], [None; 2], 0.0, 1e-8);
        Self {
            moments,
            attitude,
            rates,
            orbit,
            attraction: 1.0,
            secular,
            further,
            from,
            span,
            averaging,
            level,
            tolerance,
        }
    }

    /// The orbit of the disturbing body.
    ///
    /// # Errors
    /// That of the element that is out of range.
    pub fn disturber(&self) -> Result<Orbit, Error> {
        let [mean_motion, eccentricity, pericentre, inclination, node, argument] = self.orbit;
        Orbit::new(mean_motion, eccentricity)?.plane(inclination, node, argument)?.time_of_pericentre(pericentre)
    }

    /// The orbits of all disturbing bodies.
    ///
    /// # Errors
    /// That of the element that is out of range.
    pub fn disturbers(&self) -> Result<Vec<Orbit>, Error> {
        let [node, pericentre] = self.secular;
        let first = self.disturber()?.secular_rates(node, pericentre)?;
        let attraction = self.attraction * self.orbit[0] * self.orbit[0];
        let mut orbits = vec![if self.attraction == 1.0 { first } else { first.attraction(attraction)? }];
        for (orbit, attraction) in self.further.into_iter().flatten() {
            orbits.push(Self { orbit, ..*self }.disturber()?.attraction(attraction)?);
        }
        Ok(orbits)
    }

    /// The scene without the orbit, by theory.
    ///
    /// # Errors
    /// Those of [`Body::new`] and [`State::new`].
    pub fn free(&self) -> Result<Scene, Error> {
        let state = State::new(0.0, self.attitude, self.rates)?;
        let [start, stop] = [self.span.min(self.from), self.span.max(self.from)];
        Ok(Scene::new(Body::new(self.moments)?, state)
            .span(start, stop)
            .tolerance(self.tolerance)
            .method(Method::Closed))
    }

    /// The motion under the torque.
    ///
    /// # Errors
    /// Those of [`Scene::solve`].
    pub fn solve(&self) -> Result<Motion, Error> {
        self.free()?.disturbing(self.disturbers()?).averaging(self.averaging).level(self.level).solve()
    }

    /// Error, bound and effect over the span.
    ///
    /// # Errors
    /// Those of [`Scene::solve`].
    pub fn measured(&self) -> Result<Measured, Error> {
        let motion = self.solve()?;
        let free = self.free()?.solve()?;
        let times: Vec<f64> =
            (1..=SAMPLES).map(|k| self.from + (self.span - self.from) * k as f64 / SAMPLES as f64).collect();
        let problem = Problem { moments: self.moments, orbit: None };
        let truth = problem.integrate_under(&self.disturbers()?, 0.0, (self.attitude, self.rates), &times);
        let worst = |motion: &Motion| -> Result<f64, Error> {
            times.iter().zip(&truth).try_fold(0.0_f64, |worst, (&time, &(attitude, _))| {
                Ok(worst.max(attitude_error(motion.at(time)?.attitude.coords.into(), attitude)))
            })
        };
        let (error, bound) = (worst(&motion)?, motion.plan().error_bound());
        let lost = if error > SUSPICIOUS * bound { self.lost(&times)? } else { 0.0 };
        Ok(Measured { error, bound, effect: worst(&free)?, lost })
    }

    /// The largest error of an integration of the free motion at these times \[rad\].
    fn lost(&self, times: &[f64]) -> Result<f64, Error> {
        let free = self.free()?.tolerance(1e-13).solve()?;
        let integrated =
            Problem { moments: self.moments, orbit: None }.integrate(0.0, self.attitude, self.rates, times);
        times.iter().zip(integrated).try_fold(0.0_f64, |worst, (&time, (attitude, _))| {
            Ok(worst.max(attitude_error(free.at(time)?.attitude.coords.into(), attitude)))
        })
    }
}
