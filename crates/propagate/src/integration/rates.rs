//! The rates that orbits, tables and sources of torques bring into an integration, and whether a table is fine enough for it.

use crate::error::Error;
use crate::input::scene::Scene;
use crate::input::torque::Torque;
use crate::input::torque_source::{SourcePath, TorqueSource};
use crate::numerics::scaling::{exponent, scaled};
use crate::orbit::disturbing_body::DisturbingBody;
use crate::orbit::elements::Orbit;
use crate::orbit::table::TabulatedOrbit;
use crate::torque::strength;

/// The error by the interpolation of tables, over the largest distance of the motions with the two neighbouring polynomials.
const OF_INTERPOLATION: f64 = 8.0;
/// Largest error of a position over the distance.
const FINE: f64 = 0.8;

/// Whether a table covers a span.
pub(super) fn covered(table: &TabulatedOrbit, (start, stop): (f64, f64)) -> Result<(), Error> {
    let (first, last) = table.ends();
    if start < first || stop > last { Err(Error::TableSpan { start, stop, first, last }) } else { Ok(()) }
}

/// The fastest, the lasting and the secular rates that the sources of torques bring in.
///
/// # Errors
/// Those of a source without a position over the span, and [`Error::Torque`] for powers of its distance that no double holds.
pub(super) fn rates_of_sources(scene: &Scene, span: (f64, f64)) -> Result<[f64; 3], Error> {
    let mut rates = [0.0_f64; 3];
    let torques = scene.acting_torques();
    let sources = torques.iter().flat_map(|torque| match torque {
        Torque::Polynomial(torque) => torque.sources(),
        _ => &[],
    });
    let of_path = |orbit: &Orbit| {
        orbit.within_reach(scene.state().epoch)?;
        let secular = orbit.rates().iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        Ok::<_, Error>([rates_of_motion(orbit), orbit.mean_motion(), secular])
    };
    for source in sources {
        match source.path() {
            SourcePath::Orbit(orbit) => {
                let own = of_path(orbit)?;
                rates = std::array::from_fn(|k| rates[k].max(own[k]));
            }
            // Its direction has the double angle of the orbit, and the angle of the moment beside it.
            SourcePath::Field(field) => {
                let (own, turn) = (of_path(field.orbit())?, field.rotation_rate().abs());
                rates = std::array::from_fn(|k| rates[k].max(2.0 * own[k] + turn));
            }
            SourcePath::Tabulated(table) => covered(table, span)?,
            SourcePath::Direction(_) => {}
        }
        if falls(source, scene).iter().any(|fall| !fall.is_normal()) {
            let (power, distance) = source.distance_power();
            let value = format!("{}: {power} with a reference distance of {distance:e}", source.name());
            let bound = "such that (r0/r)^p is a double over the span".to_owned();
            return Err(Error::Torque { argument: "distance_powers", value, bound });
        }
    }
    Ok(rates)
}

/// The error by the interpolation of tables over the distance of the motions with the neighbouring polynomials: [`OF_INTERPOLATION`] where the error of a position is a
/// small part y of the distance, and 1/(1 − y) times that where it is not, because the body may be as near as 1 − y of the distance.
///
/// # Errors
/// [`Error::Table`] for y above [`FINE`]. Polynomials that pass a pericentre far outside agree on a torque that is too weak: of 1,000 tables of ellipses with 8 to 200 rows an
/// orbit 26 had errors of up to 3,000 times the bound, all with y above 0.9.
pub(crate) fn of_interpolation(scene: &Scene, span: (f64, f64)) -> Result<f64, Error> {
    let Some((table, (interval, departure))) = coarsest(scene, span) else { return Ok(OF_INTERPOLATION) };
    let error = OF_INTERPOLATION * departure;
    if error < FINE {
        return Ok(OF_INTERPOLATION / (1.0 - error));
    }
    let bound = "nearer to the time before it: the interpolation of the positions leaves the distance unknown";
    Err(too_far(table, interval, bound))
}

/// The error of a scene with a table whose interpolation leaves the attitude unknown: the time after the worst interval.
pub(super) fn too_coarse(scene: &Scene, [start, stop]: [f64; 2]) -> Option<Error> {
    let epoch = scene.state().epoch;
    let (table, (interval, _)) = coarsest(scene, (epoch + start, epoch + stop))?;
    Some(too_far(
        table,
        interval,
        "nearer to the time before it: the interpolation of the positions leaves the attitude unknown",
    ))
}

