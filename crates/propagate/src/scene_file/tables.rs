//! The tables of a scene file, as serde reads and writes them.
//!
//! A key that has no field here is an error. Optional keys that are absent are not written.

use std::collections::BTreeMap;

use std::fmt;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::input::options::{Averaging, Convention, Level, Method};
use crate::torque_free::mode::Mode;

/// The whole file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) source: Option<String>,
    #[serde(default)]
    pub(super) epoch: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) span: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) tolerance: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) method: Option<Method>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) order: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) averaging: Option<Averaging>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) level: Option<Level>,
    pub(super) body: BodyTable,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) state: Option<StateTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) periods: Option<PeriodsTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) orbit: Option<OrbitTables>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) torque: Vec<TorqueTable>,
}

/// `[[torque]]`: one of constant, damping, rotor and polynomial.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TorqueTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) constant: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) damping: Option<[[f64; 3]; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) rotor: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) dissipation: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) polynomial: Option<[String; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) truncation: Option<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) source: Vec<SourceTable>,
}

/// `[[torque.source]]`: of a polynomial, with a direction or an orbit.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SourceTable {
    pub(super) name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) power: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) reference_distance: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) law: Option<LawTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) direction: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) orbit: Option<OrbitTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) field: Option<FieldTable>,
}

/// `[torque.source.law]`: a Chebyshev series in r₀/r.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LawTable {
    pub(super) coefficients: Vec<f64>,
    pub(super) between: [f64; 2],
}

/// `[torque.source.field]`: of a dipole, at a body on the orbit of the source.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FieldTable {
    pub(super) radius: f64,
    pub(super) equatorial: f64,
    pub(super) axis: Option<[f64; 3]>,
    pub(super) rotation_rate: Option<f64>,
}

/// `[body]`: one of moments, named and inertia.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) moments: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) named: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) inertia: Option<[[f64; 3]; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) gravity: Option<GravityTable>,
}

/// `[body.gravity]`: unnormalized coefficients by their names.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GravityTable {
    pub(super) radius: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) inertia_factor: Option<f64>,
    pub(super) coefficients: BTreeMap<String, f64>,
}

/// `[state]`: inertial, or against an orbital frame.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StateTable {
    /// A quaternion; against an orbital frame also three angles.
    pub(super) attitude: Vec<f64>,
    pub(super) angular_velocity: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) frame: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) elements_of: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) relative: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) sequence: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) of: Option<usize>,
}

/// `[periods]`, in the place of a state.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PeriodsTable {
    pub(super) precession: f64,
    pub(super) rotation: f64,
    pub(super) mode: Option<Mode>,
    #[serde(default)]
    pub(super) convention: Convention,
    /// Three inertial components, or longitude and latitude.
    pub(super) momentum_direction: Option<Vec<f64>>,
    #[serde(default)]
    pub(super) phases: [f64; 2],
    pub(super) sense: Option<f64>,
    pub(super) attitude: Option<[f64; 4]>,
}

/// `[orbit]`: the elements of an orbit, or a table of positions.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OrbitTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) mean_motion: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) eccentricity: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) time_of_pericentre: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) inclination: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) node: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) argument_of_pericentre: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) mass_fraction: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) node_rate: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) pericentre_rate: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) attraction: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) semi_major_axis: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) times: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) positions: Option<Vec<[f64; 3]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) velocities: Option<Vec<[f64; 3]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) gm: Option<f64>,
}

/// `[orbit]`, or one `[[orbit]]` for each of several disturbing bodies.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(super) enum OrbitTables {
    One(Box<OrbitTable>),
    Several(Vec<OrbitTable>),
}

impl<'de> Deserialize<'de> for OrbitTables {
    /// By the kind of the value. serde's `untagged` would lose the key of an error.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;

        impl<'de> Visitor<'de> for Either {
            type Value = OrbitTables;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table or an array of tables")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<OrbitTables, A::Error> {
                Deserialize::deserialize(MapAccessDeserializer::new(map)).map(OrbitTables::One)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<OrbitTables, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(OrbitTables::Several)
            }
        }

        deserializer.deserialize_any(Either)
    }
}
