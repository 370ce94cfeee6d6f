"""Sobol' indices of a campaign whose file draws Saltelli's sets: a table for its page and CSV."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.risk._errors import FragilityError
from frames.risk.campaign.plot_response import QUANTITIES
from frames.risk.fragility.risk import RiskWarning
from frames.risk.fragility.runs import COMPLETE, outcome_of
from frames.risk.fragility.sobol import sobol_indices

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

    from frames.risk.fragility.sobol import SobolIndices

WITHIN, WHOLE = "variance within records", "whole variance"
"""Variances of which indices are shares."""


def index_table(
    data: xr.Dataset, distributions: Mapping[str, Any], *, samples: int, seed: int
) -> pd.DataFrame:
    """Return indices of the results, a row a structure, factor, quantity and parameter.

    Values of failed bearings, and larger ones, count as the largest of the complete runs. If there
    are no indices, "no index" has the reason.
    """
    done = np.array([outcome_of(str(each)) == COMPLETE for each in data["status"].to_numpy()])
    quantities = [name for name in QUANTITIES if name in data["quantity"].to_numpy()]
    rows: list[dict[str, object]] = []
    for model in dict.fromkeys(map(str, data["model"].to_numpy())):
        for scale in sorted({*data["scale"].to_numpy().tolist()}):
            of = (data["model"] == model).to_numpy() & (data["scale"] == scale).to_numpy()
            for quantity in quantities:
                reached = data["peak"].sel(quantity=quantity).to_numpy()[of & done]
                place = {"structure": model, "factor": scale, "quantity": quantity}
                most = float(np.nanmax(reached, initial=0.0))
                given: dict[str, Any] = {"quantity": quantity, "at_most": most, "samples": samples}
                try:
                    with warnings.catch_warnings(action="ignore", category=RiskWarning):
                        found = sobol_indices(
                            data, distributions, seed=seed, model=model, scale=scale, **given
                        )
                except FragilityError as cause:
                    rows.append(place | {"no index": str(cause)})
                    continue
                rows += [place | row for row in _rows(found)]
    return pd.DataFrame(rows)


def _rows(found: SobolIndices) -> list[dict[str, object]]:
    several = found.groups is not None
    parts = [(found.table, WITHIN if several else WHOLE)]
    parts += [(found.groups, WHOLE)] if found.groups is not None else []
    return [
        {"parameter": str(name), "share of": text}
        | {f"{key} [-]": value for key, value in row.items()}
        | {"samples left out": found.left_out, "no index": ""}
        for table, text in parts
        for name, row in table.iterrows()
    ]
