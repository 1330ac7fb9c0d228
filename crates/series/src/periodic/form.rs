//! The normal form about a periodic motion, and its evaluation.
//!
//! H is expanded about x̄(M) in the variables u, U of Floquet's frame; a coefficient is a periodic function. The terms are graded by degree alone, and Deprit's triangle is
//! that of every normal form: only the solution of the homological equation knows the grid. A term h(M) u^a U^b with the harmonics h_j has
//!
//! ```text
//! S_j = h_j / (i ((b − a)·ω + j·n)),    kept: b = a and j = 0
//! ```
//!
//! The normal form K is a polynomial in the actions, and the direct transformation at fixed actions a Fourier series in the proper angles and the driven phases.

use std::collections::BTreeMap;

use num_complex::Complex;
use num_traits::Zero;

use super::grid::Grid;
use super::motion::{DrivenHamiltonian, Exponent, PeriodicMotion};
use super::row::{Periodic, product};
use crate::birkhoff::matrix::symplectic_inverse;
use crate::bracket::Poisson;
use crate::error::Error;
use crate::monomial::Monomial;
use crate::polynomial::Polynomial;
use crate::triangle::{LieTransform, Progress, Removal, normalize_by};

/// Harmonics to begin with, and the most of one phase; a grid that is too coarse grows by half.
const FEWEST: usize = 3;
const MOST: usize = 255;
/// Grids without a solution after which there is none.
const FAILURES: usize = 4;
/// Harmonics below this part of the largest one of a generator have no divisor that counts.
const NEGLIGIBLE: f64 = 1e-10;
/// Divisors that are kept for the user.
const DIVISORS: usize = 20;
/// Most steps to normal coordinates, and the smallest factor by which a step that counts comes nearer.
const STEPS: usize = 80;
const SLOWEST: f64 = 0.9;

/// What a normal form about a periodic motion is to have.
#[derive(Clone, Copy, Debug)]
pub struct DrivenOptions {
    /// Terms to degree `order` + 2.
    pub order: usize,
    /// Harmonics at the border of the grid are at most this, relative to variables of size 1.
    pub tolerance: f64,
    /// A divisor below this, relative to the largest frequency, is refused.
    pub smallest_divisor: f64,
}

/// A small divisor |k·ω + j·n| of a generator.
#[derive(Clone, Debug, PartialEq)]
pub struct Divisor {
    /// k, then j.
    pub multiples: Vec<i64>,
    /// k·ω + j·n [rad per unit of time].
    pub value: f64,
}

/// One harmonic of a motion: each variable is the sum of Re(amplitude · e^{i(k·φ + j·M)}).
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonic {
    /// The integers k of the proper angles, then those j of the driven phases. The first that is not 0 is positive.
    pub multiples: Vec<i64>,
    /// The amplitudes of q₁, p₁, q₂, p₂, …
    pub amplitudes: Vec<Complex<f64>>,
}

/// The normal form of a driven Hamiltonian about its periodic motion.
#[derive(Clone, Debug)]
pub struct DrivenForm {
    pub(super) motion: PeriodicMotion,
    pub(super) transform: LieTransform<Periodic>,
    /// K in u and U without the constant.
    hamiltonian: Polynomial<Complex<f64>>,
    /// ∂K/∂I of the modes, in the actions.
    frequencies: Vec<Polynomial<f64>>,
    /// The old U of each mode, a function of the new variables; for saddles u as well.
    images: Vec<(usize, Polynomial<Periodic>)>,
    divisors: Vec<Divisor>,
}

impl DrivenForm {
    /// The normal form about the periodic motion that continues the equilibrium 0 of the Hamiltonian without its drive. `rates` are those of the phases
    /// [rad per unit of time]. The number of times of a phase grows until its last harmonics are below the tolerance.
    ///
    /// # Errors
    /// - no periodic motion: [`Error::NoPeriodicMotion`]; no frame: [`Error::MultiplierUnsupported`]; a divisor below the smallest: [`Error::SmallDivisor`];
    /// - more than 511 times of a phase: [`Error::GridTooFine`]; a callback that returns `Break`: [`Error::Interrupted`].
    pub fn new(
        system: &dyn DrivenHamiltonian,
        rates: &[f64],
        options: DrivenOptions,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let motion = settled(system, rates, options.tolerance)?;
        Self::about(system, motion, options, progress)
    }

