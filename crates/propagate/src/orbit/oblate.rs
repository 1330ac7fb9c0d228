//! The orbit about an oblate primary, with the secular rates of its J2.

use super::elements::{Orbit, POSITIVE, check, finite};
use crate::error::Error;

const ELLIPSE: &str = "0 or more and less than 1";

/// An oblate primary body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oblateness {
    /// G × the mass of the primary [length³/time²].
    pub gm: f64,
    /// J2 for the reference radius.
    pub j2: f64,
    /// The reference radius of J2 \[length\].
    pub radius: f64,
}

impl Orbit {
    /// The orbit about an oblate primary from its mean elements, with its secular rates of first order in J2 (Kaula, Theory of Satellite Geodesy, 1966, chapter
    /// 3). The rotating body is the satellite and the primary is the disturbing body.
    ///
    /// Let n0² = GM/a³, p = a(1 − e²) and k = (3/2) n0 J2 (R/p)². The node rate is −k cos i, the pericentre rate k (2 − (5/2) sin² i), and the mean motion n0 +
    /// k √(1 − e²) (1 − (3/2) sin² i), which is the rate of the mean anomaly. The attraction is GM/a³. All elements are mean ones.
    /// Periodic terms, of relative size J2 (R/p)², are omitted. Osculating elements differ from the mean ones by these terms; given instead of the mean ones they
    /// change the mean motion: on circles 500 km above the Earth the satellite is then 9 to 80 km off after an hour.
    ///
    /// ```
    /// use andoyer_propagate::Orbit;
    /// use andoyer_propagate::disturbers::Oblateness;
    /// let earth = Oblateness { gm: 3.986004415e14, j2: 1.08262668e-3, radius: 6378136.3 };
    /// let orbit = Orbit::around_oblate(&earth, 6878136.3, 0.001, 51.6_f64.to_radians())?;
    /// let per_day = orbit.rates()[0].to_degrees() * 86400.0;
    /// assert!((per_day + 4.75).abs() < 0.01);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Orbit`] for a gm, a semi-major axis or a radius of 0, a J2 of NaN, an eccentricity of 1, a pericentre inside the primary, or rates that make the mean motion 0 or negative.
    pub fn around_oblate(
        primary: &Oblateness,
        semi_major_axis: f64,
        eccentricity: f64,
        inclination: f64,
    ) -> Result<Self, Error> {
        let Oblateness { gm, j2, radius } = *primary;
        let positive = |argument, value: f64| check(argument, value, value > 0.0 && value.is_finite(), POSITIVE);
        positive("gm", gm)?;
        positive("semi_major_axis", semi_major_axis)?;
        positive("radius", radius)?;
        finite("j2", j2)?;
        finite("inclination", inclination)?;
        check("eccentricity", eccentricity, (0.0..1.0).contains(&eccentricity), ELLIPSE)?;
        let outside = "such that the pericentre, semi_major_axis (1 - eccentricity), is not inside the primary's radius, in one unit of length";
        check("semi_major_axis", semi_major_axis, semi_major_axis * (1.0 - eccentricity) >= radius, outside)?;
        let attraction = gm / semi_major_axis / semi_major_axis / semi_major_axis;
        positive("attraction", attraction)?;
        let mean_motion = attraction.sqrt();
        let square = (1.0 - eccentricity) * (1.0 + eccentricity);
        let shape = radius / (semi_major_axis * square);
        let k = 1.5 * mean_motion * j2 * shape * shape;
        let (sine, cosine) = inclination.sin_cos();
        let anomaly = mean_motion + k * square.sqrt() * (1.0 - 1.5 * sine * sine);
        Self::new(anomaly, eccentricity)?
            .plane(inclination, 0.0, 0.0)?
            .secular_rates(-k * cosine, k * (2.0 - 2.5 * sine * sine))?
            .attraction(attraction)?
            .semi_major_axis(semi_major_axis)
    }
}
