//! Derivatives for a steady rotation (theory §12): a body at rest, a sphere, a principal axis, or any axis in the plane of two equal moments.
//!
//! g is constant, so δġ = A δg + f with A δg = δg × ω + g × ν δg and f = g × δν g, both constant. Since A³ = λ² A and, for a change of the moments, A² f = 0,
//!
//! ```text
//! δg = δg0 + S A δg0 + C A² δg0 + t f + C A f      S = sinh λt/λ      C = (cosh λt − 1)/λ²
//! ```
//!
//! A change of a product of inertia has another f, with A² f = λ² f, and S f replaces t f. The moments have f = 0 for λ ≠ 0, and S = t for λ = 0, so this
//! formula holds for them too.
//!
//! S and C are a sine and a cosine about an axis of extreme inertia, where λ² = −(dℓ′/dt)², and t and t²/2 if λ = 0. About the middle axis S grows until it
//! overflows.

use andoyer_double::{DoubleDouble, two_sum};

use crate::error::Error;
use crate::motion::solved::Motion;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::user_rate;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::Polhode;

use super::constants::{CHANGES, Setting};
use super::derivatives::Derivatives;
use super::displacement::Displacement;

/// Largest λt. Beyond it e^(λt) times its factor may overflow.
const LONGEST_GROWTH: f64 = 300.0;

/// The growth of a change with time.
#[derive(Clone, Copy, Debug)]
pub(super) enum Growth {
    /// Oscillation: half of ℓ′, and dℓ′/dt, scaled.
    Oscillation(Phase, f64),
    /// Exponential growth with λ, scaled.
    Exponential(f64),
    /// Polynomial growth, λ = 0.
    Polynomial,
}

/// The vectors of one parameter, in user components.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ParameterVectors {
    /// Factors of 1, S, C and t in δg.
    pub(super) change: [[f64; 3]; 4],
    /// Growth of g·δθ.
    pub(super) turn: f64,
}

/// The quantities from which derivatives for a steady rotation are computed.
#[derive(Clone, Debug)]
pub(super) struct Varied {
    pub(super) growth: Growth,
    pub(super) vectors: [ParameterVectors; CHANGES],
    /// Largest time from the epoch, in the user's unit.
    bound: f64,
}

impl Varied {
    pub(super) fn new(polhode: &Polhode, setting: &Setting, mode: Mode) -> Self {
        let g = setting.direction;
        let apply = |v: [f64; 3]| apply(setting, v);
        let signs = polhode.frame.signs;
        let vectors = setting.changes.map(|change| {
            let [step, rate] = change.vectors();
            let force = [0, 1, 2].map(|i| (rate[(i + 2) % 3] - rate[(i + 1) % 3]) * g[(i + 1) % 3] * g[(i + 2) % 3]);
            let first = apply(step);
            let (second, pushed) = (apply(first), apply(force));
            let curved = std::array::from_fn(|i| second[i] + pushed[i]);
            let user = |v: [f64; 3]| {
                let mut user = [0.0; 3];
                for i in 0..3 {
                    user[setting.axes[i]] = change.unit * signs[i] * v[i];
                }
                user
            };
            let turn: f64 = (0..3).map(|i| g[i] * (setting.rates[i] * step[i] + rate[i] * g[i])).sum();
            ParameterVectors { change: [user(step), user(first), user(curved), user(force)], turn: change.unit * turn }
        });
        let growth = growth(polhode, setting, mode);
        let bound = match growth {
            Growth::Exponential(rate) => LONGEST_GROWTH / (rate * setting.unit),
            _ => f64::INFINITY,
        };
        Self { growth, vectors, bound }
    }

    /// # Errors
    /// - [`Error::Time`] for a time at which the change is beyond every double.
    pub(super) fn valid(&self, motion: &Motion, epoch: f64, times: &[f64]) -> Result<(), Error> {
        match times.iter().position(|time| (time - epoch).abs() > self.bound) {
            Some(index) => {
                let reason = ": about the middle axis a change grows beyond every double";
                Err(motion.too_far((index, times[index]), epoch, self.bound, reason))
            }
            None => Ok(()),
        }
    }

    /// S, C and the time, scaled.
    pub(super) fn numbers(&self, time: f64, epoch: f64, setting: &Setting) -> [f64; 3] {
        let elapsed = two_sum(time, -epoch);
        let time = elapsed.0 * setting.unit;
        match &self.growth {
            Growth::Oscillation(half, rate) => {
                let (sine, cosine) = half.angle(elapsed).sin_cos();
                [2.0 * sine * cosine / rate, 2.0 * (sine / rate) * (sine / rate), time]
            }
            Growth::Exponential(rate) => {
                let (sine, cosine) = ((0.5 * rate * time).sinh(), (0.5 * rate * time).cosh());
                [2.0 * sine * cosine / rate, 2.0 * (sine / rate) * (sine / rate), time]
            }
            Growth::Polynomial => [time, 0.5 * time * time, time],
        }
    }
}

/// δg for a displacement, from S and C: δg0 + S (A δg0 + f) + C A (A δg0 + f), on the sorted axes.
pub(super) fn change(setting: &Setting, displacement: &Displacement, [once, twice]: [f64; 2]) -> [f64; 3] {
    let (g, faster) = (setting.direction, displacement.faster(setting.direction));
    let force = [0, 1, 2].map(|i| g[(i + 1) % 3] * faster[(i + 2) % 3] - g[(i + 2) % 3] * faster[(i + 1) % 3]);
    let moved = apply(setting, displacement.step);
    let first = [0, 1, 2].map(|i| moved[i] + force[i]);
    let second = apply(setting, first);
    std::array::from_fn(|i| twice.mul_add(second[i], once.mul_add(first[i], displacement.step[i])))
}

/// A v, from the rows of the linearized ġ_i = d_i g_j g_k.
fn apply(setting: &Setting, v: [f64; 3]) -> [f64; 3] {
    let (g, d) = (setting.direction, setting.slopes);
    [0, 1, 2].map(|i| d[i] * (g[(i + 1) % 3] * v[(i + 2) % 3] + v[(i + 1) % 3] * g[(i + 2) % 3]))
}

fn growth(polhode: &Polhode, setting: &Setting, mode: Mode) -> Growth {
    // λ² = ½ tr A². On a principal axis only one of its terms is not 0.
    let (g, d) = (setting.direction, setting.slopes);
    let square: f64 = (0..3).map(|i| d[(i + 1) % 3] * d[(i + 2) % 3] * g[i] * g[i]).sum();
    if mode == Mode::Spherical || square == 0.0 {
        Growth::Polynomial
    } else if square > 0.0 {
        Growth::Exponential(square.sqrt())
    } else {
        let rate = polhode.invariants.mean_rate * polhode.invariants.gamma;
        let half = user_rate(rate * DoubleDouble::from(0.5), polhode.scales.1);
        Growth::Oscillation(Phase::new(half, 0.0), rate.to_f64())
    }
}

/// Derivatives of a body at rest, which turns by the rate times the time.
pub(super) fn at_rest<const N: usize>(
    times: &[f64],
    epoch: f64,
    attitudes: &mut [Derivatives<N>],
    rates: &mut [Derivatives<N>],
) {
    for ((time, attitude), rate) in times.iter().zip(attitudes).zip(rates) {
        let (elapsed, _) = two_sum(*time, -epoch);
        (*attitude, *rate) = ([[0.0; N]; 3], [[0.0; N]; 3]);
        for axis in 0..3 {
            attitude[axis][axis] = 1.0;
            attitude[axis][3 + axis] = elapsed;
            rate[axis][3 + axis] = 1.0;
        }
    }
}
