"""Results of a database as they are handed out: texts as Python's, runs that are not done empty."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing as xarray_indexing

from frames.risk._errors import CampaignError
from frames.risk.campaign.plan_description import TAKEN_OVER

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


def opened(where: Path) -> xr.Dataset:
    """Return a group of a database, its values read where they are used, its labels at once."""
    data: xr.Dataset = xr.open_zarr(where, chunks=None, consolidated=False)
    labels: dict[Any, Any] = {
        name: (label.dims, np.array(label.to_numpy().tolist(), dtype=object), label.attrs)
        for name, label in data.coords.items()
        if label.dtype.kind not in "fiub"
    }
    return data.assign_coords(labels)


def results_of(where: Path, plan: Mapping[str, Any], done: BoolArray) -> xr.Dataset:
    """Return what the runs of a results database reached.

    Shapes: done (runs,).
    """
    with readable(where):
        data = opened(where)
        names: list[str] = data.attrs.pop("results")
        data = data[names]
    shown = {
        name: (
            data[name].dims,
            indexing.LazilyIndexedArray(_Rows(data[name].variable, done, where, plan["batch"])),
            data[name].attrs,
        )
        for name in names
    }
    digests = np.array([plan["motions"][str(n)] for n in data["motion"].to_numpy()], dtype=object)
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

    def __init__(self, variable: xr.Variable, done: BoolArray, where: Path, batch: int) -> None:
        self._variable, self._done, self._where, self._batch = variable, done, where, batch
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
            raise CampaignError(damaged(self._where, self._first(), cause)) from cause
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
