//! The polhode of a state: its position among the motions of the body, computed without cancellation.
//!
//! The state is transformed to the frame of the theory (axes sorted, N ≥ 0) and scaled by powers of two, so that any unit gives the same bits. Let g = G/M be
//! the unit angular momentum in the body, a = C/A − 1, b = C/B − 1, and ℓ the angle of theory §1. Then
//!
//! ```text
//! cos²J = Q(ℓ) = Q1 cos²ℓ + Q2 sin²ℓ,   Q1 = g3² − g1² (a−b)/b,   Q2 = g3² + g2² (a−b)/a
//! γE = a g1² + b g2²,                  κE = α (g1²/b + g2²/a)
//! ```
//!
//! Q1 > 0 is the short-axis mode, and Q1 = 0 the separatrix. No difference of energies is computed (theory §5, §7). The long-axis mode has the same formulas
//! with the axes in the opposite order: A ≥ B ≥ C, and a, b and γ are negative, so that ℓ′ runs backwards (theory §10).

use std::f64::consts::FRAC_2_PI;

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use andoyer_double::DoubleDouble;

use super::columns::{Rotation, SortedState};
use super::invariants::Invariants;
use crate::input::body::Body;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::numerics::scaling::{exponent, scaled, scaled_pair};

/// The body axes in the order of the theory. Axis C points along the user's axis, or against it if N < 0. Axis A is reversed if the axes would be left-handed
/// otherwise.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    /// Index of the user's axis of each sorted axis.
    pub(crate) axes: [usize; 3],
    /// Sign of each sorted axis relative to the user's axis.
    pub(crate) signs: [f64; 3],
    /// Rotation from the user's body components to sorted components.
    pub(crate) quaternion: UnitQuaternion<f64>,
}

impl Frame {
    /// The frame for these moments. `momentum` is a body vector whose component on axis 3 must become ≥ 0. Axis 3 is the axis of C, or of A for the long-axis
    /// mode.
    pub(crate) fn new(moments: [DoubleDouble; 3], momentum: [f64; 3], long_axis: bool) -> Self {
        Order::new(moments, momentum, long_axis).frame()
    }

    /// Components on the sorted axes.
    pub(crate) fn sorted(&self, vector: [f64; 3]) -> [f64; 3] {
        Order { axes: self.axes, signs: self.signs }.sorted(vector)
    }

    /// Components on the user's axes.
    pub(crate) fn user(&self, sorted: [f64; 3]) -> [f64; 3] {
        let mut vector = [0.0; 3];
        for i in 0..3 {
            vector[self.axes[i]] = self.signs[i] * sorted[i];
        }
        vector
    }
}

/// The axes and signs of a frame.
#[derive(Clone, Copy)]
struct Order {
    axes: [usize; 3],
    signs: [f64; 3],
}

impl Order {
    fn new(moments: [DoubleDouble; 3], momentum: [f64; 3], long_axis: bool) -> Self {
        let mut axes = [0, 1, 2];
        for (i, j) in [(0, 1), (1, 2), (0, 1)] {
            let [one, other] = [i, j].map(|place| moments[axes[place]]);
            if (one.high, one.low) > (other.high, other.low) {
                axes.swap(i, j);
            }
        }
        if long_axis {
            axes.reverse();
        }
        let even = (axes[0] + 1) % 3 == axes[1];
        let first = if even { 1.0 } else { -1.0 };
        let upright = if momentum[axes[2]] < 0.0 { -1.0 } else { 1.0 };
        Self { axes, signs: [first, upright, upright] }
    }

    fn frame(self) -> Frame {
        let Self { axes, signs } = self;
        let mut matrix = Matrix3::zeros();
        for i in 0..3 {
            matrix[(i, axes[i])] = signs[i];
        }
        let quaternion = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
        Frame { axes, signs, quaternion }
    }

