//! `andoyer.Ensemble.from_orbital` and `Ensemble.orbital`.

use std::f64::consts::TAU;

use andoyer_propagate::disturbers::DisturbingBody;
use andoyer_propagate::ensemble::OnError;
use andoyer_propagate::orbital::OrbitalSample;
use andoyer_propagate::{Error, Scene};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::Ensemble;
use super::arguments::{of_scenes, orbits_given};
use super::bodies::Bodies;
use crate::array::MemberRows;
use crate::error;
use crate::foreign;
use crate::orbital::{Asked, Orbital};
use crate::scene::arguments::epoch as epoch_of;

/// Attitudes of the members as quaternions or as angles.
enum Turns {
    Quaternions(MemberRows<4>),
    Angles(MemberRows<3>),
}

impl Turns {
    fn new(value: &Bound<'_, PyAny>, scalar_first: bool) -> PyResult<Self> {
        // A quaternion has no unit; angles may have one.
        let argument = if foreign::holds_units(value)? { "angles" } else { "attitudes" };
        let (numbers, scalar_first) = foreign::attitudes("attitudes", value, scalar_first)?;
        if let Ok(angles) = MemberRows::<3>::new(argument, &numbers) {
            return Ok(Self::Angles(angles));
        }
        let mut rows = MemberRows::<4>::of_shape("attitudes", &numbers, "(m, 4), (4,), (m, 3) or (3,)")?;
        rows.each(|quaternion| foreign::scalar_last(quaternion, scalar_first));
        Ok(Self::Quaternions(rows))
    }

    fn members(&self) -> Option<usize> {
        match self {
            Self::Quaternions(rows) => rows.members(),
            Self::Angles(rows) => rows.members(),
        }
    }

    /// The first angle beyond a whole turn, with its name.
    fn beyond_a_turn(&self) -> Option<(String, f64)> {
        let (rows, one) = match self {
            Self::Quaternions(_) => return None,
            Self::Angles(MemberRows::One(row)) => (std::slice::from_ref(row), true),
            Self::Angles(MemberRows::Many(rows)) => (&rows[..], false),
        };
        let (member, row) = rows.iter().enumerate().find(|(_, row)| row.iter().any(|angle| angle.abs() > TAU))?;
        let argument = if one { "attitudes".to_owned() } else { format!("attitudes[{member}]") };
        error::each(&argument, row).find(|(_, angle)| angle.abs() > TAU)
    }

    fn rows(self, members: usize) -> Vec<Vec<f64>> {
        match self {
            Self::Quaternions(rows) => rows.repeated(members).into_iter().map(Vec::from).collect(),
            Self::Angles(rows) => rows.repeated(members).into_iter().map(Vec::from).collect(),
        }
    }
}

