//! Short-period corrections for the gravity gradient, to first order in the torque and to all orders in J (theory §9).
//!
//! D minus its mean is a sum of e^(i(hℓ′+my′)) g(f), m = 0, ±1, ±2, with g = (a/r)³ times 1, cos 2f or sin 2f. With the frequency Ω = h dℓ′/dt + m dy′/dt,
//!
//! ```text
//! W = Σ e^(i(hℓ′+my′)) G(f),   G = g/(iΩ) − ġ/(iΩ)² + g̈/(iΩ)³ − …,   d/dt = n η^(−3) (1 + e cos f)² d/df
//! ```
//!
//! solves dW/dt = D − ⟨D⟩ for a disturbing body that moves on its orbit. Where this sum is not accurate enough, the divisors in G are exact
//! ([`crate::gravity_gradient::terms::regime`]). The first term of G alone holds the body fixed, as in the paper. G is a Fourier polynomial in f. The corrections are brackets with W
//! in variables that are regular at J = 0 and at any inclination: p = √σ e^(iℓ′), M, y′ and rotations of the invariable frame,
//!
//! ```text
//! δp = (i/M) ∂W/∂p̄ − (p/2M) δM,   δM = −∂W/∂y′,   δy′ = −(p ∂W/∂p + p̄ ∂W/∂p̄)/2M + ∂W/∂M|p,   δ(M k) = −∂W/∂θ
//! ```
//!
//! where y′ is counted from an axis that turns with k and not about it. A term, or a derivative of g, is dropped here if it is smaller than a fraction of the
//! second-order error or of the tolerance. The error by resonant terms is part of the error bound, or it is an error ([`crate::gravity_gradient::terms::regime`]).

use nalgebra::{Quaternion, UnitQuaternion};
use num_complex::Complex;

use super::generator;
use super::generator::{Factors, Generator};
use super::sums::Harmonic;
use crate::error::{Error, TorqueMeasure};
use crate::gravity_gradient::body::inertia::{HIGHEST, Inertia};
use crate::gravity_gradient::orbit::derivatives::ORDERS;
use crate::gravity_gradient::orbit::elliptic_motion::fixed;
use crate::gravity_gradient::orbit::elliptic_orbit::Demand;
use crate::gravity_gradient::terms::divisors::Secular;
use crate::gravity_gradient::terms::regime::{Regime, Regimes};
use crate::gravity_gradient::terms::sensitivity::Response;
use crate::gravity_gradient::terms::term::{Candidate, SLOW_RATIO};
use crate::input::options::Level;
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::kepler::Place;
use crate::simd::lanes::Lanes;

type C64 = Complex<f64>;

/// Largest sum of the corrections for which first order is accepted.
const LARGEST_SIZE: f64 = 0.05;
/// Largest size of the contraction of r̂r̂ for each m.
const CONTRACTED: [f64; 3] = [2.0 / 3.0, 0.5, 1.0];
/// Largest part of the tolerance that a dropped term may take, if the mean M and L lack the dropped terms and if they have them. The second is so small that in scenes of weak torques the error stays near rounding;
/// ten times as much makes a sample 3 % faster.
const TOLERABLE: [f64; 2] = [0.01, 2e-5];
/// Largest part of a dropped term that a dropped coefficient of a time derivative may have.
const SMALLEST_COEFFICIENT: f64 = 0.004;

/// The mean variables at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mean {
    /// √σ e^(iℓ′).
    pub(crate) p: C64,
    pub(crate) longitude: f64,
    pub(crate) momentum: f64,
    /// The invariable frame, axis 3 along k.
    pub(crate) frame: UnitQuaternion<f64>,
}

/// First-order changes of the mean variables; `rotation` is about axes 1 and 2 of the frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Change {
    pub(crate) p: C64,
    pub(crate) longitude: f64,
    pub(crate) momentum: f64,
    pub(crate) rotation: [f64; 2],
}

impl Mean {
    /// These variables plus `factor` times a change; a factor of −1 subtracts the change.
    pub(crate) fn changed(&self, change: &Change, factor: f64) -> Self {
        let [x, y] = change.rotation.map(|angle| 0.5 * factor * angle);
        Self {
            p: self.p + change.p * factor,
            longitude: self.longitude + factor * change.longitude,
            momentum: self.momentum + factor * change.momentum,
            frame: self.frame * UnitQuaternion::new_normalize(Quaternion::new(1.0, x, y, 0.0)),
        }
    }
}

