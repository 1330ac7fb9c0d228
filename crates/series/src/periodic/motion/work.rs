//! The work of a periodic motion and its frame, counted before it is done: multiplications of two floats, and what takes as long.
//!
//! The constants are the times of single steps, on grids of 9 to 9,409 times, over the time of a multiplication in the steps of two phases; those of one phase are up to three times as
//! fast. [`MOST_WORK`] is a few seconds of one core at most. The count is the same on every machine.

use crate::error::Error;
use crate::periodic::hamiltonian::DrivenHamiltonian;
use crate::periodic::rows::grid::Grid;

/// Most work of a solution that nobody asks for: of a periodic motion and its frame on all grids, and of what follows.
pub const MOST_WORK: f64 = 2e9;

/// Is told the work of the next step, and returns the error that ends the iteration.
pub type Going<'a> = dyn FnMut(f64) -> Result<(), Error> + 'a;

/// A harmonic transform there and back.
fn filter(grid: &Grid) -> f64 {
    let counts: usize = (0..grid.phases()).map(|phase| grid.count(phase)).sum();
    2.0 * (grid.times() * counts) as f64
}

/// A Newton step towards the frame of a matrix of n rows.
pub(super) fn of_frame(grid: &Grid, n: usize) -> f64 {
    let n = n as f64;
    2.0 * n * n * filter(grid) + PRODUCTS * 4.0 * n.powi(3) * grid.times() as f64 + FRAME
}

/// A Taylor step of a matrix of n rows, whose entries have so many harmonics in all.
pub(super) fn of_taylor_step(n: usize, order: usize, harmonics: usize) -> f64 {
    (order * order) as f64 * ((n as f64).powi(3) + SMALL_PRODUCT) / 2.0 + (4 * order * harmonics) as f64
}

/// The products of matrices in a step towards a frame: most are in the exponential.
const PRODUCTS: f64 = 12.0;

/// What a step towards a frame takes on the smallest grids, and a product of two matrices of two rows, in multiplications.
const FRAME: f64 = 1e5;
const SMALL_PRODUCT: f64 = 20.0;

/// A Newton step towards a periodic motion without its frame: the Hamiltonian at the times of a grid.
pub(super) fn of_step(system: &dyn DrivenHamiltonian, grid: &Grid) -> f64 {
    (4 * system.pairs()) as f64 * filter(grid) + system.work() * grid.times() as f64
}

/// The work of a solution at all times together: the elimination of a linear system.
pub(super) fn of_all_times(rows: usize) -> f64 {
    (rows as f64).powi(3) / 3.0
}

/// The error of a grid whose next step is beyond the most work.
pub(super) fn too_large(grid: &Grid, most: f64) -> Error {
    Error::DrivenWorkTooLarge { times: grid.times(), work: most }
}

/// Whether an error of `going` ends the search.
pub(super) fn ends(error: &Error) -> bool {
    matches!(error, Error::Interrupted { .. } | Error::DrivenWorkTooLarge { .. })
}

/// So many values of a coefficient between the times of a grid.
pub(super) fn of_values(values: usize, times: usize) -> f64 {
    (values * (times + 100)) as f64
}
