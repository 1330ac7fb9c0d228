//! The torques beside the gravity gradient, in the series of the motion: ω′ gains c + Lω + I⁻¹ Σ P(u, ω) Π (r₀/r)^p, with the constant torques in c, damping and
//! rotors in L, and the body components u of the unit vectors to the sources in the polynomials P.
//!
//! A monomial is a product of two shorter ones, so that each coefficient of its series is one sum of products of coefficients. Monomials with a common part share
//! its series.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::paths::interpolation::Table;
use super::paths::law_series::law_series;
use super::paths::path_series::PathSeries;
use super::rates::falls;
use super::series::{ROWS, Scalars, Series, ZERO, product};
use crate::input::distance_law::DistanceLaw;
use crate::input::scene::Scene;
use crate::input::torque::{PolynomialTorque, Torque};
use crate::input::torque_source::{SourcePath, TorqueSource};
use crate::numerics::scaling::scaled;
use crate::simd::instruction_set::InstructionSet;

/// The torques of a scene in the unit of the integration, over the moments.
#[derive(Clone, Debug)]
pub(super) struct Torques {
    constant: Vector3<f64>,
    linear: Matrix3<f64>,
    polynomials: Vec<Recipe>,
    /// Whether a torque can end the growth of the rates by another one: damping, or a polynomial in the rates.
    pub(super) brakes: bool,
}

/// Coefficients and places of monomials; no place is that of the constant 1.
type Slope = Vec<(f64, Option<usize>)>;

/// How the series of one polynomial torque are computed.
#[derive(Clone, Debug)]
struct Recipe {
    sources: Vec<SourceSeries>,
    /// From components about the axes of the scene to those of the polynomials.
    turn: Matrix3<f64>,
    /// From the polynomials to angular accelerations about the axes of the scene.
    back: Matrix3<f64>,
    /// The two factors of each product; the first places are those of the variables.
    products: Vec<[usize; 2]>,
    /// Coefficients and places of the monomials of each component.
    sums: [Vec<(f64, usize)>; 3],
    constants: Vector3<f64>,
    /// The derivatives of the components with respect to each variable, if they were asked for.
    slopes: Vec<[Slope; 3]>,
    /// The largest and the smallest acceleration at the rates of the epoch.
    size: [f64; 2],
    /// Rounding errors of a term, of its factors and of the powers of the distances, over those of a product of two.
    roundings: f64,
}

/// A source: the unit vector to it, and (r₀/r)^p or a law of it.
#[derive(Clone, Debug)]
struct SourceSeries {
    direction: Result<PathSeries, [f64; 3]>,
    fall: Option<PathSeries>,
    law: Option<Arc<DistanceLaw>>,
}

/// The series of one polynomial torque about the start of a step.
#[derive(Clone, Debug)]
pub(super) struct PolynomialSeries {
    /// The inertial unit vectors to the sources.
    places: Vec<Series>,
    /// Π (r₀/r)^p.
    fall: Scalars,
    /// The variables and products of each state.
    nodes: Vec<Vec<Scalars>>,
    /// The components of each state before the factor `fall`.
    sums: Vec<[Scalars; 3]>,
}

impl Torques {
    /// `None` for a scene without such torques. `slopes`: with the derivatives of the polynomials.
    pub(super) fn new(scene: &Scene, exponent: i32, slopes: bool) -> Option<Self> {
        Self::of(&scene.acting_torques(), (scene, exponent), slopes)
    }

    /// Of these torques alone; `None` for none.
    pub(super) fn of(torques: &[Torque], (scene, exponent): (&Scene, i32), slopes: bool) -> Option<Self> {
        if torques.is_empty() {
            return None;
        }
        let inverse = Matrix3::from_diagonal(&Vector3::from(scene.body().moments()).map(f64::recip));
        let (mut constant, mut linear, mut polynomials) = (Vector3::zeros(), Matrix3::zeros(), Vec::new());
        let (mut damping, mut brakes) = (Matrix3::zeros(), false);
        for torque in torques {
            match torque {
                Torque::Constant(given) => constant += Vector3::from(*given),
                Torque::Damping(rows) => damping += Matrix3::from_fn(|i, k| rows[i][k]),
                // −ω × h = h × ω.
                Torque::Rotor(momentum) => linear += Vector3::from(*momentum).cross_matrix(),
                // Solving refuses it.
                Torque::Dissipation(_) => {}
                Torque::Polynomial(torque) => {
                    let of_rates = |(_, powers): &(f64, Vec<u32>)| powers.iter().rev().take(3).any(|power| *power > 0);
                    brakes |= torque.terms().iter().flatten().any(of_rates);
                    polynomials.push(Recipe::new(torque, &inverse, (scene, exponent), slopes))
                }
            }
        }
        // Damping alone is linear: what grows by it grows on. Beside other torques it leads to a terminal rate.
        let others = constant != Vector3::zeros() || !polynomials.is_empty();
        brakes |= others && (damping + damping.transpose()).symmetric_eigenvalues().max() > 0.0;
        linear -= damping;
        let unit = |part: f64| scaled(part, -exponent);
        Some(Self {
            constant: (inverse * constant).map(|part| unit(unit(part))),
            linear: (inverse * linear).map(unit),
            polynomials,
            brakes,
        })
    }

