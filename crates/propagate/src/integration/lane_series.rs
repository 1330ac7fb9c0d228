//! The series of the motions in lanes ([`super::lanes`]).
//!
//! Attitudes are relative to the axes of the orbit, so that r̃ has two components. With ξ = x + iy and α = w + iz of the quaternion the first two rows of its matrix are
//!
//! ```text
//! R11 + iR21 = α² + ξ²,   R12 + iR22 = i(α² − ξ²),   R13 + iR23 = −2iξα,   s = x̃ (R11, R12, R13) + ỹ (R21, R22, R23)
//! ```
//!
//! These are 34 products of two coefficients, and five for the ellipse, where the rows of four lanes of [`super::expansion`] take fourteen vectors.

use std::f64::consts::TAU;

use super::lanes::{LaneMotions, LaneVectors, minus, plus};
use super::series::RECIPROCALS;
use crate::orbit::kepler::corrected;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::{Lanes, WIDEST};
use crate::simd::sincos::sin_cos_of_turns;

impl<S: InstructionSet> LaneMotions<'_, S> {
    /// Coefficients 0 to `order`.
    #[inline(always)]
    pub(super) fn expand(&mut self, order: usize) {
        self.expand_path(order);
        let simd = self.simd;
        for k in 0..order {
            let mut sums = LaneSums::new(simd);
            let mut j = 1;
            while 2 * j < k {
                sums.add(simd, &self.motion[j], &self.motion[k - j]);
                sums.add(simd, &self.motion[k - j], &self.motion[j]);
                j += 1;
            }
            if 2 * j == k {
                sums.add(simd, &self.motion[j], &self.motion[j]);
            }
            // The newest coefficient comes last, so that the sums need not wait for it.
            sums.add(simd, &self.motion[0], &self.motion[k]);
            if k > 0 {
                sums.add(simd, &self.motion[k], &self.motion[0]);
            } else {
                self.gyration = sums.gyration;
            }
            self.matrix[k] = sums.matrix(simd);
            let torque = self.torque(k);
            let (share, half) = (simd.splat_f64s(RECIPROCALS[k + 1]), simd.splat_f64s(0.5 * RECIPROCALS[k + 1]));
            let [x, y, z, w] = sums.turned;
            let [a, b, c] = torque;
            let [g1, g2, g3] = sums.gyration;
            let [f1, f2, f3] = self.factors;
            self.motion[k + 1] = [
                simd.mul_f64s(half, x),
                simd.mul_f64s(half, y),
                simd.mul_f64s(half, z),
                simd.mul_f64s(half, w),
                simd.mul_f64s(simd.mul_f64s(f1, share), simd.sub_f64s(a, g1)),
                simd.mul_f64s(simd.mul_f64s(f2, share), simd.sub_f64s(b, g2)),
                simd.mul_f64s(simd.mul_f64s(f3, share), simd.sub_f64s(c, g3)),
            ];
        }
    }

    /// The places on the ellipses at the start of the step: x, sin E, cos E, e/ρ and √(1−e²), where ρ is the distance.
    #[inline(always)]
    fn start_path(&mut self) -> LaneVectors<S, 5> {
        let simd = self.simd;
        let [mut mean, mut anomaly, mut e, mut rest, mut root, mut motion, mut strength] = [[0.0; WIDEST]; 7];
        rest.fill(1.0);
        for (lane, place) in self.places.iter_mut().enumerate().take(S::F64_LANES) {
            let Some(place) = place else { continue };
            let conic = place.conic;
            mean[lane] = conic.mean_at(place.time);
            anomaly[lane] = place.anomaly - TAU * ((place.anomaly - mean[lane]) / TAU).round();
            (e[lane], rest[lane], root[lane]) = (conic.eccentricity, 1.0 - conic.eccentricity, conic.root);
            (motion[lane], strength[lane]) = (conic.mean_motion, conic.strength);
            place.radius = conic.radius(mean[lane]);
        }
        let of = |values: &[f64]| Lanes::load(simd, values).alike();
        let (shape, mean) = ([of(&e), of(&rest)], of(&mean));
        let anomaly = corrected(of(&anomaly), mean, shape);
        let (half_sine, half_cosine) = sin_cos_of_turns(anomaly * mean.all(0.5 / TAU));
        let versed = (half_sine + half_sine) * half_sine;
        let sine = (half_sine + half_sine) * half_cosine;
        let (x, cosine) = (shape[1] - versed, mean.all(1.0) - versed);
        let distance = versed.mul_add(shape[0], shape[1]);
        let inverse = distance.reciprocal();
        let factor = of(&strength) * inverse * inverse / distance.root();
        let rate = of(&motion) * inverse;
        let (by_shape, root) = (shape[0] * inverse, of(&root));
        for (lane, place) in self.places.iter_mut().enumerate().take(S::F64_LANES) {
            if let Some(place) = place {
                place.anomaly = anomaly.values()[lane];
            }
        }
        self.ellipse[0] = [x.strand(), sine.strand(), simd.splat_f64s(0.0), rate.strand(), factor.strand()];
        [x.strand(), sine.strand(), cosine.strand(), by_shape.strand(), root.strand()]
    }

    /// The series of r̃, with the recursions of [`super::conic`].
    #[inline(always)]
    fn expand_path(&mut self, order: usize) {
        let simd = self.simd;
        let zero = simd.splat_f64s(0.0);
        let [x, sine, cosine, by_shape, root] = self.start_path();
        for k in 0..order {
            let (mut by_rate, mut by_factor) = ([zero; 2], [zero; 3]);
            for j in 1..=k {
                let ([x, sine, grown, ..], [.., rate, factor]) = (self.ellipse[j], self.ellipse[k - j]);
                by_rate[0] = plus(simd, rate, x, by_rate[0]);
                by_rate[1] = plus(simd, rate, sine, by_rate[1]);
                by_factor[0] = plus(simd, factor, x, by_factor[0]);
                by_factor[1] = plus(simd, factor, sine, by_factor[1]);
                by_factor[2] = plus(simd, factor, grown, by_factor[2]);
            }
            if k > 0 {
                // The power of the distance is −5/2.
                let grown = plus(simd, simd.splat_f64s(1.5 * RECIPROCALS[k]), by_factor[2], by_factor[0]);
                self.ellipse[k][3] = simd.mul_f64s(by_shape, by_rate[0]);
                self.ellipse[k][4] = simd.mul_f64s(by_shape, grown);
            }
            let [.., rate, factor] = self.ellipse[k];
            self.path[k] =
                [plus(simd, factor, x, by_factor[0]), simd.mul_f64s(root, plus(simd, factor, sine, by_factor[1]))];
            let share = RECIPROCALS[k + 1];
            let next = simd.mul_f64s(simd.splat_f64s(-share), plus(simd, sine, rate, by_rate[1]));
            let next_sine = simd.mul_f64s(simd.splat_f64s(share), plus(simd, cosine, rate, by_rate[0]));
            let grown = simd.mul_f64s(simd.splat_f64s((k + 1) as f64), next);
            self.ellipse[k + 1] = [next, next_sine, grown, zero, zero];
        }
    }

    /// Coefficient k of s2 s3 and in turn, times the strength.
    #[inline(always)]
    fn torque(&mut self, k: usize) -> LaneVectors<S, 3> {
        let simd = self.simd;
        let zero = simd.splat_f64s(0.0);
        let (mut along, mut across, mut products) = ([zero; 3], [zero; 3], [zero; 3]);
        for j in 0..=k {
            let ([first, second], rows) = (self.path[k - j], &self.matrix[j]);
            for axis in 0..3 {
                along[axis] = plus(simd, first, rows[2 * axis], along[axis]);
                across[axis] = plus(simd, second, rows[2 * axis + 1], across[axis]);
            }
        }
        for axis in 0..3 {
            self.direction[k][axis] = simd.add_f64s(along[axis], across[axis]);
        }
        for j in 0..=k {
            let (one, other) = (&self.direction[j], &self.direction[k - j]);
            for axis in 0..3 {
                products[axis] = plus(simd, one[(axis + 1) % 3], other[(axis + 2) % 3], products[axis]);
            }
        }
        for product in &mut products {
            *product = simd.mul_f64s(*product, self.strength);
        }
        products
    }
}

