//! The evaluation plan of a motion: mode, method, order, harmonics, error bound, and the parts of the theory that were not needed.

use std::f64::consts::PI;
use std::fmt;

use andoyer_series::error::Short;
use nalgebra::Vector3;

use super::verification_cost::VerificationCost;
use crate::error::duration_in_words;
use crate::input::options::{Averaging, Level, Method};
use crate::input::scene::Scene;
use crate::torque_free::error_budget::DEFAULT_ROTATIONS;
use crate::torque_free::mode::Mode;

/// If σ/σ_sep exceeds this, its distance from 1 is printed.
const NEAR_ONE: f64 = 0.999;

/// A smaller tolerance counts as met if the error bound is within this limit, which rounding sets \[rad\].
pub(crate) const ROUNDED_TOLERANCE: f64 = 2e-14;

/// The longest verification without a span \[s\].
pub(crate) const LONGEST_VERIFICATION: f64 = 60.0;

/// The entries of a plan that concern the gravity gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct GradientPlan {
    pub(crate) averaging: Averaging,
    pub(crate) level: Level,
    /// Number of terms in the short-period corrections.
    pub(crate) terms: usize,
    /// Sum of the sizes of all terms that are not slow, also dropped ones \[rad\].
    pub(crate) size: f64,
    /// The largest of the dropped terms, the truncation errors of kept terms, and the square of `size` \[rad\].
    pub(crate) neglected: f64,
}

/// The entries of a plan about an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct IntegrationPlan {
    pub(crate) steps: usize,
    pub(crate) bodies: usize,
    /// The number of torques beside the gravity gradient.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) torques: usize,
    /// The error bound without the interpolation of tables, where it is less than half of the whole and the whole exceeds the tolerance \[rad\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) uninterpolated: Option<f64>,
    /// The first and the last time at which the error bound is below half a turn, where these are not the ends of the span.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) known: Option<[f64; 2]>,
}

/// The evaluation plan of a motion. It is printed in ASCII, and can be serialized.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Plan {
    pub(crate) mode: Mode,
    pub(crate) method: Method,
    pub(crate) order: usize,
    pub(crate) harmonics: usize,
    pub(crate) error_bound: f64,
    /// Largest |ω| of the torque-free motion, or of an integrated one if that is larger.
    pub(crate) fastest: f64,
    pub(crate) tolerance: f64,
    /// Whether the scene has a span.
    pub(crate) spanned: bool,
    /// Rotations from the epoch over which the averaged equations are solved, if they are fewer than the tolerance is for.
    pub(crate) reach: Option<f64>,
    pub(crate) separatrix_ratio: f64,
    pub(crate) gradient: Option<GradientPlan>,
    pub(crate) integration: Option<IntegrationPlan>,
    /// 2r of a libration about r rotations an orbit.
    pub(crate) resonance: Option<i32>,
    /// Whether derivatives are computed by power series, because their closed form cancels.
    pub(crate) expanded: bool,
    /// The cost of a verification over the span, if the scene has one; without its torques until the motion under them is solved.
    pub(crate) verification: Option<VerificationCost>,
    pub(crate) skipped: Vec<String>,
}

impl Plan {
    /// The plan of a scene that uses the closed form without a sum. The caller adds the other entries.
    pub(crate) fn new(scene: &Scene, mode: Mode, separatrix_ratio: f64, error_bound: f64) -> Self {
        Self {
            mode,
            method: Method::Closed,
            order: 0,
            harmonics: 0,
            error_bound: error_bound.min(std::f64::consts::PI),
            fastest: fastest(scene.body().moments(), scene.state().angular_velocity),
            tolerance: scene.asked_tolerance(),
            spanned: scene.asked_span().is_some(),
            reach: None,
            separatrix_ratio,
            gradient: None,
            integration: None,
            resonance: None,
            expanded: false,
            verification: VerificationCost::over_span(scene),
            skipped: Vec::new(),
        }
    }

    /// The mode of the motion.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The method of evaluation: the series, the closed form (which includes the formulas of steady rotation), or the integration.
    pub fn method(&self) -> Method {
        self.method
    }

    /// Order N of the series. It is 0 if no series is used, or if the harmonic oscillator alone meets the tolerance. For an integration it is the order of the
    /// steps.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Number of steps of the integration; 0 if there is none.
    pub fn steps(&self) -> usize {
        self.integration.map_or(0, |integration| integration.steps)
    }

