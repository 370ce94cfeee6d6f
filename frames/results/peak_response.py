"""What a time history reached: largest values of derived histories, their times, a few totals.

The assumption check, the judgement of the energy and the table of peaks rest on these numbers
alone. A result with all steps has them in its histories. A recording that leaves steps out takes
them up while the run goes on, at every base step, and keeps them as variables ``reached_...``: so
both give the same.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.peak_data import FULL_SLIP, LEAST_SHARE, PRESSED
from frames.results.hinge_extremes import hinge_rotation, link_ductility, of_hinges, of_links
from frames.results.measures import (
    ABSORBED,
    centre_shift,
    drift_by_line,
    floor_acceleration,
    lines_of,
    storey_drift,
    uplift_gap,
)
from frames.results.recorded import REACHED, largest_kept
from lir_element.kernels.friction_law import fill_left
from lir_element.layout import FRICTION_TABLE
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from frames._types import BoolArray, FloatArray

VIOLENT = 50.0 * STANDARD_GRAVITY
"""Acceleration of a node from which on it is looked at [m/s2]."""


class Quantity(NamedTuple):
    """A derived history (time, ...) of which the largest value counts."""

    dims: tuple[str, ...]
    unit: str
    meaning: str
    of: Callable[[xr.Dataset], FloatArray]


class Extreme(NamedTuple):
    """The largest values of a quantity and when they were reached."""

    values: FloatArray
    at: FloatArray  # s


def largest(data: xr.Dataset, name: str) -> Extreme:
    """Return what was reached of a quantity.

    Parameters
    ----------
    data : xarray.Dataset
        Of a time history.
    name : str
        One of `QUANTITIES`.

    Returns
    -------
    Extreme
        Largest values over the quantity's dimensions, and their times [s]: of all base steps where
        the recording kept them, else of the steps that `data` holds; and of the step at which a
        bearing passed its limit, which is in no history.
    """
    kept = largest_kept(data, name)
    if kept is None:
        kept = extreme_of(QUANTITIES[name].of(data), data["time"].to_numpy())
    return _with_exceeded(data, name, Extreme(*kept))


def _with_exceeded(data: xr.Dataset, name: str, found: Extreme) -> Extreme:
    # With what ended the run, unless `data` is a part of it that ends before.
    attrs = data.attrs
    if attrs.get("exceeded") != name:
        return found
    at = float(attrs["exceeded_at"])
    where = data.variables["bearing"].to_numpy() == attrs["exceeded_bearing"]
    ends = computed_until(data) + 1.5 * float(attrs.get("dt", math.inf)) >= at
    beyond = np.where(where & ends, float(attrs["exceeded_value"]), -math.inf)
    return later(found, Extreme(beyond, np.full(len(beyond), at)))


def with_exceeded(data: xr.Dataset) -> xr.Dataset:
    """Return a result whose variables ``reached_...`` count the step that a limit ended, too."""
    name = str(data.attrs.get("exceeded", ""))
    kept = largest_kept(data, name) if name else None
    if kept is None:
        return data
    found = zip((REACHED + name, f"{REACHED}{name}_at"), largest(data, name), strict=True)
    return data.assign({key: data[key].copy(data=values) for key, values in found})


def extreme_of(history: FloatArray, time: FloatArray) -> Extreme:
    """Return the largest of a history (time, ...) and when; NaN where it has one."""
    at = np.argmax(history, axis=0)
    return Extreme(np.take_along_axis(history, at[None], axis=0)[0], time[at])


def later(old: Extreme, new: Extreme) -> Extreme:
    """Return the larger of both, the older where they are equal; what is not a number stays so."""
    more = (new.values > old.values) | (np.isnan(new.values) & ~np.isnan(old.values))
    return Extreme(np.where(more, new.values, old.values), np.where(more, new.at, old.at))


def total(data: xr.Dataset, name: str) -> FloatArray:
    """Return a sum over the steps of a time history: one of `TOTALS`."""
    if REACHED + name in data.variables:
        return data.variables[REACHED + name].to_numpy()
    return TOTALS[name].of(data, 0, data.sizes["time"])


def left(data: xr.Dataset, name: str) -> FloatArray:
    """Return a quantity of `LEFT` at the last step of the run."""
    if f"{REACHED}{name}_left" in data.variables:
        return data.variables[f"{REACHED}{name}_left"].to_numpy()
    return np.asarray(QUANTITIES[name].of(data)[-1])


def remaining(data: xr.Dataset, name: str) -> FloatArray:
    """Return the same of a run that went to its end; NaN of one that stopped before."""
    ended = data.attrs["status"] == "ok"  # one that was interrupted has no time of failure
    return left(data, name) * (1.0 if ended else math.nan)


def computed_until(data: xr.Dataset) -> float:
    """Return the time of the last base step of a run [s]."""
    name = "until"
    kept = data.variables.get(REACHED + name)
    return float(data["time"][-1]) if kept is None else float(kept)


def storeys_of_lines(data: xr.Dataset) -> tuple[list[str], list[str]]:
    """Return the names of the lines of nodes over one another, and of the storey of each."""
    if f"{REACHED}line_storey" in data.variables:
        both = (data.variables[key].to_numpy() for key in ("line", f"{REACHED}line_storey"))
        lines, storeys = ([str(name) for name in each] for each in both)
        return lines, storeys
    _, upper, level = lines_of(data)
    names, levels = data["node"].to_numpy(), data["level"].to_numpy()
    return [str(names[k]) for k in upper], [str(levels[k]) for k in level]


def in_plan(values: FloatArray) -> FloatArray:
    """Return the sizes of the horizontal parts of vectors (..., 3) or (..., 2)."""
    return np.asarray(np.linalg.norm(np.asarray(values)[..., :2], axis=-1))


def vertical_force(data: xr.Dataset) -> FloatArray:
    """Return the axial force of the bearings (time, bearing), compression positive [N].

    Where vertical coupling is left out: that of the vertical springs, and what lifting the static
    load along the pendulum's path would have added, ``W / g`` times the acceleration of
    ``L - sqrt(L^2 - U^2)``.

    Parameters
    ----------
    data : xarray.Dataset
        Of a time history.

    Returns
    -------
    ndarray, (n_steps, n_bearings)
        Axial forces [N].
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
    met = (_of(data, "rim_force", "surface") > 0.0).any(axis=-1)
    return np.asarray(met, dtype=np.float64)


