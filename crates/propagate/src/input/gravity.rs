//! The gravity field of a rotating body of degree 3 and 4.
//!
//! ```text
//! U = (G M/r) Σ (R/r)^n Y_n(u),   Y_n = Σ (C_nm cos mλ + S_nm sin mλ) P_nm(sin φ)
//! ```
//!
//! with the direction u in body axes and unnormalized coefficients. Of degree 2 it is the gravity gradient, which comes from the moments.

use super::principal_axes::{Square, UNIT, product};
use crate::error::{Error, torque_refused};

/// The harmonics of degree 3 and 4: their names, and u-polynomials on the unit sphere.
pub(super) const HARMONICS: [(&str, &str); 16] = [
    ("C30", "2.5*z^3 - 1.5*z"),
    ("C31", "7.5*x*z^2 - 1.5*x"),
    ("S31", "7.5*y*z^2 - 1.5*y"),
    ("C32", "15*z*x^2 - 15*z*y^2"),
    ("S32", "30*x*y*z"),
    ("C33", "15*x^3 - 45*x*y^2"),
    ("S33", "45*x^2*y - 15*y^3"),
    ("C40", "4.375*z^4 - 3.75*z^2"),
    ("C41", "17.5*x*z^3 - 7.5*x*z"),
    ("S41", "17.5*y*z^3 - 7.5*y*z"),
    ("C42", "52.5*z^2*x^2 - 7.5*x^2 - 52.5*z^2*y^2 + 7.5*y^2"),
    ("S42", "105*x*y*z^2 - 15*x*y"),
    ("C43", "105*z*x^3 - 315*z*x*y^2"),
    ("S43", "315*z*x^2*y - 105*z*y^3"),
    ("C44", "105*x^4 - 630*x^2*y^2 + 105*y^4"),
    ("S44", "420*x^3*y - 420*x*y^3"),
];

/// Those of degree 2, which are compared with the inertia tensor.
const OF_INERTIA: [&str; 5] = ["C20", "C21", "S21", "C22", "S22"];

/// Those of JPL's DE421, from its file of constants.
const OF_THE_MOON: [(&str, f64); 18] = [
    ("C20", -2.032_732_576_370_724e-4),
    ("C22", 2.238_976_709_652_413e-5),
    ("C30", -8.404_701_525_941e-6),
    ("C31", 2.845_243_5e-5),
    ("S31", 5.900_8e-6),
    ("C32", 4.846_387_240_009_03e-6),
    ("S32", 1.684_198_474_147_6e-6),
    ("C33", 1.674_047_530_039_142e-6),
    ("S33", -2.485_526e-7),
    ("C40", 9.642_286e-6),
    ("C41", -5.692_687e-6),
    ("S41", 1.574_393e-6),
    ("C42", -1.586_2e-6),
    ("S42", -1.517_312e-6),
    ("C43", -8.120_41e-8),
    ("S43", -8.027_907e-7),
    ("C44", -1.273_941e-7),
    ("S44", 8.314_75e-8),
];

/// Those of Eros, fully normalized, about the axes of its prime meridian: solution NEAR15A (J. K. Miller et al., Icarus 155 (2002) 3; the file of the Planetary Data System).
const OF_EROS: [(&str, f64); 21] = [
    ("C20", -5.246_183_930_97e-2),
    ("C21", -1.637_912_961_16e-6),
    ("S21", -1.400_038_061_64e-7),
    ("C22", 8.239_938_798_58e-2),
    ("S22", -2.810_955_590_16e-2),
    ("C30", -1.414_465_370_45e-3),
    ("C31", 4.060_164_755_96e-3),
    ("S31", 3.368_468_993_23e-3),
    ("C32", 1.775_914_094_89e-3),
    ("S32", -7.038_031_814_78e-4),
    ("C33", -1.041_639_994_96e-2),
    ("S33", -1.207_144_048_20e-2),
    ("C40", 1.293_148_199_62e-2),
    ("C41", -1.003_509_335_84e-4),
    ("S41", 1.369_399_290_63e-4),
    ("C42", -1.746_880_183_25e-2),
    ("S42", 4.629_099_530_71e-3),
    ("C43", -3.002_011_920_46e-4),
    ("S43", -1.192_071_641_56e-4),
    ("C44", 1.745_516_689_02e-2),
    ("S44", -9.105_292_769_48e-3),
];

/// Coefficients of degree 2 that differ from those of the inertia tensor by more than this part of the largest are named.
const DIFFERENT: f64 = 1e-3;