    /// (largest rate of the torques at the epoch, largest rate that stays): those of damping and rotors, and the roots of the accelerations at the epoch's rates, with the
    /// sources at their nearest and at their farthest points.
    pub(super) fn rates(&self) -> [f64; 2] {
        [0, 1].map(|end| {
            let polynomials = self.polynomials.iter().map(|recipe| recipe.size[end]).sum::<f64>();
            self.linear.norm().max((self.constant.norm() + polynomials).sqrt())
        })
    }

    /// Sums of the sizes of all parts of the accelerations of one state at the start of a step, times the number of their rounding errors over that of a product of two.
    pub(super) fn sizes(&self, state: usize, rates: [f64; 3], series: &[PolynomialSeries]) -> [f64; 3] {
        let rates = Vector3::from(rates).abs();
        let mut sizes = self.constant.abs() + self.linear.abs() * rates;
        for (recipe, series) in self.polynomials.iter().zip(series) {
            let term = |(c, place): &(f64, usize)| (c * series.nodes[state][*place][0]).abs();
            let parts = Vector3::from_fn(|axis, _| {
                recipe.sums[axis].iter().map(term).sum::<f64>() + recipe.constants[axis].abs()
            });
            sizes += recipe.back.abs() * parts * (series.fall[0].abs() * recipe.roundings);
        }
        sizes.into()
    }

    /// The bodies and tables of the sources.
    pub(super) fn paths(&self) -> impl Iterator<Item = &PathSeries> {
        self.polynomials.iter().flat_map(|recipe| &recipe.sources).filter_map(|source| source.direction.as_ref().ok())
    }

    /// With tables interpolated by the earlier or the later of the neighbouring polynomials.
    pub(super) fn neighbouring(&self, earlier: bool) -> Self {
        let mut torques = self.clone();
        for source in torques.polynomials.iter_mut().flat_map(|recipe| &mut recipe.sources) {
            if let Ok(path) = &mut source.direction {
                *path = path.neighbouring(earlier);
            }
            source.fall = source.fall.as_ref().map(|path| path.neighbouring(earlier));
        }
        torques
    }

    /// Room for the series of so many states.
    pub(super) fn room(&self, states: usize) -> Vec<PolynomialSeries> {
        let room = |recipe: &Recipe| PolynomialSeries {
            places: vec![ZERO; recipe.sources.len()],
            fall: [0.0; ROWS],
            nodes: vec![vec![[0.0; ROWS]; recipe.variables() + recipe.products.len()]; states],
            sums: vec![[[0.0; ROWS]; 3]; states],
        };
        self.polynomials.iter().map(room).collect()
    }

    /// The series of the sources about a time. Returns the least radius of convergence.
    pub(super) fn begin<S: InstructionSet>(
        &self,
        simd: S,
        time: ((f64, f64), bool),
        order: usize,
        series: &mut [PolynomialSeries],
    ) -> f64 {
        let mut radius = f64::INFINITY;
        for (recipe, series) in self.polynomials.iter().zip(series) {
            series.fall = [0.0; ROWS];
            series.fall[0] = 1.0;
            for (source, place) in recipe.sources.iter().zip(&mut series.places) {
                match &source.direction {
                    Ok(path) => radius = radius.min(path.series(simd, time, order, place)),
                    Err([x, y, z]) => place[0] = [*x, *y, *z, 0.0],
                }
                if let Some(fall) = &source.fall {
                    let (before, ratio) = (series.fall, fall.factor(simd, time, order));
                    let factor = source.law.as_ref().map_or(ratio, |law| law_series(law, &ratio, order));
                    series.fall = std::array::from_fn(|k| if k < order { product(&before, &factor, k) } else { 0.0 });
                }
            }
        }
        radius
    }

    /// The derivatives of the angular accelerations with respect to a rotation about the body's axes and to the rates, up to an order.
    pub(super) fn derivatives(&self, order: usize, series: &[PolynomialSeries]) -> [Vec<Matrix3<f64>>; 2] {
        let mut by_angle = vec![Matrix3::zeros(); order];
        let mut by_rate = by_angle.clone();
        by_rate[0] = self.linear;
        for (recipe, series) in self.polynomials.iter().zip(series) {
            recipe.add_derivatives(order, series, [&mut by_angle, &mut by_rate]);
        }
        [by_angle, by_rate]
    }

