//! Derivatives with respect to the six elements of an inertia tensor (theory §12).
//!
//! A product of inertia turns the principal axes by ψ = δI_ij/(I_i − I_j) about the third axis. Its derivative follows from those with respect to the state: the
//! attitude of the principal axes changes by ψ, and the rates about them by ω × ψ. This divides by the differences of the moments. Where one of them is small,
//! [`super::expansion`] serves; in steady rotation the varied equations are solved directly.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use super::constants::Setting;
use super::displacement::{Displacement, ELEMENTS, Response, Writer};
use super::evaluate::Target;
use super::steady::Varied;
use super::{Derivatives, INERTIA_PARAMETERS, PARAMETERS, differences, expansion, steady};
use crate::error::Error;
use crate::motion::solved::Motion;
use crate::motion::trajectory::Trajectory;
use crate::solve::untruncated;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::Polhode;

type Output<'a> = (&'a mut [Derivatives<INERTIA_PARAMETERS>], &'a mut [Derivatives<INERTIA_PARAMETERS>]);

/// Derivatives about the principal axes, with respect to the elements of the tensor about them.
pub(super) fn about_principal_axes(
    motion: &Motion,
    epoch: f64,
    times: &[f64],
    (attitudes, rates): Output<'_>,
) -> Result<(), Error> {
    if matches!(motion.trajectory, Trajectory::Integrated(_) | Trajectory::Gradient(_)) {
        return differences::fill(motion, &motion.in_scene(epoch, times), attitudes, rates);
    }
    let Some(polhode) = Polhode::new(motion.scene.body(), motion.scene.state()) else {
        steady::at_rest(times, epoch, attitudes, rates);
        return Ok(());
    };
    let mode = motion.plan.mode();
    if mode == Mode::Separatrix {
        return Err(Error::SeparatrixPartials);
    }
    let setting = &Setting::new(&polhode, motion.scene.body().moments());
    let target = Target { times, epoch, initial: motion.scene.state().attitude, setting };
    if let Trajectory::Steady(_) = motion.trajectory {
        let varied = Varied::new(&polhode, setting, mode);
        varied.valid(motion, epoch, times)?;
        return steadily(motion, &polhode, target, &varied, (attitudes, rates));
    }
    if polhode.has_small_divisor(true) {
        return expansion::fill(motion, &polhode, target, (attitudes, rates));
    }
    let exact = untruncated(&motion.scene, &polhode, mode)?;
    by_turned_axes(&exact, epoch, times, (attitudes, rates))
}

/// The columns of the products of inertia from those of the state, for three different moments.
fn by_turned_axes(motion: &Motion, epoch: f64, times: &[f64], (attitudes, rates): Output<'_>) -> Result<(), Error> {
    let zero = [[0.0; PARAMETERS]; 3];
    let (mut turned, mut faster) = (vec![zero; times.len()], vec![zero; times.len()]);
    motion.partials_about_principal_axes(epoch, times, &mut turned, &mut faster)?;
    let (_, now) = motion.samples_about_principal_axes(epoch, times)?;
    let (moments, start) = (motion.scene.body().moments(), motion.scene.state().angular_velocity);
    // ψ for a unit of each product of inertia, and ω × ψ at the epoch.
    let turns: [[Vector3<f64>; 2]; 3] = std::array::from_fn(|product| {
        let (row, column) = ELEMENTS[3 + product];
        let (i, j) = if (row + 1) % 3 == column { (row, column) } else { (column, row) };
        let turn = Vector3::ith(3 - i - j, 1.0 / (moments[i] - moments[j]));
        [turn, start.cross(&turn)]
    });
    for index in 0..times.len() {
        let ([by_attitude, by_rates], spun) = (blocks(&turned[index]), blocks(&faster[index])[1]);
        let now = Vector3::from(now[index]);
        let columns = turns
            .map(|[turn, pushed]| (by_attitude * turn + by_rates * pushed - turn, spun * pushed + turn.cross(&now)));
        for row in 0..3 {
            attitudes[index][row][..PARAMETERS].copy_from_slice(&turned[index][row]);
            rates[index][row][..PARAMETERS].copy_from_slice(&faster[index][row]);
            for (column, (of_attitude, of_rates)) in columns.iter().enumerate() {
                attitudes[index][row][PARAMETERS + column] = of_attitude[row];
                rates[index][row][PARAMETERS + column] = of_rates[row];
            }
        }
    }
    Ok(())
}

