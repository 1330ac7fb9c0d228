//! The numerical motion of a normal form: its actions, frequencies, rates and energy in the real normal variables.

use super::mode::Mode;
use super::{BirkhoffNormalForm, PhaseSpace};
use crate::error::Error;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;
use num_complex::Complex;
use std::collections::BTreeMap;

/// K and its derivatives, with numbers for the parameters.
#[derive(Debug, Clone)]
pub(crate) struct Flow {
    energy: Sum,
    gradient: Vec<Sum>,
    /// ∂K/∂Iᵢ in the actions, or a resonant term if K is not a function of the actions.
    frequencies: Result<Vec<Polynomial<f64>>, String>,
}

/// A real polynomial by harmonics of the driven phases.
#[derive(Debug, Clone)]
struct Sum {
    parts: Vec<(Vec<i64>, Polynomial<f64>)>,
}

impl Sum {
    fn new(polynomial: &Polynomial<f64>, space: &PhaseSpace) -> Self {
        let mut parts: BTreeMap<Vec<i64>, Polynomial<f64>> = BTreeMap::new();
        for (monomial, c) in polynomial.terms() {
            let part = parts.entry(space.harmonics(monomial)).or_default();
            part.add_term(monomial.without(space.driven_slots()), c);
        }
        Sum { parts: parts.into_iter().collect() }
    }

    fn evaluate(&self, normal: &[f64], phases: &[f64]) -> Result<f64, Error> {
        let mut sum = 0.0;
        for (harmonics, polynomial) in &self.parts {
            let factors = harmonics.iter().zip(phases).map(|(&j, phase)| {
                let angle = j.abs() as f64 * phase;
                if j < 0 { angle.sin() } else { angle.cos() }
            });
            sum += factors.product::<f64>() * polynomial.evaluate(normal)?;
        }
        Ok(sum)
    }
}

impl Flow {
    pub(crate) fn new<R: RealField>(normal_form: &BirkhoffNormalForm<R>, parameters: &[f64]) -> Result<Self, Error> {
        let (modes, space) = (normal_form.modes().len(), normal_form.space());
        let energy = at(normal_form.in_real()?.map(R::to_float), 2 * modes, parameters)?;
        let gradient = (0..2 * modes).map(|slot| Ok(Sum::new(&energy.derivative(slot)?, space)));
        let gradient = gradient.collect::<Result<_, Error>>()?;
        let energy = Sum::new(&energy, space);
        let frequencies = match normal_form.in_actions() {
            Ok(actions) => {
                let actions = at(actions.map(R::to_float), modes, parameters)?;
                Ok((0..modes).map(|mode| actions.derivative(mode)).collect::<Result<_, _>>()?)
            }
            Err(Error::ResonantTerm { term }) => Err(term),
            Err(other) => return Err(other),
        };
        Ok(Flow { energy, gradient, frequencies })
    }

    pub(crate) fn frequencies(&self, actions: &[f64]) -> Result<Vec<f64>, Error> {
        let map = self.frequencies.as_ref().map_err(|term| Error::ResonantTerm { term: term.clone() })?;
        map.iter().map(|frequency| frequency.evaluate(actions)).collect()
    }

    pub(crate) fn is_integrable(&self) -> bool {
        self.frequencies.is_ok()
    }

    pub(crate) fn energy(&self, normal: &[f64], phases: &[f64]) -> Result<f64, Error> {
        self.energy.evaluate(normal, phases)
    }

    pub(crate) fn rates(&self, normal: &[f64], phases: &[f64]) -> Result<Vec<f64>, Error> {
        let gradient =
            self.gradient.iter().map(|slope| slope.evaluate(normal, phases)).collect::<Result<Vec<_>, _>>()?;
        Ok(super::matrix::turned(&gradient))
    }
}

/// A polynomial with numbers substituted for the parameters, which follow the first `first` variables.
fn at(mut polynomial: Polynomial<f64>, first: usize, parameters: &[f64]) -> Result<Polynomial<f64>, Error> {
    for (slot, value) in (first..).zip(parameters) {
        polynomial = polynomial.evaluate_partial(slot, value)?;
    }
    Ok(polynomial)
}

