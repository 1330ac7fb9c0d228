//! A rigid body: three principal moments of inertia, and the constants of theory §1 that follow from them.
//!
//! Moments come in any order about body axes 1, 2, 3; the theory's A ≤ B ≤ C are the sorted ones. Differences of moments are formed
//! before they are divided, so that α, αβ and 1 − β keep their relative accuracy for a nearly spherical, oblate or prolate body.

use super::catalogue;
use crate::error::Error;

/// Slack of the triangle inequality: a flat body given in rounded decimals is still a body.
const TRIANGLE_SLACK: f64 = 8.0 * f64::EPSILON;
/// Largest ratio of moments: past it C/A − 1 and its squares near the limits of a double. No body is a needle of 1e50 : 1.
const LARGEST_RATIO: f64 = 1e100;

/// Principal moments of inertia about body axes 1, 2, 3 [any unit].
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    moments: [f64; 3],
    name: Option<String>,
}

impl Body {
    /// A body from its principal moments about body axes 1, 2, 3, in any order and any unit.
    ///
    /// # Errors
    /// - [`Error::Moment`] for `[0.0, 1.0, 1.0]`, `[-1.0, 1.0, 1.0]`, `[f64::NAN, 1.0, 1.0]`, `[f64::INFINITY, 1.0, 1.0]`.
    /// - [`Error::MomentsTriangle`] for `[1.0, 1.0, 2.1]`.
    /// - [`Error::MomentsRatio`] for `[1e-101, 1.0, 1.0]`.
    ///
    /// ```
    /// let body = andoyer_propagate::Body::new([1.0, 1.5, 2.0])?;
    /// assert!((body.beta() - 0.5).abs() < 1e-15);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn new(moments: [f64; 3]) -> Result<Self, Error> {
        for (axis, &value) in moments.iter().enumerate() {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::Moment { axis, value });
            }
        }
        let body = Self { moments, name: None };
        let [a, b, c] = body.sorted();
        // Each quotient by itself: the sum of two large moments may overflow.
        let sum = a / c + b / c;
        if sum < 1.0 - TRIANGLE_SLACK {
            return Err(Error::MomentsTriangle { moments, ratio: 1.0 / sum });
        }
        if a < c / LARGEST_RATIO {
            return Err(Error::MomentsRatio { moments, ratio: c / a, bound: LARGEST_RATIO });
        }
        Ok(body)
    }

    /// The same body with moments a little different, which need not be those of a body.
    pub(crate) fn with_moments(&self, moments: [f64; 3]) -> Self {
        Self { moments, ..self.clone() }
    }

    /// A body of the catalogue by its name, in any case: "earth", "ceres", … (the list: [`Body::catalogue`]).
    ///
    /// # Errors
    /// - [`Error::UnknownBody`] for `"vulcan"`.
    pub fn named(name: &str) -> Result<Self, Error> {
        let entry = catalogue::find(name)
            .ok_or_else(|| Error::UnknownBody { name: name.to_owned(), known: Self::catalogue() })?;
        Ok(Self::new(entry.moments)?.with_name(entry.name))
    }

    /// The names that [`Body::named`] knows.
    pub fn catalogue() -> Vec<&'static str> {
        catalogue::names().collect()
    }

    /// Where the figures of a catalogue body come from; `None` for any other name.
    pub fn source(name: &str) -> Option<&'static str> {
        catalogue::find(name).map(|entry| entry.source)
    }

    /// The same body with a name, which is printed and nothing else.
    #[must_use]
    pub fn with_name(mut self, name: &str) -> Self {
        self.name = Some(name.to_owned());
        self
    }

    /// The name, if it has one.
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// The moments about body axes 1, 2, 3, as given.
    pub fn moments(&self) -> [f64; 3] {
        self.moments
    }

    /// A ≤ B ≤ C.
    pub(crate) fn sorted(&self) -> [f64; 3] {
        let mut sorted = self.moments;
        sorted.sort_by(f64::total_cmp);
        sorted
    }

    /// C/A − 1 and C/B − 1 (theory §1), each to its last bits.
    pub(crate) fn excesses(&self) -> (f64, f64) {
        let [a, b, c] = self.sorted();
        ((c - a) / a, (c - b) / b)
    }

    /// C/A − C/B = 2αβ, without the difference of the two excesses.
    pub(crate) fn excess_difference(&self) -> f64 {
        let [a, b, c] = self.sorted();
        (c / b) * ((b - a) / a)
    }

    /// α = [(C/A − 1) + (C/B − 1)]/2 (theory §1); 0 for a sphere.
    pub fn alpha(&self) -> f64 {
        let (first, second) = self.excesses();
        0.5 * (first + second)
    }

    /// β, the triaxiality, 0 ≤ β ≤ 1 (theory §1); 0 for A = B, 1 for B = C, and 0 for a sphere, where it is not defined.
    pub fn beta(&self) -> f64 {
        let alpha = self.alpha();
        if alpha == 0.0 { 0.0 } else { (0.5 * self.excess_difference() / alpha).min(1.0) }
    }

    /// γ = √((C/A − 1)(C/B − 1)) (theory §1).
    pub fn gamma(&self) -> f64 {
        let (first, second) = self.excesses();
        first.sqrt() * second.sqrt()
    }

    /// ω = √((1 + β)/(1 − β)) (theory §1); 1 for a sphere, infinite for B = C.
    pub fn omega(&self) -> f64 {
        let (first, second) = self.excesses();
        if first == 0.0 { 1.0 } else { (first / second).sqrt() }
    }

    /// σ_sep(β) = (2/π) atan √((1−β)/2β), the action of the separatrix in units of M (theory §5); 1 for A = B, 0 for B = C.
    ///
    /// From the moments, so that it keeps its digits where β is next to 1.
    pub fn separatrix_action(&self) -> f64 {
        let (_, second) = self.excesses();
        let difference = self.excess_difference();
        if difference == 0.0 {
            return 1.0;
        }
        std::f64::consts::FRAC_2_PI * second.sqrt().atan2(difference.sqrt())
    }
}
