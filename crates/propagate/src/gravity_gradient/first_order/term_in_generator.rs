//! A term in the generating function, as a sum over time derivatives or with exact divisors.

use super::fourier::ExactTerm;
use super::sums::Harmonic;
use crate::gravity_gradient::body::inertia::Inertia;
use crate::gravity_gradient::orbit::hansen::OrbitSeries;
use crate::gravity_gradient::terms::divisors::Divisors;
use crate::gravity_gradient::terms::term::{SizedTerm, Term};

impl SizedTerm {
    /// The factors of G and of −Ω ∂G/∂Ω in W, M ∂W/∂M, ∂W/∂p̄ + ∂W/∂p and ∂W/∂p̄ − ∂W/∂p.
    fn factors(&self, inertia: &Inertia) -> [[f64; 4]; 2] {
        let Self {
            term: Term { harmonic, function: [value, slope, _], frequency: [_, by_sigma, _], .. },
            frequency,
            ..
        } = *self;
        let by_sigma = inertia.momentum * by_sigma;
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
    pub(crate) fn exact(&self, inertia: &Inertia, orbit: (&OrbitSeries, Divisors), nothing: f64) -> ExactTerm {
        let negligible = 0.1 * nothing / self.size();
        ExactTerm::new((self.term.harmonic, self.term.multiple), self.factors(inertia), orbit, negligible)
    }

    /// Adds this term to the other terms of its |h|, with `orders` derivatives of g.
    pub(crate) fn join(&self, harmonics: &mut Vec<Harmonic>, inertia: &Inertia, orders: usize) {
        let Self { term: Term { harmonic, .. }, frequency, .. } = *self;
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
