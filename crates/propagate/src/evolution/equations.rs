//! The averaged equations: rates of the angular momentum and of the excess of energy (weak torques (1), (4)).

use nalgebra::{Matrix3, Vector3};

use super::polhode_means::{EvenMonomial, ExcessPolhode, ModeFamily};
use super::rows::{RowBuilder, RowGroup, SortedTorque, TorqueTerms, evaluated};
use super::sources::{MovingSource, View};
use crate::error::{Error, torque_refused};
use crate::input::energy_loss::{EnergyLoss, LossState};
use crate::input::scene::Scene;
use crate::input::torque::Torque;
use crate::input::torque_source::SourcePath;
use crate::orbit::disturbing_body::DisturbingBody;

/// Rates of the slow variables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rates {
    /// Of the angular momentum, inertial.
    pub(super) momentum: Vector3<f64>,
    /// Of the excess of energy.
    pub(super) excess: f64,
}

/// A torque with its source.
#[derive(Clone, Debug)]
struct TorquePart {
    /// `None` for a torque without a direction.
    source: Option<usize>,
    groups: Vec<RowGroup>,
    terms: TorqueTerms,
}

/// The averaged equations of a scene in one family of polhodes.
#[derive(Clone, Debug)]
pub(super) struct AveragedTorques {
    pub(super) moments: Vector3<f64>,
    pub(super) family: ModeFamily,
    pub(super) epoch: f64,
    pub(super) sources: Vec<MovingSource>,
    parts: Vec<TorquePart>,
    /// Internal friction.
    losses: Vec<EnergyLoss>,
    monomials: Vec<EvenMonomial>,
}

/// Memory that evaluations share.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    means: Vec<f64>,
    views: Vec<View>,
    rows: Vec<GroupMeans>,
}

/// Degree of a group, power of M of its rates, and the means of its rows.
type GroupMeans = (usize, f64, [f64; 5]);

/// Sorted moments, and the rotation from components about the given principal axes to components about the sorted ones.
pub(super) fn sorted_axes(moments: [f64; 3]) -> (Vector3<f64>, Matrix3<f64>) {
    let mut order = [0_usize, 1, 2];
    order.sort_by(|one, other| moments[*one].total_cmp(&moments[*other]));
    let mut sort = Matrix3::<f64>::zeros();
    (0..3).for_each(|row| sort[(row, order[row])] = 1.0);
    // An odd permutation is a reflection: axis 2 changes its sign.
    if sort.determinant() < 0.0 {
        sort[(1, order[1])] = -1.0;
    }
    (Vector3::from(order.map(|axis| moments[axis])), sort)
}

impl AveragedTorques {
    /// Of a scene about principal axes.
    ///
    /// # Errors
    /// - [`Error::Torque`] for rotors, whose body rotates on other polhodes, and for a term with two directions.
    pub(super) fn new(scene: &Scene, family: ModeFamily) -> Result<Self, Error> {
        let (moments, sort) = sorted_axes(scene.body().moments());
        let mut builder = RowBuilder::new(family, &moments);
        let (mut sources, mut parts, mut losses) = (Vec::new(), Vec::new(), Vec::new());
        for torque in scene.acting_torques().iter() {
            if let Torque::Dissipation(loss) = torque {
                loss.check(scene.body())?;
                losses.push(loss.clone());
                continue;
            }
            let (found, own) = sorted_torques(torque, &sort)?;
            for torque in found {
                let source = torque.source.map(|index| sources.len() + index);
                parts.push(TorquePart { source, groups: builder.groups(&torque)?, terms: torque.terms() });
            }
            sources.extend(own);
        }
        for body in scene.asked_disturbing() {
            let (path, strength) = match body {
                DisturbingBody::Orbit(orbit) => (SourcePath::Orbit(*orbit), orbit.strength()),
                DisturbingBody::Tabulated(table) => (SourcePath::Tabulated(table.clone()), table.gm()),
            };
            // G m/r³ is the attraction times (a/r)³, of a table gm/r³.
            let source = MovingSource::in_units(path, 3.0, strength.cbrt());
            let torque = SortedTorque::gravity(&moments)?;
            parts.push(TorquePart {
                source: Some(sources.len()),
                groups: builder.groups(&torque)?,
                terms: torque.terms(),
            });
            sources.push(source);
        }
        let monomials = builder.monomials;
        let found = Self { moments, family, epoch: scene.state().epoch, sources, parts, losses, monomials };
        let uniform = found.loss(scene.state().angular_velocity.norm(), 0.0)?;
        if uniform == 0.0 {
            return Ok(found);
        }
        Err(torque_refused("dissipation", uniform, "0 at the excess 0, where the body rotates uniformly"))
    }

