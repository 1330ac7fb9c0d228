//! Torques beside the gravity gradient: constant, damping, of rotors, and polynomials in directions and rates.

use std::sync::Arc;

use andoyer_double::DoubleDouble;
use andoyer_series::{Monomial, Polynomial};
use nalgebra::{Matrix3, Vector3};

use super::energy_loss::EnergyLoss;
use super::principal_axes::{Square, UNIT, along, product, rounded, transposed};
use super::torque_source::{TorqueSource, unsigned};
use crate::error::{Error, torque_refused};

/// Largest degree of a polynomial.
pub(crate) const MOST_DEGREE: u32 = 8;

/// Most variables of one component of a polynomial.
const MOST_VARIABLES: usize = 8;

/// A torque on the body, in body components [moment × rate²]. A scene with one is integrated.
///
/// ```
/// use andoyer_propagate::torques::Torque;
/// use andoyer_propagate::{Body, Method, Scene, State};
/// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.1, 1.0])?;
/// let scene = Scene::new(Body::new([1.0, 1.5, 2.0])?, state).span(0.0, 100.0).tolerance(1e-9);
/// let damped = scene.torques([Torque::damping([[0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]])?]).solve()?;
/// assert_eq!(damped.plan().method(), Method::Integrated);
/// assert!(damped.at(100.0)?.angular_velocity.norm() < 0.7);
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Torque {
    /// A constant torque.
    Constant([f64; 3]),
    /// −Dω.
    Damping([[f64; 3]; 3]),
    /// Rotors with a constant angular momentum h [moment × rate]: the torque −ω × h.
    Rotor([f64; 3]),
    /// Three polynomials times powers of distances.
    Polynomial(Arc<PolynomialTorque>),
    /// Internal friction, for [`Scene::evolve`](crate::Scene::evolve) and [`Scene::drift`](crate::Scene::drift) alone: no torque that a rigid body has.
    Dissipation(EnergyLoss),
}

/// Three polynomials in the body components of unit vectors to sources and of the angular velocity, times powers of the distances of the sources.
#[derive(Clone, Debug, PartialEq)]
pub struct PolynomialTorque {
    texts: [String; 3],
    sources: Vec<TorqueSource>,
    /// The terms of each component: a coefficient, and the exponents of the components of the sources in their sequence and of ω.
    terms: [Vec<(f64, Vec<u32>)>; 3],
    /// The rotation from components about the axes of the scene to those of the texts.
    turn: Square,
    /// Root mean square over all directions of what the polynomials leave out of the torque of a shape, relative to that of the torque; 0 for stated polynomials.
    truncation: f64,
}

impl Torque {
    /// A constant torque in body axes.
    ///
    /// # Errors
    /// - [`Error::Torque`] for NaN or an infinity.
    pub fn constant(torque: [f64; 3]) -> Result<Self, Error> {
        Self::Constant(torque.map(unsigned)).validated()
    }

    /// The torque −Dω; D need not be symmetric.
    ///
    /// # Errors
    /// - [`Error::Torque`] for NaN or an infinity.
    pub fn damping(matrix: [[f64; 3]; 3]) -> Result<Self, Error> {
        Self::Damping(matrix.map(|row| row.map(unsigned))).validated()
    }

    /// Rotors with this angular momentum in body axes: a gyrostat. The angular momentum of a motion includes it.
    ///
    /// # Errors
    /// - [`Error::Torque`] for NaN or an infinity.
    pub fn rotor(momentum: [f64; 3]) -> Result<Self, Error> {
        Self::Rotor(momentum.map(unsigned)).validated()
    }

