//! A term of the generating function that may be kept or dropped.

use super::divisors::Divisors;
use super::generator::{ExactTerm, Harmonic};
use super::inertia::Inertia;
use super::orbit_series::OrbitSeries;

/// Smallest |Ω| over the largest rate of twice the true anomaly for which the sum for G is used. Below this ratio the sum does not converge. Above it the
/// truncation error of the sum is part of the error bound.
pub(super) const SLOW_RATIO: f64 = 1.5;

/// The term (h, m), which may be kept or dropped.
pub(super) struct Candidate {
    pub(super) harmonic: i32,
    pub(super) multiple: i32,
    /// The real f_h and df_h/dσ; for m = 1 those of i t1.
    pub(super) value: f64,
    pub(super) slope: f64,
    pub(super) frequency: f64,
    /// Rate of change of the attitude by the term [rad per unit of time].
    pub(super) rate: f64,
    /// Rate of change of M or L by the term, over M and over m or h.
    pub(super) action: f64,
    /// The part of the change that comes from the slope of Ω, times Ω.
    pub(super) shift: f64,
}

impl Candidate {
    /// Largest change of the attitude by the term \[rad\].
    pub(super) fn size(&self) -> f64 {
        self.size_at(self.frequency.abs())
    }

    /// The same with another divisor.
    pub(super) fn size_at(&self, divisor: f64) -> f64 {
        (self.rate + self.shift / divisor) / divisor
    }

    /// With another divisor, the change of M or L over M, and that of y′ by the slope of Ω with respect to M, which is not in the size.
    pub(super) fn swing_at(&self, divisor: f64) -> [f64; 2] {
        let swing = self.action / divisor;
        [swing, swing * self.frequency.abs() / divisor]
    }

    /// The factors of G and of −Ω ∂G/∂Ω in W, M ∂W/∂M, ∂W/∂p̄ + ∂W/∂p and ∂W/∂p̄ − ∂W/∂p.
    fn factors(&self, inertia: &Inertia) -> [[f64; 4]; 2] {
        let Self { harmonic, multiple, value, slope, frequency, .. } = *self;
        let [anomaly, longitude] = inertia.rate_slopes;
        let by_sigma = f64::from(harmonic) * anomaly + f64::from(multiple) * longitude;
        let (root, degree) = (inertia.sigma.sqrt(), harmonic.abs());
        let inverse = 1.0 / frequency;
        let falling = if degree == 0 { 0.0 } else { f64::from(degree) * root.powi(degree - 1) * value };
        let further = root.powi(degree + 1);
        let [by_p, by_p_bar] = if harmonic > 0 { [falling, 0.0] } else { [0.0, falling] };
        let [sum, difference] = [by_p_bar + by_p, by_p_bar - by_p];
        let by_frequency = -inverse * inverse * further * value * by_sigma;
        let whole = inverse * root.powi(degree) * value;
        let sum = inverse * (sum + 2.0 * further * slope);
        [[whole, 0.0, sum, inverse * difference], [0.0, whole, 2.0 * by_frequency, 0.0]]
    }

    /// This term with divisors that are exact in the orbit's harmonics. What is smaller than `nothing` is left out.
    pub(super) fn exact(&self, inertia: &Inertia, orbit: (&OrbitSeries, Divisors), nothing: f64) -> ExactTerm {
        let negligible = 0.1 * nothing / self.size();
        ExactTerm::new((self.harmonic, self.multiple), self.factors(inertia), orbit, negligible)
    }

    /// Adds this term to the other terms of its |h|, with `orders` derivatives of g.
    pub(super) fn join(&self, harmonics: &mut Vec<Harmonic>, inertia: &Inertia, orders: usize) {
        let Self { harmonic, frequency, .. } = *self;
        let [still, moving] = self.factors(inertia);
        let factors: Vec<_> = (0..orders)
            .map(|j| {
                // (iε)^j without the factor i for odd j, and the same times j + 1.
                let weight = if j / 2 % 2 == 0 { 1.0 } else { -1.0 } * frequency.powi(-(j as i32)); // j < ORDERS
                let slope = (j as f64 + 1.0) * weight;
                std::array::from_fn(|i| still[i] * weight + moving[i] * slope)
            })
            .collect();
        let degree = harmonic.unsigned_abs() as usize;
        let place = harmonics.iter().position(|other| other.degree == degree).unwrap_or_else(|| {
            harmonics.push(Harmonic { degree, factors: Vec::new() });
            harmonics.len() - 1
        });
        harmonics[place].add(harmonic < 0, &factors);
    }
}
