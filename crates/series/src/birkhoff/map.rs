//! The truncated series of a normal form in `f64`: transformation of states to normal coordinates and back, actions, frequencies, motion.
//!
//! A state is q₁, p₁, q₂, p₂, … in the old or the new variables. For a centre only the image of U is needed: at real points q = Im U and p = Re U / r. For a
//! saddle or a quartet the images of u and U are needed. Exact generators are rounded to floats once, and the series are composed from the rounded generators.
//! With driven phases both transformations depend on the time; the methods without a time are those at time 0. The forced motion is added or subtracted
//! as a number. The error of a state of amplitude ε is of the order ε^(N+2); a point that the transformation there and back misses by more than 1 % is refused
//! (`range`). Cost: the two transformations once, then one pass over the terms of both for each state.

use super::BirkhoffNormalForm;
use super::flow::{self, Flow};
use super::matrix::{Matrix, dot, symplectic_inverse};
use super::mode::Mode;
use super::range::{LOST, LOST_TORUS, apart, check_return, largest, torus};
use super::series::Series;
use crate::error::Error;
use crate::polynomial::Polynomial;
use crate::real_field::RealField;
use crate::triangle::{Progress, quiet};
use num_complex::Complex;

/// A normal form ready for numerical evaluation: the transformation of states, and the motion in the normal form.
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
    modes: Vec<Mode<f64>>,
    /// The linear change z = M z′ and its inverse.
    linear: [Matrix<f64>; 2],
    direct: Vec<Series>,
    inverse: Vec<Series>,
    /// The terms of `direct` without variables: the equilibrium under parameters, and the forced motion.
    centre: Vec<Series>,
    /// The frequency and the phase at time 0 of each driven phase.
    driven: Vec<(f64, f64)>,
    /// The forced motion of all complex variables; empty without a force.
    shift: Vec<Series>,
    flow: Flow,
}

impl BirkhoffMap {
    /// The series of `normal_form`. `parameters` are numbers for its parameters, in the order of their names.
    ///
    /// # Errors
    /// - one number for two parameters: [`Error::CountMismatch`]; a NaN, or floats that overflow: [`Error::NotFinite`].
    pub fn new<R: RealField>(normal_form: &BirkhoffNormalForm<R>, parameters: &[f64]) -> Result<Self, Error> {
        Self::with_progress(normal_form, parameters, &mut quiet)
    }

    /// The same as [`new`](Self::new), with a callback as in [`normalize_with`](crate::normalize_with). Its counts start again for every series.
    ///
    /// # Errors
    /// - The errors of [`new`](Self::new); a callback that returns `Break`: [`Error::Interrupted`].
    pub fn with_progress<R: RealField>(
        normal_form: &BirkhoffNormalForm<R>,
        parameters: &[f64],
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let (space, phases) = (normal_form.space(), &normal_form.phases);
        check("parameters", parameters, space.parameters())?;
        let float = |c: &R::Complex| {
            let (re, im) = R::parts(c);
            Complex::new(re.to_float(), im.to_float())
        };
        let transform = normal_form.transform().map(float);
        let sum = |terms: Vec<Polynomial<Complex<f64>>>| {
            let mut sum = Polynomial::zero();
            for (order, term) in terms.iter().enumerate() {
                sum += &phases.lowered(term, space, order);
            }
            sum
        };
        let shift: Vec<Polynomial<Complex<f64>>> = phases.shift.iter().map(|shift| shift.map(float)).collect();
        let modes: Vec<Mode<f64>> = normal_form.modes().iter().map(|mode| mode.map(R::to_float)).collect();
        let (mut direct, mut inverse) = (Vec::new(), Vec::new());
        for slot in modes.iter().enumerate().flat_map(|(mode, kind)| needed(mode, kind)) {
            let variable = Polynomial::variable(slot)?;
            let mut old = sum(transform.direct_with(&variable, progress)?);
            shift.get(slot).into_iter().for_each(|shift| old += shift);
            direct.push(Series::new(&old, space, parameters)?);
            inverse.push(Series::new(&sum(transform.inverse_with(&variable, progress)?), space, parameters)?);
        }
        let centre = direct.iter().map(|series| series.constant(space)).collect();
        let shift = shift.iter().map(|shift| Series::new(shift, space, parameters)).collect::<Result<_, _>>()?;
        let driven = normal_form.driven().iter().map(|(frequency, phase)| (frequency.to_float(), *phase)).collect();
        let matrix: Matrix<f64> =
            normal_form.linear_change().iter().map(|row| row.iter().map(R::to_float).collect()).collect();
        let back = symplectic_inverse(&matrix);
        let flow = Flow::new(normal_form, parameters)?;
        Ok(BirkhoffMap { modes, linear: [matrix, back], direct, inverse, centre, driven, shift, flow })
    }