    /// The power of internal friction over the largest moment.
    ///
    /// # Errors
    /// Those of its functions.
    pub(super) fn loss(&self, rate: f64, excess: f64) -> Result<f64, Error> {
        let separatrix = self.family.alpha(&self.moments).y;
        let state = LossState { long_axis: !self.family.short, excess, separatrix, rate };
        self.losses.iter().map(|loss| loss.power_over(self.moments.z, &state)).sum()
    }

    /// ξ̇ by internal friction, at constant angular momentum.
    fn excess_rate_by_loss(&self, size: f64, excess: f64) -> Result<f64, Error> {
        if self.losses.is_empty() {
            return Ok(0.0);
        }
        let rate = size / self.moments.z;
        // ξ̇ = ∓2IP/M²
        let of_own = if self.family.short { -1.0 } else { self.moments.x / self.moments.z };
        Ok(2.0 * of_own * self.loss(rate, excess)? / (rate * rate))
    }

    /// The equations without internal friction, and whether they had any.
    pub(super) fn without_losses(&self) -> (Self, bool) {
        (Self { losses: Vec::new(), ..self.clone() }, !self.losses.is_empty())
    }

    /// The rates at a state.
    ///
    /// # Errors
    /// As [`MovingSource::views`].
    pub(super) fn rates(&self, time: f64, state: (&Vector3<f64>, f64), scratch: &mut Scratch) -> Result<Rates, Error> {
        self.rates_of(time, state, scratch, |_| true)
    }

    /// The rates by the harmonics of one degree alone.
    pub(super) fn rates_of(
        &self,
        time: f64,
        (momentum, excess): (&Vector3<f64>, f64),
        scratch: &mut Scratch,
        keep: impl Fn(usize) -> bool,
    ) -> Result<Rates, Error> {
        let polhode = ExcessPolhode::new(&self.moments, self.family, excess);
        let Scratch { means, views, rows } = scratch;
        polhode.means(&self.monomials, means);
        let size = momentum.norm();
        let lever = polhode.alpha.add_scalar(-polhode.excess);
        let loss = if keep(0) { self.excess_rate_by_loss(size, excess)? } else { 0.0 };
        let mut sum = Rates { momentum: Vector3::zeros(), excess: loss };
        for part in &self.parts {
            match part.source {
                Some(source) => self.sources[source].views((self.epoch, time), views)?,
                // Harmonics of degree 0 have the same mean for any direction.
                None => {
                    views.clear();
                    views.push(View { direction: Vector3::z(), weight: 1.0, zonal: false });
                }
            }
            rows.clear();
            let kept = part.groups.iter().filter(|group| keep(group.degree));
            rows.extend(kept.map(|group| (group.degree, size.powi(group.of_rates), group.means(means))));
            for view in views.iter() {
                let along = Along::new(&(momentum / size), view);
                rows.iter().for_each(|row| along.add(&mut sum, row, (&lever, size)));
            }
        }
        Ok(sum)
    }

    /// The direction and weight of each source at its place.
    ///
    /// # Errors
    /// As [`MovingSource::views`].
    pub(super) fn places(&self, time: f64) -> Result<Vec<View>, Error> {
        let mut views = Vec::new();
        let place = |source: &MovingSource| {
            let source = MovingSource { over_orbit: false, ..source.clone() };
            source.views((self.epoch, time), &mut views).map(|()| views[0])
        };
        self.sources.iter().map(place).collect()
    }

    /// The torque itself, for directions to the sources in sorted body axes and rates.
    pub(super) fn torque(&self, views: impl Iterator<Item = View>, rates: &Vector3<f64>) -> Vector3<f64> {
        let views: Vec<View> = views.collect();
        let part = |part: &TorquePart| match part.source {
            Some(source) => evaluated(&part.terms, &views[source].direction, rates) * views[source].weight,
            None => evaluated(&part.terms, &Vector3::zeros(), rates),
        };
        self.parts.iter().map(part).sum()
    }

    /// The highest degree of the harmonics.
    pub(super) fn highest_degree(&self) -> usize {
        self.parts.iter().flat_map(|part| &part.groups).map(|group| group.degree).max().unwrap_or(0)
    }

