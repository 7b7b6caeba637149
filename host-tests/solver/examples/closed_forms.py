#!/usr/bin/env python3
"""Error against run time of the full solver, scipy's DOP853 and Radau, and openTorsion, on motions of closed form.

    pip install numpy scipy opentorsion matplotlib
    python3 host-tests/solver/examples/closed_forms.py --markdown doc/solver-time.md --plot doc/solver-time.svg

The full solver runs in the example `closed_forms` beside this file, whose cases these are. A time is the processor's
for one run, the middle of several, without the start of Python or of the program. An error is the largest of the twist
of the first shaft at 200 instants, over the twist's largest value.
"""

import argparse
import datetime
import importlib.metadata
import json
import math
import pathlib
import platform
import statistics
import subprocess
import time

import numpy
import scipy
from scipy.integrate import solve_ivp

SAMPLES = 200
RUNS = 3
TOLERANCES = {"DOP853": (1e-4, 1e-6, 1e-8, 1e-10, 1e-12), "Radau": (1e-4, 1e-6, 1e-8)}
HERE = pathlib.Path(__file__).resolve().parent


class Chain:
    """Inertias on shafts; states are the twists, then the speeds."""

    def __init__(self, inertias, stiffness, damping, torque, end, gap=0.0, start=None, load=None, corners=()):
        self.inertias = numpy.array(inertias)
        self.n, self.shafts = len(inertias), len(inertias) - 1
        self.stiffness, self.damping, self.torque, self.end = stiffness, damping, torque, end
        self.gap, self.load, self.corners = gap, load, corners
        self.start = numpy.zeros(2 * self.n - 1) if start is None else numpy.array(start, dtype=float)
        self.times = end * numpy.arange(1, SAMPLES + 1) / SAMPLES
        # x' = A x + B u without a gap, u the torque on the first inertia and against the last
        self.a = numpy.zeros((2 * self.n - 1, 2 * self.n - 1))
        for s in range(self.shafts):
            self.a[s, self.shafts + s], self.a[s, self.shafts + s + 1] = 1.0, -1.0
            for node, sign in ((s, -1.0), (s + 1, 1.0)):
                row = self.shafts + node
                self.a[row, s] += sign * stiffness / inertias[node]
                self.a[row, self.shafts + s] += sign * damping / inertias[node]
                self.a[row, self.shafts + s + 1] -= sign * damping / inertias[node]
        self.b = numpy.zeros((2 * self.n - 1, 2))
        self.b[self.shafts, 0], self.b[-1, 1] = 1.0 / inertias[0], -1.0 / inertias[-1]

    def rates(self, contact):
        """Right-hand side; the gap, where there is one, in a contact: 0 open, 1 and -1 on a flank."""
        a, b = self.a, self.b
        if self.gap == 0.0:
            return lambda t, x: a @ x + b @ (self.torque, self.load(t) if self.load else 0.0)
        (j1, j2), half, k = self.inertias, 0.5 * self.gap, self.stiffness

        def rattle(_, x):
            pull = k * (x[0] - contact * half) if contact else 0.0
            return (x[1] - x[2], -pull / j1, pull / j2)

        return rattle

    def scipy(self, method, tolerance):
        """As its user would: tolerances alone, an event at each flank, a fresh start at each corner of the load."""
        largest = max(abs(self.exact()))
        options = {"method": method, "rtol": max(tolerance, 2.3e-14), "atol": tolerance * largest}
        if method == "Radau" and self.gap == 0.0:
            options["jac"] = self.a
        twists = numpy.empty(SAMPLES)
        t, x, contact = 0.0, self.start, 0
        corners = [corner for corner in self.corners if corner < self.end] + [self.end]
        while corners:
            inside = (self.times > t) & (self.times <= corners[0])
            events = None
            if self.gap > 0.0:
                events = self.flanks(contact)
            run = solve_ivp(self.rates(contact), (t, corners[0]), x, dense_output=True, events=events, **options)
            inside &= self.times <= run.t[-1]
            if inside.any():
                twists[inside] = run.sol(self.times[inside])[0]
            t, x = run.t[-1], run.y[:, -1]
            if run.status == 1:
                contact = 0 if contact else int(math.copysign(1, x[0]))
            else:
                corners.pop(0)
        return twists

    def flanks(self, contact):
        half = 0.5 * self.gap
        sides = [contact] if contact else [1, -1]
        events = []
        for side in sides:
            def crossed(_, x, side=side):
                return side * x[0] - half

            crossed.terminal, crossed.direction = True, -1 if contact else 1
            events.append(crossed)
        return events


