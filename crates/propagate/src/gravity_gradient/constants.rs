//! The tuned numbers of the gravity gradient. Exact mathematical constants stand where they are used; whole numbers (sizes of tables, counts of steps) too.
//!
//! - *Fitted* to errors that were measured: `gradient safety 1600 SEED` and `gradient climb 2 90 SEED` print error over estimate (`cargo build --release -p andoyer-tests
//!   --features programs --bin gradient`, then `target/release/gradient`); `make gravity` records a climb.
//! - *Shares* of the tolerance or of the largest part, which trade time for accuracy: `make rivals-gradient` prints the time of a sample and of a set-up.
//! - *Limits* of a formula: beyond them it does not converge, or another one is more accurate. `gradient bounds` and `gradient table` print what is served and its error.
//! - *Rounding*: below them a double has no digit, or a quotient loses digits. The unit tests of the files that use them hold them.

// Fitted.

/// Safety factor of the periodic change of the next order.
pub(crate) const PERIODIC: f64 = 5.0;
/// Safety factor of the drift of the next order.
pub(crate) const DRIFT: f64 = 1.5;
/// Safety factor of the drift by the errors of the mean M and L at the epoch.
pub(crate) const EPOCH: f64 = 4.0;
/// Factor of the average over the orbit. With it the estimate of a motion averaged over the orbit is 20 to 70 times the error in the median.
pub(crate) const ORBIT: f64 = 0.5;
/// Relative error of a sum around the orbit: R changes within the span.
pub(crate) const SOURCE_CHANGE: f64 = 0.02;
/// Safety factor of slow pairs. R is taken at the epoch, and elsewhere on the orbit the directions to the disturbing body may make it larger.
pub(crate) const SOURCE_MARGIN: f64 = 3.0;

// Shares.

/// A Fourier coefficient of a time derivative is dropped if its effect on the attitude is below this fraction of that of the largest dropped term.
pub(crate) const SMALLEST_COEFFICIENT: f64 = 0.004;
/// Fraction of the tolerance for one dropped term: if the mean M and L are computed without the dropped terms, and if they are computed with all terms. The second
/// is so small that in scenes of weak torques the error stays near rounding; ten times as much makes a sample 3 % faster. The first is also the fraction for the
/// truncation error of a sum over time derivatives.
pub(crate) const DROPPED: [f64; 2] = [0.01, 2e-5];
/// A term below this share of the second-order change is dropped too, in the same two cases. A few tens of terms may be dropped. With a third of the second share
/// a sample at n/spin = 0.02 takes 7 % longer.
pub(crate) const DROPPED_OF_SECOND_ORDER: [f64; 2] = [1e-5, 3e-4];
/// Fraction of the tolerance for one pair of terms that is not summed around the orbit.
pub(crate) const PAIRS: f64 = 0.02;
/// A pair of terms is dropped if its size is below this times the largest pair; the size of a pair is the product of the sizes of its terms. The first-order changes
/// of M and L keep every term above the square of this times the largest term.
pub(crate) const CUTOFF: f64 = 1e-6;

// Limits.

