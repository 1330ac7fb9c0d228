//! The series of the motion about the start of a step.
//!
//! With ω body rates, q the attitude, R its matrix, quadratic in q, and s = Rᵀr̃ for each disturbing body:
//!
//! ```text
//! q′ = ½ q ω,   ω1′ = f1 (Σ s2 s3 − ω2 ω3) with f1 = (I3 − I2)/I1, and in turn
//! ```
//!
//! Other torques ([`super::torques`]) are added to ω′.
//!
//! Products of series are sums over four lanes at once: of q with each rate, with itself, with its cyclic neighbours and with w; of cyclic neighbours of ω and of s; and of
//! r̃ with the cyclic diagonals of R. The matrix of a quaternion of norm 1 + ε is R (1 + 2ε), so that rounding of the norm is a relative rounding error of the torque.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::paths::path_series::PathSeries;
use super::products::{Factors, LAST, NEXT, ProductSums};
use super::series::{
    Coefficients, RECIPROCALS, ROWS, Row, Series, StateLanes, ZERO, add_product, added, four, largest, norm, tiled,
};
use super::torques::{PolynomialSeries, Torques};
use crate::input::scene::Scene;
use crate::simd::instruction_set::{InstructionSet, Task};

/// The equations of one state, W = 4, or more, in the unit of the integration.
#[derive(Clone, Debug)]
pub(super) struct Equations<const W: usize> {
    /// (I3 − I2)/I1 and so on.
    pub(super) factors: StateLanes<W>,
    pub(super) bodies: Vec<PathSeries>,
    /// Factor of the torque of each body: 1, and next to 1 for a state with displaced constants.
    pub(super) strengths: Vec<StateLanes<W>>,
    /// The torques beside the gravity gradient, and their factor in each state.
    pub(super) torques: Option<Arc<Torques>>,
    share: StateLanes<W>,
    /// The rate of the torques where they are weakest: √(3 Σμ) at the largest distance, and that of the other torques. Errors of rates are relative to this rate at least.
    pub(super) scale: f64,
}

impl Equations<4> {
    pub(super) fn new(scene: &Scene, exponent: i32, scale: f64) -> Self {
        let [first, second, third] = scene.body().ratios();
        let epoch = scene.state().epoch;
        let bodies: Vec<_> =
            scene.asked_disturbing().iter().map(|body| PathSeries::new(body, epoch, exponent)).collect();
        let strengths = vec![[1.0; 4]; bodies.len()];
        let factors = [first, second, third, 0.0];
        let torques = Torques::new(scene, exponent, false).map(Arc::new);
        Self { factors, bodies, strengths, torques, share: [1.0; 4], scale }
    }

    /// The equations of several states with displaced constants. `errors` has the relative errors of the ratios of the moments and of each torque; each state
    /// has factors of its own.
    pub(super) fn displaced<const W: usize>(&self, [ratios, torques]: [f64; 2], signs: &[Row]) -> Equations<W> {
        let factors = std::array::from_fn(|i| self.factors[i % 4] * (1.0 + ratios * signs[i / 4][i % 4]));
        // The fourth entries are 0: each body and each axis has one of the first three.
        let sign = |state: usize, number: usize| signs[state][number % 3];
        let strengths =
            (0..self.bodies.len()).map(|body| std::array::from_fn(|i| 1.0 + torques * sign(i / 4, body))).collect();
        let share = std::array::from_fn(|i| 1.0 + torques * sign(i / 4, i % 4 + 1));
        Equations {
            factors,
            bodies: self.bodies.clone(),
            strengths,
            torques: self.torques.clone(),
            share,
            scale: self.scale,
        }
    }

