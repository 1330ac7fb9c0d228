//! What became of the members of an ensemble: which were refused, and which miss the tolerance.

use crate::error::Error;
use crate::motion::plan::{Over, Plan, missed};

/// A member that misses the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Missed {
    member: usize,
    bound: f64,
    tolerance: f64,
    over: Over,
}

/// What became of the members of an ensemble.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    solved: usize,
    missing: usize,
    /// Members whose attitude is unknown at the end of their spans.
    lost: usize,
    worst: Option<Missed>,
    errors: Vec<(usize, Error)>,
}

impl Outcome {
    /// The members that were refused, by index, each with its error.
    pub fn errors(&self) -> &[(usize, Error)] {
        &self.errors
    }

    /// The same, for keeps.
    pub fn into_errors(self) -> Vec<(usize, Error)> {
        self.errors
    }

    /// How many members miss the tolerance.
    pub fn missing(&self) -> usize {
        self.missing
    }

    /// The member with the largest error bound of those that miss the tolerance, and that bound \[rad\].
    pub fn worst(&self) -> Option<(usize, f64)> {
        self.worst.map(|worst| (worst.member, worst.bound))
    }

    /// One sentence with their number and the worst of them where members miss the tolerance.
    pub fn missed_tolerance(&self) -> Option<String> {
        let Missed { member, bound, tolerance, over } = self.worst?;
        let said = missed(bound, tolerance, over);
        let lost = match self.lost {
            0 => String::new(),
            1 => "; the attitude of 1 member is unknown at the end of its span, and its rows there are NaN".to_owned(),
            lost => format!(
                "; the attitudes of {lost} members are unknown at the ends of their spans, and their rows there are NaN"
            ),
        };
        Some(format!(
            "{} of {} members miss the tolerance, the worst is member {member}: {said}{lost}",
            self.missing, self.solved
        ))
    }

    /// With a member that was solved.
    pub(crate) fn solved(mut self, member: usize, plan: &Plan) -> Self {
        self.solved += 1;
        self.lost += usize::from(plan.known().is_some());
        if !plan.meets_tolerance() {
            self.missing += 1;
            let (bound, tolerance, over) = (plan.error_bound, plan.tolerance, plan.over());
            self.worst = worse(self.worst, Some(Missed { member, bound, tolerance, over }));
        }
        self
    }

    /// With a member that was refused.
    pub(crate) fn refused(mut self, member: usize, error: Error) -> Self {
        self.errors.push((member, error));
        self
    }

    /// This and the outcome of the members after it.
    pub(crate) fn and(mut self, later: Self) -> Self {
        self.solved += later.solved;
        self.missing += later.missing;
        self.lost += later.lost;
        self.worst = worse(self.worst, later.worst);
        self.errors.extend(later.errors);
        self
    }

    /// This, or the error of the first member that was refused.
    pub(crate) fn or_first_error(mut self) -> Result<Self, Error> {
        if self.errors.is_empty() { Ok(self) } else { Err(self.errors.swap_remove(0).1) }
    }
}

/// The one with the larger bound; of equals the first.
fn worse(first: Option<Missed>, second: Option<Missed>) -> Option<Missed> {
    match (first, second) {
        (Some(one), Some(other)) => Some(if other.bound > one.bound { other } else { one }),
        (one, other) => one.or(other),
    }
}
