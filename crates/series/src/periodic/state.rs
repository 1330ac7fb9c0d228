//! States in the normal form: normal variables at given phases, actions and angles.

use std::cmp::Ordering;

use num_complex::Complex;
use num_traits::{One, Zero};

use super::form::DrivenForm;
use super::images::ImageTerm;
use crate::birkhoff::flow::{actions, advanced, complex_point, real_point};
use crate::birkhoff::map::check;
use crate::birkhoff::range::{LOST, LOST_TORUS, apart, check_return, largest};
use crate::error::Error;
use crate::monomial::Monomial;

/// Most steps to normal coordinates, and the smallest factor by which a step that counts comes nearer.
const STEPS: usize = 80;
const SLOWEST: f64 = 0.9;
/// A distance below this part of the variables is rounding.
const ROUNDING: f64 = 1e-12;

/// Terms of the transformation below this part of the largest variable do not count.
const NEGLIGIBLE: f64 = 1e-19;
/// A state may have variables so many times the largest of its linear part.
const MARGIN: f64 = 2.0;

/// The transformation of a form at one time.
#[derive(Clone, Debug)]
pub struct FormAtPhases<'a> {
    form: &'a DrivenForm,
    weights: Vec<f64>,
    origin: Vec<f64>,
    change: Vec<Vec<Complex<f64>>>,
    inverse: Vec<Vec<Complex<f64>>>,
}

/// A term of the transformation at one time.
struct TermAtPhases {
    slot: usize,
    order: usize,
    monomial: Monomial,
    value: Complex<f64>,
}