    /// The normal coordinates of a state q₁, p₁, q₂, p₂, …
    ///
    /// # Errors
    /// - a state of another length: [`Error::CountMismatch`]; a NaN, or a result that overflows: [`Error::NotFinite`];
    /// - a state beyond the range of the series: [`Error::BeyondSeries`].
    pub fn to_normal(&self, state: &[f64]) -> Result<Vec<f64>, Error> {
        self.to_normal_at(state, 0.0)
    }

    /// The normal coordinates of a state at a time, on which driven phases depend.
    ///
    /// # Errors
    /// - the errors of [`to_normal`](Self::to_normal); a time that is a NaN or infinite: [`Error::NotFinite`].
    pub fn to_normal_at(&self, state: &[f64], time: f64) -> Result<Vec<f64>, Error> {
        check("state", state, 2 * self.modes.len())?;
        let phases = &self.phases(time)?;
        let normal = self.inverted(state, phases)?;
        let miss = self.expressed(&normal, phases).map_or(f64::INFINITY, |back| apart(&back, state));
        check_return(miss, largest(state).max(self.forced(phases)?), LOST)?;
        Ok(normal)
    }

    /// The inverse series at a state, without a test of its range.
    fn inverted(&self, state: &[f64], phases: &[f64]) -> Result<Vec<f64>, Error> {
        self.transformed(&self.inverse, self.powers(&self.unforced(state, phases), phases))
    }

    /// The direct series at normal coordinates, without a test of its range.
    fn expressed(&self, normal: &[f64], phases: &[f64]) -> Result<Vec<f64>, Error> {
        let powers = self.powers(&flow::complex_point(&self.modes, normal), phases);
        finite("transformed state", self.linear(0, &self.transformed(&self.direct, powers)?))
    }

    /// The largest variable of the equilibrium, or of the forced motion at phases.
    fn forced(&self, phases: &[f64]) -> Result<f64, Error> {
        if self.centre.iter().all(|series| series.terms.is_empty()) {
            return Ok(0.0);
        }
        let powers = self.powers(&vec![Complex::default(); 2 * self.modes.len()], phases);
        Ok(largest(&self.linear(0, &self.transformed(&self.centre, powers)?)))
    }

    /// The complex variables of a state, measured from the forced motion.
    fn unforced(&self, state: &[f64], phases: &[f64]) -> Vec<Complex<f64>> {
        let mut point = flow::complex_point(&self.modes, &self.linear(1, state));
        let mut powers = self.powers(&point, phases);
        for (value, shift) in point.iter_mut().zip(&self.shift) {
            *value -= shift.evaluate(&mut powers);
        }
        point
    }

    /// The state q₁, p₁, q₂, p₂, … at normal coordinates.
    ///
    /// # Errors
    /// - The errors of [`to_normal`](Self::to_normal).
    pub fn from_normal(&self, normal: &[f64]) -> Result<Vec<f64>, Error> {
        self.from_normal_at(normal, 0.0)
    }

    /// The state q₁, p₁, q₂, p₂, … at normal coordinates and a time.
    ///
    /// # Errors
    /// - The errors of [`to_normal_at`](Self::to_normal_at).
    pub fn from_normal_at(&self, normal: &[f64], time: f64) -> Result<Vec<f64>, Error> {
        check("state", normal, 2 * self.modes.len())?;
        let phases = &self.phases(time)?;
        let state = self.expressed(normal, phases)?;
        self.check_inverse(normal, &state, phases, LOST)?;
        Ok(state)
    }

    /// Refuses a state from which the inverse series misses its normal coordinates by more than `part` of their size, both in the variables of states.
    fn check_inverse(&self, normal: &[f64], state: &[f64], phases: &[f64], part: f64) -> Result<(), Error> {
        let distance = largest(&self.linear(0, normal)).max(self.forced(phases)?);
        let missed = |back: Vec<f64>| apart(&self.linear(0, &back), &self.linear(0, normal));
        check_return(self.inverted(state, phases).map_or(f64::INFINITY, missed), distance, part)
    }

