//! The harmonics of the load along a polhode (docs/relaxation.md, equations 8 to 10).
//!
//! The products ω_i ω_j are sn dn, cn dn, sn cn and sn² of theory §10 times constants. Their Fourier series in ℓ′ are series in the nome, and no formula divides by
//! the modulus k. Lengths are in radii of the sphere of the same volume, moments in units of the largest one, rates in units of M/C; W is in units of ϱ²R⁷(M/C)⁴/S.

use std::f64::consts::{FRAC_PI_2, PI};

use andoyer_double::arithmetic_geometric_mean;

use super::elastic::StrainEnergy;

/// Terms smaller than this fraction of the largest one are dropped.
const NEGLIGIBLE: f64 = 1e-17;
/// More harmonics than any polhode has: 2,400 are above this fraction for 1 − x = 1e-200.
const MOST: u32 = 20_000;

/// A polhode in one of the two modes: x = sin² of the largest angle between G and the axis of the mode, and 1 − x, which is Q1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Swing {
    pub(super) long_axis: bool,
    pub(super) x: f64,
    pub(super) complement: f64,
}

impl Swing {
    /// From y = ln(x/(1 − x)).
    pub(super) fn new(long_axis: bool, y: f64) -> Self {
        Self { long_axis, x: 1.0 / (1.0 + (-y).exp()), complement: 1.0 / (1.0 + y.exp()) }
    }
}

/// The moments over the largest one, with the body axis of each, in the order of a mode: its own axis is the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ModeAxes {
    pub(super) order: [usize; 3],
    pub(super) moments: [f64; 3],
    /// d = C(B − A)/(B(C − A)) and b/a = 1 − d = A(C − B)/(B(C − A)).
    pub(super) spread: f64,
    ratio: f64,
    /// √(ab)/C.
    rate: f64,
    /// 1/B − 1/C, negative in the long-axis mode.
    pub(super) range: f64,
}

impl ModeAxes {
    /// The axes of a mode of a body that is no sphere.
    pub(super) fn new(moments: [f64; 3], long_axis: bool) -> Self {
        let mut order = [0, 1, 2];
        order.sort_by(|&one, &other| moments[one].total_cmp(&moments[other]));
        let largest = moments[order[2]];
        if long_axis {
            order.reverse();
        }
        let [a, b, c] = order.map(|axis| moments[axis] / largest);
        Self {
            order,
            moments: [a, b, c],
            spread: c * (b - a) / (b * (c - a)),
            ratio: a * (c - b) / (b * (c - a)),
            // ab = (C/A − 1)(C/B − 1)
            rate: ((c - a) / a * ((c - b) / b)).sqrt() / c,
            range: (c - b) / (b * c),
        }
    }

    /// E/E0 = C_max (1/C + x (1/B − 1/C)), with the largest moment C_max (equation 8).
    pub(super) fn energy_ratio(&self, x: f64) -> f64 {
        self.moments[2].recip() + x * self.range
    }

    /// E_c/x for c = 23, 31, 12, d (equation 9).
    fn energies(&self, strain: &StrainEnergy, x: f64, greatest: f64) -> [f64; 4] {
        let [a, b, c] = self.moments;
        let [w23, w31, w12] = self.order.map(|axis| strain.products[axis]);
        // r/x = (−(b/a)/A², 1/B², −d/C²)
        let r = [-self.ratio / (a * a), 1.0 / (b * b), -self.spread / (c * c)];
        let mut diagonal = 0.0;
        for (row, first) in self.order.iter().zip(r) {
            for (column, second) in self.order.iter().zip(r) {
                diagonal += first * strain.squares[(*row, *column)] * second;
            }
        }
        [
            w23 / (b * c).powi(2) * greatest,
            w31 / (c * a).powi(2) * self.ratio * greatest,
            w12 / (a * b).powi(2) * self.ratio * x,
            diagonal * x,
        ]
    }
}

/// The frequency dℓ′/dt over M/C, and the peak energy of each harmonic over x: (m, W_m/x).
pub(super) struct Load {
    pub(super) rate: f64,
    pub(super) energies: Vec<(u32, f64)>,
}

impl Load {
    /// The harmonics of a polhode for the lossy part of the strain energy.
    pub(super) fn new(axes: &ModeAxes, strain: &StrainEnergy, swing: Swing) -> Self {
        let Swing { x, complement, .. } = swing;
        // Q2 = Q1 + xd,  k² = xd/Q2,  k′² = Q1/Q2
        let greatest = complement + x * axes.spread;
        let (parameter, conjugate) = (x * axes.spread / greatest, complement / greatest);
        let quarter = FRAC_PI_2 / arithmetic_geometric_mean(1.0, conjugate.sqrt());
        // ln q = −πK′/K; q is 0 for a symmetric body.
        let log_nome = -PI * (FRAC_PI_2 / arithmetic_geometric_mean(1.0, parameter.sqrt())) / quarter;
        let energies = axes.energies(strain, x, greatest);
        Self {
            rate: axes.rate * greatest.sqrt() * FRAC_PI_2 / quarter,
            energies: series(log_nome, FRAC_PI_2 / quarter, energies),
        }
    }
}

/// W_m/x = ½ Σ_c (E_c/x) |amplitude_c,m|² (equations 10 and 11), from ln q and π/(2K).
fn series(log_nome: f64, turn: f64, [e23, e31, e12, diagonal]: [f64; 4]) -> Vec<(u32, f64)> {
    // q^n; q⁰ = 1 for q = 0 too.
    let power = |n: f64| if n == 0.0 { 1.0 } else { (n * log_nome).exp() };
    // s₂ = Σ q^(n(n+1))
    let terms = (0..).map(|n| power(f64::from(n) * f64::from(n + 1)));
    let sum: f64 = terms.take_while(|term| *term > 0.1 * NEGLIGIBLE).sum();
    let square = sum * sum;
    let (mut found, mut top) = (Vec::new(), 0.0_f64);
    for multiple in 1..=MOST {
        let m = f64::from(multiple);
        // n = (m − 1)/2 for odd m, m/2 − 1 for even m
        let q = power(f64::from((multiple - 1) / 2));
        let (plus, minus) = (1.0 + power(m), -(m * log_nome).exp_m1());
        let odd = multiple % 2 == 1;
        let factor = if odd { turn * m * q / square } else { 0.25 * m * q / (square * square) };
        let (over_plus, over_minus) = ((factor / plus).powi(2), (factor / minus).powi(2));
        let [first, second] = if odd { [e23, e31] } else { [e12, diagonal] };
        found.push((multiple, 0.5 * (first * over_plus + second * over_minus)));
        let size = m * over_minus;
        top = top.max(size);
        if multiple > 4 && size < NEGLIGIBLE * top {
            break;
        }
    }
    found
}
