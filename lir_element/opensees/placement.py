"""Place of a bearing in an OpenSees model: checks of the input, and the map to its own axes."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from lir_element.argument_checks import require_positive
from lir_element.elevations import SAME_PLACE

if TYPE_CHECKING:
    from lir_element.device.bearing import LIRBearing
    from lir_element.layout import Floats

_NDF = {2: 3, 3: 6}


class PlacementWarning(UserWarning):
    """Warning: a bearing may not be placed as intended.

    Examples
    --------
    >>> import warnings
    >>> from lir_element import LIRBearing
    >>> from lir_element.opensees import bearing_element, opensees
    >>> ops = opensees()
    >>> ops.wipe()
    >>> ops.model("basic", "-ndm", 3, "-ndf", 6)
    >>> ops.node(1, 0.0, 0.0, 0.0)
    >>> ops.node(2, 0.0, 0.0, 0.0)
    >>> ops.fix(2, 1, 1, 1, 1, 1, 1)
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=0.066, interface_friction=0.126)
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     route = bearing_element(10, 1, 2, bearing)
    >>> str(told[0].message).split(":")[0]
    'node 2, the upper one, is supported and node 1, the lower one, is not'
    >>> ops.wipe()
    """


class BearingTransform(NamedTuple):
    """Map from the model's degrees of freedom to the bearing's own axes."""

    nodes: tuple[int, int]
    dofs: int
    """Degrees of freedom of both nodes."""
    matrix: Floats
    """Displacements (12,) in bearing axes [m, rad] by those of the model, (12, dofs)."""
    force_factor: float
    """Forces of the model are ``force_factor * matrix.T @ force``."""
    axes: Floats
    """Unit vectors of the bearing's x, y and z in the model's axes, as rows (3, 3)."""
    force_unit: float
    """The model's unit of force [N]."""


class PlacedBearing(NamedTuple):
    """A bearing in a model: input of each coupling."""

    tag: int
    """Tag of its element."""
    device: LIRBearing
    level: str
    """Level of fidelity."""
    placement: BearingTransform
    symmetric: bool = False
    """True if its tangent is made symmetric."""

    def printed(self, route: str) -> dict[str, Any]:
        """Return the element's line in a printed model."""
        nodes = [int(node) for node in self.placement.nodes]
        said = {"name": self.tag, "type": "LIRBearing", "nodes": nodes}
        return said | {"level": self.level, "route": route}


def place(
    ops: Any,
    i: int,
    j: int,
    bearing: LIRBearing,
    orient: Sequence[float] | None,
    length_unit: float,
    force_unit: float,
) -> BearingTransform:
    """Check the place of a bearing, and return its map."""
    metre = require_positive("length_unit", length_unit, "m")
    newton = require_positive("force_unit", force_unit, "N")
    i, j = _two_tags(i, j)
    points = [_coordinates(ops, tag) for tag in (i, j)]
    ndm = len(points[0])
    axes = bearing_axes(orient, ndm)
    if orient is None and ndm == 3 and _stands_on_y(ops, int(i)):
        msg = (
            f"the bearing between nodes {i} and {j} points along z, but all supports lie in "
            "one plane y = const. below the model: pass orient=(0, 1, 0) if y is vertical, "
            "orient=(0, 0, 1) if z is"
        )
        warnings.warn(msg, PlacementWarning, stacklevel=3)
    rise = metre * (points[1] - points[0])
    _check_rise(i, j, rise, axes, bearing.height)
    if np.linalg.norm(rise) <= SAME_PLACE and _hangs(ops, i, j, ndm):
        msg = (
            f"node {j}, the upper one, is supported and node {i}, the lower one, is not: if "
            f"the support is below, swap them, i={j} and j={i}"
        )
        warnings.warn(msg, PlacementWarning, stacklevel=3)
    matrix = np.zeros((12, 12))
    for block in range(4):
        rows = slice(3 * block, 3 * block + 3)
        matrix[rows, rows] = axes * (metre if block % 2 == 0 else 1.0)
    if ndm == 2:  # ux, uy, rz of the plane
        matrix = matrix[:, [0, 1, 5, 6, 7, 11]]
    factor = 1.0 / (newton * metre)
    return BearingTransform((int(i), int(j)), matrix.shape[1], matrix, factor, axes, newton)


def _hangs(ops: Any, i: int, j: int, ndm: int) -> bool:
    # True if supports hold all displacements of node j and none of node i.
    moves = set(range(1, ndm + 1))
    lower, upper = (moves.intersection(ops.getFixedDOFs(tag) or ()) for tag in (i, j))
    return not lower and upper == moves


def _stands_on_y(ops: Any, node: int) -> bool:
    # True if the supports, this node among them, share the model's lowest y, but not one z.
    places = {tag: ops.nodeCoord(tag) for tag in ops.getNodeTags()}
    points = np.array([place for place in places.values() if len(place) == 3])
    ground = np.array([places[tag] for tag in {node, *ops.getFixedNodes()}])
    if ground.shape[1:] != (3,):
        return False
    spread = np.ptp(ground, axis=0)
    near = 1e-6 * max(float(np.ptp(points)), 1e-9)
    above = points[:, 1] - ground[0, 1]
    return bool(spread[1] <= near < spread[2] and above.min() >= -near and above.max() > near)