    /// The first and the last time at which the error bound is below half a turn, of a member of an ensemble that is not served over its whole span.
    pub fn known(&self) -> Option<[f64; 2]> {
        self.integration.and_then(|integration| integration.known)
    }

    /// The resonance of a libration: two integers whose quotient is the number of rotations an orbit, in lowest terms.
    pub fn resonance(&self) -> Option<[i32; 2]> {
        self.resonance.map(|twice| if twice % 2 == 0 { [twice / 2, 1] } else { [twice, 2] })
    }

    /// The number of harmonics of a libration, or the highest multiple of ℓ′ that is evaluated; 0 if there is none.
    pub fn harmonics(&self) -> usize {
        self.harmonics
    }

    /// Estimated bound of the attitude error over the span \[rad\], not proved: truncation, dropped harmonics, rounding, and under a torque what the average leaves.
    pub fn error_bound(&self) -> f64 {
        self.error_bound
    }

    /// Estimated bound of the error of the angular velocity over the span, in body components \[rad per unit of time\]: 2 |ω| times the error bound of the attitude, with the
    /// largest |ω| of the torque-free motion, or of the steps of an integration. One part is the error of the direction of the angular momentum in the body, the other that of the phase along the polhode.
    ///
    /// A motion that starts from a sample has an error of this rate: its attitude departs by the bound times the time.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 3.0])?;
    /// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).solve()?;
    /// assert_eq!(motion.plan().rate_error_bound(), 6.0 * motion.plan().error_bound());
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn rate_error_bound(&self) -> f64 {
        2.0 * self.fastest * self.error_bound
    }

