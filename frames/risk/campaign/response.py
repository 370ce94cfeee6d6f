"""What runs of a campaign reached, by structure and factor on the motions; what failed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.results.quantities import QUANTITIES as TABLE
from frames.risk.fragility.intensity import Intensity, IntensityMeasure
from frames.risk.fragility.runs import COMPLETE, FAILURE, UNBUILT, UNKNOWN, IntensityRuns

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

    from frames._types import FloatArray
    from frames.motion.ground_motion import GroundMotion

QUANTITIES = tuple(
    TABLE[name].title
    for name in ("displacement", "drift", "floor_plan", "base_shear", "rim_force", "slip")
)
"""Quantities of `frames.peaks` that the page shows, where a structure has them."""

FRACTILES = (0.16, 0.5, 0.84)


def runs_by_model(
    data: xr.Dataset, motions: Mapping[str, GroundMotion], intensity: IntensityMeasure | None = None
) -> dict[str, IntensityRuns]:
    """Return the runs of each structure, all sets of parameters together."""
    measure = intensity or Intensity(kind="scale")
    names = dict.fromkeys(str(name) for name in data["model"].to_numpy())
    return {
        name: IntensityRuns.from_dataset(data, motions, measure, model=name, parameters="all")
        for name in names
    }


def fractiles(runs: IntensityRuns, quantity: str) -> dict[float, FloatArray]:
    """Return fractiles of a demand at each factor on the motions.

    Shapes: result (3,).
    """
    demand, scale = runs.demand(quantity), runs.table["scale"].to_numpy()
    found = {}
    for factor in sorted(set(scale.tolist())):
        own = np.sort(demand[(scale == factor) & ~np.isnan(demand)])
        places = [max(math.ceil(part * len(own) - 1e-9) - 1, 0) for part in FRACTILES]
        found[factor] = own[places] if len(own) else np.full(len(FRACTILES), math.nan)
    return found


def response_table(models: Mapping[str, IntensityRuns]) -> pd.DataFrame:
    """Return what each structure reached at each factor on the motions."""
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
    """Return the runs that did not go to their end, by structure and cause."""
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
