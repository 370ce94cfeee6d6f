"""Where frame objects are divided: at joints on their line, nodes of meshes, point loads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from frames._errors import ModelError
from frames.exchange.building import NOWHERE, FrameObject
from frames.exchange.geometry import cardinal_shift, frame_axes
from lir_element.elevations import SAME_PLACE

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames._types import FloatArray
    from frames.exchange.building import Building


MOST_STIFF = 0.95
"""Largest share of a member that its stiff end zones take [-]."""

Points = dict[str, tuple[float, float, float]]


@dataclass(frozen=True, eq=False)
class SplitMember:
    """A frame object divided into members."""

    frame: FrameObject
    nodes: list[str]  # from joint i to joint j
    shares: FloatArray  # where they are, of the length between the joints [-]
    start: FloatArray  # (3,), where its axis is at joint i [m]
    way: FloatArray  # (3,), from there to where its axis is at joint j [m]
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
        """Whether its stiff zones are shorter than asked for, to leave a flexible length."""
        asked = self.frame.rigid * (self.frame.end_i + self.frame.end_j) / self.length
        return sum(self.stiff) < asked - 1e-9

    def at(self, share: float) -> FloatArray:
        """Return the point of its axis at a share of the length (3,) [m]."""
        return self.start + share * self.way

    def flexible(self, place: int) -> tuple[float, float]:
        """Return from where to where a member is flexible, as shares of the length."""
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
    """Return the nodes under point loads, and by the rule of the lever those beside them."""
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
    """Return whether the axis of a frame object is beside its joints."""
    beside = frame.offset_i != NOWHERE or frame.offset_j != NOWHERE or frame.cardinal < 10
    return frame.transforms and beside
