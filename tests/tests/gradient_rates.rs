//! Secular precession under the gravity gradient of the Sun, "/yr (theory §9), of the bodies of the catalogue, whose moments, spins, poles and orbits were read
//! in their sources.

use andoyer_propagate::nalgebra::{UnitQuaternion, Vector3};
use andoyer_propagate::options::Averaging;
use andoyer_propagate::{Body, Orbit, Scene, State};
use std::f64::consts::TAU;

/// Days.
const YEAR: f64 = 365.25;
const ARCSECOND: f64 = TAU / 1_296_000.0;

/// A body in principal-axis rotation, its pole inclined to the ecliptic.
struct Spinning {
    /// In the catalogue.
    name: &'static str,
    /// Days.
    period: f64,
    /// Degrees, to the x, y plane of the scene.
    obliquity: f64,
}

impl Spinning {
    /// Precession in longitude about the scene's z axis over so many years ["/yr].
    fn precession(&self, orbit: Orbit, averaging: Averaging, years: f64) -> f64 {
        let body = Body::named(self.name).expect("a body of the catalogue");
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
    // Whole orbits, so that nothing periodic is left in the change. The obliquity is that of the start and differs from the mean one by κ at most, which at 89°
    // is 1.4 % of the cosine for Eros. Expected: −(3/2)(n²/ω)(1−e²)^(−3/2) (C − (A+B)/2)/C cos I, computed by hand from the same figures.
    let bodies = [
        ("Earth", 0.997_269_66, 23.4393, 1.000_002_61, 0.016_711_23, -15.95),
        ("Ceres", 9.074_17 / 24.0, 4.04, 2.765_552_6, 0.079_692_3, -6.55),
        ("Vesta", 5.342_127_632_2 / 24.0, 27.44, 2.361_366_0, 0.090_203_7, -13.65),
        ("Eros", 5.270_255_43 / 24.0, 89.01, 1.458_117_4, 0.222_796_7, -2.836),
    ];
    for (name, period, obliquity, axis, eccentricity, expected) in bodies {
        let spinning = Spinning { name, period, obliquity };
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
    let earth = Spinning { name: "Earth", period: 0.997_269_66, obliquity: 23.4393 };
    let sun = earth.precession(heliocentric(1.000_002_61, 0.016_711_23), Averaging::Orbit, 1.0);
    // 27.321582 days, e = 0.0554, 5.16° to the ecliptic, mass fraction 1/82.3; its node goes round, and four of its places average the torque exactly.
    let moon = [0.0, 0.25, 0.5, 0.75].map(|node| {
        let orbit = Orbit::new(TAU / 27.321_582, 0.0554)
            .and_then(|orbit| orbit.plane(5.16_f64.to_radians(), node * TAU, 0.0))
            .and_then(|orbit| orbit.mass_fraction(1.0 / 82.3))
            .expect("an orbit");
        earth.precession(orbit, Averaging::Orbit, 27.321_582 / YEAR)
    });
    let lunar = moon.iter().sum::<f64>() / 4.0;
    // General precession in longitude, 5028.8" a century; geodesic precession and the planets, which a rigid Earth under two bodies lacks, are 0.1 % of it.
    assert!((sun + lunar + 50.288).abs() <= 0.05, "{sun} + {lunar}");
}