    /// Relative change of the integrals of the free motion, f2 ω1² − f1 ω2² and in turn: combinations of the energy and of the square of the angular momentum.
    pub(super) fn drift(&self, one: &[f64; 3], other: &[f64; 3]) -> f64 {
        let size = |rates: &[f64; 3]| rates.iter().map(|rate| rate * rate).sum::<f64>();
        let scale = size(one) * largest(&self.factors);
        let change = |i: usize| {
            let j = (i + 1) % 3;
            let by = |i: usize| (other[i] - one[i]) * (other[i] + one[i]);
            (self.factors[j] * by(i) - self.factors[i] * by(j)).abs()
        };
        let changes = change(0).max(change(1)).max(change(2));
        if scale > 0.0 { changes / scale } else { 0.0 }
    }

    /// These equations with tables interpolated by the earlier or the later of the neighbouring polynomials.
    pub(super) fn neighbouring(&self, earlier: bool) -> Self {
        Self {
            bodies: self.bodies.iter().map(|body| body.neighbouring(earlier)).collect(),
            torques: self.torques.as_ref().map(|torques| Arc::new(torques.neighbouring(earlier))),
            ..self.clone()
        }
    }
}

impl<const W: usize> Equations<W> {
    /// The bodies whose gravity gradients act, and those that are sources of other torques.
    pub(super) fn paths(&self) -> impl Iterator<Item = &PathSeries> {
        self.bodies.iter().chain(self.torques.iter().flat_map(|torques| torques.paths()))
    }

    /// Whether no torque acts.
    pub(super) fn is_free(&self) -> bool {
        self.bodies.is_empty() && self.torques.is_none()
    }
}

/// Where a step of one or more states begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start<const W: usize> {
    /// Time from the epoch, in double-double.
    pub(super) time: (f64, f64),
    pub(super) backward: bool,
    pub(super) attitude: StateLanes<W>,
    pub(super) rates: StateLanes<W>,
}

/// The series of a step of one state, W = 4, or more.
#[repr(align(64))]
pub(super) struct Workspace<const W: usize> {
    pub(super) attitude: [StateLanes<W>; ROWS],
    pub(super) rates: [StateLanes<W>; ROWS],
    /// The first coefficient of ω2 ω3, for rounding errors.
    pub(super) gyration: StateLanes<W>,
    /// Sums of the sizes of the parts of the angular acceleration by the torques beside the gravity gradient, for rounding errors.
    pub(super) further: StateLanes<W>,
    polynomials: Vec<PolynomialSeries>,
    factors: [Factors<W>; ROWS],
    places: Vec<Series>,
    /// The coefficients of r̃ of each body, and the next and the next but one of its components.
    paths: Vec<[[StateLanes<W>; 3]; ROWS]>,
    /// The least radius of convergence of the series of a body, infinite without a body.
    pub(super) radius: f64,
    /// The next and the next but one of s1, s2, s3 of each body.
    directions: Vec<[[StateLanes<W>; 2]; ROWS]>,
}

impl<const W: usize> Workspace<W> {
    pub(super) fn new(equations: &Equations<W>) -> Box<Self> {
        let bodies = equations.bodies.len();
        Box::new(Self {
            further: [0.0; W],
            polynomials: equations.torques.as_ref().map_or_else(Vec::new, |torques| torques.room(W / 4)),
            attitude: [[0.0; W]; ROWS],
            rates: [[0.0; W]; ROWS],
            gyration: [0.0; W],
            factors: [Factors::ZERO; ROWS],
            places: vec![ZERO; bodies],
            paths: vec![[[[0.0; W]; 3]; ROWS]; bodies],
            radius: f64::INFINITY,
            directions: vec![[[[0.0; W]; 2]; ROWS]; bodies],
        })
    }

