//! The truncated series of a normal form in `f64`: states to normal coordinates and back, actions, frequencies, motion.
//!
//! States are q₁, p₁, q₂, p₂, …, of the old variables or of the new ones. Only the images of Uᵢ are needed: at real
//! points q = Im U and p = Re U / r. Exact generators are rounded to floats once, and the series are composed from them.
//! Cost: that of the two transformations once, then one pass over their terms for each state. The error of a state of
//! amplitude ε is of the order ε^(N+2).

use super::{BirkhoffNormalForm, turns};
use crate::{Error, Monomial, Polynomial, Progress, RealField, SLOTS, quiet};
use num_complex::Complex;

/// A normal form ready for numbers: the transformation of states and the motion in the normal form.
///
/// ```
/// use andoyer_series::{BirkhoffMap, PhaseSpace, normalize};
/// let space = PhaseSpace::new(&[("q", "p")])?;
/// let pendulum = space.parse::<f64>("p^2/2 + q^2/2 - q^4/24 + q^6/720 - q^8/40320")?;
/// let map = BirkhoffMap::new(&normalize(&pendulum, 6, &space)?, &[])?;
/// let normal = map.to_normal(&[0.1, 0.0])?;
/// let back = map.from_normal(&normal)?;
/// assert!((back[0] - 0.1).abs() < 1e-10);
/// // 2π/Ω is the period of a pendulum that swings by 0.1 rad: 2π (1 + 0.1²/16 + …).
/// let frequency = map.frequencies(&map.actions(&[0.1, 0.0])?)?[0];
/// assert!((1.0 / frequency - 1.0 - 0.01 / 16.0).abs() < 4e-7);
/// # Ok::<(), andoyer_series::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct BirkhoffMap {
    ratios: Vec<f64>,
    direct: Vec<Series>,
    inverse: Vec<Series>,
    /// ∂K/∂Iᵢ in the actions, or the term that keeps K from being a function of them.
    frequencies: Result<Vec<Polynomial<f64>>, String>,
}

/// A polynomial in the complex variables with numbers for the parameters, its terms in canonical order.
#[derive(Debug, Clone)]
struct Series {
    terms: Vec<(Monomial, Complex<f64>)>,
}

impl BirkhoffMap {
    /// The series of `normal_form` with numbers for its parameters, in the order of their names.
    ///
    /// # Errors
    /// - one number for two parameters: [`Error::CountMismatch`]; a NaN, or floats that overflow: [`Error::NotFinite`].
    pub fn new<R: RealField>(normal_form: &BirkhoffNormalForm<R>, parameters: &[f64]) -> Result<Self, Error> {
        Self::with_progress(normal_form, parameters, &mut quiet)
    }

    /// As [`new`](Self::new), with a callback as that of [`normalize_with`](crate::normalize_with), for every series anew.
    ///
    /// # Errors
    /// - as [`new`](Self::new); a callback that returns `Break`: [`Error::Interrupted`].
    pub fn with_progress<R: RealField>(
        normal_form: &BirkhoffNormalForm<R>,
        parameters: &[f64],
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let modes = normal_form.space().degrees_of_freedom();
        check("parameters", parameters, normal_form.space().parameters())?;
        let transform = normal_form.transform().map(|c| {
            let (re, im) = R::parts(c);
            Complex::new(re.to_float(), im.to_float())
        });
        let series = |terms: Vec<Polynomial<Complex<f64>>>| {
            let mut sum = Polynomial::zero();
            for term in &terms {
                sum += term;
            }
            Series::new(&sum, 2 * modes, parameters)
        };
        let (mut direct, mut inverse) = (Vec::new(), Vec::new());
        for mode in 0..modes {
            let variable = Polynomial::variable(2 * mode + 1)?;
            direct.push(series(transform.direct_with(&variable, progress)?)?);
            inverse.push(series(transform.inverse_with(&variable, progress)?)?);
        }
        let ratios = normal_form.ratios().iter().map(R::to_float).collect();
        Ok(BirkhoffMap { ratios, direct, inverse, frequencies: frequencies(normal_form, parameters)? })
    }

    /// The normal coordinates of a state.
    ///
    /// # Errors
    /// - a state of another length: [`Error::CountMismatch`]; a NaN, or a result that overflows: [`Error::NotFinite`].
    pub fn to_normal(&self, state: &[f64]) -> Result<Vec<f64>, Error> {
        self.transformed(&self.inverse, state)
    }

    /// The state of normal coordinates.
    ///
    /// # Errors
    /// - as [`to_normal`](Self::to_normal).
    pub fn from_normal(&self, normal: &[f64]) -> Result<Vec<f64>, Error> {
        self.transformed(&self.direct, normal)
    }

    /// The actions of a state, constant along its motion to the order of the normal form if there is no resonance.
    ///
    /// # Errors
    /// - as [`to_normal`](Self::to_normal).
    pub fn actions(&self, state: &[f64]) -> Result<Vec<f64>, Error> {
        let momenta = self.momenta(&self.to_normal(state)?)?;
        Ok(momenta.iter().zip(&self.ratios).map(|(momentum, ratio)| momentum.norm_sqr() / (2.0 * ratio)).collect())
    }

