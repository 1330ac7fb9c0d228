//! Why an evaluation ends before its last time: a time without a phase, or a flag that another thread sets.

use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that is never set.
pub(crate) static GOING: AtomicBool = AtomicBool::new(false);

/// The reason why an evaluation ends before its last time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Halt {
    /// The index of a time at which the motion has no phase.
    Time(usize),
    /// The flag was set.
    Stopped,
}

impl Halt {
    /// The same reason for times that begin at the index `place`.
    pub(crate) fn later(self, place: usize) -> Self {
        match self {
            Self::Time(index) => Self::Time(place + index),
            Self::Stopped => Self::Stopped,
        }
    }
}

/// Checks the flag. It is called once for each group of times, which takes a microsecond or more.
pub(crate) fn going(stop: &AtomicBool) -> Result<(), Halt> {
    if stop.load(Ordering::Relaxed) { Err(Halt::Stopped) } else { Ok(()) }
}
