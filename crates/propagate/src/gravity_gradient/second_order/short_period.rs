//! The size of the short-period change of second order. The corrections do not contain it. Far from resonances it is the error of a motion of second order.
//!
//! The mean variables Z have the rates f₀ + ⟨g⟩, with those of the free motion f₀ and g = {Z, D}. The motion is at Z + v, with the first-order change
//! v = {Z, W}. To second order its rates differ from the true ones there by
//!
//! ```text
//! d = ½ f₀″(v, v) + g′ v − v′ ⟨g⟩
//! ```
//!
//! where ′ is the derivative with respect to Z. d is a sum over pairs of terms a, b. A part e^(i(a+b)θ) of it with a + b ≠ 0 makes a change e of the same
//! frequency, ė = f₀′ e + d. The parts with a + b = 0 are the rates that K2 gives; there the change is the mean of ½ v′ v. A size needs few terms of the sums
//! over time derivatives: W has two, D_a/(iΩ_a) − Ḋ_a/(iΩ_a)², enlarged for the others, and e has one. A harmonic e^(ijl) of d, which is a product of two
//! factors (a/r)³ r̂r̂, has the divisor Ω + jn. Where this is small, [`Turns::resonant`] has the change by this harmonic.

use nalgebra::Vector3;
use num_complex::Complex;

use super::jet::{Field, Jet, Point, SIZE, Slopes, along, with_turns};
use super::modes::{Mode, large_modes, slowest};
use crate::gravity_gradient::contraction::{Tensor, product};
use crate::gravity_gradient::corrections::{Demand, Mean};
use crate::gravity_gradient::divisors::{Divisors, Secular, multiple_of};
use crate::gravity_gradient::envelope::{at_most, on_ellipse};
use crate::gravity_gradient::inertia::Inertia;

type C64 = Complex<f64>;

/// Terms smaller than this share of the largest are left out, and pairs of terms with a smaller product.
const SIZE_CUTOFF: f64 = 3e-3;

/// Share of one harmonic in a pair as e → 1, where many harmonics share the pair. On a circle the share is 1.
const PART: f64 = 0.3;

/// What harmonics near resonance add is not computed where it is less than this share of the largest change.
const NOTHING_ADDED: f64 = 1e-6;

/// One term at one place of the disturbing body.
struct Wave {
    /// h and m.
    numbers: [i32; 2],
    /// The size of the term over the largest.
    share: f64,
    /// g′.
    torque_slopes: Slopes,
    /// v.
    change: Field,
    /// v′.
    change_slopes: Slopes,
}

/// The mean motion of which the change is sought.
pub(super) struct ShortPeriod<'a> {
    inertia: &'a Inertia,
    /// Each with its size over the largest.
    modes: Vec<(Mode, f64)>,
    /// Pairs with a smaller product of sizes are left out.
    least: f64,
    /// ⟨D⟩ over q and the contraction.
    average: Mode,
    point: Point,
    /// q.
    strength: f64,
    /// Turn of the attitude for a unit change of p, and the sum of the first-order changes of the attitude.
    gain: f64,
    whole: f64,
    /// Slower pairs are taken to be as fast as this.
    slowest: f64,
    /// The shift of the frequencies by the average torque.
    secular: Secular,
}

/// Turns of the attitude by the change \[rad\].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Turns {
    /// The largest, if slow pairs are taken to be as fast as a sum over time derivatives needs.
    pub(crate) largest: f64,
    /// What harmonics of the orbit near resonance with pairs add to it.
    pub(crate) resonant: f64,
}

impl Turns {
    /// Those with the disturbing body at these true anomalies. `sizes` are the turn of the attitude for a unit change of p and the sum of the first-order
    /// changes of the attitude.
    pub(crate) fn new(inertia: &Inertia, mean: &Mean, demand: &Demand<'_>, sizes: [f64; 2], anomalies: &[f64]) -> Self {
        let motion = ShortPeriod::new(inertia, demand, sizes, SIZE_CUTOFF);
        let [first, second, _] = demand.orbit.axes().map(|axis| mean.frame.inverse() * axis);
        let elements = (demand.mean_motion, demand.orbit.eccentricity());
        let nearest = demand.envelope.span[0];
        let mut turns = Self::default();
        for &f in anomalies {
            let [rate, cube] = on_ellipse(elements.0, elements.1, f);
            let tensors = tensors([first, second], elements, f);
            let waves = motion.waves(&tensors, 2.0 * rate);
            let lacking = motion.lacking(&waves, &tensors[0]);
            turns.largest = turns.largest.max(motion.size(&waves, &lacking));
            turns.resonant += motion.resonant(&lacking, demand) * (nearest / cube).powi(2) / anomalies.len() as f64;
        }
        turns
    }
}

