"""Rows of a campaign: as they are planned, and as a table of what they reached."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import xarray as xr

from frames.risk._errors import CampaignError
from frames.risk.fragility.runs import outcome_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames.risk.campaign.plan import Plan

_ROWS = {"run", "model", "motion", "scale", "parameter_set"}
"""Coordinates of a row, besides its parameters."""


def planned_rows(plan: Plan, layout: xr.Dataset) -> xr.Dataset:
    """Return what is planned of all runs, as coordinates along `run`, beside results like these."""
    names = () if plan.sample is None else plan.sample.names
    taken = {*names} & {*map(str, layout.variables), *_ROWS, "done", "motion_digest", OUTCOME}
    if taken:
        msg = f'the parameter "{min(taken)}" has the name of a result or column: give it another'
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
"""Columns that tell the run, before its parameters."""

OUTCOME = "outcome"
ENDS = ("status", "message", "doubts", "seconds_loop")
"""Columns that tell how a run ended; `OUTCOME` stands before them."""


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
