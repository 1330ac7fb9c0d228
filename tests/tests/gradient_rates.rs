//! Secular precession under the gravity gradient against published and recalled rates (theory §9): "/yr, of homogeneous bodies where the moments are those of an ellipsoid.

use andoyer_propagate::nalgebra::{UnitQuaternion, Vector3};
use andoyer_propagate::{Averaging, Body, Orbit, Scene, State};
use std::f64::consts::TAU;

/// Days.
const YEAR: f64 = 365.25;
const ARCSECOND: f64 = TAU / 1_296_000.0;

/// A body in principal-axis rotation, its pole inclined to the ecliptic.
struct Spinning {
    /// A/C and B/C.
    ratios: [f64; 2],
    /// Days.
    period: f64,
    /// Degrees, to the x, y plane of the scene.
    obliquity: f64,
}

impl Spinning {
    /// Precession in longitude about the scene's z axis over so many years ["/yr].
    fn precession(&self, orbit: Orbit, averaging: Averaging, years: f64) -> f64 {
        let [first, second] = self.ratios;
        let body = Body::new([first, second, 1.0]).expect("a body");
        let attitude = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), self.obliquity.to_radians());
        let state = State::new(0.0, attitude.coords.into(), [0.0, 0.0, TAU / self.period]).expect("a state");
        let times = [0.0, years * YEAR];
        let scene = Scene::new(body, state).orbit(orbit).averaging(averaging).span(0.0, times[1]);
        let mut momenta = [[0.0; 3]; 2];
        scene.solve().expect("averaged").angular_momenta_into(&times, &mut momenta).expect("finite times");
        let [start, end] = momenta.map(|momentum| Vector3::from(momentum).normalize());
        let across = Vector3::z().cross(&start);
        across.dot(&(end - start)) / across.norm_squared() / ARCSECOND / years
    }
}

/// Of a planet about the Sun, from its semi-major axis [au].
fn heliocentric(axis: f64, eccentricity: f64) -> Orbit {
    Orbit::new(TAU / (YEAR * axis.powf(1.5)), eccentricity).expect("an orbit")
}

#[test]
fn planets_and_asteroids_precess_at_the_rates_of_theory_9_by_either_average() {
    // Whole orbits, so that nothing periodic is left in the change. The obliquity is that of the start and differs from the mean one by κ at most, which at 89° is 1.4 % of
    // the cosine for Eros.
    let bodies = [
        ("Earth", [0.996_715_23, 0.996_737_18], 0.997_269_57, 23.4393, 1.000_001, 0.016_709, -15.95),
        ("Mars", [0.994_284_49, 0.994_976_76], 1.025_956_76, 25.19, 1.523_68, 0.0934, -7.60),
        ("Vesta", [0.798_544_23, 0.825_800_63], 5.342_127_6 / 24.0, 27.5, 2.3615, 0.0894, -15.17),
        ("Eros", [0.229_426_77, 0.963_753_52], 5.270_255_47 / 24.0, 89.0, 1.4583, 0.2227, -2.864),
    ];
    for (name, ratios, period, obliquity, axis, eccentricity, expected) in bodies {
        let spinning = Spinning { ratios, period, obliquity };
        let orbit = heliocentric(axis, eccentricity);
        let years = 10.0 * axis.powf(1.5);
        let [by_orbit, by_spin] = [Averaging::Orbit, Averaging::Spin].map(|a| spinning.precession(orbit, a, years));
        // Half of the last digit of the expected rate.
        let budget = if name == "Eros" { 0.04 } else { 0.006 };
        assert!((by_orbit - expected).abs() <= budget, "{name}: {by_orbit}");
        // The averages differ by the square of κ, over the cosine of the obliquity.
        assert!((by_orbit / by_spin - 1.0).abs() <= 5e-3, "{name}: {by_orbit}, {by_spin}");
    }
}

#[test]
fn sun_and_moon_together_move_the_equinox_by_fifty_arcseconds_a_year() {
    let earth = Spinning { ratios: [0.996_715_23, 0.996_737_18], period: 0.997_269_57, obliquity: 23.4393 };
    let sun = earth.precession(heliocentric(1.000_001, 0.016_709), Averaging::Orbit, 1.0);
    // 27.321661 days, 5.145° to the ecliptic; its node goes round in 18.6 years, four of whose places average the torque exactly.
    let moon = [0.0, 0.25, 0.5, 0.75].map(|node| {
        let orbit = Orbit::new(TAU / 27.321_661, 0.0549)
            .and_then(|orbit| orbit.plane(5.145_f64.to_radians(), node * TAU, 0.0))
            .and_then(|orbit| orbit.mass_fraction(1.0 / 82.3))
            .expect("an orbit");
        earth.precession(orbit, Averaging::Orbit, 27.321_661 / YEAR)
    });
    let lunar = moon.iter().sum::<f64>() / 4.0;
    assert!((sun + lunar + 50.3).abs() <= 0.05, "{sun} + {lunar}");
}
