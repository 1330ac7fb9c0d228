//! Derivatives with respect to the six elements of an inertia tensor (theory §12).
//!
//! A product of inertia turns the principal axes by ψ = δI_ij/(I_i − I_j) about the third axis. Its derivative follows from those with respect to the state: the
//! attitude of the principal axes changes by ψ, and the rates about them by ω × ψ. This divides by the differences of the moments. Where one of them is small,
//! [`super::expansion`] serves; in steady rotation the varied equations are solved directly.

use nalgebra::{Matrix3, Quaternion, SMatrix, UnitQuaternion, Vector3};

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
    for index in 0..times.len() {
        let (turned, faster, now) = (matrix(&turned[index]), matrix(&faster[index]), Vector3::from(now[index]));
        for row in 0..3 {
            attitudes[index][row][..PARAMETERS].copy_from_slice(turned.row(row).transpose().as_slice());
            rates[index][row][..PARAMETERS].copy_from_slice(faster.row(row).transpose().as_slice());
        }
        for (column, (i, j)) in ELEMENTS.into_iter().enumerate().skip(3) {
            let (i, j) = if (i + 1) % 3 == j { (i, j) } else { (j, i) };
            let axis = Vector3::ith(3 - i - j, 1.0 / (moments[i] - moments[j]));
            let pushed = start.cross(&axis);
            let by_attitude = turned.fixed_columns::<3>(0) * axis + turned.fixed_columns::<3>(3) * pushed - axis;
            let by_rates = faster.fixed_columns::<3>(3) * pushed + axis.cross(&now);
            for row in 0..3 {
                (attitudes[index][row][6 + column], rates[index][row][6 + column]) = (by_attitude[row], by_rates[row]);
            }
        }
    }
    Ok(())
}

fn matrix<const N: usize>(rows: &Derivatives<N>) -> SMatrix<f64, 3, N> {
    SMatrix::from_fn(|row, column| rows[row][column])
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

/// Transforms derivatives from the principal axes to the user's: the vector, the parameters that are vectors, and the elements of the tensor.
pub(super) fn turn(axes: &Matrix3<f64>, derivatives: &mut Derivatives<INERTIA_PARAMETERS>) {
    let mut turned = axes * matrix(derivatives);
    for first in [0, 3] {
        let block = turned.fixed_columns::<3>(first) * axes.transpose();
        turned.fixed_columns_mut::<3>(first).copy_from(&block);
    }
    // A unit of the element k l of the user's tensor changes the element i j about the principal axes by the sum of A_ki A_lj over both orders.
    let weights = SMatrix::<f64, 6, 6>::from_fn(|element, user| {
        let ((i, j), (k, l)) = (ELEMENTS[element], ELEMENTS[user]);
        let one = axes[(k, i)] * axes[(l, j)];
        if k == l { one } else { one + axes[(l, i)] * axes[(k, j)] }
    });
    let elements = turned.fixed_columns::<6>(6) * weights;
    turned.fixed_columns_mut::<6>(6).copy_from(&elements);
    for (row, values) in derivatives.iter_mut().enumerate() {
        for (column, value) in values.iter_mut().enumerate() {
            *value = turned[(row, column)];
        }
    }
}
