//! The rows of the averaged equations: five polynomials in g for each harmonic of a torque (weak torques (4)), and their dot products with means over the polhode.

use std::collections::BTreeMap;

use andoyer_series::{Monomial, Polynomial};
use nalgebra::{Matrix3, Vector3};

use super::harmonic::{Form, harmonic_parts};
use super::polhode_means::{EvenMonomial, ModeFamily};
use crate::error::{Error, torque_refused};
use crate::input::torque::PolynomialTorque;

/// A torque of one source on sorted axes: three polynomials in the direction, slots 0 to 2, and the rates, slots 3 to 5.
pub(super) struct SortedTorque {
    /// Index among the sources of the torque; `None` without a direction.
    pub(super) source: Option<usize>,
    pub(super) components: [Form; 3],
}

/// The terms of three components: coefficients with the powers of direction and rates.
pub(super) type TorqueTerms = [Vec<(f64, [i32; 6])>; 3];

/// The torque of these terms.
pub(super) fn evaluated(terms: &TorqueTerms, u: &Vector3<f64>, rates: &Vector3<f64>) -> Vector3<f64> {
    let component = |terms: &Vec<(f64, [i32; 6])>| -> f64 {
        let factor =
            |powers: &[i32; 6]| (0..3).map(|i| u[i].powi(powers[i]) * rates[i].powi(powers[3 + i])).product::<f64>();
        terms.iter().map(|(coefficient, powers)| coefficient * factor(powers)).sum()
    };
    let [first, second, third] = terms;
    Vector3::new(component(first), component(second), component(third))
}

impl SortedTorque {
    /// The terms, for evaluation.
    pub(super) fn terms(&self) -> TorqueTerms {
        self.components.each_ref().map(|form| {
            let term =
                |(monomial, c): (Monomial, &f64)| (*c, std::array::from_fn(|slot| monomial.exponent(slot) as i32));
            form.terms().map(term).collect()
        })
    }

    /// A torque without a direction: `constant` + `linear`·ω, in sorted components.
    pub(super) fn of_rates(constant: &Vector3<f64>, linear: &Matrix3<f64>) -> Result<Self, Error> {
        let component = |row: usize| {
            let mut form = Form::constant(constant[row]);
            for column in 0..3 {
                form += &Form::variable(3 + column)?.scale(&linear[(row, column)]);
            }
            Ok::<_, Error>(form)
        };
        Ok(Self { source: None, components: [component(0)?, component(1)?, component(2)?] })
    }

    /// The gravity gradient 3 r̂ × I r̂ of a body whose G m/r³ is 1.
    pub(super) fn gravity(moments: &Vector3<f64>) -> Result<Self, Error> {
        let component = |axis: usize| {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            let product = Form::variable(next)?.multiply(&Form::variable(last)?)?;
            Ok::<_, Error>(product.scale(&(3.0 * (moments[last] - moments[next]))))
        };
        Ok(Self { source: Some(0), components: [component(0)?, component(1)?, component(2)?] })
    }

