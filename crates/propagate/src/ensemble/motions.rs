//! The motions of the members: solved in groups, and kept where a torque acts.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::error::Error;
use crate::input::body::Body;
use crate::input::options::Served;
use crate::input::scene::Scene;
use crate::input::state::State;
use crate::motion::solved::Motion;
use crate::simd::halt::GOING;
use crate::simd::lanes::WIDEST;
use crate::solve::several;

use super::members::{BLOCK, Ensemble};
use super::on_error::OnError;

impl Ensemble {
    pub(super) fn scene_of_columns(&self, index: usize) -> Result<Scene, Error> {
        let state = State::new(self.epoch(index), self.attitudes()[index], self.angular_velocities()[index])?;
        let body = match self.asked_tensors().get(index) {
            Some(tensor) => Body::from_inertia(*tensor)?,
            None => Body::new(self.moments()[index])?,
        };
        let mut scene = Scene::new(body, state).tolerance(self.asked_tolerance()).method(self.asked_method());
        #[cfg(feature = "torques")]
        {
            scene = scene.level(self.asked_level()).torques(self.asked_torques().iter().cloned());
            scene = scene.disturbing(self.orbits_of(index).iter().cloned());
        }
        if let Some((start, stop)) = self.asked_span() {
            scene = scene.span(start, stop);
        }
        // The state is valid already.
        scene.validate_options()?;
        Ok(scene)
    }

    /// Calls `each` with the motions of members, one after another. There are at most [`Ensemble::group`] of them. The plans of free motions do not say what was skipped.
    pub(super) fn each_motion(
        &self,
        members: Range<usize>,
        stop: &AtomicBool,
        mut each: impl FnMut(&Result<Motion, Error>),
    ) {
        if !members.clone().any(|member| self.is_kept(member)) {
            return several(members.map(|member| self.scene(member)).collect(), each);
        }
        for member in members {
            if let Some(kept) = self.kept.get(member) {
                each(&kept);
                self.kept.keep(member, kept);
                continue;
            }
            let solved = self.solved(member, stop);
            each(&solved);
            if self.is_kept(member) {
                self.kept.keep(member, Arc::new(solved.map(Motion::compact)));
            }
        }
    }

    /// Whether the motion of a member is kept: it takes some 100 times as long to solve if a torque acts or it is integrated.
    pub(super) fn is_kept(&self, member: usize) -> bool {
        let (method, torques) = match self.scenes.get(member) {
            Some(Ok(scene)) => (scene.asked_method(), scene.asked_torques()),
            Some(Err(_)) => return false,
            None => (self.asked_method(), self.asked_torques()),
        };
        !self.orbits_of(member).is_empty() || !torques.is_empty() || method.is_integrated()
    }

    /// The motion of a member, solved.
    fn solved(&self, member: usize, stop: &AtomicBool) -> Result<Motion, Error> {
        self.scene(member).and_then(|scene| scene.served(self.served(), stop))
    }

    /// The part of its span over which a member is solved. With [`OnError::Nan`] it ends where the error bound reaches half a turn, and only the rows of later times are NaN.
    fn served(&self) -> Served {
        match self.on_error {
            OnError::Raise => Served::WholeSpan,
            OnError::Nan => Served::WhileKnown,
        }
    }

    /// Whether no member is kept.
    pub fn is_free(&self) -> bool {
        match self.scenes.len() {
            0 => self.is_empty() || self.asked_orbits().is_empty() && !self.is_kept(0),
            members => !(0..members).any(|member| self.is_kept(member)),
        }
    }

    /// Members that are solved at once: sixteen if all are free, in lanes, else one.
    pub(super) fn group(&self) -> usize {
        if self.is_free() { WIDEST } else { 1 }
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
        let motion = match self.kept.get(index) {
            Some(kept) => Result::clone(&kept).map(Motion::whole),
            None if self.is_kept(index) => {
                let solved = self.solved(index, &GOING);
                self.kept.keep(index, Arc::new(solved.clone()));
                solved
            }
            None => self.scene(index).and_then(|scene| scene.solve()),
        };
        motion.map_err(|problem| Error::of_member(index, problem))
    }

    /// Members that a thread takes at least, a multiple of the group.
    pub(super) fn block(&self) -> usize {
        if self.is_free() { BLOCK } else { 1 }
    }
}
