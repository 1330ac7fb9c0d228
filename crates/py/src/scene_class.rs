//! The class `Scene`. Its methods are in [`crate::scene`], because `Scene.solve` returns a `Motion` and `Motion.scene` returns a `Scene`.

use pyo3::prelude::*;

use crate::foreign::Calendar;

/// A body, its state at an epoch, and the requested accuracy of the solution.
///
/// The gravity of point masses acts on the body, and torques that you state: there is no drag and no control.
///
/// Time, moments and angular velocity are in any consistent set of units; angles are in rad.
///
/// Parameters
/// ----------
/// body : Body
///     The rotating body.
/// attitude : array_like, shape (4,), scipy.spatial.transform.Rotation, or a quaternion of another package
///     Unit quaternion [x, y, z, w], scalar last (Hamilton product), that rotates body components into inertial ones. Its norm must be within 1e-6
///     of 1; the quaternion is then normalized. A value that names its components x, y, z, w is read by these names, whatever the order in its memory.
/// angular_velocity : array_like, shape (3,)
///     Body components, in rad per unit of time; zeros mean a body at rest. Every function converts a Quantity of astropy to SI units, and a Time to
///     TDB seconds since J2000.
/// scalar_first : bool, optional
///     If True, the numbers of `attitude` are [w, x, y, z]. The property `attitude` is always [x, y, z, w].
/// epoch : float or astropy.time.Time, optional
///     Time of the state. The two doubles of a Time are kept, with its time scale. The times of the motion may then be Time objects, and numbers are seconds since J2000.
/// orbit : Orbit or TabulatedOrbit, or a sequence of them, optional
///     Relative orbits of the bodies whose gravity gradients act (theory §9). By default there is no orbit, and the motion is free.
/// tolerance : float, optional
///     Requested attitude error over the span, in rad. A tolerance below about 1e-14 requests the best accuracy of double precision,
///     which `Plan.error_bound` states.
/// method : {"auto", "series", "closed", "integrated", "libration"}, optional
///     Perturbation series, closed form (with an orbit: averaged theory), numerical integration of the full equations over the span, or the normal form about
///     a spin–orbit resonance of a body locked to one fixed orbit ("libration"; "auto" uses it over thousands of orbits, if it meets the tolerance). "auto" uses the closed
///     form, or the series if an order is fixed. With an orbit and a span it uses the integration if the theory does not hold, or if the theory misses the tolerance and the
///     integration meets it. It also integrates with several orbits, a table or an orbit with secular rates. `Plan.skipped` states the reason.
/// order : int, optional
///     Fixed order of the series and of the secular part (theory §7), 0 to 60, or of the normal form of a libration, 2 to 16. By default ``method="series"`` and
///     ``method="libration"`` use the order that the tolerance needs (theory §5).
///     A fixed order stays fixed, whatever the tolerance. If it is too low, `Plan.error_bound` exceeds the tolerance, and ``str(plan)``
///     says that the tolerance "is not met over the span".
/// span : (float, float), optional
///     First and last time over which the tolerance is requested: two numbers, two Time objects, or two TimeDelta from the epoch. By default it is
///     1e9 rotations. With ``averaging="spin"`` a motion reaches 65,534 orbits, and ``str(plan)`` says how many rotations these are if they are fewer.
///     A motion can be evaluated outside the span, up to 1e15 rotations (with ``averaging="spin"`` 65,534 orbits) from the epoch; a later time is a `RepresentationError` of the motion. An integrated motion needs a span and can be evaluated within the span and at the epoch only.
/// averaging : {"auto", "orbit", "spin"}, optional
///     Averaging of a scene with an orbit: "orbit" averages over rotation and orbit and uses formulas alone; "spin" averages over the rotation alone;
///     "auto" in first order uses "orbit" if it meets the tolerance, otherwise "spin"; in second order it uses "spin", or "orbit" beyond 65,534 orbits.
/// level : {"auto", "full", "second-order", "moving", "paper"}, optional
///     How much of the theory of the gravity gradient is used. "full": first order in the torque, to all orders in J. "second-order": the
///     averaged motion to second order too, by either averaging (theory, section 9). "auto" (default): "full" where it meets the
///     tolerance, else "second-order" where its error bound is smaller. "moving": corrections at J = 0 alone. "paper": those with the disturbing body held fixed.
/// torques : Torque or sequence of Torque, optional
///     Torques beside the gravity gradient. A scene with any of them is integrated over its span.
/// name, source : str, optional
///     A name and a source of the figures, kept with the scene and printed.
///
/// Raises
/// ------
/// InputError
///     An attitude whose norm is not 1 (``[0, 0, 0, 1.1]``); a tolerance that is not positive; a span whose first time is above the second; a value that is not finite;
///     an array of another shape; an order that is negative or not whole (``-1``, ``2.5``); an unknown method, averaging or level.
///     When the scene is solved: the level "second-order", or the averaging "orbit", with several disturbing bodies or an orbit that precesses.
/// RepresentationError
///     An order above 60.
/// TypeError
///     A quaternion of a class that does not name its components x, y, z, w; a body that is not a `Body`, an orbit that is not an `Orbit`, a tolerance or an epoch that is a text, an order that is a boolean.
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
    /// The epoch, if it was given as a calendar time.
    pub(crate) calendar: Option<Calendar>,
}

impl From<andoyer_propagate::Scene> for Scene {
    fn from(scene: andoyer_propagate::Scene) -> Self {
        Self { scene, calendar: None }
    }
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        self.scene == other.scene && self.calendar == other.calendar
    }
}
