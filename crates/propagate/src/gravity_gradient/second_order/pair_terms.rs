//! The terms of the sum over pairs at one state: their amplitudes, those of the generating function, and the bracket of two.

use crate::gravity_gradient::disturbance::Disturbance;
use crate::gravity_gradient::first_order::mean_variables::Mean;
use crate::gravity_gradient::inertia::Inertia;
use crate::gravity_gradient::terms::term::Term;
use crate::numerics::C64;
use crate::orbit::derivatives::ORDERS;
use crate::orbit::kepler::Place;
use crate::orbit::tensor::{Deviator, products_at};
use crate::torque::{Contraction, contraction};

/// The state at which the sum is taken.
#[derive(Clone, Copy)]
pub(crate) struct SecondOrderState<'a> {
    pub(crate) inertia: &'a Inertia,
    pub(crate) mean: &'a Mean,
    pub(crate) disturbance: &'a Disturbance<'a>,
    /// Mean anomaly of the disturbing body at the epoch \[rad\].
    pub(crate) anomaly: f64,
    /// The traceless part of (a/r)³ r̂r̂ in the frame, and its time derivatives.
    pub(crate) tensors: [Deviator<pulp::Scalar>; ORDERS],
}

/// The traceless part of (a/r)³ r̂r̂ in the frame of a mean state, and its time derivatives, as a function of the place of the disturbing body.
pub(crate) fn tensors(
    mean: &Mean,
    disturbance: &Disturbance<'_>,
) -> impl Fn(&Place<pulp::Scalar>) -> [Deviator<pulp::Scalar>; ORDERS] + use<> {
    let (products, node) = products_at(&mean.frame, disturbance.orbit.axes());
    let orbital = disturbance.envelope.orbital.clone();
    move |place| orbital.tensors(&products, node, place)
}

/// A contraction and its derivative with respect to Ω.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ContractedPart {
    pub(crate) value: Contraction,
    pub(crate) slope: C64,
}

impl ContractedPart {
    /// Adds a part of D with its divisor, as one of W.
    pub(crate) fn add(&mut self, torque: Contraction, reciprocal: f64) {
        let inverse = C64::new(0.0, -reciprocal);
        for (w, part) in self.value.iter_mut().zip(torque) {
            *w += part * inverse;
        }
        self.slope -= torque[0] * inverse * reciprocal;
    }
}

impl From<Contraction> for ContractedPart {
    /// A contraction that does not depend on Ω.
    fn from(value: Contraction) -> Self {
        Self { value, slope: C64::default() }
    }
}

/// One term, one harmonic of the orbit in a term, or ⟨D⟩.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PairTerm {
    pub(crate) harmonic: f64,
    pub(crate) multiple: f64,
    /// Relative size.
    pub(crate) size: f64,
    /// Ω and its derivatives with respect to σ and M. For a harmonic of the orbit the divisor, which may have the shift by the average torque.
    pub(crate) frequency: [f64; 3],
    /// Ω + jn of a harmonic of the orbit.
    pub(crate) unshifted: f64,
    /// Γ e^(i(hℓ′+my′)), and −i for m = 1.
    pub(crate) weight: C64,
    /// F, √σ dF/dσ, and h F/√σ.
    pub(crate) amplitude: [f64; 3],
    /// D and dD/dt.
    pub(crate) torque: [ContractedPart; 2],
    /// W and dW/dt.
    pub(crate) generator: [ContractedPart; 2],
    /// Whether it is one harmonic of the orbit, which has no other time dependence than its frequency.
    pub(crate) single: bool,
    /// Whether its divisors have the shift by the average torque.
    pub(crate) shifted: bool,
}

impl<'a> SecondOrderState<'a> {
    /// A mean state of first order with the disturbing body at its place at the epoch.
    pub(crate) fn new(
        inertia: &'a Inertia,
        mean: &'a Mean,
        place: &Place<pulp::Scalar>,
        disturbance: &'a Disturbance<'a>,
    ) -> Self {
        let anomaly = place.angle.values()[0] - place.centre.values()[0];
        Self { inertia, mean, disturbance, anomaly, tensors: tensors(mean, disturbance)(place) }
    }

