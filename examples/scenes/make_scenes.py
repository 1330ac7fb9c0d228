"""Computes and writes the scene files of this folder: state from moments, spin period, amplitude and orientation.

    python make_scenes.py            writes them
    python make_scenes.py --check    writes nothing, exit status 1 if a file differs from what would be written

The state is given in Andoyer's angles: attitude R = Rz(lambda) Rx(I) Rz(mu) Rx(J) Rz(nu), angular momentum M (sinJ sin nu, sinJ cos nu, cosJ)
in the body (theory §1). M follows from the spin period, P_spin = 2 pi / (mean rate of mu + nu), the mean rates from Jacobi's closed form in
40 digits (tests/reference/torque_free.py). Apophis has two measured periods instead, which its file states: `Scene.from_periods` finds the state.
The source text of a scene says of each figure whether it was read, and where, whether it is chosen, or computed.
Needs mpmath and andoyer.
"""

import sys
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill

from mpmath import asin, atan2, cos, cospi, degrees, mp, mpf, pi, quad, radians, sin, sinpi, sqrt

import andoyer

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parents[1] / "tests" / "reference"))

from torque_free import TorqueFree  # noqa: E402

mp.dps = 40
HOUR, DAY, YEAR = 3600, 86400, 31557600
GAUSS = mpf("0.01720209895")  # mean motion at 1 au [rad/d]: Gauss's constant


@dataclass
class Recipe:
    """One scene: what is chosen. Angles are in degrees as decimal strings, times in seconds; `source` has fields in braces."""

    file: str
    name: str
    moments: tuple
    nu: str
    node: str
    inclination: str
    source: str
    span: float
    tolerance: float = 1e-12
    nutation: mpf = None  # J [rad] at nu, with the period
    spin: mpf = None  # of the spin
    tumbling: tuple = None  # or instead of both (P_phi, P_psi) of the short axis: the extremal-axis convention in a short-axis mode
    orbit: tuple = None  # of the Sun: semi-major axis [au], eccentricity