impl Change {
    /// The sum of two changes.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            p: self.p + other.p,
            longitude: self.longitude + other.longitude,
            momentum: self.momentum + other.momentum,
            rotation: [self.rotation[0] + other.rotation[0], self.rotation[1] + other.rotation[1]],
        }
    }
}

/// The generating function of one mean motion.
#[derive(Clone, Debug)]
pub(crate) struct Corrections {
    pub(crate) generator: Generator,
    /// What is not corrected of terms in resonance, over the span \[rad\].
    pub(crate) resonant: f64,
    /// The root of the sum of the squared sizes of all terms that are not slow, and of the slow ones that are corrected \[rad\].
    pub(crate) rms: f64,
    /// Dropped terms, and truncated sums for G on both ends \[rad\].
    pub(crate) dropped: f64,
    /// Sum of the terms that the level omits, over the span \[rad\].
    pub(crate) omitted: f64,
    /// The parts of ⟨T33⟩ and of its slope that the level omits, times the mass fraction over M.
    pub(crate) axial_omitted: [f64; 2],
    /// Sum of the sizes of all terms that are not slow, also dropped ones \[rad\].
    pub(crate) size: f64,
    /// Number of terms that are kept.
    pub(crate) count: usize,
    /// The largest dropped term, or the largest truncation error of a kept term, whichever is larger \[rad\].
    pub(crate) neglected: f64,
}

/// All terms for one body, before any is dropped.
pub(crate) struct Terms {
    all: Vec<Candidate>,
    response: Response,
    /// 3n²/2 times the disturbing mass fraction.
    strength: f64,
    /// Four times the strength of the torque at the pericentre over M.
    scale: f64,
    /// Largest change of the frequencies of the torque by the rates of node and pericentre.
    turning: f64,
    /// The largest rate of twice the true anomaly, at the pericentre, and of the axes.
    fastest: f64,
    /// Sum of the sizes of the terms that are not slow \[rad\].
    pub(crate) size: f64,
}

impl Terms {
    pub(crate) fn new(inertia: &Inertia, demand: &Demand<'_>) -> Self {
        let Demand { level, rates, envelope, .. } = *demand;
        let turning = 2.0 * (rates[0].abs() + rates[1].abs());
        let fastest = envelope.fastest + turning;
        let strength = demand.strength();
        let nearest = strength * envelope.span[0];
        let response = Response::new(inertia);
        let scale = 4.0 * nearest / inertia.momentum;
        let all = candidates(inertia, &response, scale, |m, h| level.tensor(inertia, m, h));
        let mut terms = Self { all, response, strength, scale, turning, fastest, size: 0.0 };
        terms.size = terms.all.iter().filter(|candidate| terms.regular(candidate)).map(Candidate::size).sum();
        terms
    }

    /// Whether a term is fast enough for a sum over time derivatives.
    fn regular(&self, candidate: &Candidate) -> bool {
        candidate.frequency.abs() > SLOW_RATIO * self.fastest
    }
}

impl Corrections {
    /// The corrections of a mean motion under one body.
    ///
    /// # Errors
    /// - [`Error::Resonance`] if a resonant term has an effect that cannot be corrected.
    /// - [`Error::TorqueTooStrong`] if the corrections are not small.
    pub(crate) fn new(inertia: &Inertia, demand: &Demand<'_>) -> Result<Self, Error> {
        let terms = Terms::new(inertia, demand);
        let size = terms.size;
        Self::of(terms, inertia, demand, size)
    }

