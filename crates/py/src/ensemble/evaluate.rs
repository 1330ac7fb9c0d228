//! How the members of `andoyer.Ensemble` are evaluated for Python.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::Error as Propagation;
use andoyer_propagate::ensemble::{MembersRun, Outcome};
use andoyer_propagate::partials::{Derivatives, INERTIA_PARAMETERS, Parameter};
use pyo3::prelude::*;

use super::{Array, Ensemble, LONG};
use crate::array::{Times, matrices, write};
use crate::computing::interruptible;
use crate::error;
use crate::foreign::Calendar;
use crate::partials::Partials;

impl Ensemble {
    pub(super) fn times<'py>(&self, value: &Bound<'py, PyAny>) -> PyResult<Times<'py>> {
        Times::of_members(value, self.0.len(), &self.1, !self.0.is_free())
    }

    /// How the members are evaluated at these times.
    pub(super) fn run<'a>(&'a self, since_epoch: bool, stop: &'a AtomicBool) -> MembersRun<'a> {
        let run = self.0.run().until(stop);
        if since_epoch { run.since_epoch() } else { run }
    }

    /// Rows of N numbers for each time of each member, into `out` or a new array.
    pub(super) fn rows<'py, const N: usize>(
        &self,
        times: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
        evaluate: impl FnOnce(MembersRun<'_>, &[f64], &mut [[f64; N]], &AtomicBool) -> Result<Outcome, Propagation> + Send,
    ) -> PyResult<Array<'py>> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        let (rows, outcome) =
            times.evaluate(out, |values, rows, stop| evaluate(self.run(since_epoch, stop), values, rows, stop))?;
        error::warn_of_tolerance(rows.py(), outcome.missed_tolerance())?;
        Ok(rows)
    }

    /// Derivatives with respect to N parameters.
    pub(super) fn derivatives<const N: usize>(
        &self,
        times: &Bound<'_, PyAny>,
        fill: impl FnOnce(
            MembersRun<'_>,
            &[f64],
            &mut [Derivatives<N>],
            &mut [Derivatives<N>],
        ) -> Result<Outcome, Propagation>
        + Send,
    ) -> PyResult<Partials> {
        let (py, times) = (times.py(), self.times(times)?);
        let since_epoch = times.since_epoch();
        let [copy, attitude, rates] = times.matrices(N)?;
        let outcome = {
            let (mut attitude, mut rates) = (write(&attitude)?, write(&rates)?);
            let (values, attitude, rates) = (times.values()?, matrices(&mut attitude)?, matrices(&mut rates)?);
            let evaluate = |stop: &AtomicBool| fill(self.run(since_epoch, stop), values, attitude, rates);
            interruptible(py, times.long_partials(), error::propagation, evaluate)?
        };
        error::warn_of_tolerance(py, outcome.missed_tolerance())?;
        let names = Parameter::names_of_state_and_body(N == INERTIA_PARAMETERS);
        Ok(Partials::new([copy, attitude, rates].map(Bound::unbind), names))
    }

    /// What is found for every member when all are solved.
    pub(super) fn values<T: Send>(
        &self,
        py: Python<'_>,
        find: impl FnOnce(MembersRun<'_>) -> Result<T, Propagation> + Send,
    ) -> PyResult<T> {
        let long = self.0.len() >= if self.0.is_free() { LONG } else { 32 };
        interruptible(py, long, error::propagation, |stop| find(self.0.run().until(stop)))
    }

    /// The plan of every member, or its error.
    pub(super) fn solved(&self, py: Python<'_>) -> PyResult<Vec<Result<andoyer_propagate::Plan, Propagation>>> {
        self.values(py, |run| run.plans())
    }

    /// The calendar epoch of a member.
    pub(super) fn calendar(&self, index: usize) -> Option<Calendar> {
        self.1.get(if self.1.len() == 1 { 0 } else { index }).copied()
    }
}
