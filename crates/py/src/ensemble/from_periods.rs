//! `andoyer.Ensemble.from_periods`: clones of a tumbler from periods that are published with their errors.

use andoyer_propagate::ensemble::MAX_THREADS;
use andoyer_propagate::error::Kind;
use andoyer_propagate::nalgebra::Vector3;
use andoyer_propagate::options::Convention;
use andoyer_propagate::periods::ObservedPeriods;
use andoyer_propagate::{Body, Error, Mode, Scene};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arguments::{asked, orbits_given, tolerance};
use super::bodies::Bodies;
use crate::array::{MemberRows, numbers_of, span as span_of};
use crate::computing::detached;
use crate::error;
use crate::foreign::Calendar;
use crate::order::whole_number;
use crate::scene::arguments::epoch as epoch_of;
use crate::torque;

/// One value for all members, or one for each.
struct Column<T>(Vec<T>);

impl<T: Clone> Column<T> {
    fn of(&self, index: usize) -> T {
        if self.0.len() == 1 { self.0[0].clone() } else { self.0[index].clone() }
    }

    /// The number of members that the column has a value for, if it is not one for all.
    fn members(&self, name: &'static str) -> Option<(&'static str, usize)> {
        (self.0.len() != 1).then_some((name, self.0.len()))
    }
}

/// The periods of the members.
pub(super) struct Clones {
    bodies: Column<Result<Body, Error>>,
    periods: [Column<f64>; 2],
    modes: Column<Mode>,
    directions: Column<Result<Vector3<f64>, Error>>,
    phases: Column<[f64; 2]>,
    members: usize,
}

impl Clones {
    pub(super) fn new(
        bodies: &Bound<'_, PyAny>,
        [precession, rotation]: [&Bound<'_, PyAny>; 2],
        mode: Option<&Bound<'_, PyAny>>,
        directions: Option<&Bound<'_, PyAny>>,
        phases: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let bodies = Column(Bodies::any(bodies)?.each());
        let periods = [numbers_of("precession", precession)?, numbers_of("rotation", rotation)?].map(Column);
        let modes = Column(mode.map_or_else(|| Ok(vec![Mode::ShortAxis]), modes_of)?);
        let directions = Column(directions.map_or_else(|| Ok(vec![Ok(Vector3::z())]), directions_of)?);
        let phases = phases.map(|value| MemberRows::new("phases", value)).transpose()?;
        let phases = Column(phases.map_or_else(|| vec![[0.0; 2]], MemberRows::rows));
        let counts = [
            bodies.members("bodies"),
            periods[0].members("precession"),
            periods[1].members("rotation"),
            modes.members("mode"),
            directions.members("directions"),
            phases.members("phases"),
        ];
        let mut given = counts.into_iter().flatten();
        let Some((first, members)) = given.next() else {
            let text =
                "bodies, periods, modes, directions and phases are one each: one of them must have an axis of members";
            return Err(error::input("bodies", "one", "m", text.to_owned()));
        };
        match given.find(|(_, count)| *count != members) {
            Some((name, count)) => {
                let text = format!("{first} has {members} members and {name} {count}");
                Err(error::input(name, count, members, text))
            }
            None => Ok(Self { bodies, periods, modes, directions, phases, members }),
        }
    }

    fn scene(&self, index: usize, convention: Convention, epoch: f64) -> Result<Scene, Error> {
        let periods = ObservedPeriods {
            mode: self.modes.of(index),
            convention,
            momentum_direction: self.directions.of(index)?,
            phases: self.phases.of(index),
            epoch,
            ..ObservedPeriods::new(self.periods[0].of(index), self.periods[1].of(index))
        };
        Scene::from_periods(self.bodies.of(index)?, &periods)
    }

    pub(super) fn ensemble(
        self,
        (convention, epoch): (&str, Option<&Bound<'_, PyAny>>),
        (threads, errors): (Option<&Bound<'_, PyAny>>, &str),
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<(andoyer_propagate::Ensemble, Option<Calendar>)> {
        let convention = convention.parse().map_err(error::propagation)?;
        let on_error = errors.parse().map_err(error::propagation)?;
        let threads = threads.map(|value| whole_number("threads", value, 1, MAX_THREADS, Kind::Input)).transpose()?;
        let (time, calendar) = epoch_of(epoch)?;
        let py = options.map(Bound::py);
        let scenes = || (0..self.members).map(|index| self.scene(index, convention, time)).collect();
        let make = || andoyer_propagate::Ensemble::from_scenes(scenes(), on_error);
        let mut ensemble = match py {
            Some(py) => detached(py, error::propagation, make)?,
            None => make().map_err(error::propagation)?,
        };
        let mut orbits = None;
        for (name, value) in options.into_iter().flat_map(|options| options.iter()) {
            let name: String = name.extract()?;
            ensemble = match &name[..] {
                "tolerance" => ensemble.tolerance(tolerance(&value)?),
                "method" => ensemble.method(value.extract::<String>()?.parse().map_err(error::propagation)?),
                "level" => ensemble.level(value.extract::<String>()?.parse().map_err(error::propagation)?),
                "torques" => ensemble.torques(torque::torques(&value)?),
                "span" => {
                    let [start, stop] = span_of(&value, time, calendar)?;
                    ensemble.span(start, stop)
                }
                "orbit" => {
                    orbits = orbits_given(Some(&value), None)?;
                    ensemble
                }
                _ => return Err(unknown(&name)),
            };
        }
        let ensemble = asked(ensemble, orbits, None, threads).map_err(error::propagation)?;
        ensemble.validate().map_err(error::propagation)?;
        Ok((ensemble, calendar))
    }
}

fn unknown(name: &str) -> PyErr {
    let text = format!(
        "{name} is not an option of Ensemble.from_periods: orbit, torques, tolerance, method, level and span are"
    );
    pyo3::exceptions::PyTypeError::new_err(text)
}

fn modes_of(value: &Bound<'_, PyAny>) -> PyResult<Vec<Mode>> {
    let mode = |name: String| name.parse().map_err(error::propagation);
    match value.extract::<String>() {
        Ok(name) => Ok(vec![mode(name)?]),
        Err(_) => value.extract::<Vec<String>>()?.into_iter().map(mode).collect(),
    }
}

/// Vectors, or longitudes and latitudes.
fn directions_of(value: &Bound<'_, PyAny>) -> PyResult<Vec<Result<Vector3<f64>, Error>>> {
    if let Ok(pairs) = MemberRows::<2>::new("directions", value) {
        let towards = |[longitude, latitude]: [f64; 2]| {
            ObservedPeriods::new(1.0, 1.0).towards(longitude, latitude).map(|periods| periods.momentum_direction)
        };
        return Ok(pairs.rows().into_iter().map(towards).collect());
    }
    let shapes = "(m, 3), (3,), (m, 2) or (2,)";
    let vectors = MemberRows::<3>::of_shape("directions", value, shapes)?;
    Ok(vectors.rows().into_iter().map(|vector| Ok(vector.into())).collect())
}