def _of(data: xr.Dataset, name: str, *last: str) -> FloatArray:
    # The history of a variable of bearings (time, bearing, ...).
    return _values(data, name, "time", "bearing", *last)


def _values(data: xr.Dataset, name: str, *dims: str) -> FloatArray:
    # A variable in an order of its dimensions, without the coordinates that would cost time.
    return np.asarray(data.variables[name].transpose(*dims).to_numpy())


def _sliding(data: xr.Dataset) -> FloatArray:
    return in_plan(_of(data, "slider_displacement", "surface", "axis"))


def _interface_share(data: xr.Dataset) -> FloatArray:
    normal = np.maximum(
        _of(data, "axial_force"), LEAST_SHARE * data.variables["static_axial_force"].to_numpy()
    )
    holds = data.variables["interface_friction"].to_numpy() * normal
    return np.asarray(_of(data, "interface_force") / holds)


def _vertical_ratio(data: xr.Dataset) -> FloatArray:
    return np.asarray(vertical_force(data) / data.variables["static_axial_force"].to_numpy())


def _eccentricity(data: xr.Dataset) -> FloatArray:
    pressed = _of(data, "axial_force") > PRESSED * data.variables["static_axial_force"].to_numpy()
    shares = _of(data, "interface_eccentricity") / data.variables["slider_radius"].to_numpy()
    return np.where(pressed, shares, 0.0)


def _violence(data: xr.Dataset) -> FloatArray:
    moves = np.linalg.norm(_node_acceleration(data)[..., :3], axis=-1)
    heavy = data.variables["node_mass"].to_numpy().max(axis=1) > 0.0
    return np.where((moves > VIOLENT) & heavy, moves, 0.0)


def _floor(data: xr.Dataset) -> FloatArray:
    return floor_acceleration(data).transpose("time", "level", "axis").to_numpy()


def _node_acceleration(data: xr.Dataset) -> FloatArray:
    return _values(data, "node_acceleration", "time", "node", "dof")


