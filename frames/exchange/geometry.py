"""Axes of objects, directions of loads, joints in areas; division of frame objects."""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from scipy.spatial import cKDTree

from frames._errors import ModelError
from frames.exchange.building import NOWHERE, FrameObject
from frames.model.axes import VERTICAL_SINE
from lir_element.elevations import SAME_PLACE, by_elevation

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames._types import FloatArray
    from frames.exchange.building import Vector

    Point: TypeAlias = Sequence[float] | FloatArray
    from collections.abc import Sequence

    from frames.exchange.building import Building


_GLOBAL = {
    "x": (1.0, 0.0, 0.0),
    "y": (0.0, 1.0, 0.0),
    "z": (0.0, 0.0, 1.0),
    "gravity": (0.0, 0.0, -1.0),
    "grav": (0.0, 0.0, -1.0),
}


def frame_axes(start: Point, end: Point, angle: float = 0.0) -> FloatArray:
    """Return the local axes of a frame object or a link.

    Axis 1 runs from i to j; the 1-2 plane is vertical and 2 points up; for a vertical object (sine
    of the angle to Z below 1e-3) 2 is +X. The angle rotates 2 and 3 about 1. Source: CSI Analysis
    Reference Manual, "The Frame Element", local coordinate system.

    Shapes: start, end (3,), result (3, 3).
    """
    along = np.subtract(end, start)
    first = along / math.sqrt(along @ along)
    upright = math.hypot(first[0], first[1]) < VERTICAL_SINE
    guide = np.array([1.0, 0.0, 0.0] if upright else [0.0, 0.0, 1.0])
    second = guide - (guide @ first) * first
    second /= math.sqrt(second @ second)
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    third = np.array((b * z - c * y, c * x - a * z, a * y - b * x))
    if angle:
        cos, sin = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        second, third = cos * second + sin * third, cos * third - sin * second
    return np.stack([first, second, third])


def area_normal(points: FloatArray) -> tuple[FloatArray, float]:
    """Return the unit normal of a plane polygon and its area [m2].

    Shapes: points (n, 3), normal (3,).
    """
    centre = points.mean(axis=0)
    x, y, z = (points - centre).T
    u, v, w = (np.concatenate((each[1:], each[:1])) for each in (x, y, z))
    twice = np.array((y @ w - z @ v, z @ u - x @ w, x @ v - y @ u))
    size = math.sqrt(twice @ twice)
    return (twice / size if size > 0.0 else twice), 0.5 * size


def direction_of(word: str, axes: FloatArray | None) -> tuple[FloatArray, bool] | None:
    """Return the unit vector of a direction of loads, and whether it is per projected length.

    Shapes: axes (3, 3), result (3,).
    """
    text = word.strip().lower()
    projected = "proj" in text
    text = text.replace("projected", "").replace("proj", "").strip(" -")
    if text in _GLOBAL:
        return np.array(_GLOBAL[text]), projected
    if axes is not None and text in {"1", "2", "3", "local-1", "local-2", "local-3"}:
        return axes[int(text[-1]) - 1], projected
    return None


def cardinal_shift(cardinal: int, depth: float, width: float) -> tuple[float, float]:
    """Return the centroid relative to an insertion point of a doubly symmetric section [m]."""
    if not 1 <= cardinal <= 9:
        return 0.0, 0.0
    row, column = divmod(cardinal - 1, 3)
    return 0.5 * depth * (1 - row), 0.5 * width * (column - 1)


