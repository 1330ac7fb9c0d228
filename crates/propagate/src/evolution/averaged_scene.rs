//! A scene that can be averaged: its equations, its state, and the choice of the averages.

use std::f64::consts::TAU;

use nalgebra::{Rotation3, UnitQuaternion, Vector3};

use super::equations::{AveragedTorques, Rates, Scratch, sorted_axes};
use super::polhode_means::{ExcessPolhode, ModeFamily};
use super::short_period::{ShortPeriod, sorted_attitude};
use super::sources::MovingSource;
use super::torus::{MomentumFrame, turned_axes};
use super::weakness::Weakness;
use crate::error::Error;
use crate::input::options::{Averaging, Convention};
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::motion::solved::Periods;
use crate::orbit::elements::Orbit;
use crate::torque_free::mode::Mode;

/// A torque is averaged over the orbit if it turns the angular momentum, or changes ξ/ξ_sep, by less than this in an orbit.
const PER_ORBIT: f64 = 0.01;
/// Two numbers whose multiples fill a square evenly: powers of the root of x³ = x + 1.
const EVEN: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
/// Places on the orbit at which this is measured.
const PLACES: usize = 16;

/// The slow variables of the averaged motion and what follows from them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evolved {
    /// The time.
    pub time: f64,
    /// Angular momentum, inertial.
    pub momentum: [f64; 3],
    /// ξ, the excess of energy: 2CE/M² − 1 in the short-axis mode, 1 − 2AE/M² in the long-axis mode.
    pub excess: f64,
    /// The mode.
    pub mode: Mode,
    /// 2π M/2E: the period of the rotation, of a tumbler an effective one.
    pub spin_period: f64,
    /// Angle between the angular momentum and the normal of the first orbit \[rad\]; `None` without an orbit.
    pub obliquity: Option<f64>,
    /// Mean rates of the precession of the axis of the mode, of the other axis, and of the motion along the polhode.
    rates: [f64; 3],
}

impl Evolved {
    /// The direction of the angular momentum.
    pub fn direction(&self) -> [f64; 3] {
        Vector3::from(self.momentum).normalize().into()
    }

    /// Mean periods in one of the three conventions, as [`Motion::periods_of`](crate::Motion::periods_of).
    pub fn periods(&self, convention: Convention) -> Periods {
        let own = match convention {
            Convention::ExtremalAxis => true,
            Convention::LongAxis => self.mode == Mode::LongAxis,
            Convention::ShortAxis => self.mode == Mode::ShortAxis,
        };
        Periods { precession: TAU / self.rates[usize::from(!own)], rotation: TAU / self.rates[2] }
    }
}

/// The angular momentum in body axes, of a scene about principal axes.
fn body_momentum(scene: &Scene) -> Vector3<f64> {
    Vector3::from(scene.body().moments()).component_mul(&scene.state().angular_velocity)
}

/// The mode and sense of a scene, and ξ/ξ_sep; `None` on the separatrix to rounding.
pub(crate) fn family_of(scene: &Scene) -> Option<(ModeFamily, f64)> {
    let scene = scene.body().turn().map_or_else(|| scene.clone(), |turn| scene.about_principal_axes(turn));
    let (moments, sort) = sorted_axes(scene.body().moments());
    let (family, excess) = ModeFamily::of(&moments, &(sort * body_momentum(&scene).normalize()))?;
    Some((family, excess / family.alpha(&moments).y))
}

/// A scene that can be averaged: its equations and its state.
#[derive(Clone, Debug)]
pub(super) struct AveragedScene {
    /// About principal axes.
    pub(super) scene: Scene,
    pub(super) equations: AveragedTorques,
    pub(super) momentum: Vector3<f64>,
    pub(super) excess: f64,
    /// Of the sorted axes at the epoch.
    pub(super) attitude: UnitQuaternion<f64>,
}

impl AveragedScene {
    /// # Errors
    /// As [`Scene::evolve`].
    pub(super) fn new(scene: &Scene, average: Averaging) -> Result<Self, Error> {
        let scene = scene.validated()?;
        let scene = scene.body().turn().map_or_else(|| scene.clone(), |turn| scene.about_principal_axes(turn));
        let body = body_momentum(&scene);
        let momentum = scene.state().attitude * body;
        let size = momentum.norm();
        if !size.is_normal() {
            let reason = "the angular momentum, which must be a normal double,";
            return Err(Error::NotAveraged { reason, size, bound: f64::MIN_POSITIVE });
        }
        let (sorted, sort) = sorted_axes(scene.body().moments());
        let Some((family, excess)) = ModeFamily::of(&sorted, &(sort * body / size)) else {
            let reason = "ξ/ξ_sep: on the separatrix, and for a sphere, it";
            return Err(Error::NotAveraged { reason, size: 1.0, bound: 1.0 });
        };
        let equations = AveragedTorques::new(&scene, family)?;
        let attitude = sorted_attitude(&scene.state().attitude, &sort);
        let mut problem = Self { scene, equations, momentum, excess, attitude };
        Weakness::of(&problem.equations, problem.equations.epoch, size, &mut Scratch::default())?.validate()?;
        problem.choose(average)?;
        Ok(problem)
    }

    /// The mean angular momentum and excess at the epoch: without the part that the averages leave out.
    pub(super) fn mean(&self) -> Result<(Vector3<f64>, f64), Error> {
        let state = (&self.momentum, self.excess);
        let short = ShortPeriod::new(&self.equations, self.equations.epoch, state)?;
        Ok(short.mean(&self.attitude, &self.momentum))
    }

