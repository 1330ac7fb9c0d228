//! The source of a torque: where it is, and how the torque changes with its distance.

use std::sync::Arc;

use super::distance_law::DistanceLaw;
use crate::error::{Error, torque_refused};
use crate::orbit::elements::Orbit;
use crate::orbit::field::DipoleField;
use crate::orbit::table::TabulatedOrbit;

/// Largest magnitude of a power of a distance.
const MOST_POWER: f64 = 100.0;
/// Places between two rows of a table at which its distance is looked at.
const PLACES_OF_TABLE: usize = 16;

/// A source that a polynomial names.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueSource {
    name: String,
    path: SourcePath,
    power: f64,
    /// None if it is needed and was not given: `validate` refuses such a source.
    reference_distance: Option<f64>,
    /// A function of (r₀/r)^power in the place of that power.
    law: Option<Arc<DistanceLaw>>,
}

/// Where a source is.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SourcePath {
    /// The position on the orbit of these elements, from the rotating body to the source; the distance is in units of the semi-major axis if that is not given. With the
    /// elements of the rotating body about the source the vector is the opposite one: terms of odd degree in it change their sign.
    Orbit(Orbit),
    /// A body with a table of positions.
    Tabulated(Arc<TabulatedOrbit>),
    /// The field of a dipole. Its direction is that of the field, and its "distance" the size: with the power −p the torque is multiplied by (|B|/r₀)^p.
    Field(Arc<DipoleField>),
    /// A fixed inertial direction, of any length.
    Direction([f64; 3]),
}

impl SourcePath {
    /// The nearest and the farthest distance, in the unit of length of the path: of an orbit without a semi-major axis in this. Those of a table are looked for at its rows and at places between them.
    ///
    /// # Errors
    /// - [`Error::Torque`] for a direction and a field, which have no distance.
    pub(crate) fn distances(&self) -> Result<[f64; 2], Error> {
        match self {
            Self::Orbit(orbit) => {
                let (size, e) = (orbit.asked_semi_major_axis().unwrap_or(1.0), orbit.eccentricity());
                let farthest = if orbit.is_hyperbola() { f64::INFINITY } else { size * (1.0 + e) };
                Ok([size * (1.0 - e).abs(), farthest])
            }
            Self::Tabulated(table) => {
                let [x, y, z] = table.positions()[table.positions().len() - 1];
                let last = x.hypot(y).hypot(z);
                let mut ends = [last; 2];
                for pair in table.times().windows(2) {
                    for k in 0..PLACES_OF_TABLE {
                        let time = (pair[1] - pair[0]).mul_add(k as f64 / PLACES_OF_TABLE as f64, pair[0]);
                        let [x, y, z] = table.position(time)?;
                        let distance = x.hypot(y).hypot(z);
                        ends = [ends[0].min(distance), ends[1].max(distance)];
                    }
                }
                Ok(ends)
            }
            Self::Field(_) | Self::Direction(_) => {
                Err(torque_refused("law", "a law of the distance", "absent: the source has no distance"))
            }
        }
    }
}

impl TorqueSource {
    /// A source by its name.
    pub fn new(name: &str, path: SourcePath) -> Self {
        let path = match path {
            SourcePath::Direction(vector) => SourcePath::Direction(vector.map(unsigned)),
            path => path,
        };
        Self { name: name.to_owned(), path, power: 0.0, reference_distance: Some(1.0), law: None }
    }

    /// Multiplies the torque by (r₀/r)^power. For an orbit without a semi-major axis r₀ is in semi-major axes, by default 1. For an orbit with one, and for a table,
    /// it is in their unit of length and has no default: [`Torque::polynomial`](crate::torques::Torque::polynomial) refuses `None`.
    #[must_use]
    pub fn falling(self, power: f64, reference_distance: impl Into<Option<f64>>) -> Self {
        let default = (!self.has_length()).then_some(1.0);
        // Without a power no distance counts.
        let reference_distance = if power == 0.0 { Some(1.0) } else { reference_distance.into().or(default) };
        Self { power, reference_distance, ..self }
    }

    /// Multiplies the torque by a law of (r₀/r)^power in the place of this power, which is 1.
    #[must_use]
    pub fn following(self, law: Arc<DistanceLaw>) -> Self {
        Self { law: Some(law), ..self }
    }

    /// True if its distances are in a unit of length of the user.
    fn has_length(&self) -> bool {
        match &self.path {
            SourcePath::Orbit(orbit) => orbit.asked_semi_major_axis().is_some(),
            SourcePath::Tabulated(_) => true,
            SourcePath::Field(_) | SourcePath::Direction(_) => false,
        }
    }

    /// The name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Where the source is.
    pub fn path(&self) -> &SourcePath {
        &self.path
    }

    /// The power p of (r₀/r)^p, and r₀.
    pub fn distance_power(&self) -> (f64, f64) {
        (self.power, self.reference_distance.unwrap_or(1.0))
    }

    /// The law of x = r₀/r, if it is no power.
    pub fn law(&self) -> Option<&Arc<DistanceLaw>> {
        self.law.as_ref()
    }

    pub(crate) fn validate(&self) -> Result<(), Error> {
        let Self { name, path, power, reference_distance, law } = self;
        let identifier =
            name.chars().next().is_some_and(char::is_alphabetic) && name.chars().all(char::is_alphanumeric);
        if !identifier || name == "w" {
            return Err(torque_refused("sources", name, "named by letters and digits, a letter first, and not w"));
        }
        let direction = matches!(path, SourcePath::Direction(_));
        if direction && *power != 0.0 {
            return Err(torque_refused(
                "distance_powers",
                format!("{name}: {power}"),
                "absent: a direction has no distance",
            ));
        }
        if !(power.is_finite() && power.abs() <= MOST_POWER) {
            return Err(torque_refused(
                "distance_powers",
                format!("{name}: {power}"),
                "finite and at most 100 in magnitude",
            ));
        }
        let Some(reference_distance) = reference_distance else {
            let bound = "given, in the unit of length of semi_major_axis or of the table: the distance at which the texts have the torque, of a shape its `at`";
            return Err(torque_refused("reference_distances", format!("{name}: none"), bound));
        };
        if !(*reference_distance > 0.0 && reference_distance.is_finite()) {
            return Err(torque_refused(
                "reference_distances",
                format!("{name}: {reference_distance}"),
                "positive and finite",
            ));
        }
        if law.is_some() && (*power != 1.0 || matches!(path, SourcePath::Field(_))) {
            return Err(torque_refused("law", format!("{name}: {power}"), "of r0/r: with the power 1 of a distance"));
        }
        if let Some(law) = law {
            for distance in path.distances()? {
                law.within(reference_distance / distance)?;
            }
        }
        match path {
            SourcePath::Direction(vector)
                if !(vector.iter().all(|x| x.is_finite()) && vector.iter().any(|x| *x != 0.0)) =>
            {
                Err(torque_refused("sources", format!("{name}: {vector:?}"), "a finite vector other than 0"))
            }
            _ => Ok(()),
        }
    }
}

/// A number whose 0 has no sign, so that equal torques print and hash alike.
pub(super) fn unsigned(number: f64) -> f64 {
    number + 0.0
}
