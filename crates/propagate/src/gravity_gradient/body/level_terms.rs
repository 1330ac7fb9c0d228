//! The terms of the gravity-gradient theory at each level: the paper's, or more (theory §9).

use super::inertia::Inertia;
use crate::input::options::Level;

impl Level {
    /// f_h for a multiple of y′, and its slope, at this level; for the first multiple those of i t1.
    pub(crate) fn tensor(self, inertia: &Inertia, multiple: i32, harmonic: i32) -> (f64, f64) {
        match self {
            Self::Auto | Self::Full | Self::SecondOrder => inertia.tensor[multiple as usize].at(harmonic), // 0 ≤ m ≤ 2
            Self::Paper | Self::Moving if (multiple, harmonic) == (2, 0) => (inertia.untilted[1], 0.0),
            Self::Paper | Self::Moving => (0.0, 0.0),
        }
    }

    /// The parts of f_h and of its slope that the level omits.
    pub(crate) fn omitted(self, inertia: &Inertia, multiple: i32, harmonic: i32) -> (f64, f64) {
        let (value, slope) = Self::Full.tensor(inertia, multiple, harmonic);
        let (kept, kept_slope) = self.tensor(inertia, multiple, harmonic);
        (value - kept, slope - kept_slope)
    }

    /// T33 averaged over ℓ′, and its slope, at this level.
    pub(crate) fn axial(self, inertia: &Inertia) -> (f64, f64) {
        match self {
            Self::Auto | Self::Full | Self::SecondOrder => inertia.mean_axial(),
            Self::Paper | Self::Moving => (inertia.untilted[0], 0.0),
        }
    }
}