/// The gravity field of a body of degree 3 and 4.
///
/// ```
/// use andoyer_propagate::torques::Gravity;
/// use andoyer_propagate::{Body, Method, Orbit, Scene, State};
/// // C/(M R²) = 0.393 for the Moon; radius and semi-major axis in km.
/// let field = Gravity::new(&[("C30", -8.5e-6), ("C31", 3.05e-5), ("S31", 4.1e-6)], 1738.0)?.inertia_factor(0.393)?;
/// let body = Body::new([0.999_37, 0.999_6, 1.0])?.with_gravity(field)?;
/// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 2.66e-6])?;
/// let scene = Scene::new(body, state).orbit(Orbit::new(2.66e-6, 0.0)?.semi_major_axis(384_400.0)?);
/// assert_eq!(scene.span(0.0, 1e7).tolerance(1e-9).solve()?.plan().method(), Method::Integrated);
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Gravity {
    coefficients: Vec<(String, f64)>,
    radius: f64,
    inertia_factor: Option<f64>,
    /// M R² in the unit of the moments, once a body has it.
    pub(super) mass_radius_squared: f64,
    /// The rotation from components about the axes of the scene to those of the coefficients.
    pub(super) turn: Square,
}

/// The same coefficients, radius and inertia factor about the same axes; M R² belongs to the body.
impl PartialEq for Gravity {
    fn eq(&self, other: &Self) -> bool {
        (&self.coefficients, self.radius, self.inertia_factor, &self.turn)
            == (&other.coefficients, other.radius, other.inertia_factor, &other.turn)
    }
}

