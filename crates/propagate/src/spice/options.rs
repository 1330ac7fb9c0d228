//! What the writers share: the options, the errors, the result, the times of a kernel.

use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use andoyer_kernels::{Kernel, Refused, clock};
use andoyer_series::error::Short;

use crate::error::Error;
use crate::motion::solved::Motion;

/// The smallest error of an interpolation \[rad\]: attitudes near one have rounding errors of 1e-15 rad.
const SMALLEST_ERROR: f64 = 1e-13;

/// Times that are put between two records at most, one half of the interval after the other.
const HALVINGS: usize = 40;

/// Characters of a path that SPICE opens.
const LONGEST_PATH: usize = 255;

/// Ticks of a clock at times \[s of TDB past J2000\].
pub type Ticks<'a> = dyn FnMut(&[f64]) -> io::Result<Vec<f64>> + Send + 'a;
/// Called with the number of windows done and of all; `Break` stops the writer.
pub type Progress<'a> = dyn FnMut(usize, usize) -> ControlFlow<()> + Send + 'a;

/// The options of a writer.
pub struct KernelOptions<'a> {
    /// Time 0 of the motion \[s of TDB past J2000\].
    pub zero: f64,
    /// Largest error of SPICE's interpolation \[rad\]. It may not be below 1e-13.
    pub interpolation_error: f64,
    /// Whether existing files are replaced.
    pub force: bool,
    /// Lines of the comment area, after those that the writer puts there.
    pub comments: Vec<String>,
    /// The ticks of the clock that the kernel names; `None` for the clock of `andoyer_kernels`.
    pub ticks: Option<Box<Ticks<'a>>>,
    /// Called after each window.
    pub progress: Box<Progress<'a>>,
}

impl std::fmt::Debug for KernelOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut fields = f.debug_struct("KernelOptions");
        fields.field("zero", &self.zero).field("interpolation_error", &self.interpolation_error);
        fields.field("force", &self.force).field("comments", &self.comments).finish_non_exhaustive()
    }
}

impl Default for KernelOptions<'_> {
    fn default() -> Self {
        let progress = Box::new(|_, _| ControlFlow::Continue(()));
        Self { zero: 0.0, interpolation_error: 1e-8, force: true, comments: Vec::new(), ticks: None, progress }
    }
}

/// The result of a writer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Written {
    /// Type of the segments.
    pub kind: u8,
    /// Records of all segments.
    pub records: usize,
    /// Largest error of the attitude that SPICE computes at a time, against the motion at that time \[rad\]: interpolation and rounding of the times.
    pub error: f64,
}

/// The errors of a writer.
#[derive(Debug)]
#[non_exhaustive]
pub enum WriteError {
    /// An error of the motion: a time that it does not reach.
    Motion(Error),
    /// A name, a code, an interval or an error that a kernel cannot have.
    Refused(Refused),
    /// An error of the system at a file: a full disk, a folder that cannot be written, an existing file.
    System(io::Error, PathBuf),
    /// The progress callback stopped the writer.
    Stopped,
}

impl std::fmt::Display for WriteError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Motion(error) => error.fmt(f),
            Self::Refused(refused) => refused.fmt(f),
            Self::System(error, path) => write!(f, "{}: {error}", path.display()),
            Self::Stopped => f.write_str("stopped by the progress callback"),
        }
    }
}

impl std::error::Error for WriteError {}

impl From<Error> for WriteError {
    fn from(error: Error) -> Self {
        Self::Motion(error)
    }
}

impl From<Refused> for WriteError {
    fn from(refused: Refused) -> Self {
        Self::Refused(refused)
    }
}

impl From<io::Error> for WriteError {
    fn from(error: io::Error) -> Self {
        Self::System(error, PathBuf::new())
    }
}

