//! Derivatives with respect to the parameters, as arrays.

/// Number of parameters of the derivatives.
pub const PARAMETERS: usize = 9;

/// Number of parameters of the derivatives with respect to the elements of an inertia tensor.
pub const INERTIA_PARAMETERS: usize = 12;

/// Derivatives of one vector. The rows are its components, the columns the parameters.
pub type Derivatives<const N: usize = PARAMETERS> = [[f64; N]; 3];

/// Derivatives of attitude and rates at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Partials<const N: usize = PARAMETERS> {
    /// The time.
    pub time: f64,
    /// Derivatives of the attitude, as a rotation vector about body axes. Three columns are for the initial attitude \[1\], three for the initial angular
    /// velocity \[unit of time\], three for the moments [1/unit of moment]. For a body with an inertia tensor the last three are for the principal moments,
    /// with fixed principal axes. Of [`Motion::inertia_partials`](crate::Motion::inertia_partials) the last six are for the elements I11, I22, I33, I12, I13, I23 of the tensor.
    pub attitude: Derivatives<N>,
    /// Derivatives of the angular velocity in body components, in the same order [rate, 1, rate/unit of moment].
    pub angular_velocity: Derivatives<N>,
}
