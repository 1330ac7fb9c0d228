//! The matrices A and B of the variational equations as series about the start of a step (theory §12).

use nalgebra::Matrix3;

use super::expansion::{Equations, Workspace};
use super::series::{ROWS, Row, Series, ZERO, add_product};
use crate::simd::instruction_set::InstructionSet;

/// The series of the matrices A and B, of ω, and of the products of s and ω.
pub(super) struct Linear {
    pub(super) rates: [[f64; 3]; ROWS],
    pub(super) by_angle: [[[f64; 3]; 3]; ROWS],
    pub(super) by_rate: [[[f64; 3]; 3]; ROWS],
    /// (s2 s2, s3 s3, s1 s1) and (s2 s3, s3 s1, s1 s2) of each body.
    pub(super) squares: Vec<[Series; 2]>,
    /// Σ s sᵀ − ω ωᵀ.
    pub(super) products: [Matrix3<f64>; ROWS],
}

impl Linear {
    pub(super) fn new(bodies: usize) -> Self {
        Self {
            rates: [[0.0; 3]; ROWS],
            by_angle: [[[0.0; 3]; 3]; ROWS],
            by_rate: [[[0.0; 3]; 3]; ROWS],
            squares: vec![[ZERO; 2]; bodies],
            products: [Matrix3::zeros(); ROWS],
        }
    }

    #[inline(always)]
    pub(super) fn set<S: InstructionSet>(
        &mut self,
        simd: S,
        equations: &Equations<4>,
        workspace: &Workspace<4>,
        order: usize,
    ) {
        let f = equations.factors;
        for k in 0..order {
            let [mut squares, mut mixed] = [[0.0; 4]; 2];
            for (body, kept) in self.squares.iter_mut().enumerate() {
                let sums = squared(simd, |j| *workspace.direction(body, j), k);
                (kept[0][k], kept[1][k]) = (sums[0], sums[1]);
                for lane in 0..3 {
                    squares[lane] += sums[0][lane];
                    mixed[lane] += sums[1][lane];
                }
            }
            let [p22, p33, p11, _] = squares;
            let [p23, p31, p12, _] = mixed;
            let [x, y, z, _] = workspace.rates[k];
            self.rates[k] = [x, y, z];
            self.by_angle[k] = [
                [f[0] * (p33 - p22), f[0] * p12, -f[0] * p31],
                [-f[1] * p12, f[1] * (p11 - p33), f[1] * p23],
                [f[2] * p31, -f[2] * p23, f[2] * (p22 - p11)],
            ];
            self.by_rate[k] = [[0.0, -f[0] * z, -f[0] * y], [-f[1] * z, 0.0, -f[1] * x], [-f[2] * y, -f[2] * x, 0.0]];
            let rate = |j: usize| {
                let [x, y, z, _] = workspace.rates[j];
                [[y, z, x, 0.0], [z, x, y, 0.0]]
            };
            let [turned, gyration] = squared(simd, rate, k);
            let [d22, d33, d11] = [0, 1, 2].map(|lane| squares[lane] - turned[lane]);
            let [d23, d31, d12] = [0, 1, 2].map(|lane| mixed[lane] - gyration[lane]);
            self.products[k] = Matrix3::new(d11, d12, d31, d12, d22, d23, d31, d23, d33);
        }
        if let Some(torques) = &equations.torques {
            let [by_angle, by_rate] = torques.derivatives(order, workspace.polynomials());
            for (k, (angle, rate)) in by_angle.iter().zip(&by_rate).enumerate() {
                for row in 0..3 {
                    for column in 0..3 {
                        self.by_angle[k][row][column] += angle[(row, column)];
                        self.by_rate[k][row][column] += rate[(row, column)];
                    }
                }
            }
        }
    }
}

/// Coefficient k of the products of a vector's components, from (v2, v3, v1) and (v3, v1, v2): squares of the first, and their products.
#[inline(always)]
fn squared<S: InstructionSet>(simd: S, vector: impl Fn(usize) -> [Row; 2], k: usize) -> [Row; 2] {
    let mut sums = [[0.0; 4]; 2];
    for j in 0..=k {
        let ([one, _], [same, other]) = (vector(j), vector(k - j));
        add_product(simd, &mut sums[0], &one, &same);
        add_product(simd, &mut sums[1], &one, &other);
    }
    sums
}
