//! The rates of the average torque in the divisors, and what K2 in closed form lacks of its average over the orbit.

use nalgebra::{UnitQuaternion, Vector3};

use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::disturbance::series;
use crate::gravity_gradient::first_order::mean_variables::Mean;
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::second_order::k2::Hamiltonian;
use crate::gravity_gradient::second_order::k2_orbit_mean::OverOrbit;
use crate::gravity_gradient::second_order::k2_remainder::Remainder;
use crate::gravity_gradient::second_order::tests::{ECCENTRICITY, MEAN_MOTION, Scene, averaged, mean_rates};
use crate::gravity_gradient::terms::divisors::{AverageShift, Divisors};
use crate::gravity_gradient::terms::term::{Term, fast_terms, slow_limit};
use crate::numerics::C64;
use crate::orbit::elements::Orbit;
use crate::orbit::kepler::Place;
use crate::orbit::span::Reach;
use crate::orbit::tensor::products_at;
use crate::simd::lanes::Lanes;
use crate::torque::contraction;

#[test]
fn divisors_have_the_rates_of_the_average_torque() {
    for scene in Scene::all() {
        let Mean { p, momentum, frame, .. } = scene.mean;
        let inertia = Inertia::new(&scene.polhode, p.norm_sqr(), momentum);
        // With q this small the average over the orbit has no second order.
        let orbit = scene.orbit.attraction(1e-6 * MEAN_MOTION * MEAN_MOTION).expect("an orbit");
        let scene = Scene { orbit, ..scene };
        let hamiltonian = Hamiltonian::first(&inertia, scene.disturbance().strength());
        let (axes, pole) = (scene.orbit.axes(), frame * Vector3::z());
        let slopes = mean_rates(&OverOrbit::new(&hamiltonian, ECCENTRICITY, MEAN_MOTION, axes), &pole);
        let turning = frame.inverse() * slopes.turning;
        let ([one, cosine, sine], _) = products_at(&frame, axes);
        let secular = AverageShift::new(&inertia, &scene.disturbance());
        for (harmonic, multiple) in [(2, 0), (-3, 1), (1, 1), (4, 2)] {
            let divisors = Divisors::new((harmonic, multiple), [-3.0 * MEAN_MOTION, MEAN_MOTION], false, &secular);
            for (turns, sign) in [(0, 0.0), (2, -1.0), (-2, 1.0)] {
                let c = [&one, &cosine, &sine].map(|tensor| contraction(tensor, multiple));
                let part = |i: usize| if turns == 0 { c[0][i] } else { 0.5 * (c[1][i] + C64::i() * sign * c[2][i]) };
                // c_m of a part that is at rest, in a frame that turns with k but not about it.
                let rate = (part(1) * turning.x + part(2) * turning.y) / part(0);
                let [anomaly, longitude] = slopes.phases;
                let expected = f64::from(harmonic) * anomaly + f64::from(multiple) * longitude + rate.im;
                let found = divisors.at(3, turns);
                assert!(rate.re.abs() <= 1e-7 * turning.norm(), "{rate} {turning:?}");
                let scale = anomaly.abs() + longitude.abs() + rate.im.abs();
                assert!(
                    (found - expected).abs() <= 1e-7 * scale,
                    "{harmonic} {multiple} {turns}: {found:e} {expected:e}"
                );
                assert_eq!(divisors.at(6, turns), 3.0 * MEAN_MOTION);
            }
        }
    }
}

