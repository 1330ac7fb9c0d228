//! The level that the theory chooses by itself: first order where it meets the tolerance, else second order where its error estimate is smaller.

use std::f64::consts::PI;

use nalgebra::UnitQuaternion;

use crate::error::Error;
use crate::gravity_gradient::disturbed::DisturbedMotion;
use crate::gravity_gradient::draft::Outset;
use crate::gravity_gradient::request::Request;
use crate::input::options::Level;
use crate::torque_free::polhode::Polhode;

/// The motion under a gravity gradient at the level that is asked for, and why it is not of second order if that was left open.
///
/// # Errors
/// Errors of [`Outset::new`], [`Outset::draft`] and [`DisturbedMotion::new`]. With [`Level::Auto`] only those of the first-order draft; an error of second order is
/// returned as the reason.
pub(crate) fn chosen(
    polhode: &Polhode,
    attitude: UnitQuaternion<f64>,
    osculating: (f64, [f64; 2]),
    request: &Request<'_>,
) -> Result<(DisturbedMotion, Option<String>), Error> {
    let outset = Outset::new(polhode, attitude, osculating, request)?;
    if request.level != Level::Auto {
        return Ok((DisturbedMotion::new(&outset, outset.draft(request.level)?)?, None));
    }
    let first = outset.draft(Level::Full)?;
    let reason = if first.error <= request.tolerance {
        "first order meets the tolerance".to_owned()
    } else if !request.is_fixed() {
        "several disturbing bodies, and orbits that precess, are of first order".to_owned()
    } else {
        match outset.draft(Level::SecondOrder) {
            Ok(second) if second.error < first.error => match DisturbedMotion::new(&outset, second) {
                Ok(second) => return Ok((second, None)),
                Err(error) => error.to_string(),
            },
            Ok(second) if second.error >= PI => "its error bound is half a turn or more".to_owned(),
            Ok(second) => format!("its error bound, {:.1e} rad, is no smaller", second.error),
            Err(error) => error.to_string(),
        }
    };
    Ok((DisturbedMotion::new(&outset, first)?, Some(format!("second order: {reason}"))))
}
