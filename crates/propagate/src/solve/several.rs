//! The motions of several free bodies at once: the constants of their polhodes and their frequencies are computed in lanes.

use super::free::{self, Preparation};
use crate::error::Error;
use crate::input::options::Method;
use crate::input::scene::Scene;
use crate::motion::solved::Motion;
use crate::torque_free::frequencies::Secular;
use crate::torque_free::mode::Mode;
use crate::torque_free::polhode::Polhode;

/// Calls `each` with the motions of at most as many valid scenes as the widest vectors have lanes, each to the bits of [`Scene::solve`]. The plans of free
/// motions have no remarks. A motion has some hundreds of bytes: it is used where it was made and not copied.
pub(crate) fn several(scenes: Vec<Result<Scene, Error>>, mut each: impl FnMut(&Result<Motion, Error>)) {
    let free: Vec<&Scene> = scenes.iter().flatten().filter(|scene| is_free(scene)).collect();
    let polhodes = Polhode::several(&free);
    let frequencies = Secular::several(&polhodes.iter().flatten().filter(wobbles).collect::<Vec<_>>());
    let (mut polhodes, mut frequencies) = (polhodes.iter(), frequencies.into_iter());
    for scene in scenes {
        let motion = match scene {
            Ok(scene) if is_free(&scene) => {
                let polhode = polhodes.next().and_then(Option::as_ref);
                let secular = polhode.filter(wobbles).and_then(|_| frequencies.next());
                free::motion(scene, polhode, Preparation { secular, remarks: false })
            }
            Ok(scene) => scene.solve(),
            Err(error) => Err(error),
        };
        each(&motion);
    }
}

/// Whether a motion is a wobble, which has frequencies.
fn wobbles(polhode: &&Polhode) -> bool {
    matches!(Mode::of(polhode), Mode::ShortAxis | Mode::LongAxis | Mode::Axisymmetric)
}

/// Whether a scene has neither a torque nor a choice of method.
fn is_free(scene: &Scene) -> bool {
    scene.asked_disturbing().is_empty()
        && scene.acting_torques().is_empty()
        && scene.asked_method() == Method::Auto
        && scene.body().turn().is_none()
}
