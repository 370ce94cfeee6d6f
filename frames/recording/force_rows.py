"""Forces in members, storeys and under bearings as rows over the recorded quantities.

Elastic forces are linear in the displacements, and the nonlinear ones are recorded: a matrix and a
constant give the forces at any step.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import sparse

from frames.assembly.members import at_ends
from frames.assembly.system import element_dofs
from frames.model.components import TaperedLoad
from frames.model.load_combinations import SpanLoad, applied_loads
from frames.recording.section_cuts import storey_feet

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray, IntArray, SparseMatrix
    from frames.assembly.system import MemberTable, System
    from frames.bundles.run_data import Output
    from frames.model.components import Level
    from frames.model.frame_data import FrameData
    from frames.statics.gravity_state import GravityState
    from lir_element.layout import Records

MEMBER_FORCES = ("N", "Vy", "Vz", "T", "My", "Mz")
"""Forces at a section of a member, along and about its local axes."""

STOREY_FORCES = ("Vx", "Vy", "Fz", "Mx", "My", "Mz")
"""Forces that a storey transfers downwards, along and about the global axes."""

REACTIONS = ("N", "Vx", "Vy", "Mx", "My", "Mz")
"""Forces of a bearing on the parts below and above it: N presses, the others along the axes."""

STATIONS = ("i", "mid", "j")
"""Sections of a member: its ends, and the middle of the length between them."""

SIDES = ("below", "above")
"""Sides of a bearing: the part below, and the part above."""

_SIX = len(MEMBER_FORCES)
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)  # exact to degree 5: load 1, lever 1


class ForceKind(NamedTuple):
    """Sections of one kind, six forces each, one after the other among all rows."""

    name: str  # "member", "storey", "reaction"
    dims: tuple[str, ...]
    labels: tuple[tuple[str, ...], ...]  # along each dimension
    components: tuple[str, ...]
    meaning: str

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of sections along each dimension."""
        return tuple(len(each) for each in self.labels)


class ForceMaps(NamedTuple):
    """Forces at sections: ``rows @ (q, beyond, forces of bearings) + rest``, six a section."""

    kinds: tuple[ForceKind, ...]  # the sections
    # (6 n_sections, n_q + m + 12 n_bearings) over those displacements that are needed, forces of
    # nonlinear parts besides the elastic ones, and forces of bearings on nodes i and j
    rows: SparseMatrix
    rest: FloatArray  # (6 n_sections,) of loads along members [N, N m]
    expand: FloatArray  # (n_q, n_x) these displacements over ``x = (b, eta, beyond)``
    offset: FloatArray  # (n_q,) and their constant

    def of(self, out: Output, states: Records, rows: slice) -> FloatArray:
        """Return the forces at recorded steps.

        Shapes: result (n_sections, 6, n_steps).
        """
        beyond, force = out.beyond[rows], states["force"][rows]
        x = np.hstack([out.b[rows], out.e[rows], beyond])
        q = self.expand[:, : x.shape[1]] @ x.T + self.offset[:, None]
        known = np.vstack([q, beyond.T, force.reshape(len(force), -1).T])
        found = np.asarray(self.rows @ known) + self.rest[:, None]
        return found.reshape(-1, _SIX, len(force))


class _Rows(NamedTuple):
    # One kind of forces, over all free displacements, forces beyond and forces of bearings.
    q: SparseMatrix
    beyond: SparseMatrix
    bearings: SparseMatrix
    rest: FloatArray


