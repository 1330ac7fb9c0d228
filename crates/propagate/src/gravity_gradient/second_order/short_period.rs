//! The size of the short-period change of second order. The corrections do not have it, and far from resonances it is the error of a motion of second order.
//!
//! The mean variables Z have the rates f₀ + ⟨g⟩, with those of the free motion f₀ and g = {Z, D}. The motion is at Z + v, with the first-order change
//! v = {Z, W}. To second order its rates differ from the true ones there by
//!
//! ```text
//! d = ½ f₀″(v, v) + g′ v − v′ ⟨g⟩
//! ```
//!
//! where ′ is the derivative with respect to Z. d is a sum over pairs of terms a, b. A part e^(i(a+b)θ) of it with a + b ≠ 0 makes a change e of the same
//! frequency, ė = f₀′ e + d. The parts with a + b = 0 are the rates that K2 gives; there the change is the mean of ½ v′ v. A size needs few terms of the sums over
//! time derivatives: W has two, D_a/(iΩ_a) − Ḋ_a/(iΩ_a)², and e has one.

use nalgebra::Vector3;
use num_complex::Complex;

use super::jet::{Field, Jet, Point, SIZE, Slopes, along, with_turns};
use super::modes::{Mode, large_modes, slowest};
use crate::gravity_gradient::contraction::{Tensor, product};
use crate::gravity_gradient::corrections::{Demand, Mean};
use crate::gravity_gradient::envelope::on_ellipse;
use crate::gravity_gradient::inertia::Inertia;

type C64 = Complex<f64>;

/// Terms smaller than this share of the largest are left out.
const SMALLEST_SHARE: f64 = 3e-3;

/// One term at one place of the disturbing body.
struct Wave {
    /// h and m.
    numbers: [i32; 2],
    /// g′.
    torque_slopes: Slopes,
    /// v.
    change: Field,
    /// v′.
    change_slopes: Slopes,
}

/// The mean motion of which the change is sought.
pub(super) struct Motion<'a> {
    inertia: &'a Inertia,
    modes: Vec<Mode>,
    /// ⟨D⟩ over q and the contraction.
    average: Mode,
    point: Point,
    /// q.
    strength: f64,
    /// Turn of the attitude for a unit change of p.
    gain: f64,
    /// Slower pairs are taken to be as fast as this.
    slowest: f64,
}

/// The largest turn of the attitude by the change, for a disturbing body at any of these true anomalies \[rad\].
pub(crate) fn largest(inertia: &Inertia, mean: &Mean, demand: &Demand<'_>, gain: f64, anomalies: &[f64]) -> f64 {
    let motion = Motion::new(inertia, demand, gain, SMALLEST_SHARE);
    let [first, second, _] = demand.orbit.axes().map(|axis| mean.frame.inverse() * axis);
    let elements = (demand.mean_motion, demand.orbit.eccentricity());
    anomalies.iter().map(|&f| motion.size(&tensors([first, second], elements, f))).fold(0.0, f64::max)
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

impl<'a> Motion<'a> {
    pub(super) fn new(inertia: &'a Inertia, demand: &Demand<'_>, gain: f64, share: f64) -> Self {
        Self {
            inertia,
            modes: large_modes(inertia, share, slowest(demand)),
            average: Mode::average(inertia),
            point: Point { momentum: inertia.momentum, root: inertia.sigma.sqrt() },
            strength: demand.strength(),
            gain,
            slowest: slowest(demand),
        }
    }

    /// The sum of the sizes of all harmonics of the change, for (a/r)³ r̂r̂ in the frame and its time derivative \[rad\].
    fn size(&self, tensors: &[Tensor; 2]) -> f64 {
        let (harmonics, mean) = self.change(tensors);
        harmonics.iter().map(|(_, change)| 2.0 * self.turn(change)).sum::<f64>() + self.turn(&mean)
    }

    /// The change for (a/r)³ r̂r̂ in the frame and its time derivative: the harmonics e^(i(hℓ′+my′)), each with h, m, and the mean.
    pub(super) fn change(&self, tensors: &[Tensor; 2]) -> (Vec<([i32; 2], Field)>, Field) {
        let waves = self.waves(tensors);
        let mut sums = Sums::default();
        for b in &waves {
            let [h, m] = b.numbers;
            for a in &waves {
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
        self.add_average(&mut sums, &waves, &with_turns(&tensors[0]));
        let harmonics = sums.0.iter().map(|(numbers, lacking)| (*numbers, self.response(*numbers, lacking)));
        let mut mean = [C64::default(); SIZE];
        for wave in &waves {
            mean = plus(mean, along(&wave.change.map(|part| part.conj()), &wave.change_slopes));
        }
        (harmonics.collect(), mean.map(|part| part.re.into()))
    }

    /// The harmonics of the change of first order.
    #[cfg(test)]
    pub(super) fn first(&self, tensors: &[Tensor; 2]) -> Vec<([i32; 2], Field)> {
        self.waves(tensors).iter().map(|wave| (wave.numbers, wave.change)).collect()
    }

    fn waves(&self, tensors: &[Tensor; 2]) -> Vec<Wave> {
        let tensors = tensors.each_ref().map(with_turns);
        let wave = |mode: &Mode| {
            let [torque, rate] =
                tensors.each_ref().map(|tensors| Jet::torque(mode, tensors, self.strength, self.point.root));
            let frequency = mode.frequency.map(|part| part * self.point.momentum);
            let over = |jet: &Jet| jet.over(frequency, self.point);
            let generator = over(&torque).minus(&over(&over(&rate)));
            Wave {
                numbers: [mode.harmonic, mode.multiple],
                torque_slopes: torque.field_slopes(self.point),
                change: generator.field(self.point),
                change_slopes: generator.field_slopes(self.point),
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

    /// The change e^(i(hℓ′+my′)) that lacking rates make: changes of p and M act on the phases through the rates.
    fn response(&self, [h, m]: [i32; 2], lacking: &Field) -> Field {
        let Point { momentum, root } = self.point;
        let Inertia { rate_slopes, rates, .. } = self.inertia;
        let rates = rates.each_ref().map(|rate| rate.to_f64());
        let omega = f64::from(h) * rates[0] + f64::from(m) * rates[1];
        let inverse = (C64::i() * omega.abs().max(self.slowest).copysign(omega)).inv();
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

fn plus(one: Field, other: Field) -> Field {
    std::array::from_fn(|n| one[n] + other[n])
}
