"""Formulas of the quantities: histories of a Dataset, and sums over its steps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.bundles.peak_data import LOOSE
from frames.formulas import (
    balance_gap,
    closing_speed,
    either,
    interface_share,
    over_static,
    pressed_eccentricity,
    presses,
    size,
    sliding_power,
)
from frames.results.measures import ABSORBED, means_of_levels
from frames.results.recorded import require_recorded, standing
from lir_element import formulas as of_bearing
from lir_element.device.friction_table import FrictionValues
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from frames._types import BoolArray, FloatArray

VIOLENT = 50.0 * STANDARD_GRAVITY
"""Acceleration of a node from which on it is looked at [m/s2]."""


def in_plan(values: FloatArray) -> FloatArray:
    """Return the sizes of the horizontal parts of vectors (..., 3) or (..., 2)."""
    vectors = np.asarray(values)
    return np.asarray(of_bearing.in_plan(vectors[..., 0], vectors[..., 1]))


def displacement(data: xr.Dataset) -> FloatArray:
    """Return the displacements of the bearings in plan (time, bearing) [m]."""
    return in_plan(of_bearings(data, "bearing_displacement", "axis"))


def vertical_force(data: xr.Dataset) -> FloatArray:
    """Return the axial force of the bearings (time, bearing), compression positive [N].

    Without vertical coupling: the force of the vertical springs, plus the inertia of the static
    load along the pendulum's path, ``W / g`` times the acceleration of ``L - sqrt(L^2 - U^2)``.

    Shapes: result (n_steps, n_bearings).
    """
    axial: FloatArray = data.variables["axial_force"].to_numpy()
    if "vertical_coupling" not in left_out(data):
        return axial
    spring = -data["bearing_force"].sel(axis="z").to_numpy()
    time = data["time"].to_numpy()
    if len(time) < 2:
        return np.asarray(spring)
    u = data["bearing_displacement"].sel(axis=["x", "y"]).to_numpy()
    v = data["bearing_velocity"].sel(axis=["x", "y"]).to_numpy()
    length = data["length"].to_numpy()
    depth = np.sqrt(np.maximum(length**2 - (u**2).sum(axis=-1), 0.01 * length**2))
    rising = np.gradient((u * v).sum(axis=-1) / depth, time, axis=0)
    return np.asarray(
        spring + data.variables["static_axial_force"].to_numpy() / STANDARD_GRAVITY * rising
    )


def left_out(data: xr.Dataset) -> tuple[str, ...]:
    """Return the names of the features that a run left out."""
    text = str(data.attrs["features_left_out"])
    return () if text == "none" else tuple(text.split(", "))


def rims_met(data: xr.Dataset) -> FloatArray:
    """Return 1 if a bearing's slider presses on a rim, else 0 (time, bearing)."""
    return formed(presses, rim_force(data))


def closing(data: xr.Dataset) -> FloatArray:
    """Return the closing speed of the axial contact at the first step of rim contacts [m/s]."""
    found = np.zeros((data.sizes["time"], data.sizes["bearing"]))
    met, time = rims_met(data), data["time"].to_numpy()
    slip = of_bearings(data, "interface_slip", "axis")[:-1]
    way = np.diff(of_bearings(data, "bearing_displacement", "axis"), axis=0)
    speeds = formed(
        closing_speed,
        *(slip[..., 0], slip[..., 1], way[..., 0], way[..., 1]),
        np.diff(time)[:, None],
        known(data, "length"),
    )
    found[1:] = speeds * (met[1:] > met[:-1])
    return found


def of_bearings(data: xr.Dataset, name: str, *last: str) -> FloatArray:
    """Return the history of a variable of bearings (time, bearing, ...)."""
    return values_of(data, name, "time", "bearing", *last)


def values_of(data: xr.Dataset, name: str, *dims: str) -> FloatArray:
    """Return a variable in an order of its dimensions."""  # coordinates would cost time
    return np.asarray(data.variables[name].transpose(*dims).to_numpy())


def formed(formula: Callable[..., Any], *of: FloatArray) -> FloatArray:
    """Return the result of a formula for whole histories."""
    return np.asarray(formula(*of))


def known(data: xr.Dataset, name: str) -> FloatArray:
    """Return a number of each bearing, or of each of its surfaces."""
    return np.asarray(data.variables[name].to_numpy())


def rim_force(data: xr.Dataset) -> FloatArray:
    """Return the larger force of both rims (time, bearing) [N]."""
    both = of_bearings(data, "rim_force", "surface")
    return formed(either, both[..., 0], both[..., 1])


