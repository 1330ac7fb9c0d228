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

    /// Keeps what a member was solved to if there is room, unless it was stopped. A motion may have grown since it was kept, because the averaged equations are solved where times need
    /// them; one that has no room any more is dropped.
    pub(super) fn keep(&self, member: usize, solved: Solved) {
        if !matches!(*solved, Err(Error::Stopped)) {
            self.keep_within(KEPT_MEMORY, member, solved);
        }
    }

    fn keep_within(&self, most: usize, member: usize, solved: Solved) {
        let memory = solved.as_ref().as_ref().map_or(size_of::<Motion>(), Motion::memory);
        let mut motions = self.motions();
        if let Some((_, before)) = motions.by_member.remove(&member) {
            motions.memory -= before;
        }
        if motions.memory + memory <= most {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::State;

    fn solved(rates: [f64; 3]) -> Solved {
        let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], rates).expect("a state");
        Arc::new(Ok(crate::solve::solved([1.0, 1.02, 1.05], state)))
    }

    #[test]
    fn memory_is_counted_and_bounded() {
        let [one, other] = [solved([0.0, 0.01, 1.0]), solved([0.0, 1.0, 0.001])];
        let memory = |solved: &Solved| solved.as_ref().as_ref().map_or(0, Motion::memory);
        let most = memory(&one).max(memory(&other)) + 1;
        let kept = Kept::default();
        kept.keep_within(most, 0, one.clone());
        kept.keep_within(most, 2, other.clone());
        assert!(kept.get(0).is_some() && kept.get(2).is_none());
        kept.keep_within(memory(&one) - 1, 0, one.clone());
        assert!(kept.get(0).is_none() && kept.motions().memory == 0);
        kept.keep_within(most, 2, other.clone());
        kept.keep_within(most, 2, other.clone());
        assert_eq!(kept.motions().memory, memory(&other));
    }

    #[test]
    fn what_was_stopped_is_not_kept() {
        let kept = Kept::default();
        kept.keep(0, Arc::new(Err(Error::Stopped)));
        kept.keep(1, Arc::new(Err(Error::Separatrix)));
        assert!(kept.get(0).is_none() && kept.get(1).is_some());
    }

    #[cfg(feature = "torques")]
    #[test]
    fn a_motion_that_grows_is_counted_anew() {
        use crate::{Body, Orbit, Scene};
        let sun = Orbit::new(2e-3, 0.1).expect("an orbit");
        let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.01, 1.0]).expect("a state");
        let scene = Scene::new(Body::new([1.0, 1.02, 1.05]).expect("a body"), state).orbit(sun);
        let scene = scene.averaging(crate::options::Averaging::Spin).span(0.0, 1e6);
        let polhode = crate::torque_free::polhode::Polhode::new(scene.body(), &state);
        let motion = crate::solve::averaged(scene, polhode.as_ref(), &[sun]).expect("a motion");
        let before = motion.memory();
        motion.at(1e6).expect("a time"); // 318 orbits: 1,273 quarters
        assert!(motion.memory() > before + 1273 * 800);
    }

    #[test]
    fn copies_share_what_was_solved() {
        let kept = Kept::default();
        let motion = solved([0.0, 0.01, 1.0]);
        kept.clone().keep(1, motion.clone());
        assert_eq!(kept.get(1).as_ref().map(Arc::as_ptr), Some(Arc::as_ptr(&motion)));
        assert!(kept.get(0).is_none());
    }
}