fn too_far(table: &TabulatedOrbit, interval: usize, bound: &'static str) -> Error {
    Error::Table { argument: "times", index: interval + 1, value: table.times()[interval + 1], bound }
}

/// The table with the coarsest interval within a span, and what [`TabulatedOrbit::coarsest`] says of it.
fn coarsest(scene: &Scene, (start, stop): (f64, f64)) -> Option<(&TabulatedOrbit, (usize, f64))> {
    let disturbing = scene.asked_disturbing().iter().filter_map(|body| match body {
        DisturbingBody::Tabulated(table) => Some(table),
        DisturbingBody::Orbit(_) => None,
    });
    let sources = scene.asked_torques().iter().flat_map(|torque| match torque {
        Torque::Polynomial(torque) => torque.sources(),
        _ => &[],
    });
    let sources = sources.filter_map(|source| match source.path() {
        SourcePath::Tabulated(table) => Some(table),
        _ => None,
    });
    let coarsest = disturbing.chain(sources).map(|table| (&**table, table.coarsest(start, stop)));
    coarsest.max_by(|one, other| one.1.1.total_cmp(&other.1.1))
}

/// The fastest rate that an orbit brings in, and the torque's √(3μ/ρ³) at the apocentre, or where a hyperbola is farthest within the span.
pub(super) fn rates_of_orbit(orbit: &Orbit, ends: [f64; 2]) -> (f64, f64) {
    let e = orbit.eccentricity();
    // In a unit in which the square of the mean motion is a normal double.
    let unit = exponent(orbit.mean_motion());
    let strength = scaled((2.0 * strength(orbit.strength_in(unit))).sqrt(), unit);
    let near = (1.0 - e).abs().powf(-1.5);
    let farthest = if orbit.is_hyperbola() {
        ends.map(|end| orbit.hyperbolic_distance(end)).into_iter().fold(e - 1.0, f64::max)
    } else {
        1.0 + e
    };
    ((strength * near).max(rates_of_motion(orbit)), strength * farthest.powf(-1.5))
}

/// The fastest rate of the directions to a body on an orbit.
fn rates_of_motion(orbit: &Orbit) -> f64 {
    let [node, pericentre] = orbit.rates().map(f64::abs);
    (2.0 * orbit.mean_motion() * (1.0 - orbit.eccentricity()).abs().powf(-1.5)).max(node).max(pericentre)
}

/// √(3 gm/r³) at the nearest and the farthest position.
pub(super) fn rates_of_table(table: &TabulatedOrbit) -> (f64, f64) {
    let distances = table.positions().iter().map(|[x, y, z]| x.hypot(*y).hypot(*z));
    let (nearest, farthest) = distances.fold((f64::INFINITY, 0.0_f64), |(least, most), r| (least.min(r), most.max(r)));
    let rate = |distance: f64| (3.0 * table.gm() / distance).sqrt() / distance;
    (rate(nearest), rate(farthest))
}

/// The largest and the smallest (r₀/r)^p of a source, or law of it.
pub(super) fn falls(source: &TorqueSource, scene: &Scene) -> [f64; 2] {
    if let Some(law) = source.law() {
        return law.extremes();
    }
    let (power, reference) = source.distance_power();
    let distances = match source.path() {
        SourcePath::Orbit(orbit) => {
            let size = orbit.asked_semi_major_axis().unwrap_or(1.0);
            conic_distances(orbit, scene).map(|distance| size * distance)
        }
        SourcePath::Tabulated(table) => {
            let distances = table.positions().iter().map(|[x, y, z]| x.hypot(*y).hypot(*z));
            distances.fold([f64::INFINITY, 0.0], |[least, most], r| [r.min(least), r.max(most)])
        }
        // Between the equator at the apocentre and the pole at the pericentre.
        SourcePath::Field(field) => {
            let [near, far] = conic_distances(field.orbit(), scene);
            [field.strength(far), 2.0 * field.strength(near)]
        }
        SourcePath::Direction(_) => return [1.0; 2],
    };
    let [one, other] = distances.map(|distance| (reference / distance).powf(power));
    [one.max(other), one.min(other)]
}

/// The smallest and the largest distance on an orbit over the span of a scene, in semi-major axes.
fn conic_distances(orbit: &Orbit, scene: &Scene) -> [f64; 2] {
    let e = orbit.eccentricity();
    if !orbit.is_hyperbola() {
        return [1.0 - e, 1.0 + e];
    }
    let (start, stop) = scene.asked_span().unwrap_or_default();
    [e - 1.0, orbit.hyperbolic_distance(start).max(orbit.hyperbolic_distance(stop))]
}