    /// Coefficient k of the angular accelerations of one state, from the coefficients 0 to k of its rates and of the rows of its matrix.
    pub(super) fn coefficient(
        &self,
        (k, state): (usize, usize),
        rates: impl Fn(usize) -> Vector3<f64>,
        matrix: impl Fn(usize) -> Matrix3<f64>,
        series: &mut [PolynomialSeries],
    ) -> Vector3<f64> {
        let constant = if k == 0 { self.constant } else { Vector3::zeros() };
        let mut sum = constant + self.linear * rates(k);
        for (recipe, series) in self.polynomials.iter().zip(series) {
            sum += recipe.coefficient((k, state), &rates, &matrix, series);
        }
        sum
    }
}

impl SourceSeries {
    fn new(source: &TorqueSource, at: (f64, i32)) -> Self {
        let (power, reference) = source.distance_power();
        let path = |strength: f64, power: f64| match source.path() {
            SourcePath::Orbit(orbit) => Ok(PathSeries::of_orbit(orbit, at, (strength, power))),
            SourcePath::Tabulated(table) => Ok(PathSeries::of_table(table, at, (strength, power))),
            SourcePath::Field(field) => Ok(PathSeries::of_field(field, at, (strength, power))),
            SourcePath::Direction(vector) => {
                let vector = Vector3::from(*vector);
                Err((vector / vector.amax()).normalize().into())
            }
        };
        // In the unit of length of the path.
        let size = match source.path() {
            SourcePath::Orbit(orbit) => orbit.asked_semi_major_axis().unwrap_or(1.0),
            SourcePath::Tabulated(table) => Table::length(table),
            SourcePath::Field(field) => field.equatorial(),
            SourcePath::Direction(_) => 1.0,
        };
        let fall = (power != 0.0).then(|| path((reference / size).powf(power), -power).ok()).flatten();
        Self { direction: path(1.0, -1.0), fall, law: source.law().cloned() }
    }
}

impl Recipe {
    fn new(torque: &PolynomialTorque, inverse: &Matrix3<f64>, (scene, exponent): (&Scene, i32), slopes: bool) -> Self {
        let epoch = scene.state().epoch;
        let sources = torque.sources().iter().map(|source| SourceSeries::new(source, (epoch, exponent))).collect();
        let turn = torque.turn();
        let unit = |part: f64| scaled(part, -exponent);
        let back = (inverse * turn.transpose()).map(|part| unit(unit(part)));
        let mut recipe = Self {
            turn,
            back,
            products: Vec::new(),
            sums: std::array::from_fn(|_| Vec::new()),
            constants: Vector3::zeros(),
            slopes: Vec::new(),
            sources,
            size: [0.0; 2],
            roundings: 0.0,
        };
        let (spin, mut size, mut degree) = (scaled(scene.state().angular_velocity.norm(), -exponent), 0.0, 0);
        let mut known: Vec<Vec<u32>> = Vec::new();
        for (axis, terms) in torque.terms().iter().enumerate() {
            for (coefficient, exponents) in terms {
                // Rates are in the unit of the integration.
                let of_rates: u32 = exponents[exponents.len() - 3..].iter().sum();
                let coefficient = scaled(*coefficient, exponent * of_rates as i32); // the degree is at most 8
                size += coefficient.abs() * spin.powi(of_rates as i32);
                degree = degree.max(exponents.iter().sum());
                match recipe.place(exponents, &mut known) {
                    Some(place) => recipe.sums[axis].push((coefficient, place)),
                    None => recipe.constants[axis] += coefficient,
                }
            }
        }
        let power = |source: &TorqueSource| {
            source.law().map_or(source.distance_power().0.abs(), |law| law.coefficients().len() as f64)
        };
        let powers = torque.sources().iter().map(power).sum::<f64>();
        let of_field = torque.sources().iter().any(|source| matches!(source.path(), SourcePath::Field(_)));
        // A direction of a field is a polynomial of degree 3 in those of its orbit and its moment.
        let operations = if of_field { 4.0 } else { 1.0 };
        recipe.roundings = 0.5 * (1.0 + operations * (f64::from(degree) + powers));
        let falls = torque.sources().iter().map(|source| falls(source, scene));
        let falls = falls.fold([1.0; 2], |product, falls| [product[0] * falls[0], product[1] * falls[1]]);
        recipe.size = falls.map(|fall| recipe.back.norm() * size * fall);
        if slopes {
            recipe.add_slopes(torque, exponent, &mut known);
        }
        recipe
    }

