//! States under a gravity gradient whose mean wobble is 0, or nearly 0: the wobble that they have is the one that the torque forces.
//!
//! The two mean rates are proportional to the mean M, so their ratio depends on the mean σ = |p|² alone. It is least or greatest where σ is 0.

use andoyer_propagate::nalgebra::{Matrix6, Vector2, Vector6};
use andoyer_propagate::options::Averaging;
use andoyer_propagate::periods::Frequencies;

use crate::disturbed::Disturbed;

/// The distances of the points around a state, over the tilt at the separatrix: each fit is exact to the square of its distance and of the last error.
const DISTANCES: [f64; 3] = [3e-3, 1e-3, 1e-4];

/// The scene with another direction of the angular momentum in the body: the mean wobble is 0, and `offset` is added to the direction across the axis of the mode.
/// `None` if a scene near by is refused.
pub fn without_mean_wobble(scene: Disturbed, axis: usize, offset: [f64; 2]) -> Option<Disturbed> {
    let moments = scene.moments;
    let momentum: [f64; 3] = std::array::from_fn(|i| moments[i] * scene.rates[i]);
    let size = momentum.iter().map(|part| part * part).sum::<f64>().sqrt().copysign(momentum[axis]);
    let others = if axis == 0 { [1, 2] } else { [0, 1] };
    let tilted = |across: Vector2<f64>| {
        let mut direction = [0.0; 3];
        (direction[others[0]], direction[others[1]]) = (across.x, across.y);
        direction[axis] = (1.0 - across.norm_squared()).sqrt();
        Disturbed { rates: std::array::from_fn(|i| size * direction[i] / moments[i]), ..scene }
    };
    let ratio = |across: Vector2<f64>| {
        let motion = Disturbed { averaging: Averaging::Spin, ..tilted(across) }.solve().ok()?;
        let Frequencies { anomaly, longitude } = motion.frequencies();
        Some(anomaly / longitude)
    };
    let inverse = |i: usize| 1.0 / moments[i];
    let excess = |i: usize| (inverse(i) - inverse(axis)).abs();
    let [first, second] = others.map(excess);
    let separatrix = (first.min(second) / first.max(second)).sqrt();
    let mut centre = Vector2::zeros();
    for distance in DISTANCES {
        centre += extremum(|by| ratio(centre + by), distance * separatrix)?;
    }
    Some(tilted(centre + Vector2::from(offset)))
}

/// The place of the extremum of a function that is nearly a quadratic form, from six points at a distance from the origin at most.
fn extremum(function: impl Fn(Vector2<f64>) -> Option<f64>, distance: f64) -> Option<Vector2<f64>> {
    let points = [[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [0.7, 0.7]];
    let rows = points.map(|[x, y]| Vector6::new(1.0, x, y, 0.5 * x * x, x * y, 0.5 * y * y).transpose());
    let mut values = Vector6::zeros();
    for (value, point) in values.iter_mut().zip(points) {
        *value = function(Vector2::from(point) * distance)?;
    }
    let fit = Matrix6::from_rows(&rows).lu().solve(&values)?;
    let determinant = fit[3] * fit[5] - fit[4] * fit[4];
    let place = Vector2::new(fit[4] * fit[2] - fit[5] * fit[1], fit[4] * fit[1] - fit[3] * fit[2]) / determinant;
    (place.norm() < 30.0).then_some(place * distance)
}