    /// The state at a point of the centre manifold. `centre` holds q and p of the centres only.
    ///
    /// # Errors
    /// - The errors of [`to_normal`](Self::to_normal).
    pub fn from_centre(&self, centre: &[f64]) -> Result<Vec<f64>, Error> {
        self.from_centre_at(centre, 0.0)
    }

    /// The state at a point of the centre manifold and a time.
    ///
    /// # Errors
    /// - The errors of [`to_normal_at`](Self::to_normal_at).
    pub fn from_centre_at(&self, centre: &[f64], time: f64) -> Result<Vec<f64>, Error> {
        let centres = self.modes.iter().filter(|mode| mode.is_elliptic()).count();
        check("state", centre, 2 * centres)?;
        let mut pairs = centre.chunks(2);
        let pair =
            |mode: &Mode<f64>| if mode.is_elliptic() { pairs.next().unwrap_or(&[0.0, 0.0]) } else { &[0.0, 0.0] };
        let normal: Vec<f64> = self.modes.iter().flat_map(pair).copied().collect();
        self.from_normal_at(&normal, time)
    }

    /// Whether K is a function of the actions alone.
    #[must_use]
    pub fn is_integrable(&self) -> bool {
        self.flow.is_integrable()
    }

    /// The actions of a state. Without resonances they are constant along the motion, to the order of the normal form.
    ///
    /// # Errors
    /// - The errors of [`to_normal`](Self::to_normal).
    pub fn actions(&self, state: &[f64]) -> Result<Vec<f64>, Error> {
        self.actions_at(state, 0.0)
    }

    /// The actions of a state at a time.
    ///
    /// # Errors
    /// - The errors of [`to_normal_at`](Self::to_normal_at).
    pub fn actions_at(&self, state: &[f64], time: f64) -> Result<Vec<f64>, Error> {
        Ok(flow::actions(&self.modes, &self.to_normal_at(state, time)?))
    }

    /// The frequencies Ωᵢ = ∂K/∂Iᵢ at given actions. For a saddle this is the rate, for a quartet the rate and the frequency.
    ///
    /// # Errors
    /// - another number of actions: [`Error::CountMismatch`]; a NaN: [`Error::NotFinite`]; −1 for a centre: [`Error::OutsideInterval`], since I = (q²/r + r
    ///   p²)/2 is never negative;
    /// - a resonant normal form: [`Error::ResonantTerm`]; actions whose states at time 0 are beyond the range of the series: [`Error::BeyondSeries`].
    pub fn frequencies(&self, actions: &[f64]) -> Result<Vec<f64>, Error> {
        check_actions(&self.modes, actions)?;
        let frequencies = finite("frequencies", self.flow.frequencies(actions)?)?;
        let phases = &self.phases(0.0)?;
        for normal in torus(&self.modes, actions) {
            self.check_inverse(&normal, &self.expressed(&normal, phases)?, phases, LOST_TORUS)?;
        }
        Ok(frequencies)
    }

    /// The value of the normal form at normal coordinates.
    ///
    /// # Errors
    /// - The errors of [`to_normal`](Self::to_normal).
    pub fn energy(&self, normal: &[f64]) -> Result<f64, Error> {
        self.energy_at(normal, 0.0)
    }

    /// The value of the normal form at normal coordinates and a time. It depends on the time if terms with driven phases are kept.
    ///
    /// # Errors
    /// - The errors of [`to_normal_at`](Self::to_normal_at).
    pub fn energy_at(&self, normal: &[f64], time: f64) -> Result<f64, Error> {
        check("state", normal, 2 * self.modes.len())?;
        self.flow.energy(normal, &self.phases(time)?)
    }

    /// The rates of normal coordinates, from Hamilton's equations of the normal form.
    ///
    /// # Errors
    /// - The errors of [`to_normal`](Self::to_normal).
    pub fn rates(&self, normal: &[f64]) -> Result<Vec<f64>, Error> {
        self.rates_at(normal, 0.0)
    }

    /// The rates of normal coordinates at a time, on which they depend if terms with driven phases are kept.
    ///
    /// # Errors
    /// - The errors of [`to_normal_at`](Self::to_normal_at).
    pub fn rates_at(&self, normal: &[f64], time: f64) -> Result<Vec<f64>, Error> {
        check("state", normal, 2 * self.modes.len())?;
        finite("rates", self.flow.rates(normal, &self.phases(time)?)?)
    }

