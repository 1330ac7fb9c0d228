//! Copies of `andoyer.Ensemble`: some of its members, the arguments that make it anew, and its text.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::Error as Propagation;
use andoyer_propagate::disturbers::DisturbingBody;
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
use crate::scene::arguments::disturbing_body;
use crate::scene_class::Scene;

impl Ensemble {
    /// The members of a slice.
    pub(super) fn part(&self, slice: &Bound<'_, PySlice>) -> PyResult<Self> {
        let range = slice.indices(self.0.len() as isize)?;
        let chosen: Vec<usize> =
            (0..range.slicelength as isize).map(|k| (range.start + k * range.step) as usize).collect();
        let calendar = match &self.1[..] {
            [] | [_] => self.1.clone(),
            each => chosen.iter().map(|&member| each[member]).collect(),
        };
        self.chosen(&chosen).map(|part| Self(part, calendar)).map_err(error::propagation)
    }

    fn chosen(&self, chosen: &[usize]) -> Result<andoyer_propagate::Ensemble, Propagation> {
        if !self.0.asked_scenes().is_empty() {
            let scenes = chosen.iter().map(|&member| self.0.asked_scenes()[member].clone()).collect();
            let part = andoyer_propagate::Ensemble::from_scenes(scenes, self.0.asked_on_error())?;
            return asked(part, None, None, self.0.asked_threads());
        }
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
        let part = part?.tolerance(self.0.asked_tolerance()).method(self.0.asked_method()).level(self.0.asked_level());
        let part = part.torques(self.0.asked_torques().iter().cloned());
        let part = match self.0.asked_epochs() {
            [] => Ok(part),
            [of_all] => part.epochs(vec![*of_all]),
            each => part.epochs(chosen.iter().map(|&member| each[member]).collect()),
        }?;
        let orbits = match self.0.asked_orbits() {
            [] => None,
            [of_all] => Some(vec![of_all.clone()]),
            each => Some(chosen.iter().map(|&member| each[member].clone()).collect()),
        };
        asked(part, orbits, self.0.asked_span(), self.0.asked_threads())
    }

    /// What makes the ensemble anew, and its arguments.
    pub(super) fn reduced<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let class = py.get_type::<Self>();
        if self.0.asked_scenes().is_empty() {
            let (arrays, keywords) = self.arguments(py)?;
            let new = py.import("copyreg")?.getattr("__newobj_ex__")?;
            return Ok((new, (class, arrays, keywords).into_pyobject(py)?));
        }
        let member = |(index, scene): (usize, &Result<andoyer_propagate::Scene, Propagation>)| match scene {
            Ok(scene) => {
                Bound::new(py, Scene { calendar: self.calendar(index), ..scene.clone().into() }).map(Bound::into_any)
            }
            Err(problem) => Ok(error::propagation(problem.clone()).into_value(py).into_bound(py).into_any()),
        };
        let scenes = self.0.asked_scenes().iter().enumerate().map(member).collect::<PyResult<Vec<_>>>()?;
        let keywords = PyDict::new(py);
        keywords.set_item("errors", self.0.asked_on_error().to_string())?;
        keywords.set_item("threads", self.threads())?;
        let of_scenes = (class.getattr("from_scenes")?,);
        let new = py.import("functools")?.getattr("partial")?.call(of_scenes, Some(&keywords))?;
        Ok((new, (scenes,).into_pyobject(py)?))
    }

    /// Positional and keyword arguments of the constructor.
    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
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
        keywords.set_item("level", self.level())?;
        if !self.0.asked_torques().is_empty() {
            keywords.set_item("torques", self.torques(py)?)?;
        }
        keywords.set_item("span", self.span())?;
        keywords.set_item("threads", self.threads())?;
        Ok((arrays.into_pyobject(py)?, keywords))
    }

    /// What `repr` says.
    pub(super) fn text(&self) -> String {
        let bodies = if self.0.len() == 1 { "body" } else { "bodies" };
        let threads = self.0.asked_threads().map_or_else(String::new, |threads| format!(", threads={threads}"));
        if !self.0.asked_scenes().is_empty() {
            return format!("<Ensemble of {} scenes{threads}>", self.0.len());
        }
        let disturbed = (0..self.0.len()).filter(|&member| !self.0.orbits_of(member).is_empty()).count();
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
                // Its plan says whether the tolerance is met; the ensemble warns once for all of its members.
                let motion = detached(py, error::propagation, || self.0.motion(index))?;
                Ok(Bound::new(py, Motion(motion, self.calendar(index)))?.into_any())
            }
            None => Err(PyIndexError::new_err(format!("member {index} of an ensemble of {members}"))),
        }
    }

    /// One orbit, a list with one, several or None for each member, or None. Several of all members are a list of one list.
    pub(super) fn orbits_as_given<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let of_member = |bodies: &Vec<DisturbingBody>| match &bodies[..] {
            [] => Ok(py.None().into_bound(py)),
            [body] => disturbing_body(py, body),
            several => {
                let several = several.iter().map(|body| disturbing_body(py, body)).collect::<PyResult<Vec<_>>>()?;
                several.into_pyobject(py)
            }
        };
        match self.0.asked_orbits() {
            [] => Ok(py.None().into_bound(py)),
            [of_all] if of_all.len() == 1 => of_member(of_all),
            each => each.iter().map(of_member).collect::<PyResult<Vec<_>>>()?.into_pyobject(py),
        }
    }
}
