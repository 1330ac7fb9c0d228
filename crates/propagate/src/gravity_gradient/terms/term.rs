//! A term of the disturbing function: its coefficient and its frequency; the change of the motion by it, and by errors of the mean variables.

use crate::gravity_gradient::constants::SLOW_RATIO;
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::inertia::{HIGHEST, Inertia};

/// The factors of one mean motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sensitivity {
    /// Largest turn of the attitude for a unit change of p \[rad\]: √2 for an axisymmetric body at J = 0, and √(2ω) near B = C.
    pub(crate) gain: f64,
    /// Turn of the attitude for a unit change of ℓ′.
    pub(crate) visible: f64,
    /// Rate of the turn for a unit change of σ.
    pub(crate) by_sigma: f64,
    /// Rate of the turn for a unit relative change of M.
    pub(crate) by_momentum: f64,
    pub(crate) sigma: f64,
}

impl Sensitivity {
    /// The factors from the series of a and b.
    pub(crate) fn new(inertia: &Inertia) -> Self {
        let sigma = inertia.sigma;
        let root = sigma.sqrt();
        let highest = HIGHEST as i32;
        let mut slope = 0.0;
        for series in &inertia.pair {
            for harmonic in -highest..=highest {
                let (value, by_sigma) = series.at(harmonic);
                let degree = harmonic.abs();
                let falling = if degree == 0 { 0.0 } else { f64::from(degree) * root.powi(degree - 1) * value.abs() };
                slope += falling + 2.0 * root.powi(degree + 1) * by_sigma.abs();
            }
        }
        let gain = 2.0 * slope / inertia.pair[0].at(0).0.abs();
        let visible = gain * root;
        let [anomaly, longitude] = inertia.rates.map(|rate| rate.to_f64().abs());
        let [anomaly_slope, longitude_slope] = inertia.rate_slopes.map(f64::abs);
        Self {
            gain,
            visible,
            by_sigma: visible * anomaly_slope + longitude_slope,
            by_momentum: visible * anomaly + longitude,
            sigma,
        }
    }

    /// Rate of the turn of the attitude for a relative change of this size of the mean variables.
    pub(crate) fn drift(&self, change: f64) -> f64 {
        let p = change / self.gain;
        change * self.by_momentum + p * (2.0 * self.sigma.sqrt() + p) * self.by_sigma
    }

    /// The attitude error over a time that errors of the mean M and L make, over M \[rad\].
    pub(crate) fn of_actions(&self, [momentum, action]: [f64; 2], duration: f64) -> f64 {
        (momentum * self.by_momentum + (action + self.sigma * momentum) * self.by_sigma) * duration
    }

    /// The factor by which the effect of a term on the attitude grows over a time: through σ, and through M for m ≠ 0.
    pub(crate) fn growth(&self, multiple: i32, duration: f64) -> f64 {
        let by_momentum = if multiple == 0 { 0.0 } else { self.by_momentum };
        let by_sigma = 2.0 * self.sigma.sqrt() / self.gain * self.by_sigma;
        1.0 + duration * (by_sigma + by_momentum)
    }
}

/// Largest size of the contraction of r̂r̂ for each m.
const CONTRACTED: [f64; 3] = [2.0 / 3.0, 0.5, 1.0];

/// f σ^(|h|/2) e^(i(hℓ′+my′)) times the contraction c_m of (a/r)³ r̂r̂: a term of the disturbing function over Γ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    /// h.
    pub(crate) harmonic: i32,
    /// m, 0 to 2.
    pub(crate) multiple: i32,
    /// The real f, df/dσ and d²f/dσ², without the factors 3/2 for m = 0 and −i for m = 1.
    pub(crate) function: [f64; 3],
    /// Ω.
    pub(crate) frequency: f64,
    /// Ω/M, and its first two derivatives with respect to σ.
    pub(crate) per_momentum: [f64; 3],
    /// Rate of change of the attitude by the term \[rad per unit of time\]. This and the next three are 0 before [`Term::under`].
    pub(crate) rate: f64,
    /// Rate of change of M or L by the term, over M and over m or h.
    pub(crate) action: f64,
    /// Largest rate of change of p and of the direction of the angular momentum by the term.
    pub(crate) moving: f64,
    /// Change of the attitude through ∂Ω/∂σ, times the square of the divisor \[rad per unit of time squared\].
    shift: f64,
}

impl Term {
    pub(crate) fn new(inertia: &Inertia, harmonic: i32, multiple: i32) -> Self {
        let function = inertia.tensor[multiple as usize].jet(harmonic); // 0 ≤ m ≤ 2
        let rates = [inertia.rates.map(|rate| rate.to_f64()), inertia.rate_slopes, inertia.rate_curvatures];
        let combined = |[anomaly, longitude]: [f64; 2]| {
            (f64::from(harmonic) * anomaly + f64::from(multiple) * longitude) / inertia.momentum
        };
        let per_momentum = rates.map(combined);
        let frequency = inertia.momentum * per_momentum[0];
        Self { harmonic, multiple, function, frequency, per_momentum, rate: 0.0, action: 0.0, moving: 0.0, shift: 0.0 }
    }