    /// Components on the sorted axes.
    fn sorted(&self, vector: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| self.signs[i] * vector[self.axes[i]])
    }

    fn sorted_pairs(&self, vector: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
        std::array::from_fn(|i| {
            let DoubleDouble { high, low } = vector[self.axes[i]];
            DoubleDouble { high: self.signs[i] * high, low: self.signs[i] * low }
        })
    }
}

/// The constant rotations on both sides of the Cayley–Klein parameters: the attitude is inertial · (a, b) · frame.
#[derive(Clone, Debug)]
pub(crate) struct UserFrame {
    pub(crate) inertial: UnitQuaternion<f64>,
    pub(crate) frame: Frame,
    /// M divided by each moment, on the sorted axes.
    pub(crate) rates: Vector3<f64>,
}

/// sin J below which the wobble is neglected, because its square is not a normal double.
pub(crate) const SMALLEST_TILT: f64 = 1e-150;
/// Relative difference of two terms above which their rounding errors in doubles do not exchange them.
const DECIDED: f64 = 1e-14;
/// Sums of squares above this have normal doubles for terms, but for negligible ones.
const SMALLEST_SQUARE: f64 = 1e-290;

/// Smallest divisor of the closed form of the derivatives. Its rounding error, 4e-15 over the divisor, is then 4e-11.
const SMALLEST_DIVISOR: f64 = 1e-4;

/// The axes of a state, and its body and rates on them in scaled units.
struct Placed {
    frame: Frame,
    long_axis: bool,
    moments: [DoubleDouble; 3],
    rates: [DoubleDouble; 3],
    scales: (i32, i32),
}

impl Placed {
    /// `None` for a body at rest.
    fn new(body: &Body, precise_rates: [DoubleDouble; 3]) -> Option<Self> {
        let rates = precise_rates.map(|rate| rate.high);
        let largest = rates.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
        if largest == 0.0 {
            return None;
        }
        let scales = (exponent(body.sorted()[2]), exponent(largest));
        let given = body.precise_moments();
        let moments = given.map(|moment| scaled_pair(moment, -scales.0));
        let scaled_rates = precise_rates.map(|rate| scaled_pair(rate, -scales.1));
        let order = |long_axis: bool| {
            let order = Order::new(given, rates, long_axis);
            (order, order.axes.map(|axis| moments[axis]), order.sorted_pairs(scaled_rates))
        };
        let short = order(false);
        let long_axis = beyond(short.1, short.2);
        let (order, moments, rates) = if long_axis { order(true) } else { short };
        Some(Self { frame: order.frame(), long_axis, moments, rates, scales })
    }

    fn given(&self) -> SortedState {
        SortedState { moments: self.moments, rotation: Rotation::Rates(self.rates), long_axis: self.long_axis }
    }

    fn with(self, invariants: Invariants) -> Polhode {
        let Self { frame, long_axis, moments: precise_moments, scales, .. } = self;
        let moments = precise_moments.map(|moment| moment.high);
        Polhode { frame, long_axis, moments, precise_moments, scales, invariants }
    }
}

/// Whether a motion, with its axes in the order of the short-axis mode, is in the long-axis mode: Q1 < 0. The two terms of Q1 are compared in doubles, and in
/// double-double if rounding might decide.
fn beyond([a, b, c]: [DoubleDouble; 3], [first, second, third]: [DoubleDouble; 3]) -> bool {
    let (x, y, z) = (a.high * first.high, b.high * second.high, c.high * third.high);
    let [upper, lower] = [c - b, b - a];
    if upper.high == 0.0 {
        return a != c && x.abs() >= SMALLEST_TILT * (x * x + y * y + z * z).sqrt();
    }
    let (least, greatest) = (z * z * (a.high * upper.high), x * x * (c.high * lower.high));
    if (least - greatest).abs() > DECIDED * (least + greatest) && least + greatest > SMALLEST_SQUARE {
        return least < greatest;
    }
    let (x, z) = (a * first, c * third);
    let (least, greatest) = (z * z * (a * upper), x * x * (c * lower));
    (least - greatest).high < 0.0
}

