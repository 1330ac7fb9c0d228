//! `andoyer.Motion`.

use std::sync::atomic::AtomicBool;

use andoyer_propagate::periods::Convention;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyType};

use crate::array::{Times, chunks, write};
use crate::computing::{detached, interruptible};
use crate::error;
use crate::foreign::{self, Calendar};
use crate::mean;
use crate::partials::{self, Partials};
use crate::plan::Plan;
use crate::samples::Samples;
use crate::scene_class::Scene;

mod copies;
mod later;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// A solved motion, from `Scene.solve`. It is immutable, and several threads can evaluate it in parallel.
///
/// The argument `times` of every method is a scalar or an array_like of shape (n,), of floats or integers, in the unit of time of the scene. For a scalar the
/// results have no leading axis. If the epoch of the scene is a Time of astropy, the times may be Time objects too. A TimeDelta is a duration from the epoch, to which
/// astropy adds it: in its own time scale, or without one in that of the epoch (UTC: in TAI).
/// The difference from the epoch is formed in the two doubles of astropy, and `Samples.times` has the times as given. Ctrl-C ends every call within a second.
///
/// Raises
/// ------
/// RepresentationError
///     A time more than 1e15 rotations from the epoch, with ``averaging="spin"`` more than 65,534 orbits from it (262,144 arcs with several bodies or an orbit that precesses), or outside the span of an integrated motion. The message states
///     the index of the time and the limit.
/// InputError
///     A time that is NaN or infinite; a Time if the epoch is a number; a Quantity if the epoch is a Time; an array of times with two axes.
///
/// Examples
/// --------
/// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
/// >>> motion.attitude(0.0).round(12) + 0.0
/// array([0., 0., 0., 1.])
/// >>> motion.angular_velocity([0, 1, 2]).shape
/// (3, 3)
#[pyclass(frozen, module = "andoyer")]
pub(crate) struct Motion(pub(crate) andoyer_propagate::Motion, pub(crate) Option<Calendar>);

