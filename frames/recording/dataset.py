"""From recorded arrays to the labelled Dataset."""

from __future__ import annotations

from functools import cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from frames.bundles.model_data import device_records
from frames.bundles.peak_data import ENERGY_TERMS
from frames.model.components import DOFS
from frames.recording.nonlinear_results import part_coordinates, part_variables
from frames.recording.section_cuts import storey_rows
from frames.statics.gravity_state import expand
from frames.statics.resultants import Resultants, moving_mass
from lir_element.results.dataset import (
    bearing_coordinates,
    bearing_variables,
    device_variables,
    labelled,
    some_bodies,
)
from lir_element.results.deferred import deferred
from lir_element.results.optional_variables import interface_eccentricity, optional_variables

if TYPE_CHECKING:
    from collections.abc import Callable

    from frames._types import FloatArray
    from frames.assembly.system import System
    from frames.bundles.run_data import Ground, Output
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion
    from frames.recording.section_cuts import StoreyRows
    from frames.statics.gravity_state import GravityState
    from lir_element.layout import Records


_PLACES = "node_position", "level_node", "level_height"


class Common(NamedTuple):
    """Common data of all results of a structure."""

    frame: FrameData
    variables: dict[str, xr.Variable]
    labels: dict[str, list[str]]
    coordinates: xr.Coordinates  # of these labels: all but the time
    storeys: int
    storey_rows: Callable[[], StoreyRows]  # formed on first use, once
    resultants: Resultants

    def is_laid_out_as(self, other: Common) -> bool:
        """Return whether its results differ from those of another one in numbers alone."""
        own, others = self.variables, other.variables
        return own.keys() == others.keys() and self._has(_PLACES, other)

    def moves_as(self, other: Common) -> bool:
        """Return whether its nodes and masses are at the places of another one's."""
        return self._has((*_PLACES, "node_mass"), other)

    def _has(self, names: tuple[str, ...], other: Common) -> bool:
        own, others = self.variables, other.variables
        same = (np.array_equal(own[name].data, others[name].data) for name in names)
        return self.coordinates is other.coordinates and all(same)

    def of_structure(self) -> xr.Dataset:
        """Return it as a Dataset."""
        return xr.Dataset(self.variables, self.coordinates)


def common_of(frame: FrameData, state: GravityState, like: Common | None = None) -> Common:
    """Return the common data of a structure's results; equal parts are those of `like`."""
    system, levels = state.system, frame.levels
    if like is not None and like.resultants.serves(state):
        resultants = like.resultants
    else:
        resultants = Resultants(state)
    names = part_coordinates(system.parts, frame)
    if levels[1:]:
        names["storey"] = [level.name for level in levels[1:]]
    labels = {
        "node": list(system.node_names),
        "dof": list(DOFS),
        "term": list(ENERGY_TERMS),
        "resultant": list(resultants.names),
        "level": [level.name for level in levels],
        **names,
        **bearing_coordinates([placed.name for placed in system.bearings]),
    }
    if like is not None and like.labels == labels:
        coordinates = like.coordinates
    else:
        coordinates = xr.Dataset(coords=labels).coords
    variables = _device_variables(system) | _permanent(frame, state)
    rows = cache(partial(storey_rows, system, state.member_forces, [level.z for level in levels]))
    return Common(frame, variables, labels, coordinates, len(levels) - 1, rows, resultants)


def build_dataset(
    common: Common,
    state: GravityState,
    shaking: Ground,
    peak: FloatArray,
    out: Output,
    states: Records,
    bodies: Records,
    count: int,
    *,
    kept: bool = False,
) -> xr.Dataset:
    """Build a Dataset from the first `count` recorded steps (docs/results.md).

    Shapes: peak (3,).
    """
    system = state.system
    motion = _Motion(state, common.resultants, shaking, out, states, count)

    def of(form: Callable[[], FloatArray], *shape: int) -> Any:
        return deferred((count, *shape), form) if kept else form()

    nodes, bearings = len(system.node_names), len(system.bearings)
    velocity = of(motion.bearing_velocity, bearings, 3)
    variables = bearing_variables("time", states[:count], velocity, kept=kept)
    if state.contacts is not None:
        variables |= some_bodies("time", state.contacts.row, states[:count], bodies[:count])
    variables |= optional_variables("time", states[:count], state.model.props)
    node = ("time", "node", "dof")
    variables |= part_variables(system.parts, common.frame, out, count)
    variables |= {  # with arrays and attributes of their own
        name: xr.Variable(each.dims, each.values.copy(), dict(each.attrs))
        for name, each in common.variables.items()
    }
    variables |= {
        "interface_eccentricity": labelled(
            ("time", "bearing"),
            of(motion.eccentricity, bearings),
            "m",
            "offset of the resultant between the sliders from their axes, the larger; 0 lifted",
        ),
        "peak_ground_velocity": labelled(
            ("axis",), peak, "m/s", "largest velocity of the ground, also of a direction left out"
        ),
        "imbalance": labelled(
            ("time", "resultant"),
            of(motion.imbalance, len(common.resultants.names)),
            "1",
            "sum of all forces over the weight, of moments over that times half the extent",
        ),
        "node_displacement": labelled(
            node,
            of(motion.displacement, nodes, 6),
            "m, rad",
            "displacement relative to the ground",
        ),
        "node_acceleration": labelled(
            node,
            of(motion.acceleration, nodes, 6),
            "m/s2, rad/s2",
            "total acceleration, ground included",
        ),
        "ground_acceleration": labelled(
            ("time", "axis"), motion.ground.copy(), "m/s2", "ground acceleration"
        ),
        "base_shear": labelled(
            ("time", "axis"),
            of(motion.base_shear, 3),
            "N",
            "resisting force of the ground: bearings on it, and other supports",
        ),
        "energy": labelled(
            ("time", "term"),
            out.energy[:count] if kept else out.energy[:count].copy(),
            "J",
            "energy since gravity",
        ),
    }
    if common.storeys > 0:
        variables["storey_shear"] = labelled(
            ("time", "storey", "axis"),
            of(lambda: motion.storey_shear(common.storey_rows()), common.storeys, 3),
            "N",
            "resisting force of what is below a storey: its members, and bearings through it",
        )

    variables["time"] = labelled(("time",), out.time[:count].copy(), "s", "time")
    left_out = ", ".join(system.features.left_out) or "none"
    return xr.Dataset(variables, common.coordinates, {"features_left_out": left_out})


