"""Local axes of members, rotation of vectors and matrices; faces of a plan.

Local x runs from node i to node j; local z is in the plane of x and the `up` vector, on the side of
`up`; y = z x x completes the right-handed set. By default `up` is global Z, for vertical members
global X. A horizontal member along global X thus has the global directions as local axes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from frames._errors import ModelError

if TYPE_CHECKING:
    from frames._types import FloatArray


VERTICAL_SINE = 1e-3
"""A member is vertical when the sine of its angle to the global Z axis is below this [-]."""


def default_up(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the default `up` vector: global Z, and global X for vertical members.

    Shapes: start, end (n, 3), result (n, 3).
    """
    along = end - start
    sine = np.hypot(along[:, 0], along[:, 1]) / np.linalg.norm(along, axis=1)
    vertical = sine < VERTICAL_SINE
    return np.where(vertical[:, None], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])


def local_axes(start: FloatArray, end: FloatArray, up: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return local axes and lengths of members.

    Shapes: start, end (n, 3), up (n, 3), axes (n, 3, 3), length (n,).
    """
    along = end - start
    length = np.linalg.norm(along, axis=1)
    if (length <= 0.0).any():
        index = int(np.argmin(length))
        message = (
            f"member {index} has length 0 m, it must be greater than 0: join coincident "
            "nodes by a spring instead"
        )
        raise ModelError(message)
    x_axis = along / length[:, None]
    side = np.cross(up, x_axis)
    sine = np.linalg.norm(side, axis=1) / np.maximum(np.linalg.norm(up, axis=1), 1e-300)
    if (sine < 1e-6).any():
        index = int(np.argmin(sine))
        message = (
            f"up = {up[index].tolist()} of member {index} is zero or parallel to its axis "
            f"{x_axis[index].tolist()}: use a vector at an angle to the member"
        )
        raise ModelError(message)
    y_axis = side / np.linalg.norm(side, axis=1)[:, None]
    z_axis = np.cross(x_axis, y_axis)
    return np.stack([x_axis, y_axis, z_axis], axis=1), length


def to_local(vectors: FloatArray, axes: FloatArray) -> FloatArray:
    """Turn end displacements or forces from global into local axes.

    Shapes: vectors (..., n, 12), axes (n, 3, 3), result (..., n, 12).
    """
    triads = vectors.reshape(*vectors.shape[:-1], 4, 3)
    turned: FloatArray = np.einsum("nab,...nkb->...nka", axes, triads)
    return turned.reshape(vectors.shape)


def to_global(vectors: FloatArray, axes: FloatArray) -> FloatArray:
    """Turn end displacements or forces from local into global axes.

    Shapes: vectors (..., n, 12), axes (n, 3, 3), result (..., n, 12).
    """
    return to_local(vectors, axes.transpose(0, 2, 1))


def matrix_to_global(matrices: FloatArray, axes: FloatArray) -> FloatArray:
    """Turn member matrices from local into global axes.

    Shapes: matrices (n, 12, 12), axes (n, 3, 3), result (n, 12, 12).
    """
    count = axes.shape[0]
    blocks = matrices.reshape(count, 4, 3, 4, 3)
    turned: FloatArray = np.einsum("npa,nipjq,nqb->niajb", axes, blocks, axes, optimize=True)
    return turned.reshape(count, 12, 12)


Point: TypeAlias = "tuple[float, float] | FloatArray"

_STRAIGHT = 1e-6
"""Sine of the rotation below which a corner is on a straight edge [-]."""


class Fields(NamedTuple):
    """Fields of a floor."""

    # corners of each field anticlockwise, those on straight edges left out
    corners: tuple[tuple[str, ...], ...]
    # pieces of beams along the outer edges of the floor: on one side of them is no field
    outer: tuple[tuple[str, str], ...]


def fields_of(points: Mapping[str, Point], beams: Iterable[tuple[str, str]], where: str) -> Fields:
    """Return the fields that beams enclose, each without a beam across it."""
    edges = [tuple(sorted(beam)) for beam in beams]
    _require_plane(points, edges, where)
    around: dict[str, set[str]] = {}
    for one, other in edges:
        around.setdefault(one, set()).add(other)
        around.setdefault(other, set()).add(one)
    inner = faces_of(points, around, sorted)
    sides: dict[tuple[str, str], int] = {}
    for face in inner:
        for one, other in zip(face, [*face[1:], face[0]], strict=True):
            key = (min(one, other), max(one, other))
            sides[key] = sides.get(key, 0) + 1
    outer = tuple(edge for edge, count in sides.items() if count == 1)
    return Fields(tuple(corners_of(points, face) for face in inner), outer)


def _require_plane(
    points: Mapping[str, Point], edges: Sequence[tuple[str, ...]], where: str
) -> None:
    for k, first in enumerate(edges):
        for second in edges[k + 1 :]:
            if _meet(points, first, second):
                names = [f'from "{edge[0]}" to "{edge[1]}"' for edge in (first, second)]
                msg = (
                    f"{where}: the beams {names[0]} and {names[1]} overlap or cross between their "
                    "ends: divide them at column lines"
                )
                raise ModelError(msg)


def _meet(points: Mapping[str, Point], first: Sequence[str], second: Sequence[str]) -> bool:
    # True if two beams share more than an end.
    (a, b), (c, d) = ([points[name] for name in edge] for edge in (first, second))
    shared = set(first) & set(second)
    if len(shared) == 2:
        return True
    size = max(math.dist(a, b), math.dist(c, d))
    if shared:  # on one line, and on the same side of the end that they share
        (pivot,) = shared
        u, v = (next(points[name] for name in edge if name != pivot) for edge in (first, second))
        o = points[pivot]
        across = (u[0] - o[0]) * (v[1] - o[1]) - (u[1] - o[1]) * (v[0] - o[0])
        along = (u[0] - o[0]) * (v[0] - o[0]) + (u[1] - o[1]) * (v[1] - o[1])
        return abs(across) <= _STRAIGHT * math.dist(u, o) * math.dist(v, o) and along > 0.0
    least = _STRAIGHT * size**2

    def side(p: Point, q: Point, r: Point) -> float:
        turn = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        return 0.0 if abs(turn) <= least else math.copysign(1.0, turn)

    one, two, three, four = side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)
    if not any((one, two, three, four)):  # on one line
        way = (b[0] - a[0], b[1] - a[1])
        length = math.hypot(*way)
        places = sorted(((p[0] - a[0]) * way[0] + (p[1] - a[1]) * way[1]) / length for p in (c, d))
        return min(places[1], length) - max(places[0], 0.0) > _STRAIGHT * size
    return one * two <= 0.0 and three * four <= 0.0


def faces_of(
    points: Mapping[str, Point],
    around: Mapping[str, Iterable[str]],
    order: Callable[[list[tuple[str, str]]], list[tuple[str, str]]] = list,
) -> list[list[str]]:
    """Return the bounded faces of a plane graph, anticlockwise; free ends enclose nothing.

    Each side of each edge is followed once, with the leftmost turn at each node. `order` gives the
    first edges.
    """
    links = {name: set(others) for name, others in around.items()}
    while loose := [name for name, others in links.items() if len(others) < 2]:
        for name in loose:
            for other in links.pop(name):
                links.get(other, set()).discard(name)
    turned = {}
    for name, others in links.items():
        x, y = points[name]
        ways = [(math.atan2(points[o][1] - y, points[o][0] - x), o) for o in others]
        turned[name] = [other for _, other in sorted(ways)]
    edges = [(one, other) for one, others in turned.items() for other in others]
    left, faces = set(edges), []
    for edge in order(edges):
        face, (here, there) = [], edge
        while (here, there) in left:
            left.discard((here, there))
            face.append(here)
            ways_on = turned[there]
            here, there = there, ways_on[ways_on.index(here) - 1]
        if len(face) > 2 and area_of(points, face) > 0.0:
            faces.append(face)
    return faces


def area_of(points: Mapping[str, Point], face: Sequence[str]) -> float:
    """Return the area of a face, > 0 if it runs anticlockwise [m2]."""
    corners = [points[name] for name in face]
    sides = zip(corners, [*corners[1:], corners[0]], strict=True)
    return 0.5 * sum(float(a[0] * b[1] - b[0] * a[1]) for a, b in sides)


def corners_of(points: Mapping[str, Point], face: Sequence[str]) -> tuple[str, ...]:
    """Return the corners of a face, those on straight edges left out."""
    found = []
    for k, name in enumerate(face):
        (a, b, c) = (points[face[k - 1]], points[name], points[face[(k + 1) % len(face)]])
        turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
        if abs(turn) > _STRAIGHT * math.dist(a, b) * math.dist(b, c):
            found.append(name)
    return tuple(found)
