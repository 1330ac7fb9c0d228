//! The class `Scene`; its methods are in [`crate::scene`], since `Scene.solve` gives a `Motion` and `Motion.scene` a `Scene`.

use andoyer_propagate::SeriesTables;
use pyo3::prelude::*;

use crate::foreign::Calendar;

/// A body, its state at an epoch, and the accuracy asked of the solution.
///
/// No unit is built in: time, moments and angular velocity in any consistent set, angles in rad.
///
/// Parameters
/// ----------
/// body : Body
/// attitude : array_like, shape (4,), or scipy.spatial.transform.Rotation
///     Unit quaternion [x, y, z, w], scalar last (Hamilton product), that rotates body components into inertial ones; a norm within 1e-6
///     of 1 is normalized.
/// angular_velocity : array_like, shape (3,)
///     Body components, in rad per unit of time; zero is a body at rest. A Quantity of astropy is taken in SI units, here and wherever
///     numbers are taken; a Time in TDB seconds since J2000.
/// scalar_first : bool, optional
///     Whether `attitude` is [w, x, y, z]. The property `attitude` has the scalar last all the same.
/// epoch : float or astropy.time.Time, optional
///     Time of the state. Of a Time the two doubles are kept, in TDB, and times of the motion may be Time; numbers are then seconds since J2000.
/// orbit : Orbit or TabulatedOrbit, or a sequence of them, optional
///     Relative orbits of bodies whose gravity gradients act (theory §9); by default none, and the motion is free.
/// tolerance : float, optional
///     Attitude error asked for over the span, in rad. Below about 1e-14 it means the best that double precision holds
///     (`Plan.error_bound` says what that is).
/// method : {"auto", "series", "closed", "integrated"}, optional
///     Perturbation series, closed form (with an orbit the averaged theory about it), or numerical integration of the full equations over the span. "auto" is the closed
///     form, or the series if an order is fixed; with an orbit and a span it is the integration where the theory does not hold or misses the tolerance and the integration meets it,
///     and for several orbits, a table or an orbit with secular rates. `Plan.skipped` says why.
/// order : int, optional
///     Fixed order of the series, of the secular part too (theory §7), 0 to 60; by default, with ``method="series"``, the one that the tolerance needs (theory §5).
///     A fixed order is not raised for the tolerance: where it is too low, `Plan.error_bound` exceeds the tolerance and ``str(plan)``
///     says that it "is not met", and over what.
/// span : (float, float), optional
///     Two numbers, or two Time, or two TimeDelta from the epoch.
///     Times over which the tolerance is asked for; by default any within 1e9 rotations. A motion can be evaluated outside it, up to
///     1e15 rotations from the epoch; farther away is a `RepresentationError` of the motion. An integrated motion needs a span and can be evaluated within it alone,
///     with the epoch.
/// averaging : {"auto", "orbit", "spin"}, optional
///     How far the equations of a scene with an orbit are averaged: over rotation and orbit, which leaves formulas; over the rotation alone; by
///     default the first where it meets the tolerance.
/// level : {"full", "moving", "paper"}, optional
///     Terms of the short-period corrections: to all orders in J; at J = 0 alone; those with the disturbing body held fixed, as in the paper.
/// name, source : str, optional
///     What the scene is and where its figures come from: kept, printed, and nothing else.
///
/// Raises
/// ------
/// InputError
///     The attitudes ``[0, 0, 0, 0]`` and ``[0, 0, 0, 1.1]``, a tolerance of ``0`` or ``-1``, the span ``(1, 0)``, and any of them that is not finite.
///     An attitude of 3 numbers, an angular velocity of 4. The orders ``-1`` and ``2.5``. A method, an averaging or a level of another name.
/// RepresentationError
///     The order ``61``.
/// TypeError
///     A body that is a list, an orbit that is a number, a tolerance or an epoch that is a text, an order that is a boolean.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0])
/// >>> motion = scene.solve()
/// >>> bool(abs(np.linalg.norm(motion.attitude(100.0)) - 1) < 1e-14)
/// True
#[pyclass(frozen, eq, module = "andoyer")]
pub(crate) struct Scene {
    pub(crate) scene: andoyer_propagate::Scene,
    /// Those of its body.
    pub(crate) tables: SeriesTables,
    /// The epoch, where it was given as a calendar time.
    pub(crate) calendar: Option<Calendar>,
}

impl From<andoyer_propagate::Scene> for Scene {
    fn from(scene: andoyer_propagate::Scene) -> Self {
        Self { scene, tables: SeriesTables::default(), calendar: None }
    }
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        self.scene == other.scene && self.calendar == other.calendar
    }
}
