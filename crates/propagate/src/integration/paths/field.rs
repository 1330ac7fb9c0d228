//! The series of the field of a dipole along an orbit: a factor times a power of its size times the field, in units of the field on the equator.

use super::conic::Conic;
use crate::integration::series::{ROWS, Scalars, Series, ZERO, power, product};
use crate::numerics::phase::Phase;
use crate::numerics::scaling::scaled;
use crate::orbit::field::DipoleField;
use crate::simd::instruction_set::InstructionSet;

/// The field of a dipole in the unit of time of the integration.
#[derive(Clone, Debug)]
pub(crate) struct FieldSeries {
    /// r̂, and (R/r)³.
    direction: Conic,
    fall: Conic,
    axis: [f64; 3],
    phase: Phase,
    rate: f64,
    exponent: i32,
    strength: f64,
    power: f64,
}

impl FieldSeries {
    pub(crate) fn new(field: &DipoleField, (epoch, exponent): (f64, i32), (strength, power): (f64, f64)) -> Self {
        let at = (epoch, exponent);
        Self {
            direction: Conic::new(field.orbit(), at, (1.0, -1.0)),
            fall: Conic::new(field.orbit(), at, (field.strength(1.0) / field.equatorial(), -3.0)),
            axis: field.unit_axis(),
            phase: field.phase(epoch),
            rate: scaled(field.rotation_rate(), -exponent),
            exponent,
            strength,
            power,
        }
    }

    /// Returns the radius of convergence.
    pub(crate) fn series<S: InstructionSet>(&self, simd: S, time: (f64, f64), order: usize, out: &mut Series) -> f64 {
        let (field, factor, radius) = self.expanded(simd, time, order);
        for (k, row) in out.iter_mut().enumerate().take(order) {
            let [x, y, z] = field.each_ref().map(|part| product(part, &factor, k));
            *row = [x, y, z, 0.0];
        }
        radius
    }

    pub(crate) fn factor<S: InstructionSet>(&self, simd: S, time: (f64, f64), order: usize) -> Scalars {
        self.expanded(simd, time, order).1
    }

    pub(crate) fn passed(&self, time: (f64, f64)) -> f64 {
        self.direction.passed(time)
    }

    /// The field, the factor with the power of its size, and the radius of convergence.
    fn expanded<S: InstructionSet>(
        &self,
        simd: S,
        (high, low): (f64, f64),
        order: usize,
    ) -> ([Scalars; 3], Scalars, f64) {
        let mut place = ZERO;
        let radius = self.direction.series(simd, (high, low), order, &mut place);
        let fall = self.fall.factor(simd, (high, low), order);
        let direction: [Scalars; 3] =
            [0, 1, 2].map(|axis| std::array::from_fn(|k| if k < order { place[k][axis] } else { 0.0 }));
        let moment = self.moment((scaled(high, -self.exponent), scaled(low, -self.exponent)), order);
        let along: Scalars = std::array::from_fn(|k| {
            if k < order { (0..3).map(|axis| 3.0 * product(&moment[axis], &direction[axis], k)).sum() } else { 0.0 }
        });
        let field: [Scalars; 3] = [0, 1, 2].map(|axis| {
            let shape: Scalars = std::array::from_fn(|k| {
                if k < order { product(&along, &direction[axis], k) - moment[axis][k] } else { 0.0 }
            });
            std::array::from_fn(|k| if k < order { product(&shape, &fall, k) } else { 0.0 })
        });
        let (mut square, mut factor): (Scalars, Scalars) = ([0.0; ROWS], [0.0; ROWS]);
        for k in 0..order {
            square[k] = field.iter().map(|part| product(part, part, k)).sum();
            factor[k] = match k {
                0 => self.strength * square[0].powf(0.5 * self.power),
                _ => power(&square, &factor, 0.5 * self.power, k),
            };
        }
        // The roots of B² are nearer than the singularity of the orbit.
        let nearest = |k: usize| (square[0] / square[k].abs()).powf(1.0 / k as f64);
        (field, factor, (1..order).map(nearest).fold(radius, f64::min))
    }

    /// m̂ about a time after the epoch.
    fn moment(&self, elapsed: (f64, f64), order: usize) -> [Scalars; 3] {
        let [x, y, z] = self.axis;
        let (mut sine, mut cosine) = self.phase.angle(elapsed).sin_cos();
        let [mut first, mut second, mut third]: [Scalars; 3] = [[0.0; ROWS]; 3];
        third[0] = z;
        for (k, (one, other)) in first.iter_mut().zip(&mut second).enumerate().take(order) {
            (*one, *other) = (cosine * x - sine * y, sine * x + cosine * y);
            let share = self.rate / (k + 1) as f64;
            (cosine, sine) = (-share * sine, share * cosine);
        }
        [first, second, third]
    }
}
