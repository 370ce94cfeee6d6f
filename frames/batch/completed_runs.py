"""Runs of a batch in files, one as it completes: a batch that was stopped takes them up again."""

from __future__ import annotations

import contextlib
import io
import json
import math
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile

import numpy as np
import xarray as xr

from frames._errors import ModelWarning
from frames._fingerprint import fingerprint, motion_digest
from frames._provenance import sources_hash
from frames.batch.batch_dataset import Layout, RunResult
from frames.results.findings import findings_from
from frames.results.peaks import Peak
from frames.results.storage import make_folder, write_whole
from lir_element._version import package_version

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames.batch.cases import Case
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion
    from frames.solve.options import Options

_ENDING = ".run.npz"


class KeptRuns:
    """A folder of runs, each under a digest of all that its numbers depend on.

    The folder is made if it is not there; `asked` are features, levels and the recording.
    """

    def __init__(
        self,
        folder: Path,
        models: Mapping[str, FrameData],
        motions: Mapping[str, GroundMotion],
        options: Mapping[str, Options],
        asked: object,
    ) -> None:
        self._folder = make_folder(folder)
        self._models = {name: fingerprint(model) for name, model in models.items()}
        self._digests = {name: motion_digest(motion) for name, motion in motions.items()}
        self._options = {n: fingerprint(o._replace(progress=None)) for n, o in options.items()}
        self._common = fingerprint([asked, sources_hash(), package_version()])
        self._layouts: dict[str, Layout] = {}

    def rows(self, cases: Sequence[Case]) -> list[RunResult]:
        """Return the runs of these cases that are there, each at its place among them."""
        found = []
        paths = [self._path(case) for case in cases]
        for place, path in enumerate(paths):
            with contextlib.suppress(OSError, ValueError, KeyError, EOFError, BadZipFile):
                found.append(self._row(place, path))
        others = len({*self._folder.glob(f"*{_ENDING}")} - {*paths})
        if others and not found:
            msg = (
                f"the {others} runs that {self._folder} holds are of another model, motion, option "
                "or version: they are left aside"
            )
            warnings.warn(msg, ModelWarning, stacklevel=4)
        return found

    def keep(self, row: RunResult, case: Case) -> None:
        """Write a run; not one of a structure without equilibrium, which takes no time."""
        if row.layout is None:
            return
        own = row._asdict() | {"findings": row.findings.plain()}
        layout, histories = own.pop("layout"), own.pop("histories")
        arrays = {name: own.pop(name) for name in ("energy", "reached")}
        path = self._path(case)
        head: dict[str, Any] = {"row": own, "layout": _without_arrays(layout), "histories": None}
        head["of"] = path.name
        if histories is not None:
            head["histories"] = [
                (name, variable.dims, variable.attrs, name in histories.coords)
                for name, variable in histories.variables.items()
                if name in histories.data_vars or name in histories.dims
            ]
            for k, (name, *_) in enumerate(head["histories"]):
                values = histories[name].to_numpy()
                arrays[f"history {k}"] = values.astype(str) if values.dtype == object else values
        whole = io.BytesIO()
        np.savez(whole, head=np.array(json.dumps(head)), **arrays)
        make_folder(self._folder)  # which somebody may have removed since
        write_whole(path, whole.getbuffer())

    def _path(self, case: Case) -> Path:
        parts = [
            tuple(case),
            self._models[case.model],
            self._digests[case.motion],
            self._options[case.motion],
            self._common,
        ]
        return self._folder / f"{fingerprint(parts)}{_ENDING}"

    def _row(self, place: int, path: Path) -> RunResult:
        with np.load(io.BytesIO(path.read_bytes())) as file:  # a cut file leaves none open
            head = json.loads(str(file["head"]))
            arrays = {name: file[name] for name in file.files}
        if head["of"] != path.name:
            msg = f"{path} is a copy of {head['of']}"
            raise ValueError(msg)
        own = head["row"] | {"place": place}
        own["findings"] = findings_from(own["findings"])
        own["peaks"] = tuple(Peak(*peak) for peak in own["peaks"])
        return RunResult(
            **own,
            energy=arrays["energy"],
            reached=arrays["reached"],
            layout=self._layout(head["layout"]),
            histories=_histories(head["histories"], arrays),
        )

    def _layout(self, kept: Mapping[str, Any]) -> Layout:
        # Runs of one structure share theirs.
        shapes = tuple(map(tuple, kept["shapes"]))
        layout = Layout(
            names=tuple(kept["names"]),
            dims=tuple(map(tuple, kept["dims"])),
            shapes=shapes,
            starts=np.concatenate([[0], np.cumsum([math.prod(shape) for shape in shapes])]),
            attrs=tuple(kept["attrs"]),
            labels={dim: tuple(names) for dim, names in kept["labels"].items()},
        )
        return self._layouts.setdefault(fingerprint(layout), layout)


def _without_arrays(layout: Layout) -> dict[str, Any]:
    return {name: value for name, value in layout._asdict().items() if name != "starts"}


def _histories(
    kept: Sequence[tuple[str, Sequence[str], dict[str, Any], bool]] | None,
    arrays: Mapping[str, np.ndarray[Any, Any]],
) -> xr.Dataset | None:
    # What was recorded of a run, with the coordinates of its dimensions alone.
    if kept is None:
        return None
    data: dict[str, xr.Variable] = {}
    coordinates: dict[str, xr.Variable] = {}
    for k, (name, dims, attrs, is_coordinate) in enumerate(kept):
        variable = xr.Variable(dims, arrays[f"history {k}"], attrs)
        (coordinates if is_coordinate else data)[name] = variable
    return xr.Dataset(data, coordinates)
