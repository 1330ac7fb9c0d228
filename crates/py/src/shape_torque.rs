//! Torques of shapes: `Torque.from_facets`, `.panels`, `.sphere`, and what is read of them.

use std::path::PathBuf;

use andoyer_propagate::torques::{
    DistanceRule, Facet, Finish, Light, Mesh, SourcePath, SphereRule, Torque as Inner, TorqueSource,
};
use andoyer_series::error::Kind;
use numpy::{IntoPyArray, PyArrayDyn, PyArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::array;
use crate::computing::detached;
use crate::error;
use crate::order::whole_number;
use crate::scene::arguments::kind;
use crate::torque::{Torque, source_path};

#[pymethods]
impl Torque {
    /// The torque of light on a shape of triangles, as polynomials in the direction to the light (weak torques, section 3). The shape casts no shadows on itself.
    ///
    /// Each triangle reflects the fraction `specular` like a mirror and scatters `diffuse` by Lambert's law; of the rest, which it absorbs, it radiates `emission` at once from the same side by Lambert's law.
    /// With ``emission=1`` this is the YORP effect without thermal inertia. A shape with shadows needs a table of its torque: `Torque.sphere`.
    ///
    /// Parameters
    /// ----------
    /// vertices : array_like, shape (n, 3), or path of an OBJ file
    ///     From the centre of mass, in body axes.
    /// triangles : array_like of int, shape (k, 3), optional
    ///     Indices of vertices from 0, counter-clockwise as seen from outside. An OBJ file has its own.
    /// specular, diffuse, emission : float, optional
    ///     Fractions from 0 to 1.
    /// pressure : float
    ///     Pressure of absorbed light at the distance `at`: 4.56e-6 N/m² one astronomical unit from the Sun.
    /// source : Orbit, TabulatedOrbit or array_like of shape (3,)
    ///     Where the light comes from, as seen from the body; an array is a fixed inertial direction.
    /// at : float, optional
    ///     The distance of `pressure`, in the unit of `semi_major_axis` or of the table. For an `Orbit` without one it is in semi-major axes, by default 1. A direction has none.
    /// degree : int, optional
    ///     Degree of the polynomials, 1 to 8; `truncation` is what they leave out.
    /// scale : float, optional
    ///     Length of the unit of the vertices: 1000 for an OBJ file in km.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A fraction outside 0 to 1, specular + diffuse above 1, a pressure that is not positive, a degree outside 1 to 8, an index that is no vertex, a closed shape whose triangles run clockwise, a distance for a direction, none for an orbit with `semi_major_axis` or a table.
    /// FileError
    ///     An OBJ file that cannot be read or has no faces.
    ///
    /// Examples
    /// --------
    /// A tetrahedron whose sides absorb all light. Over all directions the even degrees of its torque are 0.
    ///
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1.5]]
    /// >>> sides = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    /// >>> torque = Torque.from_facets(corners, sides, pressure=4.56e-6, source=[1, 0, 0])
    /// >>> torque.degree, torque.value([0, 0, 2.0]).shape
    /// (8, (3,))
    #[classmethod]
    #[pyo3(
        signature = (vertices, triangles=None, *, specular=None, diffuse=None, emission=None, pressure, source, at=None, degree=None, scale=None),
        text_signature = "(vertices, triangles=None, *, specular=0.0, diffuse=0.0, emission=1.0, pressure, source, at=None, degree=8, scale=1.0)"
    )]
    #[expect(clippy::too_many_arguments, reason = "Python's keyword arguments")]
    fn from_facets(
        class: &Bound<'_, PyType>,
        vertices: &Bound<'_, PyAny>,
        triangles: Option<&Bound<'_, PyAny>>,
        specular: Option<&Bound<'_, PyAny>>,
        diffuse: Option<&Bound<'_, PyAny>>,
        emission: Option<&Bound<'_, PyAny>>,
        pressure: &Bound<'_, PyAny>,
        source: &Bound<'_, PyAny>,
        at: Option<&Bound<'_, PyAny>>,
        degree: Option<&Bound<'_, PyAny>>,
        scale: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (light, degree) = (light(pressure, source, at)?, asked_degree(degree)?);
        let finish = Finish {
            specular: optional("specular", specular, 0.0)?,
            diffuse: optional("diffuse", diffuse, 0.0)?,
            emission: optional("emission", emission, 1.0)?,
        };
        let scale = optional("scale", scale, 1.0)?;
        let mut mesh = match triangles {
            Some(triangles) => Mesh { vertices: array::vectors("vertices", vertices)?, triangles: indices(triangles)? },
            None => {
                let path: PathBuf = vertices.extract().map_err(|_| {
                    PyTypeError::new_err("triangles: none are given, and vertices is not the path of an OBJ file")
                })?;
                Mesh::from_obj(path).map_err(error::propagation)?
            }
        };
        mesh.vertices.iter_mut().flatten().for_each(|x| *x *= scale);
        let torque = || Inner::from_facets(&mesh.vertices, &mesh.triangles, finish, &light, degree);
        detached(class.py(), error::propagation, torque).map(Self)
    }

    /// The torque of light on flat plates, as polynomials in the direction to the light, without shadows.
    ///
    /// Parameters
    /// ----------
    /// normals : array_like, shape (k, 3)
    ///     Outward normals of any length, in body axes.
    /// areas : array_like, shape (k,)
    /// centroids : array_like, shape (k, 3)
    ///     Centres of the areas, from the centre of mass.
    /// two_sided : bool, optional
    ///     If True, each plate has a second side with the same finish. Sides that differ, such as solar cells and their back, are two plates with opposite normals.
    /// specular, diffuse, emission : float or array_like of shape (k,), optional
    ///     As of `Torque.from_facets`.
    /// pressure, source, at, degree
    ///     As of `Torque.from_facets`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     As of `Torque.from_facets`; arrays of unequal length; a negative area; a normal of length 0.
    ///
    /// Examples
    /// --------
    /// >>> torque = Torque.panels([[0, 0, 1]], [2.0], [[0.5, 0, 0]], specular=0.2, pressure=4.56e-6, source=[1, 0, 1])
    /// >>> torque.truncation < 0.02
    /// True
    #[classmethod]
    #[pyo3(
        signature = (normals, areas, centroids, *, two_sided=false, specular=None, diffuse=None, emission=None, pressure, source, at=None, degree=None),
        text_signature = "(normals, areas, centroids, *, two_sided=False, specular=0.0, diffuse=0.0, emission=1.0, pressure, source, at=None, degree=8)"
    )]
    #[expect(clippy::too_many_arguments, reason = "Python's keyword arguments")]
    fn panels(
        class: &Bound<'_, PyType>,
        normals: &Bound<'_, PyAny>,
        areas: &Bound<'_, PyAny>,
        centroids: &Bound<'_, PyAny>,
        two_sided: bool,
        specular: Option<&Bound<'_, PyAny>>,
        diffuse: Option<&Bound<'_, PyAny>>,
        emission: Option<&Bound<'_, PyAny>>,
        pressure: &Bound<'_, PyAny>,
        source: &Bound<'_, PyAny>,
        at: Option<&Bound<'_, PyAny>>,
        degree: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (light, degree) = (light(pressure, source, at)?, asked_degree(degree)?);
        let normals = array::vectors("normals", normals)?;
        let k = normals.len();
        let areas = array::fixed_length("areas", areas, k)?;
        let centroids = array::vectors("centroids", centroids)?;
        if centroids.len() != k {
            return Err(error::shape("centroids", &[centroids.len(), 3], &format!("({k}, 3)")));
        }
        let [specular, diffuse, emission] =
            [("specular", specular, 0.0), ("diffuse", diffuse, 0.0), ("emission", emission, 1.0)]
                .map(|(argument, value, default)| each(argument, value, default, k));
        let (specular, diffuse, emission) = (specular?, diffuse?, emission?);
        let facet = |i: usize| Facet {
            normal: normals[i],
            area: areas[i],
            centroid: centroids[i],
            finish: Finish { specular: specular[i], diffuse: diffuse[i], emission: emission[i] },
        };
        let mut facets: Vec<Facet> = (0..k).map(facet).collect();
        if two_sided {
            let back = |facet: &Facet| Facet { normal: facet.normal.map(|x| -x), ..*facet };
            facets.extend(facets.iter().map(back).collect::<Vec<_>>());
        }
        detached(class.py(), error::propagation, || Inner::panels(&facets, &light, degree)).map(Self)
    }

    /// The torque with given values for all directions to a source, as polynomials.
    ///
    /// Parameters
    /// ----------
    /// table : callable, or array_like of shape (3, (d + 1)²)
    ///     T(u): called once with unit vectors to the source in body axes, shape (n, 3), it returns torques in body axes, shape (n, 3); from ray tracing, say. Or coefficients of orthonormal real
    ///     harmonics of degrees up to d: column l² + l ± m is P_l^m(cos θ), m ≥ 0, times √2 cos mφ with the upper sign, √2 sin mφ with the lower one, 1 for m = 0, normalized to 1 on the sphere, without the sign (−1)^m.
    /// source : Orbit, TabulatedOrbit or array_like of shape (3,)
    /// at : float, optional
    ///     The distance of the values, as of `Torque.from_facets`.
    /// power : float, optional
    ///     The torque falls with this power of the distance; by default 2, as light. A direction has no distance.
    /// law : callable, optional
    ///     f(r) in the place of a power: the torque is multiplied by f(r)/f(at), such as a law of sublimation. Called once with distances in the unit of `at`, shape (n,), it returns numbers of at least 0, shape (n,).
    ///     It becomes a Chebyshev series in 1/r of at most 128 terms between the nearest and the farthest distance of the source; `truncation` has what this leaves out, too.
    /// degree : int, optional
    ///     Degree of the polynomials, 1 to 8.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A value that is not finite; an array of another shape; a degree outside 1 to 8; a law with a power, or for a direction; a value of a law that is negative, or 0 at `at`; a law that is not smooth: its series leaves out more than
    ///     1e-6 of its largest value.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> torque = Torque.sphere(lambda u: np.cross(u, u * [1.0, 2.0, 3.0]), source=[1, 0, 0], degree=2)
    /// >>> torque.value([0.6, 0.0, 0.8]).round(12), torque.truncation < 1e-12
    /// (array([ 0.  , -0.96,  0.  ]), True)
    #[classmethod]
    #[pyo3(
        signature = (table, *, source, at=None, power=None, law=None, degree=None),
        text_signature = "(table, *, source, at=None, power=2.0, law=None, degree=8)"
    )]
    fn sphere(
        class: &Bound<'_, PyType>,
        table: &Bound<'_, PyAny>,
        source: &Bound<'_, PyAny>,
        at: Option<&Bound<'_, PyAny>>,
        power: Option<&Bound<'_, PyAny>>,
        law: Option<&Bound<'_, PyAny>>,
        degree: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let py = class.py();
        let rule = SphereRule::of_degree(asked_degree(degree)?).map_err(error::propagation)?;
        let path = source_path(source)?;
        let power = power.map(|power| array::number("power", power)).transpose()?;
        let at = at.map(|at| array::number("at", at)).transpose()?;
        let law = law.map(|law| strengths(law, path.clone(), (at, power))).transpose()?;
        let values = if table.is_callable() {
            let directions = array::constant_rows(py, &rule.directions())?;
            array::vectors("table", &table.call1((directions,))?)?
        } else {
            rule.of_harmonics(&array::coefficients("table", table)?).map_err(error::propagation)?
        };
        let torque = || match &law {
            Some((distances, strengths)) => distances.torque(strengths, (&rule, &values)),
            None => {
                let falls = !matches!(path, SourcePath::Direction(_));
                let source = TorqueSource::new("s", path.clone());
                rule.torque(&values, source.falling(power.unwrap_or(if falls { 2.0 } else { 0.0 }), at))
            }
        };
        detached(py, error::propagation, torque).map(Self)
    }

    /// The torque for directions to its source, at the reference distance.
    ///
    /// Parameters
    /// ----------
    /// u : array_like, shape (3,) or (n, 3)
    ///     Vectors to the source in body axes, of any length.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (3,) or (n, 3)
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A torque that is no polynomial in the direction to one source; a vector of length 0.
    fn value<'py>(&self, py: Python<'py>, u: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let rows = array::MemberRows::<3>::of_shape("u", u, "(3,) or (n, 3)")?;
        let (many, rows) = (rows.members(), rows.repeated(1));
        let Inner::Polynomial(torque) = &self.0 else {
            let message = format!("value: a {} torque is no polynomial in the direction to a source", self.0.kind());
            return Err(error::input("value", self.0.kind(), "a polynomial in the direction to one source", message));
        };
        let values = rows.iter().map(|row| torque.value(*row)).collect::<Result<Vec<_>, _>>();
        let values = values.map_err(error::propagation)?.as_flattened().to_vec().into_pyarray(py);
        match many {
            Some(n) => Ok(values.reshape(vec![n, 3])?),
            None => Ok(values.reshape(vec![3])?),
        }
    }

    /// The largest degree in directions and rates.
    #[getter]
    fn degree(&self) -> u32 {
        self.0.degree()
    }

    /// What the polynomials of a shape leave out: root mean square over all directions, relative to that of the torque; 0 for torques that are not made of shapes.
    #[getter]
    fn truncation(&self) -> f64 {
        self.0.truncation()
    }
}

