//! Derivatives with respect to the six elements of an inertia tensor (theory §12).
//!
//! A product of inertia turns the principal axes by ψ = δI_ij/(I_i − I_j) about the third axis. Its derivative follows from those with respect to the state: the
//! attitude of the principal axes changes by ψ, and the rates about them by ω × ψ. This divides by the differences of the moments. Where one of them is small,
//! [`super::expansion`] serves; in steady rotation the varied equations are solved directly.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use pulp::Arch;

use super::constants::Setting;
use super::derivatives::{Derivatives, INERTIA_PARAMETERS, PARAMETERS};
use super::displacement::{Displacement, ELEMENTS, Response, Writer};
use super::evaluate::Target;
use super::steady::Varied;
use super::{expansion, steady};
use crate::error::Error;
use crate::motion::solved::Motion;
use crate::motion::trajectory::Trajectory;
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::Polhode;

type Output<'a> = (&'a mut [Derivatives<INERTIA_PARAMETERS>], &'a mut [Derivatives<INERTIA_PARAMETERS>]);

/// Fills the derivatives about the user's axes.
pub(super) fn fill(motion: &Motion, epoch: f64, times: &[f64], (attitudes, rates): Output<'_>) -> Result<(), Error> {
    let given = motion.given.as_ref().map(|given| given.turn.to_rotation_matrix().into_inner());
    let axes = given.unwrap_or_else(Matrix3::identity);
    let wobbles = matches!(motion.trajectory, Trajectory::Wobble(_) | Trajectory::Passage(_));
    let polhode = || Polhode::of(&motion.scene);
    if wobbles && polhode().is_some_and(|polhode| !polhode.has_small_divisor(true)) {
        return by_turned_axes(motion, epoch, times, &axes, (attitudes, rates));
    }
    about_principal_axes(motion, epoch, times, (&mut *attitudes, &mut *rates))?;
    if given.is_some() {
        let map = Map { axes: rows(&axes), weights: changes(&axes) };
        attitudes.iter_mut().chain(rates).for_each(|derivatives| *derivatives = map.apply(derivatives));
    }
    Ok(())
}

/// Derivatives about the principal axes, with respect to the elements of the tensor about them, where the closed form of the wobble does not serve.
fn about_principal_axes(
    motion: &Motion,
    epoch: f64,
    times: &[f64],
    (attitudes, rates): Output<'_>,
) -> Result<(), Error> {
    let Some(polhode) = Polhode::of(&motion.scene) else {
        steady::at_rest(times, epoch, attitudes, rates);
        return Ok(());
    };
    let mode = motion.plan.mode();
    if mode == Mode::Separatrix {
        return Err(Error::SeparatrixPartials);
    }
    let setting = &Setting::new(&polhode, motion.scene.body().moments());
    let target = Target { times, epoch, initial: motion.scene.state().attitude, setting };
    match motion.trajectory {
        Trajectory::Steady(_) => {
            let varied = Varied::new(&polhode, setting, mode);
            varied.valid(motion, epoch, times)?;
            steadily(motion, &polhode, target, &varied, (attitudes, rates))
        }
        _ => expansion::fill(motion, &polhode, target, (attitudes, rates)),
    }
}

/// The derivatives about the user's axes from those with respect to the state and the principal moments, for three different moments.
fn by_turned_axes(
    motion: &Motion,
    epoch: f64,
    times: &[f64],
    axes: &Matrix3<f64>,
    (attitudes, rates): Output<'_>,
) -> Result<(), Error> {
    motion.partials_about_principal_axes(epoch, times, narrow(attitudes), narrow(rates))?;
    let (moments, start) = (Vector3::from(motion.scene.body().moments()), motion.scene.state().angular_velocity);
    let changes = changes(axes);
    let mut weights: [[f64; INERTIA_PARAMETERS]; PARAMETERS] = std::array::from_fn(|row| changes[row]);
    let mut turns = [[0.0; INERTIA_PARAMETERS]; 3];
    for (product, (row, column)) in ELEMENTS.into_iter().enumerate().skip(3) {
        let (i, j) = if (row + 1) % 3 == column { (row, column) } else { (column, row) };
        let turn = Vector3::ith(3 - i - j, 1.0 / (moments[i] - moments[j]));
        let (pushed, turned) = (start.cross(&turn), axes * turn);
        for (parameter, change) in changes[6 + product].iter().enumerate() {
            for axis in 0..3 {
                weights[axis][parameter] += turn[axis] * change;
                weights[3 + axis][parameter] += pushed[axis] * change;
                turns[axis][parameter] += turned[axis] * change;
            }
        }
    }
    let map = Map { axes: rows(axes), weights };
    let by_moments = rows(&(axes * Matrix3::from_diagonal(&moments.map(|moment| 1.0 / moment))));
    let momentum = moments.component_mul(&start).into();
    dispatch(Arch::new(), Widen { map, turns, by_moments, momentum, attitudes, rates });
    Ok(())
}