RECIPES = [
    Recipe(
        file="earth.toml",
        name="Earth, free wobble of 0.2 arcsec",
        moments=("0.99671522", "0.99673719", "1.0"),
        nu="30",
        node="0",
        inclination="23.4393",
        spin=mpf("0.99726966") * DAY,
        nutation=radians(mpf("0.2") / 3600),
        span=608 * DAY,
        source="""
Moments {moments} in units of C, as in the catalogue: H = 3273795e-9 and the gravity field EGM2008 (both read). Spin period 0.99726966 d, the mean
rate of mu + nu (read: 1.00273781191135448 turns a day, Earth rotation angle of IAU 2000, SOFA). Frame: ecliptic, x along the
node of the plane of the angular momentum; I = obliquity 23.4393 deg (read). The amplitude is chosen, of the size of polar motion:
J = 0.2 arcsec = {J_urad} microradian. Computed: Euler period {wobble_d} d. The real Earth yields and has a fluid core and oceans, which lengthens
this period; the scene is Euler's rigid body. Span: 608 d, two Euler periods and a little.
""",
    ),
    Recipe(
        file="ceres.toml",
        name="Ceres, hypothetical wobble of 0.1 mrad",
        moments=("0.93041346", "0.93287245", "1.0"),
        nu="30",
        node="0",
        inclination="4.04",
        spin=mpf("9.07417") * HOUR,
        nutation=mpf("1e-4"),
        span=YEAR,
        source="""
Moments {moments} in units of C, as in the catalogue: gravity field CERES18D and mean moment 0.37 M R^2 (both read).
Spin period 9.07417 h (read: 952.1532635 deg/d), the mean rate of mu + nu. Frame: orbit plane, x along the node of the plane of the angular momentum;
I = obliquity 4.04 deg, computed from the pole 291.418, 66.764 deg (read). Ceres has no known wobble: the amplitude J = 1e-4 rad is hypothetical.
Computed: wobble period {wobble_h} h. Span: one Julian year.
""",
    ),
    Recipe(
        file="vesta.toml",
        name="Vesta, hypothetical wobble of 0.1 mrad",
        moments=("0.81773335", "0.84452477", "1.0"),
        nu="30",
        node="0",
        inclination="27.44",
        spin=mpf("5.3421276322") * HOUR,
        nutation=mpf("1e-4"),
        span=YEAR,
        source="""
Moments {moments} in units of C, as in the catalogue: gravity field VESTA20H and C/MR^2 = 0.4208 (both read).
Spin period 5.3421276322 h (read), the mean rate of mu + nu. Frame: orbit plane, x along the node of the plane of the angular momentum;
I = obliquity 27.44 deg, computed from the pole 309.031, 42.235 deg (read). Vesta has no known wobble: the amplitude J = 1e-4 rad is hypothetical.
Computed: wobble period {wobble_h} h. Span: one Julian year.
""",
    ),
    Recipe(
        file="eros.toml",
        name="Eros, 2 degrees off its short axis",
        moments=("0.21007832", "0.98310982", "1.0"),
        nu="90",
        node="0",
        inclination="89.0",
        spin=mpf("5.27025543") * HOUR,
        nutation=radians(mpf(2)),
        span=YEAR,
        source="""
Moments {moments} in units of C, as in the catalogue: gravity field JGE15A01 and C/M = 74.4434 km^2 of Miller's shape model (both read).
Spin period 5.27025543 h (read: 1639.389232 deg/d), the mean rate of mu + nu. Frame: orbit plane, x along the node of the plane of the angular momentum;
I = obliquity 89.0 deg (read: Souchay and Kinoshita 2003, abstract).
Eros turns about its short axis with no measured wobble (read: Yeomans et al. 2000, abstract): J = 2 deg is hypothetical, taken at nu = 90 deg, towards the
long axis, where the separatrix stands at {J_separatrix} deg. Computed: J swings between {J_low} and {J_high} deg, wobble period {wobble_h} h,
sigma/sigma_sep = {ratio}. Span: one Julian year.
""",
    ),
    Recipe(
        file="eros-sun.toml",
        name="Eros, 2 degrees off, under the Sun's torque",
        moments=("0.21007832", "0.98310982", "1.0"),
        nu="90",
        node="0",
        inclination="89.0",
        spin=mpf("5.27025543") * HOUR,
        nutation=radians(mpf(2)),
        span=100 * DAY,
        tolerance=1e-8,
        orbit=("1.4581174", "0.2227967"),
        source="""
Body and state as in eros.toml: moments {moments} in units of C; spin period 5.27025543 h (mean rate of mu + nu); I = obliquity 89.0 deg; J = 2 deg is
hypothetical. The Sun's orbit about Eros: a = 1.4581174 au, e = 0.2227967 (read: JPL Small-Body Database), mean motion k a^(-3/2) with Gauss's
k = 0.01720209895 rad/d. Frame: orbit plane, x along the node of the plane of the angular momentum; the pericentre on x and its passage at the epoch
are chosen. Computed: the averaged torque turns the pole at {precession} arcsec a year where J = 0. Span: 100 d.
""",
    ),
    Recipe(
        file="apophis.toml",
        name="Apophis, tumbling",
        moments=("0.61", "0.965", "1.0"),
        nu=None,  # of the state that the periods lead to
        node="5",
        inclination="175",
        tumbling=(mpf("27.38") * HOUR, 263 * HOUR),
        span=YEAR,
        source="""
Moments {moments} in units of C and the periods P_phi = 27.38 h, P_psi = 263 h of Pravec et al. 2014, Icarus 233, 48 (periods read in the list of
tumblers of DAMIT; moments published there, of which the abstract alone was read). Extremal-axis convention: the short axis precesses in P_phi, the body
turns about it in P_psi. The state follows from these two periods. Computed: J swings between {J_low} and {J_high} deg, E/E0 = {energy} (read: Pravec et al.,
1.024 +- 0.013), k^2 = {modulus}, sigma/sigma_sep = {ratio}, and the long axis precesses in {long_axis_h} h; the strongest line of the light curve is at
half of that. Frame: ecliptic; the angular momentum points to longitude 275 deg, latitude -85 deg (read: Lee et al. 2022, arXiv:2204.02540). The phases,
0 at the epoch, are chosen. Span: one Julian year.
""",
    ),
]