def damped_step(force, frequency, damping, t):
    """Of x'' + 2 zeta w x' + w^2 x = force, from rest [any textbook of vibration]."""
    w, zeta = frequency, damping
    if zeta < 1.0:
        wd = w * math.sqrt(1.0 - zeta * zeta)
        decay = numpy.exp(-zeta * w * t)
        return force / w**2 * (1.0 - decay * (numpy.cos(wd * t) + zeta * w / wd * numpy.sin(wd * t)))
    root = w * math.sqrt(zeta * zeta - 1.0)
    fast, slow = zeta * w + root, w * w / (zeta * w + root)
    return force / w**2 * (1.0 - (fast * numpy.exp(-slow * t) - slow * numpy.exp(-fast * t)) / (fast - slow))


def damped_ramp(force, w, zeta, t):
    """The same under force times t, from t = 0 on."""
    t = numpy.maximum(t, 0.0)
    wd = w * math.sqrt(1.0 - zeta * zeta)
    swing = 2.0 * zeta / w * numpy.cos(wd * t) + (2.0 * zeta * zeta - 1.0) / wd * numpy.sin(wd * t)
    return force / w**2 * (t - 2.0 * zeta / w + numpy.exp(-zeta * w * t) * swing)


class Step(Chain):
    title = "two masses, a step of torque: 20 Hz, 10 s"

    def __init__(self):
        super().__init__([0.5, 1.5], 6000.0, 2.0, 10.0, 10.0)

    def exact(self):
        reduced = 0.375
        w = math.sqrt(6000.0 / reduced)
        return damped_step(10.0 / 0.5, w, 2.0 / (2.0 * reduced * w), self.times)


class Pinion(Chain):
    title = "a light pinion between two masses, stiff: 16 Hz beside 50 us, 2 s"

    def __init__(self):
        super().__init__([1.0, 1e-4, 1.0], 1e4, 1.0, 10.0, 2.0)

    def exact(self):
        j, m, k, d = 1.0, 1e-4, 1e4, 1.0
        twist = numpy.zeros(SAMPLES)
        # the masses against each other; both against the pinion
        for shape, square in (((1.0, 0.0, -1.0), k / j), ((m, -2.0 * j, m), k * (2.0 / m + 1.0 / j))):
            norm = j * shape[0] ** 2 + m * shape[1] ** 2 + j * shape[2] ** 2
            w = math.sqrt(square)
            mode = damped_step(shape[0] * 10.0, w, 0.5 * d / k * w, self.times)
            twist += (shape[0] - shape[1]) / norm * mode
        return twist


class Gap(Chain):
    title = "two masses that rattle in a gap, 118 periods, 10 s"

    def __init__(self):
        super().__init__([1.0, 1.0], 1e4, 0.0, 0.0, 10.0, gap=0.02, start=[0.0, 0.5, -0.5])

    def exact(self):
        w, half, speed = math.sqrt(1e4 / 0.5), 0.01, 1.0
        free, contact = 2.0 * half / speed, math.pi / w
        # from the middle of the gap: a quarter to the flank, half a swing on it, and back
        t = numpy.mod(self.times, 2.0 * (free + contact))
        twist = numpy.empty(SAMPLES)
        for i, at in enumerate(t):
            sign = 1.0
            if at > free + contact:
                at, sign = at - (free + contact), -1.0
            if at < 0.5 * free:
                twist[i] = sign * speed * at
            elif at < 0.5 * free + contact:
                twist[i] = sign * (half + speed / w * math.sin(w * (at - 0.5 * free)))
            else:
                twist[i] = sign * (half - speed * (at - 0.5 * free - contact))
        return twist


class Ramp(Chain):
    title = "two masses, a load that comes and goes within 50 ms, 2 s"

    def __init__(self):
        corners = (0.1, 0.15, 1.0, 1.05)

        def load(t):
            return float(numpy.interp(t, corners, (0.0, 20.0, 20.0, 0.0)))

        super().__init__([0.5, 1.5], 6000.0, 2.0, 0.0, 2.0, load=load, corners=corners)

    def exact(self):
        reduced = 0.375
        w = math.sqrt(6000.0 / reduced)
        zeta, slope = 2.0 / (2.0 * reduced * w), 20.0 / 0.05 / 1.5
        corners = zip(self.corners, (1.0, -1.0, -1.0, 1.0))
        return sum(sign * damped_ramp(slope, w, zeta, self.times - corner) for corner, sign in corners)


CASES = {"step": Step, "pinion": Pinion, "gap": Gap, "ramp": Ramp}