/// Replaces the narrow matrices of two outputs by those about the user's axes, compiled for each instruction set.
struct Widen<'a> {
    map: Map<PARAMETERS>,
    /// ψ in the user's components for a unit of each parameter.
    turns: [[f64; INERTIA_PARAMETERS]; 3],
    /// The principal axes as columns, each divided by its moment.
    by_moments: [[f64; 3]; 3],
    /// The angular momentum at the epoch about the principal axes.
    momentum: [f64; 3],
    attitudes: &'a mut [Derivatives<INERTIA_PARAMETERS>],
    rates: &'a mut [Derivatives<INERTIA_PARAMETERS>],
}

impl Task for Widen<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: InstructionSet>(self, _: S) {
        let Self { map, turns, by_moments, momentum, attitudes, rates } = self;
        // From the last time to the first: a wider matrix takes the place of narrow ones that were read before.
        for index in (0..attitudes.len()).rev() {
            let (turned, faster) = (narrow(attitudes)[index], narrow(rates)[index]);
            // The first columns of the attitude are RᵀR0, which carries the angular momentum.
            let [[a, b, c, ..], [d, e, f, ..], [g, h, i, ..]] = turned;
            let now = product(&by_moments, product(&[[a, b, c], [d, e, f], [g, h, i]], momentum));
            let (mut attitude, mut rate) = (map.apply(&turned), map.apply(&faster));
            for row in 0..3 {
                let (next, last) = ((row + 1) % 3, (row + 2) % 3);
                for parameter in 0..INERTIA_PARAMETERS {
                    attitude[row][parameter] -= turns[row][parameter];
                    rate[row][parameter] += turns[next][parameter] * now[last] - turns[last][parameter] * now[next];
                }
            }
            (attitudes[index], rates[index]) = (attitude, rate);
        }
    }
}

/// The first part of an output, as matrices of nine columns. A buffer of its own would take as long as the derivatives, for the page faults of its memory.
#[inline(always)]
fn narrow(output: &mut [Derivatives<INERTIA_PARAMETERS>]) -> &mut [Derivatives] {
    let count = output.len();
    let (rows, _) = output.as_flattened_mut().as_flattened_mut().as_chunks_mut::<PARAMETERS>();
    let (matrices, _) = rows.as_chunks_mut::<3>();
    &mut matrices[..count]
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

/// The map from derivatives with N parameters about the principal axes to those about the user's axes.
struct Map<const N: usize> {
    /// The principal axes, as columns.
    axes: [[f64; 3]; 3],
    /// Changes of the N parameters, as rows, for a unit of each of the user's parameters.
    weights: [[f64; INERTIA_PARAMETERS]; N],
}

impl<const N: usize> Map<N> {
    #[inline(always)]
    #[allow(
        clippy::needless_range_loop,
        reason = "compilers do not always inline iterators into code for an instruction set"
    )]
    fn apply(&self, derivatives: &Derivatives<N>) -> Derivatives<INERTIA_PARAMETERS> {
        let mut mapped = [[0.0; INERTIA_PARAMETERS]; 3];
        for column in 0..N {
            let [x, y, z] = derivatives;
            let value = product(&self.axes, [x[column], y[column], z[column]]);
            for row in 0..3 {
                for parameter in 0..INERTIA_PARAMETERS {
                    mapped[row][parameter] += value[row] * self.weights[column][parameter];
                }
            }
        }
        mapped
    }
}

/// Changes of the parameters about the principal axes, as rows, for a unit of each of the user's parameters. A unit of the user's element k l changes the element
/// i j by A_ki A_lj, summed over both orders of k and l, with the principal axes as columns of A.
fn changes(axes: &Matrix3<f64>) -> [[f64; INERTIA_PARAMETERS]; INERTIA_PARAMETERS] {
    let mut changes = [[0.0; INERTIA_PARAMETERS]; INERTIA_PARAMETERS];
    for i in 0..3 {
        for k in 0..3 {
            (changes[i][k], changes[3 + i][3 + k]) = (axes[(k, i)], axes[(k, i)]);
        }
    }
    for (element, (i, j)) in ELEMENTS.into_iter().enumerate() {
        for (user, (k, l)) in ELEMENTS.into_iter().enumerate() {
            let one = axes[(k, i)] * axes[(l, j)];
            changes[6 + element][6 + user] = if k == l { one } else { one + axes[(l, i)] * axes[(k, j)] };
        }
    }
    changes
}

fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    matrix.transpose().into()
}

#[inline(always)]
fn product(matrix: &[[f64; 3]; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [one, two, three] = matrix;
    [
        one[0] * x + one[1] * y + one[2] * z,
        two[0] * x + two[1] * y + two[2] * z,
        three[0] * x + three[1] * y + three[2] * z,
    ]
}
