//! Interruptions of long sums.

use crate::error::Error;

/// Number of products between two calls of `pause`. With large rationals they take some tens of milliseconds.
pub(super) const PRODUCTS_PER_PAUSE: usize = 1 << 14;

/// A callback of long sums; its error ends the sum.
pub(crate) type Pause<'a> = dyn FnMut() -> Result<(), Error> + 'a;
