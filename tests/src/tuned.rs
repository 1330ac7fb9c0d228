//! Scenes that are tuned: next to a resonance, next to a sphere, and with a mean wobble next to 0. `part` has the coordinates of a scene beyond the first eleven.

use std::f64::consts::TAU;

use andoyer_propagate::options::{Averaging, Level};
use andoyer_propagate::periods::Frequencies;

use crate::climb::{Family, power};
use crate::disturbed::Disturbed;
use crate::mean_wobble::without_mean_wobble;

/// The scene with a mean wobble next to 0: `part` chooses the kind of the orbit, the level of first order, and the wobble.
pub(crate) fn nearly_without_wobble(scene: Disturbed, part: &[f64]) -> Disturbed {
    let refined = scene.level == Level::SecondOrder || scene.averaging == Averaging::Orbit;
    let scene = match (refined, (4.0 * part[6]) as usize) {
        (true, 0 | 1) | (false, 0) => {
            let [mean_motion, _, pericentre, inclination, node, argument] = scene.orbit;
            Disturbed { orbit: [mean_motion, 0.0, pericentre, inclination, node, argument], ..scene }
        }
        (false, 1) => Family::Precessing.extended(scene, part),
        (false, 2) => Family::TwoBodies.extended(scene, part),
        _ => scene,
    };
    let level = match (refined, (4.0 * part[7]) as usize) {
        (false, 0) => Level::Paper,
        (false, 1) => Level::Moving,
        _ => scene.level,
    };
    let scene = Disturbed { level, ..scene };
    let axis = if scene.rates[0] == 0.0 { 2 } else { 0 };
    let wobble = if part[8] < 0.1 { 0.0 } else { power(-9.0, -3.0, part[8]) };
    let (across, along) = (TAU * part[9]).sin_cos();
    without_mean_wobble(scene, axis, [across, along].map(|way| wobble * way)).unwrap_or(scene)
}

/// The scene with another mean motion n, for which |Ω + jn| of a term times the span is 1e-4 to 2: `part` chooses the term, j and Ω + jn.
pub(crate) fn next_to_resonance(scene: Disturbed, part: &[f64]) -> Disturbed {
    let [n, eccentricity, pericentre, inclination, node, argument] = scene.orbit;
    let Ok(motion) = scene.free().and_then(|scene| scene.solve()) else { return scene };
    let Frequencies { anomaly, longitude } = motion.frequencies();
    let size = power(-4.0, 0.3, part[1]) / scene.span.abs();
    let x = if part[2] < 0.5 { size } else { -size };
    // Harmonic j is smaller than the first by about e^(−j (artanh η − η)).
    let eta = (1.0 - eccentricity * eccentricity).sqrt();
    let highest = (8.0 / (eta.atanh() - eta)).min(80.0) as i32;
    let mut motions = Vec::new();
    for (h, m) in [(2, 0), (1, 1), (-1, 1), (-3, 1), (0, 2), (2, 2), (-2, 2), (-4, 2)] {
        let omega = f64::from(h) * anomaly + f64::from(m) * longitude;
        motions.extend(
            (1..=highest).map(|j| (x - omega).abs() / f64::from(j)).filter(|tuned| (0.5 * n..2.0 * n).contains(tuned)),
        );
    }
    let Some(&tuned) = motions.get((part[0] * motions.len() as f64) as usize) else { return scene };
    Disturbed { orbit: [tuned, eccentricity, pericentre * n / tuned, inclination, node, argument], ..scene }
}

/// The scene of a body whose moments differ by 1e-7 to 1e-3, under an attraction of 0.3 to 160 n², half of them on circles: `part` chooses the
/// differences of the moments, the attraction, n/spin from 0.01 to 0.13, and the eccentricity.
pub(crate) fn next_to_a_sphere(scene: Disturbed, part: &[f64]) -> Disturbed {
    let [n, eccentricity, pericentre, inclination, node, argument] = scene.orbit;
    let spread = power(-7.0, -3.0, part[0]);
    let moments = scene.moments.map(|moment| 1.0 - spread * (1.0 - moment));
    let rates = std::array::from_fn(|i| scene.rates[i] * scene.moments[i] / moments[i]);
    let motion = power(-2.0, -0.9, part[2]);
    let eccentricity = if part[3] < 0.5 { 0.0 } else { 1.25 * eccentricity };
    let orbit = [motion, eccentricity, pericentre * n / motion, inclination, node, argument];
    Disturbed { moments, rates, orbit, attraction: power(-0.5, 2.2, part[1]), ..scene }
}