#[pymethods]
impl Motion {
    /// Evaluates attitudes and angular velocities in one pass.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///     Times, in the unit of time of the scene.
    /// scalar_first : bool, optional
    ///     If True, quaternions are [w, x, y, z]; by default [x, y, z, w].
    ///
    /// Returns
    /// -------
    /// Samples
    ///     Attitudes (n, 4) and angular velocities (n, 3) in rad per unit of time.
    #[pyo3(signature = (times, *, scalar_first=false))]
    fn at(&self, py: Python<'_>, times: &Bound<'_, PyAny>, scalar_first: bool) -> PyResult<Samples> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        let [copy, attitude, rates] = times.samples()?;
        {
            let (mut attitude, mut rates) = (write(&attitude)?, write(&rates)?);
            let (values, attitude, rates) = (times.values()?, chunks(&mut attitude)?, chunks(&mut rates)?);
            let evaluate = |stop: &AtomicBool| {
                self.batch(since_epoch, stop).samples_into(values, attitude, rates)?;
                foreign::scalar_first(attitude, scalar_first, stop);
                Ok(())
            };
            interruptible(py, times.long(), error::propagation, evaluate)?;
        }
        Ok(Samples::new(copy.unbind(), attitude.unbind(), rates.unbind(), scalar_first).given(times.given()))
    }

    /// Evaluates attitudes: unit quaternions [x, y, z, w] that rotate body components into inertial ones (theory §8).
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///     Times, in the unit of time of the scene.
    /// out : ndarray, float64, C-contiguous, shape (n, 4), optional
    ///     Array for the result. After an error it contains the values computed so far.
    /// scalar_first : bool, optional
    ///     If True, quaternions are [w, x, y, z].
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n, 4)
    ///     Unit quaternions; this is `out` if `out` was given.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An `out` of another shape, or not contiguous.
    /// TypeError
    ///     An `out` that is not a float64 array, or is read-only.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    /// >>> out = np.empty((2, 4))
    /// >>> motion.attitude([0, 1], out=out) is out
    /// True
    #[pyo3(signature = (times, out=None, *, scalar_first=false))]
    fn attitude<'py>(
        &self,
        times: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
        scalar_first: bool,
    ) -> PyResult<Array<'py>> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        let evaluate = |values: &[f64], rows: &mut [[f64; 4]], stop: &AtomicBool| {
            self.batch(since_epoch, stop).attitudes_into(values, rows)?;
            foreign::scalar_first(rows, scalar_first, stop);
            Ok(())
        };
        times.evaluate(out, evaluate).map(|(rows, ())| rows)
    }

    /// Evaluates angular velocities in body components, in rad per unit of time.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///     Times, in the unit of time of the scene.
    /// out : ndarray, float64, C-contiguous, shape (n, 3), optional
    ///     Array for the result, as in `attitude`.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n, 3)
    ///     Angular velocities; this is `out` if `out` was given.
    #[pyo3(signature = (times, out=None))]
    fn angular_velocity<'py>(
        &self,
        times: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Array<'py>> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        times
            .evaluate(out, |values, rows, stop| self.batch(since_epoch, stop).angular_velocities_into(values, rows))
            .map(|(rows, ())| rows)
    }

    /// Evaluates the angular momentum in inertial components, in the unit of moment × rate. It is constant unless the scene has an orbit or torques.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///     Times, in the unit of time of the scene.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n, 3)
    ///     Angular momenta.
    fn angular_momentum<'py>(&self, times: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        times
            .evaluate(None, |values, rows, stop| self.batch(since_epoch, stop).angular_momenta_into(values, rows))
            .map(|(rows, ())| rows)
    }

    /// Evaluates the Andoyer variables (λ, μ, ν, Λ, M, N) (theory §1).
    ///
    /// The attitude is Rz(λ) Rx(I) Rz(μ) Rx(J) Rz(ν) with cos I = Λ/M, cos J = N/M. Axis 3 is the user's axis of greatest inertia with the same direction, axis
    /// 2 is the axis of B, and axis 1 is the axis of A. Axis 1 is reversed if the user's order A, B, C is left-handed. N < 0 means that the body rotates
    /// backwards about its axis 3. For N > 0, y = μ + ν has the mean rate `frequencies.longitude` and ν the mean rate −dℓ′/dt. For N < 0, y = μ − ν has the
    /// mean rate `frequencies.longitude` and ν the mean rate +dℓ′/dt. In both cases the mean rate of μ is the sum of the two frequencies. Angles are in (−π,
    /// π]. If a node is not defined (I or J is 0 or π), its angle is 0 and μ is the sum of the angles. All variables are 0 for a body at rest.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///     Times, in the unit of time of the scene.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n, 6)
    ///     Angles in rad, momenta in the unit of moment × rate.
    fn andoyer<'py>(&self, times: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        times
            .evaluate(None, |values, rows, stop| self.batch(since_epoch, stop).andoyer_into(values, rows))
            .map(|(rows, ())| rows)
    }

    /// Evaluates attitudes as a `scipy.spatial.transform.Rotation`, body to inertial. This method imports SciPy.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///     Times, in the unit of time of the scene.
    ///
    /// Returns
    /// -------
    /// scipy.spatial.transform.Rotation
    ///     n rotations, or a single rotation for a scalar time.
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     SciPy is not installed; ``pip install scipy`` installs it.
    fn rotation<'py>(&self, times: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        foreign::rotation(&self.attitude(times, None, false)?)
    }

    /// Evaluates the derivatives of attitude and angular velocity with respect to the initial state, the moments, and the orbits of disturbing bodies (theory §12).
    ///
    /// By default there are nine columns: the initial attitude (a small rotation about body axes 1, 2, 3), the initial angular velocity, and the moments as given. For
    /// a body made by `Body.from_inertia` there are twelve: the six elements I11, I22, I33, I12, I13, I23 of the tensor replace the moments, and a change of I12 is one
    /// of I21 too. A change of attitude is a rotation vector δθ about body axes, R → R exp([δθ]×); rates are body components. Of a free motion the derivatives are in
    /// closed form at any time and in every mode, or power series where the closed form cancels; under a torque they are integrated (see `Plan.partials`).
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,)
    ///     Times, in the unit of time of the scene.
    /// with_respect_to : str or sequence of str and (str, int), optional
    ///     Groups of parameters: "attitude" (3 columns), "angular_velocity" (3), "moments" (3, or the 6 elements of a tensor), "orbit" (6: mean_motion, eccentricity,
    ///     time_of_pericentre, inclination, node, argument_of_pericentre), "attraction" (1), both of the disturbing body, and "torque": the components of a constant torque, of a rotor or of a dipole (m × B of one
    ///     source), the 9 elements of a damping; of another polynomial its factor and, up to 60, its coefficients. Of several bodies or torques the index says which: ("orbit", 1).
    ///     The other arguments of the orbit are held, `attraction` or `mass_fraction` among them, whichever it was made with, and M R² of a gravity field. The orbits of
    ///     sources of torques are no parameters.
    ///
    /// Returns
    /// -------
    /// Partials
    ///     Derivatives (n, 3, k) of attitude and angular velocity, with k columns named by `Partials.parameters`.
    ///
    /// Raises
    /// ------
    /// TheoryError
    ///     The motion is on the separatrix, where the frequencies have no derivatives.
    /// InputError
    ///     An unknown parameter; that of a disturbing body that the scene lacks or that has a table; "orbit" or "attraction" of a body with a gravity field; that of a torque that the scene lacks.
    ///
    /// Examples
    /// --------
    /// After 10 units of time, the angle of rotation about axis 3 grows by 10 for each unit of the rate.
    ///
    /// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0, 0, 2.0]).solve()
    /// >>> float(motion.partials(10.0).attitude[2, 5])
    /// 10.0
    ///
    /// A satellite at its equilibrium on a circle: if the orbit is turned about axis 3, the body librates by 1 − cos(n t √(3 (B − A)/C)) of the turn.
    ///
    /// >>> import math
    /// >>> scene = Scene(Body([1, 1.2, 2]), [0, 0, 0, 1], [0, 0, 0.1], orbit=Orbit(0.1), span=(0, 20), method="integrated")
    /// >>> partials = scene.solve().partials(20.0, with_respect_to=("orbit", "attraction"))
    /// >>> partials.parameters[4], round(float(partials.attitude[2, 4]), 8), round(1 - math.cos(2 * math.sqrt(3 * 0.2 / 2)), 8)
    /// ('node', 0.54234925, 0.54234925)
    #[pyo3(signature = (times, with_respect_to=None), text_signature = "($self, times, with_respect_to=('attitude', 'angular_velocity', 'moments'))")]
    fn partials(
        &self,
        py: Python<'_>,
        times: &Bound<'_, PyAny>,
        with_respect_to: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Partials> {
        let times = self.times(times)?;
        let since_epoch = times.since_epoch();
        let parameters = partials::parameters(&self.0, with_respect_to)?;
        let names = self.0.parameter_names(&parameters).map_err(error::propagation)?;
        let [copy, attitude, rates] = times.matrices(names.len())?;
        {
            let (values, mut attitude, mut rates) = (times.values()?, write(&attitude)?, write(&rates)?);
            let long = times.long_partials();
            let (attitude, rates) = (attitude.as_slice_mut()?, rates.as_slice_mut()?);
            let evaluate = |stop: &AtomicBool| {
                self.batch(since_epoch, stop).partials_with_respect_to(&parameters, values, attitude, rates)
            };
            interruptible(py, long, error::propagation, evaluate)?;
        }
        Ok(Partials::new([copy, attitude, rates].map(Bound::unbind), names))
    }

    /// Writes a source file with a self-contained function `rotation(time)` that evaluates this motion (theory §8).
    ///
    /// The function returns the attitude [x, y, z, w] and the angular velocity in body components. It needs only its language: C99 with math.h, Rust with
    /// `core`, Python with math, or JavaScript. The C and Rust functions do not allocate memory. Phases are in double-double arithmetic and are accurate after
    /// 1e9 rotations. The head of the file names the scene, the mode, the validity interval and the largest difference from the library. Times are those of the
    /// scene, or TDB seconds since J2000 if the epoch is a Time of astropy.
    ///
    /// Parameters
    /// ----------
    /// language : {"c", "rust", "python", "javascript"}, optional
    ///     Language of the file.
    ///
    /// Returns
    /// -------
    /// str
    ///     Text of the file.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown language (``"fortran"``).
    /// RepresentationError
    ///     A motion on the separatrix or under a torque.
    ///
    /// Examples
    /// --------
    /// >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    /// >>> namespace = {}
    /// >>> exec(motion.to_code("python"), namespace)
    /// >>> attitude, rates = namespace["rotation"](1e9)
    /// >>> bool(abs(motion.attitude(1e9) - attitude).max() < 1e-14)
    /// True
    #[pyo3(signature = (language="c"))]
    fn to_code(&self, py: Python<'_>, language: &str) -> PyResult<String> {
        let language = language.parse().map_err(error::propagation)?;
        detached(py, error::propagation, || self.0.to_code(language))
    }

    /// The source file, and the bounds of the differences in its head: of the attitude [rad], and of the angular velocity divided by its length.
    fn _code(&self, py: Python<'_>, language: &str) -> PyResult<(String, f64, f64)> {
        let language = language.parse().map_err(error::propagation)?;
        let code = detached(py, error::propagation, || self.0.code(language))?;
        Ok((code.text().to_owned(), code.attitude_error(), code.rate_error()))
    }

    /// The plan: method, order, error bound and other facts about this motion.
    #[getter]
    fn plan(&self) -> Plan {
        Plan(self.0.plan().clone())
    }

    /// The scene that was solved.
    #[getter]
    fn scene(&self) -> Scene {
        Scene { calendar: self.1, ..self.0.scene().clone().into() }
    }

    /// Mean frequencies dℓ′/dt, dy′/dt (theory §7): a named tuple (anomaly, longitude), in rad per unit of time.
    ///
    /// The frequencies and `periods` of an integrated motion are those of the free motion at the epoch.
    ///
    /// Both are at least 0; a frequency that does not exist in this mode is 0. y = μ + ν for N ≥ 0. For N < 0 axis 3 points away from the angular momentum, and
    /// y = μ − ν (see `andoyer`).
    #[getter]
    fn frequencies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        static FREQUENCIES: PyOnceLock<Py<PyType>> = PyOnceLock::new();
        let frequencies = self.0.frequencies();
        FREQUENCIES.import(py, "andoyer.mean", "Frequencies")?.call1((frequencies.anomaly, frequencies.longitude))
    }

    /// Mean periods (P_φ, P_ψ) in three conventions: a dict with the keys "long-axis", "short-axis" and "extremal-axis".
    ///
    /// The values are named tuples (precession, rotation) in units of time. A period that does not exist in this mode is infinite.
    ///
    /// - "short-axis" is the convention of the Andoyer variables. P_φ is the mean period with which the short axis precesses about the angular momentum. P_ψ is
    ///   the mean period of the rotation about the short axis, or of the oscillation about it in the long-axis mode. In the short-axis mode P_φ = 2π/(dy′/dt +
    ///   dℓ′/dt) is the period of μ, and P_ψ = 2π/(dℓ′/dt) is the period of ν; ν decreases for N > 0 and increases for N < 0.
    /// - "long-axis" has the periods of the long axis: in the short-axis mode P_φ = 2π/(dy′/dt). Radar papers use this convention.
    /// - "extremal-axis" is the convention of light-curve papers (Pravec et al. 2014): "short-axis" in the short-axis mode and "long-axis"
    ///   in the long-axis mode.
    ///
    /// P_ψ is the same in all three conventions.
    ///
    /// Examples
    /// --------
    /// >>> periods = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve().periods
    /// >>> periods["extremal-axis"] == periods["short-axis"]
    /// True
    /// >>> (precession, rotation), long = periods["short-axis"], periods["long-axis"].precession
    /// >>> abs(1 / precession - 1 / rotation - 1 / long) < 1e-15
    /// True
    #[getter]
    fn periods<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        mean::periods(
            py,
            "Periods",
            Convention::ALL.into_iter().map(|convention| {
                let pair = self.0.periods_of(convention);
                (convention, (pair.precession, pair.rotation))
            }),
        )
    }

    /// E/E0: the rotational energy divided by the energy of rotation about the axis of greatest inertia with the same angular momentum (theory §5).
    ///
    /// It is 1 for rotation about this axis, C/B on the separatrix, and C/A for rotation about the axis of least inertia. With an orbit it is the value at the
    /// epoch.
    #[getter]
    fn energy_ratio(&self) -> f64 {
        self.0.energy_ratio()
    }

    /// k², the parameter of the elliptic functions of the polhode (theory §10): 0 for rotation about a principal axis, 1 on the separatrix.
    #[getter]
    fn elliptic_parameter(&self) -> f64 {
        self.0.elliptic_parameter()
    }

    fn __repr__(&self) -> String {
        let plan = self.0.plan();
        let name = self.0.scene().asked_name().map_or_else(String::new, |name| format!(" of {name:?}"));
        format!("<Motion{name}: {}, {}, order {}>", plan.mode(), plan.method(), plan.order())
    }
}

impl Motion {
    pub(crate) fn times<'py>(&self, value: &Bound<'py, PyAny>) -> PyResult<Times<'py>> {
        Times::new(value, self.1, self.0.plan().steps() > 0 || !self.0.scene().asked_disturbing().is_empty())
    }

    /// The options of an evaluation at these times.
    pub(crate) fn batch<'a>(&'a self, since_epoch: bool, stop: &'a AtomicBool) -> andoyer_propagate::batch::Batch<'a> {
        let batch = self.0.batch().until(stop);
        if since_epoch { batch.since_epoch() } else { batch }
    }
}
