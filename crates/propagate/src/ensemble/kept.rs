//! The motions that an ensemble keeps after it has solved them.

use std::sync::Arc;

use crate::error::Error;
use crate::motion::solved::Motion;
use crate::numerics::kept::{Goes, Keep, Kept};

/// The largest memory of the motions that an ensemble keeps \[bytes\].
pub const KEPT_MEMORY: usize = 512 << 20;

/// The motion of a member, or why it has none.
pub(super) type Solved = Arc<Result<Motion, Error>>;

/// What members were solved to, by index. Copies of an ensemble share it, and it does not count when ensembles are compared.
#[derive(Clone, Debug)]
pub(super) struct KeptMotions(Arc<Kept<usize, Result<Motion, Error>>>);

impl Default for KeptMotions {
    fn default() -> Self {
        Self(Arc::new(Kept::new(KEPT_MEMORY, Goes::Newest)))
    }
}

impl KeptMotions {
    pub(super) fn get(&self, member: usize) -> Option<Solved> {
        self.0.get(&member)
    }

    /// Keeps what a member was solved to, unless it was stopped. A motion may have grown since it was kept, because the averaged equations are solved where times need them.
    pub(super) fn keep(&self, member: usize, solved: Solved) {
        if !matches!(*solved, Err(Error::Stopped)) {
            self.0.keep(member, solved);
        }
    }
}

impl Keep for Result<Motion, Error> {
    fn memory(&self) -> usize {
        self.as_ref().map_or(size_of::<Motion>(), Motion::memory)
    }
}

impl PartialEq for KeptMotions {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(feature = "torques")]
    use crate::State;

    #[test]
    fn what_was_stopped_is_not_kept_and_copies_share_the_rest() {
        let kept = KeptMotions::default();
        kept.keep(0, Arc::new(Err(Error::Stopped)));
        kept.clone().keep(1, Arc::new(Err(Error::Separatrix)));
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
}
