//! Derivatives with respect to chosen parameters.

use super::derivatives::{Derivatives, INERTIA_PARAMETERS, PARAMETERS};
use crate::error::Error;
use crate::input::gravity::Gravity;
use crate::motion::batch::Batch;
use crate::motion::solved::{Motion, length};
use crate::orbit::disturbing_body::DisturbingBody;

/// The elements of an orbit, in the order of the columns.
const ELEMENTS: [&str; 6] =
    ["mean_motion", "eccentricity", "time_of_pericentre", "inclination", "node", "argument_of_pericentre"];

/// Parameters that belong together, each a column of the derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Parameter {
    /// The initial attitude: a rotation about each of the body's axes.
    Attitude,
    /// The initial angular velocity in body components.
    AngularVelocity,
    /// The three moments as given; for a body with a tensor its elements I11, I22, I33, I12, I13, I23. M R² of a gravity field is held.
    Moments,
    /// The six elements of the orbit of a disturbing body, by its index: mean motion, eccentricity, time of pericentre, inclination, node, argument of pericentre.
    /// The attraction or the mass fraction, whichever the orbit was given with, is held.
    Orbit(usize),
    /// The attraction of a disturbing body on an orbit, by its index.
    Attraction(usize),
    /// The parameters of a torque of the scene, by its index: the components of a constant torque, of the momentum of rotors or of a dipole, the elements of a damping matrix, the factor and up to 60 coefficients of another
    /// polynomial.
    Torque(usize),
}

impl Parameter {
    /// The parameters of [`Motion::partials`].
    pub const STATE_AND_BODY: [Self; 3] = [Self::Attitude, Self::AngularVelocity, Self::Moments];

    /// The names of the columns of [`Motion::partials`], or with a tensor of [`Motion::inertia_partials`].
    pub fn names_of_state_and_body(tensor: bool) -> Vec<String> {
        Self::STATE_AND_BODY.into_iter().flat_map(|parameter| parameter.names(tensor, "")).collect()
    }

    /// The names of the columns. `tensor`: of a body with a tensor; `index`: added to the names of the orbit's parameters.
    fn names(self, tensor: bool, index: &str) -> Vec<String> {
        let numbered = |name: &str| (1..=3).map(|axis| format!("{name}_{axis}")).collect();
        match self {
            Self::Attitude => numbered("attitude"),
            Self::AngularVelocity => numbered("angular_velocity"),
            Self::Moments if tensor => ["I11", "I22", "I33", "I12", "I13", "I23"].map(str::to_owned).to_vec(),
            Self::Moments => numbered("moment"),
            Self::Orbit(_) => ELEMENTS.map(|name| format!("{name}{index}")).to_vec(),
            Self::Attraction(_) => vec![format!("attraction{index}")],
            // `torque_names` has them.
            Self::Torque(_) => Vec::new(),
        }
    }
}

impl Motion {
    /// A parameter by its name: "attitude", "angular_velocity", "moments", "orbit", "attraction" or "torque". The last three take the index of a disturbing body or of a torque, which may be left
    /// out where there is one.
    ///
    /// # Errors
    /// - [`Error::Parameter`] for `"mass"`, for `("moments", 0)`, and for `"orbit"` in a scene with two disturbing bodies.
    pub fn parameter(&self, name: &str, index: Option<usize>) -> Result<Parameter, Error> {
        let bodies = self.scene.asked_disturbing().len();
        let refused = |bound: &str| {
            let value = index.map_or_else(|| format!("\"{name}\""), |index| format!("(\"{name}\", {index})"));
            Err(Error::Parameter { value, bound: bound.to_owned() })
        };
        match (name, index) {
            ("attitude", None) => Ok(Parameter::Attitude),
            ("angular_velocity", None) => Ok(Parameter::AngularVelocity),
            ("moments", None) => Ok(Parameter::Moments),
            ("torque", _) if self.scene().asked_torques().is_empty() => refused("absent in a scene without torques"),
            ("torque", None) if self.scene().asked_torques().len() > 1 => {
                refused("a pair of name and index, such as (\"torque\", 0), with several torques")
            }
            ("torque", index) => Ok(Parameter::Torque(index.unwrap_or(0))),
            ("orbit" | "attraction", _) if bodies == 0 => refused("absent in a scene without a disturbing body"),
            ("orbit" | "attraction", None) if bodies > 1 => {
                refused("a pair of name and index, such as (\"orbit\", 0), with several disturbing bodies")
            }
            ("orbit", index) => Ok(Parameter::Orbit(index.unwrap_or(0))),
            ("attraction", index) => Ok(Parameter::Attraction(index.unwrap_or(0))),
            ("attitude" | "angular_velocity" | "moments", Some(_)) => refused("without an index"),
            _ => refused("\"attitude\", \"angular_velocity\", \"moments\", \"orbit\", \"attraction\" or \"torque\""),
        }
    }