    fn about(
        system: &dyn DrivenHamiltonian,
        motion: PeriodicMotion,
        options: DrivenOptions,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let pairs = system.pairs();
        let poisson = Poisson::new(&(0..pairs).map(|mode| (2 * mode, 2 * mode + 1)).collect::<Vec<_>>())?;
        let degree = options.order as u32 + 2;
        let expanded = system.expanded(&motion.grid, &motion.variables()?, degree)?;
        let mut series = vec![Polynomial::zero(); options.order + 1];
        for (mode, exponent) in motion.exponents.iter().enumerate() {
            let action = Monomial::ONE.with(2 * mode, 1)?.with(2 * mode + 1, 1)?;
            series[0].add_term(action, &Periodic::Constant(exponent.eigenvalues()[0]));
        }
        for (monomial, c) in expanded.terms() {
            if let Some(order @ 1..) = (monomial.total_degree() as usize).checked_sub(2) {
                series[order].add_term(monomial, c);
            }
        }
        let fastest = motion.exponents.iter().map(|one| one.frequency().norm()).fold(0.0, f64::max);
        let bound = options.smallest_divisor * fastest;
        let solve = |order: usize, known: &Polynomial<Periodic>| removal(&motion, bound, order, known);
        let normal = normalize_by(&series, &poisson, options.order, &solve, progress)?;
        let mut hamiltonian = Polynomial::zero();
        for part in &normal.hamiltonian {
            hamiltonian += &part.map(Periodic::mean);
        }
        let transform = normal.transform;
        let mut images = Vec::new();
        for (mode, exponent) in motion.exponents.iter().enumerate() {
            let slots = if matches!(exponent, Exponent::Centre(_)) { 1..2 } else { 0..2 };
            for slot in slots.map(|slot| 2 * mode + slot) {
                let mut image = Polynomial::zero();
                for part in transform.direct_with(&Polynomial::variable(slot)?, progress)? {
                    image += &part;
                }
                images.push((slot, image));
            }
        }
        let divisors = divisors(&motion, &transform);
        let frequencies = frequencies(&hamiltonian, &motion.exponents)?;
        Ok(Self { motion, transform, hamiltonian, frequencies, images, divisors })
    }

    /// The order.
    #[must_use]
    pub fn order(&self) -> usize {
        self.transform.order()
    }

