//! The normal form about a spin–orbit resonance at a fixed order against the integration of the full equations: the cases of the reference programs.
//!
//! The limits are twice the errors that the tables of docs/theory-locked.md have at the same order, and the error bound of the integration. A body is displaced by
//! so many degrees in ψ, and by 0.6 and 0.5 of it in θ and φ, with zero rates of these angles.

use std::f64::consts::TAU;

use andoyer_propagate::nalgebra::{UnitQuaternion, Vector3};
use andoyer_propagate::{Body, Error, Method, Motion, Orbit, Scene, State};

const ORBITS: f64 = 1000.0;
/// Times at which motions are compared.
const TIMES: u32 = 40;
const MOON: [f64; 3] = [0.99948, 0.999772, 1.0];

/// A case: resonance, eccentricity, moments, angles ψ, θ, φ in degrees, and the error that a reference has at each order.
struct Case {
    resonance: f64,
    eccentricity: f64,
    moments: [f64; 3],
    degrees: [f64; 3],
    /// Whether the momenta instead of the rates are those of the equilibrium.
    momenta: bool,
    errors: &'static [(usize, f64)],
}

impl Case {
    /// The angles as attitude, which turns with the frame.
    fn scene(&self) -> Scene {
        let [psi, theta, phi] = self.degrees.map(f64::to_radians);
        let attitude = UnitQuaternion::from_euler_angles(phi, theta, psi);
        let spin = Vector3::new(0.0, 0.0, self.resonance);
        let along = self.resonance * self.moments[2] / theta.cos();
        let momentum = Vector3::new(0.0, along * phi.sin(), along * phi.cos());
        let rates: Vector3<f64> = match self.momenta {
            true => momentum.component_div(&Vector3::from(self.moments)),
            false => attitude.inverse() * spin,
        };
        let state = State::new(0.0, attitude.coords.into(), rates.into()).expect("a state");
        let orbit = Orbit::new(1.0, self.eccentricity).expect("an orbit");
        Scene::new(Body::new(self.moments).expect("a body"), state).orbit(orbit).span(0.0, ORBITS * TAU)
    }

    /// Each order is within twice the error of the reference, and the estimate is at least the error.
    fn check(&self) {
        let scene = self.scene();
        let truth = scene.clone().method(Method::Integrated).tolerance(1e-12).solve().expect("integrated");
        let bound = truth.plan().error_bound();
        for &(order, reference) in self.errors {
            let motion = scene.clone().method(Method::Libration).order(order).tolerance(1e-12);
            let motion = motion.solve().expect("a libration");
            let error = difference(&motion, &truth);
            assert_eq!(motion.plan().order(), order);
            assert!(error <= 2.0 * reference + bound, "order {order}: {error:.1e} against {reference:.1e}");
            let estimate = motion.plan().error_bound();
            assert!(error <= estimate + bound, "order {order}: {error:.1e}, estimate {estimate:.1e}");
        }
    }
}

fn difference(one: &Motion, two: &Motion) -> f64 {
    let angle = |k: u32| {
        let time = ORBITS * TAU * f64::from(k) / f64::from(TIMES);
        let [one, two] = [one, two].map(|motion| motion.at(time).expect("a time").attitude);
        one.angle_to(&two)
    };
    (0..=TIMES).map(angle).fold(0.0, f64::max)
}

fn planar(resonance: f64, eccentricity: f64, moments: [f64; 3], degrees: f64, errors: &'static [(usize, f64)]) {
    Case { resonance, eccentricity, moments, degrees: [degrees, 0.0, 0.0], momenta: false, errors }.check();
}

#[test]
fn longitude_on_a_circle_has_the_error_of_the_reference() {
    planar(1.0, 0.0, [0.85, 0.95, 1.0], 5.0, &[(8, 4.4e-11), (10, 2.1e-13)]);
}

#[test]
fn longitude_on_an_ellipse_has_the_error_of_the_reference() {
    planar(1.0, 0.01, [0.85, 0.95, 1.0], 2.0, &[(4, 5.4e-8), (8, 2.2e-12)]);
    planar(1.0, 0.1, [0.9985, 0.9995, 1.0], 3.0, &[(6, 1.2e-11)]);
    planar(1.0, 0.02, [0.7, 0.95, 1.0], 1.0, &[(8, 1.0e-6)]);
}

#[test]
fn longitude_of_the_moon_has_the_error_of_the_reference() {
    planar(1.0, 0.0549, [0.99948, 0.999707, 1.0], 1.0, &[(4, 1.6e-12), (6, 2.9e-14)]);
}

#[test]
fn longitude_of_mercury_has_the_error_of_the_reference() {
    planar(1.5, 0.2056, [0.9998, 0.9999, 1.0], 1.0, &[(2, 7.5e-9), (4, 1.1e-12)]);
}

fn three_angles(resonance: f64, eccentricity: f64, moments: [f64; 3], psi: f64, errors: &'static [(usize, f64)]) {
    Case { resonance, eccentricity, moments, degrees: [psi, 0.6 * psi, 0.5 * psi], momenta: false, errors }.check();
}

#[test]
fn three_angles_on_a_circle_have_the_errors_of_the_reference() {
    let errors = &[(4, 1.1e-6), (8, 4.2e-10), (12, 1.5e-11)];
    let moments = [0.55, 0.8, 1.0];
    Case { resonance: 1.0, eccentricity: 0.0, moments, degrees: [2.0, 1.2, 1.0], momenta: true, errors }.check();
}

#[test]
fn three_angles_of_the_moon_have_the_errors_of_the_reference() {
    three_angles(1.0, 0.0549, MOON, 1.0, &[(4, 9.9e-10), (6, 1.9e-12), (8, 2.1e-14)]);
}

#[test]
fn three_angles_of_a_satellite_have_the_errors_of_the_reference() {
    three_angles(1.0, 0.001, [0.55, 0.8, 1.0], 2.0, &[(8, 3.3e-7)]);
    three_angles(1.0, 0.001, [0.55, 0.8, 1.0], 0.5, &[(8, 1.3e-12)]);
}

#[test]
fn three_angles_of_mercury_have_the_errors_of_the_reference() {
    three_angles(1.5, 0.2056, [0.9998, 0.9999, 1.0], 1.0, &[(4, 2.1e-10), (6, 1.4e-13)]);
}

#[test]
fn an_order_out_of_range_is_refused() {
    let case = Case {
        resonance: 1.0,
        eccentricity: 0.0,
        moments: MOON,
        degrees: [1.0, 0.0, 0.0],
        momenta: false,
        errors: &[],
    };
    for order in [0, 1, 17] {
        let refused = case.scene().method(Method::Libration).order(order).solve();
        let Err(Error::NoLibration { reason }) = refused else { panic!("{refused:?}") };
        assert!(reason.contains("from 2 to 16"), "{reason}");
    }
    let odd = case.scene().method(Method::Libration).order(5).solve().expect("a libration");
    assert_eq!(odd.plan().order(), 5);
}
