//! The traceless part of r̂r̂ in the frame, and what the terms of each m contract it to.

use crate::gravity_gradient::orbit::derivatives::ORDERS;
use crate::gravity_gradient::orbit::elliptic_motion::Axes;
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// The traceless part of a symmetric tensor Θ: Θ33 − (Θ11 + Θ22)/2, Θ22 − Θ11, Θ12, Θ13, Θ23.
pub(crate) type Deviator<S> = [Lanes<S>; 5];

/// The traceless parts of (PP + QQ)/2, (PP − QQ)/2 and (PQ + QP)/2 for the axes P and Q of the orbit in the frame.
pub(crate) type Products<S> = [Deviator<S>; 3];

/// The products in the frame whose axes 1 and 2 are turned by the angle of `spin`, and inertial axis 3 there.
#[inline(always)]
pub(crate) fn products<S: InstructionSet>(
    frame: QuaternionLanes<S>,
    inertial: &Axes<S>,
    spin: ComplexLanes<S>,
) -> (Products<S>, [Lanes<S>; 3]) {
    let rows = frame.rows();
    let none = rows[0][0].all(0.0);
    let mut axes = [[none; 3]; 2];
    for (components, [x, y, z]) in axes.iter_mut().zip(inertial) {
        for (c, component) in components.iter_mut().enumerate() {
            let part = rows[0][c].mul_add(*x, rows[1][c] * *y);
            *component = rows[2][c].mul_add(*z, part);
        }
        *components = turned_axes(*components, spin);
    }
    let [first, second] = axes;
    let [one, other] = [product(first, scaled(first, 0.25)), product(second, scaled(second, 0.25))];
    let mut products = [product(first, scaled(second, 0.5)); 3];
    for c in 0..5 {
        products[0][c] = one[c] + other[c];
        products[1][c] = one[c] - other[c];
    }
    (products, turned_axes(rows[2], spin))
}

#[inline(always)]
fn scaled<S: InstructionSet>([x, y, z]: [Lanes<S>; 3], factor: f64) -> [Lanes<S>; 3] {
    let factor = x.all(factor);
    [x * factor, y * factor, z * factor]
}

/// The traceless part of (ab + ba)/2, from a and b/2.
#[inline(always)]
fn product<S: InstructionSet>([x, y, z]: [Lanes<S>; 3], [u, v, w]: [Lanes<S>; 3]) -> Deviator<S> {
    let (xx, yy, two) = (x * u, y * v, x.all(2.0));
    [(two * z).mul_add(w, -(xx + yy)), two * (yy - xx), x.mul_add(v, y * u), x.mul_add(w, z * u), y.mul_add(w, z * v)]
}

/// A vector's components along axes 1 and 2 that are turned by an angle, and along axis 3.
#[inline(always)]
fn turned_axes<S: InstructionSet>([x, y, z]: [Lanes<S>; 3], spin: ComplexLanes<S>) -> [Lanes<S>; 3] {
    [spin.im.mul_add(y, spin.re * x), spin.im.negate_mul_add(x, spin.re * y), z]
}

/// Σ factor × product, for the factors of the products' sequence: those of 1, cos 2f and sin 2f.
#[inline(always)]
pub(crate) fn deviator_of<S: InstructionSet>(
    [one, cosine, sine]: [Lanes<S>; 3],
    [constant, even, odd]: &Products<S>,
) -> Deviator<S> {
    let mut deviator = [one; 5];
    for (c, slot) in deviator.iter_mut().enumerate() {
        *slot = one.mul_add(constant[c], cosine.mul_add(even[c], sine * odd[c]));
    }
    deviator
}