#[test]
fn what_the_closed_form_lacks_is_the_rest_of_the_average_over_the_orbit() {
    const STEPS: usize = 400;
    const FAST: f64 = 2e-3;
    let reach = Reach { eccentricity: ECCENTRICITY, anomaly: 0.0, sides: [10.0 * std::f64::consts::TAU; 2] };
    let series = series(&reach).expect("a series");
    // In a long span the angle of every pair of different terms returns; in a span of 0 none does.
    let scenes = Scene::all();
    for (scene, duration) in scenes.into_iter().flat_map(|scene| [(scene.clone(), 1e9), (scene, 0.0)]) {
        let Mean { p, momentum, frame, .. } = scene.mean;
        let orbit = Orbit::new(FAST, ECCENTRICITY).and_then(|orbit| orbit.plane(0.4, 1.0, 2.0)).expect("an orbit");
        let scene = Scene { orbit, ..scene };
        let disturbance = Disturbance { series: Some(series.clone()), duration, ..scene.disturbance() };
        let scale = disturbance.strength();
        let inertia = Inertia::new(&scene.polhode, p.norm_sqr(), momentum);
        let lacking = |inertia: &Inertia, frame: &UnitQuaternion<f64>| {
            let mean = Mean { frame: *frame, ..scene.mean };
            Remainder::new(
                inertia,
                &mean,
                (&disturbance, &series),
                (&[], &fast_terms(inertia, 1e-3, slow_limit(&disturbance))),
            )
        };
        let remainder = lacking(&inertia, &frame);
        let (value, steady) = (remainder.value, remainder.rates(&inertia, &frame, &disturbance.path.axes[2]));
        // All of K2, with as many time derivatives as the sums have, less the closed form.
        let mut mean = 0.0;
        for k in 0..STEPS {
            let anomaly = std::f64::consts::TAU * (k as f64 / STEPS as f64 - 0.5);
            let place = Place::of(Lanes::splat(pulp::Scalar, anomaly), ECCENTRICITY);
            let moved = Scene { place, ..scene.clone() };
            let all: Vec<Term> = fast_terms(&inertia, 0.0, slow_limit(&disturbance));
            let state = moved.state(&inertia, &disturbance);
            let mut still = state;
            still.tensors[2..].fill([Lanes::splat(pulp::Scalar, 0.0); 5]);
            mean += (averaged(&state, &all) - averaged(&still, &all)) / (scale * scale) / STEPS as f64;
        }
        let found = value / (scale * scale);
        // Terms with a share of 1e-6 of it are left out, and harmonics likewise.
        assert!(duration == 0.0 || (found / mean - 1.0).abs() <= 2e-3, "{found:e} {mean:e}");
        // Its derivatives against differences.
        let at = |sigma: f64, momentum: f64, frame: &UnitQuaternion<f64>| {
            lacking(&Inertia::new(&scene.polhode, sigma, momentum), frame).value
        };
        let sigma = p.norm_sqr();
        let (small, step) = (1e-3 * sigma, 1e-4 * momentum);
        let action = |action: f64, momentum: f64| at(action / momentum, momentum, &frame);
        let by_action = (action((sigma + small) * momentum, momentum) - action((sigma - small) * momentum, momentum))
            / (2.0 * small * momentum);
        let by_momentum =
            (action(sigma * momentum, momentum + step) - action(sigma * momentum, momentum - step)) / (2.0 * step);
        for (exact, difference) in steady.phases.into_iter().zip([by_action, by_momentum]) {
            assert!((exact / difference - 1.0).abs() <= 1e-4, "{exact:e} {difference:e}");
        }
        let rotated = |by: f64| {
            let mean = Mean { p: p * C64::from_polar(1.0, by), ..scene.mean };
            let terms = fast_terms(&inertia, 1e-3, slow_limit(&disturbance));
            Remainder::new(&inertia, &mean, (&disturbance, &series), (&[], &terms)).value
        };
        let by_angle = (rotated(1e-4) - rotated(-1e-4)) / 2e-4;
        assert!((steady.action + by_angle).abs() <= 1e-6 * value.abs(), "{:e} {by_angle:e}", steady.action);
        assert_eq!(steady.action != 0.0, duration == 0.0);
        let turned = [Vector3::x(), Vector3::y()].map(|axis| {
            let turn = |by: f64| at(sigma, momentum, &(frame * UnitQuaternion::new(axis * by)));
            (turn(1e-4) - turn(-1e-4)) / 2e-4
        });
        let pole = frame * Vector3::z();
        let across = steady.force - pole * pole.dot(&steady.force);
        let expected = frame * Vector3::new(turned[1], -turned[0], 0.0);
        assert!((across - expected).norm() <= 1e-6 * expected.norm(), "{across:?} {expected:?}");
    }
}
