//! Attitudes from binary PCK files.

use std::path::Path;

use crate::daf::PCK;
use crate::read::daf::Source;
use crate::read::error::{ReadError, finite};
use crate::read::files::Files;
use crate::read::segment::{Segment, Stored, turned};

/// Orientations of bodies from binary PCK files with segments of type 2, of either byte order.
///
/// A body is named by the class ID of its frame: 3000 for ITRF93, 31006 for MOON_PA_DE421. Any number of threads may ask at the same time.
#[derive(Debug)]
pub struct Orientations(Files);

impl Orientations {
    /// Opens files. Where segments overlap, the last segment of the last file wins, as in CSPICE.
    ///
    /// # Errors
    /// As for [`crate::Ephemeris::open`].
    pub fn open<P: AsRef<Path>>(paths: &[P]) -> Result<Self, ReadError> {
        Files::open(paths, PCK).map(Self)
    }

    /// Adds an open file, or bytes in a [`std::io::Cursor`]. The name is for messages.
    ///
    /// # Errors
    /// As for [`crate::Ephemeris::open`].
    pub fn load(&mut self, name: &str, source: impl Source + 'static) -> Result<(), ReadError> {
        self.0.load(name, Box::new(source))
    }

    /// The segments in the order of loading.
    pub fn segments(&self) -> impl Iterator<Item = &Segment> {
        self.0.segments()
    }

    /// The intervals for which there are data of a body \[s of TDB past J2000\], in order. Intervals that touch are one.
    pub fn coverage(&self, body: i32) -> Vec<(f64, f64)> {
        self.0.coverage(body)
    }

    /// Reads the data of a body for a span \[s of TDB past J2000\] at once and keeps them, for many times in any order. The first time outside the span drops them.
    ///
    /// # Errors
    /// As for [`Self::angles`], but for times that are not covered.
    pub fn keep(&self, body: i32, span: (f64, f64)) -> Result<(), ReadError> {
        self.0.keep(body, span)
    }

    /// The angles φ, δ, W \[rad\] and their rates \[rad/s\]. The matrix \[W\]₃ \[δ\]₁ \[φ\]₃ goes from the inertial frame of the segment to the body's axes.
    ///
    /// # Errors
    /// As for [`crate::Ephemeris::state`].
    pub fn angles(&self, body: i32, et: f64) -> Result<([f64; 3], [f64; 3]), ReadError> {
        let [angles, rates] = self.0.at(self.find(body, et)?, et)?;
        Ok((angles, rates))
    }

    /// The attitude, a unit quaternion \[x, y, z, w\] that rotates components of the body's axes into those of J2000, and the angular velocity in J2000 \[rad/s\].
    ///
    /// q = q₃(φ) q₁(δ) q₃(W), ω = φ̇ e₃ + δ̇ n + Ẇ b with the node n = (cos φ, sin φ, 0) and the body's third axis b = (sin δ sin φ, −sin δ cos φ, cos δ).
    ///
    /// # Errors
    /// As for [`crate::Ephemeris::state`].
    pub fn attitude(&self, body: i32, et: f64) -> Result<([f64; 4], [f64; 3]), ReadError> {
        let stored = self.find(body, et)?;
        let [[phi, delta, turn], [phi_rate, delta_rate, turn_rate]] = self.0.at(stored, et)?;
        // No sum of φ and W, which would round W a second time: it grows with the time.
        let [(sin_phi, cos_phi), (sine, cosine), (sin_turn, cos_turn)] =
            [phi, delta, turn].map(|angle| (0.5 * angle).sin_cos());
        let attitude = [
            sine * (cos_phi * cos_turn + sin_phi * sin_turn),
            sine * (sin_phi * cos_turn - cos_phi * sin_turn),
            cosine * (sin_phi * cos_turn + cos_phi * sin_turn),
            cosine * (cos_phi * cos_turn - sin_phi * sin_turn),
        ];
        let ((node_y, node_x), (tilt, axis)) = (phi.sin_cos(), delta.sin_cos());
        let rate = [
            delta_rate * node_x + turn_rate * tilt * node_y,
            delta_rate * node_y - turn_rate * tilt * node_x,
            phi_rate + turn_rate * axis,
        ];
        Ok(match &stored.turn {
            None => (attitude, rate),
            Some(matrix) => (product(quaternion(matrix), attitude), turned(matrix, rate)),
        })
    }

    fn find(&self, body: i32, et: f64) -> Result<&Stored, ReadError> {
        finite(et)?;
        self.0.find(body, et).ok_or_else(|| {
            let gaps = vec![self.0.gap(body, et)];
            ReadError::NotCovered { target: body, observer: None, et, gaps }
        })
    }
}

/// The quaternion of a rotation matrix, from its largest component: 4 qᵢ² = 1 ± m₁₁ ± m₂₂ ± m₃₃.
fn quaternion(m: &[[f64; 3]; 3]) -> [f64; 4] {
    let trace = m[0][0] + m[1][1] + m[2][2];
    let squares: [f64; 4] = std::array::from_fn(|k| if k == 3 { 1.0 + trace } else { 1.0 + 2.0 * m[k][k] - trace });
    let largest = (0..4).fold(3, |best, k| if squares[k] > squares[best] { k } else { best });
    let [i, j, k] = [largest % 3, (largest + 1) % 3, (largest + 2) % 3];
    let mut q = [0.0; 4];
    q[largest] = squares[largest];
    if largest == 3 {
        q[..3].copy_from_slice(&[m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]]);
    } else {
        (q[j], q[k], q[3]) = (m[j][i] + m[i][j], m[k][i] + m[i][k], m[k][j] - m[j][k]);
    }
    let norm = q.iter().map(|part| part * part).sum::<f64>().sqrt();
    q.map(|part| part / norm)
}

/// The Hamilton product.
fn product([a, b, c, d]: [f64; 4], [x, y, z, w]: [f64; 4]) -> [f64; 4] {
    [
        d * x + a * w + b * z - c * y,
        d * y - a * z + b * w + c * x,
        d * z + a * y - b * x + c * w,
        d * w - a * x - b * y - c * z,
    ]
}
