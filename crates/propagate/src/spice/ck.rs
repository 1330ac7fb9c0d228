//! C-kernels of a motion: type 3, or type 2 for uniform rotation.

use std::io::BufWriter;
use std::path::Path;

use andoyer_kernels::{Daf, Head, Kernel, Refused, clock};
use nalgebra::{UnitQuaternion, Vector3};

use super::nodes::{KernelSource, ROTATIONS, Sampled, estimate, even, nodes, window_count};
use super::options::{KernelOptions, WriteError, Written, beside};
use crate::motion::solved::Motion;
use crate::torque_free::mode::Mode;

/// 64 bytes each: more would not fit a file that anyone loads.
const MOST_RECORDS: f64 = 5e7;
/// Records of a segment, and those of a window more: SPICE looks for a segment one after the other.
const LONGEST_SEGMENT: usize = 200_000;
/// Part of a rotation angle by which its sine may be off, with room.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Motion {
    /// Writes the motion over an interval as a C-kernel, and the text kernel with the frame and the clock beside it (`.tsc`).
    ///
    /// The unit of time must be the second. The attitude that SPICE interpolates differs from the motion by at most [`Written::error`].
    ///
    /// ```
    /// use andoyer_propagate::spice::{Kernel, KernelOptions};
    /// use andoyer_propagate::{Body, Scene, State};
    /// let motion = Scene::new(Body::new([1.0, 1.5, 2.0])?, State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.2, 1.0])?).solve()?;
    /// let path = std::env::temp_dir().join("andoyer-wobble.bc");
    /// let options = KernelOptions { interpolation_error: 1e-6, ..KernelOptions::default() };
    /// let written = motion.write_ck(&path, [0.0, 60.0], &Kernel::new("WOBBLE", "J2000")?, options)?;
    /// assert!(written.kind == 3 && (7500..7600).contains(&written.records) && written.error < 1.01e-6);
    /// # std::fs::remove_file(&path)?;
    /// # std::fs::remove_file(path.with_extension("tsc"))?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - [`WriteError::Refused`] for an interval without a length or outside the clock, an error below 1e-13 rad or the rounding of this motion, more than 5e7 records.
    /// - [`WriteError::Motion`] for a time that the motion does not reach; [`WriteError::System`] for an error of the system.
    pub fn write_ck(
        &self,
        path: &Path,
        interval: [f64; 2],
        kernel: &Kernel,
        mut options: KernelOptions<'_>,
    ) -> Result<Written, WriteError> {
        let ends = options.ends(interval)?;
        let source = KernelSource::new(self, interval, options.zero);
        let writer = CkWriter { source, head: Head::of(kernel), ends };
        let comments = options.comments(kernel, Some(self), options.interpolation_error);
        beside(path, "tsc", &kernel.text_of_ck(), options.force, |file| {
            let mut daf = Daf::ck(BufWriter::new(file), &comments)?;
            let steady = matches!(self.plan().mode(), Mode::PrincipalAxis | Mode::Spherical | Mode::AtRest)
                && self.scene().asked_disturbing().is_empty()
                && !self.plan().method().is_integrated();
            // The rate of a user's clock may change within a record of type 2.
            let written = if steady && options.ticks.is_none() {
                writer.uniform(&mut daf, &mut options)?
            } else {
                writer.tabulated(&mut daf, &mut options)?
            };
            daf.finish()?;
            Ok(written)
        })
    }
}

struct CkWriter<'a> {
    source: KernelSource<'a>,
    head: Head,
    /// First and last time \[s of TDB past J2000\].
    ends: [f64; 2],
}

