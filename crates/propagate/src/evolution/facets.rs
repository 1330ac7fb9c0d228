//! Radiation pressure on facets, without shadows (weak torques (8) to (10)).
//!
//! Each facet reflects the fraction ρ_s of the light like a mirror and scatters ρ_d by Lambert's law; it radiates the fraction ε of what it absorbs at once from the same side.

use nalgebra::Vector3;

use super::harmonic::{Form, half_range, harmonic_parts, zonal_sum};
use super::sphere::{SphereRule, check_degree};
use crate::error::{Error, torque_refused};
use crate::input::torque::Torque;
use crate::input::torque_source::{SourcePath, TorqueSource};

/// How a surface reflects and radiates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish {
    /// Fraction of the light that is reflected like a mirror.
    pub specular: f64,
    /// Fraction that is scattered by Lambert's law.
    pub diffuse: f64,
    /// Fraction of the absorbed light that is radiated at once from the same side by Lambert's law: 1 without thermal inertia, 0 if it leaves without a recoil.
    pub emission: f64,
}

/// A flat side of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// Outward normal, of any length.
    pub normal: [f64; 3],
    /// Its area.
    pub area: f64,
    /// The centre of its area, from the centre of mass.
    pub centroid: [f64; 3],
    /// Its finish.
    pub finish: Finish,
}

/// The light: where it comes from, and its pressure there.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The place of the source, from the body.
    pub path: SourcePath,
    /// Pressure of absorbed light at the reference distance.
    pub pressure: f64,
    /// The reference distance; `None` for a direction, and for an orbit without a semi-major axis, whose semi-major axis it then is.
    pub at: Option<f64>,
}

impl Light {
    /// The source with the name of the polynomials, whose light falls with the square of the distance.
    fn source(&self) -> Result<TorqueSource, Error> {
        if !(self.pressure.is_finite() && self.pressure > 0.0) {
            return Err(torque_refused("pressure", self.pressure, "positive and finite"));
        }
        let source = TorqueSource::new("s", self.path.clone());
        match (&self.path, self.at) {
            (SourcePath::Direction(_), Some(at)) => {
                Err(torque_refused("at", at, "absent for a direction, which has no distance"))
            }
            (SourcePath::Direction(_), None) => Ok(source),
            (_, at) => Ok(source.falling(2.0, at)),
        }
    }
}

/// A facet with a normal of length 1 and the pressure in its area.
struct Plate {
    normal: Vector3<f64>,
    force: f64,
    centroid: Vector3<f64>,
    specular: f64,
    /// ⅔(ρ_d + ε ρ_a)
    lambert: f64,
}

impl Plate {
    fn of(facet: &Facet, pressure: f64) -> Result<Self, Error> {
        let Finish { specular, diffuse, emission } = facet.finish;
        for (argument, value) in [("specular", specular), ("diffuse", diffuse), ("emission", emission)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(torque_refused(argument, value, "from 0 to 1"));
            }
        }
        if specular + diffuse > 1.0 {
            return Err(torque_refused("specular + diffuse", specular + diffuse, "at most 1"));
        }
        if !(facet.area.is_finite() && facet.area >= 0.0) {
            return Err(torque_refused("area", facet.area, "finite and not negative"));
        }
        let [normal, centroid] = [facet.normal, facet.centroid].map(Vector3::from);
        for (argument, vector, zero) in [("normals", &normal, false), ("centroids", &centroid, true)] {
            if !(vector.iter().all(|x| x.is_finite()) && (zero || vector.amax() > 0.0)) {
                return Err(Error::Direction { argument, value: vector.as_slice().to_vec() });
            }
        }
        let normal = (normal / normal.amax()).normalize();
        let lambert = 2.0 / 3.0 * (diffuse + emission * (1.0 - specular - diffuse));
        Ok(Self { normal, force: pressure * facet.area, centroid, specular, lambert })
    }

    /// The torque (8) for a unit vector to the source.
    fn torque(&self, u: &Vector3<f64>) -> Vector3<f64> {
        let cosine = self.normal.dot(u);
        if cosine <= 0.0 {
            return Vector3::zeros();
        }
        // F = −P A μ [(1−ρ_s) u + (2 ρ_s μ + ⅔(ρ_d + ε ρ_a)) n]
        let along = u * (1.0 - self.specular) + self.normal * (2.0 * self.specular * cosine + self.lambert);
        self.centroid.cross(&along) * (-self.force * cosine)
    }
}

