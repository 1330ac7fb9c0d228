//! The error by order that theory §7 found by numerical integration, entry by entry.

use andoyer_propagate::{Body, Scene, State};
use andoyer_tests::{attitude_error, cases, difference};

const REFERENCE: &str = include_str!("../data/orders.json");
const ORDERS: [usize; 8] = [1, 2, 4, 6, 8, 12, 16, 20];

/// Largest attitude error over twenty rotations [rad] by order, or the floor of the integration that it was found with.
enum Entry {
    Error(f64),
    Floor(f64),
}
use Entry::{Error, Floor};

fn table(name: &str) -> [Entry; 8] {
    let floors = |floor: f64| move || Floor(floor);
    match name {
        "nearly spherical" => {
            let floor = floors(2e-13);
            [Error(1.2e-8), Error(1.9e-11), floor(), floor(), floor(), floor(), floor(), floor()]
        }
        "triaxial" => {
            let floor = floors(1e-13);
            [Error(5.7e-3), Error(3.3e-4), Error(1.1e-6), Error(4.2e-9), Error(1.8e-11), floor(), floor(), floor()]
        }
        "needle" => {
            let floor = floors(5e-14);
            [Error(1.4e-4), Error(1.3e-6), Error(1.9e-10), floor(), floor(), floor(), floor(), floor()]
        }
        "triaxial, large wobble" => [5.1e-1, 1.5e-1, 1.4e-2, 1.4e-3, 1.6e-4, 2.5e-6, 4.3e-8, 8.1e-10].map(Error),
        other => panic!("no row for {other}"),
    }
}

#[test]
fn error_by_order_is_that_of_the_table_within_a_factor_of_three() {
    let cases = cases(REFERENCE);
    assert_eq!(cases.len(), 4);
    for case in cases {
        let body = Body::new(case.moments).expect("a body");
        let state = State::new(0.0, case.attitude, case.angular_velocity).expect("a state");
        for (order, entry) in ORDERS.into_iter().zip(table(&case.name)) {
            let motion = Scene::new(body.clone(), state).order(order).solve().expect("short-axis");
            assert_eq!(motion.plan().order(), order);
            let (mut error, mut rate_error) = (0.0_f64, 0.0_f64);
            for &(time, attitude, rates) in &case.states {
                let sample = motion.at(time).expect("finite");
                error = error.max(attitude_error(sample.attitude.coords.into(), attitude));
                rate_error = rate_error.max(difference(sample.angular_velocity.into(), rates));
            }
            eprintln!("{:24} order {order:2}: attitude {error:.1e} rad, rates {rate_error:.1e}", case.name);
            match entry {
                Error(expected) => {
                    assert!((expected / 3.0..=expected * 3.0).contains(&error), "{} at {order}: {error}", case.name);
                }
                Floor(floor) => assert!(error <= floor, "{} at {order}: {error} above {floor}", case.name),
            }
        }
    }
}
