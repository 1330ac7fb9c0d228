//! Attitude and rates of a wobbling body, at several times at once.
//!
//! The attitude is inertial · (a, b) · frame. The two constant rotations form one real 4×4 matrix that acts on (Re b, Im b, Im a, Re a). The rates need only
//! ℓ′, because y cancels in b ā: g = (−2 Im b ā, 2 Re b ā, |a|² − |b|²)/(|a|² + |b|²). This takes no square root and no second sine (theory §8).

use nalgebra::Quaternion;

use super::harmonics::CayleyKleinSeries;
use super::polhode::UserFrame;
use super::sums::Sums;
use crate::numerics::phase::Phase;
use crate::simd::circles::{Evaluate, Instants};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// A wobbling motion: its phases, its series and its frames.
#[derive(Clone, Debug)]
pub(crate) struct Wobble {
    pub(crate) anomaly: Phase,
    pub(crate) series: CayleyKleinSeries,
    pub(crate) half_longitude: Phase,
    pub(crate) place: UserFrame,
}

/// The constants from which a wobbling motion is evaluated.
#[derive(Clone, Debug)]
pub(crate) struct WobbleEvaluator {
    pub(crate) anomaly: Phase,
    pub(crate) half_longitude: Phase,
    pub(crate) sums: Sums,
    /// Rows x, y, z, w of the attitude, columns Re b, Im b, Im a, Re a.
    pub(crate) map: [[f64; 4]; 4],
    /// For each body axis, the index of its sorted axis and the factor of g: ±M over the moment.
    pub(crate) rates: [(usize, f64); 3],
}

impl WobbleEvaluator {
    pub(crate) fn new(wobble: &Wobble) -> Self {
        let mut map = [[0.0; 4]; 4];
        let [x, y, z, w] = wobble.place.inertial.coords.into();
        // The products of the first rotation and the units i, j, k and 1.
        let units = [[w, z, -y, -x], [-z, w, x, -y], [y, -x, w, -z], [x, y, z, w]];
        for (column, unit) in units.into_iter().enumerate() {
            let turned = Quaternion::from(unit) * wobble.place.frame.quaternion.into_inner();
            for (row, entry) in map.iter_mut().zip(&turned.coords) {
                row[column] = *entry;
            }
        }
        let mut rates = [(0, 0.0); 3];
        for sorted in 0..3 {
            rates[wobble.place.frame.axes[sorted]] =
                (sorted, wobble.place.frame.signs[sorted] * wobble.place.rates[sorted]);
        }
        Self {
            anomaly: wobble.anomaly,
            half_longitude: wobble.half_longitude,
            sums: Sums::new(&wobble.series),
            map,
            rates,
        }
    }

    /// The phases ℓ′ and y′/2.
    pub(crate) fn phases(&self) -> [&Phase; 2] {
        [&self.anomaly, &self.half_longitude]
    }

    /// The same motion by a series with other harmonics, normalized at the ℓ′ of the epoch to the same attitude.
    pub(crate) fn with_series(&self, series: &CayleyKleinSeries, anomaly: f64) -> Self {
        let Self { anomaly: phase, half_longitude, map, rates, .. } = *self;
        let half_longitude = half_longitude.starting_at(-series.pair(anomaly)[0].arg());
        Self { anomaly: phase, half_longitude, sums: Sums::new(series), map, rates }
    }
}

impl Evaluate for WobbleEvaluator {
    const BY_CIRCLES: bool = true;

    #[inline(always)]
    fn evaluate<S: InstructionSet, const ATTITUDE: bool, const RATES: bool>(
        &self,
        simd: S,
        at: impl Instants<S>,
    ) -> ([Lanes<S>; 4], [Lanes<S>; 3]) {
        let (sine, cosine) = at.circle(0, &self.anomaly);
        let [ar, ai, br, bi] = self.sums.pair(simd, sine, cosine);
        let upper = ar.mul_add(ar, ai * ai);
        let lower = br.mul_add(br, bi * bi);
        let scale = (upper + lower).reciprocal();
        let zero = Lanes::splat(simd, 0.0);
        let mut rates = [zero; 3];
        if RATES {
            let twice = scale + scale;
            let direction =
                [twice * bi.negate_mul_add(ar, br * ai), twice * br.mul_add(ar, bi * ai), scale * (upper - lower)];
            for (rate, (axis, factor)) in rates.iter_mut().zip(self.rates) {
                *rate = direction[axis] * Lanes::splat(simd, factor);
            }
        }
        let mut attitude = [zero; 4];
        if ATTITUDE {
            let (sine, cosine) = at.circle(1, &self.half_longitude);
            let root = scale.root();
            let (sine, cosine) = (sine * root, cosine * root);
            let relative = [
                bi.negate_mul_add(sine, br * cosine),
                br.mul_add(sine, bi * cosine),
                ar.mul_add(sine, ai * cosine),
                ai.negate_mul_add(sine, ar * cosine),
            ];
            for (place, row) in attitude.iter_mut().zip(self.map) {
                let [x, y, z, w] = Lanes::splats(simd, row);
                *place = w.mul_add(relative[3], z.mul_add(relative[2], y.mul_add(relative[1], x * relative[0])));
            }
        }
        (attitude, rates)
    }
}
