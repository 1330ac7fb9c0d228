//! The binding of the playground: a scene as TOML goes in; its plan, periods and samples come out. It maps types and computes nothing.

use andoyer_propagate::options::Convention;
use andoyer_propagate::orbital::{ElementsOf, OrbitalAxes, OrbitalFrame};
use andoyer_propagate::{Body, Error, Motion, Scene};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// The name by which errors call a scene: no file is read.
const FILE: &str = "scene";

fn refused(error: Error) -> JsError {
    JsError::new(&error.to_string())
}

/// A solved scene.
#[wasm_bindgen]
pub struct Solved(Motion);

#[wasm_bindgen]
impl Solved {
    /// Solves the scene of a TOML text. A scene that is refused throws an `Error` with the key, its value and the bound.
    #[wasm_bindgen(constructor)]
    pub fn new(toml: &str) -> Result<Solved, JsError> {
        Scene::parse_toml(toml, FILE).and_then(|scene| scene.solve()).map(Self).map_err(refused)
    }

    /// The plan, as it is printed.
    pub fn plan(&self) -> String {
        self.0.plan().to_string()
    }

    /// "short-axis", "long-axis", "separatrix", …
    pub fn mode(&self) -> String {
        self.0.plan().mode().to_string()
    }

    /// "series", "closed", "integrated", …
    pub fn method(&self) -> String {
        self.0.plan().method().to_string()
    }

    /// Bound of the error of attitudes \[rad\].
    pub fn error_bound(&self) -> f64 {
        self.0.plan().error_bound()
    }

    /// σ/σ_sep.
    pub fn separatrix_ratio(&self) -> f64 {
        self.0.plan().separatrix_ratio()
    }

    /// E/E₀.
    pub fn energy_ratio(&self) -> f64 {
        self.0.energy_ratio()
    }

    /// The periods P_φ and P_ψ in a convention: "extremal-axis", "long-axis" or "short-axis".
    pub fn periods(&self, convention: &str) -> Result<Vec<f64>, JsError> {
        let periods = self.0.periods_of(convention.parse::<Convention>().map_err(refused)?);
        Ok(vec![periods.precession, periods.rotation])
    }

    /// The time of the state.
    pub fn epoch(&self) -> f64 {
        self.0.scene().state().epoch
    }

    /// First and last time of the span, or nothing.
    pub fn span(&self) -> Vec<f64> {
        self.0.scene().asked_span().map_or_else(Vec::new, |(start, stop)| vec![start, stop])
    }

    /// The principal moments (3).
    pub fn moments(&self) -> Vec<f64> {
        self.0.scene().body().moments().to_vec()
    }

    /// The principal axes in body components, one after the other (9).
    pub fn axes(&self) -> Vec<f64> {
        self.0.scene().body().principal_axes().as_slice().to_vec()
    }

    /// The attitude [x, y, z, w] (4) and the angular velocity in body components (3) at the epoch.
    pub fn state(&self) -> Vec<f64> {
        let state = self.0.scene().state();
        state.attitude.coords.iter().chain(state.angular_velocity.iter()).copied().collect()
    }

    /// Attitudes [x, y, z, w] at times: (4n).
    pub fn attitudes(&self, times: &[f64]) -> Result<Vec<f64>, JsError> {
        let mut attitudes = vec![[0.0; 4]; times.len()];
        self.0.attitudes_into(times, &mut attitudes).map_err(refused)?;
        Ok(attitudes.into_flattened())
    }

    /// Angular velocities in body components at times: (3n).
    pub fn rates(&self, times: &[f64]) -> Result<Vec<f64>, JsError> {
        let mut rates = vec![[0.0; 3]; times.len()];
        self.0.angular_velocities_into(times, &mut rates).map_err(refused)?;
        Ok(rates.into_flattened())
    }

    /// The number of disturbing bodies.
    pub fn orbits(&self) -> usize {
        self.0.scene().asked_disturbing().len()
    }

    /// The frame "lvlh" of the first disturbing body at times, as rotations into inertial components [x, y, z, w]: (4n). `elements_of` is "rotating" or "disturbing".
    pub fn frames(&self, times: &[f64], elements_of: &str) -> Result<Vec<f64>, JsError> {
        let elements_of = elements_of.parse::<ElementsOf>().map_err(refused)?;
        let frame = OrbitalFrame { elements_of, axes: OrbitalAxes::Lvlh, of: 0 };
        let mut frames = Vec::with_capacity(4 * times.len());
        for &time in times {
            let (rotation, _) = frame.at(self.0.scene().asked_disturbing(), time).map_err(refused)?;
            frames.extend(rotation.coords.iter());
        }
        Ok(frames)
    }

    /// The scene as TOML.
    pub fn toml(&self) -> String {
        self.0.scene().to_toml()
    }
}

/// The names of the catalogue.
#[wasm_bindgen]
pub fn catalogue() -> Vec<String> {
    Body::catalogue().into_iter().map(str::to_owned).collect()
}

/// Where the moments of a body of the catalogue come from.
#[wasm_bindgen]
pub fn source(name: &str) -> Result<String, JsError> {
    Body::source(name).map(str::to_owned).map_err(refused)
}