def bearing_axes(orient: Sequence[float] | None, ndm: int) -> Floats:
    """Return the unit vectors of the bearing's x, y and z (from i up to j) as rows, (3, 3)."""
    if orient is None:
        given = np.array([0.0, 0.0, 1.0] if ndm == 3 else [0.0, 1.0, 0.0])
    else:
        given = _numbers(orient)
    if given.shape not in {(3,), (6,)} or not np.isfinite(given).all():
        msg = (
            f"orient = {orient!r}: give the bearing's axis from node i to node j, 3 numbers, "
            "or the axis and its horizontal x direction, 6 numbers"
        )
        raise ValueError(msg)
    if ndm == 2 and np.abs(given[2::3]).max() > 1e-12:
        msg = f"orient = {orient!r}: in a model of two dimensions both vectors lie in its plane"
        raise ValueError(msg)
    up = given[:3]
    side = given[3:] if given.size == 6 else _any_side(up, ndm)
    normal = np.cross(up, side)
    if np.linalg.norm(normal) <= 1e-6 * np.linalg.norm(up) * np.linalg.norm(side):
        msg = f"orient = {orient!r}: its axis has no length, or its x direction is parallel to it"
        raise ValueError(msg)
    z, y = up / np.linalg.norm(up), normal / np.linalg.norm(normal)
    return np.array([np.cross(y, z), y, z])


def _numbers(orient: Sequence[float]) -> Floats:
    # Anything but a list of numbers becomes an empty one, which the caller refuses.
    try:
        return np.asarray(orient, dtype=np.float64)
    except (TypeError, ValueError):
        return np.zeros(0)


def _any_side(up: Floats, ndm: int) -> Floats:
    # Global x, or global z if the bearing's axis is nearly x: its x must be normal to it. In two
    # dimensions there is one direction only.
    if ndm == 2:
        return np.array([up[1], -up[0], 0.0])
    length = float(np.linalg.norm(up))
    return np.array([0.0, 0.0, 1.0] if abs(up[0]) > 0.9 * length else [1.0, 0.0, 0.0])


def _two_tags(i: int, j: int) -> tuple[int, int]:
    for name, tag in (("i", i), ("j", j)):
        if isinstance(tag, bool) or not isinstance(tag, (int, np.integer)):
            msg = f"node {name} = {tag!r} must be an integer tag"
            raise TypeError(msg)
    if i == j:
        msg = f"the bearing starts and ends at node {i}: pass two different nodes"
        raise ValueError(msg)
    return int(i), int(j)


def _coordinates(ops: Any, tag: int) -> Floats:
    if tag not in ops.getNodeTags():
        msg = f"node {tag} is not in the current OpenSees model: add it before the bearing"
        raise ValueError(msg)
    point = np.array(ops.nodeCoord(tag), dtype=np.float64, ndmin=1)  # xara has a number for one
    ndf = np.size(ops.nodeDisp(tag))
    if _NDF.get(len(point)) != ndf:
        msg = (
            f"node {tag} has {len(point)} coordinates and {ndf} degrees of freedom: a bearing "
            "needs 3 and 6 (model -ndm 3 -ndf 6) or 2 and 3 (-ndm 2 -ndf 3)"
        )
        raise ValueError(msg)
    return point


def _check_rise(i: int, j: int, rise: Floats, axes: Floats, height: float) -> None:
    full = np.zeros(3)
    full[: len(rise)] = rise
    x, y, z = axes @ full
    apart = float(np.linalg.norm(full))
    thousandth = 1e-3 * apart
    if abs(thousandth - height) <= SAME_PLACE and apart > SAME_PLACE:
        msg = (
            f"nodes {i} and {j} are {apart:g} m apart, 1,000 times the bearing's height of "
            f"{height:g} m: if the model is in mm, pass length_unit=0.001 (and "
            "force_unit=1e3 for kN)"
        )
        raise ValueError(msg)
    if abs(z + height) <= SAME_PLACE and max(abs(x), abs(y)) <= SAME_PLACE:
        msg = (
            f"node {j} is {-z:g} m below node {i}, the bearing's height: swap the nodes, "
            f"i={j} and j={i} (i is the lower one)"
        )
        raise ValueError(msg)
    if max(abs(x), abs(y)) > SAME_PLACE:
        msg = (
            f"node {j} is {np.hypot(x, y):g} m off the bearing's axis through node {i} (at "
            f"most {SAME_PLACE:g} m): move it, or set the axis by orient, (0, 1, 0) if y is "
            "vertical"
        )
        raise ValueError(msg)
    if min(abs(z), abs(z - height)) > SAME_PLACE:
        msg = (
            f"node {j} is {z:g} m above node {i}, it must be 0 m or the bearing's height "
            f"{height:g} m (slider and plates, within {SAME_PLACE:g} m): move it, or change "
            "plate_thickness of the bearing"
        )
        raise ValueError(msg)