#[pymethods]
impl Ensemble {
    /// An ensemble of states that are given against the orbital frame, each as `Scene.from_orbital` has it: satellites that are released with a spread of angles and rates.
    ///
    /// Parameters
    /// ----------
    /// bodies : Body or sequence of m Body, or array_like, shape (3,) or (m, 3)
    ///     Bodies, or principal moments.
    /// attitudes : array_like, shape (4,), (m, 4), (3,) or (m, 3)
    ///     Quaternions that rotate body components into components of the orbital frame, or angles [rad] of `sequence`.
    /// angular_velocities : array_like, shape (3,) or (m, 3)
    ///     In body components, in rad per unit of time: relative to the turning frame, or inertial with ``relative=False``.
    /// orbit, orbits : optional
    ///     The disturbing bodies of all members, or of each, as for `Ensemble`; one of the two.
    /// elements_of, frame, relative, sequence, of : optional
    ///     As in `Scene.from_orbital`; `elements_of` is required.
    /// epoch : float or Time, optional
    ///     Time of all states.
    /// threads, errors, scalar_first : optional
    ///     As for `Ensemble`.
    /// **options
    ///     torques, tolerance, method, level, span of all scenes, as for `Scene`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     As `Scene.from_orbital`, with the number of the member; arguments with different numbers of rows, or none with an axis of members.
    ///
    /// Examples
    /// --------
    /// >>> rolls = [[0, 0, 0.1], [0, 0, 0.2]]
    /// >>> released = Ensemble.from_orbital(Body([1.5, 2, 1]), rolls, [0, 0, 0], orbit=Orbit(1e-3), elements_of="rotating", frame="lvlh", span=(0, 6e3), method="integrated")
    /// >>> released.orbital(0.0, elements_of="rotating", frame="lvlh").angles.round(9)
    /// array([[0. , 0. , 0.1],
    ///        [0. , 0. , 0.2]])
    #[staticmethod]
    #[pyo3(
        signature = (bodies, attitudes, angular_velocities, *, orbit=None, orbits=None, elements_of, frame="rtn", relative=true, sequence="ZYX",
            epoch=None, of=None, threads=None, errors="raise", scalar_first=false, **options),
        text_signature = "(bodies, attitudes, angular_velocities, *, orbit=None, orbits=None, elements_of, frame='rtn', relative=True, sequence='ZYX', epoch=0.0, of=0, threads=None, errors='raise', scalar_first=False, **options)"
    )]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn from_orbital(
        bodies: &Bound<'_, PyAny>,
        attitudes: &Bound<'_, PyAny>,
        angular_velocities: &Bound<'_, PyAny>,
        orbit: Option<&Bound<'_, PyAny>>,
        orbits: Option<&Bound<'_, PyAny>>,
        elements_of: &str,
        frame: &str,
        relative: bool,
        sequence: &str,
        epoch: Option<&Bound<'_, PyAny>>,
        of: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
        errors: &str,
        scalar_first: bool,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let asked = Asked::new(elements_of, frame, sequence, of)?;
        let on_error: OnError = errors.parse().map_err(error::propagation)?;
        let bodies = Bodies::any(bodies)?;
        let turns = Turns::new(attitudes, scalar_first)?;
        error::warn_of_degrees(attitudes.py(), turns.beyond_a_turn())?;
        let rates = MemberRows::<3>::new("angular_velocities", angular_velocities)?;
        let around = orbits_given(orbit, orbits)?.unwrap_or_default();
        let of_orbits = if orbits.is_some() { Some(around.len()).filter(|&count| count != 1) } else { None };
        let counts = [
            ("bodies", bodies.rows()),
            ("attitudes", turns.members()),
            ("angular_velocities", rates.members()),
            ("orbits", of_orbits),
        ];
        let mut given = counts.into_iter().filter_map(|(name, count)| Some((name, count?)));
        let Some((first, members)) = given.next() else {
            let text = "bodies, attitudes, angular_velocities and orbits are one each: one of them must have an axis of members";
            return Err(error::input("attitudes", "one", "m", text.to_owned()));
        };
        if let Some((name, count)) = given.find(|(_, count)| *count != members) {
            let text = format!("{first} has {members} members and {name} {count}");
            return Err(error::input(name, count, members, text));
        }
        let (time, calendar) = epoch_of(epoch)?;
        let one = bodies.rows().is_none();
        let (bodies, turns, rates) = (bodies.each(), turns.rows(members), rates.repeated(members));
        let scene = |index: usize| -> Result<Scene, Error> {
            let body = bodies[if one { 0 } else { index }].clone()?;
            let turn = asked.turned(&turns[index])?;
            let disturbing: &[DisturbingBody] = match &around[..] {
                [] => &[],
                [of_all] => of_all,
                each => &each[index],
            };
            Scene::from_orbital(
                body,
                disturbing.iter().cloned(),
                &asked.frame,
                turn,
                rates[index].into(),
                relative,
                time,
            )
        };
        let scenes: Vec<_> = (0..members).map(scene).collect();
        let ensemble = of_scenes(scenes, (time, calendar), (threads, on_error), options, "Ensemble.from_orbital")?;
        Ok(Self(ensemble, calendar.into_iter().collect()))
    }

    /// Attitudes and angular velocities of all members against the orbital frame.
    ///
    /// Parameters
    /// ----------
    /// times : float or array_like, shape (n,) or (m, n)
    ///     Times for all members, or a row of times for each.
    /// elements_of, frame, sequence, of
    ///     As in `Scene.from_orbital`.
    ///
    /// Returns
    /// -------
    /// Orbital
    ///     With a leading axis of members: attitude (m, n, 4), angles (m, n, 3), angular velocity (m, n, 3). With ``errors="nan"`` members without a motion are NaN.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     As `Motion.orbital`, with the number of the member.
    #[pyo3(
        signature = (times, *, elements_of, frame="rtn", sequence="ZYX", of=None),
        text_signature = "($self, times, *, elements_of, frame='rtn', sequence='ZYX', of=0)"
    )]
    fn orbital<'py>(
        &self,
        py: Python<'py>,
        times: &Bound<'py, PyAny>,
        elements_of: &str,
        frame: &str,
        sequence: &str,
        of: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Orbital> {
        let asked = Asked::new(elements_of, frame, sequence, of)?;
        let mut said = None;
        let orbital = asked.orbital(py, &self.times(times)?, |since_epoch, values, out, stop| {
            let run = self.0.run().until(stop);
            let run = if since_epoch { run.since_epoch() } else { run };
            let mut samples = vec![OrbitalSample::NAN; out.attitude.len()];
            said = run.orbital_into(values, &asked.frame, &mut samples)?.missed_tolerance();
            out.fill(&asked, samples);
            Ok(())
        })?;
        error::warn_of_tolerance(py, said)?;
        Ok(orbital)
    }
}
