"""Peaks of a run, found by compiled code from the records of its loop, without any Dataset.

The quantities are those of `frames.results.quantities`, of most runs at the level 'pendulum'
(`can_track`); those of others are read off Datasets (`Reduction`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import sparse

from frames.bundles.model_data import device_records
from frames.bundles.peak_data import Devices, Reached, Shape
from frames.kernels.peaks import (
    AT_ONCE,
    WHOLE_PLACES,
    peak_of_bearings,
    peak_of_structure,
)
from frames.recording.section_cuts import storey_rows
from frames.results.measures import Lines, floor_shares, lines_of
from frames.results.peak_response import Extreme
from frames.results.quantities import QUANTITIES
from lir_element.device.sliders import interface_height

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray, IntArray, SparseMatrix
    from frames.bundles.run_data import Ground, Output
    from frames.statics.gravity_state import GravityState
    from lir_element.layout import Records


_OF_STEPS = {name: quantity.dims for name, quantity in QUANTITIES.items() if quantity.by_step}
SHOWN = np.dtype(
    [(name, np.float64, (2,) * ("surface" in dims)) for name, dims in _OF_STEPS.items()]
)
"""Quantities of a bearing that compiled code fills at each step (kernels/quantities.py)."""


class Places(NamedTuple):
    """Places of the structure's nodes, as in a Dataset: `frames.results.measures`."""

    level: IntArray  # (n_nodes,) level of each node, -1 for none
    height: FloatArray  # (n_levels,) [m]
    lines: Lines
    shares: FloatArray  # (n_nodes, 3) of each node in its level's mean acceleration


class Kinematics(NamedTuple):
    """Data of geometry, supports and masses of a structure, independent of its stiffness."""

    places: Places
    drifts: SparseMatrix  # drifts of storeys and lines along x and y, over free displacements
    accelerations: SparseMatrix  # of nodes, and means of levels, over those of free displacements


def kinematics_of(transform: SparseMatrix, data: xr.Dataset) -> Kinematics:
    """Return places and motions of the nodes of a result."""
    levels = data["level_node"].to_numpy(), data["level_height"].to_numpy()
    places = Places(*levels, lines_of(data), floor_shares(data))
    return Kinematics(places, _drift_rows(transform, places), _acceleration_rows(transform, places))


class StoreyMaps(NamedTuple):
    """Storey shears along x and y, storey by storey, over ``x = (b, eta, beyond)``."""

    over_x: FloatArray  # (2 n_storeys, n_x)
    rest: FloatArray  # (2 n_storeys,)
    crossed: IntArray  # (n_storeys, n_bearings) 1 if the bearing passes through the storey


def can_track(state: GravityState) -> bool:
    """Return True if the peaks of a run can be found without Datasets."""
    # without vertical coupling its force is formed over neighbouring steps; bearings that the tilt
    # of their plates does not reach do not know it; nor are friction's other laws looked at there
    kept, records = state.system.features, device_records(state.system)
    plain = not (records["heats"].any() or records["pressure_rate"].any())
    return plain and state.contacts is None and kept.vertical_coupling and kept.plate_rotation


def devices_of(state: GravityState) -> Devices:
    """Return the input of the bearings' peaks."""
    props, system = state.model.props, state.system
    slider_height = props["radius"].sum(axis=1) - props["length"]
    return Devices(
        records=device_records(system),
        height=interface_height(props["radius"], props["slider_radius"], slider_height),
        radius=props["radius"][:, 0].copy(),
        floor=props["axial_floor"].copy(),
        static=np.asarray(state.axial_forces, dtype=np.float64),
        on_ground=np.isin([6 * placed.i for placed in system.bearings], system.fixed_dofs).astype(
            np.int64
        ),
    )


