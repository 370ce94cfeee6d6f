"""A batch of a campaign computed: its runs as arrays of the shape that the results database has."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames._fingerprint import fingerprint, fingerprints, motion_digest
from frames.batch.cases import NOT_BUILT
from frames.batch.time_histories import time_histories
from frames.frame import Frame
from frames.recording.recording import Recording
from frames.risk._errors import CampaignError
from frames.risk.campaign.designs import with_parameters
from frames.risk.campaign.measures import evaluate, with_room
from lir_element.errors import AnalysisError, AnalysisWarning

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    import xarray as xr

    from frames._types import IntArray
    from frames.batch.cases import BatchProgress
    from frames.batch.processes import Crew
    from frames.motion.ground_motion import GroundMotion
    from frames.risk.campaign.measures import Measure
    from frames.risk.campaign.plan import Plan

REFUSED = ValueError, ArithmeticError, AnalysisError
"""Reasons for which a model may not be built or run, kept in its row. Any other error is a bug."""

_PROBE_STEPS = 10
_TIMING = "seconds of the time loop"
_MOST_WARNINGS = 5

Builder = Callable[[dict[str, float]], Frame]
Told = Callable[["BatchProgress"], None]
Known = Mapping[str, tuple["xr.Dataset", int]]
"""Runs that are there already: results and row by `CampaignJob.digest`."""

DIGEST = "run_digest"
"""Variable of results that holds `CampaignJob.digest` of each run."""


class Batch(NamedTuple):
    """Results of a batch."""

    arrays: dict[str, Any]  # by name of variable, (runs, ...)
    histories: list[xr.Dataset]
    warnings: list[str]
    reused: int = 0  # runs that were copied, or are those of another row


@dataclass(frozen=True, eq=False)
class CampaignJob:
    """All that computes batches, wherever that is."""

    plan: Plan  # the rows
    # the structures, or functions of a set of parameters that give one
    models: Mapping[str, Frame | Builder]
    motions: Mapping[str, GroundMotion]  # the motions
    options: Mapping[str, Any]  # of `time_histories`
    record: Recording | None  # which histories are kept
    measures: Mapping[str, Measure] = field(default_factory=dict)  # own measures by name

    @property
    def read(self) -> Recording | None:
        """Histories that a run forms: those that are kept, or all for user-defined measures."""
        return self.record or (Recording() if self.measures else None)

    def build(self, name: str, k: int) -> Frame:
        """Return a model with set `k` of the parameters."""
        given, sample = self.models[name], self.plan.sample
        parameters = {} if sample is None else sample[k]
        if isinstance(given, Frame):
            return with_parameters(given, parameters) if parameters else given
        frame: object = given(parameters)
        if not isinstance(frame, Frame):
            msg = f'model "{name}" gave {frame!r}: return a Frame'
            raise TypeError(msg)
        return frame

    @cached_property
    def _motions(self) -> dict[str, str]:
        return {name: motion_digest(motion) for name, motion in self.motions.items()}

    def digest(self, row: int, frame: str) -> str:
        """Return a digest of a run's input, by the fingerprint of its structure."""
        run = self.plan.run(row)
        return fingerprint([run.model, frame, self._motions[run.motion], run.scale])

    def digests(self, rows: Iterable[int]) -> Iterator[str]:
        """Yield the digest of each run; "" if its model cannot be built."""
        last, frame = "", ""
        for row in rows:
            run = self.plan.run(row)
            if last != (last := run.title):
                try:
                    frame = fingerprint(self.build(run.model, run.parameters))
                except REFUSED:
                    frame = ""
            yield frame and self.digest(row, frame)

    def reference(self) -> tuple[dict[str, Frame], xr.Dataset]:
        """Return of each model the first that can be set up, and the layout of their results."""
        motion = next(iter(self.motions.values()))
        brief = dict(self.options)
        brief["duration"] = min(motion.duration, _PROBE_STEPS * (brief["dt"] or motion.dt))
        found: dict[str, Frame] = {}
        first = ""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the batches give them
            for name in self.models:
                for k in range(self.plan.sets):
                    try:
                        frame = self.build(name, k)
                        data = time_histories({name: frame}, motion, **brief)
                    except REFUSED as cause:
                        first = first or str(cause)
                        continue
                    if "peak_until" in data:
                        found[name] = frame
                        break
                    first = first or str(data["message"].item())
            if not found:
                msg = f"no model can be set up: correct the models; the first: {first}"
                raise CampaignError(msg)
            layout = _untimed(time_histories(found, motion, record=self.read, **brief))
            layout = with_room(layout, self.measures)
            layout[DIGEST] = "run", [""] * layout.sizes["run"], {"long_name": "what each run is of"}
            return found, layout.drop_dims(["time", "step"], errors="ignore")


