//! Kernels of every available instruction set, compared with a reference in double-double and with each other.

use andoyer_double::DoubleDouble;
#[cfg(feature = "rayon")]
use andoyer_series::threads::on_own;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use pulp::Arch;

use super::{Evaluation, Trajectory};
use crate::numerics::phase::Phase;
use crate::simd::halt::{GOING, Halt};
use crate::simd::instruction_set::{InstructionSet, Task, dispatch};
use crate::simd::lanes::Lanes;
use crate::simd::outputs::Outputs;
use crate::torque_free::harmonics::CayleyKleinSeries;
use crate::torque_free::polhode::{Frame, UserFrame};
use crate::torque_free::wobble::{Wobble, WobbleEvaluator};

const SIZES: [usize; 12] = [0, 1, 2, 7, 8, 9, 63, 64, 65, 511, 1000, 1537];

fn archs() -> Vec<Arch> {
    let mut archs = vec![Arch::Scalar];
    #[cfg(target_arch = "x86_64")]
    {
        archs.extend(pulp::x86::V3::try_new().map(Arch::V3));
        archs.extend(pulp::x86::V4::try_new().map(Arch::V4));
    }
    #[cfg(target_arch = "aarch64")]
    archs.extend(pulp::aarch64::Neon::try_new().map(Arch::Neon));
    archs
}

/// Pseudo-random numbers from 0 to 1.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// (sin, cos) of an angle in turns, to 30 digits.
fn circle(turns: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let turns = turns - turns.high.round().into();
    let quarters = (4.0 * turns.high).round();
    let angle = (turns - (0.25 * quarters).into()) * DoubleDouble::PI * 2.0.into();
    let (s, c) = angle.sin_cos();
    match quarters as i32 & 3 {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

/// A phase at some times.
struct At<'a>(Phase, &'a [f64]);

impl Task for At<'_> {
    type Output = Vec<(f64, f64)>;

    #[inline(always)]
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output {
        let mut circles = Vec::new();
        for times in self.1.chunks(Lanes::<S>::WIDTH) {
            let (sine, cosine) = self.0.sin_cos((Lanes::load(simd, times), Lanes::splat(simd, 0.0)));
            circles.extend(sine.values().iter().copied().zip(cosine.values().iter().copied()).take(times.len()));
        }
        circles
    }
}

