//! Segments: C-kernels of type 2 and 3, binary PCK of type 2. Source: CK Required Reading, PCK Required Reading.

use std::io::{self, Seek, Write};

use crate::daf::Daf;
use crate::kernel::Kernel;

/// One time in a directory for as many times.
pub(crate) const DIRECTORY: usize = 100;

/// The head of a segment: the code of the frame that is described, the code of the inertial frame that it is described in, the name of the segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// Class ID of the body's frame.
    pub code: i32,
    /// Code of the inertial frame ([`crate::frames::find`]).
    pub frame: i32,
    /// Name of the segment, up to 40 characters of printable ASCII.
    pub name: String,
}

impl Head {
    /// The head of all segments of a kernel.
    pub fn of(kernel: &Kernel) -> Self {
        Self { code: kernel.code(), frame: kernel.frame_code(), name: kernel.segment().to_owned() }
    }
}

impl<W: Write + Seek> Daf<W> {
    /// A segment of type 3: uniform rotation from each record to the next.
    ///
    /// `ticks`: increasing, one or more. `attitudes`: unit quaternions \[x, y, z, w\] that rotate components of the body's axes into inertial ones. `rates`: angular velocities
    /// in inertial components \[rad/s\]. `starts`: those of the ticks that begin an interval of interpolation; the first of the ticks is the first of them.
    ///
    /// # Errors
    /// Those of the stream; [`io::ErrorKind::InvalidInput`] for lists of different lengths or ticks that do not increase.
    pub fn ck3(
        &mut self,
        head: &Head,
        ticks: &[f64],
        attitudes: &[[f64; 4]],
        rates: Option<&[[f64; 3]]>,
        starts: &[f64],
    ) -> io::Result<()> {
        let lengths = attitudes.len() == ticks.len() && rates.is_none_or(|rates| rates.len() == ticks.len());
        if !(lengths && increasing(ticks) && increasing(starts)) || ticks.first() != starts.first() {
            return Err(io::ErrorKind::InvalidInput.into());
        }
        let pointing: Vec<f64> = match rates {
            None => attitudes.iter().flat_map(spice_quaternion).collect(),
            Some(rates) => {
                attitudes.iter().zip(rates).flat_map(|(q, rate)| spice_quaternion(q).into_iter().chain(*rate)).collect()
            }
        };
        let integers = [head.code, head.frame, 3, i32::from(rates.is_some())];
        let counts = [starts.len() as f64, ticks.len() as f64];
        let parts = [&pointing, ticks, &directory(ticks), starts, &directory(starts), &counts];
        self.array(&head.name, [ticks[0], ticks[ticks.len() - 1]], &integers, &parts)
    }

    /// A segment of type 2: from each tick to the next a rotation with the angular velocity of the record, in inertial components \[rad/s\]. `ticks` has one entry more than
    /// the records, and `seconds` has the seconds a tick of each record.
    ///
    /// # Errors
    /// As for [`ck3`](Self::ck3).
    pub fn ck2(
        &mut self,
        head: &Head,
        ticks: &[f64],
        attitudes: &[[f64; 4]],
        rates: &[[f64; 3]],
        seconds: &[f64],
    ) -> io::Result<()> {
        let count = seconds.len();
        if count == 0 || [attitudes.len(), rates.len(), ticks.len().wrapping_sub(1)] != [count; 3] || !increasing(ticks)
        {
            return Err(io::ErrorKind::InvalidInput.into());
        }
        let records: Vec<f64> = (attitudes.iter().zip(rates).zip(seconds))
            .flat_map(|((q, rate), &seconds)| spice_quaternion(q).into_iter().chain(*rate).chain([seconds]))
            .collect();
        let parts = [&records, &ticks[..count], &ticks[1..], &directory(&ticks[..count])];
        self.array(&head.name, [ticks[0], ticks[count]], &[head.code, head.frame, 2, 1], &parts)
    }

    /// A segment of a binary PCK of type 2: Chebyshev polynomials of the angles φ, δ, W, with the matrix \[W\]₃ \[δ\]₁ \[φ\]₃ from the inertial frame to the body's axes.
    ///
    /// The intervals have the length `length` \[s\]; the first begins at `start`, and the last ends at `end` \[s of TDB past J2000\]. `coefficients` has for each interval those of φ, of δ and of W,
    /// `degree + 1` each.
    ///
    /// # Errors
    /// As for [`ck3`](Self::ck3).
    pub fn pck2(
        &mut self,
        head: &Head,
        [start, end]: [f64; 2],
        length: f64,
        degree: usize,
        coefficients: &[f64],
    ) -> io::Result<()> {
        let each = 3 * (degree + 1);
        let count = coefficients.len() / each;
        if count == 0 || coefficients.len() != each * count {
            return Err(io::ErrorKind::InvalidInput.into());
        }
        let middle = |interval: usize| start + (interval as f64 + 0.5) * length;
        let records: Vec<f64> = (coefficients.chunks(each).enumerate())
            .flat_map(|(interval, part)| [middle(interval), 0.5 * length].into_iter().chain(part.iter().copied()))
            .collect();
        let last = [start, length, (each + 2) as f64, count as f64];
        self.array(&head.name, [start, end], &[head.code, head.frame, 2], &[&records, &last])
    }
}

/// SPICE's quaternion of the matrix from inertial components to those of the body's axes, scalar first.
fn spice_quaternion([x, y, z, w]: &[f64; 4]) -> [f64; 4] {
    [*w, -x, -y, -z]
}

fn increasing(times: &[f64]) -> bool {
    !times.is_empty() && times.is_sorted_by(|one, next| one < next)
}

/// Every hundredth of the times, but for the last time.
fn directory(times: &[f64]) -> Vec<f64> {
    times[..times.len() - 1].iter().skip(DIRECTORY - 1).step_by(DIRECTORY).copied().collect()
}
