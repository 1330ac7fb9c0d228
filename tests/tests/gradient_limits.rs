//! How good averaging is where it is hardest, that its bound says so, and the errors where it does not hold.

use andoyer_propagate::options::Averaging;
use andoyer_propagate::{Body, Error, Method, Motion, Orbit, Scene, State};
use andoyer_tests::attitude_error;
use andoyer_tests::integration::Problem;

const ATTITUDE: [f64; 4] = [0.295_520_206_661_339_6, 0.0, 0.0, 0.955_336_489_125_606];

fn scene(moments: [f64; 3], rates: [f64; 3], span: f64) -> Scene {
    let state = State::new(0.0, ATTITUDE, rates).expect("a state");
    Scene::new(Body::new(moments).expect("a body"), state).span(0.0, span).method(Method::Closed)
}

fn orbit(mean_motion: f64, eccentricity: f64, fraction: f64) -> Orbit {
    Orbit::new(mean_motion, eccentricity).and_then(|orbit| orbit.mass_fraction(fraction)).expect("an orbit")
}

fn attitude(motion: &Motion, time: f64) -> [f64; 4] {
    motion.at(time).expect("a finite time").attitude.coords.into()
}

/// Rates of a body with an angular momentum of 1 that is J from axis 3 in the plane of axes 1 and 3.
fn tilted(moments: [f64; 3], tilt: f64) -> [f64; 3] {
    [tilt.sin() / moments[0], 0.0, tilt.cos() / moments[2]]
}

#[test]
fn a_faint_torque_leaves_the_free_motion_as_it_is_up_to_nine_tenths_of_the_separatrix() {
    let moments = [0.3, 0.9, 1.0];
    for tilt in [1e-6, 0.01, 0.05, 0.1, 0.15, 0.19, 0.205] {
        let free = scene(moments, tilted(moments, tilt), 3000.0);
        let disturbed = free.clone().orbit(orbit(1e-6, 0.1, 1e-9)).solve().expect("averaged");
        let free = free.solve().expect("free");
        let ratio = disturbed.plan().separatrix_ratio();
        for time in [0.0, 1.0, 100.0, 3000.0] {
            let error = attitude_error(attitude(&disturbed, time), attitude(&free, time));
            // Rounding of 3,000 radians by a σ in doubles, with slopes of the rates that grow towards the separatrix.
            assert!(error <= 3e-12, "σ/σ_sep = {ratio}: {error:e} at {time}");
            assert!(time > 0.0 || error <= 2e-14, "σ/σ_sep = {ratio}: {error:e} at the epoch");
        }
    }
    let farthest = scene(moments, tilted(moments, 0.205), 1.0).solve().expect("free").plan().separatrix_ratio();
    assert!((0.75..0.9).contains(&farthest), "{farthest}");
}

#[test]
fn errors_are_below_their_bounds_at_large_tilts_and_eccentricities() {
    let scenes = [
        ([0.3, 0.9, 1.0], tilted([0.3, 0.9, 1.0], 0.19), 1e-3, 0.1),
        ([0.3, 0.9, 1.0], tilted([0.3, 0.9, 1.0], 0.12), 1e-3, 0.6),
        ([0.6, 0.8, 1.0], tilted([0.6, 0.8, 1.0], 0.5), 2e-3, 0.3),
        ([0.55, 0.55, 1.0], [0.6, 0.5, 1.0], 1e-3, 0.7),
        ([0.5, 0.9, 1.0], [1.0, 0.3, 0.2], 1e-3, 0.4),
        ([0.9, 0.95, 1.0], [0.05, 0.08, -1.0], 5e-3, 0.5),
    ];
    for (moments, rates, mean_motion, eccentricity) in scenes {
        let disturber = orbit(mean_motion, eccentricity, 1.0);
        let times: Vec<f64> = (1..=40).map(|k| f64::from(k) * 0.05 * std::f64::consts::TAU / mean_motion).collect();
        let truth = Problem { moments, orbit: Some(disturber) }.integrate(0.0, ATTITUDE, rates, &times);
        for averaging in [Averaging::Spin, Averaging::Orbit] {
            let scene = scene(moments, rates, times[39]).orbit(disturber).averaging(averaging);
            let motion = scene.solve().expect("averaged");
            let bound = motion.plan().error_bound();
            for (&time, &(reference, _)) in times.iter().zip(&truth) {
                let error = attitude_error(attitude(&motion, time), reference);
                assert!(error <= bound, "{moments:?} {rates:?} {averaging}: {error:e} of {bound:e} at {time}");
            }
        }
    }
}