    /// The corrections of a mean motion for one of several bodies. The sizes of the terms of all bodies that are not slow sum to `whole`.
    ///
    /// # Errors
    /// As [`Corrections::new`].
    pub(crate) fn of(terms: Terms, inertia: &Inertia, demand: &Demand<'_>, whole: f64) -> Result<Self, Error> {
        if whole > LARGEST_SIZE {
            return Err(Error::TorqueTooStrong {
                measure: TorqueMeasure::Corrections,
                size: whole,
                bound: LARGEST_SIZE,
            });
        }
        let Demand { orbit, mean_motion, level, duration, envelope, series, .. } = *demand;
        let Terms { response, strength, scale, turning, fastest, size, .. } = terms;
        let eccentricity = orbit.eccentricity();
        // The refined M and L contain all terms but are evaluated at a state found without the dropped ones, so the effect of a dropped term grows in second
        // order only.
        let further = if demand.refined { whole } else { 1.0 };
        let growth = |multiple: i32| 1.0 + further * (response.growth(multiple, duration) - 1.0);
        let tolerable = TOLERABLE[usize::from(demand.refined)] * demand.tolerance / growth(1);
        let nothing = tolerable.max(demand.share * whole * whole);
        let regimes = Regimes {
            response: &response,
            envelope,
            eccentricity,
            mean_motion,
            turning,
            fastest,
            duration,
            secular: Secular::new(inertia, strength, eccentricity, [&demand.axes[2], &demand.pole]),
            series,
            sizes: if demand.rates == [0.0; 2] { envelope.span.to_vec() } else { envelope.orbital.norms.clone() },
            most: if level == Level::Paper { 1 } else { ORDERS },
            nothing,
            enough: nothing.max(0.01 * demand.tolerance),
            whole,
        };
        let chosen: Vec<_> = terms.all.iter().map(|term| (term, regimes.of(term))).collect();
        let effects = chosen.iter().map(|(term, regime)| (*term, regimes.uncorrected(term, regime)));
        let resonant = regimes.total(effects, demand.tolerance.max(second_order(whole, &response, duration)))?;
        let omitted = candidates(inertia, &response, scale, |m, h| level.omitted(inertia, m, h));
        let omitted = omitted.iter().map(|term| regimes.whole(term)).sum();
        let (mut dropped, mut count, mut most_orders, mut neglected) = (0.0, 0, 0, 0.0_f64);
        let mut squares = 0.0;
        // Of the terms together, for a time derivative of 1.
        let mut amplitudes = [0.0; ORDERS];
        let mut harmonics = [const { Vec::<Harmonic>::new() }; 3];
        let mut exact = Vec::new();
        for (candidate, regime) in &chosen {
            // The tilt of the angular momentum by a dropped term changes its precession, for m = 0 too.
            let growth = growth(if demand.refined { 1 } else { candidate.multiple });
            squares += match *regime {
                Regime::Exact { size, .. } => size * size,
                Regime::Slow => 0.0,
                Regime::Fast { .. } | Regime::Negligible => candidate.size().powi(2),
            };
            match (*regime, series) {
                (Regime::Exact { resonant, .. }, Some(series)) => {
                    let divisors = regimes.divisors(candidate).without(resonant);
                    exact.push(candidate.exact(inertia, (series, divisors), nothing));
                    dropped += growth * nothing;
                    count += 1;
                }
                (Regime::Fast { orders, truncation }, _) => {
                    dropped += 2.0 * growth * truncation;
                    neglected = neglected.max(truncation);
                    most_orders = most_orders.max(orders);
                    for (j, amplitude) in amplitudes.iter_mut().enumerate().take(orders) {
                        let of_derivative = candidate.size() / candidate.frequency.abs().powi(j as i32); // j < ORDERS
                        *amplitude += (j + 1) as f64 * of_derivative / envelope.span[0];
                    }
                    candidate.join(&mut harmonics[candidate.multiple as usize], inertia, orders); // 0 ≤ m ≤ 2
                    count += 1;
                }
                (Regime::Negligible, _) => {
                    dropped += growth * candidate.size();
                    neglected = neglected.max(candidate.size());
                }
                _ => {}
            }
        }
        let bounds = amplitudes.map(|amplitude| SMALLEST_COEFFICIENT * nothing / amplitude);
        let (orbital, cut) = envelope.orbital.cut(&bounds[..most_orders]);
        let cut: f64 = cut.iter().zip(&amplitudes).map(|(cut, amplitude)| cut * amplitude).sum();
        dropped += 2.0 * growth(1) * cut;
        let [first, second, _] = demand.axes;
        let per_momentum = orbit.disturbing_fraction() / inertia.momentum;
        let (level_axial, full_axial) = (level.axial(inertia), Level::Full.axial(inertia));
        let axial_omitted = [full_axial.0 - level_axial.0, full_axial.1 - level_axial.1];
        let axial_omitted = axial_omitted.map(|part| part.abs() * per_momentum);
        let factors = Factors { strength, root: inertia.sigma.sqrt(), momentum: inertia.momentum };
        let generator = Generator::new(&harmonics, exact, (orbital, [first, second]), factors);
        let rms = squares.sqrt();
        Ok(Self { generator, resonant, rms, dropped, omitted, axial_omitted, size, count, neglected })
    }

