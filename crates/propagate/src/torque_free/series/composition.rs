//! The Fourier coefficients of the quaternion of theory §8, from those of w and y − y′.

use super::tables::FourierExpansion;
use crate::torque_free::harmonics::CayleyKleinSeries;

/// Grid points in a period for each order. The products of theory §8 have more than the 2N+1 harmonics of ζ. Aliasing from beyond eight times the order is
/// smaller than the square of the truncation error.
const GRID_PER_ORDER: usize = 8;

/// The ellipse of (x, X) at first order: ζ = long·Re w + i short·Im w, with w in units of √M.
///
/// Both axes are stored. If they were computed as sum and difference of the parts of w and w̄ in ζ, the short axis would lose half its digits at β → 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WobbleEllipse {
    /// The axis of X, √(2ω).
    pub(crate) long: f64,
    /// The axis of x, √(2/ω).
    pub(crate) short: f64,
}

impl WobbleEllipse {
    /// The ellipse from ω² = (C/A − 1)/(C/B − 1) ≥ 1 (theory §1).
    pub(crate) fn new(omega_square: f64) -> Self {
        let omega = omega_square.sqrt();
        Self { long: (2.0 * omega).sqrt(), short: (2.0 / omega).sqrt() }
    }

    /// w/√M from ζ.
    pub(crate) fn oscillator(&self, zeta: [f64; 2]) -> [f64; 2] {
        [zeta[0] / self.long, zeta[1] / self.short]
    }
}

/// w/√M and y − y′ at an angle ℓ′; `trigonometry(h)` returns (sin hℓ′, cos hℓ′).
pub(crate) fn oscillator_and_longitude(
    expansion: &FourierExpansion,
    trigonometry: impl Fn(usize) -> (f64, f64),
) -> ([f64; 2], f64) {
    let order = expansion.longitude.len();
    let (mut real, mut imaginary) = (0.0, 0.0);
    for m in 0..=order {
        let (sine, cosine) = trigonometry(2 * m + 1);
        let (plus, minus) = (expansion.oscillator[order + 1 + m], expansion.oscillator[order - m]);
        real += (plus + minus) * cosine;
        imaginary += (plus - minus) * sine;
    }
    let terms = expansion.longitude.iter().enumerate();
    let longitude = terms.map(|(index, &c)| c * trigonometry(2 * index + 2).0).sum();
    ([real, imaginary], longitude)
}

/// Samples the composition of theory §8 over a quarter period and computes its harmonics.
pub(crate) fn harmonics(expansion: &FourierExpansion, ellipse: WobbleEllipse) -> CayleyKleinSeries {
    let order = expansion.longitude.len();
    let period = (GRID_PER_ORDER * (order + 1)).next_power_of_two();
    let quarter = period / 4;
    let circle: Vec<(f64, f64)> =
        (0..period).map(|g| (std::f64::consts::TAU * g as f64 / period as f64).sin_cos()).collect();
    let mut terms = vec![([0.0; 2], [0.0; 2]); 2 * order + 2];
    for g in 0..=quarter {
        let trigonometry = |harmonic: usize| circle[(harmonic * g) & (period - 1)];
        let (a, b) = composed(expansion, ellipse, trigonometry);
        // A period contains an end point twice and an inner point four times. A pair of harmonics ±h has twice the mean.
        let weight = if g == 0 || g == quarter { 4.0 } else { 8.0 } / period as f64;
        for (k, (even, odd)) in terms.iter_mut().enumerate() {
            let (sine, cosine) = trigonometry(2 * k);
            even[0] += weight * a[0] * cosine;
            even[1] += weight * a[1] * sine;
            let (sine, cosine) = trigonometry(2 * k + 1);
            odd[0] += weight * b[0] * cosine;
            odd[1] += weight * b[1] * sine;
        }
    }
    terms[0].0[0] *= 0.5; // the mean has only one coefficient
    CayleyKleinSeries::from_terms(terms)
}

/// a e^(−iy′/2) and b e^(−iy′/2) by theory §8.
fn composed(
    expansion: &FourierExpansion,
    ellipse: WobbleEllipse,
    trigonometry: impl Fn(usize) -> (f64, f64),
) -> ([f64; 2], [f64; 2]) {
    let (w, longitude) = oscillator_and_longitude(expansion, trigonometry);
    let zeta = [ellipse.long * w[0], ellipse.short * w[1]];
    let half_z = 0.25 * (zeta[0] * zeta[0] + zeta[1] * zeta[1]);
    let (sine, cosine) = (0.5 * longitude).sin_cos();
    // A low order fixed by the user can reach z > 2. The truncated motion then has no attitude, and the error bound shows this.
    let upper = (1.0 - half_z).max(0.0).sqrt();
    (
        [upper * cosine, upper * sine],
        [0.5 * (zeta[0] * cosine - zeta[1] * sine), 0.5 * (zeta[0] * sine + zeta[1] * cosine)],
    )
}