#[test]
fn frequencies_have_the_secular_part_of_the_torque() {
    // A round body, whose polhode is a circle that ℓ′ goes round uniformly.
    let (moments, rates, mean_motion) = ([0.9, 0.9, 1.0], [0.2, 0.1, 1.0], 1e-3);
    let period = std::f64::consts::TAU / mean_motion;
    let scene = scene(moments, rates, 40.0 * period);
    let motion =
        scene.clone().orbit(orbit(mean_motion, 0.0, 1.0)).averaging(Averaging::Orbit).solve().expect("averaged");
    let free = scene.solve().expect("free");
    // ℓ′ from the body's rates: their phase after whole orbits, where nothing periodic of the orbit is left.
    let phase = |time: f64| {
        let rates = motion.at(time).expect("finite").angular_velocity;
        (moments[1] * rates.y).atan2(moments[0] * rates.x)
    };
    let (start, span) = (phase(0.0), 40.0 * period);
    let shift = motion.frequencies().anomaly - free.frequencies().anomaly;
    // The direction of the polhode: forward if the measured phase falls.
    let measured = |sense: f64| {
        let turned = sense * (phase(span) - start) - motion.frequencies().anomaly * span;
        (turned / std::f64::consts::TAU - (turned / std::f64::consts::TAU).round()) * std::f64::consts::TAU / span
    };
    let error = measured(1.0).abs().min(measured(-1.0).abs());
    assert!(error <= 0.1 * shift.abs(), "{error:e} of {shift:e}");
}

#[test]
fn a_high_harmonic_of_an_eccentric_orbit_is_corrected_next_to_its_resonance() {
    // Ω(−2, 2) = 45 n. The effect of the torque is 6e-2 rad. Sums over time derivatives have no such harmonic.
    let disturber = Orbit::new(0.015_220_917_677_591_528, 0.8)
        .and_then(|orbit| orbit.plane(0.0, 0.0, 1.0)?.mass_fraction(1e-3))
        .expect("an orbit");
    let scene = scene([0.55, 0.55, 1.0], [0.6, 0.5, 1.0], 1.5e4).orbit(disturber);
    let theory = scene.clone().solve().expect("served");
    let exact = scene.method(Method::Integrated).solve().expect("integrated");
    let errors = (1..=100).map(|k| {
        let [theory, exact] = [&theory, &exact].map(|motion| motion.at(150.0 * f64::from(k)).expect("in the span"));
        theory.attitude.angle_to(&exact.attitude)
    });
    let error = errors.fold(0.0, f64::max);
    let estimate = theory.plan().error_bound();
    assert!(error <= 1e-4 && error <= 3.0 * estimate, "{error:e} {estimate:e}");
}

#[test]
fn what_cannot_be_averaged_is_an_error_that_says_why() {
    let needle = scene([0.01, 1.0, 1.0], [1.0, 2e-4, 1e-4], 3000.0).orbit(orbit(2e-3, 0.2, 1.0)).solve();
    assert!(matches!(needle, Err(Error::TorqueTooStrong { .. })), "{needle:?}");
    let far = Orbit::new(1e-2, 0.1).and_then(|orbit| orbit.time_of_pericentre(-1.7e308)).expect("an orbit");
    let error = scene([0.9, 0.95, 1.0], [0.1, 0.0, 1.0], 1.0).orbit(far).solve();
    assert!(matches!(error, Err(Error::Orbit { argument: "time_of_pericentre", .. })), "{error:?}");
    let long = scene([0.9, 0.95, 1.0], [0.0, 0.0, 1.0], 1e9).orbit(orbit(1e-2, 0.1, 1.0));
    let error = long.clone().averaging(Averaging::Spin).solve();
    assert!(matches!(error, Err(Error::TooManyOrbits { .. })), "{error:?}");
    let motion = long.solve().expect("averaged over the orbit");
    assert_eq!(motion.plan().averaging(), Some(Averaging::Orbit));
    assert!(motion.at(1e9).is_ok());
}

#[test]
fn the_earth_under_the_sun_needs_no_span() {
    let body = Body::new([0.996_715_23, 0.996_737_18, 1.0]).expect("a body");
    let spin = std::f64::consts::TAU / 0.997_269_57;
    let state = State::new(0.0, ATTITUDE, [0.0, 0.0, spin]).expect("a state");
    let sun = Orbit::new(std::f64::consts::TAU / 365.25, 0.0167).expect("an orbit");
    let motion = Scene::new(body, state).orbit(sun).solve();
    assert!(motion.is_ok(), "{}", motion.expect_err("an error"));
}
