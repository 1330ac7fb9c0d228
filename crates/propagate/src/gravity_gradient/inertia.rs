//! The body: its inertia tensor in the invariable frame as Fourier series in ℓ′ and y′, and its attitude by the series of a and b, to all orders in J (theory §9).
//!
//! T = Q diag(A, B, C) Qᵀ is sampled over a quarter turn of ℓ′ on the closed form at y′ = 0: T33, i t1 e^(−iy′), t2 e^(−2iy′). The samples are those of
//! T − C, so that next to a sphere rounding is small beside the differences of the moments, which alone make a torque. The parameters a and b of theory §8 need
//! no normalization here. They are the theta series themselves, which have a few harmonics where the tensor has tens. Time reversal makes all coefficients real, and ℓ′ → ℓ′ + π leaves only the odd or only the even ones. A harmonic h is σ^(|h|/2) times a function that is analytic in σ at 0. This
//! function and its slope are tabulated, so that with p = √σ e^(iℓ′) everything is regular at J = 0. Slopes are differences of fourth order in sin²J. Their
//! step is 0.2 % of the distance to the separatrix (sin²J = 1), and at most 40 % of sin²J. A smaller step at small J would amplify rounding. The relative error
//! is 1e-10.

use crate::gravity_gradient::constants::{
    DIFFERENCE_STEP, LARGEST_DIFFERENCE_STEP, SMALLEST_HARMONIC, TANGENT_SQUARE, TAYLOR_REACH,
};
use crate::input::options::Level;
use crate::numerics::C64;
use crate::simd::complex_quaternion::ComplexLanes;
use crate::simd::instruction_set::InstructionSet;
use crate::simd::lanes::Lanes;
use crate::torque_free::closed_form::ClosedForm;
use crate::torque_free::frequencies::Secular;
use crate::torque_free::polhode::Polhode;
use andoyer_double::DoubleDouble;
use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

/// Number of samples in a period of ℓ′.
const SAMPLES: [usize; 2] = [64, 128];
/// Highest harmonic. At σ/σ_sep = 0.9 the higher harmonics are 1e-14 of the tensor.
pub(crate) const HIGHEST: usize = 32;
/// Number of harmonics from −[`HIGHEST`] to [`HIGHEST`].
const COUNT: usize = 2 * HIGHEST + 1;
/// Whether T33, t1, t2 have the odd harmonics.
const ODD: [bool; 3] = [false, true, false];
/// Where σ and the two rates stand behind the harmonics of a member.
const RATES: [usize; 3] = [5 * COUNT, 5 * COUNT + 1, 5 * COUNT + 2];

/// The series Σ_h f_h(σ) P_h, with P_h = p^h for h ≥ 0 and P_h = p̄^(−h) for h < 0.
///
/// Its entries are f_h, df_h/dσ and d²f_h/dσ², at index h + [`HIGHEST`].
#[derive(Clone, Debug)]
pub(crate) struct Harmonics(Vec<[f64; 3]>);

impl Harmonics {
    /// f_h and its slope.
    pub(crate) fn at(&self, harmonic: i32) -> (f64, f64) {
        let [value, slope, _] = self.jet(harmonic);
        (value, slope)
    }

    /// f_h, df_h/dσ and d²f_h/dσ².
    pub(crate) fn jet(&self, harmonic: i32) -> [f64; 3] {
        self.0[(harmonic + HIGHEST as i32) as usize] // −HIGHEST ≤ h ≤ HIGHEST
    }
}

