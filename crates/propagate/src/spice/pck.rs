//! Binary PCK of a motion: Chebyshev polynomials of the angles φ, δ, W, with the matrix \[W\]₃ \[δ\]₁ \[φ\]₃ from an inertial frame to the body's axes (PCK Required Reading).
//!
//! φ and W are singular where the body's axis 3 points to a pole of the inertial frame (sin δ = 0). Each segment has an inertial frame of its own, so it takes the one of
//! J2000, ECLIPJ2000 and GALACTIC from whose poles the axis stays farthest; SPICE turns the result to any frame that is asked for. The poles of the three are not on one great circle, so
//! an axis that runs along a great circle stays away from those of one frame at least.
//!
//! The polynomials interpolate at the zeros of T₁₆. Their error is largest near the extrema of T₁₆, and there it is measured.

use std::f64::consts::{PI, TAU};
use std::io::BufWriter;
use std::path::Path;

use andoyer_kernels::{Daf, Head, Kernel, Refused, clock, frames};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::nodes::{KernelSource, Sampled, even, window_count};
use super::options::{KernelOptions, WriteError, Written, beside};
use crate::motion::solved::Motion;

const DEGREE: usize = 15;
const NODES: usize = DEGREE + 1;
/// Rotations of a segment at most.
const ROTATIONS: f64 = 1024.0;
/// Intervals of a rotation at most, where the angles turn by up to 1/`NEAR` as fast as the body: with more of them rounding dominates.
const MOST: f64 = 1024.0;
/// Intervals of the whole kernel at most: 2 GB.
const MOST_RECORDS: f64 = 5e6;
/// The frames of the segments: J2000, ECLIPJ2000, GALACTIC. The first of them is taken in which sin δ stays above `FAR`.
const FRAMES: [i32; 3] = [1, 17, 13];
const FAR: f64 = 0.15;
/// A segment is halved where sin δ falls below this in all frames.
const NEAR: f64 = 0.05;
/// Times of a segment at which sin δ is looked at, for each of its rotations.
const LOOKS: f64 = 24.0;
const HALVINGS: usize = 12;

impl Motion {
    /// Writes the motion over an interval as a binary PCK of type 2, and the text kernel with the frame beside it (`.tf`).
    ///
    /// The unit of time must be the second. The attitude that SPICE computes differs from the motion by at most [`Written::error`].
    ///
    /// ```
    /// use andoyer_propagate::spice::{Kernel, KernelOptions};
    /// use andoyer_propagate::{Body, Scene, State};
    /// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?).solve()?;
    /// let path = std::env::temp_dir().join("andoyer-wobble.bpc");
    /// let written = motion.write_pck(&path, [0.0, 60.0], &Kernel::new("WOBBLE", "J2000")?, KernelOptions::default())?;
    /// assert!(written.kind == 2 && written.records < 60 && written.error < 1.01e-8);
    /// # std::fs::remove_file(&path)?;
    /// # std::fs::remove_file(path.with_extension("tf"))?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Motion::write_ck`]; [`WriteError::Refused`] also for a code by which SPICE has a rotating frame of its own.
    pub fn write_pck(
        &self,
        path: &Path,
        interval: [f64; 2],
        kernel: &Kernel,
        mut options: KernelOptions<'_>,
    ) -> Result<Written, WriteError> {
        if frames::has_constants(kernel.code()) {
            let allowed = "a code of which SPICE has no rotating frame: a kernel would change that frame too";
            return Err(Refused::new("body", kernel.code().to_string(), allowed).into());
        }
        let [begin, end] = options.times(interval)?;
        let error = options.interpolation_error;
        let comments = options.comments(kernel, Some(self), error);
        beside(path, "tf", &kernel.text_of_pck(), options.force, |file| {
            let mut daf = Daf::pck(BufWriter::new(file), &comments)?;
            let source = KernelSource::new(self, interval, options.zero);
            let rate = source.fastest()?;
            let windows = window_count(begin, end, rate, ROTATIONS);
            options.limited(windows, MOST_RECORDS)?;
            let mut fit = Fit::new(source, kernel, [begin, end], error, rate);
            let borders = even(begin, end, windows as usize);
            let mut records = 0;
            for (done, pair) in borders.windows(2).enumerate() {
                records += fit.segments(&mut daf, kernel, [pair[0], pair[1]], HALVINGS)?;
                options.limited(records as f64 * windows / (done + 1) as f64, MOST_RECORDS)?;
                options.report(done + 1, borders.len() - 1)?;
            }
            daf.finish()?;
            Ok(Written { kind: 2, records, error: error + rate * clock::rounding(begin).max(clock::rounding(end)) })
        })
    }
}

