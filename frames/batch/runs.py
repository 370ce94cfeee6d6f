"""Runs as rows: tags identify each row for all users of them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, Self

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

    from frames._types import BoolArray

TAGS = DEVICE, HAZARD, BOUND, MASS_SHIFT = "device", "hazard_level", "bound", "mass_shift"
"""Tags of a run besides its model, motion and scale: bearings in a comparison, level of the seismic
action, bound of the properties, direction of moved masses. Each is a coordinate along `run`; a
missing one is "" for all runs.
"""


class Rows(ABC):
    """Rows with tags, which are selected and grouped by these."""

    @abstractmethod
    def of(self, name: str) -> np.ndarray[Any, Any]:
        """Return a variable or a tag of all rows, (n_runs, ...)."""

    @abstractmethod
    def those(self, mask: BoolArray) -> Self:
        """Return rows by a mask (n_runs,)."""

    def where(self, **tags: object) -> Self:
        """Return the rows that have all of these tags."""
        return self.those(np.all([self.of(name) == tag for name, tag in tags.items()], axis=0))

    def by(self, *tags: str) -> dict[tuple[Any, ...], Self]:
        """Return the rows in groups of the same tags, in the order of their first rows."""
        keys = zip(*(self.of(tag).tolist() for tag in tags), strict=True)
        return {key: self.where(**dict(zip(tags, key, strict=True))) for key in dict.fromkeys(keys)}


class Runs(Rows):
    """Runs of `time_histories`, a row each, of one batch or of several in a row.

    Parameters
    ----------
    *parts : xarray.Dataset
        Results of `time_histories`, with tags as coordinates along `run`. They are not merged:
        batches may differ in steps or nodes.

    Examples
    --------
    >>> from frames import time_histories
    >>> from frames.batch.runs import Runs
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_histories(frame, {"pulse": pulse}, scales=[0.5, 1.0], workers=1)
    >>> runs = Runs(data.assign_coords(bound=("run", ["lower", "upper"])))
    >>> len(runs), runs.where(bound="upper").of("scale").tolist()
    (2, [1.0])
    """

    def __init__(self, *parts: xr.Dataset) -> None:
        self.parts = tuple(part for part in parts if part.sizes["run"])

    def __len__(self) -> int:
        """Return the number of runs."""
        return sum(part.sizes["run"] for part in self.parts)

    def __add__(self, other: Runs) -> Runs:
        """Return these runs and others after them."""
        return Runs(*self.parts, *other.parts)

    @property
    def data(self) -> xr.Dataset:
        """All rows as one Dataset."""
        import xarray as xr

        if len(self.parts) == 1:
            return self.parts[0]
        known = [n for n in TAGS if any(n in part.coords for part in self.parts)]
        parts = [
            part.assign_coords({n: ("run", _of(part, n)) for n in known}) for part in self.parts
        ]
        return xr.concat(parts, "run", data_vars="minimal", coords="minimal", compat="override")

    def of(self, name: str) -> np.ndarray[Any, Any]:
        """Return a variable or a tag of all rows.

        Shapes: result (n_runs, ...).
        """
        return np.concatenate([_of(part, name) for part in self.parts] or [np.array([])])

    @property
    def centred(self) -> Runs:
        """The rows with the masses in place."""
        return self.those(self.of(MASS_SHIFT) == "")

    @property
    def moved(self) -> Runs:
        """The rows with moved masses: accidental eccentricity."""
        return self.those(self.of(MASS_SHIFT) != "")

    def those(self, mask: BoolArray) -> Runs:
        """Return rows by a mask (n_runs,); rows that follow one another are not copied."""
        found, begin = [], 0
        for part in self.parts:
            rows = np.flatnonzero(mask[begin : begin + part.sizes["run"]])
            begin += part.sizes["run"]
            if len(rows):
                first, end = int(rows[0]), int(rows[-1]) + 1
                found.append(part.isel(run=slice(first, end) if end - first == len(rows) else rows))
        return Runs(*found)


def tagged(data: xr.Dataset, **tags: str | Sequence[object]) -> xr.Dataset:
    """Return runs with tags, each of all of them or one a run."""
    count = data.sizes["run"]
    each = {n: [v] * count if isinstance(v, str) else list(v) for n, v in tags.items() if any(v)}
    return data.assign_coords({name: ("run", values) for name, values in each.items()})


def _of(part: xr.Dataset, name: str) -> np.ndarray[Any, Any]:
    # A tag that is not there is "" of all runs.
    if name not in part.variables and name in TAGS:
        return np.full(part.sizes["run"], "", dtype=object)
    return part.variables[name].transpose("run", ...).to_numpy()
