//! The parameters that change the polhode, and the matrices of derivatives from their effects (theory §12).
//!
//! Unlike [`super::matrices`], which computes ordinary motions in lanes, this module serves any symmetric change of the inertia tensor. It serves the motions of
//! [`super::expansion`] and the tensors of steady rotations. All quantities are on the sorted axes, in units of M = 1 and of the scaled time.

use nalgebra::{Matrix3, Vector3};

use super::constants::Setting;
use super::derivatives::{Derivatives, PARAMETERS};
use crate::numerics::scaling::scaled;
use crate::torque_free::polhode::Polhode;

/// Parameters that change the polhode of a body with a tensor: three rates at the epoch, six elements of the tensor.
pub(super) const DISPLACEMENTS: usize = 9;
/// Rows and columns of the six elements of a symmetric matrix, in the order of the parameters.
pub(super) const ELEMENTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// A parameter and its effect for a unit of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Displacement {
    /// δg at the epoch.
    pub(super) step: [f64; 3],
    /// The change of M I⁻¹, a symmetric matrix that is diagonal with the elements ν_i before the change.
    pub(super) rates: [[f64; 3]; 3],
    /// Factor from the derivative in scaled units to that in the user's units.
    unit: f64,
}

impl Displacement {
    /// The displacements of the rates at the epoch and of the tensor's elements about the principal axes in the order of the body, of which the first six are
    /// those of a body given by moments.
    pub(super) fn all(polhode: &Polhode, setting: &Setting) -> [Self; DISPLACEMENTS] {
        let place = |axis: usize| setting.axes.iter().position(|user| *user == axis).unwrap_or(axis);
        std::array::from_fn(|index| match setting.changes.get(index) {
            Some(change) => {
                let [step, rates] = change.vectors();
                let rates = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { rates[i] } else { 0.0 }));
                Self { step, rates, unit: change.unit }
            }
            None => {
                let (row, column) = ELEMENTS[index - 3];
                Self::off_diagonal(polhode, setting, [place(row), place(column)])
            }
        })
    }

    /// A product of inertia: δG = δI ω and δ(I⁻¹) = −I⁻¹ δI I⁻¹.
    fn off_diagonal(polhode: &Polhode, setting: &Setting, [i, j]: [usize; 2]) -> Self {
        let Polhode { frame, moments, scales, .. } = polhode;
        let sign = frame.signs[i] * frame.signs[j];
        let (mut step, mut rates) = ([0.0; 3], [[0.0; 3]; 3]);
        step[i] = sign * setting.direction[j] / moments[j];
        step[j] = sign * setting.direction[i] / moments[i];
        rates[i][j] = -sign * setting.rates[i] / moments[j];
        rates[j][i] = rates[i][j];
        Self { step, rates, unit: scaled(1.0, -scales.0) }
    }

    /// Half of the second-order form of M δ(I⁻¹): ½ Σ δν_ij p_ij, for the six products p of the components of a vector.
    pub(super) fn half_form(&self, products: &[f64; 6]) -> f64 {
        let weight = |(i, j): (usize, usize)| if i == j { 0.5 } else { 1.0 };
        ELEMENTS.into_iter().zip(products).map(|((i, j), product)| weight((i, j)) * self.rates[i][j] * product).sum()
    }

    /// The change of the energy: g·(ν δg + ½ δν g) at the epoch.
    pub(super) fn energy(&self, setting: &Setting) -> f64 {
        let g = setting.direction;
        let by_step: f64 = (0..3).map(|i| setting.rates[i] * g[i] * self.step[i]).sum();
        by_step + self.half_form(&products(g))
    }

    /// The growth of g·δθ in steady rotation.
    pub(super) fn turn(&self, setting: &Setting) -> f64 {
        self.energy(setting) + self.half_form(&products(setting.direction))
    }

    /// M δ(I⁻¹) g.
    pub(super) fn faster(&self, g: [f64; 3]) -> [f64; 3] {
        self.rates.map(|row| row[0] * g[0] + row[1] * g[1] + row[2] * g[2])
    }
}

/// The products g_i g_j in the order of [`ELEMENTS`].
pub(super) fn products(g: [f64; 3]) -> [f64; 6] {
    ELEMENTS.map(|(i, j)| g[i] * g[j])
}

/// g at a time, and δg and g·δθ for each displacement.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response {
    pub(super) direction: [f64; 3],
    pub(super) changes: [[f64; 3]; DISPLACEMENTS],
    pub(super) along: [f64; DISPLACEMENTS],
}

/// Writes the matrices of derivatives about the principal axes.
pub(super) struct Writer<'a> {
    pub(super) polhode: &'a Polhode,
    pub(super) setting: &'a Setting,
    pub(super) displacements: &'a [Displacement; DISPLACEMENTS],
}

impl Writer<'_> {
    /// δθ = g × (RᵀR0 δg0 − δg) + g (g·δθ) and δω = ν δg + δν g, from `carried` = RᵀR0 in the user's components.
    pub(super) fn write<const N: usize>(
        &self,
        carried: &Matrix3<f64>,
        response: &Response,
        attitude: &mut Derivatives<N>,
        rates: &mut Derivatives<N>,
    ) {
        let Self { polhode, setting, displacements } = self;
        let user = |sorted: [f64; 3]| Vector3::from(polhode.frame.user(sorted));
        let direction = user(response.direction);
        for (row, (turned, faster)) in attitude.iter_mut().zip(rates.iter_mut()).enumerate() {
            for column in 0..3 {
                (turned[column], faster[column]) = (carried[(row, column)], 0.0);
            }
        }
        for (index, displacement) in displacements.iter().enumerate().take(N - 3) {
            let change = response.changes[index];
            let moved = carried * user(displacement.step) - user(change);
            let turned = (direction.cross(&moved) + direction * response.along[index]) * displacement.unit;
            let faster = displacement.faster(response.direction);
            let faster = user(std::array::from_fn(|i| setting.rates[i] * change[i] + faster[i])) * displacement.unit;
            for row in 0..3 {
                attitude[row][3 + index] = turned[row];
                rates[row][3 + index] = scaled(faster[row], polhode.scales.1);
            }
        }
    }
}

const _: () = assert!(DISPLACEMENTS + 3 > PARAMETERS);
