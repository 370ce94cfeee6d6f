"""What models of OpenSees share here: an empty one, a stand for one bearing, loads, analyses.

A model that a context manager hands out is emptied after its use, for OpenSees has one a process.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from lir_element.opensees import opensees

if TYPE_CHECKING:
    from collections.abc import Generator

    from frames import GroundMotion
    from frames._types import FloatArray

AXES = (1, 2, 3)
BELOW, ABOVE, ELEMENT = 1, 2, 1
"""Tags on a stand: of the nodes under and over the bearing, and of an element between them."""
TOLERANCE = 1e-8
"""Of the norm of a correction [m and rad]."""
_ITERATIONS = 60
_GRAVITY_STEPS = 10
_WEIGHT, _PATH, _GROUND = 1, 10, 100  # tags of patterns and their series; the last two plus an axis


@contextmanager
def empty_model(ops: Any = None) -> Generator[Any, None, None]:
    """Hand out OpenSees, or `ops`, with an empty model of 6 degrees of freedom a node; then empty it."""
    ops = opensees() if ops is None else ops
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    try:
        yield ops
    finally:
        ops.wipe()


@contextmanager
def stand(
    height: float, mass: float = 0.0, held: tuple[int, int] = (0, 0)
) -> Generator[Any, None, None]:
    """Hand out OpenSees with a fixed node and one above it that stays level; empty it after use."""
    with empty_model() as ops:
        ops.node(BELOW, 0.0, 0.0, 0.0)
        ops.node(ABOVE, 0.0, 0.0, height)
        ops.fix(BELOW, 1, 1, 1, 1, 1, 1)
        ops.fix(ABOVE, *held, 0, 1, 1, 1)
        if mass > 0.0:
            ops.mass(ABOVE, mass, mass, mass, 0.0, 0.0, 0.0)
        yield ops


def permanent_loads(ops: Any) -> None:
    """Open the pattern of permanent loads: what `ops.load` adds next belongs to it."""
    ops.timeSeries("Linear", _WEIGHT)
    ops.pattern("Plain", _WEIGHT, _WEIGHT)


def weigh_down(ops: Any, load: float) -> None:
    """Load a stand with a weight [N]; an analysis has still to bring it up."""
    permanent_loads(ops)
    ops.load(ABOVE, 0.0, 0.0, -load, 0.0, 0.0, 0.0)


def lead(ops: Any, node: int, axis: int, path: FloatArray) -> None:
    """Prescribe displacements of a node, one a unit of time; to be called after gravity.

    What holds the loads would hold the path at its first value.
    """
    tag = _PATH + axis
    ops.timeSeries("Path", tag, "-dt", 1.0, "-values", *path.tolist(), "-useLast")
    ops.pattern("Plain", tag, tag)
    ops.sp(node, axis, 1.0)


def ground_motion(ops: Any, motion: GroundMotion, length_unit: float = 1.0) -> None:
    """Add a ground motion, linear between its samples, to a model whose unit of length is given."""
    for axis, values in zip(AXES, motion.components.T, strict=True):
        if not values.any():
            continue
        tag = _GROUND + axis
        ops.timeSeries("Path", tag, "-dt", motion.dt, "-values", *(values / length_unit).tolist())
        ops.pattern("UniformExcitation", tag, axis, "-accel", tag)


def solver(
    ops: Any,
    tolerance: float = TOLERANCE,
    *,
    test: str = "NormDispIncr",
    iterations: int = _ITERATIONS,
    system: str = "UmfPack",
) -> None:
    """Drop the analysis and set constraints, equations and Newton's method for the next one."""
    ops.wipeAnalysis()
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system(system)
    ops.test(test, tolerance, iterations)
    ops.algorithm("Newton")


def static_steps(ops: Any, step: float) -> None:
    """Make the analysis static, its time `step` a step."""
    ops.integrator("LoadControl", step)
    ops.analysis("Static")


def transient_steps(ops: Any) -> None:
    """Make the analysis transient, by Newmark's average acceleration."""
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")


def gravity_analysis(ops: Any) -> None:
    """Bring the loads of the model up, hold them and set the time back to zero."""
    solver(ops)
    static_steps(ops, 1.0 / _GRAVITY_STEPS)
    advance(ops, _GRAVITY_STEPS)
    ops.loadConst("-time", 0.0)
    ops.wipeAnalysis()


def settle(ops: Any) -> None:
    """Find equilibrium under the present loads, where the model has changed."""
    solver(ops)
    static_steps(ops, 0.0)
    advance(ops, 1)


def advance(ops: Any, steps: int, dt: float | None = None, tolerance: float = TOLERANCE) -> int:
    """Advance the analysis; return how many steps needed a tolerance a hundred times as large.

    A friction that follows the velocity of the iteration before may never settle to less.
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