/// The tables of the free motion with one σ and M.
#[derive(Clone, Debug)]
pub(crate) struct Inertia {
    pub(crate) momentum: f64,
    pub(crate) sigma: f64,
    /// A + B + C.
    pub(crate) trace: f64,
    /// σ_sep.
    pub(crate) separatrix: f64,
    /// sin²J at ℓ = 0, and the slope of σ with respect to it.
    square: [f64; 2],
    /// dℓ′/dt and dy′/dt.
    pub(crate) rates: [DoubleDouble; 2],
    /// The derivatives of the two rates with respect to σ, at fixed M.
    pub(crate) rate_slopes: [f64; 2],
    /// Their second derivatives.
    pub(crate) rate_curvatures: [f64; 2],
    /// T33, i t1 e^(−iy′), t2 e^(−2iy′).
    pub(crate) tensor: [Harmonics; 3],
    /// The series of a and b, up to a common factor.
    pub(crate) pair: [Harmonics; 2],
    /// T33 and t2 e^(−2iy′) at J = 0.
    pub(crate) untilted: [f64; 2],
}

impl Inertia {
    /// The tables at σ and M, for the body, the units and the mode of a polhode.
    pub(crate) fn new(polhode: &Polhode, sigma: f64, momentum: f64) -> Self {
        let square = square_of(polhode, sigma, None);
        let exact = rates(&polhode.tilted(square, momentum)).1;
        let base = square.max(TANGENT_SQUARE);
        // Functions vary over the distance to the separatrix, where sin²J is 1. At small J a step that is a fixed share of sin²J would leave rounding over it.
        let step = (DIFFERENCE_STEP * (1.0 - base)).min(LARGEST_DIFFERENCE_STEP * base);
        let members = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| member(polhode, base + k * step, momentum, &exact));
        // A function and its derivatives with respect to sin²J.
        let tangent = |index: usize| {
            let [a, b, middle, c, d] = members.each_ref().map(|member| member[index]);
            let second = 16.0 * (b - middle + c - middle) - (a - middle + d - middle);
            [middle, (8.0 * (c - b) - (d - a)) / (12.0 * step), second / (12.0 * step * step)]
        };
        let [sigma_there, slope, curvature] = tangent(RATES[0]);
        // The function at σ and its derivatives with respect to σ.
        let jet = |index: usize| {
            let [value, first, second] = tangent(index);
            let by_sigma = first / slope;
            [value + by_sigma * (sigma - sigma_there), by_sigma, (second - by_sigma * curvature) / (slope * slope)]
        };
        let part = |part: usize| Harmonics((part * COUNT..(part + 1) * COUNT).map(jet).collect());
        let [anomaly, longitude] = [jet(RATES[1]), jet(RATES[2])];
        let mut axial = part(0);
        axial.0[HIGHEST][0] += polhode.moments[2]; // of which the members have nothing
        Self {
            momentum,
            sigma,
            trace: polhode.moments.iter().sum(),
            separatrix: polhode.separatrix_action(),
            square: [square, slope],
            rates: exact,
            rate_slopes: [anomaly[1], longitude[1]],
            rate_curvatures: [anomaly[2], longitude[2]],
            tensor: [axial, part(1), part(2)],
            pair: [part(3), part(4)],
            untilted: [polhode.moments[2], 0.25 * (polhode.moments[0] - polhode.moments[1])],
        }
    }

    /// The tables at another σ and M of the same body: from Taylor's polynomial if σ is near enough for all digits. The rates are exact in any case.
    pub(crate) fn moved(&self, polhode: &Polhode, sigma: f64, momentum: f64) -> Self {
        let by = sigma - self.sigma;
        if by.abs() > TAYLOR_REACH * (self.separatrix - self.sigma) {
            return Self::new(polhode, sigma, momentum);
        }
        // The tables of the tensor and of a and b do not depend on M, and the rates are proportional to it.
        let scale = momentum / self.momentum;
        let shifted = |series: &Harmonics| {
            let shifted = |&[value, slope, curvature]: &[f64; 3]| {
                let moved = slope + by * curvature;
                [value + by * (slope + 0.5 * by * curvature), moved, curvature]
            };
            Harmonics(series.0.iter().map(shifted).collect())
        };
        let [square, slope] = self.square;
        let square = square_of(polhode, sigma, Some([square + by / slope, slope]));
        Self {
            momentum,
            sigma,
            square: [square, slope],
            rates: rates(&polhode.tilted(square, momentum)).1,
            rate_slopes: [0, 1].map(|i| scale * (self.rate_slopes[i] + by * self.rate_curvatures[i])),
            rate_curvatures: self.rate_curvatures.map(|curvature| scale * curvature),
            tensor: self.tensor.each_ref().map(shifted),
            pair: self.pair.each_ref().map(shifted),
            ..*self
        }
    }

    /// √σ for the size of a term. It is at least √ε, because the torque forces a larger wobble.
    pub(crate) fn root(&self) -> f64 {
        self.sigma.max(f64::EPSILON).sqrt()
    }
}

