//! From the tables of a file to a scene.

use std::sync::Arc;

use nalgebra::Vector3;

use super::refusal::Refusal;
use super::tables::{
    BodyTable, FieldTable, GravityTable, LawTable, OrbitTable, OrbitTables, PeriodsTable, SceneTable, SourceTable,
    StateTable, TorqueTable,
};
use crate::input::body::Body;
use crate::input::distance_law::DistanceLaw;
use crate::input::gravity::Gravity;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::input::torque::Torque;
use crate::input::torque_source::{SourcePath, TorqueSource};
use crate::observed::periods::ObservedPeriods;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;
use crate::orbit::field::DipoleField;
use crate::orbit::table::TabulatedOrbit;
use crate::orbital::{EulerSequence, OrbitalFrame};

impl SceneTable {
    pub(super) fn scene(self) -> Result<Scene, Refusal> {
        let body = self.body.body()?;
        let bodies = self.orbit.map_or(Ok(Vec::new()), OrbitTables::bodies)?;
        let mut scene = match (self.state, self.periods) {
            (Some(_), Some(_)) => {
                return Err(Refusal::new("periods", "stands beside state: a scene has one or the other", "alone"));
            }
            (None, None) => return Err(Refusal::missing("state")),
            (Some(state), None) => state.scene(body, &bodies, self.epoch)?,
            (None, Some(periods)) => Scene::from_periods(body, &periods.periods(self.epoch)?)?,
        };
        if let Some(tolerance) = self.tolerance {
            scene = scene.tolerance(tolerance);
        }
        if let Some([start, stop]) = self.span {
            scene = scene.span(start, stop);
        }
        if let Some(order) = self.order {
            scene = scene.order(order);
        }
        if let Some(name) = &self.name {
            scene = scene.name(name);
        }
        if let Some(source) = &self.source {
            scene = scene.source(source);
        }
        let scene = scene.method(self.method.unwrap_or_default());
        let torques = self.torque.into_iter().map(TorqueTable::torque).collect::<Result<Vec<_>, _>>()?;
        #[cfg(feature = "torques")]
        let scene = {
            let (averaging, level) = (self.averaging.unwrap_or_default(), self.level.unwrap_or_default());
            scene.averaging(averaging).level(level).disturbing(bodies).torques(torques)
        };
        #[cfg(not(feature = "torques"))]
        for (key, given) in [("orbit", !bodies.is_empty()), ("torque", !torques.is_empty())] {
            if given {
                return Err(Refusal::new(key, "acts, and this build has the feature \"torques\" left out", "absent"));
            }
        }
        scene.validate()?;
        Ok(scene)
    }
}

impl StateTable {
    fn scene(self, body: Body, bodies: &[DisturbingBody], epoch: f64) -> Result<Scene, Refusal> {
        let refused =
            |bound: &str| Refusal::new("state.attitude", &format!("has another length: it must be {bound}"), bound);
        let inertial = |attitude: [f64; 4]| State::new(epoch, attitude, self.angular_velocity);
        let Some(frame) = &self.frame else {
            let of_frame =
                [self.elements_of.is_some(), self.relative.is_some(), self.sequence.is_some(), self.of.is_some()];
            let names = ["elements_of", "relative", "sequence", "of"];
            if let Some((_, name)) = of_frame.into_iter().zip(names).find(|(given, _)| *given) {
                return Err(Refusal::new(
                    &format!("state.{name}"),
                    "needs state.frame, \"rtn\" or \"lvlh\"",
                    "beside frame",
                ));
            }
            let attitude = self.attitude.as_slice().try_into().map_err(|_| refused("a quaternion [x, y, z, w]"))?;
            return Ok(Scene::new(body, inertial(attitude)?));
        };
        let elements_of = self.elements_of.as_deref().ok_or_else(|| Refusal::missing("state.elements_of"))?.parse()?;
        let frame = OrbitalFrame { elements_of, axes: frame.parse()?, of: self.of.unwrap_or(0) };
        let sequence: EulerSequence = self.sequence.as_deref().unwrap_or("ZYX").parse()?;
        let attitude = match self.attitude[..] {
            [x, y, z, w] => inertial([x, y, z, w])?.attitude,
            [first, second, third] => sequence.attitude([first, second, third]),
            _ => return Err(refused("a quaternion [x, y, z, w], or three angles")),
        };
        let relative = self.relative.unwrap_or(true);
        Ok(Scene::against(body, bodies, &frame, attitude, self.angular_velocity.into(), relative, epoch)?)
    }
}

