"""Trials of a device in OpenSees that may fail: under a mass that is shaken, or in a rig.

A device is one of `opensees_devices`. What comes back is how far a trial got, how it ended and what
it cost; `opensees_runs` is for runs that must succeed.
"""

from __future__ import annotations

import math
import os
import time
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from lir_element.opensees import builtin_commands, builtin_element, macro_model, opensees
from lir_element.units import STANDARD_GRAVITY
from validation.opensees.model import (
    ABOVE,
    AXES,
    BELOW,
    ELEMENT,
    ground_motion,
    lead,
    solver,
    stand,
    static_steps,
    transient_steps,
    weigh_down,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from frames import GroundMotion
    from lir_element import LIRBearing
    from lir_element.layout import Floats
    from lir_element.opensees.compare.builtin_writing import BuiltinKind

_TFP_DISHES = slice(10, 12)
"""Places of the diameters of the two outer dishes in the command of a TFP."""


@dataclass(frozen=True)
class Device:
    """Elements between two nodes: all of them, those on node j, and node m if there is one."""

    above: tuple[int, ...]
    middle: int | None = None


def plain(kind: BuiltinKind, bearing: LIRBearing, weight: float) -> Device:
    """Make an element of OpenSees from a plain bearing that it can represent."""
    builtin_element(kind, ELEMENT, BELOW, ABOVE, bearing, weight)
    return Device((ELEMENT,))


def tfp(bearing: LIRBearing, weight: float) -> Device:
    """Make a TFP with rims."""
    # builtin_element refuses rims for this element because they end in NaN. The hard cases are
    # there to show that: its command is taken without rims, and given dishes that end at them.
    (command,) = builtin_commands("TFP", ELEMENT, BELOW, ABOVE, bearing.as_dcfp(rims=False), weight)
    arguments = list(command[1:])
    # the element measures sliding at the pivot, R - h/2 from the centre of a dish
    half = 0.5 * bearing.slider_height
    surfaces = zip(bearing.radii, bearing.rim_displacement, strict=True)
    arguments[_TFP_DISHES] = [2.0 * reach * (r - half) / r for r, reach in surfaces]
    opensees().element(*arguments)
    return Device((ELEMENT,))


def macro(bearing: LIRBearing, weight: float, **options: Any) -> Device:
    """Make the macro-model: rims and interface."""
    tags = macro_model(bearing, BELOW, ABOVE, load=weight, **options)
    last = tags.pendulum if tags.interface is None else tags.interface
    above: tuple[int, ...] = (last,) if tags.restoring is None else (last, tags.restoring)
    if tags.node is None:
        above += tags.rims
    return Device(above, tags.node)


Maker: TypeAlias = "Callable[[LIRBearing, float], Device]"
"""Makes a device between `BELOW` and `ABOVE` from a bearing and the weight on it [N]."""

DEVICES: dict[str, Maker] = {
    "singleFPBearing": partial(plain, "singleFPBearing"),
    "FPBearingPTV": partial(plain, "FPBearingPTV"),
    "TripleFrictionPendulum": partial(plain, "TripleFrictionPendulum"),
    "TFP": tfp,
    "macro-model": macro,
}


RIG = 99
"""Tag of the node that pulls, and of what joins it."""

Steps: TypeAlias = tuple[tuple[str, ...], ...]
Analyse: TypeAlias = "Callable[[float], int]"
PLAIN: Steps = (("Newton",),)
ROBUST: Steps = (("Newton",), ("KrylovNewton",), ("ModifiedNewton", "-initial"))
HALVINGS = {PLAIN: 0, ROBUST: 6}
"""How often a step is halved after all algorithms have failed."""

TOLERANCE = 1e-7
"""Of the unbalanced force, over the weight."""
ITERATIONS = 25
CODES = {-1: "domain", -2: "integrator", -3: "algorithm", -4: "commit"}
"""What `analyze` returns where it stops."""
_RIG_STIFFNESS = 1e9  # N/m


@dataclass
class Shaken:
    """What a run hands back; (n,) times, (n, 3) vectors over time."""

    time: Floats
    displacement: Floats
    force: Floats
    """Of the bearing on node j, as `bearing_force` of the package [N]."""
    moment: Floats
    """On node i and on node j (n, 2, 3) [N m]."""
    middle: Floats
    """Displacement of node m [m], zero without one."""
    velocity: Floats
    status: str = "ok"
    seconds: float = math.nan
    """Of the analysis alone."""
    steps: int = 0
    iterations: int = 0


def load_down(weight: float) -> int:
    """Put the weight on a stand and hold it; return the code of `analyze`."""
    ops = opensees()
    weigh_down(ops, weight)
    _solver(weight)
    static_steps(ops, 0.1)
    code = int(ops.analyze(10))
    ops.loadConst("-time", 0.0)
    return code


def _solver(weight: float) -> None:
    solver(
        opensees(),
        TOLERANCE * weight,
        test="NormUnbalance",
        iterations=ITERATIONS,
        system="BandGeneral",
    )


@contextmanager
def _quiet_stand(height: float, mass: float) -> Generator[Any, None, None]:
    with stand(height, mass) as ops:
        ops.logFile(os.devnull, "-noEcho")  # thousands of lines where steps are tried again
        yield ops


def pull(make: Maker, bearing: LIRBearing, load: float, path: Floats) -> Shaken:
    """Take a device slowly along a path by stiff springs, as a rig does.

    Shapes: path (n,).
    """
    way = path if path.ndim == 2 else np.column_stack([path, np.zeros_like(path)])
    with _rig(make, bearing, load) as (ops, made):
        for axis, values in zip(AXES, way.T, strict=False):
            lead(ops, RIG, axis, values)

        def analyse(share: float) -> int:
            ops.integrator("LoadControl", share)
            return int(ops.analyze(1))

        return _March(made, ROBUST, analyse, halves=False).go(len(way) - 1, 1.0)


@contextmanager
def _rig(
    make: Maker, bearing: LIRBearing, load: float
) -> Generator[tuple[Any, Device], None, None]:
    """Hand out OpenSees and a device under load, with springs to the node that pulls."""
    with _quiet_stand(bearing.height, 0.0) as ops:
        made = make(bearing, load)
        ops.node(RIG, 0.0, 0.0, bearing.height)
        ops.fix(RIG, 0, 0, 1, 1, 1, 1)
        ops.uniaxialMaterial("Elastic", RIG, _RIG_STIFFNESS)
        ops.element("zeroLength", RIG, RIG, ABOVE, "-mat", RIG, RIG, "-dir", 1, 2)
        load_down(load)
        yield ops, made


def take_back(make: Maker, bearing: LIRBearing, load: float) -> float:
    """Return the lateral force over friction that a failed step leaves, once it is taken back."""
    with _rig(make, bearing, load) as (ops, made):
        lead(ops, RIG, 1, np.array([0.0, 1.0]))  # the time is the displacement
        ops.integrator("LoadControl", 2e-3)  # m
        ops.test("NormUnbalance", 1e-12 * load, 1)
        if ops.analyze(1) == 0:
            return math.nan
        ops.test("NormUnbalance", TOLERANCE * load, ITERATIONS)
        ops.integrator("LoadControl", 1e-9)
        ops.analyze(3)
        return _row(made)[7] / (bearing.effective_friction * load)


def shake(
    make: Maker,
    bearing: LIRBearing,
    mass: float,
    motion: GroundMotion,
    *,
    duration: float,
    dt: float,
    algorithms: Steps = PLAIN,
) -> Shaken:
    """Run a mass on a device under a ground motion."""
    weight = mass * STANDARD_GRAVITY
    with _quiet_stand(bearing.height, mass) as ops:
        made = make(bearing, weight)
        code = load_down(weight)
        if code != 0:
            empty, status = np.zeros((1, 3)), f"gravity: {CODES.get(code, code)}"
            both = np.zeros((1, 2, 3))
            return Shaken(np.zeros(1), empty, empty, both, empty, empty, status)
        ground_motion(ops, motion)
        _solver(weight)
        transient_steps(ops)

        def analyse(length: float) -> int:
            return int(ops.analyze(1, length))

        return _March(made, algorithms, analyse, halves=True).go(round(duration / dt), dt)


class _March:
    """Advances step by step, in halves where all algorithms fail, and keeps what happens."""

    def __init__(self, made: Device, algorithms: Steps, analyse: Analyse, *, halves: bool) -> None:
        self.made, self.algorithms, self.analyse, self.halves = made, algorithms, analyse, halves
        self.rows = [_row(made)]
        self.seconds, self.steps, self.iterations = 0.0, 0, 0

    def go(self, count: int, dt: float) -> Shaken:
        """Take `count` steps of `dt`, or as many as succeed."""
        status = "ok"
        for _ in range(count):
            code = self.advance(dt, HALVINGS[self.algorithms])
            if code != 0:
                status = CODES.get(code, str(code))
                break
            if not self.halves:
                self.rows.append(_row(self.made))
            if not np.isfinite(self.rows[-1]).all():
                status = "not finite"
                break
        table = np.asarray(self.rows)
        spent = (self.seconds, self.steps, self.iterations)
        moments = table[:, 10:16].reshape(-1, 2, 3)
        middle, speed = table[:, 16:19], table[:, 4:7]
        motion = (table[:, 0], table[:, 1:4], table[:, 7:10], moments, middle, speed)
        return Shaken(*motion, status, *spent)

    def advance(self, dt: float, halvings: int) -> int:
        """Take a step, whole or in halves; return the code of `analyze`."""
        code = self.attempt(dt)
        if code == 0:
            self.steps += 1
            if self.halves:
                self.rows.append(_row(self.made))
            return 0
        if halvings == 0:
            return code
        return self.advance(0.5 * dt, halvings - 1) or self.advance(0.5 * dt, halvings - 1)

    def attempt(self, dt: float) -> int:
        """Try the algorithms one after the other."""
        ops, code = opensees(), 0
        for algorithm in self.algorithms:
            if len(self.algorithms) > 1:
                ops.algorithm(*algorithm)
            began = time.perf_counter()
            code = self.analyse(dt)
            self.seconds += time.perf_counter() - began
            self.iterations += int(ops.testIter())
            if code == 0:
                break
        return code


def _row(made: Device) -> list[float]:
    ops = opensees()
    force = np.zeros(6)
    for tag in made.above:
        force += np.asarray(ops.eleForce(tag))[6:12]
    ops.reactions()
    middle = ops.nodeDisp(made.middle)[:3] if made.middle is not None else [0.0] * 3
    ground = np.asarray(ops.nodeReaction(BELOW))[3:6]
    if made.middle is not None:  # it turns with node i
        ground = ground + np.asarray(ops.nodeReaction(made.middle))[3:6]
    return [
        ops.getTime(),
        *ops.nodeDisp(ABOVE)[:3],
        *ops.nodeVel(ABOVE)[:3],
        *force[:3],
        *ground,
        *force[3:6],
        *middle,
    ]
