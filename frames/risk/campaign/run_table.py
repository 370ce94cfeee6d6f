"""Results of a campaign as one table of pandas: a row a run, a column a quantity."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.risk.fragility.runs import outcome_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

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
