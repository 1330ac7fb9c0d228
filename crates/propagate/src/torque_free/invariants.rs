//! The constants of a polhode in double-double, of several bodies at once.
//!
//! Each lane is a body. No operation combines lanes, so a body has the same bits alone and among others. The formulas are those of [`super::polhode`] with
//! 1/a and 1/b, which are infinite for a sphere and for B = C: the constants that they make NaN belong to motions that these bodies do not have.

use std::f64::consts::FRAC_PI_2;

use andoyer_double::DoubleDouble;
use pulp::Arch;

use super::columns::{Columns, SortedState};
use crate::numerics::theta::Theta;
use crate::simd::double_double_lanes::DoubleDoubleLanes;
use crate::simd::elliptic::{carlson_rf, means, precise_mean};
use crate::simd::instruction_set::{InstructionSet, Task, dispatch, dispatch_one};
use crate::simd::lanes::Lanes;

/// The constants of a polhode, in scaled units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Invariants {
    /// M.
    pub(crate) momentum: DoubleDouble,
    /// g on the sorted axes.
    pub(crate) direction: [f64; 3],
    /// a = C/A − 1 and b = C/B − 1.
    pub(crate) excesses: [DoubleDouble; 2],
    /// a − b = (C/B)(B/A − 1).
    pub(crate) difference: DoubleDouble,
    /// Q1 and Q2 for B < C. Q1 is exactly 0 on the separatrix if double-double holds its two terms exactly, because the division follows their difference.
    pub(crate) cosine_squares: [DoubleDouble; 2],
    /// The sum of the two terms of Q1 over Q1: the factor by which its relative error grows. It is infinite or NaN on the separatrix.
    pub(crate) cancellation: f64,
    /// 1 − Q1 and 1 − Q2: the maximum and the minimum of sin²J.
    pub(crate) sine_squares: [DoubleDouble; 2],
    /// γE of theory §5.
    pub(crate) gamma_energy: DoubleDouble,
    /// κE of theory §5, for B < C.
    pub(crate) kappa_energy: DoubleDouble,
    /// γ of theory §1, with the sign of α.
    pub(crate) gamma: DoubleDouble,
    /// κ = α/γ of theory §1, for B < C.
    pub(crate) kappa: f64,
    /// M/C.
    pub(crate) mean_rate: DoubleDouble,
    /// M/A, M/B, M/C.
    pub(crate) rates: [f64; 3],
    /// agm(√Q1, √Q2) and √(Q1/Q2), for 0 < Q1.
    pub(crate) agm: DoubleDouble,
    pub(crate) stretch: DoubleDouble,
    /// The theta quantities of theory §10.
    pub(crate) theta: Theta,
    /// |cos ℓ| and |sin ℓ| of the state.
    pub(crate) quadrant: [f64; 2],
    /// The argument u = √Q2 ∫ dℓ/√Q of the state in the first quadrant, counted from the nearer extremum of cos J: whether that is the maximum, and the
    /// distance.
    pub(crate) argument: (bool, f64),
}

impl Invariants {
    /// The constants of one body.
    pub(super) fn of(given: &SortedState) -> Self {
        dispatch_one(Arch::new(), One { given })
    }

    /// The constants of several bodies, each to the bits of [`Invariants::of`].
    pub(super) fn several(given: &[SortedState]) -> Vec<Self> {
        dispatch(Arch::new(), Several { given })
    }
}

struct One<'a> {
    given: &'a SortedState,
}

impl Task for One<'_> {
    type Output = Invariants;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Invariants {
        together(simd, &Columns::all(simd, self.given)).lane(0)
    }
}

struct Several<'a> {
    given: &'a [SortedState],
}

impl Task for Several<'_> {
    type Output = Vec<Invariants>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Vec<Invariants> {
        let mut found = Vec::with_capacity(self.given.len());
        for given in self.given.chunks(Lanes::<S>::WIDTH) {
            let together = together(simd, &Columns::load(simd, given));
            for lane in 0..given.len() {
                found.push(together.lane(lane));
            }
        }
        found
    }
}

/// M, g, the squares of its components, and the squares of G with M², or those of g with 1.
struct Turning<S: InstructionSet> {
    momentum: DoubleDoubleLanes<S>,
    direction: [Lanes<S>; 3],
    squares: [DoubleDoubleLanes<S>; 3],
    parts: [DoubleDoubleLanes<S>; 3],
    total: DoubleDoubleLanes<S>,
}

