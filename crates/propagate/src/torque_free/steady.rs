//! Rotation about an axis that is fixed in the body (theory §5): any axis of a sphere, a principal axis, or any axis in the plane of two equal moments.
//!
//! The angular velocity is constant. The attitude turns about it at the rate M over the moment about the axis. The evaluation needs the sine and cosine of the
//! half angle.

use andoyer_double::DoubleDouble;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::error_budget::{ROUNDING, departure, phase_rounding};
use super::mode::Mode;
use super::polhode::{Polhode, SMALLEST_TILT};
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::numerics::phase::Phase;
use crate::numerics::scaling::{half, user_rate};
use crate::simd::circles::{Evaluate, Instants};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// A rotation about an axis that is fixed in the body.
pub(crate) struct SteadyRotation {
    /// Unit axis in the user's body components; the zero vector at rest.
    pub(crate) axis: Vector3<f64>,
    /// Angular rate, in scaled units.
    pub(crate) rate: DoubleDouble,
    /// dℓ′/dt in the limit of small wobbles; 0 for an axis perpendicular to axis 3.
    pub(crate) anomaly_rate: DoubleDouble,
    /// σ/σ_sep.
    pub(crate) separatrix_ratio: f64,
    /// Bound of the attitude error \[rad\].
    pub(crate) error_bound: f64,
    /// The reason why there is no wobble.
    pub(crate) reason: &'static str,
}

impl SteadyRotation {
    /// A body at rest.
    pub(crate) fn none() -> Self {
        Self {
            axis: Vector3::zeros(),
            rate: DoubleDouble::ZERO,
            anomaly_rate: DoubleDouble::ZERO,
            separatrix_ratio: 0.0,
            error_bound: ROUNDING,
            reason: "the body is at rest",
        }
    }

    /// The rotation of a spherical body, or about a principal axis.
    pub(crate) fn new(scene: &Scene, polhode: &Polhode, mode: Mode) -> Self {
        let [_, g2, g3] = polhode.invariants.direction;
        let [_, second] = polhode.invariants.excesses;
        // If A = B, every axis perpendicular to axis 3 is a principal axis, and the rate is M over its moment. If the three moments differ, only the middle
        // axis is perpendicular to axis 3 here.
        let across = mode == Mode::PrincipalAxis && second != DoubleDouble::ZERO && g3.abs() < SMALLEST_TILT;
        let middle = across && polhode.invariants.difference != DoubleDouble::ZERO;
        let reason = match mode {
            Mode::Spherical => "every axis of a sphere is a principal axis",
            _ if middle => "the rotation is about the axis of middle inertia, its unstable equilibrium",
            _ if across => "A = B and the rotation is about one of their axes",
            _ if g2.abs() < SMALLEST_TILT && polhode.long_axis => "the rotation is about the axis of least inertia",
            _ if g2.abs() < SMALLEST_TILT => "the rotation is about the axis of greatest inertia (J = 0)",
            _ => "B = C and the rotation is about one of their axes",
        };
        let rate = if across { polhode.middle_rate() } else { polhode.invariants.mean_rate };
        let error_bound = ROUNDING + phase_rounding(scene, rate, polhode.scales.1);
        let departure = if middle { departure(scene, polhode) } else { 0.0 };
        Self {
            axis: Vector3::from(polhode.frame.user(polhode.invariants.direction)),
            rate,
            anomaly_rate: if across { DoubleDouble::ZERO } else { rate * polhode.invariants.gamma },
            separatrix_ratio: if across { 1.0 } else { 0.0 },
            error_bound: (error_bound + departure).min(std::f64::consts::PI),
            reason,
        }
    }

    /// The evaluator for a state in the user's units; `exponent` is that of the polhode's rates.
    pub(crate) fn evaluator(&self, state: &State, exponent: i32) -> Steady {
        let half_angle = half(user_rate(self.rate, exponent), 0.0);
        Steady::new(self.axis, half_angle, state.attitude, state.angular_velocity)
    }
}

/// The constants from which a steady rotation is evaluated.
#[derive(Clone, Debug)]
pub(crate) struct Steady {
    pub(crate) half_angle: Phase,
    /// The attitude is the first quaternion times the cosine plus the second times the sine.
    pub(crate) attitudes: [[f64; 4]; 2],
    pub(crate) rates: [f64; 3],
}

impl Steady {
    /// Half the angle, in the place of both phases of a wobble.
    pub(crate) fn phases(&self) -> [&Phase; 2] {
        [&self.half_angle; 2]
    }

    /// The evaluator from the unit axis, the phase of half the angle, and attitude and rates at the epoch.
    pub(crate) fn new(
        axis: Vector3<f64>,
        half_angle: Phase,
        attitude: UnitQuaternion<f64>,
        rates: Vector3<f64>,
    ) -> Self {
        let attitude = attitude.into_inner();
        let quarter = attitude * Quaternion::from_parts(0.0, axis);
        Self { half_angle, attitudes: [attitude.coords.into(), quarter.coords.into()], rates: rates.into() }
    }
}

impl Evaluate for Steady {
    const BY_CIRCLES: bool = true;

    #[inline(always)]
    fn evaluate<S: InstructionSet, const ATTITUDE: bool, const RATES: bool>(
        &self,
        simd: S,
        at: impl Instants<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]) {
        let mut attitude = [Lanes::splat(simd, 0.0); 4];
        if ATTITUDE {
            let (sine, cosine) = at.circle(1, &self.half_angle);
            for (row, place) in attitude.iter_mut().enumerate() {
                let [start, quarter] = Lanes::splats(simd, [self.attitudes[0][row], self.attitudes[1][row]]);
                *place = quarter.mul_add(sine, start * cosine);
            }
        }
        (attitude, Lanes::splats(simd, self.rates))
    }
}
