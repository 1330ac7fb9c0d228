//! A rigid body: three principal moments of inertia, and the constants of theory §1.
//!
//! Moments are given in any order about body axes 1, 2, 3. A ≤ B ≤ C of the theory are the sorted moments. Differences of moments are computed before any
//! division, so that α, αβ and 1 − β keep their relative accuracy for a nearly spherical, oblate or prolate body.

use std::sync::Arc;

use andoyer_double::DoubleDouble;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::catalogue;
use super::gravity::Gravity;
use super::principal_axes::{NEXT_AXES, Square, UNIT, along, principal_axes, rounded};
use crate::error::Error;

/// Tolerance of the triangle inequality, which accepts a flat body given in rounded decimals.
const TRIANGLE_SLACK: f64 = 8.0 * f64::EPSILON;
/// Opposite entries of a tensor that differ by less than this fraction of its largest entry are equal: their mean counts.
const SYMMETRIC: f64 = 1e-12;
/// Largest ratio C/A of moments. Beyond it C/A − 1 and its squares approach the limits of a double. No body is so thin: a needle of 1e50 : 1 has this ratio.
const LARGEST_RATIO: f64 = 1e100;

/// Difference of ratios of moments that is rounding.
pub(crate) const SAME_RATIO: f64 = 1e-12;

/// Principal moments of inertia [any unit] about body axes 1, 2, 3, or an inertia tensor about the user's axes.
#[derive(Clone, Debug)]
pub struct Body {
    moments: [f64; 3],
    /// What the moments of a tensor lose by rounding: with them they are double-doubles.
    lows: [f64; 3],
    name: Option<String>,
    tensor: Option<Box<Tensor>>,
    /// Whether the body was given by a tensor. A tensor about the principal axes is kept as moments.
    by_tensor: bool,
    /// The field of degree 3 and 4.
    gravity: Option<Arc<Gravity>>,
}

/// A body of a diagonal tensor is equal to that of its moments.
impl PartialEq for Body {
    fn eq(&self, other: &Self) -> bool {
        (self.moments, &self.name, &self.tensor, &self.gravity)
            == (other.moments, &other.name, &other.tensor, &other.gravity)
    }
}

