"""Stiffness of beams, columns and bars of an OpenSees model, element by element.

Most elements provide the stiffness of their basic system: of a beam between hinges, which a
coordinate transformation carries to the nodes. For the others forces are read while nodes are moved
in one direction at a time, each element beside one moved node; then all is restored.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.assembly.members import rigid_arms
from frames.model.axes import default_up, local_axes
from frames.opensees.structure import turning

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray
    from frames.opensees.materials import Printed
    from frames.opensees.model import ElementEntry, OpenSeesModel
    from frames.opensees.structure import Options

_STEP = 1e-6  # rotation [rad], and displacement over the mean length of elements
_APART = 1e-2  # of an element's stiffness, by which the assembled one may differ from it
_NONE = 1e-6  # of its largest entry, that counts as none
_WITH_P_DELTA = ("PDelta", "Corot")  # beginnings of names of transformations


class Geometry(NamedTuple):
    """Elements in axes of the frame, in the model's unit of length."""

    # (n, 3, 3), rows are local x, y, z as OpenSees has them; of bars those of members
    axes: FloatArray
    length: FloatArray  # (n,), between the ends
    arms: FloatArray  # (n, 2, 3), from nodes to ends, in local axes
    put: FloatArray  # (12, 2 ndf), displacements of two nodes from the model's axes to the frame's

    def local(self) -> FloatArray:
        """Return the transformation of displacements of two nodes to local axes, (n, 12, 12)."""
        found = np.zeros((len(self.axes), 12, 12))
        for k in range(0, 12, 3):
            found[:, k : k + 3, k : k + 3] = self.axes
        return found


def geometry(
    ops: Any,
    model: OpenSeesModel,
    lines: Sequence[ElementEntry],
    printed: Printed,
    options: Options,
) -> Geometry:
    """Return places and axes of elements."""
    ndm = model.coordinates.shape[1]
    axes, turn = turning(ndm, options.vertical)
    points = np.zeros((len(model.tags), 3))
    points[:, :ndm] = model.coordinates
    at = {tag: place for place, tag in enumerate(model.tags)}
    ends = np.array([[points[at[tag]] for tag in element.nodes] for element in lines])
    offsets = np.array([_offsets(_transformation(printed, element), ndm) for element in lines])
    start, end = ((ends[:, k] + offsets[:, k]) @ axes.T for k in range(2))
    up = default_up(start, end)
    for k, element in enumerate(lines):
        along = axes.T @ (end[k] - start[k])
        side = [-along[1], along[0], 0.0] if ndm == 2 else ops.eleResponse(element.tag, "yaxis")
        if side:  # no bar has one
            up[k] = axes @ np.cross(along, side)
    own, length = local_axes(start, end, up)
    arms = np.einsum("nab,nkb->nka", own, offsets @ axes.T)
    return Geometry(own, length, arms, np.asarray(np.kron(np.eye(2), turn), dtype=np.float64))


def _transformation(printed: Printed, element: ElementEntry) -> dict[str, Any]:
    tag = str(printed.elements.get(str(element.tag), {}).get("crdTransformation", ""))
    return printed.transformations.get(tag, {})


def _offsets(entry: dict[str, Any], ndm: int) -> FloatArray:
    # From the nodes to the ends, (2, 3).
    found = np.zeros((2, 3))
    for end, word in enumerate(("iOffset", "jOffset")):
        if word in entry:
            found[end, :ndm] = entry[word]
    return found


def stiffnesses(
    ops: Any,
    model: OpenSeesModel,
    lines: Sequence[ElementEntry],
    printed: Printed,
    place: Geometry,
) -> FloatArray:
    """Return the stiffness of elements over the displacements of their nodes.

    Shapes: result (n, 12, 12).
    """
    found = np.zeros((len(lines), 12, 12))
    silent = []
    for k, element in enumerate(lines):
        basic = np.array(ops.eleResponse(element.tag, "basicStiffness") or [], dtype=np.float64)
        if not basic.size:
            silent.append(k)
            continue
        side = round(basic.size**0.5)
        kind = str(_transformation(printed, element).get("type", ""))
        force = ops.eleResponse(element.tag, "basicForce")
        axial = float(force[0]) if kind.startswith(_WITH_P_DELTA) else 0.0
        found[k] = _of_basic(basic.reshape(side, side), float(place.length[k]), axial)
    to_ends = rigid_arms(place.arms) @ place.local()
    found = np.asarray(to_ends.transpose(0, 2, 1) @ found @ to_ends)
    if silent:
        moved = _by_moving(ops, model, [lines[k] for k in silent])
        found[silent] = place.put @ moved @ place.put.T
    return found


