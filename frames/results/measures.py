"""Derived results of a Dataset: drifts, floor accelerations, the energy balance."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr

from frames.bundles.peak_data import ENERGY_TERMS
from frames.formulas import by_tilt, open_gap
from frames.results.recorded import (
    largest_kept,
    noted,
    require_recorded,
    require_whole_levels,
    standing,
)
from lir_element.elevations import SAME_PLACE

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray

_ROUND_OFF = 1e-9  # m, of coordinates

ABSORBED = ENERGY_TERMS[1:]
"""Terms of the energy that balance the input."""


def energy_error(data: xr.Dataset) -> float:
    """Return the error of the energy balance [-].

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history.

    Returns
    -------
    float
        Largest gap ``|input - (sum of all other terms)|`` over the largest input [-]; in joule if
        there was no input.

    Examples
    --------
    >>> from frames import energy_error, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> energy_error(data) < 1e-6
    True
    """
    kept = [largest_kept(data, name) for name in ("energy_gap", "energy_input")]
    if kept[0] is not None and kept[1] is not None:
        gap, scale = float(kept[0][0]), float(kept[1][0])
        return gap / scale if scale > 0.0 else gap
    require_recorded(data, "energy_error", "energy")
    energy = data["energy"]
    gaps = np.abs(energy.sel(term="input") - energy.sel(term=list(ABSORBED)).sum("term"))
    scale = float(np.abs(energy.sel(term="input")).max())
    return float(gaps.max()) / scale if scale > 0.0 else float(gaps.max())


def storey_drift(data: xr.Dataset) -> xr.DataArray:
    """Return the storey drift histories of a time history [-].

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history of a model with levels.

    Returns
    -------
    xarray.DataArray
        Drift ratio (time, storey, axis x and y) [-]: the mean of `drift_by_line` over the lines of
        the storey. Nodes in only one of both levels do not count. These are components; "storey
        drift" of `peaks`, of checks and of figures is the size of the vector of both, and never
        exceeds that of the worst line.

    Raises
    ------
    ValueError
        If the model has fewer than two levels, or the nodes were not recorded.

    Examples
    --------
    >>> from frames import storey_drift, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example(1.0, storeys=2)
    >>> data = time_history(frame, pulse)
    >>> drift = storey_drift(data)
    >>> drift.dims, 1e-5 < float(abs(drift).max()) < 1e-2
    (('time', 'storey', 'axis'), True)
    """
    drifts, names = drifts_of_storeys(data), [str(name) for name in data["level"].to_numpy()[1:]]
    return xr.DataArray(
        drifts,
        dims=("time", "storey", "axis"),
        coords={"time": data["time"], "storey": names, "axis": ["x", "y"]},
        attrs={"units": "1", "long_name": "storey drift ratio"} | noted(data),
    )


def drifts_of_storeys(data: xr.Dataset) -> FloatArray:
    """Return the values of `storey_drift`."""
    drift, lines = drifts_of_lines(data, "storey_drift")
    storeys = range(1, data.sizes["level"])
    return np.stack([drift[:, lines.storey == k].mean(axis=1) for k in storeys], axis=1)


def floor_acceleration(data: xr.Dataset) -> xr.DataArray:
    """Return the mean total acceleration of each level (time, level, axis) [m/s2].

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history of a model with levels.

    Returns
    -------
    xarray.DataArray
        Means over the level's nodes by their masses: the acceleration of its centre of mass. Nodes
        without mass count only on a level that has none.

    Examples
    --------
    >>> from frames import floor_acceleration, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example(1.0, storeys=2)
    >>> data = time_history(frame, pulse)
    >>> floor_acceleration(data).sel(axis="x").dims
    ('time', 'level')
    """
    return xr.DataArray(
        means_of_levels(data),
        dims=("time", "level", "axis"),
        coords={"time": data["time"], "level": data["level"], "axis": ["x", "y", "z"]},
        attrs={"units": "m/s2", "long_name": "total acceleration of the level"} | noted(data),
    )


def means_of_levels(data: xr.Dataset) -> FloatArray:
    """Return the values of `floor_acceleration`."""
    require_recorded(data, "means over levels", "node_acceleration", "level_node", "node_mass")
    require_whole_levels(data, "means over levels")
    place, shares = data["level_node"].to_numpy(), floor_shares(data)
    values = _along(data, "node_acceleration", "ux", "uy", "uz")
    means = [
        np.einsum("tna,na->ta", values[:, on], shares[on])
        for on in (np.flatnonzero(place == k) for k in range(data.sizes["level"]))
    ]
    return np.stack(means, axis=1)


def floor_shares(data: xr.Dataset) -> FloatArray:
    """Return the share of each node in its level's mean acceleration.

    Shapes: result (n_nodes, 3).
    """
    place = data["level_node"].to_numpy()
    mass = np.ones((len(place), 3))
    if "node_mass" in data:
        mass = data["node_mass"].transpose("node", "axis").to_numpy()
    found = np.zeros((len(place), 3))
    for k in range(data.sizes["level"]):
        on = place == k
        total = mass[on].sum(axis=0)
        equal = 1.0 / max(int(on.sum()), 1)
        found[on] = np.where(total > 0.0, mass[on] / np.where(total > 0.0, total, 1.0), equal)
    return found


def drift_by_line(data: xr.Dataset) -> xr.DataArray:
    """Return the drifts of every line of nodes over one another [-]: corners drift most.

    A rigid motion in plan, turns about z included, has no drift. Tilt counts, as codes have it: a
    building that leans by an angle drifts by it.

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history of a model with levels.

    Returns
    -------
    xarray.DataArray
        Drift ratio (time, line, axis x and y) [-] between a node of a level and the node of the
        level below at the same place in plan. A line has the name of its upper node, and the
        coordinate `storey` is the level of that node. If no node of a storey is over another, each
        upper node is compared with the place below it. This place moves with the nearest node of
        the level below as with a rigid body.

    Raises
    ------
    ValueError
        If the model has fewer than two levels.

    Examples
    --------
    >>> from frames import drift_by_line, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example(1.0, storeys=2)
    >>> data = time_history(frame, pulse)
    >>> drift_by_line(data).dims
    ('time', 'line', 'axis')
    """
    drift, lines = drifts_of_lines(data, "drift_by_line")
    return xr.DataArray(
        drift,
        dims=("time", "line", "axis"),
        coords={
            "time": data["time"],
            "line": data["node"].to_numpy()[lines.upper],
            "storey": ("line", data["level"].to_numpy()[lines.storey]),
            "axis": ["x", "y"],
        },
        attrs={"units": "1", "long_name": "storey drift ratio of a line of nodes"} | noted(data),
    )


class Lines(NamedTuple):
    """Lines of drifts: pairs of nodes of neighbouring levels, each (m,)."""

    lower: IntArray
    upper: IntArray
    storey: IntArray  # level of the upper node
    arm: FloatArray  # (m, 2) from the lower node to the place below the upper one, in plan [m]


def lines_of(data: xr.Dataset) -> Lines:
    """Return the lines of nodes over one another; if a storey has none, the nearest ones."""
    level = data["level_node"].to_numpy()
    place = data["node_position"].transpose("node", "axis").to_numpy()[:, :2]
    pairs = []
    for k in range(1, data.sizes["level"]):
        low, high = np.flatnonzero(level == k - 1), np.flatnonzero(level == k)
        if not len(low):
            continue
        apart = np.linalg.norm(place[high][:, None] - place[low][None], axis=-1)
        nearest = apart.argmin(axis=1)
        over = apart[np.arange(len(high)), nearest] < SAME_PLACE
        chosen = over if over.any() else ~over
        pairs += [
            (low[n], up, k) for up, n, fits in zip(high, nearest, chosen, strict=True) if fits
        ]
    lower, upper, storey = np.array(pairs, dtype=np.int64).reshape(-1, 3).T
    arm = place[upper] - place[lower]
    return Lines(lower, upper, storey, np.where(np.abs(arm) < _ROUND_OFF, 0.0, arm))


def uplift_gap(data: xr.Dataset) -> xr.DataArray:
    """Return the opening of the bearings' contacts [m].

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history.

    Returns
    -------
    xarray.DataArray
        The gap (time, bearing) [m], 0 if a contact is closed. It is measured from the place of the
        upper sphere's centre over the lower one. At the closing of the contact this is
        ``c = L n + s`` (docs/theory.md, section 1); tilts of the plates shift it.

    Raises
    ------
    ValueError
        If an input was not recorded.

    Examples
    --------
    >>> from frames import time_history, uplift_gap
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> float(uplift_gap(data).max())
    0.0
    """
    return xr.DataArray(
        gaps(data),
        dims=("time", "bearing"),
        coords={"time": data["time"], "bearing": data["bearing"]},
        attrs={"units": "m", "long_name": "gap of the axial contact"} | noted(data),
    )


def gaps(data: xr.Dataset) -> FloatArray:
    """Return the values of `uplift_gap`."""
    require_recorded(
        data,
        "uplift_gap",
        "bearing_displacement",
        "node_displacement",
        "interface_slip_size",
        "axial_force",
    )
    given = data.variables
    moves = given["bearing_displacement"].transpose("time", "bearing", "axis").to_numpy()
    across = moves[..., :2] + centre_shift(data)
    slip, load = (
        given[name].transpose("time", "bearing").to_numpy()
        for name in ("interface_slip_size", "axial_force")
    )
    open_by = open_gap(
        across[..., 0], across[..., 1], moves[..., 2], given["length"].to_numpy(), slip, load
    )
    return np.asarray(standing(data) * open_by)


def lateral_capacity(data: xr.Dataset) -> FloatArray:
    """Return the bearings' displacements at the first rim contact, plates parallel [m]."""
    rim, radius = (
        data.variables[name].transpose("bearing", "surface").to_numpy()
        for name in ("rim_displacement", "radius")
    )
    return np.asarray(data.variables["length"].to_numpy() * (rim / radius).min(axis=1))


