//! The loss of a body of a material in a state: its power, its rate and its harmonics (docs/relaxation.md, equations 11, 16).

use nalgebra::Matrix6;

use super::elastic::{Elastic, StrainEnergy};
use super::harmonics::{Load, ModeAxes, Swing};
use super::material::{Material, positive, refused};
use super::size::{Size, flat, given, shape};
use crate::error::Error;
use crate::input::body::{Body, SAME_RATIO};
use crate::input::energy_loss::{EnergyLoss, LossState};
use crate::input::scene::Scene;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::Polhode;

/// One harmonic of the load, from [`Dissipation::harmonics`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadHarmonic {
    /// m, the multiple of dℓ′/dt.
    pub multiple: u32,
    /// m dℓ′/dt \[rad per unit of time\].
    pub frequency: f64,
    /// W_m, the sum over the components of the load of the peak strain energies. The mean energy is half of it.
    pub energy: f64,
    /// f χ(f) W_m, the loss of energy in the unit of time.
    pub power: f64,
}

/// A homogeneous, slightly inelastic ellipsoid that rotates freely.
///
/// The moments of the body count up to a factor: density and size give the moments in the units of the material. The unit of time of the scenes is that of the material.
///
/// ```
/// use andoyer_propagate::dissipation::{Dissipation, Loss, Material, Size};
/// use andoyer_propagate::{Body, Mode, Scene, State};
/// let body = Body::ellipsoid([1.0, 0.7, 0.5], 1.0)?;
/// let material = Material::new(1.0, 1.0)?.loss(Loss::Quality(1.0))?;
/// let dissipation = Dissipation::new(&body, Size::SemiAxes([1.0, 0.7, 0.5]), material)?;
/// // M/C = 1 and sin² of the largest angle from the short axis is 0.3: M = C (0, √0.3, √0.7).
/// let [_, b, c] = body.moments();
/// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, c / b * 0.3_f64.sqrt(), 0.7_f64.sqrt()])?;
/// let scene = Scene::new(body, state);
/// assert!((dissipation.power(&scene)? / 0.001_731_138_417_983_615_2 - 1.0).abs() < 1e-13);
/// assert!(dissipation.relax(&scene)?.time_to(0.1, Mode::ShortAxis)? > 0.0);
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Dissipation {
    body: Body,
    pub(super) material: Material,
    radius: f64,
    /// Over the radius.
    semi_axes: [f64; 3],
    elastic: Elastic,
    axes: [ModeAxes; 2],
}

/// A state of a scene: the rate M/C, and the polhode unless the body rests, rotates about a principal axis, or is on the separatrix.
pub(super) struct Tumbling {
    pub(super) mean_rate: f64,
    pub(super) swing: Option<Swing>,
    pub(super) separatrix: bool,
}

impl Dissipation {
    /// The dissipation of a body of this size and material.
    ///
    /// # Errors
    /// - [`Error::Positive`] for a radius or a semi-axis that is zero, negative or not finite.
    /// - [`Error::NoDissipation`] for a sphere.
    /// - [`Error::Dissipation`] for a body flatter than 1 : 1000, for semi-axes with other ratios than the moments need, and for units in which the moments or the strain
    ///   energy are no normal doubles.
    pub fn new(body: &Body, size: Size, material: Material) -> Result<Self, Error> {
        let moments = settled(body.moments());
        if moments.iter().all(|moment| *moment == moments[0]) {
            let reason = "a sphere has no polhode, and no harmonic loads it".to_owned();
            return Err(Error::NoDissipation { argument: "body", value: format!("{moments:?}"), reason });
        }
        let shape = shape(body)?;
        let (radius, semi_axes) = match size {
            Size::Radius(radius) => (radius, shape),
            Size::SemiAxes(axes) => given(axes, shape)?,
        };
        positive("radius", radius)?;
        let elastic = Elastic::new(semi_axes, material.poisson_ratio());
        let elastic = elastic.ok_or_else(|| flat(semi_axes))?;
        let axes = [false, true].map(|long_axis| ModeAxes::new(moments, long_axis));
        let dissipation = Self { body: body.clone(), material, radius, semi_axes, elastic, axes };
        let scales = [dissipation.moment_unit(), dissipation.energy_unit()];
        if scales.iter().all(|scale| scale.is_normal()) {
            return Ok(dissipation);
        }
        let bound = "such that density · radius⁵ and density² · radius⁷ / rigidity are normal doubles";
        Err(refused("radius", radius, bound))
    }

    /// The body.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The material.
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// (R1 R2 R3)^(1/3).
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The semi-axes along body axes 1, 2, 3.
    pub fn semi_axes(&self) -> [f64; 3] {
        self.semi_axes.map(|axis| axis * self.radius)
    }

    /// The moments of the homogeneous ellipsoid, in the order of [`Body::moments`] \[density · length⁵\].
    pub fn moments(&self) -> [f64; 3] {
        let largest = self.body.sorted()[2];
        self.body.moments().map(|moment| moment / largest * self.moment_unit())
    }

