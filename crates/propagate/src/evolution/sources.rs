//! Where sources are, and how their torques are averaged over an orbit (weak torques (11)).

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;

use crate::error::Error;
use crate::input::distance_law::DistanceLaw;
use crate::input::torque_source::{SourcePath, TorqueSource};
use crate::orbit::elements::Orbit;
use crate::orbit::field::DipoleField;
use crate::orbit::table::TabulatedOrbit;

/// Least and most points of the true anomaly for a fall that is no integer power of 2 or more.
const MANY: [usize; 2] = [128, 4096];
/// −ln of a rounding error.
const DIGITS: f64 = 37.0;
/// Places on an orbit, and turns of the moment, of a field.
const PLACES: usize = 48;
const TURNS: usize = 12;
/// The largest degree of a torque.
const DEGREE: usize = 8;

/// A direction with the weight of the torque there; `zonal` multiplies it by P_l(0), for the mean over the circle about the direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) direction: Vector3<f64>,
    pub(super) weight: f64,
    pub(super) zonal: bool,
}

/// The source of a torque.
#[derive(Clone, Debug)]
pub(super) struct MovingSource {
    pub(super) path: SourcePath,
    pub(super) power: f64,
    /// In the unit of length of the path.
    pub(super) reference: f64,
    /// A function of (r₀/r)^power in the place of this power.
    pub(super) law: Option<Arc<DistanceLaw>>,
    /// Whether the torque is averaged over the orbit.
    pub(super) over_orbit: bool,
    /// The largest rate of its direction [rad/time]: at the pericentre, or between two rows of a table.
    pub(super) fastest: f64,
}

impl MovingSource {
    /// As users give it.
    pub(super) fn new(source: &TorqueSource) -> Self {
        let (power, reference) = source.distance_power();
        let unit = match source.path() {
            SourcePath::Orbit(orbit) => orbit.asked_semi_major_axis().unwrap_or(1.0),
            _ => 1.0,
        };
        Self { law: source.law().cloned(), ..Self::in_units(source.path().clone(), power, reference / unit) }
    }

    /// With the reference distance in the unit of length of the path.
    pub(super) fn in_units(path: SourcePath, power: f64, reference: f64) -> Self {
        let fastest = match &path {
            SourcePath::Orbit(orbit) => fastest_of_orbit(orbit),
            SourcePath::Tabulated(table) => fastest_of_table(table),
            SourcePath::Field(field) => 2.0 * fastest_of_orbit(field.orbit()) + field.rotation_rate().abs(),
            SourcePath::Direction(_) => 0.0,
        };
        Self { path, power, reference, law: None, over_orbit: false, fastest }
    }

    /// The orbit, if it is an ellipse.
    pub(super) fn ellipse(&self) -> Option<&Orbit> {
        match &self.path {
            SourcePath::Orbit(orbit) if !orbit.is_hyperbola() => Some(orbit),
            SourcePath::Field(field) if !field.orbit().is_hyperbola() => Some(field.orbit()),
            _ => None,
        }
    }

    /// The rate \[rad/time\] that limits a step to a sixth of its period. For a table a sixth of the period is four intervals. 0 for a source that is averaged.
    pub(super) fn rate_to_follow(&self) -> f64 {
        match &self.path {
            SourcePath::Tabulated(table) => {
                let (first, last) = table.ends();
                TAU / 24.0 * (table.times().len() - 1) as f64 / (last - first)
            }
            SourcePath::Field(field) => 2.0 * field.orbit().fastest() + field.rotation_rate().abs(),
            _ => 0.0,
        }
    }

    /// The directions and weights at a time.
    ///
    /// # Errors
    /// - [`Error::Orbit`], [`Error::Table`] for a time that the path does not reach.
    pub(super) fn views(&self, (epoch, time): (f64, f64), out: &mut Vec<View>) -> Result<(), Error> {
        out.clear();
        if self.over_orbit
            && let Some(orbit) = self.ellipse()
        {
            match &self.path {
                SourcePath::Field(field) => self.around_field(field, (epoch, time), out),
                _ => self.around(orbit, (epoch, time), out),
            }
            return Ok(());
        }
        let place = match &self.path {
            SourcePath::Orbit(orbit) => orbit.relative_position(epoch, time - epoch)?,
            SourcePath::Tabulated(table) => table.position(time)?.into(),
            SourcePath::Field(field) => field.at(epoch, time - epoch)?.into(),
            SourcePath::Direction(vector) => Vector3::from(*vector),
        };
        let distance = place.amax() * (place / place.amax()).norm();
        out.push(View { direction: place / distance, weight: self.weight(distance), zonal: false });
        Ok(())
    }

