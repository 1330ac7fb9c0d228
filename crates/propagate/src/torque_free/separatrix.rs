//! Motion near the separatrix and on it, from the theta functions of the closed form in the conjugate nome (theory §10).
//!
//! This is Jacobi's imaginary transformation of the closed form. The angle is ℓ″ = ℓ′ − π/2 with |ℓ″| ≤ π/2; at ℓ″ = 0 the axis is nearest to the angular
//! momentum. With f = ℓ″/π, u = 2K f, p = e^(−πK/(2K′)), ξ = πu/(4K′) and ζ0 = πη/(4K′):
//!
//! ```text
//! a ∝ Σ p^(n²+n) cos (2n+1)(ζ0 + iξ)        b ∝ iρ Σ (−1)^n p^(n²+n) sin (2n+1)(ζ0 + iξ)        half phase: y′/2 + πηf/(2K′)
//! ```
//!
//! A passage from one rotation about the middle axis to the opposite one is described by cosh and sinh. The terms with p, which is 2.4e-6 at k′ = 1e-5, correct
//! it at its ends. On the separatrix K is infinite, p = 0, ξ is linear in time and unbounded, and dy′/dt = M/B. The sums are scaled by e^(−|ξ|), so their n-th
//! terms are at most of size p^(n²). Each step ℓ″ → ℓ″ + π changes the sign of b.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

use andoyer_double::DoubleDouble;
use nalgebra::Quaternion;

use super::polhode::{Polhode, UserFrame};
use crate::numerics::phase::Phase;
use crate::numerics::theta::{Theta, precise_argument};

/// A motion near or on the separatrix, evaluated for one time after another.
#[derive(Clone, Debug)]
pub(crate) struct Passage {
    pub(crate) passage: PassageTheta,
    pub(crate) half_longitude: Phase,
    pub(crate) place: UserFrame,
}

impl Passage {
    /// Attitude and rates at the time `elapsed` after the epoch.
    pub(crate) fn evaluate(&self, elapsed: (f64, f64)) -> ([f64; 4], [f64; 3]) {
        let (a, b, lead) = self.passage.evaluate(elapsed);
        let scale = 1.0 / (a[0] * a[0] + a[1] * a[1] + b[0] * b[0] + b[1] * b[1]).sqrt();
        let (a, b) = (a.map(|c| c * scale), b.map(|c| c * scale));
        // y cancels in b ā (theory §8).
        let direction = [
            2.0 * (b[0] * a[1] - b[1] * a[0]),
            2.0 * (b[0] * a[0] + b[1] * a[1]),
            a[0] * a[0] + a[1] * a[1] - b[0] * b[0] - b[1] * b[1],
        ];
        let UserFrame { inertial, frame, rates } = &self.place;
        let rates = frame.user(std::array::from_fn(|i| rates[i] * direction[i]));
        let (sine, cosine) = (self.half_longitude.angle(elapsed) + lead).sin_cos();
        let relative = Quaternion::new(
            a[0] * cosine - a[1] * sine,
            b[0] * cosine - b[1] * sine,
            b[0] * sine + b[1] * cosine,
            a[0] * sine + a[1] * cosine,
        );
        let attitude = inertial.into_inner() * relative * frame.quaternion.into_inner();
        (attitude.coords.into(), rates)
    }
}

/// Number of terms, n = 0, 1, 2. At k′ = 1e-5, p^(n²) is 3e-23 for n = 2.
const TERMS: i32 = 3;

/// |ξ| beyond which e^(−2|ξ|) is negligible.
const FARTHEST: f64 = 1e4;

/// The relation between the time and the position on the polhode.
///
/// Near the middle axis u is tens of radians, or hundreds at 1 − m = 1e-290, but the passage takes only a few. Therefore u at the epoch and its origin are
/// subtracted in double-double, before the result is rounded to a double.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Clock {
    /// The phase 2ℓ″, the number of turns of this phase at which b has its original sign, and ξ for each radian of 2ℓ″. b changes its sign with each turn.
    Repeating(Phase, f64, f64),
    /// On the separatrix itself: ξ at the epoch, and its rate.
    Once(DoubleDouble, DoubleDouble),
}

impl Clock {
    /// The clock near the separatrix, from the rate of ℓ″, the place u and the quarter period K of [`PassageTheta::place`], and K′.
    pub(crate) fn repeating(
        anomaly_rate: DoubleDouble,
        place: DoubleDouble,
        quarter: DoubleDouble,
        conjugate: f64,
    ) -> Self {
        let start = DoubleDouble::PI * (place / quarter);
        let phase = Phase::new(anomaly_rate.times_double(2.0), start);
        let (turns, angle) = phase.turns_and_angle_at((0.0, 0.0));
        let none = turns - ((start.to_f64() - angle) / TAU).round();
        Self::Repeating(phase, none, 0.25 * quarter.to_f64() / conjugate)
    }
}

