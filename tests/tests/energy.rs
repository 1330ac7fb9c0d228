//! The energy ratio and the elliptic parameter of a free motion, by the formulas of textbooks.

use andoyer_propagate::{Body, Motion, Scene, State};

fn motion(moments: [f64; 3], rates: [f64; 3]) -> Motion {
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], rates).expect("a state");
    Scene::new(Body::new(moments).expect("a body"), state).solve().expect("a motion")
}

#[test]
fn energy_is_that_of_the_axes_on_the_axes_and_does_not_know_their_order() {
    assert_eq!(motion([1.0, 1.5, 2.0], [0.0, 0.0, 1.0]).energy_ratio(), 1.0);
    assert!((motion([1.0, 1.5, 2.0], [1.0, 0.0, 0.0]).energy_ratio() - 2.0).abs() < 1e-15);
    assert!((motion([2.0, 1.0, 1.5], [0.0, 0.0, 1e-9]).energy_ratio() - 2.0 / 1.5).abs() < 1e-15);
    assert_eq!(motion([1.0, 1.5, 2.0], [0.0; 3]).energy_ratio(), 1.0);
}

#[test]
fn parameter_is_that_of_the_energy_integral_in_either_mode() {
    let moments: [f64; 3] = [1.0, 1.5, 2.0];
    for rates in [[0.1, 0.2, 1.0], [1.0, 0.3, 0.2], [0.3, 0.5, -0.4]] {
        let square = |power: i32| (0..3).map(|i| moments[i].powi(power) * rates[i] * rates[i]).sum::<f64>();
        let (energy, momentum) = (square(1), square(2));
        let [a, b, c] = moments;
        // Landau and Lifshitz, Mechanics, §37.
        let ratio = (b - a) * (energy * c - momentum) / ((c - b) * (momentum - energy * a));
        let expected = if ratio < 1.0 { ratio } else { 1.0 / ratio };
        assert!((motion(moments, rates).elliptic_parameter() - expected).abs() < 1e-14, "{rates:?}");
    }
}

#[test]
fn parameter_is_zero_without_a_polhode() {
    for (moments, rates) in
        [([1.0, 1.0, 2.0], [0.1, 0.2, 1.0]), ([1.0, 1.5, 2.0], [0.0, 0.0, 1.0]), ([1.0, 1.5, 2.0], [0.0; 3])]
    {
        assert_eq!(motion(moments, rates).elliptic_parameter(), 0.0);
    }
}
