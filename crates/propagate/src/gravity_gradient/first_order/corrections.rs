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
//! second-order error or of the tolerance. The error by resonant terms is part of the error estimate; if it is large, the scene is refused ([`crate::gravity_gradient::terms::regime`]).

use super::fourier::ExactTerm;
use super::generator;
use super::generator::{Generator, TorqueScale};
use super::mean_variables::{Mean, PeriodicChange};
use super::sums::TermSums;
use crate::error::{Error, TorqueMeasure};
use crate::gravity_gradient::constants::{LARGEST_SIZE, SMALLEST_COEFFICIENT};
use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::terms::regime::{Regime, Regimes, Terms};
use crate::gravity_gradient::terms::term::{Sensitivity, Term};
use crate::numerics::C64;
use crate::orbit::derivatives::ORDERS;
use crate::orbit::kepler::Place;
use crate::orbit::position::fixed;
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::lanes::Lanes;

/// The generating function of one mean motion.
#[derive(Clone, Debug)]
pub(crate) struct Corrections {
    pub(crate) generator: Generator,
    /// Error of the attitude over the span by terms in resonance \[rad\].
    pub(crate) resonant: f64,
    /// The root of the sum of the squared sizes of all terms that are not slow, and of the slow ones that are corrected \[rad\].
    pub(crate) rms: f64,
    /// The part of the squared sizes of the terms with exact divisors in the square of `rms`, and their mean squares ([`Regime::Exact`]) over the same.
    pub(crate) exact: [f64; 2],
    /// Error of the attitude by dropped terms, and by truncated sums at the epoch and at the time of evaluation \[rad\].
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

impl Corrections {
    /// The corrections of a mean motion under one body.
    ///
    /// # Errors
    /// - [`Error::Resonance`] if a resonant term has an effect that cannot be corrected.
    /// - [`Error::TorqueTooStrong`] if the corrections are not small.
    pub(crate) fn new(inertia: &Inertia, disturbance: &Disturbance<'_>) -> Result<Self, Error> {
        let terms = Terms::new(inertia, disturbance);
        Self::of(&terms, inertia, disturbance, terms.size)
    }

    /// The corrections of a mean motion for one of several bodies. The sizes of the terms of all bodies that are not slow sum to `whole`.
    ///
    /// # Errors
    /// As [`Corrections::new`].
    pub(crate) fn of(
        terms: &Terms,
        inertia: &Inertia,
        disturbance: &Disturbance<'_>,
        whole: f64,
    ) -> Result<Self, Error> {
        if whole > LARGEST_SIZE {
            let measure = TorqueMeasure::Corrections;
            return Err(Error::TorqueTooStrong { measure, size: whole, bound: LARGEST_SIZE });
        }
        let regimes = Regimes::new(terms, inertia, disturbance, whole);
        let chosen: Vec<_> = terms.all.iter().map(|term| (term, regimes.of(term))).collect();
        let moved = regimes.all_moved(&chosen);
        let effects = chosen.iter().map(|(term, regime)| (*term, regimes.uncorrected(term, regime, moved)));
        let allowed = disturbance.ledger.refused.max(second_order(whole, &terms.response, disturbance.duration));
        let resonant = regimes.total(effects, allowed)?;
        let mut collected = Collected::default();
        for (term, regime) in &chosen {
            collected.add(term, regime, inertia, (&regimes, disturbance));
        }
        let generator = collected.generator(inertia, (&regimes, disturbance));
        let Collected { squares, exact_squares, dropped, neglected, count, .. } = collected;
        Ok(Self {
            generator,
            resonant,
            rms: squares.sqrt(),
            exact: exact_squares.map(|part| if squares > 0.0 { part / squares } else { 0.0 }),
            dropped,
            omitted: terms.omitted.iter().map(|term| regimes.whole(term)).sum(),
            axial_omitted: axial_omitted(inertia, disturbance),
            size: terms.size,
            count,
            neglected,
        })
    }

