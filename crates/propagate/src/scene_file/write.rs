//! From a scene to the tables of a file.

use super::tables::{
    BodyTable, FieldTable, GravityTable, LawTable, OrbitTable, OrbitTables, SceneTable, SourceTable, StateTable,
    TorqueTable,
};
use crate::input::body::Body;
use crate::input::gravity::Gravity;
use crate::input::options::{Averaging, Level};
use crate::input::scene::Scene;
use crate::input::torque::Torque;
use crate::input::torque_source::{SourcePath, TorqueSource};
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;
use crate::orbit::field::DipoleField;
use crate::orbit::table::TabulatedOrbit;

impl SceneTable {
    /// The tables of a scene. Options that only a scene with a disturbing body needs are left out of the others.
    pub(super) fn of(scene: &Scene) -> Self {
        let state = scene.state();
        let disturbing = scene.asked_disturbing();
        let disturbed = !disturbing.is_empty();
        let (averaging, level) = (scene.asked_averaging(), scene.asked_level());
        Self {
            name: scene.asked_name().map(str::to_owned),
            source: scene.asked_source().map(str::to_owned),
            epoch: state.epoch,
            span: scene.asked_span().map(<[f64; 2]>::from),
            tolerance: Some(scene.asked_tolerance()),
            method: Some(scene.asked_method()),
            order: scene.asked_order(),
            averaging: (disturbed || averaging != Averaging::default()).then_some(averaging),
            level: (disturbed || level != Level::default()).then_some(level),
            body: BodyTable::of(scene.body()),
            state: Some(StateTable {
                attitude: state.attitude.coords.as_slice().to_vec(),
                angular_velocity: state.angular_velocity.into(),
                ..StateTable::default()
            }),
            periods: None,
            orbit: match disturbing {
                [] => None,
                [body] => Some(OrbitTables::One(Box::new(OrbitTable::of(body)))),
                bodies => Some(OrbitTables::Several(bodies.iter().map(OrbitTable::of).collect())),
            },
            torque: scene.asked_torques().iter().map(TorqueTable::of).collect(),
        }
    }
}

impl TorqueTable {
    pub(super) fn of(torque: &Torque) -> Self {
        let none = Self::default();
        match torque {
            Torque::Constant(torque) => Self { constant: Some(*torque), ..none },
            Torque::Damping(matrix) => Self { damping: Some(*matrix), ..none },
            Torque::Rotor(momentum) => Self { rotor: Some(*momentum), ..none },
            Torque::Dissipation(_) => Self { dissipation: Some(true), ..none },
            Torque::Polynomial(torque) => Self {
                polynomial: Some(torque.texts().clone()),
                truncation: (torque.truncation() != 0.0).then_some(torque.truncation()),
                source: torque.sources().iter().map(SourceTable::of).collect(),
                ..none
            },
        }
    }
}

impl FieldTable {
    fn of(field: &DipoleField) -> Self {
        Self {
            radius: field.radius(),
            equatorial: field.equatorial(),
            axis: Some(field.moment_axis()),
            rotation_rate: Some(field.rotation_rate()),
        }
    }
}

impl SourceTable {
    fn of(source: &TorqueSource) -> Self {
        let (power, distance) = source.distance_power();
        let (direction, orbit, field) = match source.path() {
            SourcePath::Direction(direction) => (Some(*direction), None, None),
            SourcePath::Orbit(orbit) => (None, Some(OrbitTable::of_orbit(orbit)), None),
            SourcePath::Tabulated(table) => (None, Some(OrbitTable::of_table(table)), None),
            SourcePath::Field(field) => (None, Some(OrbitTable::of_orbit(field.orbit())), Some(FieldTable::of(field))),
        };
        let falls = power != 0.0;
        Self {
            name: source.name().to_owned(),
            power: falls.then_some(power),
            reference_distance: falls.then_some(distance),
            law: source.law().map(|law| LawTable { coefficients: law.coefficients().to_vec(), between: law.between() }),
            direction,
            orbit,
            field,
        }
    }
}

impl BodyTable {
    pub(super) fn of(body: &Body) -> Self {
        let tensor = body.has_tensor();
        Self {
            moments: (!tensor).then(|| body.moments()),
            named: None,
            inertia: tensor.then(|| body.inertia()),
            name: body.name().map(str::to_owned),
            gravity: body.gravity().map(GravityTable::of),
        }
    }
}

impl GravityTable {
    pub(super) fn of(gravity: &Gravity) -> Self {
        Self {
            radius: gravity.radius(),
            inertia_factor: gravity.asked_inertia_factor(),
            coefficients: gravity.coefficients().iter().cloned().collect(),
        }
    }
}

impl OrbitTable {
    pub(super) fn of(body: &DisturbingBody) -> Self {
        match body {
            DisturbingBody::Orbit(orbit) => Self::of_orbit(orbit),
            DisturbingBody::Tabulated(table) => Self::of_table(table),
        }
    }

    pub(super) fn of_table(table: &TabulatedOrbit) -> Self {
        Self {
            times: Some(table.times().to_vec()),
            positions: Some(table.positions().to_vec()),
            velocities: table.velocities().map(<[_]>::to_vec),
            gm: Some(table.gm()),
            ..Self::default()
        }
    }

    pub(super) fn of_orbit(orbit: &Orbit) -> Self {
        let [mean_motion, eccentricity, time_of_pericentre, inclination, node, argument_of_pericentre, mass_fraction] =
            orbit.elements().map(Some);
        let [node_rate, pericentre_rate] = orbit.rates().map(|rate| (rate != 0.0).then_some(rate));
        Self {
            mean_motion,
            eccentricity,
            time_of_pericentre,
            inclination,
            node,
            argument_of_pericentre,
            mass_fraction,
            node_rate,
            pericentre_rate,
            attraction: orbit.asked_attraction(),
            semi_major_axis: orbit.asked_semi_major_axis(),
            ..Self::default()
        }
    }
}
