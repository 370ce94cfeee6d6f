"""Runs in OpenSees that the claims share: build the model, gravity, path or ground motion, arrays.

What stands between the nodes is put there by the caller, so that elements of OpenSees and others
are driven alike. Each run begins and ends with an empty model.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from lir_element.bearing import STANDARD_GRAVITY
from lir_element.opensees import opensees

if TYPE_CHECKING:
    from frames import GroundMotion
    from frames._types import FloatArray

Place: TypeAlias = Callable[[int, int, int], object]
"""Puts an element with a tag between node i and node j of the model at hand."""

AXES = (1, 2, 3)
BELOW, ABOVE, ELEMENT = 1, 2, 1
_STEPS = 10  # of gravity
_TOLERANCE = 1e-8  # m and rad, of the norm of a correction
_ITERATIONS = 60


@dataclass(frozen=True)
class Track:
    """What an element did: times (n,), displacement and force of the node above (n, 3), cost.

    The force is that which the element needs, as `bearing_force` of a Dataset of `frames`.
    """

    time: FloatArray
    displacement: FloatArray
    force: FloatArray
    seconds: float
    loose: int


@contextmanager
def model() -> Generator[Any, None, None]:
    """Hand out OpenSees with an empty model of 6 degrees of freedom a node; empty it after use."""
    ops = opensees()
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    try:
        yield ops
    finally:
        ops.wipe()


def gravity_analysis(ops: Any) -> None:
    """Bring the loads of the model up, hold them and set the time back to zero."""
    solver(ops)
    ops.integrator("LoadControl", 1.0 / _STEPS)
    ops.analysis("Static")
    advance(ops, _STEPS)
    ops.loadConst("-time", 0.0)
    ops.wipeAnalysis()


def solver(ops: Any, tolerance: float = _TOLERANCE) -> None:
    """Set constraints, equations and Newton's method; the tangents are unsymmetric."""
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.test("NormDispIncr", tolerance, _ITERATIONS)
    ops.algorithm("Newton")


def advance(ops: Any, steps: int, dt: float | None = None, tolerance: float = _TOLERANCE) -> int:
    """Advance the analysis; return how many steps needed a tolerance a hundred times as large.

    A friction that follows the velocity of the iteration before may never settle to less.

    Parameters
    ----------
    ops : module
        OpenSees.
    steps : int
        Number of steps.
    dt : float, optional
        Step of a transient analysis [s].
    tolerance : float
        Norm of the last correction [m, rad].

    Returns
    -------
    int
        Steps that were accepted with the larger tolerance.

    Raises
    ------
    RuntimeError
        If OpenSees finds no equilibrium.
    """
    arguments, loose = () if dt is None else (dt,), 0
    attempts = (("Newton", 1.0), ("KrylovNewton", 1.0), ("Newton", 100.0), ("KrylovNewton", 100.0))
    for k in range(steps):
        for number, (name, factor) in enumerate(attempts):
            if number:
                ops.algorithm(name)
                ops.test("NormDispIncr", factor * tolerance, _ITERATIONS)
            failed = ops.analyze(1, *arguments) != 0
            if not failed:
                break
        if failed:
            msg = (
                f"OpenSees found no equilibrium after {ops.getTime():g} s, step {k + 1} of {steps}"
            )
            raise RuntimeError(msg)
        if number:
            loose += factor > 1.0
            ops.algorithm("Newton")
            ops.test("NormDispIncr", tolerance, _ITERATIONS)
    return loose


def _one(ops: Any, place: Place, height: float, mass: float, held: tuple[int, ...]) -> None:
    ops.node(BELOW, 0.0, 0.0, 0.0)
    ops.node(ABOVE, 0.0, 0.0, height)
    ops.fix(BELOW, 1, 1, 1, 1, 1, 1)
    ops.fix(ABOVE, *held, 0, 1, 1, 1)
    if mass > 0.0:
        ops.mass(ABOVE, mass, mass, mass, 0.0, 0.0, 0.0)
    place(ELEMENT, BELOW, ABOVE)


def _weight(ops: Any, load: float) -> None:
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(ABOVE, 0.0, 0.0, -load, 0.0, 0.0, 0.0)
    gravity_analysis(ops)


def _collect(ops: Any, steps: int, dt: float | None) -> Track:
    time, moved, force = np.zeros(steps + 1), np.zeros((steps + 1, 3)), np.zeros((steps + 1, 3))
    began, loose = perf_counter(), 0
    for k in range(steps + 1):
        if k:
            loose += advance(ops, 1, dt)
        time[k] = ops.getTime()
        moved[k] = [ops.nodeDisp(ABOVE, axis) for axis in AXES]
        force[k] = ops.eleResponse(ELEMENT, "force")[6:9]
    return Track(time, moved, force, perf_counter() - began, loose)


def cycle(place: Place, height: float, load: float, path: FloatArray) -> Track:
    """Take the node above along a path in x under a held vertical load, statically.

    Parameters
    ----------
    place : callable
        Puts the element.
    height : float
        Distance of the nodes [m].
    load : float
        Vertical load, downwards [N].
    path : ndarray, (n,)
        Displacements [m], the first one zero.

    Returns
    -------
    Track
        At each point of the path.
    """
    with model() as ops:
        _one(ops, place, height, 0.0, (0, 1))
        _weight(ops, load)
        ops.timeSeries("Path", 2, "-dt", 1.0, "-values", *path.tolist(), path[-1])
        ops.pattern("Plain", 2, 2)  # after gravity, which would hold it at its first value
        ops.sp(ABOVE, 1, 1.0)
        solver(ops)
        ops.integrator("LoadControl", 1.0)
        ops.analysis("Static")
        return _collect(ops, len(path) - 1, None)


def lumped(
    place: Place,
    height: float,
    mass: float,
    motion: GroundMotion,
    dt: float,
    duration: float | None = None,
) -> Track:
    """Run a mass on one element under a ground motion, Newmark's average acceleration.

    Parameters
    ----------
    place : callable
        Puts the element.
    height : float
        Distance of the nodes [m].
    mass : float
        Mass above [kg].
    motion : GroundMotion
        Acceleration of the ground; linear between its samples.
    dt : float
        Step [s].
    duration : float, optional
        Length of the analysis [s]; that of the motion if None.

    Returns
    -------
    Track
        At each step.
    """
    with model() as ops:
        _one(ops, place, height, mass, (0, 0))
        _weight(ops, mass * STANDARD_GRAVITY)
        shake(ops, motion)
        length = motion.duration if duration is None else duration
        return _collect(ops, round(length / dt), dt)


def shake(ops: Any, motion: GroundMotion) -> None:
    """Add a ground motion to the model and prepare the transient analysis."""
    for axis, values in zip(AXES, motion.components.T, strict=True):
        if not values.any():
            continue
        tag = 100 + axis
        ops.timeSeries("Path", tag, "-dt", motion.dt, "-values", *values.tolist())
        ops.pattern("UniformExcitation", tag, axis, "-accel", tag)
    solver(ops)
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