    /// The terms with m > 0, and those with m = 0 and h > 0.
    pub(crate) fn all(inertia: &Inertia) -> impl Iterator<Item = Self> {
        let highest = HIGHEST as i32;
        (0..=2_i32).flat_map(move |multiple| {
            let lowest = if multiple == 0 { 1 } else { -highest };
            // ℓ′ → ℓ′ + π turns the body by half a turn about axis 3, so h and m are both even or both odd.
            let harmonics = (lowest..=highest).filter(move |h| (h + multiple) % 2 == 0);
            harmonics.map(move |harmonic| Self::new(inertia, harmonic, multiple))
        })
    }

    /// f and its derivatives with the factor 3/2 for m = 0.
    pub(crate) fn weighted(&self) -> [f64; 3] {
        let factor = if self.multiple == 0 { 1.5 } else { 1.0 };
        self.function.map(|part| factor * part)
    }

    /// ⟨D⟩ and its derivatives by σ, weighted.
    pub(crate) fn average(inertia: &Inertia) -> [f64; 3] {
        let [value, slope, curvature] = Self::new(inertia, 0, 0).weighted();
        [value - 0.5 * inertia.trace, slope, curvature]
    }

    /// f² σ^|h| and its first two derivatives: regular at σ = 0.
    pub(crate) fn square(&self, sigma: f64) -> [f64; 3] {
        let [f, slope, curvature] = self.weighted();
        let degree = self.harmonic.abs();
        let d = f64::from(degree);
        let falling = |lower: i32| if degree >= lower { sigma.powi(degree - lower) } else { 0.0 };
        let [s0, s1, s2] = [falling(0), d * falling(1), d * (d - 1.0) * falling(2)];
        [
            f * f * s0,
            2.0 * f * slope * s0 + f * f * s1,
            2.0 * (slope * slope + f * curvature) * s0 + 4.0 * f * slope * s1 + f * f * s2,
        ]
    }

    /// Relative size of the change of the mean variables by the term.
    pub(crate) fn relative_size(&self, root: f64) -> f64 {
        self.strength(root) / self.per_momentum[0].abs()
    }

    /// Relative rate of the change of the mean variables by the term, over M.
    pub(crate) fn strength(&self, root: f64) -> f64 {
        let degree = self.harmonic.abs();
        let [value, slope, _] = self.weighted().map(f64::abs);
        (value + root * root * slope) * root.powi((degree - 1).max(0)) * f64::from(degree + 1)
    }

    /// The term with f and df/dσ of a level and the rates of change by it, or `None` if it is 0. `scale` is four times the strength of the torque at the pericentre
    /// over M.
    pub(crate) fn under(
        self,
        (value, slope): (f64, f64),
        inertia: &Inertia,
        (response, scale): (&Sensitivity, f64),
    ) -> Option<Self> {
        let function = [value, slope, self.function[2]];
        let [value, slope, _] = function.map(f64::abs);
        let root = inertia.sigma.sqrt();
        let degree = self.harmonic.abs();
        let falling = if degree == 0 { 0.0 } else { f64::from(degree) * root.powi(degree - 1) * value };
        let further = root.powi(degree + 1);
        let derivative = falling + 2.0 * further * slope;
        let by_p = 0.5 * response.gain * derivative;
        let rate = scale * (root.powi(degree) * value + by_p);
        let by_sigma = inertia.momentum * self.per_momentum[1];
        let shift = scale * 0.5 * response.gain * further * value * by_sigma.abs();
        let contracted = CONTRACTED[self.multiple as usize]; // 0 ≤ m ≤ 2
        let action = 0.5 * scale * contracted * root.powi(degree) * value;
        // A turn about axes 1 and 2 changes a contraction by at most twice its largest size.
        let moving = 0.25 * scale * contracted * derivative + 2.0 * action;
        (rate > 0.0).then_some(Self { function, rate, action, moving, shift, ..self })
    }

    /// Largest change of the attitude by the term \[rad\].
    pub(crate) fn size(&self) -> f64 {
        self.size_at(self.frequency.abs())
    }

    /// Largest change of the attitude by the term with another divisor \[rad\].
    pub(crate) fn size_at(&self, divisor: f64) -> f64 {
        (self.rate + self.shift / divisor) / divisor
    }

    /// The change of y′ through ∂Ω/∂M for a given divisor \[rad\]. [`Term::size`] does not contain it.
    pub(crate) fn turn_at(&self, divisor: f64) -> f64 {
        self.action / divisor * self.frequency.abs() / divisor
    }
}

/// Largest |Ω| of a slow term: [`SLOW_RATIO`] times the largest rate of twice the true anomaly within the span and of the axes.
pub(crate) fn slow_limit(orbit: &Disturbance<'_>) -> f64 {
    SLOW_RATIO * (orbit.envelope.fastest + orbit.turning())
}

/// The terms that are larger than `share` of the largest and faster than `slow_limit`, a frequency.
pub(crate) fn fast_terms(inertia: &Inertia, share: f64, slow_limit: f64) -> Vec<Term> {
    let root = inertia.root();
    let is_fast = |term: &Term| term.frequency.abs() > slow_limit && term.relative_size(root) > 0.0;
    let mut terms: Vec<_> = Term::all(inertia).filter(is_fast).collect();
    let largest = terms.iter().map(|term| term.relative_size(root)).fold(0.0, f64::max);
    terms.retain(|term| term.relative_size(root) >= share * largest);
    terms
}

/// The terms that are not faster than `slow_limit`, of any size.
pub(crate) fn slow_terms(inertia: &Inertia, slow_limit: f64) -> Vec<Term> {
    Term::all(inertia).filter(|term| term.frequency.abs() <= slow_limit).collect()
}