/// σ and the two rates. For J = 0 they are limits.
fn rates(polhode: &Polhode) -> (f64, [DoubleDouble; 2]) {
    let secular = Secular::exact(polhode);
    (secular.kappa_sigma / polhode.invariants.kappa, [secular.anomaly_rate, secular.longitude_rate])
}

/// sin²J at ℓ = 0 for a given σ, by the secant method. σ is nearly linear and convex in sin²J. A near value may be known, with the slope of σ there.
fn square_of(polhode: &Polhode, sigma: f64, near: Option<[f64; 2]>) -> f64 {
    let value = |square: f64| rates(&polhode.tilted(square, 1.0)).0;
    if sigma == 0.0 {
        return 0.0;
    }
    let [mut square, mut slope] = near.filter(|[square, _]| *square > 0.0).unwrap_or_else(|| {
        let linear = value(TANGENT_SQUARE) / TANGENT_SQUARE;
        [(sigma / linear).min(0.9), linear]
    });
    // After a step of ε^(2/3) the next step is rounding, because the slope is good to 1e-5.
    let accurate = f64::EPSILON.powf(2.0 / 3.0);
    let mut before = None::<[f64; 2]>;
    for _ in 0..40 {
        let found = value(square);
        if let Some([other, then]) = before {
            slope = (found - then) / (square - other);
        }
        before = Some([square, found]);
        let next = (square + (sigma - found) / slope).clamp(0.25 * square, 0.5 * (1.0 + square));
        if (next - square).abs() <= accurate * square {
            return next;
        }
        square = next;
    }
    square
}

/// Sine and cosine of the angles of the larger number of samples. Those of the smaller number are among them.
static CIRCLE: LazyLock<Vec<(f64, f64)>> =
    LazyLock::new(|| (0..SAMPLES[1]).map(|k| (TAU * k as f64 / SAMPLES[1] as f64).sin_cos()).collect());

