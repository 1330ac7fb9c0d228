//! Cassini states: the number of them, the Moon and Mercury as observed, and the widths of resonances.

use andoyer_propagate::disturbers::{CassiniState, cassini_states};
use andoyer_propagate::{Body, Orbit};

fn states(node_rate: f64, inclination: f64) -> usize {
    let orbit = Orbit::new(0.02, 0.0).and_then(|orbit| orbit.plane(inclination, 0.0, 0.0));
    let orbit = orbit.and_then(|orbit| orbit.secular_rates(node_rate, 0.0)).expect("an orbit");
    cassini_states(&Body::new([0.9, 0.9, 1.0]).expect("a body"), &orbit, 1.0).expect("states").len()
}

#[test]
fn two_states_merge_at_the_critical_ratio_of_the_rates() {
    // α_p = (3/2) 0.02² 0.1 = 6e-5.
    for inclination in [0.01, 0.2, 0.7, 1.4_f64] {
        let (sine, cosine) = inclination.sin_cos();
        let critical = 6e-5 * (sine.powf(2.0 / 3.0) + cosine.powf(2.0 / 3.0)).powf(-1.5);
        assert_eq!(states(-critical * (1.0 - 1e-9), inclination), 4, "{inclination}");
        assert_eq!(states(-critical * (1.0 + 1e-9), inclination), 2, "{inclination}");
    }
}

/// The state whose pole is beyond inertial axis 3, seen from the normal: that of the Moon and of Mercury.
fn state(moments: [f64; 3], orbit: &Orbit, spin_rate: f64) -> CassiniState {
    let states = cassini_states(&Body::new(moments).expect("a body"), orbit, spin_rate).expect("states");
    let near = |state: &&CassiniState| state.stable && state.obliquity.abs() < 0.5;
    states.iter().find(near).copied().expect("a stable state near the normal")
}

#[test]
fn the_moon_is_inclined_to_the_ecliptic_as_observed() {
    // The equator of the Moon is inclined to the ecliptic by 1.54°. Input: the observed (C − A)/B, (B − A)/C, G m of the Earth, distance and months. Rates
    // in rad/day.
    let day = |period: f64| std::f64::consts::TAU / period;
    let (anomalistic, draconic, node) = (day(27.554_550), day(27.212_221), -day(6798.38));
    let attraction = 398_600.435 / 384_399.014_f64.powi(3) * 86_400.0 * 86_400.0;
    let inclination = 5.145_396_4_f64.to_radians();
    let orbit = Orbit::new(anomalistic, 0.0549)
        .and_then(|orbit| {
            orbit.plane(inclination, 0.0, 0.0)?.secular_rates(node, draconic - anomalistic)?.attraction(attraction)
        })
        .expect("the orbit of the Moon");
    let moon = state([0.999_369_23, 0.999_596_96, 1.0], &orbit, day(27.321_662));
    assert_eq!(moon.resonance, Some(1.0));
    let tilt = (moon.obliquity + inclination).to_degrees();
    assert!((tilt + 1.54).abs() <= 0.01, "{tilt}");
}

#[test]
fn mercury_is_inclined_to_its_orbit_as_observed() {
    // Margot et al. 2012: C/M R² = 0.346 from the observed obliquity of 2.04 ± 0.08′. Gravity field: J₂ = 5.03e-5, C₂₂ = 0.81e-5; Laplace plane at 8.53°,
    // node in 325,513 years (Stark et al. 2015).
    let (polar, oblateness, triaxiality) = (0.346, 5.03e-5, 4.0 * 0.81e-5);
    let a = 1.0 - (oblateness + 0.5 * triaxiality) / polar;
    let motion = std::f64::consts::TAU / 87.969_349_6;
    let node = -std::f64::consts::TAU / (325_513.0 * 365.25);
    let orbit = Orbit::new(motion, 0.205_630)
        .and_then(|orbit| orbit.plane(8.53_f64.to_radians(), 0.0, 0.0)?.secular_rates(node, 0.0))
        .expect("the orbit of Mercury");
    let mercury = state([a, a + triaxiality / polar, 1.0], &orbit, 6.138_518_04_f64.to_radians());
    assert_eq!(mercury.resonance, Some(1.5));
    let obliquity = 60.0 * mercury.obliquity.to_degrees();
    assert!((obliquity - 2.04).abs() <= 0.02, "{obliquity}");
}

#[test]
fn a_spin_outside_the_width_of_a_resonance_has_the_states_of_a_fast_body() {
    let orbit = Orbit::new(0.02, 0.0)
        .and_then(|orbit| orbit.plane(0.2, 0.0, 0.0)?.secular_rates(-1e-6, 0.0))
        .expect("an orbit");
    let width = 0.02 * (3.0 * 0.01_f64).sqrt();
    let resonance = |by: f64| state([0.98, 0.99, 1.0], &orbit, 0.02 - 1e-6 * 0.2_f64.cos() + by * width).resonance;
    assert_eq!([-1.001, -0.999, 0.0, 0.999, 1.001].map(resonance), [None, Some(1.0), Some(1.0), Some(1.0), None]);
    // On a circle no other multiple of half a rotation is a resonance.
    assert_eq!(state([0.98, 0.99, 1.0], &orbit, 0.03).resonance, None);
}

#[test]
fn a_body_with_thousands_of_rotations_an_orbit_is_in_no_resonance() {
    // Quadratures with fewer points than twice the harmonic gave false coefficients, 1 for 2p = 10,306 on a circle.
    for eccentricity in [0.0, 0.2229, 0.5] {
        let orbit = Orbit::new(1e-4, eccentricity)
            .and_then(|orbit| orbit.plane(0.2, 0.0, 0.0)?.secular_rates(-1e-9, 0.0))
            .expect("an orbit");
        for double in (3000..11_000).step_by(7).chain([10_306]) {
            let spin_rate = 0.5e-4 * f64::from(double);
            let states = cassini_states(&Body::new([0.5, 0.8, 1.0]).expect("a body"), &orbit, spin_rate);
            assert_eq!(states.expect("states")[0].resonance, None, "{eccentricity} {double}");
        }
    }
}