    /// Coefficients 0 to `order`.
    #[inline(always)]
    pub(super) fn expand<S: InstructionSet>(
        &mut self,
        simd: S,
        equations: &Equations<W>,
        start: &Start<W>,
        order: usize,
    ) {
        self.radius = f64::INFINITY;
        for ((body, place), path) in equations.bodies.iter().zip(&mut self.places).zip(&mut self.paths) {
            self.radius = self.radius.min(body.series(simd.four(), (start.time, start.backward), order, place));
            for (row, place) in path.iter_mut().zip(&*place).take(order) {
                let [x, y, z, _] = *place;
                *row = [tiled(place), tiled(&[y, z, x, 0.0]), tiled(&[z, x, y, 0.0])];
            }
        }
        if let Some(torques) = &equations.torques {
            let time = (start.time, start.backward);
            self.radius = self.radius.min(torques.begin(simd.four(), time, order, &mut self.polynomials));
        }
        self.attitude[0] = start.attitude;
        self.rates[0] = start.rates;
        for k in 0..order {
            self.factors[k].set(simd, &self.attitude[k], &self.rates[k]);
            let mut sums = ProductSums::ZERO;
            // The newest coefficient comes last, so that the sums need not wait for it.
            for j in 1..k {
                sums.add(simd, &self.factors[j], &self.factors[k - j]);
            }
            sums.add(simd, &self.factors[0], &self.factors[k]);
            if k > 0 {
                sums.add(simd, &self.factors[k], &self.factors[0]);
            }
            let torque = self.torque(simd, (k, sums.diagonals(simd)), &equations.strengths);
            if k == 0 {
                self.gyration = sums.gyration;
            }
            let share = RECIPROCALS[k + 1];
            let turned = sums.turned(simd);
            for lane in 0..W {
                self.rates[k + 1][lane] = equations.factors[lane] * (torque[lane] - sums.gyration[lane]) * share;
                self.attitude[k + 1][lane] = 0.5 * share * turned[lane];
            }
            if let Some(torques) = &equations.torques {
                self.add_further(torques, &equations.share, k, share);
            }
        }
    }

    /// Adds the torques beside the gravity gradient to coefficient k + 1 of the rates.
    fn add_further(&mut self, torques: &Torques, factor: &StateLanes<W>, k: usize, share: f64) {
        for state in 0..W / 4 {
            let at = 4 * state;
            let (rates, factors) = (&self.rates, &self.factors);
            let rate = |j: usize| Vector3::new(rates[j][at], rates[j][at + 1], rates[j][at + 2]);
            let matrix = |j: usize| factors[j].matrix(state);
            let found = torques.coefficient((k, state), rate, matrix, &mut self.polynomials);
            for axis in 0..3 {
                self.rates[k + 1][at + axis] += found[axis] * factor[at + axis] * share;
            }
            if k == 0 {
                let rates = &self.rates[0];
                let sizes = torques.sizes(state, [rates[at], rates[at + 1], rates[at + 2]], &self.polynomials);
                self.further[at..at + 3].copy_from_slice(&sizes);
            }
        }
    }

    /// Sizes of the gravity gradient for its rounding errors over a step: Σ 2 |s| (|s2| + |s3|) (eˣ − 1)/x and in turn. A direction s = Rᵀ r̃ has errors relative to |s|, however
    /// small a component is. R and r̃ turn by x radians in a step. Where they turn together the coefficients of s are small, but they are sums of terms as large as
    /// those of eˣ, whose mean over the step this is: the rates are the integral of the torque. The factor is 2 because R is quadratic in q.
    #[inline(always)]
    pub(super) fn sizes(&self, length: f64) -> StateLanes<W> {
        let mut sizes = [0.0; W];
        for (place, series) in self.places.iter().zip(&self.directions) {
            let distance = norm(&place[0]);
            let turned = length * (norm(&four(&self.rates[0], 0)) + norm(&place[1]) / distance.max(f64::MIN_POSITIVE));
            let share = 2.0 * distance * if turned > 0.0 { turned.exp_m1() / turned } else { 1.0 };
            let [one, other] = &series[0];
            for lane in (0..W).filter(|lane| lane % 4 < 3) {
                sizes[lane] += share * (one[lane].abs() + other[lane].abs());
            }
        }
        sizes
    }