    /// Three polynomials, in variables such as `sun1`, `sun2`, `sun3` for the body components of the unit vector to the source `sun`, and `w1`, `w2`, `w3` for
    /// those of the angular velocity.
    ///
    /// ```
    /// use andoyer_propagate::torques::{SourcePath, Torque, TorqueSource};
    /// let field = TorqueSource::new("field", SourcePath::Direction([0.0, 0.0, 1.0]));
    /// // A dipole along body axis 1 in a uniform field: m × B.
    /// assert!(Torque::polynomial(["0", "-2e-3*field3", "2e-3*field2"], vec![field]).is_ok());
    /// assert!(Torque::polynomial(["w1^9", "0", "0"], vec![]).is_err());
    /// ```
    ///
    /// # Errors
    /// - [`Error::Torque`] for a name that is no identifier or stands twice, a power for a direction, a power without a reference distance
    ///   for an orbit with a semi-major axis or a table, a degree above 8, a component with more than eight variables.
    /// - [`Error::Series`] for a text that is no polynomial in these variables.
    pub fn polynomial(texts: [&str; 3], sources: Vec<TorqueSource>) -> Result<Self, Error> {
        for (k, source) in sources.iter().enumerate() {
            source.validate()?;
            if sources[..k].iter().any(|other| other.name() == source.name()) {
                return Err(torque_refused("sources", source.name(), "different names"));
            }
        }
        let names = sources.iter().map(|source| source.name()).chain(["w"]);
        let names: Vec<String> = names.flat_map(|name| (1..=3).map(move |axis| format!("{name}{axis}"))).collect();
        let [first, second, third] = texts.map(|text| parsed(text, &names));
        let texts = texts.map(str::to_owned);
        let (turn, terms) = (UNIT, [first?, second?, third?]);
        Ok(Self::Polynomial(Arc::new(PolynomialTorque { texts, sources, terms, turn, truncation: 0.0 })))
    }

    /// The torque of a shape: three polynomials in the direction to one source, and what they leave out.
    ///
    /// # Errors
    /// As [`Torque::polynomial`].
    pub(crate) fn of_shape(polynomials: &[Polynomial<f64>; 3], source: TorqueSource) -> Result<Self, Error> {
        let text = |polynomial: &Polynomial<f64>| {
            let term = |(monomial, coefficient): (Monomial, &f64)| {
                let factor = |slot: usize| match monomial.exponent(slot) {
                    0 => String::new(),
                    power => format!("*{}{}^{power}", source.name(), slot + 1),
                };
                format!("{coefficient:?}{}{}{}", factor(0), factor(1), factor(2))
            };
            let terms: Vec<String> = polynomial.terms().map(term).collect();
            if terms.is_empty() { "0".to_owned() } else { terms.join(" + ").replace("+ -", "- ") }
        };
        let [first, second, third] = polynomials.each_ref().map(text);
        Self::polynomial([&first, &second, &third], vec![source])
    }

    /// The same polynomials with this [`PolynomialTorque::truncation`].
    ///
    /// # Errors
    /// - [`Error::Torque`] for a negative number, NaN or an infinity, and for a torque without polynomials.
    pub fn truncated(self, truncation: f64) -> Result<Self, Error> {
        match self {
            Self::Polynomial(torque) if truncation >= 0.0 && truncation.is_finite() => {
                Ok(Self::Polynomial(Arc::new(PolynomialTorque { truncation, ..(*torque).clone() })))
            }
            _ => Err(torque_refused("truncation", truncation, "of a polynomial, finite and at least 0")),
        }
    }

