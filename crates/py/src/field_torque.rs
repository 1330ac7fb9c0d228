//! `Torque.dipole` and `Torque.eddy`.

use andoyer_propagate::torques::{SourcePath, Torque as Inner};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::array::{fixed, is_matrix, matrix, number};
use crate::error;
use crate::field::Field;
use crate::scene::arguments::kind;
use crate::torque::Torque;

#[pymethods]
impl Torque {
    /// m × B of a magnetic moment fixed in the body, or commanded by the rates and the field.
    ///
    /// Parameters
    /// ----------
    /// moment : array_like of shape (3,), or sequence of three str
    ///     m, in the unit of the torque over that of the field (A m² with tesla and N m), in body axes. Texts are polynomials in the rates ``w1``, ``w2``, ``w3`` and in ``b1``, ``b2``, ``b3``, the body components of the
    ///     unit vector along the field: ``["2e3*(w2*b3 - w3*b2)", …]`` is a detumbling law.
    /// field : Field, or array_like of shape (3,)
    ///     An array is a uniform inertial field.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A moment that is not finite, a text that is no polynomial in these variables.
    /// TypeError
    ///     A field of another kind.
    ///
    /// Examples
    /// --------
    /// >>> orbit = Orbit(1.1e-3, semi_major_axis=6871.0, inclination=1.7)
    /// >>> earth = Field.dipole(radius=6371.2, equatorial=2.98e-5, axis=(0, 0, -1), orbit=orbit)
    /// >>> Torque.dipole([0.0, 0.0, 0.1], earth).kind
    /// 'polynomial'
    #[classmethod]
    fn dipole(_class: &Bound<'_, PyType>, moment: &Bound<'_, PyAny>, field: &Bound<'_, PyAny>) -> PyResult<Self> {
        let field = field_of(field)?;
        let texts: PyResult<Vec<String>> = moment.extract();
        let made = match texts {
            Ok(texts) if !moment.is_instance_of::<pyo3::types::PyString>() => {
                let three =
                    || PyTypeError::new_err("moment must be three numbers or three texts, one for each body axis");
                let [first, second, third] = &texts[..] else { return Err(three()) };
                Inner::steered_dipole([first, second, third], field)
            }
            _ => Inner::dipole(fixed("moment", moment)?, field),
        };
        made.map(Self).map_err(error::propagation)
    }

    /// (K(ω × B)) × B of eddy currents in a conducting body, with the magnetic tensor K (N. Ortiz Gómez and S. J. I. Walker 2015): it brakes the rotation across the field.
    ///
    /// The angular velocity is relative to inertial space: the field must turn slowly against the body. `partials` has its factor, by which a scalar K is known.
    ///
    /// Parameters
    /// ----------
    /// conductivity : float, or array_like of shape (3, 3)
    ///     K, in moment × rate over the square of the field, in body axes; positive definite, or it may add energy. A thin spherical shell of the radius a, thickness d and conductivity σ has 2π/3 σ a⁴ d.
    /// field : Field, or array_like of shape (3,)
    ///     An array is a uniform inertial field.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A value that is not finite; an array of another shape.
    ///
    /// Examples
    /// --------
    /// A sphere that rotates across a uniform field: the rate decays with K B²/I.
    ///
    /// >>> torque = Torque.eddy(1e3, [3e-3, 0.0, 0.0])
    /// >>> motion = Scene(Body([1, 1, 1]), [0, 0, 0, 1], [0, 0, 1], torques=torque, span=(0, 100), tolerance=1e-9).solve()
    /// >>> float(motion.angular_velocity(100.0)[2].round(6))  # exp(-0.9)
    /// 0.40657
    #[classmethod]
    fn eddy(_class: &Bound<'_, PyType>, conductivity: &Bound<'_, PyAny>, field: &Bound<'_, PyAny>) -> PyResult<Self> {
        let field = field_of(field)?;
        let tensor = if is_matrix("conductivity", conductivity) || conductivity.len().is_ok() {
            matrix("conductivity", conductivity)?
        } else {
            let scalar = number("conductivity", conductivity)?;
            std::array::from_fn(|i| std::array::from_fn(|k| if i == k { scalar } else { 0.0 }))
        };
        Inner::eddy(tensor, field).map(Self).map_err(error::propagation)
    }
}

/// The source of a field, or of a uniform one.
fn field_of(value: &Bound<'_, PyAny>) -> PyResult<SourcePath> {
    if let Ok(field) = value.cast::<Field>() {
        return Ok(field.get().0.source());
    }
    let uniform = fixed::<3>("field", value)
        .map_err(|_| PyTypeError::new_err(format!("field must be a Field or three numbers, not {}", kind(value))))?;
    Ok(SourcePath::Direction(uniform))
}