impl Torque {
    /// The torque of light on flat plates (weak torques (8)), as polynomials to a degree, without shadows.
    ///
    /// ```
    /// use andoyer_propagate::torques::{Facet, Finish, Light, SourcePath, Torque};
    /// let finish = Finish { specular: 0.2, diffuse: 0.1, emission: 1.0 };
    /// let plate = Facet { normal: [0.0, 0.0, 1.0], area: 2.0, centroid: [0.5, 0.0, 0.0], finish };
    /// let light = Light { path: SourcePath::Direction([1.0, 0.0, 1.0]), pressure: 4.56e-6, at: None };
    /// let Torque::Polynomial(torque) = Torque::panels(&[plate], &light, 8)? else { unreachable!() };
    /// assert!(torque.degree() == 8 && torque.truncation() < 0.02);
    /// # Ok::<(), andoyer_propagate::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Torque`] for a degree of 0 or above 8, no facet, a fraction outside 0 to 1, a negative area, a pressure that is not positive; a reference distance for a direction, or none for an orbit with a semi-major axis or a table.
    /// - [`Error::Direction`] for a normal of 0, and for numbers that are not finite.
    pub fn panels(facets: &[Facet], light: &Light, degree: u32) -> Result<Self, Error> {
        check_degree(degree)?;
        let source = light.source()?;
        if facets.is_empty() {
            return Err(torque_refused("areas", "none", "at least one facet"));
        }
        let plates = facets.iter().map(|facet| Plate::of(facet, light.pressure)).collect::<Result<Vec<_>, _>>()?;
        let forms = polynomials(&plates, degree)?;
        let rule = SphereRule::of_degree(degree)?;
        let total = |u: [f64; 3]| plates.iter().map(|plate| plate.torque(&u.into())).sum::<Vector3<f64>>().into();
        let values: Vec<[f64; 3]> = rule.directions().into_iter().map(total).collect();
        let size: f64 = plates.iter().map(|plate| plate.force * plate.centroid.norm()).sum();
        rule.truncated(&forms, (&values, size), source)
    }

    /// The torque of light on a shape of triangles with one finish, counter-clockwise as seen from outside; vertices from the centre of mass, in body axes.
    ///
    /// # Errors
    /// As [`Torque::panels`], and [`Error::Torque`] for a triangle with an index that is no vertex, and for a closed shape whose triangles run clockwise.
    pub fn from_facets(
        vertices: &[[f64; 3]],
        triangles: &[[usize; 3]],
        finish: Finish,
        light: &Light,
        degree: u32,
    ) -> Result<Self, Error> {
        let mut facets = Vec::with_capacity(triangles.len());
        let (mut area_sum, mut areas, mut volume) = (Vector3::zeros(), 0.0, 0.0);
        for triangle in triangles {
            if let Some(index) = triangle.iter().find(|index| **index >= vertices.len()) {
                return Err(torque_refused(
                    "triangles",
                    index,
                    &format!("below the number of vertices, {}", vertices.len()),
                ));
            }
            let [a, b, c] = triangle.map(|index| Vector3::from(vertices[index]));
            let doubled = (b - a).cross(&(c - a));
            let (area, centroid) = (0.5 * doubled.norm(), (a + b + c) / 3.0);
            // A triangle without an area has no normal and no torque.
            if area == 0.0 {
                continue;
            }
            area_sum += doubled * 0.5;
            areas += area;
            volume += a.dot(&b.cross(&c)) / 6.0;
            facets.push(Facet { normal: doubled.into(), area, centroid: centroid.into(), finish });
        }
        if area_sum.norm() < 1e-6 * areas && volume < 0.0 {
            let bound = "counter-clockwise as seen from outside: the volume of the closed shape is negative";
            return Err(torque_refused("triangles", "clockwise", bound));
        }
        Self::panels(&facets, light, degree)
    }
}

