"""Records turned, with a vertical component, one after another, and pulses: writes study_motions.md.

    python -m validation.study.motions --store motion-runs

The campaigns can be stopped; the same command goes on with their stores. Needs the extras
"campaign", "fema", "fragility" and "demo", and for the vertical component the folder LIR_RECORDS
with records of three components.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frames.design import MotionSet
from validation.measurements.yielding_runs import LIR
from validation.study.buildings_numbers import RESAMPLES
from validation.study.buildings_runs import BUILDINGS, SCALES, building, yield_rotations
from validation.study.device_runs import best_devices
from validation.study.motions_figures import figures
from validation.study.motions_numbers import of_angles, of_pulses, of_seconds, of_vertical
from validation.study.motions_page import NAME, csv_tables, page
from validation.study.motions_runs import (
    ANGLE_SCALES,
    ANGLES,
    MAIN_SCALES,
    PULSE_SCALES,
    SECONDS,
    TRIED,
    VERTICAL_SCALES,
    followed,
    pulses,
    three_components,
    turned,
    velocities,
    vertical_over_horizontal,
    without_vertical,
)
from validation.study.paired import (
    at_scales,
    joined,
    on_devices,
    performed_each,
    table_of,
    told_of,
)
from validation.study.part import run_part, write_part
from validation.study.records_runs import considered, normalised
from validation.study.rounded import rounded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames import GroundMotion
    from frames.risk import IntensityRuns

    Found = Mapping[str, Any]

BASE = BUILDINGS[0]
RECORDS = "far-field"


class Runner:
    """Runs campaigns of the building of three storeys in folders of one store."""

    def __init__(self, store: Path, workers: int) -> None:
        self._store, self._workers = store, workers
        self._frames = on_devices(building(BASE))
        self._yields = yield_rotations(BASE)
        self.costs: list[dict[str, Any]] = []

    def runs(
        self, name: str, motions: Mapping[str, GroundMotion], scales: Sequence[float]
    ) -> dict[str, IntensityRuns]:
        """Return the runs of a campaign by device."""
        frames = {self._frames[device].name: self._frames[device] for device in TRIED}
        data, cost = performed_each(frames, motions, self._store / name, scales, self._workers)
        self.costs.append(cost)
        return {
            key.removeprefix(f"{BASE.name}, "): table_of(each, motions, self._yields)
            for key, each in data.items()
        }


def found_of(runner: Runner, folder: Path) -> dict[str, Any]:
    """Run what is not done, and return what the page says of it."""
    motions = normalised(MotionSet.fema_p695(RECORDS))
    base = runner.runs("base", motions, SCALES)
    angles = {0: {name: at_scales(runs, ANGLE_SCALES) for name, runs in base.items()}} | {
        angle: runner.runs(f"angle-{angle}", turned(motions, angle), ANGLE_SCALES)
        for angle in ANGLES[1:]
    }
    after = {
        each.name: {
            name: runs.table
            for name, runs in runner.runs(
                f"after-{k}", followed(motions, each), MAIN_SCALES
            ).items()
        }
        for k, each in enumerate(SECONDS)
    }
    impulses = runner.runs("pulses", pulses(), PULSE_SCALES)
    whole = three_components(folder)
    flat = without_vertical(whole)
    vertical = of_vertical(
        runner.runs("vertical-without", flat, VERTICAL_SCALES),
        runner.runs("vertical-with", whole, VERTICAL_SCALES),
        RESAMPLES,
    )
    return {
        "records": len(motions),
        "lir": told_of(best_devices()[LIR]),
        "considered": considered(),
        "angles": of_angles(angles, RESAMPLES),
        "seconds": of_seconds(
            {name: runs.table for name, runs in base.items()},
            after,
            {each.name: each for each in SECONDS},
        ),
        "vertical": vertical,
        "three": {
            name: [motion.peak["z"], vertical_over_horizontal(motion)]
            for name, motion in whole.items()
        },
        "pulses": of_pulses(impulses),
        "velocities": velocities(),
        "cost": joined(runner.costs),
    }


def write(found: Found) -> None:
    """Write the page, its figures, its tables and the numbers."""
    write_part(NAME, page(found), figures(found), found, csv_tables(found))


def run(store: Path, workers: int | str) -> dict[str, Any]:
    """Run what is not done; records of three components are where LIR_RECORDS says."""
    records = os.environ.get("LIR_RECORDS")
    if not records:
        msg = "LIR_RECORDS names no folder: set it to one with records of three components"
        raise SystemExit(msg)
    found: dict[str, Any] = rounded(found_of(Runner(store, workers), Path(records)))
    return found


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaigns, and write the page."""
    run_part("motions", given, run, write)


if __name__ == "__main__":
    main()
