"""Motions: files, turns to the fault, spectra by an own solver, factors of scaling."""

import csv
import math

import codes
import numpy as np
from reading import GRAVITY

UNIT = {"g": GRAVITY, "m/s2": 1.0, "cm/s2": 0.01}
RULES = {  # measure of a pair, part of the target, part at the period 0, range of periods
    "ASCE 7-22": ("RotD100", 1.0, 0.0, 0.75, 1.25),
    "EN 1998": ("mean", 0.9, 1.0, 0.2, 2.0),
    "NCh2745": ("SRSS", 1.17, 0.0, 0.5, 1.25),
}
POINTS = 60


class Motion:
    """One motion as its file has it, turned where the project asks."""

    def __init__(self, folder, row, turn):
        self.name, self.dt = row["name"], float(row["dt"])
        unit = UNIT[row["unit"]]
        self.axes = {axis: unit * np.loadtxt(folder / row[axis]) for axis in "xyz" if row.get(axis)}
        self.near = row.get("near_fault") == "yes"
        self.azimuths = [float(row[key]) for key in ("azimuth_x", "azimuth_y") if row.get(key)]
        self.strike = float(row["strike"]) if row.get("strike") else None
        if turn and self.strike is not None:
            self._to_fault()

    def _to_fault(self):
        # Components of the vector in plan along two azimuths, clockwise from north.
        x, y = self.axes["x"], self.axes["y"]
        ax, ay = map(math.radians, self.azimuths)
        east = x * math.sin(ax) + y * math.sin(ay)
        north = x * math.cos(ax) + y * math.cos(ay)
        along = math.radians(self.strike)
        normal = along + 0.5 * math.pi
        self.axes["x"] = east * math.sin(normal) + north * math.cos(normal)
        self.axes["y"] = east * math.sin(along) + north * math.cos(along)
        self.azimuths = [(self.strike + 90.0) % 360.0, self.strike % 360.0]