/// Time derivatives of a tensor from those relative to axes that turn with an angular velocity, which is constant relative to them. The lists hold the orders
/// from 0.
#[inline(always)]
pub(crate) fn turned<S: InstructionSet>(tensors: &mut [Deviator<S>; ORDERS], orders: usize, [a, b, c]: [Lanes<S>; 3]) {
    let (half, two, three) = (a.all(0.5), a.all(2.0), a.all(3.0));
    for first in 1..orders {
        // Each pass replaces the derivative j by (d/dt + ω×) of the derivative j − 1 of the pass before, beginning with the highest.
        for j in (first..orders).rev() {
            let [axial, across, xy, xz, yz] = tensors[j - 1];
            let (a_yz, b_xz) = (a * yz, b * xz);
            let change = [
                three * (a_yz - b_xz),
                two * (two * c).mul_add(xy, -(a_yz + b_xz)),
                c.negate_mul_add(across, b.mul_add(yz, -(a * xz))),
                b.mul_add(half.mul_add(across, axial), a.mul_add(xy, -(c * yz))),
                a.mul_add(half.mul_add(across, -axial), c.mul_add(xz, -(b * xy))),
            ];
            for (component, more) in tensors[j].iter_mut().zip(change) {
                *component = *component + more;
            }
        }
    }
}

/// The contraction of r̂r̂ for m = 1 (r̄₊ r₃, times −1) or m = 2 (r̄₊², times −i), and its derivatives when the frame turns about its axes 1 and 2.
pub(crate) type Contracted<S> = [ComplexLanes<S>; 3];

/// The contractions for m = 1 or 2.
#[inline(always)]
pub(crate) fn contractions<S: InstructionSet>(deviator: &Deviator<S>, multiple: usize) -> Contracted<S> {
    let c = |re: Lanes<S>, im: Lanes<S>| ComplexLanes { re, im };
    let [axial, across, xy, xz, yz] = *deviator;
    if multiple == 1 {
        let half = xy.all(0.5);
        [c(-xz, yz), c(xy, half.negate_mul_add(across, axial)), c(half.mul_add(across, axial), xy)]
    } else {
        let (two_xz, two_yz) = (xz + xz, yz + yz);
        [c(-(xy + xy), across), c(-two_xz, two_yz), c(two_yz, two_xz)]
    }
}

/// (3r₃² − 1)/2, the contraction for m = 0, and its derivatives when the frame turns about its axes 1 and 2. All are real.
#[inline(always)]
pub(crate) fn axial_contractions<S: InstructionSet>([axial, _, _, xz, yz]: &Deviator<S>) -> [Lanes<S>; 3] {
    [*axial, yz.all(-3.0) * *yz, xz.all(3.0) * *xz]
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};

    use super::*;

    #[test]
    fn derivatives_of_a_tensor_in_turning_axes_are_commutators_with_the_rate() {
        let one = |value: f64| Lanes::splat(pulp::Scalar, value);
        let [first, second] = [Vector3::new(0.3, -0.7, 0.4), Vector3::new(-1.1, 0.2, 0.5)];
        let [u, v] = [first, second].map(|vector| [one(vector.x), one(vector.y), one(vector.z)]);
        let whole = (first * second.transpose() + second * first.transpose()) / 2.0;
        let deviator = |u: &Matrix3<f64>| [u.m33 - (u.m11 + u.m22) / 2.0, u.m22 - u.m11, u.m12, u.m13, u.m23].map(one);
        let rate = Vector3::new(0.8, -0.5, 1.3);
        // In the turning axes the derivative j is 0.7^j times the tensor.
        let mut tensors = [product(u, scaled(v, 0.5)); ORDERS];
        for (j, tensor) in tensors.iter_mut().enumerate() {
            *tensor = tensor.map(|component| component * one(0.7_f64.powi(j as i32)));
        }
        turned(&mut tensors, ORDERS, rate.data.0[0].map(one));
        let mut exact = whole;
        for (j, tensor) in tensors.iter().enumerate() {
            for (found, exact) in tensor.iter().zip(deviator(&exact)) {
                let (found, exact) = (found.values()[0], exact.values()[0]);
                assert!((found - exact).abs() <= 1e-14 * 4.0_f64.powi(j as i32), "{j}: {found} {exact}");
            }
            let turn = rate.cross_matrix();
            exact = exact * 0.7 + turn * exact - exact * turn;
        }
    }
}
