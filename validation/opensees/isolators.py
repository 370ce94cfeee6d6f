"""A building in OpenSees whose supports give way to isolators, and the damping it is given."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from frames import GroundMotion
from lir_element.opensees import bearing_element, builtin_element
from validation.opensees.model import settle

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray
    from lir_element import LIRBearing
    from validation.opensees.frames import Built

_GROUND = 1000
"""Tags of isolators, and of the nodes below them, less those of the nodes above."""


class Isolator(Protocol):
    """Puts an isolator between two coincident nodes of the OpenSees model."""

    def __call__(
        self, ops: Any, /, tag: int, ground: int, base: int, bearing: LIRBearing, load: float
    ) -> None:
        """Add the element `tag`; the bearing carries `load` [N] at rest."""
        ...


def spring(ops: Any, tag: int, ground: int, base: int, bearing: LIRBearing, load: float) -> None:
    """Put the pendulum under constant load as a linear spring, over a vertical one."""
    own = bearing.resolved()
    length = bearing.effective_radius + load / own["axial_stiffness"]  # of the stretched string
    ops.uniaxialMaterial("Elastic", 10 * tag, load / length)
    ops.uniaxialMaterial("Elastic", 10 * tag + 1, own["axial_stiffness"], own["axial_damping"])
    materials = (10 * tag, 10 * tag, 10 * tag + 1)
    ops.element("zeroLength", tag, ground, base, "-mat", *materials, "-dir", 1, 2, 3)


def single_pendulum(
    _: Any, tag: int, ground: int, base: int, bearing: LIRBearing, load: float
) -> None:
    """Put OpenSees' singleFPBearing, mapped as the package maps it."""
    builtin_element("singleFPBearing", tag, ground, base, bearing, load)


def own_bearing(_: Any, tag: int, ground: int, base: int, bearing: LIRBearing, load: float) -> None:
    """Put the bearing itself, whatever load it carries."""
    del load
    bearing_element(tag, ground, base, bearing)


def add_ground(ops: Any, bases: Sequence[int]) -> None:
    """Put a fixed node under each base, for its isolator.

    Modal damping has no shapes for nodes that come after it: this must come before.
    """
    for tag in bases:
        ops.node(_GROUND + tag, *ops.nodeCoord(tag))
        ops.fix(_GROUND + tag, 1, 1, 1, 1, 1, 1)


def put_on_isolators(
    ops: Any,
    bases: Sequence[int],
    bearing: LIRBearing,
    loads: FloatArray,
    isolator: Isolator,
    *,
    diaphragm: bool = True,
) -> None:
    """Put isolators under a building that stands on supports, and find its equilibrium.

    Shapes: loads (bases,).
    """
    for tag, load in zip(bases, loads, strict=True):
        ground = _GROUND + tag
        for dof in (1, 2, 3):
            ops.remove("sp", tag, dof)
        isolator(ops, ground, ground, tag, bearing, float(load))
    if diaphragm:
        ops.rigidDiaphragm(3, *bases)
    settle(ops)


def damp(ops: Any, built: Built, kind: str) -> None:
    """Give a building Rayleigh damping."""
    if kind == "mass and initial stiffness":
        ops.rayleigh(0.2, 0.0, 0.002, 0.0)
    elif kind == "present stiffness":
        ops.rayleigh(0.0, 0.005, 0.0, 0.0)
    elif kind == "by regions":
        for region, (word, beta) in enumerate((("column", 0.02), ("beam", 0.001)), start=1):
            members = [tag for name, tag in built.members.items() if name.startswith(word)]
            ops.region(region, "-ele", *members, "-rayleigh", 0.0, 0.0, beta, 0.0)


def waves(scale: float, duration: float, dt: float = 0.01) -> GroundMotion:
    """Make a motion in three directions that starts and ends softly; peaks of 1.8 m/s2 scaled."""
    t = np.arange(0.0, duration, dt)
    envelope = np.minimum(t, 1.0) * np.minimum((duration - t) / 1.5, 1.0)
    parts = ((1.8, 1.5), (1.4, 1.9), (0.8, 0.3))
    x, y, z = (scale * peak * envelope * np.sin(2.0 * np.pi * t / period) for peak, period in parts)
    return GroundMotion(x, y, z, dt=dt, name="synthetic motions")
