//! Short-period corrections by the gravity gradient, to first order in the torque and to all orders in J (theory §9).
//!
//! D less its mean is a sum of e^(i(hℓ′+my′)) g(f), m = 0, ±1, ±2, with g = (a/r)³ times 1, cos 2f or sin 2f. With the frequency Ω = h dℓ′/dt + m dy′/dt,
//!
//! ```text
//! W = Σ e^(i(hℓ′+my′)) G(f),   G = g/(iΩ) − ġ/(iΩ)² + g̈/(iΩ)³ − …,   d/dt = n η^(−3) (1 + e cos f)² d/df
//! ```
//!
//! solves dW/dt = D − ⟨D⟩ with the disturbing body on its way; the first term alone holds it fixed, as the paper does. G is a Fourier polynomial in f. The corrections are
//! brackets with W in variables that are regular at J = 0 and at any inclination: p = √σ e^(iℓ′), M, y′ and rotations of the invariable frame,
//!
//! ```text
//! δp = (i/M) ∂W/∂p̄ − (p/2M) δM,   δM = −∂W/∂y′,   δy′ = −(p ∂W/∂p + p̄ ∂W/∂p̄)/2M + ∂W/∂M|p,   δ(M k) = −∂W/∂θ
//! ```
//!
//! with y′ counted from an axis that turns with k and not about it. Terms that turn the attitude by less than their share of the tolerance are dropped here.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use num_complex::Complex;

use super::inertia::{HIGHEST, Inertia};
use super::level::Level;
use crate::error::Error;
use crate::orbit::{Orbit, Place};

type C64 = Complex<f64>;

/// Derivatives of g that G has where the disturbing body moves.
const DERIVATIVES: usize = 6;
/// Ω over the fastest angular rate of twice the true anomaly below which the sum for G does not converge; above it what the sum leaves is part of the error.
const SMALLEST_RATIO: f64 = 1.5;
/// Part of the tolerance that a dropped term may use.
const SHARE: f64 = 0.003;

/// What a moment of time has of the mean motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mean {
    /// √σ e^(iℓ′).
    pub(crate) p: C64,
    pub(crate) longitude: f64,
    pub(crate) momentum: f64,
    /// The invariable frame, axis 3 along k.
    pub(crate) frame: UnitQuaternion<f64>,
}

/// First-order changes of it; `rotation` is about axes 1 and 2 of the frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Change {
    pub(crate) p: C64,
    pub(crate) longitude: f64,
    pub(crate) momentum: f64,
    pub(crate) rotation: [f64; 2],
}

impl Mean {
    /// This with a change added, or taken away for a factor of −1.
    pub(crate) fn changed(&self, change: &Change, factor: f64) -> Self {
        let [x, y] = change.rotation.map(|angle| factor * angle);
        Self {
            p: self.p + change.p * factor,
            longitude: self.longitude + factor * change.longitude,
            momentum: self.momentum + factor * change.momentum,
            frame: self.frame * UnitQuaternion::new(Vector3::new(x, y, 0.0)),
        }
    }
}

/// One (h, m), m ≥ 0, with for each of the three g the Fourier coefficients in f of G and of its derivatives.
#[derive(Clone, Debug)]
struct Term {
    harmonic: i32,
    multiple: i32,
    /// f_h G, d(f_h G)/dσ and M d(f_h G)/dM at fixed p; by g, part and k + K.
    parts: [[Vec<C64>; 3]; 3],
}

/// The generating function of one mean motion.
#[derive(Clone, Debug)]
pub(crate) struct Corrections {
    terms: Vec<Term>,
    /// The tensors that r̂r̂ is a combination of with 1, cos 2f, sin 2f; inertial.
    bases: [Matrix3<f64>; 3],
    /// 3n²/2 times the disturbing mass fraction.
    strength: f64,
    /// Highest multiple of f.
    width: usize,
    /// Sum of the terms that were dropped \[rad\].
    pub(crate) dropped: f64,
    /// What the sums for G leave \[rad\].
    pub(crate) rest: f64,
    /// Sum of all terms \[rad\].
    pub(crate) size: f64,
}

