//! Sums of products of periodic functions, value by value, with the instructions of the machine.

use std::sync::Arc;

use num_complex::Complex;
use num_traits::Zero;

/// A factor, which shares its values, or a sum, which owns them.
#[derive(Clone, Debug)]
pub enum RawPeriodic {
    /// A constant.
    Constant(Complex<f64>),
    /// The values of a factor.
    Factor(Arc<[f64]>),
    /// The values of a sum.
    Sum(Box<[f64]>),
}

impl Default for RawPeriodic {
    fn default() -> Self {
        RawPeriodic::Constant(Complex::zero())
    }
}

impl RawPeriodic {
    pub(super) fn row(&self) -> Option<&[f64]> {
        match self {
            RawPeriodic::Constant(_) => None,
            RawPeriodic::Factor(row) => Some(row),
            RawPeriodic::Sum(row) => Some(row),
        }
    }

    pub(super) fn constant(&self) -> Complex<f64> {
        if let RawPeriodic::Constant(c) = self { *c } else { Complex::zero() }
    }

    /// The values of a sum, of which `length` are wanted.
    pub(super) fn opened(&mut self, length: usize) -> &mut [f64] {
        if !matches!(self, RawPeriodic::Sum(_)) {
            let mut row = vec![0.0; length].into_boxed_slice();
            let (re, im) = row.split_at_mut(length / 2);
            re.fill(self.constant().re);
            im.fill(self.constant().im);
            if let Some(known) = self.row() {
                row.copy_from_slice(known);
            }
            *self = RawPeriodic::Sum(row);
        }
        let RawPeriodic::Sum(row) = self else { return &mut [] };
        row
    }
}

/// sum += weight · first · second, value by value.
pub(super) struct AddProduct<'a> {
    pub(super) sum: &'a mut [f64],
    pub(super) first: &'a [f64],
    pub(super) second: &'a [f64],
    pub(super) weight: f64,
}

impl pulp::NullaryFnOnce for AddProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { sum, first, second, weight } = self;
        let count = sum.len() / 2;
        let (re, im) = sum.split_at_mut(count);
        let ((a, b), (c, d)) = (first.split_at(count), second.split_at(count));
        let (im, a, b, c, d) = (&mut im[..count], &a[..count], &b[..count], &c[..count], &d[..count]);
        for i in 0..count {
            re[i] = weight.mul_add(a[i].mul_add(c[i], -(b[i] * d[i])), re[i]);
            im[i] = weight.mul_add(a[i].mul_add(d[i], b[i] * c[i]), im[i]);
        }
    }
}

/// sum += factor · row.
pub(super) struct AddScaled<'a> {
    pub(super) sum: &'a mut [f64],
    pub(super) row: &'a [f64],
    pub(super) factor: Complex<f64>,
}

impl pulp::NullaryFnOnce for AddScaled<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { sum, row, factor } = self;
        let count = sum.len() / 2;
        let (re, im) = sum.split_at_mut(count);
        let (a, b) = row.split_at(count);
        let (im, a, b) = (&mut im[..count], &a[..count], &b[..count]);
        for i in 0..count {
            re[i] = factor.re.mul_add(a[i], (-factor.im).mul_add(b[i], re[i]));
            im[i] = factor.re.mul_add(b[i], factor.im.mul_add(a[i], im[i]));
        }
    }
}