    /// An estimate of the torque at a state, without its directions [moment × rate²].
    pub(super) fn strength(&self, time: f64, momentum: f64, scratch: &mut Scratch) -> Result<f64, Error> {
        let mut sum = 0.0;
        for part in &self.parts {
            let weight = match part.source {
                Some(source) => {
                    self.sources[source].views((self.epoch, time), &mut scratch.views)?;
                    scratch.views.iter().map(|view| view.weight.abs()).sum::<f64>()
                }
                None => 1.0,
            };
            // Rates are at most M/A.
            let size = |group: &RowGroup| group.size * (momentum / self.moments.x).powi(group.of_rates);
            sum += weight * part.groups.iter().map(size).sum::<f64>();
        }
        // A torque that takes this power.
        let half = 0.5 * self.family.alpha(&self.moments).y;
        let rate = momentum / self.moments.z;
        Ok(sum + self.moments.z * self.loss(rate, half)? / rate)
    }
}

/// One more than the highest degree of a torque.
const DEGREES: usize = 9;

/// A source as seen from the angular momentum.
struct Along {
    k: Vector3<f64>,
    /// ŝ − c k
    across: Vector3<f64>,
    /// k × ŝ
    beside: Vector3<f64>,
    /// Weight times P_l(c) and P_l′(c)/(l(l+1)).
    radial: [f64; DEGREES],
    tangential: [f64; DEGREES],
}

impl Along {
    fn new(k: &Vector3<f64>, view: &View) -> Self {
        let c = k.dot(&view.direction);
        let (mut radial, mut tangential) = legendre(c);
        let zonal = if view.zonal { legendre(0.0).0 } else { [1.0; DEGREES] };
        for (l, zonal) in zonal.into_iter().enumerate() {
            radial[l] *= view.weight * zonal;
            tangential[l] *= view.weight * zonal;
        }
        Self { k: *k, across: view.direction - k * c, beside: k.cross(&view.direction), radial, tangential }
    }

    /// Adds (4).
    fn add(&self, sum: &mut Rates, (degree, rates, means): &GroupMeans, (lever, size): (&Vector3<f64>, f64)) {
        let [first, second, third, divergence, turn] = *means;
        let (radial, tangential) = (rates * self.radial[*degree], rates * self.tangential[*degree]);
        // Ġ = P_l ⟨g·T⟩ k + P_l′/(l(l+1)) (⟨div_S T⟩ (ŝ − c k) + ⟨g·curl T⟩ k × ŝ)
        sum.momentum += self.k * (radial * (first + second + third));
        sum.momentum += (self.across * divergence + self.beside * turn) * tangential;
        // ξ̇ = 2/M P_l Σ (α_i − ξ) ⟨g_i T_i⟩
        sum.excess += 2.0 / size * radial * lever.dot(&Vector3::new(first, second, third));
    }
}

/// P_l(c) and P_l′(c)/(l (l + 1)), the latter 0 for l = 0.
fn legendre(c: f64) -> ([f64; DEGREES], [f64; DEGREES]) {
    let (mut values, mut slopes, mut derivatives) = ([1.0; DEGREES], [0.0; DEGREES], [0.0; DEGREES]);
    (values[1], derivatives[1]) = (c, 1.0);
    for l in 1..DEGREES - 1 {
        let n = l as f64;
        // P_(l+1) = ((2l+1) c P_l − l P_(l−1))/(l+1), P′_(l+1) = P′_(l−1) + (2l+1) P_l
        values[l + 1] = ((2.0 * n + 1.0) * c * values[l] - n * values[l - 1]) / (n + 1.0);
        derivatives[l + 1] = derivatives[l - 1] + (2.0 * n + 1.0) * values[l];
    }
    for l in 1..DEGREES {
        slopes[l] = derivatives[l] / (l * (l + 1)) as f64;
    }
    (values, slopes)
}

/// A torque on sorted axes, by its sources.
fn sorted_torques(torque: &Torque, sort: &Matrix3<f64>) -> Result<(Vec<SortedTorque>, Vec<MovingSource>), Error> {
    let one = |torque: Result<SortedTorque, Error>| Ok::<_, Error>((vec![torque?], Vec::new()));
    match torque {
        Torque::Constant(torque) => one(SortedTorque::of_rates(&(sort * Vector3::from(*torque)), &Matrix3::zeros())),
        Torque::Damping(rows) => {
            let matrix = sort * Matrix3::from_fn(|i, k| rows[i][k]) * sort.transpose();
            one(SortedTorque::of_rates(&Vector3::zeros(), &-matrix))
        }
        Torque::Polynomial(torque) => {
            Ok((SortedTorque::of_polynomial(torque, sort)?, torque.sources().iter().map(MovingSource::new).collect()))
        }
        Torque::Rotor(momentum) => {
            let bound = "absent: a body with rotors does not rotate as a rigid body alone; integrate the scene";
            Err(torque_refused("rotor", format!("{momentum:?}"), bound))
        }
        // A term of its own, not a torque.
        Torque::Dissipation(_) => Ok((Vec::new(), Vec::new())),
    }
}
