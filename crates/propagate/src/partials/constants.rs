//! The quantities from which derivatives are computed: the state in units of M = 1, its six changes, and the constants of theory §12 for each change.

use crate::numerics::scaling::scaled;
use crate::numerics::theta::Theta;
use crate::torque_free::invariants::Invariants;
use crate::torque_free::polhode::Polhode;

use super::integral::Integral;

/// Parameters that change the polhode: three rates at the epoch, three moments.
pub(super) const CHANGES: usize = 6;

/// A parameter and its effect on one axis: the changes of g at the epoch and of ν = M over the moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    /// The user's axis.
    pub(super) axis: usize,
    /// The index of this axis among the sorted axes.
    sorted: usize,
    /// δg at the epoch along the user's axis, for a unit of the parameter.
    pub(super) lever: f64,
    /// δg on the sorted axis, in scaled units.
    step: f64,
    /// δν on that axis, in scaled units.
    rate: f64,
    /// −1 over the moment in the user's unit; 0 for a rate.
    pub(super) inverse_moment: f64,
    /// Factor from the derivative in scaled units to that in the user's units.
    pub(super) unit: f64,
}

/// The state at the epoch in units of M = 1, on the sorted axes.
#[derive(Clone, Debug)]
pub(super) struct Setting {
    /// Index of the user's axis of each sorted axis.
    pub(super) axes: [usize; 3],
    /// g.
    pub(super) direction: [f64; 3],
    /// ν_i, scaled.
    pub(super) rates: [f64; 3],
    /// The slopes d_i in ġ_1 = d_1 g_2 g_3 and so on, scaled.
    pub(super) slopes: [f64; 3],
    /// The slopes d_i on the user's axes.
    pub(super) user_slopes: [f64; 3],
    /// ν_i on the user's axes, in the user's unit.
    pub(super) user_rates: [f64; 3],
    /// The user's unit of time in scaled units.
    pub(super) unit: f64,
    pub(super) changes: [Change; CHANGES],
}

impl Setting {
    pub(super) fn new(polhode: &Polhode, moments: [f64; 3]) -> Self {
        let Polhode { frame, scales: (moment, rate), .. } = polhode;
        let Invariants { direction, rates, .. } = polhode.invariants;
        let mean = polhode.invariants.mean_rate;
        let [first, second] = polhode.invariants.excesses;
        let slopes = [-second, first, -polhode.invariants.difference].map(|excess| (mean * excess).to_f64());
        let (mut user_slopes, mut user_rates, mut sorted) = ([0.0; 3], [0.0; 3], [0; 3]);
        for (index, &axis) in frame.axes.iter().enumerate() {
            user_slopes[axis] = frame.signs[0] * slopes[index];
            user_rates[axis] = scaled(rates[index], *rate);
            sorted[axis] = index;
        }
        let changes = std::array::from_fn(|parameter| {
            let axis = parameter % 3;
            let index = sorted[axis];
            let sign = frame.signs[index];
            if parameter < 3 {
                let (step, unit) = (1.0 / rates[index], scaled(1.0, -rate));
                Change {
                    axis,
                    sorted: index,
                    lever: step * unit,
                    step: sign * step,
                    rate: 0.0,
                    inverse_moment: 0.0,
                    unit,
                }
            } else {
                let (step, unit) = (direction[index] / polhode.moments[index], scaled(1.0, -moment));
                Change {
                    axis,
                    sorted: index,
                    lever: sign * step * unit,
                    step,
                    rate: -rates[index] / polhode.moments[index],
                    inverse_moment: -1.0 / moments[axis],
                    unit,
                }
            }
        });
        Self { axes: frame.axes, direction, rates, slopes, user_slopes, user_rates, unit: scaled(1.0, *rate), changes }
    }
}

impl Change {
    /// δg at the epoch and δν, on the sorted axes and in scaled units.
    pub(super) fn vectors(&self) -> [[f64; 3]; 2] {
        let (mut step, mut rate) = ([0.0; 3], [0.0; 3]);
        step[self.sorted] = self.step;
        rate[self.sorted] = self.rate;
        [step, rate]
    }
}