/// Harmonics of T − C, of a and of b, and σ of one free motion, and the differences of its two rates from those of a near motion.
fn member(polhode: &Polhode, square: f64, momentum: f64, near: &[DoubleDouble; 2]) -> Vec<f64> {
    let tilted = polhode.tilted(square, momentum);
    let (sigma, rates) = rates(&tilted);
    let theta = tilted.invariants.theta;
    let closed = ClosedForm::new(&tilted, &theta);
    let third = tilted.moments[2];
    let apart = tilted.moments.map(|moment| moment - third);
    let [few, many] = SAMPLES;
    // Harmonic h falls like q^(h/2) with the nome q. Half of the harmonics and samples are enough where the others are rounding.
    let nome = (-PI * theta.conjugate / theta.quarter).exp();
    let samples = if nome.powi(HIGHEST as i32 / 4) < f64::EPSILON { few } else { many };
    let stride = many / samples;
    let mut sums = vec![0.0; 5 * COUNT];
    for k in 0..=samples / 4 {
        // A period contains an end point twice and an inner point four times.
        let weight = if k == 0 || k == samples / 4 { 2.0 } else { 4.0 } / samples as f64;
        let functions = sample(&closed, TAU * k as f64 / samples as f64, apart).map(|f| f * weight);
        for ((function, series), odd) in functions.iter().zip(sums.chunks_exact_mut(COUNT)).zip(ODD) {
            for h in (usize::from(odd)..=samples / 4).step_by(2) {
                let (sine, cosine) = CIRCLE[stride * h * k % many];
                let (even, odd) = (function.re * cosine, function.im * sine);
                series[HIGHEST + h] += even + odd;
                if h > 0 {
                    series[HIGHEST - h] += even - odd;
                }
            }
        }
    }
    for (k, (even, odd)) in closed.series.terms().iter().enumerate() {
        for (part, h, [plus, minus]) in [(3, 2 * k, even), (4, 2 * k + 1, odd)] {
            let middle = part * COUNT + HIGHEST;
            sums[middle + h] = if h == 0 { *plus } else { 0.5 * (plus + minus) };
            if h > 0 {
                sums[middle - h] = 0.5 * (plus - minus);
            }
        }
    }
    // The samples are accurate to 1e-16 of the largest, so smaller sums are set to 0. The largest is a difference of moments for the tensor, and about 1 for a and b.
    // σ^(h/2) may be small: near B = C the other factor grows like σ_sep^(−h/2).
    let largest = apart.iter().fold(0.0_f64, |most, moment| most.max(moment.abs()));
    let noises = [largest, largest, largest, 1.0, 1.0].map(|size| 4.0 * f64::EPSILON * size);
    let root = sigma.sqrt();
    let powers: Vec<f64> = std::iter::successors(Some(1.0), |power| Some(power * root)).take(HIGHEST + 1).collect();
    for (series, noise) in sums.chunks_exact_mut(COUNT).zip(noises) {
        for (index, sum) in series.iter_mut().enumerate() {
            *sum = if sum.abs() < noise { 0.0 } else { *sum / powers[index.abs_diff(HIGHEST)] };
        }
    }
    sums.push(sigma);
    sums.extend([0, 1].map(|i| (rates[i] - near[i]).to_f64()));
    sums
}

/// T33, i t1, t2 at ℓ′ and y′ = 0 of a body with these moments.
fn sample(closed: &ClosedForm, angle: f64, moments: [f64; 3]) -> [C64; 3] {
    let [a, b] = closed.series.pair(angle);
    // The rows of Q are the axes of the invariable frame in body components, from the quaternion (x, y, z, w) = (Re b, Im b, Im a, Re a).
    let (x, y, z, w) = (b.re, b.im, a.im, a.re);
    let rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let entry = |i: usize, j: usize| (0..3).map(|k| rows[i][k] * moments[k] * rows[j][k]).sum::<f64>();
    let turned = C64::new(-entry(1, 2), entry(0, 2));
    let t2 = C64::new(entry(0, 0) - entry(1, 1), 2.0 * entry(0, 1)) / 4.0;
    [entry(2, 2).into(), turned, t2]
}

impl Level {
    /// f and df/dσ of the term (h, m) at this level; for m = 1 those of i t1.
    pub(crate) fn tensor(self, inertia: &Inertia, multiple: i32, harmonic: i32) -> (f64, f64) {
        match self {
            Self::Auto | Self::Full | Self::SecondOrder => inertia.tensor[multiple as usize].at(harmonic), // 0 ≤ m ≤ 2
            Self::Paper | Self::Moving => match (multiple, harmonic) {
                (0, 0) => (inertia.untilted[0], 0.0),
                (2, 0) => (inertia.untilted[1], 0.0),
                _ => (0.0, 0.0),
            },
        }
    }

    /// The parts of f_h and of its slope that the level omits.
    pub(crate) fn omitted(self, inertia: &Inertia, multiple: i32, harmonic: i32) -> (f64, f64) {
        let (value, slope) = Self::Full.tensor(inertia, multiple, harmonic);
        let (kept, kept_slope) = self.tensor(inertia, multiple, harmonic);
        (value - kept, slope - kept_slope)
    }
}

