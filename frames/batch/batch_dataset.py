"""Many results as one Dataset: peaks of each run, side by side along the dimension `run`."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from frames.bundles.peak_data import ENERGY_TERMS
from frames.results.findings import findings_from
from frames.results.peak_response import of_exceeded
from frames.results.peaks import Peak
from frames.results.recorded import is_of_all_steps
from lir_element.results.dataset import labelled

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from frames._types import FloatArray, IntArray
    from frames.batch.cases import Case
    from frames.results.findings import Findings

NUMBERS = {
    "energy_error": ("1", "largest gap of the energy balance over the largest input"),
    "numerical_share": ("1", "largest work that the time integration leaves over, over the input"),
    "steps": ("1", "steps accepted"),
    "halvings": ("1", "steps halved by adaptive substepping"),
    "seconds_loop": ("s", "time of the compiled loop"),
}
"""Numbers of each run besides its peaks: unit and meaning."""

_OF_END = "status", "message", "failed_at", "failed_where", "audit", "doubts", "findings"
_OF_PEAKS = "peak", "peak_time", "peak_where"
_SAME_TIME = 1e-9  # s


class Layout(NamedTuple):
    """Places of a structure's peaks in a row of numbers."""

    names: tuple[str, ...]
    dims: tuple[tuple[str, ...], ...]
    shapes: tuple[tuple[int, ...], ...]
    starts: IntArray  # (n + 1,)
    attrs: tuple[dict[str, Any], ...]
    labels: dict[str, tuple[str, ...]]  # names along each dimension


class RunResult(NamedTuple):
    """Results of one run."""

    place: int  # among the cases
    status: str
    message: str
    failed_at: float  # s, NaN of a run that is complete
    failed_where: str
    findings: Findings
    peaks: tuple[Peak, ...]
    numbers: dict[str, float]
    energy: FloatArray  # (n_terms,) at the last step
    reached: FloatArray
    layout: Layout | None  # None: there was no equilibrium to start from
    histories: xr.Dataset | None


def layout_of(judged: xr.Dataset) -> Layout:
    """Return the layout of the assumption check's input from a run."""
    names = tuple(
        str(name)
        for name, variable in judged.variables.items()
        if is_of_all_steps(name) and variable.dtype.kind == "f"
    )
    found = [judged.variables[name] for name in names]
    used = {str(dim) for variable in found for dim in variable.dims}
    return Layout(
        names=names,
        dims=tuple(tuple(str(dim) for dim in variable.dims) for variable in found),
        shapes=tuple(variable.shape for variable in found),
        starts=np.concatenate([[0], np.cumsum([variable.size for variable in found])]),
        attrs=tuple(dict(variable.attrs) for variable in found),
        labels={dim: _labels(judged, dim) for dim in used},
    )


def reached_row(judged: xr.Dataset, layout: Layout) -> FloatArray:
    """Return the peaks of a run as a row of numbers."""
    found = {name: judged.variables[name].values for name in layout.names} | of_exceeded(judged)
    return np.concatenate([np.ravel(found[name]) for name in layout.names])


def stack(
    rows: Sequence[RunResult], cases: Sequence[Case], digests: Mapping[str, str]
) -> xr.Dataset:
    """Join rows to a Dataset (docs/recording.md)."""
    rows = sorted(rows, key=lambda row: row.place)
    of = [cases[row.place] for row in rows]
    variables = _of_runs(rows) | _of_peaks(rows) | _of_reached(rows)
    coordinates: dict[str, Any] = {
        "run": np.array([row.place for row in rows], dtype=np.int64),
        "model": ("run", np.array([case.model for case in of], dtype=str)),
        "motion": ("run", np.array([case.motion for case in of], dtype=str)),
        "scale": ("run", np.array([case.scale for case in of])),
        "motion_digest": ("run", np.array([digests[case.motion] for case in of], dtype=str)),
        "term": list(ENERGY_TERMS),
    }
    units = {peak.quantity: peak.unit for row in rows for peak in row.peaks}
    coordinates["quantity"] = list(units)
    coordinates["unit"] = ("quantity", list(units.values()))
    labels = _union(layout.labels for layout in _unlike(rows))
    histories, more = _of_histories(rows)
    variables = _as_recorded(variables, labels, more)
    return xr.Dataset(variables | histories, coordinates | labels | more)


