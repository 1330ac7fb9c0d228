//! What a user reads of a libration: proper modes, and the table of terms.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use andoyer_series::num_complex::Complex;
use andoyer_series::periodic::Harmonic;

use super::solution::{Libration, limit};

/// An angle of the body in the frame that turns with the resonance: R = Rz(ψ) Ry(θ) Rx(φ).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LibrationAngle {
    /// ψ, about the normal of the orbit: the libration in longitude.
    Longitude,
    /// θ, about the body's intermediate axis: the long axis leaves the plane of the orbit.
    Pole1,
    /// φ, about the body's long axis.
    Pole2,
}

impl LibrationAngle {
    const ALL: [Self; 3] = [Self::Longitude, Self::Pole1, Self::Pole2];

    /// "longitude", "pole-1" or "pole-2".
    pub fn name(self) -> &'static str {
        match self {
            Self::Longitude => "longitude",
            Self::Pole1 => "pole-1",
            Self::Pole2 => "pole-2",
        }
    }
}

/// A term of an angle: amplitude · sin(phase + 2π (t − epoch)/period).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LibrationTerm {
    /// Multiples of the three proper angles, of the mean anomaly M, and of the angle α = r M + ω + ψ₀ from the node of a precessing orbit; their rate 2π/period is positive.
    pub multiples: [i64; 5],
    /// Unit of time; infinite for a constant.
    pub period: f64,
    /// \[rad\]
    pub amplitude: f64,
    /// At the epoch, from −π to π \[rad\].
    pub phase: f64,
    /// The angle that has this term.
    pub angle: LibrationAngle,
}

impl Libration {
    /// The memory of a harmonic, in bytes.
    pub(super) fn memory_of_a_harmonic(&self) -> usize {
        size_of::<Harmonic>() + 5 * size_of::<i64>() + 6 * size_of::<Complex<f64>>()
    }

    /// The order of the normal form.
    pub fn order(&self) -> usize {
        self.order
    }

    /// The number of harmonics.
    pub fn harmonics(&self) -> usize {
        self.course.harmonics.len()
    }

    /// The estimate of the error of the attitude over the span \[rad\].
    pub(crate) fn error(&self) -> f64 {
        self.error
    }

    /// What the series leaves in the equations of motion over the divisors of each mode: an angle \[rad\].
    pub fn residual(&self) -> f64 {
        self.residual
    }

    /// The angle from the orbit's normal to axis 3 of the frame in which the body librates \[rad\]: the obliquity of a Cassini state, positive away from inertial
    /// axis 3; 0 if the node is fixed.
    pub fn obliquity(&self) -> f64 {
        self.lock.shape.precession.obliquity
    }

    /// The mean motion of the orbit that locks the body [rad per unit of time].
    pub fn mean_motion(&self) -> f64 {
        self.lock.mean_motion
    }

    /// The number of phases of the terms: the three proper angles and M, and α if the orbit precesses.
    pub fn phases_of_terms(&self) -> usize {
        3 + if self.lock.shape.is_tilted() { 2 } else { 1 }
    }

    /// Why a lower error is out of reach, in words.
    pub(crate) fn limit(&self) -> String {
        limit(&self.lock, &self.course, &self.course)
    }

    /// Rotations in two orbits.
    pub(crate) fn twice(&self) -> i32 {
        self.lock.shape.twice
    }

    /// Rates of the proper angles, longitude first and then the two of the pole [rad per unit of time].
    pub fn frequencies(&self) -> [f64; 3] {
        self.course.frequencies.map(|rate| rate * self.lock.mean_motion)
    }

    /// Proper periods [unit of time].
    pub fn periods(&self) -> [f64; 3] {
        self.frequencies().map(|rate| TAU / rate.abs())
    }

    /// The largest angle of each proper mode \[rad\].
    pub fn amplitudes(&self) -> [f64; 3] {
        self.modes().map(|mode| mode.map_or(0.0, |term| term.amplitude))
    }

    /// The phase of that angle at the epoch \[rad\]; 0 for a mode without amplitude.
    pub fn phases(&self) -> [f64; 3] {
        self.modes().map(|mode| mode.map_or(0.0, |term| term.phase))
    }

    /// The largest term with the frequency of each proper mode.
    fn modes(&self) -> [Option<LibrationTerm>; 3] {
        let terms = self.terms();
        [0, 1, 2].map(|mode| {
            let mut own = [0; 5];
            own[mode] = 1;
            terms.iter().find(|term| term.multiples == own).copied()
        })
    }

    /// All terms, the largest first.
    pub fn terms(&self) -> Vec<LibrationTerm> {
        let mut terms = Vec::new();
        for harmonic in &self.course.harmonics {
            for (angle, amplitude) in LibrationAngle::ALL.into_iter().zip(harmonic.amplitudes.iter().step_by(2)) {
                terms.extend(self.term(&harmonic.multiples, *amplitude, angle));
            }
        }
        terms.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
        terms
    }

    /// The terms without proper modes: what the orbit forces.
    pub fn forced(&self) -> Vec<LibrationTerm> {
        self.terms().into_iter().filter(|term| term.multiples[..3] == [0; 3]).collect()
    }

    fn term(&self, multiples: &[i64], amplitude: Complex<f64>, angle: LibrationAngle) -> Option<LibrationTerm> {
        let rate = self.course.rate(multiples) * self.lock.mean_motion;
        let still = multiples.iter().all(|&k| k == 0);
        let amplitude = if still { Complex::new(amplitude.re, 0.0) } else { amplitude };
        // Re c e^{iα} = |c| sin(α + arg c + π/2); a rate below 0 belongs to the same term with the opposite multiples.
        let phase = self.course.phase(multiples, 0.0) + amplitude.arg() + FRAC_PI_2;
        let (sign, rate, phase) = if rate < 0.0 { (-1, -rate, PI - phase) } else { (1, rate, phase) };
        let all = std::array::from_fn(|k| sign * multiples[k]);
        let phase = phase - TAU * (phase / TAU).round();
        let period = if still { f64::INFINITY } else { TAU / rate };
        (amplitude.norm() > 0.0).then(|| LibrationTerm {
            multiples: all,
            period,
            amplitude: amplitude.norm(),
            phase,
            angle,
        })
    }
}
