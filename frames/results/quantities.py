"""The quantities of a time history whose largest values count: the table that declares them.

A column of results is added by its row here and its formula in `frames.kernels.quantities`
(docs/architecture.md).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._jit import on_arrays
from frames.bundles.peak_data import LOADED, PRESSED
from frames.kernels.quantities import (
    balance_gap,
    closing_speed,
    either,
    interface_share,
    is_lifted,
    opposite,
    over_static,
    pressed_eccentricity,
    presses,
    size,
    slips,
    vertical_change,
)
from frames.results.hinge_extremes import hinge_rotation, link_ductility, of_hinges, of_links
from frames.results.measures import (
    ABSORBED,
    centre_shift,
    drift_by_line,
    floor_acceleration,
    storey_drift,
    uplift_gap,
)
from frames.results.recorded import standing
from lir_element.kernels import derived
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from frames._types import FloatArray

VIOLENT = 50.0 * STANDARD_GRAVITY
"""Acceleration of a node from which on it is looked at [m/s2]."""


class Quantity(NamedTuple):
    """A derived history (time, ...) of which the largest value counts: declared here, and once."""

    dims: tuple[str, ...]
    unit: str
    meaning: str
    of: Callable[[xr.Dataset], FloatArray]
    by_step: bool = False
    """Whether compiled code fills it, of each bearing at each step (`show_bearing`)."""
    row: str = ""
    """Its row in the table of peaks; of a quantity of each bearing alone."""


def in_plan(values: FloatArray) -> FloatArray:
    """Return the sizes of the horizontal parts of vectors (..., 3) or (..., 2)."""
    vectors = np.asarray(values)
    return np.asarray(on_arrays(derived.in_plan)(vectors[..., 0], vectors[..., 1]))


def vertical_force(data: xr.Dataset) -> FloatArray:
    """Return the axial force of the bearings (time, bearing), compression positive [N].

    Where vertical coupling is left out: that of the vertical springs, and what lifting the static
    load along the pendulum's path would have added, ``W / g`` times the acceleration of
    ``L - sqrt(L^2 - U^2)``.

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
    """Return 1 where a bearing's slider presses on a rim, else 0 (time, bearing)."""
    return formed(presses, _rim_force(data))


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
    return _values(data, name, "time", "bearing", *last)


def _values(data: xr.Dataset, name: str, *dims: str) -> FloatArray:
    # A variable in an order of its dimensions, without the coordinates that would cost time.
    return np.asarray(data.variables[name].transpose(*dims).to_numpy())


def formed(formula: Callable[..., float], *of: FloatArray) -> FloatArray:
    """Return what a formula of kernels makes of whole histories."""
    return np.asarray(on_arrays(formula)(*of))


def known(data: xr.Dataset, name: str) -> FloatArray:
    """Return a number of each bearing, or of each of its surfaces."""
    return np.asarray(data.variables[name].to_numpy())


def _rim_force(data: xr.Dataset) -> FloatArray:
    both = of_bearings(data, "rim_force", "surface")
    return formed(either, both[..., 0], both[..., 1])


def _interface_share(data: xr.Dataset) -> FloatArray:
    return formed(
        interface_share,
        of_bearings(data, "interface_force"),
        of_bearings(data, "axial_force"),
        known(data, "static_axial_force"),
        known(data, "interface_friction"),
    )


def _vertical_ratio(data: xr.Dataset) -> FloatArray:
    return formed(over_static, vertical_force(data), known(data, "static_axial_force"))


def _eccentricity(data: xr.Dataset, share: float) -> FloatArray:
    return formed(
        pressed_eccentricity,
        of_bearings(data, "interface_eccentricity"),
        known(data, "slider_radius"),
        of_bearings(data, "axial_force"),
        known(data, "static_axial_force"),
        np.array(share),
    )


def _violence(data: xr.Dataset) -> FloatArray:
    moves = np.linalg.norm(_node_acceleration(data)[..., :3], axis=-1)
    heavy = data.variables["node_mass"].to_numpy().max(axis=1) > 0.0
    return np.where((moves > VIOLENT) & heavy, moves, 0.0)


def _floor(data: xr.Dataset) -> FloatArray:
    return floor_acceleration(data).transpose("time", "level", "axis").to_numpy()