/// The constants of one parameter (theory §12), for a unit of the parameter in the user's unit and for scaled times.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ParameterConstants {
    /// Half the logarithmic derivative of each amplitude, by the user's axis.
    pub(super) growth: [f64; 3],
    /// β/2.
    pub(super) half_beta: f64,
    /// τ at the epoch.
    pub(super) delay: f64,
    /// The mean growth of τ.
    pub(super) drift: f64,
    /// The mean growth of g·δθ.
    pub(super) turn: f64,
    /// g·δθ for a unit of the periodic part of ∫w dt.
    pub(super) swing: f64,
}

impl ParameterConstants {
    pub(super) fn all(setting: &Setting, theta: &Theta, integral: &Integral) -> [Self; CHANGES] {
        setting.changes.map(|change| Self::new(setting, theta, integral, &change))
    }

    fn new(setting: &Setting, theta: &Theta, integral: &Integral, change: &Change) -> Self {
        let [step, rate] = change.vectors();
        let Setting { direction: g, slopes: d, rates: nu, .. } = setting;
        let [least, greatest] = theta.cosines.map(|cosine| cosine * cosine);
        let slope_changes = [rate[2] - rate[1], rate[0] - rate[2], rate[1] - rate[0]];
        let relative = [slope_changes[0] / d[0], slope_changes[1] / d[1]];
        let r = [g[0] * g[0] / d[0], g[1] * g[1] / d[1]];
        let changed: [f64; 2] = std::array::from_fn(|i| 2.0 * g[i] * step[i] / d[i] - r[i] * relative[i]);
        let swing = r[1] - r[0];
        let swing_growth = (changed[1] - changed[0]) / swing;
        // Q1 = g3² − d3 r1 and Q2 = g3² − d3 r2.
        let axial = 2.0 * g[2] * step[2];
        let growth_of = |i: usize, square: f64| (axial - slope_changes[2] * r[i] - d[2] * changed[i]) / square;
        let least_growth = growth_of(0, least);
        let beta = (slope_changes[2] + d[2] * (swing_growth - growth_of(1, greatest))) / least;
        let growth = [0.5 * (swing_growth + relative[0]), 0.5 * (swing_growth + relative[1]), 0.5 * least_growth];
        let half_beta = 0.5 * beta;
        let at_epoch = [growth[0] + half_beta * r[1], growth[1] + half_beta * r[0]];
        let delay = delay(setting, &step, &at_epoch);
        let drift = 0.5 * (relative[0] + relative[1] + least_growth) - half_beta * swing * integral.mean_square;
        let work: f64 = (0..3).map(|i| rate[i] * d[i]).sum();
        let power: f64 = (0..3).map(|i| g[i] * (nu[i] * step[i] + rate[i] * g[i])).sum();
        let turn = power + 0.5 * work * (swing * integral.mean_square - r[1]);
        let unit = change.unit;
        let mut user = [0.0; 3];
        for (axis, growth) in setting.axes.into_iter().zip(growth) {
            user[axis] = unit * growth;
        }
        Self {
            growth: user,
            half_beta: unit * half_beta,
            delay: unit * delay,
            drift: unit * drift,
            turn: unit * turn,
            swing: unit * work,
        }
    }
}

/// τ at the epoch: the component along ġ of the part of δg that the amplitudes do not describe. The weights make both components equally large on a small
/// polhode.
fn delay(setting: &Setting, step: &[f64; 3], growth: &[f64; 2]) -> f64 {
    let Setting { direction: g, slopes: d, .. } = setting;
    let roots = [d[0].abs().sqrt(), d[1].abs().sqrt()];
    let motion = [d[0] / roots[0] * g[1] * g[2], d[1] / roots[1] * g[2] * g[0]];
    let largest = motion[0].abs().max(motion[1].abs());
    let unit = motion.map(|component| component / largest);
    let left: f64 = (0..2).map(|i| (step[i] - growth[i] * g[i]) / roots[i] * unit[i]).sum();
    left / (largest * (unit[0] * unit[0] + unit[1] * unit[1]))
}