class Levels:
    """Joints by elevation."""

    def __init__(self, places: Mapping[str, Vector]) -> None:
        groups = by_elevation({name: place[2] for name, place in places.items()})
        self._low = [places[names[0]][2] for names in groups]
        self._levels = [(names, np.array([places[n][:2] for n in names])) for names in groups]

    def level(self, z: float) -> int:
        """Return the number of the level at a height [m], -1 if there is none."""
        k = bisect_right(self._low, z) - 1
        if k >= 0 and z - self._low[k] <= SAME_PLACE:
            return k
        near = k + 1 < len(self._low) and self._low[k + 1] - z <= SAME_PLACE
        return k + 1 if near else -1

    def within(self, corners: FloatArray) -> dict[str, FloatArray]:
        """Return the joints inside of a level area and on its edges, and their places in plan.

        Shapes: corners (n, 3), result (2,).
        """
        k = self.level(float(corners[0, 2]))
        if k < 0:
            return {}
        names, places = self._levels[k]
        outline = corners[:, :2]
        low, high = outline.min(axis=0) - SAME_PLACE, outline.max(axis=0) + SAME_PLACE
        near = np.flatnonzero(((places >= low) & (places <= high)).all(axis=1))
        return {names[k]: places[k] for k in near if is_within(places[k], outline)}