/// The theta functions of one polhode.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PassageTheta {
    clock: Clock,
    /// The half phase for each radian of ℓ″: η/(2K′).
    lead: f64,
    /// ζ0.
    offset: f64,
    /// ρ.
    ratio: f64,
    /// p.
    nome: f64,
}

impl PassageTheta {
    /// The passage of a polhode; `clock` comes from [`PassageTheta::place`].
    pub(crate) fn new(theta: &Theta, clock: Clock) -> Self {
        let offset = FRAC_PI_4 * theta.eta / theta.conjugate;
        let nome = (-FRAC_PI_2 * theta.quarter / theta.conjugate).exp();
        let (mut cosines, mut sines) = (0.0, 0.0);
        for n in (0..TERMS).rev() {
            let weight = nome.powi(n * n + n);
            let (sine, cosine) = (f64::from(2 * n + 1) * offset).sin_cos();
            cosines += weight * cosine;
            sines += if n % 2 == 0 { weight * sine } else { -weight * sine };
        }
        let lead = 0.5 * theta.eta / theta.conjugate;
        Self { clock, lead, offset, ratio: theta.half_tangents[1] * cosines / sines, nome }
    }

    /// u of the state, K, and whether b changes its sign. u = 0 is the place where the axis is nearest to the angular momentum.
    pub(crate) fn place(polhode: &Polhode) -> (DoubleDouble, DoubleDouble, bool) {
        let (position, [cosine_sign, sine_sign]) = polhode.quadrant();
        let (quarter, distance) = precise_argument(polhode.invariants.cosine_squares, position);
        // The values of ℓ from −π/2 to 0 correspond to ℓ′ → ℓ′ + π.
        (distance.times_double(-cosine_sign * sine_sign), quarter, sine_sign < 0.0)
    }

    /// The same passage, with the sign of b changed if `over` is true.
    #[must_use]
    pub(crate) fn turned(self, over: bool) -> Self {
        Self { ratio: if over { -self.ratio } else { self.ratio }, ..self }
    }

    /// arg a plus the added half phase, at the time `elapsed` after the epoch \[rad\].
    pub(crate) fn phase(&self, elapsed: (f64, f64)) -> f64 {
        let (a, _, lead) = self.evaluate(elapsed);
        a[1].atan2(a[0]) + lead
    }

    /// 2ℓ″ at the time `elapsed` after the epoch, between −π and π; 0 on the separatrix itself \[rad\].
    pub(crate) fn angle(&self, elapsed: (f64, f64)) -> f64 {
        match self.clock {
            Clock::Once(..) => 0.0,
            Clock::Repeating(phase, ..) => phase.angle(elapsed),
        }
    }

    /// a and b up to a common factor, and the half phase to add, at the time `elapsed` after the epoch.
    pub(crate) fn evaluate(&self, elapsed: (f64, f64)) -> ([f64; 2], [f64; 2], f64) {
        let (xi, lead, turned) = match self.clock {
            Clock::Once(start, rate) => {
                let far = start.high + rate.high * elapsed.0;
                let near = || start + rate * DoubleDouble { high: elapsed.0, low: elapsed.1 };
                (if far.abs() < FARTHEST { near().to_f64() } else { far }, 0.0, false)
            }
            Clock::Repeating(phase, none, scale) => {
                let (turns, angle) = phase.turns_and_angle_at(elapsed);
                (scale * angle, 0.5 * self.lead * angle, (turns - none) % 2.0 != 0.0)
            }
        };
        let [a, b] = self.theta(xi);
        (a, if turned { b.map(|c| -c) } else { b }, lead)
    }

    /// The two sums at ξ, times 2e^(−|ξ|).
    fn theta(&self, xi: f64) -> [[f64; 2]; 2] {
        let decay = (-2.0 * xi.abs()).exp();
        let growth = if self.nome == 0.0 { 0.0 } else { (self.nome / decay).min(1.0) };
        let (mut a, mut b) = ([0.0; 2], [0.0; 2]);
        for n in 0..TERMS {
            let rising = growth.powi(n) * self.nome.powi(n * n);
            let falling = decay.powi(n + 1) * self.nome.powi(n * n + n);
            let (cosh, sinh) = (rising + falling, (rising - falling).copysign(xi));
            let (sine, cosine) = (f64::from(2 * n + 1) * self.offset).sin_cos();
            let ratio = if n % 2 == 0 { self.ratio } else { -self.ratio };
            a = [a[0] + cosine * cosh, a[1] - sine * sinh];
            b = [b[0] - ratio * cosine * sinh, b[1] + ratio * sine * cosh];
        }
        [a, b]
    }
}
