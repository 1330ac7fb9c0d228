//! Any text as a scene file: an error, or a scene that survives writing and whose motion, if there is one, is finite.
#![no_main]

use andoyer_propagate::Scene;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(scene) = Scene::parse_toml(text, "fuzz.toml") else { return };
    let again = Scene::parse_toml(&scene.to_toml(), "again.toml").expect("what was written");
    assert_eq!(again.to_toml(), scene.to_toml());
    let Ok(motion) = scene.solve() else { return };
    assert!(!motion.plan().error_bound().is_nan() && !motion.plan().to_string().is_empty());
    let epoch = scene.state().epoch;
    for time in [epoch, epoch + 1.0, 0.0] {
        if let Ok(sample) = motion.at(time) {
            assert!((sample.attitude.norm() - 1.0).abs() < 1e-12, "{:?} at {time:e}", sample.attitude);
            assert!(sample.angular_velocity.iter().all(|rate| rate.is_finite()));
        }
    }
});
