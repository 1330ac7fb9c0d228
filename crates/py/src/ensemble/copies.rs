//! Copies of `andoyer.Ensemble`: some of its members, the arguments that make it anew, and its text.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::options::Method;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySlice, PyTuple};

use super::Ensemble;
use super::arguments::asked;
use crate::computing::detached;
use crate::error;
use crate::foreign;
use crate::motion::Motion;
use crate::orbit::Orbit;

impl Ensemble {
    /// The members of a slice.
    pub(super) fn part(&self, slice: &Bound<'_, PySlice>) -> PyResult<Self> {
        let range = slice.indices(self.0.len() as isize)?;
        let chosen: Vec<usize> =
            (0..range.slicelength as isize).map(|k| (range.start + k * range.step) as usize).collect();
        let attitudes = chosen.iter().map(|&member| self.0.attitudes()[member]).collect();
        let rates = chosen.iter().map(|&member| self.0.angular_velocities()[member]).collect();
        let (on_error, going) = (self.0.asked_on_error(), AtomicBool::new(false));
        let part = if self.0.asked_tensors().is_empty() {
            let moments = chosen.iter().map(|&member| self.0.moments()[member]).collect();
            andoyer_propagate::Ensemble::new_or(moments, attitudes, rates, on_error, &going)
        } else {
            let tensors = chosen.iter().map(|&member| self.0.asked_tensors()[member]).collect();
            andoyer_propagate::Ensemble::from_inertia_or(tensors, attitudes, rates, on_error, &going)
        };
        let part = part.map_err(error::propagation)?.tolerance(self.0.asked_tolerance()).method(self.0.asked_method());
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

    /// Positional and keyword arguments of the constructor.
    pub(super) fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let bodies = if self.0.asked_tensors().is_empty() { self.moments(py)? } else { self.inertia(py)? };
        let arrays = (bodies, self.attitudes(py)?, self.angular_velocities(py)?);
        let keywords = PyDict::new(py);
        match &self.1[..] {
            [] => keywords.set_item("epochs", self.epochs(py)?)?,
            [of_all] => keywords.set_item("epochs", foreign::calendar(py, &[*of_all])?.get_item(0)?)?,
            each => keywords.set_item("epochs", foreign::calendar(py, each)?)?,
        }
        keywords.set_item("errors", self.0.asked_on_error().to_string())?;
        keywords.set_item("orbits", self.orbits(py)?)?;
        keywords.set_item("tolerance", self.tolerance())?;
        keywords.set_item("method", self.0.asked_method().to_string())?;
        keywords.set_item("span", self.span())?;
        keywords.set_item("threads", self.threads())?;
        (arrays, keywords).into_pyobject(py)
    }

    /// What `repr` says.
    pub(super) fn text(&self) -> String {
        let bodies = if self.0.len() == 1 { "body" } else { "bodies" };
        let threads = self.0.asked_threads().map_or_else(String::new, |threads| format!(", threads={threads}"));
        let disturbed = (0..self.0.len()).filter(|&member| self.0.orbit(member).is_some()).count();
        let orbits = if disturbed > 0 { format!(", {disturbed} under an orbit") } else { String::new() };
        let span =
            self.0.asked_span().map_or_else(String::new, |(start, stop)| format!(", span=({start:?}, {stop:?})"));
        let (tolerance, method) = (self.0.asked_tolerance(), self.0.asked_method());
        let method = if method == Method::Auto { String::new() } else { format!(", method=\"{method}\"") };
        format!("<Ensemble of {} {bodies}{orbits}, tolerance={tolerance:?}{method}{span}{threads}>", self.0.len())
    }

    /// A motion for an index, an ensemble for a slice.
    pub(super) fn member_or_part<'py>(
        &self,
        py: Python<'py>,
        index: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if let Ok(slice) = index.cast::<PySlice>() {
            return Ok(Bound::new(py, self.part(slice)?)?.into_any());
        }
        let index: isize = index.extract()?;
        let members = self.0.len();
        let counted = if index < 0 { index.checked_add_unsigned(members) } else { Some(index) };
        match counted.and_then(|index| usize::try_from(index).ok()).filter(|&index| index < members) {
            Some(index) => {
                let motion = detached(py, error::propagation, || self.0.motion(index))?;
                error::warn_of_tolerance(py, motion.plan().missed_tolerance())?;
                Ok(Bound::new(py, Motion(motion, self.calendar(index)))?.into_any())
            }
            None => Err(PyIndexError::new_err(format!("member {index} of an ensemble of {members}"))),
        }
    }

    /// One orbit, a list of them, or None.
    pub(super) fn orbits_as_given<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let orbits: Vec<_> = self.0.asked_orbits().iter().map(|orbit| orbit.map(Orbit)).collect();
        match self.0.asked_orbits() {
            [] => Ok(py.None().into_bound(py)),
            [Some(orbit)] => Ok(Bound::new(py, Orbit(*orbit))?.into_any()),
            _ => Ok(orbits.into_pyobject(py)?.into_any()),
        }
    }
}