    /// Adds the derivatives of the components with respect to each variable.
    fn add_slopes(&mut self, torque: &PolynomialTorque, exponent: i32, known: &mut Vec<Vec<u32>>) {
        for variable in 0..self.variables() {
            let slope = torque.terms().each_ref().map(|terms| {
                let terms = terms.iter().filter(|(_, exponents)| exponents[variable] > 0);
                let term = |(coefficient, exponents): &(f64, Vec<u32>)| {
                    let of_rates: u32 = exponents[exponents.len() - 3..].iter().sum();
                    let power = f64::from(exponents[variable]);
                    let mut rest = exponents.clone();
                    rest[variable] -= 1;
                    (power * scaled(*coefficient, exponent * of_rates as i32), self.place(&rest, known))
                };
                terms.map(term).collect()
            });
            self.slopes.push(slope);
        }
    }

    /// Adds the derivatives of the angular accelerations of the first state with respect to a rotation about the body's axes and to the rates, up to an order.
    fn add_derivatives(&self, order: usize, series: &PolynomialSeries, [by_angle, by_rate]: [&mut [Matrix3<f64>]; 2]) {
        let nodes = &series.nodes[0];
        let value = |sum: &Slope, k: usize| -> f64 {
            let constant = if k == 0 { 1.0 } else { 0.0 };
            sum.iter().map(|(c, place)| c * place.map_or(constant, |place| nodes[place][k])).sum()
        };
        let slope = |sum: &Slope| -> Scalars {
            let own: Scalars = std::array::from_fn(|k| if k < order { value(sum, k) } else { 0.0 });
            std::array::from_fn(|k| if k < order { product(&own, &series.fall, k) } else { 0.0 })
        };
        let slopes: Vec<[Scalars; 3]> = self.slopes.iter().map(|sums| sums.each_ref().map(slope)).collect();
        // The columns of three variables.
        let matrix = |first: usize, k: usize| Matrix3::from_fn(|row, column| slopes[first + column][row][k]);
        let sources = series.places.len();
        for k in 0..order {
            by_rate[k] += self.back * matrix(3 * sources, k) * self.turn;
            for source in 0..sources {
                for j in 0..=k {
                    let direction = Vector3::from_fn(|axis, _| nodes[3 * source + axis][k - j]);
                    by_angle[k] += self.back * matrix(3 * source, j) * direction.cross_matrix() * self.turn;
                }
            }
        }
    }

    fn variables(&self) -> usize {
        3 * (self.sources.len() + 1)
    }

    /// The place of a monomial, which is added with its parts if it is not known. `None` for the constant 1.
    fn place(&mut self, exponents: &[u32], known: &mut Vec<Vec<u32>>) -> Option<usize> {
        let last = exponents.iter().rposition(|power| *power > 0)?;
        let mut rest = exponents.to_vec();
        rest[last] -= 1;
        if rest.iter().all(|power| *power == 0) {
            return Some(last);
        }
        if let Some(place) = known.iter().position(|other| other == exponents) {
            return Some(self.variables() + place);
        }
        let part = self.place(&rest, known)?;
        known.push(exponents.to_vec());
        self.products.push([part, last]);
        Some(self.variables() + self.products.len() - 1)
    }

    fn coefficient(
        &self,
        (k, state): (usize, usize),
        rates: &impl Fn(usize) -> Vector3<f64>,
        matrix: &impl Fn(usize) -> Matrix3<f64>,
        series: &mut PolynomialSeries,
    ) -> Vector3<f64> {
        let PolynomialSeries { places, fall, nodes, sums } = series;
        let (nodes, sums) = (&mut nodes[state], &mut sums[state]);
        for (source, place) in places.iter().enumerate() {
            let mut direction = Vector3::zeros();
            for j in 0..=k {
                let [x, y, z, _] = place[k - j];
                direction += matrix(j).tr_mul(&Vector3::new(x, y, z));
            }
            let turned = self.turn * direction;
            (0..3).for_each(|axis| nodes[3 * source + axis][k] = turned[axis]);
        }
        let turned = self.turn * rates(k);
        (0..3).for_each(|axis| nodes[3 * places.len() + axis][k] = turned[axis]);
        let first = self.variables();
        for (place, [one, other]) in self.products.iter().enumerate() {
            nodes[first + place][k] = product(&nodes[*one], &nodes[*other], k);
        }
        let mut torque = Vector3::zeros();
        for axis in 0..3 {
            let constant = if k == 0 { self.constants[axis] } else { 0.0 };
            sums[axis][k] = self.sums[axis].iter().map(|(c, place)| c * nodes[*place][k]).sum::<f64>() + constant;
            torque[axis] = product(&sums[axis], fall, k);
        }
        self.back * torque
    }
}
