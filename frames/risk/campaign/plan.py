"""The plan of a campaign: row and batch of each run; rows as tables."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from frames.risk._errors import CampaignError
from frames.risk.fragility.runs import outcome_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames._types import IntArray
    from frames.risk.campaign.sampling import ParameterSample


MOST_LINES = 12
"""Differences that a message names."""


class PlannedRun(NamedTuple):
    """One run: names of its model and motion, its set of parameters, the factor on the motion."""

    model: str
    parameters: int
    motion: str
    scale: float

    @property
    def title(self) -> str:
        """Structure of the run in words."""
        return f"{self.model}, set {self.parameters}"


@dataclass(frozen=True, eq=False)
class Plan:
    """Rows of a campaign: models, sets of parameters, motions, scales, the last change first."""

    models: tuple[str, ...]  # names
    motions: tuple[str, ...]
    scales: tuple[float, ...]  # factors on the motions [-]
    sample: ParameterSample | None  # sets of parameters, if any
    batch: int  # runs of a batch, which is a chunk of the results database

    @property
    def sets(self) -> int:
        """Number of sets of parameters, 1 without any."""
        return 1 if self.sample is None else len(self.sample)

    @property
    def runs(self) -> int:
        """Number of runs."""
        return len(self.models) * self.sets * len(self.motions) * len(self.scales)

    @property
    def batches(self) -> int:
        """Number of batches."""
        return math.ceil(self.runs / self.batch)

    def rows(self, batch: int) -> range:
        """Return the rows of a batch."""
        return range(batch * self.batch, min((batch + 1) * self.batch, self.runs))

    def places(self) -> tuple[IntArray, ...]:
        """Return model, set, motion and scale of each row, by number, (runs,) each."""
        sizes = len(self.models), self.sets, len(self.motions), len(self.scales)
        return tuple(np.unravel_index(np.arange(self.runs), sizes))

    def run(self, row: int) -> PlannedRun:
        """Return the run of a row."""
        rest, scale = divmod(row, len(self.scales))
        rest, motion = divmod(rest, len(self.motions))
        model, k = divmod(rest, self.sets)
        return PlannedRun(self.models[model], k, self.motions[motion], self.scales[scale])


def differences(stored: Mapping[str, Any], own: Mapping[str, Any]) -> list[str]:
    """Return in words how a database's plan differs from the present one."""
    found = []
    for key in {**stored, **own}:
        old, new = stored.get(key), own.get(key)
        if old == new:
            continue
        if not (isinstance(old, dict) and isinstance(new, dict)):
            found.append(f"{key} was {_short(old)}, is {_short(new)}")
            continue
        for name in {**old, **new}:
            if name not in new:
                found.append(f'{key}: "{name}" is missing')
            elif name not in old:
                found.append(f'{key}: "{name}" is new')
            elif old[name] != new[name]:
                found.append(f'{key}: "{name}" was {_short(old[name])}, is {_short(new[name])}')
        if list(old) != list(new) and sorted(old) == sorted(new):
            found.append(f"{key} are in another order")
    return found


def listed(lines: list[str]) -> str:
    """Return differences line by line, the first ones if there are many."""
    more = [f"... and {len(lines) - MOST_LINES} more"] if len(lines) > MOST_LINES else []
    return "\n".join(f"  {line}" for line in lines[:MOST_LINES] + more)


def _short(value: object) -> str:
    text = str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


_ROWS = {"run", "model", "motion", "scale", "parameter_set"}
"""Coordinates of a row, besides its parameters."""


def planned_rows(plan: Plan, layout: xr.Dataset) -> xr.Dataset:
    """Return the plan of all runs, as coordinates along `run`, beside results like these."""
    names = () if plan.sample is None else plan.sample.names
    taken = {*names} & {*map(str, layout.variables), *_ROWS, "done", "motion_digest", OUTCOME}
    if taken:
        msg = f'the parameter "{min(taken)}" has the name of a result or column: rename it'
        raise CampaignError(msg)
    model, chosen, motion, scale = plan.places()
    found: dict[str, Any] = {
        "run": np.arange(plan.runs),
        "model": np.array(plan.models)[model],
        "motion": np.array(plan.motions)[motion],
        "scale": np.array(plan.scales)[scale],
    }
    if plan.sample is not None:
        found["parameter_set"] = chosen
        found |= {n: plan.sample.values[chosen, k] for k, n in enumerate(plan.sample.names)}
    return xr.Dataset(coords={name: ("run", values) for name, values in found.items()})


ROWS = ("model", "parameter_set", "motion", "scale")
"""Columns that identify the run, before its parameters."""

OUTCOME = "outcome"
ENDS = ("status", "message", "doubts", "seconds_loop")
"""Columns on the end of a run; `OUTCOME` is before them."""


def run_table(data: xr.Dataset, parameters: Sequence[str]) -> pd.DataFrame:
    """Return the runs that are done as a table."""
    done = np.flatnonzero(data["done"].to_numpy())
    own = data.isel(run=done)
    names = [name for name in (*ROWS, *parameters) if name in own.coords]
    columns: dict[str, Any] = {name: own[name].to_numpy() for name in names}
    columns[OUTCOME] = [outcome_of(str(status)) for status in own["status"].to_numpy()]
    columns |= {name: own[name].to_numpy() for name in ENDS}
    quantities = [str(name) for name in own["quantity"].to_numpy()]
    columns |= dict(zip(quantities, own["peak"].to_numpy().T, strict=True))
    table = pd.DataFrame(columns, index=pd.Index(own["run"].to_numpy(), name="run"))
    units = {"scale": "1", "seconds_loop": "s"}
    units |= dict(zip(quantities, map(str, own["unit"].to_numpy()), strict=True))
    table.attrs = {"units": units} | {str(name): text for name, text in data.attrs.items()}
    return table
