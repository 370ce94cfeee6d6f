"""Runs in OpenSees that must succeed: one bearing along a path, a mass or a building shaken.

What stands between the nodes is put there by the caller, so that elements of OpenSees and others
are driven alike.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from lir_element.units import STANDARD_GRAVITY
from validation.opensees.model import (
    ABOVE,
    BELOW,
    ELEMENT,
    TOLERANCE,
    advance,
    gravity_analysis,
    ground_motion,
    lead,
    solver,
    stand,
    static_steps,
    transient_steps,
    weigh_down,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames import GroundMotion
    from frames._types import FloatArray

Place: TypeAlias = Callable[[int, int, int], object]
"""Puts an element with a tag between node i and node j of the model at hand."""


@dataclass(frozen=True)
class Track:
    """What a run did."""

    time: FloatArray
    """(n,): Times [s]."""
    displacement: FloatArray
    """(n, nodes, 6): Of the nodes asked for, relative to the ground [m, rad]; of one bearing (n, 3)."""
    force: FloatArray
    """(n, elements, 3): Which the elements asked for need on the node above, as `bearing_force` of a Dataset of `frames` [N]; of one bearing (n, 3)."""
    seconds: float
    """Time of computation [s]."""
    loose: int
    """Steps with the larger tolerance, see `opensees_model.advance`."""


def cycle(place: Place, height: float, load: float, path: FloatArray) -> Track:
    """Take the node above along a path in x under a held vertical load, statically.

    Shapes: path (n,).
    """
    with stand(height, held=(0, 1)) as ops:
        place(ELEMENT, BELOW, ABOVE)
        weigh_down(ops, load)
        gravity_analysis(ops)
        lead(ops, ABOVE, 1, path)
        solver(ops)
        static_steps(ops, 1.0)
        return _of_one(_record(ops, len(path) - 1, None, (ABOVE,), (ELEMENT,)))


def lumped(
    place: Place,
    height: float,
    mass: float,
    motion: GroundMotion,
    dt: float,
    duration: float | None = None,
) -> Track:
    """Run a mass on one element under a ground motion."""
    with stand(height, mass) as ops:
        place(ELEMENT, BELOW, ABOVE)
        weigh_down(ops, mass * STANDARD_GRAVITY)
        gravity_analysis(ops)
        return _of_one(respond(ops, motion, dt, (ABOVE,), (ELEMENT,), duration=duration))


def respond(
    ops: Any,
    motion: GroundMotion,
    dt: float,
    nodes: Sequence[int],
    elements: Sequence[int] = (),
    *,
    duration: float | None = None,
    tolerance: float = TOLERANCE,
    system: str = "UmfPack",
    length_unit: float = 1.0,
) -> Track:
    """Run the model at hand under a ground motion, by Newmark's average acceleration."""
    ground_motion(ops, motion, length_unit)
    solver(ops, tolerance, system=system)
    transient_steps(ops)
    steps = round((motion.duration if duration is None else duration) / dt)
    return _record(ops, steps, dt, nodes, elements, tolerance)


def _record(
    ops: Any,
    steps: int,
    dt: float | None,
    nodes: Sequence[int],
    elements: Sequence[int],
    tolerance: float = TOLERANCE,
) -> Track:
    time = np.zeros(steps + 1)
    moved, force = np.zeros((steps + 1, len(nodes), 6)), np.zeros((steps + 1, len(elements), 3))
    began, loose = perf_counter(), 0
    for k in range(steps + 1):
        if k:
            loose += advance(ops, 1, dt, tolerance)
        time[k] = ops.getTime()
        for place, node in enumerate(nodes):
            moved[k, place] = ops.nodeDisp(node)
        for place, element in enumerate(elements):
            force[k, place] = ops.eleResponse(element, "force")[6:9]
    return Track(time, moved, force, perf_counter() - began, loose)


def _of_one(track: Track) -> Track:
    return replace(track, displacement=track.displacement[:, 0, :3], force=track.force[:, 0])