/// The harmonics of a or b that are not negligible, with their slopes, as polynomials in p² and p̄². The first list has h ≥ 0, the second h < 0.
#[derive(Clone, Debug)]
pub(crate) struct WobbleSeries([Vec<[f64; 2]>; 2]);

impl WobbleSeries {
    /// The harmonics that count for |p| up to `wobble`.
    pub(crate) fn new(series: &Harmonics, wobble: f64) -> Self {
        let odd = series.at(0).0 == 0.0;
        let side = |first: usize, sign: i32| {
            let terms = (first..=HIGHEST).step_by(2).map(|h| (h as i32, <[f64; 2]>::from(series.at(sign * h as i32))));
            let mut terms: Vec<_> = terms.collect();
            while let Some((degree, [value, slope])) = terms.last()
                && wobble.powi(*degree) * (value.abs() + slope.abs() * wobble * wobble) < SMALLEST_HARMONIC
            {
                terms.pop();
            }
            terms.into_iter().map(|(_, pair)| pair).collect()
        };
        if odd { Self([side(1, 1), side(1, -1)]) } else { Self([side(0, 1), side(2, -1)]) }
    }

    /// The two sums, without the remaining factors p and p̄.
    #[inline(always)]
    pub(crate) fn at<S: InstructionSet>(&self, square: ComplexLanes<S>, beyond: Lanes<S>) -> [ComplexLanes<S>; 2] {
        let zero = beyond.all(0.0);
        let mut sums = [ComplexLanes { re: zero, im: zero }; 2];
        for ((sum, terms), by) in sums.iter_mut().zip(&self.0).zip([square, square.conjugate()]) {
            for [value, slope] in terms.iter().rev() {
                let factor = ComplexLanes { re: beyond.mul_add(zero.all(*slope), zero.all(*value)), im: zero };
                *sum = factor.plus(*sum, by);
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::body::Body;
    use crate::input::state::State;

    #[test]
    fn tables_moved_to_a_near_sigma_have_the_digits_of_new_tables() {
        for rates in [[1e-3, 2e-3, 1.0], [0.1, 0.2, 1.0], [0.5, 0.3, 0.8]] {
            let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], rates).expect("a state");
            let polhode = Polhode::new(&Body::new([0.8, 0.9, 1.0]).expect("a body"), &state).expect("turning");
            let (sigma, _) = crate::gravity_gradient::inertia::rates(&polhode);
            let tables = Inertia::new(&polhode, sigma, 0.7);
            let to = sigma + 0.9 * TAYLOR_REACH * (tables.separatrix - sigma);
            let (moved, new) = (tables.moved(&polhode, to, 0.71), Inertia::new(&polhode, to, 0.71));
            assert_eq!((moved.sigma, moved.momentum), (to, 0.71));
            // sin²J at σ is known to some units of its last digit.
            for i in 0..2 {
                let apart = (moved.rates[i] - new.rates[i]).to_f64().abs();
                let rounding = 8.0 * f64::EPSILON * to * new.rate_slopes[i].abs();
                assert!(apart <= rounding, "rate {i}: {apart:e} of {rounding:e}");
            }
            for (moved, new) in moved.tensor.iter().zip(&new.tensor).chain(moved.pair.iter().zip(&new.pair)) {
                // Rounding of the samples, over σ^(|h|/2).
                for h in -4..=4_i32 {
                    let rounding = 4e-15 / to.powf(0.5 * f64::from(h.abs()));
                    assert!(
                        (moved.at(h).0 - new.at(h).0).abs() <= rounding,
                        "{h} {:e} {:e}",
                        moved.at(h).0,
                        new.at(h).0
                    );
                }
            }
            let slope = |tables: &Inertia| tables.rate_slopes[0];
            assert!((slope(&moved) / slope(&new) - 1.0).abs() <= 1e-8);
        }
    }
}
