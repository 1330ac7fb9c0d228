//! The mean variables p, y′, M and the invariable frame, and their periodic changes.

use nalgebra::{Quaternion, UnitQuaternion};

use crate::numerics::C64;

/// The mean variables at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mean {
    /// √σ e^(iℓ′).
    pub(crate) p: C64,
    pub(crate) longitude: f64,
    pub(crate) momentum: f64,
    /// The invariable frame, axis 3 along k.
    pub(crate) frame: UnitQuaternion<f64>,
}

/// The periodic changes of first order that lead from the mean variables to the osculating ones; `rotation` is about axes 1 and 2 of the frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PeriodicChange {
    pub(crate) p: C64,
    pub(crate) longitude: f64,
    pub(crate) momentum: f64,
    pub(crate) rotation: [f64; 2],
}

impl Mean {
    /// These variables plus `factor` times a change; a factor of −1 subtracts the change.
    pub(crate) fn changed(&self, change: &PeriodicChange, factor: f64) -> Self {
        let [x, y] = change.rotation.map(|angle| 0.5 * factor * angle);
        Self {
            p: self.p + change.p * factor,
            longitude: self.longitude + factor * change.longitude,
            momentum: self.momentum + factor * change.momentum,
            frame: self.frame * UnitQuaternion::new_normalize(Quaternion::new(1.0, x, y, 0.0)),
        }
    }
}

impl PeriodicChange {
    /// The sum of two changes.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            p: self.p + other.p,
            longitude: self.longitude + other.longitude,
            momentum: self.momentum + other.momentum,
            rotation: [self.rotation[0] + other.rotation[0], self.rotation[1] + other.rotation[1]],
        }
    }
}