/// The fit of polynomials to a motion.
struct Fit<'a> {
    source: KernelSource<'a>,
    error: f64,
    /// Largest rate of the motion \[rad/s\].
    rate: f64,
    /// Length of an interval with which the last segment met the error \[s\].
    length: f64,
    /// The rotation of inertial components from the frame of the motion to each of `FRAMES`.
    turns: [UnitQuaternion<f64>; 3],
    /// Values at the nodes to coefficients: 2 T_k(x_j)/16, half of it for k = 0.
    transform: [[f64; NODES]; NODES],
}

impl<'a> Fit<'a> {
    fn new(source: KernelSource<'a>, kernel: &Kernel, ends: [f64; 2], error: f64, rate: f64) -> Self {
        let matrix = |code| Matrix3::from(frames::from_j2000(code)).transpose();
        let own = matrix(kernel.frame_code());
        let turns = FRAMES.map(|code| {
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix(code) * own.transpose()))
        });
        let transform = std::array::from_fn(|k| {
            std::array::from_fn(|j| (k as f64 * node(j).acos()).cos() * if k == 0 { 1.0 } else { 2.0 } / NODES as f64)
        });
        let length = ends[1] - ends[0];
        Self { source, error, rate, length, turns, transform }
    }

    /// Writes one segment, or more of them where the axis runs past the poles of all frames; the number of intervals.
    fn segments(
        &mut self,
        daf: &mut Daf<impl std::io::Write + std::io::Seek>,
        kernel: &Kernel,
        [begin, end]: [f64; 2],
        halvings: usize,
    ) -> Result<usize, WriteError> {
        let (place, distance) = self.frame(begin, end)?;
        if distance < NEAR && halvings > 0 {
            let middle = 0.5 * (begin + end);
            let first = self.segments(daf, kernel, [begin, middle], halvings - 1)?;
            return Ok(first + self.segments(daf, kernel, [middle, end], halvings - 1)?);
        }
        let mut count = ((end - begin) / self.length).ceil().max(1.0);
        loop {
            let length = (end - begin) / count;
            let (coefficients, worst) = self.polynomials(begin, length, count as usize, place)?;
            let gain = (self.error / worst).powf(1.0 / NODES as f64);
            if worst <= self.error {
                // The next segment begins with intervals that would have made 0.9 of the error.
                self.length = length * (0.99 * gain).clamp(1.0, 2.0);
                let head = Head { code: kernel.code(), frame: FRAMES[place], name: kernel.segment().to_owned() };
                daf.pck2(&head, [begin, end], length, DEGREE, &coefficients)?;
                return Ok(count as usize);
            }
            if length * self.rate < TAU / MOST {
                let value = format!("{:e}, but {worst:.3e} rad are left between {begin:?} and {end:?}", self.error);
                return Err(
                    Refused::new("interpolation_error", value, "above the rounding error of this motion").into()
                );
            }
            count = (count / gain.clamp(0.25, 0.95)).ceil();
        }
    }

    /// The frame from whose poles the axis stays farthest in an interval, and the least sin δ in it.
    fn frame(&self, begin: f64, end: f64) -> Result<(usize, f64), WriteError> {
        let count = (LOOKS * (end - begin) * self.rate / TAU).ceil().max(LOOKS) as usize;
        let samples = self.source.at(&even(begin, end, count))?;
        let least = self.turns.map(|turn| {
            let distance = |attitude: &UnitQuaternion<f64>| (turn * (attitude * Vector3::z())).xy().norm();
            samples.attitudes.iter().map(distance).fold(1.0, f64::min)
        });
        let first = (0..3).find(|&place| least[place] >= FAR);
        let farthest = first.or_else(|| (0..3).max_by(|&one, &other| least[one].total_cmp(&least[other]))).unwrap_or(0);
        Ok((farthest, least[farthest]))
    }

    /// Coefficients of `count` intervals from `begin` on, and their largest error \[rad\].
    fn polynomials(&self, begin: f64, length: f64, count: usize, place: usize) -> Result<(Vec<f64>, f64), WriteError> {
        let middle = |interval: usize| begin + (interval as f64 + 0.5) * length;
        let at = |places: &dyn Fn(usize) -> f64, number: usize| {
            let ([first, last], origin) = (self.source.interval, self.source.origin);
            let time = |index: usize| {
                ((middle(index / number) - origin) + 0.5 * length * places(index % number)).clamp(first, last)
            };
            self.source.sampled(&(0..count * number).map(time).collect::<Vec<f64>>())
        };
        let at_nodes = at(&node, NODES)?;
        let Sampled { attitudes: truths, .. } = at(&extremum, NODES + 1)?;
        let (mut coefficients, mut worst) = (Vec::with_capacity(3 * NODES * count), 0.0_f64);
        let rows = at_nodes.attitudes.chunks(NODES).zip(at_nodes.rates.chunks(NODES));
        for ((attitudes, rates), truths) in rows.zip(truths.chunks(NODES + 1)) {
            let turned_to: Vec<_> = attitudes.iter().map(|attitude| self.turns[place] * attitude).collect();
            let angles = continued(&turned_to, rates, 0.5 * length);
            let fitted = [0, 1, 2].map(|angle| {
                self.transform
                    .map(|row| row.iter().zip(&angles).map(|(factor, angles)| factor * angles[angle]).sum::<f64>())
            });
            for (index, truth) in truths.iter().enumerate() {
                let [phi, delta, w] = fitted.map(|coefficients| chebyshev(&coefficients, extremum(index)));
                worst = worst.max((turned(phi, delta, w)).angle_to(&(self.turns[place] * truth)));
            }
            coefficients.extend(fitted.as_flattened());
        }
        Ok((coefficients, worst))
    }
}

