//! Functions of the mean variables with their first and second derivatives, and the changes {Z, A} of these variables.
//!
//! The variables are the radial and the tangential component of p, y′, M, and turns of the frame about its axes 1 and 2. All derivatives are regular at p = 0.

use num_complex::Complex;

use super::modes::Mode;
use crate::gravity_gradient::contraction::{Tensor, contraction};

type C64 = Complex<f64>;

/// Number of variables.
pub(super) const SIZE: usize = 6;
/// One number for each variable: a gradient, or changes of the variables.
pub(super) type Field = [C64; SIZE];
/// The same for each derivative, by variable.
pub(super) type Slopes = [Field; SIZE];

/// M and |p| of a mean motion.
#[derive(Clone, Copy)]
pub(super) struct Point {
    pub(super) momentum: f64,
    pub(super) root: f64,
}

/// The amplitude A of a function A e^(i(hℓ′ + my′)), and its derivatives with the phase factor left out.
#[derive(Clone, Copy)]
pub(super) struct Jet {
    pub(super) value: C64,
    pub(super) gradient: Field,
    /// Second derivatives; for turns of the frame the outer derivative is the first index.
    pub(super) hessian: Slopes,
}

/// F = r^|h| f(r²) of a term, of p = r e^(iℓ′).
#[derive(Clone, Copy)]
struct Radial {
    value: f64,
    /// dF/dr and hF/r.
    slopes: [f64; 2],
    /// d²F/dr², h d(F/r)/dr, and (dF/dr − h²F/r)/r.
    curvatures: [f64; 3],
}

impl Radial {
    fn new(mode: &Mode, r: f64) -> Self {
        let [f, slope, curvature] = mode.function;
        let degree = mode.harmonic.abs();
        let (d, h) = (f64::from(degree), f64::from(mode.harmonic));
        let power = |less: i32| if degree >= less { r.powi(degree - less) } else { 0.0 };
        let (lowered, lowest, same) = (f * power(1), f * power(2), slope * power(0));
        Self {
            value: f * power(0),
            slopes: [d * lowered + 2.0 * same * r, h * lowered],
            curvatures: [
                d * (d - 1.0) * lowest + (4.0 * d + 2.0) * same + 4.0 * r * r * curvature * power(0),
                h * ((d - 1.0) * lowest + 2.0 * same),
                d * (1.0 - d) * lowest + 2.0 * same,
            ],
        }
    }
}

/// A tensor, and its derivatives when the frame turns about its axis 1 or 2, in one place.
pub(super) fn with_turns(tensor: &Tensor) -> [Tensor; 3] {
    let [xx, yy, zz, xy, xz, yz] = *tensor;
    [*tensor, [0.0, 2.0 * yz, -2.0 * yz, xz, -xy, zz - yy], [-2.0 * xz, 0.0, 2.0 * xz, -yz, xx - zz, xy]]
}

impl Jet {
    /// D of a mode, from the tensor and its derivatives; `strength` is q.
    pub(super) fn torque(mode: &Mode, tensors: &[Tensor; 3], strength: f64, r: f64) -> Self {
        let i = C64::i();
        let Radial { value, slopes: [by_r, by_turn], curvatures: [rr, rt, tt] } = Radial::new(mode, r);
        let weight = if mode.multiple == 1 { -i * strength } else { C64::new(strength, 0.0) };
        let [contracted, about_first, about_second] =
            tensors.each_ref().map(|tensor| contraction(tensor, mode.multiple).map(|c| c * weight));
        let along = i * f64::from(mode.multiple);
        let none = C64::default();
        let gradient =
            |c: [C64; 3]| [c[0] * by_r, c[0] * i * by_turn, c[0] * along * value, none, c[1] * value, c[2] * value];
        let first = gradient(contracted);
        let c = contracted;
        Self {
            value: c[0] * value,
            gradient: first,
            hessian: [
                [c[0] * rr, c[0] * i * rt, c[0] * along * by_r, none, c[1] * by_r, c[2] * by_r],
                [c[0] * i * rt, c[0] * tt, c[0] * along * i * by_turn, none, c[1] * i * by_turn, c[2] * i * by_turn],
                first.map(|part| part * along),
                [none; SIZE],
                gradient(about_first),
                gradient(about_second),
            ],
        }
    }