    /// The requested attitude error over the span \[rad\].
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Whether the error bound is within the tolerance. If the tolerance is below the limit of double precision, 2e-14 rad counts instead.
    ///
    /// ```
    /// use andoyer_propagate::{Body, Orbit, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.01, 1.0])?;
    /// let free = Scene::new(Body::new([1.0, 1.02, 1.05])?, state);
    /// assert!(free.solve()?.plan().meets_tolerance());
    /// let disturbed = free.orbit(Orbit::new(2e-3, 0.1)?).span(0.0, 1e5).solve()?;
    /// assert!(!disturbed.plan().meets_tolerance() && disturbed.plan().error_bound() > 1e-12);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn meets_tolerance(&self) -> bool {
        self.known().is_none() && self.error_bound <= self.tolerance.max(ROUNDED_TOLERANCE)
    }

    /// A sentence with the error bound and the tolerance if the tolerance is not met, otherwise `None`.
    pub fn missed_tolerance(&self) -> Option<String> {
        (!self.meets_tolerance()).then(|| missed(self.error_bound, self.tolerance, self.over()) + &self.interpolation())
    }

    /// That a table has too few times for the tolerance, where it has, as the end of a sentence.
    fn interpolation(&self) -> String {
        let alone = self.integration.and_then(|integration| integration.uninterpolated);
        alone.map_or_else(String::new, |alone| {
            let alone = bound_in_words(alone);
            format!("; the interpolation of the table of positions makes most of it (the integration alone has {alone}): give closer times")
        })
    }

    /// The times over which the tolerance must hold.
    pub(crate) fn over(&self) -> Over {
        if self.spanned { Over::Span } else { Over::Rotations(self.averaging().zip(self.reach)) }
    }

    /// The cost of [`Motion::verify`](crate::Motion::verify) without a span.
    pub(crate) fn verification_cost(&self) -> VerificationCost {
        if let Some(IntegrationPlan { steps, bodies, .. }) = self.integration {
            return VerificationCost { steps: steps as f64, bodies };
        }
        self.verification.unwrap_or_else(|| {
            let rotations = if self.mode == Mode::AtRest { 0.0 } else { self.reach.unwrap_or(DEFAULT_ROTATIONS) };
            VerificationCost::over_rotations(rotations, usize::from(self.gradient.is_some()))
        })
    }

    /// How long a verification takes, and whether it needs a span.
    fn cost_in_words(&self) -> String {
        let cost = self.verification_cost();
        let (time, steps) = (duration_in_words(cost.seconds()), cost.steps);
        if cost.seconds() > LONGEST_VERIFICATION {
            format!("needs a span: about {time} ({steps:.1e} steps) over {}", self.over())
        } else {
            format!("takes about {time} ({steps:.1e} steps)")
        }
    }

    /// σ/σ_sep: 0 on the axis of greatest inertia, 1 on the separatrix (theory §5).
    pub fn separatrix_ratio(&self) -> f64 {
        self.separatrix_ratio
    }

    /// The averaging of a scene with an orbit; `None` without an orbit and for an integrated motion.
    pub fn averaging(&self) -> Option<Averaging> {
        self.gradient.map(|gradient| gradient.averaging)
    }

    /// The level of the gravity-gradient theory; `None` without an orbit and for an integrated motion.
    ///
    /// ```
    /// use andoyer_propagate::options::Level;
    /// use andoyer_propagate::{Body, Method, Orbit, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.01, 1.0])?;
    /// let scene = Scene::new(Body::new([1.0, 1.02, 1.05])?, state).span(0.0, 1e4).method(Method::Closed);
    /// let disturbed = scene.clone().orbit(Orbit::new(2e-3, 0.1)?);
    /// assert_eq!(disturbed.solve()?.plan().level(), Some(Level::SecondOrder));
    /// assert_eq!(disturbed.tolerance(1e-3).solve()?.plan().level(), Some(Level::Full));
    /// assert_eq!(scene.solve()?.plan().level(), None);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn level(&self) -> Option<Level> {
        self.gradient.map(|gradient| gradient.level)
    }

    /// Sum of the short-period corrections for the gravity gradient \[rad\], which measures the torque. It is 0 without an orbit, and for an integrated or a
    /// locked motion: these have no such corrections, whatever the torque.
    pub fn torque(&self) -> f64 {
        self.gradient.map_or(0.0, |gradient| gradient.size)
    }

    /// The first neglected term under a gravity gradient \[rad\]: a short-period term of second order in the torque, which no level has, or one of first order
    /// that was dropped; 0 without an orbit.
    pub fn first_neglected(&self) -> f64 {
        self.gradient.map_or(0.0, |gradient| gradient.neglected)
    }

    /// The method for derivatives with respect to the state and the moments or the tensor:
    ///
    /// - "closed": the closed form (theory §12).
    /// - "series": power series in time. They replace the closed form where it cancels: next to a sphere, to the separatrix and to the middle axis, and for a body
    ///   from a tensor also with nearly equal moments.
    /// - "variational": variational equations, integrated from the epoch, for a scene with a torque. Farther from the epoch of an averaged motion than 2,500 steps, some
    ///   200 rotations, they are differences of fourth order of motions by the same theory. Their error is some 1e-9 of the largest
    ///   derivative; with respect to an element of an orbit the error of the theory counts, up to 3e-5 in random scenes.
    ///
    /// It is `None` on the separatrix, where the frequencies have no derivatives.
    pub fn partials(&self) -> Option<&'static str> {
        match (self.mode, self.method, self.gradient) {
            (_, method, gradient) if method.is_of_torques() || gradient.is_some() => Some("variational"),
            (Mode::Separatrix, _, None) => None,
            _ if self.expanded => Some("series"),
            _ => Some("closed"),
        }
    }

    /// The parts of the theory that this scene did not need, each with its reason.
    pub fn skipped(&self) -> &[String] {
        &self.skipped
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "mode          {}", self.mode)?;
        writeln!(f, "method        {}", self.method())?;
        match self.separatrix_ratio {
            ratio if ratio > NEAR_ONE && ratio < 1.0 => {
                writeln!(f, "separatrix    1 - {:.3e} (sigma/sigma_sep)", 1.0 - ratio)?;
            }
            ratio => writeln!(f, "separatrix    {ratio:.3e} (sigma/sigma_sep)")?,
        }
        match self.method {
            method if method == Method::Series || method.is_of_torques() => {
                writeln!(f, "order         {}", self.order)?
            }
            _ => writeln!(f, "order         -")?,
        }
        match self.harmonics {
            0 => writeln!(f, "harmonics     -")?,
            harmonics => writeln!(f, "harmonics     {harmonics}")?,
        }
        if let Some(IntegrationPlan { steps, bodies, torques, .. }) = self.integration {
            let plural = if bodies == 1 { "body" } else { "bodies" };
            write!(f, "steps         {steps} over the span, under {bodies} disturbing {plural}")?;
            match torques {
                0 => writeln!(f)?,
                1 => writeln!(f, " and 1 other torque")?,
                torques => writeln!(f, " and {torques} other torques")?,
            }
        }
        if let Some([first, last]) = self.known() {
            let (first, last) = (Short::rounded(first, 6), Short::rounded(last, 6));
            writeln!(
                f,
                "known         from {first} to {last}: beyond, nearby states have separated and the error bound is half a turn"
            )?;
        }
        if let Some(twice) = self.resonance {
            writeln!(f, "resonance     {} rotations an orbit", in_words(twice))?;
        }
        if let Some(GradientPlan { averaging, level, terms, size, neglected }) = self.gradient {
            writeln!(
                f,
                "gradient      {level}, averaged over the {averaging}; {terms} short-period terms, together {size:.1e} rad, \
                 first neglected {neglected:.1e}"
            )?;
        }
        if self.error_bound < PI {
            write!(f, "error bound   {:.1e} rad", self.error_bound)?;
        } else {
            write!(f, "error bound   unknown (half a turn or more); {}", self.over().advice())?;
        }
        write!(f, "\nverify        {}", self.cost_in_words())?;
        if !self.meets_tolerance() {
            write!(
                f,
                "\ntolerance     {:e} rad is not met over {}{}",
                self.tolerance,
                self.over(),
                self.interpolation()
            )?;
        }
        for reason in &self.skipped {
            write!(f, "\nskipped       {reason}")?;
        }
        Ok(())
    }
}