def share_of_interface(data: xr.Dataset) -> FloatArray:
    """Return the force of the interfaces over their friction resistance (time, bearing)."""
    load = of_bearings(data, "axial_force")
    if "interface_preload" in data.variables:
        load = load + known(data, "interface_preload")
    return formed(
        interface_share,
        of_bearings(data, "interface_force"),
        load,
        known(data, "static_axial_force"),
        known(data, "interface_friction"),
    )


def vertical_ratio(data: xr.Dataset) -> FloatArray:
    """Return the vertical forces over the static ones (time, bearing)."""
    return formed(over_static, vertical_force(data), known(data, "static_axial_force"))


def eccentricity(data: xr.Dataset, share: float) -> FloatArray:
    """Return offsets over the slider radius above a share of the static load."""
    return formed(
        pressed_eccentricity,
        of_bearings(data, "interface_eccentricity"),
        known(data, "slider_radius"),
        of_bearings(data, "axial_force"),
        known(data, "static_axial_force"),
        np.array(share),
    )


def violence(data: xr.Dataset) -> FloatArray:
    """Return accelerations of nodes with mass, 0 up to `VIOLENT` (time, node)."""
    moves = np.linalg.norm(of_nodes(data)[..., :3], axis=-1)
    heavy = data.variables["node_mass"].to_numpy().max(axis=1) > 0.0
    return np.where((moves > VIOLENT) & heavy, moves, 0.0)


def of_levels(data: xr.Dataset) -> FloatArray:
    """Return the mean accelerations of levels (time, level, axis)."""
    return means_of_levels(data)


def of_nodes(data: xr.Dataset) -> FloatArray:
    """Return the accelerations of nodes (time, node, dof)."""
    return values_of(data, "node_acceleration", "time", "node", "dof")


def energy_term(data: xr.Dataset, term: str) -> FloatArray:
    """Return the size of a term of the energy (time,)."""
    return formed(size, data["energy"].sel(term=term).to_numpy())


def energy_gap(data: xr.Dataset) -> FloatArray:
    """Return the gap of the energy balance (time,)."""
    energy = data["energy"]
    both = energy.sel(term="input"), energy.sel(term=list(ABSORBED)).sum("term")
    return formed(balance_gap, *(each.to_numpy() for each in both))


def tilt(data: xr.Dataset) -> FloatArray:
    """Return the larger tilt of both sliders (time, bearing)."""
    turn = data["body_rotation"].transpose("time", "bearing", "body", "axis")
    turns = turn.sel(body=["bottom_slider", "top_slider"]).to_numpy()
    tilts = np.hypot(turns[..., 0], turns[..., 1])  # NaN without contact points
    return np.asarray(tilts.max(axis=-1))


def _slid(data: xr.Dataset, first: int, last: int) -> tuple[FloatArray, FloatArray]:
    # Speed of sliding and load on it at some steps.
    part = slice(first, last)
    load = np.maximum(of_bearings(data, "axial_force")[part], 0.0)[..., None]
    return of_bearings(data, "sliding_speed", "surface")[part], load


def sliding_work(data: xr.Dataset, first: int, last: int) -> FloatArray:
    """Return the sum of load, friction at high speed and speed."""
    speed, load = _slid(data, first, last)
    return np.asarray(formed(sliding_power, load, known(data, "friction_max"), speed).sum())


def sliding_work_lower(data: xr.Dataset, first: int, last: int) -> FloatArray:
    """Return the same sum for the friction lost below that at high speed."""
    speed, load = _slid(data, first, last)
    drop, rate = (data.variables[f"friction_{name}"].to_numpy() for name in ("drop", "rate"))
    lower = drop * np.exp(-rate * speed)  # (3.1)
    if "friction_table" in data:
        tables = data.variables["friction_table"].transpose("bearing", "surface", ...).to_numpy()
        for place in np.argwhere(tables[..., 0] > 0.0):
            at = (..., *place)
            values = FrictionValues(0.0, 0.0, 0.0, tuple(tables[tuple(place)].tolist()))
            lower[at] = drop[tuple(place)] * values.left(speed[at])
    return np.asarray(formed(sliding_power, load, lower, speed).sum())


def sliding_work_pressed(data: xr.Dataset, first: int, last: int) -> FloatArray:
    """Return the same sum for the change by pressure."""
    if "pressure_rate" not in data:
        return np.zeros(())
    speed, load = _slid(data, first, last)
    rate, at = (data.variables[name].to_numpy() for name in ("pressure_rate", "pressure_load"))
    changed = np.abs(1.0 - np.exp(-rate[:, None] * (load - at[:, None])))
    return np.asarray((load * data.variables["friction_max"].to_numpy() * changed * speed).sum())


