//! Tables of the series that are kept for the next scene.

use andoyer_propagate::{Body, Method, Scene, State};

fn rates_at(order: usize, angular_velocity: [f64; 3]) -> [f64; 3] {
    let body = Body::new([0.5, 0.75, 1.0]).expect("a body");
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], angular_velocity).expect("a state");
    let motion = Scene::new(body, state).method(Method::Series).order(order).solve().expect("a wobble");
    motion.at(123.4).expect("a finite time").angular_velocity.into()
}

#[test]
fn what_was_solved_before_changes_no_bit() {
    for angular_velocity in [[0.2, 0.3, 0.9], [1.6, 0.35, 0.5]] {
        // The first order needs tables that end there, the last ones cut longer tables off.
        let expected = [2, 7, 20].map(|order| rates_at(order, angular_velocity));
        assert!(expected[0] != expected[1] && expected[1] != expected[2]);
        rates_at(30, [0.2, 0.3, 0.9]);
        rates_at(5, [1.6, 0.35, 0.5]);
        assert_eq!([2, 7, 20].map(|order| rates_at(order, angular_velocity)), expected);
    }
}
