"""A base that tilts and bends under a stick, so that overturning reaches the bearings."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.library.building import pair
from frames.library.building_plan import DEFAULT_BASE_DEPTH

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.frame import Frame

VERTICAL_PERIOD = 0.05
"""Default period of vertical vibration that fixes a stick's stiffness [s]."""

_CLAMPED = 22.3733
"""Frequency of a beam held at both ends, over sqrt(EI / (m L^4)): cos(x) cosh(x) = 1, x^2."""

_UZ, _RX, _RY = 2, 3, 4


class GridPlan(NamedTuple):
    """A regular grid of bearings under a base."""

    bays: tuple[int, int]  # numbers of bays along x and y
    width: tuple[float, float]  # their widths [m]
    nodes: dict[tuple[int, int], str]  # nodes of the base over the bearings

    @property
    def side(self) -> tuple[float, float]:
        """Sides of the plan [m]."""
        return self.bays[0] * self.width[0], self.bays[1] * self.width[1]


def default_bending(plan: GridPlan, mass: float) -> tuple[float, float]:
    """Return the default bending stiffness of a stick's base beams along x and y.

    Beams of all levels bend equally if columns hardly shorten, so that one beam on each grid line
    represents those of all levels. The beams along one axis carry all of the mass of all levels.
    Each span, held at both ends, vibrates with a period of 0.05 s under its share of it.
    """
    square = (2.0 * math.pi / (_CLAMPED * VERTICAL_PERIOD)) ** 2
    lines = (plan.bays[1] + 1, plan.bays[0] + 1)
    along, across = (
        mass / (count * side) * span**4 * square
        for count, side, span in zip(lines, plan.side, plan.width, strict=True)
    )
    return along, across


def add_tilting_base(
    frame: Frame,
    plan: GridPlan,
    bending: float | tuple[float, float] | None,
    base_mass: float,
    *,
    column: float,
    floors: list[str],
) -> None:
    """Add a base that bends between its bearings, with floors that tilt with it, to a stick.

    The foot of the stick follows the plane that fits the nodes over the bearings best. This
    distributes its force and moments to them as a rigid base does, M x_i / sum(x^2). The beams on
    the grid lines resist deviations from the plane; the columns of the first storey hold their ends
    against rotation. Floors tilt with the foot: the stick does not bend, and shears times heights
    reach the base.
    """
    total = sum(mass[0] for mass in frame.masses.values())
    given = default_bending(plan, total) if bending is None else bending
    rigidity = pair(given, "shear_building: base_stiffness [N m2]")
    beside = {
        f"{floor}-mass": floor for floor in ("base", *floors) if f"{floor}-mass" in frame.nodes
    }
    nodes = ["base", *plan.nodes.values(), *floors, *beside]
    index = {node: k for k, node in enumerate(nodes)}
    at = np.array([(frame.nodes[node].x, frame.nodes[node].y) for node in plan.nodes.values()])
    fit = np.column_stack([np.ones(len(at)), at[:, 1], -at[:, 0]])  # uz of a plane (uz, rx, ry)
    foot = np.linalg.pinv(fit)
    count, size = len(at), 6 * len(nodes)
    over = 6 * np.arange(1, count + 1) + _UZ
    ties = np.zeros((3, size))
    ties[:, over] = -foot
    ties[:, [_UZ, _RX, _RY]] += np.eye(3)
    rows = [*ties]
    for node in (*floors, *beside):
        rows.extend(_tie(size, 6 * index[node] + turn, {turn: 1.0}) for turn in (_RX, _RY))
    for node, owner in beside.items():
        x, y = frame.nodes[node].x, frame.nodes[node].y
        follows = {6 * index[owner] + _UZ: 1.0, _RX: y, _RY: -x}
        rows.append(_tie(size, 6 * index[node] + _UZ, follows))
    mass = np.zeros((size, size))
    off = np.eye(count) - fit @ foot
    mass[np.ix_(over, over)] = total / count * off.T @ off
    stiffness = _beams(plan, rigidity, size)
    for turn in (_RX, _RY):
        held = np.zeros((count, size))
        held[np.arange(count), over - _UZ + turn] = 1.0
        held[:, turn] = -1.0
        stiffness += column * held.T @ held
    frame.add_superelement("base-beams", nodes, stiffness, mass, equations=rows)
    turning = base_mass / count * DEFAULT_BASE_DEPTH**2 / 12.0
    for node in plan.nodes.values():
        frame.add_mass(node, 0.0, (turning, turning, 0.0))


def _tie(size: int, dof: int, follows: dict[int, float]) -> FloatArray:
    # A displacement that follows others.
    row = np.zeros(size)
    row[dof] = 1.0
    for other, factor in follows.items():
        row[other] -= factor
    return row


def _beams(plan: GridPlan, rigidity: tuple[float, float], size: int) -> FloatArray:
    # Stiffness of the beams on all grid lines: uz, and the turn about the horizontal axis across.
    stiffness = np.zeros((size, size))
    place = {grid: 6 * (k + 1) for k, grid in enumerate(plan.nodes)}
    for ix, iy in plan.nodes:
        for axis, other in enumerate(((ix + 1, iy), (ix, iy + 1))):
            if other not in place:
                continue
            span = plan.width[axis]
            turn, sign = ((_RY, -1.0), (_RX, 1.0))[axis]  # slope of uz along the beam
            i, j = place[ix, iy], place[other]
            dofs = np.array([i + _UZ, i + turn, j + _UZ, j + turn])
            shape = np.array(
                [
                    [12.0, 6.0 * span, -12.0, 6.0 * span],
                    [6.0 * span, 4.0 * span**2, -6.0 * span, 2.0 * span**2],
                    [-12.0, -6.0 * span, 12.0, -6.0 * span],
                    [6.0 * span, 2.0 * span**2, -6.0 * span, 4.0 * span**2],
                ]
            )
            signs = np.array([1.0, sign, 1.0, sign])
            own = rigidity[axis] / span**3 * shape * np.outer(signs, signs)
            stiffness[np.ix_(dofs, dofs)] += own
    return stiffness
