//! The torques beside the gravity gradient, in the series of the motion: ω′ gains c + Lω + I⁻¹ Σ P(u, ω) Π (r₀/r)^p, with the constant torques in c, damping and
//! rotors in L, and the body components u of the unit vectors to the sources in the polynomials P.
//!
//! A monomial is a product of two shorter ones, so that each coefficient of its series is one sum of products of coefficients. Monomials with a common part share
//! its series.

use nalgebra::{Matrix3, Vector3};

use super::disturber::Disturber;
use super::interpolation::Table;
use super::series::{ROWS, Row, Scalars, Series, ZERO, product};
use crate::input::scene::Scene;
use crate::input::torque::{PolynomialTorque, SourcePath, Torque};
use crate::numerics::scaling::scaled;
use crate::simd::instruction_set::InstructionSet;

/// The torques of a scene in the unit of the integration, over the moments.
#[derive(Clone, Debug)]
pub(super) struct Torques {
    constant: Vector3<f64>,
    linear: Matrix3<f64>,
    polynomials: Vec<Recipe>,
}

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
}

/// A source: the unit vector to it, and (r₀/r)^p.
#[derive(Clone, Debug)]
struct SourceSeries {
    direction: Result<Disturber, [f64; 3]>,
    fall: Option<Disturber>,
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
    /// `None` for a scene without such torques.
    pub(super) fn new(scene: &Scene, exponent: i32) -> Option<Self> {
        if scene.asked_torques().is_empty() {
            return None;
        }
        let inverse = Matrix3::from_diagonal(&Vector3::from(scene.body().moments()).map(f64::recip));
        let (mut constant, mut linear, mut polynomials) = (Vector3::zeros(), Matrix3::zeros(), Vec::new());
        for torque in scene.asked_torques() {
            match torque {
                Torque::Constant(given) => constant += Vector3::from(*given),
                Torque::Damping(rows) => linear -= Matrix3::from_fn(|i, k| rows[i][k]),
                // −ω × h = h × ω.
                Torque::Rotor(momentum) => linear += Vector3::from(*momentum).cross_matrix(),
                Torque::Polynomial(torque) => polynomials.push(Recipe::new(torque, &inverse, scene, exponent)),
            }
        }
        let unit = |part: f64| scaled(part, -exponent);
        Some(Self {
            constant: (inverse * constant).map(|part| unit(unit(part))),
            linear: (inverse * linear).map(unit),
            polynomials,
        })
    }

    /// The rate that the torques bring in at the epoch: of damping and rotors, and the roots of the other accelerations.
    pub(super) fn rate(&self, rates: &Row) -> f64 {
        let fastest = rates.iter().fold(1.0_f64, |most, rate| most.max(rate.abs()));
        let polynomial = |recipe: &Recipe| {
            let size = |sum: &Vec<(f64, usize)>| sum.iter().map(|(c, _)| c.abs()).sum::<f64>();
            recipe.back.norm() * (recipe.sums.iter().map(size).sum::<f64>() * fastest + recipe.constants.norm())
        };
        let acceleration = self.constant.norm() + self.polynomials.iter().map(polynomial).sum::<f64>();
        self.linear.norm().max(acceleration.sqrt())
    }

    /// The bodies and tables of the sources.
    pub(super) fn paths(&self) -> impl Iterator<Item = &Disturber> {
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
                    let (before, factor) = (series.fall, fall.factor(simd, time, order));
                    series.fall = std::array::from_fn(|k| if k < order { product(&before, &factor, k) } else { 0.0 });
                }
            }
        }
        radius
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

impl Recipe {
    fn new(torque: &PolynomialTorque, inverse: &Matrix3<f64>, scene: &Scene, exponent: i32) -> Self {
        let epoch = scene.state().epoch;
        let sources = torque.sources().iter().map(|source| {
            let (power, reference) = source.distance_power();
            let path = |strength: f64, power: f64| match source.path() {
                SourcePath::Orbit(orbit) => Ok(Disturber::of_orbit(orbit, (epoch, exponent), (strength, power))),
                SourcePath::Tabulated(table) => Ok(Disturber::of_table(table, (epoch, exponent), (strength, power))),
                SourcePath::Direction(vector) => Err((Vector3::from(*vector).normalize()).into()),
            };
            // In the unit of length of the path.
            let size = match source.path() {
                SourcePath::Orbit(orbit) => orbit.asked_semi_major_axis().unwrap_or(1.0),
                SourcePath::Tabulated(table) => Table::length(table),
                SourcePath::Direction(_) => 1.0,
            };
            let fall = (power != 0.0).then(|| path((reference / size).powf(power), -power).ok()).flatten();
            SourceSeries { direction: path(1.0, -1.0), fall }
        });
        let sources: Vec<_> = sources.collect();
        let turn = torque.turn().to_rotation_matrix().into_inner();
        let unit = |part: f64| scaled(part, -exponent);
        let back = (inverse * turn.transpose()).map(|part| unit(unit(part)));
        let mut recipe = Self {
            turn,
            back,
            products: Vec::new(),
            sums: std::array::from_fn(|_| Vec::new()),
            constants: Vector3::zeros(),
            sources,
        };
        let mut known: Vec<Vec<u32>> = Vec::new();
        for (axis, terms) in torque.terms().iter().enumerate() {
            for (coefficient, exponents) in terms {
                // Rates are in the unit of the integration.
                let of_rates: u32 = exponents[exponents.len() - 3..].iter().sum();
                let coefficient = scaled(*coefficient, exponent * of_rates as i32); // the degree is at most 8
                match recipe.place(exponents, &mut known) {
                    Some(place) => recipe.sums[axis].push((coefficient, place)),
                    None => recipe.constants[axis] += coefficient,
                }
            }
        }
        recipe
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