    /// The change of the inertia tensor in elastic equilibrium (equation 7): rows δI11, δI22, δI33, δI23, δI31, δI12 \[density · length⁵\], columns
    /// ω1², ω2², ω3², ω2ω3, ω3ω1, ω1ω2, about principal axes.
    pub fn inertia_response(&self) -> Matrix6<f64> {
        let StrainEnergy { products, squares } = self.elastic.whole;
        let mut response = Matrix6::zeros();
        response.fixed_view_mut::<3, 3>(0, 0).copy_from(&(squares * 2.0));
        for (k, product) in products.iter().enumerate() {
            response[(3 + k, 3 + k)] = *product;
        }
        response * self.energy_unit()
    }

    /// ϱ (M/C)² R1² / S with the longest semi-axis R1. The relative error of the power by theory of first order in the deformation is of this size, over the smallest
    /// relative difference of two moments that are not equal: a deformation changes the frequency of the wobble by as much.
    ///
    /// # Errors
    /// Those of [`Dissipation::power`] for a scene.
    pub fn compliance(&self, scene: &Scene) -> Result<f64, Error> {
        let longest = self.semi_axes.iter().copied().fold(0.0, f64::max);
        Ok(self.strain(self.tumbling(scene)?.mean_rate) * longest * longest)
    }

    /// The loss of energy in the unit of time, averaged over the polhode (equation 11). It is 0 at rest, about a principal axis, and on the separatrix.
    ///
    /// # Errors
    /// - [`Error::Dissipation`] for a scene of another body, a loss that is not positive and finite, or a power that overflows; the errors of [`Scene::validate`].
    /// - [`Error::NoDissipation`] for a material without a loss.
    pub fn power(&self, scene: &Scene) -> Result<f64, Error> {
        let Tumbling { mean_rate, swing, .. } = self.tumbling(scene)?;
        swing.map_or(Ok(0.0), |swing| self.power_at(swing, mean_rate))
    }

    /// dx/dt \[1/time\] of x = sin² of the largest angle θ between the angular momentum and the axis of the mode (equation 16): negative in the short-axis mode and
    /// positive in the long-axis mode. dθ/dt = (dx/dt)/sin 2θ.
    ///
    /// # Errors
    /// Those of [`Dissipation::power`].
    pub fn rate(&self, scene: &Scene) -> Result<f64, Error> {
        let Tumbling { mean_rate, swing, .. } = self.tumbling(scene)?;
        let Some(swing) = swing else { return Ok(0.0) };
        let axes = self.axes(swing.long_axis);
        // dx/dt = x (1 − x)/(dt/dy)
        let rate = swing.x * swing.complement / self.slope(&axes, swing, mean_rate)?;
        Ok(if swing.long_axis { rate } else { -rate })
    }

    /// The harmonics of the load with their shares of the power, down to 1e-17 of the largest; none at rest, about a principal axis, and on the separatrix.
    ///
    /// # Errors
    /// Those of [`Dissipation::power`].
    pub fn harmonics(&self, scene: &Scene) -> Result<Vec<LoadHarmonic>, Error> {
        let Tumbling { mean_rate, swing, .. } = self.tumbling(scene)?;
        let Some(swing) = swing else { return Ok(Vec::new()) };
        let found = Load::new(&self.axes(swing.long_axis), &self.lossy(), swing);
        let unit = self.energy_unit() * mean_rate.powi(4) * swing.x;
        let each = found.energies.iter().map(|&(multiple, energy)| {
            let (frequency, energy) = (f64::from(multiple) * found.rate * mean_rate, unit * energy);
            Ok(LoadHarmonic {
                multiple,
                frequency,
                energy,
                power: frequency * self.material.loss_at(frequency)? * energy,
            })
        });
        each.collect()
    }

    /// The axes in the order of a mode.
    pub(super) fn axes(&self, long_axis: bool) -> ModeAxes {
        self.axes[usize::from(long_axis)]
    }

    /// The loss of energy in the unit of time on a polhode.
    pub(super) fn power_at(&self, swing: Swing, mean_rate: f64) -> Result<f64, Error> {
        // On the separatrix of a symmetric body nothing oscillates.
        if swing.complement == 0.0 {
            return Ok(0.0);
        }
        let loss = self.loss(&self.axes(swing.long_axis), swing, mean_rate)?;
        let power = self.energy_unit() * mean_rate.powi(4) * swing.x * loss;
        if power.is_finite() {
            Ok(power)
        } else {
            Err(refused("angular_velocity", mean_rate, "such that the power is finite"))
        }
    }

