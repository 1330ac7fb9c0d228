//! Scenes, bodies, states, samples, orbits and torques for serde.
//!
//! Each is the table that a scene file has of it, and is checked as one. Formats that describe themselves, such as JSON and TOML, hold them; others, such as bincode, do not.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::refusal::Refusal;
use super::tables::{BodyTable, GravityTable, OrbitTable, SceneTable, TorqueTable};
use crate::input::body::Body;
use crate::input::gravity::Gravity;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::input::torque::Torque;
use crate::motion::solved::Sample;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;
use crate::orbit::table::TabulatedOrbit;

/// A state: attitude [x, y, z, w] and rates in body components.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StateAtEpoch {
    epoch: f64,
    attitude: [f64; 4],
    angular_velocity: [f64; 3],
}

impl StateAtEpoch {
    fn of(state: &State) -> Self {
        let (attitude, angular_velocity) = (state.attitude.coords.into(), state.angular_velocity.into());
        Self { epoch: state.epoch, attitude, angular_velocity }
    }

    fn state(self) -> Result<State, Refusal> {
        Ok(State::new(self.epoch, self.attitude, self.angular_velocity)?)
    }
}

/// A sample, as a state at its time.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SampleAtTime {
    time: f64,
    attitude: [f64; 4],
    angular_velocity: [f64; 3],
}

impl SampleAtTime {
    fn of(sample: &Sample) -> Self {
        let (attitude, angular_velocity) = (sample.attitude.coords.into(), sample.angular_velocity.into());
        Self { time: sample.time, attitude, angular_velocity }
    }

    fn sample(self) -> Result<Sample, Refusal> {
        let State { epoch: time, attitude, angular_velocity } =
            State::new(self.time, self.attitude, self.angular_velocity)?;
        Ok(Sample { time, attitude, angular_velocity })
    }
}

/// The traits of serde by a table: what writes it and what reads it.
macro_rules! by_table {
    ($($type:ty: $table:ty, $write:expr, $read:expr;)+) => {$(
        impl Serialize for $type {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let write: fn(&Self) -> $table = $write;
                write(self).serialize(serializer)
            }
        }

        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let read: fn($table) -> Result<Self, Refusal> = $read;
                read(<$table>::deserialize(deserializer)?).map_err(D::Error::custom)
            }
        }
    )+};
}

by_table! {
    Scene: SceneTable, SceneTable::of, SceneTable::scene;
    Body: BodyTable, BodyTable::of, BodyTable::body;
    Gravity: GravityTable, GravityTable::of, GravityTable::field;
    Torque: TorqueTable, TorqueTable::of, TorqueTable::torque;
    DisturbingBody: OrbitTable, OrbitTable::of, OrbitTable::body;
    Orbit: OrbitTable, OrbitTable::of_orbit, |table| match table.body()? {
        DisturbingBody::Orbit(orbit) => Ok(orbit),
        DisturbingBody::Tabulated(_) => Err(Refusal::new("orbit.times", "stands in an orbit by elements", "absent")),
    };
    TabulatedOrbit: OrbitTable, OrbitTable::of_table, |table| match table.body()? {
        DisturbingBody::Tabulated(table) => Ok((*table).clone()),
        DisturbingBody::Orbit(_) => Err(Refusal::missing("orbit.times")),
    };
    State: StateAtEpoch, StateAtEpoch::of, StateAtEpoch::state;
    Sample: SampleAtTime, SampleAtTime::of, SampleAtTime::sample;
}