def _of_basic(basic: FloatArray, length: float, axial: float) -> FloatArray:
    # Basic forces: of a bar N, in the plane N, Mz at i and j, in space also My at i and j, T.
    to_basic = np.zeros((6, 12))
    to_basic[0, [0, 6]] = -1.0, 1.0
    to_basic[1:3, [1, 7]] = np.array([1.0, -1.0]) / length
    to_basic[3:5, [2, 8]] = np.array([-1.0, 1.0]) / length
    to_basic[1, 5] = to_basic[2, 11] = to_basic[3, 4] = to_basic[4, 10] = 1.0
    to_basic[5, [3, 9]] = -1.0, 1.0
    used = to_basic[: len(basic)]
    found: FloatArray = used.T @ basic @ used
    for v in (1, 2) if len(basic) > 3 else (1,):
        for row, column, sign in ((0, 0, 1.0), (0, 6, -1.0), (6, 0, -1.0), (6, 6, 1.0)):
            found[v + row, v + column] += sign * axial / length
    return found


def _by_moving(ops: Any, model: OpenSeesModel, lines: Sequence[ElementEntry]) -> FloatArray:
    # Stiffness (n, 2 ndf, 2 ndf), in axes and units of the model. Central differences make
    # quadratic terms in the displacements (P-Delta) as exact as linear ones.
    ndf, ndm = model.ndf, model.coordinates.shape[1]
    at = {tag: place for place, tag in enumerate(model.tags)}
    ends = np.array([element.nodes for element in lines])
    span = [model.coordinates[at[j]] - model.coordinates[at[i]] for i, j in ends.tolist()]
    size = float(np.linalg.norm(span, axis=1).mean())
    rest = {tag: list(map(float, ops.nodeDisp(tag))) for tag in set(ends.ravel().tolist())}
    found = np.zeros((len(lines), 2 * ndf, 2 * ndf))

    def forces(tags: Sequence[int], dof: int, by: float) -> FloatArray:
        for tag in tags:
            ops.setNodeDisp(tag, dof + 1, rest[tag][dof] + by)
        return np.array([ops.eleForce(element.tag) for element in lines], dtype=np.float64)

    for tags in _not_joined(lines):
        moved = np.isin(ends, tags)
        for dof in range(ndf):
            step = _STEP * (size if dof < ndm else 1.0)
            ahead, back = forces(tags, dof, step), forces(tags, dof, -step)
            forces(tags, dof, 0.0)
            for end in range(2):
                slope = (ahead - back) / (2.0 * step)
                found[moved[:, end], :, end * ndf + dof] = slope[moved[:, end]]
    return found


def _not_joined(lines: Sequence[ElementEntry]) -> list[list[int]]:
    # Nodes in few groups, no element between two of a group.
    beside: dict[int, set[int]] = {}
    for element in lines:
        i, j = element.nodes
        beside.setdefault(i, set()).add(j)
        beside.setdefault(j, set()).add(i)
    group: dict[int, int] = {}
    for tag in sorted(beside, key=lambda tag: -len(beside[tag])):
        taken = {group[other] for other in beside[tag] if other in group}
        group[tag] = next(k for k in range(len(taken) + 1) if k not in taken)
    count = max(group.values()) + 1
    return [[tag for tag, own in group.items() if own == k] for k in range(count)]


def apart_from_assembled(
    model: OpenSeesModel, lines: Sequence[ElementEntry], found: FloatArray, place: Geometry
) -> set[int]:
    """Return places of elements whose stiffness differs from the one that OpenSees assembles.

    Shapes: found (n, 12, 12).
    """
    ndf = model.ndf
    at = {tag: k for k, tag in enumerate(model.tags)}
    local = place.local()
    groups: dict[tuple[int, int], list[int]] = {}
    for k, element in enumerate(lines):
        i, j = sorted(at[tag] for tag in element.nodes)
        groups.setdefault((i, j), []).append(k)
    compared = {element.tag for element in lines}
    for element in model.elements:
        if element.tag not in compared:
            places = sorted({at[tag] for tag in element.nodes})
            for n, first in enumerate(places):
                for second in places[n + 1 :]:
                    groups.pop((first, second), None)
    bad: set[int] = set()
    for (i, j), those in groups.items():
        turn = local[those[0]][:6, :6] @ place.put[:6, :ndf]
        assembled = model.stiffness[ndf * i : ndf * (i + 1), ndf * j : ndf * (j + 1)].toarray()
        total = np.zeros((6, 6))
        for k in those:
            turned = at[lines[k].nodes[0]] != i
            part = found[k][6:, :6] if turned else found[k][:6, 6:]
            total += local[those[0]][:6, :6] @ part @ local[those[0]][:6, :6].T
        if not _alike(total, turn @ assembled @ turn.T, float(place.length[those[0]])):
            bad.update(those)
    return bad


def _alike(one: FloatArray, other: FloatArray, length: float) -> bool:
    # Entry by entry: bending is soft beside axial stiffness.
    size = np.array([*[1.0] * 3, *[1.0 / length] * 3])
    one, other = (np.outer(size, size) * block for block in (one, other))
    rows, columns = (np.abs(other).max(axis=axis) for axis in (1, 0))
    scale = np.sqrt(np.outer(rows, columns)) + _NONE * np.abs(other).max()
    return bool((np.abs(one - other) <= _APART * scale).all())
