"""Histories made smaller as a run goes on: steps and variables chosen, running extremes of all."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from frames.recording.recording import Recording
from frames.results.envelopes import EXTREMES
from frames.results.formulas import rims_met
from frames.results.peak_response import Extreme, extreme_of, larger_of, storeys_of_lines
from frames.results.quantities import LEFT, PEAKS, QUANTITIES, TOTALS
from frames.results.recorded import PEAK
from lir_element.results.dataset import labelled

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames._types import BoolArray, FloatArray, IntArray

    Columns = dict[str, Any]

UNTIL = f"{PEAK}until"
"""Variable that holds the time of the last base step of a run."""

_SAME_TIME = 1e-9  # s: times that differ by less are one


class _Held(NamedTuple):
    # Steps that a later rim contact may still need.
    columns: Columns  # variables (n, ...)
    step: IntArray  # (n,)
    met: BoolArray  # (n,) rim contact


class _State(NamedTuple):
    # State of the reduction; replaced in one assignment, so that no interruption finds half of it.
    taken: int  # base steps processed, the first one (at rest) included
    parts: tuple[Columns, ...]  # recorded part, piece by piece
    held: _Held | None
    last_contact: float  # s
    last_kept: int  # base step
    reached: dict[str, Extreme]
    totals: dict[str, FloatArray]
    extremes: dict[str, tuple[Extreme, Extreme]]  # of -values: the smallest
    tail: xr.Dataset | None  # the last piece's last step and all that has no time


class PeakState(NamedTuple):
    """Peaks of a run, by quantity."""

    reached: dict[str, Extreme]
    totals: dict[str, FloatArray]
    left: dict[str, FloatArray]
    """Values of the quantities in `LEFT` at the last step."""
    until: float
    """Time of that step [s]."""


def with_peak_state(data: xr.Dataset, found: PeakState) -> xr.Dataset:
    """Return a result without histories with the peaks of its run, for the check."""
    variables: dict[str, xr.Variable] = {}
    for name, most in found.reached.items():
        (dims, unit, *_), text = QUANTITIES[name], QUANTITIES[name].described
        variables[PEAK + name] = labelled(dims, most.values, unit, text)
        variables[f"{PEAK}{name}_at"] = labelled(dims, most.at, "s", f"time of: {text}")
    for name, value in found.totals.items():
        dims, unit, meaning = QUANTITIES[name][:3]
        variables[PEAK + name] = labelled(dims, value, unit, meaning)
    for name, value in found.left.items():
        dims, unit, meaning = QUANTITIES[f"{name}_left"][:3]
        variables[f"{PEAK}{name}_left"] = labelled(dims, value, unit, meaning)
    variables[UNTIL] = labelled((), found.until, "s", "time of the last base step")
    coordinates: dict[str, Any] = {}
    if "line_drift" in found.reached:
        lines, storeys = storeys_of_lines(data)
        variables[f"{PEAK}line_storey"] = xr.Variable(("line",), storeys)
        coordinates["line"] = lines
    return data.assign_coords(coordinates).assign(variables)


def put_peak_state(
    data: xr.Dataset,
    found: PeakState,
    peak: FloatArray,
    common: Mapping[str, xr.Variable],
) -> xr.Dataset:
    """Write the numbers of another run into a result of `with_peak_state`, and return it.

    `common` are variables of the run's structure. Shapes: peak (3,).
    """
    values: dict[str, Any] = {name: each.data for name, each in common.items()}
    for name, most in found.reached.items():
        values[PEAK + name], values[f"{PEAK}{name}_at"] = most
    values |= {PEAK + name: value for name, value in found.totals.items()}
    values |= {f"{PEAK}{name}_left": value for name, value in found.left.items()}
    values |= {UNTIL: np.array(found.until), "peak_ground_velocity": peak}
    variables = data.variables
    for name, value in values.items():
        variables[name].data = value
    return data


class Reduction:
    """Reduction of a run to its recording, piece by piece."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording
        self._state = _State(0, (), None, -np.inf, -1, {}, {}, {}, None)

    def take(self, piece: xr.Dataset, first: int, *, final: bool) -> None:
        """Add the new steps of a piece."""
        state, count = self._state, piece.sizes["time"]
        fresh = slice(state.taken - first, count)
        step = np.arange(state.taken, first + count)
        columns = self._columns(piece)
        extremes = self._extremes(columns, fresh, piece["time"].to_numpy(), state.extremes)
        # values over neighbours wait for the next piece with its last step
        begin = max(state.taken - 1, 0) - first
        reached, totals = _measured(piece, begin, count if final else count - 1, state)
        new = {name: values[fresh] for name, values in columns.items()}
        met = np.asarray(rims_met(piece).max(axis=1) > 0.0)[fresh]
        kept, held, contact = self._chosen(_Held(new, step, met), final=final)
        parts, last_kept = state.parts, state.last_kept
        if len(kept.step):
            parts, last_kept = (*parts, kept.columns), int(kept.step[-1])
        if final and self._recording.every is None and last_kept < first + count - 1:
            parts = (*parts, {name: values[-1:].copy() for name, values in columns.items()})
        tail = piece.isel(time=[-1])
        self._state = _State(
            first + count, parts, held, contact, last_kept, reached, totals, extremes, tail
        )

    def without_histories(self) -> xr.Dataset:
        """Return the check's input of a complete run, without histories."""
        state = self._state
        tail = _tail(state)
        at_end = {name: QUANTITIES[name].of(tail)[-1] for name in LEFT if name in state.reached}
        end = float(tail["time"][-1])
        found = PeakState(state.reached, state.totals, at_end, end)
        return with_peak_state(_without_time(tail), found)

    def recorded(self, judged: xr.Dataset) -> xr.Dataset:
        """Return the result of `without_histories`, checked, with the recorded part."""
        state, tail = self._state, _tail(self._state)
        self._state = state._replace(parts=())
        data = self._selected(judged)
        names = ["time", *self._channels(tail)]
        parts = [dict(part) for part in state.parts]
        del state
        variables = {}
        note = {"recording": str(self._recording)}
        for name in names:  # one by one: each joined part is released
            values = np.concatenate([part.pop(name) for part in parts])
            variables[name] = xr.Variable(tail[name].dims, values, tail[name].attrs | note)
        del variables["time"].attrs["recording"]
        for name, (high, low) in self._state.extremes.items():
            attrs, dims = tail[name].attrs, tail[name].dims[1:]
            known = np.isfinite(high.values) & np.isfinite(low.values)
            each = (high.values, high.at, -low.values, low.at)
            numbers = (np.where(known, values, np.nan) for values in each)
            for kind, values in zip(EXTREMES, numbers, strict=True):
                own = {"units": "s"} if kind.startswith("time") else attrs
                variables[f"{kind}_{name}"] = xr.Variable(dims, values, own)
        return data.assign_coords(time=variables.pop("time")).assign(variables)

    def _channels(self, piece: xr.Dataset) -> list[str]:
        # Names of the variables recorded, in the order of the Dataset.
        histories = [str(name) for name in piece.data_vars if "time" in piece.variables[name].dims]
        chosen = self._recording.channels
        return histories if chosen is None else [name for name in histories if name in chosen]

    def _columns(self, piece: xr.Dataset) -> Columns:
        # The recorded variables of the chosen bearings and nodes, time first.
        names, part = self._channels(piece), piece
        if self._recording.bearings or self._recording.nodes or self._recording.levels:
            part = self._selected(piece[names], statics=piece)
        return {name: part.variables[name].to_numpy() for name in ("time", *names)}

    def _selected(self, data: xr.Dataset, statics: xr.Dataset | None = None) -> xr.Dataset:
        # The bearings and nodes that the recording names; `statics` has the levels of the nodes.
        recording = self._recording
        statics = data if statics is None else statics
        if recording.bearings is not None and "bearing" in data.dims:
            data = data.sel(bearing=list(recording.bearings))
        if (recording.nodes is None and recording.levels is None) or "node" not in data.dims:
            return data
        names = [str(name) for name in statics["node"].to_numpy()]
        levels = [str(name) for name in statics["level"].to_numpy()]
        wanted = {levels.index(name) for name in recording.levels or ()}
        place = statics["level_node"].to_numpy()
        nodes = recording.nodes or ()
        kept = [k for k, name in enumerate(names) if name in nodes or int(place[k]) in wanted]
        data = data.isel(node=kept)
        if "bearing_node" in data:
            own = {k: n for n, k in enumerate(kept)}
            ends = [[own.get(int(k), -1) for k in row] for row in data["bearing_node"].to_numpy()]
            data["bearing_node"] = data["bearing_node"].copy(data=np.array(ends, dtype=np.int64))
            counts = np.array([int((place == k).sum()) for k in range(len(levels))])
            data["nodes_of_level"] = labelled(("level",), counts, "1", "nodes of it in the model")
        return data

    def _extremes(
        self, columns: Columns, fresh: slice, time: FloatArray, old: dict[str, Any]
    ) -> dict[str, tuple[Extreme, Extreme]]:
        if not self._recording.extremes or fresh.start >= fresh.stop:
            return old
        found = {}
        for name, values in columns.items():
            if name == "time":
                continue
            both = [extreme_of(sign * values[fresh], time[fresh]) for sign in (1.0, -1.0)]
            if name in old:
                both = [larger_of(a, b) for a, b in zip(old[name], both, strict=True)]
            found[name] = (both[0], both[1])
        return found

    def _chosen(self, new: _Held, *, final: bool) -> tuple[_Held, _Held | None, float]:
        # New and held steps to keep, steps to hold, and the last contact.
        every, window, state = self._recording.every, self._recording.around_impacts, self._state
        if window is None:
            return _part(new, _regular(new.step, every)), None, state.last_contact
        held = state.held
        if held is not None and len(held.step):
            columns = {k: np.concatenate([held.columns[k], v]) for k, v in new.columns.items()}
            step, met = (
                np.concatenate([getattr(held, k), getattr(new, k)]) for k in ("step", "met")
            )
            new = _Held(columns, step, met)
        time = new.columns["time"]
        contacts = np.concatenate([[state.last_contact], time[new.met]])
        place = np.searchsorted(contacts, time, side="right")
        since = time - contacts[np.maximum(place - 1, 0)]
        until = np.append(contacts, np.inf)[place] - time
        near = (since <= window[1] + _SAME_TIME) | (until <= window[0] + _SAME_TIME)
        near |= new.met
        decided = np.full(len(time), True)
        if not final and len(time):
            decided = time < time[-1] - window[0] - _SAME_TIME
        kept = _part(new, decided & (near | _regular(new.step, every)))
        last = np.append(time[new.met & decided], state.last_contact).max()
        return kept, _part(new, ~decided), float(last)


