"""Runs that other results databases hold already, taken over in place of being computed again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.risk._errors import CampaignError
from frames.risk.campaign.plan import differences, listed
from frames.risk.campaign.store import CampaignStore

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames._types import IntArray
    from frames.risk.campaign.batches import CampaignJob

_SAME = "program", "sources", "options", "record", "measures"
_HISTORIES = "what was reached"


class KnownRuns:
    """Runs of other results databases by what they are of: model, motion, scale, parameters.

    Raises
    ------
    CampaignError
        If a database was computed otherwise, keeps histories, or has no model of this campaign.
    """

    def __init__(
        self, stores: Sequence[str | Path], work: CampaignJob, planned: Mapping[str, Any]
    ) -> None:
        self._work, self._motions = work, dict(planned["motions"])
        self._names = list(planned["parameters"])
        self._known: list[tuple[pd.MultiIndex, IntArray, xr.Dataset]] = []
        for path in stores:
            store = CampaignStore(path)
            models = _common_models(store, planned)
            data = store.results()
            keys = pd.DataFrame(
                {
                    "model": data["model"].to_numpy().astype(object),
                    "motion": data["motion_digest"].to_numpy().astype(object),
                    "scale": data["scale"].to_numpy(),
                }
                | {name: data[name].to_numpy() for name in self._names}
            )
            taken = data["done"].to_numpy() & keys["model"].isin(models).to_numpy()
            rows = np.flatnonzero(taken)
            index = pd.MultiIndex.from_frame(keys.iloc[rows])
            first = ~index.duplicated()
            self._known.append((index[first], rows[first], data))

    def of(self, rows: Sequence[int]) -> Iterator[tuple[list[int], xr.Dataset]]:
        """Yield which of the rows of a campaign are known, and their results, by database."""
        missing = list(rows)
        for index, places, data in self._known:
            if not missing:
                return
            at = index.get_indexer(pd.MultiIndex.from_frame(self._keys(missing)))
            found = np.flatnonzero(at >= 0)
            if len(found):
                taken = [missing[k] for k in found]
                yield taken, data.isel(run=places[at[found]])
                missing = [row for row in missing if row not in set(taken)]

    def _keys(self, rows: Sequence[int]) -> pd.DataFrame:
        plan = self._work.plan
        runs = [plan.run(row) for row in rows]
        keys: dict[str, Any] = {
            "model": [run.model for run in runs],
            "motion": [self._motions[run.motion] for run in runs],
            "scale": [run.scale for run in runs],
        }
        if plan.sample is not None:
            sets = [plan.sample[run.parameters] for run in runs]
            keys |= {name: [each[name] for each in sets] for name in self._names}
        return pd.DataFrame(keys)


def _common_models(store: CampaignStore, planned: Mapping[str, Any]) -> list[str]:
    # Names of the models that a database shares with a campaign.
    stored = store.plan()
    both = [{key: plan.get(key) for key in _SAME} for plan in (stored, planned)]
    names = [sorted(plan["parameters"]) for plan in (stored, planned)]
    found = differences(*both)
    if names[0] != names[1]:
        found.append(f"parameters were {names[0]}, are {names[1]}")
    if found:
        msg = (
            f"reuse = {store.path}: its runs were computed otherwise: leave it out, or plan this "
            f"campaign alike\n{listed(found)}"
        )
        raise CampaignError(msg)
    if planned["record"] != _HISTORIES:
        msg = f"reuse = {store.path}: histories are not taken over: leave out record or reuse"
        raise CampaignError(msg)
    models = [name for name, own in planned["models"].items() if stored["models"].get(name) == own]
    if not models:
        others = ", ".join(stored["models"])
        msg = (
            f"reuse = {store.path}: no model is the same (its models: {others}): the names, the "
            "structures and, with parameters, the first set have to be those of this campaign"
        )
        raise CampaignError(msg)
    return models
