//! A torque of a rigid body that takes energy at constant angular momentum, in place of internal friction near the separatrix (weak torques §7).
//!
//! T = κ(h(h·ω) − ω h²) with the body's angular momentum h is across h, so |h| stays, and takes the power κ(h²ω² − (h·ω)²).

use super::averaged_scene::AveragedScene;
use super::polhode_means::ExcessPolhode;
use crate::error::Error;
use crate::input::scene::Scene;
use crate::input::torque::Torque;

/// Points of half a polhode at which the power is averaged.
const POINTS: usize = 256;

impl AveragedScene {
    /// A scene of the same body in whose torques internal friction is replaced by κ(h(h·ω) − ωh²) of the same mean power at its state.
    ///
    /// # Errors
    /// Those of the functions of the power.
    pub(super) fn with_friction(&self, scene: &Scene) -> Result<Scene, Error> {
        let size = self.momentum.norm();
        let moments = &self.equations.moments;
        let power = moments.z * self.equations.loss(size / moments.z, self.excess)?;
        let bare = scene.without_dissipation();
        if power == 0.0 {
            return Ok(bare);
        }
        let polhode = ExcessPolhode::new(moments, self.equations.family, self.excess);
        let of_unit = |point: usize| {
            let g = polhode.direction((std::f64::consts::PI * (point as f64 + 0.5) / POINTS as f64).sin_cos());
            g.cross(&g.component_div(moments)).norm_squared()
        };
        let mean = (0..POINTS).map(of_unit).sum::<f64>() / POINTS as f64 * size.powi(4);
        let torque = relaxing(power / mean, scene.body().inertia())?;
        let torques = bare.asked_torques().iter().cloned().chain([torque]);
        Ok(bare.clone().torques(torques.collect::<Vec<_>>()))
    }
}

/// κ(h(h·ω) − ωh²) as polynomials in the rates.
fn relaxing(factor: f64, inertia: [[f64; 3]; 3]) -> Result<Torque, Error> {
    let momentum = inertia.map(|row| {
        let parts = row.iter().enumerate().filter(|(_, part)| **part != 0.0);
        let parts: Vec<String> = parts.map(|(axis, part)| format!("({part:?})*w{}", axis + 1)).collect();
        format!("({})", parts.join(" + "))
    });
    let sum = |other: [String; 3]| {
        let terms: Vec<String> = momentum.iter().zip(&other).map(|(h, other)| format!("{h}*{other}")).collect();
        format!("({})", terms.join(" + "))
    };
    let along = sum([1, 2, 3].map(|axis| format!("w{axis}")));
    let square = sum(momentum.clone());
    let texts = [0, 1, 2].map(|axis| format!("({factor:?})*({}*{along} - w{}*{square})", momentum[axis], axis + 1));
    Torque::polynomial(texts.each_ref().map(String::as_str), Vec::new())
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    #[test]
    fn the_relaxing_torque_is_across_the_momentum_and_takes_energy() {
        let inertia = [[1.0, 0.1, 0.0], [0.1, 1.5, 0.2], [0.0, 0.2, 2.0]];
        let Torque::Polynomial(torque) = relaxing(0.3, inertia).expect("polynomials") else { unreachable!() };
        let w = Vector3::<f64>::new(0.3, -0.7, 1.1);
        let value = torque.terms().each_ref().map(|terms| {
            let term = |(c, powers): &(f64, Vec<u32>)| {
                c * (0..3).map(|axis| w[axis].powi(powers[axis] as i32)).product::<f64>()
            };
            terms.iter().map(term).sum::<f64>()
        });
        let h = nalgebra::Matrix3::from_fn(|i, k| inertia[i][k]) * w;
        let expected = (h * h.dot(&w) - w * h.norm_squared()) * 0.3;
        assert!((Vector3::from(value) - expected).norm() < 1e-14);
        assert!(expected.dot(&h).abs() < 1e-14 && expected.dot(&w) < 0.0);
    }
}