def sliding_work_heated(data: xr.Dataset, first: int, last: int) -> FloatArray:
    """Return the same sum for the change by temperature."""
    if "softening_rate" not in data:
        return np.zeros(())
    speed, load = _slid(data, first, last)
    scale, rate, rest = (
        data.variables[f"softening_{name}"].to_numpy()[:, None]
        for name in ("scale", "rate", "rest")
    )
    surfaces = of_bearings(data, "temperature", "contact")[first:last, :, :2]
    heated = np.isfinite(surfaces)  # of some bearings only
    changed = np.abs(1.0 - scale * (rest + np.exp(-rate * np.where(heated, surfaces, 0.0))))
    work = load * data.variables["friction_max"].to_numpy() * np.where(heated, changed, 0.0)
    return np.asarray((work * speed).sum())


def _lifted(data: xr.Dataset) -> BoolArray:
    return (of_bearings(data, "axial_force") <= 0.0) & (standing(data) > 0.0)


def uplifts(data: xr.Dataset, first: int, last: int) -> FloatArray:
    """Return how often bearings lifted off."""
    lifted = _lifted(data)
    begins = np.concatenate([lifted[:1], lifted[1:] & ~lifted[:-1]])
    return np.asarray(begins[first:last].sum(), dtype=np.float64)


def time_lifted(data: xr.Dataset, first: int, last: int) -> FloatArray:
    """Return how long each bearing was lifted [s]."""
    first = max(first, 1)
    steps = np.diff(data.variables["time"].to_numpy())[first - 1 : last - 1]
    lifted = _lifted(data)[first:last]
    return np.asarray((steps[:, None] * lifted).sum(axis=0))


def slip_loose(data: xr.Dataset, first: int, last: int) -> FloatArray:
    """Return how far interfaces slipped while nearly unloaded [m]."""
    first = max(first, 1)
    changes = np.diff(of_bearings(data, "interface_slip_size")[first - 1 : last], axis=0)
    static = data.variables["static_axial_force"].to_numpy()
    loose = of_bearings(data, "axial_force")[first:last] <= LOOSE * static
    return np.asarray((changes * loose).sum(axis=0))


def rim_plastic(data: xr.Dataset, first: int, last: int) -> FloatArray:
    """Return by how much the plastic deformation of rims grew [m]."""
    # Its growth; a rim that breaks ends it, once.
    if "rim_plastic" not in data:
        return np.zeros(data.sizes["bearing"])
    largest = of_bearings(data, "rim_plastic", "surface").max(axis=-1)
    before = largest[first - 1] if first > 0 else np.zeros(largest.shape[1])
    gone = np.isinf(before)
    return np.where(gone, 0.0, largest[last - 1] - np.where(gone, 0.0, before))


def of_links(data: xr.Dataset, name: str) -> FloatArray:
    """Return a variable of links, (time, link)."""
    require_recorded(data, "what links did", name)
    return np.asarray(data.variables[name].transpose("time", "link").to_numpy())


def of_hinges(data: xr.Dataset, name: str) -> FloatArray:
    """Return a variable of hinges, (time, hinge)."""
    require_recorded(data, "what hinges did", name)
    return np.asarray(data.variables[name].transpose("time", "hinge").to_numpy())


def link_ductility(data: xr.Dataset) -> FloatArray:
    """Return the deformations of links over those at yield.

    Shapes: result (n_steps, n_links).
    """
    d, force = of_links(data, "link_deformation"), of_links(data, "link_force")
    ratio = np.abs(d) / np.where(can_yield(data), data.variables["link_yield_deformation"], np.inf)
    return np.where(d * force > 0.0, ratio, 0.0)


def link_deformation(data: xr.Dataset) -> FloatArray:
    """Return the sizes of the links' deformations (time, link) [m, rad]."""
    return np.abs(of_links(data, "link_deformation"))


def can_yield(data: xr.Dataset) -> BoolArray:
    """Return which links have a deformation at which they yield (link,)."""
    return np.asarray(np.isfinite(data.variables["link_yield_deformation"].to_numpy()))


def hinge_rotation(data: xr.Dataset) -> FloatArray:
    """Return the sizes of the hinges' plastic rotations about both axes (time, hinge) [rad]."""
    require_recorded(data, "the rotation of hinges", "hinge_rotation")
    both = data["hinge_rotation"].sel(hinge_force_component=["My", "Mz"])
    values = both.transpose("time", "hinge", "hinge_force_component").to_numpy()
    return np.asarray(np.linalg.norm(values, axis=-1))
