//! A tumbling body: its plan, its periods, its attitude after a million turns, and how sharply the initial state must be known.

#![expect(clippy::print_stdout, reason = "an example prints what it computes")]

use andoyer_propagate::nalgebra::Vector3;
use andoyer_propagate::options::Convention;
use andoyer_propagate::{Body, Error, Scene, State};

fn main() -> Result<(), Error> {
    let body = Body::new([0.5, 0.75, 1.0])?;
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.2, 0.3, 1.1])?; // epoch, attitude [x, y, z, w], angular velocity
    let motion = Scene::new(body, state).tolerance(1e-12).solve()?;
    print!("{}", motion.plan());

    let periods = motion.periods_of(Convention::ExtremalAxis);
    println!("precession {:.6}, rotation {:.6}", periods.precession, periods.rotation);

    let late = 1e6 * periods.precession;
    let times: Vec<f64> = (0..4).map(|k| late + 0.25 * f64::from(k) * periods.precession).collect();
    for (time, [x, y, z, w]) in times.iter().zip(motion.attitudes(&times)?) {
        println!("{time:.3}: {x:+.9} {y:+.9} {z:+.9} {w:+.9}");
    }

    // The angular momentum in inertial components never changes.
    let sample = motion.at(late)?;
    let momentum = sample.attitude * sample.angular_velocity.component_mul(&Vector3::new(0.5, 0.75, 1.0));
    assert!((momentum - motion.angular_momentum()).norm() < 1e-12);

    // A change of the first rate turns the attitude by so much: nearly in proportion to the time.
    let growth = motion.partials(late)?.attitude[2][3];
    println!("{growth:.3e} rad for each unit of the first rate");
    assert!(growth.abs() > 1e3);
    Ok(())
}