/// A fully normalized coefficient with the factor that makes it an unnormalized one: √((2 − δ_0m)(2n + 1)(n − m)!/(n + m)!), n and m being the digits of its name.
fn unnormalized((name, value): (&'static str, f64)) -> (&'static str, f64) {
    let [degree, order] = [1, 2].map(|place| u32::from(name.as_bytes()[place] - b'0'));
    let factorials: f64 = (degree - order + 1..=degree + order).map(f64::from).product();
    let twice = if order == 0 { 1.0 } else { 2.0 };
    (name, value * (twice * f64::from(2 * degree + 1) / factorials).sqrt())
}

impl Gravity {
    /// Coefficients by their names, "C30" to "S44", and the reference radius in the unit of length of the orbits. Coefficients of degree 2 are compared with the moments.
    ///
    /// # Errors
    /// - [`Error::Torque`] for an unknown name or one that stands twice, a coefficient that is not finite, a radius that is not positive and finite.
    pub fn new(coefficients: &[(&str, f64)], radius: f64) -> Result<Self, Error> {
        let known = |name: &str| OF_INERTIA.contains(&name) || HARMONICS.iter().any(|(own, _)| *own == name);
        for (index, (name, value)) in coefficients.iter().enumerate() {
            if !known(name) {
                let bound = "C20, C21, S21, C22, S22, or C and S of degree 3 and 4, unnormalized";
                return Err(torque_refused("coefficients", name, bound));
            }
            if !value.is_finite() {
                return Err(torque_refused("coefficients", format!("{name}: {value}"), "finite"));
            }
            if coefficients[..index].iter().any(|(other, _)| other == name) {
                return Err(torque_refused("coefficients", format!("{name} twice"), "different names"));
            }
        }
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(torque_refused("radius", radius, "positive and finite"));
        }
        // In one order, so that equal fields are equal.
        let names = OF_INERTIA.into_iter().chain(HARMONICS.iter().map(|(name, _)| *name));
        let given = |name: &'static str| {
            coefficients.iter().find(|(own, _)| *own == name).map(|(_, value)| (name.to_owned(), value + 0.0))
        };
        let coefficients = names.filter_map(given).collect();
        Ok(Self { coefficients, radius, inertia_factor: None, mass_radius_squared: f64::NAN, turn: UNIT })
    }

    /// Sets C/(M R²) with the largest moment C. Without it C20 gives it.
    ///
    /// # Errors
    /// - [`Error::Torque`] for a factor that is not positive and finite.
    pub fn inertia_factor(self, factor: f64) -> Result<Self, Error> {
        if factor > 0.0 && factor.is_finite() {
            return Ok(Self { inertia_factor: Some(factor), ..self });
        }
        Err(torque_refused("inertia_factor", factor, "positive and finite"))
    }

    /// The field of a body by its name; radius in km. "moon": that of JPL's DE421 about its principal axes, as in the constants of that ephemeris (J_n = −C_n0). "eros": NEAR15A about the
    /// axes of the prime meridian, which are not principal: the body needs a tensor.
    ///
    /// # Errors
    /// - [`Error::Torque`] for another name.
    pub fn named(name: &str) -> Result<Self, Error> {
        match &name.to_ascii_lowercase()[..] {
            "moon" => Self::new(&OF_THE_MOON, 1738.0),
            "eros" => Self::new(&OF_EROS.map(unnormalized), 16.0),
            _ => Err(torque_refused("name", name, "\"moon\" or \"eros\"")),
        }
    }

    /// The coefficients of degree 4 of a homogeneous ellipsoid with semi-axes along body axes 1, 2, 3, with those of degree 2; the odd ones are 0.
    ///
    /// With C20 and C22: C40 = 15/7 (C20² + 2C22²), C42 = 5/7 C20 C22, C44 = 5/28 C22² (G. Balmino, Celest. Mech. Dyn. Astron. 60 (1994) 331).
    ///
    /// # Errors
    /// - [`Error::Positive`] for a semi-axis, [`Error::Torque`] for a radius, that is not positive and finite.
    pub fn ellipsoid(semi_axes: [f64; 3], radius: f64) -> Result<Self, Error> {
        for (value, argument) in semi_axes.into_iter().zip(["a", "b", "c"]) {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::Positive { argument, value });
            }
        }
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(torque_refused("radius", radius, "positive and finite"));
        }
        let [a, b, c] = semi_axes.map(|axis| axis / radius);
        let (zonal, sectoral) = ((2.0 * c * c - a * a - b * b) / 10.0, (a * a - b * b) / 20.0);
        let coefficients = [
            ("C20", zonal),
            ("C22", sectoral),
            ("C40", 15.0 / 7.0 * (zonal * zonal + 2.0 * sectoral * sectoral)),
            ("C42", 5.0 / 7.0 * zonal * sectoral),
            ("C44", 5.0 / 28.0 * sectoral * sectoral),
        ];
        let largest = [b * b + c * c, a * a + c * c, a * a + b * b].into_iter().fold(0.0, f64::max) / 5.0;
        Self::new(&coefficients, radius)?.inertia_factor(largest)
    }

    /// The coefficients by their names.
    pub fn coefficients(&self) -> &[(String, f64)] {
        &self.coefficients
    }

    /// Whether a coefficient of degree 3 or 4 is not 0.
    pub(crate) fn acts(&self) -> bool {
        HARMONICS.iter().any(|(name, _)| self.coefficient(name).is_some_and(|value| value != 0.0))
    }

    /// The reference radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// C/(M R²) as it was set.
    pub fn asked_inertia_factor(&self) -> Option<f64> {
        self.inertia_factor
    }

    pub(super) fn coefficient(&self, name: &str) -> Option<f64> {
        self.coefficients.iter().find(|(own, _)| own == name).map(|(_, value)| *value)
    }

    /// The field with M R² from the inertia tensor of its body.
    ///
    /// # Errors
    /// - [`Error::Torque`] without an inertia factor and a C20 that gives it.
    pub(super) fn of_body(self, inertia: &[[f64; 3]; 3], largest: f64) -> Result<Self, Error> {
        let oblateness = inertia[2][2] - 0.5 * (inertia[0][0] + inertia[1][1]);
        let mass_radius_squared = match (self.inertia_factor, self.coefficient("C20")) {
            (Some(factor), _) => largest / factor,
            (None, Some(zonal)) if -oblateness / zonal > 0.0 && (oblateness / zonal).is_finite() => -oblateness / zonal,
            _ => {
                let bound = "given, C/(M R²) with the largest moment C, or C20 of the sign of (I11 + I22)/2 − I33";
                return Err(torque_refused("inertia_factor", "None", bound));
            }
        };
        Ok(Self { mass_radius_squared, ..self })
    }

    /// The coefficients of degree 2 that differ from those of the inertia tensor: name, as given, of the tensor.
    pub(super) fn different(&self, inertia: &[[f64; 3]; 3]) -> Vec<(&'static str, f64, f64)> {
        let [[i11, i12, i13], [_, i22, i23], [.., i33]] = *inertia;
        let of_tensor = [0.5 * (i11 + i22) - i33, -i13, -i23, 0.25 * (i22 - i11), -0.5 * i12]
            .map(|part| part / self.mass_radius_squared);
        let largest = of_tensor.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
        let pairs = OF_INERTIA.into_iter().zip(of_tensor);
        let given = pairs.filter_map(|(name, tensor)| Some((name, self.coefficient(name)?, tensor)));
        given.filter(|(_, given, tensor)| (given - tensor).abs() > DIFFERENT * largest.max(given.abs())).collect()
    }

    /// The same field about other axes, the columns of a rotation in the old components.
    pub(super) fn turned(&self, axes: &Square) -> Self {
        Self { turn: product(&self.turn, axes), ..self.clone() }
    }
}
