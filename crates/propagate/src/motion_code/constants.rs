//! The constants of one motion, as the kernels take them.

use andoyer_series::print::{Constant, Numbers};
use nalgebra::{Quaternion, Vector3};

use crate::error::Error;
use crate::motion::solved::Motion;
use crate::motion::trajectory::Trajectory;
use crate::numerics::phase::Phase;
use crate::torque_free::steady::Steady;
use crate::torque_free::sums::Sums;
use crate::torque_free::wobble::WobbleEvaluator;

/// Bits of a double that its first part does not have, so that a product with 26 bits is exact.
const SECOND_HALF: u64 = (1 << 26) - 1;

/// Frequency in turns per unit of time as three doubles, and turns at the epoch as two.
pub(super) type PhaseParts = [f64; 5];

/// What the kernels evaluate.
#[derive(Clone, Debug)]
pub(super) struct Constants {
    pub(super) epoch: f64,
    /// Largest distance from the epoch.
    pub(super) bound: f64,
    /// ℓ′.
    pub(super) anomaly: PhaseParts,
    /// y′/2.
    pub(super) half_longitude: PhaseParts,
    /// Whether the terms are those of powers of cos 2ℓ′, else of harmonics.
    pub(super) powers: bool,
    /// Coefficients of Re a, Im a, Re b, Im b.
    pub(super) terms: Vec<[f64; 4]>,
    /// Rows x, y, z, w of the attitude; columns Re b, Im b, Im a, Re a.
    pub(super) attitude: [[f64; 4]; 4],
    /// Angular velocity in body components for each component of the unit angular momentum on the sorted axes.
    pub(super) rates: [[f64; 3]; 3],
}

impl Constants {
    /// # Errors
    /// - [`Error::NoCode`] for a motion that is neither steady nor a wobble.
    pub(super) fn new(motion: &Motion) -> Result<Self, Error> {
        let (epoch, bound) = (motion.scene.state().epoch, motion.reach()[1]);
        let mut constants = match &motion.trajectory {
            Trajectory::Steady(steady) => Self::of_steady(steady, epoch, bound),
            Trajectory::Wobble(wobble) => Self::of_wobble(wobble, epoch, bound),
            Trajectory::Passage(_) => return Err(Error::NoCode { motion: "a passage along the separatrix" }),
            Trajectory::Forced(motion) => return Err(Error::NoCode { motion: motion.name() }),
        };
        if let Some(given) = &motion.given {
            let back = given.turn.inverse().into_inner();
            constants.attitude = columns(constants.attitude, |column| Quaternion::from(column) * back);
            let matrix = given.turn.to_rotation_matrix();
            for axis in 0..3 {
                let turned = matrix * Vector3::from(constants.rates.map(|row| row[axis]));
                for (row, value) in constants.rates.iter_mut().zip(&turned) {
                    row[axis] = *value;
                }
            }
        }
        Ok(constants)
    }

    /// The constants as they stand in a file.
    pub(super) fn listed(&self) -> [Constant; 7] {
        let phase = "l' and y'/2: turns per unit of time as three doubles, the first two of 27 bits at most; turns at the epoch as two.";
        let named = |name, comment, value| Constant { name, comment, value };
        [
            named("EPOCH", "", Numbers::One(self.epoch)),
            named("BOUND", "Largest distance from the epoch.", Numbers::One(self.bound)),
            named("ANOMALY", phase, Numbers::List(self.anomaly.to_vec())),
            named("HALF_LONGITUDE", "", Numbers::List(self.half_longitude.to_vec())),
            named("TERMS", "Coefficients of Re a, Im a, Re b and Im b.", rows(&self.terms)),
            named("ATTITUDE", "Rows x, y, z, w; columns Re b, Im b, Im a, Re a.", rows(&self.attitude)),
            named("RATES", "Angular velocity of each component of the unit angular momentum.", rows(&self.rates)),
        ]
    }

    /// Rotation about a fixed axis: a = 1 and b = 0 throughout, and the angular momentum need not be known.
    fn of_steady(steady: &Steady, epoch: f64, bound: f64) -> Self {
        let [start, quarter] = &steady.attitudes;
        Self {
            epoch,
            bound,
            anomaly: [0.0, 0.0, 0.0, 1.0, 0.0],
            half_longitude: parts(&steady.half_angle),
            powers: true,
            terms: vec![[1.0, 0.0, 0.0, 0.0]],
            attitude: std::array::from_fn(|row| [0.0, 0.0, quarter[row], start[row]]),
            rates: steady.rates.map(|rate| [0.0, 0.0, rate]),
        }
    }

    fn of_wobble(wobble: &WobbleEvaluator, epoch: f64, bound: f64) -> Self {
        let (powers, terms) = match &wobble.sums {
            Sums::Powers(terms) => (true, terms.clone()),
            Sums::Harmonics(terms) => (false, terms.clone()),
        };
        let mut rates = [[0.0; 3]; 3];
        for (row, (axis, factor)) in rates.iter_mut().zip(wobble.rates) {
            row[axis] = factor;
        }
        Self {
            epoch,
            bound,
            anomaly: parts(&wobble.anomaly),
            half_longitude: parts(&wobble.half_longitude),
            powers,
            terms,
            attitude: wobble.map,
            rates,
        }
    }
}

fn rows<const N: usize>(rows: &[[f64; N]]) -> Numbers {
    Numbers::Rows(rows.iter().map(|row| row.to_vec()).collect())
}

fn parts(phase: &Phase) -> PhaseParts {
    let first = f64::from_bits(phase.frequency.high.to_bits() & !SECOND_HALF);
    [first, phase.frequency.high - first, phase.frequency.low, phase.start.high, phase.start.low]
}

/// A matrix whose columns, as quaternions, are turned.
fn columns(matrix: [[f64; 4]; 4], turn: impl Fn([f64; 4]) -> Quaternion<f64>) -> [[f64; 4]; 4] {
    let mut turned = [[0.0; 4]; 4];
    for column in 0..4 {
        let image = turn(matrix.map(|row| row[column]));
        for (row, value) in turned.iter_mut().zip(&image.coords) {
            row[column] = *value;
        }
    }
    turned
}
