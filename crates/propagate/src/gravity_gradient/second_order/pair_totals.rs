//! All pairs of terms with one h and m together: whether the sum over time derivatives is accurate enough for them, and its error.

use num_complex::Complex;

use super::pair_terms::Stand;
use super::pairs_around::{Around, Total};

type C64 = Complex<f64>;

/// Safety factor of slow pairs. S is taken at the epoch, and elsewhere on the orbit the directions to the disturbing body may make it larger.
const SOURCE_MARGIN: f64 = 3.0;

/// All pairs with one total, either with a single harmonic of the orbit in them or without.
#[derive(Clone, Copy)]
pub(crate) struct Together {
    pub(crate) total: Total,
    /// S and Ṡ.
    pub(crate) source: C64,
    pub(crate) change: C64,
    /// Whether one of the pair is a single harmonic of the orbit.
    pub(crate) single: bool,
}

impl Together {
    /// Adds this, `factor` times, to that with the same total, or with the opposite one.
    pub(crate) fn join(self, factor: f64, all: &mut Vec<Self>) {
        let Total { numbers: [h, m], frequency } = self.total;
        let opposite = m < 0.0 || m == 0.0 && h < 0.0;
        let sign = if opposite { -1.0 } else { 1.0 };
        let total = Total { numbers: [sign * h, sign * m], frequency: sign * frequency };
        let [source, change] =
            [self.source, self.change].map(|part| if opposite { part.conj() } else { part } * factor);
        // A pair with a single harmonic of the orbit in it has its own frequency, and is not joined.
        let same = all.iter_mut().filter(|_| !self.single).find(|other| other.total.numbers == total.numbers);
        match same {
            Some(other) => {
                other.source += source;
                other.change += change;
            }
            None => all.push(Self { total, source, change, ..self }),
        }
    }

    /// `part` times m and times h: the parts of M and of L.
    pub(crate) fn of_actions(&self, part: f64) -> [f64; 2] {
        let [h, m] = self.total.numbers;
        [m * part, h * part]
    }

    /// Errors of the changes of M and L by the sum over time derivatives.
    pub(crate) fn sum_error(&self, stand: &Stand<'_>) -> [f64; 2] {
        self.of_actions(self.size(stand) * stand.relative_sum_error(self.total.frequency)).map(f64::abs)
    }

    /// Whether the harmonics of the orbit are needed, and are not too many. On a circle they are few, and better than the sum over time derivatives.
    pub(crate) fn needs(&self, stand: &Stand<'_>, around: &Around<'_>) -> bool {
        let resonant = self.of_actions(self.at_resonance(stand, around)).map(f64::abs);
        let by_sum =
            if self.is_slow(stand) || around.eccentricity == 0.0 { self.sum_error(stand) } else { Default::default() };
        let enough = stand.enough * stand.mean.momentum;
        let left = [0, 1].map(|i| resonant[i] + by_sum[i]);
        !self.single && left.iter().any(|left| *left > enough) && around.highest(&self.total).is_some()
    }

    /// Whether there is no sum over time derivatives.
    fn is_slow(&self, stand: &Stand<'_>) -> bool {
        self.total.frequency.abs() <= stand.slowest
    }

    /// The change by the harmonic of S nearest to resonance, which the sum over time derivatives lacks; 0 for slow pairs, which have no such sum.
    pub(crate) fn at_resonance(&self, stand: &Stand<'_>, around: &Around<'_>) -> f64 {
        if self.is_slow(stand) {
            return 0.0;
        }
        // The amplitude of a single harmonic is the same everywhere.
        let factors = if self.single { 1 } else { 2 };
        let [size, distance] = around.nearest(self.total.frequency, factors);
        self.size(stand) * stand.closest.powi(factors) * size * (1.0 / distance).min(stand.duration)
    }

    /// Size of S. S may vanish at the epoch, so its time derivative is included.
    fn size(&self, stand: &Stand<'_>) -> f64 {
        let swing = if stand.bend > 0.0 { self.change.norm_sqr() / (4.0 * stand.bend) } else { 0.0 };
        (self.source.norm_sqr() + swing).sqrt()
    }

    /// The real part of S/Ω by the sum over time derivatives.
    pub(crate) fn by_sum(&self, stand: &Stand<'_>) -> f64 {
        if self.is_slow(stand) {
            return 0.0;
        }
        let inverse = (C64::i() * self.total.frequency).inv();
        ((self.source - self.change * inverse) * inverse * -C64::i()).re
    }
}

impl Stand<'_> {
    /// Error of χ for pairs of frequency Ω, divided by S: the terms of its sum from the third on; for slow pairs all of χ.
    fn relative_sum_error(&self, omega: f64) -> f64 {
        // A product of two has twice the orbit's rates.
        let fastest = 2.0 * self.bend.sqrt();
        let beyond = omega.abs() - fastest;
        let nearest = self.orbital_step * (omega / self.orbital_step).round();
        let distance = if beyond > 0.0 { beyond } else { (omega - nearest).abs() };
        let time = if distance * self.duration > 1.0 { 1.0 / distance } else { self.duration };
        if omega.abs() > self.slowest {
            return (fastest / omega).powi(2).min(1.0) * time;
        }
        SOURCE_MARGIN * self.closest * self.closest * time
    }
}