fn largest_error(arch: Arch, rate: DoubleDouble, start: f64, times: &[f64]) -> f64 {
    let turn = DoubleDouble::PI * 2.0.into();
    let (frequency, start_turns) = (rate / turn, DoubleDouble::from(start) / turn);
    let circles = dispatch(arch, At(Phase::new(rate, start), times));
    assert_eq!(circles.len(), times.len());
    let errors = circles.iter().zip(times).map(|(&(s, c), &time)| {
        let (sine, cosine) = circle(frequency * time.into() + start_turns);
        (sine - s.into()).to_f64().abs().max((cosine - c.into()).to_f64().abs())
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn sine_and_cosine_of_turns_are_within_an_ulp_of_one_at_every_level() {
    // With a rate of one turn, in double-double, the times are turns. The error is then that of the polynomials and of their sums. The times contain every
    // octant, its ends and their neighbours, and the smallest numbers.
    let turn = DoubleDouble::PI * 2.0.into();
    let mut draw = Draw(1);
    let mut times: Vec<f64> = (0..200_000).map(|_| draw.next() - 0.5).collect();
    for eighth in -8..=8 {
        let x = f64::from(eighth) / 8.0;
        times.extend([x, x.next_up(), x.next_down(), x + 1e-9, x - 1e-9]);
    }
    times.extend([f64::MIN_POSITIVE, 5e-324, 1e-310, 1e-200, 1e-17, -1e-17]);
    for arch in archs() {
        // At the end of an octant the product without a fused addition rounds to 1.1e-16.
        let bound = if matches!(arch, Arch::Scalar) { 1.6e-16 } else { 1.2e-16 };
        let error = largest_error(arch, turn, 0.0, &times);
        assert!(error <= bound, "{arch:?}: {error:e}");
    }
}

#[test]
fn phases_hold_to_the_last_turn_at_every_level() {
    // Budget: 1.4e-17 turns twice for the sum (1.8e-16 rad), 1.2e-16 for the sine, and 1.6e-16 without fused additions.
    let rate = DoubleDouble { high: 1.234_567_890_123, low: 3.3e-17 };
    let mut draw = Draw(2);
    for scale in [1e-3, 1.0, 1e3, 1e6, 1e9, 1e12, 5e15] {
        let times: Vec<f64> = (0..10_000).map(|_| scale * (draw.next() - 0.5)).collect();
        for arch in archs() {
            for start in [0.0, 1e-9, 0.3, -2.9, 3.1] {
                let error = largest_error(arch, rate, start, &times);
                assert!(error <= 3.5e-16 + 1e-30 * scale, "{arch:?} at {scale:e} from {start}: {error:e}");
            }
        }
    }
}

/// A wobble whose harmonics fall by a constant ratio, and its reference.
struct Case {
    rates: [DoubleDouble; 2],
    starts: [f64; 2],
    terms: Vec<([f64; 2], [f64; 2])>,
    inertial: UnitQuaternion<f64>,
    frame: Frame,
    factors: Vector3<f64>,
}

impl Case {
    fn new(draw: &mut Draw, terms: usize, ratio: f64) -> Self {
        let mut numbers = || std::array::from_fn::<f64, 4, _>(|_| draw.next() - 0.5);
        let inertial = UnitQuaternion::new_normalize(Quaternion::from(numbers()));
        let [first, second, third, fourth] = numbers();
        let frame = Frame::new([first, second, third].map(|part| (1.0 + part).into()), [0.0, 0.0, fourth], false);
        let terms = (0..terms).map(|k| {
            let [c, d, e, f] = numbers().map(|x| x * ratio.powi(k as i32));
            // The mean has no sine and is the largest term.
            if k == 0 { ([1.0 + c, 0.0], [e, f]) } else { ([c, d], [e, f]) }
        });
        Self {
            rates: [DoubleDouble { high: 0.7, low: 1e-17 }, DoubleDouble { high: 0.9, low: -2e-17 }],
            starts: [first, 4.0 * second],
            terms: terms.collect(),
            inertial,
            frame,
            factors: Vector3::new(1.1, 0.9, 0.8),
        }
    }

    fn trajectory(&self) -> Trajectory {
        let wobble = Wobble {
            anomaly: Phase::new(self.rates[0], self.starts[0]),
            half_longitude: Phase::new(self.rates[1], self.starts[1]),
            series: CayleyKleinSeries::from_terms(self.terms.clone()),
            place: UserFrame { inertial: self.inertial, frame: self.frame.clone(), rates: self.factors },
        };
        Trajectory::Wobble(Box::new(WobbleEvaluator::new(&wobble)))
    }

    /// Attitude and rates by theory §8, summed harmonic by harmonic.
    fn reference(&self, time: f64) -> ([f64; 4], [f64; 3]) {
        let turn = DoubleDouble::PI * 2.0.into();
        let turns = |phase: usize| (self.rates[phase] * time.into() + self.starts[phase].into()) / turn;
        let mut sums = [DoubleDouble::ZERO; 4];
        for (k, (a, b)) in self.terms.iter().enumerate() {
            let (even_sine, even_cosine) = circle(turns(0) * (2.0 * k as f64).into());
            let (odd_sine, odd_cosine) = circle(turns(0) * (2.0 * k as f64 + 1.0).into());
            let parts = [(a[0], even_cosine), (a[1], even_sine), (b[0], odd_cosine), (b[1], odd_sine)];
            for (sum, (coefficient, factor)) in sums.iter_mut().zip(parts) {
                *sum = *sum + DoubleDouble::from(coefficient) * factor;
            }
        }
        let norm = sums.iter().fold(DoubleDouble::ZERO, |norm, &part| norm + part * part).sqrt();
        let [ar, ai, br, bi] = sums.map(|part| part / norm);
        let two = DoubleDouble::from(2.0);
        let direction = [two * (br * ai - bi * ar), two * (br * ar + bi * ai), ar * ar + ai * ai - br * br - bi * bi];
        let rates = self.frame.user(std::array::from_fn(|i| self.factors[i] * direction[i].to_f64()));
        let (s, c) = circle(turns(1));
        let relative = [br * c - bi * s, br * s + bi * c, ar * s + ai * c, ar * c - ai * s].map(DoubleDouble::to_f64);
        let attitude = self.inertial.into_inner() * Quaternion::from(relative) * self.frame.quaternion.into_inner();
        (attitude.coords.into(), rates)
    }
}

fn evaluation(trajectory: &Trajectory, arch: Arch) -> Evaluation<'_> {
    Evaluation { trajectory, epoch: 0.0, reach: [-1e15, 1e15], arch, stop: &GOING }
}

type Both = (Vec<[f64; 4]>, Vec<[f64; 3]>);

fn both(trajectory: &Trajectory, arch: Arch, times: &[f64], threads: usize) -> Both {
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; times.len()], vec![[0.0; 3]; times.len()]);
    evaluation(trajectory, arch).fill(times, Outputs::Both(&mut attitudes, &mut rates), threads).expect("valid times");
    (attitudes, rates)
}