#[inline(always)]
fn turning<S: InstructionSet>(simd: S, columns: &Columns<S>) -> Turning<S> {
    let one = DoubleDoubleLanes::splat(simd, DoubleDouble::ONE);
    let by_squares = columns.by_squares;
    let mut parts = [one; 3];
    for (axis, part) in parts.iter_mut().enumerate() {
        *part = columns.moments[axis] * columns.rates[axis];
    }
    let (x, y, z) = (parts[0] * parts[0], parts[1] * parts[1], parts[2] * parts[2]);
    let total = x + y + z;
    let momentum = total.root();
    let inverse = momentum.reciprocal();
    let mut squares = [x, y, z];
    let mut direction = [one.high; 3];
    for axis in 0..3 {
        let component = parts[axis] * inverse;
        let given = columns.squares[axis];
        // Where the squares are given, the components are their roots.
        direction[axis] = by_squares.up_to(0.0, component.nearest(), given.high.root());
        parts[axis] = DoubleDoubleLanes::up_to_zero(by_squares, squares[axis], given);
        squares[axis] = DoubleDoubleLanes::up_to_zero(by_squares, component * component, given);
    }
    Turning {
        momentum: DoubleDoubleLanes::up_to_zero(by_squares, momentum, columns.squares[3]),
        direction,
        squares,
        parts,
        total: DoubleDoubleLanes::up_to_zero(by_squares, total, one),
    }
}

/// The constants of as many bodies as there are lanes.
struct Together<S: InstructionSet> {
    turning: Turning<S>,
    excesses: [DoubleDoubleLanes<S>; 2],
    difference: DoubleDoubleLanes<S>,
    cosine_squares: [DoubleDoubleLanes<S>; 2],
    cancellation: Lanes<S>,
    sine_squares: [DoubleDoubleLanes<S>; 2],
    gamma_energy: DoubleDoubleLanes<S>,
    kappa_energy: DoubleDoubleLanes<S>,
    gamma: DoubleDoubleLanes<S>,
    kappa: Lanes<S>,
    mean_rate: DoubleDoubleLanes<S>,
    rates: [Lanes<S>; 3],
    agm: DoubleDoubleLanes<S>,
    stretch: DoubleDoubleLanes<S>,
    elliptic: Elliptic<S>,
    eta: Lanes<S>,
    half_tangents: [Lanes<S>; 2],
    argument: Argument<S>,
    distance: Lanes<S>,
}

#[inline(always)]
fn together<S: InstructionSet>(simd: S, columns: &Columns<S>) -> Together<S> {
    let one = DoubleDoubleLanes::splat(simd, DoubleDouble::ONE);
    let [a, b, c] = columns.moments;
    let turning = turning(simd, columns);
    let (parts, momentum, [s1, s2, _]) = (turning.parts, turning.momentum, turning.squares);
    // Differences of moments are exact, and are divided last.
    let (upper, lower) = (c - b, b - a);
    let excesses = [(c - a).over_pair(a), upper.over_pair(b)];
    let [first, second] = excesses;
    let (inverse_first, inverse_second) = (first.reciprocal(), second.reciprocal());
    let between = c * lower;
    let difference = between / (a * b);
    let divisor = a * upper;
    let terms = [parts[2] * divisor, parts[0] * between];
    let apart = terms[0] - terms[1];
    let q1 = apart / (divisor * turning.total);
    let q2 = (parts[2] + parts[1] * (difference * inverse_first)) / turning.total;
    let weights = s1 * inverse_second + s2 * inverse_first;
    let sine_squares = [s1 * (first * inverse_second) + s2, s1 + s2 * (second * inverse_first)];
    let alpha = (first + second).times(a.high.all(0.5));
    let gamma = (first * second).root_or_zero();
    let gamma = DoubleDoubleLanes { high: gamma.high * columns.sign, low: gamma.low * columns.sign };
    let mean_rate = momentum.over_pair(c);
    let (least, greatest) = (q1.root_or_zero(), q2.root_or_zero());
    let elliptic = elliptic([q1, q2], [difference * weights, second * inverse_first, difference * inverse_first]);
    let [lower, upper] = elliptic.cosines;
    let argument = argument(turning.direction, (first * inverse_second).nearest().root(), [lower, upper]);
    let [from_the_axis, distance] = carlson_rf([elliptic.from_the_axis, argument.from_the_extremum]);
    Together {
        excesses,
        difference,
        cosine_squares: [q1, q2],
        cancellation: (terms[0].high + terms[1].high) / apart.high,
        sine_squares,
        gamma_energy: s1 * first + s2 * second,
        kappa_energy: alpha * weights,
        gamma,
        kappa: alpha.high / gamma.high,
        mean_rate,
        rates: [momentum.over(a.high).nearest(), momentum.over(b.high).nearest(), mean_rate.nearest()],
        agm: precise_mean(least, greatest),
        stretch: least / greatest,
        half_tangents: [
            sine_squares[0].nearest().root() / (lower + one.high),
            sine_squares[1].nearest().root() / (upper + one.high),
        ],
        eta: elliptic.root * from_the_axis,
        distance: argument.factor * distance,
        argument,
        elliptic,
        turning,
    }
}

/// One lane of each vector.
fn each<S: InstructionSet, const N: usize>(vectors: &[Lanes<S>; N], lane: usize) -> [f64; N] {
    std::array::from_fn(|index| vectors[index].values()[lane])
}