/// (a/r)³ r̂r̂ and its time derivative at a true anomaly, from the axes of the ellipse, the mean motion and the eccentricity.
fn tensors([first, second]: [Vector3<f64>; 2], (mean_motion, eccentricity): (f64, f64), f: f64) -> [Tensor; 2] {
    let (sine, cosine) = f.sin_cos();
    let [rate, cube] = on_ellipse(mean_motion, eccentricity, f);
    let (radial, across) = (first * cosine + second * sine, second * cosine - first * sine);
    let growth = -3.0 * eccentricity * sine / (1.0 + eccentricity * cosine);
    let still = product(&radial, &radial);
    let turning = product(&radial, &across);
    [still.map(|part| cube * part), std::array::from_fn(|i| cube * rate * (growth * still[i] + 2.0 * turning[i]))]
}

impl<'a> ShortPeriod<'a> {
    pub(super) fn new(inertia: &'a Inertia, demand: &Demand<'_>, [gain, whole]: [f64; 2], share: f64) -> Self {
        Self {
            inertia,
            modes: large_modes(inertia, share, slowest(demand)),
            least: share,
            average: Mode::average(inertia),
            point: Point { momentum: inertia.momentum, root: inertia.sigma.sqrt() },
            strength: demand.strength(),
            gain,
            whole,
            slowest: slowest(demand),
            secular: Secular::new(
                inertia,
                demand.strength(),
                demand.orbit.eccentricity(),
                [&demand.axes[2], &demand.pole],
            ),
        }
    }

    /// The sum of the sizes of all harmonics of the change \[rad\].
    fn size(&self, waves: &[Wave], lacking: &Sums) -> f64 {
        let harmonics = lacking.0.iter().map(|(numbers, lacking)| self.response(*numbers, lacking));
        harmonics.map(|change| 2.0 * self.turn(&change)).sum::<f64>() + self.turn(&mean(waves))
    }

    /// What harmonics of the orbit near resonance add to the size: of each harmonic of the change the one that adds most, slow ones by their mean over the
    /// span \[rad\].
    fn resonant(&self, lacking: &Sums, demand: &Demand<'_>) -> f64 {
        let (step, eccentricity, envelope) = (demand.orbital_step(), demand.orbit.eccentricity(), demand.envelope);
        // (a/r)⁶ r̂r̂r̂r̂ on a circle has no higher one.
        let highest = 4.0 * demand.mean_motion;
        let part = PART + (1.0 - PART) * (1.0 - eccentricity).powi(8);
        // Second order shifts the frequencies as well.
        let shift = self.whole * self.whole * self.frequency([0, 1]).abs();
        let size = |([h, m], lacking): &([i32; 2], Field)| {
            let omega = self.frequency([*h, *m]);
            let divisors = Divisors::new((*h, *m), [omega, demand.mean_motion], false, &self.secular);
            let counted = omega.abs().max(self.slowest);
            let by = |harmonic: f64| {
                let share = if omega.abs() <= self.slowest || harmonic.abs() <= highest {
                    1.0
                } else if envelope.passes {
                    at_most(eccentricity, harmonic / demand.mean_motion, 2)
                } else {
                    // Without the pericentre a span has no higher harmonics.
                    0.0
                };
                let number = -multiple_of(demand.mean_motion, harmonic);
                // The shifts are too small to make a neighbour the nearest. On a circle a harmonic is one power of e^(if), on an ellipse all powers of two
                // factors have it.
                let turns = if eccentricity == 0.0 { &[number.abs()][..] } else { &[0, 2, 4] };
                let apart = divisors.nearest(number, turns);
                let distance = (apart.abs() - shift).max(1.0 / demand.duration);
                let added = (1.0 - distance / counted).max(0.0) * part * share.min(envelope.share.pairs);
                // The change is at most (counted/distance)² of what its term has in the largest.
                if added * (counted / distance).powi(2) < NOTHING_ADDED {
                    return 0.0;
                }
                2.0 * added * self.turn(&self.driven(distance.copysign(apart), lacking))
            };
            let nearest = by(step * (omega / step).round());
            if omega.abs() > highest { nearest.max(by(highest.copysign(omega))) } else { nearest }
        };
        lacking.0.iter().map(size).sum()
    }

