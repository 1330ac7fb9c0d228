//! The tensor (a/r)³ r̂r̂ in a frame: its traceless part, its turns about the axes of the frame, and its time derivatives.

use nalgebra::{UnitQuaternion, Vector3};

use super::position::{Axes, fixed};
use crate::simd::complex_quaternion::{ComplexLanes, QuaternionLanes};
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;

/// The traceless part of a symmetric tensor Θ: Θ33 − (Θ11 + Θ22)/2, Θ22 − Θ11, Θ12, Θ13, Θ23.
pub(crate) type Deviator<S> = [Lanes<S>; 5];

/// The traceless parts of (PP + QQ)/2, (PP − QQ)/2 and (PQ + QP)/2 for the axes P and Q of the orbit in the frame: the factors of (a/r)³ times 1, cos 2f and
/// sin 2f in (a/r)³ r̂r̂.
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
    (products_of(axes), turned_axes(rows[2], spin))
}

/// The products of two axes in the frame.
#[inline(always)]
fn products_of<S: InstructionSet>([first, second]: Axes<S>) -> Products<S> {
    let [one, other] = [product(first, scaled(first, 0.25)), product(second, scaled(second, 0.25))];
    let mut products = [product(first, scaled(second, 0.5)); 3];
    for c in 0..5 {
        products[0][c] = one[c] + other[c];
        products[1][c] = one[c] - other[c];
    }
    products
}

/// The products in one frame, and inertial axis 3 there.
pub(crate) fn products_at(
    frame: &UnitQuaternion<f64>,
    axes: [Vector3<f64>; 3],
) -> (Products<pulp::Scalar>, [Lanes<pulp::Scalar>; 3]) {
    let [none, one] = [0.0, 1.0].map(|value| Lanes::splat(pulp::Scalar, value));
    products(QuaternionLanes::all(none, frame), &fixed(&axes, none), ComplexLanes { re: one, im: none })
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

/// X₁Θ: the derivative of the components when the frame turns about its axis 1.
#[inline(always)]
pub(crate) fn about_first<S: InstructionSet>([axial, across, xy, xz, yz]: &Deviator<S>) -> Deviator<S> {
    [yz.all(-3.0) * *yz, *yz + *yz, *xz, -*xy, yz.all(0.5).negate_mul_add(*across, *axial)]
}

/// X₂Θ: the derivative of the components when the frame turns about its axis 2.
#[inline(always)]
pub(crate) fn about_second<S: InstructionSet>([axial, across, xy, xz, yz]: &Deviator<S>) -> Deviator<S> {
    [xz.all(3.0) * *xz, *xz + *xz, -*yz, -xz.all(0.5).mul_add(*across, *axial), *xy]
}

/// X₃Θ: the derivative of the components when the frame turns about its axis 3.
#[inline(always)]
fn about_third<S: InstructionSet>([_, across, xy, xz, yz]: &Deviator<S>) -> Deviator<S> {
    [xy.all(0.0), xy.all(-4.0) * *xy, *across, *yz, -*xz]
}

/// Time derivatives of a tensor from those relative to axes that turn with an angular velocity, which is constant relative to them. The lists hold the orders
/// from 0.
#[inline(always)]
pub(crate) fn turned<S: InstructionSet>(tensors: &mut [Deviator<S>], orders: usize, [a, b, c]: [Lanes<S>; 3]) {
    for first in 1..orders {
        // Each pass replaces the derivative j by (d/dt + ω×) of the derivative j − 1 of the pass before, beginning with the highest.
        for j in (first..orders).rev() {
            let before = &tensors[j - 1];
            let turns = [about_first(before), about_second(before), about_third(before)];
            for (k, component) in tensors[j].iter_mut().enumerate() {
                let change = a.mul_add(turns[0][k], b.mul_add(turns[1][k], c * turns[2][k]));
                *component = *component - change;
            }
        }
    }
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
        const ORDERS: usize = 7;
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
