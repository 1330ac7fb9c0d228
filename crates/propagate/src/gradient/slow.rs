//! The averaged motion of the angular momentum under the gravity gradient (theory §9), with an invariable frame that does not turn about it.
//!
//! With k the unit angular momentum, Δ(σ) = (3 T33 − A − B − C)/2 averaged over ℓ′ and y′, and κ = 3n Δ/(M η³) times the mass fraction,
//!
//! ```text
//! dk/df = κ (1 + e cos f) (k·r̂) (r̂ × k)          dJ/df = n η^(−3) (1 + e cos f) (1 − 3 (k·r̂)²)
//! ```
//!
//! where J is what Δ is multiplied by in the phases. `Slow::Spin` solves this on quarters of an orbit by Picard's iteration on Chebyshev points: the right-hand side is
//! a trigonometric polynomial of f and κ is small, so that a few iterations converge to rounding and the result is its own dense output. Quarters are solved when a time
//! first needs them and kept. `Slow::Orbit` is the orbit average, first order in κ: steady precession about the orbit's normal, with the periodic part in closed form in f, no expansion in e.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::sync::{Arc, RwLock};

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::orbit::{Orbit, Place};

/// Chebyshev points of a quarter: what a degree of 17 leaves of cos 3f is 1e-15 of κ.
const POINTS: usize = 18;
/// Picard's iterations: each multiplies the error by κ at most.
const MOST_ITERATIONS: usize = 40;
/// Quarters that are kept on each side of the epoch; 0.7 kB each.
pub(crate) const MOST_QUARTERS: usize = 1 << 18;

/// Frame (quaternion x, y, z, w) and J.
type Column = [f64; 5];

/// An orbit as the averaged motion sees it.
#[derive(Clone, Debug)]
pub(crate) struct Ellipse {
    pub(crate) eccentricity: f64,
    eta_cubed: f64,
    /// n in the units of the motion.
    mean_motion: f64,
    axes: [Vector3<f64>; 3],
    /// κ.
    strength: f64,
}

/// Where the disturbing body is: whole turns since the epoch's pericentre, place and mean anomaly, in (−π, π].
#[derive(Clone, Copy, Debug)]
pub(crate) struct When {
    pub(crate) turns: f64,
    pub(crate) place: Place,
    pub(crate) mean_anomaly: f64,
}

/// The averaged motion.
#[derive(Clone, Debug)]
pub(crate) enum Slow {
    /// Averaged over the rotation alone.
    Spin(Box<Spin>),
    /// Averaged over the orbit too.
    Orbit(Precession),
}

impl Slow {
    /// The frame and J at a place of the orbit.
    pub(crate) fn at(&self, when: &When) -> (UnitQuaternion<f64>, f64) {
        match self {
            Self::Spin(spin) => spin.at(when),
            Self::Orbit(precession) => precession.at(when),
        }
    }
}

impl Ellipse {
    /// `delta` is Δ times the mass fraction over M.
    pub(crate) fn new(orbit: &Orbit, mean_motion: f64, delta: f64) -> Self {
        let eccentricity = orbit.eccentricity();
        let eta = (1.0 - eccentricity * eccentricity).sqrt();
        let eta_cubed = eta * eta * eta;
        let strength = 3.0 * mean_motion * delta / eta_cubed;
        Self { eccentricity, eta_cubed, mean_motion, axes: orbit.axes(), strength }
    }

    /// κ.
    pub(crate) fn strength(&self) -> f64 {
        self.strength
    }

    fn slope(&self, frame: &Quaternion<f64>, sine: f64, cosine: f64) -> Column {
        let direction = self.axes[0] * cosine + self.axes[1] * sine;
        let weight = 1.0 + self.eccentricity * cosine;
        let axis = (frame * Quaternion::new(0.0, 0.0, 0.0, 1.0) * frame.conjugate()).imag();
        let along = axis.dot(&direction);
        // k × dk: it turns k and not about k.
        let turning = (direction - axis * along) * (self.strength * weight * along);
        let change = Quaternion::from_parts(0.0, turning * 0.5) * frame;
        let phase = self.mean_motion / self.eta_cubed * weight * (1.0 - 3.0 * along * along);
        [change.i, change.j, change.k, change.w, phase]
    }
}

/// The averaged motion by quarters of the orbit.
#[derive(Clone, Debug)]
pub(crate) struct Spin {
    ellipse: Ellipse,
    /// The quarter of the epoch, counted from the pericentre before it.
    first: i64,
    epoch: Quarter,
    /// The quarters after it and before it.
    kept: Arc<[RwLock<Vec<Quarter>>; 2]>,
}