def centre_shift(data: xr.Dataset) -> FloatArray:
    """Return how far turns of nodes move the spheres' centres C2 - C1 (time, bearing, 2) [m]."""
    ends = data.variables["bearing_node"].transpose("end", "bearing").to_numpy()
    if (ends < 0).any():
        msg = "nodes of a bearing were not recorded: record all nodes of the bearings wanted"
        raise ValueError(msg)
    turns = _along(data, "node_displacement", "rx", "ry")
    levers = data.variables["lever"].transpose("surface", "bearing").to_numpy()
    # C1 = x_i + l_1 e_i and C2 = x_j - l_2 e_j, with the plates' axes e = (r_y, -r_x, 1)
    x = by_tilt(*levers, *(-turns[:, place, 1] for place in ends))
    y = by_tilt(*levers, *(turns[:, place, 0] for place in ends))
    return np.stack([x, y], axis=-1)


def drifts_of_lines(data: xr.Dataset, what: str) -> tuple[FloatArray, Lines]:
    """Return the values of `drift_by_line`, and the lines; `what` needs them."""
    require_recorded(data, what, "node_displacement")
    require_whole_levels(data, what)
    heights, lines = _level_heights(data), lines_of(data)
    values = _along(data, "node_displacement", "ux", "uy", "rz")
    low, high = values[:, lines.lower], values[:, lines.upper, :2]
    rise = heights[lines.storey] - heights[lines.storey - 1]
    carried = low[..., 2:] * np.column_stack([-lines.arm[:, 1], lines.arm[:, 0]])
    return np.asarray((high - low[..., :2] - carried) / rise[None, :, None]), lines


def _along(data: xr.Dataset, name: str, *dofs: str) -> FloatArray:
    # Some degrees of freedom of nodes, (time, node, dof).
    known, each = data.variables["dof"].to_numpy().tolist(), data.variables[name]
    places = [known.index(dof) for dof in dofs]
    return np.asarray(each.transpose("time", "node", "dof").to_numpy()[..., places])


def _level_heights(data: xr.Dataset) -> FloatArray:
    heights = data["level_height"].to_numpy()
    if len(heights) < 2:
        msg = f"the model has {len(heights)} levels: drifts need at least two (Frame.add_level)"
        raise ValueError(msg)
    return np.asarray(heights, dtype=np.float64)