/// The harmonics of the torque of all plates (10), as sums of the degrees up to the last.
fn polynomials(plates: &[Plate], degree: u32) -> Result<[Form; 3], Error> {
    let mut forms = [Form::zero(), Form::zero(), Form::zero()];
    // x × u P_l has the degrees l ± 1.
    for l in 0..=degree + 1 {
        let [first, second] = [half_range(1, l), half_range(2, l)];
        // −P A (1−ρ_s) b⁽¹⁾ x
        let along = |plate: &Plate| plate.centroid * (-plate.force * (1.0 - plate.specular) * first);
        let weighted: Vec<_> = plates.iter().map(|plate| (plate.normal, along(plate))).collect();
        let arm = if first == 0.0 { [Form::zero(), Form::zero(), Form::zero()] } else { zonal_sum(l, &weighted)? };
        for (axis, form) in forms.iter_mut().enumerate() {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            let cross = &arm[next].multiply(&Form::variable(last)?)? - &arm[last].multiply(&Form::variable(next)?)?;
            for (_, part) in harmonic_parts(&cross)?.range(..=degree) {
                *form += part;
            }
        }
        if l <= degree {
            // −P A (2 ρ_s b⁽²⁾ + ⅔(ρ_d + ε ρ_a) b⁽¹⁾) x × n
            let weight = |plate: &Plate| -plate.force * (2.0 * plate.specular * second + plate.lambert * first);
            let weighted = |plate: &Plate| (plate.normal, plate.centroid.cross(&plate.normal) * weight(plate));
            let part = zonal_sum(l, &plates.iter().map(weighted).collect::<Vec<_>>())?;
            forms.iter_mut().zip(&part).for_each(|(form, part)| *form += part);
        }
    }
    Ok(forms)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The force of light at 45° on a plate of unit area and pressure: its torques about arms along the axes are its components.
    fn force(finish: Finish) -> Vector3<f64> {
        let u = Vector3::new(1.0, 0.0, 1.0).normalize();
        let about = |arm: [f64; 3]| {
            let facet = Facet { normal: [0.0, 0.0, 2.0], area: 1.0, centroid: arm, finish };
            Plate::of(&facet, 1.0).expect("a plate").torque(&u)
        };
        // e₁ × F = (0, −F₃, F₂), e₂ × F = (F₃, 0, −F₁)
        let [first, second] = [about([1.0, 0.0, 0.0]), about([0.0, 1.0, 0.0])];
        Vector3::new(-second.z, first.z, second.x)
    }

    #[test]
    fn panel_at_forty_five_degrees_has_its_force() {
        let u = Vector3::new(1.0, 0.0, 1.0).normalize();
        for (emission, size, angle) in [(0.0, 0.76078, 13.280), (1.0, 1.05583, 22.738)] {
            let force = force(Finish { specular: 0.2, diffuse: 0.1, emission });
            assert!((force.norm() - size).abs() < 5e-6 && force.y == 0.0);
            // From −u towards −n.
            assert!(((-u).angle(&force).to_degrees() - angle).abs() < 5e-4);
            assert!(force.x.abs() < (u * size).x);
        }
        // The term along the normal is 32.49 % of the force at ε = 0; a law of 1.5 P A μ along −u is too large by 1.394.
        let dark = force(Finish { specular: 0.2, diffuse: 0.1, emission: 0.0 });
        let along = 0.8 * 0.5_f64.sqrt();
        assert!(((dark + u * along).norm() / dark.norm() - 0.3249).abs() < 5e-5);
        assert!((1.5 * 0.5_f64.sqrt() / dark.norm() - 1.394).abs() < 5e-4);
    }

    #[test]
    fn light_from_behind_has_no_force() {
        let finish = Finish { specular: 0.2, diffuse: 0.1, emission: 1.0 };
        let facet = Facet { normal: [0.0, 0.0, -1.0], area: 1.0, centroid: [1.0, 0.0, 0.0], finish };
        assert_eq!(Plate::of(&facet, 1.0).expect("a plate").torque(&Vector3::z()), Vector3::zeros());
    }
}