    /// The bracket of a part of one term with a part of another, with the phases.
    pub(crate) fn bracket(&self, a: &PairTerm, a_part: &ContractedPart, b: &PairTerm, b_part: &ContractedPart) -> C64 {
        let (momentum, sigma) = (self.mean.momentum, self.inertia.sigma);
        let ([x, x1, x2], [z, z1, z2]) = (a_part.value, b_part.value);
        // The derivative (h − mσ)/M ∂/∂σ + m ∂/∂M, with the factor that b's or a's amplitude gives.
        let along = |row: &PairTerm, other: &PairTerm, value: C64, slope: C64| {
            let [whole, _, lowered] = row.amplitude;
            let [_, by_sigma, by_momentum] = other.frequency;
            let turned = (lowered - row.multiple * sigma.sqrt() * whole) * other.amplitude[1] / momentum;
            let shift = (row.harmonic - row.multiple * sigma) / momentum * by_sigma + row.multiple * by_momentum;
            value * turned + slope * (whole * other.amplitude[0] * shift)
        };
        let forth = x * along(a, b, z, b_part.slope);
        let back = z * along(b, a, x, a_part.slope);
        let turning = (x1 * z2 - x2 * z1) * (a.amplitude[0] * b.amplitude[0] / momentum);
        a.weight * b.weight * (C64::i() * (forth - back) + turning)
    }
}

impl PairTerm {
    /// A term by the sums over time derivatives.
    pub(crate) fn new(state: &SecondOrderState<'_>, term: &Term) -> Self {
        let contracted = state.tensors.map(|tensor| contraction(&tensor, term.multiple));
        let omega = term.frequency;
        let orders = orders(omega, &state.disturbance.envelope.epoch);
        let generator =
            [generated(&contracted[..orders], omega), generated(&contracted[1..ORDERS.min(orders + 1)], omega)];
        Self { torque: [contracted[0].into(), contracted[1].into()], generator, ..Self::of(state, term) }
    }

    /// Whether both have the same h and m.
    pub(crate) fn is(&self, other: &Self) -> bool {
        (self.harmonic, self.multiple) == (other.harmonic, other.multiple)
    }

    /// Adds a harmonic of frequency jn with its divisor.
    pub(crate) fn add(&mut self, mut torque: Contraction, step: f64, reciprocal: f64) {
        for (d, w) in self.torque.iter_mut().zip(&mut self.generator) {
            for (d, part) in d.value.iter_mut().zip(torque) {
                *d += part;
            }
            w.add(torque, reciprocal);
            torque = torque.map(|part| part * C64::new(0.0, step));
        }
    }

    /// c_m of Ξ by the sum over time derivatives, and the size of the first omitted part.
    pub(crate) fn solution(&self, state: &SecondOrderState<'_>, multiple: i32) -> (C64, f64) {
        let (omega, sizes) = (self.frequency[0], &state.disturbance.envelope.epoch);
        let contracted = state.tensors.map(|tensor| contraction(&tensor, multiple));
        let orders = orders(omega, sizes);
        (generated(&contracted[..orders], omega).value[0], sizes[orders] / omega.abs().powi(orders as i32 + 1)) // orders ≤ ORDERS
    }

    /// The number of derivatives for a sum around the orbit.
    pub(crate) fn orders_around(&self, state: &SecondOrderState<'_>) -> usize {
        orders(self.frequency[0], &state.disturbance.envelope.orbital.norms)
    }

    /// D and W of the term with the disturbing body at another place, from the contractions of the tensor and its derivatives there. The harmonics `near` are
    /// terms of their own and are subtracted; `elapsed` is the time from the place of their amplitudes. dD/dt and dW/dt are not computed.
    pub(crate) fn elsewhere(&self, contracted: &[Contraction], near: &[Self], elapsed: f64) -> Self {
        let omega = self.frequency[0];
        let mut contracted = contracted.to_vec();
        for harmonic in near {
            let rate = harmonic.unshifted - omega;
            let mut turn = C64::from_polar(1.0, rate * elapsed);
            for values in &mut contracted {
                for (value, part) in values.iter_mut().zip(harmonic.torque[0].value) {
                    *value -= part * turn;
                }
                turn *= C64::new(0.0, rate);
            }
        }
        let torque = [contracted[0].into(), ContractedPart::default()];
        Self { torque, generator: [generated(&contracted, omega), ContractedPart::default()], ..*self }
    }