def read(project):
    """Return the project's motions in the order of the table, or of `only`."""
    given = project.file["motions"]
    folder = project.folder / given["folder"]
    with (folder / "motions.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["name"]: row for row in csv.DictReader(file)}
    chosen = given.get("only", list(rows))
    return [Motion(folder, rows[name], given.get("fault_normal", False)) for name in chosen]


def oscillator(values, dt, period, damping=0.05):
    """Return the displacement of an oscillator under an acceleration linear between samples.

    By the matrix exponential of (u, v, a, slope), at 80 points of the period or more, and on for a
    period after the motion.
    """
    omega = 2.0 * math.pi / period
    parts = max(1, math.ceil(80.0 * dt / period))
    h = dt / parts
    tail = math.ceil(period / dt) + 1
    a = np.concatenate([values, np.zeros(tail)])
    fine = np.interp(np.arange((len(a) - 1) * parts + 1) / parts, np.arange(len(a)), a)
    wd, z = omega * math.sqrt(1.0 - damping**2), damping * omega
    e, s, c = math.exp(-z * h), math.sin(wd * h), math.cos(wd * h)
    a11, a12 = e * (c + z / wd * s), e * s / wd
    a21, a22 = -(omega**2) * e * s / wd, e * (c - z / wd * s)
    # a(t) = a0 + r t is answered by u = -(a0 + r t) / w2 + 2 z r / w4, v = -r / w2
    w2, slope = omega**2, np.diff(fine) / h
    start = -fine[:-1] / w2 + 2.0 * z * slope / w2**2
    end = start - slope * h / w2
    first = -(a11 * start - a12 * slope / w2) + end
    second = -(a21 * start - a22 * slope / w2) - slope / w2
    u, v, found = 0.0, 0.0, np.empty(len(first))
    for k, (p, q) in enumerate(zip(first.tolist(), second.tolist(), strict=True)):
        u, v = a11 * u + a12 * v + p, a21 * u + a22 * v + q
        found[k] = u
    return found


def ordinate(motion, period, measure):
    """Return the pseudo-acceleration of a pair at a period."""
    pair = [motion.axes["x"], motion.axes["y"]]
    if period > 0.0:
        pair = [(2.0 * math.pi / period) ** 2 * oscillator(a, motion.dt, period) for a in pair]
    x, y = pair
    if measure == "RotD100":
        return np.hypot(x, y).max()
    if measure == "SRSS":
        return math.hypot(np.abs(x).max(), np.abs(y).max())
    return 0.5 * (np.abs(x).max() + np.abs(y).max())


class Set:
    """The motions with their spectra, target and factors."""

    def __init__(self, project):
        self.measure, self.part, self.zero, low, high = RULES[project.code]
        self.motions, given = read(project), project.file["motions"]
        shortest = min(each.get("T_D", each["period"]) for each in project.linear.values())
        longest = max(each["period"] for each in project.linear.values())
        self.grid = np.geomspace(low * shortest, high * longest, POINTS)
        spectrum = project.file["spectrum"]
        target = [codes.spectrum(project.code, spectrum, t) for t in (*self.grid, 0.0)]
        self.target, self.at_zero = np.array(target[:-1]), target[-1]
        raw = [[ordinate(m, t, self.measure) for t in self.grid] for m in self.motions]
        self.raw = np.array(raw)
        self.still = np.array([ordinate(m, 0.0, self.measure) for m in self.motions])
        if given.get("scale", "spectrum") == "spectrum":
            self.factors = np.exp(np.log(self.target / self.raw).mean(axis=1))
            mean = (self.factors[:, None] * self.raw).mean(axis=0)
            needed = (self.part * self.target / mean).max()
            if self.zero:
                needed = max(
                    needed, self.zero * self.at_zero / (self.factors @ self.still) * len(self.still)
                )
            self.factors = self.factors * needed
        else:
            self.factors = np.full(len(self.motions), float(given["scale"]))
        self.used = self.factors.copy()
        self.mean = (self.factors[:, None] * self.raw).mean(axis=0)


def compare(project, tally):
    """Hold the factors that the runs had, by their ground accelerations, against the rule's."""
    name, used = "factors of scaling", "ground motion of runs"
    tally.category(name, 4e-3, "a peak between samples: 40 points of a period miss 0.3 %")
    tally.category(used, 1e-6, "histories are kept in single precision")
    project.motions = found = Set(project)
    for level, each in project.runs.items():
        more = codes.M_M if level == "maximum" else 1.0
        for bound, data in each.items():
            for k, motion in enumerate(found.motions):
                tally.words(used, f"{level} {bound} name", data["motion"][k], motion.name)
                time = data["time"] if data["time"].ndim == 1 else data["time"][k]
                ground = data["ground_acceleration"][k]
                known = np.isfinite(ground[:, 0])
                own = np.zeros((known.sum(), 3))
                for a, axis in enumerate("xyz"):
                    if axis in motion.axes:
                        values = motion.axes[axis]
                        at = np.arange(len(values)) * motion.dt
                        own[:, a] = np.interp(time[known], at, values, right=0.0)
                peak = np.unravel_index(np.abs(own).argmax(), own.shape)
                factor = ground[known][peak] / own[peak]
                tally.same(name, f"{level} {bound} {motion.name}", factor, more * found.factors[k])
                found.used[k] = factor / more
                off = np.abs(ground[known] - factor * own).max() / np.abs(ground[known]).max()
                tally.same(used, f"{level} {bound} {motion.name} samples", 1.0, 1.0 + off)


def pairs(f):
    """Return the number of pairs and the least of it."""
    least = {"ASCE 7-22": 7, "EN 1998": 3, "NCh2745": 3}[f.code]
    return sum("x" in m.axes and "y" in m.axes for m in f.p.motions.motions), least


def mean(f):
    """Return the mean spectrum where it is the least part of the target, and that part."""
    s = f.p.motions
    k = int((s.mean / s.target).argmin())
    return s.mean[k], s.part * s.target[k]


def mean_at_zero(f):
    """Return the same at the period zero."""
    s = f.p.motions
    return s.factors @ s.still / len(s.still), s.zero * s.at_zero


def turned(f):
    """Return how many near-fault pairs are not turned to the fault's axes."""
    odd = 0
    for m in f.p.motions.motions:
        off = [abs((a - m.strike + 45.0) % 90.0 - 45.0) for a in m.azimuths] if m.near else [0.0]
        odd += max(off) > 1.0
    return odd, 0.0
