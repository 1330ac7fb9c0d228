//! The motions that an ensemble keeps after it has solved them.

use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::error::Error;
use crate::motion::solved::Motion;

/// The largest memory of the motions that an ensemble keeps \[bytes\].
pub const KEPT_MEMORY: usize = 512 << 20;

/// The motion of a member, or why it has none.
pub(super) type Solved = Arc<Result<Motion, Error>>;

/// What members were solved to. Copies of an ensemble share it, and it does not count when ensembles are compared.
#[derive(Clone, Default)]
pub(super) struct Kept(Arc<Mutex<Motions>>);

#[derive(Default)]
struct Motions {
    /// With the memory that was counted for each.
    by_member: HashMap<usize, (Solved, usize)>,
    memory: usize,
}

impl Kept {
    pub(super) fn get(&self, member: usize) -> Option<Solved> {
        self.motions().by_member.get(&member).map(|(solved, _)| solved.clone())
    }

    /// Keeps what a member was solved to if there is room. A motion may have grown since it was kept, because the averaged equations are solved where times need
    /// them; one that has no room any more is dropped.
    pub(super) fn keep(&self, member: usize, solved: Solved) {
        let memory = solved.as_ref().as_ref().map_or(size_of::<Motion>(), Motion::memory);
        let mut motions = self.motions();
        if let Some((_, before)) = motions.by_member.remove(&member) {
            motions.memory -= before;
        }
        if motions.memory + memory <= KEPT_MEMORY {
            motions.memory += memory;
            motions.by_member.insert(member, (solved, memory));
        }
    }

    /// Each change leaves the map and its memory in accord, also if a thread panicked after it.
    fn motions(&self) -> MutexGuard<'_, Motions> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl PartialEq for Kept {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for Kept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let motions = self.motions();
        write!(f, "{} motions in {} bytes", motions.by_member.len(), motions.memory)
    }
}