    /// The changes from mean to osculating variables, for |p| = √σ and the axes of the orbit at the epoch.
    pub(crate) fn at(&self, mean: &Mean, place: &Place<pulp::Scalar>) -> Change {
        let one = |value: f64| Lanes::splat(pulp::Scalar, value);
        let turn = if mean.p == C64::default() { C64::new(1.0, 0.0) } else { mean.p / mean.p.norm() };
        let spin = C64::from_polar(1.0, mean.longitude);
        let point = |c: C64| ComplexLanes { re: one(c.re), im: one(c.im) };
        let frame = QuaternionLanes::all(one(0.0), &mean.frame);
        let axes = fixed(&self.generator.axes, place.sine);
        let mean = generator::MeanLanes { turn: point(turn), spin: point(spin), frame };
        let change = self.generator.at(&mean, place, &axes);
        let value = |lanes: Lanes<pulp::Scalar>| lanes.values()[0];
        Change {
            p: turn * C64::new(value(change.p.re), value(change.p.im)),
            longitude: value(change.longitude),
            momentum: value(change.momentum),
            rotation: change.rotation.map(value),
        }
    }
}

/// Lower estimate of the second-order change of the attitude over a time \[rad\].
fn second_order(size: f64, response: &Response, duration: f64) -> f64 {
    size * size * (1.0 + 0.1 * response.by_momentum * duration)
}

/// All terms (h, m) that are not 0. `function` gives (value, slope) of (m, h). `scale` is four times the strength of the torque at the pericentre over M.
fn candidates(
    inertia: &Inertia,
    response: &Response,
    scale: f64,
    function: impl Fn(i32, i32) -> (f64, f64),
) -> Vec<Candidate> {
    let highest = HIGHEST as i32;
    let root = inertia.sigma.sqrt();
    let mut candidates = Vec::new();
    for multiple in 0..=2_i32 {
        let lowest = if multiple == 0 { 1 } else { -highest };
        // ℓ′ → ℓ′ + π turns the body by half a turn about axis 3, so h and m are both even or both odd.
        for harmonic in (lowest..=highest).filter(|h| (h + multiple) % 2 == 0) {
            let (value, slope) = function(multiple, harmonic);
            let (value_size, slope_size) = (value.abs(), slope.abs());
            let degree = harmonic.abs();
            let falling = if degree == 0 { 0.0 } else { f64::from(degree) * root.powi(degree - 1) * value_size };
            let further = root.powi(degree + 1);
            let by_p = 0.5 * response.gain * (falling + 2.0 * further * slope_size);
            let rate = scale * (root.powi(degree) * value_size + by_p);
            if rate > 0.0 {
                let frequency = frequency(inertia, harmonic, multiple);
                let [anomaly, longitude] = inertia.rate_slopes;
                let by_sigma = f64::from(harmonic) * anomaly + f64::from(multiple) * longitude;
                let shift = scale * 0.5 * response.gain * further * value_size * by_sigma.abs();
                let action = 0.5 * scale * CONTRACTED[multiple as usize] * root.powi(degree) * value_size; // 0 ≤ m ≤ 2
                candidates.push(Candidate { harmonic, multiple, value, slope, frequency, rate, action, shift });
            }
        }
    }
    candidates
}

/// Ω of a term.
fn frequency(inertia: &Inertia, harmonic: i32, multiple: i32) -> f64 {
    let [anomaly, longitude] = inertia.rates.map(|rate| rate.to_f64());
    f64::from(harmonic) * anomaly + f64::from(multiple) * longitude
}
