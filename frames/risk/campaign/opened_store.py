"""Results of a database as they are handed out: texts as Python's, runs that are not done empty."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing as xarray_indexing

from frames.risk.campaign.plan_description import TAKEN_OVER

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from frames._types import BoolArray

indexing: Any = xarray_indexing  # its types are those of another kind of arrays


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

    Parameters
    ----------
    where : Path
        Group of the results.
    plan : mapping
        Of the results database.
    done : ndarray of bool, shape (runs,)
        Runs whose batch is complete: whatever stands in the rows of others is not shown.

    Returns
    -------
    xarray.Dataset
        Read where it is used; NaN and "" where a run is not done.
    """
    data = opened(where)
    names: list[str] = data.attrs.pop("results")
    data = data[names]
    shown = {
        name: (
            data[name].dims,
            indexing.LazilyIndexedArray(_Rows(data[name].variable, done)),
            data[name].attrs,
        )
        for name in names
        if data[name].dtype.kind != "f" or not done.all()
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

    def __init__(self, variable: xr.Variable, done: BoolArray) -> None:
        self._variable, self._done = variable, done
        self.shape = variable.shape
        self._empty: Any = np.nan if variable.dtype.kind == "f" else ""
        self.dtype = np.dtype(np.float64 if variable.dtype.kind == "f" else object)

    def __getitem__(self, key: Any) -> Any:
        support = indexing.IndexingSupport.OUTER
        return indexing.explicit_indexing_adapter(key, self.shape, support, self._part)

    def _part(self, key: tuple[Any, ...]) -> Any:
        values = np.array(self._variable[key].to_numpy(), dtype=self.dtype)
        values[~self._done[key[0]]] = self._empty
        return values
