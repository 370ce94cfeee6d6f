"""Frames and walls of 3, 6 and 9 storeys on LIR-DCFP and DCFP: writes study_buildings.md.

    python -m validation.study.buildings --store building-runs

The campaigns can be stopped; the same command goes on with their stores. Needs the extras
"campaign", "fema" and "fragility".
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frames.design import MotionSet
from validation.measurements.yielding_runs import LIR
from validation.study.buildings_figures import figures
from validation.study.buildings_numbers import facts_of, halved, numbers_of
from validation.study.buildings_page import NAME, csv_tables, page
from validation.study.buildings_runs import (
    BUILDINGS,
    SCALES,
    building,
    records_for,
    yield_rotations,
)
from validation.study.device_runs import best_devices
from validation.study.paired import (
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
    from pathlib import Path

    Found = Mapping[str, Any]

RECORDS = "far-field"


def found_of(store: Path, workers: int | str) -> dict[str, Any]:
    """Run what is not done, and return what the page says of it."""
    motions = normalised(MotionSet.fema_p695(RECORDS))
    found: dict[str, Any] = {"records": len(motions), "considered": considered(), "buildings": {}}
    found["lir"] = told_of(best_devices()[LIR])
    costs = []
    for one in BUILDINGS:
        frames = {frame.name: frame for frame in on_devices(building(one)).values()}
        own = records_for(one, motions)
        data, cost = performed_each(frames, own, store, SCALES, workers)
        costs.append(cost)
        yields = yield_rotations(one)
        runs = {
            name.removeprefix(f"{one.name}, "): table_of(each, own, yields)
            for name, each in data.items()
        }
        found["buildings"][one.name] = {"facts": facts_of(one), "records": len(own)} | numbers_of(
            runs
        )
    return found | {"halved": halved(motions), "cost": joined(costs)}


def write(found: Found) -> None:
    """Write the page, its figures, its tables and the numbers."""
    write_part(NAME, page(found), figures(found), found, csv_tables(found))


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaigns, and write the page."""
    run_part("buildings", given, lambda store, workers: rounded(found_of(store, workers)), write)


if __name__ == "__main__":
    main()