    /// The times of the driven phases.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.motion.grid
    }

    /// The exponents of Floquet, on the branch that continues the modes without drive.
    #[must_use]
    pub fn exponents(&self) -> &[Exponent] {
        &self.motion.exponents
    }

    /// The smallest divisors of the generators, the smallest first.
    #[must_use]
    pub fn divisors(&self) -> &[Divisor] {
        &self.divisors
    }

    /// K in the complex variables u₁, U₁, …; for a centre u U = i I.
    #[must_use]
    pub fn in_complex(&self) -> &Polynomial<Complex<f64>> {
        &self.hamiltonian
    }

    /// K in the actions: I = (q² + p²)/2 of a centre and q p of a saddle.
    ///
    /// # Errors
    /// - None: K has no exponent beyond those of its terms.
    pub fn in_actions(&self) -> Result<Polynomial<f64>, Error> {
        in_actions(&self.hamiltonian, &self.motion.exponents)
    }

    /// Its memory, in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        let of = |polynomial: &Polynomial<Periodic>| -> usize {
            polynomial.terms().map(|(_, c)| c.memory() + size_of::<Monomial>()).sum()
        };
        let generators = (1..=self.order()).filter_map(|m| self.transform.scaled_generator(m)).map(of).sum::<usize>();
        generators + self.images.iter().map(|(_, image)| of(image)).sum::<usize>()
    }

    /// The periodic motion q₁, p₁, … at phases \[rad\].
    #[must_use]
    pub fn periodic(&self, phases: &[f64]) -> Vec<f64> {
        let weights = self.grid().weights(phases);
        self.motion.origin.iter().map(|x| x.weighted(&weights).re).collect()
    }

    /// Floquet's frame at phases \[rad\]: P with the rows q₁, p₁, … and the columns u₁, U₁, …, and P⁻¹.
    #[must_use]
    pub fn frame(&self, phases: &[f64]) -> [Vec<Vec<Complex<f64>>>; 2] {
        let weights = self.grid().weights(phases);
        let row = |row: &Vec<Periodic>| row.iter().map(|c| c.weighted(&weights)).collect();
        let change: Vec<Vec<Complex<f64>>> = self.motion.change.iter().map(row).collect();
        let inverse = symplectic_inverse(&change);
        [change, inverse]
    }

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

    /// The rates ∂K/∂I at actions: frequencies of centres, growth rates of saddles.
    ///
    /// # Errors
    /// - another number of actions: [`Error::CountMismatch`]; a result that is not finite: [`Error::NotFinite`].
    pub fn frequencies(&self, actions: &[f64]) -> Result<Vec<f64>, Error> {
        crate::birkhoff::map::check("actions", actions, self.motion.exponents.len())?;
        self.frequencies.iter().map(|frequency| frequency.evaluate(actions)).collect()
    }

    /// The state as a Fourier series in the proper angles and the driven phases, at fixed actions of centres. Harmonics whose amplitudes are all at most `least` are left out.
    ///
    /// # Errors
    /// - the errors of [`frequencies`](Self::frequencies); a mode that is no centre: [`Error::CountMismatch`].
    pub fn fourier(&self, actions: &[f64], least: f64) -> Result<Vec<Harmonic>, Error> {
        self.frequencies(actions)?;
        self.centres()?;
        let (modes, grid, n) = (actions.len(), self.grid(), self.motion.origin.len());
        let mut sums: BTreeMap<Vec<i64>, Vec<Complex<f64>>> = BTreeMap::new();
        let mut join = |mut multiples: Vec<i64>, variable: usize, c: Complex<f64>| {
            let negative = multiples.iter().find(|&&k| k != 0).is_some_and(|&k| k < 0);
            if negative {
                multiples.iter_mut().for_each(|k| *k = -*k);
            }
            let sums = sums.entry(multiples).or_insert_with(|| vec![Complex::default(); n]);
            sums[variable] += if negative { c.conj() } else { c };
        };
        for (variable, x) in self.motion.origin.iter().enumerate() {
            for (at, c) in grid.harmonics(x).into_iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                join([vec![0; modes], grid.multiples(at)].concat(), variable, c);
            }
        }
        let mut rows: BTreeMap<Vec<i64>, Vec<(usize, Periodic)>> = BTreeMap::new();
        for (slot, image) in &self.images {
            for (k, row) in by_angles(image, actions) {
                rows.entry(k).or_default().push((*slot, row));
            }
        }
        for (k, rows) in rows {
            let column: Vec<Vec<Periodic>> = rows.iter().map(|(_, row)| vec![row.clone()]).collect();
            let used: Vec<Vec<Periodic>> = (self.motion.change.iter())
                .map(|row| rows.iter().map(|(slot, _)| row[*slot].clone()).collect())
                .collect();
            for (variable, sum) in product(&used, &column).into_iter().enumerate() {
                if 2.0 * sum[0].size() <= least / grid.times() as f64 {
                    continue;
                }
                for (at, c) in grid.harmonics(&sum[0]).into_iter().enumerate() {
                    join([k.clone(), grid.multiples(at)].concat(), variable, c * 2.0);
                }
            }
        }
        let counts = |amplitudes: &[Complex<f64>]| amplitudes.iter().any(|c| c.norm() > least);
        let kept = sums.into_iter().filter(|(_, amplitudes)| counts(amplitudes));
        Ok(kept.map(|(multiples, amplitudes)| Harmonic { multiples, amplitudes }).collect())
    }

    /// Refuses modes that are no centres.
    fn centres(&self) -> Result<(), Error> {
        let exponents = &self.motion.exponents;
        let found = exponents.iter().filter(|exponent| matches!(exponent, Exponent::Centre(_))).count();
        if found == exponents.len() {
            return Ok(());
        }
        Err(Error::CountMismatch { what: "centres", found, expected: exponents.len() })
    }
}

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
        crate::birkhoff::map::check("state", normal, self.origin.len())?;
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
        crate::birkhoff::map::check("state", state, self.origin.len())?;
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

