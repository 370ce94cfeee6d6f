"""Modelling uncertainty of LIR-DCFP and DCFP: writes docs/validation/study_uncertainty.md.

    python -m validation.study.uncertainty --store uncertainty-runs

The campaigns can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.design import MotionSet
from frames.risk import open_campaign
from validation.study.part import performed, run_part, write_part
from validation.study.records_runs import ULTIMATE, normalised
from validation.study.rounded import csv_of, rounded
from validation.study.uncertainty_numbers import (
    effects_of,
    shares_of,
    stiffness_of,
    table_of,
)
from validation.study.uncertainty_page import WHAT, figures, page
from validation.study.uncertainty_runs import (
    SAMPLES,
    best_campaign,
    elastic_campaign,
    sampled,
    sets_of,
    stiffness_campaign,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from frames import GroundMotion

NAME = "study_uncertainty"
RECORDS = "far-field"
DRAWS = 300
RIMS = {"stiffness": stiffness_campaign, "elastic": elastic_campaign, "best": best_campaign}
"""Campaigns over the stiffness of rims, by the folders of their stores."""


def study(motions: Mapping[str, GroundMotion], store: Path, workers: int | str) -> dict[str, Any]:
    """Run the campaigns, and return what the page says of them."""
    sets, results, costs = sets_of(), [], []
    (store / "sample").mkdir(parents=True, exist_ok=True)
    for numbers, runs in sampled(motions, store / "sample", sets):
        costs.append(performed(runs, workers))
        results.append((numbers, runs.results()))
    tables = table_of(results, SAMPLES)
    digests = {"sample": hashlib.sha256("".join(c["digest"] for c in costs).encode()).hexdigest()}
    for name, make in RIMS.items():
        costs.append(performed(make(motions, store / name), workers))
        digests[name] = costs[-1]["digest"]
    data = {name: open_campaign(store / name).results() for name in RIMS}
    stiff = stiffness_of([*data.values()], motions, DRAWS)
    ran = [*(each for _, each in results), *data.values()]
    return {
        "records": len(motions),
        "shares": shares_of(tables, DRAWS),
        "effects": effects_of(tables, sets, len(motions), DRAWS),
        "collapsed": {
            name: float((values[~np.isnan(values)] >= np.log(ULTIMATE) - 1e-9).mean())
            for name, values in tables.items()
        },
        "stiffness": stiff,
        "cost": costs[-1]
        | {
            "runs": sum(each["runs"] for each in costs),
            "loop": sum(float(each["seconds_loop"].sum()) for each in ran),
            "digests": digests,
        },
    }


def write(found: Mapping[str, Any]) -> None:
    """Write the page, its figures, tables and the numbers."""
    rows = [
        {"result": text, "index": kind, "property": key}
        | dict(zip(("value [-]", "low", "high"), values, strict=True))
        for name, text in WHAT.items()
        for kind in ("first", "total")
        for key, values in found["shares"][name][kind].items()
    ]
    margins = [
        dict(zip(("device", "stiffness over default [-]"), key.split("|"), strict=True))
        | dict(zip(("collapse margin [-]", "low", "high"), values, strict=True))
        for key, values in found["stiffness"]["margins"].items()
    ]
    tables = {f"{NAME}-indices.csv": csv_of(rows), f"{NAME}-margins.csv": csv_of(margins)}
    write_part(NAME, page(found), figures(found), found, tables)


def run(store: Path, workers: int | str) -> dict[str, Any]:
    """Run what is not done under the records, and return what the page says of it."""
    motions = normalised(MotionSet.fema_p695(RECORDS))
    found: dict[str, Any] = rounded(study(motions, store, workers))
    return found


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaigns, and write the page."""
    run_part("uncertainty", given, run, write)


if __name__ == "__main__":
    main()
