//! One motion, and the tables of the series, from eight threads at once: the bits of one thread.

use std::thread;

use andoyer_propagate::{Body, Error, Method, Motion, Scene, State};

const THREADS: usize = 8;
const SAMPLES: usize = 5_000;

type Rows = (Vec<[f64; 4]>, Vec<[f64; 3]>);

fn times(thread: usize) -> Vec<f64> {
    (0..SAMPLES).map(|k| 0.37 * k as f64 - 100.0 * thread as f64).collect()
}

fn rows(motion: &Motion, times: &[f64]) -> Result<Rows, Error> {
    let (mut attitudes, mut rates) = (vec![[0.0; 4]; times.len()], vec![[0.0; 3]; times.len()]);
    motion.samples_into(times, &mut attitudes, &mut rates)?;
    Ok((attitudes, rates))
}

fn scene(body: &Body, method: Method) -> Result<Scene, Error> {
    let state = State::new(0.0, [0.0, 0.0, 0.0, 1.0], [0.1, 0.15, 1.1])?;
    Ok(Scene::new(body.clone(), state).method(method))
}

#[test]
fn eight_threads_that_evaluate_one_motion_have_the_bits_of_one() -> Result<(), Error> {
    for method in [Method::Closed, Method::Series] {
        let motion = scene(&Body::new([0.5, 0.75, 1.0])?, method)?.solve()?;
        let alone = (0..THREADS).map(|k| rows(&motion, &times(k))).collect::<Result<Vec<_>, _>>()?;
        thread::scope(|scope| {
            let running: Vec<_> = (0..THREADS)
                .map(|k| {
                    let motion = &motion;
                    scope.spawn(move || rows(motion, &times(k)))
                })
                .collect();
            for (thread, expected) in running.into_iter().zip(&alone) {
                assert_eq!(&thread.join().expect("no panic").expect("finite times"), expected);
            }
        });
    }
    Ok(())
}

#[test]
fn eight_threads_that_solve_for_one_body_have_the_bits_of_one() -> Result<(), Error> {
    for method in [Method::Closed, Method::Series] {
        let alone = rows(&scene(&Body::new([0.5, 0.75, 1.0])?, method)?.solve()?, &times(0))?;
        // A body that nothing has been computed for yet: all threads ask for its tables at once.
        let body = Body::new([0.5, 0.75, 1.0])?;
        thread::scope(|scope| {
            let running: Vec<_> = (0..THREADS)
                .map(|_| scope.spawn(|| scene(&body, method).and_then(|scene| rows(&scene.solve()?, &times(0)))))
                .collect();
            for thread in running {
                assert_eq!(thread.join().expect("no panic").expect("a short-axis motion"), alone);
            }
        });
    }
    Ok(())
}