def _term(data: xr.Dataset, term: str) -> FloatArray:
    return np.asarray(np.abs(data["energy"].sel(term=term).to_numpy()))


def _gap(data: xr.Dataset) -> FloatArray:
    energy = data["energy"]
    gap = energy.sel(term="input") - energy.sel(term=list(ABSORBED)).sum("term")
    return np.asarray(np.abs(gap.to_numpy()))


def _tilt(data: xr.Dataset) -> FloatArray:
    turn = data["body_rotation"].transpose("time", "bearing", "body", "axis")
    turns = turn.sel(body=["bottom_slider", "top_slider"]).to_numpy()
    tilts = np.hypot(turns[..., 0], turns[..., 1])  # NaN without contact points
    return np.asarray(tilts.max(axis=-1))


def _flag(mask: BoolArray) -> FloatArray:
    return np.asarray(mask, dtype=np.float64)


_B, _L, _H = ("bearing",), ("link",), ("hinge",)
QUANTITIES: dict[str, Quantity] = {
    "displacement": Quantity(
        _B,
        "m",
        "bearing displacement in plan",
        lambda d: in_plan(_of(d, "bearing_displacement", "axis")),
    ),
    "displacement_along": Quantity(
        ("axis",),
        "m",
        "bearing displacement along each axis",
        lambda d: np.abs(_of(d, "bearing_displacement", "axis")).max(axis=1),
    ),
    "force": Quantity(
        _B, "N", "bearing force in plan", lambda d: in_plan(_of(d, "bearing_force", "axis"))
    ),
    "axial_force": Quantity(_B, "N", "axial force", lambda d: _of(d, "axial_force")),
    "axial_tension": Quantity(
        _B, "N", "negative of the minimum axial force", lambda d: -_of(d, "axial_force")
    ),
    "vertical_tension": Quantity(
        _B,
        "1",
        "negative of the least vertical force over the static one",
        lambda d: -_vertical_ratio(d),
    ),
    "vertical_change": Quantity(
        _B,
        "1",
        "change of the vertical force over the static one",
        lambda d: np.abs(_vertical_ratio(d) - 1.0),
    ),
    "lifted": Quantity(
        _B, "1", "1: lifted off, first then", lambda d: _flag(_vertical_ratio(d) <= 0.0)
    ),
    "gap": Quantity(
        _B,
        "m",
        "gap of the axial contact",
        lambda d: uplift_gap(d).transpose("time", "bearing").to_numpy(),
    ),
    "sliding": Quantity((*_B, "surface"), "m", "sliding on each surface", _sliding),
    "rim_force": Quantity(
        _B, "N", "force of a rim", lambda d: _of(d, "rim_force", "surface").max(axis=-1)
    ),
    "rims_met": Quantity(_B, "1", "1: a rim was met, first then", rims_met),
    "slip": Quantity(_B, "m", "interface slip", lambda d: _of(d, "interface_slip_size")),
    "interface_share": Quantity(
        _B, "1", "force of the interface over what its friction holds", _interface_share
    ),
    "slipped": Quantity(
        _B,
        "1",
        "1: the interface slipped, first then",
        lambda d: _flag(_interface_share(d) >= FULL_SLIP),
    ),
    "eccentricity": Quantity(
        _B, "1", "interface eccentricity over slider radius, while pressed", _eccentricity
    ),
    "spin": Quantity(_B, "rad", "spin of the sliders", lambda d: np.abs(_of(d, "slider_spin"))),
    "tilt": Quantity(_B, "rad", "tilt of a slider with contact points", _tilt),
    "temperature": Quantity(
        (*_B, "contact"),
        "degC",
        "temperature of what each contact slides on",
        lambda d: _of(d, "temperature", "contact"),
    ),
    "centre_shift": Quantity(
        _B,
        "m",
        "shift of the spheres' centres by tilt of the plates",
        lambda d: np.linalg.norm(centre_shift(d), axis=-1),
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
        lambda d: np.abs(_floor(d)[..., 2]),
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
        lambda d: np.abs(_node_acceleration(d)[..., 2]),
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


class Total(NamedTuple):
    """A sum over steps first <= k < last of a Dataset that holds the step before the first, too."""

    dims: tuple[str, ...]
    unit: str
    meaning: str
    of: Callable[[xr.Dataset, int, int], FloatArray]


def _slid(data: xr.Dataset, first: int, last: int) -> tuple[FloatArray, FloatArray]:
    # Speed of sliding and load on it at some steps.
    part = slice(first, last)
    load = np.maximum(_of(data, "axial_force")[part], 0.0)[..., None]
    return _of(data, "sliding_speed", "surface")[part], load


def _work(data: xr.Dataset, first: int, last: int) -> FloatArray:
    speed, load = _slid(data, first, last)
    return np.asarray((load * data.variables["friction_max"].to_numpy() * speed).sum())


def _work_lower(data: xr.Dataset, first: int, last: int) -> FloatArray:
    speed, load = _slid(data, first, last)
    drop, rate = (data.variables[f"friction_{name}"].to_numpy() for name in ("drop", "rate"))
    tables = np.zeros((*drop.shape, FRICTION_TABLE))
    if "friction_table" in data:
        tables = data.variables["friction_table"].transpose("bearing", "surface", ...).to_numpy()
    lower = np.zeros((len(speed), drop.size))
    fill_left(
        drop.ravel(),
        rate.ravel(),
        np.ascontiguousarray(tables).reshape(drop.size, -1),
        np.ascontiguousarray(speed).reshape(lower.shape),
        lower,
    )
    return np.asarray((load * lower.reshape(speed.shape) * speed).sum())


def _work_pressed(data: xr.Dataset, first: int, last: int) -> FloatArray:
    if "pressure_rate" not in data:
        return np.zeros(())
    speed, load = _slid(data, first, last)
    rate, at = (data.variables[name].to_numpy() for name in ("pressure_rate", "pressure_load"))
    changed = np.abs(1.0 - np.exp(-rate[:, None] * (load - at[:, None])))
    return np.asarray((load * data.variables["friction_max"].to_numpy() * changed * speed).sum())


def _work_heated(data: xr.Dataset, first: int, last: int) -> FloatArray:
    if "softening_rate" not in data:
        return np.zeros(())
    speed, load = _slid(data, first, last)
    scale, rate, rest = (
        data.variables[f"softening_{name}"].to_numpy()[:, None]
        for name in ("scale", "rate", "rest")
    )
    surfaces = _of(data, "temperature", "contact")[first:last, :, :2]
    heated = np.isfinite(surfaces)  # of some bearings only
    changed = np.abs(1.0 - scale * (rest + np.exp(-rate * np.where(heated, surfaces, 0.0))))
    work = load * data.variables["friction_max"].to_numpy() * np.where(heated, changed, 0.0)
    return np.asarray((work * speed).sum())


def _uplifts(data: xr.Dataset, first: int, last: int) -> FloatArray:
    lifted = _of(data, "axial_force") <= 0.0
    begins = np.concatenate([lifted[:1], lifted[1:] & ~lifted[:-1]])
    return np.asarray(begins[first:last].sum(), dtype=np.float64)


def _time_lifted(data: xr.Dataset, first: int, last: int) -> FloatArray:
    first = max(first, 1)
    steps = np.diff(data.variables["time"].to_numpy())[first - 1 : last - 1]
    lifted = _of(data, "axial_force")[first:last] <= 0.0
    return np.asarray((steps[:, None] * lifted).sum(axis=0))


TOTALS: dict[str, Total] = {
    "sliding_work": Total(
        (), "N m/s", "sum over steps and surfaces: load, friction at high speed, speed", _work
    ),
    "sliding_work_lower": Total(
        (), "N m/s", "the same with what friction is below that at high speed", _work_lower
    ),
    "sliding_work_pressed": Total(
        (), "N m/s", "the same with what the pressure changes of that", _work_pressed
    ),
    "sliding_work_heated": Total(
        (), "N m/s", "the same with what the temperature changes of that", _work_heated
    ),
    "uplifts": Total((), "1", "how often bearings lifted off", _uplifts),
    "time_lifted": Total(_B, "s", "uplift duration", _time_lifted),
}
"""Sums over the steps by name."""
