"""Results of a database as they are handed out: texts as numpy's, runs that are not done empty."""

from __future__ import annotations

import json
import os
import socket
from contextlib import contextmanager
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing as xarray_indexing

from frames.results.storage import write_whole
from frames.risk._errors import CampaignError
from frames.risk.campaign.plan_description import TAKEN_OVER, WHOLE

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping
    from pathlib import Path

    from frames._types import BoolArray

indexing: Any = xarray_indexing  # its types are those of another kind of arrays


def damaged(where: Path, number: int, cause: Exception | None = None) -> str:
    """Return the message of a batch in a group that cannot be read, or is not as it was written."""
    mark, why = where.parent / "done" / f"{number:06d}.json", f" ({cause})" if cause else ""
    return f"batch {number} is not as it was written{why}: remove {mark}, and run it again"


@contextmanager
def readable(where: Path) -> Generator[None, None, None]:
    """Turn errors of a group's description into a CampaignError."""
    try:
        yield
    except (ValueError, LookupError, TypeError, RuntimeError, FileNotFoundError) as cause:
        msg = (
            f"the description of the arrays in {where} is damaged ({cause}): restore it from a "
            "copy, or name another store and run again"
        )
        raise CampaignError(msg) from cause


def opened(where: Path, plan: Mapping[str, Any], *, is_results: bool = False) -> xr.Dataset:
    """Return a group of a database, its values read where they are used, its labels at once."""
    import zarr

    data: xr.Dataset = xr.open_zarr(where, chunks=None, consolidated=False)
    group: Any = zarr.open_group(where, mode="r")
    for name in data.coords if is_results else data.variables:
        if plan["format"] >= WHOLE and group[name].nchunks_initialized < group[name].nchunks:
            msg = f"a chunk of {name} is missing"
            raise LookupError(msg)
    labels: dict[Any, Any] = {
        name: (label.dims, np.array(label.to_numpy().tolist(), dtype=str), label.attrs)
        for name, label in data.coords.items()
        if label.dtype.kind not in "fiub"
    }
    return data.assign_coords(labels)


def results_of(where: Path, plan: Mapping[str, Any], done: BoolArray) -> xr.Dataset:
    """Return what the runs of a results database reached.

    Shapes: done (runs,).
    """
    with readable(where):
        data = opened(where, plan, is_results=True)
        names: list[str] = data.attrs.pop("results")
        data = data[names]
    shown = {
        name: (
            data[name].dims,
            indexing.LazilyIndexedArray(_Rows(data[name].variable, done, where / name, plan)),
            data[name].attrs,
        )
        for name in names
    }
    digests = np.array([plan["motions"][str(n)] for n in data["motion"].to_numpy()])
    coordinates = {"done": ("run", done), "motion_digest": ("run", digests)}
    return data.assign(shown).assign_coords(coordinates).assign_attrs(_origin(plan))


def _origin(plan: Mapping[str, Any]) -> dict[str, str]:
    # Attributes: what was planned, where it comes from, and what took over.
    found = {key: str(plan[key]) for key in ("program", "options", "record")}
    found |= plan.get("provenance", {})
    taken = [
        f"after {each['after runs']} runs: {each['provenance']['source']}"
        for each in plan.get(TAKEN_OVER, [])
    ]
    return found | ({"sources_accepted": "; ".join(taken)} if taken else {})


class _Rows(BackendArray):
    # A variable along `run` in which rows that are not done are empty, and texts are Python's.

    # What cannot be read is an error that names the first batch of it.

    def __init__(
        self, variable: xr.Variable, done: BoolArray, where: Path, plan: Mapping[str, Any]
    ) -> None:
        self._variable, self._done, self._where, self._batch = variable, done, where, plan["batch"]
        self._is_whole = plan["format"] >= WHOLE and variable.size > 0
        self.shape = variable.shape
        self._empty: Any = np.nan if variable.dtype.kind == "f" else ""
        self.dtype = np.dtype(np.float64 if variable.dtype.kind == "f" else object)

    def __getitem__(self, key: Any) -> Any:
        support = indexing.IndexingSupport.OUTER
        return indexing.explicit_indexing_adapter(key, self.shape, support, self._part)

    def _part(self, key: tuple[Any, ...]) -> Any:
        try:
            values = np.array(self._variable[key].to_numpy(), dtype=self.dtype)
        except (RuntimeError, ValueError) as cause:
            raise CampaignError(damaged(self._where.parent, self._first(), cause)) from cause
        rows = np.arange(self.shape[0])[key[0]]
        for number in np.unique(rows[self._done[rows]] // self._batch) if self._is_whole else ():
            chunk = self._where / f"c.{number}{'.0' * (len(self.shape) - 1)}"
            if not chunk.exists():
                raise CampaignError(damaged(self._where.parent, number, LookupError(chunk)))
        values[~self._done[key[0]]] = self._empty
        return values

    def _first(self) -> int:
        # The first batch that cannot be read.
        for number, row in enumerate(range(0, self.shape[0], self._batch)):
            try:
                self._variable[row : row + self._batch].to_numpy()
            except (RuntimeError, ValueError):
                return number
        return 0


@contextmanager
def locked(path: Path) -> Generator[None, None, None]:
    """Hold a lock file; that of a process that has died is seized.

    The system lets go of it when its process ends. Who holds it stands in a file beside it, which
    others can read on every system.
    """
    from filelock import FileLock, Timeout

    lock, note = FileLock(path), path.with_name(f"{path.name}-holder.json")
    try:
        lock.acquire(timeout=0)
    except Timeout as cause:
        msg = (
            f"{path.parent} is in use by {_holder(note)}: wait until it has ended, or name another "
            "folder"
        )
        raise CampaignError(msg) from cause
    try:
        began = datetime.now(UTC).isoformat(timespec="seconds")
        known = {"pid": os.getpid(), "host": socket.gethostname(), "since": began}
        write_whole(note, json.dumps(known).encode())
        yield
    finally:
        note.unlink(missing_ok=True)
        lock.release()


def _holder(note: Path) -> str:
    try:
        known = json.loads(note.read_text(encoding="utf-8"))
    except (OSError, json.JSONDecodeError):  # it has just begun, or just ended
        return "another process"
    return f"process {known['pid']} on {known['host']} since {known['since']}"