def momentum_direction(nutation, nu):
    """Unit angular momentum in the body, theory §1, exactly zero where nu says so."""
    return [sin(nutation) * sinpi(nu / pi), sin(nutation) * cospi(nu / pi), cos(nutation)]


def mean_rates(moments, nutation, nu):
    """Mean rates of mu and nu for M = 1, and the parameter k^2 of the elliptic functions."""
    rates = [g / mpf(moment) for g, moment in zip(momentum_direction(nutation, nu), moments)]
    motion = TorqueFree(moments, [0, 0, 0, 1], rates)
    precession, roll = motion.mean_rates()
    return mpf(precession), mpf(roll), mpf(motion.parameter)


def state_of_periods(recipe):
    """J and nu at the epoch, and M, of the state that `Scene.from_periods` finds."""
    state = andoyer.Scene.from_periods(andoyer.Body([float(moment) for moment in recipe.moments]), *(float(period) for period in recipe.tumbling))
    g1, g2, g3 = (mpf(moment) * mpf(float(rate)) for moment, rate in zip(recipe.moments, state.angular_velocity))
    return atan2(sqrt(g1**2 + g2**2), g3), atan2(g1, g2), sqrt(g1**2 + g2**2 + g3**2)


def action(moments, energy):
    """sigma of the energy integral E gamma / alpha, quadrature of theory §5."""
    a, b, c = (mpf(x) for x in moments)
    alpha = (c / a + c / b) / 2 - 1
    beta = (c / a - c / b) / 2 / alpha

    def tilt(nu):
        # 1 - sqrt(1 - x) in the form that loses nothing at small J; on the separatrix 1 - x may round below 0 at nu = 0.
        x = energy / (1 - beta * cos(2 * nu))
        return x / (1 + sqrt(max(1 - x, 0)))

    return quad(tilt, [0, pi / 4, pi / 2]) * 2 / pi


def describe(recipe, nutation, nu, momentum):
    """The computed figures that a scene's source text quotes, formatted."""
    a, b, c = (mpf(x) for x in recipe.moments)
    precession, roll, parameter = mean_rates(recipe.moments, nutation, nu)
    g = momentum_direction(nutation, nu)
    excess = (c / a - 1) * g[0] ** 2 + (c / b - 1) * g[1] ** 2  # 2T C / M^2 - 1
    alpha, beta = (c / a + c / b) / 2 - 1, (c / a - c / b) / (c / a + c / b - 2)
    spin, wobble = 2 * pi / (momentum * (precession + roll)), 2 * pi / (-roll * momentum)
    swing = [asin(sqrt(excess / (c / moment - 1))) for moment in (a, b)]

    def figure(x, digits):
        return mp.nstr(x, digits, strip_zeros=False)

    return {
        "precession": figure(precession_of_pole(recipe, momentum), 4) if recipe.orbit else None,
        "moments": " : ".join(recipe.moments),
        "wobble_d": figure(wobble / DAY, 5),
        "wobble_h": figure(wobble / HOUR, 5),
        "long_axis_h": figure(spin / HOUR, 4),
        "J": figure(degrees(nutation), 6),
        "J_urad": figure(nutation * 10**6, 6),
        "J_low": figure(degrees(swing[0]), 4),
        "J_high": figure(degrees(swing[1]), 4),
        "J_separatrix": figure(degrees(asin(sqrt((c / b - 1) / (c / a - 1)))), 3),
        "energy": figure(1 + excess, 5),
        "modulus": figure(parameter, 3),
        "ratio": figure(action(recipe.moments, excess / alpha) / action(recipe.moments, 1 - beta), 3),
    }


def mean_motion(recipe):
    """Mean motion of the Sun [rad/s]."""
    return GAUSS / DAY / mpf(recipe.orbit[0]) ** mpf("1.5")


