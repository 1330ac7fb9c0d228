//! The loss of energy by internal friction, a term of the averaged equations (weak torques §1: Ġ = 0, ξ̇ = ∓2IP/M²).

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use super::body::Body;
use crate::error::{Error, torque_refused};

/// A state of a tumbling body, averaged over its rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LossState {
    /// True in the long-axis mode.
    pub long_axis: bool,
    /// ξ: 2CE/M² − 1 in the short-axis mode, 1 − 2AE/M² in the long-axis mode.
    pub excess: f64,
    /// ξ of the separatrix.
    pub separatrix: f64,
    /// M/C \[rad/time\].
    pub rate: f64,
}

/// A power as a function of the state.
type PowerFunction = Arc<dyn Fn(&LossState) -> Result<f64, Error> + Send + Sync>;

/// The power that internal friction takes from a tumbling body at constant angular momentum.
#[derive(Clone)]
pub struct EnergyLoss {
    power: PowerFunction,
    /// The only body that it is for, whose largest moment divides the power.
    of_body: Option<Body>,
    /// The object that a binding made it from.
    origin: Option<Arc<dyn Any + Send + Sync>>,
}

impl fmt::Debug for EnergyLoss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "EnergyLoss {{ of_body: {:?} }}", self.of_body)
    }
}

impl PartialEq for EnergyLoss {
    /// Whether both are the same function.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.power, &other.power) && self.of_body == other.of_body
    }
}

impl EnergyLoss {
    /// A power \[moment × rate³\] as a function of ξ, 0 at ξ = 0.
    pub fn of_excess(power: impl Fn(f64) -> Result<f64, Error> + Send + Sync + 'static) -> Self {
        Self { power: Arc::new(move |state: &LossState| power(state.excess)), of_body: None, origin: None }
    }

    /// A power over the largest moment \[rate³\] of this body; its moments count up to a factor.
    pub(crate) fn of_body(
        body: Body,
        power: impl Fn(&LossState) -> Result<f64, Error> + Send + Sync + 'static,
    ) -> Self {
        Self { power: Arc::new(power), of_body: Some(body), origin: None }
    }

    /// Keeps the object that it was made from, for a binding.
    #[must_use]
    pub fn with_origin(self, origin: Arc<dyn Any + Send + Sync>) -> Self {
        Self { origin: Some(origin), ..self }
    }

    /// The object of [`EnergyLoss::with_origin`].
    pub fn origin(&self) -> Option<&(dyn Any + Send + Sync)> {
        self.origin.as_deref()
    }

    /// The power over the largest of the moments of the body.
    ///
    /// # Errors
    /// - [`Error::Torque`] for a power that is negative or not finite; those of the function.
    pub(crate) fn power_over(&self, largest: f64, state: &LossState) -> Result<f64, Error> {
        let power = (self.power)(state)?;
        if !(power >= 0.0 && power.is_finite()) {
            let bound = format!("a power that is finite and at least 0 at the excess {}", state.excess);
            return Err(torque_refused("dissipation", power, &bound));
        }
        Ok(if self.of_body.is_some() { power } else { power / largest })
    }

    /// # Errors
    /// - [`Error::Torque`] for a body of other ratios of moments.
    pub(crate) fn check(&self, body: &Body) -> Result<(), Error> {
        match &self.of_body {
            Some(own) if !own.is_proportional(body) => {
                let value = format!("of a body with the moments {:?}", own.moments());
                let bound = format!("that of the body of the scene, whose moments are {:?}", body.moments());
                Err(torque_refused("dissipation", value, &bound))
            }
            _ => Ok(()),
        }
    }
}
