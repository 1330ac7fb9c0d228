//! The error under a gravity gradient is below the bound that the plan states: scenes in which it once was not.

use andoyer_propagate::{Averaging, Error, Level};
use andoyer_tests::disturbed::{Disturbed, Measured};

const ATTITUDE: [f64; 4] = [0.1, 0.2, 0.3, 0.927_361_849_549_570_4];

fn f1() -> Disturbed {
    Disturbed::new([0.01, 0.999_999, 1.0], ATTITUDE, [0.0097, 0.0, 1.0], [5.8e-4, 0.0, 0.0, 0.0, 0.0, 0.0], 1e4)
}

fn f1b() -> Disturbed {
    Disturbed::new(
        [0.050_397_5, 0.998_001_28, 1.0],
        normalized([0.004888, -0.001027, 0.978614, 0.205645]),
        [0.198224, 0.0, 0.99995],
        [5.6252e-4, 0.13723, 9181.6, 4.694, 0.0, 0.0],
        5791.4,
    )
}

fn f2() -> Disturbed {
    Disturbed::new(
        [0.494453, 0.564264, 1.0],
        normalized([0.105615, -0.668753, -0.463003, -0.572051]),
        [-0.35796, -1.47168, 0.528282],
        [4.4573e-4, 0.0034158, 13116.0, 0.6315, 5.663, 2.408],
        3142.0,
    )
}

fn f3() -> Disturbed {
    Disturbed::new(
        [0.254669, 0.745344, 1.0],
        normalized([0.26758, -0.126517, 0.830936, -0.471105]),
        [-0.209147, -0.907682, 0.734482],
        [6.7053e-3, 0.77127, 1.9179, 1.026, 5.252, 0.1621],
        5.6811,
    )
}

fn f4(level: Level) -> Disturbed {
    let scene = Disturbed::new([0.5, 0.8, 1.0], ATTITUDE, [0.3, 0.2, 1.0], [6e-3, 0.0, 0.0, 0.0, 0.0, 0.0], 300.0);
    Disturbed { level, ..scene }
}

fn f5() -> Disturbed {
    Disturbed::new(
        [0.05, 0.999_998_7, 1.0],
        normalized([0.000139, 0.002552, -0.927803, -0.373063]),
        [0.0, 0.0, 1.0],
        [1.2476e-3, 0.22667, 0.0, 5.175, 0.0, 0.0],
        9402.4,
    )
}

fn normalized(q: [f64; 4]) -> [f64; 4] {
    let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt();
    q.map(|c| c / norm)
}

#[test]
fn explore() {
    for (name, scene) in [("f1", f1()), ("f1b", f1b()), ("f2", f2()), ("f3", f3()), ("f4m", f4(Level::Moving)), ("f4p", f4(Level::Paper)), ("f5", f5())] {
        for averaging in [Averaging::Auto, Averaging::Spin, Averaging::Orbit] {
            let scene = Disturbed { averaging, ..scene };
            println!("{name} {averaging}: {:?}", scene.measured());
            if let Ok(motion) = scene.solve() { println!("{}", motion.plan()); 
            let q = motion.at(0.0).unwrap().attitude.coords.into(); println!("at epoch {:e}", andoyer_tests::attitude_error(q, scene.attitude)); }
        }
    }
}