impl KernelOptions<'_> {
    /// Checks the interval \[time of the motion\] and the error; the ends of the interval \[s of TDB past J2000\].
    pub(super) fn times(&self, [begin, end]: [f64; 2]) -> Result<[f64; 2], WriteError> {
        let ends = [self.zero + begin, self.zero + end];
        if !(ends[0].is_finite() && ends[1].is_finite() && begin < end && ends[0] < ends[1]) {
            let allowed = "two finite times, the first below the second, that differ in seconds past J2000 too";
            return Err(Refused::new("interval", format!("({begin:?}, {end:?})"), allowed).into());
        }
        let error = self.interpolation_error;
        if !(SMALLEST_ERROR..f64::INFINITY).contains(&error) {
            let allowed = format!("finite and at least {SMALLEST_ERROR:e} rad");
            return Err(Refused::new("interpolation_error", format!("{error:?}"), allowed).into());
        }
        Ok(ends)
    }

    /// Checks the number of records that the error needs.
    pub(super) fn limited(&self, records: f64, most: f64) -> Result<(), Refused> {
        if records <= most {
            return Ok(());
        }
        let value = format!(
            "{:e} rad, which needs about {} records over this interval",
            self.interpolation_error,
            Short(records.round())
        );
        let allowed = format!("so large that at most {most:.0} records are needed; or shorten the interval");
        Err(Refused::new("interpolation_error", value, allowed))
    }

    /// The ends of the interval, rounded outwards to times that the clock holds.
    pub(super) fn ends(&self, interval: [f64; 2]) -> Result<[f64; 2], WriteError> {
        let [begin, end] = interval;
        let times = self.times(interval)?;
        let ends = [self.rounded(times[0], true, false), self.rounded(times[1], false, true)];
        let outside = ends[0] < clock::FIRST || ends[1] > clock::LAST;
        if self.ticks.is_none() && outside {
            let value = format!("({begin:?}, {end:?}) s after {} s of TDB past J2000", self.zero);
            let allowed = format!(
                "from {:.3e} to {:.3e} s of TDB past J2000, the times of the clock; give a clock kernel for others",
                clock::FIRST,
                clock::LAST
            );
            return Err(Refused::new("interval", value, allowed).into());
        }
        Ok(ends)
    }

    /// A time that the clock holds: the last one up to `time` if an interval begins there, the first one from `time` on if it ends there, otherwise the nearest one.
    pub(super) fn rounded(&self, time: f64, begins: bool, ends: bool) -> f64 {
        match self.ticks {
            None if begins => clock::around(time)[0],
            None if ends => clock::around(time)[1],
            _ => self.held(time),
        }
    }

    /// The nearest time that the clock holds.
    pub(super) fn held(&self, time: f64) -> f64 {
        if self.ticks.is_none() { clock::held(time) } else { time }
    }

    /// Ticks of the times, which must increase; `argument` needs them.
    pub(super) fn ticks(&mut self, times: &[f64], argument: &'static str) -> Result<Vec<f64>, WriteError> {
        let ticks = match &mut self.ticks {
            None => times.iter().map(|&time| clock::ticks(time)).collect(),
            Some(ticks) => ticks(times)?,
        };
        if ticks.is_sorted_by(|one, next| one < next) {
            return Ok(ticks);
        }
        if let Some(jump) = jump(times, &ticks) {
            let allowed = "on one side of the jump of the clock: write a kernel for each side";
            return Err(Refused::new("interval", jump, allowed).into());
        }
        let apart = ticks[ticks.len() - 1] * f64::EPSILON;
        let value = format!("records less than {apart:.2e} ticks apart");
        Err(Refused::new(argument, value, "so chosen that the clock tells the records apart").into())
    }

    /// Ticks of the times of records. SPICE interpolates in ticks: where the rate of a user's clock changes within an interval by more than a tenth of the error at a rate
    /// \[rad/s\], times are put between.
    pub(super) fn ticks_between(&mut self, times: &mut Vec<f64>, rate: f64) -> Result<Vec<f64>, WriteError> {
        let mut ticks = self.ticks(times, "interpolation_error")?;
        if self.ticks.is_none() {
            return Ok(ticks);
        }
        for _ in 0..HALVINGS {
            let middles: Vec<f64> = times.windows(2).map(|pair| pair[0] + 0.5 * (pair[1] - pair[0])).collect();
            let found = self.ticks(&middles, "interpolation_error")?;
            let bent = |place: usize| {
                let (first, last) = (ticks[place], ticks[place + 1]);
                let away = (found[place] - first - 0.5 * (last - first)).abs();
                let angle = rate * away * (times[place + 1] - times[place]) / (last - first);
                angle > 0.1 * self.interpolation_error && away > 4.0 * f64::EPSILON * last.abs()
            };
            let added: Vec<f64> = (0..middles.len()).filter(|&place| bent(place)).map(|place| middles[place]).collect();
            if added.is_empty() {
                break;
            }
            times.extend(added);
            times.sort_by(f64::total_cmp);
            ticks = self.ticks(times, "interpolation_error")?;
        }
        Ok(ticks)
    }

    /// The times from one end to the other in parts on whose borders the rate of the clock changes.
    pub(super) fn parts(&self, [begin, end]: [f64; 2]) -> Vec<[f64; 2]> {
        let borders = clock::PIECES
            .iter()
            .map(|piece| piece.1)
            .filter(|&border| self.ticks.is_none() && begin < border && border < end);
        let times: Vec<f64> = [begin].into_iter().chain(borders).chain([end]).collect();
        times.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// The angle \[rad\] that the rounding of a time costs at a rate. `of_ticks`: the largest tick of a user's clock, in seconds.
    pub(super) fn rounding(&self, [begin, end]: [f64; 2], rate: f64, of_ticks: f64) -> f64 {
        let of_ticks = if self.ticks.is_some() { of_ticks } else { 0.0 };
        rate * (clock::rounding(begin).max(clock::rounding(end)) + f64::EPSILON * of_ticks)
    }

    /// Calls the progress callback.
    pub(super) fn report(&mut self, done: usize, of: usize) -> Result<(), WriteError> {
        match (self.progress)(done, of) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(WriteError::Stopped),
        }
    }

    /// The lines of the comment area.
    pub(super) fn comments(&self, kernel: &Kernel, about: Option<&Motion>, error: f64) -> Vec<String> {
        let name = about
            .and_then(|motion| motion.scene().asked_name().or(motion.scene().body().name()))
            .unwrap_or("a rigid body");
        let mut lines = vec![
            format!("Attitude of {name}, written by andoyer {}.", env!("CARGO_PKG_VERSION")),
            String::new(),
            format!(
                "Frame {} (class ID {}) against {}; centre {}.",
                kernel.body_frame(),
                kernel.code(),
                kernel.frame(),
                kernel.center()
            ),
            format!("Time 0 is {:?} s of TDB past J2000.", self.zero),
        ];
        if kernel.frame() == "ICRF" {
            lines.push("ICRF is taken for J2000, from which it differs by 0.02 arcseconds.".to_owned());
        }
        if let Some(motion) = about {
            lines.push(format!(
                "Error bound of the motion: {:.2e} rad; of SPICE's interpolation: {error:e} rad.",
                motion.plan().error_bound()
            ));
            lines.extend(motion.plan().missed_tolerance());
        } else {
            lines.push(format!("Estimated error of SPICE's interpolation between the samples: {error:.2e} rad."));
        }
        lines.extend(self.comments.iter().cloned());
        if let Some(motion) = about {
            lines.extend([String::new(), "The scene:".to_owned(), String::new()]);
            lines.extend(motion.scene().to_toml().lines().map(str::to_owned));
        }
        lines
    }
}