def reduced(data: xr.Dataset, recording: Recording) -> xr.Dataset:
    """Return the recorded part of a result with all steps, with its attributes."""
    reduction = Reduction(recording)
    reduction.take(data, 0, final=True)
    return reduction.recorded(reduction.without_histories().assign_attrs(data.attrs))


def without_histories_of(data: xr.Dataset) -> xr.Dataset:
    """Return the check's input from a result with all steps, without its histories."""
    reduction = Reduction(Recording(every=None))
    reduction.take(data, 0, final=True)
    return reduction.without_histories().assign_attrs(data.attrs)


def _measured(
    piece: xr.Dataset, begin: int, end: int, state: _State
) -> tuple[dict[str, Extreme], dict[str, FloatArray]]:
    # Peaks of the steps begin to end of a piece.
    if begin >= end:
        return state.reached, state.totals
    time = piece["time"].to_numpy()[begin:end]
    reached, totals = {}, {}
    for name in present_quantities(piece):
        now = extreme_of(QUANTITIES[name].of(piece)[begin:end], time)
        reached[name] = larger_of(state.reached[name], now) if name in state.reached else now
    for name, total in TOTALS.items():
        now_total = total.of(piece, begin, end)
        totals[name] = state.totals[name] + now_total if name in state.totals else now_total
    return reached, totals


def present_quantities(piece: xr.Dataset) -> list[str]:
    """Return the names of the quantities that the model of a result has."""
    levels = piece.sizes["level"]
    lacking: set[str] = set() if levels else {"floor_plan", "floor_vertical"}
    if levels < 2:
        lacking |= {"drift", "line_drift", "storey_shear"}
    if "body_rotation" not in piece:
        lacking |= {"tilt"}
    if "temperature" not in piece:
        lacking |= {"temperature"}
    for part in ("link", "hinge"):
        if part not in piece.dims:
            lacking |= {name for name, each in PEAKS.items() if part in each.dims}
    return [name for name in PEAKS if name not in lacking]


def _regular(step: IntArray, every: int | None) -> BoolArray:
    return np.asarray(step == 0 if every is None else step % every == 0)


def _part(held: _Held, chosen: BoolArray) -> _Held:
    columns = {name: values[chosen] for name, values in held.columns.items()}
    return _Held(columns, held.step[chosen], held.met[chosen])


def _tail(state: _State) -> xr.Dataset:
    if state.tail is None:
        msg = "no step was recorded"
        raise AssertionError(msg)
    return state.tail


def _without_time(data: xr.Dataset) -> xr.Dataset:
    return data.drop_dims("time")