/// The distances at which a law of a source must be known, and its values there.
fn strengths(
    law: &Bound<'_, PyAny>,
    path: SourcePath,
    (at, power): (Option<f64>, Option<f64>),
) -> PyResult<(DistanceRule, Vec<f64>)> {
    if let Some(power) = power {
        let message = format!("power = {power}: it must be absent beside a law, which has the place of a power");
        return Err(error::input("power", power, "absent beside a law", message));
    }
    if !law.is_callable() {
        return Err(PyTypeError::new_err(format!("law must be a callable of distances, not {}", kind(law))));
    }
    let rule = DistanceRule::new("s", path, at).map_err(error::propagation)?;
    let distances = rule.distances();
    let found = law.call1((array::constant(law.py(), &distances),))?;
    let values = array::fixed_length("law", &found, distances.len())?;
    Ok((rule, values))
}

fn optional(argument: &str, value: Option<&Bound<'_, PyAny>>, default: f64) -> PyResult<f64> {
    value.map_or(Ok(default), |value| array::number(argument, value))
}

fn asked_degree(value: Option<&Bound<'_, PyAny>>) -> PyResult<u32> {
    let degree = value.map_or(Ok(8), |value| whole_number("degree", value, 1, 8, Kind::Input))?;
    Ok(u32::try_from(degree).unwrap_or(u32::MAX)) // refused by the Rust crate
}

