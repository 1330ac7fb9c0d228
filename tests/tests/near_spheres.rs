//! The gravity gradient to second order for bodies next to a sphere, where ℓ′ hardly turns within the span, against integrations of the full equations.

use andoyer_propagate::nalgebra::{UnitQuaternion, Vector3, Vector4};
use andoyer_propagate::options::{Averaging, Level};
use andoyer_tests::climb::{Family, Uniform};
use andoyer_tests::disturbed::Disturbed;

#[test]
fn next_to_a_sphere_the_mean_wobble_changes() {
    // A circle on which the average torque, with Γ Δ (½ρ − ⅓), nearly vanishes: k·n̂ = 1/√3. What remains is K2, and −∂K2/∂ℓ′ is as large as its other rates.
    let momentum = [0.31, -0.42, 0.853];
    for (spread, attraction) in [(3e-6, 60.0), (2e-5, 8.0), (7e-5, 2.0)] {
        let moments = [1.0 - spread, 1.0 - 0.6 * spread, 1.0];
        let rates = std::array::from_fn(|i| momentum[i] / moments[i]);
        let inclination = (1.0_f64 / 3.0).sqrt().acos() + 1e-3;
        // The attitude turns the angular momentum to inertial axis 3.
        let attitude = UnitQuaternion::rotation_between(&momentum.into(), &Vector3::z()).expect("not opposite").coords;
        let scene = Disturbed::new(moments, attitude.into(), rates, [0.04, 0.0, 3.0, inclination, 0.7, 0.0], 900.0);
        let scene = Disturbed { attraction, level: Level::SecondOrder, averaging: Averaging::Spin, ..scene };
        let measured = scene.measured().expect("served");
        assert!(measured.ratio() <= 1.0, "{spread:e}: {measured:?}");
    }
    let random = &mut Uniform(11);
    for k in 0..16 {
        let scene = Family::NextToSphere.random(k % 2 == 1, (Averaging::Spin, Level::SecondOrder), random);
        if let Ok(measured) = scene.measured() {
            assert!(measured.ratio() <= 1.0, "{k}: {measured:?}, {scene:?}");
        }
    }
}

#[test]
fn two_harmonics_next_to_resonance_change_the_mean_momentum() {
    // Moments within 1e-5, J of 5e-4, so that the terms with m = 1 change p and M through p alone, next to resonance with harmonic j of the orbit.
    for (j, offset) in [(28.0, 1e-4), (21.0, -3e-4), (14.0, 2e-4)] {
        let moments = [0.999_992, 0.999_993_5, 1.0];
        let orbit = [(1.0 - offset / 28.0) / j, 0.66, 80.0, 2.2, 0.4, 1.9];
        let scene = Disturbed::new(moments, [0.1, -0.2, 0.3, 0.86_f64.sqrt()], [4e-4, 1e-4, 1.0], orbit, 3000.0);
        let scene = Disturbed { level: Level::SecondOrder, averaging: Averaging::Spin, tolerance: 1e-9, ..scene };
        let measured = scene.measured().expect("served");
        assert!(measured.ratio() <= 1.0, "{j}: {measured:?}");
    }
}

#[test]
fn the_torque_on_a_body_next_to_a_sphere_has_no_rounding_of_the_moments() {
    // Moments within 6e-10. Where the tensor was sampled, and not its differences from a sphere, 1.5 % of the effect was rounding.
    let moments = [1.000_000_000_45, 1.000_000_000_06, 1.000_000_000_46];
    let rates = [0.154, -0.084, 0.984];
    let orbit = [0.03, 0.4, 0.2, 0.76, 0.3, 0.13];
    let scene = Disturbed::new(moments, [0.1, -0.2, 0.3, 0.86_f64.sqrt()], rates, orbit, 750.0);
    for level in [Level::Full, Level::SecondOrder] {
        let scene = Disturbed { level, averaging: Averaging::Spin, attraction: 200.0, tolerance: 1e-9, ..scene };
        let measured = scene.measured().expect("served");
        assert!(measured.error <= 1e-4 * measured.effect, "{level}: {measured:?}");
    }
}

#[test]
fn two_terms_together_next_to_resonance_turn_the_phase() {
    // 4Ω_y is 0.09 n from harmonic 49 of the orbit, and 3Ω_y 0.10 n from harmonic 29: pairs of terms with m = 2, and with m = 1 and 2.
    let moments = [[0.999_948_7, 0.999_986_6, 1.0], [0.999_999_16, 0.999_999_72, 1.0]];
    let attitudes = [[0.7155, 0.4742, 0.128, 0.4968], [0.4987, -0.2691, -0.5454, -0.6176]];
    let rates = [[0.038_10, -0.121_34, -0.991_88], [0.194_372, 0.202_171, 0.959_868]];
    let orbits = [[0.081_49, 0.7374, -66.5, 0.0, 0.0, 5.167], [0.103_06, 0.7315, -43.51, 0.0, 0.0, 3.262]];
    for (k, attraction) in [1.8, 1.07].into_iter().enumerate() {
        let attitude = Vector4::from(attitudes[k]).normalize().into();
        let scene = Disturbed::new(moments[k], attitude, rates[k], orbits[k], 820.0);
        for level in [Level::Full, Level::SecondOrder] {
            let scene = Disturbed { attraction, level, averaging: Averaging::Spin, ..scene };
            let measured = scene.measured().expect("served");
            assert!(measured.ratio() <= 1.0, "{k} {level}: {measured:?}");
        }
    }
}