def compute(
    work: CampaignJob,
    layout: xr.Dataset,
    batch: int,
    workers: Crew | int | None,
    told: Told | None = None,
    known: Known | None = None,
) -> Batch:
    """Compute a batch."""
    rows = work.plan.rows(batch)
    arrays = {str(name): _empty(layout[name], len(rows)) for name in layout.data_vars}
    histories = []
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        runs = _Runs(work, layout, workers, told, known or {})
        for places, found in runs.of(rows):
            at = np.array(places) - rows.start
            if isinstance(found, str):
                arrays["status"][at], arrays["message"][at] = NOT_BUILT, found
            else:
                _put(arrays, at, found, layout)
                if work.record is not None:
                    histories.append(_recorded(found, layout, places))
    texts = [str(w.message) for w in heard if not issubclass(w.category, AnalysisWarning)]
    said = [text for text, _ in Counter(texts).most_common(_MOST_WARNINGS)]
    for digest, places in runs.same.items():
        arrays[DIGEST][np.array(places) - rows.start] = digest
    return Batch(arrays, histories, said, runs.reused)


class _Runs:
    # The runs of a batch, in parts: a run that could keep others from running is a part of its own.

    def __init__(
        self,
        work: CampaignJob,
        layout: xr.Dataset,
        workers: Crew | int | None,
        told: Told | None,
        known: Known,
    ) -> None:
        self._work, self._layout, self._workers, self._told = work, layout, workers, told
        self._known = known
        self.same: dict[str, list[int]] = {}  # rows of each digest: they are one run
        self.reused = 0  # rows that are known, or the run of another one

    def of(self, rows: Sequence[int]) -> Iterator[tuple[list[int], xr.Dataset | str]]:
        frames: dict[str, Frame] = {}
        whole: dict[str, list[int]] = {}
        for row in rows:
            run = self._work.plan.run(row)
            whole.setdefault(run.title, []).append(row)
        for key, own in whole.items():
            run = self._work.plan.run(own[0])
            try:
                frames[key] = self._work.build(run.model, run.parameters)
            except REFUSED as cause:
                yield own, str(cause)
        first = self._distinct(frames, {key: whole[key] for key in frames})
        same = {own[0]: own for own in self.same.values()}
        self.reused = sum(map(len, same.values())) - sum(map(len, first.values()))
        there: dict[int, tuple[xr.Dataset, list[int], list[int]]] = {}  # by database
        for digest, own in self.same.items():
            if digest in self._known:
                data, row = self._known[digest]
                _, places, rows_there = there.setdefault(id(data), (data, [], []))
                places += own
                rows_there += [row] * len(own)
        for data, places, rows_there in there.values():
            yield places, data.isel(run=rows_there)
        for places, found in self._parts(frames, first):
            taken = sorted((row, k) for k, one in enumerate(places) for row in same[one])
            own = [row for row, _ in taken]
            yield own, found if isinstance(found, str) else found.isel(run=[k for _, k in taken])

    def _distinct(
        self, frames: dict[str, Frame], rows: dict[str, list[int]]
    ) -> dict[str, list[int]]:
        # Rows to run, by model. Parameters without effect on a model, such as the interface of a
        # plain DCFP, give one run.
        digests = fingerprints(frames)
        for key, own in rows.items():
            for row in own:
                self.same.setdefault(self._work.digest(row, digests[key]), []).append(row)
        first = {own[0] for digest, own in self.same.items() if digest not in self._known}
        todo = {key: [row for row in own if row in first] for key, own in rows.items()}
        return {key: own for key, own in todo.items() if own}

    def _parts(
        self, frames: dict[str, Frame], rows: dict[str, list[int]]
    ) -> Iterator[tuple[list[int], xr.Dataset | str]]:
        if not rows:
            return
        places = [row for own in rows.values() for row in own]
        try:
            data = self._histories(frames, rows)
        except REFUSED as cause:
            if len(places) == 1:
                yield places, str(cause)
                return
        else:
            extra = _extra(data, self._layout)
            if not extra or len(rows) == 1:
                yield places, extra or evaluate(data, self._work.measures, places)
                return
        for part in _split(rows):
            yield from self._parts(frames, part)

    def _histories(self, frames: dict[str, Frame], rows: dict[str, list[int]]) -> xr.Dataset:
        runs = [(key, self._work.plan.run(row)) for key, own in rows.items() for row in own]
        data = _untimed(
            time_histories(
                {key: frames[key] for key in rows},
                {run.motion: self._work.motions[run.motion] for _, run in runs},
                cases=[(key, run.motion, run.scale) for key, run in runs],
                record=self._work.read,
                workers=self._workers,
                progress=self._told,
                **self._work.options,
            )
        )
        return with_room(data, self._work.measures)


