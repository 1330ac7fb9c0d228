"""Compare derivatives with respect to the parameters of torques with variational equations in 80 bits.

    python tests/stress/torque_partials.py                  50 scenes of each of six kinds of torques, some minutes of one core
    python tests/stress/torque_partials.py --scenes 5 --kind dipole --each

The reference is variations.c beside this file, compiled with cc: it integrates motion and derivatives in long doubles by another rule, knows each torque by its monomials, and is run twice, the second time with steps half as long. An error is the largest difference in
a column at a time over the largest element of this column at this time. Exit status 1 if the median over the scenes, of the largest error of each, exceeds 1e-13, or if an error exceeds 1e-10.
"""

import argparse
import ast
import subprocess
import sys
import tempfile
import tomllib
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import andoyer
from andoyer import Body, Field, Orbit, Scene, Torque

Array = NDArray[np.float64]
Random = np.random.Generator
# The exponents of the components of the sources in their sequence, and of the rates.
Polynomial = dict[tuple[int, ...], float]
SOURCE = Path(__file__).with_name("variations.c")
STEP, TIMES, MEDIAN, LIMIT = 0.1, 5, 1e-13, 1e-10
RADIUS, SIZE = 6371.2, 7500.0


def ellipse(random: Random) -> Orbit:
    return Orbit(
        random.uniform(0.01, 0.05),
        random.uniform(0, 0.4),
        semi_major_axis=SIZE,
        time_of_pericentre=random.uniform(-50, 50),
        inclination=random.uniform(0, 3),
        node=random.uniform(0, 6),
        argument_of_pericentre=random.uniform(0, 6),
    )


def place(random: Random) -> Orbit | Array:
    return ellipse(random) if random.random() < 0.5 else random.normal(size=3)


def constant(random: Random) -> Torque:
    return Torque.constant(random.normal(size=3) * 10 ** random.uniform(-4, -1.5))


def damping(random: Random) -> Torque:
    matrix = random.normal(size=(3, 3))
    return Torque.damping(matrix @ matrix.T * 10 ** random.uniform(-4, -2))


def rotor(random: Random) -> Torque:
    return Torque.rotor(random.normal(size=3) * 10 ** random.uniform(-3, 0))


def dipole(random: Random) -> Torque:
    field = Field.dipole(radius=RADIUS, equatorial=2.0, axis=random.normal(size=3), orbit=ellipse(random), rotation_rate=random.uniform(0, 1e-2))
    return Torque.dipole(random.normal(size=3) * 10 ** random.uniform(-4, -1.5), field if random.random() < 0.7 else random.normal(size=3))


def polynomial(random: Random) -> Torque:
    """Up to four monomials a component, of degree 4 at most in one or two directions and the rates."""
    names = ["s", "t"][: random.integers(1, 3)]
    letters = [f"{name}{axis}" for name in [*names, "w"] for axis in (1, 2, 3)]
    scale = 10 ** random.uniform(-4, -1.5)

    def monomial() -> str:
        factors = random.choice(letters, size=random.integers(0, 5))
        return "*".join([repr(float(scale * random.normal())), *factors])

    texts = [" + ".join(monomial() for _ in range(random.integers(1, 5))) for _ in range(3)]
    sources = {name: place(random) for name in names}
    orbits = [name for name, source in sources.items() if isinstance(source, Orbit)]
    powers = {name: float(random.integers(-3, 5)) for name in orbits}
    return Torque.polynomial(texts, sources=sources, distance_powers=powers, reference_distances=dict.fromkeys(powers, SIZE))


def surface(random: Random) -> Torque:
    """Light on three to six plates. Up to degree 2 each coefficient has a column, above it the factor alone."""
    count, source = random.integers(3, 7), place(random)
    shape = {"normals": random.normal(size=(count, 3)), "areas": random.uniform(1, 3, count), "centroids": random.normal(size=(count, 3))}
    at = SIZE if isinstance(source, Orbit) else None
    return Torque.panels(**shape, specular=0.3, pressure=10 ** random.uniform(-4, -2), source=source, at=at, degree=int(random.integers(1, 9)))


KINDS: dict[str, Callable[[Random], Torque]] = {
    "constant": constant,
    "damping": damping,
    "rotor": rotor,
    "dipole": dipole,
    "polynomial": polynomial,
    "surface": surface,
}