impl FormAtPhases<'_> {
    /// The state q₁, p₁, … of real normal variables: U = p + iq of a centre.
    ///
    /// # Errors
    /// - another number of variables: [`Error::CountMismatch`]; a NaN, or a state that is not finite: [`Error::NotFinite`];
    /// - a state beyond the range of the series: [`Error::BeyondSeries`].
    pub fn from_normal(&self, normal: &[f64]) -> Result<Vec<f64>, Error> {
        check("state", normal, self.origin.len())?;
        let moduli: Vec<f64> = complex_point(&self.form.motion.modes, normal).iter().map(|c| c.norm()).collect();
        let terms = self.terms(&moduli);
        let state = self.image(normal, &terms, self.form.order())?;
        self.check_inverse(normal, &state, &terms, LOST)?;
        Ok(state)
    }

    /// Refuses real normal variables beyond the range of the frequencies.
    ///
    /// # Errors
    /// - Those of [`from_normal`](Self::from_normal).
    pub(super) fn check_torus(&self, normal: &[f64]) -> Result<(), Error> {
        let moduli: Vec<f64> = complex_point(&self.form.motion.modes, normal).iter().map(|c| c.norm()).collect();
        let terms = self.terms(&moduli);
        let state = self.image(normal, &terms, self.form.order())?;
        self.check_inverse(normal, &state, &terms, LOST_TORUS)
    }

    /// Refuses a state from which the iteration of [`to_normal`](Self::to_normal) does not lead back to its normal variables, to `part` of their size. It ends as soon
    /// as it is near enough.
    fn check_inverse(&self, normal: &[f64], state: &[f64], terms: &[TermAtPhases], part: f64) -> Result<(), Error> {
        let (wanted, size) = (self.linear(state), largest(normal));
        let (mut found, mut least) = (wanted.clone(), f64::INFINITY);
        for _ in 0..STEPS {
            let miss = apart(&found, normal);
            if miss <= part * size.max(ROUNDING * largest(state)) {
                return Ok(());
            }
            if miss >= least {
                break;
            }
            least = miss;
            let Ok(image) = self.image(&found, terms, self.form.order()) else { break };
            let seen = self.linear(&image);
            found.iter_mut().zip(wanted.iter().zip(seen)).for_each(|(x, (wanted, seen))| *x += wanted - seen);
        }
        // The miss of the state is of the size of that of the normal variables, beside its distance.
        let distance = apart(state, &self.origin);
        Err(Error::BeyondSeries { miss: least / size * distance, distance })
    }

    /// The real normal variables of the linear part at a state.
    fn linear(&self, state: &[f64]) -> Vec<f64> {
        let moved: Vec<f64> = state.iter().zip(&self.origin).map(|(x, origin)| x - origin).collect();
        let row = |row: &Vec<Complex<f64>>| row.iter().zip(&moved).map(|(a, x)| a * x).sum::<Complex<f64>>();
        real_point(&self.form.motion.modes, &self.inverse.iter().map(row).collect::<Vec<_>>())
    }

    /// The terms that count where the complex variables have these moduli.
    fn terms(&self, moduli: &[f64]) -> Vec<TermAtPhases> {
        let negligible = NEGLIGIBLE * moduli.iter().copied().fold(0.0, f64::max);
        // A bound that is not a number counts.
        let counts =
            |term: &&ImageTerm| (term.size * term.modulus(moduli)).partial_cmp(&negligible) != Some(Ordering::Less);
        let at = |term: &ImageTerm| TermAtPhases {
            slot: term.slot,
            order: term.order(),
            monomial: term.monomial,
            value: term.coefficient.weighted(&self.weights),
        };
        self.form.images.terms().filter(counts).map(at).collect()
    }

    /// The state of real normal variables by the terms to an order.
    fn image(&self, normal: &[f64], terms: &[TermAtPhases], order: usize) -> Result<Vec<f64>, Error> {
        let modes = &self.form.motion.modes;
        let powers: Vec<Vec<Complex<f64>>> =
            complex_point(modes, normal).into_iter().map(|z| powers(z, order + 1)).collect();
        let mut values = vec![Complex::zero(); normal.len()];
        for term in terms.iter().filter(|term| term.order <= order) {
            let mut product = term.value;
            for (slot, powers) in powers.iter().enumerate() {
                let exponent = term.monomial.exponent(slot) as usize;
                if exponent > 0 {
                    product *= powers[exponent];
                }
            }
            values[term.slot] += product;
        }
        for mode in 0..modes.len() {
            if modes[mode].is_elliptic() {
                values[2 * mode] = values[2 * mode + 1].conj() * Complex::new(0.0, 0.5);
            }
        }
        let state = self
            .origin
            .iter()
            .zip(&self.change)
            .map(|(x, row)| x + row.iter().zip(&values).map(|(a, b)| a * b).sum::<Complex<f64>>().re);
        let state: Vec<f64> = state.collect();
        match state.iter().find(|x| !x.is_finite()) {
            Some(value) => Err(Error::NotFinite { what: "state", term: value.to_string() }),
            None => Ok(state),
        }
    }

    /// The real normal variables of a state, whose image is the state to rounding, by iteration.
    ///
    /// # Errors
    /// - another number of variables: [`Error::CountMismatch`]; a NaN: [`Error::NotFinite`]; a state of which no image keeps two digits: [`Error::BeyondSeries`].
    pub fn to_normal(&self, state: &[f64]) -> Result<Vec<f64>, Error> {
        let (normal, miss) = self.to_normal_by_orders(state, &[self.form.order()])?.remove(0);
        check_return(miss, apart(state, &self.origin).max(ROUNDING * largest(state)), LOST)?;
        Ok(normal)
    }

    /// The normal variables by the terms to each of some orders, which are those of the forms of these orders, and how far their image is from the state. Beyond the range of the
    /// series they are the variables of the best step.
    ///
    /// # Errors
    /// - another number of variables: [`Error::CountMismatch`]; a NaN: [`Error::NotFinite`].
    pub fn to_normal_by_orders(&self, state: &[f64], orders: &[usize]) -> Result<Vec<(Vec<f64>, f64)>, Error> {
        check("state", state, self.origin.len())?;
        let modes = &self.form.motion.modes;
        let wanted = self.linear(state);
        // A variable that is 0 in the linear part is not 0 in the state.
        let point = complex_point(modes, &wanted);
        let reach = MARGIN * point.iter().map(|c| c.norm()).fold(0.0, f64::max);
        let terms = self.terms(&vec![reach; point.len()]);
        // Each order begins where the one before it ended.
        let mut begin = wanted.clone();
        let settled = |&order: &usize| {
            let (mut normal, mut best, mut least) = (begin.clone(), wanted.clone(), f64::INFINITY);
            for _ in 0..STEPS {
                let image = self.image(&normal, &terms, order)?;
                let miss = image.iter().zip(state).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
                // Rounding ends the iteration, or the range.
                let ends = miss.is_nan() || miss >= least * SLOWEST;
                if miss < least {
                    (least, best) = (miss, normal.clone());
                }
                if ends {
                    break;
                }
                let seen = self.linear(&image);
                normal.iter_mut().zip(wanted.iter().zip(seen)).for_each(|(x, (wanted, seen))| *x += wanted - seen);
            }
            begin.clone_from(&best);
            Ok((best, least))
        };
        orders.iter().map(settled).collect()
    }
}

/// 1, z, z², … to a power.
pub(super) fn powers(z: Complex<f64>, most: usize) -> Vec<Complex<f64>> {
    std::iter::successors(Some(Complex::one()), |power| Some(power * z)).take(most + 1).collect()
}

impl DrivenForm {
    /// The transformation of this form at phases.
    #[must_use]
    pub fn at(&self, phases: &[f64]) -> FormAtPhases<'_> {
        let weights = self.grid().weights(phases);
        let [change, inverse] = self.frame(phases);
        let origin = self.motion.origin.iter().map(|x| x.weighted(&weights).re).collect();
        FormAtPhases { form: self, weights, origin, change, inverse }
    }

    /// The actions of real normal variables.
    #[must_use]
    pub fn actions_of(&self, normal: &[f64]) -> Vec<f64> {
        actions(&self.motion.modes, normal)
    }

    /// The proper angles φ of real normal variables: U = √(2I) e^{iφ}.
    #[must_use]
    pub fn angles_of(&self, normal: &[f64]) -> Vec<f64> {
        normal.chunks(2).map(|pair| pair[0].atan2(pair[1])).collect()
    }

    /// Real normal variables after a time, at constant rates.
    #[must_use]
    pub fn advanced(&self, normal: &[f64], rates: &[f64], time: f64) -> Vec<f64> {
        advanced(&self.motion.modes, normal, rates, time)
    }
}