def force_maps(model: FrameData, state: GravityState) -> ForceMaps:
    """Return the maps from the recorded quantities of a structure to its forces."""
    system, axial = state.system, state.member_forces
    names = tuple(placed.name for placed in system.bearings)
    levels = tuple(level.name for level in model.levels)
    kinds = (
        ForceKind(
            "member",
            ("member", "station"),
            (system.members.names + system.elements.names, STATIONS),
            MEMBER_FORCES,
            "force of the part towards end j on the part towards end i",
        ),
        ForceKind(
            "storey",
            ("section",),
            (levels,),
            STOREY_FORCES,
            "force that what is above the foot of a storey passes on",
        ),
        ForceKind(
            "reaction",
            ("bearing", "side"),
            (names, SIDES),
            REACTIONS,
            "force of the bearing on what is below and above it",
        ),
    )
    parts = (
        _member_rows(model, system, axial),
        _element_rows(system),
        _storey_rows(system, axial, model.levels),
        _reaction_rows(system),
    )
    over_q = sparse.csr_array(sparse.vstack([part.q for part in parts]))
    over_q.eliminate_zeros()
    used, place = np.unique(over_q.indices, return_inverse=True)
    over_q = sparse.csr_array(
        (over_q.data, place, over_q.indptr), shape=(over_q.shape[0], len(used))
    )
    besides = [
        sparse.vstack([getattr(part, name) for part in parts]) for name in ("beyond", "bearings")
    ]
    basis = state.basis
    whole = np.hstack([basis.expand_b, basis.expand_e])
    if state.parts is not None:
        whole = np.hstack([whole, -state.part_shift])
    return ForceMaps(
        kinds=kinds,
        rows=sparse.csr_array(sparse.hstack([over_q, *besides])),
        rest=np.concatenate([part.rest for part in parts]),
        expand=np.ascontiguousarray(whole[used]),
        offset=basis.offset[used],
    )


def _sections() -> FloatArray:
    # At end i the opposite of the force on it, at end j that force; in the middle the mean of the
    # equilibrium from either end.
    section, own = np.zeros((3 * _SIX, 12)), np.eye(_SIX)
    section[:_SIX, :_SIX], section[2 * _SIX :, _SIX:] = -own, own
    section[_SIX : 2 * _SIX, :_SIX], section[_SIX : 2 * _SIX, _SIX:] = -0.5 * own, 0.5 * own
    return section


_SECTIONS = _sections()


def element_sections(system: System, kept: Sequence[int]) -> tuple[SparseMatrix, FloatArray]:
    """Return the forces at the sections of line elements of superelements.

    Shapes: result (18 n, n_free).
    """
    table, at = system.elements, np.array(kept, dtype=np.int64)
    count, height = len(at), 3 * _SIX
    blocks = _SECTIONS @ table.rows[at]
    row = np.repeat(np.arange(height * count), 12)
    column = np.repeat(element_dofs(table.nodes[at]), height, axis=0).ravel()
    size = (height * count, 6 * len(system.node_names))
    over_u = sparse.csr_array(sparse.coo_array((blocks.ravel(), (row, column)), shape=size))
    rest = table.rest[at] @ _SECTIONS.T
    rest[:, _SIX : 2 * _SIX] += table.middle[at]
    return sparse.csr_array(over_u @ system.transform), rest.ravel()


def _element_rows(system: System) -> _Rows:
    # The line elements of superelements in the same way.
    over_q, rest = element_sections(system, range(len(system.elements.names)))
    return _Rows(
        q=over_q,
        beyond=sparse.csr_array((len(rest), system.parts.node_rows.shape[0])),
        bearings=sparse.csr_array((len(rest), 12 * len(system.bearings))),
        rest=rest,
    )