    /// The changes from mean to osculating variables, for |p| = √σ and the axes of the orbit at the epoch.
    pub(crate) fn at(&self, mean: &Mean, place: &Place<pulp::Scalar>) -> PeriodicChange {
        let one = |value: f64| Lanes::splat(pulp::Scalar, value);
        let turn = if mean.p == C64::default() { C64::new(1.0, 0.0) } else { mean.p / mean.p.norm() };
        let spin = C64::from_polar(1.0, mean.longitude);
        let point = |c: C64| ComplexLanes { re: one(c.re), im: one(c.im) };
        let frame = QuaternionLanes::all(one(0.0), &mean.frame);
        let axes = fixed(&self.generator.axes, place.sine);
        let mean = generator::MeanLanes { turn: point(turn), spin: point(spin), frame, elapsed: one(0.0) };
        let change = self.generator.at(&mean, place, &axes);
        let value = |lanes: Lanes<pulp::Scalar>| lanes.values()[0];
        PeriodicChange {
            p: turn * C64::new(value(change.p.re), value(change.p.im)),
            longitude: value(change.longitude),
            momentum: value(change.momentum),
            rotation: change.rotation.map(value),
        }
    }
}

/// What is collected from the terms of one body.
#[derive(Default)]
struct Collected {
    /// The terms that are sums over time derivatives, by m and |h|.
    sums: [TermSums; 3],
    /// The terms with exact divisors.
    exact: Vec<ExactTerm>,
    /// The size of a time derivative of 1 in the kept sums together.
    amplitudes: [f64; ORDERS],
    /// Largest number of time derivatives in a sum.
    orders: usize,
    /// As in [`Corrections`], but for `squares`, the sum of the squared sizes.
    squares: f64,
    /// The sums of the squared sizes and of the mean squares of the terms with exact divisors.
    exact_squares: [f64; 2],
    dropped: f64,
    neglected: f64,
    count: usize,
}

impl Collected {
    /// Adds a term in its regime.
    fn add(
        &mut self,
        term: &Term,
        regime: &Regime,
        inertia: &Inertia,
        (regimes, disturbance): (&Regimes<'_>, &Disturbance<'_>),
    ) {
        let growth = regimes.growth(term.multiple);
        match (*regime, &disturbance.series) {
            (Regime::Exact { resonant, size, square }, Some(series)) => {
                let divisors = regimes.divisors(term).with_resonant(resonant);
                self.exact.push(ExactTerm::new(
                    term,
                    inertia,
                    (series, divisors),
                    (regimes.nothing, disturbance.unit()),
                ));
                self.squares += size * size;
                self.exact_squares[0] += size * size;
                self.exact_squares[1] += square;
                self.dropped += growth * regimes.nothing;
                self.count += 1;
            }
            (Regime::Fast { orders, truncation }, _) => {
                self.squares += term.size().powi(2);
                self.dropped += 2.0 * growth * truncation;
                self.neglected = self.neglected.max(truncation);
                self.orders = self.orders.max(orders);
                for (j, amplitude) in self.amplitudes.iter_mut().enumerate().take(orders) {
                    let of_derivative = term.size() / term.frequency.abs().powi(j as i32); // j < ORDERS
                    *amplitude += (j + 1) as f64 * of_derivative / disturbance.envelope.span[0];
                }
                self.sums[term.multiple as usize].add(term, inertia, orders); // 0 ≤ m ≤ 2
                self.count += 1;
            }
            (Regime::Negligible, _) => {
                self.squares += term.size().powi(2);
                self.dropped += growth * term.size();
                self.neglected = self.neglected.max(term.size());
            }
            (Regime::Slow | Regime::Exact { .. }, _) => {}
        }
    }

    /// The generating function, without coefficients of the time derivatives that are negligible.
    fn generator(&mut self, inertia: &Inertia, (regimes, disturbance): (&Regimes<'_>, &Disturbance<'_>)) -> Generator {
        let bounds = self.amplitudes.map(|amplitude| SMALLEST_COEFFICIENT * regimes.nothing / amplitude);
        let (orbital, cut) = disturbance.envelope.orbital.cut(&bounds[..self.orders]);
        let cut: f64 = cut.iter().zip(&self.amplitudes).map(|(cut, amplitude)| cut * amplitude).sum();
        self.dropped += 2.0 * regimes.growth(1) * cut;
        let [first, second, _] = disturbance.path.axes;
        let factors =
            TorqueScale { strength: disturbance.strength(), root: inertia.sigma.sqrt(), momentum: inertia.momentum };
        let (sums, exact) = (std::mem::take(&mut self.sums), std::mem::take(&mut self.exact));
        Generator::new(sums, exact, (orbital, [first, second]), factors)
    }
}

/// The parts of ⟨T33⟩ and of its slope that the level omits, times the mass fraction over M.
fn axial_omitted(inertia: &Inertia, disturbance: &Disturbance<'_>) -> [f64; 2] {
    let per_momentum = disturbance.orbit.disturbing_fraction() / inertia.momentum;
    let (axial, slope) = disturbance.level.omitted(inertia, 0, 0);
    [axial, slope].map(|part| part.abs() * per_momentum)
}

/// Lower estimate of the second-order change of the attitude over a time \[rad\].
fn second_order(size: f64, response: &Sensitivity, duration: f64) -> f64 {
    size * size * (1.0 + 0.1 * response.by_momentum * duration)
}
