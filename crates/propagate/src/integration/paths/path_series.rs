//! The path of a disturbing body or of a source as a series: that of r̃ = √(3μ) ρ^(−5/2) r about a time, whose products with itself are the gravity gradient's torque;
//! for the source of another torque the power of ρ is that torque's. It comes from an orbit
//! ([`super::conic`]), from a table ([`super::interpolation`]) or from the field of a dipole ([`super::field`]).

use std::sync::Arc;

use super::conic::Conic;
use super::field::FieldSeries;
use super::interpolation::Table;
use crate::integration::series::{GRAVITY, Scalars, Series};
use crate::numerics::scaling::scaled;
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;
use crate::orbit::field::DipoleField;
use crate::orbit::table::TabulatedOrbit;
use crate::simd::instruction_set::InstructionSet;
use crate::torque::strength;

/// The path of a body, with times and rates in the unit of the integration.
#[derive(Clone, Debug)]
pub(crate) enum PathSeries {
    Conic(Box<Conic>),
    Tabulated(Box<Table>),
    Field(Box<FieldSeries>),
}

impl PathSeries {
    /// From the epoch of the scene and the exponent of the unit of rates.
    pub(crate) fn new(body: &DisturbingBody, epoch: f64, exponent: i32) -> Self {
        match body {
            DisturbingBody::Orbit(orbit) => {
                let strength = (2.0 * strength(orbit.strength_in(exponent))).sqrt();
                Self::of_orbit(orbit, (epoch, exponent), (strength, GRAVITY))
            }
            DisturbingBody::Tabulated(table) => {
                let length = Table::length(table);
                let strength = scaled((3.0 * table.gm() / length).sqrt() / length, -exponent);
                Self::of_table(table, (epoch, exponent), (strength, GRAVITY))
            }
        }
    }

    /// A path on an orbit whose series is a factor times a power of the distance in semi-major axes times the position.
    pub(crate) fn of_orbit(orbit: &Orbit, (epoch, exponent): (f64, i32), factor: (f64, f64)) -> Self {
        Self::Conic(Box::new(Conic::new(orbit, (epoch, exponent), factor)))
    }

    /// A path by a table whose series is a factor times a power of the distance times the position, both in units of [`Table::length`].
    pub(crate) fn of_table(table: &Arc<TabulatedOrbit>, (epoch, exponent): (f64, i32), factor: (f64, f64)) -> Self {
        Self::Tabulated(Box::new(Table::new(table, (epoch, exponent), factor)))
    }

    /// The field of a dipole, whose series is a factor times a power of its size times the field, both in units of the field on the equator.
    pub(crate) fn of_field(field: &DipoleField, at: (f64, i32), factor: (f64, f64)) -> Self {
        Self::Field(Box::new(FieldSeries::new(field, at, factor)))
    }

    /// The series of the factor and the power of the distance alone.
    pub(crate) fn factor<S: InstructionSet>(
        &self,
        simd: S,
        (time, backward): ((f64, f64), bool),
        order: usize,
    ) -> Scalars {
        match self {
            Self::Conic(orbit) => orbit.factor(simd, time, order),
            Self::Tabulated(table) => table.expanded((time, backward), order).1,
            Self::Field(field) => field.factor(simd, time, order),
        }
    }

    /// The first `order` coefficients about a time after the epoch, from which a step goes on or backwards. Returns the radius of convergence in units of time.
    #[inline(always)]
    pub(crate) fn series<S: InstructionSet>(
        &self,
        simd: S,
        (time, backward): ((f64, f64), bool),
        order: usize,
        out: &mut Series,
    ) -> f64 {
        match self {
            Self::Conic(orbit) => orbit.series(simd, time, order, out),
            Self::Tabulated(table) => table.series((time, backward), order, out),
            Self::Field(field) => field.series(simd, time, order, out),
        }
    }

    /// The next time after (or before) a time at which the series ends.
    pub(crate) fn next_knot(&self, time: f64, forward: bool) -> Option<(f64, f64)> {
        match self {
            Self::Conic(_) | Self::Field(_) => None,
            Self::Tabulated(table) => table.next_knot(time, forward),
        }
    }

    /// A measure of the steps from the epoch to a time: the integral of dt/R, where R is the radius of convergence, or the number of intervals of a table. The
    /// number of steps is proportional to it.
    pub(crate) fn passed(&self, time: (f64, f64)) -> f64 {
        match self {
            Self::Conic(orbit) => orbit.passed(time),
            Self::Tabulated(table) => table.passed(time),
            Self::Field(field) => field.passed(time),
        }
    }

    /// With the earlier or the later of the neighbouring polynomials, where it has a table.
    pub(crate) fn neighbouring(&self, earlier: bool) -> Self {
        match self {
            Self::Conic(_) | Self::Field(_) => self.clone(),
            Self::Tabulated(table) => Self::Tabulated(Box::new(table.neighbouring(earlier))),
        }
    }
}