    /// The mean momentum and excess of each member: a state with the momentum and energy of the epoch at one of evenly spread phases.
    pub(super) fn means_of_members(&self, members: usize) -> Result<Vec<(Vector3<f64>, f64)>, Error> {
        let short = ShortPeriod::new(&self.equations, self.equations.epoch, (&self.momentum, self.excess))?;
        let phases = (0..members).map(|member| EVEN.map(|step| TAU * ((member as f64 + 0.5) * step).fract()));
        Ok(phases.map(|[along, turn]| short.mean_of_angles((along, turn), &self.momentum)).collect())
    }

    /// The scene in a state with this momentum and excess, at phases of no meaning.
    ///
    /// # Errors
    /// As [`AveragedScene::new`].
    pub(super) fn near(&self, time: f64, momentum: &Vector3<f64>, excess: f64) -> Result<Self, Error> {
        let polhode = ExcessPolhode::new(&self.equations.moments, self.equations.family, excess);
        let g = polhode.direction((0.6, 0.8));
        let frame = MomentumFrame::new(momentum, &Vector3::z());
        let [first, second] = turned_axes(&polhode, &g);
        let turn = frame.k * g.transpose() + frame.x * first.transpose() + frame.z * second.transpose();
        let sort = sorted_axes(self.scene.body().moments()).1;
        let rates = sort.transpose() * (g * momentum.norm()).component_div(&self.equations.moments);
        let attitude = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn * sort));
        let state = State { epoch: time, attitude: UnitQuaternion::new_normalize(*attitude), angular_velocity: rates };
        let over = self.equations.sources.iter().any(|source| source.over_orbit);
        Self::new(&self.scene.with_state(state), if over { Averaging::Orbit } else { Averaging::Spin })
    }

    /// Decides which sources are averaged over their orbits.
    fn choose(&mut self, average: Averaging) -> Result<(), Error> {
        let orbits: Vec<f64> =
            self.equations.sources.iter().filter_map(MovingSource::ellipse).map(Orbit::mean_motion).collect();
        let over = match average {
            Averaging::Spin => false,
            Averaging::Orbit => true,
            Averaging::Auto => {
                let changes = orbits.iter().map(|motion| self.change_in(TAU / motion));
                changes.collect::<Result<Vec<_>, _>>()?.into_iter().all(|change| change < PER_ORBIT)
            }
        };
        for source in &mut self.equations.sources {
            source.over_orbit = over && source.ellipse().is_some();
        }
        Ok(())
    }

    /// The largest rate at places on an orbit times its period, relative to M and ξ_sep.
    fn change_in(&self, period: f64) -> Result<f64, Error> {
        let (mut scratch, size) = (Scratch::default(), self.momentum.norm());
        let separatrix = self.equations.family.alpha(&self.equations.moments).y;
        let mut most = 0.0_f64;
        for place in 0..PLACES {
            let time = self.equations.epoch + period * place as f64 / PLACES as f64;
            let rates = self.equations.rates(time, (&self.momentum, self.excess), &mut scratch)?;
            most = most.max(rates.momentum.norm() / size).max(rates.excess.abs() / separatrix);
        }
        Ok(most * period)
    }

    /// The normal of the first orbit at a time.
    pub(super) fn normal(&self, time: f64) -> Option<Vector3<f64>> {
        let orbit = self.equations.sources.iter().find_map(|source| source.ellipse())?;
        Some(orbit.axes_after(self.equations.epoch, time - self.equations.epoch)[2])
    }

    pub(super) fn evolved(&self, time: f64, momentum: &Vector3<f64>, excess: f64) -> Evolved {
        let (family, size) = (self.equations.family, momentum.norm());
        let polhode = ExcessPolhode::new(&self.equations.moments, family, excess);
        let angle = |normal: Vector3<f64>| momentum.cross(&normal).norm().atan2(momentum.dot(&normal));
        // The axis of the mode precesses with dy′/dt, less or more the motion along the polhode.
        let (turn, wobble) = (polhode.mean_turn_rate(), polhode.wobble_rate());
        let precession = if family.short { turn + wobble } else { turn - wobble };
        Evolved {
            time,
            momentum: (*momentum).into(),
            excess,
            mode: if family.short { Mode::ShortAxis } else { Mode::LongAxis },
            spin_period: TAU / (size * polhode.energy()),
            obliquity: self.normal(time).map(angle),
            rates: [precession, turn, wobble].map(|rate| size * rate),
        }
    }

    pub(super) fn rates(&self, keep: impl Fn(usize) -> bool) -> Result<Rates, Error> {
        let state = (&self.momentum, self.excess);
        self.equations.rates_of(self.equations.epoch, state, &mut Scratch::default(), keep)
    }

    /// A sixth of the shortest period with which a source moves, so that no step passes over an orbit.
    pub(super) fn longest_step(&self) -> f64 {
        let rate = |source: &MovingSource| match (source.ellipse(), source.over_orbit) {
            (Some(orbit), true) => orbit.rates()[0].abs().max(orbit.rates()[1].abs()),
            (Some(orbit), false) => orbit.fastest(),
            (None, _) => source.rate_to_follow(),
        };
        TAU / 6.0 / self.equations.sources.iter().map(rate).fold(0.0, f64::max)
    }
}