    /// The names of the columns of [`Batch::partials_with_respect_to`], such as `"attitude_1"`, `"I12"` or `"eccentricity"`; with several disturbing bodies
    /// `"eccentricity[1]"`.
    ///
    /// # Errors
    /// - [`Error::Parameter`] for [`Parameter::Orbit`] or [`Parameter::Attraction`] of a body that the scene lacks, or that has a table.
    pub fn parameter_names(&self, parameters: &[Parameter]) -> Result<Vec<String>, Error> {
        let bodies = self.scene.asked_disturbing();
        let mut names = Vec::new();
        for parameter in parameters {
            if let Parameter::Torque(index) = *parameter {
                names.extend(self.torque_names(index)?);
                continue;
            }
            let mut suffix = String::new();
            let of_orbit = matches!(parameter, Parameter::Orbit(_) | Parameter::Attraction(_));
            if of_orbit && self.scene().body().gravity().is_some_and(Gravity::acts) {
                let bound =
                    "absent for a body with a gravity field, whose torques of degree 3 and 4 depend on the orbit too"
                        .to_owned();
                return Err(Error::Parameter { value: "\"orbit\" or \"attraction\"".to_owned(), bound });
            }
            if let Parameter::Orbit(index) | Parameter::Attraction(index) = *parameter {
                let bound = match bodies.get(index) {
                    Some(DisturbingBody::Orbit(_)) => None,
                    Some(DisturbingBody::Tabulated(_)) => Some("that of a body on an orbit, not of a table".to_owned()),
                    None if bodies.is_empty() => Some("absent in a scene without a disturbing body".to_owned()),
                    None => Some(format!("that of a disturbing body, with an index from 0 to {}", bodies.len() - 1)),
                };
                if let Some(bound) = bound {
                    let name = if let Parameter::Orbit(_) = parameter { "orbit" } else { "attraction" };
                    return Err(Error::Parameter { value: format!("(\"{name}\", {index})"), bound });
                }
                if bodies.len() > 1 {
                    suffix = format!("[{index}]");
                }
            }
            names.extend(parameter.names(self.scene().body().has_tensor(), &suffix));
        }
        Ok(names)
    }

    /// The names of the parameters of a torque, with its index if there are several.
    fn torque_names(&self, index: usize) -> Result<Vec<String>, Error> {
        let torques = self.scene().asked_torques();
        let Some(torque) = torques.get(index) else {
            let bound = match torques.len() {
                0 => "absent in a scene without torques".to_owned(),
                count => format!("that of a torque, with an index from 0 to {}", count - 1),
            };
            return Err(Error::Parameter { value: format!("(\"torque\", {index})"), bound });
        };
        let suffix = if torques.len() > 1 { format!("[{index}]") } else { String::new() };
        Ok(torque.parameters()?.into_iter().map(|(name, _)| name + &suffix).collect())
    }
}