def row_of(data: xr.Dataset, place: int) -> RunResult:
    """Return the row that `stack` made runs of one row of."""
    one = data.isel(run=0)
    layout = layout_of(one)
    columns = "quantity", "peak", "unit", "peak_time", "peak_where"
    table = [one[name].to_numpy().tolist() for name in columns]
    energy = one["energy"].to_numpy()
    own = () if energy.ndim > 1 else ("energy",)  # a history if histories are kept
    known = {*layout.names, *_OF_END, *NUMBERS, *_OF_PEAKS, *own}
    histories = [name for name in one.data_vars if name not in known]
    return RunResult(
        place=place,
        status=one["status"].item(),
        message=one["message"].item(),
        failed_at=one["failed_at"].item(),
        failed_where=one["failed_where"].item(),
        findings=findings_from(json.loads(one["findings"].item())),
        peaks=tuple(Peak(*row) for row in zip(*table, strict=True)),
        numbers={name: one[name].item() for name in NUMBERS},
        energy=np.atleast_2d(energy)[-1],
        reached=reached_row(one, layout),
        layout=layout,
        histories=one[histories] if histories else None,
    )


def _as_recorded(
    variables: Mapping[str, xr.Variable],
    labels: Mapping[str, Sequence[str]],
    recorded: Mapping[str, Any],
) -> dict[str, xr.Variable]:
    # Peaks of the recorded bearings, nodes and so on, as in a single history.
    kept = {
        dim: [list(labels[dim]).index(str(name)) for name in recorded[dim]]
        for dim in labels
        if dim in recorded and list(recorded[dim]) != list(labels[dim])
    }
    return {
        name: variable.isel({dim: kept[dim] for dim in variable.dims if dim in kept})
        for name, variable in variables.items()
    }


def _texts(values: Iterable[str]) -> Any:
    found = list(values)
    out = np.empty(len(found), dtype=object)
    out[:] = found
    return out


def _of_runs(rows: Sequence[RunResult]) -> dict[str, xr.Variable]:
    # Status, message and numbers of each run.
    found = {
        "status": labelled(("run",), _texts(row.status for row in rows), "", "how the run ended"),
        "message": labelled(("run",), _texts(row.message for row in rows), "", "the same in words"),
        "failed_at": labelled(
            ("run",),
            np.array([row.failed_at for row in rows]),
            "s",
            "when it stopped; NaN where it is complete",
        ),
        "failed_where": labelled(
            ("run",), _texts(row.failed_where for row in rows), "", "bearing or degree of freedom"
        ),
        "audit": labelled(
            ("run",),
            _texts(repr(row.findings) for row in rows),
            "",
            "assumption check of the run, a line a finding",
        ),
        "doubts": labelled(
            ("run",),
            _texts("; ".join(row.findings.doubts()) for row in rows),
            "",
            'lines that the assumption check marks with "!"',
        ),
        "findings": labelled(
            ("run",),
            _texts(row.findings.json() for row in rows),
            "",
            "the assumption check as JSON: fields of `Finding`",
        ),
    }
    for name, (unit, meaning) in NUMBERS.items():
        values = np.array([row.numbers.get(name, math.nan) for row in rows])
        found[name] = labelled(("run",), values, unit, meaning)
    energy = np.array([row.energy for row in rows]).reshape(len(rows), len(ENERGY_TERMS))
    found["energy"] = labelled(
        ("run", "term"), energy, "J", "energy since gravity, at the last step"
    )
    return found


def _of_peaks(rows: Sequence[RunResult]) -> dict[str, xr.Variable]:
    # The tables of peaks, side by side.
    place = {name: k for k, name in enumerate({p.quantity: 0 for r in rows for p in r.peaks})}
    size = len(rows), len(place)
    value, time = np.full(size, np.nan), np.full(size, np.nan)
    where = np.full(size, "", dtype=object)
    for n, row in enumerate(rows):
        for peak in row.peaks:
            k = place[peak.quantity]
            value[n, k], time[n, k], where[n, k] = peak.value, peak.time, peak.where
    dims = ("run", "quantity")
    return {
        "peak": labelled(dims, value, "", "what was reached, in the unit of its quantity"),
        "peak_time": labelled(dims, time, "s", "when"),
        "peak_where": labelled(dims, where, "", "where"),
    }


