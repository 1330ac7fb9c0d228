//! Attitude of a body that turns about an axis fixed in it: the half angle's sine and cosine, and constant rates.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::numerics::phase::Phase;
use crate::simd::circles::{Circles, Evaluate};
use crate::simd::instruction_set::Level;
use crate::simd::lanes::Lanes;

/// What such a motion is evaluated from.
#[derive(Clone, Debug)]
pub(crate) struct Steady {
    half_angle: Phase,
    /// The attitude is the first times the cosine and the second times the sine.
    attitudes: [[f64; 4]; 2],
    rates: [f64; 3],
}

impl Steady {
    /// From the unit axis, the phase of half the angle, and attitude and rates at the epoch.
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
    fn phases(&self) -> [&Phase; 2] {
        [&self.half_angle; 2]
    }

    #[inline(always)]
    fn evaluate<S: Level, const ATTITUDE: bool, const RATES: bool>(
        &self,
        simd: S,
        circles: impl Circles<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]) {
        let mut attitude = [Lanes::splat(simd, 0.0); 4];
        if ATTITUDE {
            let (sine, cosine) = circles.half_longitude();
            for (row, place) in attitude.iter_mut().enumerate() {
                let [start, quarter] = Lanes::splats(simd, [self.attitudes[0][row], self.attitudes[1][row]]);
                *place = quarter.mul_add(sine, start * cosine);
            }
        }
        (attitude, Lanes::splats(simd, self.rates))
    }
}