    /// This over iΩ, with Ω and its derivatives with respect to σ at fixed M; Ω is proportional to M.
    pub(super) fn over(&self, frequency: [f64; 3], point: Point) -> Self {
        let Point { momentum, root } = point;
        let [omega, slope, curvature] = frequency;
        let inverse = (C64::i() * omega).inv();
        // Derivatives of log Ω with respect to |p| and M, and those of 1/Ω over it.
        let [by_r, by_momentum] = [2.0 * root * slope / omega, 1.0 / momentum];
        let (rr, tt) = ((2.0 * slope + 4.0 * root * root * curvature) / omega, 2.0 * slope / omega);
        let value = self.value * inverse;
        let gradient = self.gradient.map(|part| part * inverse);
        let mut hessian = self.hessian.map(|row| row.map(|part| part * inverse));
        for k in 0..SIZE {
            hessian[0][k] -= gradient[k] * by_r;
            hessian[k][0] -= gradient[k] * by_r;
            hessian[3][k] -= gradient[k] * by_momentum;
            hessian[k][3] -= gradient[k] * by_momentum;
        }
        hessian[0][0] += value * (2.0 * by_r * by_r - rr);
        hessian[1][1] -= value * tt;
        hessian[0][3] += value * by_r * by_momentum;
        hessian[3][0] += value * by_r * by_momentum;
        hessian[3][3] += value * (2.0 * by_momentum * by_momentum);
        let mut gradient = gradient;
        gradient[0] -= value * by_r;
        gradient[3] -= value * by_momentum;
        Self { value, gradient, hessian }
    }

    /// This less another function.
    pub(super) fn minus(&self, other: &Self) -> Self {
        let apart = |one: &Field, other: &Field| -> Field { std::array::from_fn(|n| one[n] - other[n]) };
        Self {
            value: self.value - other.value,
            gradient: apart(&self.gradient, &other.gradient),
            hessian: std::array::from_fn(|k| apart(&self.hessian[k], &other.hessian[k])),
        }
    }

    /// {Z, A}.
    pub(super) fn field(&self, point: Point) -> Field {
        field(&self.gradient, point)
    }

    /// The derivatives of {Z, A}.
    pub(super) fn field_slopes(&self, point: Point) -> Slopes {
        let Point { momentum, .. } = point;
        let [by_radius, by_turn, by_longitude, by_momentum, ..] = self.gradient;
        let values = self.field(point);
        let mut slopes = self.hessian.map(|row| field(&row, point));
        // The factors of the brackets depend on p and M.
        let half = 0.5 / momentum;
        slopes[0][0] += by_longitude * half;
        slopes[1][1] += by_longitude * half;
        slopes[0][2] -= by_radius * half;
        slopes[1][2] -= by_turn * half;
        for n in [0, 1, 4, 5] {
            slopes[3][n] -= values[n] / momentum;
        }
        slopes[3][2] -= (values[2] - by_momentum) / momentum;
        slopes
    }
}

/// {Z, A} from the gradient of A.
fn field(gradient: &Field, Point { momentum, root }: Point) -> Field {
    let half = 0.5 / momentum;
    let [by_radius, by_turn, by_longitude, by_momentum, first, second] = *gradient;
    [
        by_longitude * (root * half) - by_turn * half,
        by_radius * half,
        by_momentum - by_radius * (root * half),
        -by_longitude,
        second / momentum,
        -first / momentum,
    ]
}

/// Changes of the variables times derivatives.
pub(super) fn along(changes: &Field, slopes: &Slopes) -> Field {
    let mut sum = [C64::default(); SIZE];
    for (change, row) in changes.iter().zip(slopes) {
        for (sum, slope) in sum.iter_mut().zip(row) {
            *sum += change * slope;
        }
    }
    sum
}
