//! The torque that a disturbing body exerts on a gravity field of degree 3 and 4.
//!
//! ```text
//! T = −(G m′/r³) M R² (R/r)^(n−2) u × ∇Y_n
//! ```
//!
//! with the unit vector u to the disturbing body m′ in body axes, and Y_n of [`super::gravity`].

use andoyer_series::Polynomial;

use super::gravity::{Gravity, HARMONICS};
use super::torque::Torque;
use super::torque_source::{SourcePath, TorqueSource};
use crate::error::{Error, torque_refused};
use crate::orbit::disturbing_body::DisturbingBody;

impl Gravity {
    /// The torques of degree 3 and 4 by a disturbing body.
    ///
    /// # Errors
    /// - [`Error::Torque`] for an orbit without a semi-major axis.
    pub(super) fn torques(&self, body: &DisturbingBody) -> Result<Vec<Torque>, Error> {
        // G m′/R³
        let (path, strength) = match body {
            DisturbingBody::Orbit(orbit) => {
                let Some(size) = orbit.asked_semi_major_axis() else {
                    let bound = "with semi_major_axis, in the unit of the radius of the gravity field";
                    return Err(torque_refused("orbit", "without semi_major_axis", bound));
                };
                (SourcePath::Orbit(*orbit), orbit.strength() * (size / self.radius()).powi(3))
            }
            DisturbingBody::Tabulated(table) => {
                (SourcePath::Tabulated(table.clone()), table.gm() / self.radius() / self.radius() / self.radius())
            }
        };
        let factor = -strength * self.mass_radius_squared;
        let mut torques = Vec::new();
        for degree in [3_u32, 4] {
            let Some(polynomials) = self.polynomials(degree, factor)? else { continue };
            let source = TorqueSource::new("u", path.clone()).falling(f64::from(degree) + 1.0, self.radius());
            torques.push(Torque::of_shape(&polynomials, source)?.turned(&self.turn));
        }
        Ok(torques)
    }

    /// A factor times u × ∇Y_n; `None` if all coefficients are 0.
    fn polynomials(&self, degree: u32, factor: f64) -> Result<Option<[Polynomial<f64>; 3]>, Error> {
        let names = ["x", "y", "z"];
        let parse = |text: &str| Polynomial::<f64>::parse(text, &names).map_err(Error::Series);
        let own = HARMONICS.iter().filter(|(name, _)| name[1..2] == degree.to_string());
        let given = own.filter_map(|(name, text)| Some((self.coefficient(name).filter(|value| *value != 0.0)?, text)));
        let parts: Vec<String> = given.map(|(value, text)| format!("({:?})*({text})", value * factor)).collect();
        if parts.is_empty() {
            return Ok(None);
        }
        let harmonic = parse(&parts.join(" + "))?;
        let component = |i: usize, k: usize| {
            let mut sum = Polynomial::zero();
            for (place, slope, sign) in [(i, k, 1.0), (k, i, -1.0)] {
                let slope = harmonic.derivative(slope).map_err(Error::Series)?;
                let product = parse(names[place])?.multiply(&slope).map_err(Error::Series)?;
                product.terms().for_each(|(monomial, coefficient)| sum.add_term(monomial, &(sign * coefficient)));
            }
            Ok::<_, Error>(sum)
        };
        Ok(Some([component(1, 2)?, component(2, 0)?, component(0, 1)?]))
    }
}