    /// The frequencies Ωᵢ = ∂K/∂Iᵢ at given actions.
    ///
    /// # Errors
    /// - another number of actions: [`Error::CountMismatch`]; a NaN: [`Error::NotFinite`]; −1: [`Error::OutsideInterval`], since
    ///   I = (q²/r + r p²)/2 is never negative;
    /// - a resonant normal form: [`Error::ResonantTerm`].
    pub fn frequencies(&self, actions: &[f64]) -> Result<Vec<f64>, Error> {
        check("actions", actions, self.ratios.len())?;
        if let Some(&value) = actions.iter().find(|&&action| action < 0.0) {
            return Err(Error::OutsideInterval { argument: "actions", value, lower: 0.0, upper: f64::INFINITY });
        }
        let map = self.frequencies.as_ref().map_err(|term| Error::ResonantTerm { term: term.clone() })?;
        let values = map.iter().map(|frequency| frequency.evaluate(actions)).collect::<Result<Vec<_>, _>>()?;
        finite("frequencies", values)
    }

    /// The states at times after that of `state`, by the uniform motion of the angles of the normal form.
    ///
    /// # Errors
    /// - as [`to_normal`](Self::to_normal) and [`frequencies`](Self::frequencies); a NaN among the times: [`Error::NotFinite`].
    pub fn trajectory(&self, state: &[f64], times: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        check("times", times, times.len())?;
        let momenta = self.momenta(&self.to_normal(state)?)?;
        let frequencies = self.frequencies(&self.actions(state)?)?;
        let at = |&time: &f64| {
            let turned = momenta.iter().zip(&frequencies).zip(&self.ratios);
            let turned = turned.flat_map(|((momentum, frequency), ratio)| {
                let momentum = momentum * Complex::cis(frequency * time);
                [momentum.im, momentum.re / ratio]
            });
            self.from_normal(&turned.collect::<Vec<_>>())
        };
        times.iter().map(at).collect()
    }

    /// U = r p + i q of every mode.
    fn momenta(&self, state: &[f64]) -> Result<Vec<Complex<f64>>, Error> {
        check("state", state, 2 * self.ratios.len())?;
        Ok(state.chunks(2).zip(&self.ratios).map(|(pair, ratio)| Complex::new(ratio * pair[1], pair[0])).collect())
    }

    fn transformed(&self, images: &[Series], state: &[f64]) -> Result<Vec<f64>, Error> {
        let momenta = self.momenta(state)?;
        let pairs = momenta.iter().zip(&self.ratios);
        let point =
            pairs.flat_map(|(momentum, ratio)| [Complex::new(momentum.im, momentum.re) / (2.0 * ratio), *momentum]);
        let mut powers: Vec<Vec<Complex<f64>>> = point.map(|value| vec![Complex::new(1.0, 0.0), value]).collect();
        let values = images.iter().zip(&self.ratios).flat_map(|(series, ratio)| {
            let image = series.evaluate(&mut powers);
            [image.im, image.re / ratio]
        });
        let values = values.collect();
        finite("transformed state", values)
    }
}

/// ∂K/∂Iᵢ at numbers for the parameters, or the first term that is no function of the actions.
fn frequencies<R: RealField>(
    normal_form: &BirkhoffNormalForm<R>,
    parameters: &[f64],
) -> Result<Result<Vec<Polynomial<f64>>, String>, Error> {
    let modes = normal_form.space().degrees_of_freedom();
    let mut actions = match normal_form.in_actions() {
        Ok(actions) => actions.map(R::to_float),
        Err(Error::ResonantTerm { term }) => return Ok(Err(term)),
        Err(other) => return Err(other),
    };
    for (slot, value) in (modes..).zip(parameters) {
        actions = actions.evaluate_partial(slot, value)?;
    }
    (0..modes).map(|mode| actions.derivative(mode)).collect::<Result<Vec<_>, _>>().map(Ok)
}

impl Series {
    fn new(polynomial: &Polynomial<Complex<f64>>, first: usize, parameters: &[f64]) -> Result<Self, Error> {
        let mut polynomial = polynomial.clone();
        for (slot, &value) in (first..).zip(parameters) {
            polynomial = polynomial.evaluate_partial(slot, &Complex::new(value, 0.0))?;
        }
        let terms: Vec<_> = polynomial.terms().map(|(monomial, &c)| (monomial, c)).collect();
        match terms.iter().find(|(_, c)| !(c.re.is_finite() && c.im.is_finite())) {
            None => Ok(Series { terms }),
            Some((monomial, c)) => Err(Error::NotFinite {
                what: "transformation",
                term: format!("{c} at {:?}", turns(*monomial, first / 2)),
            }),
        }
    }

    /// The value at a point given by tables of powers, which grow as needed and hold the powers 0 and 1 at least.
    fn evaluate(&self, powers: &mut [Vec<Complex<f64>>]) -> Complex<f64> {
        let mut sum = Complex::default();
        for &(monomial, c) in &self.terms {
            let mut product = c;
            for (slot, table) in powers.iter_mut().enumerate().take(SLOTS) {
                let exponent = monomial.exponent(slot) as usize;
                if exponent == 0 {
                    continue;
                }
                while table.len() <= exponent {
                    table.push(table[table.len() - 1] * table[1]);
                }
                product *= table[exponent];
            }
            sum += product;
        }
        sum
    }
}

fn check(what: &'static str, values: &[f64], expected: usize) -> Result<(), Error> {
    if values.len() != expected {
        return Err(Error::CountMismatch { what, found: values.len(), expected });
    }
    finite(what, values.to_vec()).map(drop)
}

fn finite(what: &'static str, values: Vec<f64>) -> Result<Vec<f64>, Error> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(values),
        Some(at) => Err(Error::NotFinite { what, term: format!("{} at {at}", values[at]) }),
    }
}