    /// The change for (a/r)³ r̂r̂ in the frame and its time derivative: the harmonics e^(i(hℓ′+my′)), each with h, m, and the mean.
    #[cfg(test)]
    pub(super) fn change(&self, tensors: &[Tensor; 2]) -> (Vec<([i32; 2], Field)>, Field) {
        let waves = self.waves(tensors, 0.0);
        let lacking = self.lacking(&waves, &tensors[0]).0;
        let harmonics = lacking.iter().map(|(numbers, lacking)| (*numbers, self.response(*numbers, lacking)));
        (harmonics.collect(), mean(&waves))
    }

    /// The rates that the change makes up for, for (a/r)³ r̂r̂ in the frame.
    fn lacking(&self, waves: &[Wave], tensor: &Tensor) -> Sums {
        let mut sums = Sums::default();
        for b in waves {
            let [h, m] = b.numbers;
            for a in waves.iter().filter(|a| a.share * b.share >= self.least) {
                let [other_h, other_m] = a.numbers;
                let conjugate = a.torque_slopes.map(|row| row.map(|slope| slope.conj()));
                for (sign, slopes, change) in
                    [(1, &a.torque_slopes, a.change), (-1, &conjugate, a.change.map(|part| part.conj()))]
                {
                    let lacking = plus(along(&b.change, slopes), self.curvature(&change, &b.change));
                    sums.add([sign * other_h + h, sign * other_m + m], lacking);
                }
            }
        }
        self.add_average(&mut sums, waves, &with_turns(tensor));
        sums
    }

    /// The harmonics of the change of first order.
    #[cfg(test)]
    pub(super) fn first(&self, tensors: &[Tensor; 2]) -> Vec<([i32; 2], Field)> {
        self.waves(tensors, 0.0).iter().map(|wave| (wave.numbers, wave.change)).collect()
    }

    /// The terms with their first-order changes. Two terms of the sum over time derivatives are added; the factor 1/(1 − (turning/Ω)²) stands for the others,
    /// squared for the slopes. `turning` is the rate of 2f.
    fn waves(&self, tensors: &[Tensor; 2], turning: f64) -> Vec<Wave> {
        let tensors = tensors.each_ref().map(with_turns);
        let wave = |(mode, share): &(Mode, f64)| {
            let [torque, rate] =
                tensors.each_ref().map(|tensors| Jet::torque(mode, tensors, self.strength, self.point.root));
            let frequency = mode.frequency.map(|part| part * self.point.momentum);
            let over = |jet: &Jet| jet.over(frequency, self.point);
            let generator = over(&torque).minus(&over(&over(&rate)));
            let whole = 1.0 / (1.0 - (turning / frequency[0]).powi(2));
            Wave {
                numbers: [mode.harmonic, mode.multiple],
                share: *share,
                torque_slopes: torque.field_slopes(self.point),
                change: generator.field(self.point).map(|part| part * whole),
                change_slopes: generator.field_slopes(self.point).map(|row| row.map(|part| part * whole * whole)),
            }
        };
        self.modes.iter().map(wave).collect()
    }

    /// Adds what ⟨g⟩ makes: ⟨g⟩′ v − v′ ⟨g⟩. p is seen from axes that turn with the mean rate of ℓ′, also at p = 0.
    fn add_average(&self, sums: &mut Sums, waves: &[Wave], tensors: &[Tensor; 3]) {
        let average = Jet::torque(&self.average, tensors, self.strength, self.point.root);
        let slopes = average.field_slopes(self.point);
        let turning = 0.5 * average.hessian[1][1].re / self.point.momentum;
        let [_, _, longitude, _, first, second] = average.field(self.point);
        for wave in waves {
            let [h, m] = wave.numbers;
            let change = &wave.change;
            let mut lacking = along(change, &slopes);
            lacking[0] += change[1] * turning;
            lacking[1] -= change[0] * turning;
            let phase = C64::i() * (f64::from(h) * turning + f64::from(m) * longitude);
            for n in 0..SIZE {
                lacking[n] -= phase * change[n] + first * wave.change_slopes[4][n] + second * wave.change_slopes[5][n];
            }
            sums.add([h, m], lacking);
        }
    }