    /// A term whose D and W are 0.
    pub(crate) fn of(state: &SecondOrderState<'_>, term: &Term) -> Self {
        let (h, m) = (f64::from(term.harmonic), f64::from(term.multiple));
        let mean = state.mean;
        let [nu, slope, _] = term.per_momentum;
        let angle = if mean.p == C64::default() { 0.0 } else { mean.p.arg() };
        let phase = C64::from_polar(state.disturbance.strength(), h * angle + m * mean.longitude);
        Self {
            harmonic: h,
            multiple: m,
            size: term.relative_size(state.inertia.root()),
            frequency: [mean.momentum * nu, mean.momentum * slope, nu],
            weight: if term.multiple == 1 { phase * -C64::i() } else { phase },
            amplitude: amplitude(term.harmonic, term.weighted(), state.inertia.sigma),
            ..Self::default()
        }
    }

    /// 2⟨D⟩. The source of a pair with ⟨D⟩ is [⟨D⟩, W_b], without the factor ½ of R_ab = ½ [D_a, W_b].
    pub(crate) fn average(state: &SecondOrderState<'_>) -> Self {
        let function = Term::average(state.inertia);
        Self {
            size: 1.0,
            weight: (2.0 * state.disturbance.strength()).into(),
            amplitude: amplitude(0, function, state.inertia.sigma),
            torque: [0, 1].map(|j| contraction(&state.tensors[j], 0).into()),
            ..Self::default()
        }
    }

    pub(crate) fn conjugate(&self) -> Self {
        let conjugated = |part: &ContractedPart, sign: f64| ContractedPart {
            value: part.value.map(|c| c.conj()),
            slope: part.slope.conj() * sign,
        };
        let [whole, slope, lowered] = self.amplitude;
        Self {
            harmonic: -self.harmonic,
            multiple: -self.multiple,
            frequency: self.frequency.map(|part| -part),
            weight: self.weight.conj(),
            amplitude: [whole, slope, -lowered],
            torque: self.torque.each_ref().map(|part| conjugated(part, 1.0)),
            // Ω has the other sign.
            generator: self.generator.each_ref().map(|part| conjugated(part, -1.0)),
            ..*self
        }
    }
}

/// F, √σ dF/dσ and h F/√σ, regular at σ = 0.
fn amplitude(harmonic: i32, [value, slope, _]: [f64; 3], sigma: f64) -> [f64; 3] {
    let root = sigma.sqrt();
    let degree = harmonic.abs();
    let lowered = if degree == 0 { 0.0 } else { root.powi(degree - 1) * value };
    let whole = root.powi(degree) * value;
    [whole, root.powi(degree + 1) * slope + 0.5 * f64::from(degree) * lowered, f64::from(harmonic) * lowered]
}

/// Ξ with dΞ/dt + iΩΞ = Θ, from the contractions of Θ and its time derivatives.
fn generated(contracted: &[Contraction], omega: f64) -> ContractedPart {
    let inverse = (C64::i() * omega).inv();
    let mut part = ContractedPart::default();
    // (−1)^j/(iΩ)^(j+1).
    let mut factor = inverse;
    for (j, values) in contracted.iter().enumerate() {
        for (sum, value) in part.value.iter_mut().zip(values) {
            *sum += factor * value;
        }
        part.slope += factor * inverse * -C64::i() * (j as f64 + 1.0) * values[0];
        factor *= -inverse;
    }
    part
}

/// The number of derivatives that minimizes the first omitted term, from the sizes of the derivatives.
fn orders(omega: f64, sizes: &[f64]) -> usize {
    let left = |orders: usize| sizes[orders] / omega.abs().powi(orders as i32); // orders ≤ ORDERS
    (1..=ORDERS).min_by(|&a, &b| left(a).total_cmp(&left(b))).unwrap_or(1)
}