fn apart<const N: usize>(a: &[[f64; N]], b: &[[f64; N]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let differences = a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, |most, difference| if difference <= most { most } else { difference })
}

fn uneven(draw: &mut Draw, size: usize) -> Vec<f64> {
    (0..size).map(|_| 1e4 * (draw.next() - 0.5)).collect()
}

#[test]
fn every_level_holds_the_reference_at_any_number_of_terms() {
    // Budget for each component: 3e-16 for a phase and its sine, twice; 1e-16 each for the sums, a norm and a map of four; 5e-16 for the two quaternion
    // products of the reference. Slowly falling harmonics add the rounding of 16 to 40 rotations.
    let mut draw = Draw(3);
    for (terms, ratio, bound) in [
        (1, 0.1, 2e-15),
        (2, 0.1, 2e-15),
        (3, 0.2, 2e-15),
        (5, 0.25, 2e-15),
        (5, 0.8, 3e-15),
        (16, 0.3, 2e-15),
        (16, 0.8, 4e-15),
        (40, 0.7, 6e-15),
    ] {
        let case = Case::new(&mut draw, terms, ratio);
        let trajectory = case.trajectory();
        let times = uneven(&mut draw, 300);
        let (attitudes, rates): Both = times.iter().map(|&time| case.reference(time)).unzip();
        for arch in archs() {
            let (found_attitudes, found_rates) = both(&trajectory, arch, &times, 1);
            let (attitude, rate) = (apart(&attitudes, &found_attitudes), apart(&rates, &found_rates));
            assert!(attitude <= bound && rate <= bound, "{arch:?}, {terms} terms: {attitude:e} {rate:e}");
        }
    }
}

#[test]
fn any_size_and_either_output_alone_give_the_bits_of_both_together() {
    let mut draw = Draw(4);
    let trajectory = Case::new(&mut draw, 3, 0.1).trajectory();
    for arch in archs() {
        for size in SIZES {
            for times in [uneven(&mut draw, size), (0..size).map(|k| 0.1 * k as f64).collect()] {
                let (attitudes, rates) = both(&trajectory, arch, &times, 1);
                let mut alone = vec![[f64::NAN; 4]; size];
                evaluation(&trajectory, arch).fill(&times, Outputs::Attitudes(&mut alone), 1).expect("valid times");
                assert_eq!(alone, attitudes, "{arch:?} {size}");
                let mut alone = vec![[f64::NAN; 3]; size];
                evaluation(&trajectory, arch).fill(&times, Outputs::Rates(&mut alone), 1).expect("valid times");
                assert_eq!(alone, rates, "{arch:?} {size}");
            }
        }
    }
}