impl TorqueTable {
    pub(super) fn torque(self) -> Result<Torque, Refusal> {
        if self.dissipation.is_some() {
            let bound = "absent: inner friction is a function, and a file holds none";
            return Err(Refusal::new("torque.dissipation", &format!("must be {bound}"), bound));
        }
        let no_source = self.source.is_empty() && self.truncation.is_none();
        Ok(match (self.constant, self.damping, self.rotor, self.polynomial) {
            (Some(torque), None, None, None) if no_source => Torque::constant(torque)?,
            (None, Some(matrix), None, None) if no_source => Torque::damping(matrix)?,
            (None, None, Some(momentum), None) if no_source => Torque::rotor(momentum)?,
            (None, None, None, Some(texts)) => {
                let sources = self.source.into_iter().map(SourceTable::source).collect::<Result<Vec<_>, _>>()?;
                let torque = Torque::polynomial(texts.each_ref().map(String::as_str), sources)?;
                self.truncation.map_or(Ok(torque.clone()), |truncation| torque.truncated(truncation))?
            }
            _ => {
                let bound = "one of constant, damping, rotor, and polynomial with its sources";
                return Err(Refusal::new("torque", &format!("must have {bound}"), bound));
            }
        })
    }
}

impl FieldTable {
    fn field(self, orbit: Orbit) -> Result<DipoleField, Refusal> {
        let field = DipoleField::new(orbit, self.radius, self.equatorial)?;
        let field = field.axis(self.axis.unwrap_or([0.0, 0.0, 1.0]))?;
        Ok(field.rotating(self.rotation_rate.unwrap_or(0.0))?)
    }
}

impl SourceTable {
    fn source(self) -> Result<TorqueSource, Refusal> {
        let path = match (self.direction, self.orbit, self.field) {
            (Some(direction), None, None) => SourcePath::Direction(direction),
            (None, Some(table), Some(field)) => {
                match table.body().map_err(|refusal| refusal.under("torque.source"))? {
                    DisturbingBody::Orbit(orbit) => SourcePath::Field(Arc::new(field.field(orbit)?)),
                    DisturbingBody::Tabulated(_) => {
                        let bound = "with an orbit by its elements; a table has the vectors of the field itself";
                        return Err(Refusal::new("torque.source.field", &format!("must be {bound}"), bound));
                    }
                }
            }
            (None, Some(table), None) => match table.body().map_err(|refusal| refusal.under("torque.source"))? {
                DisturbingBody::Orbit(orbit) => SourcePath::Orbit(orbit),
                DisturbingBody::Tabulated(table) => SourcePath::Tabulated(table),
            },
            _ => {
                let bound = "a direction or an orbit";
                return Err(Refusal::new("torque.source", &format!("must have {bound}"), bound));
            }
        };
        let source = TorqueSource::new(&self.name, path);
        let source = source.falling(self.power.unwrap_or(0.0), self.reference_distance);
        Ok(match self.law {
            Some(LawTable { coefficients, between }) => {
                source.following(Arc::new(DistanceLaw::new(coefficients, between)?))
            }
            None => source,
        })
    }
}

impl BodyTable {
    pub(super) fn body(self) -> Result<Body, Refusal> {
        let body = match (self.moments, self.named, self.inertia) {
            (Some(moments), None, None) => Body::new(moments)?,
            (None, Some(name), None) => Body::named(&name)?,
            (None, None, Some(tensor)) => Body::from_inertia(tensor)?,
            (None, None, None) => {
                return Err(Refusal::new(
                    "body.moments",
                    "is missing: moments = [A, B, C], or named = \"ceres\" for a body of the catalogue, or inertia for a tensor",
                    "moments, named or inertia",
                ));
            }
            (Some(_), Some(_), _) => {
                return Err(Refusal::new("body.named", "stands beside moments: a body has one or the other", "alone"));
            }
            _ => {
                let problem = "stands beside moments or named: a body has one of them";
                return Err(Refusal::new("body.inertia", problem, "alone"));
            }
        };
        let body = match self.gravity {
            Some(gravity) => body.with_gravity(gravity.field()?)?,
            None => body,
        };
        Ok(match self.name {
            Some(name) => body.with_name(&name),
            None => body,
        })
    }
}