impl<S: InstructionSet> Together<S> {
    /// The constants of one body.
    fn lane(&self, lane: usize) -> Invariants {
        let [q1, q2] = &self.cosine_squares;
        let [s1, s2] = &self.sine_squares;
        let [first, second] = &self.excesses;
        let difference = self.difference.lane(lane);
        let (cosines, half_tangents) = (each(&self.elliptic.cosines, lane), each(&self.half_tangents, lane));
        let theta = if difference == DoubleDouble::ZERO {
            Theta::round(cosines, half_tangents)
        } else {
            let Elliptic { quarter, conjugate, complement, parameter, .. } = self.elliptic;
            let [quarter, conjugate, eta, complement, parameter] =
                each(&[quarter, conjugate, self.eta, complement, parameter], lane);
            Theta { cosines, half_tangents, quarter, conjugate, eta, complement, parameter }
        };
        let Argument { quadrant, from_the_top, .. } = &self.argument;
        Invariants {
            momentum: self.turning.momentum.lane(lane),
            direction: each(&self.turning.direction, lane),
            excesses: [first.lane(lane), second.lane(lane)],
            difference,
            cosine_squares: [q1.lane(lane), q2.lane(lane)],
            cancellation: self.cancellation.values()[lane].abs(),
            sine_squares: [s1.lane(lane), s2.lane(lane)],
            gamma_energy: self.gamma_energy.lane(lane),
            kappa_energy: self.kappa_energy.lane(lane),
            gamma: self.gamma.lane(lane),
            kappa: self.kappa.values()[lane],
            mean_rate: self.mean_rate.lane(lane),
            rates: each(&self.rates, lane),
            agm: self.agm.lane(lane),
            stretch: self.stretch.lane(lane),
            theta,
            quadrant: each(quadrant, lane),
            argument: (from_the_top.values()[lane] > 0.0, self.distance.values()[lane]),
        }
    }
}

/// The theta quantities in lanes.
struct Elliptic<S: InstructionSet> {
    cosines: [Lanes<S>; 2],
    quarter: Lanes<S>,
    conjugate: Lanes<S>,
    complement: Lanes<S>,
    parameter: Lanes<S>,
    /// η is this root times R_F of these arguments.
    root: Lanes<S>,
    from_the_axis: [Lanes<S>; 3],
}

/// The theta quantities from Q1 and Q2; Q2 − Q1, b/a and (a − b)/a.
#[inline(always)]
fn elliptic<S: InstructionSet>(
    [q1, q2]: [DoubleDoubleLanes<S>; 2],
    [spread, sine, cosine]: [DoubleDoubleLanes<S>; 3],
) -> Elliptic<S> {
    let one = q1.high.all(1.0);
    let zero = q1.high.all(0.0);
    let quarter_turn = q1.high.all(FRAC_PI_2);
    let mut cosines = [q1.nearest(), q2.nearest()];
    for cosine in &mut cosines {
        *cosine = cosine.up_to(0.0, zero, *cosine).root();
    }
    let inverse = q2.reciprocal();
    let parameter = (spread * inverse).nearest();
    let capped = parameter.up_to(1.0, parameter, one);
    let (sine, cosine) = (sine.nearest(), cosine.nearest());
    // Two arguments that are 0 would never converge; such a body has A = B.
    let cosine = cosine.up_to(0.0, one, cosine);
    let ratio = cosines[0] / cosines[1];
    let ratio = ratio.up_to(1.0, ratio, one);
    let [conjugate, quarter] = means([one; 2], [capped.root(), ratio]);
    Elliptic {
        cosines,
        quarter: quarter_turn / quarter,
        conjugate: quarter_turn / conjugate,
        complement: (q1 * inverse).nearest(),
        parameter,
        root: sine.root(),
        from_the_axis: [cosine, cosine + parameter * sine, one],
    }
}

/// The place of a state on its polhode.
struct Argument<S: InstructionSet> {
    /// |cos ℓ| and |sin ℓ|.
    quadrant: [Lanes<S>; 2],
    /// Above 0 where the maximum of cos J is the nearer extremum.
    from_the_top: Lanes<S>,
    /// The argument from there is this factor times R_F of these arguments.
    factor: Lanes<S>,
    from_the_extremum: [Lanes<S>; 3],
}

/// The place from g, √(a/b) and the least and the greatest cos J.
#[inline(always)]
fn argument<S: InstructionSet>(
    direction: [Lanes<S>; 3],
    stretch: Lanes<S>,
    [least, greatest]: [Lanes<S>; 2],
) -> Argument<S> {
    let (x, y) = (direction[1].magnitude(), direction[0].magnitude() * stretch);
    // The components are scaled first, because the squares of a small wobble would underflow.
    let largest = x.largest(y);
    let (x, y) = (x / largest, y / largest);
    let length = (x * x + y * y).root();
    let (cosine, sine) = (x / length, y / length);
    let (x, y) = (least * cosine, greatest * sine);
    let (x_square, y_square) = (x * x, y * y);
    let from_the_top = y - x;
    // Both expressions are undefined only for Q1 = 0 at ℓ = 0.
    let start = from_the_top.up_to(0.0, x_square, y_square);
    let end = from_the_top.up_to(0.0, least * least, greatest * greatest);
    Argument {
        quadrant: [cosine, sine],
        from_the_top,
        factor: greatest * from_the_top.up_to(0.0, sine, cosine),
        from_the_extremum: [start, x_square + y_square, end],
    }
}