def _extra(data: xr.Dataset, layout: xr.Dataset) -> str:
    # Dimensions of the results that the results database lacks, in words.
    for dim in {*layout.dims} & {*data.dims} - {"run"}:
        if extra := _texts(data, dim) - _texts(layout, dim):
            return (
                f"the model has the {dim} {min(extra)}, which the first one has not: models of one "
                "function have the same names"
            )
    return ""


def _untimed(data: xr.Dataset) -> xr.Dataset:
    # Without the quantity that is never the same twice: `seconds_loop` has it.
    return data.drop_sel(quantity=_TIMING, errors="ignore")


def _texts(data: xr.Dataset, dim: Any) -> set[str]:
    return {str(name) for name in data[dim].to_numpy()}


def _split(rows: dict[str, list[int]]) -> list[dict[str, list[int]]]:
    if len(rows) > 1:
        return [{key: own} for key, own in rows.items()]
    ((key, own),) = rows.items()
    return [{key: own[: len(own) // 2]}, {key: own[len(own) // 2 :]}]


def _empty(variable: xr.DataArray, runs: int) -> Any:
    shape = (runs, *variable.shape[1:])
    if variable.dtype.kind == "f":
        return np.full(shape, np.nan)
    return np.full(shape, "", dtype=object)


def _put(arrays: dict[str, Any], at: IntArray, found: xr.Dataset, layout: xr.Dataset) -> None:
    # Results at their places: by row, and by the names along the other dimensions.
    place = {
        dim: {str(name): k for k, name in enumerate(layout[dim].to_numpy())} for dim in layout.dims
    }
    for name, array in arrays.items():
        if name not in found:
            continue
        variable = found[name]
        others = [
            np.array([place[dim][str(label)] for label in found[dim].to_numpy()], dtype=np.int64)
            for dim in variable.dims[1:]
        ]
        array[np.ix_(at, *others)] = variable.to_numpy()


def _recorded(found: xr.Dataset, layout: xr.Dataset, places: list[int]) -> xr.Dataset:
    # The histories alone.
    names = [name for name in found.data_vars if name not in layout.data_vars]
    data = found[names].drop_vars(["model", "motion", "scale", "motion_digest"])
    return data.assign_coords(run=places)