def shape_of(state: GravityState, accelerating: FloatArray, kinematics: Kinematics) -> Shape:
    """Return the input of the structure's peaks; `accelerating` of `Resultants`."""
    basis, system = state.basis, state.system
    places, drifts, over_a = kinematics
    shear = _shear_rows(state)
    over_u = sparse.csr_array(sparse.vstack([drifts, shear[0]]))
    expand = np.hstack([basis.expand_b, basis.expand_e])
    whole = expand if state.parts is None else np.hstack([expand, -state.part_shift])
    u_used, u_place = np.unique(over_u.indices, return_inverse=True)
    a_used, a_place = np.unique(over_a.indices, return_inverse=True)
    shears = _storey_shear_maps(state, places, whole)
    levels = len(places.height)
    storeys, lines = max(levels - 1, 0), len(places.lines[0])
    moves = np.vstack([whole[u_used], shears.over_x])

    def of(rows: SparseMatrix, where: IntArray) -> tuple[IntArray, IntArray, FloatArray]:
        kinds = rows.indptr.astype(np.int64), where.astype(np.int64)
        return *kinds, np.asarray(rows.data, dtype=np.float64)

    u_rows, a_rows = of(over_u, u_place), of(over_a, a_place)
    return Shape(
        moves=np.ascontiguousarray(moves.T),
        rest=np.concatenate([basis.offset[u_used], shears.rest]),
        rates=np.ascontiguousarray(accelerating[a_used].T),
        mass_e=np.ascontiguousarray(basis.mass_e),
        u_start=u_rows[0],
        u_place=u_rows[1],
        u_value=u_rows[2],
        shear=shear[1],
        crossed=shears.crossed,
        a_start=a_rows[0],
        a_place=a_rows[1],
        a_value=a_rows[2],
        sizes=np.array([len(system.node_names), levels, storeys, lines], dtype=np.int64),
        x=np.zeros((AT_ONCE, whole.shape[1])),
        u=np.zeros((AT_ONCE, len(moves))),
        x_rate=np.zeros((AT_ONCE, expand.shape[1])),
        a=np.zeros((AT_ONCE, len(a_used))),
    )


def nothing_reached(bearings: int, shape: Shape | None) -> Reached:
    """Return the largest values before any step."""
    nodes, levels, storeys, lines = (0, 0, 0, 0) if shape is None else shape.sizes.tolist()

    def lowest(*size: int) -> FloatArray:
        return np.full(size, -np.inf)

    whole, columns = len(WHOLE_PLACES), SHOWN.itemsize // 8
    shown = lowest(1, columns)
    return Reached(
        bearing=lowest(bearings, columns),
        bearing_at=np.zeros((bearings, columns)),
        shown=shown.view(SHOWN)[:, 0].view(np.recarray),
        columns=shown,
        axis=lowest(3),
        axis_at=np.zeros(3),
        node=lowest(nodes, 2),
        node_at=np.zeros((nodes, 2)),
        level=lowest(levels, 2),
        level_at=np.zeros((levels, 2)),
        storey=lowest(storeys),
        storey_at=np.zeros(storeys),
        shear=lowest(storeys),
        shear_at=np.zeros(storeys),
        line=lowest(lines),
        line_at=np.zeros(lines),
        whole=lowest(whole),
        whole_at=np.zeros(whole),
        total=np.zeros(3),
        lifted=np.zeros((bearings, 2)),
        loose=np.zeros((bearings, 2)),
        met=np.zeros((bearings, 5)),
        last=np.zeros(2),
    )


class PeakTracker:
    """Peaks of a run."""

    def __init__(self, devices: Devices, shape: Shape | None = None) -> None:
        own = ("x", "u", "x_rate", "a")  # scratch of this one alone
        self._devices = devices
        self._shape = shape and shape._replace(**{k: getattr(shape, k).copy() for k in own})
        self._reached = nothing_reached(len(devices.records), shape)
        self._bent = np.zeros(len(devices.records))

    def take(self, states: Records, out: Output, ground: Ground, first: int, last: int) -> None:
        """Add rows first <= k < last of the recorded steps, which follow those before."""
        if first >= last:
            return
        if self._shape is not None:
            peak_of_structure(
                self._devices, self._shape, self._reached, states, out, ground, first, last
            )
        peak_of_bearings(self._devices, self._reached, states, out, first, last)
        self._bent = states["rim_plastic"][last - 1].max(axis=-1)

    def reached(self) -> dict[str, Extreme]:
        """Return the peaks by quantity."""
        r = self._reached
        of_bearings = r.bearing.view(SHOWN)[:, 0], r.bearing_at.view(SHOWN)[:, 0]
        found = {name: Extreme(*(each[name].copy() for each in of_bearings)) for name in _OF_STEPS}
        found["displacement_along"] = Extreme(r.axis.copy(), r.axis_at.copy())
        for k, name in enumerate(WHOLE_PLACES):
            found[name] = Extreme(np.array(r.whole[k]), np.array(r.whole_at[k]))
        if self._shape is None:
            del found["base_shear"]
            return found
        for k, way in enumerate(("plan", "vertical")):
            found[f"node_{way}"] = Extreme(r.node[:, k].copy(), r.node_at[:, k].copy())
            if len(r.level):
                found[f"floor_{way}"] = Extreme(r.level[:, k].copy(), r.level_at[:, k].copy())
        if len(r.storey):
            found["storey_shear"] = Extreme(r.shear.copy(), r.shear_at.copy())
            found["drift"] = Extreme(r.storey.copy(), r.storey_at.copy())
        if len(r.line):
            found["line_drift"] = Extreme(r.line.copy(), r.line_at.copy())
        return found

    def totals(self) -> dict[str, FloatArray]:
        """Return the sums over steps, by name."""
        r = self._reached
        names = ("sliding_work", "sliding_work_lower", "uplifts")
        found = {name: np.array(r.total[k]) for k, name in enumerate(names)}
        found |= {"time_lifted": r.lifted[:, 0].copy(), "slip_loose": r.loose[:, 0].copy()}
        return found | {"rim_plastic": self._bent}


