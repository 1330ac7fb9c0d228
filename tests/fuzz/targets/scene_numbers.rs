//! Any doubles as a scene: an error, or a motion whose samples are unit quaternions and finite rates that keep the angular momentum.
#![no_main]

use andoyer_propagate::{Body, Method, Scene, State};
use libfuzzer_sys::fuzz_target;

/// Moments, attitude, rates, epoch, tolerance, two times.
const NUMBERS: usize = 3 + 4 + 3 + 2 + 2;

fuzz_target!(|bytes: &[u8]| {
    let (Some(&choice), true) = (bytes.last(), bytes.len() > 8 * NUMBERS) else { return };
    let mut x = [0.0; NUMBERS];
    for (number, chunk) in x.iter_mut().zip(bytes.chunks_exact(8)) {
        *number = f64::from_le_bytes(chunk.try_into().expect("eight bytes"));
    }
    let mut attitude = [x[3], x[4], x[5], x[6]];
    let norm = attitude.iter().map(|c| c * c).sum::<f64>().sqrt();
    if choice & 1 == 0 && norm.is_normal() {
        attitude = attitude.map(|c| c / norm);
    }
    let Ok(body) = Body::new([x[0], x[1], x[2]]) else { return };
    let Ok(state) = State::new(x[10], attitude, [x[7], x[8], x[9]]) else { return };
    let scene = Scene::new(body, state).tolerance(x[11]);
    let scene = match choice >> 1 & 3 {
        0 => scene,
        1 => scene.method(Method::Closed),
        2 => scene.method(Method::Series),
        _ => scene.order(usize::from(choice >> 3)),
    };
    let Ok(motion) = scene.solve() else { return };
    let plan = motion.plan();
    assert!(plan.error_bound() > 0.0 && (0.0..=1.0).contains(&plan.separatrix_ratio()), "{plan}");
    assert!(motion.angular_momentum().iter().all(|component| component.is_finite()));
    let mut attitudes = [[0.0; 4]; 4];
    let mut rates = [[0.0; 3]; 4];
    let times = [x[10], x[12], x[13], 0.0];
    if motion.samples_into(&times, &mut attitudes, &mut rates).is_ok() {
        for (attitude, rates) in attitudes.iter().zip(&rates) {
            let norm = attitude.iter().map(|c| c * c).sum::<f64>().sqrt();
            assert!((norm - 1.0).abs() < 1e-12 && rates.iter().all(|rate| rate.is_finite()), "{attitude:?} {rates:?} {plan}");
        }
    }
    for time in times {
        if let Ok(sample) = motion.at(time) {
            assert!((sample.attitude.norm() - 1.0).abs() < 1e-12 && sample.angular_velocity.iter().all(|rate| rate.is_finite()));
        }
    }
});
