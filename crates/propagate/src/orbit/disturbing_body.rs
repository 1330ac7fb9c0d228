//! A disturbing body: its gravity gradient acts on the rotating body. Its position comes from an orbit or from a table.

use std::sync::Arc;

use super::elements::Orbit;
use super::table::TabulatedOrbit;
use crate::error::Error;

/// A disturbing body.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DisturbingBody {
    /// A body on a Keplerian orbit, fixed or with secular rates.
    Orbit(Orbit),
    /// A body with a table of positions.
    Tabulated(Arc<TabulatedOrbit>),
}

impl DisturbingBody {
    /// Whether doubles hold the torque that it exerts, in a unit of time of 2^−exponent.
    pub(crate) fn validate(&self, exponent: i32) -> Result<(), Error> {
        match self {
            Self::Orbit(orbit) => orbit.representable(exponent),
            Self::Tabulated(table) => table.representable(exponent),
        }
    }
}

impl From<Orbit> for DisturbingBody {
    fn from(orbit: Orbit) -> Self {
        Self::Orbit(orbit)
    }
}

impl From<TabulatedOrbit> for DisturbingBody {
    fn from(table: TabulatedOrbit) -> Self {
        Self::Tabulated(Arc::new(table))
    }
}
