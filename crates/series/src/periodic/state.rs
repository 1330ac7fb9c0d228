//! States in the normal form: normal variables at given phases, actions and angles.

use num_complex::Complex;
use num_traits::Zero;

use super::exponent::Exponent;
use super::form::DrivenForm;
use super::row::Periodic;
use crate::birkhoff::map::check;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;

/// Most steps to normal coordinates, and the smallest factor by which a step that counts comes nearer.
const STEPS: usize = 80;
const SLOWEST: f64 = 0.9;

/// The terms of a polynomial at one time.
type Terms = Vec<(Monomial, Complex<f64>)>;

/// The functions of a form at one time.
#[derive(Clone, Debug)]
pub struct FormAtPhases<'a> {
    form: &'a DrivenForm,
    origin: Vec<f64>,
    change: Vec<Vec<Complex<f64>>>,
    inverse: Vec<Vec<Complex<f64>>>,
    images: Vec<(usize, Terms)>,
}

impl FormAtPhases<'_> {
    /// The state q₁, p₁, … of real normal variables: U = p + iq of a centre.
    ///
    /// # Errors
    /// - another number of variables: [`Error::CountMismatch`]; a NaN: [`Error::NotFinite`].
    pub fn from_normal(&self, normal: &[f64]) -> Result<Vec<f64>, Error> {
        check("state", normal, self.origin.len())?;
        let exponents = &self.form.motion.exponents;
        let point = complex_point(exponents, normal);
        let mut values = vec![Complex::zero(); normal.len()];
        for (slot, image) in &self.images {
            values[*slot] = evaluated(image, &point);
        }
        for (mode, exponent) in exponents.iter().enumerate() {
            if let Exponent::Centre(_) = exponent {
                values[2 * mode] = values[2 * mode + 1].conj() * Complex::new(0.0, 0.5);
            }
        }
        let state = self
            .origin
            .iter()
            .zip(&self.change)
            .map(|(x, row)| x + row.iter().zip(&values).map(|(a, b)| a * b).sum::<Complex<f64>>().re);
        Ok(state.collect())
    }

    /// The real normal variables of a state, whose image is the state to rounding, by iteration; those of the best step beyond the range of the series.
    ///
    /// # Errors
    /// - another number of variables: [`Error::CountMismatch`]; a NaN: [`Error::NotFinite`].
    pub fn to_normal(&self, state: &[f64]) -> Result<Vec<f64>, Error> {
        check("state", state, self.origin.len())?;
        let exponents = &self.form.motion.exponents;
        let linear = |state: &[f64]| -> Vec<f64> {
            let moved: Vec<f64> = state.iter().zip(&self.origin).map(|(x, origin)| x - origin).collect();
            let row = |row: &Vec<Complex<f64>>| row.iter().zip(&moved).map(|(a, x)| a * x).sum::<Complex<f64>>();
            real_point(exponents, &self.inverse.iter().map(row).collect::<Vec<_>>())
        };
        let wanted = linear(state);
        let (mut normal, mut best, mut least) = (wanted.clone(), wanted.clone(), f64::INFINITY);
        for _ in 0..STEPS {
            let image = self.from_normal(&normal)?;
            let miss = image.iter().zip(state).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            // Rounding ends the iteration, or the range.
            if miss.is_nan() || miss >= least * SLOWEST {
                if miss < least {
                    best.clone_from(&normal);
                }
                break;
            }
            (least, best) = (miss, normal.clone());
            let seen = linear(&image);
            normal.iter_mut().zip(wanted.iter().zip(seen)).for_each(|(x, (wanted, seen))| *x += wanted - seen);
        }
        Ok(best)
    }
}

impl DrivenForm {
    /// This form at phases: all its functions as numbers.
    #[must_use]
    pub fn at(&self, phases: &[f64]) -> FormAtPhases<'_> {
        let weights = self.grid().weights(phases);
        let number = |c: &Periodic| c.weighted(&weights);
        let [change, inverse] = self.frame(phases);
        let list = |image: &Polynomial<Periodic>| image.terms().map(|(monomial, c)| (monomial, number(c))).collect();
        FormAtPhases {
            form: self,
            origin: self.motion.origin.iter().map(|x| number(x).re).collect(),
            inverse,
            change,
            images: self.images.iter().map(|(slot, image)| (*slot, list(image))).collect(),
        }
    }

    /// The actions of real normal variables.
    #[must_use]
    pub fn actions_of(&self, normal: &[f64]) -> Vec<f64> {
        let action = |(pair, exponent): (&[f64], &Exponent)| match exponent {
            Exponent::Centre(_) => (pair[0] * pair[0] + pair[1] * pair[1]) / 2.0,
            Exponent::Saddle(_) => pair[0] * pair[1],
        };
        normal.chunks(2).zip(&self.motion.exponents).map(action).collect()
    }

    /// The proper angles φ of real normal variables: U = √(2I) e^{iφ}.
    #[must_use]
    pub fn angles_of(&self, normal: &[f64]) -> Vec<f64> {
        normal.chunks(2).map(|pair| pair[0].atan2(pair[1])).collect()
    }

    /// Real normal variables after a time, at constant rates.
    #[must_use]
    pub fn advanced(&self, normal: &[f64], rates: &[f64], time: f64) -> Vec<f64> {
        let mut moved = normal.to_vec();
        for (mode, exponent) in self.motion.exponents.iter().enumerate() {
            let (q, p) = (normal[2 * mode], normal[2 * mode + 1]);
            let pair = match exponent {
                Exponent::Centre(_) => {
                    let turned = Complex::new(p, q) * Complex::cis(rates[mode] * time);
                    [turned.im, turned.re]
                }
                Exponent::Saddle(_) => {
                    let growth = (rates[mode] * time).exp();
                    [q * growth, p / growth]
                }
            };
            moved[2 * mode..][..2].copy_from_slice(&pair);
        }
        moved
    }
}

fn complex_point(exponents: &[Exponent], normal: &[f64]) -> Vec<Complex<f64>> {
    let pair = |(pair, exponent): (&[f64], &Exponent)| match exponent {
        Exponent::Centre(_) => [Complex::new(pair[0], pair[1]) / 2.0, Complex::new(pair[1], pair[0])],
        Exponent::Saddle(_) => [pair[0].into(), pair[1].into()],
    };
    normal.chunks(2).zip(exponents).flat_map(pair).collect()
}

fn real_point(exponents: &[Exponent], values: &[Complex<f64>]) -> Vec<f64> {
    let pair = |(pair, exponent): (&[Complex<f64>], &Exponent)| match exponent {
        Exponent::Centre(_) => [pair[1].im, pair[1].re],
        Exponent::Saddle(_) => [pair[0].re, pair[1].re],
    };
    values.chunks(2).zip(exponents).flat_map(pair).collect()
}

/// The value of a polynomial at a point.
fn evaluated(terms: &[(Monomial, Complex<f64>)], point: &[Complex<f64>]) -> Complex<f64> {
    let mut powers: Vec<Vec<Complex<f64>>> = point.iter().map(|&x| vec![Complex::new(1.0, 0.0), x]).collect();
    let mut sum = Complex::zero();
    for &(monomial, c) in terms {
        let mut product = c;
        for (slot, powers) in powers.iter_mut().enumerate() {
            let exponent = monomial.exponent(slot) as usize;
            if exponent == 0 {
                continue;
            }
            while powers.len() <= exponent {
                powers.push(powers[powers.len() - 1] * powers[1]);
            }
            product *= powers[exponent];
        }
        sum += product;
    }
    sum
}
