//! A place on a conic in numbers, from its eccentric anomaly E, or from H on a hyperbola. [`Ellipse`](super::kepler::Ellipse) has the places of an ellipse in lanes.
//!
//! Versines 1 − cos E = 2 sin² E/2 and cosh H − 1 = 2 sinh² H/2 replace the cosines, so that nothing cancels for e → 1.

use crate::orbit::hyperbola::hyperbolic_anomaly;
use crate::orbit::kepler::eccentric_anomaly;

/// A place on a conic, in units of |a|.
pub(crate) struct ConicPoint {
    /// The position along the direction to the pericentre: cos E − e, or e − cosh H.
    pub(crate) x: f64,
    /// Of E or, hyperbolic ones, of H.
    pub(crate) sine: f64,
    pub(crate) cosine: f64,
    pub(crate) radius: f64,
    /// −1 on a hyperbola.
    pub(crate) sign: f64,
}

impl ConicPoint {
    #[inline(always)]
    pub(crate) fn on_ellipse(mean: f64, e: f64) -> Self {
        let anomaly = if e == 0.0 { mean } else { eccentric_anomaly(mean, e) };
        let (half_sine, half_cosine) = (0.5 * anomaly).sin_cos();
        let versed = 2.0 * half_sine * half_sine;
        let sine = 2.0 * half_sine * half_cosine;
        Self { x: (1.0 - e) - versed, sine, cosine: 1.0 - versed, radius: (1.0 - e) + e * versed, sign: 1.0 }
    }

    pub(crate) fn on_hyperbola(mean: f64, e: f64) -> Self {
        let anomaly = hyperbolic_anomaly(mean, e);
        let half = (0.5 * anomaly).sinh();
        let versed = 2.0 * half * half;
        let radius = (e - 1.0) + e * versed;
        Self { x: (e - 1.0) - versed, sine: anomaly.sinh(), cosine: 1.0 + versed, radius, sign: -1.0 }
    }
}

/// The true anomaly f in (−π, π] of E, or of H for e > 1: tan f/2 = √((1 + e)/(1 − e)) tan E/2 = √((e + 1)/(e − 1)) tanh H/2.
pub(crate) fn true_anomaly(anomaly: f64, e: f64) -> f64 {
    if e > 1.0 {
        return 2.0 * (((e + 1.0) / (e - 1.0)).sqrt() * (0.5 * anomaly).tanh()).atan();
    }
    let (half_sine, half_cosine) = (0.5 * anomaly).sin_cos();
    2.0 * ((1.0 + e).sqrt() * half_sine).atan2((1.0 - e).sqrt() * half_cosine)
}