/// Chebyshev coefficients over a quarter.
#[derive(Clone, Debug)]
struct Quarter {
    coefficients: [Column; POINTS],
}

impl Spin {
    /// From the frame at a place of the orbit, where J is 0.
    pub(crate) fn new(ellipse: Ellipse, frame: UnitQuaternion<f64>, when: &When) -> Self {
        let (first, inside) = quarter(when);
        let start: Column = [frame.i, frame.j, frame.k, frame.w, 0.0];
        let epoch = Quarter::solved(&ellipse, first, inside, &start);
        Self { ellipse, first, epoch, kept: Arc::default() }
    }

    fn at(&self, when: &When) -> (UnitQuaternion<f64>, f64) {
        let (index, inside) = quarter(when);
        let column = match index - self.first {
            0 => self.epoch.at(inside),
            later if later > 0 => self.far(0, later as usize - 1, inside),
            earlier => self.far(1, earlier.unsigned_abs() as usize - 1, inside),
        };
        let [x, y, z, w, phase] = column;
        (UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)), phase)
    }

    /// A quarter on one side, which is solved with all before it if it was not needed yet.
    fn far(&self, side: usize, index: usize, inside: f64) -> Column {
        let kept = &self.kept[side];
        // A thread that panicked while it held the lock left whole quarters behind.
        if let Some(quarter) = kept.read().unwrap_or_else(|poisoned| poisoned.into_inner()).get(index) {
            return quarter.at(inside);
        }
        let mut quarters = kept.write().unwrap_or_else(|poisoned| poisoned.into_inner());
        let (step, end) = if side == 0 { (1, 1.0) } else { (-1, -1.0) };
        while quarters.len() <= index {
            let start = quarters.last().unwrap_or(&self.epoch).at(end);
            let number = self.first + step * (quarters.len() as i64 + 1);
            quarters.push(Quarter::solved(&self.ellipse, number, -end, &start));
        }
        quarters[index].at(inside)
    }
}

/// The quarter, counted from the epoch's pericentre, and the place in it from −1 to 1.
fn quarter(when: &When) -> (i64, f64) {
    let quarters = when.place.angle / FRAC_PI_2;
    let part = quarters.floor().clamp(-2.0, 1.0);
    let inside = (2.0 * (quarters - part) - 1.0).clamp(-1.0, 1.0);
    // Within MOST_QUARTERS, by the motion's bound.
    (4 * when.turns as i64 + part as i64, inside)
}

impl Quarter {
    /// The solution through `start` at a place of the quarter.
    fn solved(ellipse: &Ellipse, number: i64, place: f64, start: &Column) -> Self {
        let middle = (number.rem_euclid(4) as f64 + 0.5) * FRAC_PI_2;
        let nodes: [f64; POINTS] = std::array::from_fn(|i| (PI * (i as f64 + 0.5) / POINTS as f64).cos());
        let circles = nodes.map(|x| (middle + FRAC_PI_4 * x).sin_cos());
        let mut values = [*start; POINTS];
        let mut quarter = Self { coefficients: [[0.0; 5]; POINTS] };
        for _ in 0..MOST_ITERATIONS {
            let slopes: [Column; POINTS] = std::array::from_fn(|i| {
                let [x, y, z, w, _] = values[i];
                ellipse.slope(&Quaternion::new(w, x, y, z), circles[i].0, circles[i].1)
            });
            quarter = Self::integral(&slopes);
            let offset = quarter.at(place);
            for c in 0..5 {
                quarter.coefficients[0][c] += start[c] - offset[c];
            }
            let mut change = 0.0_f64;
            for (value, &x) in values.iter_mut().zip(&nodes) {
                let next = quarter.at(x);
                change = (0..4).fold(change, |most, c| most.max((next[c] - value[c]).abs()));
                *value = next;
            }
            if change <= 4.0 * f64::EPSILON {
                break;
            }
        }
        quarter
    }

    /// The primitive of what has these values at the points, up to a constant.
    fn integral(slopes: &[Column; POINTS]) -> Self {
        let count = POINTS as f64;
        let mut series = [[0.0; 5]; POINTS + 1];
        for (k, sum) in series.iter_mut().enumerate().take(POINTS) {
            let scale = if k == 0 { 1.0 } else { 2.0 } / count * FRAC_PI_4;
            for (i, slope) in slopes.iter().enumerate() {
                let weight = scale * (PI * k as f64 * (i as f64 + 0.5) / count).cos();
                for c in 0..5 {
                    sum[c] += weight * slope[c];
                }
            }
        }
        let mut coefficients = [[0.0; 5]; POINTS];
        for k in 1..POINTS {
            let lower = if k == 1 { 2.0 } else { 1.0 };
            for c in 0..5 {
                coefficients[k][c] = (lower * series[k - 1][c] - series[k + 1][c]) / (2.0 * k as f64);
            }
        }
        Self { coefficients }
    }