def torsion(case, steps):
    """openTorsion's transient simulation, the torques held over a step, of which a sample has `steps`."""
    import opentorsion

    shafts = [opentorsion.Shaft(s, s + 1, k=case.stiffness, c=case.damping) for s in range(case.shafts)]
    disks = [opentorsion.Disk(j, I=inertia) for j, inertia in enumerate(case.inertias)]
    assembly = opentorsion.Assembly(shafts, disk_elements=disks)
    times = case.end * numpy.arange(SAMPLES * steps + 1) / (SAMPLES * steps)
    excitation = opentorsion.TransientExcitation(case.n, times)
    excitation.add_transient(0, numpy.full(len(times), case.torque))
    if case.load:
        # the middle of the step that it is held over
        middles = times + 0.5 * case.end / (SAMPLES * steps)
        excitation.add_transient(case.n - 1, -numpy.array([case.load(t) for t in middles]))
    torques, speeds, _ = assembly.dsim(excitation)
    # its torque is that of twist and damping
    twists = (torques[0] - case.damping * (speeds[0] - speeds[1])) / case.stiffness
    return twists[steps::steps]


def timed(run):
    """The middle of the processor times of several runs, and what the last gave."""
    times, result = [], None
    for _ in range(RUNS):
        begin = time.process_time()
        result = run()
        times.append(time.process_time() - begin)
    return statistics.median(times), result


def measured():
    """Rows of case, solver, setting, error and seconds."""
    program = ["cargo", "run", "--quiet", "--release", "--package", "driveline-solver", "--example", "closed_forms"]
    lines = subprocess.run(program, cwd=HERE, check=True, capture_output=True, text=True).stdout.splitlines()
    full = {line["case"]: line for line in map(json.loads, lines)}
    rows = []
    for name, build in CASES.items():
        case = build()
        exact = case.exact()

        def add(solver, setting, seconds, twists):
            error = max(abs(numpy.asarray(twists) - exact)) / max(abs(exact))
            rows.append((name, solver, setting, error, seconds))

        add("full solver", "", full[name]["seconds"], full[name]["twists"])
        for method, tolerances in TOLERANCES.items():
            for tolerance in tolerances:
                seconds, twists = timed(lambda: case.scipy(method, tolerance))
                add(f"scipy {method}", f"{tolerance:.0e}", seconds, twists)
        if case.gap == 0.0:
            for steps in (1, 10, 100):
                seconds, twists = timed(lambda: torsion(case, steps))
                add("openTorsion", f"{SAMPLES * steps} steps", seconds, twists)
    return rows


def markdown(rows):
    """The page."""
    today = datetime.date.today().isoformat()
    machine = f"{platform.machine()}, {platform.python_implementation()} {platform.python_version()}"
    text = [
        "# Solver's time",
        "",
        "Error against run time of the full solver (`host-tests/solver`) and of what a user would take instead, on",
        "four motions that have a closed form. `host-tests/solver/examples/closed_forms.py` has written this page, on",
        f"{today} ({machine}, scipy {scipy.__version__}, openTorsion {importlib.metadata.version('opentorsion')}).",
        "",
        "- Error: the largest of the twist of the first shaft at 200 instants, over the twist's largest value.",
        "- Time: of the processor for one run, the middle of several, without the start of Python or of the program.",
        "  The full solver is compiled; the others are called from Python, their right-hand sides are Python.",
        "- scipy starts afresh at each corner of the load and, by events, at each flank of the gap. Its tolerance is",
        "  the relative one, and the absolute one over the largest twist. Radau has the Jacobian.",
        "  Between its steps the twist is by its dense output, which is in error and time.",
        "- openTorsion propagates by the matrix exponential with torques held over a step. It has no gaps.",
        "",
    ]
    for name, build in CASES.items():
        text += [f"## {build.title[0].upper()}{build.title[1:]}", ""]
        text += ["| solver | tolerance | error | time (ms) |", "|---|---|---|---|"]
        for case, solver, setting, error, seconds in rows:
            if case == name:
                text.append(f"| {solver} | {setting} | {error:.1e} | {1e3 * seconds:.3g} |")
        text.append("")
    return "\n".join(text)


def plot(rows, path):
    """Error against time, a picture a case."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, len(CASES), figsize=(4 * len(CASES), 4), sharey=True)
    for axis, (name, build) in zip(axes, CASES.items()):
        axis.set(title=build.title.replace(", ", ",\n", 1), xscale="log", yscale="log", xlabel="time, s")
        for solver in dict.fromkeys(row[1] for row in rows):
            points = [(row[4], max(row[3], 1e-16)) for row in rows if row[:2] == (name, solver)]
            if points:
                axis.plot(*zip(*points), "o-", label=solver)
    axes[0].set_ylabel("error")
    axes[0].legend()
    figure.tight_layout()
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--markdown", metavar="FILE", help="write the tables here, not to the terminal")
    parser.add_argument("--plot", metavar="FILE", help="draw error against time, by matplotlib")
    arguments = parser.parse_args()
    rows = measured()
    text = markdown(rows)
    if arguments.markdown:
        pathlib.Path(arguments.markdown).write_text(text)
    else:
        print(text)
    if arguments.plot:
        plot(rows, arguments.plot)


if __name__ == "__main__":
    main()