fn light(pressure: &Bound<'_, PyAny>, source: &Bound<'_, PyAny>, at: Option<&Bound<'_, PyAny>>) -> PyResult<Light> {
    let at = at.map(|at| array::number("at", at)).transpose()?;
    Ok(Light { path: source_path(source)?, pressure: array::number("pressure", pressure)?, at })
}

/// One number for all plates, or one for each.
fn each(argument: &str, value: Option<&Bound<'_, PyAny>>, default: f64, k: usize) -> PyResult<Vec<f64>> {
    let Some(value) = value else { return Ok(vec![default; k]) };
    match array::numbers_of(argument, value)?[..] {
        [one] if value.len().is_err() => Ok(vec![one; k]),
        _ => array::fixed_length(argument, value, k),
    }
}

fn indices(value: &Bound<'_, PyAny>) -> PyResult<Vec<[usize; 3]>> {
    let rows = array::vectors("triangles", value)?;
    let refused = |index: f64| {
        error::input(
            "triangles",
            index,
            "whole numbers from 0",
            format!("triangles has {index}: it must be whole numbers from 0"),
        )
    };
    // A double holds whole numbers up to 2^53.
    let whole = |index: f64| {
        if index >= 0.0 && index.fract() == 0.0 && index < 9e15 { Ok(index as usize) } else { Err(refused(index)) }
    };
    rows.into_iter().map(|[a, b, c]| Ok([whole(a)?, whole(b)?, whole(c)?])).collect()
}
