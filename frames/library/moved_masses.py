"""Floors' masses moved in plan, for the codes' accidental eccentricity; weights stay."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np
from scipy import sparse

from frames._errors import ModelError
from frames.assembly.assemble import assemble
from frames.frame import Frame
from lir_element.argument_checks import require_between
from lir_element.elevations import by_elevation

if TYPE_CHECKING:
    from frames._types import BoolArray, FloatArray, IntArray
    from frames.assembly.system import System

MOST = 0.25
"""Largest share of a side by which masses may be moved [-]; codes require 0.05."""

PART = "moved-masses"
"""Name of the superelement that moves them."""

_SPREAD = 0.5  # share of its mass that a node may lose or gain, if a floor's masses are tilted
_ALONG = 1e-9  # of the structure's plan, below which a floor has no extent
_RZ = 5

F = TypeVar("F", bound=Frame)


class _Floor(NamedTuple):
    # Masses of one level: which nodes, and the sides of its plan.
    name: str
    nodes: IntArray
    sides: FloatArray


def with_moved_masses(frame: F, shares: tuple[float, float], name: str | None = None) -> F:
    """Return a copy of a frame with floor masses moved in plan; weights stay in place.

    Floors are the levels of the frame, or the elevations of its masses above the bearings if it has
    none; a mass belongs to the nearest. If masses are at several nodes of a floor, each becomes ``m
    (1 + a (s - s_c))`` along the axis s, with ``a = c M / sum(m (s - s_c)^2)``. This moves their
    centre s_c by c and keeps their sum M. If the masses of a floor are at one node, or too close
    together, it carries them rigidly at the distance c: ``M_rz,ux = -m c_y``, ``M_rz,uy = m c_x``,
    ``M_rz,rz = m c^2``. The side of that floor is that of the whole structure, else that of its
    nodes. Only the inertia in plan moves. A pendulum's stiffness is proportional to its load, so
    that moved weights would also move the centre of stiffness, and remove most of the torsion
    (docs/choices_structure.md).

    Examples
    --------
    >>> from frames import shear_building
    >>> from frames.demo import bearing_for
    >>> frame = shear_building(bearing_for(1000e3), storeys=2, storey_mass=34e3,
    ...                        storey_stiffness=40e6, plan=((1, 1), (6.0, 6.0)))
    >>> with_moved_masses(frame, (0.05, 0.0)).superelements[PART].nodes
    ('base', 'floor-1', 'floor-2')
    """
    if PART in frame.superelements:
        msg = f'the masses of the frame "{frame.name}" are moved already: pass the original frame'
        raise ModelError(msg)
    given = [
        require_between(
            f"shares along {axis}",
            share,
            -MOST,
            MOST,
            "-",
            remedy="0.05 is 5 % of the side",
            error=ModelError,
        )
        for axis, share in zip("xy", shares, strict=True)
    ]
    system = assemble(frame)
    change = sparse.lil_array((6 * len(system.node_names),) * 2)
    for floor in _floors(frame, system):
        for axis, share in enumerate(given):
            if share:
                _move(system, floor, axis, share, change)
    places = np.unique(change.tocoo().row // 6)
    found = frame.copy(name)
    if len(places):
        dofs = (6 * places[:, None] + np.arange(6)).ravel()
        mass = sparse.csr_array(change)[dofs][:, dofs]
        nodes = tuple(system.node_names[place] for place in places)
        none = sparse.csr_array(mass.shape, dtype=np.float64)
        found.add_superelement(PART, nodes, none, mass)
    return found


def _floors(frame: Frame, system: System) -> list[_Floor]:
    # Masses above the bearings that move in plan, each with the nearest level.
    above = system.above_bearings
    moving = np.diff(system.transform.indptr).reshape(-1, 6) > 0
    heavy = above & (system.node_mass[:, :2] > 0.0).any(axis=1) & moving[:, :2].any(axis=1)
    if not heavy.any():
        msg = (
            f'the frame "{frame.name}" has no mass above its bearings that moves in plan: '
            "add masses to its floors"
        )
        raise ModelError(msg)
    heights = system.coordinates[:, 2]
    levels = {level.name: level.z for level in frame.levels}
    if not levels:
        groups = by_elevation(dict(enumerate(heights[heavy].tolist())))
        found_at = (float(heights[heavy][group[0]]) for group in groups)
        levels = {f"elevation {round(z, 3):g} m": z for z in found_at}
    names, at = list(levels), np.array(list(levels.values()))
    nearest = np.abs(heights[:, None] - at).argmin(axis=1)
    whole = np.ptp(system.coordinates[above, :2], axis=0)
    found = []
    for k, name in enumerate(names):
        nodes = np.flatnonzero(heavy & (nearest == k))
        if not len(nodes):
            continue
        own = np.ptp(system.coordinates[above & (nearest == k), :2], axis=0)
        found.append(_Floor(name, nodes, own if len(nodes) > 1 else whole))
    return found


def _move(system: System, floor: _Floor, axis: int, share: float, change: sparse.lil_array) -> None:
    # Changes of the mass matrix that move a floor's masses along an axis.
    side = float(floor.sides[axis])
    if side <= _ALONG * float(np.ptp(system.coordinates, axis=0).max()):
        msg = (
            f'floor "{floor.name}" has no extent along {"xy"[axis]}, so its masses cannot be '
            "moved: put mass on nodes apart from each other"
        )
        raise ModelError(msg)
    distance = share * side
    masses = system.node_mass[floor.nodes, :2]
    along = system.coordinates[floor.nodes, axis]
    total = masses.mean(axis=1)
    lever = along - total @ along / total.sum()
    square = float(total @ lever**2)
    tilt = distance * float(total.sum()) / square if square > 0.0 else math.inf
    if abs(tilt) * float(np.abs(lever).max()) <= _SPREAD:
        for node, mass, arm in zip(floor.nodes, masses, lever, strict=True):
            for push in (0, 1):
                change[6 * node + push, 6 * node + push] += mass[push] * tilt * arm
        return
    _require_turning(system, floor)
    push, sign = (1, 1.0) if axis == 0 else (0, -1.0)  # the mass across the direction of the move
    for node, mass in zip(floor.nodes, masses[:, push], strict=True):
        i, j = 6 * node + push, 6 * node + _RZ
        change[i, j] += sign * mass * distance
        change[j, i] += sign * mass * distance
        change[j, j] += mass * distance**2


def _require_turning(system: System, floor: _Floor) -> None:
    turns: BoolArray = np.diff(system.transform.indptr)[6 * floor.nodes + _RZ] > 0
    if not turns.all():
        node = system.node_names[floor.nodes[int(np.argmin(turns))]]
        msg = (
            f'floor "{floor.name}" cannot rotate about the vertical (rz of its node "{node}" '
            "is fixed), so moved masses have no effect: free rz"
        )
        raise ModelError(msg)