/// Most points around an orbit; more are needed from an eccentricity of 0.77 on, and for a harmonic above 60.
pub(crate) const MOST_POINTS: f64 = 128.0;
/// Most harmonics of the orbit's Fourier series; more are needed from an eccentricity of 0.8 on.
pub(crate) const MOST_HARMONICS: f64 = 320.0;
/// Least length of the longer side of a span in orbits: without the pericentre, and with it or on a circle.
pub(crate) const FEWEST_ORBITS: [f64; 2] = [1.5, 0.3];
/// Largest mean ratio of the changes of successive iterations. With a larger ratio there is no mean motion.
pub(crate) const LARGEST_CONTRACTION: f64 = 0.5;
/// Largest torque over M²/C for which first order in the torque is accepted.
pub(crate) const STRONGEST: f64 = 0.02;
/// Largest precession of the angular momentum in one radian of the true anomaly for which the averaged equations are solved on quarters of an orbit \[rad\]. The polynomials
/// then have an error of 1e-14 rad. If the precession is faster, they are solved on eighths.
pub(crate) const FASTEST_IN_QUARTERS: f64 = 0.02;
/// Length of an arc over the distance of its start from the nearest singularity of the orbit, in the complex plane of time. Polynomials of degree 15 then
/// have an error of 5e-15 of what the torque does in the arc.
pub(crate) const ARC_SHARE: f64 = 0.4;
/// Largest angle of the orbit in an arc \[rad\].
pub(crate) const LONGEST_ARC: f64 = 1.5;
/// Largest precession of the angular momentum while the true anomaly advances by 1 rad \[rad\]; if another body has a larger mean motion, while its mean anomaly
/// advances by 1 rad. At this limit polynomials of degree 15 follow the frame to 1e-10 rad.
pub(crate) const FASTEST_PRECESSION: f64 = 0.3;
/// Harmonics of a term without exact divisors are left out if |Ω + jn| is at most this times n: its first-order corrections do not contain them (equation (8)).
pub(crate) const NEAREST_IN_K2: f64 = 0.5;
/// A harmonic with |Ω + jn| above this times |Ω| is contained in the sums over time derivatives, so its divisor has no factor 1 − e^(−Ω_j² span²/4).
pub(crate) const SUMMED_ABOVE: f64 = 0.5;
/// A harmonic with |Ω + jn| below this times n is a separate term in the sum over pairs.
pub(crate) const SINGLE_BELOW: f64 = 2.5;
/// A shift of a divisor by the average torque of this times n or more is not applied.
pub(crate) const MOST_SHIFT: f64 = 0.3;
/// Largest change of the attitude by a slow term that is corrected \[rad\].
pub(crate) const LARGEST_CORRECTED: f64 = 0.01;
/// A scene is refused if one term turns the attitude by more than this without correction \[rad\].
pub(crate) const LARGEST_EFFECT: f64 = 0.03;
/// A scene is refused if the terms without correction turn the attitude by more than this multiple of the tolerance or of the error of second order.
pub(crate) const REFUSAL_FACTOR: f64 = 10.0;
/// Smallest |Ω| over the largest rate of twice the true anomaly for which the sum over time derivatives is used. Below this ratio the sum does not converge.
/// Above it the truncation error of the sum is part of the error estimate.
pub(crate) const SLOW_RATIO: f64 = 1.5;
/// Largest sum of the corrections for which first order is accepted.
pub(crate) const LARGEST_SIZE: f64 = 0.05;
/// Largest σ/σ_sep for which the tables for the gravity gradient have enough harmonics.
pub(crate) const LARGEST_SEPARATRIX_RATIO: f64 = 0.9;

// Rounding.

/// Smaller coefficients of the polynomials of the averaged motion are dropped.
pub(crate) const SMALLEST_POLYNOMIAL_COEFFICIENT: f64 = 1e-17;
/// Smallest precession in one radian of the mean anomaly from which the length of an arc is computed \[rad\]: it keeps the length finite where ⟨D⟩ vanishes.
pub(crate) const SLOWEST_PRECESSION: f64 = 1e-12;
/// Shortest arc, over the time from the epoch.
pub(crate) const SHORTEST_ARC: f64 = 8.0 * f64::EPSILON;
/// Harmonics below e^(−`LOG_CUTOFF`) of the largest are left out.
pub(crate) const LOG_CUTOFF: f64 = 28.0;
/// Smaller harmonics of a or b have no effect on the attitude \[rad\].
pub(crate) const SMALLEST_HARMONIC: f64 = 1e-18;
/// The iteration has converged if the mean variables change by less than this.
pub(crate) const CONVERGED: f64 = 1e-15;
/// Below this sin²J, functions are extrapolated along their tangent at this value.
pub(crate) const TANGENT_SQUARE: f64 = 1e-6;
/// Step of the differences in sin²J, relative to 1 − sin²J.
pub(crate) const DIFFERENCE_STEP: f64 = 2e-3;
/// Largest step, over sin²J: two of them leave it positive.
pub(crate) const LARGEST_DIFFERENCE_STEP: f64 = 0.4;
/// Largest change of σ, over the distance to the separatrix, that a Taylor polynomial of second order bridges: the third order is 1e-17.
pub(crate) const TAYLOR_REACH: f64 = 2e-6;
/// Below this |δ| the quotients by δ are power series.
pub(crate) const SERIES_BELOW: f64 = 0.5;
