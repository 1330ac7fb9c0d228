"""The engines of the propagation benchmark.

An engine is made for one scene and its times. It can be `measure`d several times, returns some `rows` of its last run, and is closed at the end.
The module of a rival is imported when its engine is made.
"""

import json
import subprocess
import time
from statistics import median

import numpy as np

import andoyer

SAMPLE_SECONDS = 0.02  # shorter runs are repeated until a sample has this much
LEAST_RUNS = 3  # and so often, if they are below
LONG_SECONDS = 0.1


class Unfit(Exception):
    """The engine does not serve this scene or these times; the message says why."""


def cpu(run):
    """Median CPU seconds of `run`, and its last result.

    The first run after another engine fills new pages of memory, which takes 10 to 100 ns a row. The median, unlike the mean, does not include this.
    """
    seconds, answer = [], None
    while sum(seconds) < SAMPLE_SECONDS or (len(seconds) < LEAST_RUNS and seconds[0] < LONG_SECONDS):
        start = time.process_time()
        answer = run()
        seconds.append(time.process_time() - start)
    return median(seconds), answer


class Engine:
    """An engine in this process: `prepare` computes everything that does not depend on the times, and `sample` evaluates all times."""

    def __init__(self, scene, times):
        self.scene, self.times = scene, times

    def set_up(self):
        seconds, self.prepared = cpu(self.prepare)
        return seconds

    def evaluate(self):
        seconds, self.answer = cpu(self.sample)
        return seconds

    def measure(self):
        """CPU seconds of the set-up, of the samples, and of both. The first two are None if they cannot be separated."""
        set_up, evaluation = self.set_up(), self.evaluate()
        return set_up, evaluation, set_up + evaluation

    def close(self):
        """End a child process of the engine."""


class Own(Engine):
    """andoyer: `Scene(…).solve()` and `Motion.at`, both called from Python."""

    def __init__(self, scene, times, method="closed"):
        super().__init__(scene, times)
        self.method = method
        try:
            self.prepare()
        except andoyer.TheoryError as problem:
            raise Unfit("the series does not reach this scene") from problem

    def prepare(self):
        scene = self.scene
        # A new body each time, so that no tables of earlier scenes are used.
        return andoyer.Scene(andoyer.Body(scene.moments), scene.attitude, scene.rates, method=self.method).solve()

    def sample(self):
        return self.prepared.at(self.times)

    def rows(self, indices):
        return np.hstack([self.answer.attitude[indices], self.answer.angular_velocity[indices]])


class OwnRates(Own):
    """andoyer: the rates alone, written to an existing array."""

    def __init__(self, scene, times):
        super().__init__(scene, times)
        self.out = np.zeros((len(times), 3))

    def sample(self):
        return self.prepared.angular_velocity(self.times, out=self.out)


class Store(Engine):
    """A lower bound of any evaluation: storing one number in every place of an array of seven or three columns, which is existing or new."""

    def __init__(self, scene, times, columns=7, new=False):
        super().__init__(scene, times)
        self.columns, self.out = columns, None if new else np.zeros((len(times), columns))

    def set_up(self):
        return 0.0

    def sample(self):
        if self.out is None:
            return np.full((len(self.times), self.columns), 1.0)
        return self.out.fill(1.0)