    /// The parts of a polynomial torque, one for each source: of a term the one whose direction it has, or whose distance multiplies the torque. `sort` takes components about the
    /// axes of the scene to sorted ones.
    ///
    /// # Errors
    /// - [`Error::Torque`] for a term with two such sources, which no average over one circle has.
    pub(super) fn of_polynomial(torque: &PolynomialTorque, sort: &Matrix3<f64>) -> Result<Vec<Self>, Error> {
        let text = torque.turn() * sort.transpose();
        // (r₀/r)^p multiplies every term, those without a direction too.
        let weighs: Vec<bool> = torque.sources().iter().map(|source| source.distance_power().0 != 0.0).collect();
        let mut parts: BTreeMap<Option<usize>, [Form; 3]> = BTreeMap::new();
        for (axis, terms) in torque.terms().iter().enumerate() {
            for (coefficient, exponents) in terms {
                let (directions, rates) = exponents.split_at(exponents.len() - 3);
                let used: Vec<usize> = (0..directions.len() / 3)
                    .filter(|&source| weighs[source] || directions[3 * source..][..3].iter().any(|power| *power > 0))
                    .collect();
                let (source, powers) = match used[..] {
                    [] => (None, [0; 3]),
                    [source] => (Some(source), [0, 1, 2].map(|k| directions[3 * source + k])),
                    _ => {
                        let bound = "averaged with the direction or the distance of one source in each term; average the product yourself, or integrate";
                        return Err(torque_refused("texts", &torque.texts()[axis], bound));
                    }
                };
                let monomial = Monomial::new(&[&powers[..], rates].concat())?;
                let forms = parts.entry(source).or_insert_with(|| [Form::zero(), Form::zero(), Form::zero()]);
                forms[axis].add_term(monomial, coefficient);
            }
        }
        let turned = |(source, forms): (Option<usize>, [Form; 3])| {
            Ok::<_, Error>(Self { source, components: turned(&forms, &text)? })
        };
        parts.into_iter().map(turned).collect()
    }
}

/// Lᵀ P(L u, L ω).
fn turned(forms: &[Form; 3], matrix: &Matrix3<f64>) -> Result<[Form; 3], Error> {
    let mut replaced = Vec::with_capacity(6);
    for slot in 0..6 {
        let mut sum = Form::zero();
        for column in 0..3 {
            sum += &Form::variable(slot / 3 * 3 + column)?.scale(&matrix[(slot % 3, column)]);
        }
        replaced.push(sum);
    }
    let replacements: Vec<(usize, &Form)> = replaced.iter().enumerate().collect();
    let mut result = [Form::zero(), Form::zero(), Form::zero()];
    for (row, form) in forms.iter().enumerate() {
        let form = form.compose(&replacements, None)?;
        (0..3).for_each(|axis| result[axis] += &form.scale(&matrix[(row, axis)]));
    }
    Ok(result)
}

/// A sparse row: indices of monomials and coefficients.
type SparseRow = Vec<(usize, f64)>;

/// The rows of one degree l and one degree in the rates.
#[derive(Clone, Debug)]
pub(super) struct RowGroup {
    pub(super) degree: usize,
    pub(super) of_rates: i32,
    /// g₁T₁, g₂T₂, g₃T₃, div_S T, g·curl T.
    rows: [SparseRow; 5],
    /// Root mean square of the torque over directions, for rates of 1.
    pub(super) size: f64,
}

impl RowGroup {
    /// The five means.
    pub(super) fn means(&self, means: &[f64]) -> [f64; 5] {
        self.rows.each_ref().map(|row| row.iter().map(|(index, coefficient)| coefficient * means[*index]).sum())
    }
}

/// Collects the monomials of all rows of a family.
pub(super) struct RowBuilder {
    family: ModeFamily,
    inverse: Vector3<f64>,
    pub(super) monomials: Vec<EvenMonomial>,
}

impl RowBuilder {
    pub(super) fn new(family: ModeFamily, moments: &Vector3<f64>) -> Self {
        Self { family, inverse: moments.map(f64::recip), monomials: Vec::new() }
    }

    /// The groups of a torque, by degree.
    pub(super) fn groups(&mut self, torque: &SortedTorque) -> Result<Vec<RowGroup>, Error> {
        let mut sums: BTreeMap<(u32, u32), [Form; 5]> = BTreeMap::new();
        let mut sizes: BTreeMap<(u32, u32), f64> = BTreeMap::new();
        for ((l, rates), components) in harmonics(&torque.components)? {
            let key = (l, rates.iter().sum());
            let forms = self.forms(&components, (l, rates))?;
            let sum = sums.entry(key).or_insert_with(|| std::array::from_fn(|_| Form::zero()));
            sum.iter_mut().zip(&forms).for_each(|(sum, form)| *sum += form);
            *sizes.entry(key).or_default() += size(&components)?;
        }
        let mut groups = Vec::new();
        for (key, forms) in sums {
            let rows = forms.each_ref().map(|form| self.row(form));
            groups.push(RowGroup { degree: key.0 as usize, of_rates: key.1 as i32, rows, size: sizes[&key] });
        }
        Ok(groups)
    }

