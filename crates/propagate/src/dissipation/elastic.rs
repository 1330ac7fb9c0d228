//! The strain energy of a homogeneous elastic ellipsoid in torque-free rotation (docs/relaxation.md, equations 1 to 7).
//!
//! Centrifugal and Euler force together are linear in the six products ω_i ω_j. Stresses that are quadratic polynomials balance them, with one symmetric
//! matrix c that Castigliano's principle fixes. The reflections of the ellipsoid split the problem into three single components, i ≠ j, and one block of three:
//!
//! ```text
//! W = ½ [w23 (ω2ω3)² + w31 (ω3ω1)² + w12 (ω1ω2)² + sᵀ Q_d s],   s_i = ω_i²
//! ```
//!
//! Density and rigidity are 1 here; w is proportional to ϱ²R⁷/S. The smaller part of W that changes the volume is kept apart.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Matrix4, Matrix6, SMatrix};

/// The coefficients of W.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StrainEnergy {
    /// w23, w31, w12.
    pub(super) products: [f64; 3],
    /// Q_d.
    pub(super) squares: Matrix3<f64>,
}

/// The strain energy of an ellipsoid and its part by compression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Elastic {
    pub(super) whole: StrainEnergy,
    pub(super) bulk: StrainEnergy,
}

impl Elastic {
    /// The coefficients for semi-axes along body axes 1, 2, 3 and Poisson's ratio ν from 0 to ½; `None` if rounding leaves no solution.
    pub(super) fn new(semi_axes: [f64; 3], poisson: f64) -> Option<Self> {
        let volume = 4.0 * PI / 3.0 * semi_axes.iter().product::<f64>();
        // N = ν/(1 + ν)
        let number = poisson / (1.0 + poisson);
        let squares = semi_axes.map(|axis| axis * axis);
        let products: [_; 3] = std::array::from_fn(|third| product(squares, third, number));
        let [whole, bulk] = diagonal(squares, number)?;
        Some(Self {
            whole: StrainEnergy { products: products.map(|[whole, _]| volume * whole), squares: whole * volume },
            bulk: StrainEnergy { products: products.map(|[_, bulk]| volume * bulk), squares: bulk * volume },
        })
    }
}

/// w_ij/V and its part by compression, for the body axes i and j beside the third axis (equation 4).
fn product(squares: [f64; 3], third: usize, number: f64) -> [f64; 2] {
    let [first, second] = [1, 2].map(|step| squares[(third + step) % 3]);
    // P = R_i² R_j², s = R_i² + R_j², z = R_k²
    let (p, s, z) = (first * second, first + second, squares[third]);
    // e = 4 (1 − N) z²,  D = 6P + 2zs + e
    let bottom = 6.0 * p + 2.0 * z * s + 4.0 * (1.0 - number) * z * z;
    // w/V = (8/35) (P²/s²) (D − P)/D
    let whole = 8.0 / 35.0 * (p / s) * (p / s) * (bottom - p) / bottom;
    // bulk/V = (8/35) (⅓ − N) z² c²,  c = 2 P^(3/2)/(s D)
    let c = 2.0 * p * p.sqrt() / (s * bottom);
    [whole, 8.0 / 35.0 * (1.0 / 3.0 - number) * (z * c) * (z * c)]
}

/// Q_d/V and its part by compression (equations 5 and 6): the least complementary energy over the diagonal of c.
fn diagonal(squares: [f64; 3], number: f64) -> Option<[Matrix3<f64>; 2]> {
    // Averages over the unit ball of F², Fξ_i², ξ_i⁴ and ξ_i²ξ_j² with F = 1 − |ξ|².
    let averages = Matrix4::new(
        8.0, 2.0, 2.0, 2.0, //
        2.0, 3.0, 1.0, 1.0, //
        2.0, 1.0, 3.0, 1.0, //
        2.0, 1.0, 1.0, 3.0,
    ) / 35.0;
    // Each stress in (F, ξ1², ξ2², ξ3²), by (κ1, κ2, κ3, c1, c2, c3).
    let mut energy = Matrix6::zeros();
    let mut trace = SMatrix::<f64, 4, 6>::zeros();
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        // σ_ii = R_i² [(κ_i − c_j − c_k) F + 2 c_j ξ_k² + 2 c_k ξ_j²]
        let mut stress = SMatrix::<f64, 4, 6>::zeros();
        (stress[(0, i)], stress[(0, 3 + j)], stress[(0, 3 + k)]) = (squares[i], -squares[i], -squares[i]);
        (stress[(1 + k, 3 + j)], stress[(1 + j, 3 + k)]) = (2.0 * squares[i], 2.0 * squares[i]);
        energy += stress.transpose() * averages * stress;
        // σ_jk = −2 R_j R_k c_i ξ_j ξ_k, twice
        energy[(3 + i, 3 + i)] += 8.0 / 35.0 * squares[j] * squares[k];
        trace += stress;
    }
    let compression = trace.transpose() * averages * trace;
    let whole = energy - compression * number;
    let corner = |row: usize, column: usize| whole.fixed_view::<3, 3>(row, column).into_owned();
    let c = -corner(3, 3).cholesky()?.solve(&corner(3, 0));
    // κ_i = ½ (s_j + s_k)
    let load = Matrix3::new(0.0, 0.5, 0.5, 0.5, 0.0, 0.5, 0.5, 0.5, 0.0);
    let mut both = SMatrix::<f64, 6, 3>::zeros();
    both.fixed_view_mut::<3, 3>(0, 0).copy_from(&load);
    both.fixed_view_mut::<3, 3>(3, 0).copy_from(&(c * load));
    let form = |matrix: Matrix6<f64>| (both.transpose() * matrix * both) * 0.5;
    Some([form(whole), form(compression) * (1.0 / 3.0 - number)])
}