    /// The states at `times` after that of `state`, from the motion of the normal form, in which the actions are constant.
    ///
    /// # Errors
    /// - The errors of [`to_normal`](Self::to_normal) and [`frequencies`](Self::frequencies); a NaN among the times: [`Error::NotFinite`].
    pub fn trajectory(&self, state: &[f64], times: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        self.trajectory_from(state, 0.0, times)
    }

    /// The states at `times` after that of `state`, which is the state at the time `start`.
    ///
    /// # Errors
    /// - The errors of [`trajectory`](Self::trajectory); a `start` that is a NaN or infinite: [`Error::NotFinite`].
    pub fn trajectory_from(&self, state: &[f64], start: f64, times: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        check("times", times, times.len())?;
        let normal = self.to_normal_at(state, start)?;
        let frequencies = finite("frequencies", self.flow.frequencies(&flow::actions(&self.modes, &normal))?)?;
        let at =
            |&time: &f64| self.from_normal_at(&flow::advanced(&self.modes, &normal, &frequencies, time), start + time);
        times.iter().map(at).collect()
    }

    /// The driven phases at a time.
    fn phases(&self, time: f64) -> Result<Vec<f64>, Error> {
        let phases = self.driven.iter().map(|(frequency, phase)| phase + frequency * time).collect();
        if !time.is_finite() { finite("time", vec![time]) } else { finite("time", phases) }
    }

    /// Tables of powers of complex variables, and of e^{iM} as harmonics are stored: 1, e^{−iM}, e^{iM}, …
    fn powers(&self, point: &[Complex<f64>], phases: &[f64]) -> Vec<Vec<Complex<f64>>> {
        let one = Complex::new(1.0, 0.0);
        let mut powers: Vec<_> = point.iter().map(|&value| vec![one, value]).collect();
        if let Some(series) = self.direct.first().filter(|_| !phases.is_empty()) {
            powers.resize(series.driven, vec![one]); // the parameters, which have numbers
            powers.extend(phases.iter().map(|&phase| vec![one, Complex::cis(-phase), Complex::cis(phase)]));
        }
        powers
    }

    /// M z or M⁻¹ z.
    fn linear(&self, which: usize, state: &[f64]) -> Vec<f64> {
        self.linear[which].iter().map(|row| dot(row, state)).collect()
    }

    /// The images of real normal variables under one of the two transformations.
    fn transformed(&self, images: &[Series], mut powers: Vec<Vec<Complex<f64>>>) -> Result<Vec<f64>, Error> {
        let slots = self.modes.iter().enumerate().flat_map(|(mode, kind)| needed(mode, kind));
        let mut values = vec![Complex::default(); 2 * self.modes.len()];
        for (slot, series) in slots.zip(images) {
            values[slot] = series.evaluate(&mut powers);
        }
        finite("transformed state", flow::real_point(&self.modes, &values))
    }
}

/// The complex variables whose images determine the real variables of a mode.
pub(crate) fn needed(mode: usize, kind: &Mode<f64>) -> Vec<usize> {
    match kind {
        Mode::Elliptic { .. } => vec![2 * mode + 1],
        Mode::Complex { frequency, .. } if *frequency < 0.0 => Vec::new(),
        _ => vec![2 * mode, 2 * mode + 1],
    }
}

pub(crate) fn check(what: &'static str, values: &[f64], expected: usize) -> Result<(), Error> {
    if values.len() != expected {
        return Err(Error::CountMismatch { what, found: values.len(), expected });
    }
    finite(what, values.to_vec()).map(drop)
}

/// Refuses another number of actions than of modes, a NaN, and a negative action of a centre.
pub(crate) fn check_actions(modes: &[Mode<f64>], actions: &[f64]) -> Result<(), Error> {
    check("actions", actions, modes.len())?;
    match modes.iter().zip(actions).find(|(mode, action)| mode.is_elliptic() && **action < 0.0) {
        Some((_, &value)) => {
            Err(Error::OutsideInterval { argument: "actions", value, lower: 0.0, upper: f64::INFINITY })
        }
        None => Ok(()),
    }
}

pub(crate) fn finite(what: &'static str, values: Vec<f64>) -> Result<Vec<f64>, Error> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(values),
        Some(at) => Err(Error::NotFinite { what, term: format!("{} at {at}", values[at]) }),
    }
}
