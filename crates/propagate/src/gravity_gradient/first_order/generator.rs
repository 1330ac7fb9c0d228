//! The generating function W of the gravity gradient and its derivatives at one place of the orbit, arranged for fast evaluation.
//!
//! The sum for G is Σ (i/Ω)^j d^j/dt^j g, up to the factor −i/Ω. The time derivatives of (a/r)³, (a/r)³ cos 2f and (a/r)³ sin 2f are powers of
//! 1 + e cos f times Fourier polynomials in f, which all terms share. After contraction with r̂r̂ for one m, each term needs only real multiples of them, since
//! T33, i t1 e^(−iy′) and t2 e^(−2iy′) have real coefficients (time reversal). |p| = √σ is a constant of the mean motion and is included in the coefficients.
//! The derivatives with respect to p and p̄ are ∂/∂p e^(iℓ′) and ∂/∂p̄ e^(−iℓ′), which are regular at p = 0. W is real. In axes 1 and
//! 2 of the frame turned by y′ about k the factor e^(imy′) is 1, so only the real or the imaginary part of each sum is computed.

use nalgebra::Vector3;

use super::fourier::{ExactTerm, ExactTerms};
use super::sums::{GeneratorSlopes, TermSums};
use crate::gravity_gradient::inertia::HIGHEST;
use crate::orbit::derivatives::{AnomalyPowers, Orbital};
use crate::orbit::kepler::Place;
use crate::orbit::position::Axes;
use crate::orbit::tensor::{deviator_of, products};
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::simd::unit_powers::UnitPowers;

/// The powers of e^(iℓ′). Most scenes do with few.
type Turns<S> = UnitPowers<S, 7, { HIGHEST + 1 }>;

/// The terms by m, the Fourier polynomials, and the plane of the orbit.
#[derive(Clone, Debug)]
pub(crate) struct Generator {
    sums: [TermSums; 3],
    /// Terms that the sums over time derivatives do not serve.
    pub(crate) exact: Vec<ExactTerm>,
    orbital: Orbital,
    /// Largest |h| of all terms.
    highest: usize,
    /// Unit vectors to the pericentre and perpendicular to it at the epoch, in inertial components.
    pub(crate) axes: [Vector3<f64>; 2],
    factors: TorqueScale,
}

/// Factors of the torque's terms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TorqueScale {
    /// Γ.
    pub(crate) strength: f64,
    /// √σ.
    pub(crate) root: f64,
    /// M.
    pub(crate) momentum: f64,
}

/// The mean motion at some times: cosine and sine of ℓ′ and of y′, the invariable frame, and the time since the epoch.
#[derive(Clone, Copy)]
pub(crate) struct MeanLanes<S: InstructionSet> {
    pub(crate) turn: ComplexLanes<S>,
    pub(crate) spin: ComplexLanes<S>,
    pub(crate) frame: QuaternionLanes<S>,
    pub(crate) elapsed: Lanes<S>,
}

/// First-order changes of the mean motion. For p it is the change times e^(−iℓ′); `rotation` is about axes 1 and 2 of the frame.
#[derive(Clone, Copy)]
pub(crate) struct Correction<S: InstructionSet> {
    pub(crate) p: ComplexLanes<S>,
    pub(crate) longitude: Lanes<S>,
    pub(crate) momentum: Lanes<S>,
    pub(crate) rotation: [Lanes<S>; 2],
}

impl<S: InstructionSet> Correction<S> {
    /// The sum of two changes.
    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            p: self.p + other.p,
            longitude: self.longitude + other.longitude,
            momentum: self.momentum + other.momentum,
            rotation: [self.rotation[0] + other.rotation[0], self.rotation[1] + other.rotation[1]],
        }
    }
}

impl Generator {
    /// From the terms by m, those with exact divisors, the Fourier polynomials, and the axes of the orbit at the epoch.
    pub(crate) fn new(
        sums: [TermSums; 3],
        exact: Vec<ExactTerm>,
        (orbital, axes): (Orbital, [Vector3<f64>; 2]),
        factors: TorqueScale,
    ) -> Self {
        let highest = sums.iter().map(TermSums::highest).chain(exact.iter().map(ExactTerm::degree)).max().unwrap_or(0);
        Self { sums, exact, orbital, highest, axes, factors }
    }

    /// The changes from mean to osculating variables, for |p| = √σ and an ellipse with these axes.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(&self, mean: &MeanLanes<S>, place: &Place<S>, axes: &Axes<S>) -> Correction<S> {
        let none = place.sine.all(0.0);
        let (products, node) = products(mean.frame, axes, mean.spin);
        let mut room = Turns::new(mean.turn);
        let turns = room.of(mean.turn, self.highest + 1);
        let mut sums =
            GeneratorSlopes { by_p: [none; 2], by_longitude: none, by_momentum: none, by_rotation: [none; 2] };
        if self.orbital.node_rate == 0.0 {
            let mut places = AnomalyPowers::new(place.turn());
            let circle = places.of(place.turn(), self.orbital.multiples());
            let [mut power, growth] = self.orbital.powers(place.cosine);
            for j in 0..self.orbital.orders() {
                let tensor = deviator_of(self.orbital.derivative(j, circle, power), &products);
                power = power * growth;
                sums.add_all(&self.sums, turns, j, &tensor);
            }
        } else {
            let tensors = self.orbital.tensors(&products, node, place);
            for (j, tensor) in tensors.iter().enumerate().take(self.orbital.orders()) {
                sums.add_all(&self.sums, turns, j, tensor);
            }
        }
        if !self.exact.is_empty() {
            let terms =
                ExactTerms { terms: &self.exact, turns, products: &products, place, elapsed: mean.elapsed, sums };
            sums = none.simd().vectorize(terms);
        }
        self.change(&sums, mean.spin)
    }

    #[inline(always)]
    fn change<S: InstructionSet>(&self, sums: &GeneratorSlopes<S>, spin: ComplexLanes<S>) -> Correction<S> {
        let all = |value: f64| sums.by_longitude.all(value);
        // Each sum is half of a term plus its conjugate.
        let momentum = sums.by_longitude * all(2.0 * self.factors.strength);
        let relative = all(2.0 * self.factors.strength / self.factors.momentum);
        let half = all(0.5) * relative;
        let [by_p, across] = sums.by_p;
        let real = momentum.negate_mul_add(all(0.5 * self.factors.root / self.factors.momentum), -(across * half));
        let circling = by_p.negate_mul_add(all(0.5 * self.factors.root), -sums.by_momentum);
        // Back from the axes that are turned by y′.
        let [first, second] = sums.by_rotation;
        let x = spin.im.negate_mul_add(second, spin.re * first);
        let y = spin.im.mul_add(first, spin.re * second);
        Correction {
            p: ComplexLanes { re: real, im: by_p * half },
            longitude: relative * circling,
            momentum,
            // k × δ(Mk)/M turns k and the frame.
            rotation: [relative * y, -(relative * x)],
        }
    }
}