/// The periodic motion on a grid that is fine enough. A grid that is too coarse can have no solution; after two of them there is none.
fn settled(system: &dyn DrivenHamiltonian, rates: &[f64], tolerance: f64) -> Result<PeriodicMotion, Error> {
    let mut halves = vec![FEWEST; rates.len()];
    let (mut known, mut failures) = (None, 0);
    loop {
        let phases: Vec<_> = rates.iter().copied().zip(halves.iter().copied()).collect();
        let found = PeriodicMotion::new(system, Grid::new(&phases), known.as_ref());
        let tails = match &found {
            Ok(motion) => motion.tails.clone(),
            Err(_) => vec![f64::INFINITY; rates.len()],
        };
        failures += usize::from(found.is_err());
        let coarse: Vec<bool> = tails.iter().map(|&tail| tail > tolerance).collect();
        if !coarse.contains(&true) || failures == FAILURES || rates.is_empty() {
            return found;
        }
        if halves.iter().zip(&coarse).any(|(&half, &coarse)| coarse && 2 * half > MOST) {
            let rest = tails.iter().copied().fold(0.0, f64::max);
            return found.and(Err(Error::GridTooFine { harmonics: MOST, rest, tolerance }));
        }
        known = found.ok();
        for (half, _) in halves.iter_mut().zip(coarse).filter(|(_, coarse)| *coarse) {
            *half += *half / 2 + 1;
        }
    }
}

/// k = b − a of u^a U^b.
fn turns(monomial: Monomial, modes: usize) -> Vec<i64> {
    (0..modes).map(|mode| i64::from(monomial.exponent(2 * mode + 1)) - i64::from(monomial.exponent(2 * mode))).collect()
}

/// The solution of the homological equation. For saddles the divisor is complex: k·ω with ω = iλ.
fn removal(
    motion: &PeriodicMotion,
    bound: f64,
    order: usize,
    known: &Polynomial<Periodic>,
) -> Result<Removal<Periodic>, Error> {
    let (mut image, mut solution) = (Vec::new(), Vec::new());
    let grid = &motion.grid;
    for (monomial, c) in known.terms() {
        if monomial == Monomial::ONE {
            image.push((monomial, c.clone()));
            continue;
        }
        let k = turns(monomial, motion.exponents.len());
        let own: Complex<f64> = k.iter().zip(&motion.exponents).map(|(&k, one)| one.frequency() * k as f64).sum();
        let still = k.iter().all(|&k| k == 0);
        let mut harmonics = grid.harmonics(c);
        let removed = if still {
            let mean = std::mem::take(&mut harmonics[0]);
            let mut rest = c.clone();
            rest -= &Periodic::Constant(mean);
            rest
        } else {
            c.clone()
        };
        for (at, c) in harmonics.iter_mut().enumerate().filter(|(_, c)| !c.is_zero()) {
            let divisor = own + grid.rate(at);
            if divisor.norm() < bound {
                let j = grid.multiples(at);
                return Err(Error::SmallDivisor {
                    order,
                    term: format!("multiples {j:?} of the driven phases"),
                    k: [k, j].concat(),
                    divisor: divisor.norm(),
                    bound,
                });
            }
            *c /= Complex::<f64>::i() * divisor;
        }
        image.push((monomial, removed));
        solution.push((monomial, grid.function(&harmonics)));
    }
    Ok(Removal { image: Polynomial::from_terms(image), solution: Polynomial::from_terms(solution) })
}

