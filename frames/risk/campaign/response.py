"""What runs of a campaign reached, by structure and factor on the motions; what failed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.risk.fragility.intensity import Intensity, IntensityMeasure
from frames.risk.fragility.runs import COMPLETE, FAILURE, UNBUILT, UNKNOWN, IntensityRuns

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

    from frames._types import FloatArray
    from frames.motion.ground_motion import GroundMotion

QUANTITIES = (
    "bearing displacement",
    "storey drift, mean",
    "floor acceleration in plan, mean",
    "base shear",
    "rim force",
    "interface slip",
)
"""Quantities of `frames.peaks` that the page shows, where a structure has them."""

FRACTILES = (0.16, 0.5, 0.84)


def runs_by_model(
    data: xr.Dataset, motions: Mapping[str, GroundMotion], intensity: IntensityMeasure | None = None
) -> dict[str, IntensityRuns]:
    """Return the runs of each structure, all sets of parameters together.

    Parameters
    ----------
    data : xarray.Dataset
        Of a campaign.
    motions : mapping of str to GroundMotion
        Its motions, not scaled.
    intensity : IntensityMeasure, optional
        The measure; the factor on the motions if None.

    Returns
    -------
    dict of str to IntensityRuns
        By structure, in the order of the campaign.
    """
    measure = intensity or Intensity(kind="scale")
    names = dict.fromkeys(str(name) for name in data["model"].to_numpy())
    return {
        name: IntensityRuns.from_dataset(data, motions, measure, model=name, parameters="all")
        for name in names
    }


def fractiles(runs: IntensityRuns, quantity: str) -> dict[float, FloatArray]:
    """Return fractiles of a demand at each factor on the motions.

    Parameters
    ----------
    runs : IntensityRuns
        Runs of one structure.
    quantity : str
        The demand.

    Returns
    -------
    dict of float to ndarray, (3,)
        By factor: the fractiles 16, 50 and 84 %. Failure of a bearing counts as an infinite demand;
        runs whose analysis failed count as none. NaN where there is no run. A fractile of n runs is
        the smallest demand that at least that part of them does not exceed.
    """
    demand, scale = runs.demand(quantity), runs.table["scale"].to_numpy()
    found = {}
    for factor in sorted(set(scale.tolist())):
        own = np.sort(demand[(scale == factor) & ~np.isnan(demand)])
        places = [max(math.ceil(part * len(own) - 1e-9) - 1, 0) for part in FRACTILES]
        found[factor] = own[places] if len(own) else np.full(len(FRACTILES), math.nan)
    return found


def response_table(models: Mapping[str, IntensityRuns]) -> pd.DataFrame:
    """Return what each structure reached at each factor on the motions.

    Parameters
    ----------
    models : mapping of str to IntensityRuns
        Of `runs_by_model`.

    Returns
    -------
    pandas.DataFrame
        A row a structure and factor: runs, shares in which a bearing failed, in which the analysis
        failed and, where there are any, for which nothing could be built [-], median and 84 %
        fractile of each quantity in SI units, as `fractiles` has them.
    """
    rows = []
    unbuilt = any((runs.table["outcome"] == UNBUILT).any() for runs in models.values())
    for name, runs in models.items():
        outcome, scale = runs.table["outcome"].to_numpy(), runs.table["scale"].to_numpy()
        each = {q: fractiles(runs, q) for q in QUANTITIES if q in runs.units}
        for factor in sorted(set(scale.tolist())):
            own = outcome[scale == factor]
            row: dict[str, object] = {
                "structure": name,
                "factor": factor,
                "runs": len(own),
                "bearing failed [-]": float((own == FAILURE).mean()),
                "analysis failed [-]": float((own == UNKNOWN).mean()),
            }
            if unbuilt:
                row["not built [-]"] = float((own == UNBUILT).mean())
            for quantity, values in each.items():
                unit = runs.units[quantity].replace("1", "-")
                row[f"{quantity}, median [{unit}]"] = values[factor][1]
                row[f"{quantity}, 84 % [{unit}]"] = values[factor][2]
            rows.append(row)
    return pd.DataFrame(rows)


def failure_table(models: Mapping[str, IntensityRuns]) -> pd.DataFrame:
    """Return the runs that did not go to their end, by structure and cause.

    Parameters
    ----------
    models : mapping of str to IntensityRuns
        Of `runs_by_model`.

    Returns
    -------
    pandas.DataFrame
        A row a structure and status: what it means, number and share of runs, the smallest factor
        on the motions at which it happened, and the message of the first such run. Empty if there
        is none.
    """
    rows = []
    for name, runs in models.items():
        table = runs.table
        for status, own in table[table["outcome"] != COMPLETE].groupby("status", sort=False):
            rows.append(
                {
                    "structure": name,
                    "cause": status,
                    "counts as": own["outcome"].iloc[0],
                    "runs": len(own),
                    "share [-]": len(own) / len(table),
                    "from factor": float(own["scale"].min()),
                    "first": f"{own['motion'].iloc[0]} x {own['scale'].iloc[0]:g}: "
                    f"{own['message'].iloc[0]}",
                }
            )
    return pd.DataFrame(rows)