def is_within(place: FloatArray, outline: FloatArray) -> bool:
    """Return True if a point is inside a polygon, or within a millimetre of its edges.

    Shapes: place (2,), outline (n, 2).
    """
    inside = False
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        way, apart = b - a, place - a
        length = float(np.hypot(*way))
        if length > 0.0:
            along = float(apart @ way) / length
            beside = abs(float(way[0] * apart[1] - way[1] * apart[0])) / length
            if beside <= SAME_PLACE and -SAME_PLACE <= along <= length + SAME_PLACE:
                return True
        if (a[1] > place[1]) != (b[1] > place[1]):
            cut = a[0] + (place[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            inside ^= bool(place[0] < cut)
    return inside


MOST_STIFF = 0.95
"""Largest share of a member that its stiff end zones take [-]."""

Points = dict[str, tuple[float, float, float]]


@dataclass(frozen=True, eq=False)
class SplitMember:
    """A frame object divided into members."""

    frame: FrameObject
    nodes: list[str]  # from joint i to joint j
    shares: FloatArray  # their positions, over the length between the joints [-]
    start: FloatArray  # (3,), its axis at joint i [m]
    way: FloatArray  # (3,), from there to its axis at joint j [m]
    length: float  # between the joints [m]
    axes: FloatArray  # (3, 3), axes 1, 2, 3
    stiff: tuple[float, float]  # shares of the length that are stiff at i and at j [-]

    @property
    def members(self) -> list[str]:
        """Names of its members, from i to j."""
        if len(self.nodes) == 2:
            return [self.frame.name]
        return [f"{self.frame.name}/{k}" for k in range(1, len(self.nodes))]

    @property
    def cut(self) -> bool:
        """True if its stiff zones are shorter than given, to leave a flexible length."""
        asked = self.frame.rigid * (self.frame.end_i + self.frame.end_j) / self.length
        return sum(self.stiff) < asked - 1e-9

    def at(self, share: float) -> FloatArray:
        """Return the point of its axis at a share of the length (3,) [m]."""
        return self.start + share * self.way

    def flexible(self, place: int) -> tuple[float, float]:
        """Return the ends of a member's flexible part, as shares of the length [-]."""
        first, last = float(self.shares[place]), float(self.shares[place + 1])
        if place == 0:
            first = self.stiff[0]
        if place == len(self.nodes) - 2:
            last = 1.0 - self.stiff[1]
        return first, last


def divide(
    building: Building, points: Points, loads: Mapping[str, Sequence[float]]
) -> list[SplitMember]:
    """Divide all frame objects."""
    names = list(points)
    where = np.array([points[name] for name in names])
    tree = cKDTree(where)
    found = []
    for frame in building.frames.values():
        first, last = (np.array(points[name]) for name in (frame.i, frame.j))
        length = float(np.linalg.norm(last - first))
        if length < SAME_PLACE:
            message = (
                f'{frame.place}: frame "{frame.name}" is {length:g} m long between joints '
                f'"{frame.i}" and "{frame.j}": merge them, or join them by a link'
            )
            raise ModelError(message)
        between: list[tuple[float, str]] = []
        if frame.meshed:
            near = tree.query_ball_point(0.5 * (first + last), 0.5 * length - SAME_PLACE)
            between = _on_line(near, names, where, first, last, length)
        found.append(_divided(building, frame, between, (first, last), length))
    _at_loads(found, points, loads)
    return found


def _on_line(
    near: list[int],
    names: list[str],
    where: FloatArray,
    first: FloatArray,
    last: FloatArray,
    length: float,
) -> list[tuple[float, str]]:
    if not near:
        return []
    unit = (last - first) / length
    apart = where[near] - first
    along = apart @ unit
    beside = np.linalg.norm(apart - along[:, None] * unit, axis=1)
    return sorted(
        (float(a) / length, names[k])
        for k, a, b in zip(near, along, beside, strict=True)
        if b <= SAME_PLACE
    )


def _divided(
    building: Building,
    frame: FrameObject,
    between: list[tuple[float, str]],
    ends: tuple[FloatArray, FloatArray],
    length: float,
) -> SplitMember:
    axes = frame_axes(ends[0], ends[1], frame.angle)
    shifts = [np.zeros(3), np.zeros(3)]
    if frame.transforms:
        section = building.sections[frame.section]
        two, three = cardinal_shift(frame.cardinal, section.depth, section.width)
        middle = two * axes[1] + three * axes[2]
        shifts = [np.array(o) + middle for o in (frame.offset_i, frame.offset_j)]
    start, end = ends[0] + shifts[0], ends[1] + shifts[1]
    shares = np.array([0.0, *(share for share, _ in between), 1.0])
    return SplitMember(
        frame=frame,
        nodes=[frame.i, *(name for _, name in between), frame.j],
        shares=shares,
        start=start,
        way=end - start,
        length=length,
        axes=axes,
        stiff=_stiff_zones(frame, shares, length),
    )


def _stiff_zones(frame: FrameObject, shares: FloatArray, length: float) -> tuple[float, float]:
    # As shares of the length: each within its member, of which a part stays flexible.
    i, j = (frame.rigid * zone / length for zone in (frame.end_i, frame.end_j))
    if len(shares) == 2:
        scale = min(1.0, MOST_STIFF / (i + j)) if i + j else 1.0
        return scale * i, scale * j
    rooms = float(shares[1]), float(1.0 - shares[-2])
    return min(i, MOST_STIFF * rooms[0]), min(j, MOST_STIFF * rooms[1])


def _at_loads(
    found: list[SplitMember], points: Points, loads: Mapping[str, Sequence[float]]
) -> None:
    # A node under each point load that is on the flexible part.
    for k, each in enumerate(found):
        for share in sorted(set(loads.get(each.frame.name, ()))):
            low, high = each.stiff[0], 1.0 - each.stiff[1]
            known = float(np.abs(found[k].shares - share).min()) * each.length < SAME_PLACE
            if known or not low < share < high:
                continue
            one = found[k]
            place = int(np.searchsorted(one.shares, share))
            name = f"{each.frame.name}@{share:.4g}"
            first, last = (np.array(points[n]) for n in (each.frame.i, each.frame.j))
            x, y, z = (first + share * (last - first)).tolist()
            points[name] = (x, y, z)
            nodes = [*one.nodes[:place], name, *one.nodes[place:]]
            shares = np.insert(one.shares, place, share)
            found[k] = SplitMember(
                one.frame, nodes, shares, one.start, one.way, one.length, one.axes, one.stiff
            )


def under_loads(found: list[SplitMember], joints: Points) -> dict[str, list[tuple[str, float]]]:
    """Return the nodes under point loads, or by the rule of the lever the nodes beside them."""
    beside = {}
    for one in found:
        real = [k for k, node in enumerate(one.nodes) if node in joints]
        for k, node in enumerate(one.nodes):
            if node not in joints:
                low = max(r for r in real if r < k)
                high = min(r for r in real if r > k)
                part = one.shares[k] - one.shares[low]
                share = float(part / (one.shares[high] - one.shares[low]))
                beside[node] = [(one.nodes[low], 1.0 - share), (one.nodes[high], share)]
    return beside


def is_offset(frame: FrameObject) -> bool:
    """Return True if the axis of a frame object is beside its joints."""
    beside = frame.offset_i != NOWHERE or frame.offset_j != NOWHERE or frame.cardinal < 10
    return frame.transforms and beside