def _nodes_dofs(nodes: IntArray, dofs: int) -> IntArray:
    # Places of the first `dofs` displacements of nodes, node by node.
    return np.asarray((6 * nodes[:, None] + np.arange(dofs)).ravel(), dtype=np.int64)


def _drift_rows(transform: SparseMatrix, places: Places) -> SparseMatrix:
    # Drifts along x and y: of storeys, the means of their lines; then of lines.
    heights = places.height
    if len(heights) < 2:
        return sparse.csr_array((0, transform.shape[1]))
    lower, upper, level, arm = places.lines
    low, high = (transform[_nodes_dofs(nodes, 2)] for nodes in (lower, upper))
    across = np.column_stack([-arm[:, 1], arm[:, 0]]).ravel()
    at = np.arange(len(across)), np.repeat(np.arange(len(arm)), 2)
    turned = sparse.csr_array((across, at), shape=(len(across), len(arm)))
    turned.eliminate_zeros()
    carried = turned @ transform[6 * lower + 5]
    over_rise = sparse.diags_array(1.0 / np.repeat(heights[level] - heights[level - 1], 2))
    lines = over_rise @ (high - low - carried)
    own = [level == k for k in range(1, len(heights))]
    means = sparse.kron(np.array([one / one.sum() for one in own]), sparse.eye_array(2))
    return sparse.csr_array(sparse.vstack([means @ lines, lines]))


def _acceleration_rows(transform: SparseMatrix, places: Places) -> SparseMatrix:
    # Accelerations of nodes, then means of levels.
    nodes = transform[_nodes_dofs(np.arange(len(places.level)), 3)]
    if not len(places.height):
        return sparse.csr_array(nodes)
    node, axis = np.nonzero((places.level >= 0)[:, None] & places.shares.astype(bool))
    at = 3 * places.level[node] + axis, 3 * node + axis
    shape = 3 * len(places.height), nodes.shape[0]
    means = sparse.csr_array((places.shares[node, axis], at), shape=shape)
    return sparse.csr_array(sparse.vstack([nodes, means @ nodes]))


def _shear_rows(state: GravityState) -> tuple[SparseMatrix, FloatArray]:
    # Resistance of the structure's own supports along x and y: `_other_reactions` of the Dataset;
    # over free degrees of freedom, and over forces beyond with the constant.
    system = state.system
    stiffness = system.node_stiffness + state.node_geometric
    node_rows = sparse.csc_array(system.parts.node_rows)
    rows = []
    rest = np.zeros((3, node_rows.shape[0] + 1))
    for axis in range(2):
        those = system.fixed_dofs[system.fixed_dofs % 6 == axis]
        ones = np.ones((1, len(those)))
        rows.append(-(sparse.csr_array(ones) @ (stiffness[those] @ system.transform)))
        rest[axis, :-1] = -np.asarray(node_rows[:, those].sum(axis=1)).ravel()
        rest[axis, -1] = system.node_load[those].sum()
    found = sparse.csr_array(sparse.vstack(rows))
    found.eliminate_zeros()
    return found, rest


def _storey_shear_maps(state: GravityState, places: Places, whole: FloatArray) -> StoreyMaps:
    # `whole` are displacements over (b, eta, beyond).
    heights, bearings = places.height.tolist(), len(state.system.bearings)
    if len(heights) < 2:
        none = np.zeros((0, bearings), dtype=np.int64)
        return StoreyMaps(np.zeros((0, whole.shape[1])), np.zeros(0), none)
    rows = storey_rows(state.system, state.member_forces, heights)
    in_plan = np.arange(len(rows.constant)) % 3 < 2
    over_x = np.asarray(rows.over_q @ whole)
    if state.parts is not None:
        over_x[:, -len(state.parts.d_old) :] += rows.over_beyond
    rest = rows.over_q @ state.basis.offset + rows.constant
    return StoreyMaps(over_x[in_plan], rest[in_plan], rows.crossed.astype(np.int64))
