"""Runs of a batch in files, one as it completes: a batch that was stopped continues with them."""

from __future__ import annotations

import warnings
from contextlib import suppress
from typing import TYPE_CHECKING

from frames._errors import ModelWarning
from frames._fingerprint import fingerprint, fingerprints, motion_digest
from frames._provenance import sources_hash
from frames.batch.batch_dataset import Layout, RunResult, row_of, stack
from frames.results.chunks import ENDING, load_chunk, write_chunk
from frames.results.storage import make_folder
from lir_element._version import package_version
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from frames.batch.cases import Case
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion
    from frames.solve.options import Options


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
        self._models = fingerprints(models)
        self._digests = {name: motion_digest(motion) for name, motion in motions.items()}
        self._options = {n: fingerprint(o._replace(progress=None)) for n, o in options.items()}
        self._common = fingerprint([asked, sources_hash(), package_version()])
        self._layouts: dict[str, Layout | None] = {}

    def rows(self, cases: Sequence[Case]) -> list[RunResult]:
        """Return the runs of these cases that are there, each at its place among them."""
        found = []
        paths = [self._path(case) for case in cases]
        for place, path in enumerate(paths):
            with suppress(ValueError):  # it is not there, or not whole
                row = row_of(load_chunk(path), place)
                layout = self._layouts.setdefault(fingerprint(row.layout), row.layout)
                found.append(row._replace(layout=layout))  # runs of one structure share theirs
        others = len({*self._folder.glob(f"*{ENDING}")} - {*paths})
        if others and not found:
            msg = worded(
                "the {count} runs in {folder} are not used: they are of another model, motion, "
                "option or version",
                count=others,
                folder=self._folder,
            )
            warnings.warn(msg, ModelWarning, stacklevel=4)
        return found

    def keep(self, row: RunResult, case: Case) -> None:
        """Write a run; not one of a structure without equilibrium, which needs no time."""
        if row.layout is None:
            return
        data = stack([row._replace(place=0)], [case], self._digests)
        make_folder(self._folder)  # which somebody may have removed since
        write_chunk(self._path(case), data)

    def _path(self, case: Case) -> Path:
        parts = [
            tuple(case),
            self._models[case.model],
            self._digests[case.motion],
            self._options[case.motion],
            self._common,
        ]
        return self._folder / f"{fingerprint(parts)}{ENDING}"