/// The columns of the attitude and those of the rates.
fn blocks(rows: &Derivatives) -> [Matrix3<f64>; 2] {
    [0, 3].map(|first| Matrix3::from_fn(|row, column| rows[row][first + column]))
}

/// Derivatives of a steady rotation.
fn steadily(
    motion: &Motion,
    polhode: &Polhode,
    target: Target<'_>,
    varied: &Varied,
    (attitudes, rates): Output<'_>,
) -> Result<(), Error> {
    let displacements = &Displacement::all(polhode, target.setting);
    let writer = Writer { polhode, setting: target.setting, displacements };
    let (turned, _) = motion.samples_about_principal_axes(target.epoch, target.times)?;
    for (index, time) in target.times.iter().enumerate() {
        let attitude = UnitQuaternion::new_unchecked(Quaternion::from(turned[index]));
        let carried = (attitude.inverse() * target.initial).to_rotation_matrix().into_inner();
        let [once, twice, elapsed] = varied.numbers(*time, target.epoch, target.setting);
        let response = Response {
            direction: target.setting.direction,
            changes: displacements.map(|displacement| steady::change(target.setting, &displacement, [once, twice])),
            along: displacements.map(|displacement| displacement.turn(target.setting) * elapsed),
        };
        writer.write(&carried, &response, &mut attitudes[index], &mut rates[index]);
    }
    Ok(())
}

/// The transformation from the principal axes to the user's.
pub(super) struct Turn {
    /// The principal axes, as columns.
    axes: [[f64; 3]; 3],
    /// Changes of the parameters about the principal axes, as rows, for a unit of each of the user's parameters.
    parameters: [[f64; INERTIA_PARAMETERS]; INERTIA_PARAMETERS],
}

impl Turn {
    /// The transformation for principal axes A as columns. A unit of the user's element k l changes the element i j by A_ki A_lj, summed over both orders of k
    /// and l.
    pub(super) fn new(axes: &Matrix3<f64>) -> Self {
        let mut parameters = [[0.0; INERTIA_PARAMETERS]; INERTIA_PARAMETERS];
        for i in 0..3 {
            for k in 0..3 {
                (parameters[i][k], parameters[3 + i][3 + k]) = (axes[(k, i)], axes[(k, i)]);
            }
        }
        for (element, (i, j)) in ELEMENTS.into_iter().enumerate() {
            for (user, (k, l)) in ELEMENTS.into_iter().enumerate() {
                let one = axes[(k, i)] * axes[(l, j)];
                parameters[6 + element][6 + user] = if k == l { one } else { one + axes[(l, i)] * axes[(k, j)] };
            }
        }
        Self { axes: std::array::from_fn(|row| std::array::from_fn(|column| axes[(row, column)])), parameters }
    }

    /// Transforms the vector, the parameters that are vectors, and the elements of the tensor. The sums are over whole rows, which vectors of any width hold.
    pub(super) fn apply(&self, derivatives: &mut Derivatives<INERTIA_PARAMETERS>) {
        let mut turned = [[0.0; INERTIA_PARAMETERS]; 3];
        for (row, axes) in turned.iter_mut().zip(&self.axes) {
            for (given, axis) in derivatives.iter().zip(axes) {
                for (sum, value) in row.iter_mut().zip(given) {
                    *sum += axis * value;
                }
            }
        }
        for (row, values) in turned.iter().zip(derivatives) {
            let mut sums = [0.0; INERTIA_PARAMETERS];
            for (index, value) in row.iter().enumerate() {
                let block = [0..3, 3..6, 6..INERTIA_PARAMETERS][(index / 3).min(2)].clone();
                for (sum, weight) in sums[block.clone()].iter_mut().zip(&self.parameters[index][block]) {
                    *sum += value * weight;
                }
            }
            *values = sums;
        }
    }
}