def precession_of_pole(recipe, momentum):
    """d lambda/dt of theory section 9, averaged over rotation and orbit, at J = 0, in arcseconds a year; momentum in units of C."""
    a, b, c = (mpf(x) for x in recipe.moments)
    shape = (1 - mpf(recipe.orbit[1]) ** 2) ** mpf("-1.5")
    rate = -1.5 * mean_motion(recipe) ** 2 / momentum * shape * (c - (a + b) / 2) * cos(radians(mpf(recipe.inclination)))
    return degrees(rate) * 3600 * YEAR


def orbit_table(recipe):
    """The table of the orbit, in the plane and with its pericentre on the x axis at the epoch, if there is one."""
    if not recipe.orbit:
        return ""
    return f"\n[orbit]\nmean_motion = {float(mean_motion(recipe))!r}\neccentricity = {recipe.orbit[1]}\n"


def quaternion(recipe, nutation, nu, mu):
    """[x, y, z, w] of Rz(lambda) Rx(I) Rz(mu) Rx(J) Rz(nu)."""
    q = [mpf(0), mpf(0), mpf(0), mpf(1)]
    turns = [(2, radians(mpf(recipe.node))), (0, radians(mpf(recipe.inclination))), (2, mu), (0, nutation), (2, nu)]
    for axis, angle in turns:
        s, c = sin(angle / 2), cos(angle / 2)
        i, j, k = axis, (axis + 1) % 3, (axis + 2) % 3
        r = [mpf(0)] * 4
        r[i], r[3] = q[i] * c + q[3] * s, q[3] * c - q[i] * s
        r[j], r[k] = q[j] * c + q[k] * s, q[k] * c - q[j] * s
        q = r
    return q


def row(values):
    """A list of numbers as TOML has it."""
    return "[" + ", ".join(repr(float(x)) for x in values) + "]"


def periods_table(recipe):
    """The table of the periods, the angular momentum towards the pole of node and inclination."""
    precession, rotation = (float(period) for period in recipe.tumbling)
    direction = row([radians(mpf(recipe.node) - 90), radians(90 - mpf(recipe.inclination))])
    return f"[periods]\nprecession = {precession!r}\nrotation = {rotation!r}\nmomentum_direction = {direction}\n"


def state_table(recipe, nutation, nu, momentum):
    """The table of the state, and what is said of it."""
    rates = [momentum * g / mpf(moment) for g, moment in zip(momentum_direction(nutation, nu), recipe.moments)]
    attitude = quaternion(recipe, nutation, nu, -nu)
    angles = f"lambda = {recipe.node} deg, I = {recipe.inclination} deg, mu = -{recipe.nu} deg, nu = {recipe.nu} deg"
    return f"[state]\nattitude = {row(attitude)}\nangular_velocity = {row(rates)}\n", f" The state: {angles}."


def scene(recipe):
    """The text of a scene file."""
    if recipe.tumbling:
        nutation, nu, momentum = state_of_periods(recipe)
        table, said = periods_table(recipe), ""
    else:
        nutation, nu = recipe.nutation, radians(mpf(recipe.nu))
        precession, roll, _ = mean_rates(recipe.moments, nutation, nu)
        momentum = 2 * pi / recipe.spin / (precession + roll)
        table, said = state_table(recipe, nutation, nu, momentum)
    source = recipe.source.strip().format(**describe(recipe, nutation, nu, momentum)) + said + " Computed by make_scenes.py."
    return f'''name = "{recipe.name}"
source = """
{fill(source, 120)}
"""
epoch = 0.0
span = {row([0, recipe.span])}
tolerance = {recipe.tolerance!r}

[body]
moments = [{", ".join(recipe.moments)}]

{table}{orbit_table(recipe)}'''


def main(check):
    stale = []
    for recipe in RECIPES:
        path, text = FOLDER / recipe.file, scene(recipe)
        if check:
            if not path.exists() or path.read_text(encoding="utf-8") != text:
                stale.append(recipe.file)
        else:
            path.write_text(text, encoding="utf-8")
    if stale:
        sys.exit(f"differ from what make_scenes.py computes: {' '.join(stale)}")


if __name__ == "__main__":
    main("--check" in sys.argv[1:])
