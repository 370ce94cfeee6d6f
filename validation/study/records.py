"""The records of FEMA P695 on four devices under a building that yields: writes the study's page.

    python -m validation.study.records --store study-runs

The campaign can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

import json
import tempfile
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frames import time_histories
from frames.design.hazard.motion_folder import RECORD_SETS
from frames.risk import open_campaign
from validation.measurements.yielding_runs import LIR, RIMS, WIDE
from validation.page import FOLDER
from validation.study.part import options_of, performed, quietly, write_part
from validation.study.records_figures import figures
from validation.study.records_page import page
from validation.study.records_runs import (
    DEMANDS,
    SCALES,
    STEP,
    campaign,
    devices,
    ductilities,
    found_of,
    record_sets,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames import GroundMotion

    Sets = Mapping[str, Mapping[str, GroundMotion]]

FAR, PULSE, PLAIN = RECORD_SETS
HALVED = (
    (LIR, FAR, 0, 1.6),
    (RIMS, FAR, 5, 2.2),
    (RIMS, PULSE, 8, 1.9),
    (WIDE, PULSE, 0, 2.6),
    (LIR, PLAIN, 8, 1.6),
)
"""Runs at half the step: device, set, motion by number, intensity [m/s2]."""


def halved(sets: Sets) -> list[dict[str, Any]]:
    """Return demands of some runs at the step of the campaign, and at half of it."""
    models = devices()
    rows = []
    for device, kind, number, scale in HALVED:
        name, motion = list(sets[kind].items())[number]
        numbers = []
        for dt in (STEP, 0.5 * STEP):
            with quietly():
                data = time_histories(
                    {device: models[device]}, {name: motion}, scales=[scale], dt=dt
                )
            peaks = data["peak"].isel(run=0).to_series().to_dict()
            peaks["ductility"] = float(ductilities(data)[0])
            status = str(data["status"].item())
            numbers.append(
                {"status": status}
                | {key: float(peaks[key]) if isfinite(peaks[key]) else None for key in DEMANDS}
            )
        rows.append({"device": device, "motion": name, "im": scale, "runs": numbers})
    return rows


def write(found: Mapping[str, Any]) -> None:
    """Write the page, its figures and the numbers."""
    write_part("study", page(found), figures(found), found)


def study(sets: Sets, store: Path, workers: int | str, scales: Sequence[float]) -> dict[str, Any]:
    """Run the campaign, and return what the page says of it."""
    motions = {name: motion for each in sets.values() for name, motion in each.items()}
    runs = campaign(motions, store, scales)
    cost = performed(runs, workers)
    return found_of(runs.results(), sets) | {"cost": cost}


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaign, and write the page."""
    options = options_of("records", given)
    if options.again:
        found = json.loads((FOLDER / "study.json").read_text(encoding="utf-8"))
        if options.store:  # fitted anew; cost and halved steps are those of the run
            found |= found_of(open_campaign(options.store).results(), record_sets())
        write(found)
        return
    with tempfile.TemporaryDirectory() as folder:
        sets = record_sets()
        found = study(sets, options.store or Path(folder, "runs"), options.workers, SCALES)
        write(found | {"halved": halved(sets)})


if __name__ == "__main__":
    main()