    /// The five polynomials of three harmonics of degree l times ν^e g^e. Derivatives act on u alone.
    fn forms(&self, torque: &[Form; 3], (l, rates): (u32, [u32; 3])) -> Result<[Form; 5], Error> {
        let factor: f64 = (0..3).map(|axis| self.inverse[axis].powi(rates[axis] as i32)).product();
        let of_rates = Form::from_terms([(Monomial::new(&rates)?, factor)]);
        let mut along = [Form::zero(), Form::zero(), Form::zero()];
        let (mut divergence, mut turn) = (Form::zero(), Form::zero());
        for axis in 0..3 {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            along[axis] = torque[axis].multiply(&Form::variable(axis)?)?;
            // div_S T = Σ ∂_i T_i − l g·T
            divergence += &torque[axis].derivative(axis)?;
            divergence -= &along[axis].scale(&f64::from(l));
            let curl = &torque[last].derivative(next)? - &torque[next].derivative(last)?;
            turn += &curl.multiply(&Form::variable(axis)?)?;
        }
        let [first, second, third] = along;
        let mut forms = [first, second, third, divergence, turn];
        for form in &mut forms {
            *form = form.multiply(&of_rates)?;
        }
        Ok(forms)
    }

    /// The terms whose mean is not 0.
    fn row(&mut self, form: &Form) -> SparseRow {
        let (across, own) = (self.family.across(), self.family.axis());
        let mut row = SparseRow::new();
        for (monomial, coefficient) in form.terms() {
            let [cn, middle] = [across, 1].map(|axis| monomial.exponent(axis) as usize);
            if cn % 2 == 1 || middle % 2 == 1 {
                continue;
            }
            let even = EvenMonomial { across: cn / 2, middle: middle / 2, own: monomial.exponent(own) as usize };
            let known = self.monomials.iter().position(|other| *other == even);
            let index = known.unwrap_or_else(|| {
                self.monomials.push(even);
                self.monomials.len() - 1
            });
            row.push((index, *coefficient));
        }
        row
    }
}

/// Degree and powers of the rates, with three harmonics.
type HarmonicsByRates = BTreeMap<(u32, [u32; 3]), [Form; 3]>;

fn harmonics(components: &[Form; 3]) -> Result<HarmonicsByRates, Error> {
    let mut found = HarmonicsByRates::new();
    for (axis, component) in components.iter().enumerate() {
        let mut by_rates: BTreeMap<[u32; 3], Form> = BTreeMap::new();
        for (monomial, coefficient) in component.terms() {
            let [u, w] = [0, 3].map(|first| [0, 1, 2].map(|k| monomial.exponent(first + k)));
            by_rates.entry(w).or_insert_with(Polynomial::zero).add_term(Monomial::new(&u)?, coefficient);
        }
        for (rates, form) in by_rates {
            for (l, part) in harmonic_parts(&form)? {
                let forms = found.entry((l, rates)).or_insert_with(|| [Form::zero(), Form::zero(), Form::zero()]);
                forms[axis] = part;
            }
        }
    }
    Ok(found)
}

/// Root mean square over the sphere, from 200 directions that are spread evenly (a spiral with the golden angle).
fn size(components: &[Form; 3]) -> Result<f64, Error> {
    let mut sum = 0.0;
    for k in 0..200 {
        let (z, angle) = ((f64::from(k) + 0.5) / 100.0 - 1.0, 2.399963229728653 * f64::from(k));
        let across = (1.0 - z * z).sqrt();
        let u = [across * angle.cos(), across * angle.sin(), z];
        for component in components {
            sum += component.evaluate(&u)?.powi(2);
        }
    }
    Ok((sum / 200.0).sqrt())
}