/// The smallest divisors of harmonics that count.
fn divisors(motion: &PeriodicMotion, transform: &LieTransform<Periodic>) -> Vec<Divisor> {
    let mut found: BTreeMap<Vec<i64>, f64> = BTreeMap::new();
    for generator in (1..=transform.order()).filter_map(|m| transform.scaled_generator(m)) {
        let most = generator.terms().map(|(_, c)| c.size()).fold(0.0, f64::max);
        for (monomial, c) in generator.terms() {
            let k = turns(monomial, motion.exponents.len());
            for (at, c) in motion.grid.harmonics(c).into_iter().enumerate() {
                if c.norm() <= NEGLIGIBLE * most {
                    continue;
                }
                let mut multiples = [k.clone(), motion.grid.multiples(at)].concat();
                if multiples.iter().find(|&&k| k != 0).is_some_and(|&k| k < 0) {
                    multiples.iter_mut().for_each(|k| *k = -*k);
                }
                let own: Complex<f64> =
                    multiples.iter().zip(&motion.exponents).map(|(&k, one)| one.frequency() * k as f64).sum();
                let driven: f64 =
                    multiples[k.len()..].iter().zip(motion.grid.rates()).map(|(&j, rate)| j as f64 * rate).sum();
                let value = own + driven;
                found.insert(multiples, if value.im == 0.0 { value.re } else { value.norm() });
            }
        }
    }
    let mut all: Vec<_> = found.into_iter().map(|(multiples, value)| Divisor { multiples, value }).collect();
    all.sort_by(|a, b| a.value.abs().total_cmp(&b.value.abs()));
    all.truncate(DIVISORS);
    all
}

fn in_actions(hamiltonian: &Polynomial<Complex<f64>>, exponents: &[Exponent]) -> Result<Polynomial<f64>, Error> {
    let mut sum = Polynomial::zero();
    for (monomial, c) in hamiltonian.terms() {
        let mut target = Monomial::ONE;
        let mut factor = *c;
        for (mode, exponent) in exponents.iter().enumerate() {
            let power = monomial.exponent(2 * mode);
            target = target.with(mode, power)?;
            if matches!(exponent, Exponent::Centre(_)) {
                factor *= Complex::<f64>::i().powu(power);
            }
        }
        sum.add_term(target, &factor.re);
    }
    Ok(sum)
}

fn frequencies(hamiltonian: &Polynomial<Complex<f64>>, exponents: &[Exponent]) -> Result<Vec<Polynomial<f64>>, Error> {
    let actions = in_actions(hamiltonian, exponents)?;
    (0..exponents.len()).map(|mode| actions.derivative(mode)).collect()
}

/// The image of U at fixed actions of centres: k, and the function before e^{ik·φ}.
fn by_angles(image: &Polynomial<Periodic>, actions: &[f64]) -> Vec<(Vec<i64>, Periodic)> {
    let sizes: Vec<f64> = actions.iter().map(|action| (2.0 * action).sqrt()).collect();
    let mut terms = Vec::new();
    for (monomial, c) in image.terms() {
        // u = (i/2) √(2I) e^{−iφ}, U = √(2I) e^{iφ}
        let mut factor = Complex::new(1.0, 0.0);
        for (mode, size) in sizes.iter().enumerate() {
            let [a, b] = [2 * mode, 2 * mode + 1].map(|slot| monomial.exponent(slot));
            factor *= Complex::new(0.0, 0.5).powu(a) * size.powi((a + b) as i32);
        }
        terms.push((turns(monomial, actions.len()), factor, c));
    }
    terms.sort_by(|a, b| a.0.cmp(&b.0));
    let mut sums: Vec<(Vec<i64>, Periodic)> = Vec::new();
    for group in terms.chunk_by(|a, b| a.0 == b.0) {
        let factors: Vec<_> = group.iter().map(|(_, factor, c)| (*factor, *c)).collect();
        sums.push((group[0].0.clone(), Periodic::combined(&factors)));
    }
    sums
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
