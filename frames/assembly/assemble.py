"""From the frame to matrices: degrees of freedom, stiffness, mass, loads."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse

from frames.assembly.check import check_connections, check_mass, check_restraint
from frames.assembly.constraints import eliminate, free_dofs, separate_massless
from frames.assembly.loads import lumped_masses, permanent_loads, span_end_forces
from frames.assembly.members import (
    at_ends,
    fixed_end_forces,
    local_stiffness,
    member_arrays,
    released,
    rigid_arms,
    spring_stiffness,
)
from frames.assembly.nonlinear import nonlinear_parts
from frames.assembly.system import MemberTable as MemberTable
from frames.assembly.system import PlacedBearing, element_dofs
from frames.assembly.system import System as System
from frames.model.axes import default_up, matrix_to_global, to_local
from frames.model.components import RELEASABLE, bearing_axial_stiffness, bearing_rocking_stiffness
from frames.model.load_combinations import applied_loads
from frames.model.superelement import Placed, element_table, lumped, placed
from lir_element.device.features import Features

if TYPE_CHECKING:
    from collections.abc import Collection

    from frames._types import FloatArray, IntArray, SparseMatrix
    from frames.model.frame_data import FrameData
    from frames.model.load_combinations import AppliedLoads


def assemble(
    frame: FrameData,
    features: Features | None = None,
    with_points: Collection[str] = (),
) -> System:
    """Check a frame and turn it into matrices.

    A model that cannot work is refused with a `ModelError` that names the culprit: nothing to
    compute, parts without connection or support, no mass, or a mechanism (see
    `frames.assembly.check`).
    """
    check_connections(frame)
    features = Features.all() if features is None else features
    names = tuple(frame.nodes)
    index = {name: place for place, name in enumerate(names)}
    coordinates = np.array([node.position for node in frame.nodes.values()], dtype=np.float64)
    applied = applied_loads(frame)
    members = _member_table(frame, index, coordinates, applied)
    own_mass, weighing = lumped_masses(frame, index, members, applied)
    parts = placed(frame.superelements.values(), index)
    node_mass = own_mass + lumped(parts.mass)
    transform, labels = free_dofs(
        frame, coordinates, node_mass, planar=not features.second_direction
    )
    mass = sparse.csr_array(sparse.diags_array(own_mass.ravel()))
    inert = np.ones(len(labels))
    if frame.superelements:
        mass = sparse.csr_array(mass + parts.mass)
        transform, labels, inert = _reduced(transform, labels, parts, mass, coordinates)
    nonlinear = nonlinear_parts(frame, index, coordinates, members)
    node_stiffness = sparse.csr_array(
        _node_stiffness(frame, index, coordinates, members)
        + nonlinear.stiffness()
        + parts.stiffness
    )
    node_load = permanent_loads(frame, index, members, weighing, applied) + parts.load
    translations = np.tile(np.eye(6)[:, :3], (len(names), 1))
    masked = sparse.csr_array(transform @ sparse.diags_array(inert))
    system = System(
        node_names=names,
        coordinates=coordinates,
        dof_labels=labels,
        transform=transform,
        stiffness=_project(transform, node_stiffness),
        mass=_project(masked, mass),
        damping=_project(transform, parts.damping),
        node_mass=node_mass,
        load=np.asarray(transform.T @ node_load),
        inertia_load=np.asarray(masked.T @ (mass @ translations)),
        bearings=tuple(
            PlacedBearing(link.name, index[link.i], index[link.j], link.bearing)
            for link in frame.bearings.values()
        ),
        gravity=frame.gravity,
        node_stiffness=node_stiffness,
        node_load=node_load,
        members=members,
        elements=element_table(
            (part.elements for part in frame.superelements.values()), index, frame.members
        ),
        features=features,
        parts=nonlinear,
    )
    check_mass(system)
    levers = [coordinates[b.j] - coordinates[b.i] for b in system.bearings]
    ends = np.array([(b.i, b.j) for b in system.bearings], dtype=np.int64).reshape(-1, 2)
    pushes = [
        [bearing_axial_stiffness(bearing)] * 3
        + [bearing_rocking_stiffness(bearing) if name in with_points else 0.0] * 3
        for name, _, _, bearing in system.bearings
    ]
    supported = node_stiffness + scatter(
        spring_stiffness(np.array(levers).reshape(-1, 3), np.array(pushes).reshape(-1, 6)),
        ends,
        len(names),
    )
    check_restraint(system, _project(transform, sparse.csr_array(supported)))
    return system


def member_axial_forces(system: System, q: FloatArray) -> FloatArray:
    """Return the axial forces of the members, tension positive.

    Shapes: q (..., n_free), result (..., n_members).
    """
    table = system.members
    u = np.asarray(system.transform @ q.T).T
    ends = (table.follow[:, 6] - table.follow[:, 0])[..., None]
    local = to_local(u[..., table.dofs], table.arrays.axes)
    elongation = (local[..., None, :] @ ends)[..., 0, 0]
    forces: FloatArray = (
        table.arrays.elastic_modulus * table.arrays.area / table.arrays.length * elongation
    )
    return forces


def node_geometric_stiffness(system: System, axial_forces: FloatArray) -> SparseMatrix:
    """Assemble the geometric stiffness of the members over all nodal displacements.

    Shapes: axial_forces (n_members,), result (6 n_nodes, 6 n_nodes).
    """
    table = system.members
    local = table.geometric(axial_forces)
    blocks = matrix_to_global(local, table.arrays.axes)
    return scatter(blocks, table.nodes, len(system.node_names))


def geometric_stiffness(system: System, of_nodes: SparseMatrix) -> SparseMatrix:
    """Return the geometric stiffness over the free DOFs, of that over all nodal displacements.

    Shapes: of_nodes (6 n_nodes, 6 n_nodes), result (n_free, n_free).
    """
    return _project(system.transform, of_nodes)


def member_end_forces(
    system: System,
    u: FloatArray,
    axial_forces: FloatArray | None = None,
    places: IntArray | None = None,
) -> FloatArray:
    """Return the forces on both ends of each member in local axes.

    Shapes: u (..., 6 n_nodes), axial_forces (n_members,), places (n,), result (..., n_members,
    12).
    """
    table = system.members
    stiffness = table.stiffness
    if axial_forces is not None:
        stiffness = stiffness + table.geometric(axial_forces)
    chosen = slice(None) if places is None else places
    local = to_local(u[..., table.dofs[chosen]], table.arrays.axes[chosen])
    forces: FloatArray = np.einsum("mab,...mb->...ma", stiffness[chosen], local)
    return at_ends(forces + table.fixed_end[chosen], table.arms[chosen])


def scatter(blocks: FloatArray, nodes: IntArray, n_nodes: int) -> SparseMatrix:
    """Sum element matrices into a matrix over all nodal displacements.

    Shapes: blocks (n, 12, 12), nodes (n, 2), result (6 n_nodes, 6 n_nodes).
    """
    dofs = element_dofs(nodes)
    rows = np.repeat(dofs, 12, axis=1).ravel()
    columns = np.tile(dofs, (1, 12)).ravel()
    size = 6 * n_nodes
    return sparse.csr_array(sparse.coo_array((blocks.ravel(), (rows, columns)), shape=(size, size)))


def _member_table(
    frame: FrameData, index: dict[str, int], coordinates: FloatArray, applied: AppliedLoads
) -> MemberTable:
    members = tuple(frame.members.values())
    nodes = np.array([(index[m.i], index[m.j]) for m in members], dtype=np.int64).reshape(-1, 2)
    offsets = np.array([m.offsets for m in members], dtype=np.float64).reshape(-1, 2, 3)
    start, end = (coordinates[nodes[:, k]] + offsets[:, k] for k in range(2))
    up = default_up(start, end)
    for place, member in enumerate(members):
        if member.up is not None:
            up[place] = member.up
    arrays = member_arrays([member.section for member in members], start, end, up)
    uniform = frame.uniform_loads  # a new mapping on each access
    load = np.array([uniform.get(m.name, np.zeros(3)) for m in members])
    elastic = local_stiffness(arrays)
    places = {name: 3 + k for k, name in enumerate(RELEASABLE)}
    free = [
        [6 * end + places[part] for end in (0, 1) for part in member.releases[end]]
        for member in members
    ]
    arms = np.einsum("nab,nkb->nka", arrays.axes, offsets)
    follow = released(elastic, free) @ rigid_arms(arms)
    back = follow.transpose(0, 2, 1)
    rows = {name: row for row, name in enumerate(frame.members)}
    forces = fixed_end_forces(arrays, load.reshape(-1, 3))
    forces += span_end_forces(arrays, rows, applied.spans)
    return MemberTable(
        names=tuple(frame.members),
        arrays=arrays,
        nodes=nodes,
        offsets=offsets,
        arms=arms,
        follow=follow,
        stiffness=back @ elastic @ follow,
        fixed_end=np.einsum("nab,nb->na", back, forces),
    )


def _node_stiffness(
    frame: FrameData, index: dict[str, int], coordinates: FloatArray, members: MemberTable
) -> SparseMatrix:
    springs = tuple(frame.springs.values())
    ends = np.array([(index[s.i], index[s.j]) for s in springs], dtype=np.int64).reshape(-1, 2)
    lever = coordinates[ends[:, 1]] - coordinates[ends[:, 0]]
    values = np.array([s.stiffness for s in springs]).reshape(-1, 6)
    blocks = np.concatenate(
        [
            matrix_to_global(members.stiffness, members.arrays.axes),
            spring_stiffness(lever, values),
        ]
    )
    return scatter(blocks, np.concatenate([members.nodes, ends]), len(index))


def _reduced(
    transform: SparseMatrix,
    labels: tuple[str, ...],
    parts: Placed,
    mass: SparseMatrix,
    coordinates: FloatArray,
) -> tuple[SparseMatrix, tuple[str, ...], FloatArray]:
    # The superelements' ties eliminated, and displacements without mass apart from the rest;
    # besides, 1 for each displacement with mass and 0 for each without.
    extent = float(np.linalg.norm(np.ptp(coordinates, axis=0))) or 1.0
    turns = np.array([label.rsplit(" ", 1)[1].startswith("r") for label in labels])
    scale = np.where(turns, 1.0 / extent, 1.0)
    kept, follow = eliminate(sparse.csr_array(parts.equations @ transform), scale)
    labels = tuple(labels[place] for place in kept)
    transform = sparse.csr_array(transform @ follow)
    turn, massless = separate_massless(_project(transform, mass), labels)
    inert = np.ones(len(labels))
    inert[massless] = 0.0
    return sparse.csr_array(transform @ turn), labels, inert


def _project(transform: SparseMatrix, matrix: SparseMatrix) -> SparseMatrix:
    # transform.T @ matrix @ transform, exactly symmetric.
    if not matrix.nnz:
        return sparse.csr_array((transform.shape[1], transform.shape[1]))
    product = sparse.csr_array(transform.T @ matrix @ transform)
    return sparse.csr_array(0.5 * (product + product.T))