impl Batch<'_> {
    /// Writes the derivatives of attitude and angular velocity with respect to chosen parameters: for each time three rows, with a column for each of
    /// [`Motion::parameter_names`].
    ///
    /// ```
    /// use andoyer_propagate::partials::Parameter;
    /// use andoyer_propagate::{Body, Orbit, Scene, State};
    /// let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.0, 0.01, 1.0])?;
    /// let scene = Scene::new(Body::new([1.0, 1.02, 1.05])?, state).orbit(Orbit::new(1e-2, 0.1)?).span(0.0, 100.0);
    /// let motion = scene.solve()?;
    /// let parameters = [Parameter::Orbit(0), Parameter::Attraction(0)];
    /// let names = motion.parameter_names(&parameters)?;
    /// assert_eq!(names[1], "eccentricity");
    /// let (mut attitudes, mut rates) = (vec![0.0; 3 * names.len()], vec![0.0; 3 * names.len()]);
    /// motion.batch().partials_with_respect_to(&parameters, &[100.0], &mut attitudes, &mut rates)?;
    /// // The attraction is n² here, so that n changes it and the phase of the orbit.
    /// assert!(attitudes[0] != 2e-2 * attitudes[6]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`Motion::partials_into`] and of [`Motion::parameter_names`].
    pub fn partials_with_respect_to(
        &self,
        parameters: &[Parameter],
        times: &[f64],
        attitudes: &mut [f64],
        rates: &mut [f64],
    ) -> Result<(), Error> {
        let columns = self.motion().parameter_names(parameters)?.len();
        length("attitudes", attitudes.len(), 3 * columns * times.len())?;
        length("rates", rates.len(), 3 * columns * times.len())?;
        #[cfg(feature = "torques")]
        if self.motion().varies_under_torques(parameters) {
            return self.forced(parameters, times, [attitudes, rates]);
        }
        if self.motion().scene().body().has_tensor() {
            self.chosen::<INERTIA_PARAMETERS>(parameters, times, [attitudes, rates], Self::inertia_partials_into)
        } else {
            self.chosen::<PARAMETERS>(parameters, times, [attitudes, rates], Self::partials_into)
        }
    }

    /// The columns of a free motion, chosen from those of state and body.
    fn chosen<const N: usize>(
        &self,
        parameters: &[Parameter],
        times: &[f64],
        [attitudes, rates]: [&mut [f64]; 2],
        fill: impl Fn(&Self, &[f64], &mut [Derivatives<N>], &mut [Derivatives<N>]) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if parameters == Parameter::STATE_AND_BODY {
            let [attitudes, rates] =
                [attitudes, rates].map(|output| output.as_chunks_mut::<N>().0.as_chunks_mut::<3>().0);
            return fill(self, times, attitudes, rates);
        }
        let [mut turned, mut faster] = [0, 1].map(|_| vec![[[0.0; N]; 3]; times.len()]);
        fill(self, times, &mut turned, &mut faster)?;
        select(parameters, &[turned, faster], [attitudes, rates]);
        Ok(())
    }
}

/// Copies the columns of state and body. Those of an orbit are 0: a free motion under a disturbing body is that of a sphere, and no orbit turns a sphere.
fn select<const N: usize>(parameters: &[Parameter], all: &[Vec<Derivatives<N>>; 2], outputs: [&mut [f64]; 2]) {
    let columns: Vec<Option<usize>> = parameters
        .iter()
        .flat_map(|parameter| match parameter {
            Parameter::Attitude => (0..3).map(Some).collect(),
            Parameter::AngularVelocity => (3..6).map(Some).collect(),
            Parameter::Moments => (6..N).map(Some).collect(),
            Parameter::Orbit(_) => vec![None; ELEMENTS.len()],
            Parameter::Attraction(_) | Parameter::Torque(_) => vec![None],
        })
        .collect();
    for (all, output) in all.iter().zip(outputs) {
        let rows = all.iter().flatten();
        for (row, chosen) in rows.zip(output.chunks_mut(columns.len().max(1))) {
            for (value, column) in chosen.iter_mut().zip(&columns) {
                *value = column.map_or(0.0, |column| row[column]);
            }
        }
    }
}
