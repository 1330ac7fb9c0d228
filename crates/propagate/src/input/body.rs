//! A rigid body: three principal moments of inertia, and the constants of theory §1 that follow from them.
//!
//! Moments come in any order about body axes 1, 2, 3; the theory's A ≤ B ≤ C are the sorted ones. Differences of moments are formed
//! before they are divided, so that α, αβ and 1 − β keep their relative accuracy for a nearly spherical, oblate or prolate body.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use super::catalogue;
use super::principal_axes::{NEGLIGIBLE, principal_axes};
use crate::error::Error;

/// Slack of the triangle inequality: a flat body given in rounded decimals is still a body.
const TRIANGLE_SLACK: f64 = 8.0 * f64::EPSILON;
/// Largest ratio of moments: past it C/A − 1 and its squares near the limits of a double. No body is a needle of 1e50 : 1.
const LARGEST_RATIO: f64 = 1e100;

/// Principal moments of inertia [any unit] about body axes 1, 2, 3, or an inertia tensor about the user's axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    moments: [f64; 3],
    name: Option<String>,
    tensor: Option<Box<Tensor>>,
}

/// An inertia tensor about axes that are not the principal ones.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tensor {
    given: [[f64; 3]; 3],
    /// Columns.
    axes: Matrix3<f64>,
    /// Rotation of components about principal axes into the user's.
    turn: UnitQuaternion<f64>,
}

