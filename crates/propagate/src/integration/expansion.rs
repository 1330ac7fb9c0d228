//! The series of the motion about the start of a step.
//!
//! With ω body rates, q the attitude, R its matrix, quadratic in q, and s = Rᵀr̃ for each disturbing body:
//!
//! ```text
//! q′ = ½ q ω,   ω1′ = f1 (Σ s2 s3 − ω2 ω3) with f1 = (I3 − I2)/I1, and in turn
//! ```
//!
//! Products of series are sums over four lanes at once: q with three permuted columns, the rows of R, cyclic neighbours of ω and s. The matrix of a quaternion of norm 1 + ε is R (1 + 2ε), so
//! that rounding of the norm is a relative rounding error of the torque.

use super::disturber::Disturber;
use super::series::{Coefficients, Row, Series, ZERO, add_product, add_scaled, largest};
use crate::input::scene::Scene;

/// The equations, in the unit of the integration.
#[derive(Clone, Debug)]
pub(super) struct Equations {
    /// (I3 − I2)/I1 and so on.
    pub(super) factors: Row,
    pub(super) bodies: Vec<Disturber>,
    /// √(3 Σμ) at the mean distance: the least rate that errors of rates are relative to.
    pub(super) scale: f64,
}

impl Equations {
    pub(super) fn new(scene: &Scene, exponent: i32, scale: f64) -> Self {
        let [a, b, c] = scene.body().moments();
        let epoch = scene.state().epoch;
        let bodies = scene.asked_disturbing().iter().map(|body| Disturber::new(body, epoch, exponent)).collect();
        Self { factors: [(c - b) / a, (a - c) / b, (b - a) / c, 0.0], bodies, scale }
    }

    /// The same with the relative errors of the constants: those of the ratios of the moments, and those of each torque.
    pub(super) fn displaced(&self, [ratios, torques]: [f64; 2], signs: &Row) -> Self {
        let factors = std::array::from_fn(|i| self.factors[i] * (1.0 + ratios * signs[i]));
        let bodies = self.bodies.iter().zip(signs.iter().cycle());
        let bodies = bodies.map(|(body, sign)| body.strengthened(1.0 + 0.5 * torques * sign)).collect();
        Self { factors, bodies, ..*self }
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

    /// The same with tables interpolated by polynomials of lower degree.
    pub(super) fn coarser(&self) -> Self {
        Self { bodies: self.bodies.iter().map(Disturber::coarser).collect(), ..self.clone() }
    }
}

/// Where a step begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// Time from the epoch, in double-double.
    pub(super) time: (f64, f64),
    pub(super) backward: bool,
    pub(super) attitude: Row,
    pub(super) rates: Row,
}

/// The series of a step.
pub(super) struct Workspace {
    pub(super) attitude: Series,
    pub(super) rates: Series,
    /// First coefficients of the parts of Euler's equations: Σ s2 s3 and ω2 ω3.
    pub(super) parts: [Row; 2],
    columns: [Series; 3],
    neighbours: [Series; 2],
    matrix: [Series; 3],
    places: Vec<Series>,
    directions: Vec<[Series; 2]>,
}

impl Workspace {
    pub(super) fn new(bodies: usize) -> Box<Self> {
        Box::new(Self {
            attitude: ZERO,
            rates: ZERO,
            parts: [[0.0; 4]; 2],
            columns: [ZERO; 3],
            neighbours: [ZERO; 2],
            matrix: [ZERO; 3],
            places: vec![ZERO; bodies],
            directions: vec![[ZERO; 2]; bodies],
        })
    }

    /// Coefficients 0 to `order`.
    #[inline(always)]
    pub(super) fn expand(&mut self, equations: &Equations, start: &Start, order: usize) {
        for (body, place) in equations.bodies.iter().zip(&mut self.places) {
            body.series((start.time, start.backward), order, place);
        }
        self.attitude[0] = start.attitude;
        self.rates[0] = start.rates;
        for k in 0..order {
            self.next_rows(k);
            let torque = self.torque(k);
            let mut gyration = [0.0; 4];
            let mut turning = [[0.0; 4]; 3];
            for j in 0..=k {
                add_product(&mut gyration, &self.neighbours[0][j], &self.neighbours[1][k - j]);
                let rates = &self.rates[k - j];
                for (axis, sum) in turning.iter_mut().enumerate() {
                    add_scaled(sum, rates[axis], &self.columns[axis][j]);
                }
            }
            if k == 0 {
                self.parts = [torque, gyration];
            }
            let share = 1.0 / (k + 1) as f64;
            let [one, two, three] = turning;
            for lane in 0..4 {
                self.rates[k + 1][lane] = equations.factors[lane] * (torque[lane] - gyration[lane]) * share;
                self.attitude[k + 1][lane] = 0.5 * share * (one[lane] + two[lane] + three[lane]);
            }
        }
    }

    /// What follows from row k of attitude and rates alone.
    #[inline(always)]
    fn next_rows(&mut self, k: usize) {
        let [x, y, z, w] = self.attitude[k];
        self.columns[0][k] = [w, z, -y, -x];
        self.columns[1][k] = [-z, w, x, -y];
        self.columns[2][k] = [y, -x, w, -z];
        let [first, second, third, _] = self.rates[k];
        self.neighbours[0][k] = [second, third, first, 0.0];
        self.neighbours[1][k] = [third, first, second, 0.0];
    }

    /// Row k of the matrix, and of Σ s2 s3 and in turn.
    #[inline(always)]
    fn torque(&mut self, k: usize) -> Row {
        let mut torque = [0.0; 4];
        if self.places.is_empty() {
            return torque;
        }
        let (mut squares, mut products, mut axial) = ([0.0; 4], [0.0; 4], [0.0; 4]);
        for j in 0..=k {
            let (one, other) = (&self.attitude[j], &self.attitude[k - j]);
            add_product(&mut squares, one, other);
            add_product(&mut products, &[one[0], one[0], one[1], 0.0], &[other[1], other[2], other[2], 0.0]);
            add_scaled(&mut axial, one[3], other);
        }
        let [xx, yy, zz, ww] = squares;
        let [xy, xz, yz, _] = products;
        let [xw, yw, zw, _] = axial;
        self.matrix[0][k] = [ww + xx - yy - zz, 2.0 * (xy - zw), 2.0 * (xz + yw), 0.0];
        self.matrix[1][k] = [2.0 * (xy + zw), ww - xx + yy - zz, 2.0 * (yz - xw), 0.0];
        self.matrix[2][k] = [2.0 * (xz - yw), 2.0 * (yz + xw), ww - xx - yy + zz, 0.0];
        for (place, [one, other]) in self.places.iter().zip(&mut self.directions) {
            let mut sums = [[0.0; 4]; 3];
            for j in 0..=k {
                let place = &place[k - j];
                for (axis, sum) in sums.iter_mut().enumerate() {
                    add_scaled(sum, place[axis], &self.matrix[axis][j]);
                }
            }
            let [first, second, third]: [f64; 3] = std::array::from_fn(|i| sums[0][i] + sums[1][i] + sums[2][i]);
            one[k] = [second, third, first, 0.0];
            other[k] = [third, first, second, 0.0];
            for j in 0..=k {
                add_product(&mut torque, &one[j], &other[k - j]);
            }
        }
        torque
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
