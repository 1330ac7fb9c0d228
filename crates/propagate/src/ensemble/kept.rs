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
        self.keep_within(KEPT_MEMORY, member, solved);
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
    use crate::Ensemble;
    use crate::input::options::{Averaging, Method};
    use crate::orbit::elements::Orbit;

    /// Two members under a torque and one without.
    fn ensemble() -> Ensemble {
        let rates = vec![[0.0, 0.01, 1.0], [0.0, 0.02, 1.0], [0.0, 1.0, 0.001]];
        let sun = Orbit::new(2e-3, 0.1).expect("an orbit");
        let ensemble = Ensemble::new(vec![[1.0, 1.02, 1.05]; 3], vec![[0.0, 0.0, 0.0, 1.0]; 3], rates);
        let ensemble = ensemble.expect("members").orbits(vec![Some(sun), None, Some(sun)]).expect("orbits");
        ensemble.span(0.0, 1e3).tolerance(1e-6)
    }

    fn attitudes(ensemble: &Ensemble, times: &[f64]) -> Vec<[f64; 4]> {
        let mut out = vec![[0.0; 4]; 3 * times.len()];
        ensemble.attitudes_into(times, &mut out).expect("attitudes");
        out
    }

    #[test]
    fn members_under_a_torque_are_solved_once() {
        let ensemble = ensemble();
        let first = attitudes(&ensemble, &[0.0, 900.0]);
        let kept = [0, 1, 2].map(|member| ensemble.kept.get(member));
        assert_eq!([0, 1, 2].map(|member: usize| kept[member].is_some()), [true, false, true]);
        let copy = ensemble.clone();
        assert_eq!(attitudes(&copy, &[0.0, 900.0]), first);
        assert_eq!(copy.plans().expect("plans").len(), 3);
        let motion = copy.motion(2).expect("a motion");
        assert_eq!(motion.plan(), &ensemble.plans().expect("plans")[2]);
        for (member, solved) in kept.iter().enumerate() {
            let again = copy.kept.get(member);
            assert_eq!(again.as_ref().map(Arc::as_ptr), solved.as_ref().map(Arc::as_ptr), "{member}");
        }
    }

    #[test]
    fn what_was_solved_for_other_options_is_not_used() {
        let ensemble = ensemble();
        let first = ensemble.plans().expect("plans");
        let shorter = ensemble.clone().span(0.0, 10.0);
        assert!(shorter.kept.get(0).is_none() && ensemble.kept.get(0).is_some());
        assert_ne!(shorter.plans().expect("plans")[0].error_bound(), first[0].error_bound());
        let changed = [ensemble.clone().tolerance(1e-7), ensemble.clone().epochs(vec![1.0]).expect("epochs")];
        assert!(changed.iter().all(|ensemble| ensemble.kept.get(0).is_none()));
        assert!(ensemble.clone().threads(1).kept.get(0).is_some());
    }

    #[test]
    fn memory_is_counted_and_bounded() {
        let ensemble = ensemble();
        let [theory, integrated] = [0, 2].map(|member| ensemble.solved(member));
        let memory = |solved: &Solved| solved.as_ref().as_ref().map_or(0, Motion::memory);
        let most = memory(&theory).max(memory(&integrated)) + 1;
        let kept = Kept::default();
        kept.keep_within(most, 0, theory.clone());
        kept.keep_within(most, 2, integrated.clone());
        assert!(kept.get(0).is_some() && kept.get(2).is_none());
        kept.keep_within(memory(&theory) - 1, 0, theory.clone());
        assert!(kept.get(0).is_none() && kept.motions().memory == 0);
        kept.keep_within(most, 2, integrated.clone());
        kept.keep_within(most, 2, integrated.clone());
        assert_eq!(kept.motions().memory, memory(&integrated));
        // 159 rotations: the steps and the rows of their series.
        let steps = integrated.as_ref().as_ref().map_or(0, |motion| motion.plan().steps());
        assert!(steps > 500 && memory(&integrated) > 72 * 10 * steps);
    }

    #[test]
    fn a_motion_that_grows_is_counted_anew() {
        let scene =
            ensemble().scene(0).expect("a scene").averaging(Averaging::Spin).method(Method::Closed).span(0.0, 1e6);
        let motion = scene.solve().expect("a motion");
        let before = motion.memory();
        motion.at(1e6).expect("a time"); // 318 orbits: 1,273 quarters
        assert!(motion.memory() > before + 1273 * 800);
    }
}