/// The times over which a tolerance must hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Over {
    /// The span of the scene.
    Span,
    /// The rotations that count without a span, or the fewer ones that an averaging reaches.
    Rotations(Option<(Averaging, f64)>),
}

impl Over {
    /// The advice for a motion whose attitude is unknown at the end of the span.
    fn advice(self) -> &'static str {
        if self == Self::Span { "give a shorter span" } else { "give a span" }
    }
}

impl fmt::Display for Over {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Span => f.write_str("the span"),
            Self::Rotations(None) => write!(f, "{DEFAULT_ROTATIONS:e} rotations (no span given)"),
            Self::Rotations(Some((averaging, reach))) => {
                write!(f, "{reach:.1e} rotations (no span given; averaging = {averaging} reaches no farther)")
            }
        }
    }
}

/// The sentence for a tolerance that is not met.
pub(crate) fn missed(bound: f64, tolerance: f64, over: Over) -> String {
    let advice = if bound < PI { String::new() } else { format!("; {}", over.advice()) };
    let bound = bound_in_words(bound);
    format!("the error bound of the attitude, {bound}, exceeds the tolerance, {tolerance:e} rad, over {over}{advice}")
}

/// A resonance as text: 3/2, or 1.
pub(crate) fn in_words(twice: i32) -> String {
    if twice % 2 == 0 { (twice / 2).to_string() } else { format!("{twice}/2") }
}

/// A message without the signs that a plan does not print.
pub(crate) fn in_ascii(message: &str) -> String {
    message.replace('σ', "sigma").replace('−', "-").replace('²', "^2")
}

/// An error bound as text. One of half a turn or more holds for any attitude, and has no figure.
pub(crate) fn bound_in_words(bound: f64) -> String {
    if bound < PI { format!("{bound:.1e} rad") } else { "half a turn or more".to_owned() }
}

/// The largest |ω| of a torque-free motion. Energy and momentum are linear in the squares of the rates, so Σω² is largest where one of them is 0.
fn fastest(moments: [f64; 3], rates: Vector3<f64>) -> f64 {
    let squares = rates.map(|rate| rate * rate);
    let [energy, momentum] =
        [1, 2].map(|power| (0..3).map(|axis| moments[axis].powi(power) * squares[axis]).sum::<f64>());
    let without = |axis: usize| {
        let (one, other) = (moments[(axis + 1) % 3], moments[(axis + 2) % 3]);
        let part = |one: f64, other: f64| (momentum - other * energy) / (one * (one - other));
        let pair = [part(one, other), part(other, one)];
        // A polhode does not pass through a negative square, and equal moments have 0/0.
        if pair.iter().all(|square| *square >= 0.0) { pair[0] + pair[1] } else { 0.0 }
    };
    (0..3).map(without).fold(squares.sum(), f64::max).sqrt()
}