/// Sums of products of coefficients.
struct LaneSums<S: InstructionSet> {
    /// q ω.
    turned: LaneVectors<S, 4>,
    /// ω2 ω3 and in turn.
    gyration: LaneVectors<S, 3>,
    /// The real part and half of the imaginary part of α² and of ξ², and ξα.
    alpha: LaneVectors<S, 2>,
    xi: LaneVectors<S, 2>,
    mixed: LaneVectors<S, 2>,
}

impl<S: InstructionSet> LaneSums<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let zero = simd.splat_f64s(0.0);
        Self { turned: [zero; 4], gyration: [zero; 3], alpha: [zero; 2], xi: [zero; 2], mixed: [zero; 2] }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, one: &LaneVectors<S, 7>, other: &LaneVectors<S, 7>) {
        let ([x, y, z, w, p1, q1, r1], [x2, y2, z2, w2, p, q, r]) = (*one, *other);
        let [t0, t1, t2, t3] = self.turned;
        self.turned = [
            minus(simd, z, q, plus(simd, y, r, plus(simd, w, p, t0))),
            minus(simd, x, r, plus(simd, z, p, plus(simd, w, q, t1))),
            minus(simd, y, p, plus(simd, x, q, plus(simd, w, r, t2))),
            minus(simd, z, r, minus(simd, y, q, minus(simd, x, p, t3))),
        ];
        let [g0, g1, g2] = self.gyration;
        self.gyration = [plus(simd, q1, r, g0), plus(simd, r1, p, g1), plus(simd, p1, q, g2)];
        self.alpha = [minus(simd, z, z2, plus(simd, w, w2, self.alpha[0])), plus(simd, w, z2, self.alpha[1])];
        self.xi = [minus(simd, y, y2, plus(simd, x, x2, self.xi[0])), plus(simd, x, y2, self.xi[1])];
        self.mixed =
            [minus(simd, y, z2, plus(simd, x, w2, self.mixed[0])), plus(simd, y, w2, plus(simd, x, z2, self.mixed[1]))];
    }

    /// R11, R21, R12, R22, R13, R23.
    #[inline(always)]
    fn matrix(&self, simd: S) -> LaneVectors<S, 6> {
        let twice = |value: S::f64s| simd.add_f64s(value, value);
        let [alpha, xi, mixed] = [self.alpha, self.xi, self.mixed];
        [
            simd.add_f64s(alpha[0], xi[0]),
            twice(simd.add_f64s(alpha[1], xi[1])),
            twice(simd.sub_f64s(xi[1], alpha[1])),
            simd.sub_f64s(alpha[0], xi[0]),
            twice(mixed[1]),
            simd.neg_f64s(twice(mixed[0])),
        ]
    }
}
