//! `Scene::drift`: mean rates now.

use super::averaged_scene::AveragedScene;
use super::equations::{Rates, Scratch};
use crate::error::Error;
use crate::input::options::Averaging;
use crate::input::scene::Scene;
use crate::integration::rates::of_interpolation;

/// Mean rates of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// Of the angular momentum, inertial [moment × rate²].
    pub momentum: [f64; 3],
    /// Of ξ [1/time].
    pub excess: f64,
    /// Of the spin period.
    pub spin_period: f64,
    /// Of the obliquity [rad/time]; `None` without an orbit.
    pub obliquity: Option<f64>,
    /// Rates of momentum and ξ by the harmonics of each degree, from 0.
    pub by_degree: Vec<([f64; 3], f64)>,
    /// dξ̇/dξ at ξ = 0 [1/time]: uniform rotation about the axis of the mode is unstable if it is positive.
    pub wobble_rate: f64,
}

impl AveragedScene {
    fn drift(&self) -> Result<Drift, Error> {
        let Rates { momentum, excess } = self.rates(|_| true)?;
        let (size, epoch) = (self.momentum.norm(), self.equations.epoch);
        let k = self.momentum / size;
        let now = self.evolved(epoch, &self.momentum, self.excess);
        let signed = if self.equations.family.short { 1.0 } else { -1.0 };
        // P = 2π I_p/(M (1 ± ξ))
        let spin_period = -now.spin_period * (k.dot(&momentum) / size + signed * excess / (1.0 + signed * self.excess));
        let turn = (momentum - k * k.dot(&momentum)) / size;
        let obliquity = self.normal(epoch).map(|normal| {
            let sine = k.cross(&normal).norm();
            if sine > 0.0 { -turn.dot(&normal) / sine } else { turn.norm() }
        });
        let highest = self.equations.highest_degree();
        let one = |degree: usize| self.rates(|l| l == degree).map(|rates| (rates.momentum.into(), rates.excess));
        let by_degree = (0..=highest).map(one).collect::<Result<Vec<_>, _>>()?;
        // (4) keeps the relative accuracy of ξ̇ for ξ → 0.
        let small = 1e-9 * self.equations.family.alpha(&self.equations.moments).y;
        let state = (&self.momentum, small);
        let wobble_rate = self.equations.rates(epoch, state, &mut Scratch::default())?.excess / small;
        Ok(Drift { momentum: momentum.into(), excess, spin_period, obliquity, by_degree, wobble_rate })
    }
}

impl Scene {
    /// The mean rates of the scene at its epoch: torques averaged over the rotation and, as in [`Scene::evolve`], over orbits.
    ///
    /// # Errors
    /// As [`Scene::evolve`].
    pub fn drift(&self, average: Averaging) -> Result<Drift, Error> {
        let averaged = AveragedScene::new(self, average)?;
        let epoch = self.state().epoch;
        of_interpolation(self, (epoch, epoch))?;
        averaged.drift()
    }
}
