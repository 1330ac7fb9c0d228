//! C-kernels of attitudes at given times, of any origin.

use std::f64::consts::PI;
use std::io::BufWriter;
use std::path::Path;

use andoyer_kernels::{Daf, Head, Kernel, Refused};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::nodes::between;
use super::options::{KernelOptions, WriteError, Written, beside};

/// Attitudes at given times.
#[derive(Clone, Copy, Debug)]
pub struct AttitudeTable<'a> {
    /// Increasing times \[s\].
    pub times: &'a [f64],
    /// Quaternions \[x, y, z, w\] that rotate body components into inertial ones.
    pub attitudes: &'a [[f64; 4]],
    /// Angular velocities in body components \[rad/s\].
    pub rates: Option<&'a [[f64; 3]]>,
}

/// Writes attitudes at given times as a C-kernel of type 3, and the text kernel beside it.
///
/// Two times that are more than `longest_step` apart end an interval: SPICE has no attitude between them.
///
/// The error that is returned is an estimate, because the motion between the samples is not known. With rates it is h²α/8 in an interval h, with the angular acceleration α from
/// the rates at its ends, and at least the difference between the rotation and the mean rate. Without rates each attitude is compared with that interpolated between its neighbours, whose
/// interval is twice as long, and the error is a fourth of the difference; it is infinite if an interval has no third sample. Turns of half a turn and more are not seen then.
///
/// # Errors
/// [`WriteError::Refused`] for lists of different lengths, fewer than two times, times that do not increase or that the clock does not hold, values that are not finite, and rates by which the body turns by half a turn or more between two samples.
/// [`WriteError::System`] for an error of the system.
pub fn write_samples(
    path: &Path,
    AttitudeTable { times, attitudes, rates }: AttitudeTable<'_>,
    longest_step: f64,
    kernel: &Kernel,
    mut options: KernelOptions<'_>,
) -> Result<Written, WriteError> {
    let turns = checked(times, attitudes, rates)?;
    if longest_step.is_nan() || longest_step <= 0.0 {
        return Err(Refused::new("longest_step", format!("{longest_step:?}"), "positive").into());
    }
    let ends = options.ends([times[0], times[times.len() - 1]])?;
    // Times past J2000 are rounded, so a step that is as long as the longest one may seem longer.
    let zero = options.zero;
    let room = |time: f64| longest_step * (1.0 + 1e-9) + 4.0 * f64::EPSILON * (zero + time).abs();
    let begins = |place: usize| place == 0 || times[place] - times[place - 1] > room(times[place]);
    // Where an interval begins or ends its time is rounded outwards, so that the kernel has the time itself; a sample alone is there twice if the clock does not hold its time.
    let (mut held, mut places, mut first) = (Vec::new(), Vec::new(), Vec::new());
    for place in 0..times.len() {
        let (begin, end) = (begins(place), place + 1 == times.len() || begins(place + 1));
        let time = options.zero + times[place];
        let own = [options.rounded(time, begin, end), options.rounded(time, false, end)];
        first.extend(begin.then_some(held.len()));
        held.push(own[0]);
        held.extend((own[1] > own[0] && begin && end).then_some(own[1]));
        places.resize(held.len(), place);
    }
    let ticks = options.ticks(&held, "samples")?;
    let starts: Vec<f64> = first.into_iter().map(|place| ticks[place]).collect();
    let of_place = |&place: &usize| rates.map(|rates| (turns[place] * Vector3::from(rates[place])).into());
    let inertial: Option<Vec<[f64; 3]>> = places.iter().map(of_place).collect();
    let estimated = estimate(times, &turns, rates, &begins)?;
    let comments = options.comments(kernel, None, estimated);
    let unit: Vec<[f64; 4]> = places.iter().map(|&place| super::ck::array(&turns[place])).collect();
    beside(path, "tsc", &kernel.text_of_ck(), options.force, |file| {
        let mut daf = Daf::ck(BufWriter::new(file), &comments)?;
        daf.ck3(&Head::of(kernel), &ticks, &unit, inertial.as_deref(), &starts)?;
        daf.finish()?;
        let fastest =
            (1..times.len()).map(|place| turns[place - 1].angle_to(&turns[place]) / (times[place] - times[place - 1]));
        // The times of the records are rounded, and so is a time that is asked for.
        let seconds = (held[held.len() - 1] - held[0]) / (ticks[ticks.len() - 1] - ticks[0]);
        let of_ticks = ticks[ticks.len() - 1].abs() * seconds;
        let rounding = 2.0 * options.rounding(ends, fastest.fold(0.0, f64::max), of_ticks);
        Ok(Written { kind: 3, records: held.len(), error: estimated + rounding })
    })
}