    /// Coefficient k of Σ s2 s3 and in turn.
    #[inline(always)]
    fn torque<S: InstructionSet>(
        &mut self,
        simd: S,
        (k, diagonals): (usize, [StateLanes<W>; 3]),
        strengths: &[StateLanes<W>],
    ) -> StateLanes<W> {
        let mut torque = [0.0; W];
        for (body, strength) in strengths.iter().enumerate() {
            let (path, directions) = (&self.paths[body], &mut self.directions[body]);
            let (mut sums, mut products) = ([[0.0; W]; 3], [0.0; W]);
            for j in 1..k {
                for diagonal in 0..3 {
                    let factors = &self.factors[j].diagonals[diagonal];
                    add_product(simd, &mut sums[diagonal], &path[k - j][diagonal], factors);
                }
                add_product(simd, &mut products, &directions[j][0], &directions[k - j][1]);
            }
            for diagonal in 0..3 {
                if k > 0 {
                    let factors = &self.factors[0].diagonals[diagonal];
                    add_product(simd, &mut sums[diagonal], &path[k][diagonal], factors);
                }
                add_product(simd, &mut sums[diagonal], &path[0][diagonal], &diagonals[diagonal]);
            }
            let direction = added(simd, &added(simd, &sums[0], &sums[1]), &sums[2]);
            let [one, other] = [simd.in_order::<NEXT, W>(&direction), simd.in_order::<LAST, W>(&direction)];
            directions[k] = [one, other];
            add_product(simd, &mut products, &directions[0][0], &other);
            if k > 0 {
                add_product(simd, &mut products, &one, &directions[0][1]);
            }
            add_product(simd, &mut torque, strength, &products);
        }
        self.factors[k].diagonals = diagonals;
        torque
    }
}

impl Workspace<4> {
    /// Coefficient k of the direction to a body with the strength of its torque, s, as (s2, s3, s1) and (s3, s1, s2).
    pub(super) fn direction(&self, body: usize, k: usize) -> &[Row; 2] {
        &self.directions[body][k]
    }

    /// Coefficient k of the matrix.
    pub(super) fn matrix(&self, k: usize) -> Matrix3<f64> {
        self.factors[k].matrix(0)
    }

    /// The series of the torques that are polynomials.
    pub(super) fn polynomials(&self) -> &[PolynomialSeries] {
        &self.polynomials
    }

    /// The coefficients of the motion up to an order.
    pub(super) fn coefficients(&self, order: usize) -> impl Iterator<Item = Coefficients> + '_ {
        self.attitude
            .iter()
            .zip(&self.rates)
            .take(order + 1)
            .map(|([x, y, z, w], [p, q, r, _])| [*x, *y, *z, *w, *p, *q, *r])
    }

    /// Takes the coefficients of the motion from those that were kept.
    pub(super) fn restore(&mut self, coefficients: &[Coefficients]) {
        for (k, [x, y, z, w, p, q, r]) in coefficients.iter().enumerate() {
            self.attitude[k] = [*x, *y, *z, *w];
            self.rates[k] = [*p, *q, *r, 0.0];
        }
    }

    /// Attitude and rates a time after the start of the step.
    #[inline(always)]
    pub(super) fn at(&self, time: f64, order: usize) -> (Row, Row) {
        let (mut attitude, mut rates) = (self.attitude[order], self.rates[order]);
        for k in (0..order).rev() {
            for lane in 0..4 {
                attitude[lane] = attitude[lane].mul_add(time, self.attitude[k][lane]);
                rates[lane] = rates[lane].mul_add(time, self.rates[k][lane]);
            }
        }
        (attitude, rates)
    }
}

/// The series of one step, for the best instruction set available.
pub(super) struct StepExpansion<'a> {
    pub(super) workspace: &'a mut Workspace<4>,
    pub(super) equations: &'a Equations<4>,
    pub(super) start: Start<4>,
    pub(super) order: usize,
}

impl Task for StepExpansion<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) {
        self.workspace.expand(simd, self.equations, &self.start, self.order);
    }
}