    /// Clenshaw's sum.
    fn at(&self, x: f64) -> Column {
        let (mut next, mut after) = ([0.0; 5], [0.0; 5]);
        for coefficient in self.coefficients[1..].iter().rev() {
            for c in 0..5 {
                (next[c], after[c]) = (coefficient[c] + 2.0 * x * next[c] - after[c], next[c]);
            }
        }
        std::array::from_fn(|c| self.coefficients[0][c] + x * next[c] - after[c])
    }
}

/// Steady precession and the periodic part of one orbit.
#[derive(Clone, Debug)]
pub(crate) struct Precession {
    ellipse: Ellipse,
    /// The mean frame at the epoch.
    frame: UnitQuaternion<f64>,
    start: When,
    /// J of the periodic part at the epoch.
    phase: f64,
}

impl Precession {
    /// From the frame at a place of the orbit, where J is 0.
    pub(crate) fn new(ellipse: Ellipse, frame: UnitQuaternion<f64>, when: &When) -> Self {
        let mut precession = Self { ellipse, frame, start: *when, phase: 0.0 };
        // The mean axis to first order, then once more with the periodic part at itself.
        for _ in 0..3 {
            let (rotation, _) = precession.periodic(&precession.frame, when);
            precession.frame = UnitQuaternion::from_scaled_axis(-rotation) * frame;
        }
        precession.phase = precession.periodic(&precession.frame, when).1;
        precession
    }

    fn at(&self, when: &When) -> (UnitQuaternion<f64>, f64) {
        let normal = self.ellipse.axes[2];
        let axis = self.frame * Vector3::z();
        let cosine = axis.dot(&normal);
        // (3/2) sin² I − 1 without cancellation at I = 0.
        let sine_square = axis.cross(&normal).norm_squared();
        let elapsed =
            std::f64::consts::TAU * (when.turns - self.start.turns) + (when.mean_anomaly - self.start.mean_anomaly);
        // dλ/dt = −(3/2) n² Δ cos I/(M η³): κ is 3 n Δ/(M η³).
        let angle = -0.5 * self.ellipse.strength * cosine * elapsed;
        let turn = UnitQuaternion::from_scaled_axis(normal * angle);
        let back = UnitQuaternion::from_scaled_axis(Vector3::z() * (-cosine * angle));
        let mean = turn * self.frame * back;
        let (rotation, phase) = self.periodic(&mean, when);
        let secular = (1.0 - 1.5 * sine_square) * elapsed / self.ellipse.eta_cubed;
        (UnitQuaternion::from_scaled_axis(rotation) * mean, self.ellipse.mean_motion * secular + phase - self.phase)
    }

    /// What the orbit average leaves out: a rotation (inertial) and J, by the integrals of theory §9.
    fn periodic(&self, frame: &UnitQuaternion<f64>, when: &When) -> (Vector3<f64>, f64) {
        let Ellipse { eccentricity: e, eta_cubed, mean_motion, axes, strength } = &self.ellipse;
        let Place { angle, sine, cosine } = when.place;
        let (double_sine, double_cosine) = (2.0 * sine * cosine, (cosine - sine) * (cosine + sine));
        let (triple_sine, triple_cosine) =
            (double_sine * cosine + double_cosine * sine, double_cosine * cosine - double_sine * sine);
        let constant = angle - when.mean_anomaly + e * sine;
        let by_cosine = 0.5 * double_sine + 0.5 * e * sine + e * triple_sine / 6.0;
        let by_sine = -(0.5 * double_cosine + 0.5 * e * cosine + e * triple_cosine / 6.0);
        let outer = |u: &Vector3<f64>, v: &Vector3<f64>| u * v.transpose();
        let tensor: Matrix3<f64> = ((outer(&axes[0], &axes[0]) + outer(&axes[1], &axes[1])) * constant
            + (outer(&axes[0], &axes[0]) - outer(&axes[1], &axes[1])) * by_cosine
            + (outer(&axes[0], &axes[1]) + outer(&axes[1], &axes[0])) * by_sine)
            * 0.5;
        let axis = frame * Vector3::z();
        let turned = tensor * axis;
        let along = axis.dot(&turned);
        ((turned - axis * along) * *strength, mean_motion / eta_cubed * (constant - 3.0 * along))
    }
}
