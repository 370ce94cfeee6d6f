"""From a result and its model to the data of the page: thinned, packed, described."""

from __future__ import annotations

import heapq
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from frames.assembly.assemble import assemble
from frames.plots.plot_choice import choose_bearing, in_window
from frames.recording.recovery import require_own
from frames.results.findings import doubts_of
from frames.results.measures import floor_acceleration, storey_drift
from frames.results.quantities import QUANTITIES
from frames.results.recorded import EVERY_STEP
from frames.viewer.structure import (
    SLIPS,
    Movements,
    devices,
    exact,
    movements,
    peaks_of,
    scaled,
    structure_of,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    import xarray as xr

    from frames._types import BoolArray, FloatArray, IntArray
    from frames.frame import Frame


SHAPE_ERROR = 1e-3
"""Allowed error of nodal displacements by their shapes, over the largest displacement [-]."""

_FEWEST = 200  # steps that are kept, however large the model
_SHAPES = 40  # assumed size of a step, before it is known
_SNAPSHOTS = 800  # instants that shapes are found from, at most
_ARM = 3.0  # m, by which rotations of nodes count


class ShownCheck(Protocol):
    """A check as a page shows it: `frames.design.Check` is one."""

    @property
    def verdict(self) -> str:
        """Outcome: one of `Verdict` of `frames.design.Check`."""

    @property
    def title(self) -> str:
        """Checked quantity."""

    @property
    def concerns(self) -> str:
        """Part, bound and level."""

    @property
    def relation(self) -> str:
        """Relation of demand and limit: "<=" or ">="."""

    @property
    def said(self) -> tuple[str, str, str]:
        """Demand, limit and ratio as text."""

    @property
    def ratio(self) -> float:
        """Utilisation."""

    @property
    def cited(self) -> str:
        """The clause."""

    @property
    def note(self) -> str:
        """Further remark."""


class Payload(NamedTuple):
    """Data of the page, and the numbers of its steps and of all steps."""

    content: dict[str, object]  # for JSON
    kept: int  # numbers of steps
    recorded: int


class Response(NamedTuple):
    """Histories of one quantity."""

    name: str  # its title, and the unit shown
    unit: str
    factor: float  # from SI to that unit
    places: tuple[str, ...]  # levels, storeys, or other places
    values: FloatArray  # (n_steps, n_places, 2) along x and y, SI


class Shapes(NamedTuple):
    """Displacements over time as ``histories @ shapes``."""

    histories: FloatArray  # (n_steps, r) how much of each shape there is
    shapes: FloatArray  # (r, n) the shapes [m, rad]
    error: float  # largest difference from the displacements, rotations times the arm [m]


def payload_of(
    data: xr.Dataset, model: Frame, checks: Iterable[ShownCheck], size: float
) -> Payload:
    """Return the data of the page of a time history."""
    data = in_window(data, None, None)
    system = assemble(model)
    require_own(model, system, data)
    time = np.asarray(data["time"].to_numpy(), dtype=np.float64)
    worst = choose_bearing({"the Dataset": data}, None)
    moved, shown = movements(data), responses(data)
    nodes = data["node_displacement"].transpose("time", "node", "dof").to_numpy()
    _require_finite(moved, shown, nodes)
    steps = _steps(time, moved, shown, size)
    shapes = as_shapes(nodes[steps].astype(np.float64), _ARM, SHAPE_ERROR)
    names = [str(name) for name in data["bearing"].to_numpy()]
    content: dict[str, object] = {
        "title": str(data.attrs.get("title", model.name)).removeprefix("time history of "),
        "facts": _facts(data),
        "warnings": list(doubts_of(data)),
        "time": exact(time[steps], "float64"),
        "structure": structure_of(model, system),
        "shapes": scaled(shapes.shapes, along=1),
        "shapeHistories": scaled(shapes.histories),
        "devices": devices(data),
        "worst": names.index(worst),
        "bearings": _packed(moved, steps),
        "peaks": peaks_of(time, moved),
        "responses": [{**one._asdict(), "values": scaled(one.values[steps])} for one in shown],
        "checks": [_line(check, names) for check in checks],
        "kept": _said_of(time, moved, shown, steps, shapes.error),
    }
    return Payload(content, len(steps), len(time))


def _steps(time: FloatArray, moved: Movements, shown: list[Response], size: float) -> IntArray:
    # As many as the size allows, of all numbers that a step has.
    numbers = sum(values[0].size for values in moved[:-1]) + sum(r.values[0].size for r in shown)
    a_step = (2 * (numbers + _SHAPES) + moved.contacts[0].size + 8) * 4.0 / 3.0
    curves = np.hstack([_over_largest(v) for v in (*moved[:-1], *(r.values for r in shown))])
    contact = np.asarray((moved.contacts & ~np.uint8(SLIPS)).any(axis=1))
    return kept_steps(time, curves, contact, max(_FEWEST, int(1e6 * size / a_step)))


def _over_largest(values: FloatArray) -> FloatArray:
    # Curves (n_steps, m) over the largest of all of them.
    largest = float(np.abs(values).max(initial=0.0))
    return values.reshape(len(values), -1) / (largest if largest > 0.0 else 1.0)


def _packed(moved: Movements, steps: IntArray) -> dict[str, object]:
    histories = {name: values[steps] for name, values in moved._asdict().items()}
    contacts = exact(histories.pop("contacts"), "uint8")
    return {"contacts": contacts, **{name: scaled(one) for name, one in histories.items()}}


def _facts(data: xr.Dataset) -> dict[str, str]:
    named = {
        "motion": "motion",
        "level": "level of model fidelity",
        "status": "status",
        "message": "",
        "recording": "recording",
        "source": "computed with",
    }
    found = {label or key: str(data.attrs.get(key, "")) for key, label in named.items()}
    for name, usual in (("status", "ok"), ("message", "completed"), ("recording", EVERY_STEP)):
        if found[name] == usual:
            found.pop(name)
    return {name: text for name, text in found.items() if text}


def _said_of(
    time: FloatArray,
    moved: Movements,
    shown: list[Response],
    steps: IntArray,
    shape_error: float,
) -> dict[str, object]:
    # Omissions of the page: numbers of steps, and errors over the largest value [-].
    groups = {
        "displacement": moved.displacement,
        "force": moved.force,
        "rim force": moved.rim_force,
        "interface slip": moved.slip,
    } | {one.name: one.values for one in shown}
    errors = {
        name: line_error(time, _over_largest(values), steps) for name, values in groups.items()
    }
    return {
        "steps": len(steps),
        "recorded": len(time),
        "errors": errors,
        "shapeError": shape_error,
    }


def _line(check: ShownCheck, bearings: list[str]) -> dict[str, object]:
    demand, limit, ratio = check.said
    named = [k for k, name in enumerate(bearings) if name in check.concerns.split(", ")]
    return {
        "verdict": check.verdict,
        "title": check.title,
        "concerns": check.concerns,
        "demand": demand,
        "relation": check.relation,
        "limit": limit,
        "ratio": ratio,
        "rank": min(check.ratio, 1e9),
        "clause": check.cited,
        "note": check.note,
        "bearing": named[0] if named else None,
    }


def _require_finite(moved: Movements, shown: list[Response], nodes: FloatArray) -> None:
    named = {**moved._asdict(), "node_displacement": nodes} | {r.name: r.values for r in shown}
    for name, values in named.items():
        good = np.isfinite(values).reshape(len(values), -1).all(axis=1)
        if not good.all():
            step = int(np.argmin(good))
            msg = (
                f"{name.replace('_', ' ')} of step {step} of {len(values)} is not finite: view the "
                f"part before it, data.isel(time=slice(0, {step}))"
            )
            raise ValueError(msg)


def responses(data: xr.Dataset) -> list[Response]:
    """Return the histories of floors and storeys that a result has, and of its base."""
    found = []
    levels = data.sizes.get("level", 0)
    if levels and "node_acceleration" in data:
        moves = floor_acceleration(data).sel(axis=["x", "y"])
        found.append(_response("floor acceleration", "floor_plan", moves, "level"))
    if levels > 1:
        found.append(_response("storey drift", "drift", storey_drift(data), "storey"))
    for variable, like, place in (
        ("storey_shear", "storey_shear", "storey"),
        ("base_shear", "base_shear", ""),
        ("ground_acceleration", "floor_plan", ""),
    ):
        if variable in data and data[variable].size:
            part = data[variable].sel(axis=["x", "y"])
            found.append(_response(variable.replace("_", " "), like, part, place))
    return found


def _response(name: str, like: str, values: xr.DataArray, place: str) -> Response:
    # In the unit of a quantity.
    if not place:
        values, place = values.expand_dims("place"), "place"
    numbers = values.transpose("time", place, "axis").to_numpy().astype(np.float64)
    named = place in values.coords
    places = tuple(map(str, values[place].to_numpy())) if named else (name,)
    return Response(name, *QUANTITIES[like].in_figures, places, numbers)


def as_shapes(moves: FloatArray, arm: float, tolerance: float) -> Shapes:
    """Return displacements of nodes as the fewest shapes that hold them (their proper modes).

    Shapes: moves (n_steps, n_nodes, 6).
    """
    weights = np.array([1.0, 1.0, 1.0, arm, arm, arm])
    table = (moves * weights).reshape(len(moves), -1)
    every = -(-len(table) // _SNAPSHOTS)
    sizes = np.abs(table).max(axis=1)
    snapshots = np.vstack([table[::every], table[[int(sizes.argmax())]]])
    basis = np.linalg.svd(snapshots, full_matrices=False)[2]
    allowed = tolerance * float(sizes.max())
    low, high = 0, len(basis)
    while low < high:  # the fewest that are enough
        middle = (low + high) // 2
        if _error(table, basis[:middle]) <= allowed:
            high = middle
        else:
            low = middle + 1
    chosen = basis[:low]
    shapes = (chosen.reshape(low, moves.shape[1], 6) / weights).reshape(chosen.shape)
    return Shapes(table @ chosen.T, shapes, _error(table, chosen))


def _error(table: FloatArray, basis: FloatArray) -> float:
    return float(np.abs(table - (table @ basis.T) @ basis).max())


CONTACT = 4.0
"""Factor on an error during rim contact or after a bearing has lifted."""

WINDOW = 0.02
"""Time before and after it in which that holds [s]."""


def kept_steps(time: FloatArray, curves: FloatArray, contact: BoolArray, count: int) -> IntArray:
    """Return the steps between which straight lines follow the curves best.

    The first and the last step and the extremes of each curve are kept. Then, repeatedly, the step
    that is farthest off the line between its kept neighbours.

    Shapes: time (n_steps,), curves (n_steps, m), contact (n_steps,).
    """
    if count >= len(time):
        return np.arange(len(time))
    weights = np.where(_widened(time, contact), CONTACT, 1.0)
    kept = set(_extremes(curves).tolist())
    order = sorted(kept)
    heap = [_farthest(time, curves, weights, *ends) for ends in pairwise(order)]
    heapq.heapify(heap)
    while heap and len(kept) < count:
        error, first, step, last = heapq.heappop(heap)
        if not error < 0.0:
            break
        kept.add(step)
        for ends in ((first, step), (step, last)):
            heapq.heappush(heap, _farthest(time, curves, weights, *ends))
    return np.array(sorted(kept), dtype=np.int64)


def line_error(time: FloatArray, curves: FloatArray, kept: IntArray) -> float:
    """Return the largest distance of recorded curves (n_steps, m) from lines between kept steps."""
    place = np.searchsorted(kept, np.arange(len(time)), side="right").clip(1, len(kept) - 1)
    first, last = kept[place - 1], kept[place]
    share = ((time - time[first]) / (time[last] - time[first]))[:, None]
    return float(np.abs(curves - (1.0 - share) * curves[first] - share * curves[last]).max())


def _extremes(curves: FloatArray) -> IntArray:
    ends = np.array([0, len(curves) - 1])
    return np.unique(np.concatenate([ends, curves.argmax(axis=0), curves.argmin(axis=0)]))


def _widened(time: FloatArray, where: BoolArray) -> BoolArray:
    # Also steps less than the window away from a marked step.
    at = time[where]
    if not len(at):
        return where
    after = np.searchsorted(at, time - WINDOW)
    nearest = at[after.clip(max=len(at) - 1)]
    return np.asarray(np.abs(nearest - time) <= WINDOW) | where


def _farthest(
    time: FloatArray, curves: FloatArray, weights: FloatArray, first: int, last: int
) -> tuple[float, int, int, int]:
    # Minus the largest weighed error between two kept steps, and the step that has it: heaps give
    # the smallest.
    if last - first < 2:
        return 0.0, first, first, last
    inside = slice(first + 1, last)
    share = ((time[inside] - time[first]) / (time[last] - time[first]))[:, None]
    line = curves[first] + share * (curves[last] - curves[first])
    errors = np.abs(curves[inside] - line).max(axis=1) * weights[inside]
    step = int(errors.argmax())
    return -float(errors[step]), first, first + 1 + step, last