impl GravityTable {
    pub(super) fn field(self) -> Result<Gravity, Refusal> {
        let named: Vec<(&str, f64)> = self.coefficients.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let field = Gravity::new(&named, self.radius)?;
        Ok(match self.inertia_factor {
            Some(factor) => field.inertia_factor(factor)?,
            None => field,
        })
    }
}

impl PeriodsTable {
    fn periods(self, epoch: f64) -> Result<ObservedPeriods, Refusal> {
        let mut periods = ObservedPeriods::new(self.precession, self.rotation);
        periods.mode = self.mode.unwrap_or(periods.mode);
        let attitude = self.attitude.map(|attitude| State::new(epoch, attitude, [0.0; 3])).transpose()?;
        let attitude = attitude.map(|state| state.attitude);
        let (convention, phases, sense) = (self.convention, self.phases, self.sense);
        let periods = ObservedPeriods { epoch, convention, phases, sense, attitude, ..periods };
        match self.momentum_direction.as_deref() {
            None => Ok(periods),
            Some(&[longitude, latitude]) => Ok(periods.towards(longitude, latitude)?),
            Some(&[x, y, z]) => Ok(ObservedPeriods { momentum_direction: Vector3::new(x, y, z), ..periods }),
            Some(_) => {
                let bound = "three inertial components, or longitude and latitude";
                Err(Refusal::new(
                    "periods.momentum_direction",
                    &format!("has another length: it must be {bound}"),
                    bound,
                ))
            }
        }
    }
}

impl OrbitTables {
    fn bodies(self) -> Result<Vec<DisturbingBody>, Refusal> {
        match self {
            Self::One(orbit) => Ok(vec![orbit.body()?]),
            Self::Several(orbits) => orbits.into_iter().map(OrbitTable::body).collect(),
        }
    }
}

impl OrbitTable {
    pub(super) fn body(self) -> Result<DisturbingBody, Refusal> {
        if self.times.is_none() && self.positions.is_none() && self.velocities.is_none() && self.gm.is_none() {
            return self.orbit().map(DisturbingBody::from);
        }
        if let Some(key) = self.first_element() {
            let problem = "stands beside a table of positions, which has times, positions and gm";
            return Err(Refusal::new(&format!("orbit.{key}"), problem, "alone"));
        }
        let missing = |key: &str| Refusal::missing(&format!("orbit.{key}"));
        let times = self.times.ok_or_else(|| missing("times"))?;
        let positions = self.positions.ok_or_else(|| missing("positions"))?;
        let gm = self.gm.ok_or_else(|| missing("gm"))?;
        let table = match self.velocities {
            Some(velocities) => TabulatedOrbit::with_velocities(times, positions, velocities, gm),
            None => TabulatedOrbit::new(times, positions, gm),
        };
        Ok(table?.into())
    }

    /// The key of the first element that is given.
    fn first_element(&self) -> Option<&'static str> {
        let elements = [
            ("mean_motion", self.mean_motion),
            ("eccentricity", self.eccentricity),
            ("time_of_pericentre", self.time_of_pericentre),
            ("inclination", self.inclination),
            ("node", self.node),
            ("argument_of_pericentre", self.argument_of_pericentre),
            ("mass_fraction", self.mass_fraction),
            ("node_rate", self.node_rate),
            ("pericentre_rate", self.pericentre_rate),
            ("attraction", self.attraction),
            ("semi_major_axis", self.semi_major_axis),
        ];
        elements.into_iter().find_map(|(key, element)| element.map(|_| key))
    }

    fn orbit(&self) -> Result<Orbit, Refusal> {
        let mean_motion = self.mean_motion.ok_or_else(|| Refusal::missing("orbit.mean_motion"))?;
        let [inclination, node, argument] =
            [self.inclination, self.node, self.argument_of_pericentre].map(Option::unwrap_or_default);
        let orbit = Orbit::new(mean_motion, self.eccentricity.unwrap_or_default())?
            .time_of_pericentre(self.time_of_pericentre.unwrap_or_default())?
            .plane(inclination, node, argument)?
            .mass_fraction(self.mass_fraction.unwrap_or(1.0))?
            .secular_rates(self.node_rate.unwrap_or_default(), self.pericentre_rate.unwrap_or_default())?;
        let orbit = self.attraction.map_or(Ok(orbit), |attraction| orbit.attraction(attraction))?;
        Ok(self.semi_major_axis.map_or(Ok(orbit), |length| orbit.semi_major_axis(length))?)
    }
}
