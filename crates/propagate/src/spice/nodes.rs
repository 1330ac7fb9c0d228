//! Times at which a motion is tabulated, so that uniform rotation between neighbouring times stays within a given error.
//!
//! Between two attitudes a C-kernel of type 3 rotates about one axis at one rate. For a motion with the angular acceleration α = |dω/dt| the error is h²α/8 in the middle of an
//! interval h, the difference between a parabola and its chord. The smallest number of nodes for an error ε therefore has the density √(α/8ε), and the number is the integral of the
//! density. α is computed from the attitude in the middle of a short interval and includes every torque. An interval is at most a quarter of a turn long, because SPICE takes the
//! shorter of the two rotations.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::error::Error;
use crate::motion::solved::Motion;

/// Rotations that are looked at together.
pub(super) const ROTATIONS: f64 = 32.0;
/// Intervals of a window in which the density is measured: 64 a rotation.
const STEPS: usize = 2048;
/// Part of the error that the nodes are laid out for: the maximum need not lie where it is measured.
const MARGIN: f64 = 0.98;
const ATTEMPTS: usize = 8;
/// Nodes, relative to the integral of the density, at most: more of them do not help.
const MOST: f64 = 16.0;
/// Times at which the rate of a motion is looked at.
const LOOKS: usize = 1024;

/// A motion whose times are counted from its epoch, so that they keep their digits at any date.
pub(super) struct KernelSource<'a> {
    motion: &'a Motion,
    /// The epoch \[s of TDB past J2000\].
    pub(super) origin: f64,
    /// First and last time \[s\] from the epoch.
    pub(super) interval: [f64; 2],
}

/// The attitudes and the angular velocities, in body components, of a motion at some times.
pub(super) struct Sampled {
    pub(super) attitudes: Vec<UnitQuaternion<f64>>,
    pub(super) rates: Vec<Vector3<f64>>,
}

impl<'a> KernelSource<'a> {
    /// The motion over an interval of its times, with time 0 \[s of TDB past J2000\].
    pub(super) fn new(motion: &'a Motion, interval: [f64; 2], zero: f64) -> Self {
        let epoch = motion.scene().state().epoch;
        Self { motion, origin: zero + epoch, interval: interval.map(|time| time - epoch) }
    }

    /// Samples at times \[s\] from the epoch. The ends of a kernel are rounded outwards; if the motion does not reach so far, they have the attitudes of the interval's ends.
    pub(super) fn sampled(&self, times: &[f64]) -> Result<Sampled, Error> {
        let (mut attitudes, mut rates) = (vec![[0.0; 4]; times.len()], vec![[0.0; 3]; times.len()]);
        let batch = self.motion.batch().since_epoch();
        match batch.samples_into(times, &mut attitudes, &mut rates) {
            Err(Error::Time { .. }) => {
                let [first, last] = self.interval;
                let times: Vec<f64> = times.iter().map(|time| time.clamp(first, last)).collect();
                batch.samples_into(&times, &mut attitudes, &mut rates)?;
            }
            result => result?,
        }
        let attitudes = attitudes.into_iter().map(|q| UnitQuaternion::new_unchecked(Quaternion::from(q))).collect();
        Ok(Sampled { attitudes, rates: rates.into_iter().map(Vector3::from).collect() })
    }

    /// Samples at times \[s of TDB past J2000\].
    pub(super) fn at(&self, times: &[f64]) -> Result<Sampled, Error> {
        self.sampled(&times.iter().map(|time| time - self.origin).collect::<Vec<f64>>())
    }

    /// The largest rate at `LOOKS` times of the interval \[rad/s\].
    pub(super) fn fastest(&self) -> Result<f64, Error> {
        let rates = self.sampled(&even(self.interval[0], self.interval[1], LOOKS))?.rates;
        Ok(rates.iter().map(Vector3::norm).fold(0.0, f64::max))
    }
}

/// `count + 1` times from one to another.
pub(super) fn even(start: f64, stop: f64, count: usize) -> Vec<f64> {
    let place = |step: usize| start + (stop - start) * (step as f64 / count as f64);
    (0..count).map(place).chain([stop]).collect()
}