/// An inertia tensor about axes that are not the principal ones.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tensor {
    given: [[f64; 3]; 3],
    /// The principal axes as columns, in the user's components.
    axes: Matrix3<f64>,
    precise_axes: Square,
    /// Rotation from components about principal axes to components about the user's axes.
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
        let body = Self { moments, lows: [0.0; 3], name: None, tensor: None, by_tensor: false, gravity: None };
        let [a, b, c] = body.sorted();
        // Each quotient is computed by itself, because the sum of two large moments may overflow.
        let sum = a / c + b / c;
        if sum < 1.0 - TRIANGLE_SLACK {
            return Err(Error::MomentsTriangle { moments, ratio: 1.0 / sum });
        }
        if a < c / LARGEST_RATIO {
            return Err(Error::MomentsRatio { moments, ratio: c / a, bound: LARGEST_RATIO });
        }
        Ok(body)
    }

    /// A body from its inertia tensor about the user's axes. Attitudes, rates and momenta of its scenes refer to these axes too.
    ///
    /// The principal axes are numbered and directed so that they are nearest to the user's axes. The tensor is taken as exact: with equal moments on its diagonal
    /// the least product of inertia turns two axes by 45°.
    ///
    /// # Errors
    /// - [`Error::InertiaSymmetry`] for opposite entries that differ by more than 1e-12 of the largest entry, or for entries that are not finite.
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
            let symmetric = value.is_finite() && (value - mirrored).abs() <= SYMMETRIC * largest;
            if !symmetric {
                return Err(Error::InertiaSymmetry { row, column, value, mirrored });
            }
        }
        if largest == 0.0 {
            return Err(Error::InertiaMoments { moments: [0.0; 3] });
        }
        let mean = |row: usize, column: usize| DoubleDouble::sum(0.5 * tensor[row][column], 0.5 * tensor[column][row]);
        let (precise, axes) =
            principal_axes(&std::array::from_fn(|row| std::array::from_fn(|column| mean(row, column))));
        let moments = precise.map(DoubleDouble::to_f64);
        if moments.iter().any(|moment| *moment <= 0.0) {
            return Err(Error::InertiaMoments { moments });
        }
        Ok(Self::new(moments)?.with_precise(precise).about(axes, tensor))
    }

    fn with_precise(self, moments: [DoubleDouble; 3]) -> Self {
        Self { moments: moments.map(|moment| moment.high), lows: moments.map(|moment| moment.low), ..self }
    }

    /// The same body about axes of which these are the principal ones.
    fn about(mut self, precise_axes: Square, given: [[f64; 3]; 3]) -> Self {
        self.by_tensor = true;
        let axes = rounded(&precise_axes);
        if axes != Matrix3::identity() {
            let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
            self.tensor = Some(Box::new(Tensor { given, axes, precise_axes, turn }));
        }
        self
    }

    /// A homogeneous ellipsoid with the given semi-axes along body axes 1, 2, 3: the moment about axis 1 is m (b² + c²)/5, and so on.
    ///
    /// # Errors
    /// - [`Error::Positive`] for a semi-axis or a mass that is zero, negative or not finite.
    /// - [`Error::Moment`], [`Error::MomentsRatio`] if the moments overflow or underflow.
    ///
    /// ```
    /// let body = andoyer_propagate::Body::ellipsoid([3.0, 2.0, 1.0], 5.0)?;
    /// assert_eq!(body.moments(), [5.0, 10.0, 13.0]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn ellipsoid(semi_axes: [f64; 3], mass: f64) -> Result<Self, Error> {
        Self::homogeneous(["a", "b", "c"], semi_axes, mass, 5.0)
    }

    /// A homogeneous box with the given edges along body axes 1, 2, 3: the moment about axis 1 is m (y² + z²)/12, and so on.
    ///
    /// # Errors
    /// The errors of [`Body::ellipsoid`].
    ///
    /// ```
    /// let body = andoyer_propagate::Body::cuboid([3.0, 2.0, 1.0], 12.0)?;
    /// assert_eq!(body.moments(), [5.0, 10.0, 13.0]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    #[doc(alias = "box")]
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

    /// The body with a gravity field of degree 3 and 4 about its axes. Scenes with it and with disturbing bodies are integrated.
    ///
    /// # Errors
    /// - [`Error::Torque`] for a field without an inertia factor or a C20 that gives it.
    pub fn with_gravity(self, gravity: Gravity) -> Result<Self, Error> {
        let gravity = gravity.of_body(&self.inertia(), self.sorted()[2])?;
        Ok(Self { gravity: Some(Arc::new(gravity)), ..self })
    }

    /// The gravity field of degree 3 and 4.
    pub fn gravity(&self) -> Option<&Gravity> {
        self.gravity.as_deref()
    }

    /// The coefficients of degree 2 of the gravity field that differ from those of the inertia tensor by more than 0.1 %: name, as given, of the tensor.
    pub fn gravity_differences(&self) -> Vec<(&'static str, f64, f64)> {
        self.gravity().map_or_else(Vec::new, |gravity| gravity.different(&self.inertia()))
    }

    /// Whether the body was given by an inertia tensor.
    pub fn has_tensor(&self) -> bool {
        self.by_tensor
    }

    /// The inertia tensor about the user's axes, as it was given. It is diagonal for a body given by principal moments.
    pub fn inertia(&self) -> [[f64; 3]; 3] {
        let [a, b, c] = self.moments;
        self.tensor.as_ref().map_or([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]], |tensor| tensor.given)
    }

    /// The principal axes in the user's components, as columns of a proper rotation in the order of [`Body::moments`]. It is the unit matrix unless a tensor
    /// was given.
    pub fn principal_axes(&self) -> Matrix3<f64> {
        self.tensor.as_ref().map_or_else(Matrix3::identity, |tensor| tensor.axes)
    }

    /// Rotation from components about principal axes to components about the user's axes; `None` if the axes are the same.
    pub(crate) fn turn(&self) -> Option<UnitQuaternion<f64>> {
        self.tensor.as_ref().map(|tensor| tensor.turn)
    }

    /// A vector about the user's axes in components about the principal axes.
    pub(crate) fn along_principal_axes(&self, vector: Vector3<f64>) -> [DoubleDouble; 3] {
        along(&self.precise_axes(), vector.into())
    }

    /// The principal axes as columns in double-double.
    pub(crate) fn precise_axes(&self) -> Square {
        self.tensor.as_ref().map_or(UNIT, |tensor| tensor.precise_axes)
    }

    /// The moments in double-double: those of a tensor are not rounded.
    pub(crate) fn precise_moments(&self) -> [DoubleDouble; 3] {
        std::array::from_fn(|axis| DoubleDouble { high: self.moments[axis], low: self.lows[axis] })
    }

    /// Whether another body has the same ratios of moments about body axes 1, 2, 3.
    pub(crate) fn is_proportional(&self, other: &Self) -> bool {
        let ratios = |body: &Self| body.moments.map(|moment| moment / body.sorted()[2]);
        ratios(self).iter().zip(ratios(other)).all(|(ratio, other)| (ratio - other).abs() <= SAME_RATIO)
    }

    /// Whether all moments are equal: no body exerts a torque on a sphere.
    pub(crate) fn is_sphere(&self) -> bool {
        let [a, b, c] = self.precise_moments();
        a == b && b == c
    }

    /// (I3 − I2)/I1 and so on, the factors of Euler's equations, accurate to rounding.
    pub(crate) fn ratios(&self) -> [f64; 3] {
        let [a, b, c] = self.precise_moments();
        [(c - b, a), (a - c, b), (b - a, c)].map(|(difference, moment)| difference.to_f64() / moment.high)
    }

    /// The same body as given, about the axes (2, 3, 1).
    ///
    /// # Errors
    /// Those of a body whose moments are at a limit.
    pub(crate) fn about_next_axes(&self) -> Result<Self, Error> {
        let next = |axis: usize| (axis + 1) % 3;
        let tensor = self.inertia();
        let body = if self.tensor.is_some() {
            Self::from_inertia(std::array::from_fn(|i| std::array::from_fn(|j| tensor[next(i)][next(j)])))?
        } else {
            Self::new([0, 1, 2].map(|axis| self.moments[next(axis)]))?
        };
        let gravity = self.gravity.as_ref().map(|gravity| Arc::new(gravity.turned(&NEXT_AXES)));
        Ok(Self { gravity, ..body })
    }

    /// The same body about its principal axes.
    pub(crate) fn about_principal_axes(&self) -> Self {
        let gravity = self.gravity.as_ref().filter(|_| self.tensor.is_some());
        let turned = gravity.map(|gravity| Arc::new(gravity.turned(&self.precise_axes())));
        Self { tensor: None, gravity: turned.or_else(|| self.gravity.clone()), ..self.clone() }
    }

    /// The body about its principal axes with a slightly different tensor, which is not validated; from the changes of I11, I22, I33, I12, I13, I23.
    pub(crate) fn displaced(&self, [i11, i22, i33, i12, i13, i23]: [f64; 6]) -> Self {
        let [a, b, c] = self.precise_moments();
        let moments = [a + i11.into(), b + i22.into(), c + i33.into()];
        let body = self.clone().with_precise(moments);
        if [i12, i13, i23] == [0.0; 3] {
            return body;
        }
        let [a, b, c] = moments;
        let [i12, i13, i23] = [i12, i13, i23].map(DoubleDouble::from);
        let tensor = [[a, i12, i13], [i12, b, i23], [i13, i23, c]];
        let (moments, axes) = principal_axes(&tensor);
        body.with_precise(moments).about(axes, tensor.map(|row| row.map(DoubleDouble::to_f64)))
    }

    /// A body of the catalogue by its name, in upper or lower case: "earth", "ceres", … ([`Body::catalogue`] lists the names).
    ///
    /// ```
    /// let eros = andoyer_propagate::Body::named("eros")?;
    /// assert_eq!(eros.moments(), [0.210_078_32, 0.983_109_82, 1.0]);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
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

    /// The sources of the figures of a catalogue body.
    ///
    /// # Errors
    /// - [`Error::UnknownBody`] for `"vulcan"`.
    pub fn source(name: &str) -> Result<&'static str, Error> {
        catalogue::entry(name).map(|entry| entry.source)
    }

    /// The same body with a name. The name is only printed.
    #[must_use]
    pub fn with_name(mut self, name: &str) -> Self {
        self.name = Some(name.to_owned());
        self
    }

    /// The name, or `None` if the body has none.
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// The moments about body axes 1, 2, 3, as given. For an inertia tensor they are the principal moments about [`Body::principal_axes`].
    pub fn moments(&self) -> [f64; 3] {
        self.moments
    }

    /// The sorted moments A ≤ B ≤ C.
    pub(crate) fn sorted(&self) -> [f64; 3] {
        let [first, second, third] = self.moments;
        let (low, high) = (first.min(second), first.max(second));
        [low.min(third), low.max(third).min(high), high.max(third)]
    }

    fn precise_sorted(&self) -> [DoubleDouble; 3] {
        let mut moments = self.precise_moments();
        moments.sort_by(|one, other| one.high.total_cmp(&other.high).then(one.low.total_cmp(&other.low)));
        moments
    }

    /// C/A − 1 and C/B − 1 (theory §1), accurate to rounding.
    pub(crate) fn excesses(&self) -> (f64, f64) {
        let [a, b, c] = self.precise_sorted();
        ((c - a).to_f64() / a.high, (c - b).to_f64() / b.high)
    }

    /// C/A − C/B = 2αβ, computed without the difference of the two excesses.
    pub(crate) fn excess_difference(&self) -> f64 {
        let [a, b, c] = self.precise_sorted();
        (c.high / b.high) * ((b - a).to_f64() / a.high)
    }

    /// α = [(C/A − 1) + (C/B − 1)]/2 (theory §1); 0 for a sphere.
    pub fn alpha(&self) -> f64 {
        let (first, second) = self.excesses();
        0.5 * (first + second)
    }

    /// β, the triaxiality, 0 ≤ β ≤ 1 (theory §1). It is 0 for A = B and 1 for B = C. For a sphere it is not defined, and 0 is returned.
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
    /// It is computed from the moments, so that it keeps its relative accuracy when β is close to 1.
    ///
    /// ```
    /// let action = andoyer_propagate::Body::new([1.0, 1.5, 2.0])?.separatrix_action();
    /// assert!((action - 0.39183).abs() < 5e-6); // β = ½: table of theory §5
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    pub fn separatrix_action(&self) -> f64 {
        let (_, second) = self.excesses();
        let difference = self.excess_difference();
        if difference == 0.0 {
            return 1.0;
        }
        std::f64::consts::FRAC_2_PI * second.sqrt().atan2(difference.sqrt())
    }
}