/// Writes a binary kernel and the text kernel beside it. Both have temporary names until the binary one is complete; then the text kernel is renamed, and the binary one after it.
pub(super) fn beside<T>(
    path: &Path,
    ending: &str,
    text: &str,
    force: bool,
    write: impl FnOnce(&mut std::fs::File) -> Result<T, WriteError>,
) -> Result<T, WriteError> {
    let length = path.as_os_str().len();
    if length > LONGEST_PATH {
        return Err(Refused::new(
            "path",
            format!("{length} characters"),
            format!("at most {LONGEST_PATH} characters for SPICE"),
        )
        .into());
    }
    let text_path = path.with_extension(ending);
    if text_path == path {
        return Err(Refused::new(
            "path",
            format!("{path:?}"),
            format!("without the ending .{ending}, which the text kernel beside it has"),
        )
        .into());
    }
    let named = |path: &Path| {
        let path = path.to_owned();
        move |error: io::Error| WriteError::System(error, path.clone())
    };
    andoyer_kernels::whole(path, force, named(path), |binary| {
        andoyer_kernels::whole(&text_path, force, named(&text_path), |beside| {
            io::Write::write_all(beside, text.as_bytes()).map_err(named(&text_path))?;
            write(binary)
        })
    })
}

/// Where the count of a clock leaps, forward or back: two neighbouring times whose ticks differ from those of its mean rate by more than half of them and more than rounding.
fn jump(times: &[f64], ticks: &[f64]) -> Option<String> {
    let last = times.len() - 1;
    let rate = (ticks[last] - ticks[0]) / (times[last] - times[0]);
    let rounding = 64.0 * f64::EPSILON * ticks[0].abs().max(ticks[last].abs());
    let off = |place: usize| {
        let expected = rate * (times[place + 1] - times[place]);
        let away = ticks[place + 1] - ticks[place] - expected;
        (away.abs() > 0.5 * expected.abs() + rounding).then_some((place, away))
    };
    let (place, away) = (0..last).filter_map(off).max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()))?;
    let (before, after) = (times[place], times[place + 1]);
    Some(format!(
        "an interval in which the clock jumps by {} ticks, from {before:?} to {after:?} s of TDB past J2000",
        Short::rounded(away, 6)
    ))
}