    /// The factor of the torque at a distance in the unit of the path.
    fn weight(&self, distance: f64) -> f64 {
        let power = if self.power == 0.0 { 1.0 } else { (self.reference / distance).powf(self.power) };
        self.law.as_ref().map_or(power, |law| law.value(power))
    }

    /// The mean over the orbit and over the turn of the moment, whose rates have no common multiple.
    fn around_field(&self, field: &DipoleField, (epoch, time): (f64, f64), out: &mut Vec<View>) {
        let orbit = field.orbit();
        let [to_pericentre, ahead, _] = orbit.axes_after(epoch, time - epoch);
        let e = orbit.eccentricity();
        let square = (1.0 - e) * (1.0 + e);
        let turns = if field.rotation_rate() == 0.0 { 1 } else { TURNS };
        for j in 0..PLACES {
            let (sine, cosine) = (TAU * (j as f64 + 0.5) / PLACES as f64).sin_cos();
            // dM/2π = (r/a)² df/(2π η)
            let radius = square / (1.0 + e * cosine);
            let share = radius * radius / square.sqrt() / (PLACES * turns) as f64;
            for turn in 0..turns {
                let angle = TAU * turn as f64 / turns as f64;
                let vector = field.of(&(to_pericentre * cosine + ahead * sine), radius, angle);
                let size = vector.norm();
                let weight = (self.reference / size).powf(self.power) * share;
                out.push(View { direction: vector / size, weight, zonal: false });
            }
        }
    }

    /// Points of the true anomaly f for a mean to rounding errors: the Fourier coefficients of 1/(1 + e cos f) fall with (e/(1 + η))^n.
    fn many(&self, e: f64) -> usize {
        let fall = ((1.0 + ((1.0 - e) * (1.0 + e)).sqrt()) / e).ln();
        let degree = self.law.as_ref().map_or(self.power.abs(), |law| law.coefficients().len() as f64);
        ((degree + DIGITS / fall).ceil() as usize + DEGREE).clamp(MANY[0], MANY[1])
    }

    /// The mean over the orbit: exact in one view for p = 2.
    fn around(&self, orbit: &Orbit, (epoch, time): (f64, f64), out: &mut Vec<View>) {
        let [to_pericentre, ahead, normal] = orbit.axes_after(epoch, time - epoch);
        let e = orbit.eccentricity();
        let square = (1.0 - e) * (1.0 + e);
        if self.power == 2.0 && self.law.is_none() {
            // ⟨(a/r)² ·⟩: ŝ → n̂, w_l → P_l(0)/√(1−e²)
            let weight = self.reference * self.reference / square.sqrt();
            out.push(View { direction: normal, weight, zonal: true });
            return;
        }
        let whole = self.power >= 2.0 && self.power.fract() == 0.0 && self.power < 100.0;
        let points = if whole { DEGREE + self.power as usize + 1 } else { self.many(e) };
        for j in 0..points {
            let (sine, cosine) = (TAU * (j as f64 + 0.5) / points as f64).sin_cos();
            // dM/2π = (r/a)² df/(2π η), r/a = η²/(1 + e cos f)
            let radius = square / (1.0 + e * cosine);
            let weight = self.weight(radius) * radius * radius / square.sqrt() / points as f64;
            out.push(View { direction: to_pericentre * cosine + ahead * sine, weight, zonal: false });
        }
    }
}

/// ḟ = n √|1 − e²|/(1 − e)² at the pericentre, or a secular rate.
fn fastest_of_orbit(orbit: &Orbit) -> f64 {
    let e = orbit.eccentricity();
    let at_pericentre = orbit.mean_motion() * ((1.0 - e) * (1.0 + e)).abs().sqrt() / ((1.0 - e) * (1.0 - e));
    at_pericentre.max(orbit.fastest())
}

/// The largest angle between neighbouring rows over the time between them.
fn fastest_of_table(table: &TabulatedOrbit) -> f64 {
    let rows = table.times().windows(2).zip(table.positions().windows(2));
    let rate = |(times, places): (&[f64], &[[f64; 3]])| {
        Vector3::from(places[0]).angle(&Vector3::from(places[1])) / (times[1] - times[0])
    };
    rows.filter(|(times, _)| times[0] < times[1]).map(rate).fold(0.0, f64::max)
}
