//! Torques of a magnetic field: m × B of a dipole, and eddy currents.

use super::torque::{Torque, parsed};
use super::torque_source::{SourcePath, TorqueSource};
use crate::error::{Error, torque_refused};

/// The components of the unit vector along a field.
const FIELD: [&str; 3] = ["b1", "b2", "b3"];

impl Torque {
    /// m × B of a magnetic moment [unit of the torque over that of the field] in a field: [`SourcePath::Field`], a table of its vectors, or a vector, which is a uniform field.
    ///
    /// # Errors
    /// - [`Error::Torque`] for NaN or an infinity.
    pub fn dipole(moment: [f64; 3], field: SourcePath) -> Result<Self, Error> {
        match moment.iter().find(|part| !part.is_finite()) {
            Some(part) => Err(torque_refused("moment", part, "finite")),
            None => Self::steered_dipole(moment.map(|part| format!("{part:?}")).each_ref().map(String::as_str), field),
        }
    }

    /// m × B of a moment that is commanded: three polynomials in the rates w1, w2, w3 and in the components b1, b2, b3 of the unit vector along the field.
    ///
    /// # Errors
    /// As [`Torque::polynomial`].
    pub fn steered_dipole(moment: [&str; 3], field: SourcePath) -> Result<Self, Error> {
        let names = ["b1", "b2", "b3", "w1", "w2", "w3"].map(str::to_owned);
        for text in moment {
            parsed(text, &names)?;
        }
        Self::of_field(cross(moment.map(str::to_owned), FIELD.map(str::to_owned)), field, 1.0)
    }

    /// (K(ω × B)) × B of eddy currents in a body with the magnetic tensor K [moment × rate/field²] (N. Ortiz Gómez and S. J. I. Walker 2015): it brakes the rotation across the field. ω is
    /// relative to inertial space, so the field must turn slowly against the body.
    ///
    /// # Errors
    /// - [`Error::Torque`] for NaN or an infinity.
    pub fn eddy(tensor: [[f64; 3]; 3], field: SourcePath) -> Result<Self, Error> {
        if let Some(part) = tensor.as_flattened().iter().find(|part| !part.is_finite()) {
            return Err(torque_refused("conductivity", part, "finite"));
        }
        let induced = cross(["w1", "w2", "w3"].map(str::to_owned), FIELD.map(str::to_owned));
        let moment = tensor.map(|row| {
            let parts = row.iter().zip(&induced).filter(|(factor, _)| **factor != 0.0);
            let parts: Vec<String> = parts.map(|(factor, part)| format!("({factor:?})*({part})")).collect();
            if parts.is_empty() { "0".to_owned() } else { parts.join(" + ") }
        });
        Self::of_field(cross(moment, FIELD.map(str::to_owned)), field, 2.0)
    }

    /// Polynomials in the direction of a field, times a power of its size.
    fn of_field(texts: [String; 3], field: SourcePath, power: f64) -> Result<Self, Error> {
        let (texts, power) = match field {
            // A uniform field has its size in the texts.
            SourcePath::Direction([x, y, z]) => {
                let size = x.hypot(y).hypot(z).powf(power);
                if !size.is_finite() {
                    return Err(torque_refused(
                        "field",
                        format!("{:?}", [x, y, z]),
                        "finite, with a square that is a double",
                    ));
                }
                (texts.map(|text| format!("({size:?})*({text})")), 0.0)
            }
            _ => (texts, -power),
        };
        let source = TorqueSource::new("b", field).falling(power, 1.0);
        Self::polynomial(texts.each_ref().map(String::as_str), vec![source])
    }
}

/// The texts of a cross product.
fn cross(one: [String; 3], other: [String; 3]) -> [String; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, k)| format!("({})*({}) - ({})*({})", one[i], other[k], one[k], other[i]))
}