def _member_rows(model: FrameData, system: System, axial: FloatArray) -> _Rows:
    table, bearings = system.members, len(system.bearings)
    count, deformations = len(table.names), system.parts.node_rows.shape[0]
    eye = np.tile(np.eye(12)[:, None], (1, count, 1))
    to_ends = at_ends(eye, table.arms).transpose(1, 2, 0)
    to_sections = _SECTIONS @ to_ends  # (n, 18, 12)
    turned = np.zeros((count, 12, 12))
    for k in range(4):
        turned[:, 3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = table.arrays.axes
    blocks = to_sections @ (table.stiffness + table.geometric(axial)) @ turned
    row = np.repeat(np.arange(3 * _SIX * count), 12)
    column = np.repeat(table.dofs, 3 * _SIX, axis=0).ravel()
    size = (3 * _SIX * count, 6 * len(system.node_names))
    over_u = sparse.csr_array(sparse.coo_array((blocks.ravel(), (row, column)), shape=size))
    over_beyond = sparse.lil_array((size[0], deformations))
    parts = system.parts
    node_rows = sparse.csr_array(parts.node_rows)
    for k, name in enumerate(parts.hinged, start=len(parts.links)):
        at, m = slice(parts.first[k], parts.first[k + 1]), table.names.index(name)
        nodal = node_rows[at].toarray()[:, table.dofs[m]].T
        share = to_sections[m] @ turned[m] @ nodal
        over_beyond[3 * _SIX * m : 3 * _SIX * (m + 1), at] = share
    rest = np.einsum("nab,nb->na", to_sections, table.fixed_end)
    rest[:, _SIX : 2 * _SIX] += between_ends(model, table)
    return _Rows(
        q=sparse.csr_array(over_u @ system.transform),
        beyond=sparse.csr_array(over_beyond),
        bearings=sparse.csr_array((size[0], 12 * bearings)),
        rest=rest.ravel(),
    )


def between_ends(model: FrameData, table: MemberTable, share: float = 0.5) -> FloatArray:
    """Return the forces of loads along members between their ends.

    Shapes: result (n, 6).
    """
    place = {name: k for k, name in enumerate(table.names)}
    spans = [
        SpanLoad(name, _uniform(load, float(table.arrays.length[place[name]])), 0.0)
        for name, load in model.uniform_loads.items()
    ]
    found = np.zeros((len(table.names), _SIX))
    for member, load, _ in (*spans, *applied_loads(model).spans):
        k = place[member]
        axes, length = table.arrays.axes[k], float(table.arrays.length[k])
        start, end = axes @ np.asarray(load.start), axes @ np.asarray(load.end)
        middle = share * length
        pieces = [load.a, *([middle] if load.a < middle < load.b else []), load.b]
        for first, last in pairwise(pieces):
            at = first + 0.5 * (1.0 + _POINTS) * (last - first)
            along = (at - load.a) / (load.b - load.a)
            force = (0.5 * _WEIGHTS * (last - first))[:, None] * (
                start + along[:, None] * (end - start)
            )
            beyond = np.where(at > middle, share, share - 1.0)[:, None]
            found[k, :3] += (beyond * force).sum(axis=0)
            lever = np.where(at > middle, share * (length - at), (1.0 - share) * at)
            found[k, 4] += lever @ force[:, 2]
            found[k, 5] -= lever @ force[:, 1]
    return found


def _uniform(load: FloatArray, length: float) -> TaperedLoad:
    x, y, z = load.tolist()
    return TaperedLoad(0.0, length, (x, y, z), (x, y, z), "")


def _storey_rows(system: System, axial: FloatArray, levels: Sequence[Level]) -> _Rows:
    bearings, deformations = len(system.bearings), system.parts.node_rows.shape[0]
    q = [sparse.csr_array((0, system.transform.shape[1]))]
    beyond = [sparse.csr_array((0, deformations))]
    under, rest = [sparse.csr_array((0, 12 * bearings))], [np.zeros(0)]
    for cut, lower, upper in storey_feet(system, axial, levels):
        q.append(sparse.csr_array(-(lower @ cut.rows @ system.transform)))
        beyond.append(sparse.csr_array(-(lower @ system.parts.node_rows.T)))
        rest.append(-np.asarray(lower @ cut.constant))
        through = np.zeros((_SIX, 12 * bearings))
        dense = upper.toarray()
        for b, placed in enumerate(system.bearings):
            if cut.crossed[b]:
                node = slice(6 * placed.j, 6 * placed.j + 6)
                through[:, 12 * b + 6 : 12 * b + 12] = dense[:, node]
        under.append(sparse.csr_array(through))
    return _Rows(
        sparse.csr_array(sparse.vstack(q)),
        sparse.csr_array(sparse.vstack(beyond)),
        sparse.csr_array(sparse.vstack(under)),
        np.concatenate(rest),
    )


def _reaction_rows(system: System) -> _Rows:
    # The opposite of the bearing's forces on its nodes; N positive if it presses.
    bearings = len(system.bearings)
    sign = -np.ones((2, _SIX))  # in the order of a node's displacements
    sign[0, 2] = 1.0
    order: IntArray = np.array([2, 0, 1, 3, 4, 5])
    row = np.arange(12 * bearings)
    column = (np.arange(2 * bearings)[:, None] * _SIX + order).ravel()
    values = np.tile(sign[:, order].ravel(), bearings)
    size = 12 * bearings
    return _Rows(
        sparse.csr_array((size, system.transform.shape[1])),
        sparse.csr_array((size, system.parts.node_rows.shape[0])),
        sparse.csr_array((values, (row, column)), shape=(size, size)),
        np.zeros(size),
    )