def _node_acceleration(data: xr.Dataset) -> FloatArray:
    return _values(data, "node_acceleration", "time", "node", "dof")


def _term(data: xr.Dataset, term: str) -> FloatArray:
    return formed(size, data["energy"].sel(term=term).to_numpy())


def _gap(data: xr.Dataset) -> FloatArray:
    energy = data["energy"]
    both = energy.sel(term="input"), energy.sel(term=list(ABSORBED)).sum("term")
    return formed(balance_gap, *(each.to_numpy() for each in both))


def _tilt(data: xr.Dataset) -> FloatArray:
    turn = data["body_rotation"].transpose("time", "bearing", "body", "axis")
    turns = turn.sel(body=["bottom_slider", "top_slider"]).to_numpy()
    tilts = np.hypot(turns[..., 0], turns[..., 1])  # NaN without contact points
    return np.asarray(tilts.max(axis=-1))


_B, _L, _H = ("bearing",), ("link",), ("hinge",)
QUANTITIES: dict[str, Quantity] = {
    "displacement": Quantity(
        _B,
        "m",
        "bearing displacement in plan",
        lambda d: in_plan(of_bearings(d, "bearing_displacement", "axis")),
        by_step=True,
    ),
    "displacement_along": Quantity(
        ("axis",),
        "m",
        "bearing displacement along each axis",
        lambda d: formed(size, of_bearings(d, "bearing_displacement", "axis")).max(axis=1),
    ),
    "rim_force": Quantity(_B, "N", "force of a rim", _rim_force, by_step=True, row="rim force"),
    "rims_met": Quantity(_B, "1", "1: a rim was met, first then", rims_met, by_step=True),
    "closing": Quantity(
        _B,
        "m/s",
        "speed along the slider's axis at which a rim was met with a slip",
        closing,
        by_step=True,
    ),
    "force": Quantity(
        _B,
        "N",
        "bearing force in plan",
        lambda d: in_plan(of_bearings(d, "bearing_force", "axis")),
        by_step=True,
        row="bearing force in plan",
    ),
    "axial_force": Quantity(
        _B,
        "N",
        "axial force",
        lambda d: of_bearings(d, "axial_force"),
        by_step=True,
        row="axial force",
    ),
    "axial_tension": Quantity(
        _B,
        "N",
        "negative of the minimum axial force",
        lambda d: formed(opposite, of_bearings(d, "axial_force")),
        by_step=True,
    ),
    "vertical_tension": Quantity(
        _B,
        "1",
        "negative of the least vertical force over the static one",
        lambda d: formed(opposite, _vertical_ratio(d)),
        by_step=True,
    ),
    "vertical_change": Quantity(
        _B,
        "1",
        "change of the vertical force over the static one",
        lambda d: formed(vertical_change, _vertical_ratio(d)),
        by_step=True,
    ),
    "lifted": Quantity(
        _B,
        "1",
        "1: lifted off, first then",
        lambda d: standing(d) * formed(is_lifted, _vertical_ratio(d)),
        by_step=True,
    ),
    "gap": Quantity(
        _B,
        "m",
        "gap of the axial contact",
        lambda d: uplift_gap(d).transpose("time", "bearing").to_numpy(),
        by_step=True,
    ),
    "sliding": Quantity(
        (*_B, "surface"),
        "m",
        "sliding on each surface",
        lambda d: in_plan(of_bearings(d, "slider_displacement", "surface", "axis")),
        by_step=True,
    ),
    "slip": Quantity(
        _B, "m", "interface slip", lambda d: of_bearings(d, "interface_slip_size"), by_step=True
    ),
    "interface_share": Quantity(
        _B,
        "1",
        "force of the interface over what its friction holds",
        _interface_share,
        by_step=True,
    ),
    "slipped": Quantity(
        _B,
        "1",
        "1: the interface slipped, first then",
        lambda d: formed(slips, _interface_share(d)),
        by_step=True,
    ),
    "eccentricity": Quantity(
        _B,
        "1",
        "interface eccentricity over slider radius, while pressed",
        lambda d: _eccentricity(d, PRESSED),
        by_step=True,
    ),
    "eccentricity_loaded": Quantity(
        _B,
        "1",
        "interface eccentricity over slider radius, while half of the load at rest presses",
        lambda d: _eccentricity(d, LOADED),
        by_step=True,
    ),
    "spin": Quantity(
        _B,
        "rad",
        "spin of the sliders",
        lambda d: formed(size, of_bearings(d, "slider_spin")),
        by_step=True,
    ),
    "centre_shift": Quantity(
        _B,
        "m",
        "shift of the spheres' centres by tilt of the plates",
        lambda d: in_plan(centre_shift(d)),
        by_step=True,
    ),
    "tilt": Quantity(_B, "rad", "tilt of a slider with contact points", _tilt),
    "temperature": Quantity(
        (*_B, "contact"),
        "degC",
        "temperature of what each contact slides on",
        lambda d: of_bearings(d, "temperature", "contact"),
    ),
    "base_shear": Quantity(
        (),
        "N",
        "base shear in plan",
        lambda d: in_plan(_values(d, "base_shear", "time", "axis")),
    ),
    "storey_shear": Quantity(
        ("storey",),
        "N",
        "storey shear in plan",
        lambda d: in_plan(_values(d, "storey_shear", "time", "storey", "axis")),
    ),
    "floor_plan": Quantity(
        ("level",),
        "m/s2",
        "floor acceleration in plan, mean of the level",
        lambda d: in_plan(_floor(d)),
    ),
    "floor_vertical": Quantity(
        ("level",),
        "m/s2",
        "floor acceleration, vertical, mean of the level",
        lambda d: formed(size, _floor(d)[..., 2]),
    ),
    "node_plan": Quantity(
        ("node",),
        "m/s2",
        "acceleration of a node in plan",
        lambda d: in_plan(_node_acceleration(d)),
    ),
    "node_vertical": Quantity(
        ("node",),
        "m/s2",
        "acceleration of a node, vertical",
        lambda d: formed(size, _node_acceleration(d)[..., 2]),
    ),
    "violence": Quantity(
        ("node",), "m/s2", "acceleration of a node with mass, 0 up to 50 g", _violence
    ),
    "imbalance": Quantity(
        ("resultant",),
        "1",
        "sum of all forces, or their moments, over the weight",
        lambda d: np.abs(_values(d, "imbalance", "time", "resultant")),
    ),
    "drift": Quantity(
        ("storey",), "1", "storey drift", lambda d: in_plan(storey_drift(d).to_numpy())
    ),
    "line_drift": Quantity(
        ("line",), "1", "drift of a line of nodes", lambda d: in_plan(drift_by_line(d).to_numpy())
    ),
    "energy_input": Quantity(
        (), "J", "work of the ground motion, absolute", lambda d: _term(d, "input")
    ),
    "energy_numerical": Quantity(
        (), "J", "work that the time integration leaves over", lambda d: _term(d, "numerical")
    ),
    "energy_gap": Quantity((), "J", "gap of the energy balance", _gap),
    "energy_yielding": Quantity(
        (), "J", "work that yielding took up", lambda d: _term(d, "yielding")
    ),
    "link_ductility": Quantity(_L, "1", "deformation of a link over that at yield", link_ductility),
    "link_deformation": Quantity(
        _L, "m, rad", "deformation of a link", lambda d: np.abs(of_links(d, "link_deformation"))
    ),
    "link_force": Quantity(
        _L, "N, N m", "force of a link", lambda d: np.abs(of_links(d, "link_force"))
    ),
    "link_reversal": Quantity(
        _L,
        "N, N m",
        "negative of the least force of a link",
        lambda d: -of_links(d, "link_force"),
    ),
    "link_work": Quantity(
        _L, "J", "work that a link has taken up", lambda d: of_links(d, "link_work")
    ),
    "hinge_rotation": Quantity(_H, "rad", "plastic rotation of a hinge", hinge_rotation),
    "hinge_turn": Quantity(
        _H, "rad", "plastic rotation run through", lambda d: of_hinges(d, "hinge_turn")
    ),
    "hinge_work": Quantity(
        _H, "J", "work that a hinge has dissipated", lambda d: of_hinges(d, "hinge_work")
    ),
}
"""Derived histories by name; what begins with "1:" is 0 before it happens."""

LEFT = ("displacement", "slip", "link_deformation", "link_work", "hinge_rotation", "hinge_work")
"""Quantities of which the value at the last step is kept, too."""
