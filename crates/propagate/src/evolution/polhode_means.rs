//! The polhode by the excess of energy ξ, and means of monomials over it (weak torques (2), (5) to (7)).
//!
//! Sorted axes: A ≤ B ≤ C about axes 1, 2, 3. In the short-axis mode ξ = 2CE/M² − 1, in the long-axis mode ξ = 1 − 2AE/M²; both are Σ α_i g_i², a sum of
//! positive terms. ξ = 0 is steady rotation and ξ = α₂ the separatrix. Every mean is a product of positive numbers, so equal moments and ξ = 0 are no special cases.

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

use nalgebra::Vector3;

use super::elliptic::Scale;

/// Points of the midpoint rule (6) in a quarter of the polhode.
const POINTS: usize = 12;
/// Above this k² the recurrence (7) is used: below it the recurrence loses digits, above it the midpoint rule does.
const RECURRENCE: f64 = 0.5;

/// Step of differences in ξ, relative to it.
const SLOPE_STEP: f64 = 1e-5;

/// The axis of the mode and the sense of the angular momentum along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ModeFamily {
    /// True for the short axis.
    pub(super) short: bool,
    /// True if the angular momentum is along the positive axis.
    pub(super) positive: bool,
}

impl ModeFamily {
    /// Index of the axis of the mode.
    pub(super) fn axis(self) -> usize {
        if self.short { 2 } else { 0 }
    }

    /// Index of the other axis that is not the middle one: the axis of cn.
    pub(super) fn across(self) -> usize {
        2 - self.axis()
    }

    pub(crate) fn sign(self) -> f64 {
        if self.positive { 1.0 } else { -1.0 }
    }

    /// α of (2).
    pub(super) fn alpha(self, moments: &Vector3<f64>) -> Vector3<f64> {
        if self.short {
            moments.map(|moment| (moments.z - moment) / moment)
        } else {
            moments.map(|moment| (moment - moments.x) / moment)
        }
    }

    /// The family of a direction in body axes, with ξ; `None` on the separatrix to rounding.
    pub(super) fn of(moments: &Vector3<f64>, g: &Vector3<f64>) -> Option<(Self, f64)> {
        let families = [true, false].map(|short| Self { short, positive: g[if short { 2 } else { 0 }] >= 0.0 });
        let found = families.map(|family| {
            let alpha = family.alpha(moments);
            (family, alpha.dot(&g.component_mul(g)), alpha.y)
        });
        let inside = found.into_iter().find(|(_, excess, separatrix)| excess < separatrix);
        inside.map(|(family, excess, _)| (family, excess))
    }
}

/// A polhode.
#[derive(Clone, Debug)]
pub(super) struct ExcessPolhode {
    pub(super) moments: Vector3<f64>,
    pub(super) family: ModeFamily,
    pub(super) excess: f64,
    pub(super) alpha: Vector3<f64>,
    /// Amplitudes of the components across, on axis 2 and on the axis of the mode, each positive.
    amplitudes: [f64; 3],
    parameter: f64,
    complement: f64,
    scale: Scale,
}

impl ExcessPolhode {
    /// For 0 ≤ ξ < α₂.
    pub(super) fn new(moments: &Vector3<f64>, family: ModeFamily, excess: f64) -> Self {
        let alpha = family.alpha(moments);
        let (a, b) = (alpha[family.across()], alpha.y);
        let (parameter, complement, amplitudes) = if excess > 0.0 && b > 0.0 {
            let below = b * (a - excess);
            let across = [excess / a, excess / b, 1.0 - excess / a].map(f64::sqrt);
            (excess * (a - b) / below, a * (b - excess) / below, across)
        } else {
            (0.0, 1.0, [0.0, 0.0, 1.0])
        };
        let scale = Scale::new(parameter, complement);
        let excess = if amplitudes[0] > 0.0 { excess } else { 0.0 };
        Self { moments: *moments, family, excess, alpha, amplitudes, parameter, complement, scale }
    }

    /// dℓ′/dt over M (5).
    pub(super) fn wobble_rate(&self) -> f64 {
        let (a, b, own) = (self.alpha[self.family.across()], self.alpha.y, self.moments[self.family.axis()]);
        // At ξ = 0 it is √(a b)/I_p; |1/B − 1/I_p| = b/I_p.
        if b > 0.0 { b / own * self.amplitudes[2] * (a / b).sqrt() * self.scale.mean } else { 0.0 }
    }

    /// dℓ′/dt and dy′/dt for a size of the angular momentum, and their derivatives with respect to ξ.
    pub(super) fn rates_and_slopes(&self, size: f64) -> ([f64; 2], [f64; 2]) {
        let rates = |polhode: &Self| [polhode.wobble_rate(), polhode.mean_turn_rate()].map(|rate| size * rate);
        let here = rates(self);
        if self.excess == 0.0 {
            return (here, [0.0; 2]);
        }
        let step = SLOPE_STEP * self.excess;
        let there = rates(&Self::new(&self.moments, self.family, self.excess - step));
        (here, [0, 1].map(|angle| (here[angle] - there[angle]) / step))
    }

    /// 2E/M².
    pub(super) fn energy(&self) -> f64 {
        let own = self.moments[self.family.axis()];
        if self.family.short { (1.0 + self.excess) / own } else { (1.0 - self.excess) / own }
    }

    /// g at a phase ℓ′ ≠ 0 with this sine and cosine.
    pub(super) fn direction(&self, phase: (f64, f64)) -> Vector3<f64> {
        let ([sn, cn, dn], sign) = (self.scale.functions(phase), self.family.sign());
        let mut g = Vector3::zeros();
        g[self.family.across()] = self.amplitudes[0] * cn;
        g.y = sign * self.amplitudes[1] * sn;
        g[self.family.axis()] = sign * self.amplitudes[2] * dn;
        g
    }

