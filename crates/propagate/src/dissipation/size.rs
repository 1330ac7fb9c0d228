//! The semi-axes of a homogeneous ellipsoid from its moments and its size.

use super::material::{positive, refused};
use crate::error::Error;
use crate::input::body::Body;

/// Least ratio of the semi-axes. Rounding of A + B − C, from which the shortest follows, is then 1e-10 of it.
const FLATTEST: f64 = 1e-3;
/// Relative difference of semi-axes from those that the moments have.
const SAME_SHAPE: f64 = 1e-6;

/// The size of a homogeneous ellipsoid whose moments are known up to a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// The radius of the sphere of the same volume, (R1 R2 R3)^(1/3).
    Radius(f64),
    /// The semi-axes along body axes 1, 2, 3 (for a body from a tensor along its principal axes, in the order of [`Body::moments`]).
    SemiAxes([f64; 3]),
}

/// The semi-axes over the radius of the homogeneous ellipsoid with the moments of a body.
pub(super) fn shape(body: &Body) -> Result<[f64; 3], Error> {
    let moments = body.moments();
    let largest = body.sorted()[2];
    // R1² ~ B + C − A
    let squares: [f64; 3] = std::array::from_fn(|axis| {
        let [own, second, third] = [0, 1, 2].map(|step| moments[(axis + step) % 3] / largest);
        // The difference of near moments is exact.
        if second > third { (second - own) + third } else { (third - own) + second }
    });
    let axes = squares.map(|square| square.max(0.0).sqrt());
    let unit = axes.iter().product::<f64>().cbrt();
    let [least, most] = [f64::min, f64::max].map(|pick| axes.iter().copied().reduce(pick).unwrap_or(0.0));
    if least < FLATTEST * most { Err(flat(axes)) } else { Ok(axes.map(|axis| axis / unit)) }
}

pub(super) fn flat(axes: [f64; 3]) -> Error {
    let [least, most] = [f64::min, f64::max].map(|pick| axes.iter().copied().reduce(pick).unwrap_or(0.0));
    let bound = "the ratio of the shortest to the longest semi-axis of the homogeneous ellipsoid with these moments, at least 0.001";
    refused("body", least / most, bound)
}

/// The radius and the semi-axes over it, if they have the ratios that the moments need.
pub(super) fn given(axes: [f64; 3], shape: [f64; 3]) -> Result<(f64, [f64; 3]), Error> {
    axes.iter().try_for_each(|axis| positive("semi_axes", *axis))?;
    let radius = axes.iter().map(|axis| axis.cbrt()).product::<f64>();
    let scaled = axes.map(|axis| axis / radius);
    for (axis, (given, needed)) in axes.iter().zip(scaled.iter().zip(shape)) {
        if (given - needed).abs() > SAME_SHAPE * needed {
            let needed = shape.map(|axis| axis * radius);
            let bound = format!(
                "within 1e-6 of those of the homogeneous ellipsoid with the moments of the body and this volume, {needed:?}"
            );
            return Err(refused("semi_axes", *axis, &bound));
        }
    }
    Ok((radius, scaled))
}