    /// |dt/dy| of y = ln(x/(1 − x)) (equations 16 and 17).
    pub(super) fn slope(&self, axes: &ModeAxes, swing: Swing, mean_rate: f64) -> Result<f64, Error> {
        // |dx/dt| = 2P/(M² |1/B − 1/C|),  P = ϱ²R⁷/S (M/C)⁴ x loss,  M²/C = ϱR⁵ c (M/C)²
        let scaled = self.moment_unit() / (self.material.density() * self.radius.powi(5)) * axes.range.abs();
        let loss = 2.0 * self.strain(mean_rate) * self.loss(axes, swing, mean_rate)?;
        let slope = swing.complement * (scaled / loss);
        if slope.is_finite() {
            Ok(slope)
        } else {
            Err(refused("angular_velocity", mean_rate, "such that the times are finite"))
        }
    }

    /// Σ f χ(f) W_m/x in units of ϱ²R⁷/S (M/C)⁴ over the unit of time, f = m dℓ′/dt.
    fn loss(&self, axes: &ModeAxes, swing: Swing, mean_rate: f64) -> Result<f64, Error> {
        let Load { rate, energies } = Load::new(axes, &self.lossy(), swing);
        energies.iter().try_fold(0.0, |sum, &(multiple, energy)| {
            let frequency = f64::from(multiple) * rate * mean_rate;
            Ok(sum + frequency * self.material.loss_at(frequency)? * energy)
        })
    }

    /// The part of the strain energy that has a loss.
    fn lossy(&self) -> StrainEnergy {
        let Elastic { whole, bulk } = self.elastic;
        if !self.material.is_shear_only() {
            return whole;
        }
        let products = std::array::from_fn(|k| whole.products[k] - bulk.products[k]);
        StrainEnergy { products, squares: whole.squares - bulk.squares }
    }

    /// C of the homogeneous ellipsoid.
    fn moment_unit(&self) -> f64 {
        let [x, y, z] = self.semi_axes.map(|axis| axis * axis);
        let largest = (x + y).max(y + z).max(z + x);
        // C = ϱV (R1² + R2²)/5 with V = 4π/3 R³
        self.material.density() * self.radius.powi(5) * (4.0 * std::f64::consts::PI / 15.0) * largest
    }

    /// ϱ²R⁷/S.
    fn energy_unit(&self) -> f64 {
        let density = self.material.density();
        density * (density / self.material.rigidity()) * self.radius.powi(7)
    }

    /// ϱ R² (M/C)²/S.
    fn strain(&self, mean_rate: f64) -> f64 {
        let speed = self.radius * mean_rate;
        self.material.density() / self.material.rigidity() * speed * speed
    }

    /// The state of a scene of this body.
    pub(super) fn tumbling(&self, scene: &Scene) -> Result<Tumbling, Error> {
        let scene = scene.validated()?;
        if !scene.body().is_proportional(&self.body) {
            let reason = format!("this is the dissipation of a body with the moments {:?}", self.body.moments());
            let value = format!("a body with the moments {:?}", scene.body().moments());
            return Err(Error::NoDissipation { argument: "scene", value, reason });
        }
        let turn = scene.body().turn();
        let scene = turn.map_or(scene.clone(), |turn| scene.about_principal_axes(turn));
        let Some(polhode) = Polhode::new(&Body::new(settled(scene.body().moments()))?, scene.state()) else {
            return Ok(Tumbling { mean_rate: 0.0, swing: None, separatrix: false });
        };
        let mode = Mode::of(&polhode);
        let long_axis = polhode.long_axis;
        // M/C is the last rate in the order of the short-axis mode.
        let mean_rate = polhode.user_rates()[if long_axis { 0 } else { 2 }];
        let [x, complement] = [polhode.invariants.sine_squares[0], polhode.invariants.cosine_squares[0]];
        let swing = Swing { long_axis, x: x.to_f64(), complement: complement.to_f64() };
        let tumbles = matches!(mode, Mode::ShortAxis | Mode::LongAxis | Mode::Axisymmetric);
        Ok(Tumbling { mean_rate, swing: tumbles.then_some(swing), separatrix: mode == Mode::Separatrix })
    }
}

impl From<Dissipation> for EnergyLoss {
    fn from(dissipation: Dissipation) -> Self {
        let unit = dissipation.moment_unit();
        Self::of_body(dissipation.body.clone(), move |state: &LossState| {
            let x = state.excess / state.separatrix;
            if x == 0.0 {
                return Ok(0.0);
            }
            let swing = Swing { long_axis: state.long_axis, x, complement: 1.0 - x };
            Ok(dissipation.power_at(swing, state.rate)? / unit)
        })
    }
}

/// The moments, of which those that differ by the rounding of a tensor are equal: the modes of a symmetric body are others.
fn settled(mut moments: [f64; 3]) -> [f64; 3] {
    let largest = moments.into_iter().fold(0.0, f64::max);
    for (i, j) in [(0, 1), (1, 2), (0, 2)] {
        if (moments[i] - moments[j]).abs() <= SAME_RATIO * largest {
            moments[j] = moments[i];
        }
    }
    moments
}
