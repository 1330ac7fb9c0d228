//! Numbers: states to normal variables and back, energies, frequencies, trajectories.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{Array, BirkhoffNormalForm};
use crate::array::{Rows, Times, fixed_length, row_by_row, write};
use crate::domain::Domain;
use crate::error;
use crate::form::either;

#[pymethods]
impl BirkhoffNormalForm {
    /// Transforms states to the new variables.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    /// time : float or array_like, shape (m,), optional
    ///     The time of the states, on which driven phases depend; 0 by default.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN, or a result that overflows.
    /// TheoryError
    ///     A state beyond the range of the series: the transformation there and back misses it by more than 1 % of its distance.
    #[pyo3(signature = (states, parameters=None, time=None))]
    fn to_normal<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
        time: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (2 * self.space().degrees_of_freedom(), self.map(states.py(), parameters)?);
        Rows::new("states", states, n)?.map_at(n, time, |state, time| map.to_normal_at(state, time))
    }

    /// Transforms new variables to states. The errors are those of `to_normal`.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    /// time : float or array_like, shape (m,), optional
    ///     The time of the states, on which driven phases depend; 0 by default.
    #[pyo3(signature = (states, parameters=None, time=None))]
    #[expect(clippy::wrong_self_convention, reason = "the pair of to_normal")]
    fn from_normal<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
        time: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (2 * self.space().degrees_of_freedom(), self.map(states.py(), parameters)?);
        Rows::new("states", states, n)?.map_at(n, time, |state, time| map.from_normal_at(state, time))
    }

    /// Transforms points of the centre manifold, given by the new variables of the centres, to states.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2c,) or (m, 2c)
    ///     q, p of the c centres, in their order.
    /// parameters : dict of {str: float}, optional
    /// time : float or array_like, shape (m,), optional
    ///     The time of the states, on which driven phases depend; 0 by default.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2n,) or (m, 2n)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN, or a result that overflows; a form without a centre.
    /// TheoryError
    ///     A point beyond the range of the series.
    #[pyo3(signature = (states, parameters=None, time=None))]
    #[expect(
        clippy::wrong_self_convention,
        reason = "the states of a manifold, as from_normal those of normal variables"
    )]
    fn from_centre_manifold<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
        time: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Array<'py>> {
        let map = self.map(states.py(), parameters)?;
        let centres = either!(&self.form, form => form.modes().iter().filter(|mode| mode.is_elliptic()).count());
        if centres == 0 {
            let message = "states: a form without a centre has no centre manifold".to_owned();
            return Err(error::input("states", 0_usize, "a form with a centre", message));
        }
        let n = 2 * self.space().degrees_of_freedom();
        Rows::new("states", states, 2 * centres)?.map_at(n, time, |centre, time| map.from_centre_at(centre, time))
    }

    /// The energy: the value of K at new variables.
    ///
    /// Parameters
    /// ----------
    /// normal : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    /// time : float or array_like, shape (m,), optional
    ///     The time of the states, on which driven phases depend; 0 by default.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (1,) or (m, 1)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN.
    #[pyo3(signature = (normal, parameters=None, time=None))]
    fn energy<'py>(
        &self,
        normal: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
        time: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (2 * self.space().degrees_of_freedom(), self.map(normal.py(), parameters)?);
        Rows::new("normal", normal, n)?.map_at(1, time, |normal, time| Ok(vec![map.energy_at(normal, time)?]))
    }

    /// The rates of new variables, by Hamilton's equations of K.
    ///
    /// Parameters
    /// ----------
    /// normal : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    /// time : float or array_like, shape (m,), optional
    ///     The time of the states, on which driven phases depend; 0 by default.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN.
    #[pyo3(signature = (normal, parameters=None, time=None))]
    fn rates<'py>(
        &self,
        normal: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
        time: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (2 * self.space().degrees_of_freedom(), self.map(normal.py(), parameters)?);
        Rows::new("normal", normal, n)?.map_at(n, time, |normal, time| map.rates_at(normal, time))
    }

    /// Estimates the range of validity of the form: the sizes of its orders, and the best order at an amplitude.
    ///
    /// Parameters
    /// ----------
    /// parameters : dict of {str: float}, optional
    ///
    /// Examples
    /// --------
    /// >>> pendulum = normalize("p**2/2 + q**2/2 - q**4/24 + q**6/720 - q**8/40320", 6, [("q", "p")])
    /// >>> domain = pendulum.domain()
    /// >>> domain.best_order(0.5), domain.best_order(10.0)
    /// (6, 2)
    #[pyo3(signature = (parameters=None))]
    fn domain(&self, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Domain> {
        let values = self.values(parameters)?;
        either!(&self.form, form => form.domain(&values)).map(Domain).map_err(error::algebra)
    }

    /// The actions of states. Along a motion they are almost constant, unless a resonance exchanges them.
    ///
    /// Parameters
    /// ----------
    /// states : array_like, shape (2n,) or (m, 2n)
    /// parameters : dict of {str: float}, optional
    /// time : float or array_like, shape (m,), optional
    ///     The time of the states, on which driven phases depend; 0 by default.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n,) or (m, n)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN, or a result that overflows.
    /// TheoryError
    ///     A state beyond the range of the series: the transformation there and back misses it by more than 1 % of its distance.
    #[pyo3(signature = (states, parameters=None, time=None))]
    fn actions<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
        time: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (self.space().degrees_of_freedom(), self.map(states.py(), parameters)?);
        Rows::new("states", states, 2 * n)?.map_at(n, time, |state, time| map.actions_at(state, time))
    }

    /// The frequencies Ω = ∂K/∂I at actions. For a saddle Ω is the rate; for a quartet it is rate and frequency.
    ///
    /// Parameters
    /// ----------
    /// actions : array_like, shape (n,) or (m, n)
    /// parameters : dict of {str: float}, optional
    ///
    /// Raises
    /// ------
    /// TheoryError
    ///     K has resonant terms; actions whose states at time 0 are beyond the range of the series.
    /// InputError
    ///     An array of another length; a NaN, or an action below 0.
    #[pyo3(signature = (actions, parameters=None))]
    fn frequency_map<'py>(
        &self,
        actions: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let (n, map) = (self.space().degrees_of_freedom(), self.map(actions.py(), parameters)?);
        Rows::new("actions", actions, n)?.map(n, |actions| map.frequencies(actions))
    }

    /// Propagates a state by the normal form to times after the state.
    ///
    /// If K is a function of the actions, the actions are constant and the angles move uniformly. With resonant terms SciPy's DOP853 integrates
    /// the equations of K in the new variables at a relative tolerance of 1e-12.
    ///
    /// Parameters
    /// ----------
    /// state : array_like, shape (2n,)
    /// times : float or array_like, shape (m,)
    /// parameters : dict of {str: float}, optional
    /// time : float, optional
    ///     The time of `state`, on which driven phases depend.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2n,) or (m, 2n)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An array of another length; a NaN, or a result that overflows.
    /// TheoryError
    ///     `state`, or a later one, is beyond the range of the series.
    /// ImportError
    ///     K has resonant terms, and SciPy is not installed.
    #[pyo3(signature = (state, times, parameters=None, time=0.0))]
    fn trajectory<'py>(
        slf: &Bound<'py, Self>,
        state: &Bound<'py, PyAny>,
        times: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyDict>>,
        time: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (py, form) = (state.py(), slf.get());
        let n = 2 * form.space().degrees_of_freedom();
        let map = form.map(py, parameters)?;
        let (given, shape) = (fixed_length("state", state, n)?, Times::new(times, None, false)?);
        if !map.is_integrable() {
            return py
                .import("andoyer.interop._flow")?
                .call_method1("trajectory", (slf, given, times, parameters, time));
        }
        let result = shape.rows(n)?;
        let states = row_by_row(py, shape.values()?, 1, |times| map.trajectory_from(&given, time, times))?;
        write(&result)?.as_slice_mut()?.copy_from_slice(&states.concat());
        Ok(result.into_any())
    }
}