impl Corrections {
    /// The corrections of a mean motion by a body on an orbit whose mean motion in the units of `inertia` is `mean_motion`.
    ///
    /// # Errors
    /// - [`Error::Resonance`] where Ω is not larger than the bound.
    pub(crate) fn new(
        inertia: &Inertia,
        orbit: &Orbit,
        mean_motion: f64,
        level: Level,
        tolerance: f64,
    ) -> Result<Self, Error> {
        let eccentricity = orbit.eccentricity();
        let eta = (1.0 - eccentricity * eccentricity).sqrt();
        let derivatives = if level == Level::Paper { 0 } else { DERIVATIVES };
        let width = 5 + 2 * derivatives;
        let orbital = derivatives_in_time(eccentricity, mean_motion, derivatives, width);
        let strength = 1.5 * mean_motion * mean_motion * orbit.disturbing_fraction();
        let [first, second, _] = orbit.axes();
        let outer = |u: &Vector3<f64>, v: &Vector3<f64>| u * v.transpose();
        let bases = [
            (outer(&first, &first) + outer(&second, &second)) * 0.5,
            (outer(&first, &first) - outer(&second, &second)) * 0.5,
            (outer(&first, &second) + outer(&second, &first)) * 0.5,
        ];
        let mut corrections = Self { terms: Vec::new(), bases, strength, width, dropped: 0.0, rest: 0.0, size: 0.0 };
        // The disturbing body's fastest: twice the true anomaly at the pericentre.
        let fastest = 2.0 * mean_motion * (1.0 + eccentricity).powi(2) / eta.powi(3);
        for multiple in 0..=2_i32 {
            let lowest = if multiple == 0 { 1 } else { -(HIGHEST as i32) };
            // ℓ′ → ℓ′ + π turns the body half about axis 3: h and m are even or odd together.
            for harmonic in (lowest..=HIGHEST as i32).filter(|h| (h + multiple) % 2 == 0) {
                let (value, slope) = level.tensor(inertia, multiple, harmonic);
                let weight = inertia.sigma.sqrt().powi(harmonic.abs() - 1).min(1.0) * (1.0 + f64::from(harmonic.abs()));
                let strength =
                    strength * (value.norm() + slope.norm() * inertia.sigma) * weight * 2.0 / inertia.momentum;
                if strength == 0.0 {
                    continue;
                }
                let divisor = frequency(inertia, harmonic, multiple);
                let size = 2.0 * strength * (1.0 + eccentricity).powi(3) / eta.powi(6) / divisor.abs();
                if size <= SHARE * tolerance {
                    corrections.dropped += size;
                    continue;
                }
                if divisor.abs() <= SMALLEST_RATIO * fastest {
                    let bound = SMALLEST_RATIO * fastest;
                    return Err(Error::Resonance {
                        harmonic,
                        multiple,
                        divisor: divisor.abs() / fastest * 2.0,
                        bound: bound / fastest * 2.0,
                    });
                }
                corrections.size += size;
                corrections.rest += size * (fastest / divisor.abs()).powi(derivatives as i32 + 1);
                let parts = parts(inertia, (harmonic, multiple), (value, slope), &orbital);
                corrections.terms.push(Term { harmonic, multiple, parts });
            }
        }
        Ok(corrections)
    }

    /// The number of terms.
    pub(crate) fn count(&self) -> usize {
        self.terms.len()
    }

    /// The changes from mean to osculating variables.
    pub(crate) fn at(&self, mean: &Mean, place: &Place) -> Change {
        let turns = circle(place, self.width);
        let tensors = self.bases.map(|basis| {
            let axes = mean.frame.to_rotation_matrix();
            axes.transpose() * basis * axes.matrix()
        });
        let mut sum = Sums::default();
        for term in &self.terms {
            sum.add(term, mean, &tensors, &turns);
        }
        sum.change(mean, self.strength)
    }
}