def drawn(kind: str, seed: int) -> tuple[Scene, Array]:
    """A scene whose first torque is of this kind, and times on one side of its epoch."""
    random = np.random.default_rng([73, list(KINDS).index(kind), seed])
    middle = random.uniform(1.1, 1.8)
    moments = np.array([1.0, middle, random.uniform(middle, 1.0 + middle)])
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    body = Body(random.permutation(moments)) if random.random() < 0.5 else Body.from_inertia(turn @ np.diag(moments) @ turn.T)
    torques = [KINDS[kind](random)]
    if random.random() < 0.5:
        torques.append(list(KINDS.values())[random.integers(len(KINDS))](random))
    attitude, rates = random.normal(size=4), random.normal(size=3)
    rates *= random.uniform(0.5, 1.5) / np.linalg.norm(rates)
    span = random.uniform(20, 60) * random.choice([-1, 1])
    orbit = ellipse(random) if random.random() < 0.5 else None
    given = {"torques": torques, "orbit": orbit, "span": sorted((0.0, span)), "tolerance": 1e-9, "method": "integrated"}
    return Scene(body, attitude / np.linalg.norm(attitude), rates, **given), span * np.sort(random.uniform(size=TIMES))


def product(one: Polynomial, other: Polynomial) -> Polynomial:
    found: Polynomial = {}
    for first, a in one.items():
        for second, b in other.items():
            key = tuple(x + y for x, y in zip(first, second, strict=True))
            found[key] = found.get(key, 0.0) + a * b
    return found


def parsed(text: str, names: list[str]) -> Polynomial:
    """The terms of a polynomial in letters with an axis, such as s1; `names` are the letters."""
    letters = [f"{name}{axis}" for name in names for axis in (1, 2, 3)]

    def value(node: ast.expr) -> Polynomial:
        if isinstance(node, ast.Constant):
            return {(0,) * len(letters): float(node.value)}
        if isinstance(node, ast.Name):
            return {tuple(int(letter == node.id) for letter in letters): 1.0}
        if isinstance(node, ast.UnaryOp):
            return {key: -x for key, x in value(node.operand).items()}
        if not isinstance(node, ast.BinOp):
            raise TypeError(text)
        left, right = value(node.left), value(node.right)
        if isinstance(node.op, ast.Mult):
            return product(left, right)
        if isinstance(node.op, ast.Pow):
            power = {(0,) * len(letters): 1.0}
            for _ in range(int(right[(0,) * len(letters)])):
                power = product(power, left)
            return power
        sign = -1.0 if isinstance(node.op, ast.Sub) else 1.0
        return {key: left.get(key, 0.0) + sign * right.get(key, 0.0) for key in left | right}

    return value(ast.parse(text.replace("^", "**"), mode="eval").body)


def line(*numbers: float) -> str:
    return " ".join(repr(float(x)) for x in numbers)


def of_orbit(table: dict) -> str:
    mean_motion = table["mean_motion"]
    names = ("mean_motion", "eccentricity", "time_of_pericentre", "inclination", "node", "argument_of_pericentre")
    return line(*(table[name] for name in names), table.get("semi_major_axis", 1.0), mean_motion**2 * table["mass_fraction"])


def of_source(table: dict) -> str:
    power = line(table.get("power", 0.0), table.get("reference_distance", 1.0))
    if "direction" in table:
        return f"0 {power} {line(*table['direction'])}"
    field = table.get("field")
    if field is None:
        return f"1 {power} {of_orbit(table['orbit'])}"
    return f"2 {power} {of_orbit(table['orbit'])} {line(field['radius'], field['equatorial'], *field['axis'], field.get('rotation_rate', 0.0))}"


def unit(axis: int) -> str:
    return " ".join(str(int(k == axis)) for k in range(3))


def rate_terms(matrix: Array) -> list[str]:
    """The terms of a torque that is a matrix times ω."""
    return [f"{i} {float(matrix[i, k])!r} {unit(k)} 0" for i in range(3) for k in range(3) if matrix[i, k]]


def skew(vector: Array) -> Array:
    """The matrix of h ×."""
    x, y, z = vector
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def polynomial_terms(component: int, polynomial: Polynomial, first: int) -> list[str]:
    """Each term multiplies by the powers of the distances of all sources of its torque."""
    found = []
    for exponents, coefficient in polynomial.items():
        sources = [exponents[k : k + 3] for k in range(0, len(exponents) - 3, 3)]
        parts = " ".join(f"{first + k} {' '.join(map(str, powers))}" for k, powers in enumerate(sources))
        found.append(f"{component} {coefficient!r} {' '.join(map(str, exponents[-3:]))} {len(sources)} {parts}")
    return found


def terms(table: dict, first: int) -> list[str]:
    """The terms of a torque of a scene file, whose first source has this number."""
    if "constant" in table:
        return [f"{axis} {x!r} 0 0 0 0" for axis, x in enumerate(table["constant"])]
    if "damping" in table:
        return rate_terms(-np.array(table["damping"]))
    if "rotor" in table:
        return rate_terms(skew(np.array(table["rotor"])))
    names = [source["name"] for source in table["source"]] + ["w"]
    return [term for axis, text in enumerate(table["polynomial"]) for term in polynomial_terms(axis, parsed(text, names), first)]