/// A state reduced to the quantities of theory §1, §5 and §7.
#[derive(Clone, Debug)]
pub(crate) struct Polhode {
    pub(crate) frame: Frame,
    /// Whether the axes are in the opposite order (long-axis mode).
    pub(crate) long_axis: bool,
    /// A, B, C divided by a power of two; C, B, A in the long-axis mode.
    pub(crate) moments: [f64; 3],
    /// The same in double-double.
    precise_moments: [DoubleDouble; 3],
    /// Binary exponents by which the moments and the rates were scaled.
    pub(crate) scales: (i32, i32),
    /// The constants that several bodies have computed at once.
    pub(crate) invariants: Invariants,
}

impl Polhode {
    /// The polhode of a valid state, or `None` for a body at rest.
    ///
    /// The motion is in the long-axis mode if Q1 < 0. If B = C, it is in the long-axis mode unless the rotation is about an axis perpendicular to axis 1.
    pub(crate) fn new(body: &Body, state: &State) -> Option<Self> {
        Self::placed(Placed::new(body, <[f64; 3]>::from(state.angular_velocity).map(DoubleDouble::from))?)
    }

    /// The polhode of the state of a valid scene, with its rates in double-double.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        Self::placed(Placed::new(scene.body(), scene.precise_rates())?)
    }

    fn placed(placed: Placed) -> Option<Self> {
        let invariants = Invariants::of(&placed.given());
        Some(placed.with(invariants))
    }

    /// The polhodes of several valid scenes, each to the bits of [`Polhode::of`].
    pub(crate) fn several(scenes: &[&Scene]) -> Vec<Option<Self>> {
        let placed = |scene: &&Scene| Placed::new(scene.body(), scene.precise_rates());
        let placed: Vec<Option<Placed>> = scenes.iter().map(placed).collect();
        let given: Vec<SortedState> = placed.iter().flatten().map(Placed::given).collect();
        let mut invariants = Invariants::several(&given).into_iter();
        let mut with = |placed: Placed| invariants.next().map(|invariants| placed.with(invariants));
        placed.into_iter().map(|place| place.and_then(&mut with)).collect()
    }

    /// The same body rotating with M and sin²J = `square` at ℓ = 0.
    pub(crate) fn tilted(&self, square: f64, momentum: f64) -> Self {
        self.with_squares([square.into(), DoubleDouble::ONE - square.into()], momentum)
    }

    /// The same body rotating with M and these sin²J and cos²J at ℓ = 0.
    pub(crate) fn with_squares(&self, squares: [DoubleDouble; 2], momentum: f64) -> Self {
        let squares = [DoubleDouble::ZERO, squares[0], squares[1]];
        let rotation = Rotation::Squares(squares, momentum.into());
        let given = SortedState { moments: self.precise_moments, rotation, long_axis: self.long_axis };
        Self { invariants: Invariants::of(&given), ..self.clone() }
    }

    /// β of theory §1 to 32 digits, for the axes in this order.
    pub(crate) fn precise_beta(&self) -> DoubleDouble {
        let [first, second] = self.invariants.excesses;
        let beta = self.invariants.difference / (first + second);
        if beta.to_f64() >= 1.0 { DoubleDouble::ONE } else { beta }
    }

    /// σ_sep(β) for the axes in this order: 1 for A = B and 0 for B = C (theory §5).
    ///
    /// It is computed from the moments, (1−β)/2β = b/(a−b), so that it keeps its relative accuracy when β is close to 1.
    pub(crate) fn separatrix_action(&self) -> f64 {
        let Invariants { excesses, difference, .. } = self.invariants;
        let [second, difference] = [excesses[1], difference].map(|x| x.to_f64().abs().sqrt());
        FRAC_2_PI * second.atan2(difference)
    }

    /// α of theory §1.
    pub(crate) fn alpha(&self) -> DoubleDouble {
        let [first, second] = self.invariants.excesses;
        (first + second).times_double(0.5)
    }

    /// Whether the closed form of the derivatives cancels (theory §12): it divides by Q1 and C/B − 1, and for the elements of a tensor by C/A − C/B too.
    pub(crate) fn has_small_divisor(&self, tensor: bool) -> bool {
        let Invariants { cosine_squares: [least, _], excesses: [_, second], difference, .. } = self.invariants;
        let divisors = [least, second, if tensor { difference } else { DoubleDouble::ONE }];
        divisors.into_iter().any(|divisor| divisor.high.abs() < SMALLEST_DIVISOR)
    }

    /// M/B in scaled units of rate.
    pub(crate) fn middle_rate(&self) -> DoubleDouble {
        self.invariants.momentum.over(self.moments[1])
    }

    /// ζ = (X + ix)/√M of theory §8: (g2 − i g1)/cos(J/2), real and imaginary part.
    pub(crate) fn zeta(&self) -> [f64; 2] {
        let [g1, g2, g3] = self.invariants.direction;
        let half_cosine = (0.5 * (1.0 + g3)).sqrt();
        [g2 / half_cosine, -g1 / half_cosine]
    }

    /// M in the user's units.
    pub(crate) fn user_momentum(&self) -> f64 {
        scaled(self.invariants.momentum.to_f64(), self.scales.0 + self.scales.1)
    }

    /// M/A, M/B, M/C in the user's units. The rates are these numbers times g.
    pub(crate) fn user_rates(&self) -> Vector3<f64> {
        Vector3::from(self.invariants.rates.map(|rate| scaled(rate, self.scales.1)))
    }

    /// The frame of theory §8 at a state: axis 3 along the angular momentum, y = 0.
    pub(crate) fn invariable_frame(&self, attitude: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
        let zeta = self.zeta();
        let half_z = 0.25 * (zeta[0] * zeta[0] + zeta[1] * zeta[1]);
        let relative = Quaternion::new((1.0 - half_z).max(0.0).sqrt(), 0.5 * zeta[0], 0.5 * zeta[1], 0.0);
        attitude * (UnitQuaternion::new_normalize(relative) * self.frame.quaternion).inverse()
    }

    /// The angular momentum at an attitude, inertial components, in the user's units.
    pub(crate) fn angular_momentum(&self, attitude: UnitQuaternion<f64>) -> Vector3<f64> {
        attitude * Vector3::from(self.frame.user(self.invariants.direction)) * self.user_momentum()
    }

    /// (cos ℓ, sin ℓ) of the state, moved to the first quadrant, and the two signs that were removed (theory §1: G2 ~ cos ℓ, −G1 ~ sin ℓ).
    pub(crate) fn quadrant(&self) -> ([f64; 2], [f64; 2]) {
        let Invariants { direction: [g1, g2, _], quadrant, .. } = self.invariants;
        (quadrant, [1.0_f64.copysign(g2), 1.0_f64.copysign(-g1)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_comparison_of_two_terms_decides_as_the_sign_of_the_least_squared_cosine_does() {
        // Rates that differ from the separatrix by a part between 1e-1 and 1e-32, on both sides of it.
        let (mut seed, mut long) = (7_u64, 0);
        let mut next = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        for k in 0..2000 {
            let (a, b) = (0.5 + 0.2 * next(), 0.75 + 0.2 * next());
            let x = 0.1 + next();
            // With C = 1 the motion on the separatrix has ω3² = ω1² A (B − A)/(1 − B).
            let z = x * (a * (b - a) / (1.0 - b)).sqrt();
            let part = if k % 2 == 0 { 1.0 } else { -1.0 } * 10.0_f64.powi(-(k % 33));
            let [moments, rates] =
                [[a, b, 1.0], [x, next() - 0.5, z * (1.0 + part)]].map(|row| row.map(DoubleDouble::from));
            let given = SortedState { moments, rotation: Rotation::Rates(rates), long_axis: false };
            let negative = Invariants::of(&given).cosine_squares[0].high < 0.0;
            assert_eq!(beyond(moments, rates), negative, "{moments:?} {rates:?}");
            long += usize::from(negative);
        }
        assert!((500..1500).contains(&long), "{long} of 2000");
    }
}