    /// ℓ′ of a direction near the polhode.
    pub(super) fn phase_of(&self, g: &Vector3<f64>) -> f64 {
        let [across, middle, _] = self.amplitudes;
        if across == 0.0 {
            return 0.0;
        }
        let angle = (self.family.sign() * g.y / middle).atan2(g[self.family.across()] / across);
        self.scale.mean_phase(angle)
    }

    /// Rate of the angle about the angular momentum over M, at a direction on the polhode (5).
    pub(super) fn turn_rate(&self, g: &Vector3<f64>) -> f64 {
        let axis = self.family.axis();
        let along = g[axis].abs();
        (self.energy() + along / self.moments[axis]) / (1.0 + along)
    }

    /// Mean of the same, dy′/dt over M.
    pub(super) fn mean_turn_rate(&self) -> f64 {
        // Near the separatrix the polhode stays near axis 2: the rule needs points in proportion to K.
        let points = (POINTS as f64 * (1.0 + 4.0 / self.scale.mean)).ceil();
        let phase = |j: usize| (FRAC_PI_2 / points * (j as f64 + 0.5)).sin_cos();
        let rates = (0..points as usize).map(|j| self.turn_rate(&self.direction(phase(j))));
        rates.sum::<f64>() / points
    }
}

/// Exponents of a monomial in g: half of those across and on axis 2, and that on the axis of the mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct EvenMonomial {
    pub(super) across: usize,
    pub(super) middle: usize,
    pub(super) own: usize,
}

/// Exponents of the rows of a torque of degree 8 are below these: 2·across + 2·middle + own ≤ 9.
const HALF: usize = 6;
const OWN: usize = 12;

impl ExcessPolhode {
    /// Means of monomials over the polhode.
    pub(super) fn means(&self, monomials: &[EvenMonomial], out: &mut Vec<f64>) {
        out.clear();
        if self.parameter <= RECURRENCE {
            self.by_points(monomials, out)
        } else {
            self.by_recurrence(monomials, out)
        }
        let sign = self.family.sign();
        let [across, middle, own] = self.amplitudes;
        let powers = |x: f64| {
            let mut table = [1.0; OWN];
            (1..OWN).for_each(|k| table[k] = table[k - 1] * x);
            table
        };
        let [across, middle, own] = [across * across, middle * middle, sign * own].map(powers);
        for (mean, monomial) in out.iter_mut().zip(monomials) {
            *mean *= across[monomial.across] * middle[monomial.middle] * own[monomial.own];
        }
    }

    /// ⟨cn^2i sn^2j dn^q⟩ by (6).
    fn by_points(&self, monomials: &[EvenMonomial], out: &mut Vec<f64>) {
        let mut tables = [[[1.0; POINTS]; OWN]; 3];
        for (point, phase) in PHASES.iter().enumerate() {
            let [sn, cn, dn] = self.scale.functions(*phase);
            for (table, factor) in tables.iter_mut().zip([cn * cn, sn * sn, dn]) {
                (1..OWN).for_each(|k| table[k][point] = table[k - 1][point] * factor);
            }
        }
        let [cn, sn, dn] = &tables;
        out.extend(monomials.iter().map(|monomial| {
            let [c, s, d] = [&cn[monomial.across], &sn[monomial.middle], &dn[monomial.own]];
            (0..POINTS).map(|point| c[point] * s[point] * d[point]).sum::<f64>() / POINTS as f64
        }));
    }

    /// The same by (7), for k² > ½.
    fn by_recurrence(&self, monomials: &[EvenMonomial], out: &mut Vec<f64>) {
        let (m, m1) = (self.parameter, self.complement);
        // even[j][i] = ⟨sn^2j cn^2i⟩, odd[j][i] = ⟨dn sn^2j cn^2i⟩
        let (mut even, mut odd) = ([[0.0; OWN]; HALF], [[0.0; OWN]; HALF]);
        (even[0][0], even[0][1], odd[0][0]) = (1.0, (self.scale.ratio - m1) / m, self.scale.mean);
        for i in 1..OWN {
            let n = i as f64;
            odd[0][i] = odd[0][i - 1] * (2.0 * n - 1.0) / (2.0 * n);
            if i + 1 < OWN {
                let sum = 2.0 * n * (2.0 * m - 1.0) * even[0][i] + (2.0 * n - 1.0) * m1 * even[0][i - 1];
                even[0][i + 1] = sum / ((2.0 * n + 1.0) * m);
            }
        }
        for j in 1..HALF {
            for i in 0..OWN - j - 1 {
                even[j][i] = even[j - 1][i] - even[j - 1][i + 1];
                odd[j][i] = odd[j - 1][i] - odd[j - 1][i + 1];
            }
        }
        out.extend(monomials.iter().map(|monomial| {
            let (half, table) = (monomial.own / 2, if monomial.own % 2 == 0 { &even } else { &odd });
            // dn^2q = Σ binomial(q, r) k′^2(q−r) k^2r cn^2r
            let (mut binomial, mut sum) = (1.0, 0.0);
            for r in 0..=half {
                let factor = binomial * m1.powi((half - r) as i32) * m.powi(r as i32);
                sum += factor * table[monomial.middle][monomial.across + r];
                binomial *= (half - r) as f64 / (r + 1) as f64;
            }
            sum
        }));
    }
}

/// Sines and cosines of the midpoints.
static PHASES: LazyLock<[(f64, f64); POINTS]> =
    LazyLock::new(|| std::array::from_fn(|j| (FRAC_PI_2 / POINTS as f64 * (j as f64 + 0.5)).sin_cos()));