def column(parameter: str, table: dict) -> list[str]:
    """What a parameter of the first torque multiplies."""
    name, _, which = parameter.partition("[")[0].partition("_")
    if name == "constant":
        return [f"{int(which) - 1} 1 0 0 0 0"]
    if name == "damping":
        matrix = np.zeros((3, 3))
        matrix[int(which[0]) - 1, int(which[1]) - 1] = -1
        return rate_terms(matrix)
    if name == "rotor":
        return rate_terms(skew(np.eye(3)[int(which) - 1]))
    if name == "factor":
        return terms(table, 0)
    if name == "dipole":
        matrix = skew(np.eye(3)[int(which) - 1])
        # A uniform field is a direction, without its size.
        field = table["source"][0].get("direction")
        size = 1.0 if field is None else float(np.linalg.norm(field))
        return [f"{i} {float(size * matrix[i, k])!r} 0 0 0 1 0 {unit(k)}" for i in range(3) for k in range(3) if matrix[i, k]]
    axis, _, monomial = which.partition(":")
    return polynomial_terms(int(axis) - 1, parsed(monomial, [source["name"] for source in table["source"]] + ["w"]), 0)


def reference(program: Path, scene: Scene, times: Array, parameters: tuple[str, ...], step: float) -> Array:
    """The derivatives (times, columns, 6) by the variational equations."""
    data = tomllib.loads(scene.to_toml())
    body = data["body"]
    tensor = np.diag(body["moments"]) if "moments" in body else np.array(body["inertia"])
    sources, total = [], []
    for table in data["torque"]:
        total += terms(table, len(sources))
        sources += map(of_source, table.get("source", []))
    orbits = [of_orbit(data["orbit"])] if "orbit" in data else []
    columns = [column(parameter, data["torque"][0]) for parameter in parameters]
    state = line(*tensor.ravel(), *data["state"]["attitude"], *data["state"]["angular_velocity"])
    rows = [state, f"{len(orbits)}", *orbits, f"{len(sources)}", *sources, f"{len(columns)}"]
    for sum_of_terms in [total, *columns]:
        rows += [f"{len(sum_of_terms)}", *sum_of_terms]
    rows += [f"{step!r} {len(times)} {line(*times)}"]
    found = subprocess.run([program], input="\n".join(rows), capture_output=True, text=True, check=True).stdout
    return np.array(found.split(), dtype=np.longdouble).reshape(len(times), len(columns), 6)


def compared(program: Path, kind: str, seed: int) -> tuple[float, float, str]:
    """The largest error of a scene, what the reference leaves unknown in the same measure, and where the error is."""
    scene, times = drawn(kind, seed)
    partials = scene.solve().partials(times, with_respect_to=[("torque", 0)])
    found = np.concatenate([partials.attitude, partials.angular_velocity], axis=1).transpose(0, 2, 1)
    coarse, exact = (reference(program, scene, times, partials.parameters, step) for step in (STEP, STEP / 2))
    size = np.abs(exact).max(axis=2)
    errors = np.abs(found - exact).max(axis=2) / size
    row, which = np.unravel_index(np.argmax(errors), errors.shape)
    where = f"{kind} {seed}: {partials.parameters[which]} at {times[row]:.1f}, of size {float(size[row, which]):.1e}"
    return float(errors.max()), float((np.abs(coarse - exact).max(axis=2) / size).max()), where


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=50, help="of each kind (50)")
    parser.add_argument("--kind", choices=KINDS, help="this one alone")
    parser.add_argument("--each", action="store_true", help="a line for each scene")
    asked = parser.parse_args()
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    kinds = [asked.kind] if asked.kind else list(KINDS)
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "variations"
        subprocess.run(["cc", "-O2", "-o", program, SOURCE, "-lm"], check=True)
        for kind in kinds:
            found[kind] = [compared(program, kind, seed) for seed in range(asked.scenes)]
            for error, unknown, where in found[kind] if asked.each else []:
                print(f"{error:.1e} (reference {unknown:.0e}) {where}")
    every = [row for rows in found.values() for row in rows]
    print(f"{len(every)} scenes, the largest error of each over its parameters and {TIMES} times; 5, 50, 95, 100 %:")
    for name, rows in {**found, "all": every, "reference": [(unknown, 0, "") for _, unknown, _ in every]}.items():
        print(f"{name:12}", "  ".join(f"{value:.1e}" for value in np.quantile([row[0] for row in rows], [0.05, 0.5, 0.95, 1])))
    for error, unknown, where in sorted(every, reverse=True)[:3]:
        print(f"largest: {error:.1e} (reference {unknown:.0e}), {where}")
    errors = [row[0] for row in every]
    return int(np.median(errors) > MEDIAN or max(errors) > LIMIT)


if __name__ == "__main__":
    sys.exit(main())