def _permanent(frame: FrameData, state: GravityState) -> dict[str, xr.Variable]:
    # Parts of a structure, and its levels.
    system = state.system
    return {
        "node_position": labelled(
            ("node", "axis"), system.coordinates.copy(), "m", "place of the node, undeformed"
        ),
        "node_mass": labelled(
            ("node", "axis"), moving_mass(state), "kg", "mass at the node, 0 where it is fixed"
        ),
        "weight": labelled(
            (), float(-system.node_load[2::6].sum()), "N", "permanent vertical load"
        ),
        "static_axial_force": labelled(
            ("bearing",), state.axial_forces.copy(), "N", "axial force under permanent loads"
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


class _Motion:
    """Motion of the structure from the recorded steps, formed on use."""

    def __init__(
        self,
        state: GravityState,
        resultants: Resultants,
        shaking: Ground,
        out: Output,
        states: Records,
        count: int,
    ) -> None:
        self._resultants = resultants
        self._state, self._out, self._states, self._count = state, out, states, count
        self._shape = (count, len(state.system.node_names), 6)
        self.ground = ground_at(shaking, out.time[:count])

    def displacement(self) -> FloatArray:
        return self._of_nodes(self._moves())

    def _moves(self) -> FloatArray:
        # Histories of the free degrees of freedom.
        state, out, count = self._state, self._out, self._count
        q = expand(state.basis, out.b[:count], out.e[:count])
        if state.parts is not None:
            q -= out.beyond[:count] @ state.part_shift.T
        return q

    def acceleration(self) -> FloatArray:
        out, count = self._out, self._count
        rates = np.hstack([out.a_b[:count], out.a_e[:count]])
        found = self._of_nodes(rates @ self._resultants.accelerating.T)
        found[..., :3] += self.ground[:, None, :]
        return found

    def imbalance(self) -> FloatArray:
        return self._resultants.of(self._out, self._states, self.ground, 0, self._count)

    def bearing_velocity(self) -> FloatArray:
        return _bearing_velocity(self._state, self._out.v_b[: self._count])

    def eccentricity(self) -> FloatArray:
        return interface_eccentricity(self._state.model.props, self._states[: self._count])

    def base_shear(self) -> FloatArray:
        system = self._state.system
        grounded = np.isin([6 * placed.i for placed in system.bearings], system.fixed_dofs)
        forces = self._states["force"][: self._count, grounded, 6:9].sum(axis=1)
        beyond = self._out.beyond[: self._count]
        found: FloatArray = forces + _other_reactions(self._state, self._moves(), beyond)
        return found

    def storey_shear(self, rows: StoreyRows) -> FloatArray:
        found = np.asarray(rows.over_q @ self._moves().T).T + rows.constant
        found += self._out.beyond[: self._count] @ rows.over_beyond.T
        found = found.reshape(self._count, len(rows.crossed), 3)
        for k, crossed in enumerate(rows.crossed):
            found[:, k] += self._states["force"][: self._count, crossed, 6:9].sum(axis=1)
        return found

    def _of_nodes(self, q: FloatArray) -> FloatArray:
        found = np.asarray(self._state.system.transform @ q.T).T.reshape(self._shape)
        return np.ascontiguousarray(found)


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
    ends = np.array([(b.i, b.j) for b in system.bearings], dtype=np.int64)
    variables["bearing_node"] = labelled(
        ("bearing", "end"), ends, "1", "place of the node among the nodes"
    )
    return variables


def _bearing_velocity(state: GravityState, v_b: FloatArray) -> FloatArray:
    # Velocity of node j relative to node i, (n, n_bearings, 3).
    rows = state.system.bearing_rows[:, state.basis.bearing_dofs]
    v = np.asarray(rows @ v_b.T).T.reshape(len(v_b), -1, 12)
    relative: FloatArray = v[..., 6:9] - v[..., :3]
    return relative


def _other_reactions(state: GravityState, q: FloatArray, beyond: FloatArray) -> FloatArray:
    # Resistance of the structure's own supports (members on the ground), with the sign of bearing
    # forces: positive for positive displacement of the structure.
    system = state.system
    fixed = system.fixed_dofs[system.fixed_dofs % 6 < 3]
    stiffness = system.node_stiffness + state.node_geometric
    forces = system.node_load[fixed] - np.asarray((stiffness[fixed] @ system.transform) @ q.T).T
    forces -= np.asarray(system.parts.node_rows[:, fixed].T @ beyond.T).T
    total = np.zeros((len(q), 3))
    for axis in range(3):
        total[:, axis] = forces[:, fixed % 6 == axis].sum(axis=1)
    return total


def _levels_of_nodes(frame: FrameData, names: tuple[str, ...]) -> Any:
    place = {node: k for k, level in enumerate(frame.levels) for node in level.nodes}
    return np.array([place.get(name, -1) for name in names], dtype=np.int64)
