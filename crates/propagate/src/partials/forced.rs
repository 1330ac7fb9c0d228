//! Derivatives of motions under torques: by the variational equations of an integration, or, far from the epoch of an averaged motion, by differences.

use nalgebra::{Matrix3, Vector3};

use super::derivatives::{Derivatives, PARAMETERS};
use super::differences;
use super::displacement::ELEMENTS;
use super::parameters::Parameter;
use crate::error::Error;
use crate::integration::columns::{ForcedColumn, PartialsRows};
use crate::integration::variation;
use crate::motion::batch::Batch;
use crate::motion::solved::Motion;
use crate::motion::trajectory::Trajectory;

/// Beyond so many steps the derivatives of an averaged motion are differences of solved motions: four for each column.
const MOST_STEPS: f64 = 2.5e3;

impl Motion {
    /// Whether these derivatives need the variational equations with torques: those of a motion under torques, and those of a sphere with respect to its moments
    /// where a body attracts it. No torque acts on the sphere, but one acts on a body beside it.
    pub(super) fn varies_under_torques(&self, parameters: &[Parameter]) -> bool {
        let attracted = !self.scene.asked_disturbing().is_empty();
        matches!(self.trajectory, Trajectory::Forced(_)) || attracted && parameters.contains(&Parameter::Moments)
    }
}

impl Batch<'_> {
    /// The derivatives of a motion under torques with respect to chosen parameters, (n, 3, columns).
    pub(super) fn forced(
        &self,
        parameters: &[Parameter],
        times: &[f64],
        outputs: PartialsRows<'_>,
    ) -> Result<(), Error> {
        let by_elements = self.motion().scene().body().has_tensor();
        self.by_columns(&columns(self.motion(), parameters, by_elements)?, times, outputs)
    }

    /// The derivatives of a motion under torques as matrices, with respect to the state and to the moments, N = 9, or to the elements of the tensor, N = 12.
    pub(super) fn forced_matrices<const N: usize>(
        &self,
        times: &[f64],
        attitudes: &mut [Derivatives<N>],
        rates: &mut [Derivatives<N>],
    ) -> Result<(), Error> {
        let parameters = [Parameter::Attitude, Parameter::AngularVelocity, Parameter::Moments];
        let columns = columns(self.motion(), &parameters, N != PARAMETERS)?;
        let outputs = [attitudes, rates].map(|matrices| matrices.as_flattened_mut().as_flattened_mut());
        self.by_columns(&columns, times, outputs)
    }

    fn by_columns(&self, columns: &[ForcedColumn], times: &[f64], mut outputs: PartialsRows<'_>) -> Result<(), Error> {
        let motion = self.motion();
        motion.valid(times, self.epoch())?;
        let in_scene = motion.in_scene(self.epoch(), times);
        let ends = [f64::min, f64::max].map(|end| in_scene.iter().copied().fold(motion.scene.state().epoch, end));
        let scene = motion.scene.clone().span(ends[0], ends[1]);
        let own = outputs.each_mut().map(|output| &mut **output);
        if let Some(averaging) = motion.plan.averaging()
            && variation::steps(&scene) > MOST_STEPS
        {
            differences::fill((motion, averaging), columns, &in_scene, own, self.stop())?;
        } else {
            variation::fill(&scene, columns, &in_scene, own, self.stop())?;
        }
        if let Some(given) = &motion.given {
            let axes = given.turn.to_rotation_matrix().into_inner();
            outputs.iter_mut().for_each(|output| turn(&axes, columns.len(), output));
        }
        self.held(times, 3 * columns.len(), outputs.each_ref().map(|output| &**output))
    }

    /// Whether doubles hold the derivatives at all times: those by the moments of a sphere next to a strong attraction may overflow where the motion is that of a free body.
    fn held(&self, times: &[f64], numbers: usize, outputs: [&[f64]; 2]) -> Result<(), Error> {
        let finite = |index: usize| {
            let rows = outputs.map(|output| &output[numbers * index..numbers * (index + 1)]);
            rows.into_iter().flatten().all(|derivative| derivative.is_finite())
        };
        let Some(index) = (0..times.len()).find(|index| !finite(*index)) else { return Ok(()) };
        let distance = |index: usize| (times[index] - self.epoch()).abs();
        let nearer = (0..times.len()).filter(|other| distance(*other) < distance(index) && finite(*other));
        let bound = nearer.map(distance).fold(0.0, f64::max);
        let reason = ": farther away a derivative may overflow a double";
        Err(self.motion().too_far((index, times[index]), self.epoch(), bound, reason))
    }
}

/// The columns of some parameters in the axes of the scene. `by_elements`: those of the body are the elements of its tensor about the user's axes.
fn columns(motion: &Motion, parameters: &[Parameter], by_elements: bool) -> Result<Vec<ForcedColumn>, Error> {
    let axes =
        motion.given.as_ref().map_or_else(Matrix3::identity, |given| given.turn.to_rotation_matrix().into_inner());
    let axis = |k: usize| axes.row(k).transpose();
    let element = |(i, j): (usize, usize)| {
        let product = axis(i) * axis(j).transpose();
        if i == j { product } else { product + product.transpose() }
    };
    let mut columns = Vec::new();
    for parameter in parameters {
        match *parameter {
            Parameter::Attitude => columns.extend((0..3).map(|k| ForcedColumn::Attitude(axis(k)))),
            Parameter::AngularVelocity => columns.extend((0..3).map(|k| ForcedColumn::AngularVelocity(axis(k)))),
            Parameter::Moments if by_elements => {
                columns.extend(ELEMENTS.map(|place| ForcedColumn::Inertia(element(place))))
            }
            Parameter::Moments => {
                let moment = |k: usize| ForcedColumn::Inertia(Matrix3::from_diagonal(&Vector3::ith(k, 1.0)));
                columns.extend((0..3).map(moment));
            }
            Parameter::Orbit(body) => columns.extend((0..6).map(|element| ForcedColumn::Element(body, element))),
            Parameter::Attraction(body) => columns.push(ForcedColumn::Attraction(body)),
            Parameter::Torque(index) => {
                let own = motion.scene().asked_torques()[index].parameters()?;
                let axes = motion.scene().body().precise_axes();
                columns.extend(own.into_iter().map(|(_, torque)| ForcedColumn::Torque(torque.turned(&axes))));
            }
        }
    }
    Ok(columns)
}

/// Turns the vectors of all columns from the scene's axes to the user's.
fn turn(axes: &Matrix3<f64>, columns: usize, output: &mut [f64]) {
    for rows in output.chunks_mut(3 * columns) {
        for column in 0..columns {
            let turned = axes * Vector3::from_fn(|axis, _| rows[axis * columns + column]);
            (0..3).for_each(|axis| rows[axis * columns + column] = turned[axis]);
        }
    }
}
