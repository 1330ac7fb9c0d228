//! Many bodies at a few epochs each: solved and evaluated member by member, in memory proportional to the result.
//!
//! A member's motion lives while its rows are written; nothing of it is kept. Each member is computed by one thread alone, so that the bits
//! do not depend on how many threads there are. A member costs its set-up, 4 to 6 µs, some 200 µs under the gravity gradient of an orbit, and its epochs.
//! Every bad member is found before any is computed, and the error names the first with its index.

mod members;
mod on_error;
mod pool;
mod run;

pub use crate::outcome::Outcome;
pub use members::Ensemble;
pub use on_error::OnError;
pub use pool::MAX_THREADS;
pub use run::Run;
