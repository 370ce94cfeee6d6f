"""Modelling uncertainty of LIR-DCFP and DCFP: writes docs/validation/study_uncertainty.md.

    python -m validation.study.uncertainty --store uncertainty-runs

The campaigns can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

import hashlib
import json
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.design import MotionSet
from frames.risk import open_campaign
from validation.page import DPI, FOLDER
from validation.study.records import options_of, performed
from validation.study.records_runs import ULTIMATE, normalised
from validation.study.rounded import rounded, written
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

    from frames import GroundMotion

NAME = "study_uncertainty"
RECORDS = "far-field"
DRAWS = 300
RIMS = {"stiffness": stiffness_campaign, "elastic": elastic_campaign, "best": best_campaign}
"""Campaigns over the stiffness of rims, by the folders of their stores."""


def study(motions: Mapping[str, GroundMotion], store: Path, workers: int) -> dict[str, Any]:
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


def write(found: Mapping[str, Any], folder: Path = FOLDER) -> None:
    """Write the page, its figures, tables and the numbers."""
    for name, figure in figures(found).items():
        figure.savefig(folder / "figures" / name, dpi=DPI, metadata={"Software": None})
    (folder / f"{NAME}.md").write_text(page(found), encoding="utf-8")
    (folder / f"{NAME}.json").write_text(json.dumps(found) + "\n", encoding="utf-8")
    rows = [
        {"result": text, "index": kind, "property": key}
        | dict(zip(("value [-]", "low", "high"), values, strict=True))
        for name, text in WHAT.items()
        for kind in ("first", "total")
        for key, values in found["shares"][name][kind].items()
    ]
    written(rows, folder / "tables" / f"{NAME}-indices.csv")
    margins = [
        dict(zip(("device", "stiffness over default [-]"), key.split("|"), strict=True))
        | dict(zip(("collapse margin [-]", "low", "high"), values, strict=True))
        for key, values in found["stiffness"]["margins"].items()
    ]
    written(margins, folder / "tables" / f"{NAME}-margins.csv")
    print(f"written to {folder}")


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaigns, and write the page."""
    options = options_of("uncertainty", given)
    if options.again:
        write(json.loads((FOLDER / f"{NAME}.json").read_text(encoding="utf-8")))
        return
    motions = normalised(MotionSet.fema_p695(RECORDS))
    with tempfile.TemporaryDirectory() as folder:
        write(rounded(study(motions, options.store or Path(folder), options.workers)))


if __name__ == "__main__":
    main()
