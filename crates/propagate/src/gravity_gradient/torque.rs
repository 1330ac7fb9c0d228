//! How much of the theory of the gravity gradient is used: the paper's, or more (theory §9).

use super::inertia::Inertia;
use crate::input::options::Level;

impl Level {
    /// f_h of a multiple of y′ and its slope, as far as the level has it; of i t1 for the first multiple.
    pub(crate) fn tensor(self, inertia: &Inertia, multiple: i32, harmonic: i32) -> (f64, f64) {
        match self {
            Self::Auto | Self::Full | Self::SecondOrder => inertia.tensor[multiple as usize].at(harmonic), // 0 ≤ m ≤ 2
            Self::Paper | Self::Moving if (multiple, harmonic) == (2, 0) => (inertia.untilted[1], 0.0),
            Self::Paper | Self::Moving => (0.0, 0.0),
        }
    }

    /// What the level leaves out of that.
    pub(crate) fn omitted(self, inertia: &Inertia, multiple: i32, harmonic: i32) -> (f64, f64) {
        let (value, slope) = Self::Full.tensor(inertia, multiple, harmonic);
        let (kept, kept_slope) = self.tensor(inertia, multiple, harmonic);
        (value - kept, slope - kept_slope)
    }

    /// T33 averaged over ℓ′ and its slope.
    pub(crate) fn axial(self, inertia: &Inertia) -> (f64, f64) {
        match self {
            Self::Auto | Self::Full | Self::SecondOrder => inertia.mean_axial(),
            Self::Paper | Self::Moving => (inertia.untilted[0], 0.0),
        }
    }
}
