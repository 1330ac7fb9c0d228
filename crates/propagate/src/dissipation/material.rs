//! What a body is made of: density, elasticity and loss.

use std::fmt;
use std::sync::Arc;

use crate::error::Error;

/// A function of the frequency \[rad per unit of time\] whose value is −Im S/S*, as in `χ = 1/Q`.
pub type LossFunction = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

/// The loss χ(f) of a material at a frequency f: the energy lost in a cycle is 2πχ times the peak energy of a standing oscillation.
#[derive(Clone)]
pub enum Loss {
    /// A quality factor Q, the same at each frequency: χ = 1/Q.
    Quality(f64),
    /// The viscosity η of a Maxwell body: χ = S/(ηf).
    Viscosity(f64),
    /// A function of the frequency.
    Function(LossFunction),
}

impl fmt::Debug for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Quality(value) => write!(f, "Quality({value})"),
            Self::Viscosity(value) => write!(f, "Viscosity({value})"),
            Self::Function(_) => write!(f, "Function"),
        }
    }
}

/// A homogeneous, slightly inelastic material, in units that are consistent with the lengths of the body and with the unit of time of its scenes.
///
/// ```
/// use andoyer_propagate::dissipation::{Loss, Material};
/// let rubble = Material::new(2000.0, 5e9)?.poisson(0.25)?.loss(Loss::Quality(100.0))?; // kg/m³, Pa
/// assert_eq!(rubble.rigidity(), 5e9);
/// # Ok::<(), andoyer_propagate::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Material {
    density: f64,
    rigidity: f64,
    poisson: f64,
    shear_only: bool,
    loss: Option<Loss>,
}

impl Material {
    /// A material with a density ϱ \[mass/length³\] and a rigidity S, the shear modulus \[mass/(length time²)\]. Poisson's ratio is ¼, and there is no loss yet.
    ///
    /// # Errors
    /// [`Error::Positive`] for a value that is zero, negative or not finite.
    pub fn new(density: f64, rigidity: f64) -> Result<Self, Error> {
        positive("density", density)?;
        positive("rigidity", rigidity)?;
        Ok(Self { density, rigidity, poisson: 0.25, shear_only: false, loss: None })
    }

    /// Sets Poisson's ratio, from 0 to ½ (incompressible).
    ///
    /// # Errors
    /// [`Error::Dissipation`] for −0.1, 0.51 or NaN.
    pub fn poisson(self, poisson: f64) -> Result<Self, Error> {
        if !(0.0..=0.5).contains(&poisson) {
            return Err(refused("poisson", poisson, "from 0 to 0.5"));
        }
        Ok(Self { poisson, ..self })
    }

    /// Sets the loss.
    ///
    /// # Errors
    /// [`Error::Positive`] for a quality factor or a viscosity that is zero, negative or not finite.
    pub fn loss(self, loss: Loss) -> Result<Self, Error> {
        match loss {
            Loss::Quality(value) => positive("quality", value)?,
            Loss::Viscosity(value) => positive("viscosity", value)?,
            Loss::Function(_) => {}
        }
        Ok(Self { loss: Some(loss), ..self })
    }

    /// Whether the loss is that of shear alone. By default compression has the same loss.
    #[must_use]
    pub fn shear_only(self, shear_only: bool) -> Self {
        Self { shear_only, ..self }
    }

    /// ϱ \[mass/length³\].
    pub fn density(&self) -> f64 {
        self.density
    }

    /// S \[mass/(length time²)\].
    pub fn rigidity(&self) -> f64 {
        self.rigidity
    }

    /// Poisson's ratio ν.
    pub fn poisson_ratio(&self) -> f64 {
        self.poisson
    }

    /// Whether compression has no loss.
    pub fn is_shear_only(&self) -> bool {
        self.shear_only
    }

    /// The loss, or `None`.
    pub fn given_loss(&self) -> Option<&Loss> {
        self.loss.as_ref()
    }

    /// χ(f), positive and finite.
    pub(super) fn loss_at(&self, frequency: f64) -> Result<f64, Error> {
        let value = match &self.loss {
            None => {
                let (value, reason) =
                    ("no loss".to_owned(), "it needs a quality factor, a viscosity or a loss function");
                return Err(Error::NoDissipation { argument: "material", value, reason: reason.to_owned() });
            }
            Some(Loss::Quality(quality)) => quality.recip(),
            Some(Loss::Viscosity(viscosity)) => self.rigidity / (frequency * viscosity),
            Some(Loss::Function(function)) => function(frequency),
        };
        if value.is_finite() && value > 0.0 {
            return Ok(value);
        }
        Err(refused("loss", value, &format!("positive and finite, at the frequency {frequency:.6e} too")))
    }
}

/// Checks that a number is positive and finite.
pub(super) fn positive(argument: &'static str, value: f64) -> Result<(), Error> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(Error::Positive { argument, value }) }
}

/// The error of a number that dissipation cannot use.
pub(super) fn refused(argument: &'static str, value: f64, bound: &str) -> Error {
    Error::Dissipation { argument, value, bound: bound.to_owned() }
}