impl CkWriter<'_> {
    /// Records of type 2: as many as keep the rounding of the angle of a record below the error, and one for each piece of the clock.
    fn uniform(
        &self,
        daf: &mut Daf<impl std::io::Write + std::io::Seek>,
        options: &mut KernelOptions<'_>,
    ) -> Result<Written, WriteError> {
        let error = options.interpolation_error;
        let mut records = 0;
        let mut rate = 0.0;
        for [begin, end] in options.parts(self.ends) {
            rate = self.source.at(&[begin])?.rates[0].norm();
            let count = (rate * (end - begin) * ROUNDING / error).ceil().max(1.0);
            options.limited(count, MOST_RECORDS)?;
            let times: Vec<f64> = even(begin, end, count as usize).into_iter().map(|time| options.held(time)).collect();
            let ticks = options.ticks(&times, "interpolation_error")?;
            let samples = self.source.at(&times[..times.len() - 1])?;
            let seconds = vec![clock::rate(begin); samples.rates.len()];
            let (attitudes, rates) = inertial(&samples);
            daf.ck2(&self.head, &ticks, &attitudes, &rates, &seconds)?;
            records += seconds.len();
        }
        Ok(Written { kind: 2, records, error: error + options.rounding(self.ends, rate, 0.0) })
    }

    /// Segments of type 3, each with whole windows. Neighbouring segments share a node, so that there is no gap.
    fn tabulated(
        &self,
        daf: &mut Daf<impl std::io::Write + std::io::Seek>,
        options: &mut KernelOptions<'_>,
    ) -> Result<Written, WriteError> {
        let (error, origin) = (options.interpolation_error, self.source.origin);
        let (rate, mut windows) = (self.source.fastest()?, Vec::new());
        for [begin, end] in options.parts(self.ends) {
            let [start, stop] = [begin - origin, end - origin];
            let number = window_count(start, stop, rate, ROTATIONS);
            options.limited(number, MOST_RECORDS)?;
            let borders = even(start, stop, number as usize);
            options.limited(estimate(&self.source, &borders, error)?, MOST_RECORDS)?;
            let count = borders.len() - 1;
            // The ends of a part are exact in the time of the kernel, where the clock changes its rate.
            let of = |place: usize| ((place == 0).then_some(begin), (place + 1 == count).then_some(end));
            windows.extend(borders.windows(2).enumerate().map(|(place, pair)| ([pair[0], pair[1]], of(place))));
        }
        let (mut times, mut records, mut fastest): (Vec<f64>, usize, f64) = (Vec::new(), 0, 0.0);
        let mut rounding = 0.0_f64;
        for (done, &([start, stop], (first, last))) in windows.iter().enumerate() {
            let found = nodes(&self.source, start, stop, error)?.map_err(|left| {
                let value = format!("{error:e}, but {left:.3e} rad are left between nodes from {start:?} to {stop:?}");
                Refused::new("interpolation_error", value, "above the rounding error of this motion")
            })?;
            let mut found: Vec<f64> = found.into_iter().map(|time| options.held(origin + time)).collect();
            let count = found.len();
            (found[0], found[count - 1]) = (first.unwrap_or(found[0]), last.unwrap_or(found[count - 1]));
            let border = found[count - 1];
            times.extend(found.into_iter().skip(usize::from(!times.is_empty())));
            if last.is_some() || times.len() > LONGEST_SEGMENT {
                let ticks = options.ticks_between(&mut times, rate)?;
                let samples = self.source.at(&times)?;
                let (attitudes, rates) = inertial(&samples);
                daf.ck3(&self.head, &ticks, &attitudes, Some(&rates), &ticks[..1])?;
                records += times.len();
                options.limited(records as f64, MOST_RECORDS)?;
                fastest = samples.rates.iter().map(Vector3::norm).fold(fastest, f64::max);
                let seconds = (times[times.len() - 1] - times[0]) / (ticks[ticks.len() - 1] - ticks[0]);
                rounding = rounding.max(ticks[ticks.len() - 1].abs() * seconds);
                times.clear();
                if last.is_none() {
                    times.push(border);
                }
            }
            options.report(done + 1, windows.len())?;
        }
        Ok(Written { kind: 3, records, error: error + options.rounding(self.ends, fastest, rounding) })
    }
}

/// Attitudes as arrays, and angular velocities in inertial components.
fn inertial(samples: &Sampled) -> (Vec<[f64; 4]>, Vec<[f64; 3]>) {
    let attitudes = samples.attitudes.iter().map(array).collect();
    (attitudes, samples.attitudes.iter().zip(&samples.rates).map(|(attitude, rate)| (attitude * rate).into()).collect())
}

pub(super) fn array(attitude: &UnitQuaternion<f64>) -> [f64; 4] {
    attitude.coords.into()
}
