//! Names and codes that SPICE keeps for itself: inertial frames with their rotations, and rotating frames.
//!
//! The table has the frames of toolkit N67 (Frames Required Reading, "Built-in inertial frames"); a test compares it with CSPICE.

/// An inertial frame: name, the frame that it is defined from, rotations (arcseconds, axis). The matrix from that frame is the product \[a₁\] \[a₂\] \[a₃\].
struct Inertial(&'static str, i32, &'static [(f64, usize)]);

const J2000: i32 = 1;
const B1950: i32 = 2;
const FK4: i32 = 3;

/// The inertial frames in the order of their codes, from 1.
const INERTIAL: [Inertial; 21] = [
    Inertial("J2000", J2000, &[]),
    Inertial("B1950", J2000, &[(1152.84248596724, 3), (-1002.26108439117, 2), (1153.04066200330, 3)]),
    Inertial("FK4", B1950, &[(0.525, 3)]),
    Inertial("DE-118", B1950, &[(0.53155, 3)]),
    Inertial("DE-96", B1950, &[(0.4107, 3)]),
    Inertial("DE-102", B1950, &[(0.1359, 3)]),
    Inertial("DE-108", B1950, &[(0.4775, 3)]),
    Inertial("DE-111", B1950, &[(0.5880, 3)]),
    Inertial("DE-114", B1950, &[(0.5529, 3)]),
    Inertial("DE-122", B1950, &[(0.5316, 3)]),
    Inertial("DE-125", B1950, &[(0.5754, 3)]),
    Inertial("DE-130", B1950, &[(0.5247, 3)]),
    Inertial("GALACTIC", FK4, &[(1177200.0, 3), (225360.0, 1), (1016100.0, 3)]),
    Inertial("DE-200", J2000, &[]),
    Inertial("DE-202", J2000, &[]),
    Inertial("MARSIAU", J2000, &[(324000.0, 3), (133610.4, 2), (-152348.4, 3)]),
    Inertial("ECLIPJ2000", J2000, &[(84381.448, 1)]),
    Inertial("ECLIPB1950", B1950, &[(84404.836, 1)]),
    Inertial("DE-140", J2000, &[(1152.71013777252, 3), (-1002.25042010533, 2), (1153.75719544491, 3)]),
    Inertial("DE-142", J2000, &[(1152.72061453864, 3), (-1002.25052830351, 2), (1153.74663857521, 3)]),
    Inertial("DE-143", J2000, &[(1153.03919093833, 3), (-1002.24822382286, 2), (1153.42900222357, 3)]),
];

/// Beginnings of the names of SPICE's rotating frames.
const ROTATING: [&str; 4] = ["IAU_", "ITRF93", "EARTH_FIXED", "MOON_"];

/// Codes from 1,000,000 on with which SPICE names a rotating frame of its own, by its text kernels of constants.
const CONSTANTS: [i32; 29] = [
    1_000_005,
    1_000_093,
    2_000_001,
    2_000_002,
    2_000_004,
    2_000_021,
    2_000_052,
    2_000_433,
    2_000_511,
    2_002_867,
    2_025_143,
    2_101_955,
    2_162_173,
    2_431_010,
    2_486_958,
    9_511_010,
    20_000_617,
    20_003_548,
    20_011_351,
    20_015_094,
    20_021_900,
    20_052_246,
    20_065_803,
    120_000_617,
    120_003_548,
    120_065_803,
    920_000_617,
    920_003_548,
    920_065_803,
];

/// The code and the name of an inertial frame; ICRF has the code of J2000, from which it differs by 0.02″ (Frames Required Reading, "ICRF vs. J2000").
pub fn find(name: &str) -> Option<(i32, &'static str)> {
    let place = INERTIAL.iter().position(|frame| frame.0 == name).map(|place| (place as i32 + 1, INERTIAL[place].0));
    place.or((name == "ICRF").then_some((J2000, "ICRF")))
}

/// Whether a code is that of an inertial frame.
pub fn is_inertial(code: i32) -> bool {
    (1..=INERTIAL.len() as i32).contains(&code)
}

/// Whether SPICE has a frame of this name, inertial or rotating, without any kernel.
pub fn is_taken(name: &str) -> bool {
    find(name).is_some() || ROTATING.iter().any(|start| name.starts_with(start))
}

/// Whether SPICE has a rotating frame of its own for the body with this code.
pub fn has_constants(code: i32) -> bool {
    CONSTANTS.contains(&code)
}

/// The matrix from J2000 to an inertial frame, by rows.
///
/// ```
/// use andoyer_kernels::frames::from_j2000;
/// assert!((from_j2000(17)[1][2] - (84381.448_f64 / 3600.0).to_radians().sin()).abs() < 1e-15);
/// ```
pub fn from_j2000(code: i32) -> [[f64; 3]; 3] {
    let place = usize::try_from(code.saturating_sub(1)).unwrap_or_default();
    let Some(&Inertial(_, base, rotations)) = INERTIAL.get(place).filter(|_| place > 0) else {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    };
    rotations
        .iter()
        .rev()
        .fold(from_j2000(base), |matrix, &(angle, axis)| turned(matrix, (angle / 3600.0).to_radians(), axis))
}

/// The product of the rotation of the frame by an angle about an axis (1 to 3) and a matrix.
fn turned(matrix: [[f64; 3]; 3], angle: f64, axis: usize) -> [[f64; 3]; 3] {
    let (sine, cosine) = angle.sin_cos();
    let (next, last) = (axis % 3, (axis + 1) % 3);
    let mut turned = matrix;
    for column in 0..3 {
        turned[next][column] = cosine * matrix[next][column] + sine * matrix[last][column];
        turned[last][column] = cosine * matrix[last][column] - sine * matrix[next][column];
    }
    turned
}