impl Body {
    /// A body from its principal moments about body axes 1, 2, 3, in any order and any unit.
    ///
    /// # Errors
    /// - [`Error::Moment`] for `[0.0, 1.0, 1.0]`, `[-1.0, 1.0, 1.0]`, `[f64::NAN, 1.0, 1.0]`, `[f64::INFINITY, 1.0, 1.0]`.
    /// - [`Error::MomentsTriangle`] for `[1.0, 1.0, 2.1]`.
    /// - [`Error::MomentsRatio`] for `[1e-101, 1.0, 1.0]`.
    ///
    /// ```
    /// let body = andoyer_propagate::Body::new([1.0, 1.5, 2.0])?;
    /// assert!((body.beta() - 0.5).abs() < 1e-15);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn new(moments: [f64; 3]) -> Result<Self, Error> {
        for (axis, &value) in moments.iter().enumerate() {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::Moment { axis, value });
            }
        }
        let body = Self { moments, name: None, tensor: None };
        let [a, b, c] = body.sorted();
        // Each quotient by itself: the sum of two large moments may overflow.
        let sum = a / c + b / c;
        if sum < 1.0 - TRIANGLE_SLACK {
            return Err(Error::MomentsTriangle { moments, ratio: 1.0 / sum });
        }
        if a < c / LARGEST_RATIO {
            return Err(Error::MomentsRatio { moments, ratio: c / a, bound: LARGEST_RATIO });
        }
        Ok(body)
    }

    /// A body from its inertia tensor about the user's axes; attitudes, rates and momenta of its scenes are about these axes too.
    ///
    /// Its principal axes are those nearest to the user's; axes between which moments are equal, to 1e-12 of the largest, and no product of inertia is left stay as they are.
    ///
    /// # Errors
    /// - [`Error::InertiaSymmetry`] for entries across the diagonal that differ by more than 1e-12 of the largest entry, or are not finite.
    /// - [`Error::InertiaMoments`] for a principal moment that is not positive: `[[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]]`.
    /// - [`Error::MomentsTriangle`], [`Error::MomentsRatio`] as for [`Body::new`].
    ///
    /// ```
    /// let body = andoyer_propagate::Body::from_inertia([[1.5, 0.5, 0.0], [0.5, 1.5, 0.0], [0.0, 0.0, 2.0]])?;
    /// assert!(body.moments().iter().zip([1.0, 2.0, 2.0]).all(|(found, exact)| (found - exact).abs() < 1e-15));
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn from_inertia(tensor: [[f64; 3]; 3]) -> Result<Self, Error> {
        let largest = tensor.iter().flatten().fold(0.0_f64, |most, entry| most.max(entry.abs()));
        for (row, column) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
            let (value, mirrored) = (tensor[row][column], tensor[column][row]);
            let symmetric = value.is_finite() && (value - mirrored).abs() <= NEGLIGIBLE * largest;
            if !symmetric {
                return Err(Error::InertiaSymmetry { row, column, value, mirrored });
            }
        }
        if largest == 0.0 {
            return Err(Error::InertiaMoments { moments: [0.0; 3] });
        }
        let matrix = Matrix3::from_fn(|row, column| 0.5 * tensor[row][column] + 0.5 * tensor[column][row]);
        let (moments, axes) = principal_axes(&matrix);
        if moments.iter().any(|moment| *moment <= 0.0) {
            return Err(Error::InertiaMoments { moments });
        }
        let mut body = Self::new(moments)?;
        if axes != Matrix3::identity() {
            let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
            body.tensor = Some(Box::new(Tensor { given: tensor, axes, turn }));
        }
        Ok(body)
    }

    /// A homogeneous ellipsoid with these semi-axes along body axes 1, 2, 3: m (b² + c²)/5 and so on.
    ///
    /// # Errors
    /// - [`Error::Positive`] for a semi-axis or a mass that is zero, negative or not finite.
    /// - [`Error::Moment`], [`Error::MomentsRatio`] where the moments have no double.
    ///
    /// ```
    /// let body = andoyer_propagate::Body::ellipsoid([3.0, 2.0, 1.0], 5.0)?;
    /// assert_eq!(body.moments(), [5.0, 10.0, 13.0]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn ellipsoid(semi_axes: [f64; 3], mass: f64) -> Result<Self, Error> {
        Self::homogeneous(["a", "b", "c"], semi_axes, mass, 5.0)
    }

    /// A homogeneous box with these edges along body axes 1, 2, 3: m (y² + z²)/12 and so on.
    ///
    /// # Errors
    /// As [`Body::ellipsoid`].
    ///
    /// ```
    /// let body = andoyer_propagate::Body::cuboid([3.0, 2.0, 1.0], 12.0)?;
    /// assert_eq!(body.moments(), [5.0, 10.0, 13.0]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn cuboid(edges: [f64; 3], mass: f64) -> Result<Self, Error> {
        Self::homogeneous(["x", "y", "z"], edges, mass, 12.0)
    }

    fn homogeneous(names: [&'static str; 3], lengths: [f64; 3], mass: f64, divisor: f64) -> Result<Self, Error> {
        for (argument, value) in names.into_iter().zip(lengths).chain([("mass", mass)]) {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::Positive { argument, value });
            }
        }
        let [a, b, c] = lengths.map(|length| length * length);
        Self::new([b + c, a + c, a + b].map(|sum| mass * sum / divisor))
    }

    /// Whether the body was given by an inertia tensor whose axes are not the principal ones.
    pub fn has_tensor(&self) -> bool {
        self.tensor.is_some()
    }

    /// The inertia tensor about the user's axes, as it was given; diagonal for a body about its principal axes.
    pub fn inertia(&self) -> [[f64; 3]; 3] {
        let [a, b, c] = self.moments;
        self.tensor.as_ref().map_or([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]], |tensor| tensor.given)
    }

    /// The principal axes in the user's components: columns of a proper rotation, in the order of [`Body::moments`]; the unit matrix unless a tensor was given.
    pub fn principal_axes(&self) -> Matrix3<f64> {
        self.tensor.as_ref().map_or_else(Matrix3::identity, |tensor| tensor.axes)
    }

    /// Rotation of components about principal axes into the user's, where they differ.
    pub(crate) fn turn(&self) -> Option<UnitQuaternion<f64>> {
        self.tensor.as_ref().map(|tensor| tensor.turn)
    }

    /// The same body about its principal axes.
    pub(crate) fn about_principal_axes(&self) -> Self {
        Self { tensor: None, ..self.clone() }
    }

    /// The same body with moments a little different, which need not be those of a body.
    pub(crate) fn with_moments(&self, moments: [f64; 3]) -> Self {
        Self { moments, ..self.clone() }
    }

    /// A body of the catalogue by its name, in any case: "earth", "ceres", … (the list: [`Body::catalogue`]).
    ///
    /// # Errors
    /// - [`Error::UnknownBody`] for `"vulcan"`.
    pub fn named(name: &str) -> Result<Self, Error> {
        let entry = catalogue::entry(name)?;
        Ok(Self::new(entry.moments)?.with_name(entry.name))
    }

    /// The names that [`Body::named`] knows.
    pub fn catalogue() -> Vec<&'static str> {
        catalogue::names().collect()
    }

    /// Where the figures of a catalogue body come from.
    ///
    /// # Errors
    /// - [`Error::UnknownBody`] for `"vulcan"`.
    pub fn source(name: &str) -> Result<&'static str, Error> {
        catalogue::entry(name).map(|entry| entry.source)
    }

    /// The same body with a name, which is printed and nothing else.
    #[must_use]
    pub fn with_name(mut self, name: &str) -> Self {
        self.name = Some(name.to_owned());
        self
    }

    /// The name, if it has one.
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// The moments about body axes 1, 2, 3, as given; of an inertia tensor the principal ones, about [`Body::principal_axes`].
    pub fn moments(&self) -> [f64; 3] {
        self.moments
    }

    /// A ≤ B ≤ C.
    pub(crate) fn sorted(&self) -> [f64; 3] {
        let mut sorted = self.moments;
        sorted.sort_by(f64::total_cmp);
        sorted
    }

    /// C/A − 1 and C/B − 1 (theory §1), each to its last bits.
    pub(crate) fn excesses(&self) -> (f64, f64) {
        let [a, b, c] = self.sorted();
        ((c - a) / a, (c - b) / b)
    }

    /// C/A − C/B = 2αβ, without the difference of the two excesses.
    pub(crate) fn excess_difference(&self) -> f64 {
        let [a, b, c] = self.sorted();
        (c / b) * ((b - a) / a)
    }

    /// α = [(C/A − 1) + (C/B − 1)]/2 (theory §1); 0 for a sphere.
    pub fn alpha(&self) -> f64 {
        let (first, second) = self.excesses();
        0.5 * (first + second)
    }

    /// β, the triaxiality, 0 ≤ β ≤ 1 (theory §1); 0 for A = B, 1 for B = C, and 0 for a sphere, where it is not defined.
    pub fn beta(&self) -> f64 {
        let alpha = self.alpha();
        if alpha == 0.0 { 0.0 } else { (0.5 * self.excess_difference() / alpha).min(1.0) }
    }

    /// γ = √((C/A − 1)(C/B − 1)) (theory §1).
    pub fn gamma(&self) -> f64 {
        let (first, second) = self.excesses();
        first.sqrt() * second.sqrt()
    }

    /// ω = √((1 + β)/(1 − β)) (theory §1); 1 for a sphere, infinite for B = C.
    pub fn omega(&self) -> f64 {
        let (first, second) = self.excesses();
        if first == 0.0 { 1.0 } else { (first / second).sqrt() }
    }

    /// σ_sep(β) = (2/π) atan √((1−β)/2β), the action of the separatrix in units of M (theory §5); 1 for A = B, 0 for B = C.
    ///
    /// From the moments, so that it keeps its digits where β is next to 1.
    pub fn separatrix_action(&self) -> f64 {
        let (_, second) = self.excesses();
        let difference = self.excess_difference();
        if difference == 0.0 {
            return 1.0;
        }
        std::f64::consts::FRAC_2_PI * second.sqrt().atan2(difference.sqrt())
    }
}
