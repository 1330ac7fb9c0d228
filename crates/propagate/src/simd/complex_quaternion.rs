//! Complex numbers and quaternions in lanes.

use std::ops::{Add, Mul};

use nalgebra::{Quaternion, Vector3};

use super::instruction_set::InstructionSet;
use super::lanes::Lanes;

/// Complex numbers.
#[derive(Clone, Copy)]
pub(crate) struct ComplexLanes<S: InstructionSet> {
    pub(crate) re: Lanes<S>,
    pub(crate) im: Lanes<S>,
}

impl<S: InstructionSet> Add for ComplexLanes<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl<S: InstructionSet> Mul for ComplexLanes<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { re: self.im.negate_mul_add(other.im, self.re * other.re), im: self.im_of_product(other) }
    }
}

impl<S: InstructionSet> ComplexLanes<S> {
    /// self + a·b.
    #[inline(always)]
    pub(crate) fn plus(self, a: Self, b: Self) -> Self {
        Self {
            re: a.im.negate_mul_add(b.im, a.re.mul_add(b.re, self.re)),
            im: a.im.mul_add(b.re, a.re.mul_add(b.im, self.im)),
        }
    }

    /// The real part of self·other, plus `sum`.
    #[inline(always)]
    pub(crate) fn plus_re_of_product(self, other: Self, sum: Lanes<S>) -> Lanes<S> {
        self.im.negate_mul_add(other.im, self.re.mul_add(other.re, sum))
    }

    /// The imaginary part of self·other.
    #[inline(always)]
    pub(crate) fn im_of_product(self, other: Self) -> Lanes<S> {
        self.im.mul_add(other.re, self.re * other.im)
    }

    #[inline(always)]
    pub(crate) fn conjugate(self) -> Self {
        Self { im: -self.im, ..self }
    }

    /// i·self.
    #[inline(always)]
    pub(crate) fn quarter_turned(self) -> Self {
        Self { re: -self.im, im: self.re }
    }
}

/// Quaternions x, y, z, w.
#[derive(Clone, Copy)]
pub(crate) struct QuaternionLanes<S: InstructionSet>(pub(crate) [Lanes<S>; 4]);

impl<S: InstructionSet> QuaternionLanes<S> {
    #[inline(always)]
    pub(crate) fn all(like: Lanes<S>, quaternion: &Quaternion<f64>) -> Self {
        let [x, y, z, w] = [quaternion.i, quaternion.j, quaternion.k, quaternion.w];
        Self([like.all(x), like.all(y), like.all(z), like.all(w)])
    }

    /// The rotation about a direction; the arguments are sine and cosine of half the angle.
    #[inline(always)]
    pub(crate) fn about(axis: &Vector3<f64>, (sine, cosine): (Lanes<S>, Lanes<S>)) -> Self {
        Self([sine * sine.all(axis.x), sine * sine.all(axis.y), sine * sine.all(axis.z), cosine])
    }

    /// Rows of the rotation matrix.
    #[inline(always)]
    pub(crate) fn rows(self) -> [[Lanes<S>; 3]; 3] {
        let [x, y, z, w] = self.0;
        let (x2, y2, z2) = (x + x, y + y, z + z);
        let one = x.all(1.0);
        [
            [one - y.mul_add(y2, z * z2), z.negate_mul_add(w + w, x * y2), y.mul_add(w + w, x * z2)],
            [z.mul_add(w + w, x * y2), one - x.mul_add(x2, z * z2), x.negate_mul_add(w + w, y * z2)],
            [y.negate_mul_add(w + w, x * z2), x.mul_add(w + w, y * z2), one - x.mul_add(x2, y * y2)],
        ]
    }

    /// The third row of the rotation matrix, of a quaternion that need not be normalized.
    #[inline(always)]
    pub(crate) fn third_row(self) -> [Lanes<S>; 3] {
        let [x, y, z, w] = self.0;
        let (beside, along) = (x.mul_add(x, y * y), z.mul_add(z, w * w));
        let scale = (along + beside).reciprocal();
        let twice = scale + scale;
        [y.negate_mul_add(w, x * z) * twice, x.mul_add(w, y * z) * twice, (along - beside) * scale]
    }

    #[inline(always)]
    pub(crate) fn normalized(self) -> Self {
        let [x, y, z, w] = self.0;
        let scale = x.mul_add(x, y.mul_add(y, z.mul_add(z, w * w))).root().reciprocal();
        Self([x * scale, y * scale, z * scale, w * scale])
    }
}

impl<S: InstructionSet> Mul for QuaternionLanes<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let ([a, b, c, d], [x, y, z, w]) = (self.0, other.0);
        Self([
            a.mul_add(w, d.mul_add(x, c.negate_mul_add(y, b * z))),
            b.mul_add(w, d.mul_add(y, a.negate_mul_add(z, c * x))),
            c.mul_add(w, d.mul_add(z, b.negate_mul_add(x, a * y))),
            c.negate_mul_add(z, b.negate_mul_add(y, a.negate_mul_add(x, d * w))),
        ])
    }
}
