//! A body whose gravity gradient acts: on an orbit, or by a table of positions.

use std::sync::Arc;

use super::orbit::Orbit;
use super::tabulated::TabulatedOrbit;

/// A disturbing body.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DisturbingBody {
    /// On a Keplerian orbit, fixed or with secular rates.
    Orbit(Orbit),
    /// By a table of positions.
    Tabulated(Arc<TabulatedOrbit>),
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
