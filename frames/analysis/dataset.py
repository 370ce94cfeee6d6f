"""From recorded arrays to the labelled Dataset."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from frames.analysis.static import expand
from frames.analysis.yielding import part_variables
from frames.assembly.assemble import node_geometric_stiffness
from frames.assembly.basis import bearing_rows
from frames.kernel_data import ENERGY_TERMS, device_records
from frames.model.parts import DOFS
from lir_element.results.dataset import (
    bearing_coordinates,
    bearing_variables,
    device_variables,
    labelled,
    some_bodies,
)
from lir_element.results.eccentricity import interface_eccentricity

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray
    from frames.analysis.static import GravityState
    from frames.assembly.assemble import System
    from frames.kernel_data import Ground, Output
    from frames.model.contents import FrameContents
    from frames.motion.ground_motion import GroundMotion
    from lir_element.layout import Records


def build_dataset(
    frame: FrameContents,
    state: GravityState,
    shaking: Ground,
    peak: FloatArray,
    out: Output,
    states: Records,
    bodies: Records,
    count: int,
) -> xr.Dataset:
    """Put the first `count` recorded steps into a Dataset (docs/results.md).

    Parameters
    ----------
    frame : Frame
        The model.
    state : GravityState
        The state the run started from, and the run.
    shaking : Ground
        The ground motion as the loop integrated it.
    peak : ndarray, (3,)
        Peak velocities of the motion as it was given [m/s].
    out, states : Output, records
        What was recorded.
    count : int
        Number of recorded steps.

    Returns
    -------
    xarray.Dataset
        Without attributes.
    """
    system, basis = state.system, state.basis
    q = expand(basis, out.b[:count], out.e[:count])
    if state.parts is not None:
        q -= out.beyond[:count] @ state.part_shift.T
    # what lags without mass has a velocity, but no acceleration of use
    a = expand(basis, out.a_b[:count], basis.mass_e * out.a_e[:count], offset=False)
    shape = (count, len(system.node_names), 6)
    displacement = np.asarray(system.transform @ q.T).T.reshape(shape)
    acceleration = np.asarray(system.transform @ a.T).T.reshape(shape).copy()
    ground = ground_at(shaking, out.time[:count])
    acceleration[..., :3] += ground[:, None, :]
    velocity = _bearing_velocity(state, out.v_b[:count])
    variables = bearing_variables("time", states[:count], velocity)
    if state.contacts is not None:
        variables |= some_bodies("time", state.contacts.row, states[:count], bodies[:count])
    node = ("time", "node", "dof")
    grounded = np.isin([6 * i for _, i, _, _ in system.bearings], _fixed_dofs(system))
    forces = states["force"][:count, grounded, 6:9].sum(axis=1)
    forces += _other_reactions(state, displacement, out.beyond[:count])
    variables |= _device_variables(system)
    more, names = part_variables(system.parts, frame, out, count)
    variables |= more
    variables |= {
        "interface_eccentricity": labelled(
            ("time", "bearing"),
            interface_eccentricity(state.model.props, states[:count]),
            "m",
            "offset of the resultant between the sliders from their axes, the larger; 0 lifted",
        ),
        "peak_ground_velocity": labelled(
            ("axis",), peak, "m/s", "largest velocity of the ground, also of a direction left out"
        ),
        "node_position": labelled(
            ("node", "axis"), system.coordinates.copy(), "m", "place of the node, undeformed"
        ),
        "node_displacement": labelled(
            node, displacement, "m, rad", "displacement relative to the ground"
        ),
        "node_acceleration": labelled(
            node, acceleration, "m/s2, rad/s2", "total acceleration, ground included"
        ),
        "ground_acceleration": labelled(("time", "axis"), ground, "m/s2", "ground acceleration"),
        "base_shear": labelled(
            ("time", "axis"),
            forces,
            "N",
            "resisting force of the ground: bearings on it, and other supports",
        ),
        "energy": labelled(
            ("time", "term"), out.energy[:count].copy(), "J", "energy since gravity"
        ),
        "weight": labelled(
            (), float(-system.node_load[2::6].sum()), "N", "permanent vertical load"
        ),
        "static_axial_force": labelled(
            ("bearing",), state.axial_forces, "N", "axial force under permanent loads"
        ),
        "level_height": labelled(
            ("level",), np.array([lv.z for lv in frame.levels]), "m", "elevation of the level"
        ),
        "level_node": labelled(
            ("node",),
            _levels_of_nodes(frame, system.node_names),
            "1",
            "place of the node's level, -1 for none",
        ),
    }
    coordinates = {
        "time": labelled(("time",), out.time[:count].copy(), "s", "time"),
        "node": list(system.node_names),
        "dof": list(DOFS),
        "term": list(ENERGY_TERMS),
        "level": [lv.name for lv in frame.levels],
        **names,
        **bearing_coordinates([name for name, _, _, _ in system.bearings]),
    }
    return xr.Dataset(variables, coordinates)


def ground_at(ground: Ground, time: FloatArray) -> FloatArray:
    """Return the ground acceleration (n, 3) at `time`, linear between samples, zero after."""
    samples = np.arange(len(ground.acceleration))
    place = time / ground.dt
    columns = [np.interp(place, samples, ground.acceleration[:, axis]) for axis in range(3)]
    shaking = place < samples[-1] + 1e-9  # the time loop's own bound
    found: FloatArray = np.column_stack(columns) * shaking[:, None]
    return found


def peak_velocity(motion: GroundMotion, end: float) -> FloatArray:
    """Return the largest ground velocity (3,) up to the time `end` [m/s]."""
    a = motion.components[: max(round(end / motion.dt), 1) + 1]
    velocity = np.cumsum(0.5 * (a[1:] + a[:-1]), axis=0) * motion.dt
    return np.asarray(np.abs(velocity).max(axis=0, initial=0.0), dtype=np.float64)


def _device_variables(system: System) -> dict[str, xr.Variable]:
    variables = device_variables(device_records(system))
    ends = np.array([(i, j) for _, i, j, _ in system.bearings], dtype=np.int64)
    variables["bearing_node"] = labelled(
        ("bearing", "end"), ends, "1", "place of the node among the nodes"
    )
    return variables


def _bearing_velocity(state: GravityState, v_b: FloatArray) -> FloatArray:
    # Velocity of node j relative to node i, (n, n_bearings, 3).
    rows = bearing_rows(state.system)[:, state.basis.bearing_dofs]
    v = np.asarray(rows @ v_b.T).T.reshape(len(v_b), -1, 12)
    relative: FloatArray = v[..., 6:9] - v[..., :3]
    return relative


def _fixed_dofs(system: System) -> IntArray:
    return np.flatnonzero(np.diff(system.transform.indptr) == 0)


def _other_reactions(
    state: GravityState, displacement: FloatArray, beyond: FloatArray
) -> FloatArray:
    # What supports of the structure itself resist (members on the ground), signed as bearing forces
    # are: positive with positive displacement of the structure.
    system = state.system
    fixed = _fixed_dofs(system)
    fixed = fixed[fixed % 6 < 3]
    flat = displacement.reshape(len(displacement), -1)
    stiffness = system.node_stiffness + node_geometric_stiffness(system, state.member_forces)
    forces = system.node_load[fixed] - np.asarray(stiffness[fixed] @ flat.T).T
    forces -= np.asarray(system.parts.node_rows[:, fixed].T @ beyond.T).T
    total = np.zeros((len(displacement), 3))
    for axis in range(3):
        total[:, axis] = forces[:, fixed % 6 == axis].sum(axis=1)
    return total


def _levels_of_nodes(frame: FrameContents, names: tuple[str, ...]) -> Any:
    place = {node: k for k, level in enumerate(frame.levels) for node in level.nodes}
    return np.array([place.get(name, -1) for name in names], dtype=np.int64)
