//! `andoyer.Ensemble.from_periods`: clones of a tumbler from periods that are published with their errors.

use std::f64::consts::TAU;
use std::ffi::CString;

use andoyer_propagate::nalgebra::Vector3;
use andoyer_propagate::options::Convention;
use andoyer_propagate::periods::ObservedPeriods;
use andoyer_propagate::{Body, Error, Mode, Scene};
use numpy::PyUntypedArrayMethods;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arguments::of_scenes;
use super::bodies::Bodies;
use crate::array::{MemberRows, numbers, numbers_of};
use crate::computing::detached;
use crate::error;
use crate::foreign::Calendar;
use crate::scene::arguments::epoch as epoch_of;

/// One value for all members, or one for each.
enum Column<T> {
    OfAll(T),
    OfEach(Vec<T>),
}

impl<T: Clone> Column<T> {
    /// One value, or an axis of them.
    fn new(mut values: Vec<T>, has_axis: bool) -> Self {
        match values.pop() {
            Some(value) if !has_axis => Self::OfAll(value),
            last => {
                values.extend(last);
                Self::OfEach(values)
            }
        }
    }

    fn of(&self, index: usize) -> T {
        match self {
            Self::OfAll(value) => value.clone(),
            Self::OfEach(values) => values[index].clone(),
        }
    }

    fn map<U>(self, of: impl Fn(T) -> U) -> Column<U> {
        match self {
            Self::OfAll(value) => Column::OfAll(of(value)),
            Self::OfEach(values) => Column::OfEach(values.into_iter().map(of).collect()),
        }
    }

    /// Warns if most values are beyond a whole turn: those of clones are drawn about one that is within it.
    fn doubt(&self, py: Python<'_>, beyond: impl Fn(&T) -> bool, name: &str, unit: &str) -> PyResult<()> {
        let values = match self {
            Self::OfAll(value) => std::slice::from_ref(value),
            Self::OfEach(values) => values,
        };
        if 2 * values.iter().filter(|value| beyond(value)).count() <= values.len() {
            return Ok(());
        }
        let said = CString::new(format!("{name}: most are more than a whole turn: {unit}"))?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &said, 1)
    }

    /// The number of members that the column has a value for, if it is not one for all.
    fn members(&self, name: &'static str) -> Option<(&'static str, usize)> {
        match self {
            Self::OfAll(_) => None,
            Self::OfEach(values) => Some((name, values.len())),
        }
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
        bodies_given: &Bound<'_, PyAny>,
        [precession, rotation]: [&Bound<'_, PyAny>; 2],
        mode: Option<&Bound<'_, PyAny>>,
        directions: Option<&Bound<'_, PyAny>>,
        phases: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let bodies = Bodies::any(bodies_given)?;
        let has_axis = bodies.rows().is_some();
        let bodies = Column::new(bodies.each(), has_axis);
        let periods = [periods_of("precession", precession)?, periods_of("rotation", rotation)?];
        let modes = mode.map_or_else(|| Ok(Column::OfAll(Mode::ShortAxis)), modes_of)?;
        let directions = directions.map_or_else(|| Ok(Column::OfAll(Ok(Vector3::z()))), directions_of)?;
        let phases = phases.map(|value| MemberRows::new("phases", value)).transpose()?;
        let phases = phases.map_or(Column::OfAll([0.0; 2]), |rows| column(rows, |phases| phases));
        phases.doubt(
            bodies_given.py(),
            |[one, other]| one.abs().max(other.abs()) > 1.0,
            "phases",
            "phases are in turns, not in degrees or radians",
        )?;
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
        let (time, calendar) = epoch_of(epoch)?;
        let scenes = || (0..self.members).map(|index| self.scene(index, convention, time)).collect();
        let scenes = match options.map(Bound::py) {
            Some(py) => detached(py, error::propagation, || Ok(scenes()))?,
            None => scenes(),
        };
        let ensemble = of_scenes(scenes, (time, calendar), (threads, on_error), options, "Ensemble.from_periods")?;
        Ok((ensemble, calendar))
    }
}

fn periods_of(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Column<f64>> {
    let periods = numbers_of(name, value)?;
    let has_axis = numbers(name, value)?.ndim() > 0;
    Ok(Column::new(periods, has_axis))
}

fn modes_of(value: &Bound<'_, PyAny>) -> PyResult<Column<Mode>> {
    let mode = |name: String| name.parse().map_err(error::propagation);
    match value.extract::<String>() {
        Ok(name) => mode(name).map(Column::OfAll),
        Err(_) => value.extract::<Vec<String>>()?.into_iter().map(mode).collect::<PyResult<_>>().map(Column::OfEach),
    }
}

/// Vectors, or longitudes and latitudes.
fn directions_of(value: &Bound<'_, PyAny>) -> PyResult<Column<Result<Vector3<f64>, Error>>> {
    if let Ok(pairs) = MemberRows::<2>::new("directions", value) {
        let angles = column(pairs, |angles| angles);
        let unit = "angles are in radians, not in degrees";
        angles.doubt(value.py(), |[longitude, _]| longitude.abs() > TAU, "directions", unit)?;
        return Ok(angles.map(|[longitude, latitude]| {
            ObservedPeriods::new(1.0, 1.0).towards(longitude, latitude).map(|periods| periods.momentum_direction)
        }));
    }
    let vectors = MemberRows::<3>::of_shape("directions", value, "(m, 3), (3,), (m, 2) or (2,)")?;
    Ok(column(vectors, |vector| Ok(vector.into())))
}

fn column<const N: usize, T: Clone>(rows: MemberRows<N>, of: impl FnMut([f64; N]) -> T) -> Column<T> {
    let has_axis = rows.members().is_some();
    Column::new(rows.rows().into_iter().map(of).collect(), has_axis)
}
