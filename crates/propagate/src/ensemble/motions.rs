//! The motions of the members: solved in groups, and kept where a torque acts.

use std::ops::Range;
use std::sync::Arc;

use crate::error::Error;
use crate::input::body::Body;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::motion::solved::Motion;
use crate::simd::lanes::WIDEST;
use crate::solve::several;

use super::kept::Solved;
use super::members::{BLOCK, Ensemble};

/// Members under a gravity gradient that a thread takes at least, at 200 µs each.
const DISTURBED_BLOCK: usize = 2;

impl Ensemble {
    pub(super) fn scene(&self, index: usize) -> Result<Scene, Error> {
        let state = State::new(self.epoch(index), self.attitudes()[index], self.angular_velocities()[index])?;
        let body = match self.asked_tensors().get(index) {
            Some(tensor) => Body::from_inertia(*tensor)?,
            None => Body::new(self.moments()[index])?,
        };
        let mut scene = Scene::new(body, state).tolerance(self.asked_tolerance());
        if let Some(&orbit) = self.orbit(index) {
            scene = scene.orbit(orbit);
        }
        if let Some((start, stop)) = self.asked_span() {
            scene = scene.span(start, stop);
        }
        // The state is valid already.
        scene.validate_options()?;
        Ok(scene)
    }

    /// Calls `each` with the motions of members, one after another. Their plans do not say what was skipped. There are at most [`Ensemble::group`] of them.
    pub(super) fn each_motion(&self, members: Range<usize>, mut each: impl FnMut(&Result<Motion, Error>)) {
        if !members.clone().all(|member| self.is_kept(member)) {
            return several(members.map(|member| self.scene(member)).collect(), each);
        }
        for member in members {
            let solved = self.solved(member);
            each(&solved);
            self.kept.keep(member, solved);
        }
    }

    /// Whether the motion of a member is kept: it takes some 100 times as long to solve if a torque acts, and not much more memory.
    fn is_kept(&self, member: usize) -> bool {
        self.orbit(member).is_some()
    }

    /// The motion of a member that is kept.
    pub(super) fn solved(&self, member: usize) -> Solved {
        self.kept.get(member).unwrap_or_else(|| Arc::new(self.scene(member).and_then(|scene| scene.solve())))
    }

    /// Members that are solved at once. Those under a gravity gradient are solved one by one.
    pub(super) fn group(&self) -> usize {
        if self.asked_orbits().is_empty() { WIDEST } else { 1 }
    }

    /// The motion of one member.
    ///
    /// # Errors
    /// - [`Error::Index`] for an index that no member has.
    /// - [`Error::Member`] with what [`Scene::solve`] says of it.
    pub fn motion(&self, index: usize) -> Result<Motion, Error> {
        if index >= self.len() {
            return Err(Error::Index { index, members: self.len() });
        }
        let motion = if self.is_kept(index) {
            let solved = self.solved(index);
            self.kept.keep(index, solved.clone());
            Result::clone(&solved)
        } else {
            self.scene(index).and_then(|scene| scene.solve())
        };
        motion.map_err(|problem| Error::of_member(index, problem))
    }

    /// Members that a thread takes at least, a multiple of the group.
    pub(super) fn block(&self) -> usize {
        if self.asked_orbits().is_empty() { BLOCK } else { DISTURBED_BLOCK }
    }
}
