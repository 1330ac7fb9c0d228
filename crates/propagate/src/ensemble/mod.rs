//! Many bodies: if all are free, those about their principal axes are solved in groups of sixteen, else one by one, and evaluated member by member, in memory proportional to the result.
//!
//! The constants of the polhodes of a group and their frequencies are computed in lanes, one member a lane. No operation combines lanes and a group is computed
//! by one thread, so that the bits depend neither on the number of threads nor on the other members. The motions under torques and those that are integrated are kept, up to [`KEPT_MEMORY`]: of an
//! integration the start of each step, from which a later call expands the steps that its times fall into. The motion of another member lives while its rows are written. Every member that is no body or no state is found before any is computed, and the error names the first with its index.

mod asked;
mod distribution;
mod kept;
mod members;
mod motions;
mod on_error;
mod options;
#[cfg_attr(not(feature = "rayon"), path = "one_thread.rs")]
mod pool;
mod run;
mod scenes;

pub use crate::outcome::Outcome;
pub use distribution::TumblingMember;
pub use kept::KEPT_MEMORY;
pub use members::Ensemble;
pub use on_error::OnError;
#[cfg(feature = "rayon")]
pub use pool::MAX_THREADS;
pub use run::MembersRun;
