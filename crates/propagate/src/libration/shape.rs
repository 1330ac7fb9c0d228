//! The equations of a locked rotation: what does not depend on the state of the body.

use std::f64::consts::TAU;

/// The equations of a locked rotation. The unit of time is 1/n, and that of the moments is the largest one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LockedShape {
    /// A ≤ B ≤ C = 1.
    pub(crate) moments: [f64; 3],
    pub(crate) eccentricity: f64,
    /// Attraction over n².
    pub(crate) attraction: f64,
    /// 2r: rotations in two orbits.
    pub(crate) twice: i32,
    /// Hansen's coefficient X_{2r} (−3, 2) of the eccentricity.
    pub(crate) resonant: f64,
    pub(crate) precession: PlaneMotion,
}

/// What the motion of node and pericentre adds. α = r M + ω + ψ₀ is the angle from the node to axis 1 of S.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlaneMotion {
    /// α̇ = r + ω̇.
    pub(crate) phase_rate: f64,
    /// The rate of S about its axis 3: α̇ + Ω̇ cos(i + δ).
    pub(crate) spin: f64,
    /// The rate of S about the direction across: Ω̇ sin(i + δ).
    pub(crate) sideways: f64,
    /// δ, from the orbit's normal to axis 3 of S, away from inertial axis 3.
    pub(crate) obliquity: f64,
    /// ω + ψ₀ if it is constant.
    pub(crate) argument: Option<f64>,
}

/// The phases of a normal form.
enum Phases {
    None,
    Anomaly,
    Node,
    Both,
    /// M/`divided`, and ω + ψ₀ in α = r M + ω + ψ₀.
    Common {
        divided: i64,
        argument: f64,
    },
}

impl LockedShape {
    /// ω_ψ², the square of the frequency of a small libration in longitude in units of n².
    pub(crate) fn swing_rate_squared(&self) -> f64 {
        let [a, b, _] = self.moments;
        3.0 * self.attraction * (b - a) * self.resonant.abs()
    }

    /// Whether the long axis is at right angles to the direction that follows the disturbing body: where Hansen's coefficient of the resonance is negative.
    pub(crate) fn is_across(&self) -> bool {
        self.resonant < 0.0
    }

    /// Whether the equations depend on α.
    pub(crate) fn is_tilted(&self) -> bool {
        self.precession.obliquity != 0.0 || self.precession.sideways != 0.0
    }

    fn phases(&self) -> Phases {
        match (self.eccentricity == 0.0, self.is_tilted(), self.precession.argument) {
            (true, false, _) => Phases::None,
            (false, false, _) => Phases::Anomaly,
            (true, true, _) => Phases::Node,
            (false, true, None) => Phases::Both,
            (false, true, Some(argument)) => Phases::Common { divided: 1 + i64::from(self.twice % 2 != 0), argument },
        }
    }

    /// The rates of the phases of a normal form.
    pub(crate) fn rates(&self) -> Vec<f64> {
        match self.phases() {
            Phases::None => vec![],
            Phases::Anomaly => vec![1.0],
            Phases::Node => vec![self.precession.phase_rate],
            Phases::Both => vec![1.0, self.precession.phase_rate],
            Phases::Common { divided, .. } => vec![1.0 / divided as f64],
        }
    }

    /// The period of the first phase, or an orbit where nothing depends on a phase, in units of 1/n.
    pub(crate) fn period(&self) -> f64 {
        TAU / self.rates().first().copied().unwrap_or(1.0).abs()
    }

    /// The phases of a normal form at a mean anomaly M and an angle α.
    pub(crate) fn driven(&self, [anomaly, node]: [f64; 2]) -> Vec<f64> {
        match self.phases() {
            Phases::None => vec![],
            Phases::Anomaly => vec![anomaly],
            Phases::Node => vec![node],
            Phases::Both => vec![anomaly, node],
            Phases::Common { divided, .. } => vec![anomaly / divided as f64],
        }
    }

    /// M and α at phases of a normal form; 0 for one that has no effect.
    pub(crate) fn anomaly_and_node(&self, phases: &[f64]) -> [f64; 2] {
        match (self.phases(), phases) {
            (Phases::Anomaly, &[anomaly]) => [anomaly, 0.0],
            (Phases::Node, &[node]) => [0.0, node],
            (Phases::Both, &[anomaly, node]) => [anomaly, node],
            (Phases::Common { divided, argument }, &[phase]) => {
                let anomaly = divided as f64 * phase;
                [anomaly, f64::from(self.twice) / 2.0 * anomaly + argument]
            }
            _ => [0.0; 2],
        }
    }

    /// The multiples (j, k) of M and α in a term of a normal form, and the term's constant angle.
    pub(crate) fn multiples(&self, phases: &[i64]) -> ([i64; 2], f64) {
        match (self.phases(), phases) {
            (Phases::Anomaly, &[j]) => ([j, 0], 0.0),
            (Phases::Node, &[k]) => ([0, k], 0.0),
            (Phases::Both, &[j, k]) => ([j, k], 0.0),
            (Phases::Common { divided: 2, argument }, &[m]) => {
                let k = m.rem_euclid(2);
                ([(m - k * i64::from(self.twice)) / 2, k], k as f64 * argument)
            }
            (Phases::Common { .. }, &[j]) => ([j, 0], 0.0),
            _ => ([0, 0], 0.0),
        }
    }
}