    /// ½ f₀″(a, b) of rates of p and y′ that depend on σ and M, without the order of a and b.
    fn curvature(&self, a: &Field, b: &Field) -> Field {
        let Point { momentum, root } = self.point;
        let Inertia { rate_slopes, rate_curvatures, rates, .. } = self.inertia;
        let by_root = 2.0 * root;
        let square = a[0] * b[0] + a[1] * b[1];
        let product = a[0] * b[0] * (by_root * by_root);
        let mixed = a[0] * b[3] * (by_root / momentum);
        let second = |i: usize| square * rate_slopes[i] + product * (0.5 * rate_curvatures[i]) + mixed * rate_slopes[i];
        let first = b[0] * (by_root * rate_slopes[0]) + b[3] * (rates[0].to_f64() / momentum);
        let none = C64::default();
        [-a[1] * first, second(0) * root + a[0] * first, second(1), none, none, none]
    }

    /// The change e^(i(hℓ′+my′)) that lacking rates make.
    fn response(&self, numbers: [i32; 2], lacking: &Field) -> Field {
        let omega = self.frequency(numbers);
        self.driven(omega.abs().max(self.slowest).copysign(omega), lacking)
    }

    /// hℓ′ + my′ in a unit of time.
    fn frequency(&self, [h, m]: [i32; 2]) -> f64 {
        let [anomaly, longitude] = self.inertia.rates.each_ref().map(|rate| rate.to_f64());
        f64::from(h) * anomaly + f64::from(m) * longitude
    }

    /// The change that lacking rates of a frequency make: changes of p and M act on the phases through the rates.
    fn driven(&self, omega: f64, lacking: &Field) -> Field {
        let Point { momentum, root } = self.point;
        let Inertia { rate_slopes, rates, .. } = self.inertia;
        let rates = rates.each_ref().map(|rate| rate.to_f64());
        let inverse = (C64::i() * omega).inv();
        let mut change = lacking.map(|part| part * inverse);
        let shifts = [0, 1].map(|i| change[0] * (2.0 * root * rate_slopes[i]) + change[3] * (rates[i] / momentum));
        change[1] += shifts[0] * root * inverse;
        change[2] += shifts[1] * inverse;
        change
    }

    /// The turn of the attitude by changes of the variables.
    fn turn(&self, [radial, tangential, longitude, _, first, second]: &Field) -> f64 {
        let of_p = self.gain * self.gain * (radial.norm_sqr() + tangential.norm_sqr());
        (of_p + longitude.norm_sqr() + first.norm_sqr() + second.norm_sqr()).sqrt()
    }
}

/// Amplitudes by h and m, each with m > 0, or m = 0 and h > 0.
#[derive(Default)]
struct Sums(Vec<([i32; 2], Field)>);

impl Sums {
    /// Adds an amplitude or its conjugate; none is kept of h = m = 0.
    fn add(&mut self, [h, m]: [i32; 2], field: Field) {
        let (numbers, field) =
            if m < 0 || m == 0 && h < 0 { ([-h, -m], field.map(|part| part.conj())) } else { ([h, m], field) };
        if numbers == [0, 0] {
            return;
        }
        match self.0.iter_mut().find(|(other, _)| *other == numbers) {
            Some((_, sum)) => *sum = plus(*sum, field),
            None => self.0.push((numbers, field)),
        }
    }
}

/// The mean of ½ v′ v.
fn mean(waves: &[Wave]) -> Field {
    let parts = waves.iter().map(|wave| along(&wave.change.map(|part| part.conj()), &wave.change_slopes));
    parts.fold([C64::default(); SIZE], plus).map(|part| part.re.into())
}

fn plus(one: Field, other: Field) -> Field {
    std::array::from_fn(|n| one[n] + other[n])
}