class Heyoka(Engine):
    """heyoka.py: Euler's equations and q′ = q ω/2 by Taylor series, and its continuous output.

    The integrator is compiled before the measurement. Its default options are the fastest here: `slp_vectorize` takes a third longer, and `force_avx512`, `fast_math` and `compact_mode` do not save time.
    """

    def __init__(self, scene, times, tolerance):
        import heyoka

        super().__init__(scene, times)
        self.state = [*scene.attitude, *scene.rates]
        (a, b, c), (x, y, z, w, p, q, r) = scene.moments, heyoka.make_vars(*"xyzwpqr")
        kinematics = [(x, w * p + y * r - z * q), (y, w * q + z * p - x * r), (z, w * r + x * q - y * p), (w, -(x * p + y * q + z * r))]
        system = [(variable, 0.5 * slope) for variable, slope in kinematics]
        system += [(p, (b - c) / a * q * r), (q, (c - a) / b * r * p), (r, (a - b) / c * p * q)]
        self.integrator = heyoka.taylor_adaptive(system, self.state, tol=tolerance)

    def restart(self):
        self.integrator.time = 0.0
        self.integrator.state[:] = self.state

    def prepare(self):
        self.restart()
        return self.integrator.propagate_until(self.times[-1], c_output=True)[4]

    def sample(self):
        return self.prepared(self.times)

    def rows(self, indices):
        return self.answer[indices]


class HeyokaGrid(Heyoka):
    """heyoka.py by `propagate_grid`, which integrates and evaluates at once."""

    def sample(self):
        self.restart()
        return self.integrator.propagate_grid(self.times)[5]

    def measure(self):
        return None, None, self.evaluate()


class ScipyClosed(Engine):
    """SciPy's elliptic functions and Carlson integrals."""

    def prepare(self):
        from jacobi import Jacobi

        return Jacobi(self.scene.moments, self.scene.attitude, self.scene.rates)

    def sample(self):
        return self.prepared.at(self.times)

    def rows(self, indices):
        attitudes, rates = self.answer
        return np.hstack([attitudes[indices], rates[indices]])


class ScipyDop853(Engine):
    """SciPy's DOP853 and its dense output."""

    tolerance = 1e-13

    def prepare(self):
        from scipy.integrate import solve_ivp

        a, b, c = self.scene.moments
        first, second, third = (b - c) / a, (c - a) / b, (a - b) / c

        def slope(_, row):
            x, y, z, w, p, q, r = row.tolist()
            kinematics = [0.5 * (w * p + y * r - z * q), 0.5 * (w * q + z * p - x * r), 0.5 * (w * r + x * q - y * p), -0.5 * (x * p + y * q + z * r)]
            return [*kinematics, first * q * r, second * r * p, third * p * q]

        state = [*self.scene.attitude, *self.scene.rates]
        span = (0.0, self.times[-1])
        return solve_ivp(slope, span, state, method="DOP853", rtol=self.tolerance, atol=self.tolerance, dense_output=True).sol

    def sample(self):
        return self.prepared(self.times)

    def rows(self, indices):
        return self.answer.T[indices]


class Process(Engine):
    """A child process that reads a scene, and answers each further line with the result of a run as JSON."""

    def __init__(self, scene, times, command, header, indices):
        super().__init__(scene, times)
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        numbers = [*scene.moments, *scene.attitude, *scene.rates, *header, *indices]
        self.send(" ".join(repr(float(x)) for x in numbers))

    def send(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def run(self):
        self.send("run")
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self.process.args[0]} has ended with status {self.process.wait()}")
        self.answer = json.loads(line)
        return self.answer

    def rows(self, indices):
        return np.array(self.answer["rows"])

    def close(self):
        self.process.stdin.close()
        self.process.wait()


class OdeSolvers(Process):
    """DOP853 of the Rust crate ode_solvers with dense output. The output is at uniform times only, and its time cannot be separated from the integration."""

    tolerance = 1e-13

    def __init__(self, scene, times, indices, command, grid):
        if grid != "uniform":
            raise Unfit("no output at other than uniform times")
        super().__init__(scene, times, [command], [self.tolerance, len(times), times[-1]], indices)

    def measure(self):
        answer = self.run()
        return answer["set_up"], None, answer["seconds"]


class Orekit(Process):
    """Orekit's TorqueFree, in a virtual machine that has warmed up."""

    def __init__(self, scene, times, indices, command):
        super().__init__(scene, times, command, [len(times), *times], indices)

    def measure(self):
        answer = self.run()
        return answer["set_up"], answer["seconds"] - answer["set_up"], answer["seconds"]