/// The rotation at a part of the way from one attitude to another, about one axis at one rate on the shorter way.
pub(super) fn between(one: &UnitQuaternion<f64>, other: &UnitQuaternion<f64>, part: f64) -> UnitQuaternion<f64> {
    one * (one.inverse() * other).powf(part)
}

/// The number of windows of an interval at a rate, with this many rotations in each.
pub(super) fn window_count(start: f64, stop: f64, rate: f64, rotations: f64) -> f64 {
    ((stop - start) * rate / (TAU * rotations)).ceil().max(1.0)
}

/// The number of nodes, estimated from the first window.
pub(super) fn estimate(source: &KernelSource<'_>, borders: &[f64], error: f64) -> Result<f64, Error> {
    let (_, integral) = count(source, borders[0], borders[1], MARGIN * error)?;
    Ok(integral[STEPS] * (borders.len() - 1) as f64)
}

/// The nodes from `start` to `stop`, which are nodes. The inner error is the angle \[rad\] that is left where more nodes do not help, because rounding dominates.
pub(super) fn nodes(
    source: &KernelSource<'_>,
    start: f64,
    stop: f64,
    error: f64,
) -> Result<Result<Vec<f64>, f64>, Error> {
    let (places, integral) = count(source, start, stop, MARGIN * error)?;
    let (mut more, mut worst) = (1.0, f64::INFINITY);
    for _ in 0..ATTEMPTS {
        let number = (more * integral[STEPS]).ceil().max(1.0) as usize;
        let mut times: Vec<f64> = even(0.0, integral[STEPS], number)
            .into_iter()
            .map(|value| interpolated(value, &integral, &places))
            .collect();
        (times[0], times[number]) = (start, stop);
        worst = largest_error(source, &times)?;
        if worst <= error {
            return Ok(Ok(times));
        }
        more *= (worst / error).sqrt() * 1.01;
        if more > MOST {
            break;
        }
    }
    Ok(Err(worst))
}

/// Times in the interval, and the number of nodes that are needed up to each of them.
fn count(source: &KernelSource<'_>, start: f64, stop: f64, error: f64) -> Result<(Vec<f64>, Vec<f64>), Error> {
    let times = even(start, stop, 2 * STEPS);
    let Sampled { attitudes, rates } = source.sampled(&times)?;
    let length = (stop - start) / STEPS as f64;
    let mut integral = vec![0.0];
    for step in 0..STEPS {
        let [one, middle, other] = [0, 1, 2].map(|place| &attitudes[2 * step + place]);
        let acceleration = 8.0 * between(one, other, 0.5).angle_to(middle) / (length * length);
        let density = (acceleration / (8.0 * error)).sqrt().max(rates[2 * step + 1].norm() / FRAC_PI_2);
        integral.push(integral[step] + density * length);
    }
    Ok((times.into_iter().step_by(2).collect(), integral))
}

/// The value at a place of a piecewise linear function with increasing places.
fn interpolated(place: f64, places: &[f64], values: &[f64]) -> f64 {
    let after = places.partition_point(|&other| other <= place).clamp(1, places.len() - 1);
    let (width, inside) = (places[after] - places[after - 1], place - places[after - 1]);
    let part = if width > 0.0 { (inside / width).clamp(0.0, 1.0) } else { 0.0 };
    values[after - 1] + part * (values[after] - values[after - 1])
}

/// The largest error \[rad\] of uniform rotation from each time to the next, at three times between them.
fn largest_error(source: &KernelSource<'_>, times: &[f64]) -> Result<f64, Error> {
    let attitudes = source.sampled(times)?.attitudes;
    let mut worst = 0.0_f64;
    for part in [0.25, 0.5, 0.75] {
        let inner: Vec<f64> = times.windows(2).map(|pair| pair[0] + part * (pair[1] - pair[0])).collect();
        let errors = attitudes.windows(2).zip(source.sampled(&inner)?.attitudes);
        worst = errors.map(|(pair, truth)| between(&pair[0], &pair[1], part).angle_to(&truth)).fold(worst, f64::max);
    }
    Ok(worst)
}