/// Derivatives of W over the strength, as far as the corrections need them.
#[derive(Default)]
struct Sums {
    by_p: C64,
    by_p_bar: C64,
    by_longitude: f64,
    by_momentum: f64,
    by_rotation: [f64; 2],
}

impl Sums {
    fn add(&mut self, term: &Term, mean: &Mean, tensors: &[Matrix3<f64>; 3], turns: &[C64]) {
        let Term { harmonic, multiple, parts } = term;
        let (power, by_p, by_p_bar) = powers(mean.p, *harmonic);
        let turn = C64::from_polar(2.0, f64::from(*multiple) * mean.longitude);
        for (tensor, parts) in tensors.iter().zip(parts) {
            let [value, slope, scale] =
                parts.each_ref().map(|part| -> C64 { part.iter().zip(turns).map(|(c, t)| c * t).sum() });
            let (contraction, turned) = contractions(tensor, *multiple);
            let factor = turn * contraction;
            // The real part of X counts: ∂/∂p of it is (∂X/∂p + conj ∂X/∂p̄)/2.
            let x = factor * (by_p * value + power * slope * mean.p.conj());
            let x_bar = factor * (by_p_bar * value + power * slope * mean.p);
            self.by_p += (x + x_bar.conj()) * 0.5;
            self.by_p_bar += (x_bar + x.conj()) * 0.5;
            let whole = power * value;
            self.by_longitude -= f64::from(*multiple) * (factor * whole).im;
            self.by_momentum += (factor * power * scale).re / mean.momentum;
            for (sum, part) in self.by_rotation.iter_mut().zip(turned) {
                *sum += (turn * part * whole).re;
            }
        }
    }

    fn change(&self, mean: &Mean, strength: f64) -> Change {
        let momentum = -strength * self.by_longitude;
        let circling = (mean.p * self.by_p + mean.p.conj() * self.by_p_bar).re;
        let [x, y] = self.by_rotation.map(|part| -strength * part / mean.momentum);
        Change {
            p: C64::i() * self.by_p_bar * (strength / mean.momentum) - mean.p * (0.5 * momentum / mean.momentum),
            longitude: strength * (self.by_momentum - 0.5 * circling / mean.momentum),
            momentum,
            // k × δ(Mk)/M turns k, and the frame with it.
            rotation: [-y, x],
        }
    }
}

/// Ω of a term.
pub(crate) fn frequency(inertia: &Inertia, harmonic: i32, multiple: i32) -> f64 {
    let [anomaly, longitude] = inertia.rates.map(|rate| rate.to_f64());
    f64::from(harmonic) * anomaly + f64::from(multiple) * longitude
}

/// P_h and its derivatives with respect to p and p̄.
fn powers(p: C64, harmonic: i32) -> (C64, C64, C64) {
    let (none, degree) = (C64::default(), harmonic.abs());
    let base = if harmonic < 0 { p.conj() } else { p };
    let lower = if degree == 0 { none } else { base.powi(degree - 1) * f64::from(degree) };
    let power = base.powi(degree);
    if harmonic < 0 { (power, none, lower) } else { (power, lower, none) }
}

/// What r̂r̂ gives to a multiple of y′, and its derivatives when the frame turns about its axes 1 and 2: r₃² − ⅓, r̄₊ r₃, r̄₊².
fn contractions(s: &Matrix3<f64>, multiple: i32) -> (C64, [C64; 2]) {
    let c = C64::new;
    match multiple {
        0 => (c(1.5 * s[(2, 2)] - 0.5 * s.trace(), 0.0), [c(-3.0 * s[(1, 2)], 0.0), c(3.0 * s[(0, 2)], 0.0)]),
        1 => (c(s[(0, 2)], -s[(1, 2)]), [c(-s[(0, 1)], s[(1, 1)] - s[(2, 2)]), c(s[(0, 0)] - s[(2, 2)], -s[(0, 1)])]),
        _ => (
            c(s[(0, 0)] - s[(1, 1)], -2.0 * s[(0, 1)]),
            [c(-2.0 * s[(1, 2)], -2.0 * s[(0, 2)]), c(-2.0 * s[(0, 2)], 2.0 * s[(1, 2)])],
        ),
    }
}