/// The attitudes as unit quaternions, if all lists are valid.
fn checked(
    times: &[f64],
    attitudes: &[[f64; 4]],
    rates: Option<&[[f64; 3]]>,
) -> Result<Vec<UnitQuaternion<f64>>, Refused> {
    let count = times.len();
    if count < 2 || attitudes.len() != count || rates.is_some_and(|rates| rates.len() != count) {
        let value = format!("{count} times, {} attitudes, {} rates", attitudes.len(), rates.map_or(0, <[_]>::len));
        return Err(Refused::new(
            "samples",
            value,
            "two or more times with an attitude for each, and a rate for each or none",
        ));
    }
    if let Some(place) =
        (0..count).find(|&place| !times[place].is_finite() || (place > 0 && times[place] <= times[place - 1]))
    {
        return Err(Refused::new(
            "samples",
            format!("times[{place}] = {:?}", times[place]),
            "finite times that increase",
        ));
    }
    if let Some(place) = rates.and_then(|rates| rates.iter().position(|rate| !rate.iter().all(|part| part.is_finite())))
    {
        return Err(Refused::new("samples", format!("angular_velocity[{place}]"), "finite"));
    }
    let turn = |(place, q): (usize, &[f64; 4])| {
        let quaternion = Quaternion::from(*q);
        let near = (quaternion.norm() - 1.0).abs() < 1e-6;
        near.then(|| UnitQuaternion::from_quaternion(quaternion)).ok_or_else(|| {
            Refused::new(
                "samples",
                format!("attitude[{place}] = {q:?}"),
                "unit quaternions, with a norm within 1e-6 of 1",
            )
        })
    };
    attitudes.iter().enumerate().map(turn).collect()
}

/// The largest estimated error of uniform rotation between neighbouring samples \[rad\].
fn estimate(
    times: &[f64],
    turns: &[UnitQuaternion<f64>],
    rates: Option<&[[f64; 3]]>,
    begins: &dyn Fn(usize) -> bool,
) -> Result<f64, Refused> {
    let mut worst = 0.0_f64;
    // Whether the interval before each sample has an estimate without rates.
    let mut covered = vec![false; times.len()];
    for place in (1..times.len()).filter(|&place| !begins(place)) {
        let width = times[place] - times[place - 1];
        if let Some(rates) = rates {
            let [one, other] = [rates[place - 1], rates[place]].map(Vector3::from);
            let mean = 0.5 * width * (one + other);
            if mean.norm() >= PI {
                let value = format!("{:.3} rad between times[{}] and times[{place}]", mean.norm(), place - 1);
                let allowed = "so near in time that the body turns by less than half a turn between them: SPICE takes the shorter way";
                return Err(Refused::new("samples", value, allowed));
            }
            let turn = turns[place - 1].inverse() * turns[place];
            let bend = width * (other - one).norm() / 8.0;
            worst = worst.max(bend).max(UnitQuaternion::from_scaled_axis(mean).angle_to(&turn));
        } else if place + 1 < times.len() && !begins(place + 1) {
            let part = width / (times[place + 1] - times[place - 1]);
            worst = worst.max(0.25 * between(&turns[place - 1], &turns[place + 1], part).angle_to(&turns[place]));
            (covered[place], covered[place + 1]) = (true, true);
        }
    }
    let unknown = rates.is_none() && (1..times.len()).any(|place| !begins(place) && !covered[place]);
    Ok(if unknown { f64::INFINITY } else { worst })
}