/// The actions of real normal variables.
pub(crate) fn actions(modes: &[Mode<f64>], normal: &[f64]) -> Vec<f64> {
    let action = |(mode, kind): (usize, &Mode<f64>)| {
        let (q, p) = (normal[2 * mode], normal[2 * mode + 1]);
        match kind {
            Mode::Elliptic { ratio, .. } => (q * q / ratio + ratio * p * p) / 2.0,
            Mode::Hyperbolic { .. } => q * p,
            Mode::Complex { frequency, partner, .. } => {
                let (other, other_p) = (normal[2 * partner], normal[2 * partner + 1]);
                if *frequency > 0.0 { q * p + other * other_p } else { other * p - q * other_p }
            }
        }
    };
    modes.iter().enumerate().map(action).collect()
}

/// Real normal variables after a time; each mode moves with its frequency.
pub(crate) fn advanced(modes: &[Mode<f64>], normal: &[f64], frequencies: &[f64], time: f64) -> Vec<f64> {
    let mut moved = normal.to_vec();
    for (mode, kind) in modes.iter().enumerate() {
        let (q, p) = (2 * mode, 2 * mode + 1);
        match kind {
            Mode::Elliptic { ratio, .. } => {
                let turned = Complex::new(ratio * normal[p], normal[q]) * Complex::cis(frequencies[mode] * time);
                (moved[q], moved[p]) = (turned.im, turned.re / ratio);
            }
            Mode::Hyperbolic { .. } => {
                let growth = (frequencies[mode] * time).exp();
                (moved[q], moved[p]) = (normal[q] * growth, normal[p] / growth);
            }
            Mode::Complex { frequency, partner, .. } if *frequency > 0.0 => {
                let growth = (frequencies[mode] * time).exp();
                let turn = Complex::cis(frequencies[*partner] * time);
                let pair = |first: usize, second: usize| Complex::new(normal[first], normal[second]) * turn;
                let (place, momentum) = (pair(q, 2 * partner) * growth, pair(p, 2 * partner + 1) / growth);
                (moved[q], moved[2 * partner]) = (place.re, place.im);
                (moved[p], moved[2 * partner + 1]) = (momentum.re, momentum.im);
            }
            Mode::Complex { .. } => {}
        }
    }
    moved
}

/// The complex variables u₁, U₁, u₂, … from the real normal variables.
pub(crate) fn complex_point(modes: &[Mode<f64>], normal: &[f64]) -> Vec<Complex<f64>> {
    let pair = |(mode, kind): (usize, &Mode<f64>)| {
        let (q, p) = (normal[2 * mode], normal[2 * mode + 1]);
        match kind {
            Mode::Elliptic { ratio, .. } => [Complex::new(q, ratio * p) / (2.0 * ratio), Complex::new(ratio * p, q)],
            Mode::Hyperbolic { .. } => [q.into(), p.into()],
            Mode::Complex { frequency, partner, .. } => {
                let (other, other_p) = (normal[2 * partner], normal[2 * partner + 1]);
                if *frequency > 0.0 {
                    [Complex::new(q, -other) / 2.0, Complex::new(p, other_p)]
                } else {
                    [Complex::new(other, q) / 2.0, Complex::new(other_p, -p)]
                }
            }
        }
    };
    modes.iter().enumerate().flat_map(pair).collect()
}

/// Real normal variables from the complex ones. Those of a centre follow from U, those of a quartet from its first mode.
pub(crate) fn real_point(modes: &[Mode<f64>], values: &[Complex<f64>]) -> Vec<f64> {
    let mut normal = vec![0.0; values.len()];
    for (mode, kind) in modes.iter().enumerate() {
        let (q, p) = (2 * mode, 2 * mode + 1);
        let (u, momentum) = (values[q], values[p]);
        match kind {
            Mode::Elliptic { ratio, .. } => (normal[q], normal[p]) = (momentum.im, momentum.re / ratio),
            Mode::Hyperbolic { .. } => (normal[q], normal[p]) = (u.re, momentum.re),
            Mode::Complex { frequency, partner, .. } if *frequency > 0.0 => {
                (normal[q], normal[2 * partner]) = (2.0 * u.re, -2.0 * u.im);
                (normal[p], normal[2 * partner + 1]) = (momentum.re, momentum.im);
            }
            Mode::Complex { .. } => {}
        }
    }
    normal
}