    /// # Errors
    /// - [`Error::Torque`] for a number that is not finite.
    pub(crate) fn validate(&self) -> Result<(), Error> {
        let finite = |argument: &'static str, numbers: &[f64]| match numbers.iter().find(|x| !x.is_finite()) {
            Some(value) => Err(torque_refused(argument, value, "finite")),
            None => Ok(()),
        };
        match self {
            Self::Constant(torque) => finite("constant", torque),
            Self::Damping(matrix) => finite("damping", matrix.as_flattened()),
            Self::Rotor(momentum) => finite("rotor", momentum),
            Self::Polynomial(_) | Self::Dissipation(_) => Ok(()),
        }
    }

    fn validated(self) -> Result<Self, Error> {
        self.validate().map(|()| self)
    }

    /// The same torque about other axes, the columns of a rotation in the old components. Double-double keeps the digits of a small component, which may turn a body
    /// about an axis with a small moment.
    pub(crate) fn turned(&self, axes: &Square) -> Self {
        let vector = |given: &[f64; 3]| along(axes, *given).map(DoubleDouble::to_f64);
        match self {
            Self::Constant(torque) => Self::Constant(vector(torque)),
            Self::Rotor(momentum) => Self::Rotor(vector(momentum)),
            Self::Damping(rows) => {
                let matrix = product(&transposed(axes), &product(&rows.map(|row| row.map(DoubleDouble::from)), axes));
                Self::Damping(matrix.map(|row| row.map(DoubleDouble::to_f64)))
            }
            Self::Dissipation(loss) => Self::Dissipation(loss.clone()),
            Self::Polynomial(torque) => {
                Self::Polynomial(Arc::new(PolynomialTorque { turn: product(&torque.turn, axes), ..(**torque).clone() }))
            }
        }
    }

    /// The largest degree in directions and rates.
    pub fn degree(&self) -> u32 {
        match self {
            Self::Constant(_) | Self::Dissipation(_) => 0,
            Self::Damping(_) | Self::Rotor(_) => 1,
            Self::Polynomial(torque) => torque.degree(),
        }
    }

    /// That of [`PolynomialTorque::truncation`], 0 for other torques.
    pub fn truncation(&self) -> f64 {
        match self {
            Self::Polynomial(torque) => torque.truncation,
            _ => 0.0,
        }
    }

    /// Its kind in one word.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Constant(_) => "constant",
            Self::Damping(_) => "damping",
            Self::Rotor(_) => "rotor",
            Self::Polynomial(_) => "polynomial",
            Self::Dissipation(_) => "dissipation",
        }
    }
}

impl PolynomialTorque {
    /// The texts of the three components.
    pub fn texts(&self) -> &[String; 3] {
        &self.texts
    }

    /// The sources.
    pub fn sources(&self) -> &[TorqueSource] {
        &self.sources
    }

    /// The largest degree in directions and rates.
    pub fn degree(&self) -> u32 {
        let degrees = self.terms.iter().flatten().map(|(_, exponents)| exponents.iter().sum::<u32>());
        degrees.max().unwrap_or(0)
    }

    /// Root mean square over all directions of what the polynomials leave out of the torque of a shape, relative to that of the torque; 0 for stated polynomials.
    pub fn truncation(&self) -> f64 {
        self.truncation
    }

    pub(crate) fn terms(&self) -> &[Vec<(f64, Vec<u32>)>; 3] {
        &self.terms
    }

    pub(crate) fn turn(&self) -> Matrix3<f64> {
        rounded(&self.turn)
    }
}

/// The angular momentum of all rotors.
pub(crate) fn rotors(torques: &[Torque]) -> Vector3<f64> {
    let momentum = |torque: &Torque| match torque {
        Torque::Rotor(momentum) => Vector3::from(*momentum),
        _ => Vector3::zeros(),
    };
    torques.iter().map(momentum).sum()
}

/// The terms of one component, in the variables of these names.
pub(super) fn parsed(text: &str, names: &[String]) -> Result<Vec<(f64, Vec<u32>)>, Error> {
    // The algebra takes a few variables: those that the text has.
    let words: Vec<&str> = text.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
    let used: Vec<&str> = names.iter().map(String::as_str).filter(|name| words.contains(name)).collect();
    if used.len() > MOST_VARIABLES {
        return Err(torque_refused("texts", text, "at most 8 variables in a component"));
    }
    let polynomial = Polynomial::<f64>::parse(text, &used).map_err(Error::Series)?;
    if let Some(degree) = polynomial.degree().filter(|degree| *degree > MOST_DEGREE) {
        return Err(torque_refused("texts", format!("degree {degree}"), "of degree 8 or less"));
    }
    let terms = polynomial.terms().map(|(monomial, coefficient)| {
        let mut exponents = vec![0; names.len()];
        for (slot, name) in used.iter().enumerate() {
            if let Some(place) = names.iter().position(|other| other == name) {
                exponents[place] = monomial.exponent(slot);
            }
        }
        (*coefficient, exponents)
    });
    Ok(terms.collect())
}