fn node(place: usize) -> f64 {
    ((place as f64 + 0.5) * PI / NODES as f64).cos()
}

fn extremum(place: usize) -> f64 {
    (place as f64 * PI / NODES as f64).cos()
}

/// The angles φ, δ, W of an attitude; each is accurate next to δ = 0 and π too, where φ and W are not determined.
fn angles(attitude: &UnitQuaternion<f64>) -> [f64; 3] {
    let axis = attitude * Vector3::z();
    let pole = attitude.inverse() * Vector3::z();
    [axis.x.atan2(-axis.y), axis.xy().norm().atan2(axis.z), pole.x.atan2(pole.y)]
}

/// The attitude with these angles.
fn turned(phi: f64, delta: f64, w: f64) -> UnitQuaternion<f64> {
    let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    about(Vector3::z_axis(), phi) * about(Vector3::x_axis(), delta) * about(Vector3::z_axis(), w)
}

/// The angles at the nodes of an interval. Whole turns are added to φ and W, so that they change from node to node as their rates say: an interval may have many turns.
fn continued(attitudes: &[UnitQuaternion<f64>], rates: &[Vector3<f64>], radius: f64) -> Vec<[f64; 3]> {
    let mut continued: Vec<[f64; 3]> = attitudes.iter().map(angles).collect();
    let speeds: Vec<[f64; 3]> = attitudes.iter().zip(rates).map(|(attitude, rate)| speeds(attitude, rate)).collect();
    for place in 1..continued.len() {
        let step = radius * (node(place) - node(place - 1));
        for angle in [0, 2] {
            let expected = continued[place - 1][angle] + 0.5 * step * (speeds[place - 1][angle] + speeds[place][angle]);
            continued[place][angle] -= TAU * ((continued[place][angle] - expected) / TAU).round();
        }
    }
    continued
}

/// Time derivatives of φ and W (and 0) for an angular velocity in body components.
fn speeds(attitude: &UnitQuaternion<f64>, rate: &Vector3<f64>) -> [f64; 3] {
    let pole = attitude.inverse() * Vector3::z();
    let phi = (rate.x * pole.x + rate.y * pole.y) / pole.xy().norm_squared().max(f64::MIN_POSITIVE);
    [phi, 0.0, rate.z - phi * pole.z]
}

/// A sum of Chebyshev polynomials, by Clenshaw's recursion as SPICE does.
fn chebyshev(coefficients: &[f64], x: f64) -> f64 {
    let (one, two) = coefficients[1..].iter().rev().fold((0.0, 0.0), |(one, two), c| (c + 2.0 * x * one - two, one));
    coefficients[0] + x * one - two
}
