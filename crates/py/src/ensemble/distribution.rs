//! How the members of `andoyer.Ensemble` tumble at one time, as `andoyer.Distribution`.

use andoyer_propagate::ensemble::TumblingMember;
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::Ensemble;
use super::arguments::refused;
use crate::array::constant_rows;
use crate::computing::interruptible;
use crate::error;
use crate::mean;

impl Ensemble {
    /// What `Ensemble.after` returns.
    pub(super) fn distribution<'py>(&self, py: Python<'py>, time: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let times = self.times(time)?;
        let &[value] = times.values()? else { return Err(times.scalar("time")) };
        let since_epoch = times.since_epoch();
        let after = |stop: &std::sync::atomic::AtomicBool| self.run(since_epoch, stop).after(value);
        let (members, outcome) = interruptible(py, times.long(), error::propagation, after)?;
        error::warn_of_tolerance(py, outcome.missed_tolerance())?;
        let mode = |member: &TumblingMember| member.mode.map_or_else(String::new, |mode| mode.to_string());
        let modes: Vec<String> = members.iter().map(mode).collect();
        let errors = PyDict::new(py);
        for (index, problem) in refused(py, outcome) {
            errors.set_item(index, problem)?;
        }
        let momenta: Vec<[f64; 3]> = members.iter().map(|member| member.angular_momentum).collect();
        let class = py.import("andoyer.distribution")?.getattr("Distribution")?;
        class.call1((
            time,
            py.import("numpy")?.call_method1("array", (modes,))?,
            members.iter().map(|member| member.has_changed).collect::<Vec<_>>().into_pyarray(py),
            periods(py, &members)?,
            PyArray1::from_iter(py, members.iter().map(|member| member.energy_ratio)),
            constant_rows(py, &momenta)?,
            errors,
        ))
    }
}

/// The periods by convention.
fn periods<'py>(py: Python<'py>, members: &[TumblingMember]) -> PyResult<Bound<'py, PyDict>> {
    mean::of_members(py, members.iter().map(|member| &member.periods))
}