/// e^(ikf), k = −K … K.
fn circle(place: &Place, width: usize) -> Vec<C64> {
    let step = C64::new(place.cosine, place.sine);
    let mut turns = vec![C64::new(1.0, 0.0); 2 * width + 1];
    for k in 1..=width {
        turns[width + k] = turns[width + k - 1] * step;
        turns[width - k] = turns[width + k].conj();
    }
    turns
}

/// Fourier coefficients in f of the time derivatives of (a/r)³ times 1, cos 2f, sin 2f, by g, derivative and k + K.
fn derivatives_in_time(eccentricity: f64, mean_motion: f64, derivatives: usize, width: usize) -> [Vec<Vec<C64>>; 3] {
    let eta = (1.0 - eccentricity * eccentricity).sqrt();
    // Times 1 + e cos f; what leaves the width is zero, which is what the width is for.
    let times_w = |series: &[C64]| -> Vec<C64> {
        let at = |k: usize| series.get(k).copied().unwrap_or_default();
        (0..series.len()).map(|k| at(k) + (at(k.wrapping_sub(1)) + at(k + 1)) * (0.5 * eccentricity)).collect()
    };
    let mut start =
        [vec![C64::default(); 2 * width + 1], vec![C64::default(); 2 * width + 1], vec![C64::default(); 2 * width + 1]];
    start[0][width] = C64::new(1.0, 0.0);
    (start[1][width + 2], start[1][width - 2]) = (C64::new(0.5, 0.0), C64::new(0.5, 0.0));
    (start[2][width + 2], start[2][width - 2]) = (C64::new(0.0, -0.5), C64::new(0.0, 0.5));
    start.map(|series| {
        let cubed = times_w(&times_w(&times_w(&series)));
        let mut all = vec![cubed.iter().map(|c| c / eta.powi(6)).collect::<Vec<_>>()];
        for order in 0..derivatives {
            let slope: Vec<C64> = (0..2 * width + 1)
                .map(|k| all[order][k] * C64::new(0.0, (k as f64 - width as f64) * mean_motion / eta.powi(3)))
                .collect();
            all.push(times_w(&times_w(&slope)));
        }
        all
    })
}

/// f_h G, d(f_h G)/dσ and M d(f_h G)/dM of one term.
fn parts(
    inertia: &Inertia,
    (harmonic, multiple): (i32, i32),
    (value, slope): (C64, C64),
    orbital: &[Vec<Vec<C64>>; 3],
) -> [[Vec<C64>; 3]; 3] {
    let divisor = frequency(inertia, harmonic, multiple);
    let by_sigma = f64::from(harmonic) * inertia.rate_slopes[0] + f64::from(multiple) * inertia.rate_slopes[1];
    orbital.each_ref().map(|derivatives| {
        let length = derivatives[0].len();
        let (mut sum, mut by_divisor) = (vec![C64::default(); length], vec![C64::default(); length]);
        let inverse = C64::new(0.0, -1.0 / divisor); // 1/(iΩ)
        let mut weight = inverse;
        for (order, series) in derivatives.iter().enumerate() {
            let fall = weight * (-(order as f64 + 1.0) / divisor);
            for (k, c) in series.iter().enumerate() {
                sum[k] += weight * c;
                by_divisor[k] += fall * c;
            }
            weight *= -inverse;
        }
        let value_part = sum.iter().map(|c| c * value).collect();
        let slope_part = sum.iter().zip(&by_divisor).map(|(c, d)| c * slope + d * value * by_sigma).collect();
        let scale_part = by_divisor.iter().map(|d| d * value * divisor).collect();
        [value_part, slope_part, scale_part]
    })
}