#[test]
fn levels_with_fused_additions_give_the_same_bits() {
    let mut draw = Draw(5);
    for (terms, ratio) in [(4, 0.1), (30, 0.8)] {
        let trajectory = Case::new(&mut draw, terms, ratio).trajectory();
        for times in [uneven(&mut draw, 2000), (0..2000).map(|k| 3.0 + 0.1 * k as f64).collect()] {
            let fused = archs().into_iter().skip(1).map(|arch| both(&trajectory, arch, &times, 1));
            let results: Vec<Both> = fused.collect();
            assert!(results.windows(2).all(|pair| pair[0] == pair[1]));
        }
    }
}

#[cfg(feature = "rayon")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let mut draw = Draw(6);
    let trajectory = Case::new(&mut draw, 3, 0.1).trajectory();
    let size = 5 * super::SAMPLES_PER_THREAD + 77;
    for times in [uneven(&mut draw, size), (0..size).map(|k| 7.0 + 0.01 * k as f64).collect()] {
        let one = both(&trajectory, Arch::new(), &times, 1);
        // The pool of a small machine has too few threads to divide the times so often.
        for threads in [2, 3, 5] {
            assert!(on_own(5, || both(&trajectory, Arch::new(), &times, threads)).as_ref() == Ok(&one), "{threads}");
        }
    }
}

#[test]
fn uniform_times_agree_with_the_same_times_one_by_one() {
    // With a table each phase has three more rounding errors, and 2e-16 from the square of the deviation: 1e-15 in all.
    let mut draw = Draw(7);
    let trajectory = Case::new(&mut draw, 3, 0.1).trajectory();
    let size = 3000;
    let even = |start: f64, step: f64| (0..size).map(|k| start + step * k as f64).collect::<Vec<_>>();
    let mut broken = even(0.0, 0.1);
    broken[1700] += 1e-3;
    broken[900] += 1e-9;
    broken[2500] += 1e-6;
    let grids = [
        even(0.0, 0.1),
        even(-150.0, 0.1),
        even(1e9, 0.125),
        even(2.4e6, 1e-3),
        even(1e3, -7.3),
        even(0.1, 7.3),
        even(0.0, 0.0),
        broken,
    ];
    for times in grids {
        for arch in archs() {
            let (attitudes, rates) = both(&trajectory, arch, &times, 1);
            // A part has too few times for a table.
            let parts: Vec<Both> = times.chunks(100).map(|part| both(&trajectory, arch, part, 1)).collect();
            let direct_attitudes: Vec<[f64; 4]> = parts.iter().flat_map(|part| part.0.clone()).collect();
            let direct_rates: Vec<[f64; 3]> = parts.iter().flat_map(|part| part.1.clone()).collect();
            let (attitude, rate) = (apart(&attitudes, &direct_attitudes), apart(&rates, &direct_rates));
            assert!(attitude <= 1e-15 && rate <= 1e-15, "{arch:?} from {}: {attitude:e} {rate:e}", times[0]);
        }
    }
}

#[test]
fn the_table_serves_uniform_times_and_leaves_others() {
    let mut draw = Draw(8);
    let trajectory = Case::new(&mut draw, 3, 0.1).trajectory();
    let grid = |times: &[f64]| super::Grid::new(Arch::new(), trajectory.phases().expect("two phases"), times).is_some();
    assert!(grid(&(0..3000).map(|k| 17.0 + 0.1 * f64::from(k)).collect::<Vec<_>>()));
    assert!(!grid(&uneven(&mut draw, 3000)));
    assert!(!grid(&[f64::INFINITY; 3000]) && !grid(&[f64::NAN; 3000]));
}

#[test]
fn the_first_time_without_a_phase_is_named() {
    let trajectory = Case::new(&mut Draw(9), 2, 0.1).trajectory();
    for arch in archs() {
        for wrong in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1.1e15] {
            for place in [0, 5, 511, 512, 999, 40_000] {
                let mut times: Vec<f64> = (0..50_000).map(f64::from).collect();
                (times[place], times[49_000]) = (wrong, wrong);
                let mut rates = vec![[0.0; 3]; times.len()];
                let found = evaluation(&trajectory, arch).fill(&times, Outputs::Rates(&mut rates), 4);
                assert_eq!(found, Err(Halt::Time(place)), "{arch:?} {wrong}");
            }
        }
    }
}
