//! Some members of an ensemble as an ensemble.

use std::sync::atomic::AtomicBool;

use pyo3::prelude::*;
use pyo3::types::PySlice;

use super::Ensemble;
use super::arguments::asked;
use crate::error;

impl Ensemble {
    /// The members of a slice.
    pub(super) fn part(&self, slice: &Bound<'_, PySlice>) -> PyResult<Self> {
        let range = slice.indices(self.0.len() as isize)?;
        let chosen: Vec<usize> =
            (0..range.slicelength as isize).map(|k| (range.start + k * range.step) as usize).collect();
        let moments = chosen.iter().map(|&member| self.0.moments()[member]).collect();
        let attitudes = chosen.iter().map(|&member| self.0.attitudes()[member]).collect();
        let rates = chosen.iter().map(|&member| self.0.angular_velocities()[member]).collect();
        let (on_error, going) = (self.0.asked_on_error(), AtomicBool::new(false));
        let part = andoyer_propagate::Ensemble::new_or(moments, attitudes, rates, on_error, &going)
            .map_err(error::propagation)?
            .tolerance(self.0.asked_tolerance());
        let part = match self.0.asked_epochs() {
            [] => Ok(part),
            [of_all] => part.epochs(vec![*of_all]),
            each => part.epochs(chosen.iter().map(|&member| each[member]).collect()),
        }
        .map_err(error::propagation)?;
        let calendar = match &self.1[..] {
            [] | [_] => self.1.clone(),
            each => chosen.iter().map(|&member| each[member]).collect(),
        };
        let orbits = match self.0.asked_orbits() {
            [] => None,
            [of_all] => Some(vec![*of_all]),
            each => Some(chosen.iter().map(|&member| each[member]).collect()),
        };
        asked(part, orbits, self.0.asked_span(), self.0.asked_threads())
            .map(|part| Self(part, calendar))
            .map_err(error::propagation)
    }
}