def _of_reached(rows: Sequence[RunResult]) -> dict[str, xr.Variable]:
    # Peaks of each bearing, node, level: NaN if a run's structure has none.
    layouts = _unlike(rows)
    labels = _union(layout.labels for layout in layouts)
    found: dict[str, xr.Variable] = {}
    for layout in layouts:
        runs = np.array([n for n, row in enumerate(rows) if row.layout is layout])
        whole = np.stack([rows[n].reached for n in runs])
        for k, name in enumerate(layout.names):
            dims = layout.dims[k]
            if name not in found:
                size = (len(rows), *(len(labels[dim]) for dim in dims))
                found[name] = xr.Variable(("run", *dims), np.full(size, np.nan), layout.attrs[k])
            values = whole[:, layout.starts[k] : layout.starts[k + 1]]
            values = values.reshape(len(runs), *layout.shapes[k])
            at = _places(layout.labels, labels, dims)
            found[name].data[np.ix_(runs, *at)] = values
    return found


def _unlike(rows: Sequence[RunResult]) -> list[Layout]:
    # The layouts of the rows, each once.
    return list({id(row.layout): row.layout for row in rows if row.layout is not None}.values())


def _union(labels: Iterable[Mapping[str, tuple[str, ...]]]) -> dict[str, list[str]]:
    # All names along each dimension, in the order of their first appearance.
    found: dict[str, dict[str, None]] = {}
    for one in labels:
        for dim, names in one.items():
            found.setdefault(dim, {}).update(dict.fromkeys(names))
    return {dim: list(names) for dim, names in found.items()}


def _places(
    own: Mapping[str, tuple[str, ...]], union: Mapping[str, Sequence[str]], dims: Sequence[str]
) -> list[IntArray]:
    places = []
    for dim in dims:
        order = {name: k for k, name in enumerate(union[dim])}
        places.append(np.array([order[name] for name in own[dim]], dtype=np.int64))
    return places


def _labels(data: xr.Dataset, dim: str) -> tuple[str, ...]:
    return tuple(str(name) for name in data[dim].to_numpy())


def _of_histories(rows: Sequence[RunResult]) -> tuple[dict[str, xr.Variable], dict[str, Any]]:
    # Recorded histories: over `time` if all runs share a grid, else over `step`.
    whole = [(n, row.histories) for n, row in enumerate(rows) if row.histories is not None]
    if not whole:
        return {}, {}
    grids = [data["time"].to_numpy() for _, data in whole]
    longest = max(grids, key=len)
    shared = all(np.abs(grid - longest[: len(grid)]).max() < _SAME_TIME for grid in grids)
    axis = "time" if shared else "step"
    dims_of: dict[str, tuple[str, ...]] = {}
    attrs: dict[str, dict[str, Any]] = {}
    every = []
    for _, data in whole:
        for name, variable in data.data_vars.items():
            dims_of[str(name)] = tuple(str(dim) for dim in variable.dims)
            attrs[str(name)] = dict(variable.attrs)
        used = {str(dim) for variable in data.data_vars.values() for dim in variable.dims}
        every.append({dim: _labels(data, dim) for dim in used if dim != "time"})
    labels = _union(every)
    found: dict[str, xr.Variable] = {}
    for name, dims in dims_of.items():
        size = [len(longest) if dim == "time" else len(labels[dim]) for dim in dims]
        values = np.full((len(rows), *size), np.nan)
        for (n, data), own in zip(whole, every, strict=True):
            if name in data:
                at = _places_in_time(own, labels, dims, data.sizes["time"])
                values[np.ix_(np.array([n]), *at)] = data[name].to_numpy()[None]
        renamed = tuple(axis if dim == "time" else dim for dim in dims)
        found[name] = xr.Variable(("run", *renamed), values, attrs[name])
    if shared:
        return found, labels | {"time": labelled(("time",), longest, "s", "time")}
    times = np.full((len(rows), len(longest)), np.nan)
    for (n, _), grid in zip(whole, grids, strict=True):
        times[n, : len(grid)] = grid
    found["time"] = labelled(("run", "step"), times, "s", "time of each step; NaN beyond the last")
    return found, labels


def _places_in_time(
    own: Mapping[str, tuple[str, ...]],
    union: Mapping[str, Sequence[str]],
    dims: Sequence[str],
    steps: int,
) -> list[IntArray]:
    return [np.arange(steps) if dim == "time" else _places(own, union, (dim,))[0] for dim in dims]
