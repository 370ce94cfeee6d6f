"""Forces in the structure, from the displacements of a time history: members, storeys, supports.

Elastic forces are linear in the recorded displacements, and the nonlinear ones are recorded: a run
needs to keep nothing else.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from scipy import sparse

from frames._errors import ModelError
from frames.assembly.assemble import (
    assemble,
    member_axial_forces,
    member_end_forces,
    node_geometric_stiffness,
)
from frames.assembly.members import at_ends
from frames.assembly.nonlinear import with_axial_forces
from frames.assembly.system import element_dofs
from frames.model.axes import to_local
from frames.model.components import DOFS
from frames.recording.nonlinear_results import forces_beyond
from frames.recording.section_cuts import storey_feet
from frames.results.envelopes import envelope
from frames.results.recorded import noted, require_recorded, require_steps
from frames.statics.springs import first_displacement
from lir_element.argument_checks import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import BoolArray, FloatArray, IntArray
    from frames.assembly.system import System
    from frames.model.components import Level
    from frames.model.frame_data import FrameData

COMPONENTS = ("N", "Vy", "Vz", "T", "My", "Mz")
"""End forces of a member along and about its local axes x, y, z."""

_AT_ONCE = 50
"""Members whose histories `force_tables` holds at a time."""


class _Structure(NamedTuple):
    # A frame as it was analysed, and its displacements under a time history.
    system: System
    axial: FloatArray  # (n_members,) of permanent loads, tension positive [N]
    data: xr.Dataset
    u: FloatArray  # (time, 6 n_nodes)
    beyond: FloatArray  # (time, m) forces of nonlinear parts besides the elastic ones


def member_forces(
    model: FrameData, data: xr.Dataset, members: Sequence[str] | None = None
) -> xr.DataArray:
    """Return the end forces of members over a time history.

    Parameters
    ----------
    model : Frame
        The model that was analysed.
    data : xarray.Dataset
        Result of `time_history`, also one that was saved and loaded.
    members : sequence of str, optional
        Names, also of line elements of superelements ("element-12" of an OpenSees model); all of
        them if None.

    Returns
    -------
    xarray.DataArray
        (time, member, end i and j, component N, Vy, Vz, T, My, Mz) [N, N m]: forces and moments on
        the ends of the member (the faces of its rigid end zones, if it has some), positive along
        and about its local axes, permanent loads included. So a compressed member has N > 0 at end
        i and N < 0 at end j. Second-order effects are those of the analysis: the permanent axial
        forces' geometric stiffness.

    Raises
    ------
    ModelError
        If the model is not the analysed one, or does not have the member.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion, member_forces, moment_frame, time_history
    >>> from frames.demo import bearing_for
    >>> frame = moment_frame((1, 1), 1, bearing=bearing_for(400e3))
    >>> data = time_history(frame, GroundMotion(x=np.ones(11), dt=0.01))
    >>> forces = member_forces(frame, data, ["column-1-0-0"])
    >>> forces.dims, forces["component"].values.tolist()
    (('time', 'member', 'end', 'component'), ['N', 'Vy', 'Vz', 'T', 'My', 'Mz'])
    """
    found = _structure(model, data)
    names = _names(found.system)
    chosen = names if members is None else tuple(members)
    unknown = [name for name in chosen if name not in names]
    if unknown:
        msg = f'members: no member "{unknown[0]}" in {model.name}; its members: {listed(names, 4)}'
        raise ModelError(msg)
    return _member_forces(found, chosen)


def support_reactions(model: FrameData, data: xr.Dataset) -> xr.DataArray:
    """Return the forces of the supports on the structure over a time history [N, N m].

    Parameters
    ----------
    model : Frame
        The model that was analysed.
    data : xarray.Dataset
        Result of `time_history`, also one that was saved and loaded.

    Returns
    -------
    xarray.DataArray
        (time, support, dof) [N, N m] at the fixed nodes, along and about the global axes: the
        forces on the structure, permanent loads included; NaN if a DOF is free. The inertia of
        masses placed on fixed nodes is the ground's.

    Raises
    ------
    ModelError
        If the model is not the one that was analysed.

    Examples
    --------
    >>> from frames import support_reactions, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example(1.0, storeys=2)
    >>> data = time_history(frame, pulse)
    >>> reactions = support_reactions(frame, data)
    >>> reactions.dims
    ('time', 'support', 'dof')
    """
    return _support_reactions(_structure(model, data))


def storey_forces(model: FrameData, data: xr.Dataset) -> xr.DataArray:
    """Return storey shears, overturning moments and torsion over a time history.

    Parameters
    ----------
    model : Frame
        The analysed model; its levels are the limits of storeys.
    data : xarray.Dataset
        Result of `time_history`, also one that was saved and loaded.

    Returns
    -------
    xarray.DataArray
        (time, storey, component) [N, N m]: forces of the part above a cut on the part below,
        positive with positive displacement as `base_shear` is. The components are Vx, Vy (storey
        shears), Fz (negative under weight), Mx, My (overturning) and Mz (torsion), moments about
        the middle of the nodes of the level below. A storey has the name of the level on top of it
        and is cut at its foot. The first one is under the lowest level and contains the bearings;
        its moments are about the middle of that level, which moves with it. Dampers of the
        structure (`Frame.damping`) add their forces.

    Raises
    ------
    ModelError
        If the model has no level, or is not the one that was analysed.

    Examples
    --------
    >>> from frames import storey_forces, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example(1.0, storeys=2)
    >>> data = time_history(frame, pulse)
    >>> forces = storey_forces(frame, data)
    >>> forces["storey"].values.tolist(), forces["component"].values.tolist()
    (['base', 'floor-1', 'floor-2'], ['Vx', 'Vy', 'Fz', 'Mx', 'My', 'Mz'])
    """
    found = _structure(model, data)
    if not model.levels:
        msg = f"{model.name} has no level: storeys need Frame.add_level for each floor"
        raise ModelError(msg)
    return _storey_forces(found, model.levels)


def force_tables(model: FrameData, data: xr.Dataset) -> dict[str, pd.DataFrame]:
    """Return the envelopes of all forces in the structure as tables.

    Parameters
    ----------
    model : Frame
        The model that was analysed.
    data : xarray.Dataset
        Result of `time_history`, also one that was saved and loaded.

    Returns
    -------
    dict of str to pandas.DataFrame
        "members" (member, end, component), "storeys" (storey, component) and "supports"
        (support, dof), as far as the model has them: `largest`, `smallest` [N, N m], and the time
        of each [s], over the steps that were recorded. `write_tables` writes them.

    Raises
    ------
    ModelError
        If the model is not the one that was analysed.
    ValueError
        If the recording has the first and the last step only.

    Examples
    --------
    >>> from frames import force_tables, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example(1.0, storeys=2)
    >>> data = time_history(frame, pulse)
    >>> sorted(force_tables(frame, data))
    ['storeys', 'supports']
    """
    require_steps(data, "force_tables")
    found = _structure(model, data)
    names = _names(found.system)
    parts = {
        "members": [  # by and by: histories of all would fill the memory
            envelope(_member_forces(found, names[first : first + _AT_ONCE]))
            for first in range(0, len(names), _AT_ONCE)
        ],
        "storeys": [envelope(_storey_forces(found, model.levels))] if model.levels else [],
        "supports": [envelope(_support_reactions(found))],
    }
    return {
        name: pd.concat([each.to_dataframe() for each in some]).dropna()
        for name, some in parts.items()
        if some
    }


def require_own(model: FrameData, system: System, data: xr.Dataset) -> None:
    """Raise a ModelError unless a result was computed with a model, assembled as `system`."""
    if "node_displacement" not in data:
        msg = (
            "data has no node_displacement: pass the Dataset of a time_history of this "
            "model that recorded it"
        )
        raise ModelError(msg)
    if "nodes_of_level" in data:
        msg = (
            f"data holds {data.sizes['node']} of {len(system.node_names)} nodes, but forces "
            "in the structure need all: record all nodes"
        )
        raise ModelError(msg)
    if tuple(str(name) for name in data["node"].to_numpy()) != system.node_names:
        msg = (
            f"data was not computed with this model: it has {data.sizes['node']} nodes "
            f"({listed(data['node'].to_numpy(), 4)}), {model.name} has "
            f"{len(system.node_names)} ({listed(system.node_names, 4)}): pass the model of "
            "that time_history"
        )
        raise ModelError(msg)


def _structure(model: FrameData, data: xr.Dataset) -> _Structure:
    system = assemble(model)
    require_own(model, system, data)
    u = data["node_displacement"].transpose("time", "node", "dof").to_numpy()
    axial = member_axial_forces(system, first_displacement(system, _with_points(data)))
    system = replace(system, parts=with_axial_forces(system.parts, system.members, axial))
    beyond = forces_beyond(system, data)
    return _Structure(system, axial, data, u.reshape(len(u), -1), beyond)


def _with_points(data: xr.Dataset) -> list[str]:
    # Bearings at the level 'contact'; the others have no bodies.
    at = str(data.attrs.get("level", ""))
    if "contact" in at or "rigid_body" in at:
        require_recorded(data, "forces in the structure", "body_position")
    if "body_position" not in data:
        return []
    bodies = data["body_position"].isel(time=0).transpose("bearing", ...).to_numpy()
    has = np.isfinite(bodies.reshape(len(bodies), -1)).all(axis=1)
    return [str(name) for name in data["bearing"].to_numpy()[has]]


def _member_forces(found: _Structure, chosen: tuple[str, ...]) -> xr.DataArray:
    names, count = _names(found.system), len(found.system.members.names)
    place = np.array([names.index(name) for name in chosen], dtype=np.int64)
    own = place < count
    forces = np.zeros((len(found.u), len(chosen), 12))
    forces[:, own] = member_end_forces(found.system, found.u, found.axial, place[own])
    forces[:, ~own] = _element_forces(found, place[~own] - count)
    for row, name in enumerate(chosen):
        if name in found.system.parts.hinged:
            forces[:, row] += _hinge_share(found, name)
    return xr.DataArray(
        np.ascontiguousarray(forces.reshape(*forces.shape[:2], 2, 6)),
        dims=("time", "member", "end", "component"),
        coords={
            "time": found.data["time"],
            "member": list(chosen),
            "end": ["i", "j"],
            "component": list(COMPONENTS),
        },
        attrs={"units": "N, N m", "long_name": "end forces in local axes"} | noted(found.data),
        name="member_forces",
    )


def _names(system: System) -> tuple[str, ...]:
    return system.members.names + system.elements.names


def _element_forces(found: _Structure, places: IntArray) -> FloatArray:
    # Forces of line elements of superelements.
    table = found.system.elements
    u = found.u[:, element_dofs(table.nodes[places])]
    forces: FloatArray = np.einsum("nab,tnb->tna", table.rows[places], u) + table.rest[places]
    return forces


def _hinge_share(found: _Structure, member: str) -> FloatArray:
    # Reduction of a member's end forces by its hinges, in local axes.
    parts, table = found.system.parts, found.system.members
    k = len(parts.links) + parts.hinged.index(member)
    at = slice(parts.first[k], parts.first[k + 1])
    row = table.names.index(member)
    nodal = np.asarray(parts.node_rows[at].T @ found.beyond[:, at].T).T[:, table.dofs[row]]
    local = to_local(nodal[:, None], table.arrays.axes[[row]])
    return at_ends(local, table.arms[[row]])[:, 0]


def _support_reactions(found: _Structure) -> xr.DataArray:
    system = found.system
    stiffness = sparse.csr_array(
        system.node_stiffness + node_geometric_stiffness(system, found.axial)
    )
    fixed = system.fixed_dofs
    forces = np.asarray(stiffness[fixed] @ found.u.T).T - system.node_load[fixed]
    forces += np.asarray(system.parts.node_rows[:, fixed].T @ found.beyond.T).T
    every = np.ones((len(system.bearings), 2), dtype=bool)
    forces += _bearing_ends(found, every)[:, fixed]
    nodes, row = np.unique(fixed // 6, return_inverse=True)
    values = np.full((len(found.u), len(nodes), 6), np.nan)
    values[:, row, fixed % 6] = forces
    return xr.DataArray(
        values,
        dims=("time", "support", "dof"),
        coords={
            "time": found.data["time"],
            "support": [system.node_names[node] for node in nodes],
            "dof": list(DOFS),
        },
        attrs={"units": "N, N m", "long_name": "forces of the supports on the structure"}
        | noted(found.data),
        name="support_reactions",
    )


def _storey_forces(found: _Structure, levels: tuple[Level, ...]) -> xr.DataArray:
    system = found.system
    values = np.zeros((len(found.u), len(levels), 6))
    for k, (cut, lower, upper) in enumerate(storey_feet(system, found.axial, levels)):
        values[:, k] = -np.asarray((lower @ cut.rows) @ found.u.T).T - lower @ cut.constant
        values[:, k] -= np.asarray((lower @ system.parts.node_rows.T) @ found.beyond.T).T
        upper_ends = np.column_stack([np.zeros_like(cut.crossed), cut.crossed])
        values[:, k] += np.asarray(upper @ _bearing_ends(found, upper_ends).T).T
    return xr.DataArray(
        values,
        dims=("time", "storey", "component"),
        coords={
            "time": found.data["time"],
            "storey": [level.name for level in levels],
            "component": ["Vx", "Vy", "Fz", "Mx", "My", "Mz"],
        },
        attrs={"units": "N, N m", "long_name": "forces that storeys pass on downwards"}
        | noted(found.data),
        name="storey_forces",
    )


def _bearing_ends(found: _Structure, chosen: BoolArray) -> FloatArray:
    # Forces of the nodes on the chosen ends (n_bearings, 2) of bearings, (time, 6 n_nodes).
    system, data = found.system, found.data
    require_recorded(data, "forces of bearings", "bearing_force", "bearing_moment")
    if data.sizes["bearing"] != len(system.bearings):
        msg = (
            f"data holds {data.sizes['bearing']} of {len(system.bearings)} bearings, but "
            "forces of storeys and supports need all: record all bearings"
        )
        raise ModelError(msg)
    force = data["bearing_force"].transpose("time", "bearing", "axis").to_numpy()
    moment = data["bearing_moment"].transpose("time", "bearing", "end", "axis").to_numpy()
    total = np.zeros((len(force), 6 * len(system.node_names)))
    for b, (_, i, j, _) in enumerate(system.bearings):
        for end, (node, sign) in enumerate(((i, -1.0), (j, 1.0))):
            if chosen[b, end]:
                total[:, 6 * node : 6 * node + 3] += sign * force[:, b]
                total[:, 6 * node + 3 : 6 * node + 6] += moment[:, b, end]
    return total
